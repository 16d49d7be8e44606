"""Aligned contact cases for ladder.py --aligned: nodes meet corners, edges, axes of symmetry and flats
exactly. `case(k)` is a Setup, k = 1 … len(all_cases()): its case file as TOML, and what must hold.

Nothing is random: parameters go through their values in turn, with coprime periods, so that a number
keeps its case on every machine as long as families are only added at the end of FAMILIES.

A claim is a dictionary {"judge": NAME, …}; aligned_judge.py explains the names. Claims come from symmetry,
balance and closed solutions alone.

Units: lengths of order 1, density 1, E = 1000, ν = 0.3: pressure waves travel at 37, a drop at 0.5 is
1.4 % of it. A cell has a twelfth of a unit between its nodes where nothing else is said.
"""

from copy import deepcopy
from math import cos, pi, radians, sin, sqrt

import ladder_solids

PLANE = ["T3", "Q4", "T6", "Q9", "T10"]
SPACE = ["Hex8", "Tet4", "Hex27", "Tet10"]
DEGREE = {"T3": 1, "Q4": 1, "T6": 2, "Q9": 2, "T10": 3, "Hex8": 1, "Tet4": 1, "Hex27": 2, "Tet10": 2, "L2": 1, "L3": 2, "L4": 3}
SCHEMES = {
    "chung-hulbert": {"kind": "chung-hulbert", "rho_inf": 0.5},
    "bathe": {"kind": "bathe", "rho_inf": 0.5},
    "energy-momentum": {"kind": "energy-momentum"},
    "hu": {"kind": "hu"},
    "central-diff": {"kind": "central-difference"},
    "moreau-jean": {"kind": "moreau-jean", "theta": 0.5},
    "trapezoidal": {"kind": "newmark", "beta": 0.25, "gamma": 0.5},
    "backward-euler": {"kind": "backward-euler"},
    "hht": {"kind": "hht", "alpha": 0.1},
    "tr-bdf2": {"kind": "tr-bdf2"},
    "bdf2": {"kind": "bdf2"},
    "wbz": {"kind": "wbz", "rho_inf": 0.5},
    "paoli": {"kind": "paoli-schatzman"},
    "ns-alpha": {"kind": "nonsmooth-generalized-alpha", "rho_inf": 0.8},
    "static": {"kind": "static"},
}
EXPLICIT = {"central-diff", "paoli"}
IMPULSE = {"central-diff", "paoli", "moreau-jean", "ns-alpha"}
MAIN = ["chung-hulbert", "bathe", "energy-momentum", "hu", "central-diff", "moreau-jean"]
ALL = [name for name in SCHEMES if name != "static"]
# Ways to declare a contact of two bodies.
WAYS = ["named", "skin", "all", "named-swapped", "skin-swapped"]
AXES = "xyz"


def speed(young, density=1.0, poisson=0.3):
    return sqrt(young * (1 - poisson) / (density * (1 + poisson) * (1 - 2 * poisson)))


def symmetric(*parts):
    """Whether the meshes are mirror images of themselves: structured quadrilaterals and hexahedra."""
    return all(p.element[0] in "QH" and "cells" in p.mesh for p in parts)


class Part:
    """A body: mesh as a table, names of its sides, distance of its nodes, volume."""

    def __init__(self, name, element, mesh, h, volume, sides=None, young=1000.0, density=1.0, poisson=0.3, **keys):
        self.name, self.element, self.mesh, self.h, self.volume = name, element, mesh, h, volume
        self.names = sides or {}
        self.young, self.density, self.poisson, self.keys = young, density, poisson, keys
        self.law = keys.pop("law", "neo-hookean")

    def side(self, which):
        return f"{self.name}.{self.names.get(which, which)}"

    @property
    def mass(self):
        return self.volume * self.density


def counts(element, lengths, per):
    """Cells along each edge, with `per` intervals between nodes in a unit of length."""
    return [max(1, round(length * per / DEGREE[element])) for length in lengths]


def block(name, element, low, high, per=12, rough=False, **more):
    """A rectangle or a box. `rough`: of an unstructured mesh of triangles, in space extruded along y."""
    size = [round(b - a, 12) for a, b in zip(low, high)]
    volume = 1.0
    for s in size:
        volume *= s
    if rough and element[0] == "T" and len(low) == 2:
        (x, y), (a, b) = low, high
        mesh = {"shape": "polygon", "points": [[x, y], [a, y], [a, b], [x, b]], "size": DEGREE[element] / per}
        return Part(name, element, mesh, 1 / per, volume, {"bottom": "side1", "right": "side2", "top": "side3", "left": "side4"}, **more)
    cells = more.pop("cells", None) or counts(element, size, per)
    h = min(s / n for s, n in zip(size, cells)) / DEGREE[element]
    return Part(name, element, {"shape": "rectangle" if len(low) == 2 else "box", "min": list(low), "max": list(high), "cells": cells}, h, volume, **more)


def disc(name, element, radius, center, rings, half=False, **more):
    mesh = {"shape": "half-disc" if half else "disc", "radius": radius, "center": list(center), "size": radius / rings}
    return Part(name, element, mesh, radius / rings / DEGREE[element], pi * radius**2 / (2 if half else 1), {"bottom": "arc", "top": "arc"}, **more)


def polygon(name, element, points, size, **more):
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1])) / 2
    return Part(name, element, {"shape": "polygon", "points": [list(p) for p in points], "size": size}, size / DEGREE[element], area, **more)


class Setup:
    """A case and its claims. `twin`: another case, with which `agree` compares."""

    def __init__(self, what, parts, scheme, end, **more):
        self.what, self.parts, self.scheme, self.end = what, parts, scheme, end
        self.contacts, self.supports = more.pop("contacts", []), more.pop("supports", [])
        self.loads, self.probes, self.claims = more.pop("loads", []), more.pop("probes", []), more.pop("claims", [])
        self.step, self.twin, self.plane = more.pop("step", None), more.pop("twin", None), more.pop("plane", "strain")
        self.may_refuse, self.field, self.tolerance = more.pop("may_refuse", None), more.pop("field", True), more.pop("tolerance", None)
        assert not more, more
        self.family = self.number = None

    @property
    def dimension(self):
        mesh = self.parts[0].mesh
        return 1 if mesh["shape"] == "interval" else 2 if self.parts[0].element in PLANE else 3

    def times(self):
        """(step, number of steps)."""
        if self.scheme == "static":
            return 0.25, 4
        if self.step:
            step = self.step
        elif self.scheme in EXPLICIT:
            factor = {1: 0.25, 2: 0.2, 3: 0.12}
            step = min(factor[DEGREE[p.element]] * p.h / speed(p.young, p.density, p.poisson) for p in self.parts)
        else:
            step = min(0.5 * p.h / speed(p.young, p.density, p.poisson) for p in self.parts)
            step = min(max(step, self.end / 250), self.end / 50)
        step = float(f"{step:.2g}")
        return step, max(20, round(self.end / step))

    def document(self):
        """The case as tables."""
        step, n = self.times()
        explicit = self.scheme in EXPLICIT
        tree = {"title": f"{self.family} {self.number:04}, {self.scheme}: {self.what}", "dimension": self.dimension}
        if self.dimension == 2:
            tree["plane"] = self.plane
        tree["material"] = [{"name": p.name, "law": p.law, "density": p.density, "young": p.young, "poisson": p.poisson} for p in self.parts]
        tree["body"] = [
            {"name": p.name, "material": p.name, "element": p.element, "mesh": p.mesh, **p.keys, **({"mass": "lumped"} if explicit else {})}
            for p in self.parts
        ]
        tree["support"], tree["load"] = self.supports, self.loads
        tree["contact"] = [{"name": f"c{i}", **c} for i, c in enumerate(self.contacts, 1)]
        tree["probe"] = self.probes
        tree["time"] = {"end": float(f"{n * step:.12g}"), "step": step, "scheme": SCHEMES[self.scheme]}
        tolerance = self.tolerance or (1e-12 if self.scheme == "static" else None)
        if tolerance:
            tree["newton"] = {"tolerance": tolerance}
        tree["output"] = {"fields_every": max(1, n // (15 if self.dimension == 3 else 40)), "checkpoint_every": 1000000}
        return tree

    def text(self):
        return toml(self.document(), f"# {self.what}.\n")

    def meta(self):
        cells = "+".join(p.element for p in self.parts)
        return {"category": self.family, "family": self.scheme, "enforcement": "multiplier", "elements": cells}


def inline(x):
    """A value as TOML."""
    if isinstance(x, bool):
        return str(x).lower()
    if isinstance(x, dict):
        return "{ " + ", ".join(f"{key} = {inline(value)}" for key, value in x.items()) + " }"
    if isinstance(x, (list, tuple)):
        return "[" + ", ".join(inline(value) for value in x) + "]"
    if isinstance(x, str):
        return f'"{x}"'
    return repr(round(x, 15)) if isinstance(x, float) else repr(x)


def toml(tree, head=""):
    """Tables as TOML: lists of tables as such, all other values in one line."""
    lines, tables = [], []
    for key, value in tree.items():
        if isinstance(value, list):
            for item in value:
                tables.append(f"\n[[{key}]]\n" + "".join(f"{k} = {inline(v)}\n" for k, v in item.items()))
        elif isinstance(value, dict):
            tables.append(f"\n[{key}]\n" + "".join(f"{k} = {inline(v)}\n" for k, v in value.items()))
        else:
            lines.append(f"{key} = {inline(value)}\n")
    return head + "".join(lines + tables)


# Pieces


def hold(*sides, fix="xyz", dimension=2, **more):
    return {**more, "on": list(sides), "fix": [a for a in AXES[:dimension] if a in fix]}


def between(way, upper, lower, **law):
    """Contact of two parts, the bottom of one on the top of the other."""
    pair = {
        "named": (upper.side("bottom"), lower.side("top")),
        "named-swapped": (lower.side("top"), upper.side("bottom")),
        "skin": (f"{upper.name}.skin", f"{lower.name}.skin"),
        "skin-swapped": (f"{lower.name}.skin", f"{upper.name}.skin"),
    }
    if way == "all":
        return {"between": "all", **law}
    return {"secondary": pair[way][0], "primary": pair[way][1], **law}


def floor(*parts, dimension=2, side="skin", **law):
    point, normal = [0.0] * dimension, [0.0] * (dimension - 1) + [1.0]
    return [{"secondary": f"{p.name}.{side}", "primary": {"plane": {"point": point, "normal": normal}}, **law} for p in parts]


def still(body, parts, axes="x", scale=0.5, tol=None, flush=False):
    """Nothing pushes the body along the axes. Symmetric meshes: to 1e-6; where corners stand exactly on
    corners (`flush`), of which rounding chooses the side, to 1e-4. Others: to twice the strain v/c of the
    impact, by which surfaces may tilt."""
    strain = scale / min(speed(p.young, p.density, p.poisson) for p in parts)
    limit = tol or ((1e-4 if flush else 1e-6) if symmetric(*parts) else 2 * strain)
    return [{"judge": "still", "body": body, "axis": a, "scale": scale, "limit": limit} for a in axes]


def newton(part, dimension, gravity=0.0, axes=None):
    return {"judge": "newton", "body": part.name, "mass": part.mass, "gravity": gravity, "axes": axes or AXES[:dimension]}


TOUCHES = {"judge": "touches"}
FLIGHT = {"judge": "flight"}


def bounce(top, bottom, v, gap, parts):
    """Time for the flight and the contact of two layers of these heights."""
    return gap / v + 5 * (top + bottom) / min(speed(p.young, p.density, p.poisson) for p in parts)


# Families in the plane


def pedestals():
    """A block is dropped flat on a narrower, equal or wider one."""
    for i in range(40):
        width = [0.5, 1.0, 1.5, 0.25, 0.75][i % 5]
        element = PLANE[(i + i // 5) % 5]
        other = element if i % 4 else PLANE[(i + 2) % 5]
        scheme = MAIN[(i + i // 6) % 6] if i % 3 else ALL[(i // 3) % len(ALL)]
        way = WAYS[(i + i // 10) % 5]
        mesh = ["matching", "2:3", "matching", "unstructured"][(i + i // 8) % 4]
        v, gap = 0.5, 0.01
        upper = block("block", element, [-0.5, gap], [0.5, 0.25 + gap], velocity=[0.0, -v])
        lower = block("pedestal", other, [-width / 2, -0.25], [width / 2, 0.0], per=8 if mesh == "2:3" else 12, rough=mesh == "unstructured")
        parts = [upper, lower]
        claims = [TOUCHES, FLIGHT, newton(upper, 2), *still("block", parts, flush=width == 1.0), {"judge": "rebound", "body": "block", "axis": "y", "before": -v}]
        yield Setup(
            f"a block 1 wide is dropped flat on a pedestal {width} wide, {mesh} meshes, sides {way}", parts, scheme, bounce(0.25, 0.25, v, gap, parts),
            contacts=[between(way, upper, lower)], supports=[hold(lower.side("bottom"))], claims=claims,
        )  # fmt: skip


def piers():
    """A block is dropped flat on two supports."""
    for i in range(24):
        element = PLANE[i % 5]
        scheme = MAIN[(i + i // 6) % 6] if i % 3 else ALL[(i // 3 + 4) % len(ALL)]
        way = ["skin", "all", "skin-swapped", "named", "named-swapped"][(i + i // 5) % 5]
        inner = [0.25, 0.125, 0.0][i % 3]
        width = [0.25, 0.125][i // 3 % 2]
        v, gap = 0.5, 0.01
        upper = block("block", element, [-0.5, gap], [0.5, 0.25 + gap], per=16, velocity=[0.0, -v])
        left = block("left", element, [-inner - width, -0.25], [-inner, 0.0], per=16 if i % 4 else 8)
        right = block("right", element, [inner, -0.25], [inner + width, 0.0], per=16 if i % 4 else 8)
        if inner == 0.0:  # a common wall would be a contact, too
            left = block("left", element, [-0.0625 - width, -0.25], [-0.0625, 0.0], per=16)
            right = block("right", element, [0.0625, -0.25], [0.0625 + width, 0.0], per=16)
        parts = [upper, left, right]
        contacts = [between(way, upper, left)] + ([between(way, upper, right)] if way != "all" else [])
        yield Setup(
            f"a block is dropped flat on two piers, {inner or 0.0625} from the axis and {width} wide, sides {way}", parts, scheme, bounce(0.25, 0.25, v, gap, parts),
            contacts=contacts, supports=[hold("left.bottom", "right.bottom")],
            claims=[TOUCHES, FLIGHT, *still("block", parts), {"judge": "rebound", "body": "block", "axis": "y", "before": -v}],
        )  # fmt: skip


def table_edges():
    """A block is dropped flat over the edge of a table, of which the corner meets a node of its bottom."""
    for i in range(24):
        element = PLANE[(i + 1) % 5]
        scheme = MAIN[(i + i // 6) % 6] if i % 3 else ALL[(i // 3 + 8) % len(ALL)]
        way = WAYS[(i + i // 5) % 5]
        over = [0.5, 0.25, 0.75, 1 / 3][(i + i // 4) % 4]
        v, gap = 0.5, 0.01
        upper = block("block", element, [over - 1.0, gap], [over, 0.25 + gap], velocity=[0.0, -v])
        lower = block("table", element, [-1.5, -0.5], [0.0, 0.0], per=12 if i % 2 else 8)
        parts = [upper, lower]
        yield Setup(
            f"a block is dropped flat over the edge of a table, {over:.3g} of it beyond, sides {way}", parts, scheme, bounce(0.25, 0.5, v, gap, parts),
            contacts=[between(way, upper, lower)], supports=[hold("table.bottom")], claims=[TOUCHES, FLIGHT, newton(upper, 2)],
        )  # fmt: skip


def halves():
    """Half models: no node on the axis is lost, whatever instant within a step it touches at."""
    for i in range(24):
        element = ["T6", "T3", "T10"][i % 3]
        scheme = ALL[i % len(ALL)] if i % 2 else MAIN[(i // 2) % 6]
        v, step = 1.0, 0.002
        gap = 0.01 + v * step * (i % 20) / 20
        body = disc("disc", element, 0.3, [0.0, 0.3 + gap], [3, 6, 3][i % 3], half=True, young=20000.0, density=2.0, velocity=[0.0, -v])
        soft = block("layer", element, [0.0, -0.25], [0.75, 0.0], per=16, young=60.0, density=0.5)
        probes = [
            {"name": "upper", "body": "disc", "at": [0.0, gap], "record": ["ux", "uy"]},
            {"name": "lower", "body": "layer", "at": [0.0, 0.0], "record": ["ux", "uy"]},
        ]
        limit = (0.1 if scheme in IMPULSE else 0.01) * soft.h
        pair = ("disc.arc", "layer.top") if i % 4 < 3 else ("layer.top", "disc.arc")
        claims = [TOUCHES, {"judge": "apart", "upper": "upper.uy", "lower": "lower.uy", "gap": gap, "limit": limit}]
        yield Setup(
            f"half a stiff disc on half a soft layer, gap {gap:.4g}", [body, soft], scheme, 0.15, step=None if scheme in EXPLICIT else step,
            contacts=[{"secondary": pair[0], "primary": pair[1]}], probes=probes, claims=claims,
            supports=[hold("layer.bottom"), hold("disc.axis", "layer.left", fix="x")],
        )  # fmt: skip


def halves_of_blocks():
    """Half models of structured meshes: the half of the whole, to round-off."""
    for i in range(16):
        element = ["Q4", "Q9"][i % 2]
        scheme = MAIN[(i + i // 6) % 6]
        width = [0.5, 1.0, 1.5, 0.25][i // 2 % 4]
        way = ["named", "skin", "named-swapped"][i % 3]
        v, gap = 0.5, 0.01

        def whole(low):
            upper = block("block", element, [0.5 * low, gap], [0.5, 0.25 + gap], per=16, velocity=[0.0, -v])
            lower = block("pedestal", element, [width / 2 * low, -0.25], [width / 2, 0.0], per=16)
            parts = [upper, lower]
            cut = [hold("block.left", "pedestal.left", fix="x")] if low == 0.0 else []
            return Setup(
                f"{'half of ' if low == 0.0 else ''}a block on a pedestal {width} wide, sides {way}", parts, scheme, bounce(0.25, 0.25, v, gap, parts),
                contacts=[between(way, upper, lower)], supports=[hold("pedestal.bottom"), *cut], claims=[TOUCHES], tolerance=1e-11,
            )  # fmt: skip

        half, twin = whole(0.0), whole(-1.0)
        same = {"block.velocity_y": 1.0, "block.center_y": 1.0, "contact_impulse_y": 0.5, "kinetic": 0.5, "strain": 0.5}
        half.claims.append({"judge": "agree", "columns": same, "limit": 1e-6})
        half.twin = twin
        yield half


def corners():
    """A square falls on its corner, straight above a node or a joint of the flat below."""
    for i in range(20):
        element = PLANE[(i + i // 5) % 5]
        scheme = MAIN[(i + i // 6) % 6] if i % 3 else ALL[(i // 3 + 2) % len(ALL)]
        way = ["skin", "all", "skin-swapped", "plane"][(i + i // 4) % 4]
        v, gap = 0.5, 0.01
        square = block("square", element, [-0.25, -0.25], [0.25, 0.25], place={"rotate": 45.0, "shift": [0.0, 0.25 * sqrt(2) + gap]}, velocity=[0.0, -v])
        lower = block("table", element, [-0.75, -0.5], [0.75, 0.0], per=12 if i % 2 else 10)
        parts = [square] if way == "plane" else [square, lower]
        contacts = floor(square) if way == "plane" else [between(way, square, lower)]
        # A dent of triangles is not symmetric.
        claims = [TOUCHES, FLIGHT, newton(square, 2)]
        if way == "plane" or symmetric(*parts):
            claims += still("square", parts, tol=1e-9 if way == "plane" else None)
        yield Setup(
            f"a square falls on its corner, onto {'a rigid plane' if way == 'plane' else 'a flat, sides ' + way}", parts, scheme, gap / v + 0.08,
            contacts=contacts, supports=[] if way == "plane" else [hold("table.bottom")], claims=claims,
        )  # fmt: skip


def slides():
    """A block slides without friction over the straight edge of a table and tips."""
    for i in range(20):
        element = PLANE[i % 5]
        scheme = ["chung-hulbert", "bathe", "energy-momentum", "hu", "moreau-jean", "backward-euler", "central-diff"][(i + i // 7) % 7]
        way = WAYS[(i + i // 5) % 5]
        if way.startswith("named"):
            way = "skin"  # the named sides are left by the block
        phase = (i % 8) / 8 / 12
        v, g, ahead = 0.5, 1.0, 0.15
        upper = block("block", element, [-0.25 - ahead - phase, 0.0], [0.25 - ahead - phase, 0.25], velocity=[v, 0.0], gravity=[0.0, -g])
        lower = block("table", element, [-1.0, -0.25], [0.0, 0.0], per=12 if i % 3 else 8)
        claims = [TOUCHES, {"judge": "steady", "body": "block", "axis": "x", "value": v, "limit": 1.25e-3 * v, "until": (ahead + phase) / v}]
        yield Setup(
            f"a block slides over the edge of a table, {phase:.3g} of a cell's phase, sides {way}", [upper, lower], scheme, (ahead + phase) / v + 0.1,
            contacts=[between(way, upper, lower)], supports=[hold("table.bottom")], claims=claims,
        )  # fmt: skip


def rough_slides():
    """A block slides with friction on a rigid plane or a table: the deceleration is known."""
    for i in range(20):
        element = PLANE[(i + i // 5) % 5]
        scheme = ["chung-hulbert", "bathe", "hu", "energy-momentum", "backward-euler", "moreau-jean", "tr-bdf2"][(i + i // 7) % 7]
        rigid, mu, g, v = i % 2 == 0, [0.1, 0.2, 0.3][i % 3], 1.0, 0.2
        upper = block("block", element, [-0.5, 0.0], [0.0, 0.25], velocity=[v, 0.0], gravity=[0.0, -g])
        lower = block("table", element, [-1.0, -0.25], [0.5, 0.0])
        stop = v / (mu * g)
        end = min(0.3, 0.8 * stop)
        way = WAYS[i % 5] if i % 5 in (0, 1, 3, 4) else "skin"
        contacts = floor(upper, mu=mu) if rigid else [between(way, upper, lower, mu=mu)]
        claims = [TOUCHES, {"judge": "slows", "body": "block", "axis": "x", "value": v, "rate": mu * g, "limit": 0.04 * v, "until": end}]
        claims.append({"judge": "coulomb", "mu": mu, "limit": 1e-6 if rigid else 0.02})
        parts = [upper] if rigid else [upper, lower]
        yield Setup(
            f"a block slides with friction {mu} on {'a rigid plane' if rigid else 'a table, sides ' + way}", parts, scheme, end,
            contacts=contacts, supports=[] if rigid else [hold("table.bottom")], claims=claims,
        )  # fmt: skip


def bars_in_line():
    """Bars of dimension 1, end on end: velocities are exchanged; of one twice as long, the short one stops."""
    for i in range(14):
        element = ["L2", "L3", "L4"][i % 3]
        scheme = ALL[i % len(ALL)]
        long = 2.0 if i % 5 == 4 else 1.0
        n = 60 // DEGREE[element]
        common = {"young": 1.0, "poisson": 0.0, "law": "linear-elastic"}
        touching = i % 4 == 3
        a = Part("a", element, {"shape": "interval", "min": -1.0, "max": 0.0, "cells": n}, 1 / 60, 1.0, velocity=[0.01], **common)
        gap = 0.0 if touching else 0.01
        b = Part("b", element, {"shape": "interval", "min": gap, "max": gap + long, "cells": n * round(long)}, 1 / 60, long, **common)
        # Damped schemes and steps longer than a cell lose what the wave fronts contain of the
        # energy.
        low = 0.85 if scheme in ("hu", "backward-euler", "bdf2", "moreau-jean", "ns-alpha", "paoli") else 0.95
        claims = [TOUCHES, {"judge": "conserved", "axis": "x", "limit": 1e-9}, {"judge": "apart-end"}]
        claims.append({"judge": "last", "column": "b.velocity_x", "value": 0.01 / long, "limit": 0.01 / long * (1 - low)})
        yield Setup(
            f"a bar of length 1 strikes one of length {long}{', touching' if touching else ''}", [a, b], scheme, 1.0 * (not touching) + 2.0 * long + 1.0,
            step=None if scheme in EXPLICIT else 0.01, contacts=[{"secondary": "a.right", "primary": "b.left"}], claims=claims, field=False,
        )  # fmt: skip


def bars():
    """Strips of the plane, end on end, flush: no side motion, momentum is kept."""
    for i in range(20):
        element = PLANE[(i + i // 5) % 5]
        scheme = MAIN[(i + i // 6) % 6] if i % 3 else ALL[(i // 3 + 5) % len(ALL)]
        way = ["named", "skin", "all"][(i + i // 3) % 3]
        ratio = ["matching", "2:3"][i // 2 % 2]
        v, gap = 0.2, [0.002, 0.0][i % 4 == 3]
        a = block("a", element, [-1.0, -0.125], [0.0, 0.125], per=12, velocity=[v, 0.0], poisson=0.0)
        b = block("b", element, [gap, -0.125], [gap + 1.0, 0.125], per=12 if ratio == "matching" else 8, poisson=0.0)
        if ratio == "2:3":
            b.mesh["cells"][1] = max(1, a.mesh["cells"][1] * 2 // 3)
        contact = {"named": {"secondary": "a.right", "primary": "b.left"}, "skin": {"secondary": "a.skin", "primary": "b.skin"}, "all": {"between": "all"}}[way]
        claims = [TOUCHES, *({"judge": "conserved", "axis": c, "limit": 1e-8} for c in "xy"), *still("b", [a, b], "y", v, flush=True)]
        claims.append({"judge": "rebound-pair", "a": "a", "b": "b", "axis": "x", "before": v, "low": 0.8})
        yield Setup(
            f"strips end on end, {ratio} meshes, {'touching, ' if not gap else ''}sides {way}", [a, b], scheme, gap / v + 2.2 / sqrt(1000.0) + 0.04,
            contacts=[contact], claims=claims,
        )  # fmt: skip


def stacks():
    """Blocks rest on each other in load steps: the forces are the weights above."""
    for i in range(20):
        element = PLANE[i % 5]
        widths = [(1.0, 0.5, 0.25), (1.0, 1.0, 1.0), (0.5, 1.0, 0.5), (1.0, 0.75, 0.5)][(i + i // 4) % 4]
        mu = None if i % 2 else 0.3
        way = ["named", "named-swapped", "skin"][(i + i // 3) % 3]
        ratio = 8 if i // 2 % 2 else 12
        parts, contacts, claims, y, g = [], [], [TOUCHES], 0.0, 1.0
        for j, w in enumerate(widths):
            parts.append(block(f"b{j + 1}", element, [-w / 2, y], [w / 2, y + 0.25], per=12 if j % 2 else ratio, gravity=[0.0, -g]))
            y = round(y + 0.25, 12)
        law = {"mu": mu} if mu else {}
        contacts = floor(parts[0], side="bottom", **law)
        contacts += [between(way, parts[j + 1], parts[j], **law) for j in range(2)]
        for j in range(3):
            weight = sum(p.mass for p in parts[j:]) * g
            claims.append({"judge": "last", "column": f"c{j + 1}.force_y", "value": weight, "limit": 1e-8 * weight, "sign": False})
            claims.append({"judge": "center", "contact": f"c{j + 1}", "axis": "x", "value": 0.0, "limit": 1e-6 if symmetric(*parts) and mu else 2e-2})
        supports = [] if mu else [hold(*(f"b{j + 1}.left" for j in range(3)), fix="x")]
        if not mu:
            claims = [c for c in claims if c["judge"] != "center"]
        yield Setup(
            f"a stack {widths} wide under its weight, {f'friction {mu}' if mu else 'held sideways'}, sides {way}", parts, "static", 1.0,
            contacts=contacts, supports=supports, claims=claims,
        )  # fmt: skip


def wheels():
    """A disc rolls or slides to a step, on a flat through its lowest point."""
    for i in range(14):
        element = ["T6", "T3", "T10"][i % 3]
        scheme = MAIN[(i + i // 6) % 6]
        rise = [0.125, 0.0, 0.25][i % 3]
        v, R = 0.5, 0.25
        wheel = disc("wheel", element, R, [-0.3 - (i % 4) / 40, R], [3, 6, 2][i % 3], velocity=[v, 0.0])
        points = [[-1.0, -0.25], [0.5, -0.25], [0.5, rise], [0.0, rise], [0.0, 0.0], [-1.0, 0.0]]
        if rise == 0.0:
            points = [[-1.0, -0.25], [0.5, -0.25], [0.5, 0.0], [-1.0, 0.0]]
        road = polygon("road", element, points, 0.125)
        pair = ("wheel.arc", "road.skin") if i % 2 else ("road.skin", "wheel.arc")
        claims = [TOUCHES] if rise else []
        if rise == 0.0:
            claims.append({"judge": "steady", "body": "wheel", "axis": "x", "value": v, "limit": 1e-6, "until": 1.0})
        yield Setup(
            f"a disc slides along a flat to a step {rise} high", [wheel, road], scheme, 0.25,
            contacts=[{"secondary": pair[0], "primary": pair[1]}], supports=[hold("road.side1")], claims=claims,
        )  # fmt: skip


def arc(radius, size):
    """Largest distance of a quadratic arc from the circle on which its nodes lie."""
    return radius * (size / radius) ** 4 / 512


def press_fits():
    """Shaft and hub with an interference: Lamé's solution in plane stress."""
    for i in range(18):
        element = ["T6", "T3", "T10"][i % 3]
        scheme = "chung-hulbert" if i % 2 else "backward-euler"
        a, b, E, inner = 0.5, 1.0, 1000.0, [0.0, 0.0, 0.25][(i + i // 3) % 3]
        delta = [1e-3, 5e-4][i // 3 % 2] * a
        common = {"law": "saint-venant-kirchhoff"}
        fine = [0.1, 0.1, 0.125][i // 6]
        shape = {"shape": "disc", "radius": a + delta, "center": [0.0, 0.0], "size": fine}
        if inner:
            shape = {"shape": "ring", "inner": inner, "outer": a + delta, "center": [0.0, 0.0], "size": fine}
        shaft = Part("shaft", element, shape, fine / DEGREE[element], pi * (a**2 - inner**2), **common)
        size = [0.13, 0.1, 0.12][i // 6]
        hub = Part("hub", element, {"shape": "ring", "inner": a, "outer": b, "center": [0.0, 0.0], "size": size}, size / DEGREE[element], pi * (b**2 - a**2), **common)
        p = E * delta / (2 * a**3) * (a**2 - inner**2) * (b**2 - a**2) / (b**2 - inner**2)
        outer = "shaft.arc" if not inner else "shaft.outer"
        pair = (outer, "hub.inner") if i % 4 < 2 else ("hub.inner", outer)
        limit = 0.1 if element == "T3" else 0.02 + (arc(a, fine) + arc(a, size)) / delta
        hoop = 2 * p * a**2 / (b**2 - a**2)
        probes = [{"name": "rim", "body": "hub", "at": [b, 0.0], "record": ["sigma_yy"]}]
        claims = [TOUCHES, {"judge": "last", "column": "rim.sigma_yy", "value": hoop, "limit": limit * hoop}]
        if not inner:
            probes.append({"name": "centre", "body": "shaft", "at": [0.0, 0.0], "record": ["sigma_xx", "sigma_yy"]})
            claims += [{"judge": "last", "column": f"centre.sigma_{x}{x}", "value": -p, "limit": limit * p} for x in "xy"]
        yield Setup(
            f"press fit, interference {delta}, shaft {'hollow' if inner else 'solid'}, pressure {p:.4g}", [shaft, hub], scheme, 0.02, step=0.001,
            contacts=[{"secondary": pair[0], "primary": pair[1], "overlap": "relax"}], probes=probes, claims=claims, plane="stress",
            may_refuse="chord|straight|curved" if element == "T3" else None, field=element != "T3",
        )  # fmt: skip


def press_flat(elements, dimension):
    """Two columns between walls overlap: the pressure is uniform."""
    for i in range(2 * len(elements)):
        element = elements[i % len(elements)]
        delta, E = 1e-4, 1000.0
        tall = 0.5
        base = [0.25] * (dimension - 1)
        per = 12 if dimension == 2 else 8
        common = {"poisson": 0.0, "law": "saint-venant-kirchhoff"}
        low = [-x for x in base]
        a = block("lower", element, [*low, -tall], [*base, 0.0], per=per, **common)
        b = block("upper", element, [*low, -delta], [*base, tall], per=per, **common)
        b.mesh["cells"] = list(a.mesh["cells"])
        up = AXES[dimension - 1]
        p = E * delta / (2 * tall)
        way = ["named", "named-swapped"][i // len(elements)]
        probes = []
        for j, at in enumerate([[0.0] * (dimension - 1), [0.25] * (dimension - 1)]):
            probes.append({"name": f"p{j}", "body": "upper", "at": [*at, tall], "record": [f"sigma_{up}{up}"]})
            probes.append({"name": f"q{j}", "body": "lower", "at": [*at, 0.0], "record": [f"sigma_{up}{up}"]})
        claims = [TOUCHES] + [{"judge": "last", "column": f"{q['name']}.sigma_{up}{up}", "value": -p, "limit": 2e-3 * p} for q in probes]
        claims.append({"judge": "even", "contact": "c1", "value": p, "limit": 2e-3 * p})
        others = [s for s in ("left", "front") if s != "front" or dimension == 3]
        supports = [hold("lower.bottom", "upper.top", fix=up, dimension=3)]
        supports += [hold(f"lower.{s}", f"upper.{s}", fix="xy"[j], dimension=3) for j, s in enumerate(others)]
        yield Setup(
            f"two columns between walls overlap by {delta}, sides {way}", [a, b], "static", 1.0, contacts=[between(way, b, a, overlap="relax")],
            supports=supports, probes=probes, claims=claims,
        )  # fmt: skip


def patches(elements, dimension):
    """A block presses another under a uniform load, in load steps: uniform stress if the meshes match."""
    for i in range(3 * len(elements)):
        element = elements[i % len(elements)]
        style = i // len(elements)
        ratio = ["matching", "2:3", "matching"][style]
        way = ["named", "named", "named-swapped"][style]
        base, up = [0.5] * (dimension - 1), AXES[dimension - 1]
        per = 12 if dimension == 2 else 6
        low = [-x for x in base]
        a = block("lower", element, [*low, -0.5], [*base, 0.0], per=per)
        b = block("upper", element, [*low, 0.0], [*base, 0.5], per=per if ratio == "matching" else per * 2 // 3)
        q = 1.0
        claims = [TOUCHES, {"judge": "last", "column": f"contact_force_{up}", "value": q, "limit": 1e-8, "sign": False}]
        probes = []
        if ratio == "matching":
            probes = [{"name": "p", "body": "upper", "at": [0.5] * (dimension - 1) + [0.0], "record": [f"sigma_{up}{up}"]}]
            claims.append({"judge": "even", "contact": "c1", "value": None, "limit": 1e-4})
        others = [s for s in ("left", "front") if s != "front" or dimension == 3]
        supports = [hold("lower.bottom", fix=up, dimension=3)]
        supports += [hold(f"lower.{s}", f"upper.{s}", fix="xy"[j], dimension=3) for j, s in enumerate(others)]
        traction = ["0"] * (dimension - 1) + [f"-{q}*t"]
        yield Setup(
            f"a block presses another under a uniform load, {ratio} meshes, sides {way}", [a, b], "static", 1.0,
            contacts=[between(way, b, a)], supports=supports, loads=[{"on": ["upper.top"], "traction": traction}], probes=probes, claims=claims,
        )  # fmt: skip


def combs():
    """A comb of several teeth rests on a flat, or falls on it."""
    for i in range(16):
        element = PLANE[i % 5]
        teeth, pitch = [3, 5, 4][i % 3], 0.25
        still_one = i % 2 == 0
        scheme = "static" if still_one else MAIN[(i // 2) % 6]
        g = 1.0 if still_one else 0.0
        v, gap = (0.0, 0.0) if still_one else (0.5, 0.01)
        width = pitch * teeth
        low = -width / 2
        points = [[low, gap + 0.5], [low, gap]]
        for j in range(teeth):
            x = low + pitch * j
            points += [[x + pitch / 2, gap], [x + pitch / 2, gap + 0.25]]
            if j + 1 < teeth:
                points += [[x + pitch, gap + 0.25], [x + pitch, gap]]
        points += [[low + width - pitch / 2, gap + 0.5]]
        rough = "T3 T6 T10 T6 T3".split()[i % 5]
        comb = polygon("comb", rough, points, DEGREE[rough] * pitch / 4, gravity=[0.0, -g], velocity=[0.0, -v])
        table = block("table", element, [-1.0, -0.25], [1.0, 0.0], per=8 if i % 4 < 2 else 12)
        way = ["skin", "skin-swapped", "all"][i % 3]
        contact = between("skin" if still_one else way, comb, table, **({"mu": 0.3} if still_one else {}))
        weight = comb.mass * g
        claims = [TOUCHES]
        if still_one:
            claims.append({"judge": "last", "column": "contact_force_y", "value": weight, "limit": 1e-8 * weight, "sign": False})
        else:
            claims += [FLIGHT, newton(comb, 2), {"judge": "rebound", "body": "comb", "axis": "y", "before": -v}]
        yield Setup(
            f"a comb of {teeth} teeth {'rests on' if still_one else 'falls on'} a flat", [comb, table], scheme, 0.12,
            contacts=[contact], supports=[hold("table.bottom")], claims=claims,
        )  # fmt: skip


def rigid_corners():
    """A rigid corner between the nodes of a coarse block, and on a node of it, is not inside it."""
    for i in range(12):
        element = PLANE[i % 5]
        scheme = ["backward-euler", "chung-hulbert", "static", "bathe"][i % 4]
        x = [0.0, 1 / 12, 0.05][i % 3]
        depth = 0.05
        body = block("block", element, [-0.5, -0.5], [0.5, 0.0], per=[6, 4][i % 2])
        points = [[x - 0.5, 0.5], [x, 0.0], [x + 0.5, 0.5]]
        move = f"-{depth}*t" if scheme == "static" else f"-{depth}*(t/0.1)^2*(3 - 2*t/0.1)"
        contact = {"secondary": "block.skin" if i % 2 else "block.top", "primary": {"polyline": {"points": points}, "motion": {"y": move}}}
        claims = [TOUCHES, {"judge": "corner", "body": "block", "at": [x, 0.0], "move": [0.0, -depth], "limit": 0.1 / [6, 4][i % 2] * DEGREE[element]}]
        yield Setup(
            f"a rigid wedge is pressed into a block at x = {x:.3g}", [body], scheme, 0.1, contacts=[contact], supports=[hold("block.bottom")], claims=claims, field=False,
        )  # fmt: skip


def flights():
    """Sharp wedges with contact with themselves fly freely, and combs whose gaps are as wide as a cell."""
    for i in range(8):
        element = ["T6", "T3", "T10", "T6"][i % 4]
        scheme = ["bathe", "chung-hulbert", "energy-momentum", "hu"][i % 4]
        angle = [5.0, 10.0, 20.0, 30.0][i // 2]
        y = round(2 * sin(radians(angle / 2)), 6)
        wedge = polygon("wedge", element, [[0.0, 0.0], [2.0, -y], [2.0, y]], 0.2, velocity=[1.0, 0.0])
        claims = [{"judge": "steady", "body": "wedge", "axis": "x", "value": 1.0, "limit": 1e-9, "until": 1.0}, {"judge": "free"}]
        yield Setup(f"a wedge of {angle} degrees with self-contact flies freely", [wedge], scheme, 0.1, step=0.005, contacts=[{"between": ["wedge"]}], claims=claims)


def relaxed_rings():
    """Two rings with an interference start from relaxed free bodies and stay at rest."""
    for i in range(6):
        element = ["T6", "T10", "T3"][i % 3]
        hub = Part("hub", element, {"shape": "ring", "inner": 1.0, "outer": 2.0002, "center": [0.0, 0.0], "size": 0.2}, 0.1, 3 * pi, young=200.0, law="saint-venant-kirchhoff")
        rim = Part("rim", element, {"shape": "ring", "inner": 2.0, "outer": 3.0, "center": [0.0, 0.0], "size": [0.26, 0.2][i // 3]}, 0.1, 5 * pi, young=100.0, law="saint-venant-kirchhoff")
        pair = ("rim.inner", "hub.outer") if i % 2 else ("hub.outer", "rim.inner")
        claims = [TOUCHES, {"judge": "rest", "limit": 1e-6, "scale": 2e-4}]
        yield Setup(
            "rings with an interference stay at rest", [hub, rim], "backward-euler", 0.5, step=0.05, field=element != "T3", may_refuse="chord|straight|curved" if element == "T3" else None,
            contacts=[{"secondary": pair[0], "primary": pair[1], "overlap": "relax", **({"mu": 0.1} if i % 2 else {})}], claims=claims,
        )  # fmt: skip


def schemes():
    """Every scheme: a block is dropped flat on a block of its width, named sides and whole boundaries."""
    for i in range(2 * len(ALL)):
        scheme, way = ALL[i % len(ALL)], ["named", "skin"][i // len(ALL)]
        v, gap = 0.5, 0.01
        upper = block("block", "Q4", [-0.5, gap], [0.5, 0.25 + gap], velocity=[0.0, -v])
        lower = block("base", "Q4", [-0.5, -0.25], [0.5, 0.0])
        parts = [upper, lower]
        yield Setup(
            f"a block is dropped flat on a block of its width, sides {way}", parts, scheme, bounce(0.25, 0.25, v, gap, parts), contacts=[between(way, upper, lower)],
            supports=[hold("base.bottom")], claims=[TOUCHES, FLIGHT, newton(upper, 2), *still("block", parts, flush=True), {"judge": "rebound", "body": "block", "axis": "y", "before": -v}],
        )  # fmt: skip


# Families in space


def pads():
    """A stiff cube rests on a soft pad by friction, in load steps from touch."""
    for i in range(32):
        element = SPACE[i % 4] if i < 20 else SPACE[i % 2]
        size = [1.0, 0.5, 0.75, 2.0][i // 4 % 4]
        width = [2.0, 1.0, 1.5][i % 3] * size
        offset = [0.0, 0.1, 0.25][i // 3 % 3] * size if width > size else 0.0
        n = [10, 6, 8, 4][(i + i // 4) % 4] // DEGREE[element]
        thick = 0.2 * size
        mu, g = [0.1, 0.3][i % 2], 1.0
        common = {"density": 1.0, "poisson": 0.4}
        half = size / 2
        cube = block("cube", element, [offset - half, -half, thick], [offset + half, half, thick + size], cells=[2, 2, 2], young=1e7, gravity=[0.0, 0.0, -g], **common)
        pad = block("pad", element, [-width / 2, -width / 2, 0.0], [width / 2, width / 2, thick], cells=[n, n, 1], young=1e3, **common)
        way = ["named-swapped", "named", "skin-swapped"][(i + i // 3) % 3]
        weight = cube.mass * g
        claims = [TOUCHES, {"judge": "last", "column": "contact_force_z", "value": weight, "limit": 1e-8 * weight, "sign": False}]
        claims += [{"judge": "last", "column": f"contact_force_{x}", "value": 0.0, "limit": 1e-8 * weight} for x in "xy"]
        yield Setup(
            f"a cube of {size} rests on a pad {width} wide, offset {offset}, friction {mu}, sides {way}", [cube, pad], "static", 1.0,
            contacts=[between(way, cube, pad, mu=mu)], supports=[hold("pad.bottom", dimension=3)], claims=claims,
        )  # fmt: skip


def space_pedestals():
    """A cuboid is dropped flat on a narrower, equal or wider one."""
    for i in range(24):
        element = SPACE[(i + i // 4) % 4]
        scheme = MAIN[(i + i // 6) % 6]
        width = [0.25, 0.5, 0.75][i % 3]
        way = WAYS[(i + i // 5) % 5]
        ratio = 8 if i % 4 else 16 / 3
        v, gap = 0.5, 0.005
        upper = block("block", element, [-0.25, -0.25, gap], [0.25, 0.25, 0.25 + gap], per=8, velocity=[0.0, 0.0, -v])
        lower = block("pedestal", element, [-width / 2, -width / 2, -0.25], [width / 2, width / 2, 0.0], per=ratio)
        parts = [upper, lower]
        claims = [TOUCHES, FLIGHT, newton(upper, 3), *still("block", parts, "xy", flush=width == 0.5), {"judge": "rebound", "body": "block", "axis": "z", "before": -v}]
        yield Setup(
            f"a cuboid 0.5 wide is dropped flat on one {width} wide, sides {way}", parts, scheme, bounce(0.2, 0.2, v, gap, parts),
            contacts=[between(way, upper, lower)], supports=[hold("pedestal.bottom", dimension=3)], claims=claims,
        )  # fmt: skip


def space_edges():
    """A block is dropped flat onto the straight edge of a table, turned about the vertical."""
    for i in range(24):
        element = SPACE[(i + i // 4) % 4]
        scheme = MAIN[(i + i // 6) % 6] if i % 3 else "chung-hulbert"
        angle = [0.0, 45.0, 90.0, 30.0, 60.0, 77.0, 15.0, 33.0][i % 8]
        way = ["skin", "skin-swapped", "all"][i // 2 % 3]
        v, gap = 0.5, 0.002
        upper = block("block", element, [-0.25, -0.15, 0.0], [0.25, 0.15, 0.2], cells=[4, 2, 2] if DEGREE[element] == 1 else [2, 1, 1],
                      place={"rotate": {"axis": [0.0, 0.0, 1.0], "angle": angle}, "shift": [-0.05, 0.0, gap]}, velocity=[0.0, 0.0, -v])  # fmt: skip
        lower = block("table", element, [-0.6, -0.4, -0.2], [0.0, 0.4, 0.0], cells=[4, 6, 1] if DEGREE[element] == 1 else [2, 3, 1])
        parts = [upper, lower]
        yield Setup(
            f"a block is dropped flat onto the edge of a table, turned by {angle} degrees, sides {way}", parts, scheme, gap / v + 0.05,
            contacts=[between(way, upper, lower)], supports=[hold("table.bottom", dimension=3)], claims=[TOUCHES, FLIGHT, newton(upper, 3)],
        )  # fmt: skip


def space_slides():
    """A block slides without friction over the straight edge of a table, at every angle."""
    for i in range(32):
        element = SPACE[(i + i // 4) % 4] if i % 2 else ["Tet4", "Hex8"][i // 2 % 2]
        scheme = ["chung-hulbert", "bathe", "energy-momentum", "backward-euler", "moreau-jean"][(i + i // 5) % 5]
        angle = 90.0 * i / 31
        way = ["skin", "skin-swapped", "all"][i // 3 % 3]
        v, g, ahead = 0.5, 1.0, 0.08
        upper = block("block", element, [-0.25, -0.15, 0.0], [0.25, 0.15, 0.2], cells=[4, 3, 2] if DEGREE[element] == 1 else [2, 1, 1],
                      place={"rotate": {"axis": [0.0, 0.0, 1.0], "angle": angle}, "shift": [-ahead, 0.0, 0.0]},
                      velocity=[v, 0.0, 0.0], gravity=[0.0, 0.0, -g])  # fmt: skip
        lower = block("table", element, [-0.6, -0.4, -0.2], [0.0, 0.4, 0.0], cells=[6, 8, 1] if DEGREE[element] == 1 else [3, 4, 1])
        until = ahead / v
        claims = [TOUCHES, {"judge": "steady", "body": "block", "axis": "x", "value": v, "limit": 1.25e-3 * v, "until": until}]
        claims.append({"judge": "steady", "body": "block", "axis": "y", "value": 0.0, "limit": 1.25e-3 * v, "until": until})
        yield Setup(
            f"a block turned by {angle:.1f} degrees slides over the edge of a table, sides {way}", [upper, lower], scheme, until + 0.08, step=2e-3,
            contacts=[between(way, upper, lower)], supports=[hold("table.bottom", dimension=3)], claims=claims,
        )  # fmt: skip


def space_rough_slides():
    """A block slides with friction on a rigid plane, or askew on a table."""
    for i in range(10):
        element = SPACE[i % 4]
        scheme = ["chung-hulbert", "bathe", "backward-euler", "moreau-jean", "hu"][i % 5]
        rigid, mu, g, v = i % 2 == 0, [0.1, 0.3][i // 2 % 2], 1.0, 0.2
        angle = [0.0, 45.0, 30.0][i % 3]
        cells = [3, 2, 2] if DEGREE[element] == 1 else [2, 1, 1]
        upper = block("block", element, [-0.25, -0.15, 0.0], [0.25, 0.15, 0.2], cells=cells, place={"rotate": {"axis": [0.0, 0.0, 1.0], "angle": angle}, "shift": [0.0, 0.0, 0.0]},
                      velocity=[v, 0.0, 0.0], gravity=[0.0, 0.0, -g])  # fmt: skip
        lower = block("table", element, [-0.5, -0.4, -0.2], [0.5, 0.4, 0.0], cells=[6, 5, 1] if DEGREE[element] == 1 else [3, 2, 1])
        end = min(0.2, 0.8 * v / (mu * g))
        contacts = floor(upper, dimension=3, mu=mu) if rigid else [between("skin", upper, lower, mu=mu)]
        claims = [TOUCHES, {"judge": "slows", "body": "block", "axis": "x", "value": v, "rate": mu * g, "limit": 0.04 * v, "until": end}]
        claims.append({"judge": "coulomb", "mu": mu, "limit": 1e-6 if rigid else 0.03})
        yield Setup(
            f"a block turned by {angle} degrees slides with friction {mu} on {'a rigid plane' if rigid else 'a table'}", [upper] if rigid else [upper, lower], scheme, end, step=2e-3,
            contacts=contacts, supports=[] if rigid else [hold("table.bottom", dimension=3)], claims=claims,
        )  # fmt: skip


def space_corners():
    """A cube falls on its corner or edge, on a rigid plane or a flat, on a node of it; edges cross on the axis."""
    for i in range(20):
        element = SPACE[(i + i // 4) % 4]
        scheme = MAIN[(i + i // 6) % 6]
        what = ["corner on a rigid plane", "edge on a flat", "corner on a flat", "edge across an edge"][i % 4]
        v, gap = 0.5, 0.005
        a, n = 0.4, 3 if DEGREE[element] == 1 else 2
        corner = what.startswith("corner")
        turn = {"axis": [1.0, -1.0, 0.0], "angle": 54.735610317245346} if corner else {"axis": [1.0, 0.0, 0.0], "angle": 45.0}
        tall = a * sqrt(3) / 2 if corner else a / sqrt(2)
        cube = block("cube", element, [-a / 2] * 3, [a / 2] * 3, cells=[n, n, n], place={"rotate": turn, "shift": [0.0, 0.0, tall + gap]}, velocity=[0.0, 0.0, -v])
        if what.endswith("edge"):
            lower = block("base", element, [-a / 2] * 3, [a / 2] * 3, cells=[n, n, n], place={"rotate": {"axis": [0.0, 1.0, 0.0], "angle": 45.0}, "shift": [0.0, 0.0, -a / sqrt(2)]})
        else:
            lower = block("base", element, [-0.4, -0.4, -0.2], [0.4, 0.4, 0.0], cells=[4, 4, 1] if DEGREE[element] == 1 else [2, 2, 1])
        rigid = what.endswith("plane")
        parts = [cube] if rigid else [cube, lower]
        way = ["skin", "skin-swapped", "all"][i // 4 % 3]
        contacts = floor(cube, dimension=3) if rigid else [between(way, cube, lower)]
        claims = [TOUCHES, FLIGHT, newton(cube, 3)]
        if rigid:
            claims += still("cube", parts, "xy", tol=1e-9)
        elif not corner and symmetric(*parts):
            # A cube on its edge is symmetric about both vertical planes, if its cells are.
            claims += still("cube", parts, "xy")
        supports = [] if rigid else [hold("base.bottom", dimension=3)]
        yield Setup(f"a cube falls with its {what}, sides {way}", parts, scheme, gap / v + 0.06, contacts=contacts, supports=supports, claims=claims)


def quarters():
    """Quarter models in space: the quarter of the whole."""
    for i in range(12):
        element = ["Hex8", "Hex27"][i % 2]
        scheme = MAIN[i % 6]
        shape = ["box", "ball"][i // 2 % 2]
        v, gap = 0.5, 0.005

        def model(cut):
            symmetry = {"symmetry": ["x", "y"]} if cut else {}
            n = 2 if DEGREE[element] == 1 else 1
            if shape == "box":
                mesh = {"shape": "box", "min": [-0.25, -0.25, gap], "max": [0.25, 0.25, 0.25 + gap], "cells": [2 * n, 2 * n, n], **symmetry}
                if cut:  # the cells along a cut axis are those of the half
                    mesh["cells"] = [n, n, n]
            else:
                mesh = {"shape": "ball", "radius": 0.25, "center": [0.0, 0.0, 0.25 + gap], "size": 0.1 * DEGREE[element], **symmetry}
            upper = Part("body", element, mesh, 0.06, 0.06 / (4 if cut else 1), velocity=[0.0, 0.0, -v])
            supports = [hold("body.plane_x", fix="x", dimension=3), hold("body.plane_y", fix="y", dimension=3)] if cut else []
            return Setup(
                f"{'a quarter of ' if cut else ''}a {shape} is dropped on a rigid plane", [upper], scheme, gap / v + 0.05, contacts=floor(upper, dimension=3),
                supports=supports, claims=[TOUCHES], tolerance=1e-11,
            )  # fmt: skip

        part, whole = model(True), model(False)
        part.twin = whole
        part.claims.append({"judge": "agree", "columns": {"body.velocity_z": 1.0, "contact_impulse_z": 0.25, "strain": 0.25}, "limit": 1e-6})
        yield part


def eighths():
    """An eighth of a ball or a box is pressed onto a rigid plane in load steps: a quarter of the force of
    the half that is cut across the pressing direction alone."""
    for i in range(8):
        element = ["Hex8", "Hex27", "Tet4", "Tet10"][i % 4]
        R, depth, n = 0.25, 0.01, 4 // DEGREE[element]
        plane = {"plane": {"point": [0.0, 0.0, R], "normal": [0.0, 0.0, -1.0]}}

        def model(symmetry):
            mesh = {"shape": "ball", "radius": R, "center": [0.0, 0.0, 0.0], "size": 0.13 * DEGREE[element], "symmetry": symmetry}
            if i >= 4:
                cells = [max(1, n // 2) if a in symmetry else n for a in AXES]
                mesh = {"shape": "box", "min": [-R] * 3, "max": [R] * 3, "cells": cells, "symmetry": symmetry}
            part = Part("body", element, mesh, 0.06, 0.1, law="saint-venant-kirchhoff")
            supports = [{"on": ["body.plane_z"], "fix": ["x", "y"], "move": {"z": f"{depth}*t"}}]
            supports += [hold(f"body.plane_{a}", fix=a, dimension=3) for a in "xy" if a in symmetry]
            what = f"{'an eighth' if len(symmetry) == 3 else 'a half'} of a {mesh['shape']} is pressed"
            return Setup(what, [part], "static", 1.0, contacts=[{"secondary": "body.skin", "primary": plane}], supports=supports, claims=[TOUCHES])

        part = model(["x", "y", "z"])
        part.twin = model(["z"])
        # Tetrahedra are not mirror images about the planes.
        part.claims.append({"judge": "agree", "columns": {"contact_force_z": 0.25}, "limit": 1e-6 if element[0] == "H" else 0.05})
        yield part


def space_stacks():
    """Cuboids rest on each other in load steps."""
    for i in range(12):
        element = SPACE[i % 4]
        widths = [(0.5, 0.5), (0.75, 0.375), (0.375, 0.75)][i // 4]
        mu, g = (0.3 if i % 2 else None), 1.0
        way = ["named", "named-swapped", "skin"][i % 3]
        n = 4 if DEGREE[element] == 1 else 2
        law = {"mu": mu} if mu else {}
        lower = block("b1", element, [-widths[0] / 2] * 2 + [0.0], [widths[0] / 2] * 2 + [0.25], cells=[n, n, 1], gravity=[0.0, 0.0, -g])
        upper = block("b2", element, [-widths[1] / 2] * 2 + [0.25], [widths[1] / 2] * 2 + [0.5], cells=[n if i < 8 else n + 1, n, 1], gravity=[0.0, 0.0, -g])
        contacts = [*floor(lower, dimension=3, side="bottom", **law), between(way, upper, lower, **law)]
        claims = [TOUCHES]
        for name, weight in (("c1", (lower.mass + upper.mass) * g), ("c2", upper.mass * g)):
            claims.append({"judge": "last", "column": f"{name}.force_z", "value": weight, "limit": 1e-8 * weight, "sign": False})
        supports = [] if mu else [hold("b1.left", "b2.left", fix="x", dimension=3), hold("b1.front", "b2.front", fix="y", dimension=3)]
        yield Setup(
            f"cuboids {widths} wide on each other, {f'friction {mu}' if mu else 'held sideways'}, sides {way}", [lower, upper], "static", 1.0,
            contacts=contacts, supports=supports, claims=claims,
        )  # fmt: skip


def space_bars():
    """Bars of space, end on end."""
    for i in range(10):
        element = SPACE[i % 4]
        scheme = MAIN[(i + 1) % 6]
        way = ["named", "skin", "all"][i % 3]
        v, gap = 0.2, [0.002, 0.0][i % 5 == 4]
        n = [4, 2, 2] if DEGREE[element] == 1 else [3, 1, 1]
        a = block("a", element, [-0.5, -0.125, -0.125], [0.0, 0.125, 0.125], cells=n, velocity=[v, 0.0, 0.0], poisson=0.0)
        b = block("b", element, [gap, -0.125, -0.125], [gap + 0.5, 0.125, 0.125], cells=n, poisson=0.0)
        contact = {"named": {"secondary": "a.right", "primary": "b.left"}, "skin": {"secondary": "a.skin", "primary": "b.skin"}, "all": {"between": "all"}}[way]
        claims = [TOUCHES, *({"judge": "conserved", "axis": c, "limit": 1e-8} for c in "xyz")]
        claims += still("b", [a, b], "yz", v, flush=True)
        claims.append({"judge": "rebound-pair", "a": "a", "b": "b", "axis": "x", "before": v, "low": 0.7})
        yield Setup(
            f"bars end on end, {'touching, ' if not gap else ''}sides {way}", [a, b], scheme, gap / v + 1.1 / sqrt(1000.0) + 0.03, contacts=[contact], claims=claims,
        )  # fmt: skip


def space_press_fits():
    """A quarter of two tubes with an interference, in plane strain: Lamé's solution."""
    for i in range(6):
        element = ["Hex27", "Hex8", "Tet10"][i % 3]
        r, a, b, E, nu = 0.25, 0.5, 1.0, 1000.0, 0.3
        delta = 1e-3 * a
        size = 0.125
        cut = {"symmetry": ["x", "y"]}
        tall = 0.125
        common = {"law": "saint-venant-kirchhoff"}
        shaft = Part("shaft", element, {"shape": "tube", "inner": r, "outer": a + delta, "height": tall, "center": [0.0, 0.0, 0.0], "size": size, **cut}, 0.1, 0.1, **common)
        hub = Part("hub", element, {"shape": "tube", "inner": a, "outer": b, "height": tall, "center": [0.0, 0.0, 0.0], "size": size * [1.0, 1.2][i // 3], **cut}, 0.1, 0.1, **common)
        p = E / (1 - nu**2) * delta / (2 * a**3) * (a**2 - r**2) * (b**2 - a**2) / (b**2 - r**2)
        hoop = 2 * p * a**2 / (b**2 - a**2)
        pair = ("hub.inner", "shaft.outer") if i % 2 else ("shaft.outer", "hub.inner")
        supports = [hold("shaft.plane_x", "hub.plane_x", fix="x", dimension=3), hold("shaft.plane_y", "hub.plane_y", fix="y", dimension=3)]
        supports.append(hold("shaft.bottom", "hub.bottom", "shaft.top", "hub.top", fix="z", dimension=3))
        limit = 0.1 if element == "Hex8" else 0.03 + (arc(a, size) + arc(a, 1.2 * size)) / delta
        yield Setup(
            f"a quarter of two tubes with an interference, pressure {p:.4g}", [shaft, hub], "static", 1.0, contacts=[{"secondary": pair[0], "primary": pair[1], "overlap": "relax"}],
            supports=supports, probes=[{"name": "rim", "body": "hub", "at": [b, 0.0, tall / 2], "record": ["sigma_yy"]}], field=element != "Hex8",
            claims=[TOUCHES, {"judge": "last", "column": "rim.sigma_yy", "value": hoop, "limit": limit * hoop}], may_refuse="chord|straight|curved" if element == "Hex8" else None,
        )  # fmt: skip


# Invariances


def bases():
    """Set-ups of which the images are compared, as functions of the scheme; turning about no axis of symmetry."""

    def drop(scheme, element="Q4"):
        upper = block("block", element, [-0.5, 0.01], [0.5, 0.26], velocity=[0.0, -0.5])
        lower = block("pedestal", element, [-0.25, -0.25], [0.25, 0.0])
        return Setup("a block on a pedestal", [upper, lower], scheme, 0.09, contacts=[between("skin", upper, lower)], supports=[hold("pedestal.bottom")])

    def slide(scheme, element="Q4"):
        upper = block("block", element, [-0.4, 0.0], [0.1, 0.25], velocity=[0.5, 0.0], gravity=[0.0, -1.0])
        lower = block("table", element, [-1.0, -0.25], [0.0, 0.0])
        return Setup("a block slides over an edge", [upper, lower], scheme, 0.3, contacts=[between("skin", upper, lower)], supports=[hold("table.bottom")])

    def corner(scheme, element="Q4"):
        square = block("block", element, [-0.25, -0.25], [0.25, 0.25], place={"rotate": 45.0, "shift": [0.0, 0.25 * sqrt(2) + 0.01]}, velocity=[0.1, -0.5])
        lower = block("table", element, [-0.75, -0.5], [0.75, 0.0])
        return Setup("a square on its corner", [square, lower], scheme, 0.08, contacts=[between("skin", square, lower)], supports=[hold("table.bottom")])

    def strips(scheme, element="Q9"):
        a = block("block", element, [-0.5, -0.125], [0.0, 0.125], per=16, velocity=[0.2, 0.0])
        b = block("other", element, [0.002, -0.125], [0.502, 0.125], per=16)
        return Setup("strips end on end", [a, b], scheme, 0.06, contacts=[between("skin", a, b)])

    def cuboid(scheme, element="Hex8"):
        upper = block("block", element, [-0.25, -0.25, 0.005], [0.25, 0.25, 0.255], per=8, velocity=[0.0, 0.0, -0.5])
        lower = block("pedestal", element, [-0.125, -0.125, -0.25], [0.125, 0.125, 0.0], per=8)
        return Setup("a cuboid on a pedestal", [upper, lower], scheme, 0.05, contacts=[between("skin", upper, lower)], supports=[hold("pedestal.bottom", dimension=3)])

    def across(scheme, element="Hex8"):
        base = {"element": element, "low": [-0.2] * 3, "high": [0.2] * 3, "cells": [3, 3, 3]}
        upper = block("block", **base, place={"rotate": {"axis": [1.0, 0.0, 0.0], "angle": 45.0}, "shift": [0.0, 0.0, 0.4 / sqrt(2) + 0.005]}, velocity=[0.0, 0.0, -0.5])
        lower = block("base", **base, place={"rotate": {"axis": [0.0, 1.0, 0.0], "angle": 45.0}, "shift": [0.0, 0.0, -0.4 / sqrt(2)]})
        return Setup("edge across an edge", [upper, lower], scheme, 0.05, contacts=[between("skin", upper, lower)], supports=[hold("base.bottom", dimension=3)])

    return [drop, slide, corner, strips, cuboid, across]


def rotation(angle):
    c, s = cos(radians(angle)), sin(radians(angle))
    return lambda x: [c * x[0] - s * x[1], s * x[0] + c * x[1], *x[2:]]


def turned(setup, angle):
    """The same, turned about the z axis: placed, and with turned vectors. All supports hold all directions."""
    turn = rotation(angle)
    for p in setup.parts:
        place = p.keys.get("place", {"shift": [0.0] * setup.dimension})
        if setup.dimension == 2:
            rotate = place.get("rotate", 0.0) + angle
        else:
            inner = place.get("rotate", {"axis": [0.0, 0.0, 1.0], "angle": 0.0})
            columns = ladder_solids.product(ladder_solids.rotation((0, 0, 1), angle), ladder_solids.rotation(inner["axis"], inner["angle"]))
            axis, size = ladder_solids.axis_and_angle(columns)
            rotate = {"axis": list(axis), "angle": size}
        p.keys["place"] = {"rotate": rotate, "shift": turn(place["shift"])}
        for key in ("velocity", "gravity"):
            if key in p.keys:
                p.keys[key] = turn(p.keys[key])
    return setup


def images():
    """Images of a set-up under transformations that do not change the mechanical problem: each must have
    the history of the original."""
    kinds = ["turned by 90", "turned by 37", "mirrored", "far", "order", "units", "small units", "moving"]
    for i in range(56):
        number = i % 7 if i % 7 < 6 else 0
        make, kind = bases()[number], kinds[i // 7]
        scheme = MAIN[(i + i // 7) % 6]
        element = ["Q4", "Q9", "T6"][i % 3] if number < 4 else ["Hex8", "Tet4"][i % 2]
        if kind == "mirrored":
            element = ["Q4", "Q9"][i % 2] if number < 4 else "Hex8"
        if kind == "moving":  # free bodies only
            make, element, number = bases()[3], ["Q4", "Q9", "T6"][i % 3], 3
        original, image = make(scheme, element), make(scheme, element)
        d = image.dimension
        same = {f"block.velocity_{a}": 1.0 for a in AXES[:d]} | {"kinetic": 1.0, "strain": 1.0}
        claim = {"judge": "agree", "columns": same, "limit": 1e-6}
        if kind.startswith("turned"):
            angle = float(kind.split()[-1])
            turned(image, angle)
            claim["turn"] = angle
        elif kind == "mirrored":
            for p in image.parts:
                low, high = p.mesh["min"], p.mesh["max"]
                low[0], high[0] = -high[0], -low[0]
                for key in ("velocity", "gravity"):
                    if key in p.keys:
                        p.keys[key][0] *= -1
                place = p.keys.get("place")
                if place:
                    place["shift"][0] *= -1
                    if d == 2:
                        place["rotate"] *= -1
                    elif place["rotate"]["axis"][0] == 0.0:
                        place["rotate"]["angle"] *= -1
            same["block.velocity_x"] = -1.0
            for c in image.supports:
                c["on"] = [s.replace("left", "RIGHT").replace("right", "left").replace("RIGHT", "right") for s in c["on"]]
        elif kind == "far":
            for p in image.parts:
                place = p.keys.setdefault("place", {"shift": [0.0] * d})
                place["shift"] = [x + y for x, y in zip(place["shift"], [128.0, -64.0, 32.0])]
        elif kind == "order":
            image.parts.reverse()
        elif kind.endswith("units"):
            length, mass, time = (1e3, 1e6, 1e3) if kind == "units" else (1e-6, 1e-6, 1e-3)
            scale(image, length, mass, time)
            for key in same:
                same[key] *= length / time if "velocity" in key else mass * (length / time) ** 2
        elif kind == "moving":
            for p in image.parts:
                p.keys["velocity"] = [x + y for x, y in zip(p.keys.get("velocity", [0.0] * d), [3.0, 1.0])]
            claim["offset"] = {"block.velocity_x": 3.0, "block.velocity_y": 1.0}
            del same["kinetic"]
        for s in (original, image):
            s.tolerance = 1e-11
            s.claims = [TOUCHES]
        image.what += f", {kind}"
        image.claims.append(claim)
        image.twin = original
        yield image


def scale(setup, length, mass, time):
    """In other units: numbers of lengths, masses and times are multiplied by these factors."""
    times = lambda x, f: [times(y, f) for y in x] if isinstance(x, list) else x * f
    step, n = setup.times()
    for p in setup.parts:
        for key in ("min", "max", "radius", "center", "size"):
            if key in p.mesh:
                p.mesh[key] = times(p.mesh[key], length)
        if "place" in p.keys:
            p.keys["place"]["shift"] = times(p.keys["place"]["shift"], length)
        for key, power in (("velocity", 1), ("gravity", 2)):
            if key in p.keys:
                p.keys[key] = times(p.keys[key], length / time**power)
        d = setup.dimension
        # In the plane the thickness is 1 in both units, so that its mass is one per length.
        volume = length**d
        p.density *= mass / volume
        p.young *= mass / (length ** (d - 2) * time**2)
        p.h *= length
    setup.step, setup.end = step * time, n * step * time
    return setup


FAMILIES = {
    "pedestal": pedestals, "piers": piers, "table-edge": table_edges, "half-disc": halves, "half-block": halves_of_blocks, "corner": corners, "slide": slides,
    "rough-slide": rough_slides, "bars-1d": bars_in_line, "bars": bars, "stack": stacks, "wheel": wheels, "press-fit": press_fits,
    "press-flat": lambda: press_flat(PLANE, 2), "patch": lambda: patches(PLANE, 2), "comb": combs, "rigid-corner": rigid_corners, "flight": flights, "rings": relaxed_rings,
    "schemes": schemes, "pad-3d": pads, "pedestal-3d": space_pedestals, "table-edge-3d": space_edges, "slide-3d": space_slides, "rough-slide-3d": space_rough_slides,
    "corner-3d": space_corners, "quarter-3d": quarters, "eighth-3d": eighths, "stack-3d": space_stacks, "bars-3d": space_bars, "press-fit-3d": space_press_fits,
    "press-flat-3d": lambda: press_flat(SPACE, 3), "patch-3d": lambda: patches(SPACE, 3), "image": images,
}  # fmt: skip


def all_cases():
    """All set-ups in the order of their numbers."""
    cases = []
    for name, family in FAMILIES.items():
        for setup in family():
            cases.append(setup)
            for s in (setup, setup.twin):
                if s:
                    s.family, s.number = name, len(cases)
    return deepcopy(cases)


def chosen(count):
    """`count` set-ups, or all, from every family in proportion and at equal distances, at least one of each;
    in an order of which every beginning is such a choice, too."""
    cases = all_cases()
    result, golden = [], (sqrt(5) - 1) / 2
    for name in FAMILIES:
        mine = [c for c in cases if c.family == name]
        n = len(mine) if count is None else min(len(mine), max(1, round(count * len(mine) / len(cases))))
        # Every beginning of a golden sequence is spread out.
        fractions = [j * golden % 1 for j in range(len(mine))]
        ranks = [sorted(fractions).index(f) for f in fractions]
        result += [((j + 0.5) / len(mine), mine[k]) for j, k in enumerate(ranks[:n])]
    return [setup for _, setup in sorted(result, key=lambda pair: pair[0])]
