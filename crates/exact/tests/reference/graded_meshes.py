#!/usr/bin/env python3
"""Do graded meshes earn their place? Terzaghi's column, loaded at once, on cells that shrink toward the drained surface.

    crates/exact/tests/reference/graded_meshes.py

The frozen operators of `GIMP-SRI` between linear displacements and one pressure a cell: a node's drag is that of the half
cells around it, `w_i = (p_below - p_above)/d_i`, and a cell loses what leaves it, `h_c p_c' = w_below - w_above`
(c_v = q = H = 1, incompressible water, no inertia). An L-stable method of second order takes steps of half a per cent of
the time, so that what is left is the cells'. Sizes follow a geometric series, the smallest at the drained surface; `ratio`
is the largest over the smallest. Errors are relative, L2 over the column, of lines through the pressures of neighbouring
cells, as a patch reads them.

Work is cells times steps. Implicit steps do not know the cells; an explicit step may last as long as a wave needs
through the smallest cell. `gain` is the error of a uniform mesh of equal work over the error, from its second order.
Needs Python alone, and seconds.
"""

import math

TIMES = [0.005, 0.05, 0.2, 1.0]
RATIOS = [1, 2, 4, 8]
CELLS = [10, 20, 40, 80]
GROWTH = 0.005
FIRST = 1e-8
# Alexander's L-stable method of two stages.
STAGE = 1.0 - math.sqrt(0.5)


def cells_of(count, ratio):
    """Sizes from the base up to the drained surface."""
    sizes = [ratio ** (-number / (count - 1)) for number in range(count)]
    whole = sum(sizes)
    return [size / whole for size in sizes]


def exact(depth, time):
    """Terzaghi's pressure at a depth below the drained surface."""
    if time < 0.02:
        root = 2.0 * math.sqrt(time)
        return math.erf(depth / root) - math.erfc((2.0 - depth) / root) + math.erfc((2.0 + depth) / root)
    total = 0.0
    for mode in range(60):
        wave = math.pi * (mode + 0.5)
        total += 2.0 / wave * math.sin(wave * depth) * math.exp(-wave * wave * time)
    return total


def rates_of(sizes):
    """Bands of `p' = A p`: below, own and above."""
    count = len(sizes)
    below, own, above = [0.0] * count, [0.0] * count, [0.0] * count
    for cell, size in enumerate(sizes):
        if cell > 0:
            below[cell] = 2.0 / ((size + sizes[cell - 1]) * size)
        up = size + sizes[cell + 1] if cell + 1 < count else size
        above[cell] = 2.0 / (up * size)
        own[cell] = -below[cell] - above[cell]
    above[-1] = 0.0
    return below, own, above


def stage_rate(bands, pressures, step):
    """`k` of `k = A (p + step k)`."""
    below, own, above = bands
    count = len(own)
    right = []
    for cell in range(count):
        rate = own[cell] * pressures[cell]
        if cell > 0:
            rate += below[cell] * pressures[cell - 1]
        if cell + 1 < count:
            rate += above[cell] * pressures[cell + 1]
        right.append(rate)
    factors = [0.0] * count
    for cell in range(count):
        pivot, value = 1.0 - step * own[cell], right[cell]
        if cell > 0:
            pivot += step * below[cell] * factors[cell - 1]
            value += step * below[cell] * right[cell - 1]
        factors[cell] = -step * above[cell] / pivot
        right[cell] = value / pivot
    for cell in range(count - 2, -1, -1):
        right[cell] -= factors[cell] * right[cell + 1]
    return right


def solve(sizes):
    """Pressures of the cells at each of the times."""
    bands, pressures, time, out = rates_of(sizes), [1.0] * len(sizes), 0.0, []
    for end in TIMES:
        while time < end - 1e-14:
            step = min(max(FIRST, GROWTH * time), end - time)
            first = stage_rate(bands, pressures, STAGE * step)
            middle = [p + (1.0 - STAGE) * step * k for p, k in zip(pressures, first)]
            second = stage_rate(bands, middle, STAGE * step)
            pressures = [m + STAGE * step * k for m, k in zip(middle, second)]
            time += step
        out.append(pressures)
    return out


def error_of(sizes, pressures, time):
    """Relative L2 error of lines through the pressures of neighbouring cells."""
    edges = [0.0]
    for size in sizes:
        edges.append(edges[-1] + size)
    centres = [0.5 * (low + high) for low, high in zip(edges, edges[1:])]
    missed = whole = 0.0
    for cell, size in enumerate(sizes):
        lower, upper = max(cell - 1, 0), min(cell + 1, len(sizes) - 1)
        slope = (pressures[upper] - pressures[lower]) / (centres[upper] - centres[lower])
        for part in range(8):
            apart = size * ((part + 0.5) / 8.0 - 0.5)
            truth = exact(1.0 - centres[cell] - apart, time)
            missed += size * (pressures[cell] + slope * apart - truth) ** 2
            whole += size * truth**2
    return math.sqrt(missed / whole)


def main():
    errors, smallest = {}, {}
    for ratio in RATIOS:
        for count in CELLS:
            sizes = cells_of(count, ratio)
            smallest[ratio, count] = min(sizes)
            found = solve(sizes)
            errors[ratio, count] = [error_of(sizes, *one) for one in zip(found, TIMES)]
    for number, time in enumerate(TIMES):
        print(f"T_v = {time}: errors on {CELLS} cells, gain at equal work on the finest two, implicit and explicit")
        for ratio in RATIOS:
            row = [errors[ratio, count][number] for count in CELLS]
            gains = []
            for count in CELLS[-2:]:
                implicit = errors[1, count][number] / errors[ratio, count][number]
                # N/h_min steps and cells for N^2; the square root in cells, and the square of that in error.
                gains.append((implicit, implicit * count * smallest[ratio, count]))
            told = "  ".join(f"{implicit:.2f} {explicit:.2f}" for implicit, explicit in gains)
            print(f"  ratio {ratio}: " + " ".join(f"{error:.2e}" for error in row) + f"   {told}")


if __name__ == "__main__":
    main()
