"""Writes reference.csv: gyrostats with wheels at constant relative momentum, at times up to 1e9 s.

    python3 tests/data/gyrostat/generate.py        (python 3.11, mpmath 1.3; some minutes)

    m' = m x w,   q' = q o (0, w)/2,   w = (m - h)/I       q scalar first, active, body to space; m = I w + h

No closed form is used. One period P of m is integrated by Taylor series of order 90 in integers with a fixed point of 280
bits, up to the return of m to its start, which Newton's method finds. Over a period the body turns about L = q m q* by an
angle F, so that at t = n P + r the attitude is the turn by n F about L after the attitude at r. Before a scenario is written
energy, |m|, |q| and L have kept 60 digits over the period, and m has come back to 55.
The quaternion is the continuous lift from its start, so its sign is definite.
"""

import csv
import random
from math import frexp
from pathlib import Path

from mpmath import atan2, cos, floor, mp, mpf, nstr, sin, sqrt

mp.dps = 84
HERE = Path(__file__).parent
BITS, ORDER, STEP = 280, 90, mpf("0.2")
ONE = 1 << BITS
COLUMNS = "scenario,regime,I1,I2,I3,h1,h2,h3,s1,s2,s3,q0w,q0x,q0y,q0z,t,m1,m2,m3,qw,qx,qy,qz".split(",")


def multiply(p, q):
    a, b, c, d = p
    e, f, g, h = q
    return [
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    ]


def conjugate(q):
    return [q[0], -q[1], -q[2], -q[3]]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def norm(v):
    return sqrt(dot(v, v))


def rotate(q, v):
    return multiply(multiply(q, [0, *v]), conjugate(q))[1:]


def fixed(x):
    return int(floor(x * ONE + mpf("0.5")))


class Series:
    """m and q over one step, as polynomials of x in [0, 1], in units of the fixed point."""

    def __init__(self, per_step, h, m, q):
        # per_step: step over moments
        M = [[x] for x in m]
        Q = [[x] for x in q]
        W = [[((m[k] - h[k]) * per_step[k]) >> BITS] for k in range(3)]
        for j in range(ORDER):
            r = range(j + 1)
            w = [[W[k][j - i] for i in r] for k in range(3)]
            new = []
            for k in range(3):
                a, b = (k + 1) % 3, (k + 2) % 3
                new.append((sum(map(int.__mul__, M[a], w[b])) - sum(map(int.__mul__, M[b], w[a]))) // (j + 1) >> BITS)
            p = lambda c, k: sum(map(int.__mul__, Q[c], w[k]))
            rate = [
                -p(1, 0) - p(2, 1) - p(3, 2),
                p(0, 0) + p(2, 2) - p(3, 1),
                p(0, 1) - p(1, 2) + p(3, 0),
                p(0, 2) + p(1, 1) - p(2, 0),
            ]
            for c in range(4):
                Q[c].append(rate[c] // (2 * j + 2) >> BITS)
            for k in range(3):
                M[k].append(new[k])
                W[k].append((new[k] * per_step[k]) >> BITS)
        self.M, self.Q = M, Q

    def at(self, x, of):
        x = fixed(x)
        out = []
        for c in of:
            s = 0
            for a in reversed(c):
                s = (s * x >> BITS) + a
            out.append(s)
        return out

    def rate(self, x):
        return self.at(x, [[j * a for j, a in enumerate(c)][1:] for c in self.M])


class Motion:
    def __init__(self, moments, h, m, q):
        self.unit = mpf(2) ** frexp(float(max(max(map(abs, m)), max(map(abs, h)))))[1]
        self.I, self.h, self.m, self.q = ([mpf(x) for x in v] for v in (moments, h, m, q))
        self.omega = [(a - b) / i for a, b, i in zip(self.m, self.h, self.I)]
        self.L = rotate(self.q, self.m)
        self.is_steady = not any(cross(self.m, self.omega))
        if not self.is_steady:
            self.integrate()

    def integrate(self):
        rate = max(max(abs(x) for x in self.m + self.h) / i for i in self.I)
        self.dt = STEP / rate
        per_step = [fixed(self.dt * self.unit / i) for i in self.I]
        h = [fixed(x / self.unit) for x in self.h]
        m = m0 = [fixed(x / self.unit) for x in self.m]
        q = [fixed(x) for x in self.q]
        self.steps = []
        before = None
        while True:
            series = Series(per_step, h, m, q)
            self.steps.append(series)
            if before is None:
                toward = series.rate(mpf(0))
            section = lambda x: dot([a - b for a, b in zip(series.at(x, series.M), m0)], toward)
            after = section(mpf(1))
            if before is not None and before < 0 <= after:
                x = mpf(-before) / (after - before)
                for _ in range(9):
                    x -= mpf(section(x)) / dot(series.rate(x), toward)
                m1 = series.at(x, series.M)
                if max(abs(a - b) for a, b in zip(m1, m0)) < ONE >> 120:
                    break
            before = after if before is not None else -1 if after < 0 else 1
            m, q = series.at(mpf(1), series.M), series.at(mpf(1), series.Q)
        self.period = self.dt * (len(self.steps) - 1 + x)
        back = max(abs(mpf(a - b)) for a, b in zip(m1, m0)) / ONE
        assert back < mpf(10) ** -55, nstr(back)
        q = [mpf(a) / ONE for a in series.at(x, series.Q)]
        turn = multiply(q, conjugate(self.q))
        G = norm(self.L)
        self.half_twist = atan2(dot(turn[1:], self.L) / G, turn[0])
        assert norm(cross(turn[1:], self.L)) / G < mpf(10) ** -55
        for x in (mpf("0.3"), mpf(1)):
            self.check([mpf(a) / ONE * self.unit for a in self.steps[-1].at(x, series.M)],
                       [mpf(a) / ONE for a in self.steps[-1].at(x, series.Q)])

    def check(self, m, q):
        energy = lambda m: sum((a - b) ** 2 / i for a, b, i in zip(m, self.h, self.I))
        G = norm(self.L)
        assert abs(energy(m) - energy(self.m)) < mpf(10) ** -60 * (energy(m) + max(G * G / i for i in self.I))
        assert abs(dot(q, q) - dot(self.q, self.q)) < mpf(10) ** -60
        assert norm([a - b for a, b in zip(rotate(q, m), self.L)]) < mpf(10) ** -60 * G

    def at(self, t):
        t = mpf(t)
        if self.is_steady:
            rate = norm(self.omega)
            if rate == 0:
                return self.m, self.q
            s = sin(rate * t / 2) / rate
            return self.m, multiply(self.q, [cos(rate * t / 2), *(w * s for w in self.omega)])
        n = floor(t / self.period)
        r = (t - n * self.period) / self.dt
        k = min(int(floor(r)), len(self.steps) - 1)
        series = self.steps[k]
        m = [mpf(a) / ONE * self.unit for a in series.at(r - k, series.M)]
        q = [mpf(a) / ONE for a in series.at(r - k, series.Q)]
        G = norm(self.L)
        turn = [cos(n * self.half_twist), *(x / G * sin(n * self.half_twist) for x in self.L)]
        q = multiply(turn, q)
        self.check(m, q)
        return m, q


# --- scenarios --------------------------------------------------------------------------------------------------


def saddle(I, h, m):
    """An unstable steady spin in doubles, by descent along the line of H on |m| = G from the start m: a zero of m x w."""
    G = norm([mpf(x) for x in m])
    m = [mpf(x) for x in m]

    def off(m):
        return cross(m, [(a - b) / i for a, b, i in zip(m, h, I)])

    for _ in range(60):
        # Newton in three unknowns with |m| = G, in the least squares
        f = off(m) + [(dot(m, m) - G * G) / 2]
        rows = []
        for k in range(3):
            e = [mpf(j == k) for j in range(3)]
            a = cross(e, [(x - y) / i for x, y, i in zip(m, h, I)])
            b = cross(m, [x / i for x, i in zip(e, I)])
            rows.append([x + y for x, y in zip(a, b)] + [m[k]])
        A = mp.matrix(rows).T
        step = mp.lu_solve(A.T * A, -(A.T * mp.matrix(f)))
        m = [x + y for x, y in zip(m, step)]
    return [float(x) for x in m]


def scenarios():
    one = (1.0, 0.0, 0.0, 0.0)
    tilted = (0.5, -0.5, 0.1, 0.7)
    tri = (1.0, 1.75, 2.25)
    yield "generic", "one oval", tri, (0.3, -0.2, 0.5), (0.7, 1.1, -0.4), one
    yield "strong wheel", "one oval", (1.5, 1.0, 2.0), (1.5, 0.75, -1.0), (0.2, -0.9, 1.2), tilted
    yield "weak wheel", "two ovals", (2.0, 1.25, 1.6), (0.05, 0.02, -0.04), (1.0, -0.8, 0.7), tilted
    yield "two ovals", "two ovals", (2.25, 1.0, 1.75), (0.1, 0.2, 0.05), (0.2, 1.9, 0.3), one
    yield "axial smallest", "axial", tri, (0.6, 0.0, 0.0), (0.9, 0.8, 0.5), one
    yield "axial middle", "axial", tri, (0.0, -0.4, 0.0), (0.3, 0.8, 1.1), tilted
    yield "axial largest", "axial", (1.0, 1.5, 2.0), (0.0, 0.0, 0.75), (0.9, 0.1, 0.6), one
    yield "plane start", "plane", (1.0, 1.5, 2.0), (0.25, 0.0, 0.75), (0.9, 0.0, 0.6), one
    yield "symmetric with the wheel off its axis", "symmetric", (1.5, 1.5, 1.0), (0.3, 0.1, 0.4), (0.6, -0.9, 0.8), one
    yield "symmetric with the wheel on its axis", "elementary", (1.5, 1.5, 1.0), (0.0, 0.0, 0.7), (0.6, -0.9, 0.8), tilted
    yield "ball", "elementary", (1.25, 1.25, 1.25), (0.3, -0.4, 0.2), (0.6, 0.9, 0.8), one
    yield "almost a ball", "almost symmetric", (1.25, 1.25 + 2.0**-30, 1.25 - 2.0**-31), (0.3, -0.4, 0.2), (0.6, 0.9, 0.8), one
    yield "almost symmetric", "almost symmetric", (1.5, 1.5 + 2.0**-40, 1.0), (0.0, 2.0**-33, 0.7), (0.6, -0.9, 0.8), one
    yield "free", "free", tri, (0.0, 0.0, 0.0), (0.4, 1.75, -0.9), one
    yield "faint wheel", "faint wheel", tri, (2.0**-40, -(2.0**-38), 2.0**-39), (0.4, 1.75, -0.9), one
    yield "fast wheel", "fast wheel", tri, (800.0, -500.0, 300.0), (801.0, -498.5, 301.25), tilted
    yield "rod", "rod", (0.015625, 1.0, 1.0009765625), (0.0078125, 0.25, -0.125), (0.0125, 0.6, -0.5), one
    yield "molecule", "scale", tuple(x * 2.0**-150 for x in tri), tuple(x * 2.0**-110 for x in (0.3, -0.2, 0.5)), tuple(x * 2.0**-110 for x in (0.7, 1.1, -0.4)), one
    stable = saddle(tri, (0.3, -0.2, 0.5), (0.1, -0.2, 2.0))
    for k in (10, 20, 30, 36):
        off = (2.0**-k, -(2.0**-k) / 2, 0.0)
        yield f"near a stable spin 2^-{k}", "near steady", tri, (0.3, -0.2, 0.5), tuple(a + b for a, b in zip(stable, off)), one
    unstable = saddle(tri, (0.1, -0.2, 0.05), (0.1, 1.0, 0.2))
    for k in (3, 6, 9, 12):
        off = (2.0**-k, -(2.0**-k) / 2, 2.0**-k / 3)
        yield f"near the separatrix 2^-{k}", "near separatrix", tri, (0.1, -0.2, 0.05), tuple(a + b for a, b in zip(unstable, off)), one
    yield "steady spin along the wheel", "steady", tri, (0.0, 0.5, 0.0), (0.0, 1.25, 0.0), tilted
    yield "at rest", "steady", tri, (0.5, 0.25, 0.125), (0.5, 0.25, 0.125), tilted
    yield "no momentum", "steady", tri, (0.5, 0.25, 0.125), (0.0, 0.0, 0.0), one


def main():
    random.seed(1899)
    rows = []
    for name, regime, I, h, s, q in scenarios():
        size = sqrt(sum(mpf(x) ** 2 for x in q))
        motion = Motion(I, h, s, [mpf(x) / size for x in q])
        print(name, "" if motion.is_steady else "period " + nstr(motion.period, 8), flush=True)
        fast = max(max(map(abs, s)), max(map(abs, h))) / min(I)
        unit = 2.0 ** -round(float(mp.log(fast, 2)))
        for decade in (0, 1, 2, 4, 6, 8, 9):
            t = random.uniform(0.1, 1.0) * 10**decade * unit
            t = -t if decade in (2, 6) else t
            m, out = motion.at(t)
            rows.append([name, regime, *map(repr, I), *map(repr, h), *map(repr, s), *(nstr(mpf(x) / size, 42) for x in q), repr(t),
                         *(nstr(x, 42) for x in m), *(nstr(x, 42) for x in out)])
    with open(HERE / "reference.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows)
    print(len(rows), "states")


if __name__ == "__main__":
    main()
