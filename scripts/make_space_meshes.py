#!/usr/bin/env python3
"""Generates meshes of bodies in space with Gmsh: tetrahedra of second order, format 2.2.

    pip install gmsh==4.15.2
    python3 scripts/make_space_meshes.py

The gmsh wheel needs libglu1-mesa libxrender1 libxcursor1 libxft2 libxinerama1.

cases/space/half-ball.msh: the half y > 0 of a ball of radius 1 about the origin, refined at (0, 0, -1)
for contact within a tenth of its radius. Volume `ball`; surfaces `sphere`, `cap` (the part of the
sphere above z = 0.9) and `plane_y`. half-ball-fine.msh: with half of the cells' size there, for contact
within a twentieth of its radius.

cases/space/half-space.msh: the quarter x, y > 0 of the half z < 0 of a ball of radius 0.4 about the
origin, refined at the circle of radius 0.1 in z = 0, the edge of a contact. Volume `ground`; surfaces
`touched` (in the circle), `free`, `far`, `plane_x` and `plane_y`.

cases/space/punch.msh: a disc of 60 triangles, slightly larger than that circle, which faces downwards.
Physical surface `face`.

docs/book/examples/bracket.msh: an angle bracket of 50 mm with a rib and holes. Volume `bracket`;
surface `skin`.

docs/book/examples/cup.msh: a quarter of a cup upside down, a shell of revolution. Volume `cup`;
surfaces `rim`, `outer`, `inner`, `plane_x` and `plane_y`.
"""

import math
from pathlib import Path

import gmsh

ROOT = Path(__file__).resolve().parent.parent
GROWTH, COARSE = 0.4, 0.4


def start(name):
    gmsh.clear()
    gmsh.option.restoreDefaults()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.model.add(name)


def half_ball(name, fine, radius):
    start(name)
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
    field.setString(size, "F", f"Min({COARSE}, {fine} + {GROWTH}*Max(0, Sqrt(x*x + y*y + (z + 1)*(z + 1)) - {radius}))")
    mesh(size)
    write(ROOT / f"cases/space/{name}.msh", lambda name, x: "cap" if name == "sphere" and min(x[2::3]) > 0.9 else name)


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


def punch(radius=0.10001, count=60):
    corners = [(radius * math.cos(2 * math.pi * i / count), radius * math.sin(2 * math.pi * i / count), 0) for i in range(count)]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "1", '2 1 "face"', "$EndPhysicalNames"]
    lines += ["$Nodes", str(count + 1)]
    lines += [f"{i} {x:.9g} {y:.9g} {z}" for i, (x, y, z) in enumerate([(0, 0, 0), *corners], 1)]
    lines += ["$EndNodes", "$Elements", str(count)]
    lines += [f"{i} 2 2 1 1 1 {i % count + 2} {i + 1}" for i in range(1, count + 1)]
    (ROOT / "cases/space/punch.msh").write_text("\n".join([*lines, "$EndElements", ""]))


def bracket():
    start("bracket")
    occ = gmsh.model.occ
    foot, wall = occ.addBox(0, 0, 0, 1, 0.8, 0.16), occ.addBox(0, 0, 0, 0.16, 0.8, 1)
    points = [occ.addPoint(*x) for x in ((0.1, 0.34, 0.1), (0.75, 0.34, 0.1), (0.1, 0.34, 0.75))]
    edges = [occ.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
    rib = occ.extrude([(2, occ.addPlaneSurface([occ.addCurveLoop(edges)]))], 0, 0.12, 0)
    solid = [x for x in rib if x[0] == 3]
    whole, _ = occ.fuse([(3, foot)], [(3, wall), *solid])
    holes = [(3, occ.addCylinder(0.72, 0.17, -1, 0, 0, 2, 0.09)), (3, occ.addCylinder(0.72, 0.63, -1, 0, 0, 2, 0.09))]
    holes.append((3, occ.addCylinder(-1, 0.4, 0.86, 2, 0, 0, 0.07)))
    part, _ = occ.cut(whole, holes)
    occ.dilate(part, 0, 0, 0, 50, 50, 50)
    occ.synchronize()
    gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], name="bracket")
    gmsh.model.addPhysicalGroup(2, [tag for _, tag in gmsh.model.getEntities(2)], name="skin")
    size = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(size, "F", "11")
    mesh(size, curvature=8)
    write(ROOT / "docs/book/examples/bracket.msh")


def cup(radius=1.0, thick=0.06, height=1.5, corner=0.35):
    """Its profile is turned about z: wall, rounded corner, bottom (above)."""
    start("cup")
    occ = gmsh.model.occ
    outer = [(radius, 0), (radius, height - corner), (radius - corner, height), (0, height)]
    inner = [(0, height - thick), (radius - corner, height - thick), (radius - thick, height - corner), (radius - thick, 0)]
    center = occ.addPoint(radius - corner, 0, height - corner)
    at = [occ.addPoint(x, 0, z) for x, z in outer + inner]
    curves = [occ.addLine(at[i], at[(i + 1) % 8]) if i not in (1, 5) else occ.addCircleArc(at[i], center, at[i + 1]) for i in range(8)]
    profile = occ.addPlaneSurface([occ.addCurveLoop(curves)])
    occ.revolve([(2, profile)], 0, 0, 0, 0, 0, 1, math.pi / 2)
    occ.synchronize()
    gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], name="cup")
    sides = {name: [] for name in ("rim", "plane_x", "plane_y", "outer", "inner")}
    for _, tag in gmsh.model.getEntities(2):
        low, high = (gmsh.model.getBoundingBox(2, tag)[k : k + 3] for k in (0, 3))
        where = {"rim": high[2] < 1e-5, "plane_x": high[0] < 1e-5, "plane_y": high[1] < 1e-5}
        middle = occ.getCenterOfMass(2, tag)
        flat = math.hypot(*middle[:2])
        where["outer"] = middle[2] > height - 0.6 * thick or high[0] > radius - 0.6 * thick and flat > 0.6 * radius
        sides[next((name for name, is_here in where.items() if is_here), "inner")].append(tag)
    for name, surfaces in sides.items():
        gmsh.model.addPhysicalGroup(2, surfaces, name=name)
    size = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(size, "F", "0.22")
    mesh(size)
    write(ROOT / "docs/book/examples/cup.msh")


def mesh(size, curvature=0):
    gmsh.model.mesh.field.setAsBackgroundMesh(size)
    for option in ("ExtendFromBoundary", "FromPoints"):
        gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", curvature)
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
    half_ball("half-ball", 0.045, 0.15)
    half_ball("half-ball-fine", 0.0225, 0.075)
    half_space()
    punch()
    bracket()
    cup()
    gmsh.finalize()


if __name__ == "__main__":
    main()
