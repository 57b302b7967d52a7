"""Writes asymmetric.csv: a free body at 25 Hz for 20 s, from elliptic functions at 40 digits (mpmath 1.3).

python3 tests/data/fit/generate.py > tests/data/fit/asymmetric.csv

Nothing here is shared with the library: Euler's equations are solved by sn, cn, dn (Landau and Lifshitz, Mechanics,
section 37) in the eigenframe of the tensor; normal deviates are Python's own, seed 2024, sigma 1e-3 rad/s.
"""

import random

import mpmath as mp

mp.mp.dps = 40
J = mp.matrix([[0.25, -0.03, 0.02], [-0.03, 0.35, 0.05], [0.02, 0.05, 0.4]])
moments, axes = mp.eigsy(J)
order = sorted(range(3), key=lambda k: moments[k])
a, b, c = (moments[k] for k in order)
e = mp.matrix(3, 3)
for column, k in enumerate(order):
    for row in range(3):
        e[row, column] = axes[row, k]
if mp.det(e) < 0:
    e[:, 2] = -e[:, 2]

w = e.T * mp.matrix([1.1, -0.7, 1.9])
# Landau's start has w_b = 0 at t = 0; the phase is put into the time, the sign into s1
T2 = a * w[0] ** 2 + b * w[1] ** 2 + c * w[2] ** 2
L2 = (a * w[0]) ** 2 + (b * w[1]) ** 2 + (c * w[2]) ** 2
if L2 < T2 * b:
    raise SystemExit("the start must circulate about the axis of the largest moment")
s1 = mp.sqrt((T2 * c - L2) / (a * (c - a)))
s2 = mp.sqrt((T2 * c - L2) / (b * (c - b)))
s3 = mp.sqrt((L2 - T2 * a) / (c * (c - a)))
rate = mp.sqrt((c - b) * (L2 - T2 * a) / (a * b * c))
m = (b - a) * (T2 * c - L2) / ((c - b) * (L2 - T2 * a))


def body(tau):
    return s1 * mp.ellipfun("cn", tau, m=m), s2 * mp.ellipfun("sn", tau, m=m), s3 * mp.ellipfun("dn", tau, m=m)


draw = random.Random(2024)
print("t,wx,wy,wz")
for i in range(501):
    v = e * mp.matrix(body(rate * i / 25 + mp.mpf("0.3")))
    print(",".join([f"{i / 25}"] + [f"{float(v[k]) + draw.gauss(0, 1e-3):.7f}" for k in range(3)]))
