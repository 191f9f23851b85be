#!/usr/bin/env python3
"""A column with Kratos' GeoMechanicsApplication: eight-node elements, pressure on their corners, backward Euler.

    adapter.py CASE.json OUT

Leaves OUT/vtu_output with a series of VTU.
"""

import json
import pathlib
import sys
import time

try:
    import KratosMultiphysics as Kratos
    from KratosMultiphysics.GeoMechanicsApplication.geomechanics_analysis import GeoMechanicsAnalysis
except ImportError as error:
    print(f"Kratos is not installed here: {error}", file=sys.stderr)
    sys.exit(77)

VISCOSITY = 1e-3  # Pa s; only turns the conductivity into a permeability
GEO = "KratosMultiphysics.GeoMechanicsApplication"


def mesh():
    """Text of the mesh. Node 3 r + c is in column c of 1, 2, 3 and row r, two rows to an element; its middle has none."""
    block = lambda name, lines: "\n".join([f"Begin {name}", *lines, f"End {name.split()[0]}", ""])
    numbers = [3 * row + column for row in range(2 * cells + 1) for column in (1, 2, 3) if row % 2 == 0 or column != 2]
    place = lambda number: f"{(number - 1) % 3 * size / 2!r} {(number - 1) // 3 * size / 2!r} 0.0"
    around = [1, 3, 9, 7, 2, 6, 8, 4]  # corners, then middles of the sides, against the clock
    elements = [f"{e + 1} 1 " + " ".join(str(6 * e + node) for node in around) for e in range(cells)]
    top = [numbers[-1], numbers[-3], numbers[-2]]
    text = block("Properties 1", [])
    text += block("Nodes", (f"{number} {place(number)}" for number in numbers))
    text += block("Elements SmallStrainUPwDiffOrderElement2D8N", elements)
    text += block("Conditions LineLoadDiffOrderCondition2D3N", ["1 1 " + " ".join(map(str, top))])
    sides = [number for number in numbers if number % 3 != 2]
    for name, nodes, elements, conditions in [
        ("Soil", numbers, range(1, cells + 1), []),
        ("Base", numbers[:3], [], []),
        ("Sides", sides, [], []),
        ("Top", top, [], [1]),
    ]:
        parts = {"Nodes": nodes, "Elements": elements, "Conditions": conditions}
        text += block(f"SubModelPart {name}", (block(f"SubModelPart{kind}", map(str, of)) for kind, of in parts.items()))
    return text


def material():
    """The soil as Kratos names it."""
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
    return {"properties": [{"model_part_name": "Column.Soil", "properties_id": 1, "Material": law}]}


def process(kind, part, variable, **more):
    """What holds or loads a part."""
    table = 0 if kind == "scalar" else [0, 0, 0]
    return {
        "python_module": f"apply_{kind}_constraint_table_process",
        "kratos_module": GEO,
        "Parameters": {"model_part_name": f"Column.{part}", "variable_name": variable, "table": table, **more},
    }


def settings():
    """The parameters of the analysis."""
    steps = round(case["times"][-1] / case["time_step"])
    step = case["times"][-1] / steps
    held = lambda *axes: {"active": axes, "is_fixed": axes, "value": [0, 0, 0]}
    return {
        "problem_data": {
            "problem_name": "column",
            "start_time": 0.0,
            "end_time": step * steps,
            "echo_level": 0,
            "parallel_type": "OpenMP",
        },
        "solver_settings": {
            "solver_type": "U_Pw",
            "model_part_name": "Column",
            "domain_size": 2,
            "model_import_settings": {"input_type": "mdpa", "input_filename": "column"},
            "material_import_settings": {"materials_filename": "material.json"},
            "time_stepping": {"time_step": step, "minimum_allowable_value": step / 2},  # or the last may be two steps
            "solution_type": "Quasi-Static",
            "scheme_type": "Backward_Euler",
            "min_iterations": 1,  # fewer than this, and Kratos doubles the time step: the default is 6
            "displacement_relative_tolerance": 1e-9,
            "displacement_absolute_tolerance": 1e-15,
            "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
            "problem_domain_sub_model_part_list": ["Soil"],
            "body_domain_sub_model_part_list": ["Soil"],
        },
        "processes": {
            "constraints_process_list": [
                process("vector", "Base", "DISPLACEMENT", **held(True, True, True)),
                process("vector", "Sides", "DISPLACEMENT", **held(True, False, False)),
                process("scalar", "Top", "WATER_PRESSURE", is_fixed=True, value=0.0),
            ],
            "loads_process_list": [
                process("vector", "Top", "LINE_LOAD", active=[False, True, False], value=[0, -column["load"], 0])
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
                        "nodal_solution_step_data_variables": ["DISPLACEMENT", "WATER_PRESSURE"],
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
analysis = GeoMechanicsAnalysis(Kratos.Model(), Kratos.Parameters(json.dumps(settings())))
analysis.Initialize()
start = time.perf_counter()
analysis.RunSolutionLoop()
print(f"solved in {time.perf_counter() - start:.6f} s")
analysis.Finalize()
