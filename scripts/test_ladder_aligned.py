#!/usr/bin/env python3
"""Tests of aligned_judge.py, that every judge passes a record that is right and not one that was tampered
with, and of aligned_cases.py.

    python scripts/test_ladder_aligned.py        (needs: pip install numpy)
"""

import csv
import json
import sys
import tempfile
import tomllib
import unittest
from math import cos, radians, sin
from pathlib import Path

sys.dont_write_bytecode = True

import numpy as np

import aligned_cases
import aligned_judge
import aligned_setup
import field_check
from test_ladder import record as fields_of
from test_ladder import square

ROWS = 60
TIME = np.arange(ROWS) / 10


def bounce():
    """Columns of a body of mass 2 that falls with 1, touches in rows 10 to 19 and leaves with 0.9."""
    stage = np.clip((np.arange(ROWS) - 9) / 11, 0, 1)
    v = -1 + 1.9 * stage
    active = ((stage > 0) & (stage < 1)).astype(float)
    zero = np.zeros(ROWS)
    kinetic = v**2
    strain = np.where(active > 0, 1 - 0.19 * stage - kinetic, 0.0)
    return {
        "time": TIME, "active": active, "kinetic": kinetic, "strain": strain, "total": kinetic + strain, "external_work": zero,
        "energy_created": zero, "energy_scale": np.ones(ROWS), "a.velocity_x": zero, "a.velocity_y": v, "b.velocity_x": zero, "b.velocity_y": zero,
        "momentum_x": zero + 1.0, "momentum_y": 2 * v, "contact_impulse_x": zero, "contact_impulse_y": 2 * (v + 1),
    }  # fmt: skip


def write(folder, columns, contacts=(), scheme="bathe", supports=("b.bottom",)):
    """A run directory of the plane without fields; contacts: rows of its last step."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "history.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*columns.values()))
    names = ["step", "contact", "multiplier", "x", "pressure"]
    with (folder / "contact.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, names)
        writer.writeheader()
        writer.writerows(contacts)
    bodies = [{"name": n, "gravity": [0.0, 0.0]} for n in "ab"]
    held = [{"on": list(supports)}] if supports else []
    case = {"dimension": 2, "bodies": bodies, "supports": held, "loads": [], "contacts": [], "time": {"scheme": {"kind": scheme}}}
    (folder / "manifest.json").write_text(json.dumps({"status": "finished", "case": case, "sides": {}, "warnings": []}))
    return folder


class Judges(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.addCleanup(self.place.cleanup)
        self.number = 0

    def judged(self, claims, columns, twin=None, **more):
        """Violations of a record of these columns, without a look at the fields."""
        self.number += 1
        base = Path(self.place.name)
        other = write(base / f"{self.number}-twin", twin, **more) if twin else None
        return aligned_judge.violations(write(base / f"{self.number}", columns, **more), claims, other, look=False)

    def catches(self, claim, name, change, columns=None, rows=slice(None), **more):
        """The claim holds in a record, and does not if a column is changed in some rows."""
        columns = columns or bounce()
        self.assertEqual(self.judged([claim], columns, **more), {})
        bad = {key: np.array(value, float) for key, value in columns.items()}
        bad[name][rows] += change
        found = self.judged([claim], bad, **more)
        self.assertIn(claim["judge"], found, f"{claim} does not see {name} changed by {change}")

    def test_touches_and_free(self):
        columns = bounce()
        self.assertEqual(self.judged([{"judge": "touches"}], columns), {})
        self.assertIn("free", self.judged([{"judge": "free"}], columns))
        columns["active"] = np.zeros(ROWS)
        self.assertIn("touches", self.judged([{"judge": "touches"}], columns))
        self.assertEqual(self.judged([{"judge": "free"}], columns), {})

    def test_flight_before_and_after(self):
        self.catches({"judge": "flight"}, "a.velocity_x", 1e-6, rows=slice(5, None))
        self.catches({"judge": "flight"}, "a.velocity_y", 1e-6, rows=slice(55, None))
        substep = bounce()
        substep["active"][10] = 0.0
        self.assertEqual(self.judged([{"judge": "flight"}], substep), {})

    def test_still(self):
        claim = {"judge": "still", "body": "a", "axis": "x", "scale": 1.0, "limit": 1e-6}
        self.catches(claim, "a.velocity_x", 1e-5, rows=slice(12, 13))

    def test_steady_until(self):
        claim = {"judge": "steady", "body": "a", "axis": "x", "value": 0.0, "limit": 1e-3, "until": 3.0}
        self.catches(claim, "a.velocity_x", 2e-3, rows=slice(29, 30))
        late = bounce()
        late["a.velocity_x"] = np.where(TIME > 3, 1.0, 0.0)
        self.assertEqual(self.judged([claim], late), {})

    def test_slows(self):
        columns = bounce() | {"a.velocity_x": 1 - 0.1 * TIME}
        self.catches({"judge": "slows", "body": "a", "axis": "x", "value": 1.0, "rate": 0.1, "limit": 0.01, "until": 9.0}, "a.velocity_x", 0.02, columns, slice(30, 31))

    def test_coulomb(self):
        columns = bounce() | {"contact_impulse_x": -0.3 * bounce()["contact_impulse_y"]}
        self.catches({"judge": "coulomb", "mu": 0.3, "limit": 1e-6}, "contact_impulse_x", 1e-3, columns, slice(40, 41))

    def test_newton(self):
        claim = {"judge": "newton", "body": "a", "mass": 2.0, "axes": "xy"}
        self.catches(claim, "contact_impulse_y", 1e-4, rows=slice(58, None))
        self.catches(claim, "a.velocity_x", 1e-4, rows=slice(15, 16))
        swapped = bounce()
        swapped["contact_impulse_y"] = -swapped["contact_impulse_y"]
        self.assertEqual(self.judged([claim], swapped), {})
        # Within a contact the velocities of α schemes do not contain all momentum.
        self.catches(claim, "contact_impulse_y", 1e-4, rows=slice(58, None), scheme="chung-hulbert")

    def test_conserved(self):
        self.catches({"judge": "conserved", "axis": "x", "limit": 1e-9}, "momentum_x", 1e-6, rows=slice(30, None))

    def test_rebound(self):
        self.catches({"judge": "rebound", "body": "a", "axis": "y", "before": -1.0}, "a.velocity_y", 0.2, rows=slice(20, None))

    def test_rebound_of_a_pair(self):
        columns = bounce()
        columns["b.velocity_x"] = np.where(TIME > 2, 1.0, 0.0)
        columns["a.velocity_x"] = 1 - columns["b.velocity_x"]
        claim = {"judge": "rebound-pair", "a": "a", "b": "b", "axis": "x", "before": 1.0, "low": 0.9}
        self.catches(claim, "b.velocity_x", 0.1, columns, slice(-1, None))
        self.catches(claim, "b.velocity_x", -0.2, columns, slice(-1, None))
        self.catches(claim, "active", 1.0, columns, slice(-1, None))

    def test_apart_end(self):
        self.catches({"judge": "apart-end"}, "active", 1.0, rows=slice(-1, None))

    def test_last(self):
        columns = bounce() | {"c1.force_y": np.full(ROWS, -3.0)}
        self.catches({"judge": "last", "column": "c1.force_y", "value": 3.0, "limit": 1e-8, "sign": False}, "c1.force_y", 1e-6, columns, slice(-1, None))
        self.assertIn("last", self.judged([{"judge": "last", "column": "c1.force_y", "value": 3.0, "limit": 1e-8}], columns))

    def test_center_and_even(self):
        row = {"step": 4, "contact": "c1", "multiplier": -1.0, "x": 0.0, "pressure": 2.0}
        rows = [row | {"x": -1.0}, row | {"x": 1.0}, row | {"step": 3, "x": 7.0}]
        claims = [{"judge": "center", "contact": "c1", "axis": "x", "value": 0.0, "limit": 1e-6}, {"judge": "even", "contact": "c1", "value": None, "limit": 1e-6}]
        self.assertEqual(self.judged(claims, bounce(), contacts=rows), {})
        rows[0] |= {"multiplier": -1.1, "pressure": 2.1}
        self.assertEqual(set(self.judged(claims, bounce(), contacts=rows)), {"center", "even"})
        self.assertEqual(set(self.judged(claims, bounce(), contacts=[])), {"center", "even"})

    def test_apart(self):
        columns = bounce() | {"upper.uy": np.full(ROWS, -0.1), "lower.uy": np.zeros(ROWS)}
        self.catches({"judge": "apart", "upper": "upper.uy", "lower": "lower.uy", "gap": 0.1, "limit": 1e-3}, "lower.uy", 2e-3, columns, slice(30, 31))

    def test_rest(self):
        columns = bounce() | {"kinetic": np.zeros(ROWS), "strain": np.ones(ROWS), "total": np.ones(ROWS)}
        self.catches({"judge": "rest", "limit": 1e-6}, "kinetic", 1e-5, columns, slice(30, 31))

    def test_energy(self):
        for scheme, rise in (("bathe", 2e-3), ("chung-hulbert", 3e-2)):
            columns = bounce()
            self.assertEqual(self.judged([], columns, scheme=scheme), {})
            columns["total"] = columns["total"] + np.where(TIME > 4, rise, 0.0)
            self.assertIn("energy", self.judged([], columns, scheme=scheme))
        columns["total"][30] = np.nan
        self.assertIn("energy", self.judged([], columns))

    def test_agree(self):
        claim = {"judge": "agree", "columns": {"a.velocity_x": 1.0, "a.velocity_y": 1.0, "kinetic": 1.0}, "limit": 1e-6}
        self.catches(claim, "kinetic", 1e-5, rows=slice(30, 31), twin=bounce())
        self.catches(claim, "a.velocity_x", 1e-5, rows=slice(30, 31), twin=bounce())
        turned = bounce()
        c, s, v = cos(radians(37)), sin(radians(37)), turned["a.velocity_y"]
        turned["a.velocity_x"], turned["a.velocity_y"] = -s * v, c * v
        self.assertIn("agree", self.judged([claim], turned, twin=bounce()))
        self.catches(claim | {"turn": 37.0}, "a.velocity_x", 1e-5, turned, slice(30, 31), twin=bounce())
        short = {name: values[:-1] for name, values in bounce().items()}
        self.assertIn("agree", self.judged([claim], short, twin=bounce()))

    def test_units_and_offset(self):
        columns = bounce()
        columns["kinetic"] = columns["kinetic"] * 100
        columns["a.velocity_x"] = columns["a.velocity_x"] + 3
        claim = {"judge": "agree", "columns": {"a.velocity_x": 1.0, "kinetic": 100.0}, "limit": 1e-6, "offset": {"a.velocity_x": 3.0}}
        columns |= {"total": bounce()["total"]}
        self.catches(claim, "kinetic", 1e-3, columns, slice(30, 31), twin=bounce())

    def test_every_judge_is_tested(self):
        text = Path(__file__).read_text()
        for name in aligned_judge.JUDGES:
            self.assertIn(f'"judge": "{name}"', text)


class Fields(unittest.TestCase):
    """Records with fields: squares of triangles, the upper one at rest or moved into the lower one."""

    def check(self, depth):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        folder = Path(place.name)
        bodies = {"low": square((0, 0), 2, 0.5, 1), "high": square((0, 1.0), 2, 0.5, 1)}
        contact = {"secondary": "high.bottom", "primary": {"side": "low.top"}, "enforcement": "multiplier"}
        fields_of(folder, bodies, [[(0, 0), (0, 0)], [(0, 0), (0, -depth)]], [contact], sides={"high.bottom": [[0, 1, 2]]})
        text = (folder / "history.csv").read_text().splitlines()
        (folder / "history.csv").write_text("\n".join([f"time,{text[0]}", *(f"{i},{row}" for i, row in enumerate(text[1:]))]) + "\n")
        manifest = json.loads((folder / "manifest.json").read_text())
        manifest["case"]["dimension"] = 2
        (folder / "manifest.json").write_text(json.dumps(manifest))
        return folder

    def test_field(self):
        self.assertEqual(aligned_judge.violations(self.check(0.0), []), {})
        self.assertIn("field", aligned_judge.violations(self.check(0.2), []))

    def test_corner(self):
        claim = {"judge": "corner", "body": "low", "at": [0.5, 1.2], "move": [0.0, -0.1], "limit": 0.05}
        self.assertEqual(aligned_judge.violations(self.check(0.0), [claim]), {})
        self.assertIn("corner", aligned_judge.violations(self.check(0.0), [claim | {"move": [0.0, -0.3]}]))

    def test_outcome(self):
        placed = [{"id": "undeclared-contact", "text": "node 5 at (0, 1)"}]
        self.assertEqual(aligned_judge.outcome({}, placed), "right")
        self.assertEqual(aligned_judge.outcome({"field": ["deep"]}, placed), "warned")
        self.assertEqual(aligned_judge.outcome({"field": ["deep"], "still": ["moves"]}, placed), "wrong")
        self.assertEqual(aligned_judge.outcome({"field": ["deep"]}, [{"id": "long-step", "text": "t = 1"}]), "wrong")


class Quadrilaterals(unittest.TestCase):
    def test_outline_of_each_degree(self):
        corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
        middles = np.array([(0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5), (0.5, 0.5)])
        for points in (corners, np.vstack([corners, middles])):
            body = field_check.Outline(np.arange(len(points))[None], points)
            self.assertEqual(body.inside(np.array([(0.5, 0.9), (1.1, 0.5)])).tolist(), [True, False])
            self.assertAlmostEqual(body.distance(np.array([(0.5, 0.9)]))[0][0], 0.1)
            self.assertFalse(body.inverted())
            folded = points.copy()
            folded[2] = (-0.2, -0.2)
            body.at(folded)
            self.assertTrue(body.inverted())


class Cases(unittest.TestCase):
    def setUp(self):
        self.cases = aligned_cases.all_cases()

    def test_all_are_read_and_the_same_again(self):
        self.assertGreaterEqual(len(self.cases), 400)
        self.assertEqual([c.number for c in self.cases], list(range(1, len(self.cases) + 1)))
        again = aligned_cases.all_cases()
        for one, other in zip(self.cases, again):
            self.assertEqual(one.text(), other.text())
            for setup in (one, one.twin):
                if setup:
                    tomllib.loads(setup.text())

    def test_claims_have_judges(self):
        for c in self.cases:
            self.assertTrue(c.claims)
            self.assertLessEqual({claim["judge"] for claim in c.claims}, set(aligned_judge.JUDGES))
            self.assertEqual(any(claim["judge"] == "agree" for claim in c.claims), c.twin is not None)

    def test_all_elements_schemes_and_ways_occur(self):
        elements = {p.element for c in self.cases for p in c.parts}
        self.assertEqual(elements, set(aligned_setup.DEGREE))
        self.assertEqual({c.scheme for c in self.cases}, set(aligned_setup.SCHEMES))

    def test_a_choice_has_every_family(self):
        short = aligned_cases.chosen(60)
        self.assertEqual({c.family for c in short}, set(aligned_cases.FAMILIES))
        self.assertLess(abs(len(short) - 60), 10)
        self.assertEqual(sorted(c.number for c in aligned_cases.chosen(None)), [c.number for c in self.cases])


if __name__ == "__main__":
    unittest.main()
