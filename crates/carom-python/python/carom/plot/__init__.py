"""Figures of runs on Matplotlib, in journal sizes and colours for colour-blind readers.

Every function draws into ``ax``, or into a new figure, and returns the Axes. ``size`` is
``"single"`` (one column, 86 mm), ``"double"`` (178 mm) or (width, height) in inches.
"""

from __future__ import annotations

from ._measured import MeasuredError, measured_error, overlay
from ._space import animate, pressure_map, snapshot
from ._style import LINES, style
from ._time import compare, energy, history

__all__ = [
    "LINES",
    "MeasuredError",
    "animate",
    "compare",
    "energy",
    "history",
    "measured_error",
    "overlay",
    "pressure_map",
    "snapshot",
    "style",
]
