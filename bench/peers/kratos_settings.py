"""Settings that the jobs of Kratos share: Bossak, mortar contact by an augmented Lagrangian, and the
material."""

import json

import KratosMultiphysics as Kratos


def parameters(name, end, step, dimension, secondary, solver):
    """The settings of a dynamic run whose contact is between the parts `secondary` and Touching."""
    solver_settings = {
        "solver_type": "Dynamic", "time_integration_method": "implicit", "scheme_type": "bossak", "damp_factor_m": -0.3,
        "model_part_name": "Structure", "domain_size": dimension, "echo_level": 0, "analysis_type": "non_linear",
        "model_import_settings": {"input_type": "use_input_model_part"},
        "time_stepping": {"time_step": step},
        "contact_settings": {"mortar_type": "ALMContactFrictionless", "fancy_convergence_criterion": False},
        "clear_storage": True, "reform_dofs_at_each_step": True, "compute_reactions": False,
        "convergence_criterion": "contact_residual_criterion",
        "residual_relative_tolerance": 1e-4, "residual_absolute_tolerance": 1e-9, "max_iteration": 20,
        "linear_solver_settings": {"solver_type": solver},
    }
    contact = {
        "python_module": "alm_contact_process", "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
        "process_name": "ALMContactProcess",
        "Parameters": {
            "model_part_name": "Structure", "contact_model_part": {"0": ["Touching"]}, "assume_master_slave": {"0": [secondary]},
            "contact_type": "Frictionless",
        },
    }
    problem = {"problem_name": name, "parallel_type": "OpenMP", "start_time": 0.0, "end_time": end, "echo_level": 0}
    whole = {"problem_data": problem, "solver_settings": solver_settings, "processes": {"contact_process_list": [contact]}}
    return Kratos.Parameters(json.dumps(whole))


def rubber(part, job, law):
    """The material of both bodies."""
    material = part.CreateNewProperties(1)
    lam, mu = job.LAMBDA, job.MU
    material[Kratos.YOUNG_MODULUS] = mu * (3 * lam + 2 * mu) / (lam + mu)
    material[Kratos.POISSON_RATIO] = lam / (2 * (lam + mu))
    material[Kratos.DENSITY] = job.RHO
    material[Kratos.CONSTITUTIVE_LAW] = Kratos.KratosGlobals.GetConstitutiveLaw(law).Clone()
    return material
