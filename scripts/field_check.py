"""Independent check of a record: do bodies penetrate each other, themselves or rigid planes, do they
pass through, is energy created?  Used by ladder.py; reads only the run directory (Python 3, numpy).

It sees the written fields. Between two of them, only the passage of a body through another is sought,
by straight paths of centres. Planes are taken as they are at t = 0; circles, polylines and obstacles
that move are refused (ValueError). A finished run with fewer than two fields, a field file that is
missing, and numbers that are not finite are wrong.

Geometry. The outline of a body is the set of cell edges that belong to one cell, chained into loops
with the body on their left. An edge of degree p with nodes x_0 … x_p at equal parameters is

    x(t) = sum_i L_i(t) x_i,     L_i(t) = prod_{j != i} (p t − j)/(i − j),     t = k/16, k = 0 … 16.

h is the length of a facet (edge) in the reference configuration.

Penetration, for every ordered pair (A, B) of bodies and every written field: a point of A is inside
if a ray from it crosses the sampled outline of B an odd number of times; its depth is its distance
to that outline. Two classes of points are judged separately (depth/h; the depth of the same class at
the first field, an overlap that the case starts with, is subtracted and reported apart):

    nodes   nodes of A that a [[contact]] declares as secondary to a side of B, which the contact
            law keeps outside exactly;  h of the facet of B that is penetrated
            limit 0.05 (multiplier), 0.25 (penalty, and laws on velocities, which leave the
            penetration of the step in which contact begins)
    edges   all other nodes of A and 17 points on each of its edges;  h the larger of the facet of B
            that is penetrated and the own facet of the point
            limit 0.1 and 0.3, plus the sag s_A + s_B that node-to-segment
            contact of curved facets cannot avoid:  s = max θ/(8 p²), the sag/h of an arc that
            turns by θ over a facet with p + 1 nodes. Turns above 35 degrees at a vertex are
            corners and do not count.

Rigid planes: depth −n·(x − x_0), relative to the own facet, with the same limits. A plane is checked
for its secondary bodies and for all bodies that start above it.

Self-penetration: if facets that are not neighbours cross, depth of the points x of the outline with
winding number w(x) > 1. Here w is the sum of the angles under which x sees the oriented outline,
divided by 2π, the interior angle at x itself over 2π where nothing overlaps, and one more inside
another part. Depth: distance to the facets that are neither the own one nor its neighbours, but for
those across a crease, where the interior angle is above 270 degrees: its two walls close on each
other. Limit 0.1 h.

Inverted: the determinant of a cell's map, relative to its corners' order, is not positive at one of
the 153 points with coordinates k/16. (The triangle of the corners of a curved cell may turn over
while the cell is bent, but valid.)

Passing through: from one field to the next, the path of the centre of the smaller body, relative to
the centre of the larger one, crosses the outline of the larger one, in the shape of either instant, an
even number > 0 of times; or the smaller centre is inside both bodies.

Energy, from history.csv with E = total − external_work:

    created = max_i (E_i − min_{j <= i} E_j) / max(max(kinetic + strain), sum |ΔW_ext|),   limit 0.02

Momentum: without supports, loads and gravity, and with contacts on obstacles only, the change of
momentum from first to last row must be contact_impulse (to 1e-6 of the largest momentum), if the
last row is without contact. Contacts of a body with itself do not count if contact.csv has no row of
them; otherwise contact_impulse contains forces within the body.
"""

import numpy as np

from field_judge import CORNER, SELF_LIMIT, Judge, depth_below, obstacle_depths

PARTS = 16


def shape_matrix(p, t):
    """Lagrange polynomials of degree p on equally spaced nodes, at t in [0, 1]."""
    rows = [[np.prod([(p * s - j) / (i - j) for j in range(p + 1) if j != i]) for i in range(p + 1)] for s in t]
    return np.array(rows)


def slopes(p):
    """Derivatives of the shape functions of a triangle of degree p, nodes in VTK's order, by both
    coordinates (2, points, nodes), at all points k/16."""
    corners = [(p, 0, 0), (0, p, 0), (0, 0, p)]
    between = lambda a, b: [tuple(((p - k) * i + k * j) // p for i, j in zip(a, b)) for k in range(1, p)]
    nodes = corners + [n for e in range(3) for n in between(corners[e], corners[(e + 1) % 3])]
    nodes += [(1, 1, 1)] if p == 3 else []
    powers = [(i, j) for i in range(p + 1) for j in range(p + 1 - i)]
    at_nodes = np.array([[(n[1] / p) ** i * (n[2] / p) ** j for i, j in powers] for n in nodes])
    points = [(i / 16, j / 16) for i in range(17) for j in range(17 - i)]
    by_x = [[i * x ** max(i - 1, 0) * y**j for i, j in powers] for x, y in points]
    by_y = [[j * x**i * y ** max(j - 1, 0) for i, j in powers] for x, y in points]
    return np.array([by_x, by_y]) @ np.linalg.inv(at_nodes)


def slopes_of_quadrilaterals(p):
    """The same of a quadrilateral of degree 1 or 2."""
    nodes = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5), (0.5, 0.5)])
    powers = [(i, j) for i in range(p + 1) for j in range(p + 1)]
    at_nodes = np.array([[x**i * y**j for i, j in powers] for x, y in nodes[: len(powers)]])
    points = [(i / 16, j / 16) for i in range(17) for j in range(17)]
    by_x = [[i * x ** max(i - 1, 0) * y**j for i, j in powers] for x, y in points]
    by_y = [[j * x**i * y ** max(j - 1, 0) for i, j in powers] for x, y in points]
    return np.array([by_x, by_y]) @ np.linalg.inv(at_nodes)


# Corners and degree of a cell, by its number of nodes.
KINDS = {3: (3, 1), 6: (3, 2), 10: (3, 3), 4: (4, 1), 9: (4, 2)}


def boundary(cells):
    """Facets (F, p + 1) of triangles or quadrilaterals in VTK's node order, chained loop after loop, and
    the loop of each."""
    corners, p = KINDS[cells.shape[1]]
    count, facets = {}, {}
    for cell in cells:
        for e in range(corners):
            i, j = cell[e], cell[(e + 1) % corners]
            count[frozenset((i, j))] = count.get(frozenset((i, j)), 0) + 1
            facets[(i, j)] = [i, *cell[corners + e * (p - 1) : corners + (e + 1) * (p - 1)], j]
    free = {}
    for (i, _), facet in facets.items():
        if count[frozenset((facet[0], facet[-1]))] == 1:
            free.setdefault(i, []).append(facet)
    order, loops, loop = [], [], 0
    while free:
        at = min(free)
        while at in free:
            order.append(free[at].pop())
            if not free[at]:
                del free[at]
            loops.append(loop)
            at = order[-1][-1]
        loop += 1
    return np.array(order), np.array(loops)


def wrapped(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


class Outline:
    """Outline of one body: topology and, after `at`, the samples of one instant."""

    def __init__(self, cells, reference):
        self.nodes_of_body, self.cells = np.unique(cells), cells
        self.facets, self.loops = boundary(cells)
        self.p = self.facets.shape[1] - 1
        self.matrix = shape_matrix(self.p, np.linspace(0, 1, PARTS + 1))
        self.slopes = (slopes if KINDS[cells.shape[1]][0] == 3 else slopes_of_quadrilaterals)(self.p)
        self.nodes, first = np.unique(self.facets, return_index=True)
        self.node_facet = first // (self.p + 1)
        self.thick = np.inf
        self.turns = np.zeros(len(self.facets))
        self.at(reference)
        self.h = np.linalg.norm(np.diff(self.samples, axis=1), axis=2).sum(1)
        self.sag = self.turning() / (8 * self.p**2)

    def at(self, position):
        self.position = position
        self.samples = np.einsum("ki,fid->fkd", self.matrix, position[self.facets])
        self.follow_turns()
        # Straight facets need one segment.
        s = self.samples[:, :: PARTS if self.p == 1 else 1]
        self.a, self.b = s[:, :-1].reshape(-1, 2), s[:, 1:].reshape(-1, 2)
        self.per = s.shape[1] - 1
        points = s.reshape(-1, 2)
        self.low, self.high = points.min(0), points.max(0)
        self.center = position[self.nodes_of_body].mean(0)
        self.extent = float(np.linalg.norm(self.high - self.low))

    def inverted(self):
        """Whether the map of a cell has a determinant that is not positive."""
        u, v = np.einsum("dqn,cni->dcqi", self.slopes, self.position[self.cells])
        return bool((u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0] <= 0).any())

    def neighbour(self):
        """Index of the next facet in the loop of each facet."""
        following = np.arange(len(self.facets)) + 1
        for loop in np.unique(self.loops):
            members = np.flatnonzero(self.loops == loop)
            following[members[-1]] = members[0]
        return following

    def angles(self):
        """Directions of the segments of each facet."""
        d = np.diff(self.samples, axis=1)
        return np.arctan2(d[..., 1], d[..., 0])

    def follow_turns(self):
        """Angle by which the outline turns at the end of each facet, negative at a concave corner; it is
        followed over the fields, because a crease may close beyond -180 degrees."""
        angle = self.angles()
        self.turns += wrapped(angle[self.neighbour(), 0] - angle[:, -1] - self.turns)

    def turning(self):
        """Largest angle over which a facet and the vertex after it turn; corners do not count."""
        inside = np.abs(wrapped(np.diff(self.angles(), axis=1)).sum(1))
        vertex = np.abs(wrapped(self.turns))
        return float((inside + np.where(vertex > CORNER, 0.0, vertex)).max())

    def points_near(self, _low, _high):
        """Sampled points between the nodes of its facets, and their h."""
        return self.samples[:, 1:-1].reshape(-1, 2), np.repeat(self.h, PARTS - 1)

    def inside(self, x):
        """Whether points are inside, by the parity of crossings of a ray."""
        result = np.zeros(len(x), bool)
        near = np.flatnonzero(((x > self.low) & (x < self.high)).all(1))
        for part in np.array_split(near, len(near) // 500 + 1):
            p = x[part][:, None]
            above_a, above_b = self.a[None, :, 1] > p[..., 1], self.b[None, :, 1] > p[..., 1]
            dy = self.b[:, 1] - self.a[:, 1]
            safe = np.where(dy == 0, 1.0, dy)
            cut = self.a[:, 0] + (p[..., 1] - self.a[:, 1]) * (self.b[:, 0] - self.a[:, 0]) / safe
            result[part] = ((above_a != above_b) & (p[..., 0] < cut)).sum(1) % 2 == 1
        return result

    def distance(self, x, exclude=None):
        """Distance of points to the outline, and the facet there; `exclude`: mask of (point, facet)."""
        if len(x) == 0:
            return np.zeros(0), np.zeros(0, int)
        d = self.b - self.a
        out, facet = np.empty(len(x)), np.empty(len(x), int)
        for part in np.array_split(np.arange(len(x)), len(x) // 500 + 1):
            r = x[part][:, None] - self.a[None]
            t = np.clip((r * d).sum(2) / np.maximum((d * d).sum(1), 1e-300), 0, 1)
            q = ((r - t[..., None] * d) ** 2).sum(2)
            if exclude is not None:
                q[np.repeat(exclude[part], self.per, axis=1)] = np.inf
            best = q.argmin(1)
            out[part], facet[part] = np.sqrt(q[np.arange(len(part)), best]), best // self.per
        return out, facet

    def meets(self, start, end):
        """How often the segment start–end crosses the outline."""
        cross = lambda u, v: u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
        s = end - start
        one = cross(s, self.a - start) > 0
        other = cross(s, self.b - start) > 0
        d = self.b - self.a
        return int(((one != other) & ((cross(d, start - self.a) > 0) != (cross(d, end - self.a) > 0))).sum())

    def self_depth(self):
        """Largest depth/h of the outline in its own body."""
        n = len(self.facets)
        following = self.neighbour()
        near = np.eye(n, dtype=bool)
        near[np.arange(n), following] = near[following, np.arange(n)] = True
        # Cheap test first: do four segments per facet (one, if straight) of distant facets cross?
        s = self.samples[:, :: PARTS if self.p == 1 else PARTS // 4]
        a, b = s[:, :-1].reshape(-1, 2), s[:, 1:].reshape(-1, 2)
        owner = np.repeat(np.arange(n), s.shape[1] - 1)
        d = b - a
        side = lambda p: (d[:, None, 0] * (p[None, :, 1] - a[:, None, 1]) - d[:, None, 1] * (p[None, :, 0] - a[:, None, 0])) > 0
        split = side(a) != side(b)
        hit = split & split.T & ~near[np.ix_(owner, owner)]
        if not hit.any():
            return 0.0
        # Angles under which the sampled points see the segments; 0 where the point is an end.
        x, own = a, owner
        u, v = a[None] - x[:, None], b[None] - x[:, None]
        angle = np.arctan2(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0], (u * v).sum(2))
        scale = 1e-12 * self.extent**2
        angle[((u * u).sum(2) < scale) | ((v * v).sum(2) < scale)] = 0.0
        inside = angle.sum(1) / (2 * np.pi) > 1 + 1e-6
        if not inside.any():
            return 0.0
        crease = self.turns < -np.pi / 2
        near[np.arange(n)[crease], following[crease]] = near[following[crease], np.arange(n)[crease]] = False
        depth, _ = self.distance(x[inside], near[own[inside]])
        return float((depth / self.h[own[inside]]).max())


class Plane(Judge):
    AXES = 2
    PRIMARY = ("side", "plane")
    outline = Outline

    def obstacle(self, a, number, spec, time):
        """A plane is checked for all bodies that start above it, too."""
        if self.previous is None:
            depth_of, _ = depth_below(spec)
            _, depth = obstacle_depths(self.bodies[a], depth_of, [])
            if depth <= 0:
                self.pairs.setdefault((a, number), (set(), "exact"))
        super().obstacle(a, number, spec, time)

    def itself(self, a, time):
        self.deepest("self", a, self.bodies[a].self_depth(), time, f"{a} in itself", SELF_LIMIT)


def check(run):
    """Numbers and verdicts of a record, as a dictionary; `wrong` lists what is wrong."""
    return Plane(run).result()
