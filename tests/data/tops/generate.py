"""Writes reference.csv: rigid bodies turning about a fixed point under uniform gravity.

    python3 tests/data/tops/generate.py        (python 3.11, mpmath 1.3; about three minutes)

    m' = m x w + G x c,   q' = q o (0, w)/2,   w = m/I,   G = Q^T e_z       q scalar first, active, body to space

c is the weight moment, potential c.G. Every value is a Taylor integration (../free_body/taylor.py) done twice,
with different step, order and digits; the two agree to 32 digits, energy and m.G are kept to 34, and the values
of tabulated problems are reproduced to the digits they were given with. The quaternion is the continuous lift.
"""

import csv
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "free_body"))

from mpmath import cos, mp, mpf, pi, sin, sqrt

from taylor import taylor_at, vertical

mp.dps = 80
COLUMNS = "scenario,regime,I1,I2,I3,c1,c2,c3,start,s1,s2,s3,q0w,q0x,q0y,q0z,t,m1,m2,m3,qw,qx,qy,qz".split(",")
ONE = (1, 0, 0, 0)
HALF = (2, 1, 0, 0)  # tilt with cos 3/5, sin 4/5


def steady_cone():
    """A cone that precesses steadily at the tilt of 60 degrees (Kinon & Betsch 2021)."""
    a, density, g, rate = mpf("0.1"), 2700, mpf("9.81"), 10
    r, arm = a / 2, 3 * a / 4
    mass = density * pi * r * r * a / 3
    across = 3 * mass * (4 * r * r + a * a) / 80 + mass * arm * arm
    along = 3 * mass * r * r / 10
    tilt = pi / 3
    spin = mass * g * arm / (along * rate) + (across - along) / along * rate * cos(tilt)
    w = [0, rate * sin(tilt), rate * cos(tilt) + spin]
    return (across, across, along), (0, 0, mass * g * arm), w, (cos(tilt / 2), sin(tilt / 2), 0, 0)


def problems():
    """name, regime, moments, weight moment, datum, its values, attitude, times; decimals as the sources give them."""
    d = mpf
    e3 = (d("0.2"), 1, d("0.4"))
    q3 = (d("0.4"), d("0.2"), d("0.4"), d("0.8"))
    yield "E3-asymmetric", "GNI Fig. VII.5.3", (d("0.5"), d("0.85"), 1), (0, 0, 1), "momentum", e3, q3, (1, 10, 30)
    yield "E3-symmetric", "GNI Fig. VII.5.3", (d("0.5"), d("0.5"), 1), (0, 0, 1), "momentum", e3, q3, (1, 10, 30)
    tilt = d("0.025")
    yield "E8", "Simo-Wong top", (5, 5, 1), (0, 0, 20), "momentum", (0, 0, 50), (cos(tilt), sin(tilt), 0, 0), (1, 5, 10)
    moments = (d("15.234375"), d("0.46875"), d("15.234375"))
    yield "E9", "Bruls-Cardona top", moments, (0, 15 * d("9.81"), 0), "omega", (0, 150, d("-4.61538")), ONE, (d("0.25"), 1, 2)
    m10 = (d("0.7"), d("-0.4"), d("0.9"))
    q10 = (d("0.9"), d("0.2"), d("-0.3"), d("0.4"))
    yield "E10", "Kovalevskaya", (2, 2, 1), (d("1.3"), 0, 0), "momentum", m10, q10, (1, 5, 20)
    moments, weight, w, q = steady_cone()
    yield "E12", "steady precession", moments, weight, "omega", w, q, (d("0.1"), 1, 10)


# 25-digit values found earlier with another program, for the decimal data: t, m, q.
KNOWN = {
    "E3-asymmetric": (
        (
            30,
            "0.8892003690195950197027259 -0.7520406396481287944896395 -0.1455999916307837035138904 "
            "0.5106044768111815597478276 -0.1524611480459563939368534 -0.6241947790847731015112367 0.5713313787638482437388637",
        ),
    ),
    "E3-symmetric": (
        (
            30,
            "0.9599571778198638481540976 -0.3641697256994491534733072 0.4 "
            "-0.4355609855843944444844289 -0.3700636549040741956285874 0.2648047913104729893167394 -0.7766710639999446163680096",
        ),
    ),
    "E8": (
        (
            10,
            "-0.1530919972091360236193383 0.1432648708666014390295241 50 "
            "0.2438016485933434999564366 0.01959979642167834919184472 -0.01872492295926492034306687 -0.9694462240803077198016318",
        ),
    ),
    "E9": (
        (
            2,
            "1.862146703280615326056242 70.3125 -89.20678085117689507943945 "
            "0.1229471350415334671042516 -0.4910798925500270146990447 0.3504300303436209618390203 -0.787986887550485669324174",
        ),
    ),
    "E10": (
        (
            20,
            "1.80415888725763036555151 -2.080945814434444747963031 0.001963537266798164916745859 "
            "-0.2122689372234242426830881 0.5872074864549525383820862 0.5696517185953487292128853 -0.5344400674001345232261687",
        ),
    ),
}


def lagrange():
    """Symmetric tops, weight along the symmetry axis."""
    short, medium = (0.5, 3.0, 20.0), (1.0, 10.0, 100.0)
    top = (1.25, 1.25, 0.75)
    tilted = (0.9, 0.3, -0.2, 0.4)
    yield "generic", "generic", top, (0, 0, 2), "omega", (0.75, -0.5, 3), tilted, (-3.0, 0.0, 0.5, 10.0, 100.0)
    yield "generic-long", "a thousand nutations", top, (0, 0, 0.5), "omega", (0.25, -0.5, 1.5), tilted, (100.0, 1000.0, 5000.0)
    yield "generic-flat", "generic", (0.625, 0.625, 1), (0, 0, 1.5), "omega", (0.3, 0.9, 2.2), tilted, medium
    yield "fast", "fast top", top, (0, 0, 1), "omega", (0.1, 0.2, 60), tilted, (1.0, 10.0)
    yield "axis-1", "symmetry about axis 1", (0.75, 1.25, 1.25), (-1.5, 0, 0), "omega", (2, 0.5, -0.75), tilted, medium
    yield "hanging-weight", "negative weight", top, (0, 0, -2), "omega", (0.75, -0.5, 3), tilted, medium
    yield "sleeping", "upright", top, (0, 0, 2), "omega", (0, 0, 8), ONE, medium
    yield "sleeping-unstable", "upright", top, (0, 0, 2), "omega", (0, 0, 1), ONE, medium
    yield "upright-nudged", "through upright", top, (0, 0, 2), "omega", (0.5, 0, 8), ONE, short
    yield "upright-falls", "through upright", top, (0, 0, 2), "omega", (0.001, 0, 1), ONE, short
    yield "tilt-1e-6-stable", "next to upright", top, (0, 0, 2), "omega", (0, 0, 8), (1, 5e-7, 0, 0), short
    yield "tilt-1e-6-unstable", "next to upright", top, (0, 0, 2), "omega", (0, 0, 1), (1, 5e-7, 0, 0), short
    yield "tilt-1e-3-critical", "next to upright", (1, 1, 0.5), (0, 0, 1), "omega", (0, 0, 4), (1, 5e-4, 0, 0), medium
    yield "cusps", "cuspidal, from its upper circle", top, (0, 0, 2), "omega", (0, 0, 6), HALF, medium
    yield "loops", "looping, from its upper circle", top, (0, 0, 2), "omega", (0, -1.5, 6), HALF, medium
    yield "waves", "from its upper circle", top, (0, 0, 2), "omega", (0, 0.25, 6), HALF, medium
    yield "lower-circle", "from its lower circle", top, (0, 0, 2), "omega", (0, 4, 3), HALF, medium
    # m_3^2 = 2 A c (1 + cos) and m_2 = m_3 tan of the half tilt: energy and m.G of the sleeping top.
    yield "homoclinic", "sleeping top's separatrix", (2.5, 2.5, 1.5), (0, 0, 2), "momentum", (0, 2, 4), HALF, (-2.0, 1.0, 5.0, 20.0)
    yield "homoclinic-near", "next to the separatrix", (2.5, 2.5, 1.5), (0, 0, 2), "momentum", (0, 2, 4.000000000000001), HALF, (1.0, 20.0, 100.0)
    yield "hanging-spin", "hanging", top, (0, 0, 2), "omega", (0, 0, 3), (0, 1, 0, 0), medium
    yield "through-hanging", "through hanging", top, (0, 0, 2), "omega", (0.5, -0.25, 3), (0, 1, 0, 0), medium
    yield "spherical-pendulum", "no spin", top, (0, 0, 2), "omega", (0.5, 0.75, 0), HALF, medium
    yield "plane-pendulum", "through upright and hanging", top, (0, 0, 2), "omega", (2.5, 0, 0), HALF, short
    yield "ball", "spherical inertia", (1, 1, 1), (0, 0, 1.5), "omega", (0.5, -0.25, 2), tilted, medium
    yield "flea", "scale", (1.25e-12, 1.25e-12, 0.75e-12), (0, 0, 3e-9), "omega", (20, -30, 150), tilted, (0.05, 1.0)


def unit(q):
    q = [mpf(a) for a in q]
    r = sqrt(sum(a * a for a in q))
    return [a / r for a in q]


def gap(x, y):
    (m, q), (n, p) = x, y
    size = sqrt(sum(a * a for a in m)) or 1
    return max([abs(a - b) / size for a, b in zip(m, n)] + [abs(a - b) for a, b in zip(q, p)])


def solve(case, digits=(56, 48), agree=32):
    """(m, q) at each time, by two integrations that must agree."""
    name, _, moments, c, start, data, attitude, times = case
    moments, c, data, times = ([mpf(a) for a in x] for x in (moments, c, data, times))
    m = [a * b for a, b in zip(moments, data)] if start == "omega" else data
    q = unit(attitude)
    scale = sum(a * a / b for a, b in zip(m, moments)) / 2 + sqrt(sum(a * a for a in c))

    def invariants(m, q):
        g = vertical(q)
        energy = sum(a * a / b for a, b in zip(m, moments)) / 2 + sum(a * b for a, b in zip(c, g))
        return energy / scale, sum(a * b for a, b in zip(m, g)) / sqrt(scale * max(moments))

    found = []
    for backward in (True, False):
        side = [t for t in times if (t < 0) == backward]
        side.sort(key=abs)
        runs = [taylor_at(moments, m, q, side, c, d) for d in digits]
        for t, one, other in zip(side, *runs):
            assert gap(one, other) < mpf(10) ** -agree, (name, t, mp.nstr(gap(one, other), 3))
            drift = max(abs(a - b) for a, b in zip(invariants(m, q), invariants(*one)))
            assert drift < mpf(10) ** -34, (name, t, "invariants", mp.nstr(drift, 3))
            found.append((t, one))
    return sorted(found, key=lambda x: x[0])


def check_known(case):
    for t, values in solve(case):
        for known_t, texts in KNOWN.get(case[0], ()):
            if t == known_t:
                for text, value in zip(texts.split(), values[0] + values[1]):
                    assert abs(mpf(text) - value) <= abs(value) * mpf(10) ** -23 + mpf(10) ** -24, (case[0], text, value)
        if case[0] == "E12":
            assert abs(vertical(values[1])[2] - mpf(1) / 2) < mpf(10) ** -34, "steady precession"


def in_doubles(case):
    name, regime, moments, c, start, data, attitude, times = case
    return (name, regime, *([float(a) for a in x] for x in (moments, c)), start, *([float(a) for a in x] for x in (data, attitude, times)))


def shown(x):
    return "0" if abs(x) < mpf(10) ** -400 else mp.nstr(x, 32, strip_zeros=True, min_fixed=-5, max_fixed=5)


def main():
    references = list(problems())
    for case in references:
        check_known(case)
    with open(HERE / "reference.csv", "w", newline="") as file:
        file.write("# Heavy tops: published problems (E...) and Lagrange's top by kind of motion\n")
        file.write("# python3 tests/data/tops/generate.py (mpmath 1.3, Taylor series, 48 and 56 digits kept a step); 32 digits are printed\n")
        file.write("# start names the datum s1..s3 (m or omega, body axes); q0 is normalised exactly; t, I, c, s, q0 are exact doubles;\n")
        file.write("# potential c.(Q^T e_z); m in body axes; q scalar first, active, body to space, the continuous lift from q0\n")
        out = csv.writer(file, lineterminator="\n")
        out.writerow(COLUMNS)
        count = 0
        for case in [in_doubles(a) for a in [*references, *lagrange()]]:
            name, regime, moments, c, start, data, attitude, _ = case
            inputs = [name, regime, *map(repr, moments), *map(repr, c), start, *map(repr, data), *map(repr, attitude)]
            for t, (m, q) in solve(case):
                out.writerow([*inputs, repr(float(t)), *map(shown, m), *map(shown, q)])
                count += 1
            file.flush()
    print("reference.csv", count, "rows")


if __name__ == "__main__":
    main()
