#!/usr/bin/env python3
"""Processor time of stepping a case from Python, against `carom run`.

    bench/python_stepping.py [CASE] [--rounds 5] [--carom target/release/carom]

Each round runs the command (one thread, no page) and, in another process, a loop over
`carom.Simulation` that reads y, v, a and the row of every step. Both include reading the case; the
command also writes its record. Prints the medians and their ratio. Needs the package `carom`.
"""

import argparse
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent

LOOP = """
import sys
import carom
simulation = carom.Simulation(carom.Case.from_file(sys.argv[1]), threads=1)
rows = []
for step in simulation:
    rows.append((simulation.row, simulation.y, simulation.v, simulation.a))
    rows = rows[-2:]
"""

NOTHING = "import carom"


def processor_seconds(command):
    """User and system time of a command."""

    def spent():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    before = spent()
    subprocess.run(command, check=True)
    return spent() - before


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("case", nargs="?", default=ROOT / "cases/perf/disc-2k.toml", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--carom", default=ROOT / "target/release/carom", type=pathlib.Path)
    arguments = parser.parse_args()
    times = {"command": [], "Python": []}
    for _ in range(arguments.rounds):
        with tempfile.TemporaryDirectory() as folder:
            out = f"{folder}/run"
            run = [arguments.carom, "-q", "run", arguments.case, "--out", out, "--threads", "1", "--no-report"]
            times["command"].append(processor_seconds(run))
        python = processor_seconds([sys.executable, "-c", LOOP, arguments.case])
        times["Python"].append(python - processor_seconds([sys.executable, "-c", NOTHING]))
    for name, found in times.items():
        print(f"{name:8}{statistics.median(found):8.3f} s  ({min(found):.3f} to {max(found):.3f})")
    ratios = [p / c for p, c in zip(times["Python"], times["command"])]
    print(f"ratio   {statistics.median(ratios):8.3f}    ({min(ratios):.3f} to {max(ratios):.3f})")


if __name__ == "__main__":
    main()
