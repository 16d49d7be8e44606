#!/usr/bin/env python3
"""Plants faults into Carom one by one and checks that each of them is detected.

    scripts/plant_faults.py [WORD…] [--markdown FILE]
        all faults, or those whose names contain a word; exit code 1 if one is not detected
    scripts/plant_faults.py --check
        whether each fault still fits the source, and is in the book's table and in README's number,
        without building anything

A fault of scripts/faults.json replaces one string of one file by another; the string must occur
exactly once. The faults are planted in target/faults, in a copy of the last commit with its own
target directory. Each fault costs the compilation of the crates above it and, if a short case
detects it, a few seconds. First `carom verify --fast --fail-fast` is run; a fault that it does not
detect is tested with the whole suite. What no case expects, such as the ranking of a study or a
warning, the tests of the package `tests` must detect.
"""

import argparse
import fcntl
import io
import itertools
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PLACE = ROOT / "target/faults"
TREE = PLACE / "tree"
FAULTS = json.loads((ROOT / "scripts/faults.json").read_text(encoding="utf-8"))

# Seconds. A fault may also prevent a run from ending.
PATIENCE = 1800


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("words", nargs="*", metavar="WORD", help="only faults whose names contain one of these")
    options.add_argument("--check", action="store_true", help="only check whether every fault fits the source")
    options.add_argument("--markdown", type=pathlib.Path, metavar="FILE", help="write the table here too")
    given = options.parse_args()
    if unfit := [f"{fault['name']}: {why}" for fault in FAULTS if (why := misfit(ROOT, fault))]:
        sys.exit("\n".join(unfit))
    if stale := undocumented():
        sys.exit(stale)
    if given.check:
        print(f"{len(FAULTS)} faults fit the source")
        return
    PLACE.mkdir(parents=True, exist_ok=True)
    lock = (PLACE / "lock").open("w")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        sys.exit(f"faults are being planted in {PLACE} already")
    copy()
    if error := build():
        sys.exit(f"the tree does not build:\n{error}")
    if missed := verified("--fast"):
        sys.exit(f"the suite fails without any fault: {missed}")
    packages = {fault["tests"] for fault in FAULTS if "tests" in fault and wanted(given, fault)}
    for package in sorted(packages):
        if failed := tested(package):
            sys.exit(f"the tests of {package} fail without any fault: {failed}")
    print("no fault: the suite passes", flush=True)
    rows, survived = [], []
    for fault in FAULTS:
        if not wanted(given, fault):
            continue
        begin, found = time.time(), planted(fault)
        print(f"{'found   ' if found else 'SURVIVED'}  {fault['name']}  ({time.time() - begin:.0f} s)  {found or ''}", flush=True)
        rows.append([fault["name"], place(fault), found or "survived"])
        if not found:
            survived.append(fault["name"])
    if given.markdown:
        lines = [["Fault", "In", "Found by"], ["---"] * 3, *rows]
        # A file is in code, where only a bar needs to be escaped.
        escaped = lambda cell: re.sub(r"[|]" if cell.startswith("`") else r"[|*_]", r"\\\g<0>", cell)
        lines = [" | ".join(map(escaped, line)) for line in lines]
        given.markdown.write_text("".join(f"| {line} |\n" for line in lines), encoding="utf-8")
    print(f"{len(rows)} faults, {len(survived)} survived{': ' + ', '.join(survived) if survived else ''}")
    sys.exit(1 if survived else 0)


def wanted(given, fault):
    return not given.words or any(word in fault["name"] for word in given.words)


def undocumented():
    """What the book's table or README say of other faults than these; None if they agree."""
    table = (ROOT / "docs/book/src/verification/faults.md").read_text(encoding="utf-8").splitlines()[2:]
    told = [line.removeprefix("| ").split(" | ")[:2] for line in table]
    for fault, row in itertools.zip_longest(FAULTS, told):
        here = fault and [fault["name"], place(fault)]
        if here != row:
            return f"faults.md has the row {row} where faults.json has {here}"
    count = re.search(r"(\d+)\s+faults", (ROOT / "README.md").read_text(encoding="utf-8"))
    if not count or int(count[1]) != len(FAULTS):
        return f"README.md does not say {len(FAULTS)} faults"
    return None


def place(fault):
    return f"`{pathlib.Path(fault['file']).relative_to('crates')}`"


def misfit(tree, fault):
    """Why a fault cannot be planted; None if it can."""
    path = tree / fault["file"]
    if not path.is_file():
        return f"there is no {fault['file']}"
    count = path.read_text(encoding="utf-8").count(fault["old"])
    return None if count == 1 else f"{fault['old']!r} occurs {count} times in {fault['file']}, not once"


def copy():
    """Copies the last commit to TREE.

    Unchanged files are not written again, so that only what differs is rebuilt.
    """
    archive = subprocess.run(["git", "archive", "HEAD"], cwd=ROOT, check=True, capture_output=True).stdout
    with tarfile.open(fileobj=io.BytesIO(archive)) as files:
        wanted = {TREE / member.name: files.extractfile(member).read() for member in files if member.isfile()}
    for path in TREE.rglob("*"):
        if path.is_file() and path not in wanted:
            path.unlink()
    for path, content in wanted.items():
        if not path.is_file() or path.read_bytes() != content:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)


def cargo(what, package):
    environment = {**os.environ, "CARGO_TARGET_DIR": str(PLACE / "target"), "CARGO_INCREMENTAL": "1"}
    command = ["cargo", what, "--quiet", "--package", package]
    return subprocess.run(command, cwd=TREE, env=environment, capture_output=True, text=True, check=False)


def build():
    """The error output of the compiler, or None."""
    done = cargo("build", "carom")
    return done.stderr if done.returncode else None


def tested(package):
    """The first test of a package that fails, or None."""
    done = cargo("test", package)
    if done.returncode == 0:
        return None
    failed = re.search(r"^---- (\S+) stdout ----$", done.stdout, re.MULTILINE)
    return f"test {package} {failed[1]}" if failed else shortened((done.stderr.strip().splitlines() or ["no message"])[0])


def verified(*which):
    """The first missed expectation or another failure of the suite; None if it passes."""
    out = PLACE / "verify"
    shutil.rmtree(out, ignore_errors=True)
    command = [PLACE / "target/debug/carom", "verify", "cases", *which, "--fail-fast", "--out", out]
    try:
        done = subprocess.run(command, cwd=TREE, capture_output=True, text=True, timeout=PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        return f"not finished within {PATIENCE} s"
    if done.returncode == 0:
        return None
    if done.returncode in (1, 3):
        for set_up in json.loads((out / "verify.json").read_text(encoding="utf-8"))["set_ups"]:
            name = f"{set_up['family']}/{set_up['name']}"
            if set_up["stopped"]:
                return f"{name}: stopped, {shortened(set_up['stopped'][0])}"
            for row in set_up["rows"]:
                if not row["pass"]:
                    digits = 15 if (row["tolerance"] or 1.0) < 1e-6 else 5
                    got = row["why"] if row["got"] is None else f"{row['got']:.{digits}g}"
                    of = f" of \"{row['arm']}\"" if row["arm"] else ""
                    return f"{name}: {row['what']}{of}, expected {row['expected']}, got {got}"
    said = (done.stderr.strip().splitlines() or ["no message"])[0]
    return f"exit code {done.returncode}: {shortened(said)}"


def shortened(text):
    return text if len(text) < 140 else f"{text[:140].rsplit(' ', 1)[0]} …"


def planted(fault):
    """The result of the suite with a fault in the tree; the tree is restored afterwards."""
    path = TREE / fault["file"]
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace(fault["old"], fault["new"]), encoding="utf-8")
    try:
        if error := build():
            sys.exit(f"{fault['name']}: does not build:\n{error}")
        return tested(fault["tests"]) if "tests" in fault else verified("--fast") or verified()
    finally:
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
