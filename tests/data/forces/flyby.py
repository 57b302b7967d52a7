"""Writes experiments/data/flyby_programs.csv and its table in docs/tumbling.md: clones of Apophis past the Earth, polhode beside heyoka.

    pip install heyoka numpy maturin
    maturin develop --release --manifest-path crates/polhode-python/Cargo.toml
    python3 tests/data/forces/flyby.py        (heyoka 7.13.2)

Orbit and moments are those of the experiment `flyby`, four days about the perigee; each clone starts in another attitude, with the same spin.
heyoka integrates attitude, momentum and orbit by its Taylor method, compiled once, one clone at a time, and as many at a time as the
processor has lanes. Both are read at the end alone. Errors are angles between the attitudes at the end and those of heyoka at a tolerance of 1e-18,
which polhode's `taylor` at the rounding of doubles confirms; times are processor times a clone in one process on one core, the least of
three rounds, set-up of each clone included and compilation not.
"""

import csv
import os
import sys
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

import heyoka as hy
import numpy as np
import polhode

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "benches"))
from beside import ROOT, apart, gradient, put, spinning, timed, to_body, turning

GM, PERIGEE, ECCENTRICITY = 398_600.4418, 38_011.48649129103, 4.25390187321279
PLANE = np.radians([152.0019490904037, 162.856154313485, 32.56762207107416])
MOMENTS = np.array([0.61, 0.965, 1.0])
WINDOW = 172_800.0
OMEGA = np.array([1.4e-5, 0.6e-5, 6.2e-5])
CLONES = 200
ROUNDS = 3
TOLERANCES = (1e-8, 1e-10, 1e-12, 1e-14, 1e-15)


def turn(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    m = np.eye(3)
    m[i, i], m[i, j], m[j, i], m[j, j] = c, -s, s, c
    return m


def place_and_velocity(t):
    """On the hyperbola at t after the perigee, km and km/s."""
    e, a = ECCENTRICITY, PERIGEE / (ECCENTRICITY - 1)
    n = np.sqrt(GM / a**3)
    f = np.arcsinh(n * t / e)
    for _ in range(50):
        f -= (e * np.sinh(f) - f - n * t) / (e * np.cosh(f) - 1)
    rate = n / (e * np.cosh(f) - 1)
    b = a * np.sqrt(e * e - 1)
    r = np.array([a * (e - np.cosh(f)), b * np.sinh(f), 0])
    v = rate * np.array([-a * np.sinh(f), b * np.cosh(f), 0])
    node, inclination, argument = PLANE
    m = turn(2, node) @ turn(0, inclination) @ turn(2, argument)
    return m @ r, m @ v


def equations():
    q, w = hy.make_vars("q0", "q1", "q2", "q3"), hy.make_vars("w0", "w1", "w2")
    r, v = hy.make_vars("x", "y", "z"), hy.make_vars("vx", "vy", "vz")
    p = [sum(row[k] * r[k] for k in range(3)) for row in to_body(q)]
    squared = hy.sum([c * c for c in r])
    near3 = squared ** -1.5
    torque = gradient(MOMENTS, 3 * GM * near3 / squared, p)
    falling = [(v[k], -GM * near3 * r[k]) for k in range(3)]
    return turning(q, w) + spinning(MOMENTS, w, torque) + [(r[k], v[k]) for k in range(3)] + falling


def starts():
    random = np.random.default_rng(2029)
    q = random.normal(size=(CLONES, 4))
    return q / np.linalg.norm(q, axis=1)[:, None]


def a_clone(work):
    """What `work` gives, and its least processor time a clone, ms."""
    found, seconds = timed(work, ROUNDS)
    return found, 1e3 * seconds / CLONES


def one_by_one(tolerance, attitudes):
    r, v = place_and_velocity(-WINDOW)
    rest = np.concatenate([OMEGA, r, v])
    integrator = hy.taylor_adaptive(equations(), np.concatenate([attitudes[0], rest]), tol=tolerance)

    def work():
        found = np.empty((CLONES, 4))
        for k, q in enumerate(attitudes):
            integrator.time = 0.0
            integrator.state[:4], integrator.state[4:] = q, rest
            integrator.propagate_until(2 * WINDOW)
            found[k] = integrator.state[:4]
        return found

    return a_clone(work)


def in_lanes(tolerance, attitudes):
    r, v = place_and_velocity(-WINDOW)
    rest = np.concatenate([OMEGA, r, v])
    lanes = hy.recommended_simd_size()

    def columns(k):
        chosen = [attitudes[min(k + lane, CLONES - 1)] for lane in range(lanes)]
        return np.array([np.concatenate([q, rest]) for q in chosen]).T.copy()

    integrator = hy.taylor_adaptive_batch(equations(), columns(0), tol=tolerance)

    def work():
        found = np.empty((CLONES, 4))
        for k in range(0, CLONES, lanes):
            integrator.set_time(0.0)
            integrator.state[:] = columns(k)
            integrator.propagate_until(2 * WINDOW)
            left = min(lanes, CLONES - k)
            found[k : k + left] = integrator.state[:4, :left].T
        return found

    return a_clone(work)


def ours(method, attitudes):
    force = polhode.gravity_gradient_on_conic(GM, PERIGEE, ECCENTRICITY, WINDOW, PLANE)
    body = polhode.Body(MOMENTS, [force])

    def work():
        found = np.empty((CLONES, 4))
        for k, q in enumerate(attitudes):
            samples = polhode.run(method, body, OMEGA, q, times=[0.0, 2 * WINDOW], step=2 * WINDOW, errors=False)
            found[k] = samples.attitude[-1]
        return found

    return a_clone(work)


def main():
    attitudes = starts()
    right, _ = one_by_one(1e-18, attitudes)
    confirmed, _ = ours("taylor", attitudes)
    difference = apart(confirmed, right).max()
    assert difference < 1e-10, difference
    lanes = hy.recommended_simd_size()
    rows = []
    for tolerance in TOLERANCES:
        for program, version, method, (found, cost) in [
            ("polhode", polhode.__version__, f"dop853:{tolerance:g}", ours(f"dop853:{tolerance:g}", attitudes)),
            ("polhode", polhode.__version__, f"taylor:{tolerance:g}", ours(f"taylor:{tolerance:g}", attitudes)),
            ("heyoka", hy.__version__, f"Taylor, {tolerance:g}", one_by_one(tolerance, attitudes)),
            ("heyoka", hy.__version__, f"Taylor in {lanes} lanes, {tolerance:g}", in_lanes(tolerance, attitudes)),
        ]:
            errors = apart(found, right)
            rows.append((program, version, method, f"{np.median(errors):.1e}", f"{errors.max():.1e}", f"{cost:.2g}"))
    with open(ROOT / "experiments/data/flyby_programs.csv", "w", newline="") as file:
        file.write(f"# {CLONES} clones of Apophis past the Earth: attitude error at the end, rad, and processor time of one core a clone, ms.\n")
        file.write("# python3 tests/data/forces/flyby.py\n")
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["program", "version", "method", "median_error", "largest_error", "milliseconds"])
        out.writerows(rows)
    table = "| program | method | median error (rad) | largest (rad) | ms a clone |\n| :--- | :--- | ---: | ---: | ---: |\n"
    for program, version, method, median, largest, cost in rows:
        table += f"| {program} {version} | {method} | {median} | {largest} | {cost} |\n"
    put("tumbling.md", "flyby programs", table)
    print(table, f"heyoka at 1e-18 and taylor differ by {difference:.1e} rad at most")


if __name__ == "__main__":
    main()
