"""adapter.py CASE.json OUT: writes the parameters of the case for column.edp and runs it in OUT."""
import json
import os
import pathlib
import shutil
import subprocess
import sys

case, out = json.load(open(sys.argv[1])), sys.argv[2]
material, column, derived = case["material"], case["column"], case["derived"]
parameters = {
    "real E": material["youngs_modulus"],
    "real nu": material["poissons_ratio"],
    "real S": material["porosity"] / material["water_bulk_modulus"],
    "real kap": material["hydraulic_conductivity"] / derived["unit_weight_of_water"],
    "real W": column["width"],
    "real H": column["height"],
    "real q": column["load"],
    "int n": case["cells"],
    # Backward Euler is of first order: its steps fall with the square of the cells.
    "real largest": 0.1 * (column["height"] / case["cells"]) ** 2 / derived["coefficient_of_consolidation"],
    "int nt": len(case["times"]),
    "real[int] times": case["times"],
}
with open(f"{out}/params.idp", "w") as file:
    file.writelines(f"{name} = {value};\n" for name, value in parameters.items())
shutil.copy(pathlib.Path(__file__).resolve().parent / "column.edp", out)
# Debian's package keeps the plug-ins here.
environment = dict(os.environ, FF_LOADPATH=os.environ.get("FF_LOADPATH", "/usr/lib/freefem++/;"))
sys.exit(subprocess.call(["FreeFem++", "-nw", "-v", "0", "column.edp"], cwd=out, env=environment))
