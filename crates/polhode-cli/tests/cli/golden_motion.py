"""Largest distance of each GOLDEN.csv from its own start integrated in 26 digits: python3 golden_motion.py GOLDEN.csv ...

Gragg's modified midpoint rule with Richardson extrapolation (Bulirsch and Stoer 1966), a step a row, in decimal arithmetic:
nothing is shared with the program that writes the files. Prints name, largest angle (rad) and largest difference of omega (rad/s).
"""
import sys
from decimal import Decimal, getcontext

getcontext().prec = 26
LEVELS = 9


def product(a, b):
    return [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def rate(y, moments, weight):
    q, omega = y[:4], y[4:]
    momentum = [i * w for i, w in zip(moments, omega)]
    # the vertical in body axes
    up = [2 * (q[1] * q[3] - q[0] * q[2]), 2 * (q[2] * q[3] + q[0] * q[1]), q[0] ** 2 - q[1] ** 2 - q[2] ** 2 + q[3] ** 2]
    torque = [a + b for a, b in zip(cross(momentum, omega), cross(up, weight))]
    return [x / 2 for x in product(q, [Decimal(0)] + omega)] + [t / i for t, i in zip(torque, moments)]


def along(y, h, k):
    return [a + h * b for a, b in zip(y, k)]


def step(y, span, *body):
    table = []
    for level in range(LEVELS):
        count = 2 * (level + 1)
        h = span / count
        a, b = y, along(y, h, rate(y, *body))
        for _ in range(count - 1):
            a, b = b, along(a, 2 * h, rate(b, *body))
        row = [[(p + q) / 2 for p, q in zip(a, along(b, h, rate(b, *body)))]]
        for j in range(level):
            ratio = (Decimal(count) / (2 * (level - j))) ** 2
            row.append([p + (p - q) / (ratio - 1) for p, q in zip(row[j], table[j])])
        table = row
    return table[-1]


for name in sys.argv[1:]:
    with open(name) as file:
        lines = file.read().splitlines()
    numbers = lambda text: [Decimal(x) for x in text.split(",")]
    body = [numbers(line.split(":")[1]) for line in lines[1:3]]
    # a double is not the decimal that is printed for it
    rows = [[Decimal(float(x)) for x in line.split(",")] for line in lines if line[0] in "0123456789"]
    norm = sum(x * x for x in rows[0][1:5]).sqrt()
    y = [x / norm for x in rows[0][1:5]] + rows[0][5:]
    angle, omega = 0.0, 0.0
    for before, row in zip(rows, rows[1:]):
        y = step(y, row[0] - before[0], *body)
        apart = product([row[1], -row[2], -row[3], -row[4]], y[:4])
        angle = max(angle, 2 * float(sum(x * x for x in apart[1:]).sqrt()))
        omega = max(omega, max(abs(float(a - b)) for a, b in zip(row[5:], y[4:])))
    print(f"{name},{angle:.1e},{omega:.1e}")
