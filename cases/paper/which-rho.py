#!/usr/bin/env python3
"""Figure and numbers of the study cases/paper/which-rho.toml: averaged stress, its noise, trajectory and
energy by method, with their intervals.

    cases/paper/which-rho.py STUDY [FIGURE.svg]

Prints the recommendations, and the values of all methods for every step and method of contact.
"""

import csv
import json
import sys
from pathlib import Path

PANES = [
    ("stress", "error", "averaged stress: error", "share of the reference, r.m.s."),
    ("stress", "noise", "stress: noise", "share of the reference, r.m.s."),
    ("trajectory", "error", "trajectory: error", "share of the largest displacement"),
    ("energy", "error", "energy dissipated or created", "share of the energy scale"),
]
# Okabe and Ito's colours, which the colour-blind tell apart.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#D55E00"]


def rows(study):
    with open(study / "ranking.csv", newline="") as table:
        return list(csv.DictReader(table))


def named(row):
    """The method without that of contact."""
    return row["method"].removesuffix(", mortar")


def order(method):
    """Chung and Hulbert's scheme by ρ∞ first."""
    rho = method.removeprefix("ρ∞ = ")
    return (rho == method, float(rho) if rho != method else 0.0, method)


def draw(found, figure):
    import matplotlib.pyplot as plt

    plt.rcParams["svg.fonttype"] = "none"
    plt.rcParams["svg.hashsalt"] = "which-rho"
    methods = sorted({named(row) for row in found}, key=order)
    series = sorted({(row["method"].endswith(", mortar"), row["level"]) for row in found})
    picture, panes = plt.subplots(2, 2, figsize=(10, 7.4), sharex=True)
    for pane, (goal, value, title, unit) in zip(panes.flat, PANES):
        for k, (mortar, level) in enumerate(series):
            own = [
                row
                for row in found
                if row["goal"] == goal and row["level"] == level and row["method"].endswith(", mortar") == mortar
                and row[value]
            ]
            x = [methods.index(named(row)) + 0.16 * (k - 1.5) for row in own]
            y = [float(row[value]) for row in own]
            bars = None
            if value == "error":
                bars = [[b - float(row["error_low"]) for row, b in zip(own, y)], [float(row["error_high"]) - b for row, b in zip(own, y)]]
            step = max((f"{float(row['step']):g}" for row in own), key=float, default="")
            label = f"{'mortar' if mortar else 'node-to-segment'}, Δt = {step}"
            marker = "s" if mortar else "o"
            pane.errorbar(x, y, bars, fmt=marker, ms=4, lw=0.8, label=label, color=COLOURS[k])
        if goal == "energy":
            pane.set_yscale("log")
        pane.set_title(title, fontsize=10)
        pane.set_ylabel(unit, fontsize=9)
        pane.set_xticks(range(len(methods)), methods, rotation=60, ha="right", fontsize=8)
        pane.grid(alpha=0.3)
    marks, labels = panes.flat[0].get_legend_handles_labels()
    plt.tight_layout(rect=(0, 0, 1, 0.96))
    picture.legend(marks, labels, loc="upper center", ncols=4, fontsize=9, frameon=False)
    plt.savefig(figure, metadata={"Date": None} if str(figure).endswith(".svg") else None)


def main():
    study = Path(sys.argv[1])
    found = rows(study)
    for verdict in json.loads((study / "verdict.json").read_text()):
        print(f"{verdict['goal']}: {verdict['recommended']} ({verdict['confidence']}), error {verdict['error']}")
        print(f"  {'; '.join(verdict['reasons'] + verdict['doubts'])}")
    for goal, value, title, _ in PANES:
        for level in sorted({row["level"] for row in found}):
            for mortar in (False, True):
                own = [
                    row
                    for row in found
                    if (row["goal"], row["level"]) == (goal, level)
                    and row["method"].endswith(", mortar") == mortar
                    and row[value]
                ]
                own.sort(key=lambda row: float(row[value]))
                words = [
                    f"{named(row)} {float(row[value]):.3g}"
                    + (f" [{float(row['error_low']):.2g}, {float(row['error_high']):.2g}]" if value == "error" else "")
                    for row in own
                ]
                print(f"\n{title}, level {level}{', mortar' if mortar else ''}: " + "; ".join(words))
    if len(sys.argv) > 2:
        draw(found, sys.argv[2])


if __name__ == "__main__":
    main()
