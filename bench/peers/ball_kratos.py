#!/usr/bin/env python3
"""Ball on block with Kratos.

    ball_kratos.py MESH STEPS FIRST LAST

MESH contains linear tetrahedra. Mortar augmented Lagrangian contact, Bossak −0.3, AMGCL.

Prints one JSON object, see ball_job.py. Every solver option is Kratos' default or is taken from its
own tests of dynamic mortar contact.
"""

import sys

import KratosMultiphysics as Kratos
import KratosMultiphysics.ConstitutiveLawsApplication
import KratosMultiphysics.LinearSolversApplication
import KratosMultiphysics.ContactStructuralMechanicsApplication
from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import StructuralMechanicsAnalysis

import ball_job as job
import kratos_settings

STEPS, FIRST, LAST = map(int, sys.argv[2:])
Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
Kratos.ParallelUtilities.SetNumThreads(1)
whole = job.Mesh(sys.argv[1])

PARAMETERS = kratos_settings.parameters("ball", (STEPS - 0.5) * job.DT, job.DT, 3, "Sphere", "amgcl")
SIDES = {"Sphere": "sphere", "Top": "top"}
FIXED = {("left", "plane_x"): "X", ("front", "plane_y"): "Y", ("bottom",): "XYZ"}


def build(part):
    """Builds nodes, elements and contact facets; returns the nodes of the ball with their share of
    its volume."""
    material = kratos_settings.rubber(part, job, "HyperElastic3DLaw")
    nodes = [part.CreateNewNode(number, *point) for number, point in enumerate(whole.points, 1)]
    share = {}
    for body, cells in whole.bodies.items():
        for cell in cells:
            ids = [nodes[k].Id for k in cell]
            element = part.CreateNewElement("TotalLagrangianElement3D4N", part.NumberOfElements() + 1, ids, material)
            if body == "ball":
                for k in cell:
                    share[nodes[k]] = share.get(nodes[k], 0.0) + element.GetGeometry().Volume() / 4
    touching = part.CreateSubModelPart("Touching")
    for name, side in SIDES.items():
        first = part.NumberOfConditions() + 1
        for number, facet in enumerate(whole.sides[side], first):
            part.CreateNewCondition("SurfaceCondition3D3N", number, [nodes[k].Id for k in facet], material)
        for place in (part.CreateSubModelPart(name), touching):
            place.AddNodes([nodes[k].Id for k in whole.nodes(side)])
            place.AddConditions(list(range(first, part.NumberOfConditions() + 1)))
    for sides, axes in FIXED.items():
        for k in whole.nodes(*sides):
            for axis in axes:
                nodes[k].Fix(Kratos.KratosGlobals.GetVariable(f"DISPLACEMENT_{axis}"))
    for node in share:
        for ago in (0, 1):
            node.SetSolutionStepValue(Kratos.VELOCITY_Z, ago, -job.SPEED)
    return share


analysis = StructuralMechanicsAnalysis(Kratos.Model(), PARAMETERS)
part = analysis.model["Structure"]
share = build(part)
analysis.Initialize()
volume = sum(share.values())


def falling():
    return sum(s * n.GetSolutionStepValue(Kratos.VELOCITY_Z) for n, s in share.items()) / volume


clock = job.Clock(FIRST, LAST, falling())
while analysis.KeepAdvancingSolutionLoop():
    analysis.time = analysis._AdvanceTime()
    analysis.InitializeSolutionStep()
    converged = analysis._GetSolver().SolveSolutionStep()
    iterations = part.ProcessInfo[Kratos.NL_ITERATION_NUMBER]
    analysis.FinalizeSolutionStep()
    clock.step(iterations, converged, falling())
clock.print_result("Kratos", whole.dofs, job.RHO * volume)
