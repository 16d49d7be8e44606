#!/usr/bin/env python3
"""Checks the PNG and PDF figures of a run.

    python scripts/check_print.py CAROM RUN        (needs: pip install pypdf)

CAROM is a binary with the feature `figures`, RUN the directory of a run. A PNG must have the size of
its figure times the scale and contain text; a PDF must have one page of its size, with the figure's
text as text.
"""

import re
import struct
import subprocess
import sys
import zlib
from pathlib import Path

from pypdf import PdfReader

SCALE = 2


def pixels(path):
    """Width, height and rows of a PNG of eight bits per channel, by its specification (ISO 15948)."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", f"{path} is no PNG"
    at, packed = 8, b""
    while at < len(data):
        (length,), kind = struct.unpack(">I", data[at : at + 4]), data[at + 4 : at + 8]
        chunk = data[at + 8 : at + 8 + length]
        assert struct.unpack(">I", data[at + 8 + length : at + 12 + length])[0] == zlib.crc32(kind + chunk)
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", chunk[:10])
        packed += chunk if kind == b"IDAT" else b""
        at += 12 + length
    assert (depth, colour) == (8, 6), (depth, colour)
    flat, size, rows = zlib.decompress(packed), 4 * width, []
    assert len(flat) == height * (size + 1)
    before = bytearray(size)
    for y in range(height):
        kind, row = flat[y * (size + 1)], bytearray(flat[y * (size + 1) + 1 : (y + 1) * (size + 1)])
        for i in range(size if kind else 0):
            left, above = row[i - 4] if i >= 4 else 0, before[i]
            corner = before[i - 4] if i >= 4 else 0
            near = min((left, above, corner), key=lambda v: abs(left + above - corner - v))
            row[i] = (row[i] + [0, left, above, (left + above) // 2, near][kind]) % 256
        rows.append(row)
        before = row
    return width, height, rows


def main():
    carom, run = sys.argv[1], Path(sys.argv[2])
    command = [carom, "report", run, "--format", "png,pdf", "--scale", str(SCALE)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    figures = sorted((run / "figures").glob("*.svg"))
    assert figures, f"{run} has no figures"
    for figure in figures:
        svg = figure.read_text(encoding="utf-8")
        size = [int(x) for x in re.search(r'width="(\d+)" height="(\d+)"', svg).groups()]
        width, height, rows = pixels(figure.with_suffix(".png"))
        assert [width, height] == [SCALE * x for x in size], f"{figure.stem}.png is {width} × {height}"
        dark = sum(max(row[i : i + 3]) < 90 for row in rows for i in range(0, len(row), 4))
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
