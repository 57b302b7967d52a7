//! The reading that the record itself supports, and the mistake of the program where none does.
//!
//! Every reading makes a claim that can be tried: that the equations of motion lead from each row to a later one. Cheap tests
//! come first: whether the attitudes turn by the angular velocities at all. What is left runs over windows of the record, as a
//! program without mistake and as programs with one. The likelihood of a hypothesis is that of normal deviates whose variance
//! is what the hypothesis leaves.

use core::cmp::{Ordering, Reverse};
use std::borrow::Cow;

use super::bodies::{Told, reordered};
use super::candidates::{self, ORDERS};
use super::columns::{Columns, Defects, Source};
use super::program::{Dynamics, FARTHEST, Law, Program, Turn};
use super::rows::{Windows, typical_turn};
use super::{
    AuditError, Convention, Direction, Frame, Question, Ranked, RateUnit, Reading, Suspect, Trajectory,
    Turns, shape,
};
use crate::body::{Body, Problem};
use crate::rotation::Vec3;

/// A reading whose kinematics leave more than this many times what the best leave is not tried, rad.
const KINEMATIC_RATIO: f64 = 3.0;

/// Nor is the difference below this seen, rad: what the trapezoidal rule leaves.
const KINEMATIC_FLOOR: f64 = 0.02;

/// Most hypotheses that are run.
const MOST_TRIED: usize = 160;

/// Defects within this ratio are the same within the scatter of some ten windows.
const SAME: f64 = 1.5;

/// Defects below this are rounding and what the steps of the trial leave.
const FLOOR: f64 = 1e-6;

/// Defects above this are those of rows that have nothing to do with each other, rad or relative.
const LOST: f64 = 0.3;

/// Rows between which the body or its angular velocity turns by less are near each other, rad.
const NEAR: f64 = 1.0;

/// A mistake is named where it leaves less than this part of what the best reading leaves.
const CONVICTED: f64 = 0.2;

/// A reading with the program that is said to have made the record.
#[derive(Clone, Debug)]
pub(super) struct Hypothesis {
    pub(super) reading: Reading,
    pub(super) program: Program,
    pub(super) body: Body,
    pub(super) suspect: Suspect,
    pub(super) defects: Defects,
}

/// What was found.
pub(super) struct Finding {
    /// Readings without a mistake, best first, with the bodies that they move.
    pub(super) right: Vec<Hypothesis>,
    pub(super) ranking: Vec<Ranked>,
    /// How many of the first cannot be told apart.
    pub(super) tied: usize,
    /// A mistake that explains what no reading does.
    pub(super) mistake: Option<Hypothesis>,
    /// The turn between rows, rad, where it is too far for any reading to be told; the first is then what is claimed or usual.
    pub(super) way: Option<f64>,
}

pub(super) fn investigate(record: &Trajectory, question: &Question) -> Result<Finding, AuditError> {
    let columns = Columns::new(record);
    if columns.source == Source::Momentum && question.body.is_none() {
        return Err(AuditError::MomentumNeedsBody);
    }
    if columns.is_at_rest() {
        return Err(AuditError::AtRest);
    }
    let windows = columns.windows();
    let (claims, bodies, told) = (question.claims, orders(question), question.told());
    let case = Case { columns, windows, claims, bodies, told };
    let attitudes = candidates::attitudes(record, &question.claims);
    if attitudes.is_empty() {
        return Err(AuditError::NoReading);
    }
    let mut readings: Vec<Reading> =
        attitudes.iter().flat_map(|attitude| candidates::rates(record, attitude)).collect();
    if case.columns.source == Source::Momentum {
        // what the momenta turn the attitudes by depends on the moments
        readings = readings
            .iter()
            .flat_map(|reading| case.bodies.iter().map(|(order, _)| Reading { moments: *order, ..*reading }))
            .collect();
    }
    let right = case.plausible(&readings, &case.right_programs());
    let mut right = case.run(right);
    if right.is_empty() {
        return Err(if case.told.is_some() { AuditError::NoStart } else { AuditError::NoBody });
    }
    case.sort(&mut right);
    let way = case.way_without_trace(&right[0].defects);
    let tied = if way.is_some() { right.len() } else { case.tied(&right) };
    right[..tied].sort_by_key(|found| Reverse(case.preference(&found.reading)));
    let tied = if way.is_some() { 1 } else { tied };
    let best = right[0].clone();
    let ranking = right.iter().take(MOST_TRIED).map(|found| case.ranked(found, &best)).collect();
    let mistake = if way.is_some() { None } else { case.mistake(&readings, &best) };
    Ok(Finding { right, ranking, tied, mistake, way })
}

/// The body in the orders of its moments that are to be tried.
fn orders(question: &Question) -> Vec<([usize; 3], Body)> {
    let Some(body) = &question.body else { return Vec::new() };
    // the axes of wheels stay where they are
    let orders = if question.wheels.is_empty() { &ORDERS[..] } else { &[[0, 1, 2]] };
    orders.iter().filter_map(|&order| Some((order, reordered(body, order)?))).collect()
}

struct Case<'a> {
    columns: Columns<'a>,
    windows: Windows,
    claims: Convention,
    /// Empty where no body is given.
    bodies: Vec<([usize; 3], Body)>,
    /// The body with wheels whose momenta follow from the start.
    told: Option<Told>,
}

impl Case<'_> {
    /// Programs without mistake, by the frame of their ω.
    fn right_programs(&self) -> Vec<(Suspect, Program)> {
        [Frame::Body, Frame::Space].map(|frame| (Suspect::None, Program::right(frame))).into()
    }

    /// Programs with one mistake.
    fn wrong_programs(&self) -> Vec<(Suspect, Program)> {
        let has_attitude = self.columns.record.attitude.is_some();
        let forced = self.told.is_some()
            || self.bodies.first().is_some_and(|(_, body)| body.problem() != Problem::Free);
        let mut found = Vec::new();
        for frame in [Frame::Body, Frame::Space] {
            let right = Program::right(frame);
            let other = if frame == Frame::Body { Frame::Space } else { Frame::Body };
            if has_attitude {
                found
                    .push((Suspect::KinematicsSign, Program { turn: Turn { frame, factor: -1.0 }, ..right }));
                found.push((
                    Suspect::OmegaFrame,
                    Program { turn: Turn { frame: other, factor: 1.0 }, ..right },
                ));
            }
            if self.bodies.is_empty() {
                continue; // of a body that is fitted, equations with a mistake fit as well
            }
            if has_attitude {
                found.push((Suspect::Transposed, Program { law: Law::Transposed, ..right }));
                if forced {
                    found.push((Suspect::Transposed, Program { law: Law::TransposedForces, ..right }));
                }
                let degree = RateUnit::DegreesPerSecond.radians_per_second(1.0);
                for factor in [degree, 1.0 / degree] {
                    found.push((Suspect::Degrees, Program { turn: Turn { frame, factor }, ..right }));
                }
            }
            found.push((Suspect::GyroscopicTermMissing, Program { law: Law::NoGyroscopicTerm, ..right }));
            if frame == Frame::Body {
                for pattern in 1..8_u8 {
                    let signs = [1, 2, 4].map(|bit| if pattern & bit == 0 { 1.0 } else { -1.0 });
                    found.push((
                        Suspect::GyroscopicSign,
                        Program { law: Law::GyroscopicSigns(signs), ..right },
                    ));
                }
            }
        }
        found
    }

    /// The hypotheses whose kinematics hold, best first.
    fn plausible(
        &self,
        readings: &[Reading],
        programs: &[(Suspect, Program)],
    ) -> Vec<(Suspect, Reading, Program)> {
        let all = readings.iter().flat_map(|reading| {
            let frame = self.columns.frame(reading);
            let fitting = programs.iter().filter(move |(_, program)| program.frame == frame);
            fitting.map(move |(suspect, program)| (suspect.clone(), *reading, *program))
        });
        let ball = self.ball();
        let every = (self.windows.starts.len() / 24).max(1);
        let mut found: Vec<(f64, (Suspect, Reading, Program))> = all
            .map(|hypothesis| {
                let (_, reading, program) = &hypothesis;
                let dynamics = self.body(reading).map(|body| Dynamics::new(&body));
                let dynamics = dynamics.as_ref().or(ball.as_ref());
                let defect = dynamics.and_then(|dynamics| {
                    self.columns.kinematic(reading, program.turn, dynamics, &self.windows, every)
                });
                (defect.unwrap_or(0.0), hypothesis)
            })
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let best = found.first().map_or(0.0, |first| first.0);
        found.retain(|(defect, _)| *defect <= (KINEMATIC_RATIO * best).max(KINEMATIC_FLOOR));
        found.into_iter().map(|(_, hypothesis)| hypothesis).take(MOST_TRIED).collect()
    }

    /// A body where none is needed but for its type.
    fn ball(&self) -> Option<Dynamics> {
        crate::inertia::Inertia::from_moments([1.0; 3])
            .ok()
            .map(|inertia| Dynamics::new(&Body::free(inertia)))
    }

    fn body(&self, reading: &Reading) -> Option<Cow<'_, Body>> {
        if let Some(told) = &self.told {
            return told.started(self.columns.record, reading).map(Cow::Owned);
        }
        let found = self.bodies.iter().find(|(order, _)| *order == reading.moments);
        found.map(|(_, body)| Cow::Borrowed(body))
    }

    /// The hypotheses in every order of moments, run over the windows; those far behind only over some.
    fn run(&self, hypotheses: Vec<(Suspect, Reading, Program)>) -> Vec<Hypothesis> {
        let each_order = self.columns.source != Source::Momentum;
        let mut found: Vec<Hypothesis> = Vec::new();
        let few = (self.windows.starts.len() / 16).max(1);
        for (suspect, reading, program) in hypotheses {
            let bodies: Vec<(Reading, Body)> = if self.bodies.is_empty() {
                let looks = self.columns.looks(&reading, &self.windows);
                // with a mistake in the kinematics, R I ω is no constant
                let by_attitude = reading.attitude.is_some() && suspect == Suspect::None;
                shape::fit(&looks, by_attitude).map(|body| (reading, body)).into_iter().collect()
            } else {
                let orders = self.bodies.iter().filter(|(order, _)| {
                    let claimed =
                        suspect == Suspect::None || self.claims.moments.is_none_or(|claim| claim == *order);
                    if each_order { claimed } else { *order == reading.moments }
                });
                let started = |body: &Body| match &self.told {
                    Some(told) => told.started(self.columns.record, &reading),
                    None => Some(body.clone()),
                };
                let of_order = |(order, body): &([usize; 3], Body)| {
                    Some((Reading { moments: *order, ..reading }, started(body)?))
                };
                orders.filter_map(of_order).collect()
            };
            for (reading, body) in bodies {
                let dynamics = Dynamics::new(&body);
                let defects = self.columns.defects(&reading, &program, &dynamics, &self.windows, few);
                found.push(Hypothesis { reading, program, body, suspect: suspect.clone(), defects });
            }
        }
        self.sort(&mut found);
        let Some(best) = found.first().map(|first| first.defects) else { return found };
        for hypothesis in found.iter_mut().filter(|found| distance(&found.defects, &best) < 4.0) {
            let dynamics = Dynamics::new(&hypothesis.body);
            hypothesis.defects =
                self.columns.defects(&hypothesis.reading, &hypothesis.program, &dynamics, &self.windows, 1);
        }
        found
    }

    fn sort(&self, found: &mut [Hypothesis]) {
        found.sort_by(|a, b| {
            let by = size(&a.defects).total_cmp(&size(&b.defects));
            if by == Ordering::Equal {
                self.preference(&b.reading).cmp(&self.preference(&a.reading))
            } else {
                by
            }
        });
    }

    /// The turn between rows, rad, where no program was followed so far, the best reading leaves what any would, and rows are not
    /// near each other as they are where a unit of time is wrong.
    fn way_without_trace(&self, best: &Defects) -> Option<f64> {
        let Trajectory { times, rates, .. } = self.columns.record;
        let rates = rates.as_ref()?;
        let span = times.last()? - times.first()?;
        let squares = rates.iter().map(|w| Vec3(*w).norm_squared()).sum::<f64>() / rates.len() as f64;
        let unit = self.claims.rate_unit.unwrap_or_default().radians_per_second(1.0);
        let way = squares.sqrt() * unit * span / (times.len() - 1) as f64;
        let is_lost = best.attitude.or(best.rates)? > LOST && typical_turn(self.columns.record) > NEAR;
        (way > FARTHEST && is_lost).then_some(way)
    }

    /// How many of the first leave the same.
    fn tied(&self, sorted: &[Hypothesis]) -> usize {
        let best = &sorted[0].defects;
        let same = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => a + FLOOR <= SAME * (b + FLOOR),
            _ => true,
        };
        let both = |found: &Hypothesis| {
            same(found.defects.attitude, best.attitude) && same(found.defects.rates, best.rates)
        };
        sorted.iter().take_while(|found| both(found)).count().max(1)
    }

    /// What is preferred among readings that fit alike: what is claimed, and what this library writes.
    fn preference(&self, reading: &Reading) -> [u32; 2] {
        let claims = &self.claims;
        let holds = |claimed: bool| u32::from(claimed);
        let claimed = holds(claims.attitude.is_some() && claims.attitude == reading.attitude)
            + holds(claims.omega_frame.is_some() && claims.omega_frame == reading.omega_frame)
            + holds(claims.rate_unit.is_some() && claims.rate_unit == reading.rate_unit)
            + holds(claims.momentum_frame.is_some() && claims.momentum_frame == reading.momentum_frame)
            + holds(claims.angle_axes.is_some() && claims.angle_axes == reading.angle_axes())
            + holds(claims.moments == Some(reading.moments));
        let usual = holds(reading.attitude == Some(Direction::BodyToSpace))
            + holds(reading.omega_frame == Some(Frame::Body))
            + holds(reading.momentum_frame == Some(Frame::Space))
            + holds(reading.rate_unit == Some(RateUnit::RadiansPerSecond))
            + holds(reading.moments_as_given())
            + holds(reading.quaternion == Some(super::QuaternionOrder::ScalarFirst))
            + holds(reading.angles.is_some_and(|angles| angles.turns == Turns::Intrinsic));
        [claimed, usual]
    }

    fn ranked(&self, found: &Hypothesis, best: &Hypothesis) -> Ranked {
        let windows = self.windows.starts.len() as f64;
        Ranked {
            reading: found.reading,
            log_likelihood_ratio: (-1.5 * windows * distance(&found.defects, &best.defects)).min(0.0),
            attitude_defect: found.defects.attitude,
            rate_defect: found.defects.rates,
        }
    }

    /// A program with a mistake that does what no reading does.
    fn mistake(&self, readings: &[Reading], best: &Hypothesis) -> Option<Hypothesis> {
        let worst = best.defects.attitude.unwrap_or(0.0).max(best.defects.rates.unwrap_or(0.0));
        if worst < 1e-5 {
            return None;
        }
        let programs = self.wrong_programs();
        let mut found = self.run(self.plausible(readings, &programs));
        self.sort(&mut found);
        let tied = if found.is_empty() { 0 } else { self.tied(&found) };
        found[..tied].sort_by_key(|found| Reverse(self.preference(&found.reading)));
        let first = found.into_iter().next()?;
        convicts(&best.defects, &first.defects).then_some(first)
    }
}

/// Whether a mistake is named that leaves `mistaken` where the best reading leaves `best`.
fn convicts(best: &Defects, mistaken: &Defects) -> bool {
    distance(best, mistaken) > -2.0 * libm::log(CONVICTED)
}

/// Logarithm of the variances that are left.
fn size(defects: &Defects) -> f64 {
    [defects.attitude, defects.rates]
        .iter()
        .flatten()
        .map(|defect| libm::log(defect * defect + FLOOR * FLOOR))
        .sum()
}

fn distance(defects: &Defects, best: &Defects) -> f64 {
    size(defects) - size(best)
}

#[cfg(test)]
mod tests {
    use super::super::{AngleUnit, Angles};
    use super::*;

    #[test]
    fn a_mistake_is_named_where_it_leaves_less_than_a_fifth() {
        let left = |attitude: f64, rates| Defects { attitude: Some(attitude), rates };
        let best = left(1e-2, None);
        assert!(convicts(&best, &left(1.9e-3, None)));
        for share in [0.21, 0.3, 0.5, 0.9] {
            assert!(!convicts(&best, &left(share * 1e-2, None)), "{share}");
        }
        // of attitude and rates together
        assert!(convicts(&left(1e-2, Some(1e-2)), &left(5e-3, Some(3e-3))));
        assert!(!convicts(&left(1e-2, Some(1e-2)), &left(5e-3, Some(5e-3))));
    }

    /// What `look` finds in a case of a slow spin for which `claims` are made.
    fn with_case<T>(claims: Convention, look: impl FnOnce(&Case<'_>) -> T) -> T {
        let record = Trajectory::new((0..20).map(f64::from).collect()).with_rates(vec![[0.1, 0.2, 0.3]; 20]);
        let columns = Columns::new(&record);
        let windows = columns.windows();
        look(&Case { columns, windows, claims, bodies: Vec::new(), told: None })
    }

    #[test]
    fn readings_are_tied_that_leave_nearly_the_same_or_only_rounding() {
        let found = |[attitude, rates]: [f64; 2]| Hypothesis {
            reading: Reading::default(),
            program: Program::right(Frame::Body),
            body: Body::free(crate::inertia::Inertia::from_moments([1.0, 2.0, 2.5]).unwrap()),
            suspect: Suspect::None,
            defects: Defects { attitude: Some(attitude), rates: Some(rates) },
        };
        let are_tied = |best: [f64; 2], other: [f64; 2]| {
            with_case(Convention::default(), |case| case.tied(&[best, other].map(found))) == 2
        };
        for (best, alike, other) in [(1e-3, 1.4e-3, 1.6e-3), (1e-8, 4e-7, 8e-7)] {
            assert!(are_tied([best; 2], [alike; 2]), "{best} {alike}");
            assert!(
                !are_tied([best; 2], [other, best]) && !are_tied([best; 2], [best, other]),
                "{best} {other}"
            );
        }
    }

    #[test]
    fn every_claim_that_holds_counts_by_itself() {
        let reading = Reading {
            attitude: Some(Direction::SpaceToBody),
            omega_frame: Some(Frame::Space),
            rate_unit: Some(RateUnit::DegreesPerSecond),
            momentum_frame: Some(Frame::Body),
            angles: Some(Angles {
                sequence: "zyx".parse().unwrap(),
                turns: Turns::Extrinsic,
                unit: AngleUnit::Radians,
            }),
            ..Reading::default()
        };
        let holding = |claims: &dyn Fn(&mut Convention)| {
            let mut claimed = Convention { moments: None, ..Convention::default() };
            claims(&mut claimed);
            with_case(claimed, |case| case.preference(&reading)[0])
        };
        let single: [&dyn Fn(&mut Convention); 6] = [
            &|claims| claims.attitude = reading.attitude,
            &|claims| claims.omega_frame = reading.omega_frame,
            &|claims| claims.rate_unit = reading.rate_unit,
            &|claims| claims.momentum_frame = reading.momentum_frame,
            &|claims| claims.angle_axes = Some([2, 1, 0]),
            &|claims| claims.moments = Some(reading.moments),
        ];
        assert_eq!(single.map(holding), [1; 6]);
        assert_eq!(holding(&|_| ()), 0);
        assert_eq!(holding(&|claims| single.iter().for_each(|claim| claim(claims))), 6);
        assert_eq!(holding(&|claims| claims.omega_frame = Some(Frame::Body)), 0);
    }
}
