#!/usr/bin/env python3
"""Largest values in the proof of the theorem on rounding errors: python3 bound.py (needs numpy).

Errors are in roundings, relative to sqrt(|Z|^2 + |W|^2). A coefficient p_k of (p_0 + p_1 X) + X^2 (p_2 + p_3 X) meets
3, 4, 5, 6 roundings: its own, its products and its sums; the factors outside add theirs.
"""

import numpy as np

KERNEL = 0.76  # error of sine and cosine
FIRST = {"cos": (1, 0, 1), "sin": (0, 1, 0), "sin odd": (1, 1, 2), "cos odd": (1, -1, 2)}


def polynomial(terms, kind):
    """Coefficients of powers of X: F_(n+1) = 2 X F_n - F_(n-1) from F_0 = c, F_1 = a + b X."""
    c, a, b = FIRST[kind]
    size = len(terms)
    total, before, now = np.zeros(size), np.zeros(size), np.zeros(size)
    before[0], now[0], now[1] = c, a, b
    for term in terms:
        total += term * before
        following = np.concatenate([[0], 2 * now[:-1]]) - before
        before, now = now, following
    return total


def value(p, x):
    return p[0] + p[1] * x + x * x * (p[2] + p[3] * x)


def error(p, x, of_x, outside):
    """Of the polynomial at x with the error `of_x`, and of `outside` products."""
    counts = np.arange(3, 7) + outside
    rounded = sum(n * abs(c) * abs(x) ** k for k, (n, c) in enumerate(zip(counts, p)))
    return rounded + abs(p[1] + 2 * p[2] * x + 3 * p[3] * x * x) * of_x


def norm(*parts):
    return np.sqrt(sum(abs(part) ** 2 for part in parts))


def speed(z, w, x):
    unit = np.stack([z, w]) / norm(z, w)
    return norm(*np.gradient(unit, x, axis=1, edge_order=2))


def direct(nome, v, x):
    """Error of the sums, and how fast the pair moves with x."""
    n, g = np.arange(4), nome / v
    sign = (-1.0) ** n
    one, two = nome ** (2 * n * n - n) * v**n, nome ** (2 * n * n) * g**n
    even, odd = sign * (one + two), sign * (one - two)
    even[0] = 1
    z0, z1 = polynomial(even, "cos"), polynomial(odd, "sin")
    one, two = nome ** (2 * n * n + n) * v**n, nome ** (2 * n * n + 2 * n) * g ** (n + 1)
    w0 = polynomial(np.sqrt(v) * sign * (one + two), "sin odd")
    w1 = polynomial(np.sqrt(v) * sign * (one - two), "cos odd")
    s, c = np.sin(x), np.cos(x)
    big = (c - s) * (c + s)
    of_x = 3 * abs(big) + 2 * (abs(s) + abs(c)) * KERNEL
    z = value(z0, big) + 2j * s * c * value(z1, big)
    w = s * value(w0, big) + 1j * c * value(w1, big)
    total = norm(
        error(z0, big, of_x, 0),
        abs(2 * s * c) * error(z1, big, of_x, 2) + 2 * (abs(s) + abs(c)) * KERNEL * abs(value(z1, big)),
        abs(s) * error(w0, big, of_x, 1) + KERNEL * abs(value(w0, big)),
        abs(c) * error(w1, big, of_x, 1) + KERNEL * abs(value(w1, big)),
    )
    return (total / norm(z, w)).max(), speed(z, w, x).max()


def dual(nome, xi, chi):
    """Error of the sums, how fast the pair moves with chi, and |chi| times that."""
    n = np.arange(4)
    weight = nome ** (n * (n + 1) / 2)
    even, odd = weight * np.cos((2 * n + 1) * xi), weight * np.sin((2 * n + 1) * xi)
    sign = (-1.0) ** n
    z0, z1 = polynomial(even, "cos odd"), polynomial(odd, "sin odd")
    w0, w1 = polynomial(even * sign, "sin odd"), polynomial(odd * sign, "cos odd")
    sinh, cosh = np.sinh(chi), np.cosh(chi)
    big = np.cosh(2 * chi)
    of_x, of_each = 4 * big, 1.5 * cosh  # 1/e^chi and the sum or difference
    z = cosh * value(z0, big) + 1j * sinh * value(z1, big)
    w = sinh * value(w0, big) + 1j * cosh * value(w1, big)
    total = norm(
        *(
            factor * error(p, big, of_x, 1) + of_each * abs(value(p, big))
            for factor, p in [(cosh, z0), (sinh, z1), (sinh, w0), (cosh, w1)]
        )
    )
    fast = speed(z, w, chi)
    return (total / norm(z, w)).max(), fast.max(), (fast * chi).max()


def main():
    x = np.linspace(0, np.pi, 721)
    cells = [(q, q + (1 - q) * part) for q in np.linspace(1e-9, 0.2, 80) for part in np.linspace(0, 1, 80)]
    sums, fast = np.max([direct(q, v, x) for q, v in cells], axis=0)
    print(f"direct form: sums {sums:.2f}, speed {fast:.3f}")
    largest = np.exp(-np.pi**2 / np.log(5))
    cells = [
        (q, xi)
        for q in np.concatenate([np.geomspace(1e-30, 1e-5, 20), np.linspace(1e-5, largest, 60)])
        for xi in np.linspace(0, np.pi / 4, 80)
    ]
    sums, fast, shifted = np.max(
        [dual(q, xi, np.linspace(0, min(-np.log(q) / 4, 30), 400)) for q, xi in cells], axis=0
    )
    print(f"dual form: sums {sums:.2f}, speed {fast:.3f}, |chi| times speed {shifted:.3f}")


if __name__ == "__main__":
    main()
