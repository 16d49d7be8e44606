"""Independent check of a record in space, as field_check.py is for the plane: do bodies penetrate each
other or rigid planes and spheres, pass through, turn inside out; are momentum and energy right?
Used by ladder.py; reads only the run directory (Python 3, numpy).

Geometry. The skin of a body is the set of faces of cells that belong to one cell: the polynomials of
degree p through their nodes. They are sampled at the points with coordinates k/6, along sharp edges at
k/24, and divided at the former into flat triangles; a flat face of three nodes is one triangle. The
length h of a face is that of its longest side between corners in the reference configuration, but at
most 6V/A of its own body and of the other, with its volume V and surface A (the edge of a cube, three
thicknesses of a plate).

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

import numpy as np

from field_judge import BALANCE, Judge, history
from field_skin import Skin


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


class Space(Judge):
    AXES = 3
    PRIMARY = ("side", "plane", "circle")
    outline = Skin

    def itself(self, a, time):
        body = self.bodies[a]
        if (body.winding(body.below()) > 1).any():
            self.saw(f"self: {a} crosses itself", time)

    def declare(self):
        super().declare()
        self.moments = Balance(self.case, self.obstacles)

    def balance(self, time, position, velocity):
        self.moments.add(self.bodies, time, position, velocity)

    def verdict(self):
        result = super().verdict()
        # A body that crosses itself is seen, but not measured.
        result["self"] = None
        if not self.count or self.static:
            return result
        drift, turn, differ = self.moments.result(history(self.run)[1])
        result["momentum"] = max(drift, result["momentum"] or 0.0)
        result["moment"] = turn
        result["differ"] = differ
        for value, what in ((drift, "momentum: of the fields, changes"), (turn, "moment: of momentum of the fields, changes")):
            if value > BALANCE:
                result["wrong"].append(f"{what} by {value:.3g} of its scale")
        if differ > BALANCE:
            result["wrong"].append(f"record: momentum of the fields differs from history.csv by {differ:.3g}")
        return result


def check(run):
    """Numbers and verdicts of a record, as a dictionary; `wrong` lists what is wrong."""
    return Space(run).result()
