#!/usr/bin/env python3
"""Generates the meshes of cases/friction, in the format of Gmsh 2.2 with triangles of second order.

    python3 scripts/make_friction_meshes.py

disc.msh: a disc of radius 0.5 about the origin with 256 cells along its arc and half as many on each
ring further inside. Surface `disc`; curve `arc`. fine-disc.msh: the same with 1024 cells.

belt.msh: a belt of thickness 0.01 along a quarter of a circle of radius 1 about the origin, from (1, 0)
to (0, 1), with straight ends of length 0.1. Surface `belt`; curves `inner`, `low` and `far` (the ends).
half-belt.msh and whole-belt.msh: the same along a half and a whole circle. running-belt.msh: along a
quarter, half as thick, with cells twice as long and a low end of length 1.6 that runs onto the circle.

cattaneo.msh: the disc again, with cells of 0.0061 where it is pressed below and above, |x| < 0.11, which
grow by 0.45 of the distance from there. Triangles are bisected at their longest edge until they are small
enough, neighbours first where they share no longest edge (M. C. Rivara, Int. J. Numer. Meth. Engng 20
(1984) 745-756).
"""

from math import cos, dist, pi, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent.parent / "cases" / "friction"
# Each with half the cells of the one before.
RADII = [0.5, 0.488, 0.466, 0.426, 0.351, 0.22]
FINE = [0.5, 0.497, 0.491, 0.479, 0.457, 0.417, 0.342, 0.22]


def disc(name, edges, radii):
    nodes = {}

    def corner(ring, j):
        n = edges >> ring
        angle = 2 * pi * (j % n) / n - pi / 2
        place = (radii[ring] * cos(angle), radii[ring] * sin(angle))
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

    for ring in range(len(radii) - 1):
        for j in range(edges >> (ring + 1)):
            a, b, c = (corner(ring, 2 * j + i) for i in range(3))
            p, q = corner(ring + 1, j), corner(ring + 1, j + 1)
            cell(a, b, p, ring == 0)
            cell(b, q, p)
            cell(b, c, q, ring == 0)
    last = len(radii) - 1
    centre = nodes.setdefault("centre", (len(nodes) + 1, (0.0, 0.0)))
    for j in range(edges >> last):
        cell(corner(last, j), corner(last, j + 1), centre)
    write(name, nodes, {"disc": cells, "arc": arc})


def belt(name, angle, cells_of_arc, cells_of_end=6, low_end=(0.1, 6), half=0.005):
    """Over quarters of a turn; `low_end`: the length of that end and its cells; `half`: of the thickness."""
    end = (round(cos(angle)), round(sin(angle)))
    (length, cells_of_low) = low_end
    count = cells_of_low + cells_of_arc + cells_of_end
    nodes = {}

    def node(i, j):
        """Node i of 2 count along the belt and j of 2 through its thickness."""
        r, s = 1 + half * j, i / 2 - cells_of_low
        if s < 0:
            place = (r, length * s / cells_of_low)
        elif s > cells_of_arc:
            beyond = 0.1 * (s - cells_of_arc) / cells_of_end
            place = (r * end[0] - beyond * end[1], r * end[1] + beyond * end[0])
        else:
            at = angle * s / cells_of_arc
            place = (r * cos(at), r * sin(at))
        return nodes.setdefault((i, j), (len(nodes) + 1, place))[0]

    cells = []
    for i in range(0, 2 * count, 2):
        p = [[node(i + k, j) for j in range(3)] for k in range(3)]
        cells.append([p[0][0], p[0][2], p[2][2], p[0][1], p[1][2], p[1][1]])
        cells.append([p[0][0], p[2][2], p[2][0], p[1][1], p[2][1], p[1][0]])
    inner = [[node(i, 0), node(i + 2, 0), node(i + 1, 0)] for i in range(0, 2 * count, 2)]
    low = [[node(0, 0), node(0, 2), node(0, 1)]]
    far = [[node(2 * count, 0), node(2 * count, 2), node(2 * count, 1)]]
    write(name, nodes, {"belt": cells, "inner": inner, "low": low, "far": far})


class Bisected:
    """A disc of triangles that are bisected at their longest edges."""

    def __init__(self, rings=((32, 0.5), (16, 0.3), (8, 0.13))):
        self.points = [
            (r * cos(2 * pi * j / n - pi / 2), r * sin(2 * pi * j / n - pi / 2)) for n, r in rings for j in range(n)
        ]
        self.points.append((0.0, 0.0))
        self.cells, self.at, self.count = {}, {}, 0
        outer = 0
        for (n, _), (m, _) in zip(rings, rings[1:]):
            inner = outer + n
            for j in range(m):
                a, b, c = (outer + (2 * j + i) % n for i in range(3))
                p, q = inner + j, inner + (j + 1) % m
                for cell in [(a, b, p), (b, q, p), (b, c, q)]:
                    self.add(cell)
            outer = inner
        for j in range(rings[-1][0]):
            self.add((outer + j, outer + (j + 1) % rings[-1][0], len(self.points) - 1))
        n = rings[0][0]
        self.arc = {frozenset((j, (j + 1) % n)) for j in range(n)}

    def edges(self, cell):
        return [frozenset((cell[i], cell[i - 1])) for i in range(3)]

    def add(self, cell):
        self.cells[self.count] = cell
        for edge in self.edges(cell):
            self.at.setdefault(edge, []).append(self.count)
        self.count += 1

    def remove(self, number):
        for edge in self.edges(self.cells[number]):
            self.at[edge].remove(number)
        del self.cells[number]

    def length(self, edge):
        return dist(*(self.points[k] for k in edge))

    def longest(self, number):
        return max(self.edges(self.cells[number]), key=lambda edge: (self.length(edge), sorted(edge)))

    def bisect(self, number):
        while number in self.cells:
            edge = self.longest(number)
            shorter = [k for k in self.at[edge] if self.longest(k) != edge]
            if shorter:
                self.bisect(shorter[0])
            else:
                self.halve(edge)

    def halve(self, edge):
        a, b = sorted(edge)
        x, y = ((self.points[a][i] + self.points[b][i]) / 2 for i in range(2))
        scale = RADII[0] / (x * x + y * y) ** 0.5 if edge in self.arc else 1
        middle = len(self.points)
        self.points.append((x * scale, y * scale))
        if edge in self.arc:
            self.arc.remove(edge)
            self.arc |= {frozenset((a, middle)), frozenset((middle, b))}
        for number in list(self.at[edge]):
            cell = self.cells[number]
            self.remove(number)
            for end in (a, b):
                self.add(tuple(middle if k == end else k for k in cell))

    def refine(self, allowed):
        """Until no edge is longer than `allowed` at the centroid of a cell."""
        while True:
            centre = lambda cell: (sum(self.points[k][i] for k in cell) / 3 for i in range(2))
            large = [k for k, cell in self.cells.items() if self.length(self.longest(k)) > allowed(*centre(cell))]
            if not large:
                return
            for number in large:
                self.bisect(number)


def cattaneo(size=0.0064, half_width=0.11, growth=0.45):
    mesh = Bisected()

    def allowed(x, y):
        aside = max(abs(x) - half_width, 0)
        return size + growth * (aside**2 + (abs(y) - RADII[0]) ** 2) ** 0.5

    mesh.refine(allowed)
    nodes = {k: (k + 1, place) for k, place in enumerate(mesh.points)}

    def middle(a, b):
        edge = frozenset((a, b))
        x, y = ((mesh.points[a][i] + mesh.points[b][i]) / 2 for i in range(2))
        scale = RADII[0] / (x * x + y * y) ** 0.5 if edge in mesh.arc else 1
        return nodes.setdefault(edge, (len(nodes) + 1, (x * scale, y * scale)))[0]

    def six(cell):
        a, b, c = cell
        return [a + 1, b + 1, c + 1, middle(a, b), middle(b, c), middle(c, a)]

    def turn(a, b):
        (x, y), (z, w) = mesh.points[a], mesh.points[b]
        return (a, b) if x * w > y * z else (b, a)

    arcs = sorted(turn(*edge) for edge in mesh.arc)
    cells = [six(cell) for cell in mesh.cells.values()]
    write("cattaneo.msh", nodes, {"disc": cells, "arc": [[a + 1, b + 1, middle(a, b)] for a, b in arcs]})


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
    disc("disc.msh", 256, RADII)
    disc("fine-disc.msh", 1024, FINE)
    belt("belt.msh", pi / 2, 90)
    belt("half-belt.msh", pi, 120)
    belt("whole-belt.msh", 2 * pi, 240)
    belt("running-belt.msh", pi / 2, 45, low_end=(1.6, 46), half=0.0025)
    cattaneo()
