#!/usr/bin/env python3
"""Generates the .msh files of the tests, of cases and of an example of the book with Gmsh.

    pip install gmsh==4.15.2
    python3 scripts/make_gmsh_fixtures.py

The gmsh wheel needs libglu1-mesa libxrender1 libxcursor1 libxft2 libxinerama1.

The geometry is the half model of the impact: a half-disc `cylinder` (radius 0.5, centre (0, 1))
above a prism (1 x 0.5) whose top is y = 0; in space an eighth of a ball. The curve `axis` belongs to both bodies. Cells of order
3 are optimised with Gmsh's high-order optimisation.
"""

import math
from pathlib import Path

import gmsh

ROOT = Path(__file__).resolve().parent.parent
TESTS = ROOT / "crates/carom-solid/tests/msh"


def start(name):
    gmsh.clear()
    gmsh.model.add(name)
    for option in ("Mesh.Binary", "Mesh.SaveAll", "Mesh.SaveParametric", "Mesh.RecombineAll"):
        gmsh.option.setNumber(option, 0)


def impact(disc_size, prism_size, square=False):
    geo = gmsh.model.geo
    start("impact")

    def point(x, y, size):
        return geo.addPoint(x, y, 0, size)

    center = point(0, 1, disc_size)
    low, right, high = point(0, 0.5, disc_size), point(0.5, 1, disc_size), point(0, 1.5, disc_size)
    arcs = [geo.addCircleArc(low, center, right), geo.addCircleArc(right, center, high)]
    axis = geo.addLine(high, low)
    disc = geo.addPlaneSurface([geo.addCurveLoop([*arcs, axis])])
    corners = [point(x, y, prism_size) for x, y in ((0, -0.5), (1, -0.5), (1, 0), (0, 0))]
    lines = [geo.addLine(corners[i], corners[(i + 1) % 4]) for i in range(4)]
    prism = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    geo.synchronize()
    group = gmsh.model.addPhysicalGroup
    group(2, [disc], name="cylinder")
    group(2, [prism], name="prism")
    group(1, arcs, name="arc")
    group(1, [axis, lines[3]], name="axis")
    for name, line in zip(("bottom", "right", "top"), lines):
        group(1, [line], name=name)
    if square:
        gmsh.model.mesh.setRecombine(2, prism)


def mesh(order, dimension=2):
    gmsh.model.mesh.generate(dimension)
    gmsh.model.mesh.setOrder(order)
    if order == 3:
        gmsh.model.mesh.optimize("HighOrder")


def eighth(order):
    """An eighth of the unit ball, its volume `eighth` and its sides `sphere`, `plane_x`, …"""
    start("eighth")
    occ = gmsh.model.occ
    occ.addSphere(0, 0, 0, 1, -1, 0, math.pi / 2, math.pi / 2)
    occ.synchronize()
    ((_, volume),) = gmsh.model.getEntities(3)
    for _, surface in gmsh.model.getBoundary([(3, volume)], oriented=False):
        center = occ.getCenterOfMass(2, surface)
        flat = gmsh.model.getType(2, surface) == "Plane"
        axis = min(range(3), key=lambda i: abs(center[i]))
        gmsh.model.addPhysicalGroup(2, [surface], name=f"plane_{'xyz'[axis]}" if flat else "sphere")
    gmsh.model.addPhysicalGroup(3, [volume], name="eighth")
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.6)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.6)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(order)
    if order > 1:
        gmsh.model.mesh.optimize("HighOrderElastic")


def sector(order):
    """A quarter of a ring of quadrangles, `sector`, with the curves `inner`, `outer`, `plane_x`, `plane_y`;
    and hexahedra above it, `wedge`, with the surfaces of these names, `sector` and `lid`."""
    start("sector")
    geo = gmsh.model.geo
    center = geo.addPoint(0, 0, 0)
    ends = [[geo.addPoint(r, 0, 0), geo.addPoint(0, r, 0)] for r in (1, 2)]
    inner, outer = (geo.addCircleArc(a, center, b) for a, b in ends)
    low, high = (geo.addLine(ends[0][k], ends[1][k]) for k in (0, 1))
    base = geo.addPlaneSurface([geo.addCurveLoop([low, outer, -high, -inner])])
    for curve in (inner, outer):
        geo.mesh.setTransfiniteCurve(curve, 5)
    for curve in (low, high):
        geo.mesh.setTransfiniteCurve(curve, 4)
    geo.mesh.setTransfiniteSurface(base)
    geo.mesh.setRecombine(2, base)
    # The lid, the volume, and the surface above each curve.
    lid, volume, *above = geo.extrude([(2, base)], 0, 0, 0.5, numElements=[2], recombine=True)
    geo.synchronize()
    names = ("plane_y", "outer", "plane_x", "inner")
    for name, curve, (_, surface) in zip(names, (low, outer, high, inner), above):
        gmsh.model.addPhysicalGroup(1, [curve], name=name)
        gmsh.model.addPhysicalGroup(2, [surface], name=name)
    gmsh.model.addPhysicalGroup(2, [base], name="sector")
    gmsh.model.addPhysicalGroup(2, [lid[1]], name="lid")
    gmsh.model.addPhysicalGroup(3, [volume[1]], name="wedge")
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(order)


def tee():
    """A quarter of a T-piece of a pipe: its volume `tee`, the cuts `plane_x` and `plane_z`, the ends
    `end` and `branch`, and the inner surface `bore`."""
    start("tee")
    occ = gmsh.model.occ

    def pipes(run, branch):
        both = [(3, occ.addCylinder(-2, 0, 0, 4, 0, 0, run)), (3, occ.addCylinder(0, 0, 0, 0, 1.2, 0, branch))]
        return occ.fuse(both[:1], both[1:])[0]

    part, _ = occ.cut(pipes(0.5, 0.35), pipes(0.3, 0.2))
    occ.intersect(part, [(3, occ.addBox(0, -1, 0, 2, 3, 1))])
    occ.synchronize()
    sides = {name: [] for name in ("plane_x", "plane_z", "end", "branch", "bore")}
    for _, surface in gmsh.model.getEntities(2):
        low, high = (gmsh.model.getBoundingBox(2, surface)[k : k + 3] for k in (0, 3))
        where = {"plane_x": high[0] < 1e-5, "plane_z": high[2] < 1e-5, "end": low[0] > 1.9, "branch": low[1] > 1.1}
        where["bore"] = high[2] < 0.301
        name = next((name for name, is_here in where.items() if is_here), None)
        if name:
            sides[name].append(surface)
    gmsh.model.addPhysicalGroup(3, [volume for _, volume in gmsh.model.getEntities(3)], name="tee")
    for name, surfaces in sides.items():
        gmsh.model.addPhysicalGroup(2, surfaces, name=name)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.22)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 12)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(2)
    gmsh.model.mesh.optimize("HighOrderElastic")


def write(path, version=4.1, binary=False):
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.write(str(path))
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size} bytes, {len(gmsh.model.mesh.getNodes()[0])} nodes")


def main():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    TESTS.mkdir(parents=True, exist_ok=True)
    for order in (1, 2, 3):
        impact(0.2, 0.25)
        mesh(order)
        for version, label in ((2.2, "22"), (4.1, "41")):
            for binary, encoding in ((False, "ascii"), (True, "binary")):
                write(TESTS / f"impact_order{order}_{label}_{encoding}.msh", version, binary)

    # All entities saved, with parameters on curves and surfaces, which Carom must ignore.
    impact(0.3, 0.4)
    mesh(2)
    gmsh.option.setNumber("Mesh.SaveAll", 1)
    gmsh.option.setNumber("Mesh.SaveParametric", 1)
    write(TESTS / "parametric_41_ascii.msh")
    write(TESTS / "parametric_41_binary.msh", binary=True)
    # In version 2.2 cells have one group only, which SaveAll would make the entity.
    gmsh.option.setNumber("Mesh.SaveAll", 0)
    write(TESTS / "parametric_22_ascii.msh", 2.2)
    write(TESTS / "parametric_22_binary.msh", 2.2, True)

    impact(0.3, 0.4, square=True)
    mesh(1)
    write(TESTS / "quadrangles.msh")

    sector(1)
    write(TESTS / "sector_order1.msh")
    sector(2)
    write(TESTS / "sector_order2.msh")
    write(TESTS / "sector_order2_22_binary.msh", 2.2, True)
    write(ROOT / "cases/space/sector.msh")

    for order, version, label in ((1, 4.1, "41_ascii"), (2, 4.1, "41_ascii"), (2, 2.2, "22_binary"), (3, 4.1, "41_binary")):
        eighth(order)
        write(TESTS / f"eighth_order{order}_{label}.msh", version, "binary" in label)
        if version == 4.1 and order > 1:
            name = {2: "quadratic", 3: "cubic"}[order]
            write(ROOT / f"cases/space/eighth-{name}.msh", version, "binary" in label)
    gmsh.option.restoreDefaults()

    start("bar")
    ends = [gmsh.model.geo.addPoint(x, 0, 0, 0.5) for x in (0, 2)]
    line = gmsh.model.geo.addLine(*ends)
    gmsh.model.geo.synchronize()
    gmsh.model.addPhysicalGroup(1, [line], name="bar")
    for end, name in zip(ends, ("left", "right")):
        gmsh.model.addPhysicalGroup(0, [end], name=name)
    mesh(3, 1)
    write(TESTS / "bar.msh")
    write(TESTS / "bar_22.msh", 2.2)

    impact(0.1, 0.125)
    mesh(3)
    write(ROOT / "cases/gmsh/impact.msh")

    tee()
    write(ROOT / "docs/book/examples/tee.msh")
    gmsh.finalize()


if __name__ == "__main__":
    main()
