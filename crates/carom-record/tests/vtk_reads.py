"""Reads Carom's fields, VTU and VTKHDF, with VTK, and VTU with meshio.

Checked are cell types, points, a cubic function between the nodes, units, body names and times.

    cargo run -p carom-record --example lagrange_fields -- FOLDER
    python crates/carom-record/tests/vtk_reads.py FOLDER        (needs: pip install vtk h5py meshio)
"""

import sys
from pathlib import Path

import h5py
import meshio
import vtk

STREAM = vtk.vtkStreamingDemandDrivenPipeline
BODIES = "T1 L1 T2 L2 T3 L3".split()


def cubic(x, y):
    return 1 + 2 * x - y + 0.5 * x * y + x**3 - 3 * x * y**2 + 0.25 * y**3


def between_nodes(grid, array, factor):
    """Largest relative error inside cells of order 3.

    VTK's own shape functions reproduce a cubic there.
    """
    worst = 0.0
    for cell in [i for i in range(grid.GetNumberOfCells()) if grid.GetCell(i).GetNumberOfPoints() in (10, 4)]:
        shape, flat = grid.GetCell(cell), grid.GetCellType(cell) == 69
        ids = shape.GetPointIds()
        for r, s in [(0.2, 0.3), (0.7, 0.1), (0.05, 0.9), (1 / 3, 1 / 3)]:
            weights, where, sub = [0.0] * ids.GetNumberOfIds(), [0.0] * 3, vtk.reference(0)
            shape.EvaluateLocation(sub, (r, s if flat else 0.0, 0.0), where, weights)
            got = sum(w * array.GetTuple(ids.GetId(i))[0] for i, w in enumerate(weights))
            wanted = factor * cubic(where[0], where[1])
            worst = max(worst, abs(got - wanted) / max(1.0, abs(wanted)))
    assert worst < 1e-12, worst
    return worst


def both(grid):
    assert grid.GetNumberOfPoints() == 3 + 2 + 6 + 3 + 10 + 4, grid.GetNumberOfPoints()
    assert [grid.GetCellType(i) for i in range(6)] == [5, 3, 22, 21, 69, 68]
    assert [grid.GetCellData().GetArray("body").GetValue(i) for i in range(6)] == list(range(6))
    data = grid.GetPointData()
    assert data.GetArray("stress").GetTuple(7)[5] == data.GetArray("cubic").GetValue(7) + 5


def vtu(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    both(grid)
    data = grid.GetPointData()
    assert data.GetArray("cubic").GetInformation().Get(vtk.vtkDataArray.UNITS_LABEL()) == "m/s²"
    assert [data.GetArray("stress").GetComponentName(i) for i in range(6)] == "XX YY ZZ XY YZ XZ".split()
    assert [grid.GetFieldData().GetArray(f"body {name}").GetValue(0) for name in BODIES] == list(range(6))
    assert grid.GetFieldData().GetArray("TimeValue").GetValue(0) == 0.25
    cells = [(block.type, block.data.shape) for block in meshio.read(path).cells]
    assert cells == [
        ("triangle", (1, 3)), ("line", (1, 2)), ("triangle6", (1, 6)), ("line3", (1, 3)),
        ("VTK_LAGRANGE_TRIANGLE", (1, 10)), ("VTK_LAGRANGE_CURVE", (1, 4)),
    ], cells
    return between_nodes(grid, data.GetArray("displacement"), 1.0)


def vtkhdf(path):
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(STREAM.TIME_STEPS())
    assert reader.GetNumberOfSteps() == 20 and list(times) == [i / 10 for i in range(20)], times
    worst = 0.0
    for i, time in enumerate(times):
        reader.SetStep(i)
        reader.Update()
        grid = reader.GetOutputDataObject(0)
        both(grid)
        assert grid.GetFieldData().GetArray("step").GetValue(0) == 5 * i
        worst = max(worst, between_nodes(grid, grid.GetPointData().GetArray("displacement"), 1.0 + time))
    with h5py.File(path) as file:
        points = file["VTKHDF/PointData"]
        assert {name: points[name].attrs["units"] for name in points} == {
            "cubic": "m/s²".encode(), "displacement": b"m", "stress": b"Pa"
        }
        assert list(file["VTKHDF/CellData/body"].attrs["bodies"]) == [name.encode() for name in BODIES]
        assert file["VTKHDF/PointData/stress"].shape == (20 * 28, 6)
    return worst


folder = Path(sys.argv[1])
errors = [vtu(folder / "cells.vtu"), vtkhdf(folder / "run/fields.vtkhdf")]
print(f"VTK {vtk.vtkVersion.GetVTKVersion()} reads VTU and VTKHDF; cubic displacement reproduced to {max(errors):.1e}")
