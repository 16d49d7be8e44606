"""Seeded hard contact cases in space for ladder.py: `case(seed, k)` is the text of case k.

A category draws shapes, meshes, places, stiffnesses, speeds and roles; a scheme family draws the
integrator and the enforcement. Bodies are boxes, balls, cylinders and tubes of Tet4, Tet10, Hex8 or
Hex27, turned about random axes. They do not overlap at the start, and the motion brings them
together. Sides are whole boundaries (`body.skin`), or contact is `between = "all"` without contact
of a body with itself. Units: lengths of order 1, density of order 1, the softest body has E = 100,
so that its waves travel at about 12.

Time. The step is C h/c for the softest body, Courant number C = 0.2 … 4, 30 to 250 steps; explicit
schemes: by the smallest cell of the fastest body, at most 2500 steps. In the category `bullet` the
step is given by the diameters moved in it. Fields are written every 1/40 of the run. A body has at
most about 700 nodes, so that a case takes seconds.
"""

import random
from math import ceil, cos, pi, radians, sin, sqrt

from ladder_cases import EXPLICIT, IMPULSE, between, num, scheme, vec
from ladder_solids import DEGREE, DOWN, Draw, add, direction, dot

FAMILIES = "trapezoidal chung-hulbert tr-bdf2 bathe energy-mom central-diff paoli moreau-jean ns-alpha static".split()

class Draft:
    """A case before its scheme is chosen. `pairs`: (secondary, primary) sides; none: between all."""

    def __init__(self, hard, bodies, pairs, end, supports=(), planes=(), **more):
        self.hard, self.bodies, self.pairs, self.end, self.supports = hard, bodies, pairs, end, list(supports)
        self.planes, self.step, self.moved = list(planes), more.get("step"), more.get("moved", False)
        self.rough, self.gravity = more.get("rough", 0.4), more.get("gravity")


HOLD = '[[support]]\non = ["{}"]\nfix = ["x", "y", "z"]\n'


def plane(point, normal):
    return f"{{ plane = {{ point = {vec(point)}, normal = {vec(normal)} }} }}"


FLOOR = plane((0, 0, 0), (0, 0, 1))


def skins(r, one, other, share=0.5):
    """Contact of two bodies, either way round, or between all."""
    if r.random() < 0.3:
        return []
    pair = (f"{one.name}.skin", f"{other.name}.skin")
    return [pair if r.random() < share else pair[::-1]]


def table(draw, r, name="table", size=(2.0, 2.0, 0.5), intervals=None, **more):
    """A box with its top at height 0."""
    return draw.box(name, size, intervals or r.randint(6, 10), **more).at((0, 0, -size[2] / 2))


def thrown(r, v, tangential=0.5, spin=0.3):
    """Velocity down and aside, and a spin or none."""
    a, w = r.uniform(0, 2 * pi), r.uniform(0, tangential) * v
    angular = tuple(r.uniform(-2, 2) * v for _ in range(3)) if r.random() < spin else None
    return (w * cos(a), w * sin(a), -v), angular


def corner_landing(r, draw):
    v, gap = between(r, 0.5, 4), r.uniform(0.005, 0.04)
    t = table(draw, r)
    b = draw.box("box", [r.uniform(0.4, 0.9) for _ in range(3)], r.randint(2, 5), young=100 * between(r, 1, 100))
    b.turned(direction(r), r.uniform(15, 180)).resting(r.uniform(-0.3, 0.3), r.uniform(-0.3, 0.3), gap).moving(*thrown(r, v))
    return Draft("a box lands on its corner", [b, t], skins(r, b, t), gap / v + 0.8 / sqrt(v), [HOLD.format("table.bottom")])


def edge_landing(r, draw):
    v, gap, tilt = between(r, 0.5, 3), r.uniform(0.005, 0.03), r.choice([0.0, r.uniform(0, 5)])
    t = table(draw, r)
    b = draw.box("box", [r.uniform(0.4, 0.9) for _ in range(3)], r.randint(2, 5), young=100 * between(r, 1, 100))
    b.turned((1, 0, 0), 45 + r.uniform(-30, 30)).turned((0, 1, 0), tilt).turned((0, 0, 1), r.uniform(0, 180))
    b.resting(r.uniform(-0.2, 0.2), r.uniform(-0.2, 0.2), gap).moving(*thrown(r, v))
    return Draft(f"a box lands on its edge, {tilt:.1f} degrees from it", [b, t], skins(r, b, t), gap / v + 0.8 / sqrt(v), [HOLD.format("table.bottom")])


def corner_corner(r, draw):
    v, gap = between(r, 0.3, 3), 0.01
    off = (r.uniform(-0.06, 0.06), r.uniform(-0.06, 0.06))
    t = draw.box("block", (1.0, 1.0, 1.0), r.randint(3, 6)).at((-0.5, -0.5, -0.5))
    b = draw.box("box", [r.uniform(0.5, 0.9) for _ in range(3)], r.randint(2, 5), young=100 * between(r, 1, 50))
    b.turned((1, -1, 0), 54.7 + r.uniform(-20, 20)).turned((0, 0, 1), r.uniform(0, 120))
    b.resting(0, 0, gap)
    # The lowest corner stands off the corner of the block by `off`.
    half = [abs(b.extent([float(i == j) for j in range(3)])) for i in range(3)]
    signs = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    corners = [tuple(sum(b.turn[i][j] * s[i] * half[i] for i in range(3)) for j in range(3)) for s in signs]
    corner = min(corners, key=lambda x: x[2])
    b.at((off[0] - corner[0], off[1] - corner[1], gap - corner[2])).moving(*thrown(r, v))
    return Draft(f"corner on corner, ({off[0]:+.3f}, {off[1]:+.3f}) beside it", [b, t], skins(r, b, t), min(0.9, 0.4 / v + 0.3), [HOLD.format("block.bottom")])


def edge_edge(r, draw):
    v, gap, cross = between(r, 0.3, 3), r.uniform(0.005, 0.02), 90 + r.uniform(-60, 60)
    t = draw.box("roof", (0.6, 1.2, 0.6), r.randint(4, 8)).turned((0, 1, 0), 45 + r.uniform(-15, 15))
    t.resting(0, 0, 0)
    top = t.center[2] + t.reach((0, 0, 1))
    if r.random() < 0.7:
        b = draw.box("box", (r.uniform(0.6, 1.2), 0.5, 0.5), r.randint(2, 6), young=100 * between(r, 1, 50))
        b.turned((1, 0, 0), 45 + r.uniform(-15, 15))
        what = "box"
    else:
        b = draw.cylinder("rod", 0.25, r.uniform(0.6, 1.0), r.choice([1, 2]), young=100 * between(r, 1, 50)).turned((0, 1, 0), 90)
        what = "rod"
    b.turned((0, 0, 1), cross - 90).resting(r.uniform(-0.1, 0.1), r.uniform(-0.3, 0.3), top + gap).moving(*thrown(r, v))
    return Draft(f"the edge of a {what} across an edge, at {cross:.0f} degrees", [b, t], skins(r, b, t), min(0.9, 0.4 / v + 0.3), [HOLD.format("roof.bottom")])


def ball_edge(r, draw):
    v, R, gap = between(r, 0.5, 4), r.uniform(0.25, 0.5), 0.01
    b = draw.ball("ball", R, r.choice([1, 2, 2, 3]), young=100 * between(r, 1, 50))
    b.turned(direction(r), r.uniform(0, 180))
    t = draw.box("block", (1.2, 1.2, 0.8), r.randint(3, 7)).at((-0.6, 0, -0.4))
    at_corner = r.random() < 0.4
    low = radians(r.uniform(5, 85))  # of the centre, seen from the edge
    aside = radians(r.uniform(-40, 40))
    out = (cos(low) * cos(aside), cos(low) * sin(aside), sin(low)) if at_corner else (cos(low), 0.0, sin(low))
    edge = (0.0, 0.6 if at_corner else r.uniform(-0.4, 0.4), 0.0)
    if at_corner:
        out = (out[0], abs(out[1]) + 0.05, out[2])
        length = sqrt(dot(out, out))
        out = tuple(x / length for x in out)
    b.at(add(edge, out, R + gap))
    velocity = tuple(-v * (x + r.uniform(-0.4, 0.4)) for x in out)
    b.moving(velocity, tuple(r.uniform(-2, 2) * v for _ in range(3)) if r.random() < 0.3 else None)
    what = "corner" if at_corner else "edge"
    return Draft(f"a ball meets the {what} of a block", [b, t], skins(r, b, t), min(0.9, 0.5 / v + 0.3), [HOLD.format("block.bottom")])


def balls(r, draw):
    v, n = between(r, 0.5, 3), r.choice([2, 2, 3])
    bodies = []
    for i in range(n):
        R = r.uniform(0.2, 0.5)
        b = draw.ball(f"ball{i + 1}", R, r.choice([1, 2, 2]), young=100 * between(r, 1, 30), density=r.choice([1.0, 1.0, 4.0]))
        b.turned(direction(r), r.uniform(0, 180))
        if bodies:
            before = bodies[-1]
            last = before.reach((1, 0, 0))
            off = (last + R) * r.uniform(0, 0.7)
            a = r.uniform(0, 2 * pi)
            along = sqrt((last + R + 0.01) ** 2 - off**2)
            b.at(add(before.center, (along, off * cos(a), off * sin(a))))
        bodies.append(b)
    spin = lambda: tuple(r.uniform(-3, 3) for _ in range(3)) if r.random() < 0.5 else None
    bodies[0].moving((v, 0, 0), spin())
    for b in bodies[1:]:
        b.moving((-v * r.uniform(0, 0.5), 0, 0), spin())
    return Draft(f"{n} free balls off their centres", bodies, [], min(0.9, 0.5 / v + 0.3))


def cylinders(r, draw):
    v, angle = between(r, 0.5, 3), r.choice([0.0, r.uniform(0, 90), 90.0])
    R, S = r.uniform(0.15, 0.35), r.uniform(0.15, 0.35)
    a = draw.cylinder("lower", R, r.uniform(0.5, 1.2), r.choice([1, 2]), young=100 * between(r, 1, 30)).turned((0, 1, 0), 90)
    b = draw.cylinder("upper", S, r.uniform(0.5, 1.2), r.choice([1, 2]), young=100.0, density=r.choice([1.0, 4.0]))
    rim = r.random() < 0.5
    b.turned((0, 1, 0), r.uniform(20, 80) if rim else 90).turned((0, 0, 1), angle)
    b.resting(r.uniform(-0.2, 0.2), r.uniform(-0.5, 0.5) * R, R + 0.01).moving(*thrown(r, v))
    a.moving((0, 0, r.uniform(0, 0.5) * v))
    how = "with its rim" if rim else f"across, at {angle:.0f} degrees"
    return Draft(f"a cylinder strikes a cylinder {how}", [a, b], skins(r, a, b), min(0.9, 0.5 / v + 0.3))


def thin_plate(r, draw):
    v, t = between(r, 0.5, 3), r.uniform(0.04, 0.1)
    p = draw.box("plate", (1.6, 1.6, t), r.randint(6, 12), young=100 * between(r, 1, 30)).at((0, 0, -t / 2))
    s = draw.lump("stone", r.uniform(0.3, 0.6), young=100 * between(r, 1, 100), density=r.choice([1.0, 4.0]))
    s.resting(r.uniform(-0.5, 0.5), r.uniform(-0.5, 0.5), 0.01).moving(*thrown(r, v))
    hold = r.choice([["left"], ["left", "right"], ["left", "right", "front", "back"], []])
    return Draft(f"a thin plate, held at {len(hold)} sides, is struck", [s, p], skins(r, s, p), min(0.9, 0.6 / v + 0.3), [HOLD.format(f"plate.{x}") for x in hold])


def bullet(r, draw):
    size, share, k = r.uniform(0.02, 0.08), between(r, 0.03, 0.3), between(r, 1, 10)
    young, on_plate = 100 * between(r, 1, 100), r.random() < 0.6
    if on_plate:
        t = r.uniform(0.02, 0.1)
        p = draw.box("plate", (0.8, 0.8, t), r.randint(6, 12), young=young).at((0, 0, -t / 2))
        supports = [HOLD.format(f"plate.{x}") for x in ("left", "right", "front", "back")]
    else:
        p = draw.box("block", (0.8, 0.8, 0.4), r.randint(5, 8), young=young).at((0, 0, -0.2))
        supports = [HOLD.format("block.bottom")]
    v = share * p.speed()
    step = k * 2 * size / v
    start = r.uniform(0.2, 2.5) * v * step + 0.01
    slant = [r.uniform(-0.3, 0.3) for _ in range(2)] if r.random() < 0.5 else [0.0, 0.0]
    keys = {"young": young * between(r, 1, 30), "density": r.choice([1.0, 5.0])}
    if r.random() < 0.6:
        s = draw.ball("shot", size, r.choice([1, 2]), **keys)
    else:
        s = draw.box("shot", (2 * size, 2 * size, 2 * size), 2, **keys)
    s.turned(direction(r), r.uniform(0, 180))
    aim = (r.uniform(-0.2, 0.2), r.uniform(-0.2, 0.2))
    s.resting(aim[0] - slant[0] * start, aim[1] - slant[1] * start, start).moving((slant[0] * v, slant[1] * v, -v))
    n = r.randint(25, 50)
    return Draft(f"a small body moves {k:.1f} diameters a step against a {p.name}", [s, p], skins(r, s, p, 0.6), n * step, supports, step=step)


def tumble(r, draw):
    g, v, slope = between(r, 1, 10), between(r, 0.3, 3), r.choice([0.0, r.uniform(5, 35)])
    kind = r.choice(["box", "box", "cylinder", "ball"])
    young = 100 * between(r, 1, 30)
    if kind == "box":
        b = draw.box("body", [r.uniform(0.3, 0.8) for _ in range(3)], r.randint(2, 5), young=young)
    elif kind == "cylinder":
        b = draw.cylinder("body", r.uniform(0.2, 0.4), r.uniform(0.2, 0.8), r.choice([1, 2]), young=young)
    else:
        b = draw.ball("body", r.uniform(0.25, 0.5), r.choice([1, 2, 3]), young=young)
    b.turned(direction(r), r.uniform(0, 180))
    a = radians(slope)
    normal = (sin(a), 0.0, cos(a))
    b.at(tuple(x * (b.reach(tuple(-x for x in normal)) + 0.01) for x in normal))
    linear, _ = thrown(r, v, 1.0)
    b.moving(linear, tuple(r.uniform(-4, 4) * v for _ in range(3)))
    planes = [plane((0, 0, 0), normal)]
    if r.random() < 0.4:
        wall = b.center[0] + b.reach((1, 0, 0)) + r.uniform(0.02, 0.3)
        planes.append(plane((wall, 0, 0), (-1, 0, 0)))
    return Draft(f"a {kind} tumbles on a plane of {slope:.0f} degrees", [b], [], r.uniform(0.4, 0.8), planes=planes, rough=0.7, gravity=(0, 0, -g))


def bowl(r, draw):
    v, inside = between(r, 0.5, 3), r.random() < 0.6
    b = draw.lump("body", r.uniform(0.3, 0.6), young=100 * between(r, 1, 30))
    R = r.uniform(0.7, 1.5) if inside else r.uniform(0.3, 1.0)
    if inside:
        reach = max(b.reach(direction(random.Random(i))) for i in range(60))
        b.at((0, 0, -(R - 1.1 * reach - 0.02)))
        center = (0, 0, 0)
    else:
        b.at((r.uniform(-0.3, 0.3) * R, r.uniform(-0.3, 0.3) * R, b.reach(DOWN) + 0.01))
        center = (0, 0, -R)
    b.moving(*thrown(r, v, 1.0, 0.5))
    sphere = f"{{ sphere = {{ center = {vec(center)}, radius = {num(R)}{', inside = true' if inside else ''} }} }}"
    where = "in a rigid bowl" if inside else "on a rigid sphere"
    return Draft(f"a body {where}", [b], [], min(1.0, 1.0 / v + 0.2), planes=[sphere], rough=0.6, gravity=(0, 0, -between(r, 1, 5)))


def stack(r, draw):
    bodies, z, v = [], 0.0, between(r, 0.5, 2)
    for i in range(3):
        gap = r.uniform(0.005, 0.04)
        name, young = f"body{i + 1}", 100 * between(r, 1, 50)
        if r.random() < 0.5:
            b = draw.box(name, [r.uniform(0.5, 0.8), r.uniform(0.5, 0.8), r.uniform(0.2, 0.4)], r.randint(2, 4), young=young)
            b.turned((0, 0, 1), r.uniform(0, 90))
        else:
            b = draw.lump(name, r.uniform(0.3, 0.5), young=young)
        b.resting(r.uniform(-0.1, 0.1), r.uniform(-0.1, 0.1), z + gap).moving((0, 0, -v))
        z = b.center[2] + b.reach((0, 0, 1))
        bodies.append(b)
    return Draft("a stack of three bodies falls on a plane", bodies, [], min(0.7, 0.5 / v + 0.2), planes=[FLOOR], gravity=r.choice([None, (0, 0, -between(r, 1, 5))]))


def mesh_ratio(r, draw):
    v, fine = between(r, 0.5, 3), r.random() < 0.5
    t = table(draw, r, "block", (1.6, 1.6, 0.5), r.choice([2, 3]) if fine else r.randint(10, 13), young=100 * between(r, 1, 1000))
    kind = r.choice(["ball", "box", "cylinder"])
    young = 100 * between(r, 1, 1000)
    if kind == "ball":
        b = draw.ball("body", r.uniform(0.3, 0.5), 3 if fine else 1, young=young)
    elif kind == "box":
        b = draw.box("body", [r.uniform(0.4, 0.8) for _ in range(3)], 6 if fine else 1, young=young)
    else:
        b = draw.cylinder("body", r.uniform(0.2, 0.4), r.uniform(0.4, 0.7), 3 if fine else 1, young=young)
    b.turned(direction(r), r.uniform(0, 180)).resting(r.uniform(-0.4, 0.4), r.uniform(-0.4, 0.4), 0.01).moving(*thrown(r, v))
    ratio = max(b.h / t.h, t.h / b.h)
    return Draft(f"meshes whose cells differ by a factor {ratio:.1f}, stiffnesses by {max(t.young / young, young / t.young):.0f}", [b, t], skins(r, b, t), min(0.9, 0.5 / v + 0.3), [HOLD.format("block.bottom")])


def press(r, draw):
    T, kind = r.uniform(0.6, 2), r.choice(["punch", "ball", "edge", "plate"])
    move = lambda d: f'"{num(d)}*(t/{num(T)})^2*(3 - 2*t/{num(T)})"'
    stiff = 100 * between(r, 10, 300)
    slide = f"x = {move(r.uniform(-0.3, 0.3))}, " if r.random() < 0.4 else ""
    if kind == "plate":
        b = draw.ball("block", 0.4, r.choice([1, 2, 2])).turned(direction(r), r.uniform(0, 180)).at((0, 0, 0.405))
        u = draw.box("tool", (1.2, 1.2, 0.3), r.randint(4, 8), young=stiff).at((0, 0, 0.965))
        depth, planes, hold = r.uniform(0.1, 0.35), [FLOOR], []
        slide = ""
        pairs = skins(r, b, u)
    else:
        b = table(draw, r, "block", (1.6, 1.6, 0.8), r.randint(5, 8))
        depth, planes, hold = r.uniform(0.08, 0.3), [], [HOLD.format("block.bottom")]
        if kind == "ball":
            R = r.uniform(0.3, 0.6)
            u = draw.ball("tool", R, r.choice([1, 2, 3]), young=stiff).turned(direction(r), r.uniform(0, 180))
        else:
            u = draw.box("tool", (r.uniform(0.4, 0.8), r.uniform(0.4, 0.8), 0.4), r.randint(2, 5), young=stiff)
            if kind == "edge":
                u.turned((1, 0, 0), r.uniform(5, 40)).turned((0, 0, 1), r.uniform(0, 90))
        u.resting(*((0.8, r.uniform(-0.2, 0.2)) if r.random() < 0.3 and kind == "punch" else (r.uniform(-0.2, 0.2), r.uniform(-0.2, 0.2))), 0.005)
        pairs = skins(r, u, b)
    if kind == "ball":
        # A ball has one side, which would be held as a whole: it is pressed by gravity instead.
        u.keys["gravity"] = vec((0, 0, -between(r, 20, 200) * u.density))
        return Draft("a heavy ball sinks in", [u, b], pairs, T, hold, planes, rough=0.5)
    fix = '["y"]' if slide else '["x", "y"]'
    hold.append(f'[[support]]\non = ["tool.top"]\nfix = {fix}\nmove = {{ {slide}z = {move(-depth - 0.005)} }}\n')
    return Draft(f"pressed from rest by {depth:.2g}: {kind}", [u, b], pairs, T, hold, planes, moved=True, rough=0.5)


def tubes(r, draw):
    v, R = between(r, 0.5, 3), r.uniform(0.3, 0.5)
    wall = between(r, 0.05, 0.15)
    g = draw.tube("tube", R - wall, R, r.uniform(0.3, 0.8), r.randint(4, 6))
    how = r.choice(["on its side", "on its rim", "on a peg", "struck"])
    if how in ("on its side", "on its rim"):
        angle = 90.0 if how == "on its side" else r.uniform(5, 60)
        g.turned((1, 0, 0), angle).turned((0, 0, 1), r.uniform(0, 180)).resting(0, 0, 0.01).moving(*thrown(r, v))
        if r.random() < 0.5:
            return Draft(f"a tube falls {how} on a plane", [g], [], min(0.9, 0.6 / v + 0.3), planes=[FLOOR], rough=0.5)
        t = table(draw, r)
        return Draft(f"a tube falls {how}", [g, t], skins(r, g, t), min(0.9, 0.6 / v + 0.3), [HOLD.format("table.bottom")], rough=0.5)
    if how == "on a peg":
        S = (R - wall) * r.uniform(0.6, 0.85)
        p = draw.cylinder("peg", S, 0.8, r.choice([1, 2]), young=100 * between(r, 1, 30)).at((0, 0, -0.4))
        off = (R - wall - S) * r.uniform(0.2, 0.6)
        g.resting(off, 0, 0.02).turned((0, 1, 0), r.uniform(-4, 4)).moving(*thrown(r, v, 0.2))
        return Draft("a tube falls on a peg, beside its axis", [g, p], skins(r, g, p), min(0.9, 0.6 / v + 0.2), [HOLD.format("peg.bottom")], rough=0.3)
    g.turned((1, 0, 0), 90).resting(0, 0, 0.002)
    s = draw.lump("stone", r.uniform(0.2, 0.4), young=100 * between(r, 1, 50), density=r.choice([1.0, 4.0]))
    s.resting(r.uniform(-0.1, 0.1), r.uniform(-0.1, 0.1), 2 * R + 0.02).moving((0, 0, -v))
    return Draft("a tube on a plane is struck", [g, s], skins(r, g, s), min(0.9, 0.5 / v + 0.3), planes=[FLOOR])


def pile(r, draw):
    v, bodies = between(r, 0.5, 2), []
    n = r.choice([3, 4])
    for i in range(n):
        b = draw.lump(f"body{i + 1}", r.uniform(0.25, 0.45), young=100 * between(r, 1, 20))
        a = 2 * pi * i / n + r.uniform(-0.2, 0.2)
        away = 0.42 / sin(pi / n) * 0.75 + 0.12
        b.at((away * cos(a), away * sin(a), 0.6 + r.uniform(-0.05, 0.05)))
        b.moving((-v * cos(a), -v * sin(a), -r.uniform(0, 1) * v), tuple(r.uniform(-2, 2) for _ in range(3)))
        bodies.append(b)
    planes = [FLOOR] if r.random() < 0.5 else []
    return Draft(f"{n} bodies fly at each other", bodies, [], min(1.0, 0.9 / v + 0.2), planes=planes)


def slide_off(r, draw):
    v, g = between(r, 0.5, 3), between(r, 1, 8)
    t = table(draw, r, size=(1.4, 1.4, 0.4))
    w = r.uniform(0.3, 0.6)
    kind = r.choice(["box", "cylinder", "ball"])
    young = 100 * between(r, 1, 30)
    if kind == "box":
        b = draw.box("body", (w, r.uniform(0.3, 0.6), 0.3), r.randint(2, 5), young=young).turned((0, 0, 1), r.uniform(0, 90))
    elif kind == "cylinder":
        b = draw.cylinder("body", w / 2, 0.3, r.choice([1, 2]), young=young)
    else:
        b = draw.ball("body", w / 2, r.choice([1, 2]), young=young).turned(direction(r), r.uniform(0, 180))
    b.resting(0.7 - w * r.uniform(0.1, 0.6), r.uniform(-0.7, 0.3), 0.002).moving((v, r.uniform(-0.5, 0.5) * v, 0))
    return Draft(f"a {kind} slides off the edge of a table", [b, t], skins(r, b, t), min(0.9, w / v + 0.3), [HOLD.format("table.bottom")], rough=0.6, gravity=(0, 0, -g))


def slanting(r, draw):
    """Within one step it would enter the plate at the top, leave at the bottom, and be past its end."""
    size, share, young = r.uniform(0.02, 0.05), between(r, 0.03, 0.3), 100 * between(r, 1, 100)
    t, angle = r.uniform(0.02, 0.06), radians(r.uniform(20, 45))
    p = draw.box("plate", (1.0, 0.4, t), r.randint(6, 12), young=young).at((0, 0, -t / 2))
    v = share * p.speed()
    along, down = v * cos(angle), v * sin(angle)
    step = r.uniform(0.8, 1.6) / along
    start = r.uniform(0.4, 1.6) * down * step + 0.01
    keys = {"young": young * between(r, 1, 30), "density": r.choice([1.0, 5.0])}
    if r.random() < 0.6:
        s = draw.ball("shot", size, r.choice([1, 2]), **keys)
    else:
        s = draw.box("shot", (2 * size, 2 * size, 2 * size), 2, **keys)
    s.turned(direction(r), r.uniform(0, 180))
    aim = r.uniform(-0.1, 0.35)
    s.resting(aim - along / down * start, r.uniform(-0.1, 0.1), start).moving((along, 0, -down))
    hold = r.choice([["left"], ["left", "right"], ["front", "back"]])
    supports = [HOLD.format(f"plate.{x}") for x in hold]
    what = f"a small body flies through a plate and past its end in a step, at {angle * 180 / pi:.0f} degrees"
    return Draft(what, [s, p], skins(r, s, p, 0.6), 20 * step, supports, step=step)


CATEGORIES = {
    "corner-landing": corner_landing, "edge-landing": edge_landing, "corner-corner": corner_corner, "edge-edge": edge_edge,
    "ball-edge": ball_edge, "balls": balls, "cylinders": cylinders, "thin-plate": thin_plate, "bullet": bullet,
    "tumble": tumble, "bowl": bowl, "stack": stack, "mesh-ratio": mesh_ratio, "press": press, "tube": tubes,
    "pile": pile, "slide-off": slide_off, "slanting": slanting,
}  # fmt: skip
# Categories of the first cases of a seed: those that were added later come after them, so that a
# number keeps its case.
FIRST, FIRST_CASES = 17, 340


def category_of(k):
    """The category of case k ≥ 1."""
    if k <= FIRST_CASES:
        return list(CATEGORIES)[(k - 1) % FIRST]
    return list(CATEGORIES)[(k - FIRST_CASES - 1 + FIRST) % len(CATEGORIES)]


def chosen_scheme(r, family):
    """The scheme as TOML."""
    return 'kind = "static"' if family == "static" else scheme(r, family)


def case(seed, k):
    """(category, family, …; text) of case k ≥ 1."""
    r = random.Random(f"ladder in space {seed} {k}")
    category = category_of(k)
    draft = CATEGORIES[category](r, Draw(r))
    refused = lambda f: draft.moved and f in IMPULSE or draft.step and f in EXPLICIT
    # Free bodies and gravity have no equilibrium: load steps are for tools between supports.
    static = draft.moved and not draft.planes
    allowed = [f for f in FAMILIES if not refused(f) and (f != "static" or static)]
    # The explicit and impulse schemes are half as frequent as the implicit ones; few cases may be
    # static.
    weight = lambda f: 1 if f in IMPULSE else 6 if f == "static" else 2
    family = r.choices(allowed, [weight(f) for f in allowed])[0]
    explicit = family in EXPLICIT
    if explicit:
        for b in draft.bodies:
            b.young = min(b.young, 1000.0)
    soft = min(draft.bodies, key=lambda b: b.speed())
    if draft.step:
        step = draft.step
    elif explicit:
        step = min(0.15 * b.small / (b.speed() * (2 if b.element.startswith("Tet") else 1) * DEGREE[b.element]) for b in draft.bodies)
        draft.end = min(draft.end, 2500 * step)
    else:
        step = between(r, 0.2, 4) * soft.h / soft.speed()
        step = min(max(step, draft.end / 250), draft.end / 30)
    step = float(f"{step:.3g}")
    n = max(20, ceil(draft.end / step - 1e-9))
    if draft.moved:  # the formula ends at `end`
        n = max(20, int(draft.end / step))
    mu = r.choice([0.1, 0.3, 0.6, 1.0]) if r.random() < draft.rough else None
    enforcement = r.choices(["multiplier", "penalty", "augmented"], [5, 0 if mu else 1, 1])[0]
    if family in IMPULSE:
        enforcement = "multiplier"
    law = ""
    if enforcement != "multiplier":
        law += f'enforcement = "{enforcement}"\nstiffness = {num(between(r, 1, 100))}\n'
    if mu:
        law += f"mu = {num(mu)}\n"
    bounces = family in ("moreau-jean", "ns-alpha", "paoli") or family == "energy-mom" and enforcement == "multiplier"
    if bounces and r.random() < 0.4:
        law += f"restitution = {r.choice([0.5, 1.0])}\n"
    title = f"{category} {k:04}, {family}, {enforcement}{f', friction {mu}' if mu else ''}: {draft.hard}"
    text = [f'# {draft.hard}.\ntitle = "{title}"\ndimension = 3\n']
    for b in draft.bodies:
        text.append(f'[[material]]\nname = "{b.name}"\nlaw = "neo-hookean"\ndensity = {num(b.density)}\nyoung = {num(b.young)}\npoisson = {num(b.poisson)}\n')
    held = " ".join(draft.supports)
    for b in draft.bodies:
        lines = [f'[[body]]\nname = "{b.name}"\nmaterial = "{b.name}"\nelement = "{b.element}"\nmesh = {b.mesh}\nplace = {b.place()}\n']
        if draft.gravity and f'"{b.name}.' not in held:
            lines.append(f"gravity = {vec(draft.gravity)}\n")
        lines += [f"{key} = {value}\n" for key, value in b.keys.items()]
        text.append("".join(lines) + ('mass = "lumped"\n' if explicit else ""))
    text += draft.supports
    contacts = [f'secondary = "{s}"\nprimary = "{p}"\n' for s, p in draft.pairs]
    if len(draft.bodies) > 1 and not draft.pairs:
        contacts.append('between = "all"\nself = false\n')
    contacts += [f'secondary = "{b.name}.skin"\nprimary = {rigid}\n' for rigid in draft.planes for b in draft.bodies]
    text += [f'[[contact]]\nname = "c{i}"\n{contact}{law}' for i, contact in enumerate(contacts, 1)]
    text.append(f"[time]\nend = {float(f'{n * step:.12g}')!r}\nstep = {step!r}\nscheme = {{ {chosen_scheme(r, family)} }}\n")
    text.append(f"[output]\nfields_every = {max(1, n // 40)}\ncheckpoint_every = 1000000\n")
    elements = "+".join(b.element for b in draft.bodies) + " " + "+".join(str(b.cells) for b in draft.bodies)
    how = enforcement + (" friction" if mu else "")
    meta = {"category": category, "family": family, "enforcement": how, "elements": elements}
    return meta, "\n".join(text)
