#!/usr/bin/env python3
"""Runs @NAME@ on one case of a study.

    adapter.py CASE.json OUT

CASE.json describes the problem (`oedometer schema case` has every key; SI units), OUT is an empty folder for the
result. The small solver below works: replace `solve` with yours.

Exit code 0: solved. 77: it cannot run here (a package is missing), so the case is skipped. Any other: it failed, and
the last lines on standard error are kept.
"""

import json
import math
import pathlib
import sys


def solve(case):
    """Rows (t, y, p, u_y) at the nodes: finite differences, backward Euler, water and skeleton compressible."""
    cells, height, load = case["cells"], case["column"]["height"], case["column"]["load"]
    soil, derived = case["material"], case["derived"]
    modulus = derived["oedometric_modulus"]
    storage = soil["porosity"] / soil["water_bulk_modulus"]
    mobility = soil["hydraulic_conductivity"] / derived["unit_weight_of_water"]
    diffusivity = mobility / (1 / modulus + storage)
    spacing = height / cells
    pressure = [load / (1 + modulus * storage)] * cells + [0.0]  # the undrained start; drained at the surface
    time = 0.0
    for output in case["times"]:
        steps = math.ceil((output - time) / case["time_step"] - 1e-9)
        for _ in range(steps):
            step = (output - time) / steps
            pressure = backward_euler(pressure, diffusivity * step / spacing**2)
        time = output
        displacement = 0.0
        for node in range(cells + 1):
            if node > 0:
                mean = 0.5 * (pressure[node] + pressure[node - 1])
                displacement -= spacing * (load - mean) / modulus
            yield time, node * spacing, pressure[node], displacement


def backward_euler(pressure, ratio):
    """One step by Thomas's algorithm: mirrored at the base (node 0), drained at the last node."""
    cells = len(pressure) - 1
    upper, right = [], []
    for node in range(cells):
        before = (upper[-1], right[-1]) if node > 0 else (0.0, 0.0)
        pivot = 1 + 2 * ratio + ratio * before[0]
        upper.append((-2 * ratio if node == 0 else -ratio) / pivot)
        right.append((pressure[node] + ratio * before[1]) / pivot)
    new = [0.0] * (cells + 1)
    for node in range(cells - 1, -1, -1):
        new[node] = right[node] - upper[node] * new[node + 1]
    return new


if __name__ == "__main__":
    case = json.loads(pathlib.Path(sys.argv[1]).read_text())
    if case["scene"] != "terzaghi":
        sys.exit(f"this adapter solves `terzaghi`, and the case is `{case['scene']}`")
    with open(pathlib.Path(sys.argv[2]) / "result.csv", "w") as result:
        result.write("t,y,p,u_y\n")
        for row in solve(case):
            result.write(",".join(f"{value:.17g}" for value in row) + "\n")
