#!/usr/bin/env python3
"""Generates the .msh files of cases, tests and examples, byte for byte as they are committed.

    scripts/make_meshes.py [--check] [--carom target/release/carom] [WORD…]

Writes the files whose path contains a word, or all of them; with --check it compares them with the
files that exist. What a mesh is stands in the .geo file beside it or at its function below; the
table RECIPES at the end names every file.

Meshes with a .geo file need Gmsh (pip install gmsh==4.15.2; the wheel needs libglu1-mesa libxrender1
libxcursor1 libxft2 libxinerama1), cases/invariance/renumbered.msh the program, the others Python.
"""

import argparse
import functools
import itertools
import random
import subprocess
import sys
import tempfile
from collections.abc import Callable
from math import cos, dist, pi, sin
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent


# Meshes in the format 2.2 of Gmsh


class Mesh:
    """Nodes, and cells in groups with names."""

    # Gmsh's number of the type of a cell, by dimension and count of nodes.
    TYPES = {(1, 2): 1, (1, 3): 8, (1, 4): 26, (2, 3): 2, (2, 6): 9, (2, 10): 21, (3, 10): 11}

    def __init__(self, groups=()):
        """`groups`: those that are numbered first, as (dimension, name)."""
        self.numbers = {}
        self.places = []
        self.groups = list(groups)
        self.cells = []

    def node(self, key, place):
        """The number of the node with a key. If there is none, it is added at a place."""
        if key not in self.numbers:
            self.places.append(place)
            self.numbers[key] = len(self.places)
        return self.numbers[key]

    def add(self, dimension, name, cells):
        """Adds cells, which are lists of node numbers, to a group."""
        group = (dimension, name)
        if group not in self.groups:
            self.groups.append(group)
        self.cells += [(group, list(cell)) for cell in cells]

    def file(self, digits="{:.17g}".format):
        """The content of the file. `digits` formats a coordinate."""
        tags = {group: tag for tag, group in enumerate(self.groups, 1)}
        names = [f'{dimension} {tag} "{name}"' for (dimension, name), tag in tags.items()]
        nodes = []
        for number, place in enumerate(self.places, 1):
            plane = ["0"] * (3 - len(place))
            nodes.append(" ".join([str(number), *map(digits, place), *plane]))
        elements = []
        for number, (group, cell) in enumerate(self.cells, 1):
            kind = self.TYPES[group[0], len(cell)]
            tag = tags[group]
            elements.append(" ".join(map(str, [number, kind, 2, tag, tag, *cell])))
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat"]
        for title, rows in (("PhysicalNames", names), ("Nodes", nodes), ("Elements", elements)):
            lines += [f"${title}", str(len(rows)), *rows, f"$End{title}"]
        return ("\n".join(lines) + "\n").encode()


def rounded(digits):
    """Formats a number rounded to decimals. Adding 0.0 removes the sign of -0.0."""
    return lambda x: repr(round(float(x), digits) + 0.0)


# Grids of triangles

# The triangles of a square, by the numbers of its corners: low, right, top, left.
RISING = ((0, 1, 2), (0, 2, 3))
FALLING = ((0, 1, 3), (1, 2, 3))
# For maps that mirror.
CLOCKWISE = ((0, 2, 1), (0, 3, 2))


class Grid:
    """Squares of a lattice, split into triangles whose nodes are moved by a map.

    A square (i, j) has the lattice points (order i, order j) to (order (i + 1), order (j + 1)).
    `place` maps the coordinates (a, b), in sides of a square, to the plane; `key` says for a lattice
    point, as seen from a square, which node it is.
    """

    def __init__(self, mesh, place, order=2, key=None):
        self.mesh = mesh
        self.place = place
        self.order = order
        self.key = key or (lambda point, square: (self, point))
        self.boundary = {}

    def node(self, point, square=(0, 0)):
        a, b = (n / self.order for n in point)
        return self.mesh.node(self.key(point, square), self.place(a, b))

    def triangles(self, squares, *splits, by_square=True):
        """Triangles of squares. Splits alternate along rows and columns. Nodes are numbered square by
        square, each of them column by column, or triangle by triangle."""
        cells = []
        for i, j in squares:
            if by_square:
                lattice = range(self.order + 1)
                for a, b in itertools.product(lattice, lattice):
                    self.node((self.order * i + a, self.order * j + b), (i, j))
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            for triangle in splits[(i + j) % len(splits)]:
                points = [tuple(self.order * n for n in corners[k]) for k in triangle]
                cells.append([self.node(point, (i, j)) for point in self.cell(points)])
        return cells

    def cell(self, corners):
        """Lattice points of a triangle: its corners, those on its sides, and that inside."""
        points = list(corners)
        for k in range(3):
            side = (corners[k], corners[(k + 1) % 3])
            points += self.between(*side)
            # A side of two triangles is not on the boundary.
            self.boundary[frozenset(side)] = None if frozenset(side) in self.boundary else side
        if self.order == 3:
            points.append(tuple(sum(n) // 3 for n in zip(*corners)))
        return points

    def between(self, start, end):
        p = self.order
        return [tuple(((p - k) * n + k * m) // p for n, m in zip(start, end)) for k in range(1, p)]

    def line(self, points):
        """Edges along a row of lattice points."""
        nodes = [self.node(point) for point in points]
        p = self.order
        return [[nodes[k], nodes[k + p], *nodes[k + 1 : k + p]] for k in range(0, len(nodes) - p, p)]

    def edges(self):
        """Edges of the boundary, each with the coordinates of its middle."""
        for start, end in filter(None, self.boundary.values()):
            middle = [(n + m) / (2 * self.order) for n, m in zip(start, end)]
            yield middle, [self.node(point) for point in (start, end, *self.between(start, end))]


def columns(count, rows):
    """Squares of a rectangle, column by column."""
    return list(itertools.product(range(count), range(rows)))


# cases/self


def strips():
    """The strips −10 ≤ x ≤ 0 and 0 ≤ x ≤ 3 of height 1, without common nodes. Surfaces `first`, `second`,
    and `both` of all cells; curves `left` (x = −10), `joint` and `face` (x = 0)."""
    mesh = Mesh()
    first = Grid(mesh, lambda a, b: (-10.0 + a / 4, b / 2))
    second = Grid(mesh, lambda a, b: (a / 4, b / 2))
    long = first.triangles(columns(40, 2), RISING)
    short = second.triangles(columns(12, 2), RISING)
    mesh.add(2, "first", long)
    mesh.add(2, "both", long + short)
    mesh.add(2, "second", short)
    mesh.add(1, "left", first.line((0, b) for b in range(5)))
    mesh.add(1, "face", first.line((80, b) for b in range(5)))
    mesh.add(1, "joint", second.line((0, b) for b in range(5)))
    return mesh.file()


def strip(slit, named=False):
    """A strip 0 ≤ x ≤ 6, 0 ≤ y ≤ 1, with a closed slit at x = 3 from y = 1/4 up, or without. Surface
    `bar`; curves `left` and `right`, and if `named` the sides `near` and `far` of the slit."""

    def key(point, square):
        a, b = point
        return (point, slit and a == 24 and b > 2 and square[0] >= 12)

    mesh = Mesh()
    grid = Grid(mesh, lambda a, b: (a / 4, b / 4), key=key)
    mesh.add(2, "bar", grid.triangles(columns(24, 4), RISING))
    mesh.add(1, "left", grid.line((0, b) for b in range(9)))
    mesh.add(1, "right", grid.line((48, b) for b in range(9)))
    if named:
        for name, square in (("near", 11), ("far", 12)):
            nodes = [grid.node((24, b), (square, b // 2)) for b in range(2, 9)]
            mesh.add(1, name, [[nodes[k], nodes[k + 2], nodes[k + 1]] for k in range(0, 6, 2)])
    return mesh.file()


def pinched():
    """A ring of radii 0.4 and 0.5, of which the halves y > 0 and y < 0 are mirror images. Surfaces
    `ring` and `half` (y > 0); curves `right` and `left`, the ends of the half."""
    mesh = Mesh()
    count = 24

    def half(sign):
        def place(a, b):
            angle = pi * a / count
            # Radii fall with b, so that the map of the upper half mirrors.
            radius = 0.5 - 0.1 * b
            if a == count:
                return (-radius, 0.0)
            return (radius * cos(angle), sign * radius * sin(angle))

        return Grid(mesh, place, key=lambda point, _: (point, sign if 0 < point[0] < 2 * count else 0))

    above = half(1)
    upper = above.triangles(columns(count, 1), CLOCKWISE)
    lower = half(-1).triangles(columns(count, 1), RISING)
    mesh.add(2, "ring", upper + lower)
    mesh.add(2, "half", upper)
    mesh.add(1, "right", above.line((0, b) for b in range(3)))
    mesh.add(1, "left", above.line((2 * count, b) for b in range(3)))
    return mesh.file()


def thin():
    """A ring of centre-line radius 1 + 0.001 cos 2φ and thickness 0.02. Surface `ring`; curves `inner`
    and `outer`."""
    mesh = Mesh()
    count = 256

    def place(a, b):
        angle = 2 * pi * a / count
        radius = 1.0 + 0.001 * cos(2 * angle) - 0.01 * (2 * b - 1)
        return (radius * cos(angle), radius * sin(angle))

    grid = Grid(mesh, place, key=lambda point, _: (point[0] % (2 * count), point[1]))
    mesh.add(2, "ring", grid.triangles(columns(count, 1), CLOCKWISE))
    mesh.add(1, "outer", grid.line((a, 0) for a in range(2 * count + 1)))
    mesh.add(1, "inner", grid.line((a, 2) for a in range(2 * count + 1)))
    return mesh.file()


# cases/tie


class Ring(NamedTuple):
    """A quarter of a ring: its radii, cells along the arc and across it."""

    radii: tuple
    along: int
    across: int


def quarter_rings(shaft, hub):
    """Quarters of two concentric rings that have no common nodes. Surfaces `shaft` and `hub`; curves
    `inner`, `bond` and `bottom`, `left` of the first, `seat`, `outer` and `low`, `side` of the second."""
    mesh = Mesh()

    def grid(ring):
        first, last = ring.radii

        def place(a, b):
            angle = 0.5 * pi * a / ring.along
            radius = first + (last - first) * b / ring.across
            if a == ring.along:
                return (0.0, radius)
            return (radius * cos(angle), radius * sin(angle))

        return Grid(mesh, place)

    rings = (shaft, hub)
    grids = [grid(ring) for ring in rings]
    for name, ring, of in zip(("shaft", "hub"), rings, grids):
        mesh.add(2, name, of.triangles(columns(ring.along, ring.across), CLOCKWISE))
    sides = (("inner", "bond", "bottom", "left"), ("seat", "outer", "low", "side"))
    for ring, of, names in zip(rings, grids, sides):
        along, across = 2 * ring.along, 2 * ring.across
        mesh.add(1, names[0], of.line((a, 0) for a in range(along + 1)))
        mesh.add(1, names[1], of.line((a, across) for a in range(along + 1)))
        mesh.add(1, names[2], of.line((0, b) for b in range(across + 1)))
        mesh.add(1, names[3], of.line((along, b) for b in range(across + 1)))
    return mesh.file()


def cut_ring():
    """A ring of radii 0.95 and 1.05 that is cut at φ = 0. Surface `ring`; curves `begin` and `end`, the
    two sides of the cut."""
    mesh = Mesh()
    count = 32

    def place(a, b):
        angle = 2 * pi * a / count
        radius = 0.95 + 0.1 * b
        return (radius, 0.0) if a == count else (radius * cos(angle), radius * sin(angle))

    grid = Grid(mesh, place, order=3)
    mesh.add(2, "ring", grid.triangles(columns(count, 1), CLOCKWISE))
    mesh.add(1, "begin", grid.line((0, b) for b in range(4)))
    mesh.add(1, "end", grid.line((3 * count, b) for b in range(4)))
    return mesh.file()


# cases/friction


def belt(angle, cells, low_end=0.1, low_cells=6, thickness=0.01):
    """A belt along an arc of radius 1 about the origin, from (1, 0) by an angle of quarters of a turn,
    with straight ends: of length `low_end` below (1, 0), and of 0.1 after the arc. Surface `belt`;
    curves `inner`, `low` and `far` (the ends)."""
    far_cells = 6
    count = low_cells + cells + far_cells
    normal = (round(cos(angle)), round(sin(angle)))

    def place(a, b):
        radius = 1 + thickness * b
        along = a - low_cells
        if along < 0:
            return (radius, low_end * along / low_cells)
        if along > cells:
            beyond = 0.1 * (along - cells) / far_cells
            return (radius * normal[0] - beyond * normal[1], radius * normal[1] + beyond * normal[0])
        turned = angle * along / cells
        return (radius * cos(turned), radius * sin(turned))

    mesh = Mesh()
    grid = Grid(mesh, place)
    mesh.add(2, "belt", grid.triangles(columns(count, 1), CLOCKWISE[::-1]))
    mesh.add(1, "inner", grid.line((a, 0) for a in range(2 * count + 1)))
    mesh.add(1, "low", grid.line((0, b) for b in range(3)))
    mesh.add(1, "far", grid.line((2 * count, b) for b in range(3)))
    return mesh.file()


RADIUS = 0.5


def rings(counts, radii):
    """A disc about the origin, triangulated between concentric rings, each with half the points of the
    one outside it. Returns points, and groups of triangles as (points of the group, triangles)."""
    points = []
    for count, radius in zip(counts, radii):
        angles = [2 * pi * j / count - pi / 2 for j in range(count)]
        points += [(radius * cos(angle), radius * sin(angle)) for angle in angles]
    groups = []
    outer = 0
    for many, few in zip(counts, counts[1:]):
        inner = outer + many
        for j in range(few):
            a, b, c = (outer + (2 * j + k) % many for k in range(3))
            p = inner + j
            q = inner + (j + 1) % few
            groups.append(([a, b, c, p, q], [(a, b, p), (b, q, p), (b, c, q)]))
        outer = inner
    center = len(points)
    points.append((0.0, 0.0))
    for j in range(counts[-1]):
        a = outer + j
        b = outer + (j + 1) % counts[-1]
        groups.append(([center, a, b], [(a, b, center)]))
    return points, groups


def circle(count):
    """The edges of the outermost ring."""
    return {frozenset((j, (j + 1) % count)) for j in range(count)}


def middle(points, edge, arc):
    """The middle of an edge; of an edge of the arc, on the circle."""
    a, b = edge
    x = (points[a][0] + points[b][0]) / 2
    y = (points[a][1] + points[b][1]) / 2
    scale = RADIUS / (x * x + y * y) ** 0.5 if edge in arc else 1
    return (x * scale, y * scale)


def six_nodes(points, groups, arc):
    """The file of a disc of six-node triangles: surface `disc`, curve `arc`. In each group, corners are
    numbered before the middles of edges."""
    mesh = Mesh()

    def curved(*corners):
        nodes = [mesh.node(corner, points[corner]) for corner in corners]
        sides = [(corners[0], corners[1])] if len(corners) == 2 else zip(corners, corners[1:] + corners[:1])
        for side in map(frozenset, sides):
            nodes.append(mesh.node(side, middle(points, side, arc)))
        return nodes

    def counterclockwise(edge):
        a, b = edge
        (x, y), (z, w) = points[a], points[b]
        return (a, b) if x * w > y * z else (b, a)

    for corners, triangles in groups:
        for corner in corners:
            mesh.node(corner, points[corner])
        mesh.add(2, "disc", [curved(*triangle) for triangle in triangles])
    mesh.add(1, "arc", [curved(*edge) for edge in sorted(map(counterclockwise, arc))])
    return mesh.file()


def disc(count, radii):
    """A disc of radius 0.5 about the origin with `count` cells along its arc and half as many on each
    ring further inside. Surface `disc`; curve `arc`."""
    counts = [count >> ring for ring in range(len(radii))]
    return six_nodes(*rings(counts, radii), circle(count))


class Bisected:
    """A disc of triangles that are bisected at their longest edges, neighbours first where they share no
    longest edge (M. C. Rivara, Int. J. Numer. Meth. Engng 20 (1984) 745-756)."""

    def __init__(self):
        counts = (32, 16, 8)
        self.points, groups = rings(counts, (RADIUS, 0.3, 0.13))
        self.arc = circle(counts[0])
        self.cells = {}
        self.cells_at = {}
        self.count = 0
        for _, triangles in groups:
            for triangle in triangles:
                self.add(triangle)

    def edges(self, cell):
        return [frozenset((cell[i], cell[i - 1])) for i in range(3)]

    def add(self, cell):
        self.cells[self.count] = cell
        for edge in self.edges(cell):
            self.cells_at.setdefault(edge, []).append(self.count)
        self.count += 1

    def remove(self, number):
        for edge in self.edges(self.cells[number]):
            self.cells_at[edge].remove(number)
        del self.cells[number]

    def length(self, edge):
        return dist(*(self.points[k] for k in edge))

    def longest(self, number):
        return max(self.edges(self.cells[number]), key=lambda edge: (self.length(edge), sorted(edge)))

    def bisect(self, number):
        while number in self.cells:
            edge = self.longest(number)
            shorter = [k for k in self.cells_at[edge] if self.longest(k) != edge]
            if shorter:
                self.bisect(shorter[0])
            else:
                self.halve(edge)

    def halve(self, edge):
        ends = sorted(edge)
        new = len(self.points)
        self.points.append(middle(self.points, edge, self.arc))
        if edge in self.arc:
            self.arc.remove(edge)
            self.arc |= {frozenset((end, new)) for end in ends}
        for number in list(self.cells_at[edge]):
            cell = self.cells[number]
            self.remove(number)
            for end in ends:
                self.add(tuple(new if k == end else k for k in cell))

    def refine(self, allowed):
        """Bisects until no edge is longer than `allowed` at the centroid of a cell."""

        def too_long(number):
            corners = [self.points[k] for k in self.cells[number]]
            return self.length(self.longest(number)) > allowed(*(sum(x) / 3 for x in zip(*corners)))

        while large := [number for number in self.cells if too_long(number)]:
            for number in large:
                self.bisect(number)


def cattaneo():
    """The disc of radius 0.5 with cells of 0.0061 where it is pressed below and above, |x| < 0.11, which
    grow by 0.45 of the distance from there. Surface `disc`; curve `arc`."""

    def allowed(x, y):
        aside = max(abs(x) - 0.11, 0)
        return 0.0064 + 0.45 * (aside**2 + (abs(y) - RADIUS) ** 2) ** 0.5

    mesh = Bisected()
    mesh.refine(allowed)
    whole = (range(len(mesh.points)), mesh.cells.values())
    return six_nodes(mesh.points, [whole], mesh.arc)


# cases/ladder


def add_with_sides(mesh, surface, grid, squares, side):
    """Adds squares, and their boundary. `side` maps the middle of an edge to the name of its curve."""
    mesh.add(2, surface, grid.triangles(squares, RISING, FALLING, by_square=False))
    for where, edge in grid.edges():
        mesh.add(1, side(*where), [edge])


class Rake(NamedTuple):
    """A strip with a tooth at every centre: half width `width(s)` at s in [0, 1] of its length."""

    centers: list
    rows: int
    width: Callable
    back: float
    length: float = 0.6

    def add(self, mesh, surface, turn=None):
        """Adds it to a mesh; `turn` is the point that a half turn brings to the origin."""
        neck = self.width(0.0)
        lines = [x for center in self.centers for x in (center - neck, center, center + neck)]
        teeth = [k for k in range(len(lines) - 1) if k % 3 != 2]
        squares = [(i, 0) for i in range(len(lines) - 1)]
        squares += [(i, 1 + j) for i in teeth for j in range(self.rows)]

        def place(a, b):
            k = min(int(a), len(lines) - 2)
            x = lines[k] + (a - k) * (lines[k + 1] - lines[k])
            y = self.back * (b - 1)
            if b > 1:
                s = (b - 1) / self.rows
                center = min(self.centers, key=lambda c: abs(c - x))
                x = center + (x - center) * self.width(s) / neck
                y = self.length * s
            # A rotation, not a reflection, keeps the orientation of the cells.
            return (x, y) if turn is None else (turn[0] - x, turn[1] - y)

        side = lambda a, b: f"{surface}_back" if b == 0 else f"{surface}_teeth"
        add_with_sides(mesh, surface, Grid(mesh, place), squares, side)


def comb():
    """Two combs whose teeth meet. Surfaces `lower` and `upper`; curves `lower_back`, `lower_teeth`, …"""
    mesh = Mesh()
    width = lambda s: 0.1 - 0.04 * s
    Rake([0.4 * k for k in range(5)], 5, width, back=0.2).add(mesh, "lower")
    # Off the middle by 0.06, so that the teeth bend; the tips are 0.1 above those of the lower
    # comb.
    Rake([0.4 * k for k in range(4)], 4, width, back=0.2).add(mesh, "upper", (1.46, 1.3))
    return mesh.file(rounded(12))


def zip_of_hooks():
    """Two combs whose teeth have thick ends, which snap into each other. Names as in comb.msh."""
    mesh = Mesh()
    width = lambda s: 0.08 + (0.06 * sin(pi * (s - 0.4) / 0.6) ** 2 if s > 0.4 else 0.0)
    rake = Rake([0.5 * k for k in range(5)], 8, width, back=0.15)
    rake.add(mesh, "lower")
    rake.add(mesh, "upper", (2.25, 0.64))
    return mesh.file(rounded(12))


def ramp():
    """Cubic cells whose side `top` is y = (1 − x)³ up to x = 1, and y = 0 from there, without a jump of
    curvature. Surface `ramp`; curves `top`, `bottom`, `ends`."""
    mesh = Mesh()
    cells_of_ramp = 16

    def place(a, b):
        x = a / cells_of_ramp
        top = (1.0 - x) ** 3 if a <= cells_of_ramp else 0.0
        return (x, -0.15 + (top + 0.15) * b)

    side = lambda a, b: "top" if b == 1 else "bottom" if b == 0 else "ends"
    add_with_sides(mesh, "ramp", Grid(mesh, place, order=3), columns(22, 1), side)
    return mesh.file(rounded(12))


def discs():
    """The case of twenty discs: bodies in rows of four, the upper ones between the lower ones, and the
    contact of each with the walls and with each other. What stands before and after them in the file
    is kept."""
    path = ROOT / "cases/ladder/discs.toml"
    text = path.read_text(encoding="utf-8")
    head = text[: text.index("\n[[body]]")]
    tail = text[text.index("\n[time]") :]
    radius = 0.5
    gap = 0.02
    walls = {
        "floor": "{ point = [0.0, 0.0], normal = [0.0, 1.0] }",
        "left": "{ point = [0.0, 0.0], normal = [1.0, 0.0] }",
        "right": "{ point = [4.5, 0.0], normal = [-1.0, 0.0] }",
    }
    names = [f"disc{k + 1}" for k in range(20)]
    tables = []
    for k, name in enumerate(names):
        row, column = divmod(k, 4)
        x = radius + gap + column * (2 * radius + 0.1) + (0.13 if row % 2 else 0.0)
        y = radius + gap + row * (2 * radius + gap)
        shape = f'{{ shape = "disc", radius = {radius}, center = [{x:.3f}, {y:.3f}], size = 0.25 }}'
        tables.append(
            f'\n[[body]]\nname = "{name}"\nmaterial = "rubber"\nelement = "T6"\nmesh = {shape}\ngravity = [0.0, -10.0]\n'
        )

    def contact(name, other, primary):
        return f'\n[[contact]]\nname = "{name}-{other}"\nsecondary = "{name}.arc"\nprimary = {primary}\n'

    for name in names:
        tables += [contact(name, wall, f"{{ plane = {plane} }}") for wall, plane in walls.items()]
    tables += [contact(one, two, f'"{two}.arc"') for one, two in itertools.combinations(names, 2)]
    return (head + "".join(tables) + tail).encode()


# cases/space


def punch():
    """A disc of 60 triangles, slightly larger than the circle of radius 0.1 at which half-space.msh is
    refined, which faces downwards. Surface `face`."""
    count = 60
    radius = 0.10001
    mesh = Mesh()
    center = mesh.node("center", (0, 0))
    angles = [2 * pi * i / count for i in range(count)]
    rim = [mesh.node(angle, (radius * cos(angle), radius * sin(angle))) for angle in angles]
    mesh.add(2, "face", [[center, rim[(i + 1) % count], rim[i]] for i in range(count)])
    return mesh.file("{:.9g}".format)


# Meshes of Gmsh


@functools.cache
def started_gmsh():
    try:
        import gmsh
    except (ImportError, OSError) as error:
        sys.exit(f"a mesh with a .geo file needs Gmsh ({error}): see --help")
    gmsh.initialize()
    return gmsh


def meshed(geo, order=None, **constants):
    """Gmsh with the mesh of a .geo file, of which DefineConstant values may be replaced."""
    gmsh = started_gmsh()
    gmsh.option.restoreDefaults()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    if order:
        gmsh.option.setNumber("Mesh.ElementOrder", order)
    gmsh.clear()
    gmsh.parser.clear()
    for name, value in constants.items():
        gmsh.parser.setNumber(name, [value])
    gmsh.merge(str(ROOT / geo))
    gmsh.model.mesh.generate(gmsh.model.getDimension())
    return gmsh


def written(geo, order=None, options=None, **constants):
    """The file that Gmsh writes, in the format that the .geo file sets unless `options` sets another."""
    gmsh = meshed(geo, order, **constants)
    for name, value in (options or {}).items():
        gmsh.option.setNumber(f"Mesh.{name}", value)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.msh"
        gmsh.write(str(path))
        return path.read_bytes()


def groups_of(gmsh):
    """Places of nodes by their tags, and (dimension, name, nodes of its cells) of every group."""
    tags, flat, _ = gmsh.model.mesh.getNodes()
    places = {int(tag): tuple(map(float, flat[3 * i : 3 * i + 3])) for i, tag in enumerate(tags)}
    groups = []
    for dimension, tag in gmsh.model.getPhysicalGroups():
        cells = []
        for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
            for kind, _, nodes in zip(*gmsh.model.mesh.getElements(dimension, entity)):
                width = gmsh.model.mesh.getElementProperties(kind)[3]
                cells += [list(map(int, nodes[i : i + width])) for i in range(0, len(nodes), width)]
        groups.append((dimension, gmsh.model.getPhysicalName(dimension, tag), cells))
    return places, groups


def compact(geo, name_of=lambda name, places: name, **constants):
    """A smaller file: the cells in groups, the nodes of these, and coordinates of ten digits. `name_of`
    may rename the group of a cell by the places of its nodes."""
    places, groups = groups_of(meshed(geo, **constants))
    mesh = Mesh()
    for tag in sorted({tag for _, _, cells in groups for cell in cells for tag in cell}):
        mesh.node(tag, places[tag])
    for dimension, name, cells in groups:
        for cell in cells:
            renamed = name_of(name, [places[tag] for tag in cell])
            mesh.add(dimension, renamed, [[mesh.numbers[tag] for tag in cell]])
    return mesh.file(lambda x: f"{round(x, 10) + 0.0:.10g}")


def half_ball(**constants):
    """The half ball of half-ball.geo, with `cap`: the part of the sphere above z = 0.9."""

    def name_of(name, places):
        return "cap" if name == "sphere" and min(z for _, _, z in places) > 0.9 else name

    return compact("cases/space/half-ball.geo", name_of, **constants)


def cylinders():
    """The quarter of a cylinder of cylinders.geo and its mirror image below, node for node. Surfaces
    `upper` and `lower`; curves `arc`, `axis` (x = 0) and `cut` (|y| = 1)."""
    places, groups = groups_of(meshed("cases/static/cylinders.geo"))
    # The surface first.
    groups.sort(key=lambda group: -group[0])
    mesh = Mesh([(1, "arc"), (1, "axis"), (1, "cut"), (2, "upper"), (2, "lower")])
    # A reflection reverses the orientation, so the order of the nodes is reversed, too.
    turned = {6: [0, 2, 1, 5, 4, 3], 3: [1, 0, 2]}
    for surface, sign in (("upper", 1), ("lower", -1)):
        numbers = {}
        for tag, (x, y, _) in places.items():
            # Adding 0.0 removes the sign of -0.0.
            numbers[tag] = mesh.node((surface, tag), (x, sign * y + 0.0))
        for dimension, name, cells in groups:
            group = surface if dimension == 2 else name
            for cell in cells:
                order = turned[len(cell)] if sign < 0 else range(len(cell))
                mesh.add(dimension, group, [[numbers[cell[i]] for i in order]])
    return mesh.file(repr)


# cases/plastic


def quarter_ring(inner, outer, count, rows):
    """A quarter of a ring about the origin, six-node triangles. Surface `ring`; curves `inner`, `outer`,
    `bottom` (y = 0) and `left` (x = 0)."""
    mesh = Mesh()

    def place(a, b):
        radius = inner + (outer - inner) * b / rows
        angle = pi / 2 * a / count
        return (0.0 if a == count else radius * cos(angle), radius * sin(angle))

    grid = Grid(mesh, place)
    mesh.add(2, "ring", grid.triangles(columns(count, rows), CLOCKWISE))
    mesh.add(1, "inner", grid.line((a, 0) for a in range(2 * count, -1, -1)))
    mesh.add(1, "outer", grid.line((a, 2 * rows) for a in range(2 * count + 1)))
    mesh.add(1, "bottom", grid.line((0, b) for b in range(2 * rows + 1)))
    mesh.add(1, "left", grid.line((2 * count, b) for b in range(2 * rows, -1, -1)))
    return mesh.file()


def eighth_shell(inner, outer, count, layers):
    """An eighth of a thick spherical shell about the origin, ten-node tetrahedra: a spherical triangle of
    count² triangles, and layers of prisms. Volume `shell`; surfaces `inner`, `outer`, `plane_x`, `plane_y`
    and `plane_z`."""

    def place(i, j, layer):
        direction = (2 * count - i - j, i, j)
        norm = sum(x * x for x in direction) ** 0.5
        radius = inner + (outer - inner) * layer / (2 * layers)
        return tuple(radius * x / norm for x in direction)

    sides = ("inner", "outer", "plane_x", "plane_y", "plane_z")
    return triangle_of_prisms("shell", sides, count, layers, place)


def necked_bar(length, radius, thinner, count, layers, growth):
    """A quarter of a bar along z, ten-node tetrahedra, whose radius falls linearly by the share `thinner`
    towards z = 0. Layers of 3 count² cells, the last `growth` times as thick as the first. Volume `bar`;
    surfaces `neck` (z = 0), `end`, `surface`, `plane_x` and `plane_y`."""

    def height(layer):
        # Middle nodes lie halfway between the ends of their layer.
        if layer % 2:
            return (height(layer - 1) + height(layer + 1)) / 2
        return length * (growth ** (layer / (2 * layers)) - 1) / (growth - 1)

    def place(i, j, layer):
        z = height(layer)
        ring = i + j
        out = radius * (1 - thinner * (1 - z / length)) * ring / (2 * count)
        angle = pi / 2 * j / max(ring, 1)
        return (out * cos(angle) if i else 0.0, out * sin(angle) if j else 0.0, z)

    sides = ("neck", "end", "surface", "plane_x", "plane_y")
    return triangle_of_prisms("bar", sides, count, layers, place)


def triangle_of_prisms(name, sides, count, layers, place):
    """Ten-node tetrahedra, three in each prism: layers of a triangle of count² triangles with the corners
    (0, 0), (2 count, 0) and (0, 2 count) of a lattice, whose points are at place(i, j, layer), layer = 0 …
    2 layers. `sides` names the surfaces of the first and the last layer, that of i + j = 2 count, and those
    of i = 0 and j = 0."""
    mesh = Mesh()

    def node(point):
        # Twice the lattice: the corners of cells are even.
        return mesh.node(point, place(*point))

    def cell(corners, pairs):
        middles = [tuple((a + b) // 2 for a, b in zip(corners[m], corners[n])) for m, n in pairs]
        return [node(point) for point in [*corners, *middles]]

    def triangle(corners):
        return cell(corners, [(0, 1), (1, 2), (2, 0)])

    flat = []
    for i, j in itertools.product(range(count), range(count)):
        if i + j < count:
            flat.append([(i, j), (i + 1, j), (i, j + 1)])
        if i + j < count - 1:
            flat.append([(i + 1, j), (i + 1, j + 1), (i, j + 1)])
    volume = []
    faces = {side: [] for side in sides}
    holds = {
        sides[0]: lambda p: p[2] == 0,
        sides[1]: lambda p: p[2] == 2 * layers,
        sides[2]: lambda p: p[0] + p[1] == 2 * count,
        sides[3]: lambda p: p[0] == 0,
        sides[4]: lambda p: p[1] == 0,
    }
    for layer in range(layers):
        for corners in flat:
            low = [(2 * i, 2 * j, 2 * layer) for i, j in corners]
            high = [(2 * i, 2 * j, 2 * layer + 2) for i, j in corners]
            # In the order of the lattice, so that the diagonals of neighbours agree.
            order = sorted(range(3), key=lambda k: low[k])
            a, b, c = (low[k] for k in order)
            d, e, f = (high[k] for k in order)
            turned = order in ([0, 1, 2], [1, 2, 0], [2, 0, 1])
            for tetrahedron in ((a, b, c, f), (a, b, f, e), (a, e, f, d)):
                four = list(tetrahedron) if turned else [tetrahedron[k] for k in (1, 0, 2, 3)]
                volume.append(cell(four, [(0, 1), (1, 2), (2, 0), (0, 3), (2, 3), (1, 3)]))
                for face in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)):
                    points = [four[k] for k in face]
                    for side, is_on in holds.items():
                        if all(map(is_on, points)):
                            faces[side].append(triangle(points))
    mesh.add(3, name, volume)
    for side, triangles in faces.items():
        mesh.add(2, side, triangles)
    return mesh.file(rounded(15))


# cases/invariance

# Nodes of triangles of order 1 to 3, by Gmsh's types, from the next corner on, and reversed.
NEXT = {2: [1, 2, 0], 9: [1, 2, 0, 4, 5, 3], 21: [1, 2, 0, 5, 6, 7, 8, 3, 4, 9]}
REVERSED = {2: [0, 2, 1], 9: [0, 2, 1, 5, 4, 3], 21: [0, 2, 1, 8, 7, 6, 5, 4, 3, 9]}
# Nodes of lines, reversed.
REVERSED_LINE = {1: [1, 0], 8: [1, 0, 2], 26: [1, 0, 3, 2]}


def blocks(lines, title, rows):
    """Blocks of a section of format 4.1, as head and lines. The head ends with a count; each of what it
    counts has `rows` lines."""
    at = lines.index(f"${title}") + 2
    while lines[at] != f"$End{title}":
        end = at + 1 + rows * int(lines[at].split()[3])
        yield lines[at], lines[at + 1 : end]
        at = end


def renumbered(carom):
    """The bodies of strike.toml with cells of third order, renumbered: nodes and cells are shuffled, each
    triangle starts at another corner, and every third one is clockwise."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "strike.msh"
        command = [carom, "mesh", ROOT / "cases/invariance/strike.toml", "--out", path]
        for body in ("disc", "block"):
            command += ["--set", f"body.{body}.element=T10"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        lines = path.read_text(encoding="utf-8").splitlines()
    chance = random.Random(1)
    of_nodes = list(blocks(lines, "Nodes", 2))
    every = [tag for _, own in of_nodes for tag in own[: len(own) // 2]]
    tags = dict(zip(every, map(str, chance.sample([int(tag) for tag in every], len(every)))))
    out = lines[: lines.index("$Nodes") + 2]
    for head, own in of_nodes:
        count = len(own) // 2
        order = chance.sample(range(count), count)
        out += [head, *(tags[own[i]] for i in order), *(own[count + i] for i in order)]
    out += ["$EndNodes", *lines[lines.index("$Elements") :][:2]]
    for head, own in blocks(lines, "Elements", 1):
        kind = int(head.split()[2])
        out.append(head)
        for k, line in enumerate(chance.sample(own, len(own))):
            tag, *cell = line.split()
            if kind in REVERSED_LINE:
                cell = [cell[i] for i in REVERSED_LINE[kind]] if k % 2 else cell
            else:
                for _ in range(chance.randrange(3)):
                    cell = [cell[i] for i in NEXT[kind]]
                cell = [cell[i] for i in REVERSED[kind]] if k % 3 == 0 else cell
            out.append(" ".join([tag, *(tags[node] for node in cell)]))
    return ("\n".join([*out, "$EndElements"]) + "\n").encode()


# Every file

# Radii of rings, each with half the cells of the one before.
COARSE = [RADIUS, 0.488, 0.466, 0.426, 0.351, 0.22]
FINE = [RADIUS, 0.497, 0.491, 0.479, 0.457, 0.417, 0.342, 0.22]

IMPACT = "cases/gmsh/impact.geo"
SECTOR = "cases/space/sector.geo"
EIGHTH = "cases/space/eighth.geo"
TESTS = "crates/carom-solid/tests/msh"
FORMATS = {
    "22_ascii": {"MshFileVersion": 2.2},
    "22_binary": {"MshFileVersion": 2.2, "Binary": 1},
    "41_ascii": {"MshFileVersion": 4.1},
    "41_binary": {"MshFileVersion": 4.1, "Binary": 1},
}


def recipes(carom):
    """What generates each file, by its path."""
    made = {
        "cases/self/strips.msh": strips,
        "cases/self/slit.msh": lambda: strip(slit=True),
        "cases/self/solid.msh": lambda: strip(slit=False),
        "cases/mortar/rings.msh": lambda: quarter_rings(Ring((1.0, 1.5), 6, 50), Ring((1.5, 2.0), 8, 60)),
        "cases/tie/rings.msh": lambda: quarter_rings(Ring((20.0, 50.0), 8, 4), Ring((50.0, 100.0), 12, 5)),
        "cases/tie/cut-ring.msh": cut_ring,
        "cases/tie/slit.msh": lambda: strip(slit=True, named=True),
        "cases/self/pinched.msh": pinched,
        "cases/self/thin.msh": thin,
        "cases/friction/disc.msh": lambda: disc(256, COARSE),
        "cases/friction/fine-disc.msh": lambda: disc(1024, FINE),
        "cases/friction/belt.msh": lambda: belt(pi / 2, 90),
        "cases/friction/half-belt.msh": lambda: belt(pi, 120),
        "cases/friction/whole-belt.msh": lambda: belt(2 * pi, 240),
        # Half as thick, with cells twice as long; its low end runs onto the circle.
        "cases/friction/running-belt.msh": lambda: belt(pi / 2, 45, low_end=1.6, low_cells=46, thickness=0.005),
        "cases/friction/cattaneo.msh": cattaneo,
        "cases/ladder/comb.msh": comb,
        "cases/ladder/zip.msh": zip_of_hooks,
        "cases/ladder/ramp.msh": ramp,
        "cases/ladder/discs.toml": discs,
        "cases/invariance/renumbered.msh": lambda: renumbered(carom),
        "cases/space/punch.msh": punch,
        "cases/space/half-ball.msh": half_ball,
        "cases/space/half-ball-fine.msh": lambda: half_ball(fine=0.0225, reach=0.075),
        "cases/materials/bar.msh": lambda: written("cases/materials/bar.geo"),
        "cases/materials/block.msh": lambda: written("cases/materials/block.geo"),
        "cases/materials/laminate.msh": lambda: written("cases/materials/laminate.geo"),
        "cases/space/half-space.msh": lambda: compact("cases/space/half-space.geo"),
        "cases/space/sector.msh": lambda: written(SECTOR, 2),
        "cases/space/eighth-quadratic.msh": lambda: written(EIGHTH, 2),
        "cases/space/eighth-cubic.msh": lambda: written(EIGHTH, 3, FORMATS["41_binary"]),
        "cases/plastic/thin-ring.msh": lambda: quarter_ring(0.0995, 0.1005, 8, 1),
        "cases/plastic/thick-ring.msh": lambda: quarter_ring(1.0, 2.0, 12, 12),
        "cases/plastic/shell.msh": lambda: eighth_shell(1.0, 2.0, 6, 6),
        "cases/plastic/neck.msh": lambda: necked_bar(26.667, 6.413, 0.018, 4, 20, 6.0),
        "cases/plastic/thin-shell.msh": lambda: eighth_shell(0.1, 0.11, 4, 1),
        "cases/static/ring.msh": lambda: written("cases/static/ring.geo"),
        "cases/static/cylinders.msh": cylinders,
        "cases/gmsh/impact.msh": lambda: written(IMPACT, 3),
        "crates/carom/templates/mesh.msh": lambda: written("crates/carom/templates/mesh.geo", 3),
        "docs/book/examples/bracket.msh": lambda: compact("docs/book/examples/bracket.geo"),
        "docs/book/examples/cup.msh": lambda: compact("docs/book/examples/cup.geo"),
        "docs/book/examples/tee.msh": lambda: written("docs/book/examples/tee.geo"),
        f"{TESTS}/bar.msh": lambda: written(f"{TESTS}/bar.geo"),
        f"{TESTS}/bar_22.msh": lambda: written(f"{TESTS}/bar.geo", options=FORMATS["22_ascii"]),
        f"{TESTS}/quadrangles.msh": lambda: written(IMPACT, 1, disc_size=0.3, prism_size=0.4, quadrangles=1),
        f"{TESTS}/sector_order1.msh": lambda: written(SECTOR, 1),
        f"{TESTS}/sector_order2.msh": lambda: written(SECTOR, 2),
        f"{TESTS}/sector_order2_22_binary.msh": lambda: written(SECTOR, 2, FORMATS["22_binary"]),
    }

    def of_test(name, form, geo, order, options=None, **constants):
        given = FORMATS[form] | (options or {})
        made[f"{TESTS}/{name}_{form}.msh"] = lambda: written(geo, order, given, **constants)

    for order, form in ((1, "41_ascii"), (2, "41_ascii"), (2, "22_binary"), (3, "41_binary")):
        of_test(f"eighth_order{order}", form, EIGHTH, order)
    for form in FORMATS:
        for order in (1, 2, 3):
            of_test(f"impact_order{order}", form, IMPACT, order, disc_size=0.2, prism_size=0.25)
        # Parameters of nodes on curves and surfaces, and all entities, which Carom must ignore. In
        # version 2.2 cells have one group only, which SaveAll would make the entity.
        parametric = {"SaveParametric": 1, "SaveAll": form.startswith("41")}
        of_test("parametric", form, IMPACT, 2, parametric, disc_size=0.3, prism_size=0.4)
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", metavar="WORD", help="only files whose path contains one of these")
    parser.add_argument("--check", action="store_true", help="compare instead of writing")
    parser.add_argument("--carom", default=str(ROOT / "target/release/carom"), help="the program")
    given = parser.parse_args()
    different = []
    for name, make in recipes(given.carom).items():
        if given.words and not any(word in name for word in given.words):
            continue
        content = make()
        path = ROOT / name
        if not path.is_file() or path.read_bytes() != content:
            different.append(name)
        if not given.check:
            path.write_bytes(content)
        state = "differs" if name in different else "same"
        print(f"{name}: {len(content)} bytes, {state}", flush=True)
    if given.check and different:
        sys.exit(f"{len(different)} files differ: {', '.join(different)}")


if __name__ == "__main__":
    main()
