"""Coefficients of the sine and cosine kernels of src/num/trig.rs.

Interpolates (sin x - x)/x^3 and (cos x - 1 + x^2/2)/x^4 as polynomials of z = x^2 on [0, (pi/4)^2] with 60
digits. The nodes are those of a Chebyshev polynomial one degree higher whose first node is moved to z = 0,
because the error is multiplied by a power of z. Coefficients are rounded one by one, lowest degree first,
and those above are fitted again. Prints them with the largest error that they leave in sin x / x and cos x.

    python3 tests/data/num/kernel.py
"""
from mpmath import mp, mpf, matrix, lu_solve, pi, sqrt, sin, cos

mp.dps = 60
TERMS = 6
END = (pi / 4) ** 2 * (1 + mpf(2) ** -20)
FIRST = cos(pi / (2 * TERMS + 2))
NODES = [END * (FIRST - cos(pi * (2 * k + 1) / (2 * TERMS + 2))) / (FIRST + 1) for k in range(1, TERMS + 1)]


def sine(z):
    x = sqrt(z)
    return (sin(x) - x) / (z * x)


def cosine(z):
    return (cos(sqrt(z)) - 1 + z / 2) / (z * z)


def fit(f):
    rounded = []
    for n in range(TERMS):
        nodes = NODES[n:]
        powers = matrix([[z**k for k in range(n, TERMS)] for z in nodes])
        rest = matrix([f(z) - mp.polyval(rounded[::-1] or [0], z) for z in nodes])
        rounded.append(mpf(float(lu_solve(powers, rest)[0])))
    return rounded


for name, f, weight in [("SIN", sine, lambda z: z), ("COS", cosine, lambda z: z * z)]:
    coefficients = fit(f)
    grid = [END * k / 500 for k in range(1, 501)]
    error = max(abs(mp.polyval(coefficients[::-1], z) - f(z)) * weight(z) for z in grid)
    print(name, [float(c) for c in coefficients], "error 2^%.1f" % mp.log(error, 2))
