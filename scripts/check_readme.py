#!/usr/bin/env python3
"""Checks what README.md says a command prints: the run of its first command, except for wall times, and
the energy that this run loses, with its step and with a quarter of it; the numbers of set-ups of
`carom verify`, or of `carom verify --fast`, of planted faults and of methods of the laboratory; that
every command of the tour has its options; and that what takes hours to measure is what the book says,
with a date and a command.

    scripts/check_readme.py CAROM VERIFY.JSON
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def block_after(text, words):
    """The lines of the indented block that follows a sentence."""
    lines = text[text.index(words) :].split("\n")
    start = next(i for i, line in enumerate(lines) if line.startswith("    "))
    end = next(i for i, line in enumerate(lines) if i > start and not line.startswith("    "))
    return [line[4:] for line in lines[start:end]]


def printed(carom):
    """The output of the first command, which writes into a new folder."""
    with tempfile.TemporaryDirectory() as folder:
        command = [carom, "run", "cases/impact/impact.toml", "--out", f"{folder}/impact"]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
        return done.stdout.replace(folder, "runs").rstrip("\n").split("\n")


# What CI does not measure: words of README.md, and the page of the book with the same figures.
MEASURED = [
    (r"needs (2\.7 GiB) of memory and (7) s per\s+step on one core \(\d+ \w+ \d{4},\s+`carom run cases/perf/ball", "performance.md",
     r"cases/perf/ball\.toml`\), ten steps \| – \| {1}\.\d s, {0} "),
    (r"Of (400)\s+random\s+plane\s+cases that are\s+hard for\s+contact, (96) %\s.*\(\d+ \w+ \d{4}, `scripts/ladder\.py --seed 1 --count 400`\)",
     "verification/ladder.md", r"first {0} cases of seed 1.*finished, correct \| [^|]* \| \d+ \({1} %\)"),
]


def lost(carom, step):
    """The percentage of its energy that the impact loses with a time step."""
    asked = 'expect=[{ what = "energy_lost", at_least = 0.0 }]'
    with tempfile.TemporaryDirectory() as folder:
        command = [carom, "run", "cases/impact/impact.toml", "--out", f"{folder}/impact", "--no-report"]
        sets = ["--set", asked, "--set", "output.fields_every=0", "--set", f"time.step={step}"]
        done = subprocess.run(command + sets, cwd=ROOT, capture_output=True, text=True, check=True)
    return 100 * float(re.search(r"energy_lost: (\S+),", done.stdout)[1])


def main():
    carom, verified = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    wrong = []

    def plain(lines):
        return [re.sub(r"in [\d.]+ s of wall time", "", line) for line in lines]

    said, found = plain(block_after(readme, "The first one prints")), plain(printed(carom))
    wrong += [f"README.md prints `{a}`, the run `{b}`" for a, b in zip(said, found) if a != b]
    if len(said) != len(found):
        wrong.append(f"README.md prints {len(said)} lines, the run {len(found)}")

    suite = json.loads(verified.read_text(encoding="utf-8"))
    set_ups = len(suite["set_ups"])
    count = f"{set_ups} of them with `--fast`" if suite["fast"] else f"Verified by {set_ups} cases and studies"
    if count not in " ".join(readme.split()):
        wrong.append(f"README.md does not say {count}")

    for pattern, step in ((r"loses (\d+) % of its energy", 1.875e-3), (r"of the step\s+it loses\s+([\d.]+) %", 4.6875e-4)):
        claim = re.search(pattern, readme)
        found = lost(carom, step)
        decimals = len(claim[1].partition(".")[2]) if claim else 0
        if not claim or claim[1] != f"{found:.{decimals}f}":
            wrong.append(f"the impact with Δt = {step} loses {found:.2f} % of its energy, not {claim and claim[1]} %")
    for pattern, page, source in MEASURED:
        claim = re.search(pattern, readme, re.DOTALL)
        text = (ROOT / "docs/book/src" / page).read_text(encoding="utf-8")
        if not claim:
            wrong.append(f"README.md does not say `{pattern}`")
        elif not re.search(source.replace("{0}", claim[1]).replace("{1}", claim[2]), text, re.DOTALL):
            wrong.append(f"{page} does not say {claim[1]} and {claim[2]}, as README.md does")

    faults = len(json.loads((ROOT / "scripts/faults.json").read_text(encoding="utf-8")))
    if not re.search(rf"\b{faults}\s+faults are planted", readme):
        wrong.append(f"README.md does not say {faults} faults")
    laboratory = (ROOT / "cases/paper/laboratory.toml").read_text(encoding="utf-8")
    methods = len(re.findall(r"^\[\[arm\]\]", laboratory, re.MULTILINE))
    if not re.search(rf"\blaboratory\.toml +.*\b{methods} methods", readme):
        wrong.append(f"README.md does not say {methods} methods")

    for line in block_after(readme, "## A tour"):
        words = re.split(r"\s{2,}", line)[0].split()
        options = subprocess.run([carom, words[1], "--help"], capture_output=True, text=True, check=True)
        wrong += [f"`{line.strip()}`: no option {w}" for w in words if w[:2] == "--" and w not in options.stdout]
        paths = [word for word in words if word.startswith("cases/")]
        wrong += [f"`{line.strip()}`: no file {path}" for path in paths if not (ROOT / path).is_file()]
    if wrong:
        sys.exit("\n".join(wrong))
    print(
        f"README.md: {len(said)} lines of output, {set_ups} set-ups, {faults} faults, {methods} methods and "
        "its tour are right"
    )


if __name__ == "__main__":
    main()
