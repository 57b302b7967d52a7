"""Writes experiments/data/derivative_programs.csv: heyoka's variational equations of the free body, their cost and their error.

    pip install heyoka mpmath==1.3.0
    python3 tests/data/derivative/programs.py        (heyoka 7.13.2)

The body has the moments 1, 2, 3 and starts with omega = (0.4, 1, -0.3) rad/s; state: attitude and momentum in the body. The derivatives are
those by the momentum at the start and by the three moments. Truth: differences of 400 digits, as in generate.py. Errors are the
largest over the largest entry, with |m| and the largest moment as units, as in the experiment `derivative`. Times are the least of
five runs; set-up is the compilation of the integrator, which the runs reuse.
"""

import csv
import sys
import time
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "free_body"))

import heyoka as hy
import numpy as np
from mpmath import mp, mpf

import importlib.util

spec = importlib.util.spec_from_file_location("derivative", HERE / "generate.py")
derivative = importlib.util.module_from_spec(spec)
spec.loader.exec_module(derivative)

MOMENTS = (1.0, 2.0, 3.0)
OMEGA = (0.4, 1.0, -0.3)
TIMES = (1e2, 1e3, 1e4)
REPEAT = 5


def equations():
    q, m = hy.make_vars(*(f"q{k}" for k in range(4))), hy.make_vars(*(f"m{k}" for k in range(3)))
    omega = [m[k] / hy.par[k] for k in range(3)]
    w, v = q[0], q[1:]
    rate = [-(v[0] * omega[0] + v[1] * omega[1] + v[2] * omega[2])]
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        rate.append(w * omega[k] + v[i] * omega[j] - v[j] * omega[i])
    turned = [(q[k], 0.5 * rate[k]) for k in range(4)]
    moved = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        moved.append((m[k], m[i] * omega[j] - m[j] * omega[i]))
    return turned + moved, list(m) + [hy.par[k] for k in range(3)]


def columns_of(integrator):
    """Rotation vector in space and momentum, by the momentum at the start and by the moments."""
    state = integrator.state
    q = state[:4]
    found = np.empty((6, 6))
    for k in range(6):
        by = np.array([state[integrator.get_vslice(order=1, component=row)][k] for row in range(7)])
        dw, dv = by[0], by[1:4]
        # the vector part of dq q*
        found[:3, k] = 2 * (q[0] * dv - dw * q[1:] - np.cross(dv, q[1:]))
        found[3:, k] = by[4:]
    return found


def exact(t):
    m = [mpf(i) * mpf(w) for i, w in zip(MOMENTS, OMEGA)]
    start = [mpf(1), mpf(0), mpf(0), mpf(0)]
    found = derivative.columns([mpf(i) for i in MOMENTS], m, start, mpf(t))
    return np.array([[float(x) for x in column] for column in found[:6]]).T


def error(found, right):
    norm = float(np.linalg.norm([i * w for i, w in zip(MOMENTS, OMEGA)]))
    unit = np.ones((6, 6))
    unit[3:, :] /= norm
    unit[:, :3] *= norm
    unit[:, 3:] *= max(MOMENTS)
    return np.abs((found - right) * unit).max() / np.abs(right * unit).max()


def main():
    mp.dps = derivative.DIGITS
    system, by = equations()
    start = [1.0, 0.0, 0.0, 0.0] + [i * w for i, w in zip(MOMENTS, OMEGA)]
    clock = time.perf_counter()
    integrator = hy.taylor_adaptive(hy.var_ode_sys(system, by, order=1), start, pars=list(MOMENTS))
    set_up = time.perf_counter() - clock
    first = integrator.state.copy()
    rows = []
    for t in TIMES:
        least, steps = float("inf"), 0
        for _ in range(REPEAT):
            integrator.time, integrator.state[:] = 0.0, first
            clock = time.perf_counter()
            steps = integrator.propagate_until(t)[3]
            least = min(least, time.perf_counter() - clock)
        rows.append((t, steps, error(columns_of(integrator), exact(t)), least * 1e3, set_up))
    path = HERE.parents[2] / "experiments" / "data" / "derivative_programs.csv"
    with open(path, "w", newline="") as file:
        file.write("# What heyoka's variational equations give of the free body with moments 1, 2, 3, omega = (0.4, 1, -0.3) rad/s.\n")
        file.write("# python3 tests/data/derivative/programs.py\n")
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["program", "version", "t", "steps", "error", "milliseconds", "set_up_seconds"])
        for t, steps, off, milliseconds, seconds in rows:
            out.writerow(["heyoka", hy.__version__, f"{t:g}", steps, f"{off:.2g}", f"{milliseconds:.3g}", f"{seconds:.2g}"])


if __name__ == "__main__":
    main()
