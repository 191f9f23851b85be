"""Biot's column by MFEM (PyMFEM): displacement H1 of order 2, pressure H1 of order 1 on quadrilaterals, backward Euler.

adapter.py CASE.json OUT: writes OUT/column/column.pvd, a PVD of PVTU, as MFEM's ParaViewDataCollection does by default."""
import json
import math
import sys
import time

import mfem.ser as mfem
import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg

case, out = json.load(open(sys.argv[1])), sys.argv[2]
material, column, derived, cells = case["material"], case["column"], case["derived"], case["cells"]
young, nu, height = material["youngs_modulus"], material["poissons_ratio"], column["height"]
storage = material["porosity"] / material["water_bulk_modulus"]
mobility = material["hydraulic_conductivity"] / derived["unit_weight_of_water"]
mu, lam = young / 2 / (1 + nu), young * nu / (1 + nu) / (1 - 2 * nu)
# Backward Euler is of first order: its steps fall with the square of the cells.
largest_step = 0.1 * (height / cells) ** 2 / derived["coefficient_of_consolidation"]

mesh = mfem.Mesh(1, cells, "QUADRILATERAL", True, column["width"], height)  # borders: 1 base, 2 right, 3 top, 4 left
of_u, of_p = mfem.H1_FECollection(2, 2), mfem.H1_FECollection(1, 2)
space_u, space_p = mfem.FiniteElementSpace(mesh, of_u, 2), mfem.FiniteElementSpace(mesh, of_p)
numbers = [mfem.ConstantCoefficient(number) for number in (lam, mu, 1.0, storage, mobility)]


def assembled(form, integrator):
    form.AddDomainIntegrator(integrator)
    form.Assemble()
    form.Finalize()
    m = form.SpMat()
    parts = (m.GetDataArray().copy(), m.GetJArray().copy(), m.GetIArray().copy())
    return sparse.csr_matrix(parts, shape=(m.Height(), m.Width()))


stiffness = assembled(mfem.BilinearForm(space_u), mfem.ElasticityIntegrator(numbers[0], numbers[1]))
coupling = assembled(mfem.MixedBilinearForm(space_u, space_p), mfem.VectorDivergenceIntegrator(numbers[2]))
compressed = assembled(mfem.BilinearForm(space_p), mfem.MassIntegrator(numbers[3]))
drained = assembled(mfem.BilinearForm(space_p), mfem.DiffusionIntegrator(numbers[4]))
load = mfem.LinearForm(space_u)
down, top = mfem.Vector([0.0, -column["load"]]), mfem.intArray([0, 0, 1, 0])
pressing = mfem.VectorConstantCoefficient(down)
load.AddBoundaryIntegrator(mfem.VectorBoundaryLFIntegrator(pressing), top)
load.Assemble()
load = load.GetDataArray().copy()


def held(space, border, component=-1):
    found = mfem.intArray()
    space.GetEssentialTrueDofs(mfem.intArray(border), found, component)
    return np.array(found.ToList(), int)


of_displacement = stiffness.shape[0]
total = of_displacement + compressed.shape[0]
fixed = [held(space_u, [1, 0, 0, 0], 1), held(space_u, [0, 1, 0, 1], 0), of_displacement + held(space_p, [0, 0, 1, 0])]
free = np.setdiff1d(np.arange(total), np.concatenate(fixed))
x, u, p = np.zeros(total), mfem.GridFunction(space_u), mfem.GridFunction(space_p)
written = mfem.ParaViewDataCollection("column", mesh)
written.SetPrefixPath(out)
written.SetLevelsOfDetail(1)  # the corners of each cell; more would subdivide it
written.SetDataFormat(mfem.VTKFormat_BINARY)
written.RegisterField("displacement", u)
written.RegisterField("pressure", p)
now, started = 0.0, time.perf_counter()
for number, then in enumerate(case["times"]):
    steps = math.ceil((then - now) / largest_step - 1e-9)
    step = (then - now) / steps
    matrix = sparse.bmat([[stiffness, -coupling.T], [coupling, compressed + step * drained]]).tocsc()
    factors = linalg.splu(matrix[free][:, free])
    for _ in range(steps):
        right = np.concatenate([load, coupling @ x[:of_displacement] + compressed @ x[of_displacement:]])
        x[free] = factors.solve(right[free])
    now = then
    u.Assign(x[:of_displacement].copy())
    p.Assign(x[of_displacement:].copy())
    written.SetCycle(number)
    written.SetTime(now)
    written.Save()
print(f"solved in {time.perf_counter() - started:.6f} s")
