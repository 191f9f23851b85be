#!/usr/bin/env python3
"""A column of Q2–P1 elements (displacement quadratic, pressure linear) with scikit-fem.

    adapter.py CASE.json OUT sdirk2 | backward-euler

Backward Euler takes equal steps of the case's `time_step`; SDIRK2 (two stages, L-stable) takes steps that grow by 5 % of
the time passed, like the implicit integrator of oedometer.
"""

import json
import math
import pathlib
import sys
import time

try:
    import numpy as np
    import scipy.sparse as sp
    from scipy.sparse.linalg import splu
    from skfem import Basis, BilinearForm, ElementLineP1, ElementLineP2, MeshLine
except ImportError as error:
    print(f"scikit-fem is not installed here: {error}", file=sys.stderr)
    sys.exit(77)


def assembled(case):
    """Matrices A, M and F and the load b of A x = b at the start and d(M x)/dt + F x = 0 in its second row, held
    unknowns left out; and a function that gives y, p and u_y at the ends of the elements."""
    soil, height = case["material"], case["column"]["height"]
    modulus, weight = case["derived"]["oedometric_modulus"], case["derived"]["unit_weight_of_water"]
    mesh = MeshLine(np.linspace(0, height, case["cells"] + 1))
    u, p = Basis(mesh, ElementLineP2(), intorder=4), Basis(mesh, ElementLineP1(), intorder=4)
    stiffness = modulus * BilinearForm(lambda u, v, _: u.grad[0] * v.grad[0]).assemble(u)
    coupling = BilinearForm(lambda p, v, _: p * v.grad[0]).assemble(p, u)
    storage = soil["porosity"] / soil["water_bulk_modulus"] * BilinearForm(lambda p, r, _: p * r).assemble(p)
    mobility = soil["hydraulic_conductivity"] / weight
    flow = mobility * BilinearForm(lambda p, r, _: p.grad[0] * r.grad[0]).assemble(p)
    at = lambda basis, y: basis.get_dofs(lambda x: np.isclose(x[0], y)).all()
    free = np.setdiff1d(np.arange(u.N + p.N), np.concatenate([at(u, 0), u.N + at(p, height)]))
    part = lambda blocks: sp.bmat(blocks).tocsr()[free][:, free].tocsc()
    load = np.zeros(u.N + p.N)
    load[at(u, height)] = -case["column"]["load"]

    def at_nodes(unknowns):
        full = np.zeros(u.N + p.N)
        full[free] = unknowns
        return np.column_stack([mesh.p[0], full[u.N + p.nodal_dofs[0]], full[u.nodal_dofs[0]]])

    balance = part([[stiffness, -coupling], [coupling.T, storage]])
    memory = part([[0 * stiffness, 0 * coupling], [coupling.T, storage]])
    return balance, memory, part([[0 * stiffness, None], [None, flow]]), load[free], at_nodes


def backward_euler(balance, memory, flow, load, case):
    """Unknowns at the outputs; from rest, so that the undrained answer to the load is part of the first step."""
    unknowns, done, step = np.zeros(len(load)), 0, case["time_step"]
    solver = splu(balance + step * flow)
    for output in case["times"]:
        steps = round(output / step)
        for _ in range(done, steps):
            unknowns = solver.solve(load + memory @ unknowns)
        done = steps
        yield unknowns


def sdirk2(balance, memory, flow, load, case):
    """The same by two stages a step."""
    gamma = 1 - 1 / math.sqrt(2)
    unknowns, now = splu(balance).solve(load), 0.0
    first = 0.075 / case["cells"] ** 2 * case["derived"]["seconds_per_time_factor"]
    for output in case["times"]:
        while now < output * (1 - 1e-12):
            step, left = max(first, 0.05 * now), output - now
            if left < 3 * step:
                step = left / math.ceil(left / step)
            solver = splu(balance + gamma * step * flow)
            past = load + memory @ unknowns
            rate = -(flow @ solver.solve(past))
            unknowns = solver.solve(past + (1 - gamma) * step * rate)
            now += step
        now = output
        yield unknowns


case = json.loads(pathlib.Path(sys.argv[1]).read_text())
scheme = {"backward-euler": backward_euler, "sdirk2": sdirk2}[sys.argv[3]]
start = time.perf_counter()
*system, at_nodes = assembled(case)
states = [at_nodes(unknowns) for unknowns in scheme(*system, case)]
print(f"solved in {time.perf_counter() - start:.6f} s")
rows = [np.insert(state, 0, output, axis=1) for output, state in zip(case["times"], states)]
result = pathlib.Path(sys.argv[2]) / "result.csv"
np.savetxt(result, np.vstack(rows), "%.17g", ",", header="t,y,p,u_y", comments="")
