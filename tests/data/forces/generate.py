"""Bodies under forces, integrated in 34 digits: writes reference.csv beside this file.

python3 tests/data/forces/generate.py        (mpmath 1.3)

Equations of motion: m' = m x w + tau, q' = q (0, w)/2, w = m/I, q scalar first, body to space.
    gradient p1 = n, p2 = e: tau = 3 n^2 (a/r)^3 r x I r, r in body axes, orbit in the x-y plane of space, perigee on +x at t = 0
    body     tau = p;  space tau = q* p q
    drag     tau = -p1 w - p2 |w| w
Twice and four times the steps agree; the script refuses less than 20 digits at half of the steps that are written.
"""

import os

from mpmath import cos, mp, mpf, nstr, sin, sqrt

mp.dps = 34

CASES = [
    ("gradient", [10.0, 25.0, 30.0], [1, 0, 0, 0], [0.0078125, -0.0234375, 0.09375], [0.00390625, 0.0, 0.0], 0.0, 2048.0),
    ("gradient", [10.0, 25.0, 30.0], [1, 0, 0, 0], [0.0078125, -0.0234375, 0.09375], [0.00390625, 0.3125, 0.0], 512.0, 2560.0),
    ("gradient", [3.0, 2.0, 2.5], [0.5, 0.5, -0.5, 0.5], [0.25, 0.5, -0.75], [0.5, 0.625, 0.0], -1.0, 7.0),
    ("body", [1.0, 2.0, 2.5], [0.5, -0.5, 0.5, 0.5], [0.25, 2.0, -0.75], [0.125, -0.25, 0.0625], 0.0, 8.0),
    ("space", [1.0, 2.0, 2.5], [0.5, -0.5, 0.5, 0.5], [0.25, 2.0, -0.75], [0.125, -0.25, 0.0625], 0.0, 8.0),
    ("drag", [1.0, 2.0, 2.5], [0.5, -0.5, 0.5, 0.5], [0.25, 2.0, -0.75], [0.125, 0.25, 0.0], 0.0, 8.0),
]


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


def torque(kind, moments, p, t, q, w):
    if kind == "body":
        return p
    if kind == "space":
        return into_body(q, p)
    if kind == "drag":
        speed = sqrt(sum(x * x for x in w))
        return [-(p[0] + p[1] * speed) * x for x in w]
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


def main():
    lines = [
        "# bodies under forces, 28 digits; python3 tests/data/forces/generate.py (mpmath 1.3, extrapolated midpoint rule)",
        "kind,I1,I2,I3,q0w,q0x,q0y,q0z,m0x,m0y,m0z,p1,p2,p3,t0,t1,qw,qx,qy,qz,mx,my,mz",
    ]
    for case in CASES:
        kind, moments, q, m, p, t0, t1 = case
        steps = 160 if p[1] > 0.5 else 64
        half, end = follow(case, steps), follow(case, 2 * steps)
        agree = max(abs(a - b) for a, b in zip(half, end))
        assert agree < mpf(10) ** -20, (kind, nstr(agree, 3))
        end = follow(case, 4 * steps)
        print(kind, nstr(agree, 3))
        numbers = [repr(float(x)) for x in moments + q + m + p + [t0, t1]]
        lines.append(",".join([kind] + numbers + [nstr(x, 30) for x in end]))
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "reference.csv"), "w") as out:
        out.write("\n".join(lines) + "\n")


main()
