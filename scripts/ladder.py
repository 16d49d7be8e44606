#!/usr/bin/env python3
"""Runs seeded hard contact cases and judges their records with field_check.py, which is independent.

    python scripts/ladder.py --carom target/release/carom --seed 1 --count 400 --out DIR
    python scripts/ladder.py --space --carom CAROM --count 100 --out DIR   cases in space
    python scripts/ladder.py --aligned --carom CAROM --out DIR             aligned cases
    python scripts/ladder.py --carom CAROM --cases FOLDER --out DIR      existing cases instead
    python scripts/ladder.py --judge DIR                                 kept records of a ladder
    python scripts/ladder.py --check RUN                                 one record
                                                                         (needs: pip install numpy)

Case k of a seed is the same for every --count and on every machine. Categories alternate; all other
parameters are random (ladder_cases.py, in space ladder_space_cases.py). A case ends as one of

    right      exit 0 and nothing wrong in the record
    wrong      exit 0, but bodies penetrate or pass through, or energy is created without a warning
    marked     exit 0 with the warning that energy was created, and nothing else wrong
    warned     exit 0, wrong, and warnings of the record with a place say so
    stopped    exit 3, with the reason of the manifest
    timeout    killed after --timeout seconds of wall time
    refused    exit 2: the case was refused before it ran, rightly (a fault of the generator) or not
    crash      any other exit

Aligned cases are not random (aligned_cases.py); --count chooses from every family in proportion. What
must hold in their records is in aligned_judge.py; a case and its image are compared, which lies beside
it as NUMBER-twin.

DIR/results.csv has a row per case: depths as multiples of h as defined in field_check.py, the energy
created by the checker's formula and by the record, rows of contact.csv, wall
time, names of the warnings of the record. What is wrong in the record of a case
that stopped is listed too. Fields of cases that end right are deleted, unless --keep is given.
"""

import argparse
import csv
import json
import re
import shutil
import subprocess
import sys
import time
import tomllib
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import aligned_cases
import aligned_judge
import field_check
import field_check_space
import ladder_cases
import ladder_space_cases

OUTCOMES = ["right", "wrong", "warned", "marked", "stopped", "timeout", "refused", "crash"]
COLUMNS = (
    "case category family enforcement elements outcome kind nodes edges self initial created created_recorded momentum "
    "contacts wall warnings wrong message"
).split()

# Schemes with impulses on single nodes.
WITHOUT_MORTAR = ("central-difference", "paoli-schatzman", "moreau-jean", "nonsmooth-generalized-alpha")

# Kind of a stop, by words of its reason.
KINDS = {
    "energy guard": "energy was created",
    "overlap at the start": "overlap at the start",
    "no unique closest point": "no unique closest point",
    "lost facet": "is beyond primary facet",
    "active set": "do(es)? not converge: nodes|active set cycles",
    "inverted cell": "inverted|det F|J ≤ 0",
    "explicit contact": "explicit step did not converge",
    "penetrates": "penetrates by",
    "not finite": "not finite",
    "Newton": "Newton's method did not converge",
}


def kind_of(message):
    last = re.search(r"last correction (\S+) L, residual (\S+) of", message)
    if last and max(float(x) for x in last.groups()) < 1e-9:
        return "Newton, but converged"
    return next((kind for kind, words in KINDS.items() if re.search(words, message)), "other")


def check(record):
    """The check of a record, by its dimension."""
    dimension = json.loads((record / "manifest.json").read_text())["case"]["dimension"]
    return (field_check_space if dimension == 3 else field_check).check(record)


def run(carom, case, out, timeout, sets):
    """(outcome, message, wall time) of a run."""
    command = [carom, "run", case, "--out", out, "--no-report", "--threads", "1", "--color", "never", "-q"]
    command += [word for key in sets for word in ("--set", key)]
    start = time.monotonic()
    try:
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=timeout)
    except subprocess.TimeoutExpired:
        return "timeout", "", time.monotonic() - start
    wall = time.monotonic() - start
    lines = [line for line in done.stderr.splitlines() if line.startswith("error")]
    message = (lines or [done.stderr.strip().split("\n")[0]])[0].removeprefix("error: ")
    outcome = {0: "right", 2: "refused", 3: "stopped"}.get(done.returncode, "crash")
    return outcome, message, wall


def judge(carom, meta, case, out, timeout, keep, sets):
    """The row of results.csv of a case."""
    outcome, message, wall = run(carom, case, out, timeout, sets)
    row = {**meta, "case": case.stem, "outcome": outcome, "message": message, "wall": f"{wall:.2f}", "kind": ""}
    if outcome in ("stopped", "refused", "crash"):
        row["kind"] = kind_of(message)
    judged(row, out)
    if row["outcome"] == "right" and not keep:
        shutil.rmtree(out / "fields", ignore_errors=True)
        shutil.rmtree(out / "checkpoint", ignore_errors=True)
    return row


def judge_aligned(carom, setup, case, out, timeout, keep, sets):
    """The row of results.csv of an aligned case."""
    pair = out.with_name(f"{out.name}-twin")
    row = {**setup.meta(), "case": case.stem, "kind": "", "wall": 0.0}
    outcome, message, wall = run(carom, case, out, timeout, sets)
    if setup.twin and outcome == "right":
        outcome, message, more = run(carom, case.with_name(f"{case.stem}-twin.toml"), pair, timeout, sets)
        message = message and f"twin: {message}"
        wall += more
    row |= {"outcome": outcome, "message": message, "wall": f"{wall:.2f}"}
    judged_aligned(row, setup, out, pair)
    if row["outcome"] == "right" and not keep:
        for folder in (out, pair):
            shutil.rmtree(folder / "fields", ignore_errors=True)
            shutil.rmtree(folder / "checkpoint", ignore_errors=True)
    return row


def judged_aligned(row, setup, out, pair):
    """Completes the row of an aligned case by what its record violates."""
    if row["outcome"] == "right":
        try:
            found = aligned_judge.violations(out, setup.claims, pair if setup.twin else None, setup.field)
            warnings = json.loads((out / "manifest.json").read_text())["warnings"]
        except Exception as error:  # a record that cannot be read is a result, too
            found, warnings = {"record": [f"{type(error).__name__}: {error}"]}, []
        row["outcome"] = aligned_judge.outcome(found, warnings)
        row["kind"] = ", ".join(sorted(found))
        row["wrong"] = "; ".join(f"{judge}: {what}" for judge, whats in found.items() for what in whats)
        row["warnings"] = " ".join(sorted({w["id"] for w in warnings}))
        row["contacts"] = len((out / "contact.csv").read_text().splitlines()) - 1 if (out / "contact.csv").exists() else ""
    elif row["outcome"] == "refused" and setup.may_refuse and re.search(setup.may_refuse, row["message"]):
        row["outcome"], row["kind"] = "right", "refused with its reason"
    else:
        row["kind"] = kind_of(row["message"])


def judged(row, out):
    """Completes a row by the check of its record."""
    outcome = row["outcome"]
    written = (out / "manifest.json").exists() and (out / "fields.pvd").exists()
    if outcome == "right" or written and outcome != "timeout":
        try:
            found = check(out)
        except Exception as error:  # a record that cannot be read is a result, too
            found = {"wrong": [f"record: {type(error).__name__}: {error}"], "marked": False}
        for key in ("nodes", "edges", "self", "initial", "created", "created_recorded", "momentum"):
            value = found.get(key)
            row[key] = "" if value is None else f"{value:.4g}"
        row["wrong"], row["contacts"] = "; ".join(found["wrong"]), found.get("contacts", "")
        row["warnings"] = " ".join(found.get("warnings", []))
        if outcome == "right":
            kinds = {w.split(":")[0] for w in found["wrong"]}
            warnings = json.loads((out / "manifest.json").read_text())["warnings"]
            row["outcome"] = "marked" if found["marked"] and not kinds else aligned_judge.outcome(kinds, warnings)
            row["kind"] = ", ".join(sorted(kinds))


def judge_again(folder, aligned):
    """Checks the records of a ladder that were kept, and prints its table; exit code 1 if one is wrong."""
    with (folder / "results.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    setups = {f"{s.number:04}": s for s in aligned_cases.all_cases()}
    for row in rows:
        out = folder / "runs" / row["case"]
        if row["outcome"] in ("right", "wrong", "marked", "warned"):
            row["outcome"] = "right" if row["kind"] != "refused with its reason" else "refused"
        if aligned:
            judged_aligned(row, setups[row["case"]], out, out.with_name(f"{out.name}-twin"))
        else:
            judged(row, out)
    for row in rows:
        if row.get("wrong"):
            print(f"{row['case']} {row['category']:<15} {row['family']:<14} {row['outcome']:<8} {row['wrong'][:150]}")
    print(table(rows))
    return int(any(row["outcome"] == "wrong" for row in rows))


def table(rows):
    """Summary: outcomes by category × scheme family, and kinds of stops and errors."""
    total = Counter(r["outcome"] for r in rows)
    n = max(len(rows), 1)
    lines = ["", f"{len(rows)} cases: " + ", ".join(f"{total[o]} {o} ({100 * total[o] / n:.0f} %)" for o in OUTCOMES if total[o])]
    families = [f for f in ladder_space_cases.FAMILIES if any(r["family"] == f for r in rows)] or sorted({r["family"] for r in rows})
    categories = list(dict.fromkeys(r["category"] for r in sorted(rows, key=lambda r: r["category"])))

    def cell(chosen):
        count = Counter(r["outcome"] for r in chosen)
        rest = sum(count[o] for o in ("timeout", "refused", "crash"))
        if not chosen:
            return "."
        return f"{count['right']}/{count['wrong'] + count['warned'] + count['marked']}/{count['stopped']}" + (f"/{rest}" if rest else "")

    width = 1 + max([len(c) for c in categories] + [8])
    lines += ["", "right / wrong, warned or marked / stopped [/ timed out, refused or crashed]", ""]
    lines.append(" " * width + "".join(f"{f:>14}" for f in [*families, "all"]))
    for c in [*categories, "all"]:
        mine = [r for r in rows if c in ("all", r["category"])]
        cells = [cell([r for r in mine if f in ("all", r["family"])]) for f in [*families, "all"]]
        lines.append(f"{c:<{width}}" + "".join(f"{x:>14}" for x in cells))
    for outcome in OUTCOMES[1:]:
        kinds = Counter(r["kind"] for r in rows if r["outcome"] == outcome)
        for kind, count in kinds.most_common():
            cases = [r["case"] for r in rows if (r["outcome"], r["kind"]) == (outcome, kind)]
            lines.append(f"{outcome:>8} {count:4}  {kind or '-':<28} {' '.join(cases[:8])}{' …' if len(cases) > 8 else ''}")
        if outcome == "stopped" and kinds:
            before = [r["case"] for r in rows if r["outcome"] == outcome and r.get("wrong")]
            lines.append(f"{len(before):13}  of them wrong before the stop {' '.join(before[:8])}")
    idle = [r["case"] for r in rows if r["outcome"] == "right" and r.get("contacts") == 0]
    excused = [r["case"] for r in rows if r["kind"] == "refused with its reason"]
    lines += [f"   right {len(excused):4}  refused with their reason    {' '.join(excused)}"] if excused else []
    lines += [f"   right {len(idle):4}  without a row in contact.csv {' '.join(idle)}"] if idle else []
    return "\n".join(lines)


def show(run):
    """Prints the check of one record; exit code 1 if it is wrong."""
    found = check(run)
    for key in ("status", "reason", "fields", "initial", "nodes", "edges", "self", "created", "created_recorded", "momentum"):
        value = found[key]
        print(f"{key:>17}  {value:.4g}" if isinstance(value, float) else f"{key:>17}  {value}")
    print("\n".join(f"{'wrong':>17}  {w}" for w in found["wrong"]) or "nothing wrong")
    return 1 if found["wrong"] else 0


def with_mortar(text):
    """A case with mortar contact between sides of bodies in the plane, if the scheme has it."""
    case = tomllib.loads(text)
    if case["dimension"] != 2 or case["time"]["scheme"]["kind"] in WITHOUT_MORTAR:
        return text
    parts = re.split(r"(?m)^(?=\[\[contact\]\])", text)
    for i, part in enumerate(parts[1:], 1):
        contact = tomllib.loads(part)["contact"][0]
        if contact.get("law") != "predictor":
            parts[i] = part.replace("[[contact]]\n", '[[contact]]\nmethod = "mortar"\n', 1)
    return "".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--carom", type=Path, help="the program")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, help="default: 400; all, of aligned cases")
    parser.add_argument("--out", type=Path, help="directory that is created")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", help="numbers of cases, or words of their category or scheme family, separated by commas")
    parser.add_argument("--timeout", type=float, default=120.0)
    parser.add_argument("--keep", action="store_true", help="keep the fields of all cases")
    parser.add_argument("--cases", type=Path, help="folder of existing cases to run instead")
    parser.add_argument("--judge", type=Path, metavar="DIR", help="check the kept records of a ladder again and stop")
    parser.add_argument("--check", type=Path, metavar="RUN", help="check one record and stop")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a key of every case that is changed")
    parser.add_argument("--space", action="store_true", help="cases in space")
    parser.add_argument("--aligned", action="store_true", help="aligned cases")
    parser.add_argument("--mortar", action="store_true", help="mortar contact wherever it is available")
    parser.add_argument("--demand", type=float, metavar="SHARE", help="exit code 1 if a case is wrong or fewer than this share are right")
    parser.add_argument("--dry", action="store_true", help="write the cases only")
    options = parser.parse_args()
    if options.check:
        return show(options.check)
    if options.judge:
        return judge_again(options.judge, options.aligned)
    if not options.out or not (options.carom or options.dry):
        parser.error("--carom and --out are needed")
    if (options.out / "results.csv").exists():
        parser.error(f"{options.out} has results already; give another --out")
    (options.out / "cases").mkdir(parents=True, exist_ok=True)
    (options.out / "runs").mkdir(exist_ok=True)
    work = []
    if options.cases:
        meta = {"category": "given", "family": "given", "enforcement": "", "elements": ""}
        work = [(meta, case) for case in sorted(options.cases.glob("*.toml"))]
    generator = ladder_space_cases if options.space else ladder_cases
    words = options.only.split(",") if options.only else []
    numbers = {int(word) for word in words if word.isdigit()}
    kinds = [word for word in words if not word.isdigit()]
    wanted = lambda k, meta: not words or k in numbers or any(kind in meta["category"] + " " + meta["family"] for kind in kinds)
    folder = options.out / "cases"
    written = with_mortar if options.mortar else lambda text: text
    for setup in aligned_cases.chosen(options.count) if options.aligned else []:
        if wanted(setup.number, setup.meta()):
            path = folder / f"{setup.number:04}.toml"
            path.write_text(written(setup.text()))
            if setup.twin:
                path.with_name(f"{path.stem}-twin.toml").write_text(written(setup.twin.text()))
            work.append((setup, path))
    for k in range(1, (options.count or 400) + 1) if not options.cases and not options.aligned else []:
        meta, text = generator.case(options.seed, k)
        if wanted(k, meta):
            path = folder / f"{k:04}.toml"
            path.write_text(written(text))
            work.append((meta, path))
    if options.dry:
        return 0
    rows = []
    with (options.out / "results.csv").open("w", newline="") as file, ThreadPoolExecutor(options.jobs) as pool:
        writer = csv.DictWriter(file, COLUMNS, restval="")
        writer.writeheader()
        of_case = judge_aligned if options.aligned else judge
        one = lambda w: of_case(options.carom, w[0], w[1], options.out / "runs" / w[1].stem, options.timeout, options.keep, options.set)
        for row in pool.map(one, work):
            rows.append(row)
            writer.writerow({key: row.get(key, "") for key in COLUMNS})
            file.flush()
            note = row.get("wrong") if row["outcome"] == "wrong" else row["message"]
            print(f"{row['case']} {row['category']:<15} {row['family']:<14} {row['outcome']:<8} {row['wall']:>6} s  {(note or '')[:150]}", flush=True)
    print(table(rows))
    right = sum(row["outcome"] == "right" for row in rows)
    silent = any(row["outcome"] == "wrong" for row in rows)
    return int(options.demand is not None and (silent or right < options.demand * len(rows)))


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    sys.exit(main())
