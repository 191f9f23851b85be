"""A solver of one's own, and the test that holds it: cell by cell, as a notebook would."""

# %% A solver: finite differences in space, implicit in time, for a column that drains at its top.
import oedometer

HEIGHT, MODULUS, POISSON, CONDUCTIVITY, UNIT_WEIGHT = 1.0, 1.0e6, 0.25, 1.0e-4, 9810.0
CONFINED = MODULUS * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON))
SPREAD = CONDUCTIVITY * CONFINED / UNIT_WEIGHT  # m²/s


def consolidated(cells, end, load=1.0):
    """Pressures (Pa) at the centres of equal cells from the base up, at a time (s)."""
    steps = 4 * cells * cells
    share = SPREAD * (end / steps) / (HEIGHT / cells) ** 2
    pressure = [load] * cells
    for _ in range(steps):
        # (1 + 2 r) p_i − r (p_{i−1} + p_{i+1}) = p_i before; no flow at the base, no pressure at the top.
        diagonal = [1 + share] + [1 + 2 * share] * (cells - 2) + [1 + 3 * share]
        for cell in range(1, cells):
            factor = -share / diagonal[cell - 1]
            diagonal[cell] += factor * share
            pressure[cell] -= factor * pressure[cell - 1]
        pressure[-1] /= diagonal[-1]
        for cell in reversed(range(cells - 1)):
            pressure[cell] = (pressure[cell] + share * pressure[cell + 1]) / diagonal[cell]
    return pressure


# %% The exact solution at the same places.
TIME_FACTOR = 0.2
END = TIME_FACTOR * HEIGHT**2 / SPREAD
exact = oedometer.exact("terzaghi-incompressible", TIME_FACTOR, [0.05, 0.5, 0.95])
print("exact pressures at three depths:", [round(float(value), 4) for value in exact.pressure])

# %% Its error on three meshes.
LEVELS = (5, 10, 20)
errors = []
for cells in LEVELS:
    heights = [HEIGHT * (cell + 0.5) / cells for cell in range(cells)]
    score = oedometer.score(
        "terzaghi",
        time=[END],
        height=heights,
        pressure=[consolidated(cells, END)],
        sample="centres",
        reference="terzaghi-incompressible",
    )
    errors.append(score.error("pressure", TIME_FACTOR))
    print(f"{cells} cells: {errors[-1]:.3e}", *score.warnings, *score.diagnosis)

# %% How it converges, and the test that a change must pass.
sizes = [HEIGHT / cells for cells in LEVELS]
found = oedometer.convergence(sizes, errors)
print(f"{found.kind}, order {found.order:.2f}: {found.reason}")
oedometer.assert_converges(sizes, errors, order=2.0, minus=0.2, plus=0.2, at=(0.1, 5e-3))
