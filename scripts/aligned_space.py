"""Families of aligned cases in space, for aligned_cases.py, as those in aligned_plane.py."""

from math import sqrt

from aligned_plane import arc
from aligned_setup import AXES, DEGREE, FLIGHT, MAIN, SPACE, TOUCHES, WAYS, Part, Setup, between, block, bounce, floor, hold, newton, still, symmetric


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
        claims.append({"judge": "coulomb", "mu": mu, "limit": 1e-3 if rigid else 0.03})
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
        elif what == "edge on a flat" and symmetric(*parts):
            # A cube on its edge is symmetric about both vertical planes, if its cells are. On
            # another edge its equilibrium is unstable: round-off of 1e-12 grows to 6e-3 while they
            # touch.
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
            mesh = {"shape": "ball", "radius": R, "center": [0.0, 0.0, 0.0], "size": 0.12 * DEGREE[element], "symmetry": symmetry}
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
