"""Writes derivative.csv: the derivative of the motion of Lagrange's top by its start and by its constants.

    python3 tests/data/tops/derivative.py        (python 3.11, mpmath 1.3; about ten minutes)

Columns: rotation vector in space and momentum in the body, at t, by the same at the start and by transverse moment, axial moment and
weight moment. They are central differences, with steps of 1e-20, of Taylor integrations of the equations of motion with 64 digits
(../free_body/taylor.py), so that nothing of the equations of the changes is used. One column of each row is done again with other
steps and digits; the two agree to 32 digits of the largest entry.
"""

import csv
from pathlib import Path

from mpmath import cos, mp, mpf, sin, sqrt

from generate import HALF, lagrange, unit
from taylor import taylor

HERE = Path(__file__).parent

DIGITS, STEP = 64, mpf(10) ** -20
# times of the scenarios of generate.py, and scenarios of this file
TIMES = {
    "generic": (-3.0, 30.0), "generic-long": (30.0,), "generic-flat": (10.0,), "fast": (1.0,), "axis-1": (10.0,),
    "hanging-weight": (10.0,), "sleeping": (10.0,), "sleeping-unstable": (10.0,), "upright-nudged": (3.0,),
    "upright-falls": (3.0, 20.0), "tilt-1e-6-stable": (20.0,), "tilt-1e-6-unstable": (3.0, 20.0),
    "tilt-1e-3-critical": (10.0,), "cusps": (10.0,), "loops": (3.0,), "waves": (1.0,), "lower-circle": (10.0,),
    "homoclinic": (-2.0, 5.0, 20.0), "homoclinic-near": (1.0, 20.0), "hanging-spin": (10.0,), "through-hanging": (10.0,),
    "spherical-pendulum": (10.0,), "plane-pendulum": (3.0,), "ball": (10.0,), "flea": (0.05,),
}


def further():
    """name, regime, moments, weight moment, datum, its values, attitude, times."""
    top, tilted = (1.25, 1.25, 0.5), (0.9, 0.3, -0.2, 0.4)
    # m_3 W = A W^2 cos + c with W = 1: a double zero of the cubic, in doubles
    yield "steady", "steady precession", top, (0, 0, 2), "momentum", (0, 1, 2.75), HALF, (10.0,)
    yield "steady-near", "next to steady precession", top, (0, 0, 2), "momentum", (0, 1, 2.75 + 1e-9), HALF, (-10.0,)
    yield "weak", "weak weight", top, (0, 0, 1e-12), "omega", (0.5, -0.25, 2), tilted, (10.0,)
    yield "weaker", "weak weight", top, (0, 0, 1e-40), "omega", (0.5, -0.25, 2), tilted, (3.0,)
    yield "no-tilt", "next to upright", (1.25, 1.25, 0.75), (0, 0, 2), "omega", (1e-12, 0, 8), (1, 0, 0, 0), (10.0,)
    yield "critical", "upright", (1, 1, 0.5), (0, 0, 1), "omega", (0, 0, 4), (1, 0, 0, 0), (10.0,)
    yield "rod", "long and thin", (1, 1, 1e-4), (0, 0, -3), "omega", (0.5, 0.75, 300), tilted, (1.0,)


def multiply(p, q):
    a, b, c, d = p
    w, x, y, z = q
    return [a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w]


def conjugate(q):
    return [q[0], -q[1], -q[2], -q[3]]


def columns(case, t, which, step=STEP, digits=DIGITS):
    _, _, moments, c, start, data, attitude, _ = case
    moments, c, data = ([mpf(a) for a in x] for x in (moments, c, data))
    m = [a * b for a, b in zip(moments, data)] if start == "omega" else data
    q = unit(attitude)
    axis = max(range(3), key=lambda k: abs(c[k]))
    weight = max(abs(a) for a in c)
    size = sqrt(sum(a * a for a in m)) or max(moments) * sqrt(weight / max(moments))
    units = [mpf(1)] * 3 + [size] * 3 + [min(moments)] * 2 + [max(weight, size * size / max(moments))]

    def end(n, e):
        other, n_m, n_c, n_q = list(moments), list(m), list(c), list(q)
        if n < 3:
            turn = [cos(e / 2), *(sin(e / 2) if k == n else mpf(0) for k in range(3))]
            n_q = multiply(turn, q)
        elif n < 6:
            n_m[n - 3] += e
        elif n == 6:
            other = [i if k == axis else i + e for k, i in enumerate(moments)]
        elif n == 7:
            other = [i + e if k == axis else i for k, i in enumerate(moments)]
        else:
            n_c[axis] += e if c[axis] > 0 else -e
        return taylor(other, n_m, n_q, t, n_c, digits)

    found, scaled = [], mpf(0)
    for n in which:
        e = step * units[n]
        (m1, q1), (m2, q2) = end(n, e), end(n, -e)
        turn = [2 * a for a in multiply(q1, conjugate(q2))[1:]]
        column = [a / (2 * e) for a in turn] + [(a - b) / (2 * e) for a, b in zip(m1, m2)]
        found.append(column)
        scaled = max([scaled] + [abs(a) * units[n] * (1 if k < 3 else 1 / size) for k, a in enumerate(column)])
    return found, scaled


def main():
    mp.dps = DIGITS + 20
    cases = [(*case[:7], TIMES[case[0]]) for case in lagrange() if case[0] in TIMES] + list(further())
    with open(HERE / "derivative.csv", "w", newline="") as file:
        file.write("# Derivative of (rotation vector in space, momentum in the body) of Lagrange's top by the same at the start and by its\n")
        file.write("# transverse moment a, axial moment c and weight moment w\n")
        file.write("# python3 tests/data/tops/derivative.py (mpmath 1.3, Taylor series with 64 digits); 20 digits are printed\n")
        out = csv.writer(file, lineterminator="\n")
        names = [f"{a}_{b}" for b in ("r1", "r2", "r3", "m1", "m2", "m3", "a", "c", "w") for a in ("r1", "r2", "r3", "m1", "m2", "m3")]
        out.writerow("scenario,regime,I1,I2,I3,c1,c2,c3,start,s1,s2,s3,q0w,q0x,q0y,q0z,t".split(",") + names)
        count = 0
        for case in cases:
            name, regime, moments, c, start, data, attitude, times = case
            inputs = [name, regime, *(repr(float(a)) for x in (moments, c) for a in x), start,
                      *(repr(float(a)) for x in (data, attitude) for a in x)]
            for t in times:
                found, largest = columns(case, mpf(t), range(9))
                again = count % 9
                other, _ = columns(case, mpf(t), [again], STEP / 1000, DIGITS + 10)
                size = max(abs(a) for a in other[0]) or 1
                gap = max(abs(a - b) for a, b in zip(found[again], other[0])) / size
                assert gap < mpf(10) ** -32, (name, t, mp.nstr(gap, 3))
                out.writerow([*inputs, repr(t), *(mp.nstr(a, 20, strip_zeros=True, min_fixed=0, max_fixed=0) if abs(a) > mpf(10) ** -400 else "0"
                                                 for column in found for a in column)])
                file.flush()
                count += 1
                print(count, name, t, mp.nstr(largest, 5), flush=True)
    print("derivative.csv", count, "rows")


if __name__ == "__main__":
    main()
