#!/usr/bin/env python3
"""Plants faults into Carom one by one and asks `carom verify --fast` to find each: a suite that cannot fail proves nothing.

    python3 scripts/plant_faults.py                 all of them; exit 1 if one is not found
    python3 scripts/plant_faults.py NAME…           those whose name contains one of the words

Works on a copy of the last commit in target/faults with a target directory of its own, one after the other: about two minutes each.
"""
import json
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PLACE = ROOT / "target" / "faults"
TREE = PLACE / "tree"

FAULTS = json.loads((ROOT / "scripts" / "faults.json").read_text())


def build():
    environment = {**os.environ, "CARGO_TARGET_DIR": str(PLACE / "target")}
    done = subprocess.run(["cargo", "build", "-q", "-p", "carom-cli"], cwd=TREE, env=environment, capture_output=True, text=True)
    return done.stderr if done.returncode else None


def verify():
    """Exit code and the rows that were missed."""
    out = PLACE / "verify"
    subprocess.run(["rm", "-rf", out], check=True)
    command = [PLACE / "target" / "debug" / "carom", "verify", "cases", "--fast", "--fail-fast", "--out", out]
    done = subprocess.run(command, cwd=TREE, capture_output=True, text=True)
    missed = [line.strip() for line in (done.stdout + done.stderr).splitlines() if "MISSED" in line or "FAILED" in line]
    return done.returncode, missed


def main():
    words = sys.argv[1:]
    subprocess.run(["rm", "-rf", TREE], check=True)
    TREE.mkdir(parents=True)
    archive = subprocess.run(["git", "archive", "HEAD"], cwd=ROOT, check=True, capture_output=True).stdout
    subprocess.run(["tar", "x", "-C", TREE], input=archive, check=True)
    if error := build():
        sys.exit(f"the tree does not build:\n{error}")
    code, missed = verify()
    if code != 0:
        sys.exit(f"the suite fails without any fault (exit {code}): {missed}")
    print("no fault: the suite passes", flush=True)
    survived = []
    for fault in FAULTS:
        if words and not any(word in fault["name"] for word in words):
            continue
        path, begin = TREE / fault["file"], time.time()
        text = path.read_text()
        if text.count(fault["old"]) != 1:
            sys.exit(f"{fault['name']}: {fault['old']!r} stands {text.count(fault['old'])} times in {fault['file']}, not once")
        path.write_text(text.replace(fault["old"], fault["new"]))
        error = build()
        path_error = error and error.strip().splitlines()[0]
        code, missed = (None, []) if error else verify()
        path.write_text(text)
        seconds = f"{time.time() - begin:.0f} s"
        if error:
            sys.exit(f"{fault['name']}: does not build: {path_error}")
        if code == 0:
            survived.append(fault["name"])
            print(f"SURVIVED  {fault['name']} ({seconds})", flush=True)
        else:
            print(f"found     {fault['name']} ({seconds}): {missed[0] if missed else f'exit {code}'}", flush=True)
    print(f"{len(survived)} survived: {', '.join(survived)}" if survived else "every fault was found")
    sys.exit(1 if survived else 0)


main()
