#!/usr/bin/env python3
"""A column of one or several soils with OpenGeoSys: eight-node elements, pressure on their corners, backward Euler.

    adapter.py CASE.json OUT

Fills `column.prj` with the numbers of the case and lets the program's own tools make the mesh.
"""

import json
import pathlib
import shutil
import string
import subprocess
import sys

VISCOSITY = 1e-3  # Pa s; only turns the conductivity into a permeability
SIDES = ["top", "bottom", "left", "right"]


def run(program, *words):
    """Starts a program of the package, in the folder of the result; ends with its exit code where it fails."""
    code = subprocess.run([program, *map(str, words)], cwd=folder).returncode
    if code != 0:
        sys.exit(code)


def by_height(value):
    """A number of the soil as an expression of y; of layers with the thicknesses from the base up."""
    below, *above = column["soils"] or [{}]
    expression, bottom = repr(value(material | below)), 0.0
    for soil in above:
        bottom += below["thickness"]
        expression, below = f"if (y > {bottom!r}, {value(material | soil)!r}, {expression})", soil
    return expression


if shutil.which("ogs") is None:
    print("OpenGeoSys is not installed here: there is no program `ogs`", file=sys.stderr)
    sys.exit(77)
case, folder = json.loads(pathlib.Path(sys.argv[1]).read_text()), pathlib.Path(sys.argv[2])
column, material = case["column"], case["material"]
height, cells, end = column["height"], case["cells"], case["times"][-1]
steps = round(end / case["time_step"])
weight = case["derived"]["unit_weight_of_water"]
numbers = {
    "load": column["load"],
    "viscosity": VISCOSITY,
    "water_density": material["water_density"],
    "grain_density": material["grain_density"],
    "compressibility": 1 / material["water_bulk_modulus"],
    "youngs_modulus": by_height(lambda soil: soil["youngs_modulus"]),
    "poissons_ratio": by_height(lambda soil: soil["poissons_ratio"]),
    "porosity": by_height(lambda soil: soil["porosity"]),
    "permeability": by_height(lambda soil: soil["hydraulic_conductivity"] / weight * VISCOSITY),
    "steps": steps,
    "step": end / steps,
    "end": end,
    "times": " ".join(map(repr, case["times"])),
}
template = string.Template((pathlib.Path(__file__).parent / "column.prj").read_text())
(folder / "column.prj").write_text(template.substitute(numbers))
size = ["--lx", height / cells, "--ly", height, "--nx", 1, "--ny", cells]
run("generateStructuredMesh", "-e", "quad", *size, "-o", "linear.vtu")
run("createQuadraticMesh", "-i", "linear.vtu", "-o", "column.vtu")
for side in SIDES:
    run("createQuadraticMesh", "-i", f"linear_{side}.vtu", "-o", f"{side}.vtu")
run("identifySubdomains", "-f", "-m", "column.vtu", "-o", "./", *(f"{side}.vtu" for side in SIDES))
run("ogs", "column.prj")
