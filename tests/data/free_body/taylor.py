"""Rotation of a rigid body about a fixed point by Taylor series, in fixed-point integers.

    m' = m x w + G x c,   q' = q o (0, w)/2,   G' = G x w,   w = m/I

m and w in body axes, q scalar first, active, body to space; G = Q^T e_z is the upward vertical in the body and
c the weight moment (potential c.G), zero for a free body. Every right side is quadratic, so the series follow
from Cauchy products. This shares nothing with the closed forms it is compared with.
"""

from operator import mul

from mpmath import mp, mpf, floor, ldexp, log

AXES = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


def vertical(q):
    """Upward vertical in body axes for a unit quaternion."""
    w, x, y, z = q
    return [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z]


def taylor(moments, m, q, t, c=(0, 0, 0), digits=50):
    """Momentum and attitude at time t; `digits` are kept in each step."""
    return next(taylor_at(moments, m, q, [t], c, digits))


def taylor_at(moments, m, q, times, c=(0, 0, 0), digits=50):
    """Yields (m, q) at each of `times`, which move monotonically away from 0."""
    bits = int(3.33 * digits) + 40
    order = 40 + digits // 2
    heavy = any(c)
    with mp.workprec(2 * bits + 200):
        # Units of inertia and rate that make every number of order one; powers of two, so nothing is rounded.
        rate = max([abs(a / b) for a, b in zip(m, moments)] + [mp.sqrt(abs(a) / max(moments)) for a in c])
        inertia_unit = mpf(2) ** int(floor(log(max(moments), 2)))
        rate_unit = mpf(2) ** int(floor(log(rate, 2)))
        momentum_unit = inertia_unit * rate_unit

        def fixed(x):
            return int(mp.nint(ldexp(x, bits)))

        inverse = [fixed(inertia_unit / a) for a in moments]
        weight = [fixed(a / (momentum_unit * rate_unit)) for a in c]
        state = [fixed(a / momentum_unit) for a in m] + [fixed(a) for a in q]
        if heavy:
            state += [fixed(a) for a in vertical(q)]
        targets = [fixed(t * rate_unit) for t in times]
    now = 0
    for target in targets:
        while now != target:
            series = expand(inverse, weight, state, order, bits)
            left = target - now
            h = min(stride(series, order, bits, digits), abs(left))
            h = h if left > 0 else -h
            state = [horner(a, h, bits) for a in series]
            now += h
        with mp.workprec(bits + 20):
            values = [ldexp(mpf(a), -bits) for a in state]
            mm, qq = [a * momentum_unit for a in values[:3]], values[3:7]
            if heavy:
                slack = max(abs(a - b) for a, b in zip(values[7:], vertical(qq)))
                assert slack < mpf(10) ** (10 - digits), ("vertical and attitude disagree", slack)
        yield mm, qq


def expand(inverse, weight, state, order, bits):
    """Taylor coefficients of every component: m, q and, under a weight, G."""
    parts = [[a] for a in state]
    m, q, g = parts[:3], parts[3:7], parts[7:]
    w = [[a[0] * f >> bits] for a, f in zip(m, inverse)]
    for n in range(order):
        back = [a[::-1] for a in w]
        unit = n + 1

        def by(a, k):
            return sum(map(mul, a, back[k]))

        dm = [by(m[j], k) - by(m[k], j) for _, j, k in AXES]
        dg = [by(g[j], k) - by(g[k], j) for _, j, k in AXES] if g else []
        if g:
            dm = [a + g[j][n] * weight[k] - g[k][n] * weight[j] for a, (_, j, k) in zip(dm, AXES)]
        s, x, y, z = q
        dq = (
            -by(x, 0) - by(y, 1) - by(z, 2),
            by(s, 0) + by(y, 2) - by(z, 1),
            by(s, 1) + by(z, 0) - by(x, 2),
            by(s, 2) + by(x, 1) - by(y, 0),
        )
        for a, d in zip(m + g, dm + dg):
            a.append((d >> bits) // unit)
        for a, d in zip(q, dq):
            a.append((d >> bits + 1) // unit)
        for a, b, f in zip(w, m, inverse):
            a.append(b[-1] * f >> bits)
    return parts


def stride(series, order, bits, digits):
    """Step at which the last two terms fall below 10^-digits."""
    steps = []
    with mp.workprec(60):
        for n in (order - 1, order):
            size = max(abs(a[n]) for a in series)
            if size:
                steps.append((mpf(10) ** -digits / ldexp(mpf(size), -bits)) ** (mpf(1) / n))
        h = min(steps) if steps else mpf(1)
        return int(ldexp(floor(ldexp(h, 20)), bits - 20))


def horner(coefficients, h, bits):
    value = 0
    for a in reversed(coefficients):
        value = (value * h >> bits) + a
    return value
