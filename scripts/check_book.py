#!/usr/bin/env python3
"""Checks numbers in the prose and tables of the book against what `carom verify` computed.

    scripts/check_book.py [VERIFY.JSON] [--claims DIR [--write]]

A comment before a paragraph or table names the numbers in it, one a line:

    <!-- carom verify:
    −0.7823 = impact/impact: min A.uy
    6.02 = 4 × space/ball: peak_mean_force
    0.1 % = −1 × friction/disc-rolls: last [ friction_work / external_work ]
    5e-12 ≥ bar/elastic: last total / first total − 1
    -->

The number must stand in the next paragraph as it is written here. After `=`, the computed value of
the set-up, FAMILY/NAME, must round to it; after `≥`, its magnitude must not exceed it. Quantities are
those of the rows of `carom verify --verbose`, or metrics of arms in the set-up's study.csv, as
`METRIC of "ARM"`. With `--fast` some are not computed; they are counted and left to the nightly run.
The page on the suite says that every expected value states its source: that is checked, too.

--claims compares the table of the paper's statements, in the order of the study's claims, with the
output of `carom study cases/paper/claims.toml --out DIR`; --write puts the study's numbers into it.
"""

import argparse
import csv
import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COMMENT = re.compile(r"<!-- carom verify:\n(.*?)-->\n+(.*?)(?=\n\s*\n|\Z)", re.DOTALL)
LINE = re.compile(r"(?P<figure>\S+)(?P<percent> %)? (?P<sign>[=≥]) (?:(?P<factor>\S+) × )?(?P<place>\S+/\S+?): (?P<what>.+?)(?P<less> − 1)?")


def number(text):
    """The value of a figure, and half a unit of its last digit."""
    plain = text.replace("−", "-").replace("\u2009", "")
    digits, _, exponent = plain.lower().partition("e")
    decimals = len(digits.partition(".")[2])
    return float(plain), 0.5 * 10.0 ** (int(exponent or 0) - decimals)


def computed(path):
    """Values by place and quantity, and whether slow ones were left out."""
    verified = json.loads(path.read_text(encoding="utf-8"))
    values = {}
    for set_up in verified["set_ups"]:
        found = values.setdefault(f"{set_up['family']}/{set_up['name']}", {})
        table = path.parent / set_up["directory"] / "study.csv"
        if table.is_file():
            with open(table, encoding="utf-8", newline="") as file:
                for row in csv.DictReader(file):
                    found |= {f'{key} of "{row["arm"]}"': value for key, value in row.items() if value}
        for row in set_up["rows"]:
            arm = f' of "{row["arm"]}"' if row["arm"] else ""
            found[row["what"] + arm] = row["got"]
    return values, verified["fast"]


def without_source(path):
    """Expected values that state no source."""
    set_ups = json.loads(path.read_text(encoding="utf-8"))["set_ups"]
    return [
        f"{set_up['file']}: {row['what']}: no source"
        for set_up in set_ups
        for row in set_up["rows"]
        if not row["source"]
    ]


def problem(line, paragraph, values, fast):
    """What is wrong with a line; nothing if it is right, None if it cannot be decided."""
    if not (parts := LINE.fullmatch(line)):
        return "is not `NUMBER = FAMILY/NAME: QUANTITY`"
    figure = parts["figure"] + (parts["percent"] or "")
    if not re.search(rf"(?<![\w.]){re.escape(figure)}(?![\w]|\.\d)", re.sub(r"\s+", " ", paragraph)):
        return f"the paragraph below does not say {figure}"
    got = values.get(parts["place"], {}).get(parts["what"])
    if got is None:
        return None if fast else f"{parts['place']} has no `{parts['what']}`"
    value, half = number(parts["figure"])
    scale = (100 if parts["percent"] else 1) * number(parts["factor"] or "1")[0]
    got = scale * (float(got) - (1 if parts["less"] else 0))
    right = abs(got - value) <= half * (1 + 1e-9) if parts["sign"] == "=" else abs(got) <= value
    return "" if right else f"carom verify computes {got:.6g}"


def numbers_in_prose(path):
    """What is wrong with the numbers named in comments, and how many are right, and left out."""
    values, fast = computed(path)
    wrong = without_source(path)
    right = 0
    left = 0
    for page in sorted((ROOT / "docs/book/src").rglob("*.md")):
        text = page.read_text(encoding="utf-8")
        for comment in COMMENT.finditer(text):
            first = text.count("\n", 0, comment.start(1)) + 1
            # A line that begins with a space continues the one before.
            for line in re.finditer(r"(?m)^\S.*(?:\n .*)*", comment[1]):
                words = " ".join(line[0].split())
                found = problem(words, comment[2], values, fast)
                if found:
                    row = first + comment[1].count("\n", 0, line.start())
                    wrong.append(f"{page}:{row}: {words}: {found}")
                right += found == ""
                left += found is None
        if text.count("<!-- carom verify:") != len(COMMENT.findall(text)):
            wrong.append(f"{page}: a comment `carom verify:` without an end or a paragraph")
    print(f"the book: {right} numbers are those of carom verify" + (f", {left} are slow" if left else ""))
    return wrong


def ratio(claim):
    """Median, least and largest ratio, with two digits, or as many as tell them apart."""
    values = [float(claim[key]) for key in ("ratio", "ratio_low", "ratio_high")]
    digits = 5 if max(values) - min(values) < 0.01 * max(values) else 2
    median, low, high = (f"{value:#.{digits}g}".rstrip(".") for value in values)
    return f"{median} ({low} to {high})"


def table_of_claims(study, write):
    """The rows that differ from the study; with `write`, they are replaced."""
    page = ROOT / "docs/book/src/verification/paper.md"
    head = "| Statement | Members that confirm it | Ratio |\n| --- | --- | --- |\n"
    with open(study / "claims.csv", newline="", encoding="utf-8") as file:
        claims = list(csv.DictReader(file))
    before, after = page.read_text(encoding="utf-8").split(head)
    table, rest = after.split("\n\n", 1)
    rows = table.split("\n")
    if len(rows) != len(claims):
        return [f"{len(rows)} rows of the table for {len(claims)} claims"]
    statements = [row.split("|")[1] for row in rows]
    found = [f"|{said}| {claim['held']} of {claim['of']} | {ratio(claim)} |" for said, claim in zip(statements, claims)]
    if write:
        page.write_text(before + head + "\n".join(found) + "\n\n" + rest, encoding="utf-8")
        return []
    return [f"book:  {row}\nstudy: {new}" for row, new in zip(rows, found) if row != new]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("verify", type=Path, nargs="?", metavar="VERIFY.JSON")
    parser.add_argument("--claims", type=Path, metavar="DIR")
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    wrong = numbers_in_prose(given.verify) if given.verify else []
    wrong += table_of_claims(given.claims, given.write) if given.claims else []
    if wrong:
        sys.exit("\n".join(wrong))


if __name__ == "__main__":
    main()
