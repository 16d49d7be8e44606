#!/usr/bin/env python3
"""Reads the fields of real runs with VTK.

    python scripts/check_vtk.py CAROM RUN        (needs: pip install vtk)

CAROM is the binary, RUN the directory of a finished run with VTU fields and contact of two bodies.
Checked are arrays and their units, times equal to the decimals of n·Δt, and values equal to those of
the record's tables. The case is then run again and killed before it ends. The instants in
`fields.pvd` must be readable at that point, and after `carom resume` they must be those of RUN.
"""

import csv
import json
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as xml
from decimal import Decimal
from pathlib import Path

import vtk

UNITS = {
    "displacement": "m", "velocity": "m/s", "stress": "Pa", "von_mises": "Pa", "principal_stress": "Pa",
    "principal_log_strain": None, "contact_pressure": "Pa",
}
COMPONENTS = {"displacement": "X Y Z", "stress": "XX YY ZZ XY YZ XZ", "principal_stress": "1 2 3"}


def values(grid):
    """Point arrays as bytes."""
    data = grid.GetPointData()
    return {data.GetArrayName(i): bytes(memoryview(data.GetArray(i))) for i in range(data.GetNumberOfArrays())}


def vtu(run, step_size):
    """Steps and grids of a run with VTU fields; checks names, units and times."""
    steps, grids = [], []
    for entry in xml.parse(run / "fields.pvd").iter("DataSet"):
        file = entry.get("file")
        step = int(Path(file).stem)
        assert Decimal(entry.get("timestep")) == step * step_size, f"{file}: {entry.get('timestep')} is not {step}·Δt"
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(run / file))
        reader.Update()
        grid = reader.GetOutput()
        for name, unit in UNITS.items():
            found = grid.GetPointData().GetArray(name).GetInformation().Get(vtk.vtkDataArray.UNITS_LABEL())
            assert found == unit, f"{file}: {name} in {found}"
        for name, components in COMPONENTS.items():
            array = grid.GetPointData().GetArray(name)
            found = " ".join(array.GetComponentName(i) for i in range(array.GetNumberOfComponents()))
            assert found == components, f"{file}: {name} has the components {found}"
        assert grid.GetFieldData().GetArray("TimeValue").GetValue(0) == float(step * step_size), file
        steps.append(step)
        grids.append(grid)
    return steps, grids


def against_tables(run, steps, grids):
    """Contact pressures must be those of contact.csv, on both bodies, and zero without contact."""
    pressures = {}
    for row in csv.DictReader((run / "contact.csv").open()):
        pressures.setdefault(int(row["step"]), {})[int(row["node"])] = float(row["pressure"])
    in_contact = 0
    for step, grid in zip(steps, grids):
        array = grid.GetPointData().GetArray("contact_pressure")
        found = [array.GetValue(i) for i in range(array.GetNumberOfValues())]
        listed = pressures.get(step, {})
        assert all(found[node] == pressure for node, pressure in listed.items()), f"contact pressure in step {step}"
        assert min(found) == 0.0 and any(found) == bool(listed), f"contact pressure in step {step}"
        bodies = set()
        for cell in range(grid.GetNumberOfCells()):
            if any(found[grid.GetCell(cell).GetPointId(i)] for i in range(grid.GetCell(cell).GetNumberOfPoints())):
                bodies.add(grid.GetCellData().GetArray("body").GetValue(cell))
        assert len(bodies) == (2 if listed else 0), f"contact pressure in step {step} on bodies {bodies}"
        in_contact += bool(listed)
    assert in_contact > 0, "no instant has contact"
    assert {grids[-1].GetCellType(i) for i in range(grids[-1].GetNumberOfCells())} == {69}
    return in_contact


def killed_and_resumed(carom, case, step_size, place):
    """Runs the case, kills the run, reads its fields, and resumes."""
    run = place / "run"
    command = [carom, "run", case, "--no-report", "--out", run]
    # The debug binary is ten times slower than the release binary, so wait for steps, not seconds.
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    listed = run / "fields.pvd"
    while process.poll() is None and not (listed.exists() and (run / "contact.csv").stat().st_size > 1000):
        time.sleep(0.001)
    assert process.poll() is None, "the run ended before it could be killed"
    process.send_signal(signal.SIGKILL)
    process.wait()
    steps, _ = vtu(run, step_size)
    subprocess.run([carom, "resume", run, "--no-report"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return run, len(steps)


def main():
    carom, finished = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    manifest = json.loads((finished / "manifest.json").read_text())
    step_size = Decimal(repr(manifest["case"]["time"]["step"]))
    steps, grids = vtu(finished, step_size)
    in_contact = against_tables(finished, steps, grids)
    with tempfile.TemporaryDirectory() as place:
        case = Path(place) / "case.toml"
        case.write_text(manifest["source"]["text"])
        run, seen = killed_and_resumed(carom, case, step_size, Path(place))
        assert 0 < seen < len(steps), f"{seen} of {len(steps)} instants when killed"
        again, resumed = vtu(run, step_size)
        assert again == steps
        for a, b in zip(grids, resumed):
            assert values(a) == values(b), "the fields of the resumed run differ"
        for name in ("history.csv", "contact.csv"):
            assert (run / name).read_bytes() == (finished / name).read_bytes(), f"{name} differs"
    print(f"{finished}: {len(steps)} instants, {in_contact} in contact; readable after a kill at {seen}")


if __name__ == "__main__":
    main()
