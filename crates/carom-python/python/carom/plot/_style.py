"""Sizes, fonts and colours."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TypeAlias

import matplotlib
import matplotlib.pyplot as plt
from cycler import cycler
from matplotlib.axes import Axes

Size: TypeAlias = str | tuple[float, float]

#: Line colours of M. Okabe and K. Ito, "Color Universal Design", black first, without yellow; those
#: of Carom's report pages.
LINES = ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]

#: Shade of contact episodes.
CONTACT = "#56b4e9"

_SIZES = {"single": (3.39, 2.4), "double": (7.0, 3.2)}

_SETTINGS: Any = {
    "axes.prop_cycle": cycler(color=LINES),
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.labelsize": 8,
    "axes.titlesize": 8,
    "figure.dpi": 150,
    "font.size": 8,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "lines.linewidth": 1.1,
    "savefig.dpi": 300,
    "svg.fonttype": "none",
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
}


@contextmanager
def style() -> Iterator[None]:
    """Matplotlib settings of these figures, for own ones: ``with carom.plot.style(): …``."""
    # Only these: `rc_context` would also undo the backend that notebooks choose at the first
    # figure.
    before = {name: matplotlib.rcParams[name] for name in _SETTINGS}
    matplotlib.rcParams.update(_SETTINGS)
    try:
        yield
    finally:
        matplotlib.rcParams.update(before)


def axes(ax: Axes | None, size: Size) -> Axes:
    """The given Axes, or those of a new figure."""
    if ax is not None:
        return ax
    if isinstance(size, str):
        if size not in _SIZES:
            raise ValueError(f"size is one of {', '.join(_SIZES)}, or (width, height) in inches, not {size!r}")
        size = _SIZES[size]
    _, made = plt.subplots(figsize=size, layout="constrained")
    return made


def labelled(name: str, unit: str) -> str:
    """A name with its unit."""
    return f"{name} ({unit})" if unit else name
