"""Runs GeoTaichi's two-phase material point method on a column at any strain.

adapter.py CASE.json OUT: GeoTaichi writes OUT/geotaichi/particles/*.npz. GEOTAICHI is the folder of its sources.

Its conductivity is constant, so a function that it calls after each step sets k_0 J². It starts with the whole load in the
water, without the strain n q/K_w."""
import json
import math
import os
import sys

try:
    sys.path.insert(0, os.environ["GEOTAICHI"])
    import geotaichi
    import taichi as ti
except (ImportError, KeyError) as missing:
    print(f"GeoTaichi is not here: {missing}", file=sys.stderr)
    sys.exit(77)

case, out = json.load(open(sys.argv[1])), sys.argv[2]
soil, column, derived = case["material"], case["column"], case["derived"]
cells, height, load, per_cell = case["cells"], column["height"], column["load"], case["points_per_cell"]
modulus, porosity = derived["oedometric_modulus"], soil["porosity"]
h = height / cells
top = height + 2 * h
conductivity = soil["hydraulic_conductivity"] * 9.8 / soil["gravity"]  # its unit weight of water is 9800 N/m³

# Steps of 0.4 of the time that the undrained wave takes through a cell at the end, where the pores are narrowest.
narrowest = 1 - (1 - porosity) * math.exp(load / modulus)
solid, water = (1 - porosity) / soil["grain_density"], porosity / soil["water_density"]
speed = math.sqrt(soil["water_bulk_modulus"] / narrowest * (solid + water) + modulus / ((1 - porosity) * soil["grain_density"]))
# Outputs are equally spaced: at the greatest common divisor of the times.
millionths = math.gcd(*(round(1e6 * factor) for factor in case["time_factors"]))
interval = millionths / 1e6 * derived["seconds_per_time_factor"]
step = interval / math.ceil(interval / (0.4 * h / speed))


def rectangle(name, bottom, tall):
    return {
        "Name": name,
        "Type": "Rectangle2D",
        "BoundingBoxPoint": ti.Vector([0.0, bottom]),
        "BoundingBoxSize": ti.Vector([h, tall]),
        "ydirection": ti.Vector([0.0, 1.0]),
    }


def fixed(velocity, start, end):
    place = {"StartPoint": start, "EndPoint": end, "NLevel": 0}
    return {"BoundaryType": "VelocityConstraint", "Velocity": velocity, **place}


geotaichi.init(dim=2, arch="cpu", cpu_max_num_threads=1, log=False)
mpm = geotaichi.MPM()
mpm.set_configuration(
    domain=ti.Vector([h, top]),
    gravity=ti.Vector([0.0, 0.0]),
    background_damping=0.0,
    alphaPIC=0.0,
    mapping="USF",
    shape_function="GIMP",
    material_type="TwoPhaseSingleLayer",
    visualize=False,
)
solver = {"Timestep": step, "SimulationTime": case["times"][-1], "SaveInterval": interval, "SavePath": out + "/geotaichi"}
mpm.set_solver(solver)
places = ("max_velocity_constraint", "max_absorbing_constraint", "max_particle_traction_constraint")
memory = {"max_material_number": 1, "max_particle_number": 10000, "max_constraint_number": dict.fromkeys(places, 10000)}
mpm.memory_allocate(memory)
mpm.add_material(
    "LinearElastic",
    {
        "MaterialID": 1,
        "SolidDensity": soil["grain_density"],
        "FluidDensity": soil["water_density"],
        "Porosity": porosity,
        "FluidBulkModulus": soil["water_bulk_modulus"],
        "Permeability": conductivity,
        "YoungModulus": soil["youngs_modulus"],
        "PoissonRatio": soil["poissons_ratio"],  # its examples write PossionRatio, which is passed over: 0.3
    },
)
mpm.add_element({"ElementType": "Q4N2D", "ElementSize": ti.Vector([h, h]), "Contact": {}})
mpm.add_region([rectangle("soil", 0.0, height), rectangle("surface", height - h / per_cell, h / per_cell)])
body = {
    "RegionName": "soil",
    "nParticlesPerCell": per_cell,
    "BodyID": 0,
    "MaterialID": 1,
    "ParticleStress": {"GravityField": False, "InternalStress": ti.Vector([0.0] * 6), "PorePressure": load},
    "Traction": [
        {"Pressure": ti.Vector([0.0, -load]), "FluidPressure": ti.Vector([0.0, 0.0]), "RegionName": "surface"},
    ],
    "InitialVelocity": ti.Vector([0.0, 0.0]),
    "FixVelocity": ["Free", "Free"],
}
mpm.add_body({"Template": [body]})
sides = [fixed([0.0, None], [x, 0.0], [x, top]) for x in (0.0, h)]
mpm.add_boundary_condition([fixed([0.0, 0.0], [0.0, 0.0], [h, 0.0]), *sides])
particle, points = mpm.scene.particle, int(mpm.scene.particleNum[0])


def conductivities():
    for i in range(points):
        particle[i].permeability = conductivity * ((1 - porosity) / (1 - particle[i].porosity)) ** 2


mpm.select_save_data(grid=False)
mpm.run(function=conductivities)
