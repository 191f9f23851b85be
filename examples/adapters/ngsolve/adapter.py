#!/usr/bin/env python3
"""A column with NGSolve in three fields: displacement Q2, flux of water RT0, pressure constant in a cell; backward Euler.

    adapter.py CASE.json OUT

Leaves OUT/centres.csv with pressure and displacement at the cell centres, and OUT/settlement.csv with that of the surface.
"""

import json
import pathlib
import sys
import time

try:
    import ngsolve as ng
    from ngsolve.meshes import MakeStructured2DMesh
except ImportError as error:
    print(f"NGSolve is not installed here: {error}", file=sys.stderr)
    sys.exit(77)

case, folder = json.loads(pathlib.Path(sys.argv[1]).read_text()), pathlib.Path(sys.argv[2])
soil, cells, size, height = case["material"], case["cells"], case["derived"]["cell_size"], case["column"]["height"]
step, weight = case["time_step"], case["derived"]["unit_weight_of_water"]
young, poisson = soil["youngs_modulus"], soil["poissons_ratio"]
shear, lame = young / (2 + 2 * poisson), young * poisson / ((1 + poisson) * (1 - 2 * poisson))

start = time.perf_counter()
mesh = MakeStructured2DMesh(nx=1, ny=cells, mapping=lambda x, y: (size * x, height * y))
space = ng.FESpace([
    ng.VectorH1(mesh, order=2, dirichletx="left|right", dirichlety="bottom"),
    ng.HDiv(mesh, order=0, RT=True, dirichlet="left|right|bottom"),
    ng.L2(mesh, order=0),
])  # fmt: skip
(u, flux, p), (v, z, q) = space.TnT()
strain = lambda field: ng.Sym(ng.Grad(field))
content = soil["porosity"] / soil["water_bulk_modulus"] * p + ng.div(u)

balance = ng.BilinearForm(space)
balance += (2 * shear * ng.InnerProduct(strain(u), strain(v)) + (lame * ng.div(u) - p) * ng.div(v)) * ng.dx
balance += (weight / soil["hydraulic_conductivity"] * flux * z - p * ng.div(z)) * ng.dx
balance += (content + step * ng.div(flux)) * q * ng.dx
memory = ng.BilinearForm(space)
memory += content * q * ng.dx
load = ng.LinearForm(space)
load += -case["column"]["load"] * v[1] * ng.ds("top")
for form in (balance, memory, load):
    form.Assemble()
solver = balance.mat.Inverse(space.FreeDofs(), inverse="umfpack")

state, done = ng.GridFunction(space), 0
displacement, _, pressure = state.components
with open(folder / "centres.csv", "w") as centres, open(folder / "settlement.csv", "w") as settlement:
    print("t,y,p,u_y", file=centres)
    print("t,s", file=settlement)
    for output in case["times"]:
        steps = round(output / step)
        for _ in range(done, steps):
            state.vec.data = solver * (load.vec + memory.mat * state.vec)
        done = steps
        for cell in range(cells):
            y = (cell + 0.5) * size
            at = mesh(size / 2, y)
            print(output, y, pressure(at), displacement(at)[1], sep=",", file=centres)
        print(output, -displacement(mesh(size / 2, height))[1], sep=",", file=settlement)
print(f"solved in {time.perf_counter() - start:.6f} s")
