"""Boxes, balls, cylinders and tubes of Tet4, Tet10, Hex8 or Hex27 for ladder_space_cases.py, turned and
placed, with their meshes as TOML and their extent in any direction.

The numbers of cells are those of the generators of Carom: along half an edge of the rounded square or
cube of a cylinder or ball, around it, and along the axis.
"""

from math import atan2, ceil, cos, degrees, pi, radians, sin, sqrt

from ladder_cases import num, vec

DEGREE = {"Tet4": 1, "Hex8": 1, "Tet10": 2, "Hex27": 2}
DOWN = (0.0, 0.0, -1.0)


def add(a, b, factor=1.0):
    return tuple(x + factor * y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def direction(r):
    """A direction, uniform on the sphere."""
    z, a = r.uniform(-1, 1), r.uniform(0, 2 * pi)
    s = sqrt(1 - z * z)
    return (s * cos(a), s * sin(a), z)


def rotation(axis, angle):
    """Columns of the rotation by an angle in degrees (Rodrigues' formula)."""
    n, s, c = [x / sqrt(dot(axis, axis)) for x in axis], sin(radians(angle)), cos(radians(angle))
    columns = []
    for i in range(3):
        e = [float(i == j) for j in range(3)]
        cross = (n[1] * e[2] - n[2] * e[1], n[2] * e[0] - n[0] * e[2], n[0] * e[1] - n[1] * e[0])
        columns.append(tuple(c * e[j] + s * cross[j] + (1 - c) * n[i] * n[j] for j in range(3)))
    return columns


def axis_and_angle(columns):
    """Axis and angle in degrees of a rotation."""
    trace = columns[0][0] + columns[1][1] + columns[2][2]
    c = max(-1.0, min(1.0, (trace - 1) / 2))
    axis = (columns[1][2] - columns[2][1], columns[2][0] - columns[0][2], columns[0][1] - columns[1][0])
    length = sqrt(dot(axis, axis))
    if length < 1e-9:
        return (0.0, 0.0, 1.0), 0.0
    return tuple(x / length for x in axis), degrees(atan2(length / 2, c))


def product(one, other):
    """Columns of the rotation `one` after `other`."""
    turn = lambda x: tuple(sum(one[i][j] * x[i] for i in range(3)) for j in range(3))
    return [turn(x) for x in other]


NO_TURN = rotation((0, 0, 1), 0)


class Solid:
    """A body around its own origin, which is then turned and moved; h and `small` are the longest and the
    shortest edge of its cells."""

    def __init__(self, name, element, mesh, h, small, cells, extent, young=100.0, density=1.0, poisson=0.3):
        self.name, self.element, self.mesh, self.h, self.small, self.cells = name, element, mesh, h, small, cells
        self.extent, self.young, self.density, self.poisson = extent, young, density, poisson
        self.turn, self.center, self.keys = NO_TURN, (0.0, 0.0, 0.0), {}

    def speed(self):
        nu = self.poisson
        return sqrt(self.young * (1 - nu) / (self.density * (1 + nu) * (1 - 2 * nu)))

    def reach(self, to):
        """Largest coordinate along the direction `to`, from its centre."""
        return self.extent([dot(column, to) for column in self.turn])

    def turned(self, axis, angle):
        self.turn = product(rotation(axis, angle), self.turn)
        return self

    def at(self, center):
        self.center = tuple(center)
        return self

    def resting(self, x, y, z):
        """With its lowest point at height z, its centre above (x, y)."""
        return self.at((x, y, z + self.reach(DOWN)))

    def moving(self, linear, angular=None):
        self.keys["velocity"] = vec(linear)
        if angular:
            about = vec(self.center)
            self.keys["velocity"] = f"{{ linear = {vec(linear)}, angular = {vec(angular)}, about = {about} }}"
        return self

    def place(self):
        axis, angle = axis_and_angle(self.turn)
        turn = f"rotate = {{ axis = {vec(axis)}, angle = {num(angle)} }}, " if angle else ""
        return f"{{ {turn}shift = {vec(self.center)} }}"


class Draw:
    """Draws solids; `same`: the cells of all bodies of a case, or none."""

    def __init__(self, r):
        self.r = r
        kinds = list(DEGREE)
        self.same = r.choice(kinds) if r.random() < 0.4 else None

    def element(self):
        return self.same or self.r.choice(list(DEGREE))

    def box(self, name, size, intervals, **more):
        """Edges `size`; intervals between nodes along the longest edge, about."""
        element = self.element()
        p, longest = DEGREE[element], max(size)
        counts = [max(1, round(intervals / p * s / longest)) for s in size]
        edges = [s / n for s, n in zip(size, counts)]
        mesh = f'{{ shape = "box", min = {vec([-s / 2 for s in size])}, max = {vec([s / 2 for s in size])}, cells = {counts} }}'
        extent = lambda d: sum(abs(x) * s / 2 for x, s in zip(d, size))
        return Solid(name, element, mesh, max(edges), min(edges), self.split(element, counts), extent, **more)

    def split(self, element, counts):
        n = 1
        for c in counts:
            n *= c
        return n * (6 if element.startswith("Tet") else 1)

    def level(self, element, level):
        """Cells from the axis to the rounded square: fewer if they are quadratic."""
        return max(1, level // DEGREE[element])

    def ball(self, name, radius, level, **more):
        element = self.element()
        half = self.level(element, level)
        size = pi / 4 * radius / half
        layers = ceil(0.42 / (pi / 4) * half)
        mesh = f'{{ shape = "ball", radius = {num(radius)}, center = [0.0, 0.0, 0.0], size = {num(1.001 * size)} }}'
        cells = self.split(element, [8 * half**3 + 24 * half**2 * layers])
        small = 0.4 * radius / max(half, layers)
        return Solid(name, element, mesh, size, small, cells, lambda d: radius * sqrt(dot(d, d)), **more)

    def cylinder(self, name, radius, height, level, **more):
        element = self.element()
        half = self.level(element, level)
        size = pi / 4 * radius / half
        layers, up = ceil(0.42 / (pi / 4) * half), ceil(height / (1.001 * size) - 1e-9)
        mesh = f'{{ shape = "cylinder", radius = {num(radius)}, height = {num(height)}, center = {vec((0, 0, -height / 2))}, size = {num(1.001 * size)} }}'
        cells = self.split(element, [up * (4 * half**2 + 8 * half * layers)])
        extent = lambda d: radius * sqrt(d[0] ** 2 + d[1] ** 2) + height / 2 * abs(d[2])
        small = min(0.4 * radius / max(half, layers), height / up)
        return Solid(name, element, mesh, max(size, height / up), small, cells, extent, **more)

    def tube(self, name, inner, outer, height, intervals, **more):
        """Intervals between nodes on a quarter of the outer circle."""
        element = self.element()
        quarter = max(2, round(intervals / DEGREE[element]))
        size = pi / 2 * outer / quarter
        up = ceil(height / (1.001 * size) - 1e-9)
        mesh = f'{{ shape = "tube", inner = {num(inner)}, outer = {num(outer)}, height = {num(height)}, center = {vec((0, 0, -height / 2))}, size = {num(1.001 * size)} }}'
        layers = ceil((outer - inner) / (1.001 * size) - 1e-9)
        cells = self.split(element, [4 * quarter * layers * up])
        extent = lambda d: outer * sqrt(d[0] ** 2 + d[1] ** 2) + height / 2 * abs(d[2])
        small = min((outer - inner) / layers, height / up)
        return Solid(name, element, mesh, max(size, height / up), small, cells, extent, **more)

    def lump(self, name, size, **more):
        """A box, ball or cylinder of about this size, turned at random."""
        r = self.r
        kind = r.choice(["box", "ball", "cylinder"])
        if kind == "ball":
            solid = self.ball(name, size / 2, r.choice([1, 2, 2]), **more)
        elif kind == "cylinder":
            solid = self.cylinder(name, size * r.uniform(0.3, 0.5), size * r.uniform(0.3, 1), r.choice([1, 2, 2]), **more)
        else:
            solid = self.box(name, [size * r.uniform(0.5, 1) for _ in range(3)], r.randint(2, 4), **more)
        return solid.turned(direction(r), r.uniform(0, 180))
