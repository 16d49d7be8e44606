"""Histories as files for other programs."""

from __future__ import annotations

import csv
import json
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
    run
        The run.
    path
        The file; ``None`` for standard output, except for Parquet.
    format
        ``parquet`` (units and meanings are metadata of the columns), ``csv`` (names, units, rows) or
        ``json`` (columns with name, unit, description and values).
    """
    if format == "parquet":
        import pyarrow.parquet as parquet

        if path is None:
            raise ValueError("a Parquet file needs a name: --out FILE")
        parquet.write_table(run.to_arrow(), path)
        return
    if format not in FORMATS:
        raise ValueError(f"no format is called {format!r}; the formats are: {', '.join(FORMATS)}")
    out = sys.stdout if path is None else Path(path).open("w", encoding="utf-8", newline="")
    try:
        if format == "json":
            columns = [
                {
                    "name": name,
                    "unit": run.history.units[name],
                    "description": run.history.descriptions.get(name, ""),
                    "values": values.tolist(),
                }
                for name, values in run.history.items()
            ]
            json.dump({"title": run.title, "version": run.manifest["version"], "columns": columns}, out)
            out.write("\n")
        else:
            writer = csv.writer(out, lineterminator="\n")
            writer.writerow(run.history)
            writer.writerow(run.history.units.values())
            writer.writerows(zip(*(values.tolist() for values in run.history.values())))
    finally:
        if path is not None:
            out.close()


def read_parquet(path: str | PathLike[str]) -> Table:
    """Read a Parquet file that `export` wrote."""
    import pyarrow.parquet as parquet

    return Table.of_arrow(parquet.read_table(path))
