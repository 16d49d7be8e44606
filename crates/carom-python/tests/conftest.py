"""Cases for all tests: small, with exact solutions."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import pytest

import carom

#: The root of the repository.
ROOT = Path(__file__).resolve().parents[3]


def bar_dict() -> dict[str, Any]:
    """A bar of density 1 and stiffness 900 (c = 30) thrown at a wall at speed 10. Exact: the impulse
    is 2 m v = 200, and contact lasts 2 L / c = 2/3."""
    return {
        "title": "Bar on a wall",
        "dimension": 1,
        "material": [{"name": "steel", "law": "linear-elastic", "density": 1.0, "young": 900.0, "poisson": 0.0}],
        "body": [
            {
                "name": "bar",
                "material": "steel",
                "element": "L2",
                "mesh": {"shape": "interval", "min": 0.1, "max": 10.1, "cells": 100},
                "velocity": [-10.0],
            }
        ],
        "contact": [
            {"name": "wall", "secondary": "bar.left", "primary": {"plane": {"point": [0.0], "normal": [1.0]}}}
        ],
        "probe": [{"name": "tip", "body": "bar", "at": [10.1], "record": ["ux", "vx", "sigma_xx"]}],
        "time": {"end": 1.5, "step": 0.002, "scheme": {"kind": "chung-hulbert", "rho_inf": 0.6}},
    }


def disc_dict() -> dict[str, Any]:
    """The disc of the README, on a coarse mesh, with fields."""
    return {
        "title": "A disc thrown on a block",
        "dimension": 2,
        "plane": "strain",
        "material": [{"name": "rubber", "law": "neo-hookean", "density": 0.25, "lambda": 200.0, "mu": 15.0}],
        "body": [
            {
                "name": "disc",
                "material": "rubber",
                "element": "T6",
                "mesh": {"shape": "disc", "radius": 0.5, "center": [0.0, 0.52], "size": 0.3},
                "velocity": [0.0, -2.0],
            },
            {
                "name": "block",
                "material": "rubber",
                "element": "T6",
                "mesh": {"shape": "rectangle", "min": [-1.0, -0.5], "max": [1.0, 0.0], "cells": [6, 2]},
            },
        ],
        "support": [{"name": "floor", "on": ["block.bottom"], "fix": ["x", "y"]}],
        "contact": [{"name": "strike", "secondary": "disc.arc", "primary": "block.top"}],
        "probe": [{"name": "top", "body": "disc", "at": [0.0, 1.02], "record": ["uy", "sigma_yy"]}],
        "time": {"end": 0.3, "step": 5e-3, "scheme": {"kind": "chung-hulbert", "rho_inf": 0.5}},
        "output": {"fields_every": 5},
        "expect": [{"what": "restitution", "at_least": 0.5, "source": "rubber rebounds"}],
    }


@pytest.fixture
def bar() -> carom.Case:
    return carom.Case.from_dict(bar_dict())


@pytest.fixture
def disc() -> carom.Case:
    return carom.Case.from_dict(disc_dict())


@pytest.fixture(scope="session")
def disc_run() -> carom.Run:
    return carom.Case.from_dict(disc_dict()).run(progress=False)


@pytest.fixture(scope="session")
def command() -> str:
    """The command line: `CAROM`, or the one of this repository."""
    found = os.environ.get("CAROM") or str(ROOT / "target/release/carom")
    if not shutil.which(found):
        pytest.skip("the command carom is not built")
    return found
