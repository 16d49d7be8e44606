"""VTK itself reads our field files: cell types, points, the cubic between the nodes, units, body names.

    cargo run -p carom-record --example lagrange_vtu -- cells.vtu
    python crates/carom-record/tests/vtk_reads.py cells.vtu        (needs: pip install vtk)
"""

import sys

import vtk


def cubic(x, y):
    return 1 + 2 * x - y + 0.5 * x * y + x**3 - 3 * x * y**2 + 0.25 * y**3


reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
assert grid.GetNumberOfPoints() == 3 + 2 + 6 + 3 + 10 + 4, grid.GetNumberOfPoints()
assert [grid.GetCellType(i) for i in range(6)] == [69, 68] * 3

data = grid.GetPointData()
units = vtk.vtkDataArray.UNITS_LABEL()
assert data.GetArray("cubic").GetInformation().Get(units) == "m/s²"
stress = data.GetArray("stress")
assert [stress.GetComponentName(i) for i in range(6)] == "XX YY ZZ XY YZ XZ".split()
assert stress.GetTuple(7)[5] == data.GetArray("cubic").GetValue(7) + 5
names = grid.GetFieldData().GetAbstractArray("bodies")
assert [names.GetValue(i) for i in range(names.GetNumberOfValues())] == "T1 L1 T2 L2 T3 L3".split()
assert grid.GetFieldData().GetArray("TimeValue").GetValue(0) == 0.25
assert reader.GetOutput().GetCellData().GetArray("body").GetValue(3) == 3

# Order k reproduces polynomials of degree k: order 3 the cubic itself, by VTK's own shape functions.
worst = 0.0
for cell in (4, 5):
    shape = grid.GetCell(cell)
    ids = shape.GetPointIds()
    for p in [(0.2, 0.3), (0.7, 0.1), (0.05, 0.9), (1 / 3, 1 / 3)]:
        p = (p[0], p[1] if cell == 4 else 0.0, 0.0)
        weights, where, sub = [0.0] * ids.GetNumberOfIds(), [0.0] * 3, vtk.reference(0)
        shape.EvaluateLocation(sub, p, where, weights)
        got = sum(w * data.GetArray("cubic").GetValue(ids.GetId(i)) for i, w in enumerate(weights))
        worst = max(worst, abs(got - cubic(where[0], where[1])))
assert worst < 1e-11, worst
print(f"VTK {vtk.vtkVersion.GetVTKVersion()} reads it; cubic reproduced to {worst:.1e}")
