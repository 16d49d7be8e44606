"""Families of aligned cases in the plane and of dimension 1, for aligned_cases.py. Every function yields
set-ups; parameters go through their values in turn, with coprime periods.
"""

from math import pi, radians, sin, sqrt

from aligned_setup import (
    ALL, AXES, DEGREE, EXPLICIT, FLIGHT, IMPULSE, MAIN, PLANE, TOUCHES, WAYS, Part, Setup, between, block, bounce,
    disc, floor, hold, newton, polygon, still, symmetric,
)


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
        # The table's top is tilted by the block that overhangs: with cells and steps a quarter as
        # long, the velocity rises by 1.3e-3 of itself in the longest of these slides.
        claims = [TOUCHES, {"judge": "steady", "body": "block", "axis": "x", "value": v, "limit": 2e-3 * v, "until": (ahead + phase) / v}]
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
        # Damped schemes, and steps longer than a cell, lose what wave fronts contain of the energy.
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
            f"a disc slides along a flat to a step {rise} high", [wheel, road], scheme, 0.4 if rise else 0.25,
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
        claims = [TOUCHES, {"judge": "corner", "body": "block", "at": [x, 0.0], "move": [0.0, -depth], "limit": 0.1 / [6, 4][i % 2]}]
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
