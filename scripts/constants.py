#!/usr/bin/env python3
"""What half and twice of every geometric constant changes in sixty hard cases.

    python scripts/constants.py --out DIR [--jobs N] [--only NAME,NAME]
                                        builds the program with constants that can be changed, if DIR
                                        has none yet, runs the cases and writes DIR/constants.csv
                                        (needs: Rust, numpy)

The table of constants is crates/carom-contact/src/constants.rs. A copy of the sources is built in DIR
in which a constant that has a number of its own is multiplied by a factor from the environment; those
that follow from it change with it. An angle is multiplied as an angle.

The cases are forty aligned ones, spread over all families, and of the random ladders the fastest of
each category in the plane (seed 31) and seven fast ones in space (seed 1). A row of the table has, for a factor:

    changed     cases whose contact.csv differs in any digit from that of the constants as they are
    judged      cases with another judgement, as NUMBER: before > after; a stays for aligned, p for
                plane, s for space
    largest     largest change of contact force and impulse in the last row, relative to their largest
                values in the record, of cases that are right with both, and that case
"""

import argparse
import csv
import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
TABLE = "crates/carom-contact/src/constants.rs"
SAMPLES = {
    "a": ["--aligned", "--count", "38"],
    "p": ["--seed", "31", "--count", "150", "--only", "118,80,55,82,122,19,59,125,61,127,141,78,116"],
    "s": ["--space", "--count", "80", "--only", "52,20,44,28,68,39,12"],
}
CONSTANT = re.compile(r"^(pub(?:\(crate\))?) const ([A-Z_]+): ([^=]+) = (.+);$", re.MULTILINE)
FREE = re.compile(r"^(Angle::degrees\()?(-?[\d.e-]+)\)?$")

READ = '''
fn factor(name: &str) -> f64 {
    let chosen = std::env::var("CAROM_CONSTANT").unwrap_or_default();
    chosen.split_once('=').filter(|(of, _)| *of == name).map_or(1.0, |(_, factor)| factor.parse().unwrap())
}
'''


def free_constants():
    """Names of the constants that follow from no other one."""
    return [m[2] for m in CONSTANT.finditer((ROOT / TABLE).read_text()) if FREE.match(m[4])]


def called(text, names):
    """The text, but for imports and comments, with calls in place of names."""
    word = re.compile(r"\b(" + "|".join(sorted(names)) + r")\b(?!\()")
    lines = []
    importing = False
    for line in text.split("\n"):
        importing = importing or bool(re.match(r"\s*(pub )?use ", line))
        if not importing and not line.lstrip().startswith("//"):
            line = word.sub(r"\1()", line)
        importing = importing and ";" not in line
        lines.append(line)
    return "\n".join(lines)


def as_functions(table):
    """The table with functions in place of constants."""
    names = [m[2] for m in CONSTANT.finditer(table)]

    def function(m):
        visible, name, kind, value = m.groups()
        free = FREE.match(value)
        if free and free[1]:
            value = f'Angle::degrees({free[2]} * factor("{name}"))'
        elif free:
            value = f'{value} * factor("{name}")'
        else:
            value = called(value, names)
        return (
            f"#[allow(non_snake_case)]\n{visible} fn {name}() -> {kind} {{\n    static VALUE: std::sync::OnceLock<{kind}>"
            f" = std::sync::OnceLock::new();\n    *VALUE.get_or_init(|| {value})\n}}"
        )

    return CONSTANT.sub(function, table) + READ, names


def changeable(folder):
    """A copy of the sources in which constants can be changed."""
    files = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True)
    for name in files.stdout.split():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name, follow_symlinks=False)
    table, names = as_functions((folder / TABLE).read_text())
    (folder / TABLE).write_text(table)
    for path in folder.glob("crates/*/src/**/*.rs"):
        text = path.read_text()
        imports = " ".join(re.findall(r"(?:constants|kinematics)::(\{[^}]*\}|[A-Z_]+)", text))
        mine = [name for name in names if re.search(rf"\b{name}\b", imports)]
        if mine and path != folder / TABLE:
            path.write_text(called(text, mine))


def judged(carom, out, jobs, constant, only=None):
    """Judgement and record of all cases, or of some, by the ladder."""
    rows = {}
    for sample, words in SAMPLES.items():
        if only is not None:
            numbers = [name[1:5] for name in only if name[0] == sample]
            if not numbers:
                continue
            words = [word for k, word in enumerate(words) if "--only" not in words[max(k - 1, 0) : k + 1]]
            words += ["--only", ",".join(str(int(number)) for number in numbers)]
        folder = out / sample
        command = [sys.executable, str(ROOT / "scripts/ladder.py"), *words, "--carom", str(carom), "--out", str(folder), "--jobs", str(jobs)]
        subprocess.run(command, env={**os.environ, "CAROM_CONSTANT": constant}, stdout=subprocess.DEVNULL, check=False)
        with (folder / "results.csv").open() as file:
            rows.update({sample + row["case"]: (row["outcome"], folder / "runs" / row["case"]) for row in csv.DictReader(file)})
    return rows


def contacts(carom, out, before, jobs, constant):
    """What contact.csv has for every case and its image, by sample and name; without fields."""

    def one(case):
        record = out / case.parent.parent.name / case.stem
        record.parent.mkdir(parents=True, exist_ok=True)
        command = [carom, "run", case, "--out", record, "--no-report", "-q", "--threads", "1", "--set", "output.fields_every=0"]
        subprocess.run([str(word) for word in command], env={**os.environ, "CAROM_CONSTANT": constant}, capture_output=True, check=False)
        found = record / "contact.csv"
        return case.parent.parent.name + case.stem, found.read_bytes() if found.exists() else b""

    with ThreadPoolExecutor(jobs) as pool:
        return dict(pool.map(one, sorted(before.glob("*/cases/*.toml"))))


def last(record):
    """Contact forces and impulses in the last row of a history, and the largest of each kind."""
    with (record / "history.csv").open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    kinds = [[k for k in rows[0] if k.startswith(f"contact_{kind}_")] for kind in ("force", "impulse")]
    of_kind = [np.array([[float(row[k] or 0) for k in kind] for row in rows]) for kind in kinds]
    return [(values[-1], np.abs(values).max(initial=0.0)) for values in of_kind]


def change(before, after):
    """Largest relative change in the last row."""
    pairs = zip(last(before), last(after))
    return max((np.abs(new - old).max() / max(size, other) if max(size, other) > 0 else 0.0 for (old, size), (new, other) in pairs), default=0.0)


def compared(before, after, differs):
    """A row of the table for cases that differ."""
    other = [f"{k}: {before[k][0]} > {after[k][0]}" for k in differs if before[k][0] != after[k][0]]
    both = [k for k in differs if before[k][0] == after[k][0] == "right"]
    sizes = [(change(before[k][1], after[k][1]), k) for k in both]
    size, case = max(sizes, default=(0.0, ""))
    return {"changed": len(differs), "judged": "; ".join(other), "largest": f"{size:.1e}", "in": case}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True, help="directory that is created")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", help="names of constants, separated by commas")
    options = parser.parse_args()
    out = options.out.resolve()
    carom = out / "carom"
    if not carom.exists():
        changeable(out / "source")
        target = Path(os.environ.get("CARGO_TARGET_DIR", out / "target"))
        build = ["cargo", "build", "--release", "--bin", "carom"]
        subprocess.run(build, cwd=out / "source", env={**os.environ, "CARGO_TARGET_DIR": str(target)}, check=True)
        shutil.copy(target / "release/carom", carom)
    before = judged(carom, out / "before", options.jobs, "")
    print(f"{len(before)} cases, {sum(outcome == 'right' for outcome, _ in before.values())} right", flush=True)
    own = contacts(carom, out / "own", out / "before", options.jobs, "")
    names = options.only.split(",") if options.only else free_constants()
    with (out / "constants.csv").open("w", newline="") as file:
        table = csv.DictWriter(file, ["constant", "factor", "changed", "judged", "largest", "in"])
        table.writeheader()
        for name in names:
            for factor in ("0.5", "2"):
                constant = f"{name}={factor}"
                found = contacts(carom, out / "changed", out / "before", options.jobs, constant)
                differs = sorted({k[:5] for k in own if own[k] != found[k]})
                after = judged(carom, out / "after", options.jobs, constant, differs)
                row = {"constant": name, "factor": factor, **compared(before, after, differs)}
                shutil.rmtree(out / "changed")
                shutil.rmtree(out / "after", ignore_errors=True)
                table.writerow(row)
                file.flush()
                print(*row.values(), sep="  ", flush=True)
    return 0


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    sys.exit(main())
