#!/usr/bin/env python3
"""The performance job with Carom and its peers, in turn on one core: ratios in one run, physics side by side.

    bench/peers/compare.py [--rounds N] [--steps N] [--rings 4 12] [--install]

GetFEM comes from Debian (python3-getfem; --install asks apt for it). Carom is target/release/carom. CPU seconds of the process per step; with few steps
the set-up of Carom is in its figure, that of GetFEM is not.
"""

import argparse
import json
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
CASES = {4: "disc-2k", 12: "disc-19k"}
ONE = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
PYTHON = "/usr/bin/python3"


def pinned(command):
    return ["taskset", "-c", "0", *command]


def carom(rings, steps):
    case = ROOT / "cases" / "perf" / f"{CASES[rings]}.toml"
    with tempfile.TemporaryDirectory() as place:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        out = pathlib.Path(place) / "run"
        command = [ROOT / "target/release/carom", "run", case, "--out", out, "--no-report"]
        subprocess.run(pinned([*map(str, command), "--set", f"time.end={steps * 1.875e-3}"]), check=True, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        manifest = json.loads((out / "manifest.json").read_text())
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    got = {e["what"]: e["got"] for e in manifest["expectations"]}
    return {
        "code": "Carom", "cpu_per_step": cpu / steps, "newton": manifest["counters"]["newton"] / steps,
        "peak_mean_force": got.get("peak_mean_force"), "rebound": got.get("last disc.velocity_y"),
    }


def getfem(rings, steps):
    # Quadratic triangles: half again as many rings have the same nodes as cubic ones.
    command = [PYTHON, str(HERE / "getfem_job.py"), str(rings * 3 // 2), str(steps)]
    done = subprocess.run(pinned(command), check=True, capture_output=True, env=ONE, text=True)
    return json.loads(done.stdout.strip().splitlines()[-1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--steps", type=int, default=400)
    parser.add_argument("--rings", type=int, nargs="+", default=[4, 12], choices=sorted(CASES))
    parser.add_argument("--install", action="store_true")
    options = parser.parse_args()
    if options.install:
        subprocess.run(["apt-get", "install", "-yq", "--no-install-recommends", "python3-getfem"], check=True)
    if subprocess.run([PYTHON, "-c", "import getfem"], capture_output=True).returncode:
        sys.exit("python3-getfem is not installed: run again with --install, or apt-get install python3-getfem")
    print(f"{'dofs':>7} {'code':8} {'ms/step':>9} {'Newton':>7} {'peak force':>11} {'rebound':>8}   ratio")
    for rings in options.rings:
        rows = {"Carom": [], "GetFEM": []}
        for _ in range(options.rounds):
            for run in (carom, getfem):
                row = run(rings, options.steps)
                rows[row["code"]].append(row)
        dofs = rows["GetFEM"][0]["dofs"]
        median = {code: statistics.median(r["cpu_per_step"] for r in found) for code, found in rows.items()}
        ratios = [b["cpu_per_step"] / a["cpu_per_step"] for a, b in zip(rows["Carom"], rows["GetFEM"])]
        for code, found in rows.items():
            force, rebound = (f"{found[0][k]:.2f}" if found[0][k] is not None else "-" for k in ("peak_mean_force", "rebound"))
            ratio = f"{statistics.median(ratios):.1f}" if code == "GetFEM" else "1"
            print(f"{dofs:7} {code:8} {1e3 * median[code]:9.2f} {found[0]['newton']:7.1f} {force:>11} {rebound:>8}   {ratio}")


main()
