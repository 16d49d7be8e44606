#!/usr/bin/env python3
"""Lists the warnings of the cases and studies of the repository, to examine each of them.

    scripts/list_warnings.py CAROM [--run SECONDS] [PATH…]
        those before a run, of `carom check`; with --run also those of the records of the cases that
        end within so many seconds. PATH: files or folders, by default cases and docs/book.

One line for each warning: its name, the case, its place and what was found. The last lines count
the cases and the warnings.
"""

import argparse
import collections
import json
import pathlib
import subprocess
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent


def files(paths):
    for path in map(pathlib.Path, paths):
        yield from sorted(path.rglob("*.toml")) if path.is_dir() else [path]


def checked(carom, path):
    """The warnings of `carom check`, each with the number of its arms; none if it is no case."""
    done = subprocess.run([carom, "check", "--json", path], capture_output=True, text=True)
    if done.returncode != 0:
        return None
    event = json.loads(done.stdout.splitlines()[-1])
    return event["warnings"]


def recorded(carom, path, seconds):
    """The warnings in the manifest of a run; none if it does not end in time."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "run"
        command = [carom, "run", path, "-q", "--threads", "1", "--out", out, "--set", "output.fields_every=0"]
        try:
            subprocess.run(command, capture_output=True, timeout=seconds)
            manifest = json.loads((out / "manifest.json").read_text(encoding="utf-8"))
        except (subprocess.TimeoutExpired, OSError):
            return None
        return manifest.get("warnings", []) if manifest["status"] in ("finished", "failed") else None


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("carom", type=pathlib.Path)
    parser.add_argument("--run", type=float, metavar="SECONDS")
    parser.add_argument("paths", nargs="*", default=[ROOT / "cases", ROOT / "docs/book"])
    arguments = parser.parse_intermixed_args()
    carom, counts = arguments.carom.resolve(), collections.Counter()
    for path in files(arguments.paths):
        is_study = "case" in tomllib.loads(path.read_text(encoding="utf-8"))
        warnings = checked(carom, path)
        if warnings is None:
            continue
        counts["checked"] += 1
        if arguments.run and not is_study:
            of_run = recorded(carom, path, arguments.run)
            counts["run"] += of_run is not None
            warnings = of_run or warnings
        for warning in warnings:
            warning = warning.get("warning", warning)
            counts[warning["id"]] += 1
            print(f"{warning['id']:20} {path}  {warning['place']}: {warning['what']}", flush=True)
    print(", ".join(f"{name}: {count}" for name, count in counts.items()))


if __name__ == "__main__":
    main()
