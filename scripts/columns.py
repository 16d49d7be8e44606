#!/usr/bin/env python3
"""Prose and comments that are wider than 100 columns.

    scripts/columns.py [FILE...]

Reads the Markdown, Rust, Python and TOML files under version control, or the given ones, and prints
FILE:LINE and the width of every line that should be wrapped; the exit code is 1 if there are any.
In Markdown, and in the doc comments of Rust, tables, headings and code blocks may be wider, and so
may a line that is a single word or link. Code and string literals are not read.
"""

import io
import re
import subprocess
import sys
import tokenize
from pathlib import Path

WIDTH = 100
# A string that ends on a later line is one up to the end of its first.
STRING = re.compile(r'"(?:\\.|[^"\\])*(?:"|\\?$)|\'(?:\\.|[^\'\\])\'')
TRIPLE = re.compile(r'"""|\'\'\'')
LITERAL = re.compile(r"'[^'\n]*'")
# Nothing to wrap: one word or link after the marks of a list, quotation or comment.
SINGLE = re.compile(r"\s*(?:[-*+>#/!]+\s+|\d+\.\s+)*(?:\S*\[[^\]]*\](?:\([^)]*\)|:\s*\S+)|\S+)\S*\s*")


def prose(lines):
    """Of (number, content) in Markdown, the numbers that are neither code, table nor heading."""
    fence, blank, in_list, in_code = None, True, False, False
    for number, line in lines:
        text = line.lstrip(" >")
        if mark := re.match(r"`{3,}|~{3,}", text):
            if fence is None:
                fence = mark[0]
            elif text.startswith(fence):
                fence = None
            continue
        # Four columns after a blank line are code, except below an item of a list.
        in_code = line.startswith("    ") and (in_code or blank and not in_list)
        item = re.match(r"[-*+] |\d+\. ", text)
        in_list = bool(item) or (in_list and (not text or line.startswith(" ")))
        blank = not text
        if fence is None and not in_code and not text.startswith(("|", "#")):
            yield number


def markdown(lines):
    """The numbers of lines of prose."""
    yield from prose(enumerate(lines, 1))


def rust(lines):
    """The numbers of lines with a comment; doc comments count as Markdown."""
    docs = []
    for number, line in enumerate(lines, 1):
        if doc := re.match(r"\s*//[/!] ?", line):
            docs.append((number, line[doc.end() :]))
            continue
        yield from prose(docs)
        docs = []
        if "//" in STRING.sub("", line):
            yield number
    yield from prose(docs)


def python(lines):
    """The numbers of lines with a comment, other than those for type checkers."""
    for token in tokenize.generate_tokens(io.StringIO("\n".join(lines)).readline):
        if token.type == tokenize.COMMENT and not token.string.startswith("# type:"):
            yield token.start[0]


def toml(lines):
    """The numbers of lines with a comment, outside strings of several lines."""
    inside = False
    for number, line in enumerate(lines, 1):
        if not inside and "#" in LITERAL.sub("", STRING.sub("", line)):
            yield number
        inside ^= len(TRIPLE.findall(line)) % 2 == 1


READERS = {".md": markdown, ".rs": rust, ".py": python, ".pyi": python, ".toml": toml}


def too_wide(path):
    """(number, width) of the lines of a file that should be wrapped."""
    lines = path.read_text(encoding="utf-8").split("\n")
    for number in READERS[path.suffix](lines):
        line = lines[number - 1]
        if len(line) > WIDTH and not SINGLE.fullmatch(line):
            yield number, len(line)


def main():
    root = Path(__file__).resolve().parent.parent
    paths = [Path(name).resolve() for name in sys.argv[1:]]
    if not paths:
        listed = subprocess.run(["git", "-C", root, "ls-files"], capture_output=True, text=True, check=True)
        paths = [path for name in listed.stdout.splitlines() if (path := root / name).suffix in READERS]
    found = 0
    for path in paths:
        for number, width in too_wide(path):
            found += 1
            shown = path.relative_to(root) if path.is_relative_to(root) else path
            print(f"{shown}:{number}: {width} columns")
    if found:
        sys.exit(f"{found} lines of prose or comments are wider than {WIDTH} columns")
    print(f"prose and comments fit in {WIDTH} columns")


if __name__ == "__main__":
    main()
