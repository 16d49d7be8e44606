"""Figures over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from matplotlib.axes import Axes

from ..run import Run
from ._style import CONTACT, Size, axes, labelled, style

#: Kinds of events that are marked, with their marks on the time axis.
_MARKS = {"rejected": ("v", "rejected step"), "overlap": ("X", "overlap"), "stopped": ("s", "stop")}


#: What a probe records along an axis, by the first letter of the column.
_VECTORS = {"u": "displacement", "v": "velocity", "a": "acceleration"}


def history(
    run: Run,
    *columns: str,
    events: bool = True,
    ax: Axes | None = None,
    size: Size = "single",
) -> Axes:
    """Columns over time, with contact episodes shaded and events marked.

    Parameters
    ----------
    run : Run
        The run.
    *columns : str
        Names of columns with one unit; without any, the contact force.
    events : bool
        Whether rejected steps, overlaps and the place of a stop are marked below the lines.
    ax : Axes, optional
        Where to draw; by default a new figure.
    size : str or (float, float)
        Of a new figure: ``"single"``, ``"double"`` or (width, height) in inches.

    Returns
    -------
    Axes
        The Axes.
    """
    names = columns or (_force(run),)
    # An unknown name is an error of the table, with the names that are nearest.
    values = [run.history[name] for name in names]
    units = {run.history.units[name] for name in names}
    if len(units) > 1:
        raise ValueError(f"these columns have different units: {', '.join(sorted(units))}; draw two figures")
    with style():
        ax = axes(ax, size)
        for name, column in zip(names, values, strict=True):
            ax.plot(run.history["time"], column, label=name)
        shade_contact(run, ax)
        if events:
            _mark_events(run, ax)
        _finish(run, ax, names)
    return ax


def energy(run: Run, *, ax: Axes | None = None, size: Size = "single") -> Axes:
    """The energy ledger: kinetic, strain and potential energy, their total, works, dissipation.

    Terms that are zero throughout are left out.

    Parameters
    ----------
    run : Run
        The run.
    ax : Axes, optional
        Where to draw; by default a new figure.
    size : str or (float, float)
        Of a new figure: ``"single"``, ``"double"`` or (width, height) in inches.

    Returns
    -------
    Axes
        The Axes.
    """
    # The columns of the ledger follow one another, but that of plastic flow.
    names = list(run.history)
    terms = names[names.index("kinetic") : names.index("dissipation") + 1]
    terms += [name for name in ("plastic_work",) if name in names]
    with style():
        ax = axes(ax, size)
        time = run.history["time"]
        for name in terms:
            values = run.history[name]
            if not (values == 0).all():
                ax.plot(time, values, label=name.replace("_", " "))
        shade_contact(run, ax)
        ax.axhline(0, color="0.7", lw=0.5, zorder=0)
        ax.set_xlabel(labelled("time", run.history.units["time"]))
        ax.set_ylabel(labelled("energy", run.history.units["kinetic"]))
        ax.margins(x=0)
        ax.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    return ax


def compare(
    runs: Mapping[str, Run] | Sequence[Run],
    column: str,
    *,
    ax: Axes | None = None,
    size: Size = "single",
) -> Axes:
    """One column of several runs; the contact of the first one is shaded.

    Parameters
    ----------
    runs : dict of str to Run, or list of Run
        Runs by their labels, or runs that are labelled by their titles.
    column : str
        The column.
    ax : Axes, optional
        Where to draw; by default a new figure.
    size : str or (float, float)
        Of a new figure: ``"single"``, ``"double"`` or (width, height) in inches.

    Returns
    -------
    Axes
        The Axes.
    """
    named = dict(runs) if isinstance(runs, Mapping) else {run.title: run for run in runs}
    if not named:
        raise ValueError("there are no runs to compare")
    if len(named) < len(runs):
        raise ValueError("two runs have one title; give a dictionary of labels and runs")
    dashes = ["-", "--", "-.", ":"]
    with style():
        ax = axes(ax, size)
        for i, (label, run) in enumerate(named.items()):
            ax.plot(run.history["time"], run.history[column], dashes[i % 4], label=label)
        first = next(iter(named.values()))
        shade_contact(first, ax)
        _finish(first, ax, (column,))
        ax.legend()
    return ax


def shade_contact(run: Run, ax: Axes) -> None:
    """Shade the contact episodes."""
    for start, end in run.episodes:
        ax.axvspan(start, end, color=CONTACT, alpha=0.15, lw=0, zorder=0)


def _mark_events(run: Run, ax: Axes) -> None:
    for kind, (marker, label) in _MARKS.items():
        times = sorted({event["time"] for event in run.log if event["kind"] == kind})
        if times:
            transform = ax.get_xaxis_transform()
            ax.plot(
                times, [0.02] * len(times), marker, color="0.4", ms=3, transform=transform, label=label
            )


def _finish(run: Run, ax: Axes, names: Sequence[str]) -> None:
    unit = run.history.units[names[0]]
    ax.set_xlabel(labelled("time", run.history.units["time"]))
    ax.set_ylabel(labelled(names[0] if len(names) == 1 else _kind(names), unit))
    ax.margins(x=0)
    if len(ax.get_legend_handles_labels()[0]) > 1:
        ax.legend()


def _kind(names: Sequence[str]) -> str:
    """What several columns are: displacement, stress, …"""
    kinds = {_kind_of(name) for name in names}
    return kinds.pop() if len(kinds) == 1 else "value"


def _kind_of(name: str) -> str:
    quantity = name.rpartition(".")[2]
    if len(quantity) == 2 and quantity[0] in _VECTORS and quantity[1] in "xyz":
        return _VECTORS[quantity[0]]
    if quantity.startswith("sigma_") or quantity == "von_mises":
        return "stress"
    without_axis = quantity[:-2] if quantity[-2:] in ("_x", "_y", "_z") else quantity
    return without_axis.replace("_", " ")


def _force(run: Run) -> str:
    """The component of the contact force that is largest."""
    found = [name for name in run.history if name.startswith("contact_force_")]
    return max(found, key=lambda name: float(abs(run.history[name]).max()))
