"""Laws of one's own."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import carom

Array = NDArray[np.float64]


# ANCHOR: law
class Damage:
    """Neo-Hookean material, of which damage leaves the share threshold/history of its stiffness."""

    memory = 1

    def __init__(self, lame: float, mu: float, threshold: float) -> None:
        self.lame, self.mu, self.threshold = lame, mu, threshold

    def response(self, F: Array, memory: Array) -> tuple[float, float, Array, Array, list[float]]:
        G = np.linalg.inv(F).T
        log = np.log(np.linalg.det(F))
        energy = 0.5 * self.mu * (np.sum(F * F) - 3.0 - 2.0 * log) + 0.5 * self.lame * log**2
        P = self.mu * (F - G) + self.lame * log * G
        A = self.mu * np.einsum("ik,jl->ijkl", np.eye(3), np.eye(3))
        A = A + self.lame * np.einsum("ij,kl->ijkl", G, G)
        A = A + (self.mu - self.lame * log) * np.einsum("il,kj->ijkl", G, G)
        start = max(memory[0], self.threshold)
        history = max(start, energy)
        intact = self.threshold / history
        lost = self.threshold * np.log(history / start)
        if energy > start:
            A = A - np.einsum("ij,kl->ijkl", P, P) / history
        return intact * energy, lost, intact * P, intact * A, [history]
# ANCHOR_END: law


def bar(**changes: Any) -> carom.Case:
    case = {
        "title": "A bar that is damaged",
        "dimension": 1,
        "material": [{"name": "m", "law": "neo-hookean", "density": 1.0, "lambda": 0.5, "mu": 1.0}],
        "body": [
            {
                "name": "bar",
                "material": "m",
                "element": "L2",
                "mesh": {"shape": "interval", "min": 0.0, "max": 1.0, "cells": 2},
            }
        ],
        "support": [
            {"on": ["bar.left"], "fix": ["x"]},
            {"name": "grip", "on": ["bar.right"], "move": {"x": "0.4*sin(3*t)"}},
        ],
        "time": {"end": 2.0, "step": 0.02, "scheme": {"kind": "static"}},
    }
    return carom.Case.from_dict({**case, **changes})


def test_stress_of_a_damaged_bar() -> None:
    """P = intact · (μ (λ − 1/λ) + Λ ln λ/λ) with the largest energy so far."""
    simulation = carom.Simulation(bar(), threads=1, laws={"m": Damage(0.5, 1.0, 0.02)})
    history = 0.02
    for step in simulation:
        stretch = 1.0 + 0.4 * math.sin(3.0 * step.time)
        log = math.log(stretch)
        energy = 0.5 * (stretch**2 - 1.0) - log + 0.25 * log**2
        history = max(history, energy)
        expected = 0.02 / history * (stretch - 1.0 / stretch + 0.5 * log / stretch)
        assert abs(simulation.row["grip.reaction_x"]) == pytest.approx(abs(expected), abs=1e-9)
    assert history > 0.05


def test_a_law_without_damage_is_the_one_of_the_case() -> None:
    case = bar(time={"end": 1.0, "step": 0.05, "scheme": {"kind": "energy-momentum"}})
    runs = [carom.Simulation(case, threads=2, laws=laws) for laws in ({}, {"m": Damage(0.5, 1.0, 1e9)})]
    for simulation in runs:
        for _ in simulation:
            pass
    assert np.allclose(runs[0].y, runs[1].y, atol=1e-12)


def test_exceptions_of_a_law_are_raised() -> None:
    class Wrong(Damage):
        def response(self, F: Array, memory: Array) -> Any:
            if F[0, 0] > 1.1:
                raise ArithmeticError("too much")
            return super().response(F, memory)

    simulation = carom.Simulation(bar(), laws={"m": Wrong(0.5, 1.0, 0.02)})
    with pytest.raises(ArithmeticError, match="too much"):
        for _ in simulation:
            pass
    with pytest.raises(AttributeError):
        carom.Simulation(bar(), laws={"m": object()})


def test_rows_and_checkpoints_of_plane_stress() -> None:
    """The thickness follows from the law, which rows ask for on other threads."""
    plate = bar(
        dimension=2,
        plane="stress",
        body=[
            {
                "name": "bar",
                "material": "m",
                "element": "Q4",
                "mesh": {"shape": "rectangle", "min": [0.0, 0.0], "max": [1.0, 1.0], "cells": [2, 2]},
            }
        ],
        support=[
            {"on": ["bar.left"], "fix": ["x"]},
            {"on": ["bar.bottom"], "fix": ["y"]},
            {"name": "grip", "on": ["bar.right"], "move": {"x": "0.1*t"}},
        ],
        time={"end": 0.2, "step": 0.1, "scheme": {"kind": "static"}},
    )
    simulation = carom.Simulation(plate, threads=2, laws={"m": Damage(0.5, 1.0, 10.0)})
    given = carom.Simulation(plate, threads=2)
    for _, _ in zip(simulation, given):
        assert simulation.row["grip.reaction_x"] == pytest.approx(given.row["grip.reaction_x"], rel=1e-9)
        assert simulation.row["min_det_f"] == pytest.approx(given.row["min_det_f"], rel=1e-9)
    checkpoint = simulation.checkpoint()

    class Other(Damage):
        scale = 2.0

    for laws in [{}, {"m": Damage(0.5, 2.0, 10.0)}, {"m": Other(0.5, 1.0, 10.0)}]:
        with pytest.raises(carom.CaseError, match="other laws: m"):
            carom.Simulation(plate, laws=laws).restore(checkpoint)
    carom.Simulation(plate, laws={"m": Damage(0.5, 1.0, 10.0)}).restore(checkpoint)
