//! The numbers of a verdict are those of the record: each is put there with a known size, and worked out here by other means.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::audit::{Judgement, Question, Verdict, audit};
use polhode::body::{Body, Conserved};
use polhode::inertia::Inertia;
use polhode::rotation::{Quat, Vec3};

use super::records::{Form, Seeded, Writing, Written, plain, plain_in, record};
use super::ties::states;

const MOMENTS: [f64; 3] = [1.0, 2.0, 3.0];
const ROWS: usize = 401;
const STEP: f64 = 0.05;

fn body() -> Body {
    Body::free(Inertia::from_moments(MOMENTS).unwrap())
}

fn motion(omega: [f64; 3]) -> Vec<Written> {
    let body = body();
    let attitude = UnitQuaternion::from_euler_angles(0.3, -0.8, 1.9);
    states(&body, &body.state(attitude, omega.into()).unwrap(), STEP, ROWS)
}

fn verdict(states: &[Written]) -> Verdict {
    audit(&plain(states), &Question::new(Some(body()))).unwrap()
}

/// How a row is changed: a turn of the attitude in space, rad, and a factor of ω.
type Change<'a> = &'a dyn Fn(usize, &Written) -> (Vec3<f64>, f64);

fn changed(of: Change) -> Vec<Written> {
    let rows = motion([0.4, 1.0, -0.3]);
    let change = |(row, state): (usize, &Written)| {
        let (turn, factor) = of(row, state);
        (state.0, turn_by(turn) * state.1, state.2 * factor)
    };
    rows.iter().enumerate().map(change).collect()
}

fn turn_by(turn: Vec3<f64>) -> Quat<f64> {
    UnitQuaternion::from_scaled_axis(Vector3::from(turn)).into()
}

fn near(found: f64, expected: f64, part: f64) {
    assert!((found - expected).abs() <= part * expected.abs(), "{found:e} for {expected:e}");
}

fn momentum(state: &Written) -> Vec3<f64> {
    state.1.rotate(state.2.times(Vec3(MOMENTS)))
}

/// ω grows by a part in a thousand to the end: |L| and its components by as much, the energy by twice that, each at a steady rate;
/// no direction changes.
#[test]
fn what_grows_steadily_is_shown_with_its_size_and_rate() {
    let span = STEP * (ROWS - 1) as f64;
    let verdict = verdict(&changed(&|row, _| (Vec3::zero(), 1.0 + 1e-3 * row as f64 / (ROWS - 1) as f64)));
    assert_eq!(verdict.judgement, Judgement::Wrong);
    assert_eq!(verdict.conservation.len(), 4);
    for kept in &verdict.conservation {
        let size = match kept.quantity {
            Conserved::Energy => 2.001e-3,
            Conserved::MomentumNorm | Conserved::Momentum => 1e-3,
            _ => continue,
        };
        near(kept.error, size, 1e-9);
        let drift = kept.drift.unwrap();
        near(drift.slope, size / span, 1e-3);
        assert!(drift.half_width < 1e-2 * drift.slope, "{kept:?}");
        assert!(!kept.conserved && kept.resolution > 1e-6 && kept.resolution < 2e-5, "{kept:?}");
    }
    let traces = &verdict.traces;
    for (k, time) in traces.times.iter().enumerate() {
        let grown = 1e-3 * time / span;
        assert!((traces.energy[k] - grown * (2.0 + grown)).abs() < 1e-12);
        assert!((traces.momentum_norm[k] - grown).abs() < 1e-12);
        assert!(traces.momentum_direction[k].abs() < 1e-10);
    }
    assert_eq!(traces.times.len(), traces.attitude.len());
}

/// L swings to both sides of where it was: the angle has a sign, and the largest change is that of the record.
#[test]
fn the_direction_of_the_momentum_swings_to_both_sides() {
    let first = momentum(&motion([0.4, 1.0, -0.3])[0]);
    let across = first.cross(Vec3([0.0, 0.0, 1.0]));
    let axis = across * (1.0 / across.norm());
    let angle = |row: usize| 2e-3 * (0.03 * row as f64).sin();
    let rows = changed(&|row, _| (axis * angle(row), 1.0));
    let verdict = verdict(&rows);
    let of = |quantity| verdict.conservation.iter().find(|kept| kept.quantity == quantity).unwrap();
    let largest = rows.iter().map(|row| (momentum(row) - first).norm()).fold(0.0, f64::max) / first.norm();
    near(of(Conserved::Momentum).error, largest, 1e-9);
    let along_z = rows.iter().map(|row| (momentum(row) - first)[2].abs()).fold(0.0, f64::max) / first.norm();
    assert!(
        verdict
            .conservation
            .iter()
            .all(|kept| kept.quantity != Conserved::MomentumZ || (kept.error / along_z - 1.0).abs() < 1e-9)
    );
    assert!(of(Conserved::Energy).conserved && of(Conserved::MomentumNorm).conserved);
    let traces = &verdict.traces;
    // the sign is that of the side on which it is furthest off
    let furthest = (0..ROWS).map(angle).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap();
    for (time, found) in traces.times.iter().zip(&traces.momentum_direction) {
        let expected = angle((time / STEP).round() as usize) * furthest.signum();
        assert!((found - expected).abs() < 1e-9, "{found:e} for {expected:e} at {time}");
    }
}

/// A clock that is off turns the body along its motion, a turn about another axis across; the largest is where it was put.
#[test]
fn the_error_of_the_attitude_is_told_along_the_motion_and_across() {
    let late = |row: usize| if row > 300 { 1e-3 * (row - 300) as f64 / (ROWS - 301) as f64 } else { 0.0 };
    let along = |state: &Written| {
        let omega = state.1.rotate(state.2);
        omega * (1.0 / omega.norm())
    };
    for (share, sign) in [(1.0_f64, 1.0), (0.6, -1.0)] {
        let across = |state: &Written| {
            let v = along(state).cross(Vec3([1.0, 0.0, 0.0]));
            v * (1.0_f64 - share * share).max(0.0).sqrt() * (1.0 / v.norm())
        };
        let rows = changed(&|row, state| ((along(state) * (sign * share) + across(state)) * late(row), 1.0));
        let verdict = verdict(&rows);
        let error = verdict.attitude_error.unwrap();
        assert_eq!(verdict.judgement, Judgement::Wrong);
        // the start is fitted to most rows, which are right
        near(error.largest, 1e-3, 0.1);
        near(error.phase, sign * share * 1e-3, 0.15);
        assert!((error.drift - (1.0 - share * share).max(0.0).sqrt() * 1e-3).abs() < 1.5e-4, "{error:?}");
        assert!((error.at - STEP * (ROWS - 1) as f64).abs() < 1e-9, "{error:?}");
        near(error.from_first_row, 1e-3, 1e-6);
        near(*verdict.traces.attitude.last().unwrap(), sign * error.largest, 1e-6);
    }
}

#[test]
fn noise_is_measured_in_both_columns() {
    for noise in [1e-5, 1e-3] {
        let mut random = Seeded(9);
        let mut noisy = |of: Vec3<f64>, size: f64| of + Vec3([0; 3].map(|_| size * random.normal()));
        let rows = motion([0.4, 1.0, -0.3]);
        let size = (rows.iter().map(|row| row.2.norm_squared()).sum::<f64>() / ROWS as f64).sqrt();
        let rows: Vec<Written> = (rows.iter())
            .map(|(t, q, w)| (*t, turn_by(noisy(Vec3::zero(), noise)) * *q, noisy(*w, 3.0 * noise)))
            .collect();
        let verdict = verdict(&rows);
        assert_eq!(verdict.judgement, Judgement::Undecided);
        let (found, resolution) = (verdict.noise.unwrap(), verdict.resolution);
        near(found.attitude, noise, 0.15);
        near(found.rates, 3.0 * noise, 0.15);
        near(resolution.attitude.unwrap(), noise, 0.15);
        near(resolution.rates.unwrap(), 3.0 * noise / size, 0.15);
        assert_eq!((resolution.digits, resolution.single_precision), (17, false));
        // of a column that is not there it is none
        let mut alone = plain(&rows);
        alone.rates = None;
        let told = audit(&alone, &Question::new(Some(body()))).unwrap().noise;
        assert_eq!(told.map(|noise| noise.rates), Some(0.0));
        // what the noise explains of the momentum is more than it does, and not much more
        for kept in &verdict.conservation {
            assert!(kept.conserved && kept.resolution < 10.0 * kept.error, "{kept:?}");
        }
    }
}

/// Of rounded numbers half a unit of the last digit is left open, of single precision 2⁻²⁵ of each number.
#[test]
fn digits_leave_half_a_unit_of_the_last_open() {
    let rows = motion([0.4, 1.0, -0.3]);
    for (digits, single) in [(5, false), (7, false), (17, true)] {
        let written = plain_in(&rows, Writing { digits, single, noise: 0.0 });
        let verdict = audit(&written, &Question::new(Some(body()))).unwrap();
        let resolution = verdict.resolution;
        let unit = if single { 6e-8 } else { 10_f64.powi(-(digits as i32)) };
        assert_eq!((verdict.judgement, resolution.single_precision), (Judgement::Right, single));
        assert!(single || resolution.digits == digits as u32, "{resolution:?}");
        for left in [resolution.attitude.unwrap(), resolution.rates.unwrap()] {
            assert!(left > 0.2 * unit && left < 20.0 * unit, "{digits}: {resolution:?}");
        }
        assert_eq!(verdict.faults.is_empty(), digits > 10 && !single, "{:?}", verdict.faults);
    }
}

/// Next to the middle axis the body flips; the rates of the record tell how often.
#[test]
fn flips_are_counted_in_the_record_and_in_the_motion() {
    let mut rows = motion([0.05, 2.0, 0.05]);
    let flips = |rows: &[Written]| {
        rows.windows(2).filter(|pair| (pair[0].2[1] > 0.0) != (pair[1].2[1] > 0.0)).count() as u64
    };
    let exact = flips(&rows);
    assert!(exact > 1, "{exact}");
    let right = verdict(&rows);
    assert_eq!((right.flips, right.flips_exact), (Some(exact), Some(exact)));
    assert_eq!(right.judgement, Judgement::Right);
    // some rows of another sign are two flips more
    rows[200..205].iter_mut().for_each(|row| row.2 = -row.2);
    let verdict = verdict(&rows);
    assert_eq!((verdict.flips, verdict.flips_exact), (Some(flips(&rows)), Some(exact)));
    assert_eq!(verdict.judgement, Judgement::Wrong);
}

/// A column of its own frame: space axes, matrices, angles and momenta carry the same figures as quaternions and rates.
#[test]
fn the_figures_do_not_depend_on_the_form() {
    let rows = changed(&|row, _| (Vec3([0.0, 1e-5 * row as f64, 0.0]), 1.0 - 1e-6 * row as f64));
    let plainly = verdict(&rows);
    let (error, first) = (plainly.attitude_error.unwrap(), &plainly.conservation);
    for form in [Form::Quaternion, Form::Matrix, Form::Angles, Form::Rodrigues] {
        let mut random = Seeded(form as u64 + 40);
        let convention = super::records::reading(&mut random, form);
        let written = record(&mut random, &rows, &convention, form, Writing::EXACT);
        let other = audit(&written, &Question::new(Some(body()))).unwrap();
        let there = other.attitude_error.unwrap();
        for (a, b) in [(error.largest, there.largest), (error.phase, there.phase), (error.drift, there.drift)]
        {
            assert!((a - b).abs() < 1e-6 * error.largest, "{form:?}: {error:?} {there:?}");
        }
        assert_eq!(
            (error.at, error.fitted_start, plainly.judgement),
            (there.at, there.fitted_start, other.judgement)
        );
        for (a, b) in first.iter().zip(&other.conservation) {
            near(a.error, b.error, 1e-6);
            near(a.resolution, b.resolution, 0.2);
        }
    }
}
