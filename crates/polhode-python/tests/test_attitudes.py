"""Attitudes from rates."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

import polhode
from polhode import FreeMotion, PolhodeError, PolhodeWarning

T = np.arange(2000) * 0.05
EXACT, RATES = FreeMotion([1, 2, 3], [0.4, 1, -0.3]).at(T)


def angles(found, exact):
    return 2 * np.arccos(np.clip(abs((found * exact).sum(1)), 0, 1))


def test_errors_are_those_of_the_budget():
    noisy = RATES + np.random.default_rng(1).normal(0, 1e-3, RATES.shape)
    found = polhode.attitude(T, noisy, kind="rate")
    assert_allclose(found.noise, 1e-3, rtol=0.1)
    error = angles(found.attitude, EXACT)
    assert 0.1 < error[-1] / (found.sigma[-1] * 3**0.5) < 3
    assert_allclose(found.sigma, np.sqrt(np.trace(found.covariance, axis1=1, axis2=2) / 3))
    assert set(found.budget) == {"truncation", "random_walk", "bias", "scale", "stamps"} and len(found) == 2000
    smooth = polhode.attitude(T, noisy, kind="rate", body=[1, 2, 3])
    assert smooth.rule == "exact motion" and smooth.sigma[-1] < found.sigma[-1] and (smooth.truncation == 0).all()
    assert "magnus:" in repr(found) and found._repr_html_().count("<svg") == 1


def test_what_an_attitude_is_not_worth_is_said():
    spike = RATES + np.random.default_rng(1).normal(0, 1e-3, RATES.shape)
    # stamps are part of noise that is found
    assert (polhode.attitude(T, spike, kind="rate", stamps=0.01).budget["stamps"] == 0).all()
    assert polhode.attitude(T, spike, kind="rate", stamps=0.01, noise=1e-3).budget["stamps"][-1] > 0
    # a spike is left out, as by the command, and does nothing to the attitude
    quiet = polhode.attitude(T, spike, kind="rate", rule="magnus:4,4")
    spike[1000] += 1
    with pytest.warns(PolhodeWarning, match=r"1 spikes are left out, the first at row 1001 \(50 s\)"):
        found = polhode.attitude(T, spike, kind="rate", rule="magnus:4,4")
    assert (found.t == np.delete(T, 1000)).all()
    assert angles(found.attitude[-1:], quiet.attitude[-1:])[0] < 1e-3
    with pytest.warns(PolhodeWarning, match="the attitude is lost: from t = .* s on its standard deviation is above 1 rad"):
        polhode.attitude(T, RATES, kind="rate", noise=0, bias=10.0)


def test_warnings_are_those_of_the_command():
    def told(t, rates, **options):
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            polhode.attitude(t, rates, **options)
        return [str(one.message) for one in found]

    noise = "fewer than 5 samples, too few to find their noise: sigma does not include it; give noise"
    truncation = "one polynomial goes through all 4 samples"
    four = told(T[:4], RATES[:4], kind="rate", rule="magnus:4,4")
    assert noise in four and any(text.startswith(truncation) for text in four), four
    assert not told(T[:4], RATES[:4], kind="rate", rule="magnus:2,2", noise=1e-3)
    # stamps count where no noise is found that holds them
    with pytest.warns(PolhodeWarning, match="fewer than 5 samples"):
        assert polhode.attitude(T[:4], RATES[:4], kind="rate", rule="magnus:2,2", stamps=0.01).budget["stamps"][-1] > 0
    # one step of a sensor
    still = np.full((100, 3), 0.02)
    steps = "the readings rest on so few values"
    assert any(text.startswith(steps) for text in told(T[:100], still, kind="rate"))
    assert not told(T[:100], still, kind="rate", bias=0.006) and not told(T[:100], still, kind="rate", noise=1e-3)
    missing = np.delete(np.arange(100), 20)
    one = "1 intervals are longer than 1.5 usual ones, the first ends at 1.05 s"
    assert any(text.startswith(one) for text in told(T[missing], RATES[missing] * 0.05, kind="increment", rule="magnus:2,2"))
    assert not any("intervals" in text for text in told(T[missing], RATES[missing], kind="rate"))
    twice = np.insert(np.arange(100), 20, 20)
    merged = "1 rows have the time of the row before, the first at 1 s: their rates are averaged"
    assert told(T[twice], RATES[twice], kind="rate") == [merged]
    with pytest.raises(PolhodeError, match="1 rows have the time of the row before; with averages none may be missing or repeated"):
        polhode.attitude(T[twice], RATES[twice], kind="average")


def test_the_command_leaves_out_the_same(command):
    spiked = RATES + np.random.default_rng(1).normal(0, 1e-3, RATES.shape)
    spiked[[300, 1000]] += 1
    rows = "".join("{!r},{!r},{!r},{!r}\n".format(*map(float, row)) for row in np.column_stack([T, spiked]))
    record = command.folder / "spikes.csv"
    record.write_text("t (s),wx (rad/s),wy (rad/s),wz (rad/s)\n" + rows)
    beside = command("attitude", record, "--kind", "rate")
    with pytest.warns(PolhodeWarning, match="2 spikes are left out"):
        found = polhode.attitude(T, spiked, kind="rate")
    assert [row["t"] for row in beside] == list(found.t)
    assert [row["attitude_sigma"] for row in beside] == list(found.sigma)
    assert [row["q_w"] for row in beside] == list(found.attitude[:, 0])


def test_orders_of_rules_and_of_quaternions():
    half = polhode.attitude(T, RATES, kind="rate", rule="hold", noise=0, start=EXACT[0])
    fine = polhode.attitude(T, RATES, kind="rate", rule="magnus:6,8", noise=0, start=EXACT[0])
    assert fine.rule == "magnus:6,8" and polhode.attitude(T, RATES, kind="rate", rule="magnus:4", noise=0).rule.startswith("magnus:4,")
    assert angles(half.attitude, EXACT)[-1] > 1e-3 > 1e-7 > angles(fine.attitude, EXACT)[-1]
    last = polhode.attitude(T, RATES, kind="rate", rule="magnus:6,8", noise=0, order="xyzw")
    assert_allclose(np.roll(last.attitude, 1, axis=1), fine.attitude, atol=1e-15)
    # what a reading is makes a difference of half an interval
    mean = polhode.attitude(T, RATES, kind="average", rule="magnus:6,8", noise=0)
    assert angles(mean.attitude, fine.attitude)[-1] > 1e-3
    angle = polhode.attitude(T, RATES * 0.05, kind="increment", rule="magnus:6,8", noise=0)
    assert_allclose(angle.attitude, mean.attitude, atol=1e-12)


@pytest.mark.parametrize(
    "call, says",
    [
        (lambda: polhode.attitude(T, RATES, kind="speed"), "kind: unknown kind of reading 'speed'"),
        (lambda: polhode.attitude(T, RATES[1:], kind="rate"), r"rates: an array of shape \(1999, 3\)"),
        (lambda: polhode.attitude(T, RATES, kind="rate", rule="euler"), "rule: 'euler'; it must be auto"),
        (lambda: polhode.attitude(T, RATES, kind="rate", rule="magnus:6,7"), "7 samples"),
        (lambda: polhode.attitude(T, RATES, kind="average", rule="runge-kutta"), "needs instantaneous rates"),
        (lambda: polhode.attitude(T[::-1], RATES, kind="rate"), "times must not decrease"),
        (lambda: polhode.attitude(T, RATES * np.nan, kind="rate", noise=0), r"line 1, column 2 \(wx\)"),
        (lambda: polhode.attitude(np.where(T > 50, T + 100, T), RATES, kind="rate"), "2 segments with gaps .* from 50 s to 150.05"),
        (lambda: polhode.attitude(T, RATES * 100, kind="rate"), "more than half a turn"),
        (lambda: polhode.attitude(T, RATES, kind="rate", bias=-1.0), "the bias of the sensor is -1"),
        (lambda: polhode.attitude(T, RATES, kind="rate", stamps=-1.0), "the error of the stamps of the sensor is -1"),
        (lambda: polhode.attitude(T, RATES, kind="rate", start=[0, 0, 0, 0]), "start: .* is not a rotation"),
        (lambda: polhode.attitude(T, RATES, kind="rate", start=[1, 0, 0]), r"start: an array of shape \(3,\)"),
        (lambda: polhode.attitude(T, RATES, kind="rate", body=[1, 1, 1.9]), "the record contradicts the body"),
        (lambda: polhode.attitude(T, RATES, kind="increment", body=[1, 2, 3]), "a flight is fitted to rates"),
        (lambda: polhode.attitude(T, kind="rate"), "rates: missing"),
    ],
)
def test_what_tells_no_attitude_is_refused(call, says):
    with pytest.raises(PolhodeError, match=says):
        call()


def test_a_record_of_a_file_and_one_with_a_gap():
    table = {"t": T, "wx (rad/s)": RATES[:, 0], "wy (rad/s)": RATES[:, 1], "wz (rad/s)": RATES[:, 2]}
    record = polhode.read(table, kind="record")
    found = polhode.attitude(record, kind="rate", noise=0)
    assert_allclose(found.attitude, polhode.attitude(T, RATES, kind="rate", noise=0).attitude, atol=1e-15)
    with pytest.raises(PolhodeError, match="the record has its own"):
        polhode.attitude(record, RATES, kind="rate")
    table["t"] = np.where(T > 50, T + 100, T)
    with pytest.raises(PolhodeError, match="2 segments with gaps"):
        polhode.attitude(polhode.read(table, kind="record"), kind="rate")
