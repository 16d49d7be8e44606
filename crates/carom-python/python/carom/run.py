"""Records of runs."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _carom
from .errors import StoppedError
from .fields import Fields
from .functions import name_of
from .progress import progress_bar, thread_count
from .table import Table

if TYPE_CHECKING:
    import pandas as pd
    import polars as pl
    import pyarrow as pa
    import xarray as xr


class Metrics(Mapping[str, float]):
    """Metrics of a run by name; NaN where the record has none.

    Attributes
    ----------
    units, meanings : dict of str to str
        Unit label and meaning of every metric.
    """

    def __init__(self, found: Sequence[tuple[str, float | None, str, str]]) -> None:
        self._values = {name: math.nan if value is None else value for name, value, _, _ in found}
        self.units = {name: unit for name, _, unit, _ in found}
        self.meanings = {name: meaning for name, _, _, meaning in found}

    def __getitem__(self, name: str) -> float:
        if name not in self._values:
            raise KeyError(f"no metric is named {name!r}; the metrics are: {', '.join(self._values)}")
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        lines = [f"{name} = {value:.6g} {self.units[name]}".rstrip() for name, value in self.items()]
        return "\n".join(lines)


@dataclass(frozen=True)
class Expectation:
    """Outcome of an ``[[expect]]``.

    Attributes
    ----------
    what : str
        What was asked: ``min A.uy``.
    expected : str
        The bound: ``-0.7827 ± 0.004``.
    got : float or None
        The value of the record; ``None`` if there is none.
    met : bool
        Whether the bound is satisfied.
    source : str or None
        Where the expected value comes from.
    """

    what: str
    expected: str
    got: float | None
    met: bool
    source: str | None


class Run:
    """The record of a run, in memory or read from its directory.

    Attributes
    ----------
    history : Table
        One row per recorded step: energies, contact force, probes, … Columns have the shape (rows,)
        and are not copied.
    """

    def __init__(self, core: _carom.Record) -> None:
        self._core = core
        columns = core.columns
        self.history = Table(
            {name: values for (name, *_), values in zip(columns, core.values)},
            {name: unit for name, unit, _, _ in columns},
            {name: meaning for name, _, meaning, _ in columns},
        )

    @property
    def directory(self) -> Path | None:
        """The run directory; ``None`` in memory."""
        return self._core.directory

    @cached_property
    def manifest(self) -> dict[str, Any]:
        """What was run, on which machine, and how it ended."""
        return self._core.manifest()

    @property
    def case(self) -> dict[str, Any]:
        """The case with all defaults."""
        found: dict[str, Any] = self.manifest["case"]
        return found

    @property
    def title(self) -> str:
        """Title of the case."""
        return str(self.case["title"])

    @property
    def status(self) -> str:
        """``finished``, ``stopped`` (by Ctrl-C), ``failed`` (cannot continue) or ``running``."""
        return str(self.manifest["status"])

    @property
    def reason(self) -> str | None:
        """Why it did not finish."""
        reason: str | None = self.manifest["reason"]
        return reason

    @cached_property
    def stop(self) -> dict[str, Any] | None:
        """Where and why the simulation could not continue, and what to try."""
        return self._core.stop()

    @property
    def warnings(self) -> list[str]:
        """Reasons to distrust some of the results."""
        return self._core.warnings()

    @cached_property
    def contact(self) -> Table:
        """One row per active contact node of a recorded step.

        Position (``x``, ``y``, and ``z`` in space), ``gap``, ``multiplier`` (force, negative for
        compression), ``pressure``, unit normal of the primary side. Columns have the shape (rows,).
        """
        return Table._of_core(self._core.contact(), self._core.contact_units())

    @cached_property
    def metrics(self) -> Metrics:
        """All metrics that a study tabulates."""
        return Metrics(self._core.metrics())

    @property
    def expectations(self) -> list[Expectation]:
        """Outcomes of the case's expectations."""
        return [
            Expectation(e["what"], e["expected"], e["got"], e["pass"], e.get("source"))
            for e in self.manifest["expectations"]
        ]

    @cached_property
    def log(self) -> list[dict[str, Any]]:
        """Events: ``step``, ``time``, ``kind``, ``message`` and data of the kind."""
        return self._core.log()

    @cached_property
    def episodes(self) -> list[tuple[float, float]]:
        """Contact episodes: first time in contact, first time after it (or the end of the record)."""
        last = float(self.history["time"][-1]) if self.history.rows else 0.0
        return [(start, last if end is None else end) for start, end in self._core.episodes()]

    @cached_property
    def fields(self) -> Fields:
        """Fields at the recorded instants (``output.fields_every`` of the case)."""
        return Fields(self._core)

    def to_pandas(self) -> pd.DataFrame:
        """The history for pandas.

        Returns
        -------
        pandas.DataFrame, shape (rows, columns)
            On the same memory; units are in ``attrs["units"]``.
        """
        return self.history.to_pandas()

    def to_polars(self) -> pl.DataFrame:
        """The history for polars, through Arrow's C interface.

        Returns
        -------
        polars.DataFrame, shape (rows, columns)
            On the same memory.
        """
        return self.history.to_polars()

    def to_arrow(self) -> pa.Table:
        """The history for Arrow.

        Returns
        -------
        pyarrow.Table, shape (rows, columns)
            On the same memory; units and meanings are metadata of its fields.
        """
        return self.history.to_arrow()

    def to_xarray(self) -> xr.Dataset:
        """The history for xarray.

        Returns
        -------
        xarray.Dataset
            Variables over ``time``, shape (rows,), on the same memory; units are attributes.
        """
        return self.history.to_xarray()

    def to_vtkhdf(self, path: str | PathLike[str]) -> Path:
        """The fields of all recorded instants in one VTKHDF file, for ParaView and VTK.

        Parameters
        ----------
        path : str or PathLike
            The file, which must not exist yet: ``impact.vtkhdf``.

        Returns
        -------
        Path
            The file. Points are the reference positions; the filter "Warp By Vector" of
            ``displacement`` shows the deformed bodies. The attribute ``units`` of an array is its
            unit, and ``bodies`` of the cell array ``body`` are the names of the bodies.
        """
        from . import vtkhdf

        return vtkhdf.write(self.fields, path)

    def page(self) -> Path:
        """Make figures and report page of a run directory.

        Returns
        -------
        Path
            The page.
        """
        if self.directory is None:
            raise ValueError("a run in memory has no page; give case.run a directory: out=…")
        return self._core.page()

    def __repr__(self) -> str:
        place = f" in {self.directory}" if self.directory else ""
        return f"<Run {self.title!r}: {self.status}, {self.history.rows} rows{place}>"


def open(directory: str | PathLike[str]) -> Run:
    """Read a run directory, also one that the command line wrote or is still writing.

    Parameters
    ----------
    directory : str or PathLike
        The run directory.

    Returns
    -------
    Run
        The record.
    """
    return Run(_carom.open(directory))


def resume(
    directory: str | PathLike[str],
    *functions: Callable[..., Any],
    threads: int | None = None,
    progress: bool = True,
    page: bool = True,
) -> Run:
    """Continue a run that was stopped or killed; the result is bitwise that of one run.

    Parameters
    ----------
    directory : str or PathLike
        The run directory.
    *functions : callable
        The Python functions of the case, which must be the same: their code, defaults, the values they
        enclose and their attributes are compared. Functions that begin alike are given in the order of
        the case.
    threads, progress, page : optional
        As in `Case.run`.

    Returns
    -------
    Run
        The record.
    """
    given: dict[str, Callable[..., Any]] = {}
    for function in functions:
        given[name_of(function, given)] = function
    with progress_bar(str(directory), progress) as report:
        core, raised = _carom.resume(directory, thread_count(threads), page, given, report)
    return ended(Run(core), raised)


def ended(run: Run, raised: BaseException | None) -> Run:
    """The run, or the exception that ended it."""
    if isinstance(raised, KeyboardInterrupt):
        reached = run.history["time"][-1] if run.history.rows else 0.0
        where = f'continue it with carom.resume("{run.directory}")' if run.directory else "it is in memory"
        warnings.warn(f"stopped by Ctrl-C at t = {reached:g}; {where}", stacklevel=3)
        return run
    if raised is not None:
        raise raised
    if run.status == "failed":
        advice = [f"try: {a['what']}" for a in (run.stop or {}).get("advice", [])][:3]
        error = StoppedError("\n".join([run.reason or "the simulation stopped", *advice]))
        error.run = run
        raise error
    return run
