"""Fields at recorded instants, as arrays or as VTK grids with curved cells."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import _carom

if TYPE_CHECKING:
    import pyvista

Floats = NDArray[np.float64]

NOT_RECORDED = 'no fields are recorded; set "output.fields_every" of the case to 1 or more'


@dataclass(frozen=True)
class Block:
    """Cells of a body.

    Attributes
    ----------
    body : str
        Its name.
    vtk_type : int
        Lagrange cells. 68: curve; 69: triangle; 70: quadrilateral; 71: tetrahedron; 72: hexahedron.
    degree : int
        1 to 3.
    cells : ndarray, shape (cells, nodes)
        Point numbers: corners, then the nodes of each edge, of each face, and the interior.
    """

    body: str
    vtk_type: int
    degree: int
    cells: NDArray[np.int64]


@dataclass(frozen=True)
class FieldSet:
    """Fields at one instant.

    Attributes
    ----------
    time : float
        The instant, in units of time.
    points : ndarray, shape (points, 3)
        Reference positions, in units of length.
    blocks : list of Block
        Cells, one block per body.
    arrays : dict of str to ndarray, shape (points, components)
        ``displacement``, ``velocity``, ``stress`` (Cauchy, XX YY ZZ XY YZ XZ), ``von_mises``,
        ``principal_stress`` (descending, tension positive), ``principal_log_strain`` (ln λ of the
        principal stretches, descending; no unit), ``contact_pressure``.
    units : dict of str to str
        Their unit labels.
    """

    time: float
    points: Floats
    blocks: list[Block]
    arrays: dict[str, Floats]
    units: dict[str, str]

    @property
    def positions(self) -> Floats:
        """Current positions, shape (points, 3)."""
        return self.points + self.arrays["displacement"]

    def quantity(self, name: str) -> tuple[Floats, str]:
        """A scalar at the points.

        Parameters
        ----------
        name : str
            ``sigma_xx`` …, ``von_mises``, ``principal_stress_1`` (the largest) to ``_3``,
            ``principal_log_strain_1`` to ``_3``, ``contact_pressure``, ``ux``, ``vy``, …

        Returns
        -------
        values : ndarray, shape (points,)
            The values; NaN where there is none.
        unit : str
            Their unit label.
        """
        stress = self.arrays["stress"]
        axes = {"x": 0, "y": 1, "z": 2}
        components = ["xx", "yy", "zz", "xy", "yz", "xz"]
        if name.startswith("sigma_") and name[6:] in components:
            return stress[:, components.index(name[6:])], self.units["stress"]
        principal, _, number = name.rpartition("_")
        if principal.startswith("principal_") and principal in self.arrays and number in ("1", "2", "3"):
            return self.arrays[principal][:, int(number) - 1], self.units[principal]
        if name == "von_mises":
            xx, yy, zz, xy, yz, xz = stress.T
            normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
            return np.sqrt(normal / 2 + 3 * (xy**2 + yz**2 + xz**2)), self.units["stress"]
        if len(name) == 2 and name[0] in "uv" and name[1] in axes:
            field = "displacement" if name[0] == "u" else "velocity"
            return self.arrays[field][:, axes[name[1]]], self.units[field]
        if name in self.arrays and self.arrays[name].shape[1] == 1:
            return self.arrays[name][:, 0], self.units[name]
        raise ValueError(
            f"no field is named {name!r}; try sigma_xx, sigma_yy, sigma_xy, von_mises, "
            "principal_stress_1, principal_log_strain_1, contact_pressure, ux, uy, vx or vy"
        )

    def grid(self) -> pyvista.UnstructuredGrid:
        """The fields for PyVista and VTK.

        Returns
        -------
        pyvista.UnstructuredGrid
            Lagrange cells, which are curved, at the reference positions;
            ``grid.warp_by_vector("displacement")`` is the deformed grid.
        """
        import pyvista

        cells, types = [], []
        for block in self.blocks:
            width = block.cells.shape[1]
            cells.append(np.column_stack([np.full(len(block.cells), width), block.cells]).ravel())
            types.append(np.full(len(block.cells), block.vtk_type, dtype=np.uint8))
        grid = pyvista.UnstructuredGrid(np.concatenate(cells), np.concatenate(types), self.points)
        for name, values in self.arrays.items():
            grid.point_data[name] = values[:, 0] if values.shape[1] == 1 else values
        grid.field_data["time"] = [self.time]
        return grid


class Fields(Mapping[float, "pyvista.UnstructuredGrid"]):
    """Fields by time: ``run.fields[0.3]`` is the grid of the nearest recorded instant."""

    def __init__(self, core: _carom.Record) -> None:
        self._core = core
        self.times: Floats = np.asarray(core.field_times)

    def __len__(self) -> int:
        return len(self.times)

    def __iter__(self) -> Iterator[float]:
        return iter(self.times.tolist())

    def __getitem__(self, time: float) -> pyvista.UnstructuredGrid:
        return self.at(time).grid()

    def at(self, time: float) -> FieldSet:
        """The fields of the recorded instant nearest to a time, as arrays.

        Parameters
        ----------
        time : float
            The time, in units of time.

        Returns
        -------
        FieldSet
            The fields.

        Raises
        ------
        KeyError
            If nothing is recorded, or the time is outside the recorded interval.
        """
        if not len(self.times):
            raise KeyError(NOT_RECORDED)
        first, last = self.times[0], self.times[-1]
        if not first - 1e-9 <= time <= last * (1 + 1e-9) + 1e-12:
            raise KeyError(f"t = {time:g} is outside the recorded interval, {first:g} to {last:g}")
        return self.number(int(np.argmin(np.abs(self.times - time))))

    def number(self, i: int) -> FieldSet:
        """The fields of a recorded instant by its number.

        Parameters
        ----------
        i : int
            From 0, or -1 for the last one.

        Returns
        -------
        FieldSet
            The fields.
        """
        try:
            raw = self._core.field(range(len(self))[i])
        except IndexError:
            raise IndexError(f"{len(self)} instants are recorded, and none of them is number {i}") from None
        return FieldSet(
            time=raw["time"],
            points=raw["points"],
            blocks=[Block(*block) for block in raw["blocks"]],
            arrays={name: values for name, _, values in raw["arrays"]},
            units={name: unit for name, unit, _ in raw["arrays"]},
        )
