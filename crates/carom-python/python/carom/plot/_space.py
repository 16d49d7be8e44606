"""Figures in space: the deformed bodies, and the contact pressure along a side."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize, TwoSlopeNorm
from matplotlib.tri import Triangulation
from numpy.typing import NDArray

from ..fields import NOT_RECORDED, Block, FieldSet
from ..run import Run
from ._style import Size, axes, labelled, style

Floats = NDArray[np.float64]

#: Triangles between the nodes (corners, edges, interior) of plane Lagrange cells, by number of
#: nodes.
_LATTICE = {
    3: [(0, 1, 2)],
    4: [(0, 1, 2), (0, 2, 3)],
    6: [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
    9: [(0, 4, 8), (4, 1, 8), (1, 5, 8), (5, 2, 8), (2, 6, 8), (6, 3, 8), (3, 7, 8), (7, 0, 8)],
    10: [
        (0, 3, 8),
        (3, 9, 8),
        (3, 4, 9),
        (4, 5, 9),
        (4, 1, 5),
        (8, 9, 7),
        (9, 6, 7),
        (9, 5, 6),
        (7, 6, 2),
    ],
}

#: Corners of the plane cells, by VTK type.
_CORNERS = {69: 3, 70: 4}


def snapshot(
    run: Run,
    time: float,
    quantity: str = "sigma_yy",
    *,
    mesh: bool = True,
    limits: tuple[float, float] | None = None,
    ax: Axes | None = None,
    size: Size = "single",
) -> Axes:
    """A quantity on the deformed bodies at the recorded instant nearest to a time.

    Cells are divided at their nodes, so that curved sides are shown as they are.

    Parameters
    ----------
    run : Run
        A run in the plane with recorded fields.
    time : float
        The instant, in units of time.
    quantity : str
        ``sigma_xx``, ``sigma_yy``, ``sigma_xy``, ``von_mises``, ``contact_pressure``, ``ux``, ``vy``.
    mesh : bool
        Whether the edges of cells are drawn.
    limits : (float, float), optional
        Range of the colours; by default that of the instant, symmetric for signed quantities.
    ax : Axes, optional
        Where to draw; by default a new figure.
    size : str or (float, float)
        Of a new figure: ``"single"``, ``"double"`` or (width, height) in inches.

    Returns
    -------
    Axes
        The Axes.
    """
    _in_the_plane(run)
    fields = run.fields.at(time)
    values, unit = fields.quantity(quantity)
    norm, colours = _colours(quantity, values, limits)
    with style():
        ax = axes(ax, size)
        drawn = _draw(ax, fields, values, norm, colours, mesh)
        bar = ax.figure.colorbar(drawn, ax=ax, shrink=0.9, pad=0.02)
        bar.set_label(labelled(quantity, unit))
        ax.set_title(f"t = {fields.time:.4g} {run.history.units['time']}".rstrip())
        ax.set_aspect("equal")
        ax.autoscale_view()
        ax.axis("off")
    return ax


def animate(
    run: Run,
    quantity: str = "sigma_yy",
    *,
    frames: int = 60,
    mesh: bool = False,
    size: Size = "single",
) -> Any:
    """An animation of a quantity on the deformed bodies.

    Parameters
    ----------
    run : Run
        A run in the plane with recorded fields.
    quantity : str
        As in `snapshot`.
    frames : int
        Largest number of recorded instants that are shown.
    mesh : bool
        Whether the edges of cells are drawn.
    size : str or (float, float)
        ``"single"``, ``"double"`` or (width, height) in inches.

    Returns
    -------
    matplotlib.animation.FuncAnimation
        ``.save("impact.gif")``; notebooks show ``.to_jshtml()``.
    """
    from matplotlib.animation import FuncAnimation

    _in_the_plane(run)
    count = len(run.fields)
    if not count:
        raise KeyError(NOT_RECORDED)
    chosen = np.unique(np.linspace(0, count - 1, min(frames, count)).round().astype(int))
    sets = [run.fields.number(int(i)) for i in chosen]
    found = [fields.quantity(quantity) for fields in sets]
    norm, colours = _colours(quantity, np.concatenate([values for values, _ in found]), None)
    corners = np.concatenate([fields.positions[:, :2] for fields in sets])
    low, high = corners.min(0), corners.max(0)
    margin = 0.03 * (high - low).max()
    with style():
        ax = axes(None, size)
        mappable = plt.cm.ScalarMappable(norm, colours)
        ax.figure.colorbar(mappable, ax=ax, shrink=0.9, pad=0.02).set_label(labelled(quantity, found[0][1]))

    def frame(i: int) -> list[Any]:
        ax.clear()
        drawn = _draw(ax, sets[i], found[i][0], norm, colours, mesh)
        ax.set_xlim(low[0] - margin, high[0] + margin)
        ax.set_ylim(low[1] - margin, high[1] + margin)
        ax.set_aspect("equal")
        ax.axis("off")
        ax.set_title(f"t = {sets[i].time:.4g} {run.history.units['time']}".rstrip(), fontsize=8)
        return [drawn]

    animation = FuncAnimation(ax.figure, frame, frames=len(sets), interval=50)  # type: ignore[arg-type]
    plt.close(ax.figure)  # type: ignore[arg-type]
    return animation


def pressure_map(
    run: Run, contact: str | None = None, *, ax: Axes | None = None, size: Size = "single"
) -> Axes:
    """The contact pressure p(s, t) along the secondary side.

    Parameters
    ----------
    run : Run
        A run in the plane, or of bars, with recorded fields, which contain the side.
    contact : str, optional
        Name of the contact; by default the first one.
    ax : Axes, optional
        Where to draw; by default a new figure.
    size : str or (float, float)
        Of a new figure: ``"single"``, ``"double"`` or (width, height) in inches.

    Returns
    -------
    Axes
        The Axes.

    Notes
    -----
    s is the arc length along the undeformed side, from its first node; from a node opposite to the
    contact if the side is closed. The pressure of a corner of the primary side is shown at the node that
    is nearest to it.
    """
    contacts = {c["name"]: c for c in run.case["contacts"]}
    if not contacts:
        raise ValueError("the case has no contact")
    if run.case["dimension"] == 3:
        raise ValueError("this map is along a line; in space, run.fields[t] contains contact_pressure")
    if not len(run.fields):
        raise KeyError(NOT_RECORDED)
    name = contact or next(iter(contacts))
    if name not in contacts:
        raise ValueError(f"no contact is named {name!r}; the contacts are: {', '.join(contacts)}")
    side = contacts[name]["secondary"]
    chains = [np.asarray(chain) for chain in run.manifest["sides"][side]]
    fields, rows = run.fields.number(0), run.contact
    mine = rows["contact"] == name
    active, pressures = rows["node"][mine], rows["pressure"][mine]
    # Corners of the primary are contact nodes, too; their facets are those of this side.
    corners = ~np.isin(active, np.concatenate(chains))
    degree = next(block.degree for block in fields.blocks if block.body == side.split(".")[0])
    facets = np.concatenate([_facets(chain, degree) for chain in chains])
    nearest = np.rint((rows["xi"][mine] + 1) / 2 * degree).astype(int)
    active = np.where(corners, 0, active)
    active[corners] = facets[rows["facet"][mine][corners], nearest[corners]]
    nodes = _unrolled(np.concatenate(chains), active)
    lengths = np.concatenate(
        [[0.0], np.cumsum(np.linalg.norm(np.diff(fields.points[nodes], axis=0), axis=1))]
    )
    place = {int(node): k for k, node in enumerate(nodes)}
    line = np.array([place[int(node)] for node in active], dtype=int)

    times, row = np.unique(rows["time"][mine], return_inverse=True)
    with style():
        ax = axes(ax, size)
        if len(times):
            grid = run.history["time"]
            grid = grid[(grid >= times[0]) & (grid <= times[-1])]
            pressure = np.zeros((len(nodes), len(grid)))
            column = np.searchsorted(grid, times)[row]
            # A node that is in contact itself is not hidden by a corner beside it.
            for some in (corners, ~corners):
                pressure[line[some], column[some]] = pressures[some]
            drawn = ax.pcolormesh(grid, lengths, pressure, cmap="cividis", shading="nearest", rasterized=True)
            touched = lengths[(pressure != 0).any(axis=1)]
            low, high = touched.min(initial=lengths[-1]), touched.max(initial=0)
            if high > low:  # not the end of a bar
                margin = 0.15 * (high - low)
                ax.set_ylim(max(low - margin, 0), min(high + margin, lengths[-1]))
            bar = ax.figure.colorbar(drawn, ax=ax)
            bar.set_label(labelled("contact pressure", rows.units["pressure"]))
        ax.set_xlabel(labelled("time", run.history.units["time"]))
        ax.set_ylabel(labelled("arc length", run.history.units["penetration"]))
        ax.set_title(name)
    return ax


def _in_the_plane(run: Run) -> None:
    """What shows the other bodies is named before a figure is begun."""
    dimension = run.case["dimension"]
    if dimension == 3:
        raise ValueError(
            "this figure shows bodies in the plane; in space, "
            'run.fields[t].warp_by_vector("displacement").plot(scalars="stress", component=2) draws with '
            "PyVista, and the page of a run in a directory has a scene to turn, cut and play"
        )
    if dimension == 1:
        raise ValueError(
            "this figure shows bodies in the plane; of bars, run.fields.at(t).points[:, 0] and "
            '.quantity("sigma_xx") are place and stress'
        )


def _facets(chain: NDArray[np.int64], degree: int) -> NDArray[np.int64]:
    """The nodes of every facet of a chain, shape (facets, degree + 1)."""
    starts = np.arange(0, len(chain) - 1, degree)
    nodes: NDArray[np.int64] = chain[starts[:, None] + np.arange(degree + 1)]
    return nodes


def _unrolled(nodes: NDArray[np.int64], active: NDArray[np.int64]) -> NDArray[np.int64]:
    """The nodes of a side; a closed one begins in the middle of its longest part without contact."""
    if len(nodes) < 3 or nodes[0] != nodes[-1]:
        return nodes
    nodes = nodes[:-1]
    touched = np.flatnonzero(np.isin(nodes, active))
    if not len(touched):
        return nodes
    free = np.diff(np.append(touched, touched[0] + len(nodes)))
    longest = int(np.argmax(free))
    return np.roll(nodes, -(int(touched[longest]) + int(free[longest]) // 2))


def _colours(quantity: str, values: Floats, limits: tuple[float, float] | None) -> tuple[Normalize, str]:
    """Blue is compression, red is tension; quantities without sign are in one hue."""
    finite = values[np.isfinite(values)]
    signed = quantity not in ("von_mises", "contact_pressure")
    if limits is None:
        most = float(np.abs(finite).max(initial=0.0)) or 1.0
        limits = (-most, most) if signed else (0.0, most)
    if signed and limits[0] < 0 < limits[1]:
        return TwoSlopeNorm(0.0, *limits), "RdBu_r"
    return Normalize(*limits), "RdBu_r" if signed else "cividis"


def _draw(
    ax: Axes, fields: FieldSet, values: Floats, norm: Normalize, colours: str, mesh: bool
) -> Any:
    """The bodies; edges of cells along their nodes."""
    y = fields.positions
    triangles = np.concatenate([_triangles(block) for block in fields.blocks])
    # Where J ≤ 0 there is no stress.
    masked = np.isnan(values[triangles]).any(axis=1)
    shape = Triangulation(y[:, 0], y[:, 1], triangles, mask=masked)
    drawn = ax.tripcolor(
        shape, np.nan_to_num(values), shading="gouraud", cmap=colours, norm=norm, rasterized=True
    )
    for block in fields.blocks:
        edges = _edges(block)
        count = np.unique(np.sort(edges[:, [0, -1]], axis=1), axis=0, return_inverse=True, return_counts=True)
        outline = edges[count[2][count[1].ravel()] == 1]
        ax.add_collection(LineCollection(list(y[outline][:, :, :2]), colors="k", linewidths=0.6))
        if mesh:
            ax.add_collection(
                LineCollection(list(y[edges][:, :, :2]), colors="k", linewidths=0.15, alpha=0.5)
            )
    return drawn


def _triangles(block: Block) -> NDArray[np.int64]:
    if block.vtk_type not in _CORNERS:
        return np.empty((0, 3), dtype=np.int64)
    lattice = _LATTICE[block.cells.shape[1]]
    return np.concatenate([block.cells[:, list(corners)] for corners in lattice])


def _edges(block: Block) -> NDArray[np.int64]:
    """Nodes along every edge of every cell, from corner to corner."""
    corners, inner, cells = _CORNERS[block.vtk_type], block.degree - 1, block.cells
    edges = []
    for k in range(corners):
        between = [corners + k * inner + i for i in range(inner)]
        edges.append(cells[:, [k, *between, (k + 1) % corners]])
    return np.concatenate(edges)
