#!/usr/bin/env python3
"""Writes released_waves.csv: columns let go from a mode, whose waves run for up to 1e9 radians (mpmath, 60 digits).

The one mode is a system of two oscillators, solved by the residues of its transform. Soils of any conductivity on a column
of 0.7 m under 3 Pa: inputs are the doubles that the program reads, and the time is theirs too. Columns: start, conductivity,
bulk modulus of the water, time factor, relative depth, pressure over the load, displacement of the solid over that of the
start.
Needs: pip install mpmath.
"""
import csv
import os

import mpmath as mp

mp.mp.dps = 60
HERE = os.path.dirname(os.path.abspath(__file__))
N, RS, RW, G, E, NU, H, LOAD = map(mp.mpf, (0.35, 2700.0, 1020.0, 9.7, 2.5e6, 0.2, 0.7, 3.0))
MOD = E * (1 - NU) / ((1 + NU) * (1 - 2 * NU))
M = mp.pi / 2 / H
MS, MW = (1 - N) * RS, N * RW


def state(start, k, kw, time_factor):
    """Solid and water of the mode, and the solid at the start."""
    q = kw / N
    time = time_factor * H * H * RW * G / (k * MOD)
    d = N * N * RW * G / k
    kss, ksw, kww = M**2 * (MOD + q * (1 - N) ** 2), M**2 * q * N * (1 - N), M**2 * q * N**2
    if start == "standing-wave":
        u = w = -LOAD / (q * M)
        v = vw = mp.mpf(0)
    else:
        u, psi = LOAD / (MOD * M), -LOAD / (q * M)
        w = (psi - (1 - N) * u) / N
        discharge = M * k * LOAD / (RW * G)
        v = -q / (q + MOD) * discharge
        vw = v + discharge / N
    poly = [MS * MW, (MS + MW) * d, MS * kww + MW * kss, d * (kss + kww + 2 * ksw), kss * kww - ksw**2]
    roots = mp.polyroots(poly, maxsteps=2000, extraprec=600)
    found = [mp.mpf(0), mp.mpf(0)]
    for a, s in enumerate(roots):
        slope = MS * MW
        for b, other in enumerate(roots):
            if b != a:
                slope *= s - other
        fs = MS * (s * u + v) + d * (u - w)
        fw = MW * (s * w + vw) - d * (u - w)
        solid = ((MW * s * s + d * s + kww) * fs - (ksw - d * s) * fw) / slope
        water = ((MS * s * s + d * s + kss) * fw - (ksw - d * s) * fs) / slope
        for i, value in enumerate((solid, water)):
            found[i] += mp.re(value * mp.exp(s * time))
    return found, u, q


with open(os.path.join(HERE, "released_waves.csv"), "w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(["start", "conductivity", "water_bulk_modulus", "time_factor", "zeta", "p_over_q", "solid_over_start"])
    for start in ("standing-wave", "dynamic-single-mode"):
        for k in (1e-12, 1e-9, 1e-6, 1e-3):
            for kw in (2.2e9, 3.3e7):
                for time_factor in (1e-9, 1e-6, 1e-3):
                    (solid, water), u, q = state(start, mp.mpf(k), mp.mpf(kw), mp.mpf(time_factor))
                    for zeta in (mp.mpf(0.3), mp.mpf(1.0)):
                        y = H * (1 - zeta)
                        pressure = -q * M * mp.cos(M * y) * ((1 - N) * solid + N * water) / LOAD
                        moved = (solid - u) * mp.sin(M * y) / u
                        row = [start, repr(k), repr(kw), repr(time_factor), mp.nstr(zeta, 3)]
                        out.writerow(row + [mp.nstr(pressure, 20), mp.nstr(moved, 20)])
