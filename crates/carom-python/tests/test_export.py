"""Exported histories are read back with their units."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import carom
from carom.export import export, read_parquet


@pytest.fixture(scope="module")
def directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from conftest import disc_dict

    place = tmp_path_factory.mktemp("runs") / "disc"
    carom.Case.from_dict(disc_dict()).run(place, page=False, progress=False)
    return place


@pytest.mark.parametrize("by", ["python", "command"])
def test_parquet(directory: Path, by: str, command: str, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    file = tmp_path / "disc.parquet"
    program = [command] if by == "command" else [sys.executable, "-m", "carom"]
    arguments = ["export", str(directory), "--format", "parquet", "--out", str(file)]
    told = subprocess.run([*program, *arguments], capture_output=True, text=True)
    if "built without Parquet" in told.stderr:
        pytest.skip("the command was built without its feature `parquet`")
    assert told.returncode == 0, told.stderr
    assert parquet.read_schema(file).field("total").metadata[b"unit"] == b"J"
    history, table = carom.open(directory).history, read_parquet(file)
    assert table.units == history.units and table.descriptions == history.descriptions
    for name in history:
        assert np.array_equal(table[name], history[name], equal_nan=True)


@pytest.mark.parametrize("by", ["python", "command"])
def test_csv_and_json(directory: Path, by: str, command: str, tmp_path: Path) -> None:
    history = carom.open(directory).history
    program = [command] if by == "command" else [sys.executable, "-m", "carom"]
    for form in ("csv", "json"):
        file = tmp_path / f"disc.{form}"
        arguments = ["export", str(directory), "--format", form, "--out", str(file)]
        assert subprocess.run([*program, *arguments]).returncode == 0
    with (tmp_path / "disc.csv").open(newline="") as file_:
        names, units, *rows = list(csv.reader(file_))
    assert dict(zip(names, units)) == history.units
    values = np.array(rows, dtype=float)
    for k, name in enumerate(names):
        assert np.array_equal(values[:, k], history[name], equal_nan=True)
    columns = json.loads((tmp_path / "disc.json").read_text())["columns"]
    assert [c["name"] for c in columns] == list(history)
    assert columns[1]["values"] == history["time"].tolist() and columns[1]["unit"] == "s"


@pytest.mark.parametrize("form", ["csv", "json"])
def test_there_is_one_text(directory: Path, form: str, command: str, tmp_path: Path) -> None:
    """The bytes are those of the command."""
    told = subprocess.run([command, "export", str(directory), "--format", form], capture_output=True, text=True)
    export(carom.open(directory), tmp_path / "text", form)
    assert (tmp_path / "text").read_text() == told.stdout


def test_a_million_rows(tmp_path: Path) -> None:
    """Ten columns of a million rows: no copy from memory, and under 0.5 s from Parquet.

    The processor time of all threads counts; on an idle machine, less time than that passes.
    """
    pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    values = np.random.default_rng(1).normal(size=(10, 1_000_000))
    table = carom.Table({f"c{k}": column for k, column in enumerate(values)}, {"c0": "m"})
    arrow = table.to_arrow()
    for k, column in enumerate(values):
        assert arrow.column(k).chunk(0).buffers()[1].address == column.__array_interface__["data"][0]
    frame = table.to_pandas()
    assert np.shares_memory(frame["c3"].to_numpy(), values[3])
    parquet.write_table(arrow, tmp_path / "million.parquet")
    best = min(_timed(tmp_path / "million.parquet") for _ in range(3))
    print(f"a million rows of ten columns from Parquet: {best:.3f} s")
    assert best < 0.5
    assert np.array_equal(read_parquet(tmp_path / "million.parquet")["c9"], values[9])


def _timed(path: Path) -> float:
    began = time.process_time()
    read_parquet(path)
    return time.process_time() - began


def test_what_cannot_be_exported(directory: Path) -> None:
    run = carom.open(directory)
    history = (directory / "history.csv").read_bytes()
    for form in ("csv", "json", "parquet"):
        with pytest.raises(FileExistsError, match="exists already"):
            export(run, directory / "history.csv", form)
    assert (directory / "history.csv").read_bytes() == history
    with pytest.raises(ValueError, match="needs a name"):
        pytest.importorskip("pyarrow")
        export(run, None, "parquet")
    with pytest.raises(ValueError, match="the formats are"):
        export(run, None, "xls")
