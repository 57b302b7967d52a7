"""Writes experiments/data/derivative_programs.csv and its table in docs/exact-motion.md: the derivative of the free motion beside
heyoka's variational equations, cost and error.

    pip install heyoka mpmath==1.3.0 maturin
    maturin develop --release --manifest-path crates/polhode-python/Cargo.toml
    python3 tests/data/derivative/programs.py        (heyoka 7.13.2)

The body has the moments 1, 2, 3 and starts with omega = (0.4, 1, -0.3) rad/s; state: attitude and momentum in the body. The derivatives are
those by the momentum at the start and by the three moments. Truth: differences of 400 digits, as in generate.py. Errors are the
largest over the largest entry, with |m| and the largest moment as units, as in the experiment `derivative`. Times are the least
processor times of nine runs, in one process; set-up is the compilation of heyoka's integrator, which the runs reuse, and the first
derivative of a new motion here, call from Python included.
"""

import csv
import sys
import time
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent / "free_body"), str(HERE.parents[2] / "benches")]

import heyoka as hy
import numpy as np
import polhode
from beside import ROOT, put, timed, turning
from mpmath import mp, mpf

import importlib.util

spec = importlib.util.spec_from_file_location("derivative", HERE / "generate.py")
derivative = importlib.util.module_from_spec(spec)
spec.loader.exec_module(derivative)

MOMENTS = (1.0, 2.0, 3.0)
OMEGA = (0.4, 1.0, -0.3)
TIMES = (1e2, 1e3, 1e4)
REPEAT = 9


def equations():
    q, m = hy.make_vars(*(f"q{k}" for k in range(4))), hy.make_vars(*(f"m{k}" for k in range(3)))
    omega = [m[k] / hy.par[k] for k in range(3)]
    moved = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        moved.append((m[k], m[i] * omega[j] - m[j] * omega[i]))
    return turning(q, omega) + moved, list(m) + [hy.par[k] for k in range(3)]


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


def heyoka():
    """Name, version and set-up, s, with what gives columns and steps at t."""
    system, by = equations()
    start = [1.0, 0.0, 0.0, 0.0] + [i * w for i, w in zip(MOMENTS, OMEGA)]
    clock = time.process_time()
    integrator = hy.taylor_adaptive(hy.var_ode_sys(system, by, order=1), start, pars=list(MOMENTS))
    set_up = time.process_time() - clock
    first = integrator.state.copy()

    def at(t):
        integrator.time, integrator.state[:] = 0.0, first
        return integrator.propagate_until(t)[3]

    return "heyoka", hy.__version__, set_up, at, lambda _: columns_of(integrator), lambda steps: steps


def closed_form():
    def first():
        motion = polhode.FreeMotion(MOMENTS, OMEGA)
        motion.at_with_derivative(1.0)
        return motion

    motion, set_up = timed(first, REPEAT)
    return (
        "polhode", polhode.__version__, set_up, lambda t: motion.at_with_derivative(t, by="momentum")[1],
        lambda matrix: matrix[:, 3:9], lambda _: "",
    )


def main():
    mp.dps = derivative.DIGITS
    programs, rows = [heyoka(), closed_form()], []
    for t in TIMES:
        right = exact(t)
        for name, version, set_up, at, columns, steps in programs:
            found, least = timed(lambda: at(t), REPEAT)
            off = error(np.asarray(columns(found)), right)
            rows.append((name, version, f"{t:g}", steps(found), f"{off:.2g}", f"{least * 1e3:.3g}", f"{set_up:.2g}"))
    with open(ROOT / "experiments/data/derivative_programs.csv", "w", newline="") as file:
        file.write("# The derivative of the free motion with moments 1, 2, 3, omega = (0.4, 1, -0.3) rad/s: variational equations and closed form.\n")
        file.write("# python3 tests/data/derivative/programs.py\n")
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["program", "version", "t", "steps", "error", "milliseconds", "set_up_seconds"])
        out.writerows(rows)
    table = "| program | t (s) | steps | error | time (ms) | set-up (s) |\n| :--- | ---: | ---: | ---: | ---: | ---: |\n"
    for name, version, t, steps, off, milliseconds, seconds in rows:
        table += f"| {name} {version} | {t} | {steps} | {off} | {milliseconds} | {seconds} |\n"
    put("exact-motion.md", "derivative programs", table)
    print(table)


if __name__ == "__main__":
    main()
