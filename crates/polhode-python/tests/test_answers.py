"""Audits, fits, advice, tensors and files."""

import json
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import polhode
from conftest import PROGRAMS
from polhode import PolhodeError, PolhodeWarning
from polhode.testing import assert_rotation_right

OMEGA = [0.4, 1, -0.3]
T = np.arange(300) * 0.1


@pytest.fixture(scope="module")
def exact():
    return polhode.FreeMotion([1, 2, 3], OMEGA).at(T)


def test_conventions_are_told_from_the_rows(exact):
    attitude, omega = exact
    last = np.roll(attitude, -1, axis=1)
    for q, w, told in [
        (attitude, omega, {"quaternion": "wxyz", "attitude": "body-to-space", "omega_frame": "body", "rate_unit": "rad/s"}),
        (last, np.degrees(omega), {"quaternion": "xyzw", "rate_unit": "deg/s"}),
        (attitude * [1, -1, -1, -1], omega, {"attitude": "space-to-body"}),
    ]:
        verdict = polhode.audit(T, q, w, moments=[1, 2, 3])
        assert verdict.is_right and verdict.attitude_error < 1e-12
        assert told.items() <= verdict.reading.items()
    stated = polhode.audit(T, attitude, omega, moments=[1, 2, 3], direction="space-to-body")
    assert (stated.verdict, stated.suspect) == ("wrong", "transposed")


def test_matrices_and_rotations_are_attitudes_too(exact):
    transform = pytest.importorskip("scipy.spatial.transform")
    turn = exact.rotation
    assert isinstance(turn, transform.Rotation)
    for attitude in (turn, turn.as_matrix()):
        assert polhode.audit(T, attitude, exact.omega, moments=[1, 2, 3]).verdict == "right"
    angles = turn.as_euler("ZXZ")
    verdict = polhode.audit(T, angles, exact.omega, moments=[1, 2, 3], form="euler", euler="zxz")
    assert verdict.verdict == "right" and verdict.reading["euler"] == "zxz"


def test_a_noisy_record_is_undecided_until_its_noise_is_declared(exact):
    noise = np.random.default_rng(1).normal(0, 1e-3, exact.omega.shape)
    undecided = polhode.audit(T, exact.attitude, exact.omega + noise, moments=[1, 2, 3])
    assert undecided.verdict == "undecided"
    # by the keyword, and not by the flag of the command
    said = " ".join(repr(undecided).split())
    assert "declare it: noise " in said and "--" not in said
    assert polhode.audit(T, exact.attitude, exact.omega + noise, moments=[1, 2, 3], noise=[0, 1.1e-3]).is_right
    # what is said of columns or moments that are not there
    with pytest.raises(PolhodeError, match="has no angular velocity"):
        polhode.audit(T, exact.attitude, moments=[1, 2, 3], noise=[0, 1.1e-3])
    with pytest.raises(PolhodeError, match="any_order: needs the moments"):
        polhode.audit(T, exact.attitude, exact.omega, any_order=True)


def test_what_is_said_of_columns_that_a_record_has_not_is_refused(exact):
    attitude, omega = exact
    for argument, value, record in [
        ("order", "xyzw", (T, None, omega)),
        ("direction", "space-to-body", (T, None, omega)),
        ("omega_frame", "body", (T, attitude)),
        ("rate_unit", "rpm", (T, attitude)),
        ("momentum_frame", "space", (T, attitude, omega)),
        ("euler", "zyx", (T, attitude, omega)),
        ("angle_unit", "deg", (T, attitude, omega)),
    ]:
        with pytest.raises(PolhodeError, match=f"{argument}: '{value}'; it is for .*, and the record has none"):
            polhode.audit(*record, moments=[1, 2, 3], **{argument: value})


def test_what_columns_say_by_their_names_is_heeded_as_by_the_command(exact):
    attitude, omega = exact
    rates = {f"omega_body_{axis}": omega[:, k] for k, axis in enumerate("xyz")}
    last = {f"q_{axis}": attitude[:, "wxyz".index(axis)] for axis in "xyzw"}
    assert polhode.audit(polhode.read({"t": T, **last, **rates}), moments=[1, 2, 3], order="xyzw").is_right
    w, x, y, z = attitude.T
    roll, pitch = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), np.arcsin(2 * (w * y - z * x))
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    angles = polhode.read({"t": T, "roll": roll, "pitch": pitch, "yaw": yaw, **rates})
    assert polhode.audit(angles, moments=[1, 2, 3], euler="zyx").is_right
    degrees = {f"{name} (deg)": np.degrees(angle) for name, angle in [("roll", roll), ("pitch", pitch), ("yaw", yaw)]}
    second = {f"box2_q{axis}": attitude[:, k] for k, axis in enumerate("wxyz")}
    for record, says, words in [
        (angles, {"euler": "zxz"}, "euler: 'zxz'; it turns about one axis twice"),
        (polhode.read({"t": T, **degrees, **rates}), {"angle_unit": "rad"}, "angle_unit: 'rad'; the header says deg"),
        (polhode.read({"t": T, **last, **rates, **second}), {}, "columns box2_qw, box2_qx, box2_qy, box2_qz hold another attitude"),
    ]:
        with pytest.raises(PolhodeError, match=words):
            polhode.audit(record, moments=[1, 2, 3], **says)


def test_a_wrong_integrator_is_named_with_what_to_switch_to():
    verdict = polhode.audit(polhode.read(PROGRAMS / "mujoco-euler.csv"), moments=[1, 2, 2.5])
    assert (verdict.verdict, verdict.suspect) == ("wrong", "integrator:semi-implicit-euler")
    assert abs(verdict.integrator["step"] - 0.05) < 1e-9 and not verdict.is_right
    assert " ".join(str(verdict).split()).startswith(f"{PROGRAMS / 'mujoco-euler.csv'}: wrong; suspect: integrator:semi-implicit-euler")
    assert "<svg" in verdict._repr_html_() and json.loads(verdict.to_json()) == verdict.to_dict()
    assert verdict.traces["t"].shape == verdict.traces["energy"].shape
    with pytest.raises(AssertionError, match="semi-implicit-euler"):
        assert_rotation_right(polhode.read(PROGRAMS / "mujoco-euler.csv"), moments=[1, 2, 2.5], advice=False)


def test_forces_are_part_of_the_question():
    body = polhode.Body([1.25, 1.3, 0.75], [polhode.gravity([0.1, 0, 2])])
    run = polhode.run("dop853", body, [0.5, 0, 20], [0.97, 0.24, 0, 0], times=T / 10, tolerance=1e-12)
    assert polhode.audit(T / 10, run.attitude, run.omega, body=body).is_right
    assert not polhode.audit(T / 10, run.attitude, run.omega, moments=[1.25, 1.3, 0.75], advice=False).is_right


class Turns:
    """What of scipy's rotations is looked for."""

    def as_quat(self):
        return np.tile([0.0, 0, 0, 1], (len(T), 1))


def test_what_cannot_be_audited_is_refused(exact):
    attitude, omega = exact
    for call, words in [
        (lambda: polhode.audit(T[:5], attitude[:5], omega[:5]), "the record has 5 rows; a verdict needs at least 10"),
        (lambda: polhode.audit(T, attitude[:9], omega), r"attitude: an array of shape \(9, 4\); it must be of shape \(300, 4\)"),
        (lambda: polhode.audit(T, omega, omega), "form: missing"),
        (lambda: polhode.audit(T, attitude * np.nan, omega), "NaN"),
        (lambda: polhode.audit(T, attitude, omega, moments=[1, 2, 3], body="phone"), "give one of them"),
        (lambda: polhode.audit(T, attitude, omega, tolerance=0), "tolerance"),
        (lambda: polhode.audit(T, attitude, omega, order="zyxw"), "order: 'zyxw'; it must be"),
        (lambda: polhode.audit(T, None, omega, form="euler"), "form: 'euler'; it is the form of attitudes, and there are none"),
        (lambda: polhode.audit(T, Turns(), omega, form="matrix"), "form: 'matrix'; it is the form of attitudes"),
    ]:
        with pytest.raises(PolhodeError, match=words):
            call()


def test_bodies_of_a_file_are_audited_one_by_one():
    bodies = polhode.read(PROGRAMS / "lammps-digits.dump")
    assert set(bodies) == {"1", "2"}
    verdict = polhode.audit(bodies["1"], moments=[0.05, 0.068, 0.082], advice=False)
    assert verdict.suspect == "integrator:richardson"


def simulated(noise=0.01, seed=1):
    t = np.arange(4000) * 0.01
    omega = polhode.FreeMotion([1, 2, 2.5], OMEGA).at(t).omega
    return t, omega + np.random.default_rng(seed).normal(0, noise, omega.shape)


def test_a_fit_finds_the_ratios_and_says_how_well():
    estimate = polhode.fit(*simulated())
    assert (abs(estimate.ratios - [0.4, 0.8]) < 5 * estimate.sigma_ratios).all()
    assert_allclose(estimate.principal.sum(), 1)
    assert estimate.covariance.shape == (6, 6) and abs(estimate.noise_sigma / 0.01 - 1) < 0.1
    assert estimate.inertia is None and estimate.flights == [(0.0, 39.99)]
    assert "offset_x" in estimate.systematic and "I1 / trace" in repr(estimate) and "<svg" in estimate._repr_html_()
    sized = polhode.fit(*simulated(), trace=5.5)
    assert_allclose(np.trace(sized.inertia), 5.5)
    # about an axis of any length
    assert_allclose(polhode.fit(*simulated(), moment=[0, 0, 2, 2.5]).inertia[2, 2], 2.5)


def test_limits_of_moments_hold():
    free = polhode.fit(*simulated())
    assert 0.15 < free.shape[0, 0] < 0.2
    assert polhode.fit(*simulated(), at_least=[[1, 0, 0, 0.15]], at_most=[[1, 0, 0, 0.2]]).active_constraints == []
    for limit, share in [("at_least", 0.2), ("at_most", 0.15)]:
        with pytest.warns(PolhodeWarning, match="the record contradicts them"):
            held = polhode.fit(*simulated(), **{limit: [[3, 0, 0, share]]})
        assert_allclose(held.shape[0, 0], share, rtol=1e-9)
        assert held.active_constraints[0]["name"].startswith("limit 1: moment about")
    for wrong, says in [
        (dict(moment=[0, 0, 1]), r"moment: an array of shape \(3,\); it must be of shape \(4,\)"),
        (dict(moment=[0, 0, 1, 2.5], trace=5.5), "trace, momentum, twice_energy, moment: give one of them"),
        (dict(at_most=[1, 0, 0, 0.2]), r"at_most: an array of shape \(4,\); it must be of shape \(n, 4\)"),
        (dict(at_least=[[1, 0, 0, 2]]), "it must be a share of the trace, from 0 to 1"),
    ]:
        with pytest.raises(PolhodeError, match=says):
            polhode.fit(*simulated(), **wrong)


def test_a_fit_says_how_its_record_was_read_and_what_to_do_next(tmp_path):
    t, rates = simulated()
    path = tmp_path / "record.csv"
    rows = "".join(f"{a},{x},{y},{z},20\n" for a, (x, y, z) in zip(1000 * t, np.degrees(rates)))
    path.write_text("t (ms),wx,wy,wz,temperature\n" + rows)
    record = polhode.read(path, rate_unit="deg/s", axes="x,y,z")
    read_as, = record.read_as
    assert (read_as["rate_unit"], read_as["rate_unit_by"]) == ("deg/s", "setting")
    assert (read_as["time_unit"], read_as["time_unit_by"]) == ("ms", "header")
    assert abs(read_as["sample_rate"] / 100 - 1) < 1e-9 and read_as["axes"] == "x, y, z" and read_as["taken_as_right_handed"]
    estimate = polhode.fit(record)
    assert estimate.read_as == [read_as] and estimate.unused_columns == ["temperature"]
    assert abs(estimate.ratios - polhode.fit(t, rates).ratios).max() < 1e-9 and polhode.fit(t, rates).read_as == []
    assert estimate.next_steps and estimate.method.startswith("weak form") and estimate.rank == 5
    assert abs(estimate.rms_rate / np.sqrt((rates**2).sum(axis=1).mean()) - 1) < 1e-3
    assert_allclose(np.diag(estimate.correlation), 1)
    assert estimate.per_segment[0]["ratios_without"] is None and estimate.torque_model == "none"


def test_each_segment_says_what_the_answer_is_without_it():
    parts = [simulated(seed=seed) for seed in range(3)]
    t = np.concatenate([part[0][:1000] + 100 * k for k, part in enumerate(parts)])
    rates = np.concatenate([part[1][1000 * k : 1000 * (k + 1)] for k, part in enumerate(parts)])
    estimate = polhode.fit(t, rates)
    assert [one["segment"] for one in estimate.per_segment] == [1, 2, 3]
    for one in estimate.per_segment:
        assert (one["sigma_ratios_without"] > estimate.sigma_ratios).all()
        assert (abs(one["ratios_without"] - [0.4, 0.8]) < 5 * one["sigma_ratios_without"]).all() and one["shift"] > 0


def test_warnings_of_a_fit_are_python_warnings():
    t, rates = simulated()
    rates[1000] += 1
    with pytest.warns(PolhodeWarning, match="1 sample was left out as far from"):
        estimate = polhode.fit(t, rates)
    assert any("far from" in text for text in estimate.warnings)


def test_readings_that_count_twice_are_said_to_do_so():
    t, rates = simulated()
    record = record_of(t, rates)
    with pytest.warns(PolhodeWarning, match=f"record 1 of the list: {len(t)} of its {len(t)} samples are those of records before it"):
        twice = polhode.fit([record, record])
    assert twice.segments == 2 and (twice.sigma_ratios < polhode.fit(record).sigma_ratios).all()


def record_of(t, rates):
    return polhode.read({"t": t, **{f"w{axis}": rates[:, k] for k, axis in enumerate("xyz")}}, kind="record")


def test_what_a_record_does_not_tell_is_refused():
    t = np.arange(4000) * 0.01
    spin = np.tile([0, 0, 1.0], (4000, 1)) + np.random.default_rng(1).normal(0, 0.01, (4000, 3))
    for call, words in [
        (lambda: polhode.fit(t, spin), "determine"),
        (lambda: polhode.fit(t, 0 * spin), "."),
        (lambda: polhode.fit(t[:3], spin), r"rates: an array of shape \(4000, 3\); it must be of shape \(3, 3\)"),
        (lambda: polhode.fit(t), "rates: missing"),
        # what would be of no use
        (lambda: polhode.fit(*simulated(), order="xyzw"), "order: 'xyzw'; it is of attitudes, and none are given"),
        (lambda: polhode.fit([record_of(*simulated())], wheel=spin), "wheel, applied_torque: the records have their own; leave them out"),
        (lambda: polhode.fit([record_of(*simulated())], applied_torque=spin), "wheel, applied_torque: the records have their own"),
        (lambda: polhode.fit(record_of(*simulated()), attitude=spin), "t: beside attitudes it must be times"),
        (lambda: polhode.fit(polhode.read(PROGRAMS / "mujoco-euler.csv")), 't: a Trajectory; read the file as kind="record"'),
        (lambda: polhode.fit(*simulated(), torque="wind"), "torque: 'wind'; it must be"),
        (lambda: polhode.fit(*simulated(), gyro_bias=-1), "gyro_bias: -1.0; it must be"),
    ]:
        with pytest.raises(PolhodeError, match=words):
            call()


def test_advice_names_a_method_that_does():
    told = []
    advice = polhode.advise([1, 2, 3], OMEGA, until=100, attitude_error=1e-6, exclude=["exact"], check=True,
                            progress=lambda *now: told.append(now))
    assert advice.actual_error <= 1e-6 and advice.method and told[-1][1] == 1
    # some times a second, not at each step, which are thousands
    assert sum(done < 1 for _, done, _ in told) < 200
    run = polhode.run(advice.method, [1, 2, 3], OMEGA, times=[0, 100], step=advice.step, tolerance=advice.tolerance)
    assert run.attitude_error[-1] < 2e-6
    assert advice.to_dict()["method"] == advice.method and advice.method in repr(advice)
    with pytest.raises(PolhodeError, match="at rest"):
        polhode.advise([1, 2, 3], [0, 0, 0], until=1, attitude_error=1e-6)
    with pytest.raises(PolhodeError, match='exclude: there is no method "rk5"'):
        polhode.advise([1, 2, 3], OMEGA, until=1, attitude_error=1e-6, exclude=["exact", "dmv", "rk5"])
    with pytest.raises(ZeroDivisionError):
        polhode.advise([1, 2, 3], OMEGA, until=1e4, attitude_error=1e-6, exclude=["exact"], progress=lambda *now: 1 / 0)


def test_solids_add_up():
    rod = polhode.solid("rod", [2], mass=3)
    assert_allclose(rod.principal_moments, [0, 1, 1], atol=1e-15)
    half = [polhode.solid("rod", [1], mass=1.5).moved([0, 0, z]) for z in (-0.5, 0.5)]
    assert_allclose((half[0] + half[1]).tensor, rod.tensor, rtol=1e-14)
    assert_allclose(rod.tensor_about([0, 0, 1])[0, 0], 4)
    box = polhode.solid("box", [1, 2, 3], density=2)
    assert_allclose(box.mass, 12)
    assert_allclose(box.turned([0, 1, 0, 0]).tensor, box.tensor, rtol=1e-14)
    assert_array_equal(polhode.Body(box).tensor, box.tensor)
    with pytest.raises(PolhodeError, match="give mass"):
        polhode.solid("box", [1, 2, 3])
    with pytest.raises(PolhodeError):
        polhode.solid("boxx", [1, 2, 3], mass=1)


def test_what_is_mended_of_a_mesh_is_said():
    corners, faces = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        whole = polhode.mesh(corners, faces, mass=1)
    inwards = [face[::-1] for face in faces]
    for triangles, close in [(inwards, None), (faces[:3], "fan"), (faces + faces[:1], None), (faces + [[0, 0, 1]], None)]:
        with pytest.warns(PolhodeWarning, match="^triangles: "):
            mended = polhode.mesh(corners, triangles, mass=1, close=close)
        assert_allclose(mended.tensor, whole.tensor, rtol=1e-14)
    both = np.concatenate([corners, np.add(corners, [0.1, 0, 0])])
    with pytest.warns(PolhodeWarning, match="^triangles: parts overlap, and .* % of the volume counts twice"):
        polhode.mesh(both, np.concatenate([faces, np.add(faces, 4)]), mass=1)
    with pytest.raises(PolhodeError, match="the mesh is open"):
        polhode.mesh(corners, faces[:3], mass=1)


def test_a_tensor_is_examined():
    valid = polhode.diagnose(np.diag([1.0, 2, 2.5]))
    assert valid.verdict == "valid" and valid.trouble is None
    wrong = polhode.diagnose([[0.75, 0.3125, 0.3125], [0.3125, 0.75, 0.3125], [0.3125, 0.3125, 0.75]])
    assert_array_equal(wrong.corrected[0], [0.75, -0.3125, -0.3125])
    assert "cause 1" in repr(wrong)
    with pytest.raises(PolhodeError, match="violate"):
        polhode.Body(wrong)


URDF = """<robot name="r">
<link name="forearm"><inertial><mass value="1.5"/><inertia ixx="0.01" iyy="0.02" izz="0.025" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="hand"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>"""


def test_links_of_a_robot_are_examined(tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text(URDF)
    robot = polhode.read(path)
    assert len(robot) == 2 and robot.keys() == ["forearm", "hand"] and "hand" in robot
    assert robot["forearm"].verdict == "valid" and robot[1].verdict == "invalid"
    assert_array_equal(polhode.Body(robot["forearm"]).principal_moments, [0.01, 0.02, 0.025])
    assert_array_equal(polhode.body(f"{path}:forearm").tensor, robot["forearm"].tensor)
    assert "violate" in repr(robot) and [link.name for link in robot] == robot.keys()
    with pytest.raises(KeyError, match="did you mean 'forearm'"):
        robot["forearn"]
    with pytest.raises(PolhodeError, match="violate"):
        robot["hand"].properties
    path.write_text(URDF.replace('value="1.5"', 'value="0.001"'))
    with pytest.warns(PolhodeWarning, match="of 'forearm': its tensor is suspicious: implausible density"):
        polhode.body(f"{path}:forearm")


def test_tables_in_memory_are_read_by_their_names(exact):
    attitude, omega = exact
    table = {"t": T, **{f"q_{axis}": attitude[:, k] for k, axis in enumerate("wxyz")}}
    table |= {f"Gyroscope {axis} (deg/s)": np.degrees(omega[:, k]) for k, axis in enumerate("xyz")}
    kinds = [(name, "f8") for name in table]
    structured = np.array(list(zip(*table.values())), dtype=kinds)

    class Frame:
        """As a data frame writes itself."""

        def to_csv(self, index=True):
            assert not index
            return "\n".join([",".join(table), *(",".join(map(repr, map(float, row))) for row in zip(*table.values()))])

    for given in (table, structured, Frame()):
        trajectory = polhode.read(given)
        assert_array_equal(trajectory.attitude, attitude)
        verdict = polhode.audit(trajectory, moments=[1, 2, 3])
        assert verdict.is_right and verdict.reading["rate_unit"] == "deg/s"
    record = polhode.read({name: table[name] for name in ["t", *(name for name in table if "Gyro" in name)]})
    assert_allclose(record.rates, omega, rtol=1e-15)
    with pytest.raises(PolhodeError, match=r"wx: an array of shape \(2,\); it must be of shape \(3,\), as t"):
        polhode.read({"t": [1, 2, 3], "wx": [1, 2]})
    with pytest.raises(PolhodeError, match="a trajectory or a record"):
        polhode.read(table, kind="mesh")
    for wrong, kind in [(None, "NoneType"), ([1, 2], "list"), (np.zeros((4, 4)), "ndarray"), (b"record.csv", "bytes")]:
        with pytest.raises(PolhodeError, match=f"^path: a {kind}; it must be a path, a data frame, a structured array or a dict of columns"):
            polhode.read(wrong)


def test_every_kind_of_file_is_read(tmp_path):
    trajectory = polhode.read(PROGRAMS / "basilisk.csv")
    assert isinstance(trajectory, polhode.Trajectory) and trajectory.attitude.shape == (len(trajectory), 3)
    columns = "t=1,s1=2,s2=3,s3=4,wx=5,wy=6,wz=7"
    saved = polhode.read(PROGRAMS / "numpy.npy", columns=columns)
    assert_array_equal(saved.t, trajectory.t)
    (tmp_path / "log.csv").write_text("time,gx,gy,gz\n0,0.4,1,-0.3\n10,0.41,0.99,-0.28\n20,x,y,z\n")
    with pytest.warns(PolhodeWarning, match="left out"):
        record = polhode.read(tmp_path / "log.csv", time_unit="ms", skip_rows=0.5)
    assert isinstance(record, polhode.Record) and record.t.tolist() == [0, 0.01] and record.rates.shape == (2, 3)
    (tmp_path / "parts.toml").write_text('[[part]]\nshape = "sphere"\nsizes = [0.1]\nmass = 2\n')
    (tmp_path / "tetrahedron.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    solid = polhode.read(tmp_path / "tetrahedron.obj", density=6, length_unit="m")
    assert_allclose(solid.mass, 1)
    assert_allclose(solid.center_of_mass, [0.25, 0.25, 0.25])
    (tmp_path / "times.txt").write_text("0\n1.5\n3\n")
    assert polhode.read(tmp_path / "times.txt", kind="times").tolist() == [0, 1.5, 3]
    (tmp_path / "dates.txt").write_text("2026-01-01T00:00:00Z\n2026-01-01T00:00:10Z\n")
    assert polhode.read(tmp_path / "dates.txt", kind="times", epoch="2025-12-31T23:59:50Z").tolist() == [10, 20]
    (tmp_path / "dates.csv").write_text("time,wx,wy,wz\n2026-01-01T00:00:00Z,0.4,1,-0.3\n2026-01-01T00:00:01Z,0.41,0.99,-0.28\n")
    for call, words in [
        (lambda: polhode.read(tmp_path / "missing.csv"), "missing.csv"),
        (lambda: polhode.read(tmp_path / "log.csv", kind="film"), "kind: 'film'"),
        (lambda: polhode.read(tmp_path / "log.csv", density=1), "they are for meshes"),
        (lambda: polhode.read(tmp_path / "tetrahedron.obj"), "give mass"),
        (lambda: polhode.read("-"), "-"),
        # what would be of no use
        (lambda: polhode.read(tmp_path / "log.csv", weld=1e-6), "they are for meshes"),
        (lambda: polhode.read(tmp_path / "log.csv", root=tmp_path), "root: it is the folder of the includes"),
        (lambda: polhode.read(tmp_path / "tetrahedron.obj", density=6, shell=0.01, close="fan"), "close, shell: .*give one of the two"),
        (lambda: polhode.read(tmp_path / "tetrahedron.obj", density=6, columns="t=1"), "they are for trajectories and records"),
        (lambda: polhode.read(tmp_path / "times.txt", kind="times", time_unit="ms"), "they are for trajectories and records"),
        (lambda: polhode.read(PROGRAMS / "numpy.npy", columns=columns, axes="x,-y,z"), "they are for records"),
        (lambda: polhode.read({"t": [0, 1], **{f"q_{axis}": [0.5, 0.5] for axis in "wxyz"}}, rate_unit="rpm"), "rate_unit: 'rpm'"),
        (lambda: polhode.read(tmp_path / "dates.csv", time_unit="ms"), "dates.csv are dates already"),
        (lambda: polhode.read(tmp_path / "dates.csv", epoch="2026-01-01"), "epoch: it is the date of t = 0 of times"),
        (lambda: polhode.read(tmp_path / "dates.txt", kind="times", epoch="soon"), "^epoch: "),
        # flags of the command are keywords here
        (lambda: polhode.read(tmp_path / "dates.txt", kind="times"), "give the date of t = 0 by epoch"),
        (lambda: polhode.read(tmp_path / "log.csv", sample_rate=100), "drop sample_rate, or name the counter by columns t=NAME"),
        (lambda: polhode.read({"x": [1, 2]}, kind="record"), r"say which they are: columns t=NAME,wx=NAME,... \(keys in help\)"),
    ]:
        with pytest.raises(PolhodeError, match=words):
            call()


def test_one_record_of_a_carrier_is_not_two():
    t, random = np.arange(1000) * 0.01, np.random.default_rng(1)
    rates = polhode.FreeMotion([0.02, 0.03, 0.04], [1, 3, 2]).at(t).omega + random.normal(0, 1e-3, (1000, 3))
    one = (t, rates)
    says = "the record of {} has samples of that of carrier, although "
    with pytest.raises(PolhodeError, match=says.format("carrier and proof body")):
        polhode.fit_carrier(one, proof=one, proof_body=[0.015, 0.004, 0.016])
    with pytest.raises(PolhodeError, match=says.format("carrier and object")):
        polhode.fit_carrier(one, object=one)


# in nanoseconds since 1970; the nearest double is 21 ns away
COUNT = 1_700_000_000_123_456_789


@pytest.mark.parametrize(
    "t",
    [
        COUNT + np.arange(4) * 10_000_000,
        (COUNT + np.arange(4) * 10_000_000).astype("uint64"),
        np.array([COUNT, COUNT + 10_000_000], dtype=object),
        np.array([np.int64(COUNT), 1.5], dtype=object),
        [2**53 + 1, 2**64 + 1],
        2**53 + 1,
    ],
)
def test_integers_that_are_no_doubles_are_refused(t):
    first = np.ravel(np.asarray(t, dtype=object))[0]
    with pytest.raises(PolhodeError, match=f"^t: {first} has too many digits for a double, the nearest is {int(float(first))}; subtract"):
        polhode.FreeMotion([1, 2, 3], OMEGA).at(t)


def test_integers_that_are_doubles_are_numbers():
    beyond = np.array([2**60, 2**61, 3 * 2**59])
    for moments in (beyond, beyond.astype("uint64"), beyond.astype(object), np.array([1, 2, 2.5], dtype=object), np.arange(2, 5, dtype="int8")):
        given = polhode.FreeMotion(moments, OMEGA).at(T).attitude
        assert_array_equal(given, polhode.FreeMotion(np.asarray(moments, dtype=float), OMEGA).at(T).attitude)
    # masked arrays, of which nothing is masked
    whole = np.ma.masked_array([1, 2, 3])
    assert_array_equal(polhode.FreeMotion(whole, OMEGA).at(T).attitude, polhode.FreeMotion([1, 2, 3], OMEGA).at(T).attitude)
    whole[1] = np.ma.masked
    with pytest.raises(PolhodeError, match="inertia: not an array of numbers"):
        polhode.FreeMotion(whole, OMEGA)
    at = polhode.FreeMotion([1, 2, 3], OMEGA).at
    for text in ("1.5", b"1.5", True):
        with pytest.raises(PolhodeError, match=f"t: not an array of numbers: it holds a {type(text).__name__}"):
            at(np.array([0.0, text], dtype=object))


def test_counts_since_1970_keep_their_digits_in_a_table():
    rates = {f"w{axis} (rad/s)": np.sin(np.arange(40) + k) for k, axis in enumerate("xyz")}
    # 1 ns beside the whole microsecond
    counts = COUNT + np.arange(40) * 10_000_001
    for t in (counts, counts.astype("uint64"), counts.tolist()):
        record = polhode.read({"t": t, **rates}, kind="record", time_unit="ns")
        assert_allclose(record.t, np.arange(40) * 10_000_001e-9, rtol=1e-15)


class Quantity(np.ndarray):
    """An array with a unit as those of astropy."""

    unit = "deg / s"

    def to_value(self, unit):
        raise NotImplementedError


class Bare(Quantity):
    unit = ""


class Measured:
    """A quantity as those of pint."""

    units = "hour"
    magnitude = np.arange(40)

    def __array__(self, dtype=None, copy=None):
        return self.magnitude


def test_units_that_numpy_strips_are_refused():
    degrees = np.array(OMEGA).view(Quantity)
    with pytest.raises(PolhodeError, match="^omega: a quantity in deg / s, and units of quantities are not read; give its numbers"):
        polhode.FreeMotion([1, 2, 3], degrees)
    with pytest.raises(PolhodeError, match="^step: a quantity in deg / s"):
        polhode.run("rk4", [1, 2, 3], OMEGA, times=[1], step=np.array(0.1).view(Quantity))
    with pytest.raises(PolhodeError, match="t: a quantity in hour"):
        polhode.FreeMotion([1, 2, 3], OMEGA).at(Measured())
    rates = {f"w{axis} (rad/s)": np.sin(np.arange(40) + k) for k, axis in enumerate("xyz")}
    with pytest.raises(PolhodeError, match="a quantity in hour"):
        polhode.read({"t": Measured(), **rates}, kind="record")
    bare = polhode.FreeMotion([1, 2, 3], np.array(OMEGA).view(Bare))
    assert_array_equal(bare.at(T).attitude, polhode.FreeMotion([1, 2, 3], OMEGA).at(T).attitude)


def test_columns_that_are_counted_are_no_names():
    rows = np.column_stack([T, np.sin(T), np.cos(T), np.sin(2 * T)])

    class Frame:
        """As a data frame of pandas that was made of an array."""

        columns = range(4)

        def to_csv(self, index=True):
            return "\n".join([",".join(map(str, self.columns)), *(",".join(map(repr, row)) for row in rows.tolist())])

    for given in (Frame(), dict(zip("0123", rows.T)), {"1.5": T, " -1e3": T}):
        with pytest.raises(PolhodeError, match="path: the columns are called .*, which may be a row of numbers; give them names, as t, wx"):
            polhode.read(given, kind="record")
    Frame.columns = ["t", "wx", "wy", "wz"]
    assert_array_equal(polhode.read(Frame(), kind="record").rates, rows[:, 1:])


def test_columns_beside_those_that_are_read_may_hold_anything_that_a_file_has():
    rates = {f"w{axis}": np.sin(np.arange(5) + k) for k, axis in enumerate("xyz")}
    told = polhode.read({"t": np.arange(5) * 0.1, **rates}, kind="record")
    beside = {"label": np.array(['a,b', 'say "c"', "#d", "e;f\n", ""]), "ok": np.arange(5) > 2, "from": np.array(["2026-01-01"] * 5, "M8[D]")}
    found = polhode.read({**beside, "t": np.arange(5) * 0.1, **rates}, kind="record")
    assert_array_equal(found.t, told.t)
    assert_array_equal(found.rates, told.rates)
    dates = np.datetime64("2026-01-01T00:00:00", "ns") + (np.arange(5) * 100_000_000).astype("m8[ns]")
    assert_allclose(polhode.read({"t": dates, **rates}, kind="record").t, told.t, atol=1e-12)
    for wrong, says in [
        (np.arange(5) > 2, "True|False"),
        (np.arange(5) * 1j, "wz: an array of complex128; it must hold real numbers"),
        (np.zeros((5, 2)), r"wz: an array of shape \(5, 2\); it must be of shape \(n,\)"),
        (np.zeros(5, "m8[s]"), "wz: an array of timedelta64"),
    ]:
        with pytest.raises(PolhodeError, match=says):
            polhode.read({"t": np.arange(5) * 0.1, **rates, "wz": wrong}, kind="record")


def test_a_unit_of_times_that_is_guessed_is_said():
    rates = {f"w{axis} (rad/s)": np.sin(np.arange(40) + k) for k, axis in enumerate("xyz")}
    table = {"t": COUNT + np.arange(40) * 10_000_000, **rates}
    with pytest.warns(PolhodeWarning, match="the times are taken as ns since 1970; if they count from another time, .* give their unit as time_unit"):
        polhode.read(table, kind="record")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        polhode.read(table, kind="record", time_unit="ns")
