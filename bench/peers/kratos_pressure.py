#!/usr/bin/env python3
"""Static frictionless contact with Kratos.

    kratos_pressure.py MDPA STEPS

MDPA is a model of pressure_decks.py: quadrilaterals of small displacements, nodal loads that grow in
STEPS equal steps, and the parts FixX, FixY, Load, Secondary and Touching. Mortar augmented
Lagrangian contact with its default parameters but the search and the tolerances, Eigen's sparse LU.

Prints one JSON object: the pressure per deformed area at every node of the secondary side, by the
number of the node.
"""

import json
import sys

import KratosMultiphysics as Kratos
import KratosMultiphysics.ConstitutiveLawsApplication
import KratosMultiphysics.LinearSolversApplication
import KratosMultiphysics.ContactStructuralMechanicsApplication as Contact
import KratosMultiphysics.StructuralMechanicsApplication as Structural
from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import StructuralMechanicsAnalysis

import kratos_settings

MDPA, STEPS = sys.argv[1].removesuffix(".mdpa"), int(sys.argv[2])
Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
Kratos.ParallelUtilities.SetNumThreads(1)

settings = kratos_settings.parameters("pressure", 1.0 - 0.5 / STEPS, 1.0 / STEPS, 2, "Secondary", "LinearSolversApplication.sparse_lu")
solver = settings["solver_settings"]
for name in ("time_integration_method", "scheme_type", "damp_factor_m"):
    solver.RemoveValue(name)
solver["solver_type"].SetString("Static")
solver["model_import_settings"] = Kratos.Parameters(json.dumps({"input_type": "mdpa", "input_filename": MDPA}))
solver["max_iteration"].SetInt(50)
for scope, prefix in ((solver, ""), (solver["contact_settings"], "contact_")):
    for name, value in (("relative", 1e-9), ("absolute", 1e-30)):
        scope.AddDouble(f"{prefix}residual_{name}_tolerance", value)

# The default search, in_radius_with_obb, misses parts of the interface between rings: the pressure
# beside them is then up to twice too high.
contact = settings["processes"]["contact_process_list"][0]["Parameters"]
contact.AddValue("search_parameters", Kratos.Parameters(json.dumps({"type_search": "in_radius"})))

analysis = StructuralMechanicsAnalysis(Kratos.Model(), settings)
part = analysis.model["Structure"]
analysis.Initialize()
for name, variable in (("FixX", Kratos.DISPLACEMENT_X), ("FixY", Kratos.DISPLACEMENT_Y)):
    for node in part.GetSubModelPart(name).Nodes:
        node.Fix(variable)
loads = [(node, node.GetSolutionStepValue(Structural.POINT_LOAD)) for node in part.GetSubModelPart("Load").Nodes]
for step in range(1, STEPS + 1):
    analysis.time = analysis._AdvanceTime()
    for node, load in loads:
        node.SetSolutionStepValue(Structural.POINT_LOAD, load * (step / STEPS))
    analysis.InitializeSolutionStep()
    if not analysis._GetSolver().SolveSolutionStep():
        sys.exit(f"step {step} did not converge")
    analysis.FinalizeSolutionStep()
# The conditions work with scale · multiplier + penalty · weighted gap, negative in contact; the
# weighted gap is zero once they have converged.
scale = part.ProcessInfo[Kratos.SCALE_FACTOR]
multiplier = Contact.LAGRANGE_MULTIPLIER_CONTACT_PRESSURE
print(json.dumps({node.Id: -scale * node.GetSolutionStepValue(multiplier) for node in part.GetSubModelPart("Secondary").Nodes}))
