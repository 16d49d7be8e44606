#!/usr/bin/env python3
"""Plots stick-slip.csv into stick-slip-redrawn.pdf: python3 stick-slip.py  (needs matplotlib)"""
import csv, pathlib
import matplotlib.pyplot as plt

here = pathlib.Path(__file__).resolve().parent
contacts = {}
with open(here / "stick-slip.csv", encoding="utf-8", newline="") as file:
    for row in csv.DictReader(file):
        state = "sticks" if row["state"] != "slip" else @ALONG@ if float(row["traction"]) < 0 else @AGAINST@
        times, places = contacts.setdefault(row["contact"], {}).setdefault(state, ([], []))
        times.append(float(row["time"])); places.append(float(row["s"]))

colors = {"sticks": "#56b4e9", @AGAINST@: "#d55e00", @ALONG@: "#009e73"}
figure, axes = plt.subplots(
    len(contacts), figsize=(7.2, 2.6 * len(contacts) + 0.4), squeeze=False, layout="constrained"
)
for ax, (contact, states) in zip(axes.flat, contacts.items()):
    for state, (times, places) in states.items():
        ax.scatter(times, places, color=colors[state], marker="s", s=5, label=state)
    ax.set(title=contact, xlabel=@T@, ylabel=@S@)
    ax.legend(fontsize=8)
figure.savefig(here / "stick-slip-redrawn.pdf")
