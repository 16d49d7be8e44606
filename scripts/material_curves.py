#!/usr/bin/env python3
"""Draws the curves of the chapter "Materials" from runs of docs/book/examples/unit-cell.toml.

    scripts/material_curves.py [--carom target/release/carom] [OUT.svg]

Each curve is a run with another material or another motion of the grip; the default picture is
docs/book/src/theory/materials.svg. Needs only Python and a built carom.
"""

import argparse
import csv
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASE = ROOT / "docs/book/examples/unit-cell.toml"
# Elastic laws with the shear modulus 1 and the bulk modulus 1000.
NEARLY = "lambda = 999.3333, mu = 1.0"
RUBBER = {
    "neo-Hookean": f'law = "neo-hookean", {NEARLY}',
    "Mooney–Rivlin": 'law = "mooney-rivlin", c10 = 0.3, c01 = 0.2, bulk = 1000.0',
    "Yeoh": 'law = "yeoh", c10 = 0.5, c20 = -0.02, c30 = 0.004, bulk = 1000.0',
    "Hencky": f'law = "hencky", {NEARLY}',
}
STEEL = 'law = "hencky", young = 206.9e3, poisson = 0.29, plastic = '
METAL = {
    "perfectly plastic": STEEL + "{ yield = 450.0 }",
    "linear hardening": STEEL + "{ yield = 450.0, hardening = 2000.0 }",
    "Voce": STEEL + "{ yield = 450.0, hardening = 129.24, voce = { rise = 265.0, rate = 16.93 } }",
}
COLOURS = ["#1f6fb4", "#d1602c", "#2c8a57", "#7a4fa3"]
WIDTH, HEIGHT, MARGIN = 380, 300, 52


def curve(carom, place, material, motion, step):
    """Stretch and force of a run."""
    out = place / str(len(list(place.iterdir())))
    sets = [
        f'material=[{{ name = "m", density = 1.0, {material} }}]',
        f'support.grip.move.x="{motion}"',
        f"time.step={step}",
        "expect=[]",
        'probe=[{ name = "end", body = "cell", at = [1.0, 1.0, 1.0], record = ["ux"] }]',
    ]
    command = [carom, "run", CASE, "--no-report", "--quiet", "--out", out]
    subprocess.run([*command, *(word for given in sets for word in ("--set", given))], check=True)
    with open(out / "history.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return [(1 + float(row["end.ux"]), float(row["grip.reaction_x"])) for row in rows]


def panel(left, title, axes, curves, ranges, names):
    """Parts of an SVG: axes with ticks, and curves with their names below a place."""
    (x0, x1, xs), (y0, y1, ys) = ranges
    right, low, high = left + WIDTH - MARGIN - 12, HEIGHT - MARGIN, 30
    place_x = lambda x: left + MARGIN + (x - x0) / (x1 - x0) * (right - left - MARGIN)
    place_y = lambda y: low - (y - y0) / (y1 - y0) * (low - high)
    parts = [f'<text x="{left + MARGIN}" y="18" font-weight="bold">{title}</text>']
    count = lambda first, last, step: [first + k * step for k in range(round((last - first) / step) + 1)]
    for x in count(x0, x1, xs):
        at = place_x(x)
        parts.append(f'<path d="M{at:.1f} {high}V{low}" stroke="#8884"/>')
        parts.append(f'<text x="{at:.1f}" y="{low + 16}" text-anchor="middle">{x:.3g}</text>')
    for y in count(y0, y1, ys):
        at = place_y(y)
        parts.append(f'<path d="M{left + MARGIN} {at:.1f}H{right}" stroke="#8884"/>')
        parts.append(f'<text x="{left + MARGIN - 6}" y="{at + 4:.1f}" text-anchor="end">{y:.3g}</text>')
    parts.append(f'<text x="{(left + MARGIN + right) / 2:.0f}" y="{low + 36}" text-anchor="middle">{axes[0]}</text>')
    middle = (low + high) / 2
    turned = f'transform="rotate(-90 {left + 12} {middle:.0f})"'
    parts.append(f'<text x="{left + 12}" y="{middle:.0f}" text-anchor="middle" {turned}>{axes[1]}</text>')
    for k, (colour, (name, points)) in enumerate(zip(COLOURS, curves.items())):
        inside = [(x, y) for x, y in points if y0 <= y <= y1]
        line = " ".join(f"{place_x(x):.1f},{place_y(y):.1f}" for x, y in inside)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="1.8"/>')
        parts.append(f'<text x="{left + names[0]}" y="{names[1] + 16 * k}" fill="{colour}">{name}</text>')
    return parts


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--carom", default=ROOT / "target/release/carom")
    parser.add_argument("out", nargs="?", default=ROOT / "docs/book/src/theory/materials.svg", type=pathlib.Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as directory:
        place = pathlib.Path(directory)
        pull, press = "2*t", "-0.5*t"
        rubber = {}
        for name, material in RUBBER.items():
            pressed = curve(given.carom, place, material, press, 0.02)
            rubber[name] = [*reversed(pressed), *curve(given.carom, place, material, pull, 0.02)]
        # Loaded, unloaded, pressed, and pulled again.
        cycle = "if(t < 0.4, 0.05*t, if(t < 0.8, 0.05*(0.8 - t), 0.15*(t - 0.8)))"
        metal = {name: curve(given.carom, place, material, cycle, 0.005) for name, material in METAL.items()}
    axes = ("stretch λ", "force per undeformed area / μ")
    parts = panel(0, "Rubber", axes, rubber, ((0.5, 3.0, 0.5), (-4.0, 6.0, 2.0)), (62, 48))
    axes = ("stretch λ", "force per undeformed area, MPa")
    parts += panel(WIDTH, "Metal", axes, metal, ((1.0, 1.03, 0.01), (-600.0, 800.0, 200.0)), (96, 160))
    box = f'viewBox="0 0 {2 * WIDTH} {HEIGHT}" width="{2 * WIDTH}" height="{HEIGHT}"'
    style = 'font-family="DejaVu Sans, Helvetica, Arial, sans-serif" font-size="12"'
    ground = f'<rect width="{2 * WIDTH}" height="{HEIGHT}" fill="#ffffff"/>'
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" {box} {style}>', ground, *parts, "</svg>", ""]
    given.out.write_text("\n".join(svg), encoding="utf-8")


if __name__ == "__main__":
    main()
