#!/usr/bin/env python3
"""Writes dynamic_ramp.csv: the column with inertia under a load that grows, by its modes (mpmath, 60 digits).

Each mode is the first-order system of four unknowns of its own, solved by the roots of its characteristic
polynomial; its departure from steady growth, added to that growth in closed form, cancels many digits,
of which there are enough. Seed material, height 1 m, load 1 Pa. Columns: conductivity, duration of the
growth, time, height over the base, displacements of solid and water, pressure.
Needs: pip install mpmath.
"""
import csv
import os

import mpmath as mp

mp.mp.dps = 60
HERE = os.path.dirname(os.path.abspath(__file__))
# Doubles, as the program reads them.
N, RS, RW, G, E, NU, KW = map(mp.mpf, (0.3, 2650.0, 1000.0, 9.81, 1e6, 0.25, 2.2e9))
MOD, Q = E * (1 - NU) / ((1 + NU) * (1 - 2 * NU)), KW / N
MS, MW = (1 - N) * RS, N * RW


def mode(j, k, duration, time):
    """Solid and psi = (1-n) u + n U of mode j: response from rest to a force that grows, less steady growth."""
    m = (j + mp.mpf(1) / 2) * mp.pi
    d = N * N * RW * G / k
    kss, ksw, kww = m**2 * (MOD + Q * (1 - N) ** 2), m**2 * Q * N * (1 - N), m**2 * Q * N**2
    # det [[MS s2 + d s + kss, ksw - d s], [ksw - d s, MW s2 + d s + kww]]
    poly = [MS * MW, (MS + MW) * d, MS * kww + MW * kss, d * (kss + kww + 2 * ksw), kss * kww - ksw**2]
    roots = mp.polyroots(poly, maxsteps=400, extraprec=200)
    force = (-1) ** (j + 1) * mp.mpf(2) / duration
    out = [mp.mpf(0), mp.mpf(0)]
    for a, s in enumerate(roots):
        slope = MS * MW
        for b, other in enumerate(roots):
            if b != a:
                slope *= s - other
        solid = (MW * s * s + d * s + kww) / slope
        water = -(ksw - d * s) / slope
        psi = (1 - N) * solid + N * water
        growth = mp.exp(s * time)
        if time > duration:
            growth -= mp.exp(s * (time - duration))
        for i, v in enumerate((solid, psi)):
            out[i] += mp.re(v * growth * force / (s * s))
    return m, out, max(abs(mp.re(v)) for v in out)


def steady(y, k, duration, time):
    if time > duration:
        return -y / MOD, mp.mpf(0), mp.mpf(0)
    slope = RW * G / (k * MOD * duration)
    pressure, impulse = slope * (1 - y * y) / 2, slope * y * (mp.mpf(1) / 2 - y * y / 6)
    return -y * time / duration / MOD + impulse / MOD, -impulse / Q, pressure


def rows(k, duration, time, heights):
    modes, j = [], 0
    while True:
        m, (solid, psi), _ = mode(j, k, duration, time)
        modes.append((m, solid, psi))
        size = m * max(Q * abs(psi), MOD * abs(solid))
        if size * (j + 1) < mp.mpf(10) ** -22 and j > 3:
            break
        j += 1
        if j > 1500:
            raise ValueError(f"modes do not end: {k} {duration} {time}: {mp.nstr(size, 5)}")
    for y in heights:
        solid, psi, pressure = steady(y, k, duration, time)
        for m, a, b in modes:
            solid, psi = solid + a * mp.sin(m * y), psi + b * mp.sin(m * y)
            pressure -= Q * b * m * mp.cos(m * y)
        yield solid, (psi - (1 - N) * solid) / N, pressure


if __name__ == "__main__":
    with open(os.path.join(HERE, "dynamic_ramp.csv"), "w", newline="") as f:
        w = csv.writer(f, lineterminator="\n")
        w.writerow("conductivity duration time height u_solid u_water pressure".split())
        cases = [
            (1e-4, 1.0, (0.5, 1.0, 1.5, 3.0)), (1e-4, 0.1, (0.05, 0.1, 0.125, 0.3)),
            (1e-4, 2e-3, (0.05, 1.0)), (1e-4, 1e-6, (0.05, 1.0)), (1e-4, 1e-9, (0.05,)),
            (1e-5, 0.2, (0.1, 0.2, 0.25)), (1e-5, 20.0, (10.0, 20.0, 50.0)),
            (1e-3, 0.5, (0.3, 0.5, 0.75)), (1e-3, 1e-5, (0.5, 3.0)), (1e-2, 3.0, (2.0, 3.0, 4.0)),
        ]
        heights = [mp.mpf(y) for y in (0.0, 0.25, 0.75, 0.984375, 1.0)]
        for k, duration, times in cases:
            for time in times:
                try:
                    found = list(rows(mp.mpf(k), mp.mpf(duration), mp.mpf(time), heights))
                except ValueError as error:
                    print(error)
                    continue
                for y, values in zip(heights, found):
                    w.writerow([k, duration, time, mp.nstr(y, 10), *[mp.nstr(v, 20) for v in values]])
                f.flush()
                print(k, duration, time, len(found))
