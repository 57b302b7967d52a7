"""Terms of order 12 of the preprocessed discrete Moser-Veselov map for the moments 3/5, 4/5, 1, in exact fractions.

    python3 tests/data/schemes/dmv.py        (python 3, fractions of the standard library)

Prints the coefficients of X^(5-j) Y^j, j = 0 ... 5, X = h^2 |m|^2 / 2 and Y = h^2 H, in s and in d, where the map with the
reciprocal moments s/I_i + d is the exact motion: (4/h) beta_i = (s/I_i + d) sigma_i with beta = p_0 (p_1, p_2, p_3) of the
increment p of the attitude over h and sigma = m(0) + m(h).
"""

from fractions import Fraction as F

INVERSE = [F(5, 3), F(5, 4), F(1)]
DEGREE = 5


def product(a, b, n):
    return sum(a[k] * b[n - k] for k in range(n + 1))


def series(m):
    """Coefficients of h^10 in s and d at the momentum m, by Taylor series of the exact motion."""
    momentum, increment = [[x] for x in m], [[F(1)], [F(0)], [F(0)], [F(0)]]
    for n in range(2 * DEGREE + 2):
        rates = [(INVERSE[c] - INVERSE[b]) * product(momentum[b], momentum[c], n) for b, c in ((1, 2), (2, 0), (0, 1))]
        omega = [[x * INVERSE[k] for x in momentum[k]] for k in range(3)]
        p = lambda a, k: product(increment[a], omega[k], n) / 2
        turned = [
            -p(1, 0) - p(2, 1) - p(3, 2),
            p(0, 0) + p(2, 2) - p(3, 1),
            p(0, 1) + p(3, 0) - p(1, 2),
            p(0, 2) + p(1, 1) - p(2, 0),
        ]
        for row, rate in zip(momentum + increment, rates + turned):
            row.append(rate / (n + 1))

    def ratio(k):
        beta = [4 * product(increment[0], increment[k + 1], n) for n in range(1, 2 * DEGREE + 2)]
        sigma = [2 * momentum[k][0]] + momentum[k][1:]
        terms = []
        for n in range(len(beta)):
            terms.append((beta[n] - sum(terms[j] * sigma[n - j] for j in range(n))) / sigma[0])
        return terms[2 * DEGREE]

    first, second = ratio(0), ratio(1)
    s = (first - second) / (INVERSE[0] - INVERSE[1])
    return s, first - s * INVERSE[0]


def solve(matrix, values):
    """Gauss-Jordan in fractions."""
    rows = [row + [value] for row, value in zip(matrix, values)]
    n = len(rows)
    for k in range(n):
        pivot = next(i for i in range(k, n) if rows[i][k] != 0)
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for i in range(n):
            if i != k:
                rows[i] = [a - rows[i][k] * b for a, b in zip(rows[i], rows[k])]
    return [row[n] for row in rows]


momenta = [[F(1), F(k), F(1, k)] for k in range(1, DEGREE + 2)]
matrix, found = [], []
for m in momenta:
    c = sum(x * x for x in m) / 2
    h = sum(x * x * i for x, i in zip(m, INVERSE)) / 2
    matrix.append([c ** (DEGREE - j) * h**j for j in range(DEGREE + 1)])
    found.append(series(m))
for name, column in (("s", 0), ("d", 1)):
    print(name, *solve(matrix, [row[column] for row in found]))
