#!/usr/bin/env python3
"""The column with OpenGeoSys 6: one column of eight-node elements, pressure on their corners, backward Euler.

    ogs_column.py CASE.json OUT

Writes meshes and project, runs `ogs`, and leaves OUT/col.pvd with a VTU an output. `pip install ogs` brings the
program; without it the case is skipped.
"""

import json
import pathlib
import shutil
import subprocess
import sys

VISCOSITY = 1e-3  # Pa s; the conductivity of the case decides, this only turns it into a permeability


def program():
    """The program, beside this Python or wherever the system finds it."""
    beside = pathlib.Path(sys.executable).parent / "ogs"
    found = str(beside) if beside.is_file() else shutil.which("ogs")
    if found is None:
        print("OpenGeoSys is not installed here: there is no program `ogs`", file=sys.stderr)
        sys.exit(77)
    return found


def write_mesh(path, points, cells, kind, point_data=None, cell_data=None):
    """A VTU in text. `kind` is VTK's number of the cell."""
    array = lambda name, kind, values, parts=1: (
        f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{parts}" format="ascii">'
        + " ".join(map(str, values))
        + "</DataArray>"
    )
    data = lambda tag, given: f"<{tag}>" + "".join(array(n, k, v) for n, k, v in given or []) + f"</{tag}>"
    ends = [sum(len(cell) for cell in cells[: place + 1]) for place in range(len(cells))]
    path.write_text(
        '<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">'
        f'<UnstructuredGrid><Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">'
        + data("PointData", point_data)
        + data("CellData", cell_data)
        + "<Points>" + array("Points", "Float64", [repr(x) for point in points for x in point], 3) + "</Points>"
        + "<Cells>" + array("connectivity", "Int64", [node for cell in cells for node in cell])
        + array("offsets", "Int64", ends) + array("types", "UInt8", [kind] * len(cells))
        + "</Cells></Piece></UnstructuredGrid></VTKFile>\n"
    )


def write_meshes(folder, height, cells):
    """The column and its four sides."""
    width = height / cells
    ends = [height * row / cells for row in range(cells + 1)]
    numbers, points = {}, []

    def node(x, y):
        if (x, y) not in numbers:
            numbers[x, y] = len(points)
            points.append((x, y, 0.0))
        return numbers[x, y]

    for y in ends:  # OpenGeoSys wants the corners first
        node(0.0, y), node(width, y)
    sides = {"left": [], "right": []}
    elements = []
    for low, high in zip(ends, ends[1:]):
        middle = 0.5 * (low + high)
        corners = [node(0.0, low), node(width, low), node(width, high), node(0.0, high)]
        between = [node(width / 2, low), node(width, middle), node(width / 2, high), node(0.0, middle)]
        elements.append(corners + between)
        sides["left"].append([corners[0], corners[3], between[3]])
        sides["right"].append([corners[1], corners[2], between[1]])
    write_mesh(folder / "bulk.vtu", points, elements, 23, cell_data=[("MaterialIDs", "Int32", [0] * cells)])
    sides["bottom"] = [[node(0.0, 0.0), node(width, 0.0), node(width / 2, 0.0)]]
    sides["top"] = [[node(0.0, height), node(width, height), node(width / 2, height)]]
    owners = {"left": range(cells), "right": range(cells), "bottom": [0], "top": [cells - 1]}
    for name, lines in sides.items():
        own = sorted({number for line in lines for number in line})
        local = {number: place for place, number in enumerate(own)}
        write_mesh(
            folder / f"{name}.vtu",
            [points[number] for number in own],
            [[local[number] for number in line] for line in lines],
            21,
            point_data=[("bulk_node_ids", "UInt64", own)],
            cell_data=[("bulk_element_ids", "UInt64", owners[name])],
        )


def write_project(folder, case):
    """The template with the numbers of the case."""
    soil, derived = case["material"], case["derived"]
    steps = round(case["times"][-1] / case["time_step"])
    step = case["times"][-1] / steps
    values = {
        "YOUNGS_MODULUS": soil["youngs_modulus"],
        "POISSONS_RATIO": soil["poissons_ratio"],
        "POROSITY": soil["porosity"],
        "WATER_DENSITY": soil["water_density"],
        "GRAIN_DENSITY": soil["grain_density"],
        "COMPRESSIBILITY": 1 / soil["water_bulk_modulus"],
        "VISCOSITY": VISCOSITY,
        "PERMEABILITY": soil["hydraulic_conductivity"] / derived["unit_weight_of_water"] * VISCOSITY,
        "LOAD": -case["column"]["load"],
        "STEPS": steps,
        "STEP": step,
        "END": case["times"][-1],
    }
    text = (pathlib.Path(__file__).parent / "ogs_column.prj").read_text()
    for name, value in values.items():
        text = text.replace(f"@{name}@", repr(value))
    text = text.replace("@TIMES@", " ".join(map(repr, case["times"])))
    (folder / "column.prj").write_text(text)


if __name__ == "__main__":
    case, folder = json.loads(pathlib.Path(sys.argv[1]).read_text()), pathlib.Path(sys.argv[2])
    ogs = program()
    write_meshes(folder, case["column"]["height"], case["cells"])
    write_project(folder, case)
    sys.exit(subprocess.run([ogs, "column.prj", "-o", "."], cwd=folder).returncode)
