#!/usr/bin/env python3
"""Builds the book from its pages and from the output of Carom.

    scripts/make_book.py [--carom target/release/carom] [--fast] [--verify DIR]

The output of Carom goes to docs/book/src/generated/; then mdbook builds target/book/.

keys/          a page for each table of the case file, from `carom schema`; for each key, lines of a
               shipped case that uses it
commands.md    `carom COMMAND --help`
explain/       `carom explain` for each scheme shown in the pages
first-run.*    output and figure of `carom run cases/impact/impact.toml`
columns.md     columns of its history.csv, from its manifest
metrics.md     the table of metrics, from crates/carom-record/src/metrics/table.rs
activation.md, coarse-steps.md, transits.md, flagship.md, peak.md     results of docs/book/studies/
spins.md, refine.md        tables of cases/free/spins.toml and cases/impact/refine-*.toml
solid-*.svg, contact-*.svg     figures of the examples in space
FAMILY.md, FAMILY.svg      `carom verify --report --out DIR --markdown DIR`, and a figure of one of
                           its runs; with --verify DIR, the existing content of DIR

Every case of docs/book/examples/ is run as well. Missing output, broken links and keys that no case
uses are listed at the end; the exit code is then 1. Needs Python 3.11 and a built carom. Without
mdbook in the path, only the generated files are written.
"""

import argparse
import csv
import html
import html.parser
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import urllib.parse

import book_keys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BOOK = ROOT / "docs/book"
GENERATED = BOOK / "src/generated"

# Family: the case whose figure is shown in its chapter, and the figure.
FIGURES = {
    "bar": ("single", "force"),
    "free": ("spin", "energy"),
    "order": ("", "energy"),
    "invariance": ("", "bodies"),
    "impact": ("impact", "bodies"),
    "disc": ("offset", "bodies"),
    "corner": ("skin", "bodies"),
    "self": ("ring", "bodies"),
    "ladder": ("zip", "bodies"),
    "obstacle": ("paddle", "bodies"),
    "friction": ("bar-on-bed", "energy"),
    "loads": ("", "bodies"),
    "static": ("", "bodies"),
    "tie": ("wave", "bodies"),
    "manufactured": ("moving-block-orders", "energy"),
}

# Columns of a study's table in the book.
STUDIES = {
    "activation": ["peak_force", "force_roughness", "restitution", "energy_lost", "energy_created", "rejected_steps"],
    "coarse-steps": ["energy_created", "energy_lost", "restitution"],
    "transits": ["energy_created", "energy_lost", "restitution"],
    "flagship": ["energy_lost", "dissipated_integrator", "dissipated_contact", "A.uy:min", "contact_end", "peak_mean_force"],
    "peak": ["peak_force", "peak_mean_force", "impulse_x", "restitution", "energy_lost"],
}

# Studies of refinement, and the metrics of their tables.
REFINEMENTS = {"refine-step": "The step halved", "refine-mesh": "The meshes halved"}
REFINED = ["cylinder.center_y", "cylinder.velocity_y", "A.uy:min", "B.uy:min", "contact_end", "impulse_y", "restitution", "energy_lost", "peak_force", "peak_mean_force"]

problems = []


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--carom", type=pathlib.Path, default=ROOT / "target/release/carom", help="the program")
    options.add_argument("--fast", action="store_true", help="omit what `carom verify --fast` omits")
    options.add_argument("--verify", type=pathlib.Path, help="output of an earlier `carom verify --report --out DIR --markdown DIR`")
    given = options.parse_args()
    carom = given.carom.resolve()
    if not carom.is_file():
        sys.exit(f"{carom} does not exist: build it with `cargo build --release`, or name it with --carom")

    shutil.rmtree(GENERATED, ignore_errors=True)
    (GENERATED / "explain").mkdir(parents=True)
    with tempfile.TemporaryDirectory() as place:
        place = pathlib.Path(place)
        commands(carom)
        explanations(carom)
        keys(carom)
        first_run(carom, place)
        studies(carom, place)
        examples(carom, place)
        metrics()
        verified(carom, given, place)
    build()
    for problem in problems:
        print(f"missing: {problem}", file=sys.stderr)
    sys.exit(1 if problems else 0)


def run(carom, *arguments, accept=(0,)):
    """Standard output of a carom command; if it fails, None, and a problem is recorded."""
    done = subprocess.run([carom, *map(str, arguments)], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode in accept:
        return done.stdout
    said = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[0]
    problems.append(f"carom {' '.join(map(str, arguments))}: {said}")
    return None


def write(name, text):
    (GENERATED / name).write_text(text, encoding="utf-8")


def table(head, rows):
    """A table in Markdown; the cells are Markdown."""
    cell = lambda text: str(text).replace("|", "\\|").replace("\n", " ")
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(map(cell, line))} |\n" for line in lines) + "\n"


def number(text):
    """A number with five digits, as in the summaries of carom."""
    try:
        return f"{float(text):.5g}".replace("e-0", "e-")
    except ValueError:
        return "–"


# Commands and schemes


def commands(carom):
    help_text = run(carom, "--help") or ""
    names = re.findall(r"^  ([a-z]+) ", help_text.split("Commands:")[-1].split("Options:")[0], re.M)
    parts = []
    for name in names:
        if name != "help" and (text := run(carom, name, "--help")):
            parts.append(f"## carom {name}\n\n```text\n{text.replace(carom.name, 'carom').strip()}\n```\n\n")
    write("commands.md", "".join(parts))


def explanations(carom):
    """Writes generated/explain/NAME.txt for every page that includes it.

    NAME consists of the arguments of `carom explain`, joined with +.
    """
    pages = "".join(page.read_text(encoding="utf-8") for page in (BOOK / "src").rglob("*.md"))
    for name in sorted(set(re.findall(r"{{#include [./]*generated/explain/([^}\s]+)\.txt}}", pages))):
        arguments = [] if name == "all" else name.split("+")
        said = run(carom, "explain", *arguments)
        if said is not None:
            # The section on other codes is printed by the command only.
            write(f"explain/{name}.txt", said.split("\nin other codes\n")[0].strip() + "\n")


def keys(carom):
    schema = json.loads(run(carom, "schema") or "{}")
    if unused := book_keys.pages(schema, ROOT, GENERATED / "keys"):
        problems.append(f"a case that uses {', '.join(unused)}: add one to docs/book/examples/")
    listed = set(re.findall(r"generated/keys/(\w+)\.md", (BOOK / "src/SUMMARY.md").read_text(encoding="utf-8")))
    made = {page.stem for page in (GENERATED / "keys").glob("*.md")} - {"index"}
    if listed != made:
        problems.append(f"pages on keys in SUMMARY.md, which must list those of the schema: {', '.join(sorted(listed ^ made))}")


# Runs for the book


def first_run(carom, place):
    out = place / "impact"
    said = run(carom, "run", "cases/impact/impact.toml", "--out", out)
    if said is None:
        return
    write("first-run.txt", said.replace(str(out), "runs/impact").strip() + "\n")
    shutil.copy(out / "figures/bodies.svg", GENERATED / "first-run.svg")
    manifest = json.loads((out / "manifest.json").read_text(encoding="utf-8"))
    rows = [[f"`{c['name']}`", c["unit"] or "–", c["description"]] for c in manifest["columns"]]
    write("columns.md", table(["Column", "Unit", "Meaning"], rows))


def metrics():
    """Writes the table of metrics, which is defined in the code."""
    command = ["cargo", "run", "--quiet", "-p", "carom-record", "--example", "metrics"]
    write("metrics.md", subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout)


def studies(carom, place):
    for name, columns in STUDIES.items():
        out = place / name
        if run(carom, "study", f"docs/book/studies/{name}.toml", "--out", out) is None:
            continue
        with open(out / "study.csv", encoding="utf-8", newline="") as file:
            rows = [[row["arm"], *(number(row[c]) for c in columns)] for row in csv.DictReader(file)]
        write(f"{name}.md", table(["Arm", *(f"`{c}`" for c in columns)], rows))


def examples(carom, place):
    """Runs every case of docs/book/examples/ in alphabetical order.

    A case may start from the end of an earlier one.
    """
    for case in sorted(BOOK.glob("examples/*.toml")):
        content = tomllib.loads(case.read_text(encoding="utf-8"))
        study = "case" in content
        out = place / f"example-{case.stem}"
        before = content.get("initial", {}).get("from")
        start = ["--set", f'initial.from="{place / f"example-{pathlib.Path(before).name}"}"'] if before else []
        said = run(carom, "study" if study else "run", case.relative_to(ROOT), "--out", out, *start)
        if said is not None:
            if "MISSED: expected" in said or ": not available" in said:
                problems.append(f"what {case.name} expects: {said.strip()}")
            if case.stem.startswith(("solid-", "contact-")):
                shutil.copy(out / "figures/bodies.svg", GENERATED / f"{case.stem}.svg")


# Verification


def verified(carom, given, place):
    out = given.verify
    if out is None:
        out = place / "verify"
        fast = ["--fast"] if given.fast else []
        # Missed expectations and stopped runs are rows of the tables, not errors.
        run(carom, "verify", *fast, "--report", "--out", out, "--markdown", out, accept=(0, 1, 3))
    for family in [*FIGURES, "paper"]:
        if (out / f"{family}.md").is_file():
            shutil.copy(out / f"{family}.md", GENERATED)
        else:
            problems.append(f"{family}.md, the table of `carom verify`")
    for family, (case, figure) in FIGURES.items():
        if found := figure_of(out, family, case, figure):
            shutil.copy(found, GENERATED / f"{family}.svg")
        else:
            problems.append(f"figures/{figure}.svg of a run of the family {family}")
    spins = [[r["arm"], *(number(r[c]) for c in ("steps", "energy", "moment"))] for r in ends(out / "free/spins")]
    write("spins.md", table(["", "Steps done", "Energy at the end / at the start", "Angular momentum, likewise"], spins))
    write("refine.md", "".join(refinement(out / f"impact/{name}/study.csv", title) for name, title in REFINEMENTS.items()))


def ends(study):
    """Steps done and the remaining energy and angular momentum for each arm of a study."""
    if not (study / "study.csv").is_file():
        problems.append(f"{study.name} of {study.parent.name}")
        return
    with open(study / "study.csv", encoding="utf-8", newline="") as file:
        names = [row["arm"] for row in csv.DictReader(file)]
    for name, history in zip(names, sorted(study.glob("arms/*/history.csv"))):
        rows = list(csv.DictReader(history.open(encoding="utf-8")))
        left = lambda column: float(rows[-1][column]) / float(rows[0][column])
        yield {"arm": name, "steps": rows[-1]["step"], "energy": left("total"), "moment": left("angular_momentum")}


def refinement(path, title):
    """A table of a study that halves a step or cell size three times."""
    if not path.is_file():
        problems.append(f"{path.name} of {path.parent.name}")
        return f"{title}: not run.\n\n"
    with open(path, encoding="utf-8", newline="") as file:
        arms = list(csv.DictReader(file))
    ends = [list(csv.DictReader(place.open(encoding="utf-8")))[-1] for place in sorted(path.parent.glob("arms/*/history.csv"))]
    rows = []
    for column in REFINED:
        name, sources = (f"`{column}`", arms) if column in arms[0] else (f"`{column}`, at the end", ends)
        values = [float(source[column]) for source in sources]
        rows.append([name, *map(number, values), *verdict(values)])
    return f"{title}:\n\n" + table(["", *(arm["arm"] for arm in arms), "Order", "Limit"], rows)


def verdict(values):
    """Order and limit of values at halved steps, computed as in carom_record::order."""
    orders = []
    for a, b, c in zip(values, values[1:], values[2:]):
        quotient = (a - b) / (b - c) if b != c else 0.0
        orders.append(math.log2(quotient) if quotient > 0.0 else None)
    if None in orders or abs(orders[-1] - orders[-2]) > 0.3 or orders[-1] <= 0.0:
        return ["no order", "–"]
    distance = (values[-1] - values[-2]) / (2.0 ** orders[-1] - 1.0)
    return [f"{orders[-1]:.2f}", f"{number(values[-1] + distance)} ± {number(1.25 * abs(distance))}"]


def figure_of(out, family, case, figure):
    """OUT/FAMILY/CASE/figures/FIGURE.svg, or that of the first case of the family that has one."""
    found = sorted((out / family).glob(f"**/figures/{figure}.svg"))
    named = [path for path in found if path.parent.parent.name == case]
    return next(iter(named + found), None)


# mdbook


def build():
    if shutil.which("mdbook") is None:
        print("no mdbook in the path (cargo install mdbook --locked): only docs/book/src/generated/ was written")
        return
    done = subprocess.run(["mdbook", "build", BOOK], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        problems.append(f"mdbook build: {done.stderr.strip()}")
        return
    # Reasons follow a warning in lines of their own.
    said = [line.strip() for line in done.stderr.splitlines()]
    problems.extend(line for line in said if line.startswith(("WARN", "ERROR")) and "Caused By:" not in line)
    site = ROOT / "target/book"
    pages = {page.resolve(): Page(page) for page in site.rglob("*.html") if page.name not in ("print.html", "toc.html", "404.html")}
    for path, page in pages.items():
        for link in page.links:
            place, anchor = urllib.parse.urldefrag(link)
            if urllib.parse.urlparse(place).scheme:
                continue
            target = (path.parent / urllib.parse.unquote(place)).resolve() if place else path
            known = pages.get(target)
            if not target.exists() or (anchor and known and urllib.parse.unquote(anchor) not in known.anchors):
                problems.append(f"the target of {link} in {path.name}")
        if "{{#include" in page.text:
            problems.append(f"what {path.name} includes")
    print(site / "index.html")


class Page(html.parser.HTMLParser):
    """Links, anchors and text of a page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.anchors, self.text = [], set(), path.read_text(encoding="utf-8")
        self.feed(self.text)

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.anchors.update(filter(None, [attrs.get("id"), attrs.get("name")]))
        link = attrs.get("href") if tag in ("a", "link") else attrs.get("src") if tag == "img" else None
        if link:
            self.links.append(link)


if __name__ == "__main__":
    main()
