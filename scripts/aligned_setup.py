"""Set-ups of the aligned ladder (aligned_cases.py): bodies with meshes of their own, contacts, supports and
claims, and the case file as TOML.

A claim is a dictionary {"judge": NAME, …}; aligned_judge.py explains the names. Claims come from symmetry,
balance and closed solutions alone.

Units: lengths of order 1, density 1, E = 1000, ν = 0.3: pressure waves travel at 37, a drop at 0.5 is
1.4 % of it. There are twelve intervals between nodes in a unit of length where nothing else is said.
"""

from math import pi, sqrt

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
