#!/usr/bin/env python3
"""Estimated and measured memory of runs: a table for the book, in Markdown.

    scripts/memory_table.py [--carom PATH] [--only WORD]

Every line is a case of cases/perf with other values, which makes a few steps without a report page.
The estimate is the one of `carom check` (crates/carom-case/src/memory.rs); the peak is the largest
resident size of the process of `carom run`. The exit code is 1 if an estimate and its peak differ by
more than a factor of two.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
FACTOR = 2.0

EXPLICIT = {
    "time.scheme": '{ kind = "central-difference" }',
    "body.block.mass": '"lumped"',
    "time.step": "1e-4",
    "time.end": "1e-3",
}


def block(element, cells, **sets):
    """The block of solid.toml: cells along each edge."""
    size = f"[{cells}, {cells}, {cells}]" if isinstance(cells, int) else str(cells)
    return {"body.block.element": f'"{element}"', "body.block.mesh.cells": size, "time.end": "5.625e-3"} | sets


def blocks(element, cells, **sets):
    """The two blocks of blocks-19k.toml, 4:1."""
    size = f"[{4 * cells}, {cells}]"
    both = {f"body.{body}.{key}": value for body in ("upper", "lower")
            for key, value in (("element", f'"{element}"'), ("mesh.cells", size))}
    return both | {"time.end": "3e-3"} | sets


ITERATIVE = {"newton.linear": '"iterative"'}
DIRECT = {"newton.linear": '"direct"'}
IMPULSES = {"time.scheme": '{ kind = "moreau-jean", theta = 1.0 }'}

# What is solved, case, values.
RUNS = [
    ("explicit, Tet4", "solid.toml", block("Tet4", 16) | EXPLICIT),
    ("explicit, Tet4", "solid.toml", block("Tet4", 40) | EXPLICIT),
    ("explicit, Tet10", "solid.toml", block("Tet10", 12) | EXPLICIT),
    ("explicit, Hex8", "solid.toml", block("Hex8", 24) | EXPLICIT),
    ("iterative, Tet10", "solid.toml", block("Tet10", 11) | ITERATIVE),
    ("iterative, Tet10", "solid.toml", block("Tet10", 20) | ITERATIVE),
    ("iterative, Hex27", "solid.toml", block("Hex27", 10) | ITERATIVE),
    ("iterative, Tet4", "solid.toml", block("Tet4", 24) | ITERATIVE),
    ("iterative, ball, Tet10", "ball-strikes.toml", {"body.ball.mesh.size": "0.08"} | ITERATIVE),
    ("direct, Tet10", "solid.toml", block("Tet10", 6) | DIRECT),
    ("direct, Tet10", "solid.toml", block("Tet10", 11) | DIRECT),
    ("direct, slender, Tet10", "solid.toml",
     block("Tet10", [4, 4, 60]) | {"body.block.mesh.max": "[1, 1, 15]"} | DIRECT),
    ("direct, Hex8", "solid.toml", block("Hex8", 16) | DIRECT),
    ("direct, T10", "disc-2k.toml", {"time.end": "0.04875"}),
    ("direct, T10", "disc-19k.toml", {"time.end": "0.04875"}),
    ("direct, T3", "blocks-19k.toml", blocks("T3", 60)),
    ("direct, Q9", "blocks-19k.toml", blocks("Q9", 40)),
    ("impulses, T10", "disc-19k.toml", {"time.end": "0.04875"} | IMPULSES),
    ("direct, a bar, 4 000 rows", "bar.toml", {}),
]


def arguments(sets):
    return [word for key, value in sets.items() for word in ("--set", f"{key}={value}")]


def estimate(carom, case, sets):
    """Bytes by `carom check`."""
    checked = subprocess.run([carom, "check", "--json", case, *arguments(sets)], capture_output=True, text=True)
    if checked.returncode != 0:
        sys.exit(f"{case}: {checked.stdout}{checked.stderr}")
    event = json.loads(checked.stdout.splitlines()[-1])
    dofs = sum(body["dofs"] for body in event["model"]["bodies"])
    return dofs, sum(event["memory"].values())


def peak(carom, case, sets):
    """Largest resident size in bytes of a run."""
    with tempfile.TemporaryDirectory() as folder:
        command = [carom, "run", case, "--out", f"{folder}/run", "--threads", "1", "--no-report", "-q"]
        process = subprocess.Popen(command + arguments(sets))
        _, status, usage = os.wait4(process.pid, 0)
        if status != 0:
            sys.exit(f"{case}: exit status {status}")
    return 1024 * usage.ru_maxrss


def words(size):
    mebibytes = size / 2**20
    return f"{mebibytes:.0f} MiB" if mebibytes < 1000 else f"{mebibytes / 1024:.2f} GiB"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--carom", default=str(ROOT / "target/release/carom"), help="the program")
    parser.add_argument("--only", default="", help="lines with this word")
    options = parser.parse_args()
    print("| solution | case | unknowns | estimate | peak | estimate/peak |")
    print("| --- | --- | --- | --- | --- | --- |")
    wrong = 0
    for name, file, sets in RUNS:
        if options.only not in name:
            continue
        case = str(ROOT / "cases/perf" / file)
        dofs, expected = estimate(options.carom, case, sets)
        measured = peak(options.carom, case, sets)
        ratio = expected / measured
        wrong += not 1 / FACTOR <= ratio <= FACTOR
        print(f"| {name} | `{file}` | {dofs:_} | {words(expected)} | {words(measured)} | {ratio:.2f} |".replace("_", " "),
              flush=True)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
