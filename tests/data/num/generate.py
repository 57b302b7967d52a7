"""Reference values for tests/num.rs: dd.csv, trig.csv and elliptic.csv beside this file.

Inputs are doubles (a double-double input is two of them, high part first) and are taken exactly. Values are
computed by mpmath with at least 60 digits, 150 for the elliptic functions, and printed with 40.

    python3 tests/data/num/generate.py
"""
import csv
import math
import pathlib
import random

from mpmath import (mp, mpf, acos, atan2, cos, ellipf, ellipfun, ellipk, elliprc, elliprd, elliprf, elliprj,
                    exp, expm1, ldexp, log, nstr, pi, sin, sqrt, tanh, sech)

HERE = pathlib.Path(__file__).parent
RANDOM = random.Random(1)
mp.dps = 150


def write(name, header, rows):
    with open(HERE / name, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(header)
        for row in rows:
            out.writerow([nstr(x, 40) if isinstance(x, mpf) else repr(x) if isinstance(x, float) else x for x in row])


# Double-double numbers.


def near(x):
    """A double-double number whose high part is x."""
    return float(x), math.ulp(x) * RANDOM.uniform(-0.5, 0.5)


def nearest(x):
    """The double-double number nearest to x."""
    return float(x), float(x - mpf(float(x)))


def either(low, high):
    """A number of either sign with a size spread evenly over the decades from low to high."""
    return RANDOM.choice([-1, 1]) * 10 ** RANDOM.uniform(math.log10(low), math.log10(high))


def dd_rows():
    zero = (0.0, 0.0)

    def value(x):
        return mpf(x[0]) + mpf(x[1])

    def row(function, regime, a, b=zero):
        x, y = value(a), value(b)
        result = {
            "add": lambda: x + y, "mul": lambda: x * y, "div": lambda: x / y, "sqrt": lambda: sqrt(x),
            "sin": lambda: sin(x), "cos": lambda: cos(x), "atan2": lambda: atan2(x, y), "exp": lambda: exp(x),
            "exp_m1": lambda: expm1(x), "ln": lambda: log(x),
        }[function]()
        return [function, regime, *a, *b, result]

    for _ in range(30):
        a, b = near(either(1e-3, 1e3)), near(either(1e-3, 1e3))
        yield row("add", "sizes 1e-3 to 1e3", a, b)
        for function in ("mul", "div"):
            yield row(function, "sizes 1e-3 to 1e3", a, b)
            yield row(function, "sizes 1e-140 to 1e140", near(either(1e-140, 1e140)), near(either(1e-140, 1e140)))
        yield row("add", "cancelling", a, near(-a[0] * (1 + 2.0 ** RANDOM.randint(-60, -20))))
        yield row("sqrt", "1e-280 to 1e300", near(abs(either(1e-280, 1e300))))
    for _ in range(24):
        for function in ("sin", "cos"):
            yield row(function, "below π/4", near(either(1e-12, 0.78)))
            yield row(function, "to 100", near(either(0.8, 100)))
            yield row(function, "to 1e15", near(either(100, 1e15)))
            zero_of = RANDOM.randint(1, 10**RANDOM.randint(1, 14)) * pi + (0 if function == "sin" else pi / 2)
            yield row(function, "nearest to a zero", nearest(zero_of))
            yield row(function, "nearest f64 to a zero", (float(zero_of), 0.0))
        yield row("atan2", "any quadrant", near(either(1e-3, 1e3)), near(either(1e-3, 1e3)))
        yield row("atan2", "near the axes", near(either(1e-30, 1e-3)), near(either(1, 10)))
        yield row("atan2", "near the axes", near(either(1, 10)), near(either(1e-30, 1e-3)))
        yield row("atan2", "sizes 1e±300", near(either(0.1, 10) * 1e300), near(either(0.1, 10) * 1e300))
        yield row("atan2", "sizes 1e±300", near(either(0.1, 10) * 1e-280), near(either(0.1, 10) * 1e-280))
        yield row("exp", "below 1", near(either(1e-20, 1)))
        yield row("exp", "to 600", near(either(1, 600)))
        yield row("exp_m1", "below 1", near(either(1e-20, 1)))
        yield row("exp_m1", "to 600", near(either(1, 600)))
        yield row("ln", "near 1", near(1 + either(1e-15, 0.3)))
        yield row("ln", "1e-280 to 1e300", near(abs(either(1e-280, 1e300))))
    for n in (-1, 1):
        for distance in (0, 2.0**-60, -(2.0**-53)):
            yield row("atan2", "near the axes", near(1.0 + distance), near(n * 1.0))
            yield row("ln", "near 1", (1.0, n * 2.0**-60))


# Sine and cosine of doubles: a check of the sample against Dd in tests/num.rs, and the hardest arguments.


def trig_rows():
    def row(x):
        return [x, sin(mpf(x)), cos(mpf(x))]

    for n in [1, 2, 3, 5, 8, 13, 100, 1001, 11111, 350000, 667543, 10**9, 10**15]:
        for x in (float(n * pi / 2), float(n * pi / 4), math.nextafter(float(n * pi / 4), 0)):
            yield row(x)
    for k in range(-300, 6, 15):
        yield row(float(f"1e{k}"))
    for x in (0.1, -0.2, 0.3, 0.5, -0.7, 0.78539, 1.0, -2.0, 3.0, 10.0, 1e22, 1.7976931348623157e308):
        yield row(x)
    # The double closest to a multiple of π/2 of all (J.-M. Muller, Elementary functions).
    yield row(6381956970095103.0 * 2.0**797)


# Elliptic integrals and functions.

MODULI = [
    ("m1 > 1", [1.0000000000000002, 4.0]),
    ("m1 ≥ 0.1", [1.0, 0.999999, 0.9, 0.5, 0.1]),
    ("1e-8 ≤ m1 < 0.1", [0.03, 1e-3, 1e-5, 1e-8]),
    ("1e-40 ≤ m1 < 1e-8", [1e-12, 1e-17, 1e-25, 1e-40]),
    ("m1 = 0", [0.0]),
]


def carlson_rows():
    def row(function, regime, *arguments):
        arguments = [float(x) for x in arguments]
        exact = [mpf(x) for x in arguments]
        result = {"r_f": elliprf, "r_c": elliprc, "r_j": elliprj, "r_d": elliprd}[function](*exact)
        return [function, regime, *arguments, *[0.0] * (4 - len(arguments)), +result.real]

    def size(low, high):
        return abs(either(low, high))

    for regime, low, high in [("sizes 1e-1 to 1e1", 1e-1, 1e1), ("sizes 1e-20 to 1e20", 1e-20, 1e20)]:
        for _ in range(20):
            x, y, z, p = (size(low, high) for _ in range(4))
            yield row("r_f", regime, x, y, z)
            yield row("r_c", regime, x, y)
            yield row("r_j", regime, x, y, z, p)
            yield row("r_d", regime, x, y, z)
    for _ in range(12):
        m1, p = size(1e-40, 1), 1 + size(1e-6, 1e6)
        yield row("r_f", "complete (0 m1 1)", 0, m1, 1)
        yield row("r_d", "complete (0 m1 1)", 0, m1, 1)
        yield row("r_d", "complete (0 m1 1)", 0, 1, m1)
        yield row("r_j", "complete (0 m1 1 p) with p ≥ 1", 0, m1, 1, p)
        yield row("r_c", "complete (0 y)", 0, m1)
        yield row("r_j", "p = 1e-20 to 1e-6", size(0.1, 1), size(0.1, 1), 1, size(1e-20, 1e-6))
    yield row("r_f", "sizes 1e-1 to 1e1", 1, 1, 1)
    yield row("r_j", "sizes 1e-1 to 1e1", 1, 1, 1, 1)
    yield row("r_c", "sizes 1e-1 to 1e1", 1, 1 + 2.0**-40)


def functions_of(u, m1):
    u, m1 = mpf(u), mpf(m1)
    if m1 == 0:
        return tanh(u), sech(u), sech(u)
    if m1 == 1:
        return sin(u), cos(u), mpf(1)
    return tuple(mpf(ellipfun(name, u, m=1 - m1).real) for name in ("sn", "cn", "dn"))


def jacobi_rows():
    for regime, complements in MODULI:
        for m1 in complements:
            quarter = ellipk(1 - mpf(m1)) if m1 else mpf(40)
            if m1:
                yield ["quarter_period", regime, m1, 0.0, 0.0, 0.0, +quarter]
            inside = [1e-200, 1e-9] + [float(quarter) * f for f in (0.03, 0.2, -0.4, 0.6, 0.8, -0.97)]
            points = [(regime, u) for u in inside]
            if m1:
                points += [(f"{regime} and next to K", float(quarter * (1 - mpf(10) ** -n))) for n in (4, 8, 12)]
            for where, u in points:
                for name, value in zip(("sn", "cn", "dn"), functions_of(u, m1)):
                    yield [name, where, u, m1, 0.0, 0.0, value]
            for cn in (1.0, 0.999, 0.5, 1e-3, 1e-9, 1e-30):
                if m1 and cn < 1:
                    yield ["incomplete", regime, cn, m1, 0.0, 0.0, +ellipf(acos(mpf(cn)), 1 - mpf(m1)).real]
    for m1 in (0.7, 1e-10):
        for u in (1e3, -1e6, 1e9, 1e12):
            for name, value in zip(("sn", "cn", "dn"), functions_of(u, m1)):
                yield [name, "u to 1e12", u, m1, 0.0, 0.0, value]


write("dd.csv", ["function", "regime", "a_hi", "a_lo", "b_hi", "b_lo", "value"], dd_rows())
write("trig.csv", ["x", "sin", "cos"], trig_rows())
write("elliptic.csv", ["function", "regime", "a", "b", "c", "d", "value"], list(carlson_rows()) + list(jacobi_rows()))
