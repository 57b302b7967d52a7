"""Bodies under forces, integrated in 34 digits, and places on conics: writes reference.csv and conics.csv beside this file.

python3 tests/data/forces/generate.py        (mpmath 1.3; a quarter of an hour)

Equations of motion: m' = m x w + tau, q' = q (0, w)/2, w = m/I, q scalar first, body to space.
    gradient p1 = n, p2 = e: tau = 3 n^2 (a/r)^3 r x I r, r in body axes, orbit in the x-y plane of space, perigee on +x at t = 0
    conic    p1 = GM, p2 = q, p3 = e: tau = 3 GM/r^3 r x I r, least distance q at t = PASSAGE, plane by the angles PLANE:
             node, inclination, argument of the periapsis
    body     tau = p;  space tau = q* p q
    drag     tau = -p1 w - p2 |w| w
Twice and four times the steps agree; the script refuses less than 20 digits at half of the steps that are written.
"""

import math
import os

from mpmath import asinh, cbrt, cos, cosh, mp, mpf, nstr, pi, sin, sinh, sqrt, workdps

mp.dps = 34

CASES = [
    ("gradient", [10.0, 25.0, 30.0], [1, 0, 0, 0], [0.0078125, -0.0234375, 0.09375], [0.00390625, 0.0, 0.0], 0.0, 2048.0),
    ("gradient", [10.0, 25.0, 30.0], [1, 0, 0, 0], [0.0078125, -0.0234375, 0.09375], [0.00390625, 0.3125, 0.0], 512.0, 2560.0),
    ("gradient", [3.0, 2.0, 2.5], [0.5, 0.5, -0.5, 0.5], [0.25, 0.5, -0.75], [0.5, 0.625, 0.0], -1.0, 7.0),
    ("conic", [3.0, 2.0, 2.5], [0.5, 0.5, -0.5, 0.5], [0.25, 0.5, -0.75], [2.0, 1.5, 4.25], 0.0, 8.0),
    ("conic", [3.0, 2.0, 2.5], [0.5, 0.5, -0.5, 0.5], [0.25, 0.5, -0.75], [2.0, 1.5, 1.0], 0.0, 8.0),
    ("conic", [3.0, 2.0, 2.5], [0.5, 0.5, -0.5, 0.5], [0.25, 0.5, -0.75], [2.0, 1.5, 0.875], 0.0, 8.0),
    ("body", [1.0, 2.0, 2.5], [0.5, -0.5, 0.5, 0.5], [0.25, 2.0, -0.75], [0.125, -0.25, 0.0625], 0.0, 8.0),
    ("space", [1.0, 2.0, 2.5], [0.5, -0.5, 0.5, 0.5], [0.25, 2.0, -0.75], [0.125, -0.25, 0.0625], 0.0, 8.0),
    ("drag", [1.0, 2.0, 2.5], [0.5, -0.5, 0.5, 0.5], [0.25, 2.0, -0.75], [0.125, 0.25, 0.0], 0.0, 8.0),
]


PASSAGE, PLANE = 3.0, [0.4, 0.9, -1.3]

# eccentricities, and times in units of the root of q^3/GM
CONICS = [0.0, 0.5, 0.875, 1 - 2.0**-20, 1 - 2.0**-53, 1.0, 1 + 2.0**-52, 1 + 2.0**-20, 1.25, 4.25, 1000.0]
TIMES = [0.0, 2.0**-20, -0.25, 1.0, -3.0, 20.0, 1000.0, 2.0**30]


def times(p, q):
    a, b, c, d = p
    w, x, y, z = q
    return [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]


def into_body(q, v):
    return times(times([q[0], -q[1], -q[2], -q[3]], [mpf(0)] + list(v)), q)[1:]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def root(f, slope, e, mean, x):
    """Newton's iteration down a convex function in doubles, and on from there: each step doubles the digits."""
    near, small = float(x), (float(e), float(mean))
    for _ in range(200):
        below = near - f(math, near, *small) / slope(math, near, *small)
        if not below < near:
            break
        near = below
    x = mpf(near)
    for _ in range(4 if mp.dps < 40 else 60):
        x -= f(mp, x, e, mean) / slope(mp, x, e, mean)
    assert abs(f(mp, x, e, mean)) <= (abs(x) + mean) * mpf(10) ** (4 - mp.dps), (e, nstr(mean))
    return x


def on_conic(e, s):
    """Place in units of q at the time s after the least distance in units of the root of q^3/GM, by Kepler's and Barker's equations."""
    sign, s = (-1 if s < 0 else 1), abs(mpf(s))
    if s == 0:
        return [mpf(1), mpf(0)]
    if e < 1:
        a = 1 / (1 - mpf(e))
        mean = s / sqrt(a) ** 3
        mean -= 2 * pi * mp.nint(mean / (2 * pi))
        if mean < 0:
            sign, mean = -sign, -mean
        x = root(lambda m, x, e, s: x - e * m.sin(x) - s, lambda m, x, e, s: 1 - e * m.cos(x), mpf(e), mean, min(mean + e, pi))
        return [a * (cos(x) - e), sign * a * sqrt(1 - mpf(e) ** 2) * sin(x)]
    if e == 1:
        w = cbrt(3 * s / sqrt(mpf(2)) / 2 + sqrt((3 * s / sqrt(mpf(2)) / 2) ** 2 + 1))
        tangent = w - 1 / w
        return [1 - tangent**2, sign * 2 * tangent]
    a = 1 / (mpf(e) - 1)
    mean = s / sqrt(a) ** 3
    x = root(lambda m, x, e, s: e * m.sinh(x) - x - s, lambda m, x, e, s: e * m.cosh(x) - 1, mpf(e), mean, asinh(mean * a))
    return [a * (e - cosh(x)), sign * a * sqrt(mpf(e) ** 2 - 1) * sinh(x)]


def turned(v, axis, angle):
    j, k = (axis + 1) % 3, (axis + 2) % 3
    v = list(v)
    v[j], v[k] = cos(angle) * v[j] - sin(angle) * v[k], sin(angle) * v[j] + cos(angle) * v[k]
    return v


def torque(kind, moments, p, t, q, w):
    if kind == "body":
        return p
    if kind == "space":
        return into_body(q, p)
    if kind == "drag":
        speed = sqrt(sum(x * x for x in w))
        return [-(p[0] + p[1] * speed) * x for x in w]
    if kind == "conic":
        gm, least, e = p
        place = [least * x for x in on_conic(e, (t - PASSAGE) * sqrt(gm / least**3))] + [mpf(0)]
        for axis, angle in [(2, PLANE[2]), (0, PLANE[1]), (2, PLANE[0])]:
            place = turned(place, axis, mpf(angle))
        r = into_body(q, place)
        distance = sqrt(sum(x * x for x in r))
        return [3 * gm / distance**5 * x for x in cross(r, [i * x for i, x in zip(moments, r)])]
    n, e = p[0], p[1]
    mean = n * t
    anomaly = mean
    for _ in range(40 if e else 0):
        anomaly -= (anomaly - e * sin(anomaly) - mean) / (1 - e * cos(anomaly))
    near = 1 / (1 - e * cos(anomaly))
    r = into_body(q, [(cos(anomaly) - e) * near, sqrt(1 - e * e) * sin(anomaly) * near, mpf(0)])
    return [3 * n * n * near**3 * x for x in cross(r, [i * x for i, x in zip(moments, r)])]


def step(rhs, t, y, h, order):
    """Extrapolated midpoint rule (Bulirsch and Stoer), `order` columns of h^2."""
    rows = []
    for k in range(order):
        n = 2 * (k + 1)
        d = h / n
        before, now = y, [a + d * b for a, b in zip(y, rhs(t, y))]
        for j in range(1, n):
            f = rhs(t + j * d, now)
            before, now = now, [a + 2 * d * b for a, b in zip(before, f)]
        f = rhs(t + h, now)
        row = [[(a + b + d * c) / 2 for a, b, c in zip(before, now, f)]]
        for j in range(1, k + 1):
            ratio = (mpf(n) / (2 * (k - j + 1))) ** 2 - 1
            row.append([a + (a - b) / ratio for a, b in zip(row[j - 1], rows[k - 1][j - 1])])
        rows.append(row)
    return rows[-1][-1]


def follow(case, steps):
    kind, moments, q, m, p, t0, t1 = case
    moments, p = [mpf(x) for x in moments], [mpf(x) for x in p]

    def rhs(t, y):
        q, m = y[:4], y[4:]
        w = [a / b for a, b in zip(m, moments)]
        rate = times(q, [mpf(0)] + w)
        gyro = cross(m, w)
        tau = torque(kind, moments, p, t, q, w)
        return [x / 2 for x in rate] + [a + b for a, b in zip(gyro, tau)]

    y, h = [mpf(x) for x in q + m], (mpf(t1) - mpf(t0)) / steps
    for n in range(steps):
        y = step(rhs, mpf(t0) + n * h, y, h, 12)
    return y


def conics():
    lines = [
        "# x and y in least distances at the time s in units of the root of q^3/GM, 32 digits; python3 tests/data/forces/generate.py",
        "e,s,x,y",
    ]
    with workdps(90):
        for e in CONICS:
            for s in TIMES:
                lines.append(",".join([repr(e), repr(s)] + [nstr(x, 34) for x in on_conic(e, s)]))
    write("conics.csv", lines)


def write(name, lines):
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), name), "w") as out:
        out.write("\n".join(lines) + "\n")


def main():
    conics()
    lines = [
        "# bodies under forces, 28 digits; python3 tests/data/forces/generate.py (mpmath 1.3, extrapolated midpoint rule)",
        "kind,I1,I2,I3,q0w,q0x,q0y,q0z,m0x,m0y,m0z,p1,p2,p3,t0,t1,qw,qx,qy,qz,mx,my,mz",
    ]
    for case in CASES:
        kind, moments, q, m, p, t0, t1 = case
        steps = 160 if kind == "gradient" and p[1] > 0.5 else 64
        half, end = follow(case, steps), follow(case, 2 * steps)
        agree = max(abs(a - b) for a, b in zip(half, end))
        assert agree < mpf(10) ** -20, (kind, nstr(agree, 3))
        end = follow(case, 4 * steps)
        print(kind, nstr(agree, 3))
        numbers = [repr(float(x)) for x in moments + q + m + p + [t0, t1]]
        lines.append(",".join([kind] + numbers + [nstr(x, 30) for x in end]))
    write("reference.csv", lines)


main()
