#!/usr/bin/env python3
"""A column with Kratos' PoromechanicsApplication: four-node elements with finite increment calculus, backward Euler.

    poromechanics.py CASE.json OUT

Leaves OUT/vtu_output with a series of VTU.
"""

import json
import pathlib
import sys
import time

try:
    import KratosMultiphysics as Kratos
    from KratosMultiphysics.PoromechanicsApplication.poromechanics_analysis import PoromechanicsAnalysis
except ImportError as error:
    print(f"Kratos is not installed here: {error}", file=sys.stderr)
    sys.exit(77)

VISCOSITY = 1e-3  # Pa s; only turns the conductivity into a permeability
PORO = "KratosMultiphysics.PoromechanicsApplication"


def mesh():
    """Text of the mesh: two columns of nodes, numbered from 1 in rows of two."""
    block = lambda name, lines: "\n".join([f"Begin {name}", *lines, f"End {name.split()[0]}", ""])
    numbers = range(1, 2 * cells + 3)
    base, top = [1, 2], [2 * cells + 1, 2 * cells + 2]
    place = lambda number: f"{(number - 1) % 2 * size!r} {(number - 1) // 2 * size!r} 0.0"
    corners = lambda cell: f"{2 * cell + 1} {2 * cell + 2} {2 * cell + 4} {2 * cell + 3}"
    text = block("Properties 1", [])
    text += block("Nodes", (f"{number} {place(number)}" for number in numbers))
    text += block("Elements UPlSmallStrainFICElement2D4N", (f"{cell + 1} 1 {corners(cell)}" for cell in range(cells)))
    text += block("Conditions UPlFaceLoadCondition2D2N", [f"1 1 {top[0]} {top[1]}"])
    for name, nodes, elements, conditions in [
        ("Soil", numbers, range(1, cells + 1), []),
        ("Base", base, [], []),
        ("Top", top, [], [1]),
    ]:
        parts = {"Nodes": nodes, "Elements": elements, "Conditions": conditions}
        text += block(f"SubModelPart {name}", (block(f"SubModelPart{kind}", map(str, of)) for kind, of in parts.items()))
    return text


def material():
    """The soil as Kratos names it."""
    permeability = soil["hydraulic_conductivity"] / case["derived"]["unit_weight_of_water"] * VISCOSITY
    variables = {
        "YOUNG_MODULUS": soil["youngs_modulus"],
        "POISSON_RATIO": soil["poissons_ratio"],
        "DENSITY_SOLID": soil["grain_density"],
        "DENSITY_LIQUID": soil["water_density"],
        "POROSITY": soil["porosity"],
        "BULK_MODULUS_SOLID": 1e20,
        "BULK_MODULUS_LIQUID": soil["water_bulk_modulus"],
        **{f"PERMEABILITY_{axes}": permeability for axes in ("XX", "YY", "ZZ")},
        **{f"PERMEABILITY_{axes}": 0.0 for axes in ("XY", "YZ", "ZX")},
        "DYNAMIC_VISCOSITY_LIQUID": VISCOSITY,
        "THICKNESS": 1.0,
        "BIOT_COEFFICIENT": 1.0,
    }
    law = {"constitutive_law": {"name": "LinearElasticPlaneStrainSolid2DLaw"}, "Variables": variables, "Tables": {}}
    return {"properties": [{"model_part_name": "Column.Soil", "properties_id": 1, "Material": law}]}


def process(kind, part, variable, **more):
    """What holds or loads a part."""
    table = 0 if kind == "scalar" else [0, 0, 0]
    return {
        "python_module": f"apply_{kind}_constraint_table_process",
        "kratos_module": PORO,
        "Parameters": {"model_part_name": f"Column.{part}", "variable_name": variable, "table": table, **more},
    }


def settings():
    """The parameters of the analysis."""
    steps = round(case["times"][-1] / case["time_step"])
    step = case["times"][-1] / steps
    held = lambda *axes: {"active": axes, "is_fixed": axes, "value": [0.0, 0.0, 0.0]}
    return {
        "problem_data": {
            "problem_name": "column",
            "start_time": 0.0,
            "end_time": step * (steps - 0.5),  # or it takes one step more, by round-off
            "echo_level": 0,
            "parallel_type": "OpenMP",
            "fracture_utility": False,
        },
        "solver_settings": {
            "solver_type": "poromechanics_U_Pl_solver",
            "model_part_name": "Column",
            "domain_size": 2,
            "start_time": 0.0,
            "time_step": step,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "column"},
            "material_import_settings": {"materials_filename": "material.json"},
            "solution_type": "implicit_quasi_static",
            "scheme_type": "Newmark",
            "newmark_beta": 1.0,  # all four together are backward Euler
            "newmark_gamma": 1.0,
            "newmark_theta_u": 1.0,
            "newmark_theta_p": 1.0,
            "convergence_criterion": "Displacement_criterion",
            "displacement_relative_tolerance": 1e-9,
            "displacement_absolute_tolerance": 1e-15,
            "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
            "problem_domain_sub_model_part_list": ["Soil"],
            "processes_sub_model_part_list": ["Soil", "Base", "Top"],
            "body_domain_sub_model_part_list": ["Soil"],
        },
        "processes": {
            "constraints_process_list": [
                process("vector", "Soil", "DISPLACEMENT", **held(True, False, False)),
                process("vector", "Base", "DISPLACEMENT", **held(True, True, False)),
                process("scalar", "Top", "LIQUID_PRESSURE", is_fixed=True, value=0.0),
            ],
            "loads_process_list": [
                process("vector", "Top", "FACE_LOAD", active=[False, True, False], value=[0.0, -column["load"], 0.0])
            ],
        },
        "output_processes": {
            "vtu_output": [
                {
                    "python_module": "vtu_output_process",
                    "kratos_module": "KratosMultiphysics",
                    "Parameters": {
                        "model_part_name": "Column.porous_computational_model_part",
                        "output_control_type": "step",
                        "output_interval": round(case["times"][0] / step),
                        "file_format": "binary",
                        "output_path": "vtu_output",
                        "nodal_solution_step_data_variables": ["DISPLACEMENT", "LIQUID_PRESSURE"],
                    },
                }
            ]
        },
    }


case, folder = json.loads(pathlib.Path(sys.argv[1]).read_text()), pathlib.Path(sys.argv[2])
column, soil, cells, size = case["column"], case["material"], case["cells"], case["derived"]["cell_size"]
(folder / "column.mdpa").write_text(mesh())
(folder / "material.json").write_text(json.dumps(material()))
Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
analysis = PoromechanicsAnalysis(Kratos.Model(), Kratos.Parameters(json.dumps(settings())))
analysis.Initialize()
start = time.perf_counter()
analysis.RunSolutionLoop()
print(f"solved in {time.perf_counter() - start:.6f} s")
analysis.Finalize()
