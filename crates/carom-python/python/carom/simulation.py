"""A simulation that is advanced step by step."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import _carom
from .case import Case
from .fingerprint import fingerprint_of_law
from .progress import thread_count
from .table import Table

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Step:
    """A step on the grid of times.

    Attributes
    ----------
    number : int
        From 1.
    time : float
        At its end, in units of time.
    newton : int
        Newton iterations.
    rejected : int
        Attempts that were rejected and repeated with a smaller step.
    activations, releases : int
        Nodes that came into contact, and that left it.
    penetration : float
        Depth of the deepest node of either side, in units of length.
    """

    number: int
    time: float
    newton: int
    rejected: int
    activations: int
    releases: int
    penetration: float


class Simulation:
    """A case from its start, advanced step by step.

    Parameters
    ----------
    case : Case
        The case; later changes of it have no effect.
    threads : int, optional
        Number of threads, by default one per core, and one for a model too small for more to pay;
        the result does not depend on it.
    laws : mapping of str to object, optional
        Laws of your own by the name of their material. A law has an attribute ``memory``, the count
        of numbers (at most 16) that a quadrature point remembers, all zero at first, and a method
        ``response(F, memory)`` that returns ``(stored, dissipated, P, dP/dF, memory)``: the energy
        that is stored, the one that is dissipated in the step, the first Piola–Kirchhoff stress of
        shape (3, 3), its derivative by F of shape (3, 3, 3, 3), and the memory at the end of the
        step. P is the derivative of the sum of both energies by F, and everything depends on
        ``F.T @ F`` alone. It is called for each point and evaluation, some fifty microseconds each.

    Examples
    --------
    A bar of 100 cells whose end is 5 from a wall flies at speed 10, and touches it at t = 0.5:

    >>> simulation = carom.Simulation(carom.Case.from_file("cases/bar/single.toml"))
    >>> simulation.y.shape, float(simulation.y[0, 0]), round(simulation.energies["total"], 9)
    ((101, 1), 5.0, 500.0)
    >>> for step in simulation:
    ...     if simulation.contacts.rows:
    ...         break
    >>> round(simulation.time, 2), simulation.contacts["node"].tolist()
    (0.5, [0])
    """

    def __init__(
        self, case: Case, threads: int | None = None, laws: Mapping[str, object] | None = None
    ) -> None:
        laws = dict(laws or {})
        fingerprints = {material: fingerprint_of_law(law) for material, law in laws.items()}
        self._core = _carom.Simulation(
            case._core, thread_count(threads), case._functions, laws, fingerprints
        )
        self._columns = self._core.columns()

    def advance(self) -> Step:
        """Advance to the next grid time.

        Returns
        -------
        Step
            What was done.

        Raises
        ------
        StoppedError
            If no step is accepted; the state is still that of the last grid time.
        StopIteration
            At the end time.
        """
        if self._core.finished:
            raise StopIteration("the simulation is at its end time")
        counts = self._core.advance()
        return Step(self._core.step, self._core.time, *counts)

    def __iter__(self) -> Iterator[Step]:
        while not self._core.finished:
            yield self.advance()

    def __len__(self) -> int:
        """Steps that are left."""
        return self.steps - self.step

    @property
    def finished(self) -> bool:
        """Whether the end time is reached."""
        return self._core.finished

    @property
    def step(self) -> int:
        """Steps done."""
        return self._core.step

    @property
    def steps(self) -> int:
        """Steps to the end time, from the start."""
        return self._core.steps

    @property
    def time(self) -> float:
        """Time of the state, in units of time."""
        return self._core.time

    @property
    def dt(self) -> float:
        """Step of the grid of times, in units of time."""
        return self._core.dt

    @property
    def y(self) -> Floats:
        """Positions, shape (nodes, dimension), in units of length; the array is a copy."""
        return self._core.y

    @property
    def v(self) -> Floats:
        """Velocities, shape (nodes, dimension), in length per time, as `y`."""
        return self._core.v

    @property
    def a(self) -> Floats:
        """Algorithmic accelerations, shape (nodes, dimension), in length per time², as `y`."""
        return self._core.a

    @property
    def reference(self) -> Floats:
        """Reference positions, shape (nodes, dimension), in units of length."""
        return self._core.reference

    @property
    def bodies(self) -> dict[str, slice]:
        """The nodes of every body: ``simulation.y[simulation.bodies["disc"]]``."""
        return {name: slice(first, end) for name, first, end in self._core.bodies()}

    @property
    def row(self) -> dict[str, float]:
        """The row of the history that a run would record now, by column.

        Counts are those of the last step.
        """
        return dict(zip((name for name, _ in self._columns), self._core.row()))

    @property
    def units(self) -> dict[str, str]:
        """Units of the columns of `row`."""
        return dict(self._columns)

    @property
    def energies(self) -> dict[str, float]:
        """Kinetic, strain, potential and total energy, works, dissipation: columns of `row`.

        In units of energy: ``units["kinetic"]``.
        """
        row, units = self.row, self.units
        energy = units["kinetic"]
        # Other columns, such as moments, may have the unit of an energy.
        names = list(units)
        first, last = names.index("kinetic"), names.index("energy_scale")
        own = names[first : last + 1] + [name for name in names if name == "plastic_work"]
        return {name: row[name] for name in own if units[name] == energy}

    @property
    def contacts(self) -> Table:
        """The active contact nodes, with the columns of `Run.contact`."""
        return Table._of_core(self._core.contact(), self._core.contact_units())

    def checkpoint(self) -> bytes:
        """The state, to be restored in this or another simulation of the same case.

        Returns
        -------
        bytes
            The state, with the case and the names of its functions.
        """
        return self._core.checkpoint()

    def restore(self, checkpoint: bytes) -> None:
        """Continue from a checkpoint; what follows is bitwise what followed it then.

        Parameters
        ----------
        checkpoint : bytes
            Of this case with the same Python functions.

        Raises
        ------
        CaseError
            If it was made with other Python functions.
        ValueError
            If it belongs to another case.
        """
        self._core.restore(checkpoint)

    def __repr__(self) -> str:
        return f"<Simulation at t = {self.time:g}, step {self.step} of {self.steps}>"

