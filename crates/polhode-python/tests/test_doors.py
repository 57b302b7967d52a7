"""What the front page shows with the command comes out of Python too, bit for bit; times of processors excepted."""

import csv
import io

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import polhode
from conftest import PROGRAMS, stl_of_an_open_cube


def close_to_all(found, told, but=()):
    """The same values under the same names, without those that are times of processors."""
    assert found.keys() == told.keys()
    for name in set(told) - set(but):
        assert found[name] == told[name], name


@pytest.mark.parametrize("log, body", [
    ("mujoco-euler.csv", [1, 2, 2.5]), ("mujoco-rk4.csv", [1, 2, 2.5]), ("basilisk.csv", [10, 20, 26]), ("drake.csv", [1, 2, 2.6]),
])  # fmt: skip
def test_a_simulator(command, log, body):
    told = command("audit", PROGRAMS / log, "--moments", ",".join(map(str, body)))
    verdict = polhode.audit(polhode.read(PROGRAMS / log), moments=body)
    # advice is that of the quickest on this machine, found in two seconds
    close_to_all(verdict.to_dict(), told, but=["advice"])
    text = command("audit", PROGRAMS / log, "--moments", ",".join(map(str, body)), format="table")
    assert [line for line in str(verdict).splitlines() if "Switch to" not in line][:8] == text.splitlines()[:8]


def test_advice(command):
    told = command("advise", "--body", "toutatis", "--until", "30d", "--attitude-error", "1e-6")
    advice = polhode.advise("toutatis", until=30 * 86400, attitude_error=1e-6)
    assert (advice.method, advice.step, advice.tolerance) == (told["method"], told["step"], told["tolerance"])
    assert advice.predicted_error == told["predicted_error"] and advice.conditioning == told["conditioning"]
    # of methods that both have run at the same setting the errors are the same
    ours = {(one["method"], one["step"], one["tolerance"]): one for one in advice.others if one["whole_time"]}
    theirs = {(one["method"], one["step"], one["tolerance"]): one for one in told["others"] if one["whole_time"]}
    for both in ours.keys() & theirs.keys():
        assert ours[both]["predicted_error"] == theirs[both]["predicted_error"], both


def test_a_phase_error(command):
    told = command("compare", "--moments", "1,2,3", "--omega", "0.4,1,-0.3", "--until", "100", "--methods", "rattle,rattle+phase",
                   "--steps", "0.05", "--phase")  # fmt: skip
    drift = polhode.phase("rattle", [1, 2, 3], [0.4, 1, -0.3], step=0.05)
    # the command's start has gone through a file of doubles
    found = [drift.shift, drift.twist, drift.attitude_error(100)]
    np.testing.assert_allclose(found, [told[0][key] for key in ("shift_rate", "twist_rate", "predicted_error")], rtol=1e-9)
    for ask in (drift.departure, drift.rounding):
        with pytest.raises(polhode.PolhodeError, match="t: NaN is not a finite number of seconds"):
            ask(float("nan"))
    assert drift.doubt < 1e-9 and 0 < drift.rounding(100) < 1e-9 * drift.attitude_error(100)
    exact = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3]).at([100])
    ends = [polhode.run(name, [1, 2, 3], [0.4, 1, -0.3], step=0.05, times=[100]) for name in ("rattle", "rattle+phase")]
    errors = [2 * np.arccos(min(1.0, abs(float((end.attitude @ exact.attitude.T).item())))) for end in ends]
    assert abs(errors[0] / drift.attitude_error(100) - 1) < 1e-6 and errors[1] < 1e-7  # arccos next to one
    with pytest.raises(polhode.PolhodeError, match="its energy drifts"):
        polhode.phase("rk4", [1, 2, 3], [0.4, 1, -0.3], step=0.05)
    with pytest.raises(polhode.PolhodeError, match="its energy drifts"):
        polhode.run("rk4+phase", [1, 2, 3], [0.4, 1, -0.3], step=0.05, times=[1])


def test_a_tumbling_asteroid(command):
    (told,) = command("motion", "--body", "toutatis")
    assert (told.pop("frame"), told.pop("epoch")) == ("ecliptic J2000", "1992-11-09T17:49:47 UTC")
    close_to_all(polhode.FreeMotion("toutatis").character(), told)


def rows(text):
    found = list(csv.DictReader(io.StringIO(text)))
    return {name: np.array([float(row[name] or "nan") for row in found]) for name in found[0]}


def test_a_tensor(command):
    path = command.folder / "part.stl"
    path.write_text(stl_of_an_open_cube())
    told = command("inertia", "mesh", "part.stl", "--length-unit", "mm", "--density", "2700", "--close", "fan")
    with pytest.warns(polhode.PolhodeWarning, match="mended"):
        found = polhode.read(path, length_unit="mm", density=2700, close="fan")
    assert (found.mass, found.tensor.tolist()) == (told["mass"], told["inertia"])
    assert_array_equal(found.center_of_mass, told["center_of_mass"])
    assert_array_equal(found.principal_moments, told["principal_moments"])
    wrong = command("inertia", "tensor", "0.75,0.75,0.75,0.3125,0.3125,0.3125")
    examined = polhode.diagnose([[0.75, 0.3125, 0.3125], [0.3125, 0.75, 0.3125], [0.3125, 0.3125, 0.75]])
    assert (examined.verdict, examined.trouble, examined.cause) == (wrong["verdict"], wrong["trouble"], wrong["cause"])


def test_a_record(command):
    command("simulate", "--body", "spacecraft", "--omega", "0.3,1,0.4", "--until", "60", "--every", "0.01", "--noise", "0.01", "--out", "record.csv", format=None)
    told = command("fit", "record.csv")
    found = polhode.fit(polhode.read(command.folder / "record.csv", kind="record"))
    for name in ("shape", "principal", "sigma_principal", "axes", "covariance", "ratios", "sigma_ratios", "bound"):
        assert_array_equal(getattr(found, name), told[name], err_msg=name)
    for name in ("noise_sigma", "samples", "segments", "radius", "chi2_per_dof", "triangle_slack", "unexplained", "warnings", "identifiable"):
        assert getattr(found, name) == told[name], name
    assert [list(flight) for flight in found.flights] == told["flights"]
    for line in told["systematic"]:
        assert found.systematic[line["name"]]["principal"].tolist() == line["principal"]


def test_a_carrier_a_proof_body_and_an_object(command):
    tensors = {"carrier": "0.03,0.051,0.063,0.003,-0.006,0.002", "proof": "0.03495,0.0671,0.07935,0.0045,-0.00825,0.0029",
               "object": "0.037,0.06,0.0768,0.0054,-0.0048,0.0018", "both": "0.04244,0.07776,0.096,0.00828,-0.0072,0.003"}
    for (name, tensor), omega in zip(tensors.items(), ["1,2.5,1.5", "2,1,2", "-1,2,2", "2,2,-1"]):
        motion = ["--omega", omega, "--until", "8", "--every", "0.02", "--noise", "0.001"]
        command("simulate", f"--inertia={tensor}", *motion, "--out", f"{name}.csv", format=None)
    told = command("fit", "object.csv", "--carrier", "carrier.csv", "--proof", "proof.csv", "--object-proof", "both.csv", "--proof-body",
                   "0.003,0.011,0.012", "--proof-at", "0.05,-0.02,0.03,2", "--carrier-mass", "6", "--object-at", "-0.04,0.04,0.02,2")
    carrier, proof, item, both = (polhode.read(command.folder / f"{name}.csv", kind="record") for name in tensors)
    known = polhode.MassProperties(2, [0.05, -0.02, 0.03], np.diag([0.003, 0.011, 0.012]))
    found = polhode.fit_carrier(carrier, proof=proof, object=item, object_proof=both, proof_body=known, carrier_mass=6,
                                object_mass=2, object_at=[-0.04, 0.04, 0.02])
    for body in ("carrier", "object", "object_itself"):
        assert_array_equal(getattr(found, body).tensor, told[body]["inertia"], err_msg=body)
        assert_array_equal(getattr(found, body).covariance, told[body]["inertia_covariance"], err_msg=body)
    assert found.agreement == (told["chi2"], told["dof"]) and found.warnings == told["warnings"]
    assert set(found.records) == {record["attached"] for record in told["records"]}
    for wrong, words in [
        (dict(), "nothing gives the size of the carrier"),
        (dict(proof=proof), "proof_body: missing"),
        (dict(proof=proof, proof_body=known), "carrier_mass: missing"),
        (dict(proof_body=[1, 2, 2.5]), "proof, object_proof: missing"),
        (dict(object=item, object_mass=2), "give all three"),
        (dict(object=(item.t,)), "object: a tuple of 1"),
        (dict(object_proof=both, proof_body=known, carrier_mass=6), "object_mass, object_at: missing"),
        (dict(object_mass=2, object_at=[-0.04, 0.04, 0.02], carrier_mass=6), "object_at: no record has the object"),
        (dict(object=item, proof_sigma=0.01), "proof_sigma: 0.01; it is of proof_body"),
        (dict(proof=proof, proof_body=[1, 2, 2.5], carrier_mass=6), "carrier_mass: 6.0; it goes with"),
    ]:
        with pytest.raises(polhode.PolhodeError, match=words):
            polhode.fit_carrier(carrier, **wrong)


@pytest.mark.parametrize("rates", [[], ["--noise", "0.01"]])
def test_a_record_of_attitudes(command, rates):
    start = ["--body", "phone", "--omega", "1,9,2", "--until", "5", "--every", "0.02"]
    command("simulate", *start, "--attitude-noise", "0.005", *rates, "--out", "poses.csv", format=None)
    told = command("fit", "poses.csv", "--from", "both" if rates else "attitudes", "--attitude", "body-to-space")
    measured = polhode.read(command.folder / "poses.csv")
    found = polhode.fit(measured.t, measured.omega if rates else None, attitude=measured.attitude)
    for name in ("shape", "principal", "sigma_principal", "axes", "covariance", "ratios", "sigma_ratios"):
        assert_array_equal(getattr(found, name), told[name], err_msg=name)
    assert found.attitudes["noise_sigma"] == told["attitudes"]["noise_sigma"]
    assert ("alignment" in found.attitudes) == bool(rates)
    # space to body is said to be so
    inverse = measured.attitude * [1, -1, -1, -1]
    with pytest.raises(polhode.PolhodeError, match="look inverted"):
        polhode.fit(measured.t, attitude=inverse)
    with pytest.raises(polhode.PolhodeError, match="attitude_noise: given without attitude"):
        polhode.fit(measured.t, measured.attitude[:, 1:], attitude_noise=0.01)


def test_attitudes_of_a_gyroscope(command):
    command("simulate", "--body", "spacecraft", "--omega", "0.3,1,0.4", "--until", "60", "--every", "0.05", "--noise", "1e-4", "--out", "gyro.csv", format=None)
    told = rows(command("attitude", "gyro.csv", "--kind", "rate", "--bias", "1e-5", format="csv"))
    found = polhode.attitude(polhode.read(command.folder / "gyro.csv", kind="record"), kind="rate", bias=1e-5)
    assert_array_equal(found.attitude, np.column_stack([told[f"q_{axis}"] for axis in "wxyz"]))
    assert_array_equal(found.sigma, told["attitude_sigma"])
    assert_array_equal(found.truncation, told["truncation"])


@pytest.mark.parametrize("method, flags", [("rk4", ["--step", "0.05"]), ("rattle", ["--step", "0.05"]), ("dop853", ["--tolerance", "1e-12", "--step", "0.1"]), ("exact", [])])
def test_a_class(command, method, flags):
    told = rows(command("propagate", "--body", "racket", "--until", "10", "--every", "0.1", "--method", method, *flags, format="csv"))
    times = told["t"]
    setting = {flag.lstrip("-"): float(value) for flag, value in zip(flags[::2], flags[1::2])}
    found = polhode.run(method, "racket", times=times, **setting)
    for k, axis in enumerate("wxyz"):
        assert_array_equal(found.attitude[:, k], told[f"q_{axis}"])
    for k, axis in enumerate("xyz"):
        assert_array_equal(found.omega[:, k], told[f"omega_body_{axis}"])
    for name in ("energy", "momentum", "energy_error", "momentum_error", "momentum_vector_error", "attitude_error"):
        values = getattr(found, name)
        assert_array_equal(np.full(len(times), np.nan) if values is None else values, told[name], err_msg=name)
