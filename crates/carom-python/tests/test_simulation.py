"""Step by step."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import disc_dict

import carom


def test_steps_are_the_rows_of_a_run(disc: carom.Case, disc_run: carom.Run) -> None:
    simulation = carom.Simulation(disc)
    rows = [simulation.row]
    for step in simulation:
        rows.append(simulation.row)
        assert step.number == simulation.step and step.time == simulation.time
    assert simulation.finished and len(simulation) == 0
    with pytest.raises(StopIteration):
        simulation.advance()
    assert list(rows[0]) == list(disc_run.history)
    for name in disc_run.history:
        found = np.array([row[name] for row in rows])
        assert np.array_equal(found, disc_run.history[name], equal_nan=True), name


def test_views_keep_their_values(disc: carom.Case) -> None:
    simulation = carom.Simulation(disc)
    nodes = simulation.bodies["disc"]
    before, velocity = simulation.y, simulation.v
    assert before.shape == simulation.reference.shape == (len(before), 2)
    for array in (before, simulation.a, simulation.reference):
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 1.0
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.setflags(write=True)
    copy = before.copy()
    simulation.advance()
    assert np.array_equal(before, copy) and not np.array_equal(simulation.y, copy)
    # Free flight: y = X + v t, without gravity and before contact.
    moved = simulation.y[nodes] - copy[nodes]
    assert np.allclose(moved, velocity[nodes] * simulation.time, atol=1e-12)


def test_energies_and_contacts(disc: carom.Case) -> None:
    simulation = carom.Simulation(disc)
    # The mesh has quadratic arcs, and so a little less area than the disc.
    start = simulation.energies["total"]
    assert start == pytest.approx(0.5 * 0.25 * np.pi * 0.25 * 4.0, rel=2e-3)
    while not simulation.contacts.rows:
        simulation.advance()
    energies = simulation.energies
    assert energies["total"] == energies["kinetic"] + energies["strain"] + energies["potential"]
    # Conserved but for what the scheme dissipates.
    kept = energies["total"] + energies["dissipation"] - energies["contact_work"]
    assert kept == pytest.approx(start, rel=1e-12)
    contacts = simulation.contacts
    assert contacts.units["gap"] == "m" and contacts.units["traction"] == "N"
    force = -(contacts["multiplier"] * contacts["normal_y"]).sum()
    assert force == pytest.approx(simulation.row["contact_force_y"], rel=1e-9)


def test_restored_states_continue_bitwise(disc: carom.Case) -> None:
    simulation = carom.Simulation(disc)
    for _ in range(10):
        simulation.advance()
    checkpoint = simulation.checkpoint()
    penetration = simulation.row["penetration"]
    positions = [simulation.advance() and simulation.y for _ in range(5)]
    simulation.restore(checkpoint)
    assert simulation.step == 10
    # No step has led to it.
    assert simulation.row["penetration"] == penetration and simulation.row["newton"] == 0.0
    again = [simulation.advance() and simulation.y for _ in range(5)]
    other = carom.Simulation(disc, threads=2)
    other.restore(checkpoint)
    elsewhere = [other.advance() and other.y for _ in range(5)]
    for first, second, third in zip(positions, again, elsewhere):
        assert np.array_equal(first, second) and np.array_equal(first, third)
    finer = disc_dict()
    finer["body"][0]["mesh"]["size"] = 0.2
    with pytest.raises(ValueError, match="another case: its bodies"):
        carom.Simulation(carom.Case.from_dict(finer)).restore(checkpoint)
    with pytest.raises(ValueError, match="not a checkpoint"):
        simulation.restore(b"nothing")
    with pytest.raises(ValueError, match="not a checkpoint: 4 bytes follow"):
        simulation.restore(checkpoint + b"junk")


@pytest.mark.parametrize(
    "key, value, told",
    [
        ("time.step", 1e-2, r"time\.step is 0\.005, and that of this simulation is 0\.01"),
        ("time.scheme.rho_inf", 0.4, "rho_inf is 0.5"),
        ("material.rubber.mu", 16.0, "mu is 15.0"),
    ],
)
def test_a_checkpoint_of_another_case_is_refused(disc: carom.Case, key: str, value: float, told: str) -> None:
    simulation = carom.Simulation(disc)
    simulation.advance()
    other = carom.Simulation(disc.copy().set(key, value))
    with pytest.raises(ValueError, match=told):
        other.restore(simulation.checkpoint())
    assert other.step == 0


def test_vectors_in_space() -> None:
    """Three columns, and free flight: y = X + v t."""
    from test_plot import cube

    simulation = carom.Simulation(cube())
    simulation.advance()
    assert simulation.y.shape == simulation.v.shape == simulation.a.shape == simulation.reference.shape == (64, 3)
    moved = simulation.y - simulation.reference
    assert np.allclose(moved, np.array([0.0, 0.0, -2.0]) * simulation.time, atol=1e-12)
    for _ in simulation:
        pass
    contacts = simulation.contacts
    assert contacts.rows and np.allclose(contacts["normal_z"], 1.0)
    force = -(contacts["multiplier"] * contacts["normal_z"]).sum()
    assert force == pytest.approx(simulation.row["contact_force_z"], rel=1e-9)
