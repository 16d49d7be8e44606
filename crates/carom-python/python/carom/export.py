"""Histories as files for other programs."""

from __future__ import annotations

import sys
from os import PathLike
from pathlib import Path

from .run import Run
from .table import Table

FORMATS = ("parquet", "csv", "json")


def export(run: Run, path: str | PathLike[str] | None, format: str) -> None:
    """Write the history of a run with the units of its columns.

    Parameters
    ----------
    run : Run
        The run.
    path : str or PathLike or None
        The file, which must not exist yet; ``None`` for standard output, except for Parquet.
    format : str
        ``parquet`` (units and meanings are metadata of the columns), ``csv`` (names, units, rows) or
        ``json`` (columns with name, unit, description and values; ``null`` is not a number), as
        ``carom export`` writes them.
    """
    if format not in FORMATS:
        raise ValueError(f"no format is called {format!r}; the formats are: {', '.join(FORMATS)}")
    if path is not None and Path(path).is_file():
        # It may be one of the record.
        raise FileExistsError(f"{path} exists already, and Carom never overwrites a file; name another file")
    if format == "parquet":
        import pyarrow.parquet as parquet

        if path is None:
            raise ValueError("a Parquet file needs a name: --out FILE")
        parquet.write_table(run.to_arrow(), path)
    elif path is None:
        sys.stdout.write(run._core.text(format))
    else:
        Path(path).write_text(run._core.text(format), encoding="utf-8", newline="")


def read_parquet(path: str | PathLike[str]) -> Table:
    """Read a Parquet file that `export` wrote.

    Parameters
    ----------
    path : str or PathLike
        The file.

    Returns
    -------
    Table
        The history, with units and meanings of its columns.
    """
    import pyarrow.parquet as parquet

    return Table.of_arrow(parquet.read_table(path))
