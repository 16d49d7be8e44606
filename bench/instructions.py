#!/usr/bin/env python3
"""Instructions per call of the benchmarks of some crates, counted by valgrind's callgrind.

    bench/instructions.py [--only NAME] CRATE…      e.g. carom-solid carom-contact carom-algebra carom-run

The count does not depend on the load of the machine. Each benchmark runs twice under callgrind,
with one call and with eleven. A tenth of the difference is the cost of a call, without set-up and
harness. Valgrind supports AVX2 but not AVX-512, so the kernels are those of an ordinary machine.
Needs valgrind (Debian: apt-get install valgrind).
"""

import argparse
import json
import os
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
MORE = 10


def binaries(crates):
    build = ["cargo", "bench", "-q", *(word for crate in crates for word in ("-p", crate)), "--benches", "--no-run", "--message-format=json"]
    for line in subprocess.run(build, cwd=ROOT, check=True, capture_output=True, text=True).stdout.splitlines():
        message = json.loads(line)
        if message.get("executable") and "bench" in message["target"]["kind"]:
            yield message["executable"]


def benchmarks(binary):
    """Paths of the benchmarks, as divan lists them for nextest."""
    listed = subprocess.run([binary, "--list", "--format", "terse"], check=True, capture_output=True, text=True, env={**os.environ, "NEXTEST": "1"}).stdout
    return [line.removesuffix(": benchmark") for line in listed.splitlines() if line.endswith(": benchmark")]


def count(binary, name, calls):
    command = [
        "valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", binary, "--bench", "--exact", name,
        "--sample-count", "1", "--sample-size", str(calls),
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    counted = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or not counted:
        raise RuntimeError(next((line for line in done.stderr.splitlines() if "unhandled" in line), f"exit code {done.returncode}"))
    return int(counted[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="only benchmarks whose name contains this")
    parser.add_argument("crate", nargs="+")
    options = parser.parse_args()
    for binary in binaries(options.crate):
        for name in benchmarks(binary):
            if options.only in name:
                try:
                    counts = f"{(count(binary, name, 1 + MORE) - count(binary, name, 1)) / MORE:14,.0f}"
                except RuntimeError as error:
                    # An older valgrind does not support every AVX instruction.
                    counts = f"not counted: {error}"
                print(f"{name:60} {counts}", flush=True)


main()
