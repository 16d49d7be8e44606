#!/usr/bin/env python3
"""Plots @NAME@.csv into @NAME@-redrawn.pdf: python3 @NAME@.py  (needs matplotlib)"""
import csv, pathlib
import matplotlib.pyplot as plt
from matplotlib.collections import PolyCollection
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

here = pathlib.Path(__file__).resolve().parent
panes = {}
with open(here / "@NAME@.csv", encoding="utf-8", newline="") as file:
    for row in csv.DictReader(file):
        cell = panes.setdefault(row["pane"], {}).setdefault((row["body"], row["cell"]), [])
        cell.append([float(row[key]) if row[key] else None for key in ("x", "y", "z", "value")])

titles = list(panes)
corners = [corner for cells in panes.values() for cell in cells.values() for corner in cell]
solid, coloured = corners[0][2] is not None, corners[0][3] is not None
axis = range(3 if solid else 2)
spans = [(min(c[i] for c in corners), max(c[i] for c in corners)) for i in axis]
most = max(c[3] for c in corners) if coloured else 1.0
bodies = list(dict.fromkeys(body for cells in panes.values() for body, _ in cells))
figure, axes = plt.subplots(
    1, len(panes), figsize=(3.0 * len(panes) + 1, 3.6), squeeze=False, layout="constrained",
    subplot_kw={"projection": "3d" if solid else None},
)
for ax, (title, cells) in zip(axes.flat, panes.items()):
    kind = Poly3DCollection if solid else PolyCollection
    faces = [[corner[: len(axis)] for corner in cell] for cell in cells.values()]
    drawn = kind(faces, edgecolors="#667", linewidths=0.3)
    if coloured:
        drawn.set(array=[sum(c[3] for c in cell) / len(cell) for cell in cells.values()], cmap="YlOrRd", clim=(0.0, most))
    else:
        drawn.set_facecolor([f"C{bodies.index(body)}" for body, _ in cells])
        drawn.set_alpha(0.4)
    ax.add_collection(drawn)
    ax.set(title=title, xlabel=@X@, ylabel=@Y@, xlim=spans[0])
    if solid:
        ax.set(ylim=spans[1], zlim=spans[2], zlabel=@Z@)
        ax.locator_params(nbins=4)
        ax.set_box_aspect([high - low or 1.0 for low, high in spans])
    elif spans[1][0] < spans[1][1]:
        ax.set(ylim=spans[1], aspect="equal")
if coloured:
    figure.colorbar(drawn, ax=axes, label=@VALUE@)
figure.savefig(here / "@NAME@-redrawn.pdf")
