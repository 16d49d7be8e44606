#!/usr/bin/env python3
"""Ball on block with GetFEM.

    ball_getfem.py MESH STEPS FIRST LAST

MESH contains quadratic tetrahedra. Ray-traced augmented Lagrangian contact in large sliding, damped
Newmark, MUMPS; planes of symmetry by penalty.

Prints one JSON object, see ball_job.py.
"""

import sys

import getfem as gf
import numpy as np

import ball_job as job

STEPS, FIRST, LAST = map(int, sys.argv[2:])
BETA, GAMMA = 0.422, 0.799
# Gmsh's nodes of a cell in the order of GetFEM: layers of z, in each rows of y.
ORDER = [0, 4, 1, 6, 5, 2, 7, 9, 8, 3]
CONTACT, BOTTOM, SYMMETRY_X, SYMMETRY_Y = 1, 2, 3, 4
SIDES = {
    "ball": {CONTACT: "sphere", SYMMETRY_X: "plane_x", SYMMETRY_Y: "plane_y"},
    "block": {CONTACT: "top", BOTTOM: "bottom", SYMMETRY_X: "left", SYMMETRY_Y: "front"},
}
SYMMETRY_STIFFNESS = 1e6
gf.util_trace_level(0)
whole = job.Mesh(sys.argv[1])
points = np.array(whole.points)


def mesh(body):
    m = gf.Mesh("empty", 3)
    m.add_convex(gf.GeoTrans("GT_PK(3,2)"), points[np.array(whole.bodies[body])[:, ORDER]].transpose(2, 1, 0))
    outer = {tuple(face) for face in m.outer_faces().T}
    for region, side in SIDES[body].items():
        found = m.faces_from_pid(m.pid_from_coords(points[whole.nodes(side)].T))
        faces = [face for face in found.T if tuple(face) in outer]
        assert len(faces) == len(whole.sides[side]), side
        m.set_region(region, np.array(faces).T)
    return m


ball, block = mesh("ball"), mesh("block")
md = gf.Model("real")
md.add_initialized_data("rho", job.RHO)
spaces, integrals = {}, {}
for name, m in (("u1", ball), ("u2", block)):
    space = gf.MeshFem(m, 3)
    space.set_fem(gf.Fem("FEM_PK(3,2)"))
    integral = gf.MeshIm(m, gf.Integ("IM_TETRAHEDRON(5)"))
    spaces[name], integrals[name] = space, integral
    md.add_fem_variable(name, space)
    j = f"Det(Id(3)+Grad_{name})"
    energy = f"{job.MU}*((Norm_sqr(Id(3)+Grad_{name})-3)*0.5-log({j}))+{job.LAMBDA}*0.5*sqr(log({j}))"
    md.add_nonlinear_term(integral, energy)
    for region, axis in ((SYMMETRY_X, 1), (SYMMETRY_Y, 2)):
        md.add_linear_term(integral, f"{SYMMETRY_STIFFNESS}*{name}({axis})*Test_{name}({axis})", region)
md.add_Dirichlet_condition_with_simplification("u2", BOTTOM)

multiplier = gf.MeshFem(ball, 3)
multiplier.set_fem(gf.Fem("FEM_PK(3,1)"))
md.add_filtered_fem_variable("lambda1", multiplier, CONTACT)
# Twice Young's modulus over the size of the facets: of the values tried, that with the fewest
# iterations.
young = job.MU * (3 * job.LAMBDA + 2 * job.MU) / (job.LAMBDA + job.MU)
facet = job.RADIUS * np.sqrt(np.pi / len(whole.sides["sphere"]))
md.add_initialized_data("r", [2.0 * young / facet])
md.add_initialized_data("f", [0.0])
md.add_initialized_data("alpha", [1.0])
md.add_fem_data("w1", spaces["u1"])
md.add_fem_data("w2", spaces["u2"])
contact = md.add_integral_large_sliding_contact_brick_raytracing("r", 0.1, "f", "alpha", 0)
md.add_slave_contact_boundary_to_large_sliding_contact_brick(contact, integrals["u1"], CONTACT, "u1", "lambda1", "w1")
md.add_master_contact_boundary_to_large_sliding_contact_brick(contact, integrals["u2"], CONTACT, "u2", "w2")

for name in spaces:
    md.add_Newmark_scheme(name, BETA, GAMMA)
    md.add_mass_brick(integrals[name], f"Dot2_{name}", "rho")
md.set_time_step(job.DT)
falling = np.tile([0.0, 0.0, -job.SPEED], spaces["u1"].nbdof() // 3)
md.set_variable("Previous_Dot_u1", falling)
md.perform_init_time_derivative(job.DT / 20.0)
md.solve("max_res", 1e-9, "max_iter", 30, "lsolver", "mumps")

scalar = gf.MeshFem(ball, 1)
scalar.set_fem(gf.Fem("FEM_PK(3,2)"))
up = np.zeros((3, scalar.nbdof()))
up[2] = 1.0
load = gf.asm_volumic_source(integrals["u1"], spaces["u1"], scalar, up)

clock = job.Clock(FIRST, LAST, -job.SPEED)
for step in range(STEPS):
    iterations, converged = md.solve("max_res", 1e-8, "max_iter", 20, "lsearch", "simplest", "alpha min", 0.2, "lsolver", "mumps")
    md.shift_variables_for_time_integration()
    clock.step(iterations, converged, float(load @ md.variable("Previous_Dot_u1")) / load.sum())
clock.print_result("GetFEM", whole.dofs, job.RHO * load.sum())
