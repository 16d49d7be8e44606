#!/usr/bin/env python3
"""Compares the speed and results of Carom, GetFEM and Kratos on the performance job.

    bench/peers/compare.py [--rounds N] [--steps N] [--rings 4 12] [--carom PATH] [--install]

The codes run in turn on one core. GetFEM comes from Debian (python3-getfem); Kratos comes from PyPI
and is installed in a virtual environment below target/. --install installs both. Carom is
target/release/carom.

The time is the processor time of the process per step. Everything before the first step (reading,
meshing, analysis, imports) is excluded for all codes: the peers read their clock before the first
step, and for Carom the time of a run of one step is subtracted. The ratio is that of Carom's speed
to the peer's in the same round; the median over the rounds is printed. Forces and velocities are
computed by one formula from the velocity of the disc after every step. With fewer than 400 steps
the last velocity is not the rebound velocity.
"""

import argparse
import csv
import datetime
import json
import os
import pathlib
import platform
import statistics
import sys
import tempfile

import job
from peers import DEBIAN, ROOT, VENV, install, missing, peer, timed

CASES = {4: "disc-2k", 12: "disc-19k"}


def carom_run(binary, rings, steps, out):
    """CPU seconds and memory in KiB of a run."""
    case = ROOT / "cases" / "perf" / f"{CASES[rings]}.toml"
    command = [binary, "run", case, "--out", out, "--no-report", "--threads", 1, "--set", f"time.end={steps * job.DT}"]
    return timed(command)


def carom(options, rings, steps):
    with tempfile.TemporaryDirectory() as place:
        place = pathlib.Path(place)
        first, _ = carom_run(options.carom, rings, 1, place / "first")
        whole, memory = carom_run(options.carom, rings, steps, place / "run")
        manifest = json.loads((place / "run" / "manifest.json").read_text())
        with open(place / "run" / "history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
    velocity = [float(row["disc.velocity_y"]) for row in rows]
    mass = 2 * float(rows[0]["kinetic"]) / velocity[0] ** 2
    return {
        "code": "Carom", "set_up": first, "cpu_per_step": (whole - first) / (steps - 1), "memory_kib": memory,
        "newton": manifest["counters"]["newton"] / steps,
        "peak_mean_force": job.peak_mean_force(mass, velocity), "rebound": velocity[-1],
    }


# Quadratic triangles need 1.5 times as many rings as cubic ones for the same nodes, linear ones 3
# times as many.
RUNS = {
    "Carom": carom,
    "GetFEM": lambda _, rings, steps: peer(DEBIAN, "getfem_job.py", rings * 3 // 2, steps),
    "Kratos": lambda _, rings, steps: peer(VENV / "bin" / "python", "kratos_job.py", rings * 3, steps),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--steps", type=int, default=400)
    parser.add_argument("--rings", type=int, nargs="+", default=[4, 12], choices=sorted(CASES))
    parser.add_argument("--carom", type=pathlib.Path, default=ROOT / "target" / "release" / "carom")
    parser.add_argument("--install", action="store_true")
    options = parser.parse_args()
    if options.install:
        install()
    if lacking := list(missing()):
        sys.exit(f"{' and '.join(lacking)} not installed: run again with --install")
    load = os.getloadavg()[0]
    print(f"{datetime.date.today()}, {platform.machine()}, {os.cpu_count()} cores, load {load:.1f}; {options.steps} steps, {options.rounds} rounds")
    print(f"{'dofs':>7} {'code':8} {'ms/step':>9} {'set-up s':>9} {'MiB':>5} {'Newton':>7} {'peak force':>11} {'velocity':>9} {'ratio':>7}  of the rounds")
    for rings in options.rings:
        rows = {code: [] for code in RUNS}
        for _ in range(options.rounds):
            for code, run in RUNS.items():
                rows[code].append(run(options, rings, options.steps))
        dofs = rows["GetFEM"][0]["dofs"]
        for code, found in rows.items():
            ratios = [b["cpu_per_step"] / a["cpu_per_step"] for a, b in zip(rows["Carom"], found)]
            cpu, set_up = (statistics.median(r[k] for r in found) for k in ("cpu_per_step", "set_up"))
            first = found[0]
            force = f"{first['peak_mean_force']:.2f}" if first["peak_mean_force"] is not None else "-"
            print(
                f"{dofs:7} {code:8} {1e3 * cpu:9.2f} {set_up:9.2f} {first['memory_kib'] / 1024:5.0f} {first['newton']:7.1f} {force:>11} {first['rebound']:9.3f} "
                f"{statistics.median(ratios):7.1f}  {' '.join(f'{r:.1f}' for r in ratios)}",
                flush=True,
            )


main()
