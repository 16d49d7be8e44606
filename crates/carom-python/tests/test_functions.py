"""Python functions as loads and motions of supports, against the same as formulas."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import carom


def block(**tables: Any) -> carom.Case:
    """A block on a floor, without contact."""
    return carom.Case.from_dict(
        {
            "dimension": 2,
            "plane": "strain",
            "material": [
                {"name": "rubber", "law": "neo-hookean", "density": 0.25, "lambda": 200.0, "mu": 15.0}
            ],
            "body": [
                {
                    "name": "block",
                    "material": "rubber",
                    "element": "T6",
                    "mesh": {"shape": "rectangle", "min": [0.0, 0.0], "max": [1.0, 0.5], "cells": [4, 2]},
                }
            ],
            "support": [{"name": "floor", "on": ["block.bottom"], "fix": ["x", "y"]}],
            "time": {"end": 0.05, "step": 1e-3, "scheme": {"kind": "chung-hulbert", "rho_inf": 0.5}},
            "output": {"checkpoint_every": 10},
        }
        | tables
    )


def push(t: float, x: np.ndarray) -> np.ndarray:
    return -20.0 * np.sin(40.0 * t) * (1.0 + x[:, 0])


PUSH = "-20*sin(40*t)*(1 + X)"


def shake(t: float, x: np.ndarray) -> tuple[float, float, float]:
    return 0.01 * np.sin(60 * t), 0.6 * np.cos(60 * t), -36.0 * np.sin(60 * t)


@pytest.mark.parametrize(
    "load",
    [
        lambda f: {"on": ["block.top"], "traction": [0.0, f]},
        lambda f: {"on": ["block.top"], "pressure": f},
        lambda f: {"body": "block", "body_force": [f, 0.0]},
    ],
)
def test_loads(load: Any) -> None:
    given = block(load=[load(push)]).run(progress=False)
    written = block(load=[load(PUSH)]).run(progress=False)
    assert np.abs(written.history["block.center_y"] - written.history["block.center_y"][0]).max() > 1e-6
    for name in ("block.center_x", "block.center_y", "external_work", "total"):
        scale = np.abs(written.history[name]).max()
        assert np.allclose(given.history[name], written.history[name], rtol=0, atol=1e-12 * scale)


def test_motions() -> None:
    moved = {"name": "floor", "on": ["block.bottom"], "fix": ["y"]}
    given = block(support=[moved | {"move": {"x": shake}}]).run(progress=False)
    written = block(support=[moved | {"move": {"x": "0.01*sin(60*t)"}}]).run(progress=False)
    for name in ("block.center_x", "floor.reaction_x", "external_work"):
        scale = np.abs(written.history[name]).max()
        assert scale > 0
        assert np.allclose(given.history[name], written.history[name], rtol=0, atol=1e-11 * scale)


def test_one_call_per_evaluation() -> None:
    calls: list[tuple[float, tuple[int, ...]]] = []

    class Recorder:
        def __call__(self, t: float, x: np.ndarray) -> float:
            calls.append((t, x.shape))
            return 1.0

    case = block(load=[{"on": ["block.top"], "traction": [0.0, Recorder()]}])
    case.run(progress=False)
    assert len({shape for _, shape in calls}) == 1 and calls[0][1][1] == 2
    # At the start, and once per step.
    assert len(calls) <= 2 * 50 + 5, len(calls)


def test_exceptions_come_through() -> None:
    def broken(t: float, x: np.ndarray) -> float:
        if t > 0.01:
            raise RuntimeError("the sensor is gone")
        return 0.0

    case = block(load=[{"on": ["block.top"], "traction": [0.0, broken]}])
    with pytest.raises(RuntimeError, match="the sensor is gone"):
        case.run(progress=False)
    simulation = carom.Simulation(case)
    with pytest.raises(RuntimeError, match="the sensor is gone"):
        for _ in simulation:
            pass

    # The state is not there within a step; asking for it must not wait for ever.
    held: list[carom.Simulation] = []
    case = block(load=[{"on": ["block.top"], "traction": [0.0, lambda t, x: held[0].y[0, 0] if held else 0.0]}])
    held.append(carom.Simulation(case))
    with pytest.raises(RuntimeError, match="is being advanced"):
        held[0].advance()

    wrong = block(load=[{"on": ["block.top"], "traction": [0.0, lambda t, x: [1.0, 2.0]]}])
    with pytest.raises(ValueError, match="must return a number per point"):
        wrong.run(progress=False)


SCRIPT = """
import sys
sys.path.insert(0, sys.argv[2])
from test_functions import block, push
block(load=[{"on": ["block.top"], "traction": [0.0, push]}]).set({"time.step": 2e-5}).run(
    sys.argv[1], page=False, progress=False
)
"""


def test_a_run_is_resumed_with_the_same_function_only(tmp_path: Path) -> None:
    """Killed in the middle; resumed without the function, with another one, and with the same."""
    case = block(load=[{"on": ["block.top"], "traction": [0.0, push]}]).set({"time.step": 2e-5})
    case.run(tmp_path / "whole", page=False, progress=False)
    here = str(Path(__file__).parent)
    process = subprocess.Popen([sys.executable, "-c", SCRIPT, str(tmp_path / "killed"), here])
    for _ in range(1000):
        time.sleep(0.01)
        if len(list((tmp_path / "killed/checkpoint").glob("*"))) > 1:
            break
    process.kill()
    process.wait()
    assert carom.open(tmp_path / "killed").status == "running"

    def other(t: float, x: np.ndarray) -> float:
        return 0.0

    for functions in ((), (other,)):
        with pytest.raises(carom.CaseError, match="the function `push:.*` is not given"):
            carom.resume(tmp_path / "killed", *functions, page=False, progress=False)
    carom.resume(tmp_path / "killed", push, page=False, progress=False)
    assert (tmp_path / "killed/history.csv").read_bytes() == (tmp_path / "whole/history.csv").read_bytes()


def test_the_command_refuses_functions(tmp_path: Path, command: str) -> None:
    text = block(load=[{"on": ["block.top"], "traction": [0.0, push]}]).to_toml()
    told = subprocess.run(
        [command, "run", "-", "--out", str(tmp_path / "no")], input=text, text=True, capture_output=True
    )
    assert told.returncode == 2 and "is not given" in told.stderr and "^" in told.stderr
    with pytest.raises(carom.CaseError, match="is not given"):
        carom.Case.from_text(text).run(progress=False)


def test_checkpoints_keep_to_their_functions() -> None:
    def other(t: float, x: np.ndarray) -> np.ndarray:
        return -21.0 * np.sin(40.0 * t) * (1.0 + x[:, 0])

    def simulation(function: Any) -> carom.Simulation:
        return carom.Simulation(block(load=[{"on": ["block.top"], "traction": [0.0, function]}]))

    first = simulation(push)
    first.advance()
    checkpoint = first.checkpoint()
    simulation(push).restore(checkpoint)
    with pytest.raises(carom.CaseError, match="other functions"):
        simulation(other).restore(checkpoint)


def test_the_same_code_has_the_same_name() -> None:
    from carom.functions import name_of

    def made(factor: float) -> Any:
        return lambda t, x: factor * t

    assert name_of(made(1.0)) == name_of(made(1.0)) != name_of(made(2.0))
    assert name_of(push).startswith("push:")
