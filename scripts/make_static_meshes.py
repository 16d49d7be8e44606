#!/usr/bin/env python3
"""Generates the meshes of cases/static with Gmsh: cylinders.msh (Hertz problems) and ring.msh.

    pip install gmsh==4.15.2
    python3 scripts/make_static_meshes.py

The gmsh wheel needs libglu1-mesa libxrender1 libxcursor1 libxft2 libxinerama1.

cylinders.msh: a quarter of a cylinder of radius 1 that touches y = 0 at the origin, refined there,
and its mirror image below, node for node, so that the nodes of two equal cylinders match. Surfaces
`upper` and `lower`; curves `arc`, `axis` (x = 0) and `cut` (|y| = 1).

ring.msh: the quarter x, y > 0 of a ring of radii 1 and 2, of third order. Surface `ring`; curves
`inner`, `outer`, `bottom` (y = 0) and `left` (x = 0).
"""

from pathlib import Path

import gmsh

ROOT = Path(__file__).resolve().parent.parent
FINE, RADIUS, COARSE = 0.005, 0.075, 0.2


def quarter():
    """Nodes, and second-order cells by the name of their group."""
    geo, field = gmsh.model.geo, gmsh.model.mesh.field
    low, right, center = (geo.addPoint(x, y, 0) for x, y in ((0, 0), (1, 1), (0, 1)))
    curves = {"arc": geo.addCircleArc(low, center, right), "cut": geo.addLine(right, center), "axis": geo.addLine(center, low)}
    surface = geo.addPlaneSurface([geo.addCurveLoop(list(curves.values()))])
    geo.synchronize()
    size = field.add("MathEval")
    field.setString(size, "F", f"Min({COARSE}, {FINE} + 0.25*Max(0, Sqrt(x*x + y*y) - {RADIUS}))")
    field.setAsBackgroundMesh(size)
    for option in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints"):
        gmsh.option.setNumber(f"Mesh.{option}", 0)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(2)
    tags, places, _ = gmsh.model.mesh.getNodes()
    nodes = {tag: tuple(places[3 * i : 3 * i + 2]) for i, tag in enumerate(tags)}
    groups = {}
    for name, dimension, entity in [("body", 2, surface), *((name, 1, curve) for name, curve in curves.items())]:
        _, _, cells = gmsh.model.mesh.getElements(dimension, entity)
        width = 6 if dimension == 2 else 3
        groups[name] = [list(cells[0][i : i + width]) for i in range(0, len(cells[0]), width)]
    return nodes, groups


def ring():
    geo = gmsh.model.geo
    center, *corners = (geo.addPoint(x, y, 0, 0.25) for x, y in ((0, 0), (1, 0), (2, 0), (0, 2), (0, 1)))
    a, b, c, d = corners
    curves = {"bottom": geo.addLine(a, b), "outer": geo.addCircleArc(b, center, c), "left": geo.addLine(c, d), "inner": geo.addCircleArc(d, center, a)}
    surface = geo.addPlaneSurface([geo.addCurveLoop(list(curves.values()))])
    geo.synchronize()
    gmsh.model.addPhysicalGroup(2, [surface], name="ring")
    for name, curve in curves.items():
        gmsh.model.addPhysicalGroup(1, [curve], name=name)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(3)
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    path = ROOT / "cases/static/ring.msh"
    gmsh.write(str(path))
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size} bytes, {len(gmsh.model.mesh.getNodes()[0])} nodes")


def cylinders(nodes, groups):
    number = {tag: i + 1 for i, tag in enumerate(nodes)}
    places, cells = [], []
    for part, (surface, sign) in enumerate((("upper", 1), ("lower", -1))):
        shift = part * len(nodes)
        # Adding 0.0 removes the sign of -0.0.
        places += [(x, sign * y + 0.0) for x, y in nodes.values()]
        for name, lines in groups.items():
            group = ["arc", "axis", "cut", "upper", "lower"].index(surface if name == "body" else name) + 1
            for cell in lines:
                cell = [number[tag] + shift for tag in cell]
                if sign < 0:
                    # The reflection reverses the orientation, so reverse the order of the nodes.
                    order = [0, 2, 1, 5, 4, 3] if len(cell) == 6 else [1, 0, 2]
                    cell = [cell[i] for i in order]
                cells.append([9 if len(cell) == 6 else 8, 2, group, group, *cell])
    names = [(1, "arc"), (1, "axis"), (1, "cut"), (2, "upper"), (2, "lower")]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    lines += [f'{dimension} {i + 1} "{name}"' for i, (dimension, name) in enumerate(names)]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(places))]
    lines += [f"{i + 1} {x!r} {y!r} 0" for i, (x, y) in enumerate((float(x), float(y)) for x, y in places)]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += [" ".join(map(str, [i + 1, *cell])) for i, cell in enumerate(cells)]
    lines.append("$EndElements")
    path = ROOT / "cases/static/cylinders.msh"
    path.write_text("\n".join(lines) + "\n")
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size} bytes, {len(places)} nodes")


def main():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    ring()
    gmsh.clear()
    cylinders(*quarter())
    gmsh.finalize()


if __name__ == "__main__":
    main()
