#!/usr/bin/env python3
"""Draws the results of ladder.py as a map of categories against schemes.

    python scripts/ladder_map.py DIR/results.csv MAP.svg

A cell says how many of its cases are right, and of how many; its shade is their share. Cells with a
wrong case have a thick border.
"""

import csv
import sys
from collections import defaultdict
from pathlib import Path
from xml.sax.saxutils import escape

import ladder_cases
import ladder_space_cases

NAMES = {
    "trapezoidal": "trapezoidal", "chung-hulbert": "Chung–Hulbert", "tr-bdf2": "TR-BDF2", "bathe": "Bathe",
    "energy-mom": "energy–mom.", "central-diff": "central diff.", "paoli": "Paoli–Sch.",
    "moreau-jean": "Moreau–Jean", "ns-alpha": "nonsmooth α", "static": "load steps",
}
WIDTH, HEIGHT, LEFT, TOP = 74, 30, 120, 62


def shade(share):
    """From dark orange (0) over white to blue (1), readable in print and with colour blindness."""
    low, high = (217, 95, 2), (158, 202, 225)
    a, b, t = (low, (255, 255, 255), share / 0.5) if share < 0.5 else ((255, 255, 255), high, (share - 0.5) / 0.5)
    return "#" + "".join(f"{round(x + (y - x) * t):02x}" for x, y in zip(a, b))


def main(results, out):
    cells = defaultdict(list)
    with open(results, newline="") as file:
        for row in csv.DictReader(file):
            for key in [(row["category"], row["family"]), (row["category"], "all"), ("all", row["family"]), ("all", "all")]:
                cells[key].append(row["outcome"])
    columns = [*(f for f in ladder_space_cases.FAMILIES if cells.get(("all", f))), "all"]
    rows = [*(c for c in {**ladder_cases.CATEGORIES, **ladder_space_cases.CATEGORIES} if cells.get((c, "all"))), "all"]
    width, height = LEFT + WIDTH * len(columns) + 10, TOP + HEIGHT * len(rows) + 10
    svg = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
        'font-family="DejaVu Sans, Helvetica, Arial, sans-serif" font-size="12">',
        "<title>Cases of the ladder that finish and are right, of all</title>",
        f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
    ]
    for i, column in enumerate(columns):
        x, y = LEFT + WIDTH * (i + 0.5), TOP - 8
        svg.append(f'<text x="{x:.0f}" y="{y}" transform="rotate(-25 {x:.0f} {y})">{escape(NAMES.get(column, column))}</text>')
    for j, row in enumerate(rows):
        y = TOP + HEIGHT * j
        svg.append(f'<text x="{LEFT - 8}" y="{y + 19}" text-anchor="end">{escape(row.replace("-", " "))}</text>')
        for i, column in enumerate(columns):
            outcomes = cells.get((row, column), [])
            if not outcomes:
                continue
            right, bad = outcomes.count("right"), any(o in ("wrong", "crash", "timeout") for o in outcomes)
            border = 'stroke="#000000" stroke-width="3"' if bad else 'stroke="#888888" stroke-width="0.5"'
            x = LEFT + WIDTH * i
            svg.append(f'<rect x="{x + 1}" y="{y + 1}" width="{WIDTH - 2}" height="{HEIGHT - 2}" fill="{shade(right / len(outcomes))}" {border}/>')
            svg.append(f'<text x="{x + WIDTH / 2:.0f}" y="{y + 19}" text-anchor="middle">{right} / {len(outcomes)}</text>')
    Path(out).write_text("\n".join([*svg, "</svg>", ""]))


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
