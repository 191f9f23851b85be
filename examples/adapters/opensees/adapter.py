#!/usr/bin/env python3
"""A column with OpenSees: elements 9_4_QuadUP, pressure on their corners, backward Euler.

    adapter.py CASE.json OUT

OpenSees has the pressure as the velocity of the third degree of freedom of a corner.
"""

import json
import pathlib
import sys
import time

try:
    import openseespy.opensees as ops
except (ImportError, RuntimeError) as error:
    print(f"OpenSees is not installed here: {error}", file=sys.stderr)
    sys.exit(77)

case, folder = json.loads(pathlib.Path(sys.argv[1]).read_text()), pathlib.Path(sys.argv[2])
soil, cells, size = case["material"], case["cells"], case["derived"]["cell_size"]
node = lambda row, column: 3 * row + column + 1  # three columns, two rows to an element
rows, corner_rows = range(2 * cells + 1), range(0, 2 * cells + 1, 2)
corners = [(row, column) for row in corner_rows for column in (0, 2)]

for freedoms in (3, 2):  # corners have a pressure, the others none
    ops.model("basic", "-ndm", 2, "-ndf", freedoms)
    for row in rows:
        for column in range(3):
            if ((row, column) in corners) == (freedoms == 3):
                ops.node(node(row, column), column * size / 2, row * size / 2)
for row in rows:
    for column in range(3):
        drained = [int(row == 2 * cells)] if (row, column) in corners else []
        ops.fix(node(row, column), int(row == 0 or column != 1), int(row == 0), *drained)

ops.nDMaterial("ElasticIsotropic", 1, soil["youngs_modulus"], soil["poissons_ratio"], 0.0)
bulk = soil["water_bulk_modulus"] / soil["porosity"]
mobility = soil["hydraulic_conductivity"] / case["derived"]["unit_weight_of_water"]
around = [(0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0), (1, 1)]  # corners, middles of the sides, middle
for cell in range(cells):
    nodes = [node(2 * cell + row, column) for row, column in around]
    ops.element("9_4_QuadUP", cell + 1, *nodes, 1.0, 1, bulk, 0.0, mobility, mobility, 0.0, 0.0)

ops.timeSeries("Constant", 1)
ops.pattern("Plain", 1, 1)
for column, share in enumerate((1 / 6, 4 / 6, 1 / 6)):
    more = [0.0] if column != 1 else []
    ops.load(node(2 * cells, column), 0.0, -case["column"]["load"] * size * share, *more)

ops.constraints("Plain")
ops.numberer("RCM")
ops.system("UmfPack")
ops.test("NormDispIncr", 1e-12, 10)
ops.algorithm("Linear")
ops.integrator("Newmark", 1.0, 1.0)  # backward Euler of displacement and pressure
ops.analysis("Transient")

start, done = time.perf_counter(), 0
with open(folder / "result.csv", "w") as result:
    print("t,y,p,u_y", file=result)
    for output in case["times"]:
        steps = round(output / case["time_step"])
        if ops.analyze(steps - done, case["time_step"]) != 0:
            sys.exit("OpenSees ended before the last output")
        done = steps
        for row in corner_rows:
            pressure, up = ops.nodeVel(node(row, 0), 3), ops.nodeDisp(node(row, 0), 2)
            print(output, row * size / 2, pressure, up, sep=",", file=result)
print(f"solved in {time.perf_counter() - start:.6f} s")
