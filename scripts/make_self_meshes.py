#!/usr/bin/env python3
"""Generates the meshes of cases/self, in the format of Gmsh 2.2 with triangles of second order.

    python3 scripts/make_self_meshes.py

strips.msh: the strips −10 ≤ x ≤ 0 and 0 ≤ x ≤ 3 of height 1, without common nodes. Surfaces `first`,
`second`, and `both` of all cells; curves `left` (x = −10), `joint` and `face` (x = 0).

slit.msh, solid.msh: a strip 0 ≤ x ≤ 6, 0 ≤ y ≤ 1, with a closed slit at x = 3 from y = 1/4 up, and
without. Surface `bar`; curves `left` and `right`.

pinched.msh: a ring of radii 0.4 and 0.5, of which the halves y > 0 and y < 0 are mirror images.
Surfaces `ring` and `half` (y > 0); curves `right` and `left`, the ends of the half.

thin.msh: a ring of centre-line radius 1 + 0.001 cos 2φ and thickness 0.02. Surface `ring`; curves
`inner` and `outer`.
"""

from math import cos, pi, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent.parent / "cases" / "self"


class Mesh:
    """Nodes by key, so that equal keys are one node; cells and edges by group."""

    def __init__(self):
        self.nodes, self.groups = {}, {}

    def node(self, key, place):
        return self.nodes.setdefault(key, (len(self.nodes) + 1, place))[0]

    def add(self, dimension, group, nodes):
        self.groups.setdefault((dimension, group), []).append(nodes)

    def write(self, name):
        names = {group: k + 1 for k, group in enumerate(self.groups)}
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
        lines += [f'{d} {k} "{group}"' for (d, group), k in names.items()]
        lines += ["$EndPhysicalNames", "$Nodes", str(len(self.nodes))]
        lines += [f"{k} {x:.17g} {y:.17g} 0" for k, (x, y) in self.nodes.values()]
        elements = [(names[group], group[0], nodes) for group, all in self.groups.items() for nodes in all]
        lines += ["$EndNodes", "$Elements", str(len(elements))]
        for k, (tag, d, nodes) in enumerate(elements):
            lines.append(f"{k + 1} {8 if d == 1 else 9} 2 {tag} {tag} " + " ".join(map(str, nodes)))
        (HERE / name).write_text("\n".join(lines + ["$EndElements", ""]))


def grid(mesh, columns, rows, place, key, groups, mirrored=False):
    """Cells of a grid. Node (i, j) counts half cells; `key` says which nodes are one."""

    def node(i, j, column, row):
        return mesh.node(key(i, j, column, row), place(i, j))

    for c in range(columns):
        for r in range(rows):
            p = [[node(2 * c + i, 2 * r + j, c, r) for j in range(3)] for i in range(3)]
            lower = [p[0][0], p[2][0], p[2][2], p[1][0], p[2][1], p[1][1]]
            upper = [p[0][0], p[2][2], p[0][2], p[1][1], p[1][2], p[0][1]]
            for a in (lower, upper):
                cell = [a[0], a[2], a[1], a[5], a[4], a[3]] if mirrored else a
                for group in groups:
                    mesh.add(2, group, cell)


def edges(mesh, group, nodes):
    """Edges along a list of nodes, two for each edge and one at the end."""
    for k in range(0, len(nodes) - 1, 2):
        mesh.add(1, group, [nodes[k], nodes[k + 2], nodes[k + 1]])


def strips():
    mesh = Mesh()
    for name, start, columns in (("first", -10.0, 40), ("second", 0.0, 12)):
        place = lambda i, j, start=start: (start + i / 8, j / 4)
        grid(mesh, columns, 2, place, lambda i, j, c, r, name=name: (name, i, j), (name, "both"))
    at = lambda name, i: [mesh.nodes[name, i, j][0] for j in range(5)]
    for group, nodes in (("left", at("first", 0)), ("face", at("first", 80)), ("joint", at("second", 0))):
        edges(mesh, group, nodes)
    mesh.write("strips.msh")


def bar(name, slit):
    mesh = Mesh()

    def key(i, j, column, row):
        return (i, j, slit and i == 24 and j > 2 and column >= 12)

    grid(mesh, 24, 4, lambda i, j: (i / 8, j / 8), key, ("bar",))
    for group, i in (("left", 0), ("right", 48)):
        edges(mesh, group, [mesh.nodes[i, j, False][0] for j in range(9)])
    mesh.write(name)


def pinched():
    mesh, columns = Mesh(), 24
    for sign in (1, -1):

        def place(i, j):
            angle, radius = pi * i / (2 * columns), 0.5 - 0.05 * j
            if i == 2 * columns:
                return (-radius, 0.0)
            return (radius * cos(angle), sign * radius * sin(angle))

        # Radii fall along j, so that the upper half is traversed clockwise.
        key = lambda i, j, c, r: (i, j, sign if 0 < i < 2 * columns else 0)
        grid(mesh, columns, 1, place, key, ("ring", "half") if sign == 1 else ("ring",), sign == 1)
    for group, i in (("right", 0), ("left", 2 * columns)):
        edges(mesh, group, [mesh.nodes[i, j, 0][0] for j in range(3)])
    mesh.write("pinched.msh")


def thin():
    mesh, columns = Mesh(), 256

    def place(i, j):
        angle = pi * i / columns
        radius = 1.0 + 0.001 * cos(2 * angle) - 0.01 * (j - 1)
        return (radius * cos(angle), radius * sin(angle))

    grid(mesh, columns, 1, place, lambda i, j, c, r: (i % (2 * columns), j), ("ring",), True)
    for group, j in (("outer", 0), ("inner", 2)):
        edges(mesh, group, [mesh.nodes[i % (2 * columns), j][0] for i in range(2 * columns + 1)])
    mesh.write("thin.msh")


if __name__ == "__main__":
    strips()
    bar("slit.msh", True)
    bar("solid.msh", False)
    pinched()
    thin()
