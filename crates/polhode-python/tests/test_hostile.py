"""Calls with whatever: only the documented exceptions, never a crash, no result that is not finite.

POLHODE_HOSTILE=100000 makes more calls, POLHODE_HOSTILE_SEED other ones.
"""

import os
import random
import warnings
from fractions import Fraction

import numpy as np
import pytest

import polhode

CALLS = int(os.environ.get("POLHODE_HOSTILE", "1500"))
SEED = int(os.environ.get("POLHODE_HOSTILE_SEED", "1"))
# PolhodeError is a ValueError; others come from what Python makes of an argument before the library sees it
DOCUMENTED = (ValueError, TypeError, OverflowError, MemoryError)


class Liar:
    """Claims to be an array, or a rotation."""

    def __init__(self, answer):
        self.answer = answer

    def __array__(self, dtype=None, copy=None):
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer


def number(rng):
    choice = rng.randrange(8)
    if choice == 0:
        return rng.choice([0.0, -0.0, 1.0, float("nan"), float("inf"), -float("inf"), 5e-324, 1.7e308, 2**53, 10**400])
    if choice == 1:
        return rng.choice([-1, 1]) * 10.0 ** rng.uniform(-320, 308)
    return rng.uniform(-3, 3)


def array(rng, shape):
    """An array of about that shape, in any layout and type."""
    shape = list(shape)
    if rng.random() < 0.15 and shape:
        shape[rng.randrange(len(shape))] = rng.choice([0, 1, 2, 3, 4, 7])
    if rng.random() < 0.05:
        shape = shape + [1]
    values = np.array([float(min(max(number(rng), -1.7e308), 1.7e308)) for _ in range(int(np.prod(shape)))]).reshape(shape)
    if rng.random() < 0.6:
        values = np.random.default_rng(rng.randrange(2**32)).uniform(0.5, 1.5, shape)
    kind = rng.randrange(14)
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if kind == 0:
            values = np.asfortranarray(values)
        elif kind == 1 and values.ndim:
            values = np.repeat(values, 2, axis=0)[::2]
        elif kind == 2 and values.ndim:
            values = values[::-1]
        elif kind == 3:
            values = values.astype(rng.choice(["f2", "f4", "i1", "i8", "u2", "bool", "complex128", "U4", "S3", "O", ">f8", "M8[s]", "g"]))
        elif kind == 4:
            values.flags.writeable = False
        elif kind == 5:
            values = values.tolist()
        elif kind == 6:
            values = np.ma.masked_array(values, np.random.default_rng(rng.randrange(99)).random(values.shape) < 0.2)
        elif kind == 7 and values.ndim == 2:
            values = values[:, ::-1].T.copy().T
    return values


def junk(rng):
    return rng.choice([
        None, True, "1,2,3", "", "toutatis", b"123", [], {}, {"a": 1}, [[1], [2, 3]], object(), Fraction(1, 3), 1 + 2j, lambda: 0, [None] * 3,
        np.float32(1.5), np.array(2.0), np.array("a"), np.array([{}, {}, {}], dtype=object), Liar(np.ones(3)), Liar("no array"),
        Liar(RuntimeError("no")), Liar(np.ones(4, complex)), range(3), iter([1, 2, 3]), memoryview(b"abc"), float, "\0", "\ud800",
        np.broadcast_to(1.0, (10**14,)), np.array([1, 2, 3]).view([("a", "i8")]),
    ])  # fmt: skip


def some(rng, *shapes):
    return junk(rng) if rng.random() < 0.15 else array(rng, rng.choice(shapes))


def scalar(rng):
    return junk(rng) if rng.random() < 0.1 else number(rng)


def maybe(rng, call, share=0.3):
    return call() if rng.random() < share else None


def words(rng, *known):
    return rng.choice([*known, "", "no such", "\0", "é" * 50, 3]) if rng.random() < 0.3 else rng.choice(known)


def forces(rng):
    make = [
        lambda: polhode.gravity(some(rng, (3,))),
        lambda: polhode.gravity_gradient(scalar(rng), scalar(rng)),
        lambda: polhode.torque_body(some(rng, (3,))),
        lambda: polhode.torque_space(some(rng, (3,))).during(some(rng, (2, 2))),
        lambda: polhode.drag(scalar(rng), scalar(rng)),
        lambda: polhode.force(words(rng, "own"), rng.choice([lambda t, q, w: -w, lambda t, q, w: junk(rng), lambda t: 0, 5])),
    ]
    return [rng.choice(make)() for _ in range(rng.randrange(3))]


def body(rng):
    if rng.random() < 0.3:
        return words(rng, "toutatis", "racket", "gyroscope", "water", "robot.urdf:x")
    inertia = rng.choice([[1, 2, 3], [1.25, 1.25, 0.75], some(rng, (3,), (3, 3))])
    return polhode.Body(inertia, forces(rng)) if rng.random() < 0.5 else inertia


def start(rng):
    return {
        "omega": maybe(rng, lambda: some(rng, (3,)), 0.8),
        "attitude": maybe(rng, lambda: some(rng, (4,))),
        "momentum": maybe(rng, lambda: some(rng, (3,)), 0.1),
        "order": words(rng, "wxyz", "xyzw"),
    }


def times(rng):
    return np.sort(np.abs(np.random.default_rng(rng.randrange(99)).normal(0, 5, 4))) if rng.random() < 0.6 else some(rng, (5,), ())


def rows(rng):
    n = rng.choice([0, 1, 12, 40])
    motion = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3])
    t = np.arange(n) * 0.1
    attitude, omega = motion.at(t)
    if rng.random() < 0.3 and n:
        (attitude if rng.random() < 0.5 else omega)[rng.randrange(n)] *= number(rng) if rng.random() < 0.5 else 1.1
    return [given if rng.random() < 0.9 else some(rng, (n, 4), (n, 3), (n,)) for given in (t, attitude, omega)]


def free(rng):
    motion = polhode.FreeMotion(body(rng), **start(rng))
    motion.character() if rng.random() < 0.3 else motion.flips(scalar(rng)) if rng.random() < 0.2 else repr(motion)
    return motion.at(rng.choice([scalar(rng), some(rng, (5,), (2, 3), ())]), order=words(rng, "wxyz", "xyzw", None))


def linear(rng):
    motion = polhode.FreeMotion(body(rng), **start(rng))
    if rng.random() < 0.5:
        return motion.at_with_derivative(some(rng, (5,), ()), by=words(rng, "omega", "momentum"), axes=words(rng, "space", "body"))[0]
    return motion.covariance(some(rng, (3,), ()), some(rng, (6, 6), (12, 12)), axes=words(rng, "space", "body"), torque=maybe(rng, lambda: some(rng, (3, 3)), 0.2))


def through(rng):
    t, attitude, _ = rows(rng)
    turns = rng.choice([0.5, 1.0, scalar(rng)])
    if isinstance(turns, float) and turns > 3:
        turns = 3.0
    call = rng.randrange(3)
    if call == 0:
        return [passage.motion.at(1.0) for passage in polhode.FreeMotion.through(body(rng), t[:2], attitude[:2], turns=turns, order=words(rng, "wxyz", "xyzw"))]
    if call == 1:
        return polhode.Interpolation(body(rng), t, attitude, turns=turns).at(some(rng, (3,), ()))
    guess = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3])
    return polhode.FreeMotion.fitted(body(rng), t, attitude, noise=scalar(rng), guess=rng.choice([guess, junk(rng)])).motion.at(0)


def attitude(rng):
    t, _, rates = rows(rng)
    sensor = {name: scalar(rng) for name in ("noise", "bias", "scale_error", "stamps") if rng.random() < 0.2}
    found = polhode.attitude(t, rates, kind=words(rng, "rate", "increment", "average"), start=maybe(rng, lambda: some(rng, (4,))),
                             rule=words(rng, "auto", "magnus:4", "magnus:6,8", "hold", "two-speed"), body=maybe(rng, lambda: body(rng), 0.2), **sensor)
    str(found), found._repr_html_(), found.budget
    return found


def top(rng):
    motion = polhode.LagrangeTop(body(rng), **start(rng))
    times = rng.choice([scalar(rng), some(rng, (5,))])
    return motion.at(times) if rng.random() < 0.5 else motion.at_with_derivative(times, by=words(rng, "omega", "momentum"))[0]


def run(rng):
    name = words(rng, "rk4", "dmv:10", "exact", "dop853", "lie-poisson", "kick-drift@srkn-6b", "explicit-euler", "gauss:4", "rk4:3")
    step = maybe(rng, lambda: rng.choice([0.1, 0.01, scalar(rng)]), 0.9)
    # no run of minutes, which is legal
    if isinstance(step, float) and 0 < step < 1e-3:
        step = 1e-3
    ends = times(rng)
    if isinstance(ends, np.ndarray) and ends.dtype.kind == "f":
        ends = np.minimum(ends, 100)
    return polhode.run(name, body(rng), **start(rng), times=ends, step=step, tolerance=maybe(rng, lambda: scalar(rng), 0.1),
                       start_time=maybe(rng, lambda: scalar(rng), 0.1) or 0.0, errors=rng.random() < 0.5)


def ensemble(rng):
    n = rng.choice([1, 2, 5])
    given = {
        "body": maybe(rng, lambda: body(rng), 0.6), "omega": maybe(rng, lambda: some(rng, (3,), (n, 3)), 0.9),
        "attitude": maybe(rng, lambda: some(rng, (4,), (n, 4))), "momentum": maybe(rng, lambda: some(rng, (n, 3)), 0.1),
        "moments": maybe(rng, lambda: some(rng, (n, 3)), 0.3), "tensors": maybe(rng, lambda: some(rng, (n, 3, 3)), 0.1),
    }  # fmt: skip
    members = polhode.Ensemble(**given, threads=rng.choice([0, 1, 2]), order=words(rng, "wxyz", "xyzw"))
    if rng.random() < 0.5:
        return members.at(times(rng))
    return members.run(words(rng, "rk4", "two-turn:31"), times=rng.choice([[0, 1], [0, 0.5, 2], times(rng)]), step=rng.choice([0.1, 0.5, 0.0, -1.0]))


def audit(rng):
    t, attitude, omega = rows(rng)
    known = {
        "moments": maybe(rng, lambda: rng.choice([[1, 2, 3], some(rng, (3,))]), 0.7), "inertia": maybe(rng, lambda: some(rng, (3, 3)), 0.1),
        "body": maybe(rng, lambda: body(rng), 0.1), "momentum": maybe(rng, lambda: some(rng, (40, 3), (12, 3)), 0.1),
        "tolerance": rng.choice([1e-6, 1e-6, scalar(rng)]), "noise": maybe(rng, lambda: rng.choice([1e-3, scalar(rng), some(rng, (2,))]), 0.2),
        "order": maybe(rng, lambda: words(rng, "wxyz", "xyzw")), "direction": maybe(rng, lambda: words(rng, "body-to-space")),
        "omega_frame": maybe(rng, lambda: words(rng, "body", "space")), "rate_unit": maybe(rng, lambda: words(rng, "rad/s", "rpm")),
        "euler": maybe(rng, lambda: words(rng, "zxz", "zyx:extrinsic"), 0.1), "form": maybe(rng, lambda: words(rng, "quaternion", "euler", "rodrigues"), 0.2),
        "any_order": rng.random() < 0.2, "advice": False,
    }  # fmt: skip
    verdict = polhode.audit(t, attitude, omega, **{k: v for k, v in known.items() if v is not None})
    str(verdict), verdict._repr_html_(), verdict.to_json()


def fit(rng):
    n = rng.choice([0, 3, 60])
    t = np.arange(n) * 0.05
    rates = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3]).at(t).omega + np.random.default_rng(rng.randrange(99)).normal(0, 0.01, (n, 3))
    if rng.random() < 0.3:
        rates = some(rng, (n, 3))
    return polhode.fit(t if rng.random() < 0.9 else some(rng, (n,)), rates, torque=words(rng, "auto", "none", "drag"),
                       windows=maybe(rng, lambda: some(rng, (1, 2)), 0.2), noise=maybe(rng, lambda: scalar(rng), 0.1),
                       radius=maybe(rng, lambda: scalar(rng), 0.1), trace=maybe(rng, lambda: scalar(rng), 0.1),
                       gyro_bias=maybe(rng, lambda: scalar(rng), 0.1), prior=maybe(rng, lambda: some(rng, (3,)), 0.1),
                       prior_sigma=maybe(rng, lambda: scalar(rng), 0.1))


def masses(rng):
    call = rng.randrange(4)
    if call == 0:
        return polhode.diagnose(some(rng, (3, 3)), mass=maybe(rng, lambda: scalar(rng)), center_of_mass=maybe(rng, lambda: some(rng, (3,))),
                                extents=maybe(rng, lambda: some(rng, (3,))))
    if call == 1:
        return polhode.mesh(some(rng, (4, 3)), rng.choice([[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], some(rng, (4, 3))]), density=scalar(rng),
                            close=maybe(rng, lambda: words(rng, "fan", "hull")))
    if call == 2:
        return polhode.MassProperties(scalar(rng), some(rng, (3,)), some(rng, (3, 3)), about=maybe(rng, lambda: some(rng, (3,))))
    shape = polhode.solid(words(rng, "box", "sphere", "tube", "rod", "torus"), some(rng, (3,), (1,), (2,)), mass=scalar(rng))
    return shape.moved(some(rng, (3,))).turned(some(rng, (4,))) + shape


def read(rng, folder):
    path = folder / rng.choice(["a.csv", "b.urdf", "c.stl", "d.toml", "e.json", "f.npy", "g.obj", "h.xml", "i.dump"])
    text = rng.choice([
        "", "t,wx,wy,wz\n0,1,2,3\n1,nan,2,3\n", "t,q_w,q_x,q_y,q_z\n" + "0,1,0,0,0\n" * 12, "<robot><link name='a'/></robot>", "solid a\nendsolid a\n",
        "[[part]]\nshape = 3\n", "{}", "\x93NUMPY\x01\x00", "v 0 0 0\nf 1 1 1\n", "ITEM: TIMESTEP\n0\n", "\0" * 40, "a" * 2000,
    ])  # fmt: skip
    path.write_bytes(text.encode("latin-1"))
    return polhode.read(rng.choice([path, str(path), folder, junk(rng)]), kind=maybe(rng, lambda: words(rng, "record", "trajectory", "times", "mesh")),
                        columns=maybe(rng, lambda: words(rng, "t=1,wx=2,wy=3,wz=4"), 0.1), time_unit=maybe(rng, lambda: scalar(rng), 0.1),
                        density=maybe(rng, lambda: scalar(rng), 0.2), close=maybe(rng, lambda: words(rng, "fan"), 0.1))


def finite(found):
    for name in ("attitude", "omega", "energy", "principal", "tensor", "center_of_mass"):
        value = getattr(found, name, None)
        if isinstance(value, np.ndarray):
            assert np.isfinite(value).all(), name


def test_hostile_calls_are_refused_in_words(tmp_path):
    rng = random.Random(SEED)
    calls = [free, free, free, linear, through, attitude, top, run, run, ensemble, audit, fit, masses, masses, lambda rng: read(rng, tmp_path)]
    refused = answered = 0
    for k in range(CALLS):
        call = rng.choice(calls)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                found = call(rng)
        except DOCUMENTED as error:
            refused += 1
            assert str(error).strip(), f"call {k}: no words"
        except BaseException as error:
            raise AssertionError(f"call {k} of seed {SEED}, {getattr(call, '__name__', call)}: {error!r}") from error
        else:
            answered += 1
            finite(found)
    assert answered > CALLS / 20 and refused > CALLS / 20, (answered, refused)
