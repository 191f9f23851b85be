"""Whole programs in turn: least `wall_seconds` of the runs of benches/README.md, as a Markdown table.

    python3 benches/programs.py 9 old=/path/to/oedometer new=target/release/oedometer

Least of so many rounds, of the largest run a third as many; the last columns are the time of the last program over that of each
other one.
"""

import json
import subprocess
import sys

COLUMN = "xie-leo --method GC-SRI-patch --integrator explicit --time-factor 0.001 --set integrator.drag=implicit"
COLUMN += " --points-per-cell 4 --time-step stable=0.4"
LAYER = "cosine-layer --method GIMP-SRI-patch --integrator implicit --time-factor 0.1 --time-step seconds=0.1635"
RUNS = {
    "moving points on a line": f"{COLUMN} --cells 40",
    "moving points in the plane": f"{COLUMN} --cells 10 --set column.dimensions=2",
    "vortex, with the search for its critical step": "manufactured-vortex --method GIMP-SRI-patch --integrator explicit"
    " --cells 16 --points-per-cell 2 --time-factor 0.375 --time-step stable=0.4",
    "implicit at large strain": "xie-leo --method TL-GC-SRI-patch --integrator implicit --cells 40 --points-per-cell 4"
    " --time-factor 0.2 --set material.porosity=0.68 --time-step growth=0.05",
    "fixed points": "terzaghi --method GC-SRI-patch --integrator explicit --cells 10 --points-per-cell 4"
    " --time-factor 0.03 --time-step stable=0.4",
    "layer of 64 × 64 cells, 50 steps": f"{LAYER} --cells 64",
    "layer of 128 × 128 cells, 50 steps": f"{LAYER} --cells 128",
}


def wall_seconds(binary, run):
    try:
        done = subprocess.run([binary, "solve", *run.split(), "--format", "json"], capture_output=True, text=True)
    except OSError as error:
        sys.exit(f"{binary}: {error.strerror}")
    if done.returncode != 0:
        sys.exit(f"{binary} solve {run}: {done.stderr.strip()}")
    return json.loads(done.stdout)["wall_seconds"]


def shown(seconds):
    return f"{seconds:.2f} s" if seconds >= 1.0 else f"{1e3 * seconds:.3g} ms"


def main(rounds, *programs):
    programs = dict(program.split("=", 1) for program in programs)
    *others, last = programs
    print("| run |", " | ".join([*programs, *(f"{last} of {other}" for other in others)]), "|")
    print("| :-- |" + " --: |" * (2 * len(programs) - 1))
    for name, run in RUNS.items():
        turns = int(rounds) if run != f"{LAYER} --cells 128" else -(-int(rounds) // 3)
        least = dict.fromkeys(programs, float("inf"))
        for _ in range(turns):
            for program, binary in programs.items():
                least[program] = min(least[program], wall_seconds(binary, run))
        cells = [*map(shown, least.values()), *(f"{least[last] / least[other]:.2f}" for other in others)]
        print(f"| {name} |", " | ".join(cells), "|", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 3 or not sys.argv[1].isdigit() or not all("=" in program for program in sys.argv[2:]):
        sys.exit(__doc__)
    main(*sys.argv[1:])
