#!/usr/bin/env python3
"""Generates meshes of bodies in space with Gmsh: tetrahedra of second order, format 2.2.

    pip install gmsh==4.15.2
    python3 scripts/make_space_meshes.py

The gmsh wheel needs libglu1-mesa libxrender1 libxcursor1 libxft2 libxinerama1.

cases/space/half-ball.msh: the half y > 0 of a ball of radius 1 about the origin, refined at (0, 0, -1)
for contact within a tenth of its radius. Volume `ball`; surfaces `sphere`, `cap` (the part of the
sphere above z = 0.9) and `plane_y`.

cases/space/half-space.msh: the quarter x, y > 0 of the half z < 0 of a ball of radius 0.4 about the
origin, refined at the circle of radius 0.1 in z = 0, the edge of a contact. Volume `ground`; surfaces
`touched` (in the circle), `free`, `far`, `plane_x` and `plane_y`.
"""

from pathlib import Path

import gmsh

ROOT = Path(__file__).resolve().parent.parent
FINE, RADIUS, GROWTH, COARSE = 0.045, 0.15, 0.4, 0.4


def start(name):
    gmsh.clear()
    gmsh.option.restoreDefaults()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.model.add(name)


def half_ball():
    start("half-ball")
    geo, field = gmsh.model.geo, gmsh.model.mesh.field
    center = geo.addPoint(0, 0, 0)
    west, east, back, low, high = (geo.addPoint(*x) for x in ((-1, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, -1), (0, 0, 1)))
    ring = [west, low, east, high]
    rims = [geo.addCircleArc(a, center, b) for a, b in zip(ring, ring[1:] + ring[:1])]
    ribs = [geo.addCircleArc(a, center, back) for a in ring]
    sides = []
    for i in range(4):
        loop = geo.addCurveLoop([rims[i], ribs[(i + 1) % 4], -ribs[i]])
        sides.append(geo.addSurfaceFilling([loop], sphereCenterTag=center))
    plane = geo.addPlaneSurface([geo.addCurveLoop(rims)])
    volume = geo.addVolume([geo.addSurfaceLoop([*sides, plane])])
    geo.synchronize()
    gmsh.model.addPhysicalGroup(2, sides, name="sphere")
    gmsh.model.addPhysicalGroup(2, [plane], name="plane_y")
    gmsh.model.addPhysicalGroup(3, [volume], name="ball")
    size = field.add("MathEval")
    field.setString(size, "F", f"Min({COARSE}, {FINE} + {GROWTH}*Max(0, Sqrt(x*x + y*y + (z + 1)*(z + 1)) - {RADIUS}))")
    mesh(size)
    write(ROOT / "cases/space/half-ball.msh", lambda name, x: "cap" if name == "sphere" and min(x[2::3]) > 0.9 else name)


def half_space(edge=0.1, reach=0.4):
    start("half-space")
    geo, field = gmsh.model.geo, gmsh.model.mesh.field
    center, x, y, far_x, far_y, low = (geo.addPoint(*p) for p in ((0, 0, 0), (edge, 0, 0), (0, edge, 0), (reach, 0, 0), (0, reach, 0), (0, 0, -reach)))
    rim, rim_x, rim_y = geo.addCircleArc(x, center, y), geo.addLine(center, x), geo.addLine(center, y)
    out_x, out_y, down = geo.addLine(x, far_x), geo.addLine(y, far_y), geo.addLine(center, low)
    top, arc_x, arc_y = (geo.addCircleArc(a, center, b) for a, b in ((far_x, far_y), (far_x, low), (far_y, low)))
    loop = lambda *curves: geo.addCurveLoop(list(curves))
    sides = {
        "touched": geo.addPlaneSurface([loop(rim_x, rim, -rim_y)]),
        "free": geo.addPlaneSurface([loop(out_x, top, -out_y, -rim)]),
        "far": geo.addSurfaceFilling([loop(top, arc_y, -arc_x)], sphereCenterTag=center),
        "plane_y": geo.addPlaneSurface([loop(rim_x, out_x, arc_x, -down)]),
        "plane_x": geo.addPlaneSurface([loop(rim_y, out_y, arc_y, -down)]),
    }
    volume = geo.addVolume([geo.addSurfaceLoop(list(sides.values()))])
    geo.synchronize()
    for name, side in sides.items():
        gmsh.model.addPhysicalGroup(2, [side], name=name)
    gmsh.model.addPhysicalGroup(3, [volume], name="ground")
    size = field.add("MathEval")
    field.setString(size, "F", f"0.006 + 0.4*Sqrt((Sqrt(x*x + y*y) - {edge})^2 + z*z)")
    mesh(size)
    write(ROOT / "cases/space/half-space.msh")


def mesh(size):
    gmsh.model.mesh.field.setAsBackgroundMesh(size)
    for option in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(2)
    gmsh.model.mesh.optimize("HighOrderElastic")


def write(path, name_of=lambda name, _: name):
    """Cells in groups with their names, which may depend on their places, and nodes to ten digits."""
    tags, places, _ = gmsh.model.mesh.getNodes()
    at = {tag: places[3 * i : 3 * i + 3] for i, tag in enumerate(tags)}
    groups, elements = {}, []
    for dimension, tag in gmsh.model.getPhysicalGroups():
        whole = gmsh.model.getPhysicalName(dimension, tag)
        for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
            for kind, _, nodes in zip(*gmsh.model.mesh.getElements(dimension, entity)):
                width = gmsh.model.mesh.getElementProperties(kind)[3]
                for cell in (nodes[i : i + width] for i in range(0, len(nodes), width)):
                    name = name_of(whole, [x for node in cell for x in at[node]])
                    group = groups.setdefault(name, (dimension, len(groups) + 1))[1]
                    elements.append((kind, group, cell))
    number = {tag: i for i, tag in enumerate(sorted({tag for _, _, cell in elements for tag in cell}), 1)}
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {group} "{name}"' for name, (dimension, group) in groups.items()]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(number))]
    # Adding 0.0 removes the sign of -0.0.
    lines += [f"{number[tag]} " + " ".join(f"{round(x, 10) + 0.0:.10g}" for x in at[tag]) for tag in number]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    for i, (kind, group, cell) in enumerate(elements, 1):
        lines.append(f"{i} {kind} 2 {group} {group} " + " ".join(str(number[tag]) for tag in cell))
    path.write_text("\n".join([*lines, "$EndElements", ""]))
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size} bytes, {len(number)} nodes, {len(elements)} elements")


def main():
    gmsh.initialize()
    half_ball()
    half_space()
    gmsh.finalize()


if __name__ == "__main__":
    main()
