#!/usr/bin/env python3
"""Runs the scripts that redraw figures, and compares what they draw with their tables.

    python3 scripts/check_redrawn.py CAROM

Of runs in the plane, in space, with friction, of bars with measured data and of one that stops, and of
a study of two groups of arms: every `figures/*.py` must run, write its PDF, and have a pane with a title for each one that its
table names. Needs matplotlib.
"""

import csv
import os
import runpy
import subprocess
import sys
import tempfile
from pathlib import Path

os.environ["MPLBACKEND"] = "Agg"
import matplotlib.pyplot as plt  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent

# The reaction is in no other figure.
BARS = """
dimension = 1
[[material]]
name = "steel"
law = "linear-elastic"
density = 1.0
young = 100.0
poisson = 0.0
[[body]]
name = "bar"
material = "steel"
element = "L2"
mesh = { shape = "interval", min = 0.0, max = 1.0, cells = 8 }
velocity = [1.0]
[[support]]
name = "wall"
on = ["bar.left"]
fix = ["x"]
[[probe]]
name = "A"
body = "bar"
at = [1.0]
record = ["ux"]
[[overlay]]
name = "gauge"
file = "measured.csv"
column = "wall.reaction_x"
[time]
end = 0.2
step = 0.002
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
[output]
fields_every = 20
"""
STUDY = """
case = "bars.toml"
[grid]
"time.step" = [0.004, 0.002, 0.001]
"time.scheme.rho_inf" = [0.0, 0.5, 1.0]
"""


def panes(script):
    """The panes of the table beside a script, in their order, and how many the script has drawn."""
    with open(script.with_suffix(".csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    column = next(name for name in ("pane", "contact", "time") if name in rows[0])
    said = list(dict.fromkeys(row[column] for row in rows))
    plt.close("all")
    found = runpy.run_path(str(script))
    drawn = [ax for ax in found["figure"].axes if ax.get_visible() and ax.get_label() != "<colorbar>"]
    named = len(found["titles"]) if column == "pane" else len(said)
    return said, named, sum(ax.has_data() for ax in drawn)


def main():
    carom = Path(sys.argv[1]).resolve()
    wrong, count = [], 0
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "bars.toml").write_text(BARS)
        (place / "measured.csv").write_text("t,value\n0.05,1\n0.1,2\n0.15,1\n")
        (place / "study.toml").write_text(STUDY)
        few = ["--set", "time.end=0.45", "--set", "expect=[]"]
        friction = ["--set", "expect=[]"]
        for name, command in {
            "impact": ["run", ROOT / "cases/impact/impact.toml", *few],
            "friction": ["run", ROOT / "cases/friction/block-to-rest.toml", *friction],
            "bars": ["run", place / "bars.toml"],
            "space": ["run", ROOT / "cases/space/incline-sticks.toml", "--set", "expect=[]"],
            "stops": ["run", ROOT / ".ci/pages/stops.toml"],
            "study": ["study", place / "study.toml"],
        }.items():
            done = subprocess.run([carom, *command, "--out", place / name], capture_output=True, text=True)
            if done.returncode != (3 if name == "stops" else 0):
                sys.exit(done.stderr)
            scripts = sorted((place / name / "figures").glob("*.py"))
            count += len(scripts)
            for script in scripts:
                said, named, drawn = panes(script)
                if not len(said) == named == drawn:
                    wrong.append(f"{name}/{script.name}: {said} in the table, {named} named, {drawn} drawn")
                if not script.with_name(f"{script.stem}-redrawn.pdf").is_file():
                    wrong.append(f"{name}/{script.name} writes no PDF")
            if not scripts:
                wrong.append(f"{name} has no scripts")
        wanted = ["impact/figures/bodies.py", "impact/figures/pressure.py", "friction/figures/stick-slip.py"]
        wanted += [f"{name}/figures/setup.py" for name in ("impact", "bars", "space", "stops")]
        wanted += ["space/figures/bodies.py", "stops/figures/stopped.py"]
        wanted += ["bars/figures/bodies.py", "bars/figures/measured.py", "study/figures/trend-time.step.py"]
        wrong += [f"no {path}" for path in wanted if not (place / path).is_file()]
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{count} scripts draw the panes of their tables")


if __name__ == "__main__":
    main()
