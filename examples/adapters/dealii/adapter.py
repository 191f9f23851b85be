"""adapter.py CASE.json OUT: writes the parameters of the case and runs dealii-column, which is built of column.cc, in OUT."""
import json
import shutil
import subprocess
import sys

case, out = json.load(open(sys.argv[1])), sys.argv[2]
if not shutil.which("dealii-column"):
    print("dealii-column is not in PATH: build it as README.md says", file=sys.stderr)
    sys.exit(77)
material, column, derived = case["material"], case["column"], case["derived"]
young, nu = material["youngs_modulus"], material["poissons_ratio"]
parameters = {
    "lambda": young * nu / (1 + nu) / (1 - 2 * nu),
    "mu": young / 2 / (1 + nu),
    "storage": material["porosity"] / material["water_bulk_modulus"],
    "mobility": material["hydraulic_conductivity"] / derived["unit_weight_of_water"],
    "width": column["width"],
    "height": column["height"],
    "load": column["load"],
    "cells": case["cells"],
    # Backward Euler is of first order: its steps fall with the square of the cells.
    "largest step": 0.1 * (column["height"] / case["cells"]) ** 2 / derived["coefficient_of_consolidation"],
    "times": ", ".join(repr(time) for time in case["times"]),
}
with open(f"{out}/column.prm", "w") as file:
    file.writelines(f"set {name} = {value}\n" for name, value in parameters.items())
sys.exit(subprocess.call(["dealii-column", f"{out}/column.prm", out]))
