#!/usr/bin/env python3
"""Tests of field_check.py and ladder_cases.py on constructed data with known answers.

    python scripts/test_ladder.py        (needs: pip install numpy)
"""

import json
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

sys.dont_write_bytecode = True

import numpy as np

import field_check as fc
import field_judge
import ladder_cases


def elevated(points, triangles, p):
    """Straight cells of order p in VTK's order from triangles."""
    points, cells, known = [np.array(q, float) for q in points], [], {}

    def edge(i, j):
        key = (min(i, j), max(i, j))
        if key not in known:
            known[key] = []
            for k in range(1, p):
                known[key].append(len(points))
                points.append(points[key[0]] + (points[key[1]] - points[key[0]]) * k / p)
        return known[key] if i < j else known[key][::-1]

    for t in triangles:
        inner = [edge(t[e], t[(e + 1) % 3]) for e in range(3)]
        cell = [*t, *inner[0], *inner[1], *inner[2]]
        if p == 3:
            cell.append(len(points))
            points.append(sum(points[i] for i in t) / 3)
        cells.append(cell)
    return np.array(points), np.array(cells)


def square(low, n, size, p):
    """Square from `low` of n × n cells of the size."""
    points = [(low[0] + i * size, low[1] + j * size) for j in range(n + 1) for i in range(n + 1)]
    at = lambda i, j: j * (n + 1) + i
    triangles = []
    for j in range(n):
        for i in range(n):
            triangles += [(at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1))]
    return elevated(points, triangles, p)


def round_disc(radius, n, p, center=(0.0, 0.0)):
    """n cells around a centre; the nodes of the arc are on the circle."""
    angle = 2 * np.pi * np.arange(n) / n
    corners = [(0, 0), *zip(radius * np.cos(angle), radius * np.sin(angle))]
    points, cells = elevated(corners, [(0, 1 + i, 1 + (i + 1) % n) for i in range(n)], p)
    for i, cell in enumerate(cells):
        for k in range(1, p):
            a = angle[i] + 2 * np.pi / n * k / p
            points[cell[3 + (p - 1) + k - 1]] = radius * np.cos(a), radius * np.sin(a)
    return points + np.array(center), cells


def outline(points, cells, moved=(0.0, 0.0)):
    body = fc.Outline(cells, points)
    body.at(points + np.array(moved))
    return body


def write_vtu(path, bodies, displacement, velocity=None):
    """As Carom writes it: appended raw arrays with lengths of 8 bytes."""
    data, head = b"", ""

    def array(kind, name, values, n=1):
        nonlocal data, head
        raw = np.ascontiguousarray(values, field_judge.TYPES[kind]).tobytes()
        parts = f' NumberOfComponents="{n}"' if n > 1 else ""
        head += f'<DataArray type="{kind}" Name="{name}"{parts} format="appended" offset="{len(data)}"/>\n'
        data += len(raw).to_bytes(8, "little") + raw

    for number, name in enumerate(bodies):
        head += f'<DataArray type="Int32" Name="body {name}" NumberOfTuples="1" format="ascii">{number}</DataArray>\n'
    shift = np.cumsum([0] + [len(p) for p, _ in bodies.values()])
    flat = lambda x: np.concatenate([np.pad(v, ((0, 0), (0, 3 - v.shape[1]))) for v in x])
    array("Float64", "displacement", flat(displacement), 3)
    if velocity:
        array("Float64", "velocity", flat(velocity), 3)
    array("Int32", "body", np.concatenate([np.full(len(c), i) for i, (_, c) in enumerate(bodies.values())]))
    array("Float64", "points", flat([p for p, _ in bodies.values()]), 3)
    array("Int64", "connectivity", np.concatenate([(c + s).ravel() for (_, c), s in zip(bodies.values(), shift)]))
    array("Int64", "offsets", np.cumsum(np.concatenate([np.full(len(c), c.shape[1]) for _, c in bodies.values()])))
    path.write_bytes(b"<VTKFile>" + head.encode() + field_judge.MARK + data + b"\n</AppendedData>")


def record(folder, bodies, motion, contacts, energies=(1.0, 1.0), sides=None, supports=(1,), momenta=None, touched=()):
    """A run directory; motion: displacement of every body at each instant; momenta: (momentum, impulse of
    contact) in x of each row; touched: contacts with a row in contact.csv."""
    (folder / "fields").mkdir()
    entries = ""
    for k, moves in enumerate(motion):
        displacement = [np.broadcast_to(m, p.shape) for (p, _), m in zip(bodies.values(), moves)]
        write_vtu(folder / f"fields/{k}.vtu", bodies, displacement)
        entries += f'<DataSet timestep="{k}" file="fields/{k}.vtu"/>'
    (folder / "fields.pvd").write_text(f"<VTKFile><Collection>{entries}</Collection></VTKFile>")
    columns = "total external_work kinetic strain energy_created energy_scale active momentum_x momentum_y contact_impulse_x contact_impulse_y"
    momenta = momenta or [(0.0, 0.0)] * len(energies)
    rows = [f"{e},0,{e},0,0,1,{0 if supports == [] else 1},{p},0,{f},0" for e, (p, f) in zip(energies, momenta)]
    (folder / "contact.csv").write_text("\n".join(["step,contact", *(f"1,{name}" for name in touched)]) + "\n")
    (folder / "history.csv").write_text("\n".join([columns.replace(" ", ","), *rows]) + "\n")
    contacts = [{"name": f"c{i}", **contact} for i, contact in enumerate(contacts)]
    time = {"scheme": {"kind": "chung-hulbert"}}
    case = {"contacts": contacts, "supports": list(supports), "loads": [], "bodies": [], "time": time}
    (folder / "manifest.json").write_text(json.dumps({"status": "finished", "case": case, "sides": sides or {}, "warnings": []}))


class Geometry(unittest.TestCase):
    def test_facets_of_every_order_have_their_lengths_and_direction(self):
        for p in (1, 2, 3):
            body = outline(*square((0, 0), 3, 0.5, p))
            self.assertEqual(len(body.facets), 12)
            np.testing.assert_allclose(body.h, 0.5)
            a, b = body.a, body.b
            area = float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2)
            self.assertAlmostEqual(area, 2.25)  # anticlockwise
            self.assertEqual(body.sag, 0.0)  # corners do not count

    def test_a_curved_facet_is_the_polynomial_and_not_its_chord(self):
        n, R = 8, 1.0
        for p, error in ((1, 0.08), (2, 2e-3), (3, 3e-4)):
            body = outline(*round_disc(R, n, p))
            off = np.abs(np.linalg.norm(body.samples, axis=2) - R).max()
            self.assertLess(off, error)
        # 45 degrees: corners
        self.assertAlmostEqual(outline(*round_disc(R, n, 1)).sag, 0.0, places=12)
        self.assertAlmostEqual(outline(*round_disc(R, 12, 1)).sag, np.pi / 6 / 8, places=12)
        self.assertAlmostEqual(outline(*round_disc(R, n, 2)).sag, np.pi / 4 / 32, delta=1e-3)

    def test_two_squares_overlap_by_the_known_depth(self):
        for p in (1, 2, 3):
            low = outline(*square((0, 0), 4, 0.25, p))
            # Its lowest nodes 0.03 below the top, not above the nodes of the other.
            high = outline(*square((0.1, 1.0), 4, 0.2, p), moved=(0.0, -0.03))
            bottom = high.nodes[np.isclose(high.position[high.nodes, 1], 0.97)]
            nodes, edges = field_judge.pair_depths(high, low, bottom)
            self.assertAlmostEqual(nodes, 0.03 / 0.25)
            self.assertAlmostEqual(edges, 0.03 / 0.25)  # points on its edges; the larger facet
            nodes, edges = field_judge.pair_depths(high, low, [])
            self.assertEqual(nodes, 0.0)
            apart = outline(*square((0.1, 1.0), 4, 0.2, p))
            self.assertEqual(field_judge.pair_depths(apart, low, bottom), (0.0, 0.0))

    def test_a_curved_disc_enters_a_square_between_its_nodes(self):
        low = outline(*square((-1, -2), 4, 0.5, 2))
        points, cells = round_disc(0.5, 8, 2)
        turn = np.pi / 8 + np.pi / 16  # a quarter of a facet beside the lowest point: no node there
        rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        body = outline(points @ rotation.T, cells, moved=(0.0, 0.498))
        nodes, edges = field_judge.pair_depths(body, low, body.nodes)
        self.assertEqual(nodes, 0.0)
        lowest = -body.samples[..., 1].min()
        self.assertGreater(lowest, 1e-3)
        self.assertAlmostEqual(edges, lowest / 0.5)  # the facet of the square is the larger one

    def test_inside_of_a_ring_is_not_its_hole(self):
        n, points, triangles = 16, [], []
        for i in range(n):
            a = 2 * np.pi * i / n
            points += [(0.5 * np.cos(a), 0.5 * np.sin(a)), (np.cos(a), np.sin(a))]
        for i in range(n):
            a, b, c, d = 2 * i, 2 * i + 1, (2 * i + 3) % (2 * n), (2 * i + 2) % (2 * n)
            triangles += [(a, b, c), (a, c, d)]
        body = outline(*elevated(points, triangles, 1))
        self.assertEqual(len(np.unique(body.loops)), 2)
        self.assertEqual(list(body.inside(np.array([[0, 0], [0.75, 0], [1.5, 0]]))), [False, True, False])
        self.assertEqual(body.self_depth(), 0.0)

    def test_the_ends_of_a_bent_strip_overlap_by_the_known_depth(self):
        n = 24
        points = [(i / n, j * 0.1) for i in range(n + 1) for j in (0, 1)]
        triangles = []
        for i in range(n):
            a, b, c, d = 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1
            triangles += [(a, b, c), (a, c, d)]
        for p in (1, 2):
            reference, cells = elevated(points, triangles, p)
            body = fc.Outline(cells, reference)
            for turns, wrong in ((0.97, False), (1.04, True)):
                a = 2 * np.pi * turns * reference[:, 0]
                r = 1 - reference[:, 1]
                body.at(np.column_stack([r * np.sin(a), -r * np.cos(a)]))
                depth = body.self_depth()
                self.assertEqual(depth > 0, wrong)
            # The corners of the end are 0.04 turns inside: 0.25 rad, 0.1 wide, so at most half of
            # 0.1.
            self.assertLessEqual(depth, 0.05 / body.h.min() + 0.1)

    def test_the_walls_of_a_crease_overlap_by_their_distance(self):
        # A notch in the upper side, whose walls lean over each other.
        left, right, low = (-1.0, 1.0), (1.0, 1.0), (-1.0, -1.0)
        points = [low, (1.0, -1.0), right, (0.1, 1.0), (0.05, 0.5), (0.0, 0.0), (-0.05, 0.5), (-0.1, 1.0), left]
        triangles = [(0, 1, 5), (1, 2, 5), (2, 3, 4), (2, 4, 5), (5, 6, 8), (6, 7, 8), (0, 5, 8)]
        for p in (1, 2):
            reference, cells = elevated(points, triangles, p)
            body = fc.Outline(cells, reference)
            self.assertEqual(body.self_depth(), 0.0)
            for over in (0.004, 0.05):
                moved = reference.copy()
                wall = reference[:, 1] > 0
                # From the tips on both walls: by 0.1 + over at the top.
                amount = (0.1 + over) * reference[wall, 1]
                moved[wall, 0] -= np.where(np.abs(reference[wall, 0]) < 0.5, np.sign(reference[wall, 0]) * amount, 0)
                body.at(moved)
                found = body.self_depth()
                self.assertLess(found * body.h.min(), 2.1 * over)
                self.assertGreater(found * body.h.max(), over)

    def test_plane(self):
        body = outline(*square((0, 0), 2, 0.5, 2), moved=(0.0, -0.1))
        depth_of, _ = field_judge.depth_below({"point": [0.0, 0.0], "normal": [0.0, 1.0]})
        nodes, edges = field_judge.obstacle_depths(body, depth_of, body.nodes)
        self.assertAlmostEqual(nodes, 0.2)
        self.assertAlmostEqual(edges, 0.2)


class Records(unittest.TestCase):
    def judged(self, motion, energies=(1.0, 1.0), size=0.1, secondary="shot.all", damage=None, **more):
        bodies = {"shot": square((0, 1), 2, size, 2), "plate": square((-1, -2), 4, 0.5, 1)}
        n = len(bodies["shot"][0])
        sides = {"shot.all": [list(range(n))], "plate.all": [list(range(n, n + len(bodies["plate"][0])))]}
        primary = "plate.all" if secondary == "shot.all" else "shot.all"
        contacts = [{"secondary": secondary, "primary": {"side": primary}, "enforcement": "multiplier"}]
        contacts = more.pop("contacts", contacts)
        with tempfile.TemporaryDirectory() as folder:
            record(Path(folder), bodies, motion, contacts, energies, sides, **more)
            if damage:
                damage(Path(folder))
            return fc.check(folder)

    def test_touching_is_right(self):
        found = self.judged([[(0, 0), (0, 0)], [(0, -1), (0, 0)]])
        self.assertEqual((found["wrong"], found["fields"]), ([], 2))

    def test_a_node_inside_is_wrong_by_its_depth(self):
        found = self.judged([[(0, 0), (0, 0)], [(0, -1.04), (0, 0)]])
        self.assertAlmostEqual(found["nodes"], 0.08)
        self.assertTrue(found["wrong"][0].startswith("nodes: nodes of shot in plate: 0.08 h"), found["wrong"])

    def test_a_primary_body_may_enter_between_nodes_but_not_far(self):
        # Corners of the shot in the large facets of the plate: 0.04/0.5 is below the limit,
        # 0.06/0.5 above.
        self.assertEqual(self.judged([[(0, 0), (0, 0)], [(0.1, -1.04), (0, 0)]], secondary="plate.all")["wrong"], [])
        found = self.judged([[(0, 0), (0, 0)], [(0.1, -1.06), (0, 0)]], secondary="plate.all")
        self.assertTrue(found["wrong"][0].startswith("edges: edges of shot in plate: 0.12 h"), found["wrong"])

    def test_overlap_of_the_start_is_subtracted_and_reported(self):
        found = self.judged([[(0, -1.04), (0, 0)], [(0, -1.045), (0, 0)]])
        self.assertAlmostEqual(found["initial"], 0.08)
        self.assertEqual(found["wrong"], [])

    def test_passing_through_between_two_fields(self):
        found = self.judged([[(0, 0), (0, 0)], [(0, -4), (0, 0)]])
        self.assertEqual(found["wrong"], ["through: shot passes through plate at t = 1"])
        # Past its side, or with it, is not through it.
        self.assertEqual(self.judged([[(2, 0), (0, 0)], [(2, -4), (0, 0)]])["wrong"], [])
        self.assertEqual(self.judged([[(0, 0), (0, 0)], [(0, -4), (0, -4)]])["wrong"], [])

    def test_energy_created_after_a_loss(self):
        still = [[(0, 0), (0, 0)]] * 2
        self.assertEqual(self.judged(still, energies=(1.0, 0.5, 0.51))["wrong"], [])
        found = self.judged(still, energies=(1.0, 0.5, 0.53))
        self.assertAlmostEqual(found["created"], 0.03)
        self.assertIn("energy: 3 % created", found["wrong"][0])


    def test_what_is_missing_is_wrong(self):
        moves = [[(0, 0), (0, 0)], [(0, -0.5), (0, 0)]]
        self.assertEqual(self.judged(moves)["wrong"], [])
        self.assertIn("1 fields", self.judged(moves[:1])["wrong"][0])
        self.assertIn("0 fields", self.judged([])["wrong"][0])
        gone = lambda folder: (folder / "fields/1.vtu").unlink()
        self.assertIn("the field of t = 1 is missing", self.judged(moves, damage=gone)["wrong"][0])
        self.assertEqual(self.judged(moves, energies=(1.0, float("nan")))["wrong"], ["energy: not finite"])

    def test_a_body_turned_inside_out_is_wrong(self):
        points = square((0, 1), 2, 0.1, 2)[0]
        mirrored = np.column_stack([0.2 - 2 * points[:, 0], 0 * points[:, 0]])
        found = self.judged([[(0, 0), (0, 0)], [mirrored, (0, 0)]])
        self.assertEqual(found["wrong"], ["inverted: a cell of shot at t = 1"])

    def test_a_bent_cell_is_not_inverted_although_its_corners_turn_over(self):
        # A third of a ring, with the third corner inside of the arc and outside of its chord.
        mid = lambda a, b: [tuple(((3 - k) * i + k * j) / 3 for i, j in zip(a, b)) for k in (1, 2)]
        a, b, c = corners = [(0, 0), (1, 0), (0, 1)]
        x, y = np.array([*corners, *mid(a, b), *mid(b, c), *mid(c, a), (1 / 3, 1 / 3)]).T
        angle, radius = 2 / 3 * np.pi * (x + y / 2), 1 - 0.4 * y
        bent = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
        self.assertLess(np.linalg.det(bent[1:3] - bent[0]), 0)
        u, v = fc.slopes(3) @ bent
        exact = 2 / 3 * np.pi * 0.4 * (1 - 0.4 / 3)
        found = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).mean()
        self.assertLess(abs(found / exact - 1), 0.03)
        self.assertGreater((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).min(), 0)

    def test_momentum_on_a_plane_whatever_contacts_with_itself_a_body_has(self):
        plane = {"secondary": "shot.all", "primary": {"plane": {"point": [0, -9], "normal": [0, 1]}}, "enforcement": "multiplier"}
        of_itself = {"secondary": "shot.all", "primary": {"side": "shot.all"}, "enforcement": "multiplier"}
        still = [[(0, 0), (0, 0)]] * 2
        judged = lambda momenta, touched=("c0",): self.judged(
            still, contacts=[plane, of_itself], supports=[], momenta=momenta, touched=touched
        )
        self.assertEqual(judged([(1.0, 0.0), (-0.8, -1.8)])["wrong"], [])
        self.assertAlmostEqual(judged([(1.0, 0.0), (-0.8, -1.8)])["momentum"], 0.0)
        self.assertIn("momentum: change and contact impulse differ by 0.1", judged([(1.0, 0.0), (-0.8, -1.7)])["wrong"][0])
        # Once it touches itself, the impulses are not of the plane alone.
        self.assertIsNone(judged([(1.0, 0.0), (-0.8, -1.7)], ("c0", "c1"))["momentum"])

    def test_obstacles_that_it_cannot_check_are_refused(self):
        circle = {"secondary": "shot.all", "primary": {"circle": {}}, "enforcement": "multiplier"}
        with self.assertRaises(ValueError):
            self.judged([[(0, 0), (0, 0)]] * 2, contacts=[circle])


class Generator(unittest.TestCase):
    def test_cases_are_valid_toml_and_depend_on_seed_and_number_only(self):
        seen = set()
        for k in range(1, 131):
            meta, text = ladder_cases.case(7, k)
            self.assertEqual((meta, text), ladder_cases.case(7, k))
            case = tomllib.loads(text)
            steps = case["time"]["end"] / case["time"]["step"]
            self.assertAlmostEqual(steps, round(steps), places=5)
            self.assertLessEqual(steps, 3020)
            pairs = [str(c.get("between") or (c["secondary"], c["primary"])) for c in case["contact"]]
            self.assertEqual(len(pairs), len(set(pairs)))
            self.assertTrue(text.startswith("# "))
            seen.add((meta["category"], meta["family"]))
            self.assertNotEqual(text, ladder_cases.case(8, k)[1])
        self.assertEqual({c for c, _ in seen}, set(ladder_cases.CATEGORIES))
        self.assertEqual({f for _, f in seen}, set(ladder_cases.FAMILIES))


if __name__ == "__main__":
    unittest.main()
