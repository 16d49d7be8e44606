"""Comparison with measured data."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from ..run import Run
from ._style import LINES, Size, style
from ._time import history


@dataclass(frozen=True)
class MeasuredError:
    """Deviation of a run from measured data.

    Attributes
    ----------
    rms : float
        Root mean square of the differences at the measured times, in the unit of the column.
    nrms : float
        The same divided by the range of the measured values.
    r2 : float
        Coefficient of determination.
    samples : int
        Number of measured values within the time of the run.
    """

    rms: float
    nrms: float
    r2: float
    samples: int


def measured_error(run: Run, column: str, times: ArrayLike, values: ArrayLike) -> MeasuredError:
    """The deviation of a column from measured values.

    Parameters
    ----------
    run : Run
        The run; its column is interpolated linearly.
    column : str
        The column.
    times, values : array_like, shape (samples,)
        Measured data in the units of the case. Samples outside the time of the run are ignored.

    Returns
    -------
    MeasuredError
        The deviation.
    """
    t, x = np.asarray(times, dtype=float), np.asarray(values, dtype=float)
    if t.shape != x.shape or t.ndim != 1:
        raise ValueError(f"times and values must be lists of one length, not of shapes {t.shape} and {x.shape}")
    own = run.history["time"]
    inside = (t >= own[0]) & (t <= own[-1]) & np.isfinite(x)  # not where t or x is NaN
    if inside.sum() < 2:
        raise ValueError(f"fewer than two samples are within the time of the run, {own[0]:g} to {own[-1]:g}")
    t, x = t[inside], x[inside]
    off = np.interp(t, own, run.history[column]) - x
    rms, spread = float(np.sqrt(np.mean(off**2))), float(np.ptp(x))
    variance = float(np.mean((x - x.mean()) ** 2))
    return MeasuredError(
        rms=rms,
        nrms=rms / spread if spread else np.nan,
        r2=1 - rms**2 / variance if variance else np.nan,
        samples=int(inside.sum()),
    )


def overlay(
    run: Run,
    column: str,
    measured: str | PathLike[str] | tuple[ArrayLike, ArrayLike],
    *,
    label: str = "measured",
    ax: Axes | None = None,
    size: Size = "single",
) -> Axes:
    """A column with measured data, and its error in the legend (see `measured_error`).

    Parameters
    ----------
    run : Run
        The run.
    column : str
        The column.
    measured : str, PathLike or tuple of array_like, shape (samples,)
        A CSV file whose first two columns are time and value, with or without a header, separated
        by commas, or by semicolons or tabs and then also with decimal commas; or (times, values).
        In the units of the case.
    label : str
        What the data are called in the legend.
    ax : Axes, optional
        Where to draw; by default a new figure.
    size : str or (float, float)
        Of a new figure: ``"single"``, ``"double"`` or (width, height) in inches.

    Returns
    -------
    Axes
        The Axes.
    """
    times, values = measured if isinstance(measured, tuple) else _read(measured)
    error = measured_error(run, column, times, values)
    ax = history(run, column, events=False, ax=ax, size=size)
    name = f"{label} (NRMS {100 * error.nrms:.2g} %)"
    with style():
        ax.plot(times, values, "o", ms=3, mfc="none", mew=0.8, color=LINES[2], label=name)
        ax.legend()
    return ax


def _read(path: str | PathLike[str]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The first two columns; values that are missing are NaN."""
    lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    # A comma is decimal where something else separates.
    mark = next((mark for mark in ";\t," if any(mark in line for line in lines)), " ")
    rows: list[tuple[float, float]] = []
    for number, cells in enumerate(csv.reader(lines, delimiter=mark, skipinitialspace=True), 1):
        numbers = [_number(cell if mark == "," else cell.replace(",", ".")) for cell in cells[:2]]
        if len(numbers) == 2 and numbers[0] is not None and numbers[1] is not None:
            rows.append((numbers[0], numbers[1]))
        elif rows and any(cells):
            # Above the first row are names and units.
            raise ValueError(f"{path}:{number} is no row of numbers: {lines[number - 1]!r}")
    if not rows:
        raise ValueError(f"{path} has no rows of numbers; give time and value in its first two columns")
    times, values = np.array(rows).T
    return times, values


def _number(cell: str) -> float | None:
    try:
        return float(cell) if cell.strip() else np.nan
    except ValueError:
        return None
