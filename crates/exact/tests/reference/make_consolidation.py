#!/usr/bin/env python3
"""Writes consolidation.csv and inverse.csv: independent values of Terzaghi's functions (mpmath, 60 digits).

W by its sine series; below T = 1e-3, where that needs thousands of terms, by the Poisson-summed
image series. The two are compared at every point where both are affordable. Arguments are the exact
values of the printed doubles. Needs: pip install mpmath.
"""
import csv
import os
import random

import mpmath as mp

mp.mp.dps = 60
HERE = os.path.dirname(os.path.abspath(__file__))
CUT = mp.mpf(10) ** -50


def modes(zeta, t):
    w = integral = u = mp.mpf(0)
    j = 0
    while True:
        m = (j + mp.mpf(1) / 2) * mp.pi
        e = mp.exp(-m * m * t)
        w += 2 / m * mp.sin(m * zeta) * e
        integral += 2 / m ** 2 * mp.cos(m * zeta) * e
        u += 2 / m ** 2 * e
        j += 1
        if e < CUT:
            return w, integral, 1 - u


def ierfc(x):
    return mp.exp(-x * x) / mp.sqrt(mp.pi) - x * mp.erfc(x)


def images(zeta, t):
    a = 2 * mp.sqrt(t)
    w, integral, u = mp.mpf(1), 1 - zeta, 1 / mp.sqrt(mp.pi)
    m = 0
    while True:
        s = (-1) ** m
        w -= s * (mp.erfc((2 * m + zeta) / a) + mp.erfc((2 * m + 2 - zeta) / a))
        integral -= s * a * (ierfc((2 * m + zeta) / a) - ierfc((2 * m + 2 - zeta) / a))
        u -= 2 * s * ierfc((m + 1) / mp.sqrt(t))
        m += 1
        if mp.exp(-((2 * m) / a) ** 2) < CUT:
            return w, integral, a * u


def exact(zeta, t):
    zeta, t = mp.mpf(zeta), mp.mpf(t)
    if t < mp.mpf("1e-3"):
        return images(zeta, t)
    value = modes(zeta, t)
    for x, y in zip(value, images(zeta, t) if t < 5 else value):
        assert abs(x - y) < mp.mpf(10) ** -40, (zeta, t)
    return value


def degree(t):
    return exact(0.0, t)[2]


if __name__ == "__main__":
    random.seed(20210119)
    near = [0.2 * (1 + s * 10.0 ** -k) for s in (-1, 1) for k in (1, 3, 6, 12, 15)]
    times = [1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.2, *near, 0.3, 1.0, 3.0, 10.0, 30.0]
    depths = [0.0, 1e-9, 1e-4, 0.003, 0.1, 0.37, 0.5, 0.9, 0.999, 1.0]
    points = [(z, t) for t in times for z in depths]
    for _ in range(300):
        t = 10.0 ** random.uniform(-8, 1)
        points.append((random.random(), t))
        points.append((min(1.0, random.expovariate(1.0) * t ** 0.5), t))
    with open(os.path.join(HERE, "consolidation.csv"), "w", newline="") as f:
        w = csv.writer(f, lineterminator="\n")
        w.writerow(["zeta", "time_factor", "isochrone", "isochrone_integral", "degree"])
        for z, t in points:
            w.writerow([repr(z), repr(t), *[mp.nstr(v, 20) for v in exact(z, t)]])
    with open(os.path.join(HERE, "inverse.csv"), "w", newline="") as f:
        w = csv.writer(f, lineterminator="\n")
        w.writerow(["degree", "time_factor"])
        degrees = [1e-12, 1e-6, 1e-3, 0.01, 0.1, 0.3, 0.5, 0.5040, 0.50408, 0.50410, 0.51, 0.6, 0.7, 0.9, 0.95, 0.99,
                   0.999, 1 - 1e-6, 1 - 1e-9, 1 - 2.0 ** -53]
        for u in degrees + [random.random() for _ in range(40)]:
            target = mp.mpf(u)
            if u < 0.5:
                start = mp.pi * target ** 2 / 4
            else:
                start = -4 / mp.pi ** 2 * mp.log((1 - target) * mp.pi ** 2 / 8)
            f_of_s = lambda s: mp.log(degree(mp.exp(s)) / target) if u < 0.5 else mp.log((1 - degree(mp.exp(s))) / (1 - target))
            root = mp.exp(mp.findroot(f_of_s, (mp.log(start), mp.log(start) + mp.mpf("1e-6")), tol=1e-60))
            w.writerow([repr(u), mp.nstr(root, 20)])
