"""Errors of the package."""

from __future__ import annotations

from typing import Any


class Error(Exception):
    """Any error of Carom."""


class CaseError(Error, ValueError):
    """A case is wrong. The text is that of the command line: place, reason and what to try."""


class RecordError(Error):
    """A run or study directory is damaged, not one, or cannot be used in this way."""


class StoppedError(Error):
    """The simulation cannot continue.

    Attributes
    ----------
    run : Run or None
        The record up to the last accepted step; ``None`` from `Simulation.advance`, whose state is
        still that of the last accepted step.
    """

    # A `Run`, whose module imports this one.
    run: Any = None
