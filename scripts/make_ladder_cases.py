#!/usr/bin/env python3
"""Generates the meshes comb.msh, zip.msh and ramp.msh and the case discs.toml of cases/ladder.

    python3 scripts/make_ladder_cases.py        (needs nothing but Python)

A mesh is a grid of squares, some of them left out, each split into two triangles; its nodes are moved
by a map. Surfaces `lower` and `upper` (comb, zip) or `ramp`; curves as named below.
"""

from math import pi, sin
from pathlib import Path

LADDER = Path(__file__).resolve().parent.parent / "cases/ladder"
TRIANGLE, LINE = {1: 2, 2: 9, 3: 21}, {1: 1, 2: 8, 3: 26}  # Gmsh's numbers of cell types


HEAD = '''\
# Twenty discs fall into a box of rigid planes and come to rest on each other. There is no friction:
# only the scheme takes energy. Written by scripts/make_ladder_cases.py.
title = "Twenty discs settle"
dimension = 2

[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
young = 2000.0
poisson = 0.3
'''

TAIL = '''
[time]
end = 6.0
step = 0.02
scheme = {{ kind = "backward-euler" }}

[output]
fields_every = 10

[[expect]]
slow = true                         # omitted by `carom verify --fast`
what = "{floor}"
value = 157.0796
relative = 5e-3
source = "the weight of twenty discs, 20 π r² ρ g"

[[expect]]
slow = true
what = "{walls}"
value = 0.0
tolerance = 0.5
source = "at rest the walls press equally"

[[expect]]
slow = true
what = "last kinetic / max kinetic"
at_most = 1e-3
source = "the discs come to rest"

[[expect]]
slow = true
what = "max penetration_secondary"
at_most = 1e-7
source = "a secondary node may enter by a millionth of a cell"

[[expect]]
slow = true
what = "max penetration"
at_most = 5.3e-3
source = "2 % of a facet, 0.26"

[[expect]]
slow = true
what = "energy_created"
at_most = 0.02
source = "the energy guard"
'''


class Mesh:
    def __init__(self):
        self.nodes, self.cells, self.names = [], [], []

    def group(self, dimension, name):
        if (dimension, name) not in self.names:
            self.names.append((dimension, name))
        return self.names.index((dimension, name)) + 1

    def add(self, surface, p, squares, place, side):
        """Adds the squares (i, j). `place` maps grid coordinates to x, y; `side` maps the middle of a
        boundary edge to the name of its curve."""
        number, edges = {}, {}

        def node(a, b):
            if (a, b) not in number:
                self.nodes.append(place(a / p, b / p))
                number[a, b] = len(self.nodes)
            return number[a, b]

        def along(a, b):
            return [tuple(((p - k) * a[d] + k * b[d]) // p for d in (0, 1)) for k in range(p + 1)]

        for i, j in squares:
            low, right, top, left = ((p * (i + a), p * (j + b)) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)))
            # Diagonals alternate, so that a mesh of an even number of squares prefers no direction.
            flip = (i + j) % 2
            for corners in ((low, right, left), (right, top, left)) if flip else ((low, right, top), (low, top, left)):
                ends = [(corners[k], corners[(k + 1) % 3]) for k in range(3)]
                inner = [n for a, b in ends for n in along(a, b)[1:-1]]
                if p == 3:
                    inner.append(tuple(sum(c[d] for c in corners) // 3 for d in (0, 1)))
                self.cells.append((TRIANGLE[p], self.group(2, surface), [node(*n) for n in [*corners, *inner]]))
                for a, b in ends:
                    edges[frozenset((a, b))] = None if frozenset((a, b)) in edges else (a, b)
        for a, b in filter(None, edges.values()):
            middle = tuple((a[d] + b[d]) / (2 * p) for d in (0, 1))
            line = along(a, b)
            cell = [node(*n) for n in (a, b, *line[1:-1])]
            self.cells.append((LINE[p], self.group(1, side(*middle)), cell))

    def write(self, name):
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(self.names))]
        lines += [f'{dimension} {i + 1} "{group}"' for i, (dimension, group) in enumerate(self.names)]
        lines += ["$EndPhysicalNames", "$Nodes", str(len(self.nodes))]
        lines += [f"{i + 1} {round(x, 12) + 0.0!r} {round(y, 12) + 0.0!r} 0" for i, (x, y) in enumerate(self.nodes)]
        lines += ["$EndNodes", "$Elements", str(len(self.cells))]
        lines += [" ".join(map(str, [i + 1, kind, 2, g, g, *cell])) for i, (kind, g, cell) in enumerate(self.cells)]
        (LADDER / name).write_text("\n".join([*lines, "$EndElements"]) + "\n")
        print(f"{name}: {len(self.nodes)} nodes")


def rake(mesh, surface, centers, neck, width, length, back, mirror, p, rows):
    """A strip of thickness `back` with a tooth at every centre: half width `width(s)` at s in [0, 1],
    `neck` = width(0). `mirror` is the y that is reflected to 0, or None."""
    lines = [x for c in centers for x in (c - neck, c, c + neck)]
    teeth = [k for k in range(len(lines) - 1) if k % 3 != 2]
    squares = [(i, 0) for i in range(len(lines) - 1)] + [(i, 1 + j) for i in teeth for j in range(rows)]

    def place(a, b):
        k = min(int(a), len(lines) - 2)
        x = lines[k] + (a - k) * (lines[k + 1] - lines[k])
        if b <= 1:
            y = back * (b - 1)
        else:
            s = (b - 1) / rows
            c = min(centers, key=lambda c: abs(c - x))
            x, y = c + (x - c) * width(s) / neck, length * s
        # A rotation, not a reflection, keeps the orientation of the cells.
        return (x, y) if mirror is None else (mirror[0] - x, mirror[1] - y)

    mesh.add(surface, p, squares, place, lambda a, b: f"{surface}_back" if b == 0 else f"{surface}_teeth")


def comb():
    mesh = Mesh()
    width = lambda s: 0.1 - 0.04 * s
    rake(mesh, "lower", [0.4 * k for k in range(5)], 0.1, width, 0.6, 0.2, None, 2, 5)
    # Off the middle by 0.06, so that the teeth bend; the tips are 0.1 above those of the lower
    # comb.
    rake(mesh, "upper", [0.4 * k for k in range(4)], 0.1, width, 0.6, 0.2, (1.46, 1.3), 2, 4)
    mesh.write("comb.msh")


def zip_of_hooks():
    mesh = Mesh()
    width = lambda s: 0.08 + (0.06 * sin(pi * (s - 0.4) / 0.6) ** 2 if s > 0.4 else 0.0)
    centers = [0.5 * k for k in range(5)]
    rake(mesh, "lower", centers, 0.08, width, 0.6, 0.15, None, 2, 8)
    rake(mesh, "upper", centers, 0.08, width, 0.6, 0.15, (2.25, 0.64), 2, 8)
    mesh.write("zip.msh")


def ramp():
    """Its side `top` is y = (1 − x)³ up to x = 1, and y = 0 from there, without a jump of curvature."""
    mesh = Mesh()
    n, m = 16, 22

    def place(a, b):
        x = a / n
        top = (1.0 - x) ** 3 if a <= n else 0.0
        return x, -0.15 + (top + 0.15) * b

    side = lambda a, b: "top" if b == 1 else "bottom" if b == 0 else "ends"
    mesh.add("ramp", 3, [(i, 0) for i in range(m)], place, side)
    mesh.write("ramp.msh")


def discs():
    """Twenty discs in rows of four, the upper ones between the lower ones, and all pairs of them."""
    radius, width, gap = 0.5, 4.5, 0.02
    text = HEAD
    names = []
    for k in range(20):
        row, column = divmod(k, 4)
        x = radius + gap + column * (2 * radius + 0.1) + (0.13 if row % 2 else 0.0)
        y = radius + gap + row * (2 * radius + gap)
        names.append(f"disc{k + 1}")
        text += f"""
[[body]]
name = "{names[-1]}"
material = "rubber"
element = "T6"
mesh = {{ shape = "disc", radius = {radius}, center = [{x:.3f}, {y:.3f}], size = 0.25 }}
gravity = [0.0, -10.0]
"""
    planes = {"floor": ((0.0, 0.0), (0.0, 1.0)), "left": ((0.0, 0.0), (1.0, 0.0)), "right": ((width, 0.0), (-1.0, 0.0))}
    for name in names:
        for plane, (point, normal) in planes.items():
            rigid = f"{{ plane = {{ point = {list(point)}, normal = {list(normal)} }} }}"
            text += f'\n[[contact]]\nname = "{name}-{plane}"\nsecondary = "{name}.arc"\nprimary = {rigid}\n'
    for a, one in enumerate(names):
        for two in names[a + 1 :]:
            text += f'\n[[contact]]\nname = "{one}-{two}"\nsecondary = "{one}.arc"\nprimary = "{two}.arc"\n'
    total = lambda *columns: "last [ " + " + ".join(f"{name}-{c}" for name in names for c in columns) + " ]"
    text += TAIL.format(floor=total("floor.force_y"), walls=total("left.force_x", "right.force_x"))
    (LADDER / "discs.toml").write_text(text)


def main():
    comb()
    zip_of_hooks()
    ramp()
    discs()


if __name__ == "__main__":
    main()
