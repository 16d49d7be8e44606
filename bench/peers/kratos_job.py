#!/usr/bin/env python3
"""Disc on block with Kratos.

    kratos_job.py RINGS STEPS

With 12 rings the nodes are those of cases/perf/disc-2k.toml, with 36 those of disc-19k.toml. Linear
triangles, mortar augmented Lagrangian contact, Bossak −0.3, Eigen's sparse LU.

Prints one JSON object, see job.py. Every solver option is Kratos' default or is taken from its own
tests of dynamic mortar contact.
"""

import sys

import KratosMultiphysics as Kratos
import KratosMultiphysics.ConstitutiveLawsApplication
import KratosMultiphysics.LinearSolversApplication
import KratosMultiphysics.ContactStructuralMechanicsApplication
from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import StructuralMechanicsAnalysis

import job
import kratos_settings

RINGS, STEPS = int(sys.argv[1]), int(sys.argv[2])
Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
Kratos.ParallelUtilities.SetNumThreads(1)

PARAMETERS = kratos_settings.parameters("disc", (STEPS - 0.5) * job.DT, job.DT, 2, "Arc", "LinearSolversApplication.sparse_lu")


def build(part):
    """Builds nodes, elements and contact lines; returns the nodes of the disc with their share of
    its area."""
    material = kratos_settings.rubber(part, job, "HyperElasticPlaneStrain2DLaw")
    material[Kratos.THICKNESS] = 1.0
    nodes, share = {}, {}

    def node(key, at):
        if key not in nodes:
            nodes[key] = part.CreateNewNode(len(nodes) + 1, *at, 0.0)
        return nodes[key]

    def triangle(corners):
        element = part.CreateNewElement("TotalLagrangianElement2D3N", part.NumberOfElements() + 1, [n.Id for n in corners], material)
        return element.GetGeometry().Area()

    across, down = 4 * RINGS, RINGS
    for cell in job.disc(RINGS):
        keys = [("disc", k, s % (6 * k) if k else 0) for k, s in cell]
        corners = [node(key, job.point(RINGS, *key[1:])) for key in keys]
        area = triangle(corners)
        for n in corners:
            share[n] = share.get(n, 0.0) + area / 3
    for cell in job.block(across, down):
        triangle([node(("block", *c), job.place(across, down, *c)) for c in cell])
    arc = [nodes["disc", RINGS, s] for s in range(6 * RINGS)]
    top = [nodes["block", i, down] for i in range(across, -1, -1)]
    for name, line, closed in (("Arc", arc, True), ("Top", top, False)):
        lines = [(a.Id, b.Id) for a, b in zip(line, line[1:] + line[:1] if closed else line[1:])]
        first = part.NumberOfConditions() + 1
        for number, ends in enumerate(lines, first):
            part.CreateNewCondition("LineCondition2D2N", number, list(ends), material)
        sides = part.CreateSubModelPart(name)
        sides.AddNodes([n.Id for n in line])
        sides.AddConditions(list(range(first, first + len(lines))))
    touching = part.CreateSubModelPart("Touching")
    touching.AddNodes([n.Id for n in arc + top])
    touching.AddConditions(list(range(1, part.NumberOfConditions() + 1)))
    for i in range(across + 1):
        for variable in (Kratos.DISPLACEMENT_X, Kratos.DISPLACEMENT_Y):
            nodes["block", i, 0].Fix(variable)
    for n in share:
        for ago in (0, 1):
            n.SetSolutionStepValue(Kratos.VELOCITY_Y, ago, -job.SPEED)
    return share


analysis = StructuralMechanicsAnalysis(Kratos.Model(), PARAMETERS)
part = analysis.model["Structure"]
share = build(part)
analysis.Initialize()
area = sum(share.values())


def falling():
    return sum(s * n.GetSolutionStepValue(Kratos.VELOCITY_Y) for n, s in share.items()) / area


begin = job.usage()
velocity, iterations = [falling()], 0
while analysis.KeepAdvancingSolutionLoop():
    analysis.time = analysis._AdvanceTime()
    analysis.InitializeSolutionStep()
    if not analysis._GetSolver().SolveSolutionStep():
        print(f"step {len(velocity)} did not converge", file=sys.stderr)
    iterations += part.ProcessInfo[Kratos.NL_ITERATION_NUMBER]
    analysis.FinalizeSolutionStep()
    velocity.append(falling())
job.print_result("Kratos", 2 * part.NumberOfNodes(), begin, iterations, job.RHO * area, velocity)
