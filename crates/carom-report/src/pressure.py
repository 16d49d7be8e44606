#!/usr/bin/env python3
"""Plots pressure.csv into pressure-redrawn.pdf: python3 pressure.py  (needs matplotlib)"""
import csv, pathlib
import matplotlib.pyplot as plt

here = pathlib.Path(__file__).resolve().parent
contacts = {}
with open(here / "pressure.csv", encoding="utf-8", newline="") as file:
    for row in csv.DictReader(file):
        contacts.setdefault(row["contact"], []).append([float(row[k]) for k in ("time", "s", "pressure")])

figure, axes = plt.subplots(
    len(contacts), figsize=(7.2, 2.6 * len(contacts) + 0.4), squeeze=False, layout="constrained"
)
for ax, (contact, rows) in zip(axes.flat, contacts.items()):
    time, s, pressure = zip(*rows)
    points = ax.scatter(time, s, c=pressure, cmap="YlOrRd", marker="s", s=6, vmin=0)
    figure.colorbar(points, ax=ax, label=@P@)
    ax.set(title=contact, xlabel=@T@, ylabel=@S@)
figure.savefig(here / "pressure-redrawn.pdf")
