#!/usr/bin/env python3
"""Generates the mesh of the rolling discs of cases/friction, in the format of Gmsh 2.2 with triangles
of second order.

    python3 scripts/make_friction_meshes.py

disc.msh: a disc of radius 0.5 about the origin with 256 cells along its arc and half as many on each
ring further inside. Surface `disc`; curve `arc`.
"""

from math import cos, pi, sin
from pathlib import Path

FILE = Path(__file__).resolve().parent.parent / "cases" / "friction" / "disc.msh"
RADII = [0.5, 0.488, 0.466, 0.426, 0.351, 0.22]  # each with half the cells of the one before
EDGES = 256


def main():
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

    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '2 1 "disc"', '1 2 "arc"']
    lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{k} {x:.17g} {y:.17g} 0" for k, (x, y) in nodes.values()]
    elements = [(9, 1, c) for c in cells] + [(8, 2, e) for e in arc]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    for k, (kind, tag, e) in enumerate(elements):
        lines.append(f"{k + 1} {kind} 2 {tag} {tag} " + " ".join(map(str, e)))
    FILE.write_text("\n".join(lines + ["$EndElements", ""]))


if __name__ == "__main__":
    main()
