#!/usr/bin/env python3
"""Generates the meshes of cases/friction, in the format of Gmsh 2.2 with triangles of second order.

    python3 scripts/make_friction_meshes.py

disc.msh: a disc of radius 0.5 about the origin with 256 cells along its arc and half as many on each
ring further inside. Surface `disc`; curve `arc`.

belt.msh: a belt of thickness 0.01 along a quarter of a circle of radius 1 about the origin, from (1, 0)
to (0, 1), with straight ends of length 0.1. Surface `belt`; curves `inner`, `low` and `far` (the ends).
"""

from math import cos, pi, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent.parent / "cases" / "friction"
RADII = [0.5, 0.488, 0.466, 0.426, 0.351, 0.22]  # each with half the cells of the one before
EDGES = 256


def disc():
    nodes = {}

    def corner(ring, j):
        n = EDGES >> ring
        angle = 2 * pi * (j % n) / n - pi / 2
        place = (RADII[ring] * cos(angle), RADII[ring] * sin(angle))
        return nodes.setdefault((ring, j % n), (len(nodes) + 1, place))

    def middle(a, b, on_arc):
        x, y = (a[1][0] + b[1][0]) / 2, (a[1][1] + b[1][1]) / 2
        scale = RADII[0] / (x * x + y * y) ** 0.5 if on_arc else 1
        key = (min(a[0], b[0]), max(a[0], b[0]), "middle")
        return nodes.setdefault(key, (len(nodes) + 1, (x * scale, y * scale)))

    cells, arc = [], []

    def cell(a, b, c, on_arc=False):
        mid = [middle(a, b, on_arc), middle(b, c, False), middle(c, a, False)]
        cells.append([p[0] for p in [a, b, c] + mid])
        if on_arc:
            arc.append([a[0], b[0], mid[0][0]])

    for ring in range(len(RADII) - 1):
        for j in range(EDGES >> (ring + 1)):
            a, b, c = (corner(ring, 2 * j + i) for i in range(3))
            p, q = corner(ring + 1, j), corner(ring + 1, j + 1)
            cell(a, b, p, ring == 0)
            cell(b, q, p)
            cell(b, c, q, ring == 0)
    last = len(RADII) - 1
    centre = nodes.setdefault("centre", (len(nodes) + 1, (0.0, 0.0)))
    for j in range(EDGES >> last):
        cell(corner(last, j), corner(last, j + 1), centre)
    write("disc.msh", nodes, {"disc": cells, "arc": arc})


def belt(cells_of_arc=90, cells_of_end=6):
    count = cells_of_arc + 2 * cells_of_end
    nodes = {}

    def node(i, j):
        """Node i of 2 count along the belt and j of 2 through its thickness."""
        r, s = 1 + 0.005 * j, i / 2 - cells_of_end
        if s < 0:
            place = (r, 0.1 * s / cells_of_end)
        elif s > cells_of_arc:
            place = (0.1 * (cells_of_arc - s) / cells_of_end, r)
        else:
            angle = pi / 2 * s / cells_of_arc
            place = (r * cos(angle), r * sin(angle))
        return nodes.setdefault((i, j), (len(nodes) + 1, place))[0]

    cells = []
    for i in range(0, 2 * count, 2):
        p = [[node(i + k, j) for j in range(3)] for k in range(3)]
        cells.append([p[0][0], p[0][2], p[2][2], p[0][1], p[1][2], p[1][1]])
        cells.append([p[0][0], p[2][2], p[2][0], p[1][1], p[2][1], p[1][0]])
    inner = [[node(i, 0), node(i + 2, 0), node(i + 1, 0)] for i in range(0, 2 * count, 2)]
    low = [[node(0, 0), node(0, 2), node(0, 1)]]
    far = [[node(2 * count, 0), node(2 * count, 2), node(2 * count, 1)]]
    write("belt.msh", nodes, {"belt": cells, "inner": inner, "low": low, "far": far})


def write(name, nodes, groups):
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    elements = []
    for tag, (group, cells) in enumerate(groups.items(), 1):
        dimension = 2 if tag == 1 else 1
        lines.append(f'{dimension} {tag} "{group}"')
        elements += [(9 if dimension == 2 else 8, tag, c) for c in cells]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{k} {x:.17g} {y:.17g} 0" for k, (x, y) in nodes.values()]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    for k, (kind, tag, e) in enumerate(elements):
        lines.append(f"{k + 1} {kind} 2 {tag} {tag} " + " ".join(map(str, e)))
    (HERE / name).write_text("\n".join(lines + ["$EndElements", ""]))


if __name__ == "__main__":
    disc()
    belt()
