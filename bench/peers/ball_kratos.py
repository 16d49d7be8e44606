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

STEPS, FIRST, LAST = map(int, sys.argv[2:])
Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
Kratos.ParallelUtilities.SetNumThreads(1)
whole = job.Mesh(sys.argv[1])

PARAMETERS = f"""{{
    "problem_data": {{ "problem_name": "ball", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": {(STEPS - 0.5) * job.DT}, "echo_level": 0 }},
    "solver_settings": {{
        "solver_type": "Dynamic", "time_integration_method": "implicit", "scheme_type": "bossak", "damp_factor_m": -0.3,
        "model_part_name": "Structure", "domain_size": 3, "echo_level": 0, "analysis_type": "non_linear",
        "model_import_settings": {{ "input_type": "use_input_model_part" }},
        "time_stepping": {{ "time_step": {job.DT} }},
        "contact_settings": {{ "mortar_type": "ALMContactFrictionless", "fancy_convergence_criterion": false }},
        "clear_storage": true, "reform_dofs_at_each_step": true, "compute_reactions": false,
        "convergence_criterion": "contact_residual_criterion",
        "residual_relative_tolerance": 1e-4, "residual_absolute_tolerance": 1e-9, "max_iteration": 20,
        "linear_solver_settings": {{ "solver_type": "amgcl" }}
    }},
    "processes": {{
        "contact_process_list": [{{
            "python_module": "alm_contact_process", "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
            "process_name": "ALMContactProcess",
            "Parameters": {{
                "model_part_name": "Structure", "contact_model_part": {{ "0": ["Touching"] }}, "assume_master_slave": {{ "0": ["Sphere"] }},
                "contact_type": "Frictionless"
            }}
        }}]
    }}
}}"""
SIDES = {"Sphere": "sphere", "Top": "top"}
FIXED = {("left", "plane_x"): "X", ("front", "plane_y"): "Y", ("bottom",): "XYZ"}


def build(part):
    """Builds nodes, elements and contact facets; returns the nodes of the ball with their share of
    its volume."""
    material = part.CreateNewProperties(1)
    lam, mu = job.LAMBDA, job.MU
    material[Kratos.YOUNG_MODULUS] = mu * (3 * lam + 2 * mu) / (lam + mu)
    material[Kratos.POISSON_RATIO] = lam / (2 * (lam + mu))
    material[Kratos.DENSITY] = job.RHO
    material[Kratos.CONSTITUTIVE_LAW] = Kratos.KratosGlobals.GetConstitutiveLaw("HyperElastic3DLaw").Clone()
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


analysis = StructuralMechanicsAnalysis(Kratos.Model(), Kratos.Parameters(PARAMETERS))
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
