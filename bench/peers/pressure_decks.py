"""Decks of pressure.py: pairs of bodies with unmatched meshes and an exact contact pressure, and the
writer of their models for Carom and Kratos."""

import dataclasses
import json
import math
from typing import Callable

YOUNG, POISSON = 1.0, 0.3
SIDES = ("bottom", "right", "top", "left")


@dataclasses.dataclass
class Body:
    """The image of the unit square under `place`, divided into quadrilaterals."""

    cells: tuple[int, int]
    place: Callable

    def number(self, i, j):
        return j * (self.cells[0] + 1) + i

    def points(self):
        across, up = self.cells
        return [self.place(i / across, j / up) for j in range(up + 1) for i in range(across + 1)]

    def quadrilaterals(self):
        across, up = self.cells
        corners = ((0, 0), (1, 0), (1, 1), (0, 1))
        return [[self.number(i + a, j + b) for a, b in corners] for j in range(up) for i in range(across)]

    def side(self, name):
        """Nodes of a side of the square, with the body on its left."""
        across, up = self.cells
        return {
            "bottom": [self.number(i, 0) for i in range(across + 1)],
            "right": [self.number(across, j) for j in range(up + 1)],
            "top": [self.number(i, up) for i in range(across, -1, -1)],
            "left": [self.number(0, j) for j in range(up, -1, -1)],
        }[name]


@dataclasses.dataclass
class Deck:
    """Two bodies; the top of `lower` touches the bottom of `upper`, and x is fixed on the left.

    Sides are written BODY.SIDE. The traction is a dead load per reference area, in formulas linear
    in X and Y; `exact` is the pressure per deformed area at a reference point, `highest` its maximum.
    """

    lower: Body
    upper: Body
    fixed_y: list[str]
    loaded: str
    traction: tuple[str, str]
    exact: Callable
    highest: float
    overlap: str = "refuse"
    steps: int = 1

    def nodes(self, side):
        """Nodes of a side, numbered from 0 through both bodies, and their reference positions."""
        body, name = side.split(".")
        points = self.lower.points() + self.upper.points()
        first = len(self.lower.points()) if body == "upper" else 0
        numbers = [first + node for node in getattr(self, body).side(name)]
        return numbers, [points[k] for k in numbers]


def patch(n):
    """Two unit squares under a uniform pressure, free to expand."""
    pressure = 1e-3
    deformed = pressure / (1 + POISSON * (1 + POISSON) * pressure / YOUNG)

    def square(low):
        return lambda s, t: (s, low + t)
    return Deck(
        Body((2 * n, 2 * n), square(-1.0)), Body((3 * n, 3 * n), square(0.0)), ["lower.bottom"],
        "upper.top", ("0", f"{-pressure}"), lambda x, y: deformed, deformed,
    )


def rings(interface):
    """Quarters of two rings with an inner pressure (Lamé), divided at radius 1.5.

    The nodes of the interface lie on the circle, so that the chords of the bodies overlap, or evenly
    on the edges of one polygon whose corners are nodes of both.
    """
    a, b, c, inside = 1.0, 1.5, 2.0, 1e-2
    nominal = inside * a**2 * (c**2 - b**2) / (b**2 * (c**2 - a**2))
    expansion = (1 + POISSON) / YOUNG * inside * a**2 / (c**2 - a**2) * (1 - 2 * POISSON + c**2 / b**2)
    pressure = nominal / (1 + expansion)

    def circle(radius, s):
        angle = math.pi / 2 * (1 - s)
        return (radius * math.cos(angle), radius * math.sin(angle))

    def mix(first, last, t):
        return tuple((1 - t) * u + t * v for u, v in zip(first, last))

    def deck(n):
        def middle(s):
            if interface == "circle":
                return circle(b, s)
            edges = 2 * n
            edge = min(int(s * edges + 1e-9), edges - 1)
            return mix(circle(b, edge / edges), circle(b, (edge + 1) / edges), s * edges - edge)
        inner = Body((4 * n, n), lambda s, t: mix(circle(a, s), middle(s), t))
        outer = Body((6 * n, n), lambda s, t: mix(middle(s), circle(c, s), t))
        return Deck(
            inner, outer, ["lower.right", "upper.right"], "lower.bottom", (f"{inside / a}*X", f"{inside / a}*Y"),
            lambda x, y: pressure, pressure, overlap="touch" if interface == "circle" else "refuse",
        )
    return deck


def hertz(n):
    """Half of a cylinder on half of a block of the same material, both of unit width and height."""
    radius, half_width, grading = 2.0, 0.03, 4.5
    modulus = YOUNG / (2 * (1 - POISSON**2))
    force = math.pi * half_width**2 * modulus / (4 * radius)
    highest = math.sqrt(force * modulus / (math.pi * radius))

    def graded(s):
        return math.sinh(grading * s) / math.sinh(grading)

    def block(s, t):
        return (graded(s), -graded(1 - t))

    def cylinder(s, t):
        x = graded(s)
        bottom = radius - math.sqrt(radius**2 - x**2)
        return (x, bottom + (1 - bottom) * graded(t))
    return Deck(
        Body((2 * n, n), block), Body((3 * n, n), cylinder), ["lower.bottom"], "upper.top", ("0", f"{-force / 2}"),
        lambda x, y: highest * math.sqrt(max(0.0, 1 - (x / half_width) ** 2)), highest, steps=4,
    )


DECKS = {
    "patch": (patch, (2, 4)),
    "rings, one polygon": (rings("polygon"), (5, 10)),
    "rings, circle": (rings("circle"), (5, 10)),
    "Hertz": (hertz, (16, 32)),
}


def lines(nodes):
    return list(zip(nodes, nodes[1:]))


def write(deck, secondary, folder):
    """Writes lower.msh, upper.msh and the case without `method` for Carom, model.mdpa for Kratos."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("lower", "upper"):
        write_msh(getattr(deck, name), folder / f"{name}.msh")
    write_case(deck, secondary, folder / "case.toml")
    write_mdpa(deck, secondary, folder / "model.mdpa")


def write_msh(body, path):
    names = [f'1 {group} "{name}"' for group, name in enumerate(SIDES, 2)] + ['2 1 "body"']
    nodes = [f"{k} {x!r} {y!r} 0" for k, (x, y) in enumerate(body.points(), 1)]
    found = [(1, group, line) for group, name in enumerate(SIDES, 2) for line in lines(body.side(name))]
    found += [(3, 1, cell) for cell in body.quadrilaterals()]
    elements = [f"{k} {kind} 2 {group} {group} {' '.join(str(n + 1) for n in of)}" for k, (kind, group, of) in enumerate(found, 1)]
    text = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat"]
    for section, rows in (("PhysicalNames", names), ("Nodes", nodes), ("Elements", elements)):
        text += [f"${section}", len(rows), *rows, f"$End{section}"]
    write_lines(path, text)


def write_case(deck, secondary, path):
    primary = "upper.bottom" if secondary == "lower.top" else "lower.top"
    ramped = json.dumps([f"t*({formula})" for formula in deck.traction])
    write_lines(path, [
        'dimension = 2',
        'plane = "strain"',
        f'material = [{{ name = "m", law = "linear-elastic", density = 1.0, young = {YOUNG}, poisson = {POISSON} }}]',
        'body = [',
        *(f'    {{ name = "{name}", material = "m", element = "Q4", mesh = {{ file = "{name}.msh", surface = "body" }} }},' for name in ("lower", "upper")),
        ']',
        f'support = [{{ on = ["lower.left", "upper.left"], fix = ["x"] }}, {{ on = {json.dumps(deck.fixed_y)}, fix = ["y"] }}]',
        f'load = [{{ on = ["{deck.loaded}"], traction = {ramped} }}]',
        f'contact = [{{ name = "joint", secondary = "{secondary}", primary = "{primary}", overlap = "{deck.overlap}" }}]',
        f'time = {{ end = 1.0, step = {1 / deck.steps}, scheme = {{ kind = "static" }} }}',
    ])


def write_mdpa(deck, secondary, path):
    points = deck.lower.points() + deck.upper.points()
    first = len(deck.lower.points())
    cells = deck.lower.quadrilaterals() + [[first + k for k in cell] for cell in deck.upper.quadrilaterals()]
    loaded = nodal_loads(deck)
    touching = {side: deck.nodes(side)[0] for side in ("lower.top", "upper.bottom")}
    pieces = [("LineCondition2D2N", side, line) for side, of in touching.items() for line in lines(of)]
    pieces += [("PointLoadCondition2D1N", "load", (node,)) for node in loaded]

    def numbered(kind, rows):
        return [f"Begin {kind}", *rows, f"End {kind.split()[0]}"]

    def entities(kind, rows):
        return numbered(kind, [f"{k} 1 {' '.join(str(n + 1) for n in of)}" for k, of in rows])
    text = ["Begin Properties 1", f"YOUNG_MODULUS {YOUNG}", f"POISSON_RATIO {POISSON}", "DENSITY 1.0", "THICKNESS 1.0"]
    text += ["CONSTITUTIVE_LAW LinearElasticPlaneStrain2DLaw", "End Properties"]
    text += numbered("Nodes", [f"{k} {x!r} {y!r} 0.0" for k, (x, y) in enumerate(points, 1)])
    text += entities("Elements SmallDisplacementElement2D4N", enumerate(cells, 1))
    for kind in ("LineCondition2D2N", "PointLoadCondition2D1N"):
        text += entities(f"Conditions {kind}", [(k, of) for k, (this, _, of) in enumerate(pieces, 1) if this == kind])
    for axis, letter in enumerate("XY"):
        text += numbered(f"NodalData POINT_LOAD_{letter}", [f"{node + 1} 0 {load[axis]!r}" for node, load in loaded.items()])

    def part(name, nodes, owners=()):
        text.append(f"Begin SubModelPart {name}")
        text.extend(numbered("SubModelPartNodes", [node + 1 for node in sorted(set(nodes))]))
        text.extend(numbered("SubModelPartConditions", [k for k, (_, owner, _) in enumerate(pieces, 1) if owner in owners]))
        text.append("End SubModelPart")
    part("FixX", deck.nodes("lower.left")[0] + deck.nodes("upper.left")[0])
    part("FixY", [node for side in deck.fixed_y for node in deck.nodes(side)[0]])
    part("Load", loaded, ["load"])
    part("Secondary", touching[secondary], [secondary])
    part("Touching", touching["lower.top"] + touching["upper.bottom"], list(touching))
    write_lines(path, text)


def nodal_loads(deck):
    """Integral of the traction times the shape function, by node: exact for linear tractions."""
    nodes, points = deck.nodes(deck.loaded)
    loads = {node: [0.0, 0.0] for node in nodes}
    for (first, start), (last, end) in lines(list(zip(nodes, points))):
        length = math.dist(start, end)
        for axis, formula in enumerate(deck.traction):
            at_start, at_end = (eval(formula, {"X": x, "Y": y}) for x, y in (start, end))
            loads[first][axis] += length * (2 * at_start + at_end) / 6
            loads[last][axis] += length * (at_start + 2 * at_end) / 6
    return loads


def write_lines(path, text):
    path.write_text("\n".join(map(str, text)) + "\n")
