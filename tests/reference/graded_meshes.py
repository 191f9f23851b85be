#!/usr/bin/env python3
"""Do graded meshes earn their place? Prints what docs/cost.md says of them. Plain Python, half a minute.

A frozen column with one pressure a cell and hats at the nodes is a chain of cells: the strain of a cell follows its
pressure, and between neighbours water flows by the difference of their pressures over half the sum of their heights,
to the drained surface over half the last one. On equal cells this is what `GIMP-SRI` solves in one dimension. Here
heights shrink towards the surface by a constant factor, `grading` is the largest over the smallest. Two stages of
SDIRK2 a step, steps that grow by half a percent, load at once. Errors are relative L2 of the pressure at two points a
cell, on lines through the centres of neighbouring cells, against Terzaghi's series.
"""
import math

SDIRK = 1.0 - math.sqrt(0.5)
GROWTH = 0.005
TIMES = [0.005, 0.05, 0.2, 1.0]


def heights(cells, grading):
    """Cell heights from the base to the drained surface, of a column of one."""
    factor = grading ** (-1.0 / (cells - 1))
    raw = [factor**i for i in range(cells)]
    return [h / sum(raw) for h in raw]


def exact(depth, t):
    """Terzaghi's pressure over the load at a relative depth below the drained surface."""
    total, m = 0.0, 0
    while True:
        k = math.pi * (m + 0.5)
        decay = math.exp(-k * k * t)
        total += 2.0 / k * math.sin(k * depth) * decay
        m += 1
        if decay < 1e-17:
            return total


def rates(pressure, conductances, h):
    """Rates of the pressures of the cells."""
    flows = [0.0] + [c * (below - above) for c, below, above in zip(conductances, pressure, pressure[1:] + [0.0])]
    return [(inflow - outflow) / height for inflow, outflow, height in zip(flows, flows[1:], h)]


def solved(right, conductances, h, step):
    """Solves `(I - step A) x = right` by elimination along the chain."""
    count = len(h)
    lower = [0.0] + conductances[:-1]
    diagonal = [1.0 + step * (lower[i] + conductances[i]) / h[i] for i in range(count)]
    x = list(right)
    for i in range(1, count):
        factor = -step * lower[i] / h[i] / diagonal[i - 1]
        diagonal[i] -= factor * (-step * conductances[i - 1] / h[i - 1])
        x[i] -= factor * x[i - 1]
    x[-1] /= diagonal[-1]
    for i in range(count - 2, -1, -1):
        x[i] = (x[i] + step * conductances[i] / h[i] * x[i + 1]) / diagonal[i]
    return x


def run(cells, grading):
    """Errors at the times."""
    h = heights(cells, grading)
    conductances = [2.0 / (a + b) for a, b in zip(h, h[1:])] + [2.0 / h[-1]]
    pressure, t, errors = [1.0] * cells, 0.0, []
    step = 1e-6
    for end in TIMES:
        while t < end * (1.0 - 1e-12):
            step = min(max(step, GROWTH * t), end - t)
            stage = solved(rates(pressure, conductances, h), conductances, h, SDIRK * step)
            middle = [p + (1.0 - SDIRK) * step * k for p, k in zip(pressure, stage)]
            second = solved(rates(middle, conductances, h), conductances, h, SDIRK * step)
            pressure = [p + step * ((1.0 - SDIRK) * a + SDIRK * b) for p, a, b in zip(pressure, stage, second)]
            t += step
            step = max(1e-6, GROWTH * t)
        errors.append(error(pressure, h, end))
    return errors


def error(pressure, h, t):
    """Relative L2 error at two points a cell."""
    faces = [sum(h[:i]) for i in range(len(h) + 1)]
    centres = [0.5 * (a + b) for a, b in zip(faces, faces[1:])]
    off, size = 0.0, 0.0
    for cell, height in enumerate(h):
        for side in (-0.25, 0.25):
            place = centres[cell] + side * height
            other = cell - 1 if (side < 0 and cell > 0) or cell == len(h) - 1 else cell + 1
            slope = (pressure[other] - pressure[cell]) / (centres[other] - centres[cell])
            known = exact(1.0 - place, t)
            off += 0.5 * height * (pressure[cell] + slope * (place - centres[cell]) - known) ** 2
            size += 0.5 * height * known**2
    return math.sqrt(off / size)


def main():
    print("cells grading  explicit work  error of p at T_v = " + ", ".join(f"{t:g}" for t in TIMES))
    for grading in (1.0, 2.0, 4.0, 8.0):
        for cells in (10, 20, 40, 80):
            smallest = min(heights(cells, grading))
            # Explicit steps follow the time that a wave takes through the smallest cell.
            work = cells / smallest / 100.0
            print(f"{cells:5} {grading:7g} {work:14.1f}  " + "  ".join(f"{e:.2e}" for e in run(cells, grading)))


if __name__ == "__main__":
    main()
