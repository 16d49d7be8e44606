#!/usr/bin/env python3
"""Reads cells of every element with VTK, and the VTU files with meshio too.

    python scripts/check_cells.py CAROM        (needs: pip install vtk meshio)

A rectangle or box of every element of degree k starts deformed by

    x = X + 0.1 Yᵏ + 0.05 Zᵏ,  y = Y + 0.1 Zᵏ,  z = Z;        bars x = X + 0.1 Xᵏ

which the shape functions reproduce, and whose determinant is 1 where there is more than one axis:
area and volume remain those of the rectangle and the box. Checked are, with the shape functions of
VTK, the deformed place of points inside every cell, and the length, area or volume of all cells by
quadrature. A node at another place than VTK's fails both.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

DEGREES = {
    "L2": 1, "L3": 2, "L4": 3, "T3": 1, "T6": 2, "T10": 3, "Q4": 1, "Q9": 2,
    "Tet4": 1, "Tet10": 2, "Tet20": 3, "Hex8": 1, "Hex27": 2,
}
SIZES = [2.0, 1.5, 0.75]
# Corners that differ from the first one along one axis of the reference cell.
AXES = {"L": [1], "T": [1, 2], "Q": [1, 3], "Tet": [1, 2, 3], "Hex": [1, 3, 4]}

CASE = """
title = "One body of every element"
dimension = {dimension}
{plane}
[[material]]
name = "soft"
law = "{law}"
density = 1.0
young = 1.0
poisson = 0.0
[[body]]
name = "a_&_ü"
material = "soft"
element = "{element}"
mesh = {mesh}
position = {position}
[time]
end = 1e-4
step = 1e-4
scheme = {{ kind = "energy-momentum" }}
[output]
fields_every = 1
"""


def motion(X, k):
    """The deformed places of points, one per row."""
    x = X.copy()
    if X.shape[1] == 1:
        return X + 0.1 * X**k
    x[:, 0] += 0.1 * X[:, 1] ** k
    if X.shape[1] == 3:
        x[:, 0] += 0.05 * X[:, 2] ** k
        x[:, 1] += 0.1 * X[:, 2] ** k
    return x


def case(element):
    degree, shape = DEGREES[element], element.rstrip("0123456789")
    dimension = len(AXES[shape])
    of = lambda values: "[" + ", ".join(map(str, values)) + "]"
    kind = {1: "interval", 2: "rectangle", 3: "box"}[dimension]
    mesh = f'{{ shape = "{kind}", min = {of([0.0] * dimension)}, max = {of(SIZES[:dimension])}, cells = {of([2] * dimension)} }}'
    if dimension == 1:
        mesh = f'{{ shape = "interval", min = 0.0, max = {SIZES[0]}, cells = 2 }}'
    formulas = {
        1: [f"X + 0.1*X^{degree}"],
        2: [f"X + 0.1*Y^{degree}", "Y"],
        3: [f"X + 0.1*Y^{degree} + 0.05*Z^{degree}", f"Y + 0.1*Z^{degree}", "Z"],
    }[dimension]
    return CASE.format(
        dimension=dimension, plane='plane = "strain"' if dimension == 2 else "", element=element, mesh=mesh,
        law="linear-elastic" if dimension == 1 else "neo-hookean", position=str(formulas).replace("'", '"'),
    )


def location(grid, places, cell, parameters):
    """The place of a point of a cell by VTK's shape functions."""
    shape = grid.GetCell(cell)
    weights, where = [0.0] * shape.GetNumberOfPoints(), [0.0] * 3
    shape.EvaluateLocation(vtk.reference(0), parameters, where, weights)
    nodes = [shape.GetPointId(i) for i in range(shape.GetNumberOfPoints())]
    return np.array(weights) @ places[nodes]


def derivative(function, at, axis, h=0.05):
    """By differences that are exact up to degree 4."""
    step = lambda n: function(at + n * h * np.eye(3)[axis])
    return (8.0 * (step(1) - step(-1)) - (step(2) - step(-2))) / (12.0 * h)


def quadrature(shape, dimension):
    """Points and weights on VTK's reference cell, exact for degree 9 along each axis, less what the collapse takes."""
    x, w = np.polynomial.legendre.leggauss(5)
    x, w = (x + 1.0) / 2.0, w / 2.0
    for index in np.ndindex(*[5] * dimension):
        p, weight = np.zeros(3), np.prod(w[list(index)])
        p[:dimension] = x[list(index)]
        if shape in ("T", "Tet"):
            # Duffy: the square or cube collapsed to the triangle or tetrahedron.
            left = 1.0
            for axis in range(dimension):
                p[axis], weight = p[axis] * left, weight * left
                left -= p[axis]
        yield p, weight


def check(grid, element):
    """Largest error of a place, and the relative one of length, area or volume."""
    shape, degree = element.rstrip("0123456789"), DEGREES[element]
    axes = AXES[shape]
    dimension = len(axes)
    points = vtk_to_numpy(grid.GetPoints().GetData())
    moved = points + vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
    farthest, measure = 0.0, 0.0
    for cell in range(grid.GetNumberOfCells()):
        corners = points[[grid.GetCell(cell).GetPointId(i) for i in [0, *axes]]]
        for p, weight in quadrature(shape, dimension):
            X = corners[0] + p[:dimension] @ (corners[1:] - corners[0])
            x = motion(X[None, :dimension], degree)[0]
            farthest = max(farthest, abs(location(grid, moved, cell, p)[:dimension] - x).max())
            slopes = [derivative(lambda q: location(grid, moved, cell, q), p, axis) for axis in range(dimension)]
            measure += weight * np.linalg.det(np.array(slopes)[:, :dimension])
    size = np.prod(SIZES[:dimension])
    expected = size + 0.1 * size**degree if dimension == 1 else size
    return farthest, abs(measure / expected - 1.0)


def read_vtu(run):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(run / "fields/00000000.vtu"))
    reader.Update()
    return reader.GetOutput()


def check_meshio(run, grid):
    """Meshio must see the cells, points and values that VTK sees, and the names of the bodies."""
    mesh = meshio.read(run / "fields/00000000.vtu")
    nodes = np.concatenate([block.data.ravel() for block in mesh.cells])
    seen = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    assert np.array_equal(nodes, seen), "meshio has other nodes"
    assert np.array_equal(mesh.points, vtk_to_numpy(grid.GetPoints().GetData()))
    data = grid.GetPointData()
    names = {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())}
    assert names == mesh.point_data.keys(), names ^ mesh.point_data.keys()
    for name in names:
        assert np.array_equal(mesh.point_data[name].ravel(), vtk_to_numpy(data.GetArray(name)).ravel()), name
    assert mesh.field_data["body a_&_ü"] == [0] and mesh.field_data["TimeValue"] == [0.0], mesh.field_data
    assert grid.GetFieldData().GetArray("body a_&_ü").GetValue(0) == 0
    return mesh.cells[0].type


def main():
    carom, worst = Path(sys.argv[1]).resolve(), 0.0
    for element in DEGREES:
        with tempfile.TemporaryDirectory() as place:
            file, run = Path(place) / "case.toml", Path(place) / "run"
            file.write_text(case(element))
            command = [carom, "run", file, "--no-report", "--out", run]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            grid = read_vtu(run)
            place_error, measure_error = check(grid, element)
            assert place_error < 1e-12 and measure_error < 1e-11, f"{element}: {place_error} {measure_error}"
            worst = max(worst, place_error, measure_error)
            known = check_meshio(run, grid)
        print(f"{element}: VTK type {grid.GetCellType(0)}, meshio {known}")
    print(f"places, lengths, areas and volumes of {len(DEGREES)} elements to {worst:.1e}")


if __name__ == "__main__":
    main()
