#!/usr/bin/env python3
"""Draws the two figures of the paper as Carom computes them side by side, for the README.

    python3 scripts/paper_picture.py

From docs/book/src/verification/paper-uy.svg and paper-sigma.svg, which are those of `carom study
cases/paper/paper.toml`, to docs/images/paper.png. Needs `chromium` (apt-get install chromium).
"""

import base64
import tempfile
from pathlib import Path

from check_page import Browser

ROOT = Path(__file__).resolve().parent.parent
FIGURES = ("paper-uy.svg", "paper-sigma.svg")
# Pixels of the page, of which the picture has two in either direction.
WIDTH, SCALE = 1100, 2


def main():
    place = ROOT / "docs/book/src/verification"
    images = "".join(f'<img src="{(place / name).as_uri()}">' for name in FIGURES)
    style = "body { margin: 0; background: #fff; display: flex; width: %dpx } img { width: 50%%; }" % WIDTH
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        page = Path(folder) / "page.html"
        page.write_text(f"<!doctype html><style>{style}</style>{images}", encoding="utf-8")
        browser = Browser(Path(folder) / "profile")
        try:
            browser.open(page)
            size = browser.value("(r => [r.width, r.height])(document.body.getBoundingClientRect())")
            clip = {"x": 0, "y": 0, "width": size[0], "height": size[1], "scale": SCALE}
            shot = browser("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)["data"]
            browser.close()
        finally:
            browser.process.kill()
    (ROOT / "docs/images/paper.png").write_bytes(base64.b64decode(shot))


if __name__ == "__main__":
    main()
