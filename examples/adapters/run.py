#!/usr/bin/env python3
"""Installs other people's programs from PyPI, runs the studies beside this file with them, and prints one table.

    python3 examples/adapters/run.py [NAME …] [--environments DIR] [--oedometer PROGRAM] [--wrong-k] [--write]

Each program has an environment of its own in DIR (default target/adapters). `--write` keeps the table of all programs, where all is
met, as results.csv, which the report of oedometer shows. `--wrong-k` lets OpenGeoSys take a conductivity 2 % too large and expects to see it caught.
"""

import argparse
import csv
import datetime
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import venv

HERE = pathlib.Path(__file__).resolve().parent
KRATOS = (  # PoromechanicsApplication imports FluidDynamics and does not bring it
    "KratosMultiphysics KratosGeoMechanicsApplication KratosPoromechanicsApplication KratosFluidDynamicsApplication"
)
PROGRAMS = {  # folder: packages, studies
    "scikit-fem": ("scikit-fem", ["scikit-fem"]),
    "opengeosys": ("ogs", ["opengeosys", "layers"]),
    "kratos": (KRATOS, ["kratos"]),
    "opensees": ("openseespy", ["opensees"]),
    "ngsolve": ("ngsolve", ["ngsolve"]),
}
Q2P1 = "mixed elements Q2–P1"
EULER = "backward Euler, steps of 0.1 h²/H² in T_v"
NODES = "corner nodes"
SOLVERS = {  # solver of a study: what it is, samples, time scheme
    "scikit-fem": (Q2P1, NODES, "SDIRK2 with steps that grow by 5 %"),
    "scikit-fem-euler": (Q2P1, NODES, EULER),
    "ogs": (Q2P1, NODES, EULER),
    "kratos": (Q2P1, NODES, EULER),
    "kratos-poromechanics": ("elements Q1–Q1 with finite increment calculus", NODES, EULER),
    "opensees": ("elements 9_4_QuadUP", NODES, EULER),
    "ngsolve": ("mixed elements Q2–RT0–P0", "cell centres", EULER),
}
TIMES = [0.05, 0.2, 1.0]


def environment(folder, packages):
    """Folder of the programs of an environment, which is made where it is missing."""
    if not folder.is_dir():
        venv.create(folder, with_pip=True)
    programs = folder / "bin"
    subprocess.run([programs / "python", "-m", "pip", "install", "--quiet", *packages.split()], check=True)
    return programs


def solved(study, programs, arguments):
    """Runs and checks a study; whether all is met, and what the check says."""

    def called(verb):
        path = f"{programs}{os.pathsep}{os.environ['PATH']}"
        command = [arguments.oedometer, verb, study, "--allow-solvers", "--jobs", "1"]
        told = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
        return subprocess.run(command, cwd=arguments.out, env={**os.environ, "PATH": path}, **told)

    called("run")
    checked = called("check")
    return checked.returncode == 0, checked.stdout


def rows_of(study, arguments):
    """A row for each solver and mesh of a study."""
    folder = arguments.out / "out" / study
    coarser = None
    printed = subprocess.run([arguments.oedometer, "records", folder, "--format", "json"], stdout=subprocess.PIPE, check=True)
    records = {record["hash"]: record for record in json.loads(printed.stdout)}
    for (solver, cells), case in sorted(cases_of(folder / f"{study}.csv").items()):
        record = records[case["hash"]]
        errors = {time: case["pressure", time] for time in TIMES}
        order = ""
        if coarser and coarser[0] == solver:
            order = f"{math.log(coarser[2] / errors[0.05]) / math.log(cells / coarser[1]):.2f}"
        coarser = solver, cells, errors[0.05]
        yield {
            "program": record["attached"]["version"],
            "what it is": SOLVERS[solver][0],
            "cells": cells,
            "samples": SOLVERS[solver][1],
            "time scheme": SOLVERS[solver][2],
            **{f"error at T_v={time:g}": f"{error:.3e}" for time, error in errors.items()},
            "order at T_v=0.05": order,
            "settlement error at T_v=0.05": f"{case['settlement', 0.05]:+.2e}",
            # Processor time counts the start of the program too, its own time grows with the load of the machine.
            "seconds": f"{min(min(one['cpu_seconds'], one['own_seconds']) for one in record['wall']):.3g}",
            "measured on": datetime.date.today().isoformat(),
        }


def cases_of(table):
    """Errors of pressure and settlement by solver and cells."""
    cases = {}
    with open(table) as rows:
        for row in csv.DictReader(rows):
            if (row["quantity"], row["norm"]) in [("pressure", "l2"), ("settlement", "relative")]:
                case = cases.setdefault((row["method"], int(row["cells"])), {"hash": row["case"]})
                case[row["quantity"], float(row["time_factor"])] = float(row["value"])
    return cases


def wrong_k_is_caught(programs, arguments):
    """Whether a conductivity that is 2 % too large is refused, and named."""
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(shutil.copytree(HERE / "opengeosys", pathlib.Path(folder) / "opengeosys"))
        shutil.copytree(HERE / "golden", pathlib.Path(folder) / "golden")
        adapter = copy / "adapter.py"
        right = 'soil["hydraulic_conductivity"]'
        text = adapter.read_text()
        assert text.count(right) == 1
        adapter.write_text(text.replace(right, f"1.02 * {right}"))
        arguments.out = pathlib.Path(folder)
        is_met, told = solved(copy / "opengeosys.toml", programs, arguments)
        print(told)
        return not is_met and "is k 1.02e-4 m/s for 1e-4" in " ".join(told.split())


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(PROGRAMS)}")
    arguments.add_argument("--environments", type=pathlib.Path, default=HERE.parent.parent / "target/adapters")
    arguments.add_argument("--oedometer", default="oedometer")
    arguments.add_argument("--wrong-k", action="store_true")
    arguments.add_argument("--write", action="store_true")
    arguments = arguments.parse_args()
    arguments.out = arguments.environments.resolve()
    arguments.out.mkdir(parents=True, exist_ok=True)
    if arguments.wrong_k:
        packages = PROGRAMS["opengeosys"][0]
        caught = wrong_k_is_caught(environment(arguments.out / "opengeosys", packages), arguments)
        sys.exit("a k that is off by 2 % was not caught" if not caught else 0)
    rows, all_met = [], True
    for name in arguments.names or PROGRAMS:
        packages, studies = PROGRAMS[name]
        programs = environment(arguments.out / name, packages)
        for study in studies:
            is_met, told = solved(HERE / name / f"{study}.toml", programs, arguments)
            all_met &= is_met
            print(f"{study}: {'met' if is_met else told}", flush=True)
            if study != "layers":
                rows += rows_of(study, arguments)
    print(*rows[0], sep=" | ")
    for row in rows:
        print(*row.values(), sep=" | ")
    if arguments.write and all_met and not arguments.names:
        with open(HERE / "results.csv", "w", newline="") as table:
            writer = csv.DictWriter(table, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    sys.exit(not all_met)


if __name__ == "__main__":
    main()
