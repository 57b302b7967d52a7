"""Writes semidefinite.csv: physical tensors nearest to a point, by the semidefinite cone of Clarabel (clarabel 0.11.1 for
Python, whose cone needs BLAS and LAPACK; numpy 2).

python3 tests/data/fit/semidefinite.py > tests/data/fit/semidefinite.csv

min |R (x - c)|^2 over J(x) = 1/3 + sum x_k B_k with 1/2 - J positive semidefinite, in the whitened unknowns y = R (x - c).
Columns: the condition of R, the five numbers of c, the fifteen of R (upper triangle, row by row), the five of x, and what
the solver left of the stationarity of y: so far at most is y from the minimum, which is all that this solver can tell.
Random numbers are numpy's own, seed 2026.
"""

import clarabel
import numpy as np
from scipy import sparse

half, sixth = np.sqrt(0.5), np.sqrt(1.0 / 6.0)


def basis(k):
    if k == 0:
        return np.diag([half, -half, 0.0])
    if k == 1:
        return np.diag([sixth, sixth, -2.0 * sixth])
    i, j = [(0, 1), (0, 2), (1, 2)][k - 2]
    b = np.zeros((3, 3))
    b[i, j] = b[j, i] = half
    return b


def svec(m):
    # upper triangle, column by column, off-diagonals times sqrt 2
    return np.array([m[i, j] * (1.0 if i == j else np.sqrt(2.0)) for j in range(3) for i in range(j + 1)])


B = [basis(k) for k in range(5)]
draw = np.random.default_rng(2026)
settings = clarabel.DefaultSettings()
settings.verbose = False
settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = 1e-12

names = ["condition"] + [f"c{k}" for k in range(5)]
names += [f"r{i}{j}" for i in range(5) for j in range(i, 5)] + [f"x{k}" for k in range(5)] + ["residual"]
print(",".join(names))
for trial in range(60):
    spread = 0.5 if trial < 30 else 1.5
    root = np.triu(draw.uniform(-1, 1, (5, 5)), 1) * 30.0
    root += np.diag(10.0 ** (2.0 + spread * draw.uniform(-1, 1, 5)))
    c = 0.3 * draw.uniform(-1, 1, 5)
    inverse = np.linalg.inv(root)
    # slack = 1/2 - J(c + R^-1 y) = b - A y
    slack = 0.5 * np.eye(3) - np.eye(3) / 3.0 - sum(c[k] * B[k] for k in range(5))
    columns = [sum(inverse[k, l] * B[k] for k in range(5)) for l in range(5)]
    A = np.column_stack([svec(m) for m in columns])
    P = sparse.csc_matrix(np.eye(5))
    solver = clarabel.DefaultSolver(
        P, np.zeros(5), sparse.csc_matrix(A), svec(slack), [clarabel.PSDTriangleConeT(3)], settings
    )
    solution = solver.solve()
    if str(solution.status) not in ("Solved", "AlmostSolved"):
        raise SystemExit(f"{trial}: {solution.status}")
    x = c + inverse @ np.array(solution.x)
    # y + R^-T times the gradients v' B_k w of the face, with the best multipliers
    values, v = np.linalg.eigh(np.eye(3) / 3.0 + sum(x[k] * B[k] for k in range(5)))
    face = [a for a in range(3) if values[a] > 0.5 - 1e-7]
    pairs = [(a, b) for a in face for b in face if a <= b]
    gradients = [np.linalg.solve(root.T, [v[:, a] @ B[k] @ v[:, b] for k in range(5)]) for a, b in pairs]
    y = root @ (x - c)
    if pairs:
        y = y - np.column_stack(gradients) @ np.linalg.lstsq(np.column_stack(gradients), y, rcond=None)[0]
    residual = np.linalg.norm(y)
    numbers = [np.linalg.cond(root), *c, *[root[i, j] for i in range(5) for j in range(i, 5)], *x, residual]
    print(",".join(repr(float(v)) for v in numbers))
