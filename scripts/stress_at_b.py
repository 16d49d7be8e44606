"""Convergence of the contact stress of the paper's impact, σ_yy at B, with both contact methods.

    python3 scripts/stress_at_b.py CAROM OUT [--levels 3]

Refines mesh and time step of cases/impact/impact.toml together, by 1, 2, 4 …, with node-to-segment
and mortar contact and three integrators, and prints, in percent, how much the history on each level
differs from that on the next one: ‖e‖₂ of the stress itself, and of its mean over a window of 1/16
of the contact, each over the norm of the finer history.
"""

import argparse
import bisect
import csv
import subprocess
from pathlib import Path

STEP = 1.875e-3
SCHEMES = {
    "ρ∞ = 0.1": '{ kind = "chung-hulbert", rho_inf = 0.1 }',
    "ρ∞ = 0.6": '{ kind = "chung-hulbert", rho_inf = 0.6 }',
    "trapezoidal": '{ kind = "newmark", beta = 0.25, gamma = 0.5 }',
}
METHODS = ("node-to-segment", "mortar")
SAMPLES = 2000
END = 0.55


def history(carom, out, level, method, scheme):
    """Times and σ_yy at B of a run; made once."""
    factor = 2**level
    if not (out / "manifest.json").exists():
        case = Path(__file__).parent.parent / "cases/impact/impact.toml"
        sets = {
            "contact.strike.method": f'"{method}"',
            "time.scheme": scheme,
            "time.step": STEP / factor,
            "time.end": 0.6,
            "output.fields_every": 0,
            "body.cylinder.mesh.size": 0.1 / factor,
            "body.prism.mesh.cells": [8 * factor, 4 * factor],
            "probe.B.record": '["uy", "sigma_yy"]',
        }
        command = [carom, "run", case, "--out", out]
        for key, value in sets.items():
            command += ["--set", f"{key}={value}"]
        subprocess.run(command, check=True, capture_output=True)
    with open(out / "history.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return [float(row["time"]) for row in rows], [float(row["B.sigma_yy"]) for row in rows]


def integral(times, values):
    """The integral of a history from its start to each of its times, by trapezia."""
    sums = [0.0]
    for i in range(1, len(times)):
        sums.append(sums[-1] + 0.5 * (values[i] + values[i - 1]) * (times[i] - times[i - 1]))
    return sums


def at(times, values, t):
    """Linear interpolation."""
    i = min(max(bisect.bisect_right(times, t), 1), len(times) - 1)
    share = (t - times[i - 1]) / (times[i] - times[i - 1])
    return values[i - 1] + share * (values[i] - values[i - 1])


def sampled(times, values, window):
    """Values, or means over a window, at equidistant times."""
    grid = [0.02 + (END - 0.02) * k / SAMPLES for k in range(SAMPLES + 1)]
    if window == 0:
        return [at(times, values, t) for t in grid]
    sums = integral(times, values)
    half = window / 2
    return [(at(times, sums, t + half) - at(times, sums, t - half)) / window for t in grid]


def distance(one, other, window):
    a, b = (sampled(*history, window) for history in (one, other))
    norm = sum(y * y for y in b) ** 0.5
    return 100 * sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5 / norm


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("carom", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--levels", type=int, default=3)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    print("| contact | integrator | " + " | ".join(f"{2**k} → {2 ** (k + 1)}, itself / mean" for k in range(options.levels - 1)) + " |")
    print("|---|---|" + "---|" * (options.levels - 1))
    for method in METHODS:
        for name, scheme in SCHEMES.items():
            runs = [
                history(options.carom, options.out / f"{method}-{k}-{len(name)}{name[-1]}", k, method, scheme)
                for k in range(options.levels)
            ]
            pairs = list(zip(runs, runs[1:]))
            cells = [f"{distance(a, b, 0):.1f} / {distance(a, b, END / 16):.1f}" for a, b in pairs]
            print(f"| {method} | {name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
