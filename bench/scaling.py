#!/usr/bin/env python3
"""Seconds and memory of explicit runs over their size and the number of threads: a table and a figure.

    bench/scaling.py [--carom PATH] [--cells 1e3 1e4 1e5 1e6] [--threads 1 2] [--figure FILE.svg]

A block of linear tetrahedra strikes a rigid plane with its whole lower face: contact in every step
after the first, a row of the history per step, no fields, no page. Set-up is everything before the
first step: reading, mesh, model, checks. The peak is the largest resident size of the process.

The floor of a step is the larger of two times, both measured in the same run by `cargo bench -p
carom-run --bench explicit -- floors`: to move what any code must move per step at the bandwidth of a
triad, and to evaluate the law alone for cells that stay in the cache. Steps are timed by the fastest
of several runs, set-up by their median. It needs an idle machine.
"""

import argparse
import json
import os
import pathlib
import re
import statistics
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASE = """
title = "A block of linear tetrahedra strikes a rigid plane"
dimension = 3
material = [{{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }}]
contact = [{{ name = "floor", secondary = "block.bottom", primary = {{ plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }} }} }}]
output = {{ fields_every = 0, checkpoint_every = 1000000 }}

[[body]]
name = "block"
material = "rubber"
element = "Tet4"
mass = "lumped"
mesh = {{ shape = "box", min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 1.0], cells = [{n}, {n}, {n}] }}
velocity = [0.0, 0.0, -3.0]

[time]
end = {end!r}
step = {step!r}
scheme = {{ kind = "central-difference" }}
"""
# Steps so short that no matrix is needed to know that they are stable: a third of a cell's edge per
# time of a pressure wave, whose speed is √((λ + 2μ)/ρ).
SHARE = 0.1
SPEED = ((200.0 + 2 * 15.0) / 0.25) ** 0.5
PER_BOX = 6


def floors():
    """Nanoseconds per cell: bytes moved at the bandwidth of a triad, the law alone."""
    command = ["cargo", "bench", "-q", "-p", "carom-run", "--bench", "explicit", "--", "floors"]
    text = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    found = re.search(r"memory\s+([\d.]+) ns per cell.*arithmetic\s+([\d.]+) ns", text)
    return {"memory": float(found[1]), "arithmetic": float(found[2])}


def run(carom, n, steps, threads):
    """Seconds of set-up and of a step, and the peak in MiB."""
    step = SHARE / n / SPEED
    with tempfile.TemporaryDirectory() as directory:
        case = pathlib.Path(directory, "block.toml")
        case.write_text(CASE.format(n=n, step=step, end=step * steps))
        out = pathlib.Path(directory, "run")
        command = [carom, "run", case, "--out", out, "--no-report", "--quiet", "--threads", str(threads)]
        began = time.monotonic()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - began
        if status != 0:
            raise SystemExit(f"{n}³ boxes: exit status {status}")
        manifest = json.loads((out / "manifest.json").read_text())
        timings = manifest["timings"]
        return {
            "setup": seconds - timings["total"],
            "step": timings["total"] / steps,
            "peak": usage.ru_maxrss / 1024,
        }


def measure(carom, cells, threads, rounds):
    n = max(2, round((cells / PER_BOX) ** (1 / 3)))
    count = PER_BOX * n**3
    steps = int(min(400, max(20, 4e6 / count)))
    done = [run(carom, n, steps, threads) for _ in range(rounds)]
    return {
        "cells": count,
        "threads": threads,
        "setup": statistics.median(one["setup"] for one in done),
        "step": min(one["step"] for one in done),
        "peak": max(one["peak"] for one in done),
    }


def table(rows, floor):
    bound = max(floor.values())
    first = {row["cells"]: row["step"] for row in rows if row["threads"] == min(r["threads"] for r in rows)}
    print(f"floor: {floor['memory']:.1f} ns per cell to move the data, {floor['arithmetic']:.1f} ns for the law alone\n")
    print("| cells | threads | set-up | step | per cell | of the floor | against one thread | peak | per cell |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for row in rows:
        per_cell = 1e9 * row["step"] / row["cells"]
        print(
            f"| {row['cells']:_} | {row['threads']} | {row['setup']:.2f} s | {1e3 * row['step']:.3g} ms | {per_cell:.1f} ns"
            f" | {per_cell / bound:.1f} | {first[row['cells']] / row['step']:.2f} | {row['peak']:.0f} MiB"
            f" | {row['peak'] * 2**20 / row['cells']:.0f} B |".replace("_", " ")
        )


def figure(rows, floor, path):
    """Nanoseconds per cell and step over the number of cells, with the floor."""
    import math

    width, height, left, bottom, top = 640, 360, 60, 50, 20
    bound = max(floor.values())
    values = [1e9 * row["step"] / row["cells"] for row in rows] + [bound]
    low = 10 ** math.floor(math.log10(min(values)))
    high = 10 ** math.ceil(math.log10(max(values)))
    sizes = [row["cells"] for row in rows]
    first = 10 ** math.floor(math.log10(min(sizes)))
    last = 10 ** math.ceil(math.log10(max(sizes)))

    def x(cells):
        return left + (width - left - 20) * math.log(cells / first) / math.log(last / first)

    def y(value):
        return height - bottom - (height - bottom - top) * math.log(value / low) / math.log(high / low)

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="13">',
             f'<rect width="{width}" height="{height}" fill="white"/>']
    power = first
    while power <= last:
        parts.append(f'<line x1="{x(power):.1f}" x2="{x(power):.1f}" y1="{top}" y2="{height - bottom}" stroke="#ddd"/>')
        parts.append(f'<text x="{x(power):.1f}" y="{height - bottom + 18}" text-anchor="middle">10<tspan dy="-5" font-size="9">{round(math.log10(power))}</tspan></text>')
        power *= 10
    value = low
    while value <= high:
        parts.append(f'<line x1="{left}" x2="{width - 20}" y1="{y(value):.1f}" y2="{y(value):.1f}" stroke="#ddd"/>')
        parts.append(f'<text x="{left - 8}" y="{y(value) + 4:.1f}" text-anchor="end">{value:g}</text>')
        value *= 10
    parts.append(f'<text x="{(left + width - 20) / 2}" y="{height - 10}" text-anchor="middle">cells</text>')
    middle = (top + height - bottom) / 2
    parts.append(f'<text x="16" y="{middle}" text-anchor="middle" transform="rotate(-90 16 {middle})">ns per cell and step</text>')
    colours = ["#1f4e9c", "#c8501e", "#2d7d46", "#7b3f9d", "#555555"]
    threads = sorted({row["threads"] for row in rows})
    for colour, count in zip(colours, threads):
        points = [(x(row["cells"]), y(1e9 * row["step"] / row["cells"])) for row in rows if row["threads"] == count]
        line = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3" fill="{colour}"/>' for a, b in points]
        label = "1 thread" if count == 1 else f"{count} threads"
        place = top + 16 + 18 * threads.index(count)
        parts.append(f'<text x="{width - 30}" y="{place}" text-anchor="end" fill="{colour}">{label}</text>')
    parts.append(f'<line x1="{left}" x2="{width - 20}" y1="{y(bound):.1f}" y2="{y(bound):.1f}" stroke="black" stroke-dasharray="6 4"/>')
    parts.append(f'<text x="{left + 6}" y="{y(bound) - 6:.1f}">floor of one thread, {bound:.1f} ns</text>')
    parts.append("</svg>\n")
    pathlib.Path(path).write_text("\n".join(parts))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--carom", default=ROOT / "target/release/carom", help="the program")
    parser.add_argument("--cells", type=float, nargs="+", default=[1e3, 1e4, 1e5, 1e6])
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--rounds", type=int, default=3, help="runs of each")
    parser.add_argument("--floor", type=float, nargs=2, help="the two floors in ns per cell, if they are known")
    parser.add_argument("--figure", help="file of the figure")
    options = parser.parse_args()
    floor = dict(zip(("memory", "arithmetic"), options.floor)) if options.floor else floors()
    rows = [measure(options.carom, cells, threads, options.rounds) for cells in options.cells for threads in options.threads]
    table(rows, floor)
    if options.figure:
        figure(rows, floor, options.figure)


if __name__ == "__main__":
    main()
