#!/usr/bin/env python3
"""Prose and comments that are wider than 100 columns.

    scripts/columns.py

Prints FILE:LINE and the width of every such line of the Markdown, Rust, Python and TOML files under
version control; the exit code is 1 if there are any. Read are lines that are a comment as a whole,
and the text of Markdown. Tables, headings, blocks of code and lines that are a single word or link
may be wider.
"""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WIDTH = 100
# What begins a line of prose, by the suffix of the file.
MARKS = {".md": "", ".rs": r"\s*//[/!]? ?", ".py": r"\s*# ?", ".pyi": r"\s*# ?", ".toml": r"\s*# ?"}
# Nothing to wrap: one word or link after the marks of a list or quotation.
SINGLE = re.compile(r"\s*(?:[-*+>]\s+|\d+\.\s+)*(?:\S*\[[^\]]*\](?:\([^)]*\)|:\s*\S+)|\S+)\S*\s*")


def too_wide(path):
    """(number, width) of the lines of a file that should be wrapped."""
    in_block = False
    for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
        mark = re.match(MARKS[path.suffix], line)
        if not mark:
            in_block = False
            continue
        text = line[mark.end() :]
        if re.match(r"[\s>]*(```|~~~)", text):
            in_block = not in_block
        verbatim = in_block or text.startswith(("    ", "|", "#", "type:"))
        if len(line) > WIDTH and not verbatim and not SINGLE.fullmatch(text):
            yield number, len(line)


def main():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files"], capture_output=True, text=True, check=True)
    paths = [ROOT / name for name in listed.stdout.splitlines() if Path(name).suffix in MARKS]
    wide = [(path, *found) for path in paths if path.is_file() for found in too_wide(path)]
    for path, number, width in wide:
        print(f"{path.relative_to(ROOT)}:{number}: {width} columns")
    if wide:
        sys.exit(f"{len(wide)} lines of prose or comments are wider than {WIDTH} columns")
    print(f"prose and comments fit in {WIDTH} columns")


if __name__ == "__main__":
    main()
