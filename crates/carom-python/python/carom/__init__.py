"""Impact and contact of deformable solids by the positional finite element method.

A bar of length 10 strikes a rigid wall at speed 10; its waves have the speed 30, so that it is in
contact from t = 0.5 for 2/3:

>>> import carom
>>> case = carom.Case.from_file("cases/bar/single.toml")
>>> run = case.set("time.scheme.rho_inf", 0.6).run(progress=False)
>>> round(run.metrics["contact_start"], 2), round(run.metrics["contact_duration"], 2)
(0.5, 0.67)

Units are those of the case, whose labels every table carries. Arrays are read-only.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from ._carom import __version__
from .case import Case
from .errors import CaseError, Error, RecordError, StoppedError
from .explained import explain, schemes
from .run import Expectation, Metrics, Run, open, resume
from .simulation import Simulation, Step
from .study import Study, study
from .table import Table

if TYPE_CHECKING:
    from . import export, plot

__all__ = [
    "Case",
    "CaseError",
    "Error",
    "Expectation",
    "Metrics",
    "RecordError",
    "Run",
    "Simulation",
    "Step",
    "StoppedError",
    "Study",
    "Table",
    "__version__",
    "explain",
    "export",
    "open",
    "plot",
    "resume",
    "schemes",
    "study",
]


def __getattr__(name: str) -> Any:
    # Matplotlib is imported only by those who plot.
    if name in ("export", "plot"):
        return importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module 'carom' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
