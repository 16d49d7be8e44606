"""Runs in memory and in directories."""

from __future__ import annotations

import os
import signal
import struct
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import bar_dict, disc_dict

import carom


def test_a_bar_on_a_wall(bar: carom.Case) -> None:
    """Exact: impulse 2 m v, contact 2 L / c, rebound at the same speed."""
    run = bar.set({"time.step": 1e-3, "body.bar.mesh.cells": 200}).run(progress=False)
    assert run.status == "finished"
    assert run.history["contact_impulse_x"][-1] == pytest.approx(200.0, rel=2e-3)
    assert run.metrics["contact_duration"] == pytest.approx(2 / 3, abs=4e-3)
    assert run.metrics["restitution"] == pytest.approx(1.0, abs=0.02)
    assert run.history.units["tip.ux"] == "m" and run.history.units["kinetic"] == "J"
    start, end = run.episodes[0]
    assert start == pytest.approx(0.01, abs=3e-3) and end - start == run.metrics["contact_duration"]
    energy = run.history["kinetic"] + run.history["strain"] + run.history["potential"]
    assert np.allclose(energy, run.history["total"], rtol=1e-12)


def test_memory_directory_and_command_give_the_same_bits(
    disc: carom.Case, disc_run: carom.Run, command: str, tmp_path: Path
) -> None:
    case = tmp_path / "disc.toml"
    case.write_text(disc.to_toml())
    subprocess.run([command, "-q", "run", str(case), "--out", str(tmp_path / "cli")], check=True)
    mine = disc.run(tmp_path / "python", threads=2, progress=False)
    theirs = carom.open(tmp_path / "cli")
    for name in ("history.csv", "contact.csv", "log.jsonl"):
        assert (tmp_path / "cli" / name).read_bytes() == (tmp_path / "python" / name).read_bytes()
    header = (tmp_path / "cli/contact.csv").read_text().splitlines()[0].split(",")
    assert list(mine.contact) == header and set(mine.contact["friction"]) == {"none"}
    for other in (mine, theirs):
        for table, same in ((other.history, disc_run.history), (other.contact, disc_run.contact)):
            assert list(table) == list(same)
            for column in table:
                assert np.array_equal(table[column], same[column], equal_nan=table[column].dtype.kind == "f")
        assert other.log == disc_run.log
        assert other.fields.times.tolist() == disc_run.fields.times.tolist()
        last = other.fields.number(-1)
        for number in (len(other.fields), -len(other.fields) - 1, 2**70):
            with pytest.raises(IndexError, match="instants are recorded"):
                other.fields.number(number)
        same_fields = disc_run.fields.number(len(other.fields) - 1)
        for name, values in last.arrays.items():
            assert np.array_equal(values, same_fields.arrays[name])
        work = {"cpu_time", "wall_time"}  # measured
        metrics = {k: v for k, v in other.metrics.items() if k not in work}
        assert metrics == pytest.approx({k: disc_run.metrics[k] for k in metrics}, rel=0, abs=0, nan_ok=True)
    assert (tmp_path / "python/report.html").is_file()
    with pytest.raises(carom.RecordError, match="exists already"):
        disc.run(tmp_path / "python", progress=False)


def test_expectations_and_tables(disc_run: carom.Run) -> None:
    (expectation,) = disc_run.expectations
    assert expectation.met and expectation.source == "rubber rebounds"
    assert expectation.got == disc_run.metrics["restitution"]
    contact = disc_run.contact
    assert contact.rows == int(disc_run.history["active"].sum())
    assert contact.units["gap"] == "m" and contact.units["pressure"] == "Pa"
    # Forces are -multiplier times the normal; their sum is the contact force.
    last = contact["time"] == contact["time"][0]
    force = -(contact["multiplier"] * contact["normal_y"])[last].sum()
    row = disc_run.history["time"] == contact["time"][0]
    assert force == pytest.approx(disc_run.history["contact_force_y"][row][0], rel=1e-9)
    with pytest.raises(KeyError, match="did you mean 'kinetic'"):
        disc_run.history["kinetik"]


def test_the_history_is_not_copied(disc_run: carom.Run) -> None:
    time_column = disc_run.history["time"]
    assert disc_run.history["time"] is time_column and not time_column.flags.writeable
    frame = disc_run.to_pandas()
    assert np.shares_memory(frame["time"].to_numpy(), time_column)
    assert frame.attrs["units"]["kinetic"] == "J"
    pa = pytest.importorskip("pyarrow")
    table = disc_run.to_arrow()
    address = table.column("time").chunk(0).buffers()[1].address
    assert address == time_column.__array_interface__["data"][0]
    assert table.schema.field("kinetic").metadata == {b"unit": b"J", b"description": "kinetic energy ½ vᵀM v".encode()}
    assert pa.table(disc_run.history).equals(table)


def test_polars_and_xarray(disc_run: carom.Run) -> None:
    pytest.importorskip("polars")
    pytest.importorskip("xarray")
    assert np.array_equal(disc_run.to_polars()["total"].to_numpy(), disc_run.history["total"])
    dataset = disc_run.to_xarray()
    assert dataset["kinetic"].attrs["units"] == "J" and dataset["kinetic"].dims == ("time",)


def test_fields_are_curved_cells(disc_run: carom.Run) -> None:
    """The area of the disc from its curved cells; VTK reads the same cells."""
    fields = disc_run.fields.at(0.0)
    disc = next(block for block in fields.blocks if block.body == "disc")
    assert (disc.vtk_type, disc.degree, disc.cells.shape[1]) == (69, 2, 6)
    middles = fields.points[np.unique(disc.cells[:, 3:])]
    # Nodes on the arc lie on the circle, between the corners too.
    distance = np.hypot(middles[:, 0], middles[:, 1] - 0.52)
    assert np.isclose(distance.max(), 0.5, atol=1e-12)
    with pytest.raises(KeyError, match="outside the recorded interval"):
        disc_run.fields.at(7.0)
    pyvista = pytest.importorskip("pyvista")
    grid = disc_run.fields[0.1]
    assert isinstance(grid, pyvista.UnstructuredGrid)
    assert set(grid.celltypes) == {69} and grid.n_points == len(fields.points)
    assert grid.point_data["stress"].shape == (grid.n_points, 6)


def test_principal_values_are_eigenvalues(disc_run: carom.Run) -> None:
    """Principal stresses by LAPACK; strains are zero before contact, where the disc only falls."""
    fields = disc_run.fields.at(0.15)
    xx, yy, zz, xy, yz, xz = fields.arrays["stress"].T
    tensors = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
    expected = np.linalg.eigvalsh(tensors)
    for k in (1, 2, 3):
        values, unit = fields.quantity(f"principal_stress_{k}")
        assert np.allclose(values, expected[:, 3 - k], atol=1e-12 * np.abs(tensors).max()) and unit == "Pa"
    largest, unit = fields.quantity("principal_log_strain_1")
    assert unit == "" and largest.max() > 0.01
    assert np.abs(disc_run.fields.at(0.0).arrays["principal_log_strain"]).max() < 1e-12


def test_vtk_reads_the_fields_in_one_file(disc_run: carom.Run, tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    hdf = pytest.importorskip("vtkmodules.vtkIOHDF")
    from vtkmodules.util.numpy_support import vtk_to_numpy

    path = disc_run.to_vtkhdf(tmp_path / "disc.vtkhdf")
    with pytest.raises(FileExistsError, match="never overwrites"):
        disc_run.to_vtkhdf(path)
    reader = hdf.vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == len(disc_run.fields)
    for step in range(len(disc_run.fields)):
        fields = disc_run.fields.number(step)
        reader.SetStep(step)
        reader.Update()
        grid = reader.GetOutputDataObject(0)
        assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), fields.points)
        bodies = vtk_to_numpy(grid.GetCellData().GetArray("body"))
        assert [int(np.sum(bodies == i)) for i in range(2)] == [len(block.cells) for block in fields.blocks]
        cells = np.concatenate([block.cells.ravel() for block in fields.blocks])
        assert np.array_equal(vtk_to_numpy(grid.GetCells().GetConnectivityArray()), cells)
        for name, values in fields.arrays.items():
            read = vtk_to_numpy(grid.GetPointData().GetArray(name)).reshape(values.shape)
            assert np.array_equal(read, values, equal_nan=True), name
    with h5py.File(path) as file:
        assert file["VTKHDF/PointData/stress"].attrs["units"] == disc_run.fields.number(0).units["stress"]
        assert list(file["VTKHDF/CellData/body"].attrs["bodies"]) == ["disc", "block"]
        assert np.allclose(file["VTKHDF/Steps/Values"], disc_run.fields.times, rtol=1e-15)


def test_a_run_without_fields_says_what_to_do(bar: carom.Case) -> None:
    run = bar.set("output.fields_every", 0).run(progress=False)
    with pytest.raises(KeyError, match="output.fields_every"):
        run.fields.at(0.1)


def test_a_stop_is_an_error_with_the_record() -> None:
    case = disc_dict() | {"newton": {"max_iterations": 1}}
    with pytest.raises(carom.StoppedError, match="is still rejected") as error:
        carom.Case.from_dict(case).run(progress=False)
    run = error.value.run
    assert run is not None and run.status == "failed" and run.history.rows > 1
    assert run.stop is not None and run.stop["advice"]


SLOW = """
import signal, sys, warnings
warnings.simplefilter("always")
import carom
case = carom.Case.from_file(sys.argv[1]).set("time.step", 1e-5)
print("running", flush=True)
run = case.run(sys.argv[2] if len(sys.argv) > 2 else None, progress=False)
print(run.status, run.history.rows)
"""


@pytest.mark.parametrize("in_memory", [True, False])
def test_ctrl_c_keeps_what_there_is(in_memory: bool, tmp_path: Path) -> None:
    case = tmp_path / "bar.toml"
    case.write_text(carom.Case.from_dict(bar_dict()).to_toml())
    place = [] if in_memory else [str(tmp_path / "run")]
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW, str(case), *place],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None and process.stdout.readline() == "running\n"
    time.sleep(2)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 0, err
    status, rows = out.split()
    assert status == "stopped" and int(rows) > 10, err
    assert "stopped by Ctrl-C" in err
    if not in_memory:
        assert carom.open(tmp_path / "run").history.rows == int(rows)


def test_other_threads_run_meanwhile(disc: carom.Case) -> None:
    """The interpreter's lock is released."""
    count, done = 0, threading.Event()

    def tick() -> None:
        nonlocal count
        while not done.is_set():
            count += 1
            time.sleep(0.001)

    ticking = threading.Thread(target=tick)
    ticking.start()
    began = time.perf_counter()
    disc.set("time.step", 5e-4).run(threads=1, progress=False)
    elapsed = time.perf_counter() - began
    done.set()
    ticking.join()
    assert count > 100 * elapsed, (count, elapsed)


def test_an_interrupted_run_is_resumed_to_the_same_bits(tmp_path: Path) -> None:
    """Killed while it runs; the resumed record has the bytes of one that was not."""
    case = carom.Case.from_dict(disc_dict()).set({"time.step": 5e-4, "output.checkpoint_every": 10})
    whole = case.run(tmp_path / "whole", page=False, progress=False)
    path = tmp_path / "case.toml"
    path.write_text(case.to_toml())
    script = "import carom,sys; carom.Case.from_file(sys.argv[1]).run(sys.argv[2], page=False, progress=False)"
    process = subprocess.Popen([sys.executable, "-c", script, str(path), str(tmp_path / "killed")])
    history = tmp_path / "killed/checkpoint"
    for _ in range(400):
        time.sleep(0.02)
        if history.is_dir() and len(list(history.iterdir())) > 1:
            break
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    resumed = carom.resume(tmp_path / "killed", page=False, progress=False)
    assert resumed.status == "finished"
    assert (tmp_path / "killed/history.csv").read_bytes() == (tmp_path / "whole/history.csv").read_bytes()
    assert resumed.history.rows == whole.history.rows


def test_a_bar_is_shown_in_terminals_only(tmp_path: Path) -> None:
    pytest.importorskip("tqdm")
    fcntl, pty, termios = (pytest.importorskip(name) for name in ("fcntl", "pty", "termios"))
    case = tmp_path / "case.toml"
    case.write_text(carom.Case.from_dict(disc_dict()).set("time.step", 2e-4).to_toml())
    command = [sys.executable, "-c", "import carom, sys; carom.Case.from_file(sys.argv[1]).run()", str(case)]
    ours, theirs = pty.openpty()
    # Of 24 lines and 80 columns; without columns, tqdm shows nothing.
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("4H", 24, 80, 0, 0))
    process = subprocess.Popen(command, stderr=theirs)
    os.close(theirs)
    shown = b""
    try:
        while part := os.read(ours, 4096):
            shown += part
    except OSError:  # Linux: the other end is closed
        pass
    assert process.wait() == 0
    assert b"A disc thrown on a block" in shown and b"/1500" in shown and b"t = 0." in shown
    assert subprocess.run(command, stderr=subprocess.PIPE).stderr == b""


def test_pressures_have_a_unit_without_a_probe_of_stress(bar: carom.Case) -> None:
    case = bar_dict() | {"units": {"length": "mm", "time": "ms", "mass": "g"}}
    del case["probe"]
    run = carom.Case.from_dict(case).set("time.end", 0.1).run(progress=False)
    # g mm/ms² is N, and force over length squared MPa.
    assert run.contact.units["multiplier"] == "N"
    assert run.contact.units["pressure"] == "MPa"
    assert bar.set("probe", []).set("time.end", 0.1).run(progress=False).contact.units["pressure"] == "Pa"
    for table in (run.contact, carom.Simulation(carom.Case.from_dict(case)).contacts):
        assert not any(values.flags.writeable for values in table.values())


def test_what_is_no_record_says_what_to_try(command: str, tmp_path: Path, bar: carom.Case) -> None:
    """As the command does."""
    (tmp_path / "empty").mkdir()
    carom.study(bar.set("time.end", 0.01), {"a": {}}, out=tmp_path / "study", progress=False)
    for name, told in (("empty", "a directory that `carom run` created"), ("study", "study/arms")):
        with pytest.raises(carom.RecordError, match="try: give .*") as error:
            carom.open(tmp_path / name)
        assert told in str(error.value)
        export = [command, "export", str(tmp_path / name), "--format", "csv"]
        assert str(error.value).split("try: ")[1] in subprocess.run(export, capture_output=True, text=True).stderr
    with pytest.raises(carom.RecordError, match="never overwrites a directory\ntry: run the study again, into"):
        carom.study(bar, {"a": {}}, out=tmp_path / "study", progress=False)
