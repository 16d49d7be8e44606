"""Cases: what is simulated."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from typing import Any

from . import _carom
from .errors import CaseError
from .functions import plain
from .progress import progress_bar, thread_count
from .run import Run, ended


class Case:
    """A case, with the keys of a case file.

    Make one with `from_file`, `from_dict` or `from_text`. It is checked at once: everything wrong
    with it is a `CaseError` with place, reason and what to try, as on the command line.

    Examples
    --------
    >>> case = carom.Case.from_file("cases/bar/single.toml")
    >>> case.set("time.step", 1e-3).resolved()["time"]["step"]
    0.001
    """

    def __init__(self, core: _carom.Case, functions: Mapping[str, Callable[..., Any]]) -> None:
        self._core = core
        self._functions = dict(functions)
        self._sets: dict[str, str] = {}

    @classmethod
    def from_file(cls, path: str | PathLike[str]) -> Case:
        """Read a case file.

        Parameters
        ----------
        path : str or PathLike
            The TOML file. Meshes and tables that it names are looked for beside it.

        Returns
        -------
        Case
            The case.
        """
        return cls(_carom.Case.open(path, []), {})

    @classmethod
    def from_text(cls, text: str) -> Case:
        """Read a case from TOML text.

        Parameters
        ----------
        text : str
            The text of a case file. Files that it names are looked for in the working directory.

        Returns
        -------
        Case
            The case.
        """
        return cls(_carom.Case.parse("case", text, []), {})

    @classmethod
    def from_dict(cls, case: Mapping[str, Any]) -> Case:
        """Read a case from a dictionary with the keys of a case file.

        Parameters
        ----------
        case : dict
            Values may be NumPy numbers and arrays. Components of a load and the motion of a support
            may be Python functions; see `set`.

        Returns
        -------
        Case
            The case.
        """
        functions: dict[str, Callable[..., Any]] = {}
        text = _carom.toml_document(plain(case, functions))
        return cls(_carom.Case.parse("case", text, []), functions)

    def set(self, key: str | Mapping[str, Any], value: Any = None) -> Case:
        """Replace values, as ``--set key=value`` does; the case is checked again.

        Parameters
        ----------
        key : str or dict
            Path of the key; a table of a list is addressed by its name: ``body.cylinder.element``.
            A dictionary replaces several values at once.
        value : object
            The new value. A component of a load may be a function ``f(t)`` of the time, or
            ``f(t, X)`` of the time and the reference positions, shape (points, dimension), that
            returns a number or one per point, in the units of the case. The motion of a support may
            be a function that returns displacement, velocity and acceleration, ``(u, v, a)``, each a
            number or one per point. It is called once per evaluation, with all points: a few
            microseconds, about once per step and stage. Arguments with defaults are the function's
            own.

        Returns
        -------
        Case
            The same case, changed. After an error it is unchanged.
        """
        values = key if isinstance(key, Mapping) else {key: value}
        # The last override of a key counts.
        sets = {path: text for path, text in self._sets.items() if path not in values}
        functions = self._functions_of(sets | {path: "0" for path in values})
        for path, new in values.items():
            sets[path] = _carom.toml(plain(new, functions))
        self._core = self._core.with_sets(_listed(sets))
        self._sets, self._functions = sets, functions
        return self

    def _functions_of(self, sets: Mapping[str, str]) -> dict[str, Callable[..., Any]]:
        """The functions that the case has with other overrides."""
        try:
            text = self._core.text_with(_listed(sets))
        except CaseError:
            # A key that is not there: the check of the new case says which.
            return dict(self._functions)
        return {name: function for name, function in self._functions.items() if f'"@{name}"' in text}

    def copy(self) -> Case:
        """An independent case with the same values.

        Returns
        -------
        Case
            The copy; changing one of the two leaves the other as it is.
        """
        case = Case(self._core, self._functions)
        case._sets = dict(self._sets)
        return case

    @property
    def title(self) -> str:
        """Title for figures."""
        return self._core.title

    def to_dict(self) -> dict[str, Any]:
        """The case as given, with the values that `set` replaced.

        Returns
        -------
        dict
            Keys and values of a case file.
        """
        return self._core.to_dict()

    def to_toml(self) -> str:
        """The text of a case file.

        Returns
        -------
        str
            TOML, which `from_text` reads.
        """
        return self._core.merged()

    def resolved(self) -> dict[str, Any]:
        """The case with all defaults, as `carom check --json` prints it.

        Returns
        -------
        dict
            Every key that the case could have, with its value.
        """
        return self._core.resolved()

    def check(self) -> list[str]:
        """Build the model, which finds what only meshes show.

        Returns
        -------
        list of str
            Warnings: reasons to distrust some results.
        """
        return self._core.check(self._functions)

    def run(
        self,
        out: str | PathLike[str] | None = None,
        *,
        threads: int | None = None,
        progress: bool = True,
        page: bool = True,
    ) -> Run:
        """Compute the case.

        Parameters
        ----------
        out : str or PathLike, optional
            Directory of the run, which must not exist yet. Without it the run is recorded in memory,
            and cannot be resumed.
        threads : int, optional
            Number of threads, by default one per core, and one for a model too small for more to pay;
            the result does not depend on it.
        progress : bool
            Whether a bar is shown, in a terminal or a notebook, if tqdm is installed.
        page : bool
            Whether figures and report page are made in `out`.

        Returns
        -------
        Run
            The record. After Ctrl-C it is what there is, with ``status == "stopped"`` and a warning.

        Raises
        ------
        CaseError
            If only the meshes show that the case is wrong.
        StoppedError
            If the simulation cannot continue; its ``run`` is the record up to there.

        Examples
        --------
        >>> run = carom.Case.from_file("cases/bar/single.toml").run(progress=False)
        >>> run.history["time"].shape, run.history.units["time"]
        ((601,), 's')
        """
        with progress_bar(self.title, progress) as report:
            core, raised = self._core.run(
                out, thread_count(threads), page, self._functions, report
            )
        return ended(Run(core), raised)

    def __repr__(self) -> str:
        return f"<Case {self.title!r}>"


def _listed(sets: Mapping[str, str]) -> list[str]:
    return [f"{path}={text}" for path, text in sets.items()]
