#!/usr/bin/env python3
"""Writes cosine_layer.csv: amplitudes of the cosine-loaded layer (mpmath, two-point problem by the matrix
exponential in as many digits as its boundary layers need, fixed Talbot inversion with 32 nodes).

Seed material, height 1 m. Columns: length, base, water, time factor (0: undrained start, inf: drained end),
depth, amplitudes of u_x, u_z (down) and p, all per unit load. Needs: pip install mpmath.
"""
import csv
import os

import mpmath as mp

mp.mp.dps = 40
HERE = os.path.dirname(os.path.abspath(__file__))
E, NU, N0, KW = mp.mpf("1e6"), mp.mpf("0.25"), mp.mpf("0.3"), mp.mpf("2.2e9")
K, GW, H = mp.mpf("1e-4"), mp.mpf(9810), mp.mpf(1)
G = E / (2 * (1 + NU))
LAM = E * NU / ((1 + NU) * (1 - 2 * NU))
MO = LAM + 2 * G
KAP = K / GW


def elastic(z, length, rough, lam):
    """Layer without flow: states u_x, u_z, tau, sigma; returns u_x, u_z, volume strain."""
    b, m = mp.pi / length, lam + 2 * G
    w = [-lam * b / m, 0, 0, 1 / m]
    a = mp.matrix([[0, b, 1 / G, 0], w, [0] * 4, [0, 0, -b, 0]])
    # d(tau)/dz = b^2 M u_x + b lam du_z/dz, with sigma_xx = M b u_x + lam du_z/dz.
    for j in range(4):
        a[2, j] = b * lam * w[j]
    a[2, 0] += b * b * m
    sc = [1 / MO, 1 / MO, 1, 1]
    a = mp.matrix([[a[i, j] * sc[j] / sc[i] for j in range(4)] for i in range(4)])
    eh, ez = mp.expm(a * H), mp.expm(a * z) if z else mp.eye(4)
    rows = [1, 0 if rough else 2]
    s, r = mp.matrix(2, 2), mp.matrix(2, 1)
    for i, row in enumerate(rows):
        for j, col in enumerate([0, 1]):
            s[i, j] = eh[row, col]
        r[i] = eh[row, 3]
    x = mp.lu_solve(s, r)
    v = ez * mp.matrix([x[0], x[1], 0, -1])
    ux, uz, sig = v[0] * sc[0], v[1] * sc[1], v[3]
    return ux, uz, b * ux + (-lam * b / m * ux + sig / m)


def transform(s, z, length, rough, storage):
    b = mp.pi / length
    sc = [1 / MO, 1 / MO, 1, 1, 1, KAP]
    a = mp.zeros(6)
    w = [-LAM * b / MO, 0, 1 / MO, 0, 1 / MO, 0]
    a[0, 1], a[0, 3], a[2, 5], a[4, 3] = b, 1 / G, -1 / KAP, -b
    for j in range(6):
        a[1, j], a[3, j], a[5, j] = w[j], b * LAM * w[j], -s * w[j]
    a[3, 0] += b * b * MO
    a[3, 2] -= b
    a[5, 0] -= s * b
    a[5, 2] -= KAP * b * b + s * storage
    m = mp.matrix([[a[i, j] * sc[j] / sc[i] for j in range(6)] for i in range(6)])
    eh, ez = mp.expm(m * H), mp.expm(m * z) if z else mp.eye(6)
    rows, unknown = [1, 5, 0 if rough else 3], [0, 1, 5]
    lhs, rhs = mp.matrix(3, 3), mp.matrix(3, 1)
    for i, row in enumerate(rows):
        for j, col in enumerate(unknown):
            lhs[i, j] = eh[row, col]
        rhs[i] = eh[row, 4] / s
    x = mp.lu_solve(lhs, rhs)
    y = mp.matrix(6, 1)
    y[4] = -1 / s
    for j, col in enumerate(unknown):
        y[col] = x[j]
    v = ez * y
    return [v[i] * sc[i] for i in range(3)]


def layer(z, time_factor, length, rough, compressible):
    storage = N0 / KW if compressible else mp.mpf(0)
    if time_factor == 0:
        coupling = KW / N0 if compressible else mp.mpf(10) ** 30
        ux, uz, strain = elastic(z, length, rough, LAM + coupling)
        return [ux, uz, -coupling * strain]
    if time_factor == mp.inf:
        return [*elastic(z, length, rough, LAM)[:2], mp.mpf(0)]
    t = time_factor / (KAP * MO)
    n, old = 32, mp.mp.dps
    r = mp.mpf(2) * n / (5 * t)
    decay = mp.sqrt(r * (1 / MO + storage) / KAP) * H
    mp.mp.dps = 40 + int(2 * decay / mp.log(10))
    out = [mp.re(f) * mp.exp(r * t) / 2 for f in transform(r, z, length, rough, storage)]
    for k in range(1, n):
        th = k * mp.pi / n
        cot = mp.cot(th)
        s, sig = r * th * (cot + 1j), th + (th * cot - 1) * cot
        e = mp.exp(t * s) * (1 + 1j * sig)
        out = [o + mp.re(e * g) for o, g in zip(out, transform(s, z, length, rough, storage))]
    mp.mp.dps = old
    return [o * r / n for o in out]


if __name__ == "__main__":
    with open(os.path.join(HERE, "cosine_layer.csv"), "w", newline="") as f:
        w = csv.writer(f, lineterminator="\n")
        w.writerow("length base water time_factor depth ux_per_load uz_per_load p_over_load".split())
        cases = [("1", r, c, t, z) for r in (0, 1) for c in (0, 1) for t in ("0", "0.005", "0.05", "0.2", "inf")
                 for z in ("0", "0.25", "0.5", "1")]
        cases += [(length, r, c, t, z) for length, c in (("0.25", 0), ("4", 1), ("30", 1)) for r in (0, 1)
                  for t in ("0", "0.001", "0.02", "1", "inf") for z in ("0.0625", "0.75")]
        for length, rough, compressible, t, z in cases:
            a = layer(mp.mpf(z), mp.mpf(t), mp.mpf(length), rough, compressible)
            w.writerow([length, "rough" if rough else "smooth", "compressible" if compressible else "incompressible",
                        t, z, *[mp.nstr(v, 17) for v in a]])
            f.flush()
