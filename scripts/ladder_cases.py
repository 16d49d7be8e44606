"""Seeded hard contact cases for ladder.py: `case(seed, k)` is the text of case k.

A category draws shapes, meshes, stiffnesses, speeds and roles; a scheme family draws the integrator
and the enforcement. Every body has contact with itself. Bodies do not overlap at the start, and the motion brings them together. Units:
lengths of order 1, density of order 1, the softest body has E = 100, so that its waves travel at
c = sqrt(E (1 − ν)/(ρ (1 + ν)(1 − 2ν))), about 12.

Time. The step is C h/c for the softest body, Courant number C = 0.2 … 5, 60 to 600 steps; explicit
schemes: a tenth of h/c for the stiffest body, less for higher orders and sharp corners, at most 3000
steps, which take less time than 600 others. In the category `fast` the step is given by the diameters
moved in it. Fields are written every 1/40 of the run. A case has at most about 400 cells.
"""

import random
from math import ceil, cos, exp, log, pi, radians, sin, sqrt, tan

FAMILIES = "trapezoidal chung-hulbert tr-bdf2 bathe energy-mom central-diff paoli moreau-jean ns-alpha".split()
EXPLICIT, IMPULSE = {"central-diff", "paoli"}, {"central-diff", "paoli", "moreau-jean", "ns-alpha"}


def num(x):
    """A number with five digits, as TOML."""
    return repr(float(f"{x:.5g}"))


def vec(x):
    return "[" + ", ".join(num(c) for c in x) + "]"


def between(r, low, high):
    """Uniform in the logarithm."""
    return exp(r.uniform(log(low), log(high)))


class Body:
    """A body: its mesh as TOML, the sides that may touch, edge length h and number of cells."""

    def __init__(self, name, mesh, sides, h, cells, young=100.0, **more):
        self.name, self.mesh, self.sides, self.h, self.cells, self.young = name, mesh, sides, h, cells, young
        self.density, self.poisson, self.element = more.pop("density", 1.0), more.pop("poisson", 0.3), more.pop("element", None)
        self.sharp = more.pop("sharp", False)
        self.keys = more  # further keys, as TOML

    def speed(self):
        nu = self.poisson
        return sqrt(self.young * (1 - nu) / (self.density * (1 + nu) * (1 - 2 * nu)))

    def faces(self, *names):
        return [f"{self.name}.{side}" for side in (names or self.sides)]


def rectangle(name, low, high, cells, **more):
    h = max((high[i] - low[i]) / cells[i] for i in (0, 1))
    mesh = f'{{ shape = "rectangle", min = {vec(low)}, max = {vec(high)}, cells = [{cells[0]}, {cells[1]}] }}'
    return Body(name, mesh, ["bottom", "right", "top", "left"], h, 2 * cells[0] * cells[1], **more)


def disc(name, radius, center, rings, **more):
    mesh = f'{{ shape = "disc", radius = {num(radius)}, center = {vec(center)}, size = {num(radius / rings)} }}'
    return Body(name, mesh, ["arc"], radius / rings, 6 * rings**2, **more)


def ring(name, inner, outer, center, size, **more):
    mesh = f'{{ shape = "ring", inner = {num(inner)}, outer = {num(outer)}, center = {vec(center)}, size = {num(size)} }}'
    h = min(size, outer - inner)
    cells = int(2 * pi * (inner + outer) / h * max(1, round((outer - inner) / h)))
    return Body(name, mesh, ["outer"], h, cells, **more)


def polygon(name, points, size, area, **more):
    mesh = f'{{ shape = "polygon", points = [{", ".join(vec(p) for p in points)}], size = {num(size)} }}'
    sides = [f"side{i + 1}" for i in range(len(points))]
    return Body(name, mesh, sides, size, int(area / (0.43 * size**2)), sharp=True, **more)


def box(r, name, width, height, angle, low_at, n, **more):
    """A rectangle turned by `angle` degrees with its lowest corner at `low_at`: a placed rectangle
    or a polygon. Sides in the order bottom, right, top, left."""
    w, t, a = width / 2, height / 2, radians(angle)
    corners = [(-w, -t), (w, -t), (w, t), (-w, t)]
    turned = [(x * cos(a) - y * sin(a), x * sin(a) + y * cos(a)) for x, y in corners]
    lowest = min(turned, key=lambda p: p[1])
    shift = (low_at[0] - lowest[0], low_at[1] - lowest[1])
    if r.random() < 0.5:
        points = [(x + shift[0], y + shift[1]) for x, y in turned]
        return polygon(name, points, max(width, height) / n, width * height, **more)
    more["place"] = f"{{ rotate = {num(angle)}, shift = {vec(shift)} }}"
    return rectangle(name, (-w, -t), (w, t), (n, max(1, round(n * height / width))), **more)


class Draft:
    """A case before its scheme and elements are chosen."""

    def __init__(self, hard, bodies, pairs, end, supports=(), **more):
        self.hard, self.bodies, self.pairs, self.end, self.supports = hard, bodies, pairs, end, list(supports)
        self.step, self.moved = more.get("step"), more.get("moved", False)


def product(secondary, primary):
    return [(s, p) for s in secondary for p in primary]


def roles(r, one, other, share=0.5):
    """Every side of `one` with every side of `other`, one way round."""
    return product(one, other) if r.random() < share else product(other, one)


def table(r, low=-1.5, high=1.5, depth=0.6, name="table", **more):
    nx = r.randint(8, 22)
    return rectangle(name, (low, -depth), (high, 0.0), (nx, max(2, round(nx * depth / (high - low)))), **more)


HOLD = '[[support]]\non = ["{}"]\nfix = ["x", "y"]\n'
PLANE = "{ plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }"


def corner_landing(r):
    v, gap, spin = between(r, 0.5, 4), r.uniform(0.005, 0.04), r.choice([0.0, 0.0, r.uniform(-3, 3)])
    velocity = vec((r.uniform(-0.6, 0.6), -v))
    if spin:
        velocity = f"{{ linear = {velocity}, angular = {num(spin)}, about = [0.0, 0.7] }}"
    angle = 45 + r.uniform(-40, 40)
    b = box(r, "box", 1.0, r.uniform(0.5, 1), angle, (r.uniform(-0.2, 0.2), gap), r.randint(2, 6), young=100 * between(r, 1, 100), velocity=velocity)
    t = table(r)
    pairs = roles(r, b.faces(), t.faces("top"))
    return Draft(f"a box lands on its corner, turned by {angle:.0f} degrees", [b, t], pairs, gap / v + 0.5, [HOLD.format("table.bottom")])


def corner_slide(r):
    R, v = 0.5, between(r, 0.5, 4)
    low = R * between(r, 0.005, 0.6)
    x = -1 - sqrt(R**2 - (R - low) ** 2) - 0.02
    d = disc("disc", R, (x, R - low), r.randint(2, 6), young=100 * between(r, 1, 30), velocity=vec((v, r.choice([0.0, -0.2 * v]))))
    b = table(r, -1, 1, 0.4, "block")
    pairs = roles(r, d.faces(), b.faces("top", "left"), 0.75)
    return Draft(f"a disc meets the corner of a block {low / R:.2g} R above its lowest point", [d, b], pairs, min(2.0, 1.2 / v + 0.1), [HOLD.format("block.bottom")])


def disc_dent(r):
    a, b = r.uniform(0.3, 0.6), r.uniform(0.15, 0.5)
    shift, gap, v = r.uniform(-0.6, 0.6) * (a + b), 0.005, between(r, 0.5, 3)
    height = a + gap + sqrt((a + b + gap) ** 2 - shift**2)
    lower = disc("lower", a, (0.0, a + gap), r.randint(2, 5))
    upper = disc("upper", b, (shift, height), r.randint(2, 5), young=100 * between(r, 10, 1000), density=r.choice([1.0, 5.0]),
                 poisson=r.choice([0.3, 0.45]), velocity=vec((r.uniform(-1, 1) * v, -v)))
    pairs = roles(r, upper.faces(), lower.faces()) + [("lower.arc", PLANE), ("upper.arc", PLANE)]
    return Draft("a stiff disc dents a soft one and slides off", [lower, upper], pairs, min(1.2, 1.0 / v + 0.1))


def wedge(r):
    half, v = radians(r.uniform(7, 35)), between(r, 0.3, 2)
    gap, tall = 0.01, 0.8
    wide = tall * tan(half)
    lean = r.uniform(-0.3, 0.3)
    points = [(0.0, gap), (wide + lean, tall), (-wide + lean, tall)]
    w = polygon("wedge", points, r.uniform(0.12, 0.3), tall * wide, young=100 * between(r, 3, 300), density=5.0, velocity=vec((r.uniform(-0.5, 0.5) * v, -v)))
    b = table(r, -1, 1, 0.8, "block")
    pairs = roles(r, w.faces("side1", "side3"), b.faces("top"))
    return Draft(f"a wedge of {2 * half * 180 / pi:.0f} degrees is driven into a soft block", [w, b], pairs, min(0.8, gap / v + 0.4 / v), [HOLD.format("block.bottom")])


def notch(r):
    a, d, v = r.uniform(0.15, 0.5), r.uniform(0.15, 0.5), between(r, 0.5, 3)
    inner = [(0.0, -d)] if r.random() < 0.6 else [(0.8 * a, -d), (-0.8 * a, -d)]
    points = [(-1.0, -0.8), (1.0, -0.8), (1.0, 0.0), (a, 0.0), *inner, (-a, 0.0), (-1.0, 0.0)]
    b = polygon("block", points, r.uniform(0.12, 0.3), 1.4)
    R = a * r.uniform(0.6, 2.0)
    s = disc("disc", R, (r.uniform(-0.7, 0.7) * a, R + 0.01), r.randint(2, 4), young=100 * between(r, 1, 100), velocity=vec((r.uniform(-0.4, 0.4) * v, -v)))
    top = b.faces(*b.sides[2:-1])
    pairs = roles(r, s.faces(), top, 0.6)
    return Draft(f"a disc strikes a notch (concave corner), R = {R / a:.2g} half widths", [s, b], pairs, min(1.0, 0.02 / v + 0.8 / v), [HOLD.format("block.side1")])


def beam(r):
    t, nx, v = r.uniform(0.06, 0.15), r.randint(10, 30), between(r, 0.5, 4)
    b = rectangle("beam", (-1.0, -t), (1.0, 0.0), (nx, r.choice([1, 1, 2])), young=100 * between(r, 1, 10))
    R, at_end = r.uniform(0.1, 0.35), r.random() < 0.5
    x = 1 + r.uniform(-0.3, 0.6) * R if at_end else r.uniform(-0.2, 0.2)
    y = sqrt(R**2 - max(0.0, x - 1) ** 2) + 0.01
    s = disc("disc", R, (x, y), r.randint(2, 4), young=100 * between(r, 1, 100), density=r.choice([1.0, 5.0]), velocity=vec((0.0, -v)))
    hold = r.choice([[], ["left"], ["left"], ["left", "right"] if not at_end else ["left"]])
    faces = b.faces("top", "right") if at_end else b.faces("top")
    pairs = roles(r, s.faces(), faces)
    return Draft(f"a slender beam is struck {'near its end' if at_end else 'at its middle'}", [b, s], pairs, min(1.0, 1.0 / v), [HOLD.format(f"beam.{h}") for h in hold])


def thin_ring(r):
    wall, v, R = between(r, 0.05, 0.2), between(r, 0.5, 3), 0.5
    size = between(r, wall, 0.2)
    g = ring("ring", R - wall, R, (0.0, R + 0.01), size, velocity=vec((r.uniform(-0.3, 0.3), -v)))
    onto = r.choice(["plane", "block", "disc"])
    end = min(1.5, 1.2 / v + 0.2)
    if onto == "plane":
        return Draft("a thin ring falls on a plane and may collapse", [g], [("ring.outer", PLANE)], end)
    if onto == "block":
        b = table(r, -1, 1, 0.4, "block", young=100 * between(r, 0.3, 10))
        return Draft("a thin ring falls on a block", [g, b], roles(r, g.faces(), b.faces("top")), end, [HOLD.format("block.bottom")])
    b = r.uniform(0.1, 0.4)
    g.keys.pop("velocity")
    s = disc("disc", b, (r.uniform(-0.3, 0.3), 2 * R + b + 0.02), r.randint(2, 4), young=100 * between(r, 1, 100), density=r.choice([1.0, 5.0]), velocity=vec((0.0, -v)))
    pairs = roles(r, s.faces(), g.faces()) + [("ring.outer", PLANE), ("disc.arc", PLANE)]
    return Draft("a thin ring on a plane is struck by a disc", [g, s], pairs, end)


def stack(r):
    bodies, pairs, y, v, under = [], [], 0.0, between(r, 0.5, 3), None
    for i in range(3):
        name, gap = f"body{i + 1}", r.uniform(0.005, 0.05)
        x, young = r.uniform(-0.08, 0.08), 100 * between(r, 1, 100)
        g = {"velocity": vec((0.0, -v))}
        if r.random() < 0.5:
            R = r.uniform(0.15, 0.35)
            b, tall = disc(name, R, (x, y + gap + R), r.randint(2, 4), young=young, **g), 2 * R
            low, high = b.faces(), b.faces()
        else:
            w, tall = r.uniform(0.5, 0.9), r.uniform(0.2, 0.4)
            n = r.randint(2, 7)
            b = rectangle(name, (x - w / 2, y + gap), (x + w / 2, y + gap + tall), (n, max(1, round(n * tall / w))), young=young, **g)
            low, high = b.faces("bottom", "left", "right"), b.faces("top")
        if under:
            pairs += roles(r, low, under)
        pairs += [(side, PLANE) for side in low]
        bodies, y, under = [*bodies, b], y + gap + tall, high
    return Draft("a stack of three bodies falls on a plane", bodies, pairs, min(1.2, 0.8 / v + 0.2))


def corner_corner(r):
    v, gap, off = between(r, 0.3, 3), 0.01, r.uniform(-0.06, 0.06)
    angle = 45 + r.uniform(-30, 30)
    b = box(r, "box", 0.8, 0.8, angle, (off, gap), r.randint(2, 6), young=100 * between(r, 1, 50), velocity=vec((r.uniform(-0.5, 0.5) * v, -v)))
    n = r.randint(3, 8)
    t = rectangle("block", (-1.0, -1.0), (0.0, 0.0), (n, n))
    pairs = roles(r, b.faces(), t.faces("top", "right"))
    return Draft(f"corner on corner, {off:+.3f} beside it", [b, t], pairs, min(1.0, 0.6 / v + 0.1), [HOLD.format("block.bottom")])


def slide_off(r):
    v, g = between(r, 0.5, 3), between(r, 1, 10)
    t = table(r, -1, 1, 0.5)
    kind, w = r.choice(["box", "disc"]), r.uniform(0.3, 0.7)
    keys = {"young": 100 * between(r, 1, 50), "velocity": vec((v, 0.0)), "gravity": vec((0.0, -g))}
    x = 1 - w * r.uniform(0.1, 0.7)
    if kind == "box":
        n = r.randint(2, 6)
        b = rectangle("box", (x - w / 2, 0.002), (x + w / 2, 0.002 + 0.7 * w), (n, max(1, round(0.7 * n))), **keys)
        pairs = roles(r, b.faces("bottom", "left"), t.faces("top", "right"))
    else:
        b = disc("disc", w / 2, (x, w / 2 + 0.002), r.randint(2, 5), **keys)
        pairs = roles(r, b.faces(), t.faces("top", "right"))
    return Draft(f"a {kind} slides off the edge of a table", [b, t], pairs, min(1.5, 1.2 * w / v + 0.3), [HOLD.format("table.bottom")])


def fast(r):
    size, share, k = r.uniform(0.02, 0.08), between(r, 0.03, 0.4), between(r, 1, 10)
    plate = r.random() < 0.5
    young = 100 * between(r, 1, 100)
    if plate:
        t = r.uniform(0.03, 0.12)
        b = rectangle("plate", (-1.0, -t), (1.0, 0.0), (r.randint(15, 40), 1), young=young)
        supports = [HOLD.format("plate.left"), HOLD.format("plate.right")]
    else:
        b = table(r, -1, 1, 0.6, "block", young=young)
        supports = [HOLD.format("block.bottom")]
    v = share * b.speed()
    step = k * 2 * size / v
    start = r.uniform(0.2, 2.5) * v * step + 0.01
    slant = r.uniform(-0.3, 0.3) if r.random() < 0.5 else 0.0
    keys = {"young": young * between(r, 1, 30), "density": r.choice([1.0, 5.0]), "velocity": vec((slant * v, -v))}
    if r.random() < 0.6:
        s = disc("shot", size, (-slant * start, size + start), 2, **keys)
    else:
        s = box(r, "shot", 2 * size, 2 * size, r.uniform(-45, 45), (-slant * start, start), 2, **keys)
    pairs = roles(r, s.faces(), b.faces("top"), 0.6)
    n = r.randint(30, 60)
    return Draft(f"a small body moves {k:.1f} diameters a step against a {b.name}", [s, b], pairs, n * step, supports, step=step)


def mesh_ratio(r):
    ratio, v = between(r, 2, 8), between(r, 0.5, 3)
    coarse_disc = r.random() < 0.5
    nx = max(4, min(24, round(24 / ratio))) if not coarse_disc else r.randint(16, 24)
    b = rectangle("block", (-1.0, -0.5), (1.0, 0.0), (nx, max(1, nx // 4)), young=100 * between(r, 1, 100))
    R = r.uniform(0.3, 0.6)
    rings = 2 if coarse_disc else max(2, min(6, round(R / (2 / nx) * ratio)))
    s = disc("disc", R, (r.uniform(-0.5, 0.5), R + 0.01), rings, young=100 * between(r, 1, 100), velocity=vec((r.uniform(-1, 1) * v, -v)))
    if r.random() < 0.3:
        s = box(r, "disc", 2 * R, R, r.uniform(-20, 20), (0.0, 0.01), 2 * rings, young=s.young, velocity=s.keys["velocity"])
    pairs = roles(r, s.faces(), b.faces("top"))
    return Draft(f"meshes whose cells differ by a factor {max(b.h / s.h, s.h / b.h):.1f}", [s, b], pairs, min(1.0, 0.8 / v + 0.1), [HOLD.format("block.bottom")])


def press(r):
    T, kind = r.uniform(0.6, 2), r.choice(["plate", "punch", "indenter", "edge"])
    move = lambda d: f'"{num(d)}*(t/{num(T)})^2*(3 - 2*t/{num(T)})"'
    stiff, gap = 100 * between(r, 10, 1000), 0.005 if kind == "edge" else r.choice([0.0, 0.005])
    if kind == "plate":
        R = 0.5
        d = disc("disc", R, (0.0, R), r.randint(2, 5))
        n = r.randint(4, 12)
        u = rectangle("tool", (-1.0, 2 * R + gap), (1.0, 2 * R + gap + 0.4), (n, 2), young=stiff)
        depth = r.uniform(0.3, 0.75)
        pairs = [("disc.arc", PLANE), *roles(r, d.faces(), u.faces("bottom"), 0.7)]
        hold, bodies, top = [], [d, u], "top"
    else:
        b = table(r, -1, 1, 0.8, "block")
        hold, depth = [HOLD.format("block.bottom")], r.uniform(0.15, 0.5)
        x = 1.0 if kind == "edge" else r.uniform(-0.2, 0.2)
        if kind == "indenter":
            w = r.uniform(0.1, 0.5)
            u = polygon("tool", [(x, gap), (x + w, 0.6), (x - w, 0.6)], r.uniform(0.12, 0.25), 0.6 * w, young=stiff)
            faces, top = u.faces("side1", "side3"), "side2"
        else:
            w, n = r.uniform(0.2, 0.5), r.randint(2, 6)
            u = rectangle("tool", (x - w, gap), (x + w, gap + 0.4), (n, max(1, n // 2)), young=stiff)
            faces, top = u.faces("bottom", "left", "right"), "top"
        pairs = roles(r, faces, b.faces("top", "right") if kind == "edge" else b.faces("top"))
        bodies = [u, b]
    slide = f"x = {move(r.uniform(-0.4, 0.4))}, " if r.random() < 0.4 else ""
    fix = "" if slide else 'fix = ["x"]\n'
    hold.append(f'[[support]]\non = ["tool.{top}"]\n{fix}move = {{ {slide}y = {move(-depth - gap)} }}\n')
    return Draft(f"pressed from rest by {depth:.2g}: {kind}", bodies, pairs, T, hold, moved=True)


CATEGORIES = {
    "corner-landing": corner_landing, "corner-slide": corner_slide, "disc-dent": disc_dent, "wedge": wedge, "notch": notch,
    "beam": beam, "ring": thin_ring, "stack": stack, "corner-corner": corner_corner, "slide-off": slide_off, "fast": fast,
    "mesh-ratio": mesh_ratio, "press": press,
}  # fmt: skip


def scheme(r, family):
    """The scheme as TOML."""
    choose = {
        "trapezoidal": lambda: 'kind = "newmark", beta = 0.25, gamma = 0.5',
        "chung-hulbert": lambda: f'kind = "chung-hulbert", rho_inf = {r.choice([0.0, 0.1, 0.5, 0.8, 1.0])}',
        "tr-bdf2": lambda: 'kind = "tr-bdf2"',
        "bathe": lambda: f'kind = "bathe", rho_inf = {r.choice([0.0, 0.6, 0.9])}',
        "energy-mom": lambda: 'kind = "energy-momentum"',
        "central-diff": lambda: 'kind = "central-difference"',
        "paoli": lambda: 'kind = "paoli-schatzman"',
        "moreau-jean": lambda: f'kind = "moreau-jean", theta = {r.choice([0.5, 1.0])}',
        "ns-alpha": lambda: f'kind = "nonsmooth-generalized-alpha", rho_inf = {r.choice([0.1, 0.5, 0.8])}',
    }
    return choose[family]()


def case(seed, k):
    """(category, family, …; text) of case k ≥ 1."""
    r = random.Random(f"ladder {seed} {k}")
    category = list(CATEGORIES)[(k - 1) % len(CATEGORIES)]
    draft = CATEGORIES[category](r)
    allowed = [f for f in FAMILIES if not (draft.moved and f in IMPULSE) and not (draft.step and f in EXPLICIT)]
    # The explicit and impulse schemes are half as frequent as the implicit ones.
    family = r.choices(allowed, [1 if f in IMPULSE else 2 for f in allowed])[0]
    explicit = family in EXPLICIT
    same = r.choice(["T3", "T6", "T6", "T10"]) if r.random() < 0.6 else None
    for b in draft.bodies:
        b.element = same or r.choice(["T3", "T6", "T10"])
        if explicit:
            b.young = min(b.young, 1000.0)
    penalty = family not in IMPULSE and r.random() < 0.25
    soft = min(draft.bodies, key=lambda b: b.speed())
    if draft.step:
        step = draft.step
    elif explicit:
        step = min(0.1 * (0.3 if b.sharp else 1) * b.h / (b.speed() * int("136"["T3 T6 T10".split().index(b.element)])) for b in draft.bodies)
        draft.end = min(draft.end, 3000 * step)
    else:
        step = between(r, 0.2, 5) * soft.h / soft.speed()
        step = min(max(step, draft.end / 600), draft.end / 60)
    step = float(f"{step:.3g}")
    n = max(20, ceil(draft.end / step - 1e-9))
    if draft.moved:  # the formula ends at `end`
        n = max(20, int(draft.end / step))
    law = f"enforcement = \"penalty\"\nstiffness = {num(between(r, 1, 100))}\n" if penalty else ""
    if family in ("moreau-jean", "ns-alpha", "paoli") and r.random() < 0.4:
        law += f"restitution = {r.choice([0.5, 1.0])}\n"
    cells = "+".join(str(b.cells) for b in draft.bodies)
    text = [f'# {draft.hard}.\ntitle = "{category} {k:04}, {family}, {"penalty" if penalty else "multiplier"}: {draft.hard}"\ndimension = 2\n']
    for b in draft.bodies:
        text.append(f'[[material]]\nname = "{b.name}"\nlaw = "neo-hookean"\ndensity = {num(b.density)}\nyoung = {num(b.young)}\npoisson = {num(b.poisson)}\n')
    for b in draft.bodies:
        lines = [f'[[body]]\nname = "{b.name}"\nmaterial = "{b.name}"\nelement = "{b.element}"\nmesh = {b.mesh}\n']
        lines += [f"{key} = {value}\n" for key, value in b.keys.items()]
        text.append("".join(lines) + ('mass = "lumped"\n' if explicit else ""))
    text += draft.supports
    for i, (secondary, primary) in enumerate(draft.pairs, 1):
        primary = primary if primary.startswith("{") else f'"{primary}"'
        text.append(f'[[contact]]\nname = "c{i}"\nsecondary = "{secondary}"\nprimary = {primary}\n{law}')
    # Any body may fold; nothing may pass through itself.
    text += [f'[[contact]]\nname = "self-{b.name}"\nbetween = ["{b.name}"]\n{law}' for b in draft.bodies]
    text.append(f"[time]\nend = {float(f'{n * step:.12g}')!r}\nstep = {step!r}\nscheme = {{ {scheme(r, family)} }}\n")
    text.append(f"[output]\nfields_every = {max(1, n // 40)}\ncheckpoint_every = 1000000\n")
    elements = "+".join(f"{b.element}" for b in draft.bodies)
    meta = {"category": category, "family": family, "enforcement": "penalty" if penalty else "multiplier", "elements": f"{elements} {cells}"}
    return meta, "\n".join(text)
