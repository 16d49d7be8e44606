#!/usr/bin/env python3
"""What stepping a case from Python costs, against `carom run`.

    bench/python_stepping.py [CASE] [--rounds 10] [--carom target/release/carom] [--instructions]

Each round runs the command (one thread, no page) and, in another process, a loop over
`carom.Simulation` that reads y, v, a and the row of every step. Both include reading the case; the
command also writes its record. Prints the medians of their processor times and the median of the
ratios. With --instructions both are counted per step by valgrind's cachegrind, whatever the load of
the machine, as the difference of two lengths of the run. Needs the package `carom`.
"""

import argparse
import os
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent

LOOP = """
import sys
import carom
case = carom.Case.from_file(sys.argv[1])
if len(sys.argv) > 2:
    case.set("time.end", float(sys.argv[2]))
simulation = carom.Simulation(case, threads=1)
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


def command(carom, case, out, *options):
    """The command line of a run that writes its record only."""
    return [carom, "-q", "run", case, "--out", out, "--threads", "1", "--no-report", *options]


def instructions(words):
    counting = ["valgrind", "--tool=cachegrind", "--cache-sim=no", f"--cachegrind-out-file={os.devnull}"]
    told = subprocess.run([*counting, *words], capture_output=True, text=True, check=True).stderr
    return int(re.search(r"I *refs: *([\d,]+)", told)[1].replace(",", ""))


def count(case, carom):
    """Prints the instructions per step of both, from runs of 60 and of 120 steps."""
    import carom as package

    step = package.Case.from_file(case).resolved()["time"]["step"]
    counts = {"command": [], "Python": []}
    for end in (repr(60 * step), repr(120 * step)):
        with tempfile.TemporaryDirectory() as folder:
            words = command(carom, case, f"{folder}/run", "--set", f"time.end={end}")
            counts["command"].append(instructions(words))
        counts["Python"].append(instructions([sys.executable, "-c", LOOP, case, end]))
    each = {name: (long - short) / 60 for name, (short, long) in counts.items()}
    for name, found in each.items():
        print(f"{name:8}{found / 1e6:8.2f} million instructions per step")
    print(f"ratio   {each['Python'] / each['command']:8.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("case", nargs="?", default=ROOT / "cases/perf/disc-2k.toml", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=10)
    parser.add_argument("--carom", default=ROOT / "target/release/carom", type=pathlib.Path)
    parser.add_argument("--instructions", action="store_true")
    arguments = parser.parse_args()
    if arguments.instructions:
        count(arguments.case, arguments.carom)
        return
    times = {"command": [], "Python": []}
    for _ in range(arguments.rounds):
        with tempfile.TemporaryDirectory() as folder:
            run = command(arguments.carom, arguments.case, f"{folder}/run")
            times["command"].append(processor_seconds(run))
        python = processor_seconds([sys.executable, "-c", LOOP, arguments.case])
        times["Python"].append(python - processor_seconds([sys.executable, "-c", NOTHING]))
    for name, found in times.items():
        print(f"{name:8}{statistics.median(found):8.3f} s  ({min(found):.3f} to {max(found):.3f})")
    ratios = [p / c for p, c in zip(times["Python"], times["command"])]
    print(f"ratio   {statistics.median(ratios):8.3f}    ({min(ratios):.3f} to {max(ratios):.3f})")


if __name__ == "__main__":
    main()
