#!/usr/bin/env python3
"""Plots bodies.csv into bodies-redrawn.pdf: python3 bodies.py  (needs matplotlib)"""
import csv, pathlib
import matplotlib.pyplot as plt

here = pathlib.Path(__file__).resolve().parent


def rows(name):
    with open(here / name, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


instants = {}
for row in rows("bodies.csv"):
    instants.setdefault(row["time"], []).append([float(row[key]) for key in ("x", "y", "value")])
triangles = [[int(row[key]) for key in "abc"] for row in rows("bodies.triangles.csv")]
most = max(abs(value) for points in instants.values() for _, _, value in points)

figure, axes = plt.subplots(
    1, len(instants), figsize=(2.0 * len(instants) + 1, 3.2), squeeze=False, sharey=True, layout="constrained"
)
for ax, (time, points) in zip(axes.flat, instants.items()):
    x, y, value = zip(*points)
    levels = [most * (k / 12 - 1) for k in range(25)]
    drawn = ax.tricontourf(x, y, triangles, value, levels=levels, cmap="RdBu_r")
    ax.set(title=f"t = {float(time):.4g} " + @TIME@, aspect="equal", xlabel=@X@)
axes.flat[0].set_ylabel(@Y@)
figure.colorbar(drawn, ax=axes, label=@STRESS@)
figure.savefig(here / "bodies-redrawn.pdf")
