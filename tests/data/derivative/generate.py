"""Writes experiments/data/derivative.csv: the derivative of the torque-free motion by its start and by the inertia tensor.

    python3 tests/data/derivative/generate.py        (python 3.11, mpmath 1.3)

Scenarios and the closed form of the motion are those of ../free_body/generate.py. The derivatives are central differences of it
with 400 digits and steps of 1e-60, so that nothing of the closed form of the derivative is used; a tensor with products of inertia
is turned to its principal axes first. Before a row is written one column of it is compared with differences of a Taylor
integration (../free_body/taylor.py) where the motion is short.
"""

import csv
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "free_body"))

from mpmath import mp, mpf, atan2, cos, hypot, sin

from generate import Motion, conjugate, multiply, norm, scenarios
from taylor import taylor

DIGITS = 400
STEP = mpf(10) ** -60
TENSOR = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
# next to the unstable axis a difference of 1e-60 is one no longer after this many e-folds
MOST_FOLDS = 40
EVERY = {"random": 4, "nearly symmetric": 2, "unstable axis": 3, "generic": 2}


def rotate(q, v):
    return multiply(multiply(q, [mpf(0), *v]), conjugate(q))[1:]


def with_product(moments, i, j, e):
    """Principal moments and axes (a quaternion) of the tensor with the product e for the axes i < j."""
    a, b = moments[i], moments[j]
    angle = atan2(2 * e, a - b) / 2
    mean, half = (a + b) / 2, hypot((a - b) / 2, e)
    out = list(moments)
    out[i], out[j] = mean + half, mean - half
    axis = [mpf(0)] * 3
    k = 3 - i - j
    axis[k] = sin(angle / 2) if (j - i) == 1 else -sin(angle / 2)
    return out, [cos(angle / 2), *axis]


def end(moments, m, q, t, entry=None, e=0, by=None):
    """Momentum and attitude at t, the entry of the tensor changed by e."""
    moments, turn = list(moments), [mpf(1), mpf(0), mpf(0), mpf(0)]
    if entry is not None:
        i, j = entry
        if i == j:
            moments[i] += e
        else:
            moments, turn = with_product(moments, i, j, e)
    back = conjugate(turn)
    start = rotate(back, m), multiply(q, turn)
    if by is None:
        after, attitude = Motion(moments, *start).at(t)
    else:
        after, attitude = by(moments, *start, t)
    return rotate(turn, after), multiply(attitude, back)


def difference(f, step, q):
    """Derivative of (rotation vector in space, momentum) by central differences."""
    (m1, q1), (m2, q2) = f(step), f(-step)
    if sum(a * b for a, b in zip(q1, q2)) < 0:
        q2 = [-a for a in q2]
    if sum(a * b for a, b in zip(q1, q)) < 0:
        q1, q2 = [-a for a in q1], [-a for a in q2]
    rate = [(a - b) / (2 * step) for a, b in zip(q1, q2)]
    turn = multiply(rate, conjugate(q))
    return [2 * a for a in turn[1:]] + [(a - b) / (2 * step) for a, b in zip(m1, m2)]


def columns(moments, m, q, t, by=None, step=STEP):
    now = end(moments, m, q, t, by=by)[1]
    size = max(abs(a) for a in m) or max(moments)
    found = []
    for k in range(3):
        def changed(e, k=k):
            other = list(m)
            other[k] += e
            return end(moments, other, q, t, by=by)
        found.append(difference(changed, step * size, now))
    for entry in TENSOR:
        found.append(difference(lambda e: end(moments, m, q, t, entry, e, by), step * max(moments), now))
    return found


def growth(moments, m):
    """Rate at which a deviation grows where the motion never leaves the unstable axis, or never comes back."""
    l, mu, h = sorted(moments)
    return norm(m) / mu * mp.sqrt((h - mu) * (mu - l) / (h * l))


def check(moments, m, q, t, found):
    def by(moments, m, q, t):
        return taylor(moments, m, q, t, digits=80)

    other = columns(moments, m, q, t, by, mpf(10) ** -30)
    largest = max(abs(a) for column in found for a in column)
    error = max(abs(a - b) for x, y in zip(found, other) for a, b in zip(x, y)) / largest
    assert error < mpf(10) ** -35, mp.nstr(error, 5)


def main():
    seen, rows, checked = {}, 0, 0
    with open(HERE.parents[2] / "experiments/data/derivative.csv", "w", newline="") as file:
        file.write("# Derivative of (rotation vector in space, momentum in the body) by (momentum in the body, xx, yy, zz, xy, xz, yz)\n")
        file.write("# python3 tests/data/derivative/generate.py (mpmath 1.3, 400 digits); 20 digits are printed\n")
        file.write("# start names the datum s1..s3 (m or omega, body axes); q0 is normalised exactly; t, I, s, q0 are exact doubles\n")
        out = csv.writer(file, lineterminator="\n")
        names = [f"{a}_{b}" for b in ("m1", "m2", "m3", "xx", "yy", "zz", "xy", "xz", "yz")
                 for a in ("r1", "r2", "r3", "m1", "m2", "m3")]
        out.writerow(["scenario", "regime", "I1", "I2", "I3", "start", "s1", "s2", "s3", "q0w", "q0x", "q0y", "q0z", "t", *names])
        mp.dps = DIGITS
        for scenario in scenarios():
            count = seen[scenario.regime] = seen.get(scenario.regime, -1) + 1
            if count % EVERY.get(scenario.regime, 1):
                continue
            moments = [mpf(a) for a in scenario.moments]
            data = [mpf(a) for a in scenario.data]
            m = [a * b for a, b in zip(moments, data)] if scenario.start == "omega" else data
            q = [mpf(a) for a in scenario.attitude]
            q = [a / norm(q) for a in q]
            times = list(scenario.times)
            if scenario.regime in ("separatrix", "pure spin"):
                times = [t for t in times if abs(t) * growth(moments, m) < MOST_FOLDS or
                         scenario.regime == "pure spin" and scenario.name[5] != "2"]
            # one time each, another from scenario to scenario
            t = times[count // EVERY.get(scenario.regime, 1) % len(times)]
            found = columns(moments, m, q, mpf(t))
            if abs(t) * norm(m) / min(moments) < 15 and t:
                check(moments, m, q, mpf(t), found)
                checked += 1
            digits = [mp.nstr(a, 20, strip_zeros=True, min_fixed=0, max_fixed=0) if a else "0" for c in found for a in c]
            out.writerow([scenario.name, scenario.regime, *map(repr, scenario.moments), scenario.start,
                          *map(repr, scenario.data), *map(repr, scenario.attitude), repr(t), *digits])
            rows += 1
            print(rows, scenario.name, t, flush=True)
    print(rows, "rows,", checked, "compared with Taylor integrations")


if __name__ == "__main__":
    main()
