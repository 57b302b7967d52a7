//! Gauss and Newton's steps, damped, towards the model of the largest likelihood.

use polhode::rotation::{Quat, Vec3};

use crate::likelihood::motion::Start;
use crate::likelihood::sums::{Pull, Reduced, Step, Sums};
use crate::likelihood::track::{Kind, Model, Track};
use crate::thresholds::likelihood::{BEYOND, CHANGE, CREEP, DAMPING, LOOK, MOST_DAMPING, STEPS, STILL};

/// Standard deviations of a component of attitudes, rad, and of rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Levels {
    pub(crate) attitude: f64,
    pub(crate) rate: f64,
}

impl Levels {
    pub(crate) fn of(self, kind: Kind) -> f64 {
        match kind {
            Kind::Attitude => self.attitude,
            Kind::Rate => self.rate,
        }
    }
}

/// What is to be made least: samples within `radius` of the middles of their stretches, and the pull of a tensor.
///
/// Of residuals beyond [`BEYOND`] deviations the size counts in place of the square (Huber).
pub(crate) struct Problem<'a> {
    pub(crate) tracks: &'a [Track],
    pub(crate) levels: Levels,
    pub(crate) radius: f64,
    pub(crate) pull: Option<Pull>,
}

impl Problem<'_> {
    /// The normal equations at `model`, and what is to be made least; `None` where there is no such motion.
    pub(crate) fn sums(&self, model: &Model) -> Option<(Vec<Sums>, f64)> {
        let mut cost = self.pull.map_or(0.0, |pull| pull.squares(model));
        let mut all = Vec::with_capacity(self.tracks.len());
        for (track, start) in self.tracks.iter().zip(&model.starts) {
            let mut sums = Sums::zero();
            track.visit(model, start, self.radius, |left| {
                let level = self.levels.of(left.kind);
                let (per_square, size) = (1.0 / (level * level), left.residual.norm() / level);
                // x² up to the bend, 2 k x − k² beyond
                let bent = size.min(BEYOND);
                cost += bent * (2.0 * size - bent);
                sums.add(left, (BEYOND / size).min(1.0) * per_square);
            })?;
            all.push(sums);
        }
        cost.is_finite().then_some((all, cost))
    }

    /// The model nearest to the samples, from one near it; `None` where no motion is found.
    pub(crate) fn settle(&self, mut model: Model) -> Option<Settled> {
        let (mut sums, mut cost) = self.sums(&model)?;
        let (mut damping, mut is_still, mut before) = (0.0, false, cost);
        for count in 1..=STEPS {
            let pull = self.pull.as_ref().map(|pull| (pull, &model));
            let step = Reduced::damped(&sums, pull, damping).and_then(|reduced| reduced.step());
            // a short step that is damped tells of no bottom
            is_still = damping == 0.0 && step.as_ref().is_some_and(|step| step.gain < STILL);
            let next = step.map(|step| moved(&model, &step));
            let found = next.and_then(|next| self.sums(&next).map(|found| (next, found)));
            match found {
                Some((next, (there, less))) if less <= cost => {
                    (model, sums, cost) = (next, there, less);
                    damping = if damping > DAMPING { damping / CHANGE } else { 0.0 };
                }
                // at the bottom rounding alone decides
                Some(_) if is_still => {}
                _ => damping = f64::max(CHANGE * damping, DAMPING),
            }
            if is_still || damping > MOST_DAMPING {
                break;
            }
            if count % LOOK == 0 {
                if before - cost < CREEP {
                    break;
                }
                before = cost;
            }
        }
        Some(Settled { model, is_still })
    }
}

/// Where a descent has ended.
pub(crate) struct Settled {
    pub(crate) model: Model,
    /// Whether it is the bottom.
    pub(crate) is_still: bool,
}

/// A model after a step.
pub(crate) fn moved(model: &Model, step: &Step) -> Model {
    let turned = |q: Quat<f64>, v: [f64; 3]| (q * Quat::exponential(Vec3(v))).normalized();
    let starts = model.starts.iter().zip(&step.starts).map(|(start, step)| Start {
        attitude: turned(start.attitude, [step[0], step[1], step[2]]),
        rate: start.rate + step.fixed_rows::<3>(3),
    });
    let c = &step.common;
    Model {
        x: model.x + c.fixed_rows::<5>(0),
        alignment: turned(model.alignment, [c[5], c[6], c[7]]),
        is_aligned: model.is_aligned,
        drag: model.drag.map(|drag| drag + c[8]),
        starts: starts.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::{Coordinates, Form, eigen};
    use nalgebra::Vector3;

    /// Squares of residuals in their deviations up to four, beyond them 2 · 4 times the size less 16; a pull is added, and what is not used
    /// is not.
    #[test]
    fn the_cost_bends_at_four_deviations() {
        let start = Start { attitude: Quat::identity(), rate: Vector3::new(0.5, 0.8, -0.4) };
        let x = Coordinates::new(-0.06, 0.02, 0.03, -0.02, 0.04);
        let alignment = Quat::identity();
        let model = Model { x, alignment, is_aligned: false, drag: None, starts: vec![start] };
        let motion = model.motion(&start).unwrap();
        let times = vec![-2.0, -1.0, 0.0, 1.0];
        let at = |t: &f64| motion.at(*t).unwrap();
        let rates = times.iter().zip([0.2, 0.6, 0.8, 0.0]).map(|(t, off)| at(t).rate + Vector3::x() * off);
        let turned = times.iter().zip([0.0, 0.0, 0.0, 0.06]);
        let turned = turned.map(|(t, off)| at(t).attitude * Quat::exponential(Vec3([0.0, off, 0.0])));
        let track = Track {
            attitudes: turned.collect(),
            rates: rates.collect(),
            used: vec![true, true, false, true],
            times: times.clone(),
        };
        let levels = Levels { attitude: 0.02, rate: 0.1 };
        let tracks = core::slice::from_ref(&track);
        let cost = |radius, pull| Problem { tracks, levels, radius, pull }.sums(&model).unwrap().1;
        // two deviations, six and three: 4 + (8 · 6 − 16) + 9
        assert!((cost(f64::INFINITY, None) - 45.0).abs() < 1e-9);
        assert!((cost(1.0, None) - 41.0).abs() < 1e-9);
        let centre = x + Coordinates::repeat(0.5);
        let pull = Pull { information: Form::identity() * 4.0, centre, drag: 1.0 };
        // 4 · 5 · 0.25
        assert!((cost(1.0, Some(pull)) - 46.0).abs() < 1e-9);
        assert_eq!((levels.of(Kind::Attitude), levels.of(Kind::Rate)), (0.02, 0.1));
    }

    /// The motion of the readings is a bottom at once. Where a pull outwards makes a saddle of it no step is taken but a damped one, and that
    /// tells of no bottom.
    #[test]
    fn a_saddle_is_no_bottom() {
        let start = Start { attitude: Quat::identity(), rate: Vector3::new(0.5, 0.8, -0.4) };
        let x = Coordinates::new(-0.06, 0.02, 0.03, -0.02, 0.04);
        let alignment = Quat::identity();
        let model = Model { x, alignment, is_aligned: false, drag: None, starts: vec![start] };
        let motion = model.motion(&start).unwrap();
        let times: Vec<f64> = (0..=20).map(|k| 0.5 * f64::from(k) - 5.0).collect();
        let rates = times.iter().map(|t| motion.at(*t).unwrap().rate).collect();
        let tracks = [Track { attitudes: Vec::new(), rates, used: vec![true; 21], times }];
        let levels = Levels { attitude: 1.0, rate: 0.1 };
        let problem = |pull| Problem { tracks: &tracks, levels, radius: f64::INFINITY, pull };
        let (sums, cost) = problem(None).sums(&model).unwrap();
        let form = Reduced::new(&sums).unwrap().of_tensor().unwrap();
        assert!(cost == 0.0 && problem(None).settle(model.clone()).unwrap().is_still);
        // along the direction of which the readings tell least the information is half of theirs, or as much below zero
        for (share, is_still) in [(0.5, true), (2.0, false)] {
            let information = Form::identity() * (-share * eigen(form).0[0]);
            let pull = Pull { information, centre: x, drag: 0.0 };
            let settled = problem(Some(pull)).settle(model.clone()).unwrap();
            assert_eq!((settled.is_still, settled.model.x), (is_still, x), "{share}");
        }
    }
}
