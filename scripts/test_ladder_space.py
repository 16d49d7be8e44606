#!/usr/bin/env python3
"""Tests of field_check_space.py and ladder_space_cases.py on constructed data with known answers.

    python scripts/test_ladder_space.py        (needs: pip install numpy)
"""

import itertools
import json
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

sys.dont_write_bytecode = True

import numpy as np

import field_check_space as fc
import field_judge
import ladder_space_cases
from field_skin import Cell, Skin, to_triangles
from test_ladder import write_vtu

KINDS = (4, 10, 8, 27)
# Freudenthal's six tetrahedra of the unit cube.
PATHS = [np.cumsum([np.zeros(3), *np.eye(3)[list(order)]], axis=0) for order in itertools.permutations(range(3))]


def block(kind, low, size, counts):
    """A box of cells with `kind` nodes from `low`."""
    cell, points, cells = Cell(kind), {}, []
    corners = []
    for at in itertools.product(*(range(n) for n in counts)):
        for path in PATHS if cell.tet else [None]:
            if cell.tet:
                t = path if np.linalg.det(path[1:] - path[0]) > 0 else path[[0, 2, 1, 3]]
                x = t[0] + cell.nodes @ (t[1:] - t[0])
            else:
                x = cell.nodes
            corners.append(x + at)
    for x in corners:
        cells.append([points.setdefault(tuple(np.round(4 * p).astype(int)), len(points)) for p in x])
    return np.array(low) + np.array(list(points)) / 4 * np.array(size) / np.array(counts), np.array(cells)


def body(points, cells, moved=(0.0, 0.0, 0.0)):
    skin = Skin(cells, points)
    skin.at(points + np.array(moved))
    return skin


def turned(points, axis, degrees):
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    s, c = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
    turn = np.eye(3)
    turn[i, i], turn[i, j], turn[j, i], turn[j, j] = c, -s, s, c
    return points @ turn.T


def ball(kind, radius, n):
    """A box mapped onto the ball: b(q) of the generator of Carom, whose corners are degenerate."""
    q, cells = block(kind, (-1, -1, -1), (2, 2, 2), (n, n, n))
    x, y, z = q.T**2
    stretch = lambda a, b: np.sqrt(1 - (a + b) / 2 + a * b / 3)
    return radius * q * np.column_stack([stretch(y, z), stretch(z, x), stretch(x, y)]), cells


def tube(kind, turns, n=16):
    """A tube of inner radius 0.5, outer 1 and height 0.5; turns of 1 are closed."""
    points, cells = block(kind, (0, 0, 0), (1, 1, 1), (n, 1, 1))
    if turns == 1:
        key = {}
        at = [key.setdefault(tuple(np.round([x % 1 * 1000, y * 1000, z * 1000]).astype(int)), len(key)) for x, y, z in points]
        first = np.unique(at, return_index=True)[1]
        points, cells = points[first], np.array(at)[cells]
    a, r = 2 * np.pi * turns * points[:, 0], 1 - 0.5 * points[:, 1]
    return np.column_stack([r * np.cos(a), r * np.sin(a), points[:, 2] / 2]), cells


class Geometry(unittest.TestCase):
    def test_volume_area_and_faces_of_a_box(self):
        for kind in KINDS:
            points, cells = block(kind, (1, 2, 3), (1.0, 0.5, 0.25), (4, 2, 1))
            skin = Skin(cells, points)
            self.assertAlmostEqual(skin.weight.sum(), 0.125)
            t = skin.triangles.reshape(-1, 3, 3)
            area = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]) / 2
            self.assertAlmostEqual(np.linalg.norm(area, axis=1).sum(), 1.75)
            np.testing.assert_allclose((area * t.mean(1)).sum() / 3, 0.125)  # they point outwards
            self.assertEqual(len(skin.faces), 28 * (2 if Cell(kind).tet else 1))
            self.assertEqual(skin.sag, 0.0)  # edges do not count
            self.assertAlmostEqual(skin.thick, 6 * 0.125 / 1.75)
            self.assertFalse(skin.inverted())

    def test_a_curved_face_is_the_polynomial_and_not_its_chord(self):
        for kind, error in ((8, 0.15), (27, 0.01), (10, 0.02)):
            skin = Skin(ball(kind, 1.0, 4)[1], ball(kind, 1.0, 4)[0])
            off = np.abs(np.linalg.norm(skin.samples, axis=2) - 1).max()
            self.assertLess(off, error)
            self.assertAlmostEqual(skin.weight.sum() / (4 / 3 * np.pi), 1, delta=error)

    def test_distances_are_those_of_dense_samples(self):
        r = np.random.default_rng(1)
        t, x = r.normal(size=(5, 3, 3)), r.normal(size=(40, 3))
        n = 200
        grid = np.array([(i / n, j / n) for i in range(n + 1) for j in range(n + 1 - i)])
        dense = (t[:, None, 0] + grid[None, :, :1] * (t[:, None, 1] - t[:, None, 0]) + grid[None, :, 1:] * (t[:, None, 2] - t[:, None, 0])).reshape(-1, 3)
        sampled = np.linalg.norm(x[:, None] - dense[None], axis=2).min(1)
        exact = to_triangles(x, t)
        self.assertTrue((exact <= sampled + 1e-12).all())
        self.assertLess((sampled - exact).max(), 0.02)

    def test_two_boxes_overlap_by_the_known_depth(self):
        for kind in KINDS:
            low = body(*block(kind, (0, 0, 0), (1, 1, 1), (4, 4, 4)))
            points, cells = block(kind, (0.13, 0.12, 1.0), (0.6, 0.6, 0.6), (3, 3, 3))
            high = body(points, cells, (0, 0, -0.03))
            bottom = high.nodes[np.isclose(high.position[high.nodes, 2], 0.97)]
            h = 0.25 * (2**0.5 if Cell(kind).tet else 1)
            nodes, edges = field_judge.pair_depths(high, low, bottom)
            self.assertAlmostEqual(nodes, 0.03 / h)
            self.assertAlmostEqual(edges, 0.03 / h)  # the larger face
            self.assertEqual(field_judge.pair_depths(high, low, [])[0], 0.0)
            apart = body(points, cells, (0, 0, 1e-9))
            self.assertEqual(field_judge.pair_depths(apart, low, bottom), (0.0, 0.0))
            touching = field_judge.pair_depths(body(points, cells), low, bottom)
            self.assertLess(max(touching), 1e-12)

    def test_an_edge_that_enters_an_edge_between_nodes_is_found(self):
        for kind in KINDS:
            roof, cells = block(kind, (-0.5, -1, -0.5), (1, 2, 1), (2, 4, 2))
            roof = turned(roof, 1, 45)
            low = body(roof - [0, 0, roof[:, 2].max()], cells)
            points, cells = block(kind, (-1, -0.5, -0.5), (2, 1, 1), (2, 1, 1))
            points = turned(points, 0, 45)
            # Its edge along x, 0.05 below the ridge along y, and no node of either near the other.
            high = body(points - [0.21, 0.13, points[:, 2].min()], cells, (0, 0, -0.05))
            for one, other in ((high, low), (low, high)):
                nodes, edges = field_judge.pair_depths(one, other, one.nodes)
                self.assertEqual(nodes, 0.0)
                h = max(other.h.max(), one.h.max())
                # On the ridge itself the depth is 0.05/√2; the points are a 24th of a face apart.
                depth = edges * min(h, one.thick, other.thick)
                self.assertLess(depth, 0.05 / 2**0.5 + 1e-12)
                self.assertGreater(depth, (0.05 - max(0.5, 1.0) / 48) / 2**0.5)

    def test_a_ball_enters_a_box_between_its_nodes(self):
        low = body(*block(27, (-1, -1, -1), (2, 2, 1), (4, 4, 2)))
        points, cells = ball(27, 0.5, 4)
        high = body(turned(points, 0, 11.0), cells, (0, 0, 0.499))
        lowest = -high.samples[..., 2].min()
        nodes, edges = field_judge.pair_depths(high, low, [])
        self.assertEqual(nodes, 0.0)
        self.assertAlmostEqual(edges, lowest / 0.5)

    def test_inside_of_a_tube_is_not_its_hole(self):
        for kind in KINDS:
            skin = body(*tube(kind, 1))
            at = np.array([[0.01, 0.02, 0.25], [0.75, 0.02, 0.25], [1.5, 0, 0.25], [0.02, -0.7, 0.45], [0.75, 0, 0.6]])
            self.assertEqual(skin.inside(at).tolist(), [False, True, False, True, False])
            self.assertTrue((skin.winding(skin.below()) == 1).all())

    def test_a_bent_strip_whose_ends_overlap_crosses_itself(self):
        for kind in KINDS:
            for turns, wrong in ((0.97, False), (1.04, True)):
                points, cells = tube(kind, turns)
                skin = Skin(cells, block(kind, (0, 0, 0), (5, 0.5, 0.5), (16, 1, 1))[0])
                skin.at(points)
                self.assertEqual(bool((skin.winding(skin.below()) > 1).any()), wrong, (kind, turns))

    def test_obstacles(self):
        skin = body(*block(10, (-0.5, -0.5, 0), (1, 1, 1), (2, 2, 2)), (0, 0, -0.1))
        plane, radius = field_judge.depth_below({"point": [0, 0, 0], "normal": [0, 0, 2]})
        h = 2**0.5 / 2
        for found in field_judge.obstacle_depths(skin, plane, skin.nodes):
            self.assertAlmostEqual(found, 0.1 / h)
        self.assertEqual(radius, 0.0)
        # The ball touches the plane z = 0.05 from below: the middle of the face is 0.15 inside.
        sphere, radius = field_judge.depth_below({"center": [0, 0, -0.95], "radius": 1.0})
        nodes, edges = field_judge.obstacle_depths(skin, sphere, skin.nodes)
        self.assertAlmostEqual(nodes, 0.15 / h)
        self.assertEqual(radius, 1.0)
        bowl, radius = field_judge.depth_below({"center": [0, 0, 0], "radius": 1.0, "inside": True})
        nodes, edges = field_judge.obstacle_depths(skin, bowl, skin.nodes)
        self.assertAlmostEqual(nodes, ((0.5 + 0.81) ** 0.5 - 1) / h)
        self.assertEqual(radius, 0.0)

    def test_inverted_cells(self):
        for kind in KINDS:
            points, cells = block(kind, (0, 0, 0), (1, 1, 1), (2, 2, 2))
            self.assertTrue(body(points * [-1, 1, 1] - points, cells, points * 0 + points).inverted())
            a, r = 2 * points[:, 0], 2 - points[:, 1]
            bent = np.column_stack([r * np.sin(a), -r * np.cos(a), points[:, 2]])
            self.assertFalse(body(points, cells, bent - points).inverted())
            pinched = points.copy()
            middle = np.flatnonzero((np.abs(points - 0.5) < 1e-9).all(1))
            pinched[middle] += [0.6, 0.6, 0.6]
            self.assertTrue(body(points, cells, pinched - points).inverted())

    def test_moments_of_a_turning_box(self):
        for kind in KINDS:
            points, cells = block(kind, (-1, -0.5, -0.25), (2, 1, 0.5), (4, 2, 2))
            skin = Skin(cells, points)
            spin, linear = np.array([0.3, -0.2, 0.9]), np.array([1.0, 2.0, 3.0])
            v = linear + np.cross(spin, points)
            m, x, w = skin.moments(points, v, 3.0, False)
            np.testing.assert_allclose((m[:, None] * w).sum(0), 3.0 * linear)
            inertia = 3.0 / 12 * np.array([1 + 0.25, 4 + 0.25, 4 + 1])
            np.testing.assert_allclose((m[:, None] * np.cross(x, w)).sum(0), inertia * spin)
            m, x, w = skin.moments(points, v, 3.0, True)
            np.testing.assert_allclose((m[:, None] * w).sum(0), 3.0 * linear)
            self.assertTrue((m > 0).all())

    def test_a_segment_crosses_a_skin(self):
        skin = body(*tube(27, 1))
        at = lambda x, y: np.array([x, y, 0.2513])
        self.assertEqual(skin.meets(at(-2, 0.013), at(2, 0.017)), 4)
        self.assertEqual(skin.meets(at(-2, 0.013), at(0, 0.017)), 2)
        self.assertEqual(skin.meets(at(-2, 0.013), at(-0.7, 0.017)), 1)
        self.assertEqual(skin.meets(np.array([0.013, 0.017, -2]), np.array([0.013, 0.017, 2])), 0)


def record(folder, bodies, motion, velocity, contacts, energies, scheme, momenta, **case):
    """A run directory; motion, velocity: of every body at each instant."""
    (folder / "fields").mkdir()
    entries = ""
    for k, moves in enumerate(motion):
        displacement = [np.broadcast_to(m, p.shape) for (p, _), m in zip(bodies.values(), moves)]
        speeds = [np.broadcast_to(v, p.shape) for (p, _), v in zip(bodies.values(), velocity[k])]
        write_vtu(folder / f"fields/{k}.vtu", bodies, displacement, speeds)
        entries += f'<DataSet timestep="{k}" file="fields/{k}.vtu"/>'
    (folder / "fields.pvd").write_text(f"<VTKFile><Collection>{entries}</Collection></VTKFile>")
    (folder / "contact.csv").write_text("step,contact\n1,c0\n")
    head = "time,total,external_work,kinetic,strain,energy_created,energy_scale,active," + ",".join(
        f"{what}_{i}" for what in ("momentum", "contact_impulse") for i in "xyz"
    )
    rows = [",".join(str(x) for x in [k, e, 0, e, 0, 0, 1, 1, *p, 0, 0, 0]) for k, (e, p) in enumerate(zip(energies, momenta))]
    (folder / "history.csv").write_text("\n".join([head, *rows]) + "\n")
    materials = [{"name": "m", "density": 2.0}]
    specs = [{"name": n, "material": "m", "mass": "consistent", "gravity": [0, 0, 0]} for n in bodies]
    smooth = {"mu": None, "shear": None}
    contacts = [{"name": f"c{i}", "enforcement": "multiplier", "friction": smooth, **c} for i, c in enumerate(contacts)]
    case = {"dimension": 3, "contacts": contacts, "supports": [], "loads": [], "bodies": specs, "materials": materials, **case}
    case["time"] = {"scheme": {"kind": scheme}}
    (folder / "manifest.json").write_text(json.dumps({"status": "finished", "case": case, "sides": {}, "warnings": []}))


class Records(unittest.TestCase):
    PAIR = {"secondary": "shot.skin", "primary": {"side": "plate.skin"}}

    def judged(self, motion, velocity=None, contacts=(PAIR,), energies=None, scheme="newmark", momenta=None, kind=8, **case):
        bodies = {"shot": block(kind, (0.1, 0.1, 1), (0.2, 0.2, 0.2), (2, 2, 2)), "plate": block(kind, (-1, -1, -1), (2, 2, 2), (4, 4, 4))}
        still = [((0, 0, 0), (0, 0, 0))] * len(motion)
        n = len(motion)
        with tempfile.TemporaryDirectory() as folder:
            momenta = momenta or [(0, 0, 0)] * n
            record(Path(folder), bodies, motion, velocity or still, contacts, energies or [1.0] * n, scheme, momenta, **case)
            return fc.check(folder)

    def test_touching_is_right(self):
        for kind in KINDS:
            found = self.judged([[(0, 0, 0.1), (0, 0, 0)], [(0, 0, 0), (0, 0, 0)]], kind=kind)
            self.assertEqual((found["wrong"], found["fields"]), ([], 2))
            self.assertLess(max(found["nodes"], found["edges"]), 1e-12)

    def test_a_node_inside_is_wrong_by_its_depth(self):
        found = self.judged([[(0, 0, 0.1), (0, 0, 0)], [(0, 0, -0.02), (0, 0, 0)]])
        self.assertAlmostEqual(found["nodes"], 0.1)  # h is at most the edge of the shot, 0.2
        self.assertTrue(found["wrong"][0].startswith("nodes: nodes of shot in plate: 0.1 h"), found["wrong"])

    def test_a_primary_body_may_enter_between_nodes_but_not_far(self):
        plate = {"secondary": "plate.skin", "primary": {"side": "shot.skin"}}
        self.assertEqual(self.judged([[(0, 0, 0.1), (0, 0, 0)], [(0, 0, -0.018), (0, 0, 0)]], contacts=[plate])["wrong"], [])
        found = self.judged([[(0, 0, 0.1), (0, 0, 0)], [(0, 0, -0.022), (0, 0, 0)]], contacts=[plate])
        self.assertTrue(found["wrong"][0].startswith("edges: edges of shot in plate: 0.11 h"), found["wrong"])

    def test_overlap_of_the_start_is_subtracted_and_reported(self):
        found = self.judged([[(0, 0, -0.02), (0, 0, 0)], [(0, 0, -0.021), (0, 0, 0)]])
        self.assertAlmostEqual(found["initial"], 0.1)
        self.assertEqual(found["wrong"], [])

    def test_passing_through_between_two_fields(self):
        found = self.judged([[(0, 0, 0.1), (0, 0, 0)], [(0, 0, -4), (0, 0, 0)]])
        self.assertEqual(found["wrong"], ["through: shot passes through plate at t = 1"])
        self.assertEqual(self.judged([[(2, 0, 0), (0, 0, 0)], [(2, 0, -4), (0, 0, 0)]])["wrong"], [])
        self.assertEqual(self.judged([[(0, 0, 0.1), (0, 0, 0)], [(0, 0, -4), (0, 0, -4.1)]])["wrong"], [])

    def test_momentum(self):
        far = [[(0, 0, 1), (0, 0, 0)]] * 2
        # Volumes of 0.008 and 8: the same momentum.
        one, other = [(1, 2, 3), (0, 0, 0)], [(0, 0, 0), (0.001, 0.002, 0.003)]
        m = 2 * 0.008
        p = [(m, 2 * m, 3 * m)] * 2
        judged = lambda *v, **more: self.judged(far, velocity=list(v), **{"momenta": p, **more})["wrong"]
        self.assertEqual(judged(one, other), [])
        self.assertIn("momentum: of the fields, changes", judged(one, [(0, 0, 0), (0.001, 0.002, 0.00301)])[0])
        self.assertIn("record: momentum of the fields differs", judged(one, other, momenta=[(m, 2 * m, 2 * m)] * 2)[0])
        # Supports and planes take momentum, a smooth plane only along its normal.
        fast = [(0, 0, 0), (0.001, 0.002, 0)]
        plane = {"secondary": "plate.skin", "primary": {"plane": {"point": [0, 0, -1], "normal": [0, 0, 1]}}}
        of = lambda v: [tuple(m * x for x in one[0])] + [tuple(16 * x for x in v[1])]
        self.assertEqual(judged(one, fast, contacts=[self.PAIR, plane], momenta=of(fast)), [])
        aside = [(0, 0, 0), (0.001, 0.0021, 0)]
        self.assertIn("momentum: of the fields", judged(one, aside, contacts=[self.PAIR, plane], momenta=of(aside))[0])
        rough = {**plane, "friction": {"mu": 0.3, "shear": None}}
        self.assertEqual(judged(one, aside, contacts=[self.PAIR, rough], momenta=of(aside)), [])
        self.assertEqual(judged(one, aside, supports=[1], momenta=of(aside)), [])

    def test_moment_of_momentum_with_energy_momentum(self):
        far, still = [[(0, 0, 1), (0, 0, 0)]] * 2, [(0, 0, 0), (0, 0, 0)]
        points = block(8, (-1, -1, -1), (2, 2, 2), (4, 4, 4))[0]
        spin = [(0, 0, 0), np.cross([0, 0, 1.0], points)]
        self.assertEqual(self.judged(far, [still, spin])["wrong"], [])
        self.assertIn("moment: of momentum", self.judged(far, [still, spin], scheme="energy-momentum")["wrong"][0])

    def test_energy_and_missing_fields(self):
        still = [[(0, 0, 0.1), (0, 0, 0)]] * 3
        self.assertEqual(self.judged(still, energies=(1.0, 0.5, 0.51))["wrong"], [])
        self.assertIn("energy: 3 % created", self.judged(still, energies=(1.0, 0.5, 0.53))["wrong"][0])
        self.assertIn("1 fields", self.judged(still[:1])["wrong"][0])

    def test_obstacles_that_it_cannot_check_are_refused(self):
        circle = {"secondary": "shot.skin", "primary": {"polyline": {}}}
        with self.assertRaises(ValueError):
            self.judged([[(0, 0, 0), (0, 0, 0)]] * 2, contacts=[circle])


class Generator(unittest.TestCase):
    def test_cases_are_valid_toml_and_depend_on_seed_and_number_only(self):
        seen = set()
        for k in range(1, 381):
            meta, text = ladder_space_cases.case(7, k)
            self.assertEqual((meta, text), ladder_space_cases.case(7, k))
            case = tomllib.loads(text)
            steps = case["time"]["end"] / case["time"]["step"]
            self.assertAlmostEqual(steps, round(steps), places=5)
            self.assertLessEqual(steps, 2520)
            self.assertEqual(len({b["name"] for b in case["body"]}), len(case["body"]))
            self.assertTrue(text.startswith("# "))
            seen.add((meta["category"], meta["family"]))
            self.assertNotEqual(text, ladder_space_cases.case(8, k)[1])
        self.assertEqual({c for c, _ in seen}, set(ladder_space_cases.CATEGORIES))
        self.assertEqual({f for _, f in seen}, set(ladder_space_cases.FAMILIES))

    def test_a_category_that_was_added_later_does_not_change_the_first_cases(self):
        of = ladder_space_cases.category_of
        self.assertEqual([of(k) for k in (1, 17, 18, 340)], ["corner-landing", "slide-off", "corner-landing", "slide-off"])
        self.assertEqual([of(k) for k in (341, 342, 358, 359)], ["slanting", "corner-landing", "slide-off", "slanting"])


if __name__ == "__main__":
    unittest.main()
