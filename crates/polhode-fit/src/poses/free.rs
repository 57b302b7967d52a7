//! The free motion that follows attitudes, and what contradicts it.

use nalgebra::{Matrix3, Vector3};
use polhode::record::{Record, Segment};
use polhode::rotation::{Quat, Vec3};

use crate::error::FitError;
use crate::likelihood::alignment::{Alignment, align, at_nodes};
use crate::likelihood::alternatives::Alternatives;
use crate::likelihood::choice::{Acting, Found, Moved, is_linear, steady_within_noise, with_torque};
use crate::likelihood::descent::Levels;
use crate::likelihood::growth::{Followed, follow};
use crate::likelihood::local::{self, Node};
use crate::likelihood::momentum::tensor_of;
use crate::likelihood::track::Track;
use crate::models::weighed::Weighed;
use crate::physical::coordinates::{Coordinates, Form, coordinates, tensor};
use crate::poses::clean::{jumps, turns};
use crate::poses::fault::PoseFault;
use crate::poses::misread::{Misread, without_error_of_rates};
use crate::poses::moving::{Moving, with_moving_axes};
use crate::poses::record::{PoseSegment, Poses};
use crate::settings::Settings;
use crate::signal::noise::variance;
use crate::signal::stretch::Stretch;
use crate::thresholds::noise::{DEVIATIONS, LEAST, STATED};
use crate::thresholds::poses::{COARSE, FEWEST, HALF_TURN, MOVING, SAME_SIZE, STILL};

/// What is known of the samples before a motion is.
#[derive(Clone, Debug)]
pub(crate) struct Read {
    /// Unit of rates and inverse of that of times, rad/s.
    pub(crate) unit: f64,
    /// The segments that were long enough, each with the time of its middle, s.
    pub(crate) used: Vec<(usize, f64)>,
    /// What neighbouring attitudes say of the noise, where the body turns little between them, rad.
    pub(crate) local_noise: Option<f64>,
    /// What neighbouring rates say of the noise of a component, where they stand beside attitudes, rad/s.
    pub(crate) rate_noise: Option<f64>,
    /// Largest turn from one attitude to the next, rad.
    pub(crate) largest_turn: f64,
    /// Samples that jump.
    pub(crate) jumps: usize,
    pub(crate) has_rates: bool,
}

/// Samples in their units, and where the search for a motion begins.
pub(crate) struct Begun {
    pub(crate) tracks: Vec<Track>,
    /// A first tensor, in the axes of the rates where there are any.
    pub(crate) first: Coordinates,
    /// Takes coordinates along the body axes of the attitudes to those.
    turn: Quat<f64>,
    /// Standard deviation of a component of an attitude, rad.
    noise: f64,
    pub(crate) read: Read,
}

/// The motion of one body through all segments, free or slowed by drag.
pub(crate) struct Free {
    pub(crate) followed: Followed,
    pub(crate) torque: Acting,
    /// Log-likelihood with the torque less that without, where both were tried.
    pub(crate) gain: Option<f64>,
    /// The coordinates without it.
    pub(crate) without: Option<Coordinates>,
    /// What each torque makes of the samples.
    pub(crate) models: Vec<Weighed>,
    /// What a torque, moving axes or an error of the rates would bring; `None` where the samples do not determine the model.
    pub(crate) alternatives: Option<Alternatives>,
    /// How the axes of rates and attitudes turn against each other, where they do.
    pub(crate) moving: Option<Moving>,
    /// The error that was taken out of the rates, where they have one.
    pub(crate) misread: Option<Misread>,
    pub(crate) read: Read,
    /// The information on the tensor at the steady spins that explain the samples nearly as well, if they do: a wobble within the noise
    /// would pass for one that tells the tensor.
    pub(crate) steady: Option<Form>,
}

impl Begun {
    /// What `poses` are, and a first tensor.
    pub(crate) fn new(poses: &Poses, settings: &Settings) -> Result<Begun, FitError> {
        let Looked { used, stretches, rates, largest_turn, jumps } = looked_at(poses, settings)?;
        // the closed form itself is not without rounding
        let local_noise = local::noise(&stretches).unwrap_or(0.0).max(LEAST.sqrt());
        let noise = settings.attitude_noise.unwrap_or(local_noise);
        let width = local::width(&stretches, noise).unwrap_or(0.0);
        let nodes: Vec<Vec<Node>> =
            stretches.iter().map(|(times, attitudes)| local::nodes(times, attitudes, width)).collect();
        let unit = unit_of(&nodes, noise).filter(|_| does_turn(&stretches, noise).is_ok());
        let Some(unit) = unit else {
            let is_misstated = STATED * local_noise < noise && does_turn(&stretches, local_noise).is_ok();
            if is_misstated {
                return Err(PoseFault::StatedNoise { stated: noise, shown: local_noise }.into());
            }
            let error = does_turn(&stretches, noise).err();
            return Err(match error {
                // a motion that is left among the noise
                Some(FitError::Poses(PoseFault::NoTurn { turn: all, .. }))
                    if settings.attitude_noise.is_none() && largest_turn > COARSE =>
                {
                    PoseFault::FarApart { turn: largest_turn, all }.into()
                }
                other => other.unwrap_or(FitError::NoRotation { rms: 0.0, noise }),
            });
        };
        let alignment = alignment_of(&nodes, &stretches, &rates, width)?;
        let turn = alignment.map_or(Quat::identity(), |alignment| alignment.turn);
        let tracks = stretches.iter().zip(&rates).map(|(s, rates)| track(s, rates, unit)).collect();
        let scaled: Vec<Vec<Node>> =
            nodes.iter().map(|nodes| nodes.iter().map(|n| in_units(n, unit)).collect()).collect();
        let first = tensor_of(&scaled, noise * noise).unwrap_or_else(Coordinates::zeros);
        let first = turned(&first, &turn);
        // a motion that moves far between neighbours is left among their noise
        let local_noise = (largest_turn <= COARSE).then_some(local_noise);
        let has_rates = poses.has_rates();
        let rate_noise = has_rates.then(|| noise_of_rates(&stretches, &rates).max(LEAST.sqrt() * unit));
        let read = Read { unit, used, local_noise, rate_noise, largest_turn, jumps, has_rates };
        Ok(Begun { tracks, first, turn, noise, read })
    }
}

impl Free {
    /// The free motion nearest to `poses`.
    pub(crate) fn new(poses: &Poses, settings: &Settings) -> Result<Free, FitError> {
        let Begun { tracks, first, turn, noise, read } = Begun::new(poses, settings)?;
        let levels = Levels { attitude: noise, rate: 0.0 };
        let turn_between = read.largest_turn;
        let not_free = |residual| PoseFault::NotFree { residual, noise: Some(noise), turn: turn_between };
        let search = |tracks: &[Track]| {
            let moved = |drag| Some(Moved::new(follow(tracks, first, turn, levels, drag)?));
            with_torque(settings.torque, moved)
        };
        let found = search(&tracks).ok_or_else(|| not_free(1.0))?;
        let (found, misread) = without_error_of_rates(&tracks, found, search);
        let tracks = match &misread {
            Some(error) => error.taken_out(&tracks),
            None => tracks,
        };
        let (found, moving) = with_moving_axes(&tracks, found, search);
        let Found { moved, torque, gain, without, models } = found;
        let Moved { followed, alternatives } = moved;
        let steady = steady_within_noise(&followed);
        Ok(Free { followed, torque, gain, without, models, alternatives, moving, misread, read, steady })
    }

    /// Mean square of what is left of the attitudes, or of rates alone, over their noise, where that is known.
    pub(crate) fn misfit(&self, settings: &Settings) -> Option<f64> {
        let levels = self.followed.levels;
        let has_attitudes = self.followed.tracks.iter().any(Track::has_attitudes);
        let (left, known) = match has_attitudes {
            true => (levels.attitude, settings.attitude_noise.or(self.read.local_noise)),
            false => (levels.rate, settings.noise.map(|noise| noise / self.read.unit)),
        };
        let ratio = left / known.filter(|noise| *noise > 0.0)?;
        Some(ratio * ratio)
    }

    /// Whether the noise explains what the free motion leaves, and no torque explains it better.
    pub(crate) fn is_explained(&self, settings: &Settings) -> bool {
        let most = by_chance(self.followed.dof.iter().sum());
        let by_noise = self.misfit(settings).is_none_or(|misfit| misfit <= most);
        let Some(found) = &self.alternatives else { return by_noise };
        let constant = match self.torque {
            Acting::Nothing | Acting::Drag => MOVING,
            Acting::Constant => f64::INFINITY,
        };
        by_noise
            && found.constant.gain <= constant
            && found.drag.as_ref().is_none_or(|found| found.gain <= MOVING)
            && (self.torque != Acting::Constant || is_linear(&self.followed, &found.constant))
    }
}

/// The largest misfit of `dof` numbers that chance brings: differences of neighbours tell the noise from fewer numbers than all readings do.
pub(crate) fn by_chance(dof: f64) -> f64 {
    1.0 + DEVIATIONS * (2.0 * STILL / dof.max(1.0)).sqrt()
}

/// Segments that are long enough, without jumps.
struct Looked {
    used: Vec<(usize, f64)>,
    stretches: Vec<(Vec<f64>, Vec<Quat<f64>>)>,
    rates: Vec<Vec<Vector3<f64>>>,
    largest_turn: f64,
    jumps: usize,
}

fn looked_at(poses: &Poses, settings: &Settings) -> Result<Looked, FitError> {
    let longest = poses.segments().iter().map(|s| s.times.len()).max().unwrap_or(0);
    if longest < FEWEST {
        let (samples, segments) = (poses.samples(), poses.segments().len());
        return Err(FitError::TooFewSamples { samples, segments, longest, saturated: 0, needed: FEWEST });
    }
    let mut looked =
        Looked { used: Vec::new(), stretches: Vec::new(), rates: Vec::new(), largest_turn: 0.0, jumps: 0 };
    for (k, s) in poses.segments().iter().enumerate().filter(|(_, s)| s.times.len() >= FEWEST) {
        let out = if settings.leave_out_spikes { jumps(&s.attitudes) } else { Vec::new() };
        looked.jumps += out.len();
        let kept: Vec<usize> = (0..s.times.len()).filter(|i| !out.contains(i)).collect();
        let middle = 0.5 * (s.times[0] + s.times[s.times.len() - 1]);
        let attitudes: Vec<Quat<f64>> = kept.iter().map(|&i| s.attitudes[i]).collect();
        looked.largest_turn = looked.largest_turn.max(check_turns(s, &kept, &attitudes)?);
        looked.used.push((k, middle));
        looked.stretches.push((kept.iter().map(|&i| s.times[i] - middle).collect(), attitudes));
        looked.rates.push(kept.iter().filter_map(|&i| s.rates.get(i).copied()).collect());
    }
    Ok(looked)
}

/// The largest turn from one attitude to the next, which must be less than half a turn.
fn check_turns(s: &PoseSegment, kept: &[usize], attitudes: &[Quat<f64>]) -> Result<f64, FitError> {
    let turns = turns(attitudes);
    let far = turns.iter().position(|turn| *turn > HALF_TURN);
    if let Some(k) = far {
        let time = s.times[kept[k]];
        let step = s.times[kept[k + 1]] - time;
        let (source_name, sample) = (s.source().to_string(), s.samples[kept[k]]);
        return Err(PoseFault::HalfTurn { source_name, sample, time, turn: turns[k], step }.into());
    }
    Ok(turns.into_iter().fold(0.0, f64::max))
}

/// Refuses attitudes that differ by their noise alone.
fn does_turn(stretches: &[(Vec<f64>, Vec<Quat<f64>>)], noise: f64) -> Result<(), FitError> {
    let (mut square, mut count) = (0.0, 0.0);
    for (_, attitudes) in stretches {
        for q in attitudes {
            square += (attitudes[0].conjugate() * *q).logarithm().norm_squared();
            count += 1.0;
        }
    }
    let turn = (square / f64::max(count, 1.0)).sqrt();
    if turn > STILL * noise { Ok(()) } else { Err(PoseFault::NoTurn { turn, noise }.into()) }
}

/// Root mean square of the rates of the nodes, rad/s, their noise taken off.
fn unit_of(nodes: &[Vec<Node>], noise: f64) -> Option<f64> {
    let (mut square, mut count) = (0.0, 0.0);
    for node in nodes.iter().flatten() {
        square += node.rate.norm_squared() - 3.0 * node.variance * noise * noise;
        count += 1.0;
    }
    let unit = f64::sqrt(square / count);
    (unit.is_normal() && unit > 0.0).then_some(unit)
}

/// What neighbouring rates say of the noise of a component, or its rounding where that is more, rad/s.
fn noise_of_rates(stretches: &[(Vec<f64>, Vec<Quat<f64>>)], rates: &[Vec<Vector3<f64>>]) -> f64 {
    let both = || stretches.iter().zip(rates).filter(|(_, rates)| !rates.is_empty());
    let read = both().map(|((times, _), rates)| Stretch::new(times.clone(), rates.clone()));
    let read: Vec<Stretch> = read.collect();
    let mut record = Record::default();
    let segments =
        both().filter_map(|((times, _), rates)| Segment::new("", times.clone(), rates.clone()).ok());
    record.segments.extend(segments);
    variance(&read).max(record.rounding(&record.quanta())).sqrt()
}

/// The turn from the axes of the attitudes to those of the rates, where there are rates.
fn alignment_of(
    nodes: &[Vec<Node>],
    stretches: &[(Vec<f64>, Vec<Quat<f64>>)],
    rates: &[Vec<Vector3<f64>>],
    width: f64,
) -> Result<Option<Alignment>, FitError> {
    let (mut all, mut beside) = (Vec::new(), Vec::new());
    for ((nodes, (times, _)), rates) in
        nodes.iter().zip(stretches).zip(rates).filter(|(_, rates)| !rates.is_empty())
    {
        all.extend_from_slice(nodes);
        beside.extend(at_nodes(nodes, times, rates, width));
    }
    if all.is_empty() {
        return Ok(None);
    }
    let alignment = align(&all, &beside).ok_or(FitError::NoRotation { rms: 0.0, noise: 0.0 })?;
    match alignment {
        Alignment { scale, .. } if !(1.0 / SAME_SIZE..=SAME_SIZE).contains(&scale) => {
            Err(PoseFault::Scale { scale }.into())
        }
        Alignment { is_mirror: true, .. } => Err(PoseFault::Mirrored.into()),
        alignment => Ok(Some(alignment)),
    }
}

fn track((times, attitudes): &(Vec<f64>, Vec<Quat<f64>>), rates: &[Vector3<f64>], unit: f64) -> Track {
    Track {
        times: times.iter().map(|t| t * unit).collect(),
        attitudes: attitudes.clone(),
        rates: rates.iter().map(|w| w / unit).collect(),
        used: vec![true; times.len()],
    }
}

fn in_units(node: &Node, unit: f64) -> Node {
    Node { time: node.time * unit, rate: node.rate / unit, variance: node.variance / (unit * unit), ..*node }
}

/// The same tensor along axes to which `turn` takes coordinates.
fn turned(x: &Coordinates, turn: &Quat<f64>) -> Coordinates {
    let columns = [0, 1, 2].map(|k| turn.rotate(Vec3::unit(k)).into());
    let r = Matrix3::from_columns(&columns);
    coordinates(&(r * tensor(x) * r.transpose()))
}

#[cfg(test)]
impl Free {
    /// This motion of these readings, and nothing beside it.
    pub(crate) fn of(followed: Followed, read: Read) -> Free {
        Free {
            followed,
            torque: Acting::Nothing,
            gain: None,
            without: None,
            models: Vec::new(),
            alternatives: None,
            moving: None,
            misread: None,
            read,
            steady: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::track::Model;
    use nalgebra::UnitQuaternion;

    impl Read {
        /// Nothing, in units of 2 rad/s.
        pub(crate) fn nothing() -> Self {
            let (local_noise, rate_noise) = (None, None);
            let (used, largest_turn, jumps, has_rates) = (Vec::new(), 0.0, 0, false);
            Self { unit: 2.0, used, local_noise, rate_noise, largest_turn, jumps, has_rates }
        }
    }

    fn about_z(angle: f64) -> Quat<f64> {
        Quat::exponential(Vec3([0.0, 0.0, angle]))
    }

    /// Of n numbers a misfit of 1 + 5 √(2 · 5/n) may be chance.
    #[test]
    fn few_numbers_leave_more_to_chance() {
        assert_eq!([10.0, 40.0].map(by_chance), [6.0, 3.5]);
        assert_eq!(by_chance(0.0), by_chance(1.0));
    }

    /// The noise of three components is taken off the mean square of the rates; what does not turn has no unit.
    #[test]
    fn the_unit_is_the_rate_without_its_noise() {
        let node = |size: f64| Node {
            time: 6.0,
            attitude: Quat::identity(),
            rate: Vector3::x() * size,
            variance: 0.125,
        };
        // (9 + 16)/2 − 3 · 0.125 · 4
        let nodes = [vec![node(3.0)], vec![node(-4.0)]];
        assert!((unit_of(&nodes, 2.0).unwrap() - 11_f64.sqrt()).abs() < 1e-14);
        assert!(unit_of(&nodes, 20.0).is_none() && unit_of(&[], 1.0).is_none());
        let scaled = in_units(&node(3.0), 2.0);
        assert_eq!((scaled.time, scaled.rate.x, scaled.variance), (12.0, 1.5, 0.03125));
    }

    /// Attitudes differ from the first of their stretch by more than five deviations of the noise, in the root of the mean square.
    #[test]
    fn what_turns_by_its_noise_alone_is_refused() {
        let of = |first: f64| (vec![0.0, 1.0], vec![about_z(first), about_z(first + 0.1)]);
        let stretches = [of(0.0), of(1.0)];
        // the root of 0.01/2 is 0.0707
        assert_eq!(does_turn(&stretches, 0.0141), Ok(()));
        let refused = does_turn(&stretches, 0.0142);
        let Err(FitError::Poses(PoseFault::NoTurn { turn, noise: 0.0142 })) = refused else {
            panic!("{refused:?}")
        };
        assert!((turn - 0.1 * 0.5_f64.sqrt()).abs() < 1e-14);
    }

    /// A quarter turn about z takes x to y and y to −x.
    #[test]
    fn tensors_turn_with_their_axes() {
        let j = Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45);
        let expected = Matrix3::new(0.35, -0.01, -0.03, -0.01, 0.2, -0.02, -0.03, -0.02, 0.45);
        let found = tensor(&turned(&coordinates(&j), &about_z(core::f64::consts::FRAC_PI_2)));
        assert!((found - expected).amax() < 1e-14, "{found}");
    }

    /// Rates in units of less than 1.25 times those of the attitudes, or over 1.25, are of another size beyond that, and rates of nothing have no
    /// axes.
    #[test]
    fn rates_of_another_size_are_refused() {
        let rates = [Vector3::x(), Vector3::y(), Vector3::z()];
        let times = [0.0, 1.0, 2.0];
        let node =
            |k: usize| Node { time: times[k], attitude: Quat::identity(), rate: rates[k], variance: 0.0 };
        let nodes = [(0..3).map(node).collect::<Vec<Node>>()];
        let stretches = [(times.to_vec(), vec![Quat::identity(); 3])];
        let of = |scale: f64| {
            let own = [rates.map(|rate| rate * scale).to_vec()];
            alignment_of(&nodes, &stretches, &own, 0.1)
        };
        for scale in [0.81, 1.0, 1.24] {
            let found = of(scale).unwrap().unwrap();
            assert!((found.scale - scale).abs() < 1e-14 && found.turn.v.norm() < 1e-13, "{scale}");
        }
        for wrong in [0.79, 1.26] {
            let Err(FitError::Poses(PoseFault::Scale { scale })) = of(wrong) else { panic!("{wrong}") };
            assert!((scale - wrong).abs() < 1e-14);
        }
        let Err(FitError::Poses(fault)) = of(-1.0) else { panic!() };
        assert_eq!(fault, PoseFault::Mirrored);
        assert_eq!(of(0.0).err(), Some(FitError::NoRotation { rms: 0.0, noise: 0.0 }));
        assert!(alignment_of(&nodes, &stretches, &[Vec::new()], 0.1).unwrap().is_none());
    }

    fn poses(angles: &[f64]) -> Poses {
        let times: Vec<f64> = (0..angles.len()).map(|k| 3.0 + 0.5 * k as f64).collect();
        let attitudes: Vec<UnitQuaternion<f64>> = angles.iter().map(|angle| about_z(*angle).into()).collect();
        Poses::new("a", &times, &attitudes).unwrap()
    }

    /// A frame that jumps is left out, and its neighbours become neighbours; times count from the middle of all samples.
    #[test]
    fn a_look_leaves_out_what_jumps() {
        let mut angles: Vec<f64> = (0..21).map(|k| 0.05 * f64::from(k)).collect();
        angles[7] += 1.0;
        let poses = poses(&angles);
        let found = looked_at(&poses, &Settings::default()).unwrap();
        assert_eq!((found.jumps, found.stretches[0].0.len(), &found.used[..]), (1, 20, &[(0, 8.0)][..]));
        assert!((found.largest_turn - 0.1).abs() < 1e-13);
        assert_eq!((found.stretches[0].0[0], found.stretches[0].0[7]), (-5.0, -1.0));
        let kept = looked_at(&poses, &Settings::default().with_leave_out_spikes(false)).unwrap();
        assert!(kept.jumps == 0 && (kept.largest_turn - 1.05).abs() < 1e-13);
    }

    /// More than nine tenths of half a turn between neighbours are refused by the sample before, however few samples stand between.
    #[test]
    fn half_a_turn_is_refused_by_its_sample() {
        let of = |turn: f64| {
            let angle = |k: u8| 0.05 * f64::from(k) + if k < 9 { 0.0 } else { turn };
            looked_at(&poses(&(0..16).map(angle).collect::<Vec<f64>>()), &Settings::default())
        };
        assert!(of(2.77).is_ok_and(|found| (found.largest_turn - 2.82).abs() < 1e-12));
        let Err(FitError::Poses(fault)) = of(2.79) else { panic!() };
        let PoseFault::HalfTurn { sample: 9, time: 7.0, turn, step: 0.5, .. } = fault else {
            panic!("{fault}")
        };
        assert!((turn - 2.84).abs() < 1e-12);
        let Err(FitError::TooFewSamples { samples: 7, segments: 1, longest: 7, .. }) =
            looked_at(&poses(&[0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6]), &Settings::default())
        else {
            panic!()
        };
    }

    /// What is left is compared with the noise of attitudes where there are any, and with the one that is given before that of neighbours.
    #[test]
    fn a_misfit_is_over_the_noise_that_is_known() {
        let free = |level: f64, local_noise: Option<f64>, has_attitudes: bool| {
            let attitudes = if has_attitudes { vec![Quat::identity()] } else { Vec::new() };
            let track = Track { times: vec![0.0], attitudes, rates: vec![Vector3::x()], used: vec![true] };
            let (x, alignment) = (Coordinates::zeros(), Quat::identity());
            let model = Model { x, alignment, is_aligned: false, drag: None, starts: Vec::new() };
            let levels = Levels { attitude: level, rate: 0.5 * level };
            let followed = Followed { tracks: vec![track], ..Followed::at(model, levels, [4.0, 6.0]) };
            Free::of(followed, Read { local_noise, has_rates: true, ..Read::nothing() })
        };
        let (plain, given) = (Settings::default(), Settings::default().with_attitude_noise(0.5));
        assert_eq!(free(1.0, Some(0.25), true).misfit(&plain), Some(16.0));
        assert_eq!(free(1.0, Some(0.25), true).misfit(&given), Some(4.0));
        assert!([None, Some(0.0)].iter().all(|noise| free(1.0, *noise, true).misfit(&plain).is_none()));
        // 0.5 in units of 2 rad/s over 0.25 rad/s
        let rates = free(1.0, Some(0.25), false);
        assert_eq!((rates.misfit(&plain.clone().with_noise(0.25)), rates.misfit(&plain)), (Some(16.0), None));
        // ten numbers scatter up to 6
        for (level, is_explained) in [(1.22, true), (1.23, false)] {
            assert_eq!(free(level, None, true).is_explained(&given), is_explained, "{level}");
        }
        assert!(free(9.0, None, true).is_explained(&plain));
    }

    /// Attitudes of a steady spin are told in units of its rate, from the middle of their times. What neighbours tell of the noise counts up to three
    /// tenths of a radian from one to the next, and a noise that is given before it.
    #[test]
    fn attitudes_are_told_in_units_of_their_rate() {
        for (step, is_told) in [(0.29, true), (0.31, false)] {
            let poses = poses(&(0..21).map(|k| step * f64::from(k)).collect::<Vec<f64>>());
            let begun = |settings: Settings| Begun::new(&poses, &settings).ok().unwrap();
            let Begun { tracks, noise, read, turn, .. } = begun(Settings::default());
            // half a second from one to the next
            let unit = 2.0 * step;
            assert!((read.unit / unit - 1.0).abs() < 1e-9, "{} {unit}", read.unit);
            assert!((tracks[0].times[0] / (-5.0 * unit) - 1.0).abs() < 1e-9, "{:?}", tracks[0].times);
            assert!(noise < 1e-9 && turn == Quat::identity(), "{noise}");
            assert_eq!((read.local_noise, read.rate_noise), (is_told.then_some(noise), None), "{step}");
            assert!((read.largest_turn - step).abs() < 1e-12 && !read.has_rates);
            assert_eq!(begun(Settings::default().with_attitude_noise(1e-3)).noise, 1e-3);
        }
    }
}
