"""Motions, runs, forces and ensembles in arrays."""

import threading
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import polhode
from polhode import Body, Ensemble, FreeMotion, LagrangeTop, PolhodeError, PolhodeWarning, run

OMEGA = [0.4, 1, -0.3]


def test_a_spin_about_an_axis_is_a_turn():
    t = np.linspace(-5, 5, 101)
    attitude, omega = FreeMotion([1, 2, 3], [0, 0, 0.5]).at(t)
    assert_allclose(attitude, np.column_stack([np.cos(t / 4), 0 * t, 0 * t, np.sin(t / 4)]), atol=1e-15)
    assert_allclose(omega, np.tile([0, 0, 0.5], (101, 1)))


def test_any_shape_of_times_and_one_time_give_the_same_bits():
    motion = FreeMotion([1, 2, 3], OMEGA, [0.5, 0.1, -0.3, 0.9])
    t = np.arange(24.0).reshape(2, 3, 4)
    states = motion.at(t)
    assert states.attitude.shape == (2, 3, 4, 4) and states.omega.shape == (2, 3, 4, 3)
    assert_array_equal(states.t, t)
    one = motion.at(7.0)
    assert one.attitude.shape == (4,) and one.t == 7.0
    assert_array_equal(one.attitude, states.attitude[0, 1, 3])
    assert_array_equal(motion.at(7).omega, states.omega[0, 1, 3])
    # strides, types and lists of times
    for same in (t[:, ::2], t.astype("f4"), t.astype(int), np.asfortranarray(t), t.tolist(), t.astype(">f8")):
        assert_array_equal(motion.at(same).attitude, motion.at(np.array(same, dtype=float)).attitude)
    # 9 bytes from one to the next, and doubles at an odd address
    packed = np.zeros(24, dtype=[("flag", "i1"), ("t", "f8")])
    packed["t"] = t.ravel()
    for same in (packed["t"], np.frombuffer(b"-" + t.tobytes(), offset=1)):
        assert_array_equal(motion.at(same).t, t.ravel())


def test_the_order_of_quaternions_is_explicit():
    first = FreeMotion([1, 2, 3], OMEGA, [0.5, 0.1, -0.3, 0.9])
    last = FreeMotion([1, 2, 3], OMEGA, [0.1, -0.3, 0.9, 0.5], order="xyzw")
    t = [0, 1, 2]
    assert_array_equal(np.roll(first.at(t).attitude, -1, axis=-1), last.at(t).attitude)
    assert_array_equal(first.at(t, order="xyzw").attitude, last.at(t).attitude)
    with pytest.raises(PolhodeError, match="order: 'xzyw'; it must be 'wxyz' or 'xyzw'"):
        first.at(t, order="xzyw")


def test_rotations_of_scipy_go_in_and_out():
    transform = pytest.importorskip("scipy.spatial.transform")
    turn = transform.Rotation.from_euler("zxz", [0.3, 0.5, 0.7])
    motion = FreeMotion([1, 2, 3], OMEGA, turn)
    assert (motion.at(0).rotation * turn.inv()).magnitude() < 1e-15
    states = motion.at([0, 5])
    moments = np.array([1, 2, 3]) * states.omega
    in_space = states.rotation.apply(moments)
    assert_allclose(in_space[0], in_space[1], rtol=1e-13)


def test_the_motion_of_a_top_keeps_its_energy():
    body = Body([1.25, 1.25, 0.75], [polhode.gravity([0, 0, 2])])
    top = LagrangeTop(body, [0.5, 0, 20], [0.97, 0.24, 0, 0])
    states = top.at(np.linspace(0, 1e4, 1000))
    up = 1 - 2 * (states.attitude[:, 1] ** 2 + states.attitude[:, 2] ** 2)
    energy = 0.5 * (states.omega**2 * [1.25, 1.25, 0.75]).sum(1) + 2 * up
    assert np.ptp(energy) < 1e-12 * energy[0]
    assert top.nutation_period > 0 and top.turning_points.shape == (2,)
    with pytest.raises(PolhodeError, match="gravity acts on the body"):
        FreeMotion(body, [0, 0, 20])
    with pytest.raises(PolhodeError, match="the body has no weight moment"):
        LagrangeTop([1, 1, 2], [0, 0, 20])


def test_a_body_of_the_catalogue_has_its_start():
    body = polhode.body("toutatis")
    assert "toutatis" in polhode.bodies() and body.attitude_known.startswith("attitude in the frame ecliptic J2000")
    assert_array_equal(FreeMotion("toutatis").at(0).omega, FreeMotion(body, body.omega, body.attitude).at(0).omega)
    character = FreeMotion(body).character()
    assert character["mode"] == "long-axis" and character["stability"] is None


def test_runs_carry_their_errors():
    times = np.arange(0, 101, 10.0)
    rk4 = run("rk4", [1, 2, 3], OMEGA, times=times, step=0.1)
    assert len(rk4) == 11 and rk4.attitude.shape == (11, 4)
    assert (np.diff(rk4.energy_error) >= 0).all() and 1e-8 < rk4.energy_error[-1] < 1e-4
    exact = FreeMotion([1, 2, 3], OMEGA).at(times)
    angle = 2 * np.linalg.norm(rk4.attitude * np.sign(rk4.attitude[:, :1]) - exact.attitude * np.sign(exact.attitude[:, :1]), axis=1)
    assert_allclose(rk4.attitude_error, angle, rtol=0.01, atol=1e-13)
    rattle = run("rattle", [1, 2, 3], OMEGA, times=times, step=0.1)
    assert rattle.momentum_vector_error[-1] < 1e-13 < 1e-4 < rattle.attitude_error[-1]
    bare = run("rattle", [1, 2, 3], OMEGA, times=times, step=0.1, errors=False)
    assert bare.energy_error is None and bare.attitude_error is None and bare.flips is None
    assert_array_equal(bare.attitude, rattle.attitude)
    adaptive = run("dop853", [1, 2, 3], OMEGA, times=times, tolerance=1e-12)
    assert adaptive.attitude_error.max() < 1e-9
    for found in (rk4, rattle, bare, adaptive):
        assert "<pre>" in found._repr_html_() and found.method in repr(found)
    assert "<svg" in rk4._repr_html_()


def test_long_runs_tell_how_far_they_are():
    told = []
    run("rk4", [1, 2, 3], OMEGA, times=[0, 2e5], step=0.05, progress=lambda *now: told.append(now))
    assert told and all(stage == "rk4" and 0 <= done <= 1 for stage, done, _ in told)
    assert told[-1] == ("rk4", 1, None) and told == sorted(told, key=lambda one: one[1])
    with pytest.raises(ZeroDivisionError):
        run("rk4", [1, 2, 3], OMEGA, times=[0, 1e9], step=0.05, progress=lambda *now: 1 / 0)


def test_what_cannot_be_called_is_refused():
    says = r"^progress: 'bar'; it must be a function, which is called as progress\(stage, done, seconds\)"
    members = Ensemble([1, 2, 3], OMEGA)
    for call in (
        lambda: run("rk4", [1, 2, 3], OMEGA, times=[0, 1], step=0.1, progress="bar"),
        lambda: polhode.advise([1, 2, 3], OMEGA, until=1, attitude_error=0.1, progress="bar"),
        lambda: members.at([0], progress="bar"),
        lambda: members.run("rk4", times=[0], step=0.1, progress="bar"),
    ):
        with pytest.raises(PolhodeError, match=says):
            call()
    with pytest.raises(PolhodeError, match=r"^torque: 5; it must be a function, which is called as torque\(t, attitude, omega\)"):
        polhode.force("own", 5)


def test_a_step_that_turns_too_far_is_warned_of():
    says = r"^step: 1: turns the body by 1.1 rad per step; above 1 rad no stepping method is accurate; use a smaller step$"
    for call in (
        lambda: run("rk4", [1, 2, 3], OMEGA, times=[1], step=1),
        lambda: Ensemble([1, 2, 3], OMEGA).run("rk4", times=[1], step=1),
        lambda: Ensemble([1, 2, 3], momentum=np.multiply([1, 2, 3], OMEGA)).run("rk4", times=[1], step=1),
    ):
        with pytest.warns(PolhodeWarning, match=says):
            call()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run("rk4", [1, 2, 3], OMEGA, times=[1], step=0.5)
        run("dop853", [1, 2, 3], OMEGA, times=[1], step=1, tolerance=1e-9)
        Ensemble([1, 2, 3], OMEGA).run("rk4", times=[1], step=0.5)


def test_forces_add_and_stop():
    gravity, brake = polhode.gravity([0, 0, 2]), polhode.drag(0.1)
    body = Body([1, 1, 0.25], [gravity, brake])
    assert body.forces == ["gravity", "drag"]
    slow = run("rk4", body, [0, 0, 4], times=[0, 10], step=0.01)
    assert slow.energy[1] < slow.energy[0] and slow.energy_error is None
    short = Body([1, 2, 3], [brake.during([[0, 1]])])
    braked = run("rk4", short, OMEGA, times=[0, 1, 5, 10], step=0.01)
    assert braked.energy[1] < braked.energy[0] and abs(braked.energy[3] / braked.energy[1] - 1) < 1e-9


def test_what_has_no_size_is_not_moved_by_what_has_one(tmp_path):
    path = tmp_path / "tetrahedron.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    mesh = str(path)
    gradient, brake = polhode.gravity_gradient(1e-3), polhode.drag(0.1)
    assert Body(mesh, [gradient, gradient.during([[0, 1]])]).forces == ["gravity gradient"] * 2
    own = polhode.force("gravity gradient", lambda t, attitude, omega: 0 * omega)
    read = Body(mesh, [gradient])
    path.unlink()
    for acting in ({"forces": [own]}, {"forces": [gradient, brake.during([[0, 1]])]}, {"wheels": [polhode.Wheel([0, 0, 1], 1e-3, 1)]}):
        with pytest.raises(PolhodeError, match="tetrahedron.obj': a mesh file has no mass"):
            Body(read, **acting)
    with pytest.warns(PolhodeWarning, match="toutatis: the catalogue has only ratios of its moments"):
        Body("toutatis", [brake])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert Body("toutatis", [gradient]).forces and Body("spacecraft", [brake]).forces


def test_a_function_is_a_force():
    times = np.linspace(0, 3, 4)
    built_in = run("rk4", Body([1, 2, 3], [polhode.drag(0.1)]), OMEGA, times=times, step=0.1)
    own = polhode.force("own", lambda t, attitude, omega: -0.1 * omega)
    assert_allclose(run("rk4", Body([1, 2, 3], [own]), OMEGA, times=times, step=0.1).attitude, built_in.attitude, rtol=1e-14)


def test_an_exception_of_a_force_ends_the_run_and_comes_back():
    calls = []

    def broken(t, attitude, omega):
        calls.append(t)
        if t > 0.5:
            raise RuntimeError("no more")
        return 0 * omega

    body = Body([1, 2, 3], [polhode.force("broken", broken)])
    with pytest.raises(RuntimeError, match="no more"):
        run("rk4", body, OMEGA, times=[0, 1e6], step=0.1)
    assert len(calls) < 100
    bad = Body([1, 2, 3], [polhode.force("bad", lambda t, q, w: [1, 2])])
    with pytest.raises(PolhodeError, match=r"torque: an array of shape \(2,\); it must be of shape \(3,\)"):
        run("rk4", bad, OMEGA, times=[0, 1], step=0.1)
    nan = Body([1, 2, 3], [polhode.force("nan", lambda t, q, w: w * np.nan)])
    with pytest.raises(PolhodeError, match="nan is not finite at t = 0 s"):
        run("rk4", nan, OMEGA, times=[0, 1], step=0.1)


def test_members_of_an_ensemble_have_the_bits_of_one_body():
    omega = OMEGA + np.random.default_rng(1).normal(0, 0.1, (100, 3))
    states = Ensemble([1, 2, 3], omega).at([0, 10, 1000])
    alone = FreeMotion([1, 2, 3], omega[37]).at([0, 10, 1000])
    assert_array_equal(states.attitude[:, 37], alone.attitude)
    assert_array_equal(states.omega[:, 37], alone.omega)
    stepped = Ensemble([1, 2, 3], omega, threads=1).run("rk4", times=[0, 10], step=0.1)
    assert_array_equal(stepped.attitude[1, 5], run("rk4", [1, 2, 3], omega[5], times=[0, 10], step=0.1).attitude[1])
    moments = np.random.default_rng(2).uniform(2, 3, (7, 3))
    each = Ensemble(moments=moments, omega=OMEGA).at([5])
    assert_array_equal(each.attitude[0, 3], FreeMotion(moments[3], OMEGA).at(5).attitude)
    top = Body([1.25, 1.25, 0.75], [polhode.gravity([0, 0, 2])])
    heavy = Ensemble(top, omega=[[0, 0, 20], [0, 0, 21]], attitude=[0.97, 0.24, 0, 0]).at([3])
    assert_array_equal(heavy.omega[0, 1], LagrangeTop(top, [0, 0, 21], [0.97, 0.24, 0, 0]).at(3).omega)


def test_the_momentum_of_a_start_counts_the_wheels_as_they_turn_then():
    axis, omega, tensor = np.array([0.0, 0.6, 0.8]), np.array([0.1, 0.02, 0.3]), np.array([10.0, 12.0, 15.0])
    wheel = polhode.Wheel(axis, 0.05, 60).driven(0.1, omega)
    # in 5 s the motor gives the wheel 0.5 N m s
    assert_allclose(wheel.speed(5.0, omega), 60 + 0.1 * 5 / 0.05, rtol=1e-13)
    momentum = tensor * omega + 0.05 * wheel.speed(5.0, omega) * axis
    body = Body(tensor, wheels=[wheel])
    started = run("rk4", body, momentum=momentum, times=[5], start_time=5, step=0.01)
    assert_allclose(started.omega[0], omega, rtol=1e-12)


def test_members_of_a_body_of_the_catalogue_start_at_its_attitude():
    body = polhode.body("toutatis")
    started = Ensemble("toutatis", [body.omega, body.omega]).at([0]).attitude
    assert abs(body.attitude[0]) < 0.999 and (abs(started[0] @ body.attitude) > 1 - 1e-12).all()


def test_members_are_named_where_they_are_refused():
    with pytest.raises(PolhodeError, match="moments: member 1: principal moments 1, 2, 4 violate"):
        Ensemble(moments=[[1, 2, 3], [1, 2, 4]], omega=OMEGA)
    with pytest.raises(PolhodeError, match="inertia of 2 members, omega of 3, attitude of 1"):
        Ensemble(moments=[[1, 2, 3], [1, 2, 2]], omega=np.ones((3, 3)))
    with pytest.raises(PolhodeError, match="member 1: angular velocity has the component NaN"):
        Ensemble([1, 2, 3], [OMEGA, [0, np.nan, 0]]).at([1])


def test_refusals_have_the_words_of_the_library_and_name_the_argument():
    cases = [
        (lambda: FreeMotion([1, 2, 4], OMEGA), "inertia: principal moments 1, 2, 4 violate I1 \\+ I2 >= I3 by 1"),
        (lambda: FreeMotion([1, 2, 3, 4], OMEGA), r"inertia: an array of shape \(4,\); it must be of shape \(3,\) or \(3, 3\)"),
        (lambda: FreeMotion([1, 2, 3], [1, 2]), r"omega: an array of shape \(2,\); it must be of shape \(3,\)"),
        (lambda: FreeMotion([1, 2, 3]), "omega: missing; give omega or momentum"),
        (lambda: FreeMotion([1, 2, 3], OMEGA, [0, 0, 0, 0]), "zero quaternion, which is not a rotation"),
        (lambda: FreeMotion([1, 2, 3], OMEGA).at(np.nan), "t: time NaN s is not a finite number"),
        (lambda: FreeMotion([1, 2, 3], OMEGA).at([0, 1e300]), "the phase has too few digits left"),
        (lambda: FreeMotion([1, 2, 3], OMEGA).at("now"), "t: an array of <U3; it must hold real numbers"),
        (lambda: FreeMotion([1, 2, 3], OMEGA).at([1 + 2j]), "t: an array of complex128"),
        (lambda: FreeMotion([1, 2, 3], OMEGA).at(np.ma.masked_array([1.0, 2.0], [0, 1])), "NaN s is not a finite number"),
        (lambda: run("rk4", [1, 2, 3], OMEGA, times=[0, 1]), "step: missing; rk4 needs a step in seconds"),
        (lambda: run("rk4", [1, 2, 3], OMEGA, times=[1, 0], step=0.1), "goes forwards only|ascending"),
        (lambda: run("rk4", [1, 2, 3], OMEGA, times=[0, 1], step=0.1, tolerance=1e-9), "tolerance"),
        (lambda: run("explicit-euler", [1, 2, 3], [4, 10, -3], times=[0, 1e4], step=1), "diverged|no longer describe"),
        (lambda: polhode.body("robot.urdf"), "no such file, and no such body in the catalogue"),
    ]
    for call, words in cases:
        with pytest.raises(PolhodeError, match=words):
            call()
    assert issubclass(PolhodeError, ValueError)


def test_results_print_as_tables():
    motion = FreeMotion("toutatis")
    assert "long-axis" in repr(motion) and "464870.6" in repr(motion)
    text = repr(motion.at(np.arange(1000.0)))
    assert "omega_z" in text and "1000 rows" in text and len(text.splitlines()) < 20
    assert repr(LagrangeTop("gyroscope")).startswith("LagrangeTop(tilt")


def test_threads_share_a_motion():
    motion, found = FreeMotion([1, 2, 3], OMEGA), {}
    t = np.arange(20000.0)

    def work(k):
        found[k] = motion.at(t).attitude

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert all((found[k] == found[0]).all() for k in found) and len(found) == 4


@pytest.mark.parametrize("work", [
    lambda: FreeMotion([1, 2, 3], OMEGA).at(np.arange(3e6)),
    lambda: polhode.Interpolation([1, 2, 3], [0, 1, 2], FreeMotion([1, 2, 3], OMEGA).at([0, 1, 2]).attitude, turns=0.5).beside_slerp(np.full(500_000, 0.5)),
    lambda: run("rk4", [1, 2, 3], OMEGA, times=[0, 1e6], step=0.1),
    lambda: Ensemble(tensors=np.tile([[2, 0.1, 0.2], [0.1, 2.2, 0.05], [0.2, 0.05, 2.4]], (50000, 1, 1)), omega=OMEGA),
    lambda: Ensemble([1, 2, 3], np.tile(OMEGA, (20000, 1)), threads=1).run("rk4", times=[0, 300], step=0.1),
    lambda: [polhode.audit(np.arange(3e3), *FreeMotion([1, 2, 3], OMEGA).at(np.arange(3e3)), moments=[1, 2, 3]) for _ in range(20)],
])  # fmt: skip
def test_the_interpreter_is_free_meanwhile(work):
    done = threading.Event()
    thread = threading.Thread(target=lambda: (work(), done.set()))
    thread.start()
    ticks = 0
    while not done.wait(0.001):
        ticks += 1
    thread.join()
    # with the lock held there would be one or two
    assert ticks > 10


def test_the_derivative_is_what_differences_say():
    motion = FreeMotion([1, 2, 3], OMEGA)
    t = np.array([[0.0, 3.0], [20.0, 100.0]])
    states, derivative = motion.at_with_derivative(t)
    assert derivative.shape == (2, 2, 6, 12)
    assert_array_equal(states.omega, motion.at(t).omega)
    assert_allclose(derivative[0, 0, :6, :6], np.eye(6), atol=1e-15)
    for axis in range(3):
        high, low = (FreeMotion([1, 2, 3], OMEGA + sign * 1e-6 * np.eye(3)[axis]) for sign in (1, -1))
        change = (high.at(t).omega - low.at(t).omega) / 2e-6
        assert_allclose(derivative[..., 3:, 3 + axis], change, atol=1e-6 * abs(change).max())
    # per entry of the tensor at fixed momentum
    start = np.array([1, 2, 2.5]) * OMEGA
    _, by_momentum = FreeMotion([1, 2, 2.5], momentum=start).at_with_derivative(20.0, by="momentum", axes="body")
    high, low = (FreeMotion([1 + sign * 1e-6, 2, 2.5], momentum=start) for sign in (1, -1))
    change = (high.at(20.0).omega * [1 + 1e-6, 2, 2.5] - low.at(20.0).omega * [1 - 1e-6, 2, 2.5]) / 2e-6
    assert_allclose(by_momentum[3:, 6], change, atol=1e-6 * abs(change).max())
    for wrong in ({"by": "energy"}, {"axes": "sky"}):
        with pytest.raises(PolhodeError, match="it must be"):
            motion.at_with_derivative(0, **wrong)


def test_the_derivative_of_a_top_is_what_differences_say():
    def top(spin=20, transverse=1.25, weight=2):
        body = Body([transverse, transverse, 0.75], [polhode.gravity([0, 0, weight])])
        return LagrangeTop(body, [0.5, 0, spin], [0.97, 0.24, 0, 0])

    t = np.array([0.0, 3.0, 20.0])
    states, derivative = top().at_with_derivative(t)
    assert derivative.shape == (3, 6, 9)
    assert_array_equal(states.omega, top().at(t).omega)
    assert_allclose(derivative[0, :, :6], np.eye(6), atol=1e-15)
    for column, name, value in ((5, "spin", 20), (6, "transverse", 1.25), (8, "weight", 2)):
        high, low = (top(**{name: value + sign * 1e-6}) for sign in (1, -1))
        change = (high.at(t).omega - low.at(t).omega) / 2e-6
        assert_allclose(derivative[..., 3:, column], change, atol=1e-5 * abs(change).max())
    with pytest.raises(PolhodeError, match="it must be"):
        top().at_with_derivative(0, by="energy")


def test_a_covariance_is_that_of_many_starts():
    motion, rng = FreeMotion([1, 2, 3], OMEGA), np.random.default_rng(3)
    sigma = np.array([0, 0, 0, 1e-5, 2e-5, 1e-5])
    state, nonlinearity = motion.covariance([10, 50], np.diag(sigma**2))
    assert state.shape == (2, 6, 6) and (nonlinearity < 0.01).all()
    omegas = Ensemble([1, 2, 3], OMEGA + rng.normal(0, sigma[3:], (4000, 3))).at([10, 50]).omega
    for k in range(2):
        assert_allclose(np.cov(omegas[k].T), state[k, 3:, 3:], atol=0.1 * np.trace(state[k, 3:, 3:]))
    _, late = motion.covariance(1e7, np.diag(sigma**2))
    assert late > 0.9  # nothing is known of the phase any more
    with pytest.raises(PolhodeError, match="covariance: an array of shape \\(5, 5\\)"):
        motion.covariance(1, np.eye(5))


def test_motions_through_attitudes_and_fitted_to_them_are_the_motion():
    motion, t = FreeMotion([1, 2, 3], OMEGA, [0.5, 0.1, -0.3, 0.9]), np.arange(0, 20.0)
    attitude, omega = motion.at(t)
    passages = FreeMotion.through([1, 2, 3], t[:2], attitude[:2], turns=0.5)
    assert all(passage.miss < 1e-12 for passage in passages)
    nearest = min(passages, key=lambda passage: abs(passage.omega - omega[0]).max())
    assert_allclose(nearest.motion.at(1).omega, omega[1], atol=1e-11)
    last = polhode.Interpolation([1, 2, 3], t, np.roll(attitude, -1, axis=1), turns=0.5, order="xyzw")
    between = np.array([[0.25, 7.5], [12.125, 19.0]])
    found = last.at(between, order="wxyz")
    distance = np.minimum(abs(found.attitude - motion.at(between).attitude), abs(found.attitude + motion.at(between).attitude))
    assert distance.max() < 1e-11 and found.omega.shape == (2, 2, 3)
    assert last.beside_slerp(between).shape == (2, 2) and last.beside_slerp(7.5) > 1e-3 and last.span == (0, 19)
    with pytest.raises(PolhodeError, match="t: 20"):
        last.at(20)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        polhode.Interpolation([1, 2, 3], t, attitude, turns=0.5)
    # those of another body
    with pytest.warns(PolhodeWarning, match="these are not attitudes of one free motion: the angular velocity jumps by up to .* rad/s at them"):
        polhode.Interpolation([1, 2, 2.5], t, attitude, turns=0.5)
    guess = FreeMotion([1, 2, 3], [0.41, 1, -0.3], [0.5, 0.1, -0.3, 0.9])
    fitted = FreeMotion.fitted([1, 2, 3], t, attitude, noise=1e-3, guess=guess)
    assert_allclose(fitted.motion.at(0).omega, OMEGA, atol=1e-11)
    assert fitted.covariance.shape == (6, 6) and fitted.chi2_per_dof < 1e-15
    with pytest.raises(PolhodeError, match="gravity acts on the body"):
        FreeMotion.through(Body([1, 1, 2], [polhode.gravity([0, 0, 1])]), t[:2], attitude[:2])
    with pytest.raises(PolhodeError, match="attitude: an array of shape"):
        FreeMotion.through([1, 2, 3], t[:2], attitude[:3])


def test_the_closed_form_is_no_method_of_steps():
    with pytest.raises(PolhodeError, match="method: 'exact': the closed form takes no steps; it is that of Ensemble.at"):
        Ensemble([1, 2, 3], OMEGA).run("exact", times=[0, 1], step=0.1)
    with pytest.raises(PolhodeError, match="method: 'exact': the closed form takes no steps"):
        polhode.phase("exact", [1, 2, 3], OMEGA, step=0.1)


def test_an_ensemble_tells_its_progress_and_ends_where_that_raises():
    told = []
    many = Ensemble([1, 2, 3], np.tile(OMEGA, (3000, 1)), threads=1)
    many.run("rk4", times=np.arange(1, 20), step=0.01, progress=lambda *done: told.append(done))
    assert told and all(stage == "ensemble" and 0 <= done <= 1 for stage, done, _ in told)
    assert told[-1] == ("ensemble", 1, None)
    assert told == sorted(told, key=lambda one: one[1])

    def enough(stage, done, seconds):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        many.run("rk4", times=np.arange(1, 200), step=0.01, progress=enough)


def test_a_body_with_wheels_moves_as_its_equations_say():
    axis, inertia, speed = np.array([0.0, 0.6, 0.8]), 0.05, 60.0
    tensor, omega = np.diag([10.0, 12.0, 15.0]), np.array([0.1, 0.02, 0.3])
    held = polhode.Wheel(axis, inertia, speed)
    for wheel in (held, held.free(omega)):
        body = polhode.Body(tensor, wheels=[wheel])
        motion = polhode.GyrostatMotion(body, omega)
        # I w' + J a W' = -w x (I w + J W a); W' = -a.w' of a free wheel, 0 of one that is held
        is_free = wheel is not held
        left = tensor - inertia * np.outer(axis, axis) if is_free else tensor

        def rate(state):
            turn, w, spin = state[:4], state[4:7], state[7]
            momentum = tensor @ w + inertia * spin * axis
            acceleration = np.linalg.solve(left, -np.cross(w, momentum))
            product = np.array(
                [
                    -turn[1:] @ w,
                    *(turn[0] * w + np.cross(turn[1:], w)),
                ]
            )
            return np.concatenate([product / 2, acceleration, [-axis @ acceleration if is_free else 0.0]])

        state, h = np.concatenate([[1, 0, 0, 0], omega, [speed]]), 0.01
        for _ in range(2000):
            k1 = rate(state)
            k2 = rate(state + h / 2 * k1)
            k3 = rate(state + h / 2 * k2)
            k4 = rate(state + h * k3)
            state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        there = motion.at(20.0)
        np.testing.assert_array_equal(motion.at([-3.0, 20.0]).omega[1], there.omega)
        assert abs(abs(there.attitude @ state[:4]) - 1) < 1e-9
        np.testing.assert_allclose(there.omega, state[4:7], atol=1e-8)
        assert abs(wheel.speed(20.0, there.omega) - state[7]) < 1e-6
        run = polhode.run("lie-poisson", body, omega, times=[20.0], step=0.001)
        np.testing.assert_allclose(run.omega[-1], there.omega, atol=1e-5)
        np.testing.assert_allclose(
            np.linalg.norm(motion.momentum), np.linalg.norm(tensor @ omega + inertia * speed * axis), rtol=1e-14
        )
    with pytest.raises(polhode.PolhodeError, match="GyrostatMotion"):
        polhode.FreeMotion(body, omega)
    with pytest.raises(polhode.PolhodeError, match="is too large for"):
        polhode.Body([1, 2, 2.5], wheels=[polhode.Wheel([1, 0, 0], 0.6, 1)])
    for call, words in [
        (lambda: held.free([0, np.nan, 0]), "omega: NaN is not a finite number"),
        (lambda: held.driven(0.1, [0, 0, np.inf]), "omega: inf is not a finite number"),
        (lambda: held.free(omega).speed(np.nan, omega), "t: NaN is not a finite number"),
    ]:
        with pytest.raises(polhode.PolhodeError, match=words):
            call()
    assert repr(held) == "Wheel(axis 0, 0.6, 0.8, inertia 0.05 kg m^2, held at 60 rad/s)"
    assert repr(held.free(omega)).endswith(", free)") and repr(held.driven(0.1, omega)).endswith(", driven by 0.1 N m)")
    with pytest.raises(polhode.PolhodeError, match="acts with"):
        polhode.GyrostatMotion(polhode.Body(tensor, wheels=[held.driven(0.1, omega)]), omega)
