#!/usr/bin/env python3
"""Disc on block with GetFEM.

    getfem_job.py RINGS STEPS

With 6 rings the nodes are those of cases/perf/disc-2k.toml, with 18 those of disc-19k.toml.
Quadratic triangles, ray-traced augmented Lagrangian contact, damped Newmark.

Prints one JSON object, see job.py.
"""

import sys

import getfem as gf
import numpy as np

import job

RINGS, STEPS = int(sys.argv[1]), int(sys.argv[2])
BETA, GAMMA = 0.422, 0.799
gf.util_trace_level(0)


def disc(rings):
    """Quadratic triangles: corners and midside nodes; nodes of the arc lie on the circle."""
    for cell in job.disc(rings):
        corners = [np.array(job.point(rings, *c)) for c in cell]

        def middle(a, b):
            if cell[a][0] == cell[b][0] == rings:
                return job.point(rings, rings, (cell[a][1] + cell[b][1]) / 2)
            return (corners[a] + corners[b]) / 2

        a, b, c = corners
        yield np.array([a, middle(0, 1), b, middle(0, 2), middle(1, 2), c]).T


def block(across, down):
    for cell in job.block(across, down):
        a, b, c = (np.array(job.place(across, down, *corner)) for corner in cell)
        yield np.array([a, (a + b) / 2, b, (a + c) / 2, (b + c) / 2, c]).T


def mesh(cells, side):
    m = gf.Mesh("empty", 2)
    kind = gf.GeoTrans("GT_PK(2,2)")
    for points in cells:
        m.add_convex(kind, points)
    faces = m.outer_faces()
    chosen = []
    for cell, face in faces.T:
        ids = m.pid_from_cvid(int(cell))[0]
        normal = m.normal_of_face(int(cell), int(face))
        middle = np.mean(m.pts(ids), axis=1)
        if side(middle, normal):
            chosen.append((cell, face))
    m.set_region(1, np.array(chosen).T)
    return m


upper = mesh(disc(RINGS), lambda middle, normal: True)
lower = mesh(block(4 * RINGS, RINGS), lambda middle, normal: normal[1] > 0.9)
base = [(c, f) for c, f in lower.outer_faces().T if lower.normal_of_face(int(c), int(f))[1] < -0.9]
lower.set_region(2, np.array(base).T)

md = gf.Model("real")
md.add_initialized_data("rho", job.RHO)
spaces, integrals = {}, {}
for name, m in (("u1", upper), ("u2", lower)):
    space = gf.MeshFem(m, 2)
    space.set_fem(gf.Fem("FEM_PK(2,2)"))
    integral = gf.MeshIm(m, gf.Integ("IM_TRIANGLE(4)"))
    spaces[name], integrals[name] = space, integral
    md.add_fem_variable(name, space)
    j = f"Det(Id(2)+Grad_{name})"
    energy = f"{job.MU}*((Norm_sqr(Id(2)+Grad_{name})-2)*0.5-log({j}))+{job.LAMBDA}*0.5*sqr(log({j}))"
    md.add_nonlinear_term(integral, energy)
md.add_Dirichlet_condition_with_multipliers(integrals["u2"], "u2", 1, 2)

multiplier = gf.MeshFem(upper, 2)
multiplier.set_fem(gf.Fem("FEM_PK(2,1)"))
md.add_filtered_fem_variable("lambda1", multiplier, 1)
md.add_initialized_data("r", [20.0 * RINGS])
md.add_initialized_data("f", [0.0])
md.add_initialized_data("alpha", [1.0])
md.add_fem_data("w1", spaces["u1"])
md.add_fem_data("w2", spaces["u2"])
contact = md.add_integral_large_sliding_contact_brick_raytracing("r", 0.2, "f", "alpha", 0)
md.add_slave_contact_boundary_to_large_sliding_contact_brick(contact, integrals["u1"], 1, "u1", "lambda1", "w1")
md.add_master_contact_boundary_to_large_sliding_contact_brick(contact, integrals["u2"], 1, "u2", "w2")

for name in spaces:
    md.add_Newmark_scheme(name, BETA, GAMMA)
    md.add_mass_brick(integrals[name], f"Dot2_{name}", "rho")
md.set_time_step(job.DT)
falling = np.tile([0.0, -job.SPEED], spaces["u1"].nbdof() // 2)
md.set_variable("Previous_Dot_u1", falling)
md.perform_init_time_derivative(job.DT / 20.0)
md.solve("max_res", 1e-9, "max_iter", 30)

scalar = gf.MeshFem(upper, 1)
scalar.set_fem(gf.Fem("FEM_PK(2,1)"))
up = np.array([np.zeros(scalar.nbdof()), np.ones(scalar.nbdof())])
load = gf.asm_volumic_source(integrals["u1"], spaces["u1"], scalar, up)


begin = job.usage()
velocity, iterations = [-job.SPEED], 0
for step in range(STEPS):
    iterations += md.solve("max_res", 1e-8, "max_iter", 40, "lsearch", "simplest", "alpha min", 0.2)[0]
    md.shift_variables_for_time_integration()
    velocity.append(float(load @ md.variable("Previous_Dot_u1")) / load.sum())
job.print_result("GetFEM", int(spaces["u1"].nbdof() + spaces["u2"].nbdof()), begin, iterations, job.RHO * load.sum(), velocity)
