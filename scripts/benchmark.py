#!/usr/bin/env python3
"""Compares a time integrator with those of the benchmark studies in cases/benchmark, whose answers are
stored in cases/benchmark/answers.csv.

    scripts/benchmark.py [--carom CAROM] [--write] [SCHEME | SET]

    scripts/benchmark.py '{ kind = "hht", alpha = 0.2 }'
    scripts/benchmark.py --explicit '"time.scheme" = { kind = "central-difference" }, "body.*.mass" = "lumped"'

SCHEME is the value of `time.scheme`; SET are assignments as in the `set` of an [[arm]], in which
`body.*` stands for every body. Without either, the stored answers are computed again. An explicit
scheme (--explicit) takes part at the cost of Chung and Hulbert's with ρ∞ = 0.5, and starts the search
for its step at a tenth of the shortest one. The exit code is 1 if an answer differs from the stored
one by more than a thousandth.
"""

import argparse
import csv
import re
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / "cases" / "benchmark"
ANSWERS = FOLDER / "answers.csv"
NEW = "new scheme"
KEYS = ["study", "arm"]
VALUES = ["error_low", "error_high", "cost"]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scheme", nargs="?", help="value of time.scheme, or assignments")
    parser.add_argument("--carom", default="carom", help="the program")
    parser.add_argument("--explicit", action="store_true", help="match its cost instead of its step")
    parser.add_argument("--write", action="store_true", help="store the answers")
    return parser.parse_args()


def with_arm(study, scheme, explicit):
    """The text of a study with one more arm, and its case named by its absolute path."""
    text = study.read_text()
    case = (study.parent / re.search(r'^case = "(.*)"$', text, re.M)[1]).resolve()
    text = re.sub(r'^case = ".*"$', lambda _: f'case = "{case}"', text, flags=re.M)
    if not scheme:
        return text
    sets = f'"time.scheme" = {scheme}' if scheme.startswith("{") else scheme
    bodies = re.findall(r'\[\[body\]\]\nname = "(.*)"', case.read_text())
    one = re.compile(r'"body\.\*\.([^"]*)"( = [^,]*)')
    sets = one.sub(lambda m: ", ".join(f'"body.{body}.{m[1]}"{m[2]}' for body in bodies), sets)
    if explicit:
        steps = re.search(r"^steps = \[(.*)\]$", text, re.M)[1].split(",")
        sets += f', "time.step" = {float(steps[-1]) / 10!r}'
    match = '\nmatch = "cost"' if explicit else ""
    return f'{text}\n[[arm]]\nname = "{NEW}"{match}\nset = {{ {sets} }}\n'


def ranking(carom, study, scheme, explicit, folder):
    """The rows of ranking.csv of a study for its goal."""
    file = folder / study.name
    file.write_text(with_arm(study, scheme, explicit))
    out = folder / study.stem
    done = subprocess.run([carom, "study", file, "--out", out, "--no-report"], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    goal = re.search(r'^goal = "(.*)"$', study.read_text(), re.M)[1]
    with open(out / "ranking.csv", newline="") as table:
        return [row for row in csv.DictReader(table) if row["goal"] == goal]


def stored():
    with open(ANSWERS, newline="") as table:
        return {tuple(row[key] for key in KEYS): row for row in csv.DictReader(table)}


def differs(row, answer):
    pairs = [(float(row[value]), float(answer[value])) for value in VALUES]
    return any(abs(got - known) > 1e-3 * max(abs(got), abs(known)) + 1e-12 for got, known in pairs)


def main():
    asked = arguments()
    studies = sorted(path for path in FOLDER.glob("*.toml") if "[[arm]]" in path.read_text())
    rows = []
    with tempfile.TemporaryDirectory() as place:
        for study in studies:
            found = ranking(asked.carom, study, asked.scheme, asked.explicit, Path(place))
            rows += [{"study": study.stem, **row} for row in found]
    if asked.write:
        with open(ANSWERS, "w", newline="") as table:
            writer = csv.DictWriter(table, KEYS + VALUES, extrasaction="ignore", lineterminator="\n")
            writer.writeheader()
            writer.writerows(sorted((row for row in rows if row["method"] != NEW), key=lambda row: [row[k] for k in KEYS]))
        return 0
    answers = stored()
    wrong = 0
    study = None
    for row in rows:
        if row["study"] != study:
            study = row["study"]
            print(f"\n{study}\n{'place':>6} {'step':>10} {'error':>10} {'from':>10} {'to':>10} {'cost':>10}  method")
        answer = answers.get(tuple(row[key] for key in KEYS))
        is_wrong = row["method"] != NEW and (answer is None or differs(row, answer))
        wrong += is_wrong
        numbers = [float(row[name]) for name in ("step", "error", "error_low", "error_high")]
        words = " ".join(f"{x:10.3g}" for x in numbers)
        note = " <<<" if row["method"] == NEW else "  DIFFERS FROM THE STORED ANSWER" if is_wrong else ""
        print(f"{row['place']:>6} {words} {float(row['cost']):10.0f}  {row['method']}{note}")
    print(f"\n{len(answers)} stored answers, {wrong} of {sum(row['method'] != NEW for row in rows)} differ")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
