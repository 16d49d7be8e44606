#!/usr/bin/env python3
"""Seconds and memory of runs over their size and the number of threads: the page of the book.

    bench/scaling.py [--carom PATH] [--threads 1 2] [--largest 1e6] [--rounds 2] [--page DIRECTORY]

Three jobs, all in contact, with a row of the history per step, no fields, no report:

    explicit          a block of linear tetrahedra strikes a rigid plane with its whole lower face
    implicit, plane   a disc of cubic triangles strikes a block
    implicit, space   a ball of quadratic tetrahedra strikes a rigid plane

Set-up is everything before the first step: reading, mesh, model, checks. The peak is the largest
resident size of the process. The floor of an explicit step is the larger of two times, both
measured in the same run by `cargo bench -p carom-run --bench explicit -- floors`: to move what any
code must move per step at the bandwidth of a triad, and to evaluate the law alone for cells that
stay in the cache. Runs with different numbers of threads take turns; steps are timed by the
fastest run, set-up by the median. It needs an idle machine. With --page, the table and the figures
of the book are replaced: scaling.md between its two markers, and scaling.svg.
"""

import argparse
import dataclasses
import json
import os
import pathlib
import re
import statistics
import subprocess
import tempfile
import textwrap
import time

from scaling_figure import figure

ROOT = pathlib.Path(__file__).resolve().parent.parent
RUBBER = 'material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]'
QUIET = "output = { fields_every = 0, checkpoint_every = 1000000 }"
FLOOR = "{ plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] } }"
# Time of a pressure wave over a length of one: √(ρ/(λ + 2μ)).
WAVE = (0.25 / (200.0 + 2 * 15.0)) ** 0.5
MARKERS = "<!-- bench/scaling.py -->\n", "<!-- end of bench/scaling.py -->"


@dataclasses.dataclass
class Job:
    """A case of a size, and how many steps of it are timed."""

    name: str
    cells: int
    step: float
    steps: int
    scheme: str
    text: str

    def case(self):
        end = self.step * self.steps
        times = f"time = {{ end = {end!r}, step = {self.step!r}, scheme = {self.scheme} }}"
        return "\n".join([f'title = "{self.name}"', RUBBER, QUIET, times, self.text])


def block(cells):
    n = max(2, round((cells / 6) ** (1 / 3)))
    count = 6 * n**3
    text = f"""dimension = 3
contact = [{{ name = "floor", secondary = "block.bottom", primary = {FLOOR} }}]
[[body]]
name = "block"
material = "rubber"
element = "Tet4"
mass = "lumped"
mesh = {{ shape = "box", min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 1.0], cells = [{n}, {n}, {n}] }}
velocity = [0.0, 0.0, -3.0]
"""
    # Steps so short that no matrix is needed to know that they are stable.
    step = 0.1 / n * WAVE
    steps = int(min(400, max(20, 4e6 / count)))
    return Job("explicit", count, step, steps, '{ kind = "central-difference" }', text)


def disc(rings):
    text = f"""dimension = 2
plane = "strain"
contact = [{{ name = "strike", secondary = "disc.arc", primary = "block.top" }}]
support = [{{ on = ["block.bottom"], fix = ["x", "y"] }}]
[[body]]
name = "disc"
material = "rubber"
element = "T10"
mesh = {{ shape = "disc", radius = 1.0, center = [0.0, 1.001], size = {1.0001 / rings!r} }}
velocity = [0.0, -3.0]
[[body]]
name = "block"
material = "rubber"
element = "T10"
mesh = {{ shape = "rectangle", min = [-2.0, -1.0], max = [2.0, 0.0], cells = [{4 * rings}, {rings}] }}
"""
    cells = 6 * rings**2 + 8 * rings**2
    # Of large meshes shorter steps, in which contact reaches as many nodes.
    step = 1.875e-3 * min(1.0, 12.0 / rings)
    steps = {4: 200, 12: 40}.get(rings, 6)
    return Job("implicit, plane", cells, step, steps, '{ kind = "chung-hulbert", rho_inf = 0.5 }', text)


def ball(size, cells):
    text = f"""dimension = 3
contact = [{{ name = "floor", secondary = "ball.sphere", primary = {FLOOR} }}]
[[body]]
name = "ball"
material = "rubber"
element = "Tet10"
mesh = {{ shape = "ball", radius = 0.5, center = [0.0, 0.0, 0.5001], size = {size} }}
velocity = [0.0, 0.0, -3.0]
"""
    steps = 20 if cells < 1e4 else 6 if cells < 5e4 else 3
    return Job("implicit, space", cells, 9.375e-4, steps, '{ kind = "chung-hulbert", rho_inf = 0.5 }', text)


def jobs(largest):
    all_of = [block(cells) for cells in (1e3, 1e4, 1e5, 1e6, 1e7)]
    all_of += [disc(rings) for rings in (4, 12, 40)]
    all_of += [ball(size, cells) for size, cells in ((0.2, 1500), (0.1, 10000), (0.05, 71000))]
    return [job for job in all_of if job.cells <= 1.1 * largest]


def counts(carom, job):
    """Numbers of cells and of unknowns, as `carom check` says them."""
    with tempfile.TemporaryDirectory() as directory:
        case = pathlib.Path(directory, "case.toml")
        case.write_text(job.case())
        text = subprocess.run([carom, "check", case], check=True, capture_output=True, text=True).stdout
    found = re.findall(r"([\d_ ]+) cells, ([\d_ ]+) free dofs", text)
    return [sum(int(number.replace(" ", "")) for number in of) for of in zip(*found)]


def floors(benchmark):
    """Nanoseconds per cell: bytes moved at the bandwidth of a triad, the law alone."""
    compiling = ["cargo", "bench", "-q", "-p", "carom-run", "--bench", "explicit", "--"]
    command = [*([benchmark] if benchmark else compiling), "floors"]
    text = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    bandwidth = re.search(r"triad:\s+([\d.]+) GB/s", text)
    found = re.search(r"memory\s+([\d.]+) ns per cell.*arithmetic\s+([\d.]+) ns", text)
    return {"bandwidth": float(bandwidth[1]), "memory": float(found[1]), "arithmetic": float(found[2])}


def run(carom, job, threads):
    """Seconds of set-up and of a step, the peak in MiB, and the history."""
    with tempfile.TemporaryDirectory() as directory:
        case = pathlib.Path(directory, "case.toml")
        case.write_text(job.case())
        out = pathlib.Path(directory, "run")
        command = [carom, "run", case, "--out", out, "--no-report", "--quiet", "--threads", str(threads)]
        began = time.monotonic()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - began
        if status != 0:
            raise SystemExit(f"{job.name}, {job.cells} cells: exit status {status}")
        manifest = json.loads((out / "manifest.json").read_text())
        total = manifest["timings"]["total"]
        return {
            "setup": seconds - total,
            "step": total / job.steps,
            "peak": usage.ru_maxrss / 1024,
            "history": (out / "history.csv").read_bytes(),
        }


def measure(carom, job, threads, rounds):
    """A row for each number of threads, measured in turn; their histories must have the same bits."""
    cells, unknowns = counts(carom, job)
    done = {count: [] for count in threads}
    for _ in range(rounds):
        for count in threads:
            done[count].append(run(carom, job, count))
    histories = {one["history"] for runs in done.values() for one in runs}
    if len(histories) != 1:
        raise SystemExit(f"{job.name}, {job.cells} cells: the history depends on the number of threads")
    return [
        {
            "job": job.name,
            "cells": cells,
            "unknowns": unknowns,
            "threads": count,
            "setup": statistics.median(one["setup"] for one in runs),
            "step": min(one["step"] for one in runs),
            "peak": max(one["peak"] for one in runs),
        }
        for count, runs in done.items()
    ]


def table(rows, floor):
    bound = max(floor["memory"], floor["arithmetic"])
    alone = {(row["job"], row["cells"]): row["step"] for row in rows if row["threads"] == 1}
    measured = (
        f"Triad {floor['bandwidth']:.1f} GB/s; floor of an explicit step {floor['memory']:.1f} ns per cell to move the"
        f" data, {floor['arithmetic']:.1f} ns for the law alone; {os.cpu_count()} cores; {time.strftime('%-d %B %Y')}."
    )
    lines = [
        *textwrap.wrap(measured, 100),
        "",
        "| | cells | unknowns | threads | set-up | step | per cell | of the floor | against one thread | peak | per cell |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for row in rows:
        each = 1e9 * row["step"] / row["cells"]
        against = alone.get((row["job"], row["cells"]))
        cells, unknowns = (f"{row[of]:_}".replace("_", " ") for of in ("cells", "unknowns"))
        floors = f"{each / bound:.1f}" if row["job"] == "explicit" else ""
        speed = f"{against / row['step']:.2f}" if against else ""
        lines.append(
            f"| {row['job']} | {cells} | {unknowns} | {row['threads']} | {row['setup']:.2f} s | {short(row['step'])}"
            f" | {short(1e-9 * each)} | {floors} | {speed} | {row['peak']:.0f} MiB"
            f" | {row['peak'] * 2**20 / row['cells']:.0f} B |"
        )
    return "\n".join(lines) + "\n"


def short(seconds):
    """A time in the unit in which it is a short number."""
    for unit, name in ((1e-6, "ns"), (1e-3, "µs"), (1.0, "ms")):
        if seconds < unit:
            return f"{seconds / unit * 1e3:.3g} {name}"
    return f"{seconds:.3g} s"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--carom", default=ROOT / "target/release/carom", help="the program")
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--largest", type=float, default=1e6, help="cells of the largest job")
    parser.add_argument("--rounds", type=int, default=2, help="runs of each")
    parser.add_argument("--benchmark", help="the benchmark `explicit`, if it is compiled already")
    parser.add_argument("--page", type=pathlib.Path, help="directory of scaling.md and scaling.svg")
    options = parser.parse_args()
    floor = floors(options.benchmark)
    rows = []
    for job in jobs(options.largest):
        rounds = options.rounds if job.cells < 2e5 else 1
        rows += measure(options.carom, job, options.threads, rounds)
        print(table(rows[-len(options.threads):], floor).splitlines()[-1], flush=True)
    text = table(rows, floor)
    print(text)
    if options.page:
        page = options.page / "scaling.md"
        before, rest = page.read_text().split(MARKERS[0])
        after = rest.split(MARKERS[1])[1]
        page.write_text(before + MARKERS[0] + "\n" + text + "\n" + MARKERS[1] + after)
        bound = max(floor["memory"], floor["arithmetic"])
        (options.page / "scaling.svg").write_text(figure(rows, bound))


if __name__ == "__main__":
    main()
