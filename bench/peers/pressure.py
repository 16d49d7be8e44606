#!/usr/bin/env python3
"""Compares the contact pressures of Carom and Kratos on the same unmatched meshes with exact ones.

    bench/peers/pressure.py CAROM [--decks DECK...] [--install]

CAROM is the program. Prints the table of docs/book/src/verification/mortar.md as Markdown. Both
programs compute Q4 cells of small strains in plane strain with the same nodal loads; the meshes are
written to target/peers-pressure. Kratos comes from PyPI in a virtual environment below target/;
--install installs it.

Of every node of the secondary side, the pressure per deformed area is compared with the exact one
there. The error is that of the largest pressure; RMS is the root of the mean square of the errors,
weighted with half the lengths of the facets beside the node, relative to that of the exact pressure.
"""

import argparse
import csv
import math
import pathlib
import shutil
import subprocess
import sys

from peers import KRATOS, ROOT, VENV, install_python, missing, peer
from pressure_decks import DECKS, lines, write

PLACE = ROOT / "target" / "peers-pressure"
# Largest error of the resultant; it contains that of its integration from the values at the nodes.
# An overlap of the meshes changes the resultant.
BALANCE = 0.03
SECONDARIES = ("upper.bottom", "lower.top")


def carom(program, method, folder):
    """Pressure at the end of the run by node, numbered from 0."""
    out = folder / method
    shutil.rmtree(out, ignore_errors=True)
    options = ["--out", out, "--no-report", "--quiet", "--threads", "1", "--set", f"contact.joint.method={method}"]
    subprocess.run([program, "run", folder / "case.toml", *options], check=True)
    with open(out / "contact.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return {int(row["node"]): float(row["pressure"]) for row in rows if row["time"] == rows[-1]["time"]}


def kratos(deck, folder):
    found = peer(VENV / "bin" / "python", "kratos_pressure.py", folder / "model.mdpa", deck.steps)
    return {int(number) - 1: pressure for number, pressure in found.items()}


def percent(share, sign=""):
    return f"{100 * share:{sign}.2f}" if abs(share) >= 5e-5 else f"{100 * share:{sign}.0e}"


def measure(deck, secondary, pressure):
    """Largest pressure, its error, and RMS, as cells of the table."""
    nodes, points = deck.nodes(secondary)
    square, whole = 0.0, 0.0
    found, expected = 0.0, 0.0
    for k, node in enumerate(nodes):
        length = sum(math.dist(*line) for line in lines(points[max(k - 1, 0) : k + 2])) / 2
        exact = deck.exact(*points[k])
        square += length * (pressure.get(node, 0.0) - exact) ** 2
        whole += length * exact**2
        found += length * pressure.get(node, 0.0)
        expected += length * exact
    if deck.overlap == "refuse" and abs(found / expected - 1) > BALANCE:
        sys.exit(f"the resultant of the pressure is {found / expected:.3f} of the exact one")
    largest = max(pressure.values())
    return [f"{largest:.4g}", percent(largest / deck.highest - 1, "+"), percent(math.sqrt(square / whole))]


def row(program, name, n, secondary):
    deck = DECKS[name][0](n)
    folder = PLACE / f"{name.replace(', ', '-').replace(' ', '-')}-{n}-{secondary}"
    write(deck, secondary, folder)
    along = [f"{body.cells[0]}×{body.cells[1]}" for body in (deck.lower, deck.upper)]
    finer = "finer" if secondary == "upper.bottom" else "coarser"
    cells = [name, " : ".join(along), finer, f"{deck.highest:.4g}"]
    for pressure in (carom(program, "mortar", folder), carom(program, "node-to-segment", folder), kratos(deck, folder)):
        cells += measure(deck, secondary, pressure)
    return cells


def print_row(cells):
    print(f"| {' | '.join(cells)} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("carom", type=pathlib.Path)
    parser.add_argument("--decks", nargs="+", default=list(DECKS), choices=DECKS)
    parser.add_argument("--install", action="store_true")
    options = parser.parse_args()
    if options.install:
        install_python()
    if "Kratos" in missing():
        sys.exit("Kratos not installed: run again with --install")
    version = subprocess.run([options.carom, "--version"], check=True, capture_output=True, text=True).stdout.strip()
    print(f"{version}; {KRATOS[0]}; errors and RMS in %\n")
    methods = ("Carom, mortar", "Carom, node-to-segment", "Kratos")
    header = ["deck", "cells", "secondary", "exact", *(cell for method in methods for cell in (method, "error", "RMS"))]
    print_row(header)
    print_row(["---"] * len(header))
    for name in options.decks:
        for n in DECKS[name][1]:
            for secondary in SECONDARIES:
                print_row(row(options.carom, name, n, secondary))


main()
