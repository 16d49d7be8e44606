#!/usr/bin/env python3
"""Checks the size of a report page in space: at least 20 000 surface triangles and 100 frames in less
than 8 MB.

    scripts/check_page_size.py runs/page/report.html
"""

import json
import pathlib
import re
import sys

page = pathlib.Path(sys.argv[1])
text = page.read_text()
scene = re.search(r'<script id="animation-data" type="application/json">(.*?)</script>', text, re.DOTALL)
if scene is None:
    sys.exit(f"{page}: no scene")
data = json.loads(scene.group(1))
triangles, frames, size = sum(data["facets"]), len(data["frames"]), page.stat().st_size
print(f"{page}: {triangles} triangles, {frames} frames, {size / 1e6:.1f} MB")
sys.exit(0 if triangles >= 20_000 and frames >= 100 and size < 8e6 else f"{page}: expected more, or a smaller page")
