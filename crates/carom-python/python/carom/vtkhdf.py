"""Fields of a run in one VTKHDF file, for ParaView and VTK."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from .fields import NOT_RECORDED, Fields, FieldSet


def write(fields: Fields, path: str | PathLike[str]) -> Path:
    """Write all recorded instants into one file (the "VTKHDF File Format", version 2, of docs.vtk.org).

    Parameters
    ----------
    fields : Fields
        The fields of a run.
    path : str or PathLike
        The file, which must not exist yet.

    Returns
    -------
    Path
        The file.
    """
    import h5py

    if not len(fields):
        raise KeyError(NOT_RECORDED)
    if Path(path).exists():
        raise FileExistsError(f"{path} exists already, and Carom never overwrites a file; name another file")
    with h5py.File(path, "x") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = [2, 0]
        root.attrs["Type"] = np.bytes_("UnstructuredGrid")
        first = fields.number(0)
        _write_mesh(root, first)
        _describe_steps(root, first, fields.times)
        for step in range(len(fields)):
            _write_values(root, fields.number(step), step)
    return Path(path)


def _write_mesh(root: Any, first: FieldSet) -> None:
    """The points in the reference configuration and the cells, which all instants share."""
    nodes = np.concatenate([block.cells.ravel() for block in first.blocks])
    sizes = np.concatenate([np.full(len(block.cells), block.cells.shape[1]) for block in first.blocks])
    types = [np.full(len(block.cells), block.vtk_type, dtype=np.uint8) for block in first.blocks]
    bodies = [np.full(len(block.cells), number, dtype=np.int32) for number, block in enumerate(first.blocks)]
    root["NumberOfPoints"] = np.array([len(first.points)])
    root["NumberOfCells"] = np.array([len(sizes)])
    root["NumberOfConnectivityIds"] = np.array([len(nodes)])
    root["Points"] = first.points
    root["Connectivity"] = nodes
    root["Offsets"] = np.concatenate([[0], np.cumsum(sizes)])
    root["Types"] = np.concatenate(types)
    root["CellData/body"] = np.concatenate(bodies)
    root["CellData/body"].attrs["bodies"] = [block.body for block in first.blocks]


def _describe_steps(root: Any, first: FieldSet, times: Any) -> None:
    """The instants, and where each of them finds its mesh and its values."""
    count = len(times)
    steps = root.create_group("Steps")
    steps.attrs["NSteps"] = count
    # The decimals of the grid of times, as in fields.pvd.
    steps["Values"] = np.array([float(f"{time:.15g}") for time in times])
    steps["NumberOfParts"] = np.ones(count, dtype=np.int64)
    for of_mesh in ("PartOffsets", "PointOffsets"):
        steps[of_mesh] = np.zeros(count, dtype=np.int64)
    for of_cells in ("CellOffsets", "ConnectivityIdOffsets"):
        steps[of_cells] = np.zeros((count, 1), dtype=np.int64)
    steps["CellDataOffsets/body"] = np.zeros(count, dtype=np.int64)
    for name, values in first.arrays.items():
        shape = (count * len(values),) if values.shape[1] == 1 else (count * len(values), values.shape[1])
        array = root.create_dataset(f"PointData/{name}", shape=shape, dtype=np.float64)
        if first.units[name]:
            array.attrs["units"] = first.units[name]
        steps[f"PointDataOffsets/{name}"] = np.arange(count) * len(values)


def _write_values(root: Any, fields: FieldSet, step: int) -> None:
    for name, values in fields.arrays.items():
        rows = slice(step * len(values), (step + 1) * len(values))
        root[f"PointData/{name}"][rows] = values[:, 0] if values.shape[1] == 1 else values
