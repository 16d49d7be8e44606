"""Independent check of a record in space, as field_check.py is for the plane: do bodies penetrate each
other or rigid planes and spheres, pass through, turn inside out; are momentum and energy right?
Used by ladder.py; reads only the run directory (Python 3, numpy).

Geometry. The skin of a body is the set of faces of cells that belong to one cell: the polynomials of
degree p through their nodes. They are sampled at the points with coordinates k/6, along sharp edges at
k/24, and divided at the former into flat triangles; a flat face of three nodes is one triangle. The length h of a face is that of its
longest side between corners in the reference configuration, but at most 6V/A of its own body and of
the other, with its volume V and surface A (the edge of a cube, three thicknesses of a plate).

Penetration, for every ordered pair (A, B) of bodies and every written field: the winding number of B
about a point of A is the number of triangles through which a ray leaves B less that through which it
enters. The point is inside where it is positive along two rays. Its depth is its distance to the
triangles of B. As in the plane there are two classes of points, with the same limits on depth/h:

    nodes   nodes of A that a contact declares as secondary to B, which the contact law keeps outside
            exactly; h of the face of B that is penetrated
    edges   all other nodes of A, and the sampled points on its faces and their edges; h the larger of
            the face of B that is penetrated and the own one. To the limit the sag s_A + s_B is
            added that node-to-facet contact of curved or kinked faces cannot avoid: s = θ/(4 p²),
            where θ is the largest angle between normals at two corners of a face, plus the
            kink to the next face. A square between four points of a sphere has the sag θh/4, and so
            has a face that straddles a kink of θ. Kinks above 35 degrees are edges and do not count.

Rigid planes and spheres: depth below their surface, relative to the own face, with the same limits; the
sag of a face outside a sphere of radius R, h/(4 R p²), is added. They are checked for their secondary
bodies. Other obstacles, and those that move, are refused (ValueError).

A body crosses itself if its winding number about a point 0.1 h below the surface is 2 or more.

Inverted: the determinant of a cell's map is not positive at one of the points with coordinates k/4
(tetrahedra: k/6).

Passing through: as in the plane, by the path of the centre of the smaller body between two fields.

Momentum P and angular momentum L of the written velocities v, with the mass matrix formed here by
quadrature over the reference cells (or the sums of HRZ, if the case says so): without supports and
loads, components of P on which neither gravity nor an obstacle acts must not change by more than 1e-6
of Σ m|v|; with energy–momentum and without obstacles and gravity, L not by more than 1e-6 of
Σ m|x||v|, about the centre of mass. P must be that of history.csv.

Energy, and momentum with rigid planes: from history.csv, as in the plane.
"""

import json
from pathlib import Path

import numpy as np

from field_check import CREATED_LIMIT, LIMITS, Worst, declare, energy, frames, history, momentum
from field_skin import skins

BALANCE = 1e-6


def largest(x):
    return float(x.max()) if len(x) else 0.0


def near_points(a, low, high):
    """Sampled points of the faces and sharp edges of A whose boxes meet a box, and their h."""
    points, own = [], []
    for samples, h in ((a.samples, a.h), (a.edges, a.h[a.sharp[:, 0]])):
        hit = ((samples.min(1) <= high) & (samples.max(1) >= low)).all(1)
        points.append(samples[hit].reshape(-1, 3))
        own.append(np.repeat(h[hit], samples.shape[1]))
    return np.concatenate(points), np.concatenate(own)


def pair_depths(a, b, secondary):
    """(nodes, edges): largest depth/h of A's points in B, by class; `secondary`: nodes of A."""
    if (a.low > b.high).any() or (b.low > a.high).any():
        return 0.0, 0.0
    thick = min(a.thick, b.thick)
    points, own = near_points(a, b.low, b.high)
    x = a.position[a.nodes]
    exact = np.concatenate([np.isin(a.nodes, secondary), np.zeros(len(points), bool)])
    points, own = np.concatenate([x, points]), np.concatenate([a.h[a.node_face], own])
    found = np.flatnonzero(b.inside(points))
    depth, face = b.distance(points[found])
    mine = exact[found]
    limit = np.minimum(b.h[face], thick)
    nodes = largest((depth / limit)[mine])
    edges = largest((depth / np.minimum(np.maximum(b.h[face], own[found]), thick))[~mine])
    return nodes, edges


def obstacle_depths(a, depth_of, secondary):
    exact = np.isin(a.nodes, secondary)
    h = np.minimum(a.h, a.thick)
    at_nodes = depth_of(a.position[a.nodes]) / h[a.node_face]
    at_faces = depth_of(a.samples).max(1) / h
    return max(0.0, largest(at_nodes[exact])), max(0.0, largest(np.concatenate([at_faces, at_nodes[~exact]])))


def declared(manifest, bodies):
    """{(body, other body or number of obstacle): (secondary nodes, kind of limit)}, obstacles."""
    pairs, obstacles = {}, []
    for contact in manifest["case"]["contacts"]:
        body, side = contact["secondary"].split(".")
        nodes = {n for path in manifest["sides"].get(contact["secondary"], []) for n in path}
        nodes = nodes if side != "skin" else set(bodies[body].nodes.tolist())
        primary = contact["primary"]
        if not {"plane", "circle", "side"} & set(primary) or contact.get("motion", "fixed") != "fixed":
            raise ValueError(f"contact {contact['name']}: only sides, fixed planes and spheres are checked")
        if "side" in primary:
            other = primary["side"].split(".")[0]
        else:
            spec = primary.get("plane") or primary["circle"]  # a sphere, in space
            if spec not in obstacles:
                obstacles.append(spec)
            other = obstacles.index(spec)
        declare(pairs, contact, body, other, nodes)
    return pairs, obstacles


def depth_below(spec):
    """Depth of points below the surface of an obstacle, and the radius outside of which bodies are, or 0."""
    if "normal" in spec:
        point, normal = np.array(spec["point"]), np.array(spec["normal"]) / np.linalg.norm(spec["normal"])
        return lambda x: -(x - point) @ normal, 0.0
    center, radius, sign = np.array(spec["center"]), spec["radius"], -1.0 if spec.get("inside") else 1.0
    return lambda x: sign * (radius - np.linalg.norm(x - center, axis=-1)), 0.0 if spec.get("inside") else radius


class Balance:
    """Momentum and angular momentum of the fields, and of what may not change the largest change."""

    def __init__(self, case, obstacles):
        density = {m["name"]: m["density"] for m in case["materials"]}
        self.of = {b["name"]: (density[b["material"]], b["mass"] == "lumped") for b in case["bodies"]}
        held = bool(case["supports"] or case["loads"])
        acting = [b["gravity"] for b in case["bodies"] if any(b["gravity"])]
        rough = any(c["friction"]["mu"] or c["friction"]["shear"] for c in case["contacts"] if "side" not in c["primary"])
        acting += [spec["normal"] for spec in obstacles if "normal" in spec]
        if held or rough or any("radius" in spec for spec in obstacles):
            acting = np.eye(3)
        self.free = np.eye(3)
        for direction in acting:
            d = self.free @ np.array(direction, float)
            if np.linalg.norm(d) > 1e-9 * np.linalg.norm(direction):
                d /= np.linalg.norm(d)
                self.free = self.free - np.outer(d, d)
        self.whole = not len(acting) and case["time"]["scheme"]["kind"] == "energy-momentum"
        self.first, self.drift, self.turn, self.rows = None, 0.0, 0.0, []

    def add(self, bodies, time, position, velocity):
        m, x, v = (np.concatenate(part) for part in zip(*(s.moments(position, velocity, *self.of[n]) for n, s in bodies.items())))
        center = (m[:, None] * x).sum(0) / m.sum()
        p = (m[:, None] * v).sum(0)
        l = (m[:, None] * np.cross(x - center, v)).sum(0)
        size = (m * np.linalg.norm(v, axis=1)).sum()
        turn = (m * np.linalg.norm(x - center, axis=1) * np.linalg.norm(v, axis=1)).sum()
        self.rows.append((time, *p))
        if self.first is None:
            self.first, self.size, self.turn_size = (p, l), size, turn
        self.size, self.turn_size = max(self.size, size), max(self.turn_size, turn)
        self.drift = max(self.drift, np.linalg.norm(self.free @ (p - self.first[0])))
        self.turn = max(self.turn, np.linalg.norm(l - self.first[1]) if self.whole else 0.0)

    def result(self, column):
        """(relative changes of P and L, difference from the record)."""
        size, turn = (max(s, 1e-300) for s in (self.size, self.turn_size))
        rows, times = np.array(self.rows), column("time")
        recorded = np.column_stack([column(f"momentum_{i}") for i in "xyz"])
        at = np.abs(times[None] - rows[:, :1]).argmin(1)
        differ = np.abs(recorded[at] - rows[:, 1:]).max() / size
        return self.drift / size, self.turn / turn, differ


def check(run):
    """Numbers and verdicts of a record, as a dictionary; `wrong` lists what is wrong."""
    run = Path(run)
    manifest = json.loads((run / "manifest.json").read_text())
    case = manifest["case"]
    bodies, before, count, passed, missing = None, None, 0, {}, []
    nodes, edges = {}, {}
    for time, arrays in frames(run):
        if arrays is None:
            missing.append(f"record: the field of t = {time:.6g} is missing")
            continue
        if bodies is None:
            bodies = skins(arrays)
            pairs, obstacles = declared(manifest, bodies)
            balance = Balance(case, obstacles)
        position = arrays["points"] + arrays["displacement"]
        count += 1
        if not (np.isfinite(position).all() and np.isfinite(arrays["velocity"]).all()):
            passed.setdefault("record: positions or velocities that are not finite", time)
            break
        for name, body in bodies.items():
            body.at(position)
            if body.inverted():
                passed.setdefault(f"inverted: a cell of {name}", time)
            if (body.winding(body.below()) > 1).any():
                passed.setdefault(f"self: {name} crosses itself", time)
        balance.add(bodies, time, position, arrays["velocity"])
        for a, one in bodies.items():
            for b, two in bodies.items():
                if a == b:
                    continue
                secondary, kind = pairs.get((a, b), (set(), "exact"))
                depths, limit = pair_depths(one, two, sorted(secondary)), LIMITS[kind]
                nodes.setdefault((a, b), Worst()).add(depths[0], time, f"nodes of {a} in {b}", limit[0])
                edges.setdefault((a, b), Worst()).add(depths[1], time, f"edges of {a} in {b}", limit[1] + one.sag + two.sag)
                if one.extent < two.extent or one.extent == two.extent and a < b:
                    if two.inside(one.center[None])[0] and one.inside(one.center[None])[0]:
                        passed.setdefault(f"through: the centre of {a} is in {b}", time)
                    if before:
                        start, end = before[a] - before[b], one.center - two.center
                        now = two.meets(start + two.center, end + two.center)
                        two.at(previous)
                        then = two.meets(start + before[b], end + before[b])
                        two.at(position)
                        if now and then and now % 2 == 0 and then % 2 == 0:
                            passed.setdefault(f"through: {a} passes through {b}", time)
            for i, spec in enumerate(obstacles):
                if (a, i) in pairs:
                    secondary, kind = pairs[a, i]
                    depth, radius = depth_below(spec)
                    depths, limit = obstacle_depths(one, depth, sorted(secondary)), LIMITS[kind]
                    sag = one.sag + (largest(one.h) / (4 * radius * one.p**2) if radius else 0.0)
                    nodes.setdefault((a, i), Worst()).add(depths[0], time, f"nodes of {a} in obstacle {i + 1}", limit[0])
                    edges.setdefault((a, i), Worst()).add(depths[1], time, f"edges of {a} in obstacle {i + 1}", limit[1] + sag)
        before, previous = {name: body.center for name, body in bodies.items()}, position
    created, recorded = energy(run)
    static = case["time"]["scheme"]["kind"] == "static"
    classes = {"nodes": list(nodes.values()), "edges": list(edges.values())}
    result = {"fields": count, "created": created, "created_recorded": recorded, "self": None, "wrong": []}
    wrong = result["wrong"]
    result["initial"] = max([w.first for ws in classes.values() for w in ws if w.first] or [0.0])
    for name, all_of in classes.items():
        result[name] = max([w.depth for w in all_of] or [0.0])
        for w in sorted(all_of, key=lambda w: w.limit - w.depth):
            if w.depth > w.limit:
                wrong.append(f"{name}: {w.what}: {w.depth:.3g} h at t = {w.time:.6g} (limit {w.limit:.3g})")
    wrong += [f"{what} at t = {t:.6g}" for what, t in passed.items()] + missing
    if count < 2 and manifest["status"] == "finished":
        wrong.append(f"record: {count} fields, and at least 2 are needed")
    warnings = sorted({w["id"] for w in manifest.get("warnings") or []})
    contact = run / "contact.csv"
    result["warnings"] = warnings
    result["contacts"] = max(0, len(contact.read_text().splitlines()) - 1) if contact.exists() else 0
    energy_stop = manifest["status"] == "failed" and "energy was created" in (manifest.get("reason") or "")
    result["marked"] = "energy-created" in warnings or energy_stop
    if not np.isfinite(created):
        wrong.append("energy: not finite")
    if created > CREATED_LIMIT and not result["marked"] and not static:
        wrong.append(f"energy: {100 * created:.3g} % created (the record says {100 * recorded:.3g} %)")
    of_planes = momentum(run, case)
    result["momentum"] = of_planes
    if of_planes is not None and of_planes > BALANCE:
        wrong.append(f"momentum: change and contact impulse differ by {of_planes:.3g} of the momentum")
    if count and not static:
        drift, turn, differ = balance.result(history(run)[1])
        result["momentum"] = max(drift, of_planes or 0.0)
        result["moment"], result["differ"] = turn, differ
        for value, what in ((drift, "momentum: of the fields, changes"), (turn, "moment: of momentum of the fields, changes")):
            if value > BALANCE:
                wrong.append(f"{what} by {value:.3g} of its scale")
        if differ > BALANCE:
            wrong.append(f"record: momentum of the fields differs from history.csv by {differ:.3g}")
    result["status"], result["reason"] = manifest["status"], manifest.get("reason") or ""
    return result
