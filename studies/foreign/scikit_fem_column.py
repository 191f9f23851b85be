#!/usr/bin/env python3
"""A column of Q2–P1 elements (displacement quadratic, pressure linear) with scikit-fem.

    scikit_fem_column.py CASE.json OUT [backward-euler | sdirk2]

Backward Euler takes equal steps of the case's `time_step`; SDIRK2 (two stages, L-stable) takes steps that grow by 5 %
of the time passed, like the implicit integrator of oedometer. It says how long the solution took without imports.
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


class Column:
    """Matrices of K u − C p = f and C' u̇ + S ṗ + D p = 0, and the free unknowns."""

    def __init__(self, case):
        height, soil, derived = case["column"]["height"], case["material"], case["derived"]
        modulus, weight = derived["oedometric_modulus"], derived["unit_weight_of_water"]
        storage = soil["porosity"] / soil["water_bulk_modulus"]
        mobility = soil["hydraulic_conductivity"] / weight
        mesh = MeshLine(np.linspace(0, height, case["cells"] + 1))
        u, p = Basis(mesh, ElementLineP2(), intorder=4), Basis(mesh, ElementLineP1(), intorder=4)
        stiffness = BilinearForm(lambda u, v, w: modulus * u.grad[0] * v.grad[0]).assemble(u)
        coupling = BilinearForm(lambda p, v, w: p * v.grad[0]).assemble(p, u)
        compressibility = BilinearForm(lambda p, r, w: storage * p * r).assemble(p)
        flow = BilinearForm(lambda p, r, w: mobility * p.grad[0] * r.grad[0]).assemble(p)
        fixed = np.concatenate(
            [
                u.get_dofs(lambda x: np.isclose(x[0], 0)).all(),
                u.N + p.get_dofs(lambda x: np.isclose(x[0], height)).all(),
            ]
        )
        free = np.setdiff1d(np.arange(u.N + p.N), fixed)
        part = lambda blocks: sp.bmat(blocks).tocsr()[free][:, free].tocsc()
        nothing = sp.csr_matrix(stiffness.shape), sp.csr_matrix(coupling.shape)
        self.whole = part([[stiffness, -coupling], [coupling.T, compressibility]])
        self.memory = part([[*nothing], [coupling.T, compressibility]])
        self.flow = part([[nothing[0], None], [None, flow]])
        load = np.zeros(u.N + p.N)
        load[u.get_dofs(lambda x: np.isclose(x[0], height)).all()] = -case["column"]["load"]
        self.load, self.free, self.size = load[free], free, u.N + p.N
        self.places = mesh.p[0]
        self.nodes_u, self.nodes_p = u.nodal_dofs[0], u.N + p.nodal_dofs[0]

    def fields(self, unknowns):
        """Pressure and displacement at the corner nodes."""
        full = np.zeros(self.size)
        full[self.free] = unknowns
        return full[self.nodes_p], full[self.nodes_u]


def backward_euler(column, case):
    """Unknowns at the outputs."""
    # From rest: the undrained answer to the load is part of the first step.
    unknowns, now, known = np.zeros(len(column.free)), 0.0, {}
    for output in case["times"]:
        steps = math.ceil((output - now) / case["time_step"] - 1e-9)
        step = (output - now) / steps
        key = round(step / case["time_step"], 9)
        if key not in known:
            known[key] = splu(column.whole + step * column.flow)
        for _ in range(steps):
            unknowns = known[key].solve(column.load + column.memory @ unknowns)
        now = output
        yield output, unknowns


def sdirk2(column, case, growth=0.05):
    """The same by two stages a step."""
    gamma = 1 - 1 / math.sqrt(2)
    unknowns, now = splu(column.whole).solve(column.load), 0.0
    first = (0.5 / case["cells"]) ** 2 * 0.3 * case["derived"]["seconds_per_time_factor"]
    for output in case["times"]:
        while now < output * (1 - 1e-12):
            step, left = max(first, growth * now), output - now
            if left < 3 * step:
                step = left / math.ceil(left / step)
            solver = splu(column.whole + gamma * step * column.flow)
            past = column.load + column.memory @ unknowns
            rate = -(column.flow @ solver.solve(past))
            unknowns = solver.solve(past + (1 - gamma) * step * rate)
            now += step
        now = output
        yield output, unknowns


if __name__ == "__main__":
    case = json.loads(pathlib.Path(sys.argv[1]).read_text())
    scheme = {"backward-euler": backward_euler, "sdirk2": sdirk2}[(sys.argv[3:] or ["backward-euler"])[0]]
    start = time.perf_counter()
    column = Column(case)
    states = [(output, column.fields(unknowns)) for output, unknowns in scheme(column, case)]
    print(f"solved in {time.perf_counter() - start:.6f} s")
    with open(pathlib.Path(sys.argv[2]) / "result.csv", "w") as result:
        result.write("t,y,p,u_y\n")
        for output, (pressure, displacement) in states:
            for place, p, u in zip(column.places, pressure, displacement):
                result.write(f"{output:.17g},{place:.17g},{p:.17g},{u:.17g}\n")
