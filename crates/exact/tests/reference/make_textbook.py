"""Values of the textbook problems to 40 digits, by other ways than crates/exact/src/textbook: transforms inverted on Talbot's
contour, quadratures, and integration of the differential equations. Prints textbook.csv.

Columns: problem, case, time factor T_v, depth zeta, then over the load p and sigma', over m_v q H the displacement u and
the settlement s. The soil of every case is the default one of ColumnParameters but for what CASES changes."""
import csv
import sys
from functools import lru_cache
from mpmath import mp, mpf, mpc, pi, sqrt, exp, log, sinh, cosh, quad, invertlaplace, odefun, besseli, besselk
from mpmath import euler, workdps

mp.dps = 40
DEGREE = 60
CASES = {
    'default': {},
    'soft': dict(Kw='6e5'),
    'biot': dict(alpha='0.8', Ks='3e6', Kw='2e6'),
    'stiff-grains': dict(Ks='2.5e6'),
    'wide-drain': dict(drain='0.5'),
    'slow-wave': dict(period='600', Kw='2e6', alpha='0.7'),
    'small-load': dict(initial='50'),
}


class Soil:
    def __init__(self, case):
        given = CASES[case]
        E, nu, n, gw, k = mpf('1e6'), mpf('0.25'), mpf('0.3'), 1000 * mpf('9.81'), mpf('1e-4')
        Kw = mpf(given.get('Kw', '2.2e9'))
        self.G, self.K = E / 2 / (1 + nu), E / 3 / (1 - 2 * nu)
        self.Eo = self.K + 4 * self.G / 3
        Ks = mpf(given['Ks']) if 'Ks' in given else None
        if 'alpha' in given:
            self.alpha = mpf(given['alpha'])
            Ks = Ks or (self.K / (1 - self.alpha))
        else:
            self.alpha = 1 - self.K / Ks if Ks else mpf(1)
        self.M = 1 / (n / Kw + ((self.alpha - n) / Ks if Ks else 0))
        self.kap = k / gw
        self.cv = self.kap * self.Eo
        self.drain = mpf(given.get('drain', '0.05'))
        self.period = mpf(given.get('period', '10'))
        self.initial = mpf(given.get('initial', '1'))


def invert(f, t):
    return invertlaplace(f, t, method='talbot', degree=DEGREE)


def biot_column(s, t, z):
    """Equilibrium and storage in the Laplace domain; the base is at z = 1 (H = q = 1)."""
    S = 1 / s.M + s.alpha ** 2 / s.Eo
    p0 = s.alpha / s.Eo / S
    P = lambda w, y: p0 / w * (1 - cosh(sqrt(w * S / s.kap) * y) / cosh(sqrt(w * S / s.kap)))
    I = lambda w, y: p0 / w * (y - sinh(sqrt(w * S / s.kap) * y) / sqrt(w * S / s.kap) / cosh(sqrt(w * S / s.kap)))
    y = 1 - z
    p = invert(lambda w: P(w, y), t)
    u = lambda y: -(y - s.alpha * invert(lambda w: I(w, y), t))
    return p, s.alpha * p - 1, u(y), -u(mpf(1))


def cryer(s, t, z):
    """Unknown constants from p = 0 and sigma_rr = -1 at r = 1, in the Laplace domain."""
    S = 1 / s.M + s.alpha ** 2 / s.Eo
    r = 1 - z
    def fields(w, r):
        m = sqrt(w * S / s.kap)
        # P = A sinh(mr)/r + D; balance: w (S P + alpha C/Eo) = kap (P'' + 2P'/r)  =>  S D = -alpha C/Eo
        # u = (1/r^2) int r^2 (alpha P + C)/Eo;  sigma_rr = C - 4 G u/r
        J = lambda r: (m * r * cosh(m * r) - sinh(m * r)) / m ** 2      # int r sinh(mr)
        C = mpf(1)
        D = -s.alpha * C / s.Eo / S
        A = -D / sinh(m)
        u = lambda r: (s.alpha * (A * J(r) + D * r ** 3 / 3) + C * r ** 3 / 3) / s.Eo / r ** 2
        scale = -1 / w / (C - 4 * s.G * u(mpf(1)))
        p = A * (sinh(m * r) / r if r else m) + D
        ur = u(r) if r else mpf(0)
        strain = u(r) / r if r else (s.alpha * p + C) / s.Eo / 3
        return [scale * v for v in (p, C - 4 * s.G * strain + s.alpha * p, ur * s.Eo)]
    p, st, u = [invert(lambda w: fields(w, r)[i], t) for i in range(3)]
    return p, st, u, -invert(lambda w: fields(w, mpf(1))[2], t)


def barron(s, t, z):
    """Equal strain: the flux that an even strain rate drives, its mean by quadrature, and the rate that follows."""
    rw, re = s.drain, s.drain + 1
    # p' = (rate/(2 kap)) (re^2/r - r)
    shape = lambda r: quad(lambda x: (re ** 2 / x - x) / 2 / s.kap, [rw, r])
    area = (re ** 2 - rw ** 2) / 2
    # int_rw^re r shape(r) dr, by parts once: the outer integral of the flux through what lies outside of it
    mean = quad(lambda x: (re ** 2 / x - x) / 2 / s.kap * (re ** 2 - x ** 2) / 2, [rw, re]) / area
    ubar = exp(-s.Eo * t / mean)
    return ubar * shape(rw + z) / mean, ubar - 1, -(1 - ubar), 1 - ubar


@lru_cache(maxsize=None)
def bessel(z):
    """I0, I1, K0, K1: K0 by its ascending series with the digits that it cancels, K1 from the Wronskian."""
    if abs(z) > 120:
        return besseli(0, z), besseli(1, z), besselk(0, z), besselk(1, z)
    with workdps(mp.dps + 20 + int(abs(z))):
        square, term, harmonic, first, second, k = z * z / 4, mpf(1), mpf(0), mpf(1), mpf(0), 0
        while abs(term) > mpf(10) ** -mp.dps:
            k += 1
            term *= square / k ** 2
            harmonic += mpf(1) / k
            first, second = first + term, second + term * harmonic
        k0 = second - (log(z / 2) + euler) * first
        i1 = besseli(1, z)
        return first, i1, k0, (1 / z - i1 * k0) / first


def barron_free(s, t, z):
    rw, re, r = s.drain, s.drain + 1, s.drain + z
    def at(w, r):
        m = sqrt(w / s.cv)
        (i0, i1, k0, k1), (_, outer_i1, _, outer_k1) = bessel(m * r), bessel(m * re)
        return i0 * outer_k1 + k0 * outer_i1, (k1 * outer_i1 - i1 * outer_k1) / m
    P = lambda w, r: (1 - at(w, r)[0] / at(w, rw)[0]) / w
    mean = lambda w: (1 - rw * at(w, rw)[1] / at(w, rw)[0] * 2 / (re ** 2 - rw ** 2)) / w
    p = invert(lambda w: P(w, r), t) if z else mpf(0)
    ubar = invert(mean, t)
    return p, p - 1, p - 1, 1 - ubar


def seabed(s, t, z):
    """The complex amplitude from the base up, by Taylor steps of the differential equation: P, P', int P."""
    S = 1 / s.M + s.alpha ** 2 / s.Eo
    omega = 2 * pi / s.period
    # kap P'' = i omega (S P - alpha/Eo)
    right = lambda y, v: [v[1], mpc(0, 1) * omega / s.kap * (S * v[0] - s.alpha / s.Eo * v[3]), v[0], mpc(0)]
    # v[3] is the share of the forced part: 1, or 0 for the free one.
    forced = odefun(right, 0, [mpc(0), mpc(0), mpc(0), mpc(1)])
    free = odefun(right, 0, [mpc(1), mpc(0), mpc(0), mpc(0)])
    a = (1 - forced(1)[0]) / free(1)[0]
    turn = exp(mpc(0, 1) * omega * t)
    at = lambda y: [((f + a * g) * turn).real for f, g in zip(forced(y), free(y))]
    y = 1 - z
    p, _, within, _ = at(y)
    u = lambda y, within: -(y * turn.real - s.alpha * within)
    return p, s.alpha * p - turn.real, u(y, within), -u(mpf(1), at(mpf(1))[2])


def injection(s, t, z):
    """Instantaneous sources summed over time; displacement by inversion of its transform."""
    S = 1 / s.M + s.alpha ** 2 / s.Eo
    c = s.kap / S
    rate = 4 * pi * s.kap
    r = 1 - z
    # tau = r^2/(4 c x^2)
    p = quad(lambda x: rate / S * (4 * pi * c * r ** 2 / (4 * c * x ** 2)) ** mpf('-1.5') * exp(-x ** 2)
             * r ** 2 / (2 * c * x ** 3), [r / (2 * sqrt(c * t)), 1 + r / (2 * sqrt(c * t)), 4 + r / (2 * sqrt(c * t)), mp.inf])
    def U(w, r):
        m = sqrt(w * S / s.kap)
        return s.alpha / s.Eo / r ** 2 * rate / (4 * pi * s.kap * w) * (1 - (1 + m * r) * exp(-m * r)) / m ** 2
    u = lambda r: invert(lambda w: U(w, r), t) * s.Eo
    return p, s.alpha * p - 4 * s.G / s.Eo * u(r) / r, u(r), -u(mpf(1))


def davis_raymond(s, t, z):
    """w = ln(sigma'/sigma'_f) diffuses; strain by quadrature of its inverse."""
    start, end = s.initial, s.initial + 1
    w0 = log(start / end)
    W = lambda y: invert(lambda w: w0 / w * (1 - cosh(sqrt(w / s.cv) * y) / cosh(sqrt(w / s.cv))), t)
    Wint = lambda y: invert(lambda w: w0 / w * (y - sinh(sqrt(w / s.cv) * y) / sqrt(w / s.cv) / cosh(sqrt(w / s.cv))), t)
    sig = end * exp(W(1 - z))
    # strain: (start/Eo) ln(sigma'/start)
    u = lambda y: -start * (Wint(y) + y * log(end / start))
    return end - sig, -sig, u(1 - z), -u(mpf(1))


PROBLEMS = [
    ('biot-column', biot_column, ('default', 'biot', 'stiff-grains'), True),
    ('cryer', cryer, ('default', 'soft', 'biot', 'stiff-grains'), True),
    ('barron', barron, ('default', 'wide-drain'), True),
    ('barron-free-strain', barron_free, ('default', 'wide-drain'), True),
    ('seabed', seabed, ('default', 'soft', 'slow-wave'), True),
    ('injection', injection, ('default', 'biot', 'soft'), False),
    ('davis-raymond', davis_raymond, ('default', 'small-load'), True),
]

if __name__ == '__main__':
    out = csv.writer(sys.stdout, lineterminator='\n')
    out.writerow(['problem', 'case', 'time_factor', 'zeta', 'pressure', 'stress', 'displacement', 'settlement'])
    for name, fields, cases, has_end in PROBLEMS:
        for case in cases:
            soil = Soil(case)
            for T in ('0.001', '0.02', '0.1', '0.5', '2'):
                for z in ('0.1', '0.5', '0.9', '1') if has_end else ('0', '0.1', '0.5', '0.9'):
                    values = fields(soil, mpf(T) / soil.cv, mpf(z))
                    out.writerow([name, case, T, z] + [mp.nstr(v, 20, strip_zeros=False) for v in values])
            print(name, case, file=sys.stderr)
