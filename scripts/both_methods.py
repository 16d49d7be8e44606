#!/usr/bin/env python3
"""Runs cases with contact of single nodes and with mortar contact, and prints one table of both.

    python3 scripts/both_methods.py CAROM [CASE…]

A row is an expectation of a case or one of the metrics below. The cases: the paper's impact, two
plane bars and the discs of cases/.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

CASES = Path(__file__).resolve().parent.parent / "cases"
DEFAULT = (
    "impact/impact",
    "bar/two-strips",
    "disc/bouncing",
    "disc/head-on",
    "disc/offset",
    "disc/on-plane",
    "disc/in-ring",
    "disc/incline",
    "disc/row",
)
METHODS = ("node-to-segment", "mortar")
METRICS = (
    "contact_start",
    "contact_duration",
    "impulse_y",
    "peak_mean_force",
    "restitution",
    "energy_lost",
    "penetration",
)


def record(carom, case, method, out):
    """Manifest and metrics of a run in which every contact has the method."""
    checked = subprocess.run(
        [carom, "check", case, "--json"], check=True, capture_output=True, text=True
    )
    names = [contact["name"] for contact in json.loads(checked.stdout)["case"]["contacts"]]
    sets = [f'--set=contact."{name}".method="{method}"' for name in names]
    subprocess.run([carom, "run", case, "--no-report", "--quiet", "--out", out, *sets])
    manifest = json.loads((out / "manifest.json").read_text())
    metrics = json.loads((out / "metrics.json").read_text())["metrics"]
    return manifest, {metric["name"]: metric for metric in metrics}


def number(value):
    return "–" if value is None else f"{value:.5g}"


def rows(carom, name, folder):
    """The rows of a case: quantity, what is expected of it, and a value by method."""
    records = []
    for method in METHODS:
        out = folder / f"{name.replace('/', '-')}-{method}"
        records.append(record(carom, CASES / f"{name}.toml", method, out))
    manifests = [manifest for manifest, _ in records]
    for each in zip(*(manifest["expectations"] for manifest in manifests)):
        what = each[0]["what"].replace("|", "\\|")
        yield f"`{what}`", each[0]["expected"], [number(of["got"]) for of in each]
    for metric in METRICS:
        found = [metrics.get(metric) for _, metrics in records]
        if any(of and of["value"] is not None for of in found):
            unit = next(of["unit"] for of in found if of)
            values = [number(of and of["value"]) for of in found]
            yield f"{metric} [{unit}]" if unit else metric, "", values


def main():
    carom, *cases = sys.argv[1:]
    print("| case | quantity | expected | node-to-segment | mortar |")
    print("| --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for name in cases or DEFAULT:
            for quantity, expected, values in rows(carom, name, Path(folder)):
                print(f"| {name} | {quantity} | {expected} | {' | '.join(values)} |", flush=True)


if __name__ == "__main__":
    main()
