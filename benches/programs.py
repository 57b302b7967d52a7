#!/usr/bin/env python3
"""heyoka, scipy and MuJoCo beside polhode's `taylor`: processor time at equal attitude error, in one process, in turn.

    python3 -m venv venv
    venv/bin/pip install heyoka==7.13.2 scipy==1.17.1 numba==0.68.1 mujoco==4.0.0 numpy==2.4.6 ./crates/polhode-python
    venv/bin/python benches/programs.py

It writes experiments/data/peer_programs.csv and the tables of docs/which-method.md. With `--try` it follows each motion over a hundredth of
its time and writes nothing. Without numba the right sides that scipy calls are Python's own, and the table says so.

Errors are angles between the attitudes at the end, root mean square over the starts. Truth is the closed form where there is one, else
heyoka in extended precision at a tolerance of 1e-19. The first is confirmed by the second, the second by another order, and both by `taylor`.
Each program is run over many tolerances or steps, from the finest on until its error is large. The time at an error between two runs lies
on the straight line between their logarithms. Times are those of whole runs, read at the end alone, the least of `ROUNDS`; what takes
long runs once. heyoka's integrators and numba's functions are compiled before; what polhode sets up for a run is in its time.
"""

import csv
import os
import platform
import sys
from dataclasses import dataclass
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

import heyoka as hy
import mujoco
import numpy as np
import polhode
import scipy
from beside import ROOT, apart, gradient, put, spinning, timed, to_body, turning
from scipy.integrate import solve_ivp

try:
    import numba
except ImportError:
    numba = None

ROUNDS = 5
# what takes longer, s, runs once
LONG = 0.5
STARTS = 4
SEED = 1967
# errors that tables ask for, rad; a program is not run further once it is beyond the first
ERRORS = [10.0**-k for k in range(3, 13)]
# of an attitude that is lost, rad
LOST = 0.5
# of heyoka, which takes nothing but the order from the tolerance
ORDERS = range(22, 3, -2)
TOLERANCES = [1.2e-16] + [10.0 ** (-0.5 * k) for k in range(31, 5, -1)]
SCIPY = ("DOP853", "LSODA")
# of scipy, which takes none below
RELATIVE = [2.3e-14] + [10.0**-k for k in range(12, 1, -2)]
STEPS = [0.005, 0.01, 0.02, 0.05]
# two ways to the truth may differ by this, rad, and polhode in steps, which has the rounding of doubles, by more
AGREEMENT, CONFIRMED = 3e-13, 1e-9


@dataclass
class Problem:
    name: str
    moments: tuple
    # s
    span: float
    # attitudes and angular velocities, rad/s
    starts: list
    # of a top: weight times distance of the centre of mass, along the third axis, N m
    weight: float = 0.0
    # of a satellite: mean motion, rad/s, and eccentricity
    orbit: tuple = ()
    # whether scipy follows it in bearable time
    by_scipy: bool = False

    def body(self):
        forces = [polhode.gravity([0, 0, self.weight])] if self.weight else []
        forces += [polhode.gravity_gradient(*self.orbit)] if self.orbit else []
        return polhode.Body(self.moments, forces)

    def closed_form(self):
        """Attitudes at the end, where the motion has a closed form."""
        if self.orbit or (self.weight and self.moments[0] != self.moments[1]):
            return None
        motion = polhode.LagrangeTop if self.weight else polhode.FreeMotion
        return np.array([motion(self.body(), omega, q).at(self.span).attitude for q, omega in self.starts])


def drawn(speed):
    """Starts in any attitude with an angular velocity of this length in any direction."""
    random = np.random.default_rng(SEED)
    q, omega = random.normal(size=(STARTS, 4)), random.normal(size=(STARTS, 3))
    return list(zip(unit(q), speed * unit(omega)))


def near(q, omega):
    """A start and others near it, whose motions are as regular."""
    random = np.random.default_rng(SEED)
    off = 0.1 * random.normal(size=(STARTS, 7))
    off[0] = 0.0
    return list(zip(unit(np.array(q) + off[:, :4]), np.array(omega) + off[:, 4:]))


def unit(rows):
    return rows / np.linalg.norm(rows, axis=1)[:, None]


def problems(share):
    """All of them, over this share of their times."""

    def heavy(name, moments):
        # Hairer, Lubich and Wanner, Geometric Numerical Integration, figure VII.5.3
        starts = near([0.4, 0.2, 0.4, 0.8], np.array([0.2, 1.0, 0.4]) / moments)
        return Problem(name, moments, share * 256.0, starts, weight=1.0, by_scipy=True)

    free = near([1.0, 0.0, 0.0, 0.0], [0.4, 1.0, -0.3])
    satellite, day = tuple(np.diag(polhode.body("spacecraft").tensor)), share * 86_400.0
    return [
        Problem("free body, 1000 s", (1.0, 2.0, 3.0), share * 1e3, free, by_scipy=True),
        Problem("free body, 10 000 s", (1.0, 2.0, 3.0), share * 1e4, free),
        heavy("Lagrange's top, 256 s", (0.5, 0.5, 1.0)),
        heavy("asymmetric top, 256 s", (0.5, 0.85, 1.0)),
        Problem("satellite on a circle, a day", satellite, day, drawn(0.1), orbit=(1.1e-3, 0.0)),
        Problem("satellite on an ellipse, a day", satellite, day, drawn(0.1), orbit=(1.1e-3, 0.1)),
    ]


def of_time(n, e):
    """Strength of the gradient and place on the orbit, whose semi-major axis is 1, as functions of time."""
    if e == 0:
        return 3 * n * n, [hy.cos(n * hy.time), hy.sin(n * hy.time)], [], []
    anomaly = hy.kepE(e, n * hy.time)
    place = [hy.cos(anomaly) - e, float(np.sqrt(1 - e * e)) * hy.sin(anomaly)]
    return 3 * n * n * (1 - e * hy.cos(anomaly)) ** -5.0, place, [], []


def integrated(n, e):
    """The same with the equations of the orbit and its start, at the least distance."""
    r = hy.make_vars("x", "y")
    if e == 0:
        return 3 * n * n, r, [(r[0], -n * r[1]), (r[1], n * r[0])], [1.0, 0.0]
    v = hy.make_vars("vx", "vy")
    squared = r[0] * r[0] + r[1] * r[1]
    near3 = squared**-1.5
    orbit = [(r[k], v[k]) for k in range(2)] + [(v[k], -n * n * near3 * r[k]) for k in range(2)]
    start = [1 - e, 0.0, 0.0, float(n * np.sqrt((1 + e) / (1 - e)))]
    return 3 * n * n * near3 / squared, r, orbit, start


def equations(problem, place):
    """Equations for heyoka, and the start of what they have beside attitude and angular velocity."""
    q, omega = hy.make_vars("q0", "q1", "q2", "q3"), hy.make_vars("w0", "w1", "w2")
    rows, torque, orbit, start = to_body(q), (0.0, 0.0, 0.0), [], []
    if problem.weight:
        up = [row[2] for row in rows]
        torque = (problem.weight * up[1], -problem.weight * up[0], 0.0)
    if problem.orbit:
        strength, r, orbit, start = place(*problem.orbit)
        torque = gradient(problem.moments, strength, [row[0] * r[0] + row[1] * r[1] for row in rows])
    return turning(q, omega) + spinning(problem.moments, omega, torque) + orbit, start


def by_heyoka(problem, order, place=of_time, real=float):
    """What runs heyoka from each start, with the order that it takes for a tolerance."""
    system, more = equations(problem, place)
    # heyoka's order is ⌈1 − ln(tolerance)/2⌉
    tolerance = real(np.exp(3 - 2 * order))
    states = [np.array([*q, *omega, *more], dtype=real) for q, omega in problem.starts]
    for state in states:
        state[:4] /= np.sqrt(np.sum(state[:4] ** 2))
    # of extended precision the compilation takes longer than the run
    integrator = hy.taylor_adaptive(system, states[0], tol=tolerance, fp_type=real, compact_mode=real is not float)
    assert integrator.order == order, (integrator.order, order)

    def work():
        found = np.empty((len(states), 4), dtype=real)
        for k, state in enumerate(states):
            integrator.time, integrator.state[:] = real(0), state
            integrator.propagate_until(real(problem.span))
            found[k] = integrator.state[:4]
        return found

    return work


def by_polhode(problem, tolerance):
    body, times = problem.body(), [problem.span]

    def work():
        found = np.empty((len(problem.starts), 4))
        for k, (q, omega) in enumerate(problem.starts):
            run = polhode.run("taylor", body, omega, q, times=times, step=problem.span, tolerance=tolerance, errors=False)
            found[k] = run.attitude[0]
        return found

    return work


def right_side(problem):
    """Free bodies and tops for scipy."""
    (a, b, c), weight = problem.moments, problem.weight

    def rates(_, y):
        w, x, y, z, p, q, r = y[0], y[1], y[2], y[3], y[4], y[5], y[6]
        found = np.empty(7)
        found[0] = -0.5 * (x * p + y * q + z * r)
        found[1] = 0.5 * (w * p + y * r - z * q)
        found[2] = 0.5 * (w * q + z * p - x * r)
        found[3] = 0.5 * (w * r + x * q - y * p)
        found[4] = ((b - c) * q * r + 2 * weight * (y * z + w * x)) / a
        found[5] = ((c - a) * r * p - 2 * weight * (x * z - w * y)) / b
        found[6] = (a - b) * p * q / c
        return found

    if numba is None:
        return rates
    compiled = numba.njit(rates)
    # once for each kind of array that a method hands over
    for method in SCIPY:
        solve_ivp(compiled, (0, 1e-3), np.ones(7), method)
    return compiled


def by_scipy(problem, rates, method, tolerance):
    def work():
        found = np.empty((len(problem.starts), 4))
        for k, (q, omega) in enumerate(problem.starts):
            start = np.concatenate((q, omega))
            run = solve_ivp(rates, (0, problem.span), start, method, [problem.span], rtol=tolerance, atol=tolerance)
            if not run.success:
                raise SystemExit(f"scipy, {method}: {run.message}")
            found[k] = run.y[:4, -1]
        return found

    return work


MODEL = """<mujoco>
  <option timestep="{step}" integrator="{integrator}" gravity="0 0 0"><flag constraint="disable" contact="disable"/></option>
  <worldbody><body><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="{moments}"/></body></worldbody>
</mujoco>"""


def by_mujoco(problem, integrator, step):
    """Free bodies by MuJoCo, all steps in one call."""
    moments = " ".join(map(repr, problem.moments))
    model = mujoco.MjModel.from_xml_string(MODEL.format(step=step, integrator=integrator, moments=moments))
    data = mujoco.MjData(model)

    def work():
        found = np.empty((len(problem.starts), 4))
        for k, (q, omega) in enumerate(problem.starts):
            mujoco.mj_resetData(model, data)
            data.qpos[3:], data.qvel[3:] = q, omega
            mujoco.mj_step(model, data, nstep=round(problem.span / step))
            found[k] = data.qpos[3:]
        return found

    return work


def truth(problem):
    """Attitudes at the end, which two ways have confirmed."""
    # orders for 1e-19 and 1e-17
    finer, coarser = (by_heyoka(problem, order, real=np.longdouble)() for order in (23, 21))
    closed = problem.closed_form()
    right, other = (finer, coarser) if closed is None else (closed, finer)
    difference = apart(other, right).max()
    confirmed = apart(by_polhode(problem, None)(), right).max()
    print(f"{problem.name}: truth to {difference:.1e} rad, polhode at the rounding off by {confirmed:.1e} rad", flush=True)
    if difference > AGREEMENT or confirmed > CONFIRMED:
        sys.exit(f"{problem.name}: no truth")
    return right


@dataclass
class Outcome:
    """A program on a problem at one tolerance or step: error, rad, and least time a start, s."""

    program: str
    setting: str
    work: object
    error: float
    seconds: float


def outcomes(problem, program, settings, prepare, right):
    """The runs of a program from the finest setting on, until the attitude is worse than any that is asked for."""
    found = []
    for setting in settings:
        work = prepare(setting)
        attitudes, seconds = timed(work, 1)
        error = float(np.sqrt(np.mean(apart(attitudes, right) ** 2)))
        found.append(Outcome(program, f"{setting:.3g}", work, error, seconds / len(problem.starts)))
        if error > ERRORS[0]:
            break
    return found


def again(found, starts):
    """The times of the quick ones, in turn."""
    for _ in range(ROUNDS - 1):
        for outcome in found:
            if starts * outcome.seconds < LONG:
                outcome.seconds = min(outcome.seconds, timed(outcome.work, 1)[1] / starts)


def needed(found, error):
    """The least time for an error, s; none where it is not reached."""
    times = [outcome.seconds for outcome in found if outcome.error <= error]
    for fine, coarse in zip(found, found[1:]):
        if fine.error <= error < coarse.error:
            share = np.log(coarse.error / error) / np.log(coarse.error / fine.error)
            times.append(coarse.seconds * (fine.seconds / coarse.seconds) ** share)
    return min(times, default=None)


def programs(problem):
    """Name, settings, and what prepares a run, of each."""
    found = [("polhode", TOLERANCES, lambda tolerance: by_polhode(problem, tolerance))]
    if problem.orbit:
        for name, place in (("the orbit by its formula", of_time), ("the orbit integrated", integrated)):
            found.append((f"heyoka, {name}", ORDERS, lambda order, place=place: by_heyoka(problem, order, place)))
    else:
        found.append(("heyoka", ORDERS, lambda order: by_heyoka(problem, order)))
    if problem.by_scipy:
        rates = right_side(problem)
        for method in SCIPY:
            found.append((f"scipy, {method}", RELATIVE, lambda t, method=method: by_scipy(problem, rates, method, t)))
    return found


def by_steps(problem, right):
    """MuJoCo's integrators; each step counts, also where the attitude is lost."""
    found = []
    for integrator in ("Euler", "implicitfast", "RK4"):
        for step in STEPS:
            prepare = lambda h, name=integrator: by_mujoco(problem, name, h)
            found += outcomes(problem, f"MuJoCo, {integrator}", [step], prepare, right)
    return found


def digits(x):
    """Two of them."""
    rounded = float(f"{x:.1e}")
    return f"{rounded:.{max(0, 1 - int(np.floor(np.log10(rounded))))}f}"


def cell(ours, theirs):
    if ours is None:
        return "" if theirs is None else "alone"
    return "not reached" if theirs is None else digits(theirs / ours)


def processor():
    lines = open("/proc/cpuinfo").read().splitlines() if os.path.exists("/proc/cpuinfo") else []
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.processor())


def main():
    is_trial = sys.argv[1:] == ["--try"]
    if sys.argv[1:] and not is_trial:
        sys.exit(__doc__)
    everything, lines, steps, kept, asked = [], [], [], 0, 0
    for problem in problems(0.01 if is_trial else 1.0):
        right = truth(problem)
        found = {name: outcomes(problem, name, settings, prepare, right) for name, settings, prepare in programs(problem)}
        stepped = by_steps(problem, right) if not problem.weight and problem.by_scipy else []
        # by rank, so that programs take turns
        ranked = sorted((rank, k) for k, runs in enumerate(found.values()) for rank in range(len(runs)))
        again([list(found.values())[k][rank] for rank, k in ranked] + stepped, len(problem.starts))
        ours = {error: needed(found["polhode"], error) for error in ERRORS}
        for name in list(found)[1:]:
            cells = [cell(ours[error], needed(found[name], error)) for error in ERRORS]
            lines.append(f"| {problem.name} | {name} | {' | '.join(cells)} |\n")
        for error in ERRORS:
            theirs = [needed(runs, error) for name, runs in found.items() if name.startswith("heyoka")]
            theirs = min((seconds for seconds in theirs if seconds is not None), default=None)
            if (ours[error], theirs) != (None, None):
                asked += 1
                kept += ours[error] is not None and (theirs is None or ours[error] <= theirs)
        for run in stepped:
            is_lost = run.error > LOST
            ratio = digits(run.seconds / needed(found["polhode"], run.error))
            error = "lost" if is_lost else f"{run.error:.1e}"
            steps.append(f"| {run.program.split(', ')[1]} | {run.setting} | {error} | {ratio} |\n")
        everything += [(problem.name, run) for runs in [*found.values(), stepped] for run in runs]
    compiled = f"compiled by numba {numba.__version__}" if numba else "Python's own"
    columns = [f"{error:.0e}".replace("e-0", "e-") for error in ERRORS]
    text = f"| problem | program | {' | '.join(columns)} |\n| :--- | :--- |{' ---: |' * len(ERRORS)}\n{''.join(lines)}\n"
    text += f"Of the {asked} errors in all problems that `taylor` or heyoka reaches, `taylor` takes at most the time of heyoka at {kept}.\n\n"
    text += f"MuJoCo on the first problem:\n\n| integrator | step (s) | error (rad) | time |\n| :--- | ---: | ---: | ---: |\n{''.join(steps)}\n"
    where = f"polhode {polhode.__version__}, heyoka {hy.__version__}, scipy {scipy.__version__} with right sides {compiled}, "
    where += f"MuJoCo {mujoco.__version__}, Python {platform.python_version()}; {processor()}.\n"
    text += where
    print(text)
    # what MuJoCo writes of steps that are too long
    Path("MUJOCO_LOG.TXT").unlink(missing_ok=True)
    if is_trial:
        return
    with open(ROOT / "experiments/data/peer_programs.csv", "w", newline="") as file:
        file.write("# Attitude error at the end, rad, root mean square over starts, and processor time of a run, ms. Settings: tolerances of\n")
        file.write("# polhode and scipy, orders of heyoka, steps of MuJoCo, s. python3 benches/programs.py\n")
        file.write(f"# {where}")
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["problem", "program", "setting", "error", "milliseconds"])
        for problem, run in everything:
            out.writerow([problem, run.program, run.setting, f"{run.error:.3g}", f"{1e3 * run.seconds:.3g}"])
    put("which-method.md", "programs", text)


if __name__ == "__main__":
    main()
