#!/usr/bin/env python3
"""Somebody else's solver: Terzaghi's column by finite differences and backward Euler.

    finite_difference.py CELLS > column-CELLS.csv

It knows nothing of oedometer and has habits of its own: kilopascals and millimetres, time in
minutes, depth below the surface, tension positive, settlement positive. mapping.toml declares them.
"""

import sys

HEIGHT, LOAD = 1.0, 1.0e-3  # m, kPa
MODULUS = 1200.0  # oedometric, kPa
DIFFUSIVITY = 1e-4 * MODULUS / 9.81  # k E/γ_w with γ_w in kN/m³, m²/s
OUTPUTS = [0.1, 0.2, 0.5]  # time factors
STEP = 0.002  # time factor, on ten cells


def solve(cells):
    """Rows of (minutes, depth, pressure, settled) at the nodes."""
    spacing = HEIGHT / cells
    step = STEP * (10 / cells) ** 2  # first order in time, second in space: together second
    ratio = step * cells**2
    pressure = [0.0] + [1.0] * cells  # over the load; node 0 is the drained surface
    done = 0
    for output in OUTPUTS:
        while done < round(output / step):
            pressure = backward_euler(pressure, ratio)
            done += 1
        settled = [0.0] * (cells + 1)
        for node in range(cells - 1, -1, -1):
            mean = 1 - 0.5 * (pressure[node] + pressure[node + 1])
            settled[node] = settled[node + 1] + mean * spacing * LOAD / MODULUS
        seconds = output * HEIGHT**2 / DIFFUSIVITY
        for node in range(cells + 1):
            yield seconds / 60, node * spacing, -LOAD * pressure[node], 1e3 * settled[node]


def backward_euler(pressure, ratio):
    """One step: Thomas's algorithm, drained at the first node, mirrored at the last."""
    last = len(pressure) - 1
    upper, right = [0.0] * (last + 1), [0.0] * (last + 1)
    for node in range(1, last + 1):
        lower = -2 * ratio if node == last else -ratio
        pivot = 1 + 2 * ratio - lower * upper[node - 1]
        upper[node] = (0.0 if node == last else -ratio) / pivot
        right[node] = (pressure[node] - lower * right[node - 1]) / pivot
    new = [0.0] * (last + 1)
    new[last] = right[last]
    for node in range(last - 1, 0, -1):
        new[node] = right[node] - upper[node] * new[node + 1]
    return new


if __name__ == "__main__":
    print("time,depth,pore_pressure,settled")
    for row in solve(int(sys.argv[1])):
        print(",".join(f"{value:.12g}" for value in row))
