"""Judges of the aligned ladder (aligned_cases.py): what must hold in the record of a case by symmetry,
balance or a closed solution. Nothing here knows an earlier result of Carom. Reads only the run
directory (Python 3, numpy).

For every case, without a claim:

    field     field_check.py or field_check_space.py: nothing penetrates, passes through, is inverted;
              momentum. Not in dimension 1, nor where the claims say why
    energy    total − external_work rises above its running minimum by at most 1e-3 of the scale with
              schemes that dissipate or conserve, 2e-2 with those that may create energy where contact
              opens and closes (CREATES); load steps: not judged

A claim is {"judge": NAME, …}. `limit` is absolute where nothing else is said.

    touches       some row has an active contact: the case is not vacuous
    free          no row has one
    flight        before the first contact, and after the last, the velocities of bodies without
                  supports and gravity are constant (1e-8 of the largest velocity)
    still         |velocity| of a body along an axis ≤ limit × scale
    steady        velocity of a body along an axis = value, until a time
    slows         the same, = value − rate × time
    coulomb       tangential contact impulse = μ × normal one (limit: relative to it). In space nodes slip
                  in directions that differ by the strain, so that their sum is smaller by its square
    newton        mass × change of velocity of a body = ± contact impulse, 1e-6 of mass × velocity,
                  25 rows after the last contact, and with the schemes in SHARP in every row
    conserved     a component of momentum is constant (limit: relative to the largest momentum)
    rebound       a body does not leave faster than it came
    rebound-pair  of two equal bars the relative velocity is reversed: at most that of before, at least
                  `low` of it, half of this with damped schemes; they have parted
    apart-end     no contact is active at the end
    last          the last value of a column = value (`sign` false: absolute values)
    center        the centre of the forces of a contact in the last row = value
    even          the pressures of a contact in the last row = value, or each other (limit: relative)
    apart         gap + upper − lower ≥ −limit in every row: two points do not pass each other
    corner        a point of a rigid corner is not deeper than limit in a body at the end
    rest          kinetic energy ≤ limit × strain energy
    agree         columns are those of the twin, times a factor (limit: relative to the range of all
                  columns of the kind); `turn`: vectors are turned back by this angle; `offset`: added
"""

import csv
import json
import re
from math import cos, radians, sin
from pathlib import Path

import numpy as np

import field_check
import field_check_space
import field_judge

# Schemes that may create energy when contact opens and closes within a step, or in non-linear
# motion.
CREATES = {"chung-hulbert", "hht", "wbz", "newmark", "hu", "generalized-alpha", "central-difference", "paoli-schatzman", "nonsmooth-generalized-alpha", "bdf2"}
# Those of which the velocities contain all momentum at the end of every step.
SHARP = {"bathe", "tr-bdf2", "backward-euler", "energy-momentum", "moreau-jean"}
DAMPED = {"hu", "backward-euler", "bdf2", "moreau-jean", "nonsmooth-generalized-alpha", "paoli-schatzman", "wbz"}
# Names of warnings, or words in them, that tell of a violation that a judge finds.
DEEP = ("undeclared-contact", "penetration", "deep", "overlap")
SAYS = {"energy": ("energy-created", "hidden-energy")} | dict.fromkeys(
    ("field", "corner", "apart", "nodes", "edges", "self"), DEEP
)
# Rows after a contact from which the velocities of an α scheme contain all momentum.
AFTER = 25


class Record:
    """A run directory: its manifest, the columns of history.csv, the rows of contact.csv."""

    def __init__(self, run):
        self.run = Path(run)
        self.manifest = json.loads((self.run / "manifest.json").read_text())
        self.case = self.manifest["case"]
        self.scheme = self.case["time"]["scheme"]["kind"]
        self.rows, self.column = field_judge.history(self.run)
        self.time, self.active = self.column("time"), self.column("active")
        self.axes = "xyz"[: self.case["dimension"]]

    def velocity(self, body, axis):
        return self.column(f"{body}.velocity_{axis}")

    def vector(self, name):
        return np.array([self.column(f"{name}_{a}") for a in self.axes])

    def contacts(self, name):
        """Rows of a contact in the last recorded step of contact.csv."""
        with (self.run / "contact.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        rows = [r for r in rows if r["contact"] == name and float(r["multiplier"]) != 0]
        last = max((int(r["step"]) for r in rows), default=0)
        return [r for r in rows if int(r["step"]) == last]

    def free_bodies(self):
        held = {side.split(".")[0] for s in self.case["supports"] for side in s["on"]}
        return [b["name"] for b in self.case["bodies"] if b["name"] not in held and not any(np.atleast_1d(b["gravity"]) != 0)]

    def fastest(self):
        """Largest velocity of a body's centre."""
        found = [np.linalg.norm([self.velocity(b["name"], a) for a in self.axes], axis=0).max() for b in self.case["bodies"]]
        return max(*found, 1e-300) if len(found) > 1 else max(found[0], 1e-300)

    def touching(self):
        """Rows with contact; a scheme with substeps may have had contact in a step that ends without."""
        push = np.abs(np.diff(self.vector("contact_impulse"), axis=1, prepend=0.0)).max(0)
        return np.flatnonzero((self.active > 0) | (push > 0))

    def parted(self):
        """Index of the first row that is AFTER rows after the last active contact."""
        touching = np.flatnonzero(self.active > 0)
        return int(touching[-1]) + 1 + AFTER if len(touching) else 0


def worst(difference, time, limit, what):
    """A violation at the row of the largest difference, or none."""
    difference = np.abs(difference)
    if not len(difference):
        return []
    if not np.isfinite(difference).all():
        return [f"{what}: not finite"]
    k = int(difference.argmax())
    return [f"{what} by {difference[k]:.3g} at t = {time[k]:.6g} (limit {limit:.3g})"] if difference[k] > limit else []


# Judges: each returns the violations that it finds.


def touches(record, claim, twin):
    return [] if (record.active > 0).any() else ["no contact is ever active"]


def free(record, claim, twin):
    return ["a contact is active"] if (record.active > 0).any() else []


def flight(record, claim, twin):
    touching, found = record.touching(), []
    first = int(touching[0]) if len(touching) else len(record.time)
    scale = record.fastest()
    for body in record.free_bodies():
        for axis in record.axes:
            v = record.velocity(body, axis)
            found += worst(v[:first] - v[0], record.time, 1e-8 * scale, f"velocity_{axis} of {body} changes before contact")
            after = record.parted()
            found += worst(v[after:] - v[after : after + 1], record.time[after:], 1e-8 * scale, f"velocity_{axis} of {body} changes after contact")
    return found


def still(record, claim, twin):
    v = record.velocity(claim["body"], claim["axis"]) / claim["scale"]
    return worst(v, record.time, claim["limit"], f"{claim['body']} moves along {claim['axis']}, relative to its normal velocity,")


def steady(record, claim, twin):
    now = record.time <= claim["until"]
    v = record.velocity(claim["body"], claim["axis"])[now]
    return worst(v - claim["value"], record.time, claim["limit"], f"velocity_{claim['axis']} of {claim['body']} differs from {claim['value']}")


def slows(record, claim, twin):
    now = record.time <= claim["until"]
    v = record.velocity(claim["body"], claim["axis"])[now]
    expected = claim["value"] - claim["rate"] * record.time[now]
    return worst(v - expected, record.time, claim["limit"], f"velocity_{claim['axis']} of {claim['body']} differs from that of friction")


def coulomb(record, claim, twin):
    impulse = record.vector("contact_impulse")
    normal, tangential = np.abs(impulse[-1]), np.linalg.norm(impulse[:-1], axis=0)
    late = normal > 0.05 * normal.max()
    share = (tangential - claim["mu"] * normal)[late] / normal[late]
    return worst(share, record.time[late], claim["limit"], "friction impulse over normal impulse differs from mu")


def newton(record, claim, twin):
    v = np.array([record.velocity(claim["body"], a) for a in claim["axes"]])
    j = record.vector("contact_impulse")[["xyz".index(a) for a in claim["axes"]]]
    start = 0 if record.scheme in SHARP else record.parted()
    change = claim["mass"] * (v - v[:, :1])
    differs = min((np.abs(change - sign * j).max(0)[start:] for sign in (1, -1)), key=lambda d: d.max(initial=0))
    return worst(differs / (claim["mass"] * record.fastest()), record.time[start:], 1e-6, f"momentum of {claim['body']} and contact impulse differ, relatively,")


def conserved(record, claim, twin):
    p = record.vector("momentum")
    mine = p[record.axes.index(claim["axis"])]
    return worst((mine - mine[0]) / max(np.abs(p).max(), 1e-300), record.time, claim["limit"], f"momentum_{claim['axis']} changes, relatively,")


def rebound(record, claim, twin):
    if record.active[-1] > 0:
        return []
    after = record.velocity(claim["body"], claim["axis"])[-1] / -claim["before"]
    return [f"{claim['body']} leaves {after:.5g} times as fast as it came"] if after > 1.001 else []


def rebound_pair(record, claim, twin):
    if record.active[-1] > 0:
        return ["the bars are still in contact"]
    ratio = (record.velocity(claim["b"], claim["axis"])[-1] - record.velocity(claim["a"], claim["axis"])[-1]) / claim["before"]
    low = claim["low"] * (0.5 if record.scheme in DAMPED else 1.0)
    return [] if low <= ratio <= 1.001 else [f"relative velocity after, over that before: {ratio:.4g} (limits {low:.3g}, 1.001)"]


def apart_end(record, claim, twin):
    return ["contact is active at the end"] if record.active[-1] > 0 else []


def last(record, claim, twin):
    value = record.column(claim["column"])[-1]
    differs = abs(value) - abs(claim["value"]) if claim.get("sign") is False else value - claim["value"]
    if abs(differs) <= claim["limit"]:
        return []
    return [f"last {claim['column']} is {value:.9g}, not {claim['value']:.9g} (limit {claim['limit']:.3g})"]


def center(record, claim, twin):
    rows = record.contacts(claim["contact"])
    force = np.array([float(r["multiplier"]) for r in rows])
    if not force.sum():
        return [f"{claim['contact']} has no force"]
    x = np.array([float(r[claim["axis"]]) for r in rows])
    value = float((x * force).sum() / force.sum())
    return [f"the forces of {claim['contact']} have their centre at {value:.6g}, not {claim['value']}"] if abs(value - claim["value"]) > claim["limit"] else []


def even(record, claim, twin):
    p = np.array([float(r["pressure"]) for r in record.contacts(claim["contact"])])
    if not len(p):
        return [f"{claim['contact']} has no pressure"]
    value = claim["value"]
    if value is None:
        value, limit = p.mean(), claim["limit"] * abs(p.mean())
    else:
        limit = claim["limit"]
    k = int(np.abs(p - value).argmax())
    return [f"pressure {p[k]:.6g} where it is uniform, {value:.6g}"] if abs(p[k] - value) > limit else []


def apart(record, claim, twin):
    gap = claim["gap"] + record.column(claim["upper"]) - record.column(claim["lower"])
    return worst(np.minimum(gap, 0.0), record.time, claim["limit"], "points that face each other pass each other")


def corner(record, claim, twin):
    position, bodies = None, {}
    for _, arrays in field_judge.frames(record.run):
        reference = arrays["points"][:, :2]
        bodies = bodies or {name: field_check.Outline(cells, reference) for name, cells in field_judge.bodies_of(arrays)}
        position = reference + arrays["displacement"][:, :2]
    body = bodies[claim["body"]]
    body.at(position)
    point = np.array([claim["at"]]) + np.array([claim["move"]])
    if not body.inside(point)[0]:
        return []
    depth = float(body.distance(point)[0][0])
    return [f"a rigid corner is {depth:.3g} deep in {claim['body']} (limit {claim['limit']:.3g})"] if depth > claim["limit"] else []


def rest(record, claim, twin):
    strain = max(record.column("strain").max(), 1e-300)
    return worst(record.column("kinetic") / strain, record.time, claim["limit"], "kinetic energy at rest, relative to strain energy,")


def agree(record, claim, twin):
    if twin is None:
        return ["the twin has no record"]
    if len(twin.time) != len(record.time):
        return [f"{len(record.time)} rows, and the twin has {len(twin.time)}"]
    mine = {name: record.column(name) for name in claim["columns"]}
    for name, more in claim.get("offset", {}).items():
        mine[name] = mine[name] - more
    if "turn" in claim:
        x, y = (next(n for n in mine if n.endswith(f"velocity_{a}")) for a in "xy")
        c, s = cos(radians(claim["turn"])), sin(radians(claim["turn"]))
        mine[x], mine[y] = c * mine[x] + s * mine[y], c * mine[y] - s * mine[x]
    kinds = {name: "velocity" if "velocity" in name else name for name in mine}
    scale = {}
    for name, factor in claim["columns"].items():
        size = abs(factor) * np.abs(twin.column(name)).max()
        scale[kinds[name]] = max(scale.get(kinds[name], 1e-300), size)
    found = []
    for name, factor in claim["columns"].items():
        differs = (mine[name] - factor * twin.column(name)) / scale[kinds[name]]
        found += worst(differs, record.time, claim["limit"], f"{name} differs from that of the twin, relatively,")
    return found


JUDGES = {
    f.__name__.replace("_", "-"): f
    for f in (touches, free, flight, still, steady, slows, coulomb, newton, conserved, rebound, rebound_pair, apart_end, last, center, even, apart, corner, rest, agree)
}


def energy(record):
    """Energy that a scheme may not create."""
    if record.scheme == "static":
        return []
    created, _ = field_judge.energy(record.run)
    limit = 2e-2 if record.scheme in CREATES else 1e-3
    return [] if created <= limit else [f"{created:.3g} of the energy is created (limit {limit})"]


class Plane(field_check.Plane):
    def itself(self, a, time):
        """No body of an aligned case folds."""


class Space(field_check_space.Space):
    def itself(self, a, time):
        """No body of an aligned case folds."""


def field(record):
    """Violations that the independent check of the fields finds, but for that of energy."""
    check = Space if record.case["dimension"] == 3 else Plane
    return [w for w in check(record.run).result()["wrong"] if not w.startswith("energy:")]


def violations(run, claims, twin=None, look=True):
    """{judge: what is violated} of the record of a finished run."""
    record = Record(run)
    other = Record(twin) if twin else None
    found = {"energy": energy(record)}
    if look and record.case["dimension"] > 1:
        found["field"] = field(record)
    for claim in claims:
        found.setdefault(claim["judge"], []).extend(JUDGES[claim["judge"]](record, claim, other))
    if not np.isfinite(record.column("total")).all():
        found["energy"].append("not finite")
    return {judge: what for judge, what in found.items() if what}


def outcome(found, warnings):
    """right, warned or wrong. Warned: every violation is of a kind that a warning with a place tells of."""
    if not found:
        return "right"
    placed = [w["id"] for w in warnings if re.search(r"node|\(|t = ", str(w))]
    told = all(any(word in name for name in placed for word in SAYS.get(judge, ())) for judge in found)
    return "warned" if told else "wrong"
