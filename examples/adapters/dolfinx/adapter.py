"""Biot's column by DOLFINx 0.5: displacement of order 2, pressure of order 1 on quadrilaterals, backward Euler.

adapter.py CASE.json OUT: writes OUT/column.xdmf with HDF5 beside it, and OUT/column.pvd, a PVD of PVTU."""
import json
import math
import sys
import time

import numpy as np
import ufl
from dolfinx import fem, io, mesh
from dolfinx.fem.petsc import apply_lifting, assemble_matrix, assemble_vector, set_bc
from mpi4py import MPI
from petsc4py import PETSc

case, out = json.load(open(sys.argv[1])), sys.argv[2]
material, column, derived, cells = case["material"], case["column"], case["derived"], case["cells"]
young, nu = material["youngs_modulus"], material["poissons_ratio"]
height, width = column["height"], column["width"]
storage = material["porosity"] / material["water_bulk_modulus"]
mobility = material["hydraulic_conductivity"] / derived["unit_weight_of_water"]
mu, lam = young / 2 / (1 + nu), young * nu / (1 + nu) / (1 - 2 * nu)
# Backward Euler is of first order: its steps fall with the square of the cells.
largest_step = 0.1 * (height / cells) ** 2 / derived["coefficient_of_consolidation"]

grid = mesh.create_rectangle(MPI.COMM_WORLD, [[0, 0], [width, height]], [1, cells], mesh.CellType.quadrilateral)
of_u, of_p = ufl.VectorElement("Lagrange", grid.ufl_cell(), 2), ufl.FiniteElement("Lagrange", grid.ufl_cell(), 1)
space = fem.FunctionSpace(grid, ufl.MixedElement([of_u, of_p]))
new, old = fem.Function(space), fem.Function(space)
(u, p), (v, r) = ufl.TrialFunctions(space), ufl.TestFunctions(space)
u_old, p_old = ufl.split(old)
step = fem.Constant(grid, PETSc.ScalarType(1.0))


def at(place):
    return mesh.locate_entities_boundary(grid, 1, place)


def stress(u):
    return 2 * mu * ufl.sym(ufl.grad(u)) + lam * ufl.div(u) * ufl.Identity(2)


def held(part, place):
    inside, _ = part.collapse()
    return fem.dirichletbc(fem.Function(inside), fem.locate_dofs_topological((part, inside), 1, at(place)), part)


surface = np.sort(at(lambda x: np.isclose(x[1], height)))
top = ufl.Measure("ds", grid, subdomain_data=mesh.meshtags(grid, 1, surface, np.ones(len(surface), np.int32)))(1)
balance = ufl.inner(stress(u), ufl.grad(v)) - p * ufl.div(v)
water = ufl.div(u) * r + storage * p * r + step * mobility * ufl.dot(ufl.grad(p), ufl.grad(r))
left = fem.form((balance + water) * ufl.dx)
right = fem.form(-column["load"] * v[1] * top + (ufl.div(u_old) * r + storage * p_old * r) * ufl.dx)
fixed = [
    held(space.sub(0).sub(0), lambda x: np.isclose(x[0], 0) | np.isclose(x[0], width)),
    held(space.sub(0).sub(1), lambda x: np.isclose(x[1], 0)),
    held(space.sub(1), lambda x: np.isclose(x[1], height)),
]
solver = PETSc.KSP().create(grid.comm)
solver.setType("preonly")
solver.getPC().setType("lu")
solver.getPC().setFactorSolverType("mumps")

shown_u = fem.Function(fem.VectorFunctionSpace(grid, ("Lagrange", 1)), name="u")  # XDMF has no more than order 1
shown_s = fem.Function(fem.FunctionSpace(grid, ("DG", 0)), name="sigma_eff_yy")
xdmf, pvd = io.XDMFFile(grid.comm, out + "/column.xdmf", "w"), io.VTKFile(grid.comm, out + "/column.pvd", "w")
xdmf.write_mesh(grid)
now, started = 0.0, time.perf_counter()
for then in case["times"]:
    steps = math.ceil((then - now) / largest_step - 1e-9)
    step.value = (then - now) / steps
    matrix = assemble_matrix(left, bcs=fixed)
    matrix.assemble()
    solver.setOperators(matrix)
    for _ in range(steps):
        vector = assemble_vector(right)
        apply_lifting(vector, [left], [fixed])
        set_bc(vector, fixed)
        solver.solve(vector, new.vector)
        old.x.array[:] = new.x.array
    now = then
    u_now, p_now = new.sub(0).collapse(), new.sub(1).collapse()
    p_now.name = "p"
    shown_u.interpolate(u_now)
    shown_s.interpolate(fem.Expression(stress(u_now)[1, 1], shown_s.function_space.element.interpolation_points()))
    for shown in (p_now, shown_u, shown_s):
        xdmf.write_function(shown, now)
    pvd.write_function([p_now, shown_u, shown_s], now)
print(f"solved in {time.perf_counter() - started:.6f} s")
xdmf.close()
pvd.close()
