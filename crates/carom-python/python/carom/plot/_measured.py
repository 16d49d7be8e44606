"""Comparison with measured data."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike

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
    inside = (t >= own[0]) & (t <= own[-1]) & np.isfinite(x)
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
        A CSV file whose first two columns are time and value, with or without a header; or (times,
        values). In the units of the case.
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
    table = np.genfromtxt(path, delimiter=",", usecols=(0, 1), dtype=float)
    table = np.atleast_2d(table)
    # The header, if there is one, is not a number.
    table = table[~np.isnan(table[:, 0])]
    if not len(table):
        raise ValueError(f"{path} has no rows of numbers; give time and value in its first two columns")
    return table[:, 0], table[:, 1]
