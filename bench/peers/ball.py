#!/usr/bin/env python3
"""Compares the speed and results of Carom, GetFEM and Kratos on a ball that strikes a block in
space.

    bench/peers/ball.py [--sizes S M] [--codes CODE...] [--rounds N] [--window 3 10] [--steps N]
                        [--limit SECONDS] [--carom PATH] [--install]

The job is cases/space/ball.toml with meshes of Gmsh, which are written to target/peers-ball. The
cells are Tet10, or Tet4 on the same nodes: GetFEM computes the former, Kratos the latter, Carom
both. The codes run in turn on one core. GetFEM comes from Debian (python3-getfem), Kratos and Gmsh
from PyPI in a virtual environment below target/. --install installs all of them. Carom is
target/release/carom.

The time is the processor time of the process per step of the window of steps, which are numbered
from 1; contact begins within the second step. The peers read their clock at both ends of the
window; for Carom the time of a run that ends before the window is subtracted. The ratio is that of
the speed of Carom with Tet10 to that of the code in the same round; the median over the rounds is
printed. Forces (of the whole ball, four times the quarter) and velocities are computed by one
formula from the velocity of the ball after every step, and the velocity is the last one: after
contact if --steps is 140 (--window 3 128 then comprises the whole contact). With --limit, a peer
that takes longer is left out.

Each code stops its iterations by its own criterion: Carom at its default, 1e-9 of the sum of the
forces and of the length; GetFEM at a residual of 1e-8 of the forces; Kratos at a residual of 1e-4
of the first one in the step, its default.
"""

import argparse
import csv
import datetime
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile

import ball_job as job
from peers import DEBIAN, ROOT, VENV, install, missing, peer, timed

MESHES = ROOT / "target" / "peers-ball"
CASE = ROOT / "cases" / "space" / "ball.toml"
SIZES = ("XS", "S", "M", "L")


def mesh(size, element):
    path = MESHES / f"{size}-{element}.msh"
    if not path.exists():
        MESHES.mkdir(parents=True, exist_ok=True)
        subprocess.run([VENV / "bin" / "python", pathlib.Path(__file__).with_name("ball_mesh.py"), size, MESHES], check=True)
    return path


def carom_run(options, size, element, steps, out):
    """CPU seconds, memory in KiB and Newton iterations of a run."""
    command = [options.carom, "run", CASE, "--out", out, "--no-report", "--quiet", "--threads", 1, "--set", f"time.end={steps * job.DT}"]
    command += ["--set", "output.fields_every=0"]
    for body in ("ball", "block"):
        command += ["--set", f"body.{body}.element={element}"]
        command += ["--set", f"body.{body}.mesh={{ file = {json.dumps(str(mesh(size, element)))}, volume = \"{body}\" }}"]
    cpu, memory = timed(command)
    return cpu, memory, json.loads((out / "manifest.json").read_text())["counters"]["newton"]


def carom(element):
    def run(options, size):
        first, last = options.window
        with tempfile.TemporaryDirectory() as place:
            place = pathlib.Path(place)
            before, _, newton_before = carom_run(options, size, element, first - 1, place / "before")
            cpu, memory, newton = carom_run(options, size, element, last, place / "run")
            if options.steps > last:
                _, memory, _ = carom_run(options, size, element, options.steps, place / "whole")
            with open(place / ("whole" if options.steps > last else "run") / "history.csv", newline="") as file:
                rows = list(csv.DictReader(file))
        velocity = [float(row["ball.velocity_z"]) for row in rows]
        mass = 4 * 2 * float(rows[0]["kinetic"]) / velocity[0] ** 2
        return {
            "dofs": job.Mesh(mesh(size, element)).dofs, "unconverged": 0, "cpu_per_step": (cpu - before) / (last - first + 1), "memory_kib": memory,
            "newton": (newton - newton_before) / (last - first + 1), "peak_mean_force": job.peak_mean_force(mass, velocity), "velocity": velocity[-1],
        }
    return run


def other(python, script, element):
    return lambda options, size: peer(python, script, mesh(size, element), options.steps, *options.window, limit=options.limit)


CODES = {
    "Carom-Tet10": carom("Tet10"),
    "Carom-Tet4": carom("Tet4"),
    "GetFEM": other(DEBIAN, "ball_getfem.py", "Tet10"),
    "Kratos": other(VENV / "bin" / "python", "ball_kratos.py", "Tet4"),
}
FIRST = "Carom-Tet10"


def compare(options, size):
    rows = {code: [] for code in options.codes}
    for _ in range(options.rounds):
        for code, found in rows.items():
            found.append(CODES[code](options, size))
    for code, found in rows.items():
        if None in found:
            print(f"{'':7} {code:11} no result within {options.limit:.0f} s", flush=True)
            continue
        cpu, newton = (statistics.median(row[key] for row in found) for key in ("cpu_per_step", "newton"))
        reference = rows.get(FIRST, [])
        ratios = [b["cpu_per_step"] / a["cpu_per_step"] for a, b in zip(reference, found)]
        ratio = f"{statistics.median(ratios):7.1f}  {' '.join(f'{r:.1f}' for r in ratios)}" if ratios else f"{'-':>7}"
        one = found[0]
        force = f"{one['peak_mean_force']:.3f}" if one["peak_mean_force"] is not None else "-"
        note = f"; {one['unconverged']} steps did not converge" if one["unconverged"] else ""
        print(f"{one['dofs']:7} {code:11} {cpu:9.3f} {one['memory_kib'] / 1024:5.0f} {newton:7.1f} {force:>11} {one['velocity']:9.4f} {ratio}{note}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", nargs="+", default=["S", "M"], choices=SIZES)
    parser.add_argument("--codes", nargs="+", default=list(CODES), choices=CODES)
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--window", type=int, nargs=2, default=[3, 10], metavar=("FIRST", "LAST"))
    parser.add_argument("--steps", type=int)
    parser.add_argument("--limit", type=float)
    parser.add_argument("--carom", type=pathlib.Path, default=ROOT / "target" / "release" / "carom")
    parser.add_argument("--install", action="store_true")
    options = parser.parse_args()
    options.steps = max(options.steps or 0, options.window[1])
    if options.install:
        install("gmsh==4.15.2")
    if lacking := list(missing(Gmsh="gmsh")):
        sys.exit(f"{' and '.join(lacking)} not installed: run again with --install")
    first, last = options.window
    load = os.getloadavg()[0]
    print(f"{datetime.date.today()}, {platform.machine()}, {os.cpu_count()} cores, load {load:.1f}; steps {first} to {last} of {options.steps}, rounds: {options.rounds}")
    print(f"{'dofs':>7} {'code':11} {'s/step':>9} {'MiB':>5} {'Newton':>7} {'peak force':>11} {'velocity':>9} {'ratio':>7}  of the rounds")
    for size in options.sizes:
        compare(options, size)


main()
