#!/usr/bin/env python3
"""Opens pages in headless Chromium and fails on any console message, missing animation or request to the outside.

    python3 scripts/check_page.py runs/impact/report.html [more pages] [--screenshots DIR]

Needs `chromium` (apt-get install chromium) and nothing else. With --screenshots, writes NAME.png of the screen and NAME.pdf of the
print for every page, NAME being its folder.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path


def chromium(page, *options):
    """Standard output and error of one headless visit that is offline: every name resolves to nothing."""
    program = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if program is None:
        sys.exit("check_page.py needs chromium")
    with tempfile.TemporaryDirectory() as profile:
        command = [
            program, "--headless", "--disable-gpu", "--hide-scrollbars", f"--user-data-dir={profile}",
            "--enable-logging=stderr", "--v=0", "--host-resolver-rules=MAP * ~NOTFOUND", "--virtual-time-budget=4000",
            "--window-size=1000,3200", *options, page.resolve().as_uri(),
        ]
        if hasattr(os, "geteuid") and os.geteuid() == 0:
            command.insert(1, "--no-sandbox")
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    return done.stdout, done.stderr


def check(page):
    """What is wrong with a page, as sentences."""
    dom, log = chromium(page, "--dump-dom")
    wrong = [line for line in log.splitlines() if "CONSOLE" in line or "Uncaught" in line]
    if "<h1>" not in dom:
        wrong.append("the page has no heading: it was not shown")
    text = page.read_text(encoding="utf-8")
    outside = re.search(r"""(?:src|href)\s*=\s*["']?(?:https?:)?//|url\(|@import|\bfetch\(|XMLHttpRequest""", text)
    if outside:
        wrong.append(f"a request to the outside: {outside.group()}")
    if 'id="animation"' in text:
        opening = re.search(r'<figure[^>]*id="animation"[^>]*>', dom)
        if not opening or "hidden" in opening.group():
            wrong.append("the animation's script did not run to its end")
        if not re.search(r'<path[^>]*class="cursor"[^>]*d="M', dom):
            wrong.append("no time history has the animation's cursor")
    if page.stat().st_size > 5_000_000:
        wrong.append(f"{page.stat().st_size} bytes are more than 5 MB")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pages", nargs="+", type=Path)
    parser.add_argument("--screenshots", type=Path)
    arguments = parser.parse_args()
    failed = False
    for page in arguments.pages:
        wrong = check(page)
        failed |= bool(wrong)
        print(f"{page}: {page.stat().st_size / 1e6:.2f} MB, {'; '.join(wrong) or 'no console message'}")
        if arguments.screenshots:
            arguments.screenshots.mkdir(parents=True, exist_ok=True)
            to = arguments.screenshots / page.resolve().parent.name
            chromium(page, f"--screenshot={to}.png")
            chromium(page, f"--print-to-pdf={to}.pdf", "--no-pdf-header-footer")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
