"""Python functions as loads and motions of supports, against the same as formulas."""

from __future__ import annotations

import subprocess
import sys
import time
import types
from functools import lru_cache, partial
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


class Constant:
    def __init__(self, value: float) -> None:
        self.value = value

    def __call__(self, t: float, x: np.ndarray) -> float:
        return self.value


def scaled(t: float, x: np.ndarray, *, factor: float) -> float:
    return factor


def enclosing(value: object) -> Any:
    return lambda t, x: value.value if isinstance(value, Constant) else value  # type: ignore[return-value]


class Counter:
    """A value that changes with every call."""

    def __init__(self) -> None:
        self.count = 0

    def __call__(self, t: float, x: np.ndarray) -> float:
        self.count += 1
        return 0.0


def with_keyword(value: float) -> Any:
    def function(t: float, x: np.ndarray, *, factor: float = value) -> float:
        return factor

    return function


#: Functions of one code with another value with them.
MADE: dict[str, Any] = {
    "attribute": Constant,
    "partial": lambda value: partial(scaled, factor=value),
    "vectorize": lambda value: (lambda f: lambda t, x: f(x[:, 0]))(np.vectorize(lambda x: value)),
    "closure": lambda value: enclosing(Constant(value)),
    "keyword": with_keyword,
    "method": lambda value: Constant(value).__call__,
}


@pytest.mark.parametrize("made", MADE.values(), ids=MADE.keys())
def test_functions_of_one_code_are_told_apart(made: Any) -> None:
    """Against the same loads as numbers: momentum is the integral of the force, of both components."""

    def momentum(traction: list[Any]) -> list[float]:
        run = block(load=[{"on": ["block.top"], "traction": traction}], support=[]).run(progress=False)
        return [float(run.history[name][-1]) for name in ("momentum_x", "momentum_y")]

    found = momentum([made(1.0), made(-1.0)])
    # Top of length 1, for 0.05.
    assert found == pytest.approx([0.05, -0.05], rel=1e-9)
    assert found == pytest.approx(momentum([1.0, -1.0]), rel=1e-12)


def test_names_depend_on_all_that_a_function_has_with_it() -> None:
    from carom.functions import name_of

    def two(first: object, second: object) -> Any:
        return lambda t, x: (first, second)

    pairs = [
        (enclosing({1}), enclosing({2})),
        (two(12, 3), two(1, 23)),
        (two((1,), 2), two((1, 2), ())),
        (lru_cache(lambda t, x: 1.0), lru_cache(lambda t, x: 2.0)),
        (np.sin, np.cos),
        (two(np.array([1, 2]), 0), two(np.array([1, 3]), 0)),
        (two({"a": 1}, 0), two({"a": 2}, 0)),
    ]
    for first, second in pairs:
        assert name_of(first).split(":")[1] != name_of(second).split(":")[1], (first, second)


def test_a_function_may_call_itself() -> None:
    from carom.functions import name_of

    def made(last: int) -> Any:
        def steps(t: float, x: np.ndarray) -> float:
            return 0.0 if t < last else steps(t - 1.0, x)

        return steps

    def unset() -> Any:
        def function(t: float, x: np.ndarray) -> float:
            return later

        name = name_of(function)
        later = 1.0
        return name

    assert name_of(made(1)) == name_of(made(1)) != name_of(made(2))
    assert unset().startswith("function:")


def test_two_functions_that_begin_alike_are_two() -> None:
    first, second = Counter(), Counter()
    block(load=[{"on": ["block.top"], "traction": [first, second]}]).run(progress=False)
    assert first.count == second.count > 50
    # One function in two places is one.
    both = Counter()
    text = block(load=[{"on": ["block.top"], "traction": [both, both]}]).to_toml()
    assert "#2" not in text


def test_replaced_functions_are_forgotten() -> None:
    """The names of a case are those of its text, however it came to it."""
    load = [{"name": "press", "on": ["block.top"], "traction": [0.0, push]}]
    fresh = block(load=load)
    changed = block(load=[load[0] | {"traction": [0.0, lambda t, x: 1.0]}]).set("load.press.traction", [0.0, push])
    # As when a cell of a notebook is run again.
    again = types.FunctionType(push.__code__, push.__globals__, "push")
    changed.set("load.press.traction", [0.0, again])
    assert list(changed._functions) == list(fresh._functions)
    simulation = carom.Simulation(changed)
    simulation.advance()
    carom.Simulation(fresh).restore(simulation.checkpoint())


class Gain:
    def __init__(self, gain: float) -> None:
        self.gain = gain

    def __call__(self, t: float, x: np.ndarray) -> float:
        return self.gain * t

    def force(self, t: float, x: np.ndarray) -> float:
        return self.gain * t


def test_the_same_code_has_the_same_name() -> None:
    """What a function encloses, its defaults and attributes count; other objects of them do not."""
    from functools import partial

    from carom.functions import name_of

    def enclosing(factor: float) -> Any:
        return lambda t, x: factor * t

    def defaults(factor: float) -> Any:
        def push(t: float, x: np.ndarray, *, scale: float = factor) -> float:
            return scale * t

        return push

    def scaled(scale: float, t: float, x: np.ndarray) -> float:
        return scale * t

    def recursive(factor: float) -> Any:
        def push(t: float, x: np.ndarray) -> float:
            return factor if t < 1 else push(t - 1, x)

        return push

    makers = [
        enclosing, defaults, recursive, Gain,
        lambda factor: Gain(factor).force,
        lambda factor: partial(scaled, factor),
    ]  # fmt: skip
    for made in makers:
        assert name_of(made(1.0)) == name_of(made(1.0)) != name_of(made(2.0))
    assert len({name_of(made(1.0)) for made in makers}) == len(makers)
    assert name_of(np.sin) != name_of(np.cos)
    assert name_of(push).startswith("push:")


def test_functions_of_time_only() -> None:
    """f(t), with values of its own as defaults, is f(t, X) without X."""

    def momentum(load: Any) -> float:
        run = block(load=[{"on": ["block.top"], "traction": [load, 0.0]}], support=[]).run(progress=False)
        return float(run.history["momentum_x"][-1])

    expected = momentum("3*sin(40*t)")
    assert expected != 0
    for load in (
        lambda t: 3.0 * np.sin(40.0 * t),
        lambda t, gain=3.0: gain * np.sin(40.0 * t),
        lambda t, x: 3.0 * np.sin(40.0 * t),
        lambda *arguments: 3.0 * np.sin(40.0 * arguments[0]) + 0.0 * arguments[1][:, 0],
        partial(lambda gain, t: gain * np.sin(40.0 * t), 3.0),
    ):
        assert momentum(load) == pytest.approx(expected, rel=1e-12)
    # Universal functions have another meaning for their second argument.
    assert momentum(np.sin) == pytest.approx(momentum("sin(t)"), rel=1e-12)
    moved = {"name": "floor", "on": ["block.bottom"], "fix": ["y"]}
    of_time, of_both = (
        block(support=[moved | {"move": {"x": f}}]).run(progress=False) for f in (lambda t: shake(t, t), shake)
    )
    assert np.array_equal(of_time.history["block.center_x"], of_both.history["block.center_x"])
    for wrong in (lambda: 0.0, lambda t, x, y: 0.0):
        with pytest.raises(carom.CaseError, match="arguments without default\ntry: f"):
            block(load=[{"on": ["block.top"], "traction": [0.0, wrong]}])
