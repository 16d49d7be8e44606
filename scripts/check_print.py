#!/usr/bin/env python3
"""Checks the PNG and PDF figures of a run.

    python scripts/check_print.py CAROM RUN        (needs: pip install pillow pypdf)

CAROM is a binary with the feature `figures`, RUN the directory of a run. A PNG must have the size of
its figure times the scale and contain text; a PDF must have one page of its size, with the figure's
text as text.
"""

import re
import subprocess
import sys
from pathlib import Path

from PIL import Image
from pypdf import PdfReader

SCALE = 2


def main():
    carom, run = sys.argv[1], Path(sys.argv[2])
    command = [carom, "report", run, "--format", "png,pdf", "--scale", str(SCALE)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    figures = sorted((run / "figures").glob("*.svg"))
    assert figures, f"{run} has no figures"
    for figure in figures:
        svg = figure.read_text(encoding="utf-8")
        size = [int(x) for x in re.search(r'width="(\d+)" height="(\d+)"', svg).groups()]
        with Image.open(figure.with_suffix(".png")) as image:
            width, height = image.size
            brightest = [max(pixel) for pixel in image.convert("RGB").getdata()]
        assert [width, height] == [SCALE * x for x in size], f"{figure.stem}.png is {width} × {height}"
        dark = sum(value < 90 for value in brightest)
        assert 0.001 < dark / (width * height) < 0.5, f"{figure.stem}.png: {dark} dark pixels"
        pages = PdfReader(figure.with_suffix(".pdf")).pages
        assert len(pages) == 1, f"{figure.stem}.pdf has {len(pages)} pages"
        points = [float(x) for x in pages[0].mediabox[2:]]
        assert all(abs(a - 0.75 * b) < 0.01 for a, b in zip(points, size)), f"{figure.stem}.pdf: {points} pt"
        words = "".join(pages[0].extract_text().split())
        wanted = re.findall(r"[A-Za-z0-9.]{3,}", " ".join(re.findall(r"<text[^>]*>([^<&]+)", svg)))
        missing = [word for word in wanted if word not in words]
        assert wanted and not missing, f"{figure.stem}.pdf lacks the words {missing}"
        print(f"{figure.stem}: {width} × {height} pixels, {len(words)} letters")


if __name__ == "__main__":
    main()
