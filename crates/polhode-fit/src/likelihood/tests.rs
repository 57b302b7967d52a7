//! Searches and their parts on simulated attitudes and rates, whose tensor, torque, alignment and noise are known.

use nalgebra::{SMatrix, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};

use crate::likelihood::alignment::at_nodes;
use crate::likelihood::alternatives::{Alternatives, RateError};
use crate::likelihood::choice::{Acting, Moved, is_linear, left_out, with_torque};
use crate::likelihood::descent::{Levels, Problem, moved};
use crate::likelihood::growth::{Followed, follow, squares, steady};
use crate::likelihood::local::{Node, node, nodes, noise, width};
use crate::likelihood::momentum::tensor_of;
use crate::likelihood::motion::{Motion, Start};
use crate::likelihood::profile::fall;
use crate::likelihood::sums::{Reduced, Step};
use crate::likelihood::track::{COMMON, Kind, Model, OWN, Track};
use crate::physical::coordinates::{Coordinates, coordinates, eigen, tensor};
use crate::settings::torque::TorqueModel;
use crate::simulate::{Disturbances, Gyroscope, simulate_poses};
use crate::thresholds::likelihood::{LINEAR, NODE};

fn x() -> Coordinates {
    Coordinates::new(-0.06, 0.02, 0.03, -0.02, 0.04)
}

fn alignment() -> Quat<f64> {
    Quat::exponential(Vec3([0.4, -0.2, 0.7]))
}

fn vector(v: [f64; 3]) -> Vector3<f64> {
    Vector3::from(v)
}

/// Noise of attitudes and of rates.
const NOISE: Levels = Levels { attitude: 2e-3, rate: 4e-3 };

/// Attitudes and rates of the body `x` under a torque, over half of `span` before and after the middle, with noise.
fn track(by: &Disturbances, start: Vector3<f64>, span: f64, seed: u64) -> Track {
    let body = Inertia::from_tensor(tensor(&x())).unwrap();
    let times: Vec<f64> = (0..=(10.0 * span) as usize).map(|k| 0.1 * k as f64 - 0.5 * span).collect();
    let mut random = Random::new(seed);
    let gyroscope = Gyroscope::default().with_noise(NOISE.rate);
    let made = simulate_poses(&body, start, &times, by, &gyroscope, 0.0, &mut random).unwrap();
    let off = |random: &mut Random| Quat::exponential(Vec3::from(random.normal_vector() * NOISE.attitude));
    let attitudes = made.attitudes.iter().map(|q| Quat::from(*q) * alignment() * off(&mut random));
    Track { attitudes: attitudes.collect(), rates: made.rates, used: vec![true; times.len()], times }
}

fn tracks(by: &Disturbances) -> Vec<Track> {
    vec![track(by, vector([0.5, 0.8, -0.4]), 16.0, 1), track(by, vector([-0.7, 0.3, 0.6]), 12.0, 2)]
}

fn found(tracks: &[Track], has_drag: bool) -> Followed {
    let near = alignment() * Quat::exponential(Vec3([0.02, 0.01, -0.02]));
    let levels = Levels { attitude: 5e-3, rate: 0.0 };
    follow(tracks, x() + Coordinates::repeat(0.005), near, levels, has_drag).unwrap()
}

fn information(followed: &Followed) -> SMatrix<f64, 5, 5> {
    let Followed { model, tracks, levels, .. } = followed;
    let problem = Problem { tracks, levels: *levels, radius: f64::INFINITY, pull: None };
    Reduced::new(&problem.sums(model).unwrap().0).unwrap().of_tensor().unwrap()
}

/// What is left of readings falls by the rows of their derivatives.
#[test]
fn what_is_left_of_a_reading_falls_by_its_derivatives() {
    let start = Start { attitude: Quat::exponential(Vec3([0.1, 0.5, -0.3])), rate: vector([0.5, 0.8, -0.4]) };
    let model =
        Model { x: x(), alignment: alignment(), is_aligned: true, drag: Some(0.03), starts: vec![start] };
    let motion = Motion::new(&model.x, &start, 0.03).unwrap();
    let times = vec![-2.0, -0.7, 0.0, 1.3, 4.0];
    let at = |t: &f64| motion.at(*t).unwrap();
    let track = Track {
        attitudes: times.iter().map(|t| at(t).attitude * model.alignment).collect(),
        rates: times.iter().map(|t| at(t).rate).collect(),
        used: vec![true, true, false, true, true],
        times,
    };
    let left = |model: &Model, radius: f64| {
        let mut all = Vec::new();
        track
            .visit(model, &model.starts[0], radius, |left| {
                all.push((left.kind, left.sample, left.residual, left.rows));
            })
            .unwrap();
        all
    };
    let here = left(&model, f64::INFINITY);
    // two readings of each sample that is used, within the radius
    let order: Vec<(Kind, usize)> = here.iter().map(|(kind, sample, ..)| (*kind, *sample)).collect();
    let of = |sample| [(Kind::Attitude, sample), (Kind::Rate, sample)];
    assert_eq!(order, [0, 1, 3, 4].map(of).concat());
    assert_eq!(left(&model, 1.3).len(), 4);
    assert!(here.iter().all(|(_, _, residual, _)| residual.norm() < 1e-13));
    let h = 1e-5;
    for k in 0..OWN + COMMON {
        let stepped = |by: f64| {
            let mut step = Step { common: SMatrix::zeros(), starts: vec![SMatrix::zeros()], gain: 0.0 };
            if k < OWN {
                step.starts[0][k] = by
            } else {
                step.common[k - OWN] = by
            }
            left(&moved(&model, &step), f64::INFINITY)
        };
        for ((kind, sample, _, rows), (above, below)) in here.iter().zip(stepped(h).iter().zip(stepped(-h))) {
            let slope = (below.2 - above.2) / (2.0 * h);
            let apart = (slope - rows.column(k)).amax();
            assert!(apart < 1e-6 * (1.0 + slope.amax()), "{k} {kind:?} {sample}: {apart:e}");
        }
    }
}

/// Tensor, alignment and levels of the noise within their deviations, and single readings that stand out left out.
#[test]
fn the_likeliest_motion_is_that_which_was_simulated() {
    let mut tracks = tracks(&Disturbances::default());
    tracks[0].attitudes[40] = tracks[0].attitudes[40] * Quat::exponential(Vec3([0.5, 0.0, 0.0]));
    let followed = found(&tracks, false);
    assert!(followed.is_still && followed.model.drag.is_none() && followed.model.is_aligned);
    let out = followed.tracks.iter().map(|t| t.used.iter().filter(|used| !**used).count());
    assert_eq!(out.collect::<Vec<_>>(), [1, 0]);
    assert!(!followed.tracks[0].used[40]);
    let samples = (161 + 121 - 1) as f64;
    // two starts of six numbers, five of the tensor, three of the alignment
    let dof: f64 = followed.dof.iter().sum();
    assert!((dof - (6.0 * samples - 20.0)).abs() < 1e-9 && (followed.dof[0] - followed.dof[1]).abs() < 1e-9);
    // of some 840 components each, to √(1/1680) = 0.024
    assert!((followed.levels.attitude / NOISE.attitude - 1.0).abs() < 0.12, "{:?}", followed.levels);
    assert!((followed.levels.rate / NOISE.rate - 1.0).abs() < 0.12, "{:?}", followed.levels);
    let (left, counts) = squares(&followed.tracks, &followed.model).unwrap();
    assert_eq!(counts, [3.0 * samples; 2]);
    for ((left, dof), level) in
        left.iter().zip(followed.dof).zip([followed.levels.attitude, followed.levels.rate])
    {
        assert!((left / dof / (level * level) - 1.0).abs() < 0.01, "{left:e} {level:e}");
    }
    let cost = followed.dof[0] * libm::log(followed.levels.attitude) * 2.0
        + followed.dof[1] * libm::log(followed.levels.rate) * 2.0;
    assert!((followed.cost() - cost).abs() < 1e-9 * cost.abs());
    let form = information(&followed);
    let off = followed.model.x - x();
    // the 99.99 % point of χ²₅
    assert!(off.dot(&(form * off)) < 25.75, "{}", off.dot(&(form * off)));
    let turned = (alignment().conjugate() * followed.model.alignment).logarithm().norm();
    assert!(turned < 1e-3, "{turned:e}");
    let widest = 1.0 / eigen(form).0[0].sqrt();
    assert!((followed.deviation / widest - 1.0).abs() < 1e-3, "{} {widest}", followed.deviation);
    // along its narrow ellipsoid the likelihood falls as the squares of the deviations
    let problem =
        Problem { tracks: &followed.tracks, levels: followed.levels, radius: f64::INFINITY, pull: None };
    let (_, directions) = eigen(form);
    for (k, deviations) in [(0, 2.0), (4, -1.5)] {
        let away = directions.column(k) * (deviations / eigen(form).0[k].sqrt());
        let fallen = fall(&problem, &followed.model, &(followed.model.x + away)).unwrap();
        assert!((fallen / (deviations * deviations) - 1.0).abs() < 0.05, "{k}: {fallen}");
    }
    // no steady spin is near them
    assert!(steady(&followed.tracks, alignment(), followed.levels).is_none_or(|(_, cost)| cost > 1e4));
}

/// A torque that is left out is found by one step: its size, its deviation, and where the tensor is with it.
#[test]
fn torques_that_are_left_out_are_found_by_one_step() {
    let (drag, torque) = (2e-3, vector([2e-4, -1e-4, 1.5e-4]));
    let by = Disturbances::default().with_relative_drag(drag);
    let free = found(&tracks(&by), false);
    let all = Alternatives::new(&free.tracks, &free.model, free.levels).unwrap();
    let own = all.drag.as_ref().unwrap();
    assert!((own.values[0] - drag).abs() < 4.0 * own.sigmas[0] + 0.05 * drag, "{:?}", own.values);
    assert!(own.sigmas[0] < 0.1 * drag, "{:?}", own.sigmas);
    // of one coefficient the gain is half the square of its deviations
    let z = own.values[0] / own.sigmas[0];
    assert!((own.gain / (0.5 * z * z) - 1.0).abs() < 1e-9);
    // with the drag as part of the model, in its deviations
    let slowed = found(&tracks(&by), true);
    let fitted = slowed.model.drag.unwrap();
    assert!((fitted - drag).abs() < 5.0 * own.sigmas[0], "{fitted}");
    assert!(Alternatives::new(&slowed.tracks, &slowed.model, slowed.levels).unwrap().drag.is_none());

    let free = found(&tracks(&Disturbances::default().with_torque(torque)), false);
    let all = Alternatives::new(&free.tracks, &free.model, free.levels).unwrap();
    for k in 0..3 {
        let apart = (all.constant.values[k] - torque[k]).abs();
        assert!(apart < 4.0 * all.constant.sigmas[k] + 0.05 * torque.norm(), "{:?}", all.constant.values);
    }
    let form = information(&free);
    let off = free.model.x + Coordinates::from_fn(|k, _| all.constant.moved[k]) - x();
    let spread = all.constant.spread.rows(0, 5);
    let covariance =
        form.try_inverse().unwrap() + SMatrix::<f64, 5, 5>::from_fn(|i, k| spread.row(i).dot(&spread.row(k)));
    let distance = off.dot(&(covariance.try_inverse().unwrap() * off));
    assert!(distance < 25.75, "{distance}");
    // ½ |J⁻¹ τ| T² within half of the longest stretch
    let acceleration =
        tensor(&free.model.x).try_inverse().unwrap() * Vector3::from_column_slice(&all.constant.values);
    let (gain, turn) = left_out(&free, &all.constant).unwrap();
    assert!((turn / (0.5 * acceleration.norm() * 64.0) - 1.0).abs() < 1e-9 && gain == all.constant.gain);
    assert_eq!(is_linear(&free, &all.constant), turn <= LINEAR, "{turn}");
}

/// Attitudes and rates without noise, under a torque, of the motions of a model that has none.
fn exact(by: &Disturbances) -> (Vec<Track>, Model) {
    let body = Inertia::from_tensor(tensor(&x())).unwrap();
    let each = [(vector([0.5, 0.8, -0.4]), 16), (vector([-0.7, 0.3, 0.6]), 12)].map(|(start, span)| {
        let times: Vec<f64> = (0..=8 * span).map(|k| 0.125 * f64::from(k) - 0.5 * f64::from(span)).collect();
        let made = |by: &Disturbances| {
            let quiet = Gyroscope::default();
            simulate_poses(&body, start, &times, by, &quiet, 0.0, &mut Random::new(1)).unwrap()
        };
        let (moved, free) = (made(by), made(&Disturbances::default()));
        // the middle is at time 0
        let middle = times.len() / 2;
        let start = Start { attitude: Quat::from(free.attitudes[middle]), rate: free.rates[middle] };
        let attitudes = moved.attitudes.iter().map(|q| Quat::from(*q) * alignment()).collect();
        (Track { attitudes, rates: moved.rates, used: vec![true; times.len()], times }, start)
    });
    let (tracks, starts) = each.into_iter().unzip();
    (tracks, Model { x: x(), alignment: alignment(), is_aligned: true, drag: None, starts })
}

/// Of readings without noise, off by one small number alone, one step tells that number and no other of its kind.
#[test]
fn one_step_tells_each_small_number() {
    let small = 1e-5;
    let alternatives =
        |(tracks, model): (Vec<Track>, Model)| Alternatives::new(&tracks, &model, NOISE).unwrap();
    let read = |change: &dyn Fn(&mut Track)| {
        let (mut tracks, model) = exact(&Disturbances::default());
        tracks.iter_mut().for_each(change);
        alternatives((tracks, model))
    };
    // the integral of a torque is by the trapezoidal rule
    let near = |values: &[f64], expected: &[f64]| {
        let apart = values.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(values.len() == expected.len() && apart < 0.03 * small, "{values:?} {expected:?}");
    };
    let all = alternatives(exact(&Disturbances::default().with_relative_drag(small)));
    near(&all.drag.unwrap().values, &[small]);
    let all = read(&|track| track.rates.iter_mut().for_each(|w| *w *= 1.0 + small));
    near(&all.of_error(RateError::Scale).unwrap().values, &[small]);
    for axis in 0..3 {
        let along = Vector3::ith(axis, small);
        let all = alternatives(exact(&Disturbances::default().with_torque(along)));
        near(&all.constant.values, along.as_slice());
        let all = read(&|track| track.rates.iter_mut().for_each(|w| *w += along));
        near(&all.of_error(RateError::Offset).unwrap().values, along.as_slice());
        for is_of_rates in [true, false] {
            let all = read(&|track| {
                let span = track.times[track.times.len() - 1] - track.times[0];
                for k in 0..track.times.len() {
                    let by = Quat::exponential(Vec3::from(along * (track.times[k] / span)));
                    if is_of_rates {
                        track.rates[k] = by.rotate_back(track.rates[k].into()).into();
                    } else {
                        track.attitudes[k] = track.attitudes[k] * by;
                    }
                }
            });
            near(&all.of_axes(is_of_rates).unwrap().values, along.as_slice());
        }
    }
}

/// Axes of attitudes or of rates that turn evenly over each stretch are told from each other, with their turn.
#[test]
fn axes_that_move_are_found_by_one_step() {
    let turn = vector([0.02, -0.01, 0.015]);
    for is_of_rates in [true, false] {
        let mut tracks = tracks(&Disturbances::default());
        for track in &mut tracks {
            let span = track.times[track.times.len() - 1] - track.times[0];
            for k in 0..track.times.len() {
                let by = Quat::exponential(Vec3::from(turn * (track.times[k] / span)));
                if is_of_rates {
                    track.rates[k] = by.conjugate().rotate(track.rates[k].into()).into();
                } else {
                    track.attitudes[k] = track.attitudes[k] * by;
                }
            }
        }
        let free = found(&tracks, false);
        let all = Alternatives::new(&free.tracks, &free.model, free.levels).unwrap();
        let moving = all.moving.as_ref().unwrap();
        assert_eq!(moving.is_of_rates, is_of_rates);
        for k in 0..3 {
            let apart = (moving.found.values[k] - turn[k]).abs();
            assert!(apart < 4.0 * moving.found.sigmas[k] + 1e-3, "{is_of_rates}: {:?}", moving.found.values);
        }
        assert!(moving.found.gain > 15.0 && all.of_axes(is_of_rates).unwrap().gain == moving.found.gain);
        assert!(all.of_axes(!is_of_rates).unwrap().gain < moving.found.gain);
        assert!(all.error_of_rates().is_none(), "{:?}", all.error_of_rates());
    }
}

/// An offset of the rates, or an error of their scale, is found with its size, and is not taken for a torque or for axes that move. Neither
/// is named of rates without error, whether a torque acts or not.
#[test]
fn errors_of_the_rates_are_found_by_one_step() {
    let alternatives = |tracks: &[Track]| {
        let free = found(tracks, false);
        Alternatives::new(&free.tracks, &free.model, free.levels).unwrap()
    };
    let misread = |offset: Vector3<f64>, scale: f64| {
        let mut tracks = tracks(&Disturbances::default());
        for rate in tracks.iter_mut().flat_map(|track| track.rates.iter_mut()) {
            *rate = *rate * (1.0 + scale) + offset;
        }
        alternatives(&tracks)
    };
    let offset = vector([0.02, -0.01, 0.015]);
    let all = misread(offset, 0.0);
    let (error, own) = all.error_of_rates().unwrap();
    assert_eq!(error, RateError::Offset);
    for k in 0..3 {
        let apart = (own.values[k] - offset[k]).abs();
        assert!(apart < 4.0 * own.sigmas[k] + 0.05 * offset.norm(), "{:?}", own.values);
    }
    for scale in [0.05, -0.05] {
        let all = misread(Vector3::zeros(), scale);
        let (error, own) = all.error_of_rates().unwrap();
        assert_eq!(error, RateError::Scale);
        assert!((own.values[0] - scale).abs() < 4.0 * own.sigmas[0] + 2e-3, "{scale}: {:?}", own.values);
    }
    for by in [
        Disturbances::default(),
        Disturbances::default().with_relative_drag(3e-3),
        Disturbances::default().with_torque(vector([4e-4, -2e-4, 3e-4])),
    ] {
        let all = alternatives(&tracks(&by));
        assert!(all.error_of_rates().is_none(), "{:?}", all.error_of_rates());
    }
}

/// The torque that samples ask for is the one that was simulated, with what it gains over none.
#[test]
fn the_torque_that_samples_ask_for_is_the_one_that_acts() {
    let constant = Disturbances::default().with_torque(vector([4e-4, -2e-4, 3e-4]));
    for (by, acting) in [
        (Disturbances::default(), Acting::Nothing),
        (Disturbances::default().with_relative_drag(3e-3), Acting::Drag),
        (constant, Acting::Constant),
    ] {
        let tracks = tracks(&by);
        let moved = |has_drag: bool| Some(Moved::new(found(&tracks, has_drag)));
        let chosen = with_torque(TorqueModel::Auto, moved).unwrap();
        assert_eq!(chosen.torque, acting);
        let gain = 0.5 * (found(&tracks, false).cost() - found(&tracks, true).cost());
        let of_drag = chosen.models.iter().find(|one| one.model == TorqueModel::Drag).unwrap().gain;
        match acting {
            Acting::Drag => {
                assert!((chosen.gain.unwrap() - gain).abs() < 1e-6 && (of_drag - gain).abs() < 1e-6);
                let asked = with_torque(TorqueModel::Drag, moved).unwrap();
                assert!(asked.torque == Acting::Drag && asked.gain.is_none());
                let models: Vec<TorqueModel> = asked.models.iter().map(|one| one.model).collect();
                assert_eq!(models[..2], [TorqueModel::None, TorqueModel::Drag]);
                assert!((asked.models[1].gain - gain).abs() < 1e-6 && gain > 5.0);
            }
            Acting::Constant => {
                let found = &chosen.moved.alternatives.as_ref().unwrap().constant;
                assert!(chosen.gain == Some(found.gain) && found.gain > 8.0);
                // the tensor without it
                assert_eq!(chosen.without, Some(chosen.moved.followed.model.x));
            }
            Acting::Nothing => assert!(chosen.gain.is_none() && chosen.without.is_none() && of_drag < 5.0),
        }
        assert_eq!(chosen.models[0].gain, 0.0);
    }
}

/// About any sample of an even turn the node has its attitude and its rate; of evenly spaced samples the variance of the rate is that of a
/// straight line.
#[test]
fn nodes_of_an_even_turn_are_exact() {
    let (rate, start) = (vector([0.3, -0.7, 0.4]), Quat::exponential(Vec3([0.2, 0.1, 1.0])));
    let times: Vec<f64> = (0..60).map(|k| 0.05 * f64::from(k)).collect();
    let turned = |t: &f64| start * Quat::exponential(Vec3::from(rate * *t));
    let attitudes: Vec<Quat<f64>> = times.iter().map(turned).collect();
    for middle in [0, 1, 30, 58, 59] {
        let found = node(&times, &attitudes, middle, 0.5).unwrap();
        assert!((found.rate - rate).norm() < 1e-12 && found.time == times[middle], "{middle}");
        assert!((attitudes[middle].conjugate() * found.attitude).logarithm().norm() < 1e-13);
    }
    // eleven samples within half of the width on both sides
    let near: f64 = (-5..=5).map(|k| 0.05 * 0.05 * f64::from(k * k)).sum();
    let variance = node(&times, &attitudes, 30, 0.51).unwrap().variance;
    assert!((variance * near - 1.0).abs() < 1e-9, "{variance} {near}");
    let all = nodes(&times, &attitudes, 0.5);
    assert!(all.windows(2).all(|pair| (0.24..0.31).contains(&(pair[1].time - pair[0].time))));
    // widths double
    let stretches = [(times, attitudes)];
    let found = width(&stretches, 0.0).unwrap() * rate.norm();
    assert!((NODE..2.0 * NODE).contains(&found), "{found}");
}

/// Where a width holds fewer than three samples the nearest are taken, and the rates beside a node are the mean of those within its half.
#[test]
fn nodes_take_the_nearest_samples() {
    let rate = vector([0.3, -0.7, 0.4]);
    let times = [0.0, 1.0, 1.1, 3.0];
    let turned = |t: &f64| Quat::exponential(Vec3::from(rate * *t));
    for (middle, far) in [(1, 3), (2, 3)] {
        let mut attitudes = times.map(|t| turned(&t));
        attitudes[far] = attitudes[far] * Quat::exponential(Vec3([1.0, 0.0, 0.0]));
        let found = node(&times, &attitudes, middle, 0.05).unwrap();
        assert!((found.rate - rate).norm() < 1e-12, "{middle}: {}", found.rate);
    }
    let mut attitudes = times.map(|t| turned(&t));
    attitudes[0] = attitudes[0] * Quat::exponential(Vec3([1.0, 0.0, 0.0]));
    assert!((node(&times, &attitudes, 3, 0.05).unwrap().rate - rate).norm() < 1e-12);

    let times: Vec<f64> = (0..41).map(|k| 0.1 * f64::from(k)).collect();
    let attitudes: Vec<Quat<f64>> = times.iter().map(turned).collect();
    let near = node(&times, &attitudes, 20, 1.0).unwrap();
    // eleven samples from 1.5 to 2.5 s would be half of a width of two
    for (place, counts) in [(15, true), (25, true), (14, false), (26, false)] {
        let mut rates = vec![rate; times.len()];
        rates[place] += vector([0.0, 0.0, 11.0]);
        let mean = at_nodes(&[near], &times, &rates, 2.02)[0];
        let expected = if counts { rate + vector([0.0, 0.0, 1.0]) } else { rate };
        assert!((mean - expected).norm() < 1e-12, "{place}: {mean}");
    }
    let nearest = at_nodes(&[near], &times, &vec![rate; times.len()], 1e-3)[0];
    assert!((nearest - rate).norm() < 1e-12);
}

/// The momentum of a free body stays in space: nodes along its motion tell its tensor, with a start of any attitude.
#[test]
fn a_momentum_that_stays_tells_a_first_tensor() {
    let motions = [(vector([0.5, 0.8, -0.4]), 0.3), (vector([-0.7, 0.3, 0.6]), 1.2)].map(|(rate, turn)| {
        let start = Start { attitude: Quat::exponential(Vec3([turn, 0.2, -0.4])), rate };
        let motion = Motion::new(&x(), &start, 0.0).unwrap();
        let at = |k: u32| {
            let t = 0.5 * f64::from(k);
            let moved = motion.at(t).unwrap();
            Node { time: t, attitude: moved.attitude, rate: moved.rate, variance: 0.0 }
        };
        (0..30).map(at).collect::<Vec<Node>>()
    });
    assert!((tensor_of(&motions, 0.0).unwrap() - x()).amax() < 1e-10);
    assert!((tensor_of(&motions[..1], 0.0).unwrap() - x()).amax() < 1e-9);
}

/// Noise of attitudes is read to its own scatter, also where single ones stand far out.
#[test]
fn the_noise_of_attitudes_is_read_from_neighbours() {
    let mut random = Random::new(9);
    let times: Vec<f64> = (0..2000).map(|k| 0.02 * f64::from(k)).collect();
    let off = |random: &mut Random| Quat::exponential(Vec3::from(random.normal_vector() * 0.01));
    let mut attitudes: Vec<Quat<f64>> =
        times.iter().map(|t| Quat::exponential(Vec3([0.0, 0.3 * t, 0.0])) * off(&mut random)).collect();
    let read = noise(&[(times.clone(), attitudes.clone())]).unwrap();
    assert!((read / 0.01 - 1.0).abs() < 0.06, "{read}");
    attitudes[700] = attitudes[700] * Quat::exponential(Vec3([1.0, 0.0, 0.0]));
    let with_one = noise(&[(times, attitudes)]).unwrap();
    assert!((with_one / read - 1.0).abs() < 0.02, "{with_one} {read}");
    assert!(noise(&[(vec![0.0; 4], vec![Quat::identity(); 4])]).is_none());
    assert!((coordinates(&tensor(&x())) - x()).amax() < 1e-15);
}
