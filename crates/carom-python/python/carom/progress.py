"""Progress bars by tqdm, in terminals and notebooks."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from . import _carom


def concurrency(name: str, requested: int | None) -> int:
    """The number of threads or concurrent runs asked for by an argument, or one per core."""
    if requested is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    most = _carom.most_concurrent()
    if not 1 <= requested <= most:
        raise ValueError(
            f"{name} must be from 1 to {most}, not {requested}; more than one per core costs time and memory"
        )
    return requested


def thread_count(requested: int | None) -> int | None:
    """The number of threads asked for by an argument; none for as many as pay, at most one per core."""
    return None if requested is None else concurrency("threads", requested)


def _in_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return type(shell).__name__ == "ZMQInteractiveShell"


@contextmanager
def progress_bar(title: str, wanted: bool) -> Iterator[Callable[[int, int, float], object] | None]:
    """A function that shows steps done, all steps and the time; none where nothing would be seen."""
    try:
        with warnings.catch_warnings():
            # Without ipywidgets the bar is plain text.
            warnings.simplefilter("ignore")
            from tqdm.auto import tqdm
    except ImportError:
        wanted = False
    visible = wanted and (_in_notebook() or sys.stderr.isatty())
    if not visible:
        yield None
        return
    bar: Any = None

    def show(done: int, steps: int, time: float) -> None:
        nonlocal bar
        if bar is None:
            bar = tqdm(total=steps, initial=done, desc=title, unit="step", leave=False)
        bar.n = done
        if time:
            bar.set_postfix_str(f"t = {time:.4g}", refresh=False)
        bar.refresh()

    try:
        yield show
    finally:
        if bar is not None:
            bar.close()
