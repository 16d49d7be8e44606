"""What the independent checks of records in the plane (field_check.py) and in space
(field_check_space.py) share: reading fields, depths, energy and momentum, and the verdicts.
"""

import csv
import html
import json
import re
import xml.etree.ElementTree as xml
from pathlib import Path

import numpy as np

# Limits of depth/h for nodes and edges.
LIMITS = {"exact": (0.05, 0.1), "soft": (0.25, 0.3)}
SELF_LIMIT = 0.1
CREATED_LIMIT = 0.02
BALANCE = 1e-6
# Turns and kinks above this angle are corners and edges.
CORNER = np.radians(35.0)
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


def frames(run):
    """(time, arrays) of every written field; no arrays where the file is missing."""
    for entry in xml.parse(run / "fields.pvd").iter("DataSet"):
        path = run / entry.get("file")
        yield float(entry.get("timestep")), read_vtu(path) if path.exists() else None


def bodies_of(arrays):
    """Name and cells of each body."""
    ends, conn = arrays["offsets"], arrays["connectivity"]
    starts = np.concatenate([[0], ends[:-1]])
    for i, name in enumerate(arrays["names"]):
        mine = np.flatnonzero(arrays["body"] == i)
        yield name, np.array([conn[starts[c] : ends[c]] for c in mine])


# Depths


def largest(x):
    return float(x.max()) if len(x) else 0.0


def pair_depths(a, b, secondary):
    """(nodes, edges): largest depth/h of A's points in B, by class; `secondary`: nodes of A."""
    if (a.low > b.high).any() or (b.low > a.high).any():
        return 0.0, 0.0
    thick = min(a.thick, b.thick)
    points, own = a.points_near(b.low, b.high)
    exact = np.concatenate([np.isin(a.nodes, secondary), np.zeros(len(points), bool)])
    points = np.concatenate([a.position[a.nodes], points])
    own = np.concatenate([a.h[a.node_facet], own])
    found = np.flatnonzero(b.inside(points))
    depth, facet = b.distance(points[found])
    mine = exact[found]
    nodes = largest((depth / np.minimum(b.h[facet], thick))[mine])
    edges = largest((depth / np.minimum(np.maximum(b.h[facet], own[found]), thick))[~mine])
    return nodes, edges


def obstacle_depths(a, depth_of, secondary):
    """The same of A's points below the surface of an obstacle."""
    exact = np.isin(a.nodes, secondary)
    h = np.minimum(a.h, a.thick)
    at_nodes = depth_of(a.position[a.nodes]) / h[a.node_facet]
    at_facets = depth_of(a.samples).max(1) / h
    return max(0.0, largest(at_nodes[exact])), max(0.0, largest(np.concatenate([at_facets, at_nodes[~exact]])))


def depth_below(spec):
    """Depth of points below the surface of an obstacle, and the radius outside of which bodies are, or 0."""
    if "normal" in spec:
        point, normal = np.array(spec["point"]), np.array(spec["normal"]) / np.linalg.norm(spec["normal"])
        return lambda x: -(x - point) @ normal, 0.0
    center, radius, sign = np.array(spec["center"]), spec["radius"], -1.0 if spec.get("inside") else 1.0
    return lambda x: sign * (radius - np.linalg.norm(x - center, axis=-1)), 0.0 if spec.get("inside") else radius


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


# Energy and momentum


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


# Verdicts


class Judge:
    """Follows the fields of a record and says what is wrong. A subclass knows the geometry: the number of
    axes, the kinds of primary that it checks, the outline of a body from its cells and reference
    positions, and how a body may cross itself."""

    AXES = 0
    PRIMARY = ()
    outline = None

    def __init__(self, run):
        self.run = Path(run)
        self.manifest = json.loads((self.run / "manifest.json").read_text())
        self.case = self.manifest["case"]
        self.static = self.case["time"]["scheme"]["kind"] == "static"
        self.bodies = None
        self.centers = None
        self.previous = None
        self.count = 0
        self.missing = []
        self.seen = {}
        self.classes = {"nodes": {}, "edges": {}, "self": {}}

    def saw(self, what, time):
        """Notes what must not be at any instant; the first one is reported."""
        self.seen.setdefault(what, time)

    def deepest(self, of, key, depth, time, what, limit):
        self.classes[of].setdefault(key, Worst()).add(depth, time, what, limit)

    def declare(self):
        """Sets `pairs`, {(body, other body or number of obstacle): (secondary nodes, kind of limit)}, and
        `obstacles`."""
        self.pairs = {}
        self.obstacles = []
        for contact in self.case["contacts"]:
            body, side = contact["secondary"].split(".")
            primary = contact["primary"]
            if not set(self.PRIMARY) & set(primary) or contact.get("motion", "fixed") != "fixed":
                raise ValueError(f"contact {contact['name']}: only fixed {', '.join(self.PRIMARY)} are checked")
            nodes = {n for path in self.manifest["sides"].get(contact["secondary"], []) for n in path}
            if side == "skin":
                nodes = set(self.bodies[body].nodes.tolist())
            if "side" in primary:
                other = primary["side"].split(".")[0]
            else:
                spec = primary.get("plane") or primary["circle"]  # a sphere, in space
                if spec not in self.obstacles:
                    self.obstacles.append(spec)
                other = self.obstacles.index(spec)
            soft = contact["enforcement"] == "penalty" or contact.get("law") == "velocity"
            kind = "soft" if soft else "exact"
            old, _ = self.pairs.get((body, other), (set(), kind))
            self.pairs[body, other] = (old | nodes, kind)
            if "side" in primary:
                self.pairs.setdefault((other, body), (set(), kind))

    def result(self):
        """Numbers and verdicts, as a dictionary; `wrong` lists what is wrong."""
        for time, arrays in frames(self.run):
            if arrays is None:
                self.missing.append(f"record: the field of t = {time:.6g} is missing")
                continue
            reference = arrays["points"][:, : self.AXES]
            if self.bodies is None:
                self.bodies = {name: self.outline(cells, reference) for name, cells in bodies_of(arrays)}
                self.declare()
            position = reference + arrays["displacement"][:, : self.AXES]
            velocity = arrays.get("velocity", position)
            self.count += 1
            if not (np.isfinite(position).all() and np.isfinite(velocity).all()):
                self.saw("record: positions or velocities that are not finite", time)
                break
            self.follow(time, position)
            self.balance(time, position, velocity)
        return self.verdict()

    def follow(self, time, position):
        """Looks at the bodies at one instant."""
        for name, body in self.bodies.items():
            body.at(position)
            if body.inverted():
                self.saw(f"inverted: a cell of {name}", time)
        for a in self.bodies:
            for b in self.bodies:
                if a != b:
                    self.pair(a, b, time, position)
            for number, spec in enumerate(self.obstacles):
                self.obstacle(a, number, spec, time)
            self.itself(a, time)
        self.centers = {name: body.center for name, body in self.bodies.items()}
        self.previous = position

    def pair(self, a, b, time, position):
        one = self.bodies[a]
        two = self.bodies[b]
        secondary, kind = self.pairs.get((a, b), (set(), "exact"))
        of_nodes, of_edges = pair_depths(one, two, sorted(secondary))
        nodes, edges = LIMITS[kind]
        self.deepest("nodes", (a, b), of_nodes, time, f"nodes of {a} in {b}", nodes)
        self.deepest("edges", (a, b), of_edges, time, f"edges of {a} in {b}", edges + one.sag + two.sag)
        if one.extent > two.extent or one.extent == two.extent and a > b:
            return
        # The centre of a comb or a ring is not in the body itself.
        if two.inside(one.center[None])[0] and one.inside(one.center[None])[0]:
            self.saw(f"through: the centre of {a} is in {b}", time)
        if self.centers:
            # Relative to the centre of the larger body, in its shape of both instants.
            start = self.centers[a] - self.centers[b]
            end = one.center - two.center
            now = two.meets(start + two.center, end + two.center)
            two.at(self.previous)
            then = two.meets(start + self.centers[b], end + self.centers[b])
            two.at(position)
            if now and then and now % 2 == 0 and then % 2 == 0:
                self.saw(f"through: {a} passes through {b}", time)

    def obstacle(self, a, number, spec, time):
        """Looks at a body that an obstacle keeps out."""
        if (a, number) not in self.pairs:
            return
        body = self.bodies[a]
        secondary, kind = self.pairs[a, number]
        depth_of, radius = depth_below(spec)
        of_nodes, of_edges = obstacle_depths(body, depth_of, sorted(secondary))
        nodes, edges = LIMITS[kind]
        sag = body.sag + (largest(body.h) / (4 * radius * body.p**2) if radius else 0.0)
        self.deepest("nodes", (a, number), of_nodes, time, f"nodes of {a} in obstacle {number + 1}", nodes)
        self.deepest("edges", (a, number), of_edges, time, f"edges of {a} in obstacle {number + 1}", edges + sag)

    def itself(self, a, time):
        """Looks whether a body crosses itself."""
        raise NotImplementedError

    def balance(self, time, position, velocity):
        """Looks at the velocities of one instant."""

    def verdict(self):
        created, recorded = energy(self.run)
        unbalanced = momentum(self.run, self.case)
        result = {"fields": self.count, "created": created, "created_recorded": recorded, "momentum": unbalanced}
        wrong = []
        every = [worst for of in self.classes.values() for worst in of.values()]
        result["initial"] = max([worst.first for worst in every if worst.first] or [0.0])
        for name, of in self.classes.items():
            result[name] = max([worst.depth for worst in of.values()] or [0.0])
            for worst in sorted(of.values(), key=lambda worst: worst.limit - worst.depth):
                if worst.depth > worst.limit:
                    found = f"{worst.depth:.3g} h at t = {worst.time:.6g} (limit {worst.limit:.3g})"
                    wrong.append(f"{name}: {worst.what}: {found}")
        wrong += [f"{what} at t = {time:.6g}" for what, time in self.seen.items()]
        wrong += self.missing
        if self.count < 2 and self.manifest["status"] == "finished":
            wrong.append(f"record: {self.count} fields, and at least 2 are needed")
        contact = self.run / "contact.csv"
        reason = self.manifest.get("reason") or ""
        result["status"] = self.manifest["status"]
        result["reason"] = reason
        result["warnings"] = sorted({warning["id"] for warning in self.manifest.get("warnings") or []})
        result["contacts"] = max(0, len(contact.read_text().splitlines()) - 1) if contact.exists() else 0
        energy_stop = self.manifest["status"] == "failed" and "energy was created" in reason
        result["marked"] = "energy-created" in result["warnings"] or energy_stop
        if not np.isfinite(created):
            wrong.append("energy: not finite")
        if created > CREATED_LIMIT and not result["marked"] and not self.static:
            wrong.append(f"energy: {100 * created:.3g} % created (the record says {100 * recorded:.3g} %)")
        if unbalanced is not None and unbalanced > BALANCE:
            wrong.append(f"momentum: change and contact impulse differ by {unbalanced:.3g} of the momentum")
        return result | {"wrong": wrong}
