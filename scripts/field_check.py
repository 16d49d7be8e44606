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

import csv
import html
import json
import re
import xml.etree.ElementTree as xml
from pathlib import Path

import numpy as np

PARTS = 16
LIMITS = {"exact": (0.05, 0.1), "soft": (0.25, 0.3)}
SELF_LIMIT, CREATED_LIMIT, CORNER = 0.1, 0.02, np.radians(35.0)
TYPES = {"Float64": "<f8", "Int64": "<i8", "Int32": "<i4", "UInt8": "u1"}
MARK = b'<AppendedData encoding="raw">\n_'


def read_vtu(path):
    """Point arrays, `points`, `connectivity`, `offsets`, cell array `body`, and the names of bodies."""
    raw = Path(path).read_bytes()
    at = raw.index(MARK)
    head, data, arrays = raw[:at].decode(), raw[at + len(MARK) :], {}
    for tag in re.finditer(r'<DataArray type="(\w+)" ([^>]*?)/?>', head):
        kind, rest = tag.groups()
        attributes = dict(re.findall(r'(\w+)="([^"]*)"', rest))
        if attributes["Name"].startswith("body "):
            arrays.setdefault("names", []).append(html.unescape(attributes["Name"][5:]))
            continue
        start = int(attributes["offset"])
        size = int.from_bytes(data[start : start + 8], "little")
        values = np.frombuffer(data, TYPES[kind], size // np.dtype(TYPES[kind]).itemsize, start + 8)
        n = int(attributes.get("NumberOfComponents", 1))
        arrays[attributes["Name"]] = values.reshape(-1, n) if n > 1 else values
    return arrays


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


def boundary(cells):
    """Facets (F, p + 1) of triangles in VTK's node order, chained loop after loop, and the loop of each."""
    n = cells.shape[1]
    p = {3: 1, 6: 2, 10: 3}[n]
    count, facets = {}, {}
    for cell in cells:
        for e in range(3):
            i, j = cell[e], cell[(e + 1) % 3]
            count[frozenset((i, j))] = count.get(frozenset((i, j)), 0) + 1
            facets[(i, j)] = [i, *cell[3 + e * (p - 1) : 3 + (e + 1) * (p - 1)], j]
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
        self.slopes = slopes(self.p)
        self.nodes, first = np.unique(self.facets, return_index=True)
        self.node_facet = first // (self.p + 1)
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

    def crossings(self, start, end):
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


class Worst:
    """Largest depth/h of a class for a pair, less that of the first field, and where."""

    def __init__(self):
        self.first, self.depth, self.time, self.what, self.limit = None, 0.0, None, "", 0.0

    def add(self, value, time, what, limit):
        self.limit = limit
        if self.first is None:
            self.first = value
        elif value - self.first > self.depth:
            self.depth, self.time, self.what = value - self.first, time, what


def frames(run):
    """(time, arrays) of every written field; no arrays where the file is missing."""
    for entry in xml.parse(run / "fields.pvd").iter("DataSet"):
        path = run / entry.get("file")
        yield float(entry.get("timestep")), read_vtu(path) if path.exists() else None


def outlines(arrays):
    """Outline of each body, by name."""
    ends, conn = arrays["offsets"], arrays["connectivity"]
    starts = np.concatenate([[0], ends[:-1]])
    result = {}
    for i, name in enumerate(arrays["names"]):
        mine = np.flatnonzero(arrays["body"] == i)
        cells = np.array([conn[starts[c] : ends[c]] for c in mine])
        result[name] = Outline(cells, arrays["points"][:, :2])
    return result


def max_or_zero(x):
    return float(x.max()) if len(x) else 0.0


def pair_depths(a, b, secondary):
    """(nodes, edges): largest depth/h of A's points in B, by class; `secondary`: nodes of A, a mask."""
    if (a.low > b.high).any() or (b.low > a.high).any():
        return 0.0, 0.0
    x = a.position[a.nodes]
    own = a.h[a.node_facet]
    inner = a.samples[:, 1:-1].reshape(-1, 2)
    points = np.concatenate([x, inner])
    own = np.concatenate([own, np.repeat(a.h, PARTS - 1)])
    is_secondary = np.concatenate([np.isin(a.nodes, secondary), np.zeros(len(inner), bool)])
    found = np.flatnonzero(b.inside(points))
    depth, facet = b.distance(points[found])
    sec = is_secondary[found]
    nodes = max_or_zero((depth / b.h[facet])[sec])
    edges = max_or_zero((depth / np.maximum(b.h[facet], own[found]))[~sec])
    return nodes, edges


def plane_depths(a, point, normal, secondary):
    depth_of = lambda x: -(x - point) @ normal
    sec = np.isin(a.nodes, secondary)
    at_nodes = depth_of(a.position[a.nodes]) / a.h[a.node_facet]
    at_edges = depth_of(a.samples).max(1) / a.h
    edges = np.concatenate([at_edges, at_nodes[~sec]]) if len(secondary) < len(a.nodes) else at_edges
    return max(0.0, max_or_zero(at_nodes[sec])), max(0.0, max_or_zero(edges))


def history(run):
    with (run / "history.csv").open() as file:
        rows = list(csv.DictReader(file))
    column = lambda name: np.array([float(r[name]) for r in rows])
    return rows, column


def energy(run):
    """(created by this formula, energy_created/energy_scale of the record)."""
    rows, column = history(run)
    if not rows:
        return 0.0, 0.0
    e, work = column("total") - column("external_work"), column("external_work")
    if not np.isfinite(e).all():
        return float("nan"), float("nan")
    rise = (e - np.minimum.accumulate(e)).max()
    scale = max((column("kinetic") + column("strain")).max(), np.abs(np.diff(work)).sum(), 1e-300)
    last = rows[-1]
    return float(rise / scale), float(last["energy_created"]) / max(float(last["energy_scale"]), 1e-300)


def touched(run):
    """Names of the contacts that contact.csv has rows of."""
    path = run / "contact.csv"
    if not path.exists():
        return set()
    with path.open() as file:
        return {row["contact"] for row in csv.DictReader(file)}


def momentum(run, case):
    """|change of momentum − contact impulse| over the largest momentum; None if it does not apply."""
    free = not case["supports"] and not case["loads"] and not any(any(b["gravity"]) for b in case["bodies"])
    of_itself = lambda c: c["primary"].get("side") == c["secondary"]
    contacts = [c for c in case["contacts"] if not of_itself(c) or c["name"] in touched(run)]
    rigid = contacts and all("side" not in c["primary"] for c in contacts)
    rows, column = history(run)
    if not (free and rigid and rows and float(rows[-1]["active"]) == 0):
        return None
    axes = [i for i in "xyz" if f"momentum_{i}" in rows[0]]
    p = np.array([column(f"momentum_{i}") for i in axes])
    error = p[:, -1] - p[:, 0] - [column(f"contact_impulse_{i}")[-1] for i in axes]
    return float(np.linalg.norm(error) / max(np.linalg.norm(p, axis=0).max(), 1e-300))


def declare(pairs, contact, body, other, nodes):
    """Adds the nodes of a body that another body, or an obstacle by number, keeps out."""
    soft = contact["enforcement"] == "penalty" or contact.get("law") == "velocity"
    kind = "soft" if soft else "exact"
    old = pairs.get((body, other), (set(), kind))
    pairs[body, other] = (old[0] | nodes, kind)
    if not isinstance(other, int):
        pairs.setdefault((other, body), (set(), kind))


def declared(manifest):
    """{(body, other body or plane index): (secondary nodes, kind of limit)}, planes, from the resolved case."""
    pairs, planes = {}, []
    for contact in manifest["case"]["contacts"]:
        body = contact["secondary"].split(".")[0]
        nodes = {n for path in manifest["sides"][contact["secondary"]] for n in path}
        if not {"plane", "side"} & set(contact["primary"]) or contact.get("motion", "fixed") != "fixed":
            raise ValueError(f"contact {contact['name']}: only sides and fixed planes are checked")
        if "plane" in contact["primary"]:
            spec = contact["primary"]["plane"]
            normal = np.array(spec["normal"]) / np.linalg.norm(spec["normal"])
            key = tuple(np.round([*spec["point"], *normal], 12))
            if key not in [k for k, *_ in planes]:
                planes.append((key, np.array(spec["point"]), normal))
            other = [k for k, *_ in planes].index(key)
        else:
            other = contact["primary"]["side"].split(".")[0]
        declare(pairs, contact, body, other, nodes)
    return pairs, planes


def check(run):
    """Numbers and verdicts of a record, as a dictionary; `wrong` lists what is wrong."""
    run = Path(run)
    manifest = json.loads((run / "manifest.json").read_text())
    pairs, planes = declared(manifest)
    nodes, edges, own, passed, bodies, before, count = {}, {}, {}, {}, None, None, 0
    missing = []
    for time, arrays in frames(run):
        if arrays is None:
            missing.append(f"record: the field of t = {time:.6g} is missing")
            continue
        bodies = bodies or outlines(arrays)
        position = arrays["points"][:, :2] + arrays["displacement"][:, :2]
        count += 1
        if not np.isfinite(position).all():
            passed.setdefault("record: positions that are not finite", time)
            break
        for name, body in bodies.items():
            body.at(position)
            if body.inverted():
                passed.setdefault(f"inverted: a cell of {name}", time)
        for a, one in bodies.items():
            for b, two in bodies.items():
                if a == b:
                    continue
                secondary, kind = pairs.get((a, b), (set(), "exact"))
                depths = pair_depths(one, two, sorted(secondary))
                limit = LIMITS[kind]
                nodes.setdefault((a, b), Worst()).add(depths[0], time, f"nodes of {a} in {b}", limit[0])
                edges.setdefault((a, b), Worst()).add(
                    depths[1], time, f"edges of {a} in {b}", limit[1] + one.sag + two.sag
                )
                if one.extent < two.extent or one.extent == two.extent and a < b:
                    # The centre of a comb or a ring is not in the body itself.
                    if two.inside(one.center[None])[0] and depths[1] > 0 and one.inside(one.center[None])[0]:
                        passed.setdefault(f"through: the centre of {a} is in {b}", time)
                    if before:
                        # Relative to the centre of the larger body, in its shape of both instants.
                        start, end = before[a] - before[b], one.center - two.center
                        now = two.crossings(start + two.center, end + two.center)
                        two.at(previous)
                        then = two.crossings(start + before[b], end + before[b])
                        two.at(position)
                        if now and then and now % 2 == 0 and then % 2 == 0:
                            passed.setdefault(f"through: {a} passes through {b}", time)
            for i, (_, point, normal) in enumerate(planes):
                secondary, kind = pairs.get((a, i), (set(), "exact"))
                depths = plane_depths(one, point, normal, sorted(secondary))
                if not secondary and (a, i) not in nodes and depths[1] > 0:
                    nodes[a, i] = None  # below the plane from the start: not meant for this body
                if nodes.get((a, i), 0) is not None:
                    limit = LIMITS[kind]
                    nodes.setdefault((a, i), Worst()).add(depths[0], time, f"nodes of {a} in plane {i + 1}", limit[0])
                    edges.setdefault((a, i), Worst()).add(
                        depths[1], time, f"edges of {a} in plane {i + 1}", limit[1] + one.sag
                    )
            own.setdefault(a, Worst()).add(one.self_depth(), time, f"{a} in itself", SELF_LIMIT)
        before, previous = {name: body.center for name, body in bodies.items()}, position
    created, recorded = energy(run)
    unbalanced = momentum(run, manifest["case"])
    classes = {"nodes": [w for w in nodes.values() if w], "edges": list(edges.values()), "self": list(own.values())}
    result = {"fields": count, "created": created, "created_recorded": recorded, "momentum": unbalanced, "wrong": []}
    result["initial"] = max([w.first for ws in classes.values() for w in ws if w.first] or [0.0])
    for name, all_of in classes.items():
        result[name] = max([w.depth for w in all_of] or [0.0])
        for w in sorted(all_of, key=lambda w: w.limit - w.depth):
            if w.depth > w.limit:
                result["wrong"].append(f"{name}: {w.what}: {w.depth:.3g} h at t = {w.time:.6g} (limit {w.limit:.3g})")
    result["wrong"] += [f"{what} at t = {t:.6g}" for what, t in passed.items()] + missing
    if count < 2 and manifest["status"] == "finished":
        result["wrong"].append(f"record: {count} fields, and at least 2 are needed")
    result["warnings"] = sorted({w["id"] for w in manifest.get("warnings") or []})
    contact = run / "contact.csv"
    result["contacts"] = max(0, len(contact.read_text().splitlines()) - 1) if contact.exists() else 0
    marked = "energy-created" in result["warnings"]
    result["marked"] = marked or manifest["status"] == "failed" and "energy was created" in (manifest.get("reason") or "")
    if not np.isfinite(created):
        result["wrong"].append("energy: not finite")
    if created > CREATED_LIMIT and not result["marked"]:
        result["wrong"].append(f"energy: {100 * created:.3g} % created (the record says {100 * recorded:.3g} %)")
    if unbalanced is not None and unbalanced > 1e-6:
        result["wrong"].append(f"momentum: change and contact impulse differ by {unbalanced:.3g} of the momentum")
    result["status"], result["reason"] = manifest["status"], manifest.get("reason") or ""
    return result
