#!/usr/bin/env python3
"""Compares the book's table of the paper's statements with the study that computes it.

    carom study cases/paper/claims.toml --out runs/claims
    scripts/check_claims.py runs/claims [--write]

Rows are in the order of the study's claims. `--write` puts the study's numbers into the table.
"""

import csv
import pathlib
import sys

PAGE = pathlib.Path(__file__).parent.parent / "docs/book/src/verification/paper.md"
HEAD = "| Statement | Members that confirm it | Ratio |\n| --- | --- | --- |\n"


def ratio(claim: dict) -> str:
    """Median, least and largest ratio, with two digits, or as many as tell them apart."""
    values = [float(claim[key]) for key in ("ratio", "ratio_low", "ratio_high")]
    digits = 5 if max(values) - min(values) < 0.01 * max(values) else 2
    median, low, high = (f"{value:#.{digits}g}".rstrip(".") for value in values)
    return f"{median} ({low} to {high})"


def main() -> str | None:
    place, write = pathlib.Path(sys.argv[1]), "--write" in sys.argv
    with open(place / "claims.csv", newline="", encoding="utf-8") as file:
        claims = list(csv.DictReader(file))
    text = PAGE.read_text(encoding="utf-8")
    before, after = text.split(HEAD)
    table, rest = after.split("\n\n", 1)
    rows = table.split("\n")
    if len(rows) != len(claims):
        return f"{len(rows)} rows of the table for {len(claims)} claims"
    found = []
    for row, claim in zip(rows, claims, strict=True):
        statement = row.split("|")[1]
        found.append(f"|{statement}| {claim['held']} of {claim['of']} | {ratio(claim)} |")
    if write:
        PAGE.write_text(before + HEAD + "\n".join(found) + "\n\n" + rest, encoding="utf-8")
        return None
    wrong = [f"book:  {row}\nstudy: {new}" for row, new in zip(rows, found, strict=True) if row != new]
    return "\n".join(wrong) or None


sys.exit(main())
