"""Figures contain what the record says."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import ROOT, disc_dict
from matplotlib.axes import Axes

import carom


def test_history_shows_the_columns_and_the_contact(disc_run: carom.Run) -> None:
    ax = carom.plot.history(disc_run, "top.uy")
    assert isinstance(ax, Axes)
    (line,) = ax.lines
    assert np.array_equal(line.get_ydata(), disc_run.history["top.uy"])
    assert ax.get_ylabel() == "top.uy (m)" and ax.get_xlabel() == "time (s)"
    assert len(ax.patches) == len(disc_run.episodes) == 1
    with pytest.raises(ValueError, match="different units"):
        carom.plot.history(disc_run, "top.uy", "kinetic")
    with pytest.raises(KeyError, match="did you mean 'kinetic'"):
        carom.plot.history(disc_run, "kinetik")
    assert carom.plot.history(disc_run).get_ylabel() == "contact_force_y (N)"


def test_the_energy_ledger_closes_with_friction() -> None:
    """The lines of the figure: the change of the total energy is that of the works and the dissipation."""
    case = disc_dict()
    case["contact"][0]["mu"] = 0.5
    case["body"][0]["velocity"] = [2.0, -2.0]
    run = carom.Case.from_dict(case).run(progress=False)
    lines = {line.get_label(): line.get_ydata() for line in carom.plot.energy(run).lines}
    assert abs(lines["friction work"][-1]) > 1e-3 * lines["total"][0]
    works = sum(lines.get(name, 0.0) for name in ("external work", "contact work", "friction work"))
    lost = lines["total"][0] - lines["total"] + works - lines["dissipation"]
    assert abs(lost).max() < 1e-12 * lines["total"][0]


def test_energy_and_comparison(disc_run: carom.Run) -> None:
    labels = [line.get_label() for line in carom.plot.energy(disc_run).lines]
    assert {"kinetic", "strain", "total"} <= set(labels) and "potential" not in labels
    ax = carom.plot.compare({"a": disc_run, "b": disc_run}, "top.uy")
    assert [line.get_label() for line in ax.lines] == ["a", "b"]
    with pytest.raises(ValueError, match="one title"):
        carom.plot.compare([disc_run, disc_run], "top.uy")


def test_a_snapshot_covers_the_bodies(disc_run: carom.Run, tmp_path: Path) -> None:
    ax = carom.plot.snapshot(disc_run, 0.0, "ux", mesh=True)
    # Sub-triangles at t = 0 fill disc and block: their area is that of the polygon through all
    # nodes.
    from carom.plot._space import _triangles

    fields = disc_run.fields.at(0.0)
    area = 0.0
    for block in fields.blocks:
        a, b, c = (fields.points[_triangles(block)[:, k], :2] for k in range(3))
        signed = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
        assert (signed > 0).all()
        area += float(signed.sum())
    assert area == pytest.approx(1.0 + np.pi / 4, rel=0.02)
    ax.figure.savefig(tmp_path / "a.png")


def test_the_lattice_of_cubic_triangles_is_complete() -> None:
    """Nine triangles of one ninth each: nodes of a T10 on the unit triangle."""
    from carom.plot._space import _LATTICE

    third = 1 / 3
    nodes = np.array(
        [
            (0, 0), (1, 0), (0, 1),
            (third, 0), (2 * third, 0),
            (2 * third, third), (third, 2 * third),
            (0, 2 * third), (0, third),
            (third, third),
        ]
    )  # fmt: skip
    assert np.allclose(_areas(nodes, _LATTICE[10]), 0.5 / 9)


def test_the_lattices_of_quadrilaterals_are_complete() -> None:
    """Q4 and Q9 on the unit square: corners, middles of the edges, centre."""
    from carom.plot._space import _LATTICE

    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], dtype=float)
    nodes = np.vstack([corners, (corners + np.roll(corners, -1, axis=0)) / 2, [(0.5, 0.5)]])
    assert np.allclose(_areas(nodes, _LATTICE[4]), 1 / 2)
    assert np.allclose(_areas(nodes, _LATTICE[9]), 1 / 8)


def _areas(nodes: np.ndarray, lattice: list[tuple[int, int, int]]) -> np.ndarray:
    a, b, c = (nodes[[triangle[k] for triangle in lattice]] for k in range(3))
    areas: np.ndarray = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    return areas


def test_the_pressure_map_shows_every_contact_node(disc_run: carom.Run) -> None:
    ax = carom.plot.pressure_map(disc_run, "strike")
    values = np.asarray(ax.collections[0].get_array())
    assert values.max() == disc_run.contact["pressure"].max()
    # A node between two facets has a row for each.
    contact = disc_run.contact
    active = {(t, n) for t, n, p in zip(contact["time"], contact["node"], contact["pressure"]) if p}
    assert (values != 0).sum() == len(active)
    # The side is closed: contact is in the middle of the map.
    touched = np.flatnonzero((values != 0).any(axis=1))
    assert touched.min() > 0 and touched.max() < len(values) - 1
    assert abs((touched.min() + touched.max()) / 2 - len(values) / 2) < 2
    with pytest.raises(ValueError, match="strike"):
        carom.plot.pressure_map(disc_run, "nothing")


def test_corners_of_the_primary_are_on_the_pressure_map() -> None:
    """On the axis of the impact, the corner of the prism is the contact node."""
    case = carom.Case.from_file(ROOT / "cases/impact/impact.toml").set("time.end", 0.375)
    run = case.run(progress=False)
    values = np.asarray(carom.plot.pressure_map(run).collections[0].get_array())
    late = values[:, -1]
    assert np.isfinite(late).all() and 0.5 < late[0] / late[1] < 2


def test_measured_data(disc_run: carom.Run, tmp_path: Path) -> None:
    """Against numbers by hand: an offset of 0.01 is an error of 0.01."""
    times, values = disc_run.history["time"][::6], disc_run.history["top.uy"][::6] + 0.01
    path = tmp_path / "measured.csv"
    path.write_text("t,uy\n" + "".join(f"{t},{x}\n" for t, x in zip(times, values)))
    error = carom.plot.measured_error(disc_run, "top.uy", times, values)
    assert error.rms == pytest.approx(0.01, rel=1e-9)
    assert error.nrms == pytest.approx(0.01 / np.ptp(values), rel=1e-9) and error.samples == len(times)
    ax = carom.plot.overlay(disc_run, "top.uy", path)
    assert "NRMS" in ax.get_legend_handles_labels()[1][-1]


@pytest.mark.parametrize(
    "text",
    [
        "0.0,0.5\n0.1,0.25\n0.2,\n",
        "# tracked by camera\ntime,uy\ns,m\n0.0,0.5\n0.1,0.25\n",
        '"t","u"\n"0.0","0.5"\n"0.1","0.25"\n',
        "t;u\n0,0;0,5\n0,1;0,25\n",
        "\ufefft\tu\n0.0\t0.5\n0.1\t0.25\n\n",
        "0.0 0.5 7\n0.1   0.25 8\n",
    ],
)
def test_kinds_of_measured_files(text: str, tmp_path: Path) -> None:
    from carom.plot._measured import _read

    path = tmp_path / "measured.csv"
    path.write_text(text, encoding="utf-8")
    times, values = _read(path)
    assert times[:2].tolist() == [0.0, 0.1] and values[:2].tolist() == [0.5, 0.25]


def test_damaged_measured_files(tmp_path: Path) -> None:
    from carom.plot._measured import _read

    path = tmp_path / "measured.csv"
    for text, told in (("t,u\n", "no rows of numbers"), ("0,1\n1,x\n", "csv:2 is no row of numbers: '1,x'")):
        path.write_text(text)
        with pytest.raises(ValueError, match=told):
            _read(path)


def test_an_animation_shows_recorded_instants(disc_run: carom.Run, tmp_path: Path) -> None:
    animation = carom.plot.animate(disc_run, "von_mises", frames=3)
    animation.save(tmp_path / "disc.gif", writer="pillow")
    assert (tmp_path / "disc.gif").stat().st_size > 1000


def cube() -> carom.Case:
    """A cube of 27 cells that falls on a plane."""
    return carom.Case.from_dict(
        {
            "dimension": 3,
            "material": [{"name": "rubber", "law": "neo-hookean", "density": 0.25, "lambda": 200.0, "mu": 15.0}],
            "body": [
                {
                    "name": "cube",
                    "material": "rubber",
                    "element": "Hex8",
                    "mesh": {"shape": "box", "min": [0.0, 0.0, 0.01], "max": [1.0, 1.0, 1.01], "cells": [3, 3, 3]},
                    "velocity": [0.0, 0.0, -2.0],
                }
            ],
            "contact": [
                {
                    "name": "floor",
                    "secondary": "cube.bottom",
                    "primary": {"plane": {"point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}},
                }
            ],
            "time": {"end": 0.05, "step": 2e-3, "scheme": {"kind": "chung-hulbert", "rho_inf": 0.5}},
            "output": {"fields_every": 5},
        }
    )


def test_bodies_in_space() -> None:
    """Fields and histories are those of any run; figures of the plane name what shows them."""
    run = cube().run(progress=False)
    fields = run.fields.at(0.02)
    assert fields.positions.shape == (64, 3) and fields.blocks[0].vtk_type == 72
    assert carom.plot.history(run).get_ylabel() == "contact_force_z (N)"
    assert carom.plot.energy(run).get_ylabel() == "energy (J)"
    plt.close("all")
    for figure in (lambda: carom.plot.snapshot(run, 0.02), lambda: carom.plot.animate(run)):
        with pytest.raises(ValueError, match="warp_by_vector"):
            figure()
    with pytest.raises(ValueError, match="contact_pressure"):
        carom.plot.pressure_map(run)
    assert not plt.get_fignums()
    pyvista = pytest.importorskip("pyvista")
    deformed = run.fields[0.02].warp_by_vector("displacement")
    assert isinstance(deformed, pyvista.UnstructuredGrid)
    # Free flight for 0.005, then the bottom stays on the plane.
    assert deformed.bounds[4] == pytest.approx(0.0, abs=1e-6)


def test_what_a_figure_needs(bar: carom.Case, disc: carom.Case) -> None:
    run = bar.set({"output.fields_every": 50, "time.end": 0.2}).run(progress=False)
    for figure in (lambda: carom.plot.snapshot(run, 0.1), lambda: carom.plot.animate(run)):
        with pytest.raises(ValueError, match="of bars, run.fields"):
            figure()
    run = disc.set({"output.fields_every": 0, "time.end": 0.05}).run(progress=False)
    for figure in (lambda: carom.plot.snapshot(run, 0.1), lambda: carom.plot.animate(run), lambda: carom.plot.pressure_map(run)):
        with pytest.raises(KeyError, match="output.fields_every"):
            figure()
