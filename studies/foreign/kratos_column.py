#!/usr/bin/env python3
"""The column with Kratos' GeoMechanicsApplication: eight-node elements, pressure on their corners, backward Euler.

    kratos_column.py CASE.json OUT

Leaves OUT/vtu_output with a series of VTU. `pip install KratosMultiphysics KratosGeoMechanicsApplication` brings it;
without it the case is skipped.
"""

import json
import pathlib
import sys
import time

try:
    import KratosMultiphysics as Kratos
    import KratosMultiphysics.GeoMechanicsApplication
    from KratosMultiphysics.GeoMechanicsApplication import geomechanics_analysis
except ImportError as error:
    print(f"Kratos is not installed here: {error}", file=sys.stderr)
    sys.exit(77)

VISCOSITY = 1e-3  # Pa s; the conductivity of the case decides, this only turns it into a permeability
MODEL = "PorousDomain"
PART = f"{MODEL}.porous_computational_model_part"
GEO = "KratosMultiphysics.GeoMechanicsApplication"


def mesh(height, cells):
    """Text of the mesh: nodes from 1, elements, the loaded line and the parts of the model."""
    width = height / cells
    ends = [height * row / cells for row in range(cells + 1)]
    numbers, points = {}, []

    def node(x, y):
        if (x, y) not in numbers:
            points.append((x, y))
            numbers[x, y] = len(points)
        return numbers[x, y]

    elements = []
    for low, high in zip(ends, ends[1:]):
        middle = 0.5 * (low + high)
        corners = [node(0.0, low), node(width, low), node(width, high), node(0.0, high)]
        between = [node(width / 2, low), node(width, middle), node(width / 2, high), node(0.0, middle)]
        elements.append(corners + between)
    top = [node(width, height), node(0.0, height), node(width / 2, height)]
    bottom = [node(0.0, 0.0), node(width, 0.0), node(width / 2, 0.0)]
    sides = [number for (x, _), number in numbers.items() if x in (0.0, width)]
    lines = ["Begin Properties 1", "End Properties", "Begin Nodes"]
    lines += [f" {number} {x!r} {y!r} 0.0" for number, (x, y) in enumerate(points, 1)]
    lines += ["End Nodes", "Begin Elements SmallStrainUPwDiffOrderElement2D8N"]
    lines += [f" {number} 1 " + " ".join(map(str, element)) for number, element in enumerate(elements, 1)]
    lines += ["End Elements", "Begin Conditions LineLoadDiffOrderCondition2D3N"]
    lines += [f" 1 1 {top[0]} {top[1]} {top[2]}", "End Conditions"]
    parts = [
        ("Soil", range(1, len(points) + 1), range(1, cells + 1), []),
        ("Bottom", bottom, [], []),
        ("Side", sides, [], []),
        ("Top", top, [], []),
        ("Load", top, [], [1]),
    ]
    for name, *members in parts:
        lines.append(f"Begin SubModelPart {name}")
        for kind, of_kind in zip(["Nodes", "Elements", "Conditions"], members):
            lines += [f" Begin SubModelPart{kind}", *[f"  {one}" for one in of_kind], f" End SubModelPart{kind}"]
        lines.append("End SubModelPart")
    return "\n".join(lines) + "\n"


def material(case):
    """The soil as Kratos names it."""
    soil = case["material"]
    permeability = soil["hydraulic_conductivity"] / case["derived"]["unit_weight_of_water"] * VISCOSITY
    variables = {
        "GEO_DRAINAGE_TYPE": "FULLY_COUPLED",
        "YOUNG_MODULUS": soil["youngs_modulus"],
        "POISSON_RATIO": soil["poissons_ratio"],
        "DENSITY_SOLID": soil["grain_density"],
        "DENSITY_WATER": soil["water_density"],
        "POROSITY": soil["porosity"],
        "BULK_MODULUS_SOLID": 1e20,
        "BULK_MODULUS_FLUID": soil["water_bulk_modulus"],
        "PERMEABILITY_XX": permeability,
        "PERMEABILITY_YY": permeability,
        "PERMEABILITY_XY": 0.0,
        "DYNAMIC_VISCOSITY": VISCOSITY,
        "BIOT_COEFFICIENT": 1.0,
    }
    law = {"constitutive_law": {"name": "GeoLinearElasticPlaneStrain2DLaw"}, "Variables": variables}
    return {"properties": [{"model_part_name": f"{MODEL}.Soil", "properties_id": 1, "Material": law}]}


def vector(part, variable, active, value):
    """A process that holds or loads a part."""
    is_held = variable == "DISPLACEMENT"
    return {
        "python_module": "apply_vector_constraint_table_process",
        "kratos_module": GEO,
        "process_name": "ApplyVectorConstraintTableProcess",
        "Parameters": {
            "model_part_name": f"{MODEL}.{part}",
            "variable_name": variable,
            "active": active,
            "is_fixed": active if is_held else [False] * 3,
            "value": value,
            "table": [0, 0, 0],
        },
    }


def settings(case, folder):
    """The parameters of the analysis."""
    steps = round(case["times"][-1] / case["time_step"])
    step = case["times"][-1] / steps
    drained = {"model_part_name": f"{MODEL}.Top", "variable_name": "WATER_PRESSURE", "is_fixed": True}
    output = {
        "python_module": "vtu_output_process",
        "kratos_module": "KratosMultiphysics",
        "process_name": "VtuOutputProcess",
        "Parameters": {
            "model_part_name": PART,
            "output_control_type": "step",
            "output_interval": max(1, round(case["times"][0] / step)),
            "file_format": "binary",
            "output_precision": 16,
            "output_path": str(folder / "vtu_output"),
            "nodal_solution_step_data_variables": ["DISPLACEMENT", "WATER_PRESSURE"],
        },
    }
    return {
        "problem_data": {
            "problem_name": "column",
            "start_time": 0.0,
            "end_time": step * steps,
            "echo_level": 0,
            "parallel_type": "OpenMP",
            "number_of_threads": 1,
        },
        "solver_settings": {
            "solver_type": "U_Pw",
            "model_part_name": MODEL,
            "domain_size": 2,
            "model_import_settings": {"input_type": "mdpa", "input_filename": str(folder / "column")},
            "material_import_settings": {"materials_filename": str(folder / "material.json")},
            "time_stepping": {"time_step": step},
            "buffer_size": 2,
            "echo_level": 0,
            "reset_displacements": False,
            "clear_storage": False,
            "compute_reactions": False,
            "move_mesh_flag": False,
            "reform_dofs_at_each_step": False,
            "block_builder": True,
            "solution_type": "Quasi-Static",
            "scheme_type": "Backward_Euler",
            "strategy_type": "newton_raphson",
            "convergence_criterion": "displacement_criterion",
            "displacement_relative_tolerance": 1e-9,
            "displacement_absolute_tolerance": 1e-15,
            "min_iterations": 1,
            "max_iterations": 8,
            "number_cycles": 1,
            "reduction_factor": 0.5,
            "increase_factor": 2.0,
            "desired_iterations": 4,
            "calculate_reactions": False,
            "rotation_dofs": False,
            "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
            "problem_domain_sub_model_part_list": ["Soil"],
            "processes_sub_model_part_list": ["Bottom", "Side", "Top", "Load"],
            "body_domain_sub_model_part_list": ["Soil"],
        },
        "output_processes": {"vtu_output": [output]},
        "processes": {
            "constraints_process_list": [
                vector("Bottom", "DISPLACEMENT", [True, True, True], [0, 0, 0]),
                vector("Side", "DISPLACEMENT", [True, False, False], [0, 0, 0]),
                {
                    "python_module": "apply_scalar_constraint_table_process",
                    "kratos_module": GEO,
                    "process_name": "ApplyScalarConstraintTableProcess",
                    "Parameters": {**drained, "value": 0.0, "table": 0},
                },
            ],
            "loads_process_list": [
                vector("Load", "LINE_LOAD", [False, True, False], [0, -case["column"]["load"], 0])
            ],
        },
    }


if __name__ == "__main__":
    case, folder = json.loads(pathlib.Path(sys.argv[1]).read_text()), pathlib.Path(sys.argv[2])
    (folder / "column.mdpa").write_text(mesh(case["column"]["height"], case["cells"]))
    (folder / "material.json").write_text(json.dumps(material(case)))
    Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
    analysis = geomechanics_analysis.GeoMechanicsAnalysis(
        Kratos.Model(), Kratos.Parameters(json.dumps(settings(case, folder)))
    )
    analysis.Initialize()
    start = time.perf_counter()
    analysis.RunSolutionLoop()
    print(f"solved in {time.perf_counter() - start:.6f} s")
    analysis.Finalize()
