#!/usr/bin/env python3
"""Writes the meshes of the ball on the block with Gmsh (PyPI).

    ball_mesh.py SIZE FOLDER

A quarter of a ball of radius 0.5, 0.01 above the block [0, 1]² × [−0.5, 0]. FOLDER receives
SIZE-Tet10.msh, curved to the sphere, and SIZE-Tet4.msh, in which every cell is cut into eight, so
that both have the same nodes. The names of the sides are those of cases/space/ball.toml.
"""

import pathlib
import sys

import gmsh

import ball_job as job

# Length of an edge near the contact: about 1 000, 3 000, 12 000 and 40 000 nodes.
EDGE = {"XS": 0.2, "S": 0.1065, "M": 0.0617, "L": 0.0393}
# Beyond NEAR from the place of contact the cells of the block grow, up to COARSE times at FAR.
NEAR, FAR, COARSE = 0.5, 1.2, 2.2


def side(dimension, surface, body):
    """Name of a surface by the planes it lies in."""
    box = gmsh.model.getBoundingBox(dimension, surface)
    flat = [abs(box[k + 3] - box[k]) < 1e-5 for k in range(3)]
    if body == "ball":
        return "plane_x" if flat[0] else "plane_y" if flat[1] else "sphere"
    names = (("left", "right"), ("front", "back"), ("bottom", "top"))
    axis = flat.index(True)
    return names[axis][abs(box[axis] - (0.0, 0.0, -0.5)[axis]) > 1e-5]


def geometry():
    occ = gmsh.model.occ
    center = job.GAP + job.RADIUS
    sphere = occ.addSphere(0, 0, center, job.RADIUS)
    quadrant = occ.addBox(0, 0, center - 1, 1, 1, 2)
    ((_, ball),), _ = occ.intersect([(3, sphere)], [(3, quadrant)])
    block = occ.addBox(0, 0, -0.5, 1, 1, 0.5)
    occ.synchronize()
    for volume, body in ((ball, "ball"), (block, "block")):
        gmsh.model.addPhysicalGroup(3, [volume], name=body)
        for dimension, surface in gmsh.model.getBoundary([(3, volume)], oriented=False):
            gmsh.model.addPhysicalGroup(2, [surface], name=side(dimension, surface, body))
    return ball, block


def sizes(edge, ball, block):
    field = gmsh.model.mesh.field
    parts = []
    growing = f"{edge}*(1+{COARSE - 1}*min(1,max(0,(sqrt(x*x+y*y+z*z)-{NEAR})/{FAR - NEAR})))"
    for volume, formula in ((ball, str(edge)), (block, growing)):
        everywhere, inside = field.add("MathEval"), field.add("Restrict")
        field.setString(everywhere, "F", formula)
        field.setNumber(inside, "InField", everywhere)
        field.setNumbers(inside, "VolumesList", [volume])
        parts.append(inside)
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", parts)
    field.setAsBackgroundMesh(least)


def main():
    size, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    gmsh.initialize(["-nopopup"])
    for option, value in {
        "General.Terminal": 0, "General.NumThreads": 1, "Mesh.Algorithm": 6, "Mesh.Algorithm3D": 1, "Mesh.MeshSizeFromPoints": 0,
        "Mesh.MeshSizeExtendFromBoundary": 0, "Mesh.MshFileVersion": 2.2, "Mesh.Binary": 0,
    }.items():
        gmsh.option.setNumber(option, value)
    sizes(EDGE[size], *geometry())
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(2)
    gmsh.write(str(folder / f"{size}-Tet10.msh"))
    gmsh.model.mesh.setOrder(1)
    gmsh.model.mesh.refine()
    gmsh.write(str(folder / f"{size}-Tet4.msh"))
    gmsh.finalize()


main()
