"""Writes reference.csv, brink.csv and experiments/data/free_body.csv: the exact torque-free rigid body.

    python3 tests/data/free_body/generate.py        (python 3.11, mpmath 1.3)

    m' = m x w,   q' = q o (0, w)/2,   w = m/I       q scalar first, active, body to space

The closed form below (Jacobi functions for m, Carlson's integrals for the twist about the axis that m never
leaves) is evaluated with 160 digits and more, so that the cancellation next to the separatrix is exact in the
doubles given and phases of 10^12 rad keep their digits. Before a row is written
 - every scenario is compared with a Taylor integration (taylor.py) to 40 digits after about 13 rad, both ways;
 - every scenario is continued from its own state at the last time but one to the last (group law, 40 digits);
 - the values of published and tabulated problems are reproduced to the digits they were given with.
The quaternion is the continuous lift from its start, so its sign is definite.
"""

import csv
import random
import sys
from math import nextafter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from mpmath import mp, mpf, atan2, cos, elliprf, elliprj, log10, nint, pi, sin, sqrt, tanh

from taylor import taylor

mp.dps = 160
HERE = Path(__file__).parent
COLUMNS = "scenario,regime,I1,I2,I3,start,s1,s2,s3,q0w,q0x,q0y,q0z,t,m1,m2,m3,qw,qx,qy,qz".split(",")
ONE = (1.0, 0.0, 0.0, 0.0)


# --- the motion -------------------------------------------------------------------------------------------------


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


def norm(v):
    return sqrt(sum(a * a for a in v))


def jacobi(u, mc):
    """sn, cn, dn of u for the complementary parameter mc = 1 - k^2, by the descending Gauss transformation."""
    if mc == 0:
        return tanh(u), mp.sech(u), mp.sech(u)
    levels = []
    a, b = mpf(1), sqrt(mc)
    while True:
        a, b, c = (a + b) / 2, sqrt(a * b), (a - b) / 2
        levels.append((a, c))
        if abs(c) < mp.eps * a:
            break
    angle = 2 ** len(levels) * a * u
    for a, c in reversed(levels):
        angle = (angle + mp.asin(c / a * sin(angle))) / 2
    sn, cn = sin(angle), cos(angle)
    return sn, cn, sqrt(mc + (1 - mc) * cn * cn)


class Motion:
    def __init__(self, moments, m, q):
        self.m, self.q = list(m), list(q)
        I = self.I = list(moments)
        l, mu, h = sorted(range(3), key=lambda i: I[i])
        square = [a * a for a in m]
        G = self.G = sqrt(sum(square))
        self.energy2 = sum(a / b for a, b in zip(square, I))
        delta_l = square[mu] * (I[mu] - I[l]) / I[mu] + square[h] * (I[h] - I[l]) / I[h]
        delta_h = -square[l] * (I[h] - I[l]) / I[l] - square[mu] * (I[h] - I[mu]) / I[mu]
        # Products of doubles, exact at this precision: an exact zero is the separatrix itself.
        delta_mu = (square[h] * I[l] * (I[h] - I[mu]) - square[l] * I[h] * (I[mu] - I[l])) / (I[l] * I[h])
        omega = [a / b for a, b in zip(m, I)]
        turning = [m[j] * m[k] * (I[j] - I[k]) for j, k in ((1, 2), (2, 0), (0, 1))]
        self.spin = not any(turning)
        if self.spin:
            return
        if delta_mu <= 0:
            a, b, c = l, mu, h
            da, dc, den = delta_l, delta_h, delta_h * (I[mu] - I[l])
        else:
            a, b, c = h, mu, l
            da, dc, den = delta_h, delta_l, delta_l * (I[h] - I[mu])
        self.axes = a, b, c
        Ia, Ib, Ic = I[a], I[b], I[c]
        self.even = 1 if (a, b, c) in ((0, 1, 2), (1, 2, 0), (2, 0, 1)) else -1
        self.side = 1 if m[a] > 0 else -1
        A = self.A = sqrt(Ia * dc / (Ia - Ic))
        B = self.B = sqrt(Ib * da / (Ib - Ia))
        C = self.C = sqrt(Ic * da / (Ic - Ia))
        self.k2 = da * (Ic - Ib) / (-dc * (Ib - Ia))
        self.mc = delta_mu * (I[h] - I[l]) / den
        self.n = -Ia * (Ic - Ib) / (Ic * (Ib - Ia))
        self.rate = self.even * (Ic - Ia) / (Ia * Ic) * self.side * A * C / B
        x, y = m[b] / B, m[c] / C
        r = sqrt(x * x + y * y)
        x, y, self.turns = x / r, y / r, 0
        if y < 0:
            x, y, self.turns = -x, -y, 1
        self.start = x, y
        self.phase = self.half = mpf(0)
        if self.mc:
            self.half = 2 * elliprf(0, self.mc, 1)
            self.phase = self.half * self.turns
        self.phase += x * elliprf(y * y, self.mc + self.k2 * y * y, 1)

    def at(self, t):
        if self.spin:
            if not any(self.m):
                return self.m, self.q
            angle = self.energy2 / self.G * t
            turn = [cos(angle / 2)] + [sin(angle / 2) * a / self.G for a in self.m]
            return self.m, multiply(self.q, turn)
        a, b, c = self.axes
        u = self.phase + self.rate * t
        turns = int(nint(u / self.half)) if self.mc else self.turns
        u -= self.half * turns
        sn, cn, dn = jacobi(u, self.mc)
        flip = -1 if turns % 2 else 1
        m = [None] * 3
        m[a], m[b], m[c] = self.side * self.A * dn, flip * self.B * sn, flip * self.C * cn
        # The twist's integral of the third kind and its elementary companion.
        n, halves = self.n, turns - self.turns

        def incomplete(x, y):
            return x**3 * elliprj(y * y, self.mc + self.k2 * y * y, 1, 1 - n * x * x)

        third = incomplete(sn, cn) - incomplete(*self.start)
        if halves:
            third += 2 * halves * elliprj(0, self.mc, 1, 1 - n)
        third *= self.G * self.B / (self.A * self.C) * n / 3
        x, y = self.start
        angle = pi * halves + atan2(self.B * sn, self.C * cn) - atan2(self.B * x, self.C * y)
        twist = self.G * t / self.I[c] - self.even * self.side * (third - angle)
        axis = [mpf(0)] * 3
        axis[a] = mpf(self.side)
        turn = [cos(twist / 2)] + [sin(twist / 2) * e for e in axis]
        q = multiply(multiply(multiply(self.q, conjugate(self.swing(self.m))), turn), self.swing(m))
        return m, q

    def swing(self, m):
        """Turn that takes m to the axis it circulates about."""
        a = self.axes[0]
        p = [mpf(0)] * 4
        p[0] = self.G + self.side * m[a]
        j, k = (a + 1) % 3, (a + 2) % 3
        p[1 + j], p[1 + k] = self.side * m[k], -self.side * m[j]
        r = norm(p)
        return [x / r for x in p]


# --- scenarios --------------------------------------------------------------------------------------------------


class Scenario:
    def __init__(self, name, regime, moments, start, data, times, attitude):
        self.name, self.regime, self.start, self.times = name, regime, start, times
        self.moments, self.data, self.attitude = moments, data, attitude
        for x in [*moments, *data, *attitude, *times]:
            assert isinstance(x, float)
        small, middle, large = sorted(mpf(a) for a in moments)
        self.body = small > 0 and large <= small + middle

    def motion(self):
        moments = [mpf(a) for a in self.moments]
        data = [mpf(a) for a in self.data]
        m = [a * b for a, b in zip(moments, data)] if self.start == "omega" else data
        q = [mpf(a) for a in self.attitude]
        r = norm(q)
        return Motion(moments, m, [a / r for a in q])


def omega(name, regime, moments, w, times, attitude=ONE):
    return Scenario(name, regime, tuple(moments), "omega", tuple(w), tuple(times), attitude)


def momentum(name, regime, moments, m, times, attitude=ONE):
    return Scenario(name, regime, tuple(moments), "momentum", tuple(m), tuple(times), attitude)


TILTED = (0.5, -0.3, 0.7, 0.1)
ORDERS = ((0, 1, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0), (0, 2, 1), (1, 0, 2))
LONG = (0.37, 10.0, -1.0, 1e3, 1e6, 1e9)
SOME = (1.0, 1e3, 1e6, 1e9)


def place(values, order):
    """Puts the first, second, third value on the axes named by order."""
    out = [0.0] * 3
    for value, axis in zip(values, order):
        out[axis] = value
    return out


def scenarios():
    generic = (0.6, 0.8, 1.0)
    for order in ORDERS:
        label = "".join(str(i + 1) for i in order)
        body = place(generic, order)
        times = (0.0, *LONG, 1e11) if order == (0, 1, 2) else LONG
        yield momentum(f"generic-small-{label}", "generic", body, place((1.8, 0.4, -0.9), order), times)
        yield omega(f"generic-large-{label}", "generic", body, place((-0.4, 0.3, 1.1), order), times, TILTED)

    for order in ORDERS[:3]:
        for power in (3, 6, 9, 12):
            off = 10.0**-power
            body = place((3.0, 5.0, 7.0), order)
            label = f"{order[1] + 1}-1e-{power}"
            yield omega(f"middle-{label}-small", "unstable axis", body, place((off, 1.0, 0.0), order), (1.0, 10.0, 1e3, 1e9))
            yield omega(f"middle-{label}-large", "unstable axis", body, place((0.0, -1.0, off), order), (1.0, 10.0, 1e3, 1e9))
    for power in range(3, 13):
        off = 10.0**-power
        yield momentum(f"racket-1e-{power}", "unstable axis", (3.0, 5.0, 7.0), (0.3 * off, 2.0, off), (10.0, 100.0, 1e6), TILTED)

    for power in (4, 6, 8, 10, 12):
        split = 1 + 10.0**-power
        for kind, body in (("oblate", (1.0, split, 1.6)), ("prolate", (0.4, 1.0, split))):
            lone = 2 if kind == "oblate" else 0
            root = 10.0 ** (-power / 2)
            # Rates of the lone axis deep inside, slow in phase, and on either side of the separatrix.
            edge = 0.613 if kind == "oblate" else 1.43
            for start, rate in (("fast", 0.7), ("slow", 7e-4), ("edge", edge * root), ("inside", 0.97 * edge * root)):
                w = [0.6, -0.5, 0.7]
                w[lone] = rate
                yield omega(f"near-{kind}-1e-{power}-{start}", "nearly symmetric", body, w, SOME, TILTED)
        body = (1.0 + 2.3 * 10.0**-power, 1.0, split)
        yield omega(f"near-sphere-1e-{power}", "nearly spherical", body, (0.5, 0.6, -0.7), SOME)
        yield omega(f"near-sphere-1e-{power}-middle", "nearly spherical", body, (0.01, 0.003, -1.0), SOME, TILTED)

    for lone in range(3):
        for kind, value in (("oblate", 1.5), ("prolate", 0.3)):
            body = [1.0, 1.0, 1.0]
            body[lone] = value
            yield omega(f"{kind}-{lone + 1}", "symmetric", body, (0.3, -0.8, 0.5), SOME, TILTED)
    yield omega("oblate-equatorial", "symmetric", (1.0, 1.0, 1.5), (0.6, -0.8, 0.0), SOME)
    yield omega("oblate-slow", "symmetric", (1.0, 1.0, 1.5), (0.6, -0.8, 1e-9), SOME)
    yield omega("prolate-equatorial", "symmetric", (0.3, 1.0, 1.0), (0.0, 0.6, 0.8), SOME)
    yield omega("prolate-axial", "symmetric", (0.3, 1.0, 1.0), (-1.0, 0.0, 0.0), SOME)
    yield omega("sphere", "spherical", (0.7, 0.7, 0.7), (0.3, -0.8, 0.5), SOME)
    yield momentum("sphere-tilted", "spherical", (1.3, 1.3, 1.3), (-1.0, 0.2, 0.9), SOME, TILTED)

    plate = (0.375, 0.625, 1.0)
    yield omega("plate-small", "planar", plate, (1.0, 0.3, 0.2), LONG)
    yield omega("plate-large", "planar", plate, (0.2, -0.3, 1.0), LONG, TILTED)
    yield omega("plate-321", "planar", plate[::-1], (0.7, -0.5, 0.4), LONG)
    yield omega("disk", "planar", (0.5, 0.5, 1.0), (0.7, -0.5, 0.4), LONG)

    rod = (1e-3, 1.0, 1.0005)
    yield omega("rod-all", "rod", rod, (1.0, 0.8, -0.6), LONG)
    yield omega("rod-spin", "rod", rod, (30.0, 0.3, 0.2), LONG, TILTED)
    yield omega("rod-slow", "rod", rod, (1e-3, 0.8, 0.6), LONG)
    yield omega("rod-end-over-end", "rod", rod, (1e-2, 0.1, 1.0), LONG)
    yield omega("rod-middle", "rod", (1.0005, 1e-3, 1.0), (1e-4, 1e-2, 1.0), LONG)

    for axis in range(3):
        for sign in (1.0, -1.0):
            w = [0.0] * 3
            w[axis] = sign * 0.9
            name = f"spin-{axis + 1}{'+' if sign > 0 else '-'}"
            yield omega(name, "pure spin", (0.6, 0.8, 1.0), w, (0.37, -1.0, 1e6, 1e9), TILTED)

    # I_h (I_m - I_l) / (I_l (I_h - I_m)) is the square of m_h/m_l: 1 for the first body, 1/4 for the second.
    edges = (((0.75, 1.0, 1.5), (0.75, 0.5, 0.75)), ((9.0, 10.0, 18.0), (9.0, -4.0, 4.5)))
    for number, (body, m) in enumerate(edges):
        for signs in ((1, 1, 1), (1, 1, -1), (-1, 1, 1), (-1, 1, -1)):
            data = [s * x for s, x in zip(signs, m)]
            label = f"{number + 1}" + "".join("+-"[s < 0] for s in signs)
            yield momentum(f"separatrix-{label}", "separatrix", body, data, (0.37, -10.0, 30.0, 1e9))
            data[1] = 0.0
            yield momentum(f"separatrix-{label}-top", "separatrix", body, data, (1.0, 100.0), TILTED)
        order = ORDERS[3]
        yield momentum(f"separatrix-{number + 1}-321", "separatrix", place(body, order), place(m, order), (1.0, -30.0, 1e6))
        for where, which in (("l", 0), ("h", 2)):
            for way in (2.0, 0.0):
                data = list(m)
                data[which] = nextafter(data[which], way * data[which])
                name = f"ulp-{number + 1}-{where}{'+' if way else '-'}"
                yield momentum(name, "next to separatrix", body, data, (1.0, 30.0, 1e3, 1e6, 1e9))

    for number, scale in enumerate((1e-47, 1e33)):
        body = [a * scale for a in (0.6148, 1.1555, 1.7703)]
        name = ("molecule", "asteroid")[number]
        rate = (1e13, 1e-3)[number]
        w = [a * rate for a in (0.7, 0.6, -0.4)]
        times = [a / rate for a in (0.37, 10.0, 1e6, 1e9)]
        yield omega(f"{name}-omega", "scale", body, w, times, TILTED)
        yield momentum(f"{name}-momentum", "scale", body, [a * b for a, b in zip(body, w)], times)
        yield momentum(f"{name}-middle", "scale", body, [1e-4 * w[0] * body[0], w[1] * body[1], 1e-5 * w[2] * body[2]], times)

    slow = (1e3, 1e6, 1e9, 1e12)
    yield omega("slow-asteroid", "asteroid", (1.2e33, 2.9e33, 3.4e33), (3.1e-4, -1.7e-4, 2.2e-4), slow, TILTED)
    yield omega("slow-asteroid-long", "asteroid", (1.2e33, 2.9e33, 3.4e33), (9.1e-4, 1.1e-5, -2.2e-5), slow)
    yield omega("slow-asteroid-wobble", "asteroid", (2.0e30, 2.1e30, 2.3e30), (1e-6, 2e-6, 3.3e-4), slow)
    day = 86400.0
    spin = [a * float(pi / 180) / day for a in (-98.5, 14.5, 33.7)]
    yield omega("toutatis", "asteroid", (1.0, 3.0836, 3.235), spin, (day, 23.15972222222222 * day, 1e9, 1e12))

    draw = random.Random(20070611)
    for number in range(30):
        small, middle = sorted(10 ** draw.uniform(-1, 0) for _ in range(2))
        body = [small, middle, draw.uniform(middle, small + middle)]
        draw.shuffle(body)
        w = [draw.gauss(0, 1) for _ in range(3)]
        attitude = tuple(draw.gauss(0, 1) for _ in range(4))
        yield omega(f"random-{number + 1}", "random", body, w, (0.37, 10.0, 1e6, 1e9), attitude)


def brink():
    """Deviations from a turn about the middle axis, down to the smallest double."""
    body = (1.0, 1.5, 1.75)
    for off, name in ((1e-40, "1e-40"), (1e-56, "1e-56"), (1e-75, "1e-75"), (1e-100, "1e-100"), (1e-145, "1e-145"),
                      (1e-158, "1e-158"), (1e-200, "1e-200"), (1e-300, "1e-300"), (5e-324, "5e-324")):
        for which, m in (("small", (off, 1.0, 0.0)), ("large", (0.0, -1.0, off)), ("both", (-off, 0.75, 3 * off))):
            order = ORDERS[1] if which == "both" else ORDERS[0]
            name_of = f"brink-{name}-{which}"
            yield momentum(name_of, "brink", place(body, order), place(m, order), (1.0, -100.0, 3e3, 1e6), TILTED)


def references():
    """Problems of the literature, in the doubles next to their decimal data. E4 to E7 break the triangle inequality:
    the equations do not mind, but no body has such moments."""
    third, c11, s11 = 2 / 3, float(cos(mpf("1.1"))), float(sin(mpf("1.1")))
    toms = (1.0, 1.012686988782515, 3.306237422473038)
    yield momentum("E1", "Hairer-Vilmart driver", (0.6, 0.8, 1.0), (1.8, 0.4, -0.9), (1.0, 10.0, 1e3, 1e6, 1e9))
    yield momentum("E2", "dyadic", (0.625, 0.75, 1.0), (1.75, 0.375, -0.875), (1.0, 10.0, 1e4, 1e6, 1e9))
    yield momentum("E3-free", "GNI Fig. VII.5.3", (0.5, 0.85, 1.0), (0.2, 1.0, 0.4), (1.0, 10.0, 30.0), (0.4, 0.2, 0.4, 0.8))
    yield momentum("E4", "TOMS 903 example 4", toms, (-0.544332842491675, 0.729131780907662, -0.414811526666455), (1.0, 10.0))
    yield momentum("E5", "TOMS 903 example 3", toms, (-0.609860759302936, 0.761660947972381, 0.218957654801698), (1.0, 10.0))
    yield momentum("E5-0", "TOMS 903 example 0", (1.0, 1.6487857827119290, 1.9720127096641928),
                   (-0.709894965287627, -0.685144717153487, 0.163174308075589), (0.1, 1.0, 10.0))
    yield momentum("E6", "Dzhanibekov", (3.0, 5.0, 9.0), (0.0, 2.0, 0.01), (1.0, 50.0, 100.0))
    yield momentum("E7", "GNI chapter IV", (2.0, 1.0, third), (c11, 0.0, s11), (1.0, 32.0))
    day = 86400.0
    spin = [a * float(pi / 180) for a in (-98.5, 14.5, 33.7)]
    yield omega("E11", "Toutatis in days", (1.0, 3.0836, 3.235), spin, (1.0, 23.15972222222222))


# 25-digit values found earlier with another program, for the decimal data themselves: moments, m, q and rows t, m, q.
KNOWN = (
    (("0.6", "0.8", "1"), ("1.8", "0.4", "-0.9"), None, (
        ("10", "1.76596250851820753572715 -0.6954641970330891194994928 0.7795549814818710861007418",
         "-0.7360613641607939361612411 -0.5707869512403507332546212 -0.2993885718307900937437669 -0.2068390861046731924831171"),
        ("1e3", None, "-0.7542529472420037252189495 0.6534382753335019950698016 -0.02351654307782214343998455 0.0597317679932422447407748"),
        ("1e6", "1.811381985441215888256206 0.2244715442636401034608552 -0.9372874845184562761816093",
         "0.848897250291755286427368 0.4819069291672868718237005 0.07456533876948243119812037 -0.2039097357210902110011036"),
        ("1e9", None, "0.8501118542250969028021592 0.51328712173943373639761 0.01713209550513139068224 -0.11641588064357191044177"))),
    (("0.625", "0.75", "1"), ("1.75", "0.375", "-0.875"), None, (
        ("10", "1.768186490190561154387 0.1595454939308918514144 -0.9037763945102418606089",
         "-0.8883609463723478648778 0.3813705489682785803988 0.0652107937339102517065 -0.2472223406584722912335"),
        ("1e4", None, "-0.8103385431509628572379 -0.4139073384303736067966 -0.2927951421421662949855 -0.2937740039816455752222"),
        ("1e6", "1.473510004993583859739 -1.320949611957570183124 0.2293695443012285033826",
         "0.1030376591773212537864 0.9543226551836829835698 -0.2447485788533700377635 -0.1369293385059578962188"),
        ("1e9", None, "-0.2755999811288595093035 -0.867304921999715038621 -0.07934396458479419249356 0.4068554509414952155901"))),
    (("0.5", "0.85", "1"), ("0.2", "1", "0.4"), ("0.4", "0.2", "0.4", "0.8"), (
        ("30", "0.2372809549886187912627994 0.9526912271375782387676665 0.4858777357883198705491154",
         "-0.6203812640160511100888425 -0.342989323867929511567972 -0.185047246525582336990471 -0.6806195174425779004378671"),)),
    (("1", "1.012686988782515", "3.306237422473038"), ("-0.544332842491675", "0.729131780907662", "-0.414811526666455"), None, (
        ("10", "0.7106898781472953988734884 -0.5648300034433560542577915 -0.4193887985022506510934585",
         "-0.3676198428912016030899345 -0.6306293411934666453690841 -0.6127232630971779098614419 0.3028737162549582841069787"),)),
    (("1", "1.012686988782515", "3.306237422473038"), ("-0.609860759302936", "0.761660947972381", "0.218957654801698"), None, (
        ("10", None, "0.03094318842092296820298839 0.9352193365240536833987384 -0.07731539423781958856698603 -0.3441360799098325005492938"),)),
    (("3", "5", "9"), ("0", "2", "0.01"), None, (
        ("100", "0.2090942628297760675113266 1.972485481094647073085859 0.2562822977158024670448626",
         "0.9729650346542738322786753 -0.07171372908301691046137617 -0.2164463177188846447851643 0.03670386828593163761549256"),)),
    (("2", "1", "2/3"), ("cos(1.1)", "0", "sin(1.1)"), None, (
        ("32", "0.4502011468407950377106102 0.07833733152922749351891543 0.8894842268821369067818485",
         "-0.9760128833940325721842725 -0.1310465582577418387797393 -0.009497746672400894230050634 -0.1735956330839394972444165"),)),
)


# --- checks and output ------------------------------------------------------------------------------------------


def gap(x, y):
    """Largest difference of two states, momentum in units of its length."""
    (m, q), (n, p) = x, y
    size = norm(m) or 1
    return max([abs(a - b) / size for a, b in zip(m, n)] + [abs(a - b) for a, b in zip(q, p)])


def exact(text):
    if text.startswith(("cos", "sin")):
        return (cos if text.startswith("cos") else sin)(mpf(text[4:-1]))
    if "/" in text:
        a, b = text.split("/")
        return mpf(a) / mpf(b)
    return mpf(text)


def check_known():
    for moments, m, q, rows in KNOWN:
        q = [exact(a) for a in q or ("1", "0", "0", "0")]
        r = norm(q)
        motion = Motion([exact(a) for a in moments], [exact(a) for a in m], [a / r for a in q])
        for t, m_text, q_text in rows:
            found = motion.at(mpf(t))
            for text, values in ((m_text, found[0]), (q_text, found[1])):
                for digits, value in zip((text or "").split(), values):
                    shown = len(digits.lstrip("-0.").replace(".", ""))
                    assert abs(mpf(digits) - value) <= abs(value) * mpf(10) ** (1.0 - shown) + mpf(10) ** -25, (t, digits, value)


def check(scenario, motion):
    """Against the Taylor integrator, and the closed form against itself from another start."""
    fastest = max(abs(a / b) for a, b in zip(motion.m, motion.I))
    for radians in (13, -2):
        t = radians * mpf(2) ** -int(nint(mp.log(fastest, 2)))
        error = gap(motion.at(t), taylor(motion.I, motion.m, motion.q, t))
        assert error < mpf(10) ** -40, (scenario.name, "Taylor", mp.nstr(error, 5))
    if len(scenario.times) > 1 and (motion.spin or motion.mc):
        first, last = (mpf(t) for t in scenario.times[-2:])
        error = gap(Motion(motion.I, *motion.at(first)).at(last - first), motion.at(last))
        assert error < mpf(10) ** -40, (scenario.name, "group law", mp.nstr(error, 5))


def shown(x):
    """36 significant digits; what underflows every floating-point type is 0."""
    return "0" if abs(x) < mpf(10) ** -400 else mp.nstr(x, 36, strip_zeros=True, min_fixed=-5, max_fixed=5)


def write(name, about, cases):
    count = 0
    with open(HERE / name, "w", newline="") as file:
        file.write(f"# {about}\n")
        file.write("# python3 tests/data/free_body/generate.py (mpmath 1.3, at least 160 digits); 36 digits are printed\n")
        file.write("# start names the datum s1..s3 (m or omega, body axes); q0 is normalised exactly; t, I, s, q0 are exact doubles;\n")
        file.write("# m in body axes; q scalar first, active, body to space, the continuous lift from q0\n")
        out = csv.writer(file, lineterminator="\n")
        out.writerow(COLUMNS)
        for scenario in cases:
            mp.dps = 160
            assert scenario.body or scenario.name[:2] in ("E4", "E5", "E6", "E7"), (scenario.name, "triangle inequality")
            motion = scenario.motion()
            if motion.spin is False and motion.mc:
                # Digits for the largest phase and for the distance to the separatrix.
                mp.dps += int(-log10(motion.mc)) + int(max(0, log10(max(1, abs(motion.rate * max(scenario.times, key=abs))))))
                motion = scenario.motion()
            assert (scenario.regime == "separatrix") == (not motion.spin and motion.mc == 0), scenario.name
            check(scenario, motion)
            inputs = [scenario.name, scenario.regime, *map(repr, scenario.moments), scenario.start, *map(repr, scenario.data)]
            for t in scenario.times:
                m, q = motion.at(mpf(t))
                out.writerow([*inputs, *map(repr, scenario.attitude), repr(t), *map(shown, m), *map(shown, q)])
                count += 1
    print(name, count, "rows")


if __name__ == "__main__":
    check_known()
    write("reference.csv", "Published and tabulated free-body problems", references())
    write("../../../experiments/data/free_body.csv", "Exact torque-free rotation of a rigid body by regime", scenarios())
    write("brink.csv", "Exact torque-free rotation of a rigid body that turns about its middle axis but for a deviation", brink())
