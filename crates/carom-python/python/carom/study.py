"""Studies: many runs of one case, and the table of their metrics."""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _carom
from .case import Case
from .errors import CaseError, RecordError
from .progress import concurrency, progress_bar
from .run import Run
from .run import open as open_run

if TYPE_CHECKING:
    import pandas as pd


class Study:
    """A study that has been computed: a directory with one run directory per arm.

    Parameters
    ----------
    directory : str or PathLike
        Its directory, also one that ``carom study`` wrote.
    """

    def __init__(self, directory: str | PathLike[str]) -> None:
        self.directory = Path(directory)
        self._rows = _carom.study_table(self.directory)
        self._temporary: tempfile.TemporaryDirectory[str] | None = None

    @property
    def arms(self) -> list[str]:
        """Names of the arms."""
        return [name for name, *_ in self._rows]

    @property
    def missing(self) -> list[str]:
        """Arms that have not ended."""
        return [name for name, status, *_ in self._rows if status not in ("finished", "failed")]

    @property
    def units(self) -> dict[str, str]:
        """Units of the metrics."""
        return {metric: unit for *_, metrics in self._rows for metric, _, unit in metrics}

    def to_pandas(self) -> pd.DataFrame:
        """The table of metrics.

        Returns
        -------
        pandas.DataFrame, shape (arms, metrics + 2)
            One row per arm, one column per metric, ``status`` and ``reason`` first; units are in
            ``attrs["units"]``.
        """
        import pandas as pd

        rows = [
            {"arm": name, "status": status, "reason": reason}
            | {metric: math.nan if value is None else value for metric, value, _ in metrics}
            for name, status, reason, _, metrics in self._rows
        ]
        frame = pd.DataFrame(rows).set_index("arm")
        frame.attrs["units"] = self.units
        return frame

    def __iter__(self) -> Iterator[str]:
        """Names of the arms."""
        return iter(self.arms)

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, arm: str) -> Run:
        """The record of an arm."""
        for name, status, reason, directory, _ in self._rows:
            if name == arm:
                if status is None:
                    raise RecordError(reason or f"arm {arm!r} has not been computed")
                return open_run(self.directory / directory)
        raise KeyError(f"no arm is named {arm!r}; the arms are: {', '.join(self.arms)}")

    def page(self) -> Path:
        """Make figures and page, and the pages of the arms.

        Returns
        -------
        Path
            The page.
        """
        for arm in self.arms:
            if arm not in self.missing:
                self[arm].page()
        _carom.study_collect(self.directory, True)
        return self.directory / "study.html"

    def _repr_html_(self) -> str:
        return str(self.to_pandas().to_html())

    def __repr__(self) -> str:
        return f"<Study of {len(self._rows)} arms in {self.directory}>"


def study(
    case: Case,
    arms: Sequence[Mapping[str, Any]] | Mapping[str, Mapping[str, Any]] | None = None,
    grid: Mapping[str, Sequence[Any]] | None = None,
    *,
    jobs: int | None = None,
    out: str | PathLike[str] | None = None,
    client: Any = None,
    progress: bool = True,
    page: bool = False,
    **keys: Any,
) -> Study:
    """Run a case many times with some of its values replaced.

    Parameters
    ----------
    case : Case
        The case.
    arms : dict of str to dict, or list of dict, optional
        Changes of the case by the name of the arm: ``{"Hu": {"time.scheme": {"kind": "hu"}}}``; or a
        list of ``[[arm]]`` tables.
    grid : dict of str to list, optional
        Lists of values by key: all combinations are arms.
    jobs : int, optional
        Number of concurrent runs, by default one per core.
    out : str or PathLike, optional
        Directory of the study, which must not exist yet. Without it the records are kept in a
        temporary directory as long as the study is in use.
    client : distributed.Client or the module ray, optional
        Arms are computed by the workers of Dask or Ray, which must share the file system with this
        process. An arm whose worker is killed is continued by another.
    progress : bool
        Whether a bar is shown, if tqdm is installed.
    page : bool
        Whether figures and page are made.
    **keys : object
        Further keys of a study file: ``reference``, ``goal``, ``claim``, …

    Returns
    -------
    Study
        Its ``to_pandas()`` is the table of metrics, with the values of ``study.csv``.

    Raises
    ------
    CaseError
        If a case of the study is wrong.
    RecordError
        If the directory exists. With a client: if steps of matched cost need times.

    Examples
    --------
    The steps of a grid, and their number, which is end / step:

    >>> case = carom.Case.from_file("cases/bar/single.toml").set("time.end", 0.1)
    >>> table = carom.study(case, grid={"time.step": [0.002, 0.001]}, progress=False).to_pandas()
    >>> table["steps"].tolist()
    [50.0, 100.0]
    """
    if case._functions:
        raise CaseError(
            "a study cannot have Python functions: its arms are resumed from files, which have none\n"
            "try: write formulas, or loop over case.run()"
        )
    temporary = tempfile.TemporaryDirectory(prefix="carom-") if out is None else None
    directory = Path(out) if out is not None else Path(temporary.name if temporary else "") / "study"
    # The files that the case names are found from every directory, also by workers.
    name = str(Path(case._core.name).absolute())
    text = _study_text(case, name, arms, grid, keys)
    if client is not None:
        count = _carom.study_plan(text, name, case._core, directory)
        _on_workers(client, count, directory)
    else:
        with progress_bar(case.title, progress) as report:
            raised = _carom.study(text, name, case._core, directory, concurrency("jobs", jobs), report)
        if raised is not None:
            raise raised
    found = Study(directory)
    found._temporary = temporary
    if page:
        found.page()
    return found


def _study_text(
    case: Case,
    name: str,
    arms: Sequence[Mapping[str, Any]] | Mapping[str, Mapping[str, Any]] | None,
    grid: Mapping[str, Sequence[Any]] | None,
    keys: Mapping[str, Any],
) -> str:
    """The text of a study file, which names the case."""
    from .functions import plain

    given = plain(dict(keys), {})
    sets = case._sets | {key: _carom.toml(value) for key, value in given.pop("set", {}).items()}
    study: dict[str, Any] = {"title": case.title, "case": name} | given
    if isinstance(arms, Mapping):
        arms = [{"name": name, "set": dict(changes)} for name, changes in arms.items()]
    if arms is not None:
        study["arm"] = plain(list(arms), {})
    if grid is not None:
        study["grid"] = plain(dict(grid), {})
    text = _carom.toml_document(study)
    if sets:
        common = "".join(f"{_carom.toml(key)} = {value}\n" for key, value in sets.items())
        text += f"\n[set]\n{common}"
    return text


def _on_workers(client: Any, count: int, directory: Path) -> None:
    """Computes the runs of a planned study by the workers of a Dask client, or of Ray."""
    place, numbers = str(directory.resolve()), range(1, count + 1)
    if hasattr(client, "gather"):
        key = f"carom-{place}"
        client.gather(client.map(_arm, [place] * count, numbers, pure=False, retries=3, key=key))
    else:
        task = client.remote(max_retries=3)(_arm)
        client.get([task.remote(place, number) for number in numbers])
    _carom.study_collect(directory, False)


def _arm(directory: str, number: int) -> str:
    """Computes one run of a planned study, in a worker."""
    # A worker that the scheduler has given up may still be computing it.
    while (status := _carom.study_arm(directory, number)) is None:
        time.sleep(1)
    return status
