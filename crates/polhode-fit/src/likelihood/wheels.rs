//! The likeliest tensor of a body with wheels, on its exact motion, from a weak estimate.
//!
//! A stretch is the motion `p' = p × ω`, `p = J ω + u h`, from a rate at its middle, with the momentum h of the wheels constant; its readings are
//! `y = P⁻¹ (ω + b)`. Windows double about the middles of the stretches, in all but the last of which the weak estimate pulls; the derivatives by
//! tensor, u and start are central differences of the closed form.

use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3};
use polhode::body::{Body, Wheel};
use polhode::flow::GyrostatMotion;
use polhode::inertia::Inertia;

use crate::columns::column::{Column, Unknowns, terms_of};
use crate::columns::effect::Class;
use crate::physical::coordinates::{eigen, tensor};
use crate::signal::stretch::Stretch;
use crate::solve::weak_estimate::{Part, WeakEstimate};
use crate::thresholds::likelihood::{
    CHANGE, CONSTANT, CREEP, DAMPING, DIFFERENCE, FIRST, LIGHT, LOOK, MOST_DAMPING, SAMPLES, STEPS, STILL,
    TOGETHER,
};

/// Numbers of a start.
const OWN: usize = 3;

/// The likeliest unknowns.
pub(crate) struct Likeliest {
    pub(crate) at: Unknowns,
    /// On columns and coordinates, each start at its best, per reciprocal variance of the noise; with the priors of the columns.
    pub(crate) information: DMatrix<f64>,
    /// Mean square of the residuals over the noise.
    pub(crate) misfit: f64,
}

/// The likeliest unknowns next to `weak`; `None` where something else acts than wheels of constant momentum, where the motion has no closed form,
/// where more is left than noise, and where they lie apart from the weak ones.
pub(crate) fn likeliest(stretches: &[Stretch], weak: &WeakEstimate, variance: f64) -> Option<Likeliest> {
    let root = weak.stacked.as_ref()?.whole();
    let told = |column: &Column| match column.class() {
        Class::Input => true,
        Class::Sensor => column.effect().change_of_rate(&Vector3::zeros()).is_some(),
        _ => false,
    };
    if weak.has_torque_noise() || !weak.columns.iter().all(|column| column.segment.is_none() && told(column))
    {
        return None;
    }
    let tracks = weak.parts.iter().map(|part| {
        let stretch = stretches.iter().find(|stretch| stretch.index == part.stretch)?;
        Track::new(stretch, part, weak, variance)
    });
    let tracks = tracks.collect::<Option<Vec<Track<'_>>>>()?;
    let problem = Problem { tracks, weak, variance, pull: root.transpose() * root };
    let model = problem.grow()?;
    let sums = problem.sums(&model, f64::INFINITY)?;
    let components = 3 * sums.iter().map(|sums| sums.samples).sum::<usize>();
    let unknowns = weak.columns.len() + 5 + OWN * sums.len();
    let squares: f64 = sums.iter().map(|sums| sums.squares).sum();
    let misfit = squares / variance / components.checked_sub(unknowns).filter(|dof| *dof > 0)? as f64;
    let apart = problem.apart(&model);
    let apart = apart.dot(&(&problem.pull * &apart)) / variance;
    let (information, _) = problem.reduced(&sums, &model, 0.0, false)?;
    let is_noise = weak.misfit(variance).max(misfit) <= weak.expected_misfit();
    (is_noise && apart <= TOGETHER).then_some(Likeliest { at: model.at, information, misfit })
}

/// The motion of a body with wheels, whose momentum is constant.
struct Motion {
    motion: GyrostatMotion,
    /// Of the wheels of the body that is followed, along the principal axes, and of those that are meant.
    followed: Vector3<f64>,
    meant: Vector3<f64>,
    moments: Vector3<f64>,
    /// Takes coordinates along the principal axes to those of the tensor.
    axes: Matrix3<f64>,
}

impl Motion {
    /// From the rate `start`; `None` where a moment is not positive, or the motion has too few digits.
    ///
    /// A multiple c of |p|² in twice the energy changes no p(t). With it the body that is followed has the moments I/(1 + c I), which obey the triangle
    /// inequality also where an estimate does not, and wheels of the momentum h/(1 + c I).
    fn new(j: &Matrix3<f64>, wheel: &Vector3<f64>, start: &Vector3<f64>) -> Option<Motion> {
        let (moments, mut axes) = eigen(*j);
        if axes.determinant() < 0.0 {
            axes.column_mut(2).neg_mut();
        }
        let common = moments.map(|own| 1.0 + 4.0 * own / moments[2]);
        let inertia = moments.component_div(&common);
        let meant = axes.tr_mul(wheel);
        let momentum = moments.component_mul(&axes.tr_mul(start)) + meant;
        let followed = meant.component_div(&common);
        // so light that it fits into the body
        let light = LIGHT * inertia[0];
        let axis = if followed == Vector3::zeros() { Vector3::z() } else { followed };
        let held = Wheel::new(axis, light, followed.norm() / light).ok()?;
        let body = Body::free(Inertia::from_positive_moments(inertia.into()).ok()?).with_wheel(held).ok()?;
        let rate = (momentum - followed).component_div(&inertia);
        let start = body.state(UnitQuaternion::identity(), rate).ok()?;
        let motion = GyrostatMotion::new(&body, &start).ok()?;
        Some(Motion { motion, followed, meant, moments, axes })
    }

    /// The rate; `None` out of reach.
    fn at(&self, t: f64) -> Option<Vector3<f64>> {
        let momentum = Vector3::from(self.motion.at(t).ok()?.momentum_body) + self.followed;
        Some(self.axes * (momentum - self.meant).component_div(&self.moments))
    }
}

/// A stretch, its time measured from its middle.
struct Track<'a> {
    stretch: &'a Stretch,
    middle: f64,
    /// Of the wheels, in units of the column.
    wheel: Vector3<f64>,
    start: Vector3<f64>,
    /// One over the variance of its noise, in that of all.
    weight: f64,
}

impl<'a> Track<'a> {
    /// `None` where a torque is known, or the momentum of the wheels changes by what readings would show.
    fn new(stretch: &'a Stretch, part: &Part, weak: &WeakEstimate, variance: f64) -> Option<Track<'a>> {
        let inputs = stretch.inputs.as_ref()?;
        let count = stretch.times.len();
        let wheel = inputs.wheel.iter().sum::<Vector3<f64>>() / count as f64;
        let terms = terms_of(&weak.columns, &weak.at, stretch);
        let change = inputs.wheel.iter().map(|h| (h - wheel).norm()).fold(0.0, f64::max);
        let weight = 1.0 / part.levels.white;
        let moves = change * terms.input.abs() * (count as f64 * weight / variance).sqrt();
        if inputs.torque.iter().any(|torque| *torque != Vector3::zeros())
            || moves > CONSTANT * eigen(terms.j).0[0]
        {
            return None;
        }
        let middle = 0.5 * (stretch.times.first()? + stretch.times.last()?);
        let nearest = stretch.times.partition_point(|t| *t < middle).min(count - 1);
        let start = terms.rate(&(stretch.rates[nearest] - part.noise[nearest]));
        Some(Track { stretch, middle, wheel, start, weight })
    }

    fn within(&self, radius: f64) -> impl Iterator<Item = usize> {
        let low = self.stretch.times.partition_point(|t| *t < self.middle - radius);
        low..self.stretch.times.partition_point(|t| *t <= self.middle + radius)
    }

    fn reach(&self) -> f64 {
        0.5 * self.stretch.duration()
    }
}

/// Where a search is.
#[derive(Clone)]
struct Model {
    at: Unknowns,
    starts: Vec<Vector3<f64>>,
}

/// Normal equations of one stretch, of columns, coordinates and start, per reciprocal variance of the noise.
struct Sums {
    matrix: DMatrix<f64>,
    gradient: DVector<f64>,
    squares: f64,
    samples: usize,
}

/// What a model leaves of the readings of one stretch.
struct Left {
    /// Of the samples that it is asked for.
    radius: f64,
    /// The readings that the motion would give.
    readings: Vec<Vector3<f64>>,
    /// Sum of squares of what is left, per reciprocal variance of the noise.
    squares: f64,
}

struct Problem<'a> {
    tracks: Vec<Track<'a>>,
    weak: &'a WeakEstimate,
    variance: f64,
    /// Information of the weak equations on columns and coordinates.
    pull: DMatrix<f64>,
}

impl Problem<'_> {
    /// Numbers that all stretches share.
    fn common(&self) -> usize {
        self.weak.columns.len() + 5
    }

    /// The likeliest model of the whole stretches; `None` where the search does not come to rest.
    fn grow(&self) -> Option<Model> {
        let starts = self.tracks.iter().map(|track| track.start).collect();
        let mut model = Model { at: self.weak.at.clone(), starts };
        let end = self.tracks.iter().map(Track::reach).fold(0.0, f64::max);
        let mut radius =
            FIRST / self.tracks.iter().map(|track| self.fastest(track, &model)).fold(1.0, f64::max);
        let few =
            |track: &Track<'_>, radius| track.within(radius).count() < SAMPLES.min(track.stretch.times.len());
        while radius < end && self.tracks.iter().any(|track| few(track, radius)) {
            radius *= 2.0;
        }
        while radius < end {
            model = self.settle(model, radius, true)?.0;
            radius *= 2.0;
        }
        let (model, is_still) = self.settle(model, f64::INFINITY, false)?;
        is_still.then_some(model)
    }

    /// The rate at which wheels turn the momentum about themselves.
    fn fastest(&self, track: &Track<'_>, model: &Model) -> f64 {
        let terms = terms_of(&self.weak.columns, &model.at, track.stretch);
        (track.wheel * terms.input).norm() / eigen(terms.j).0[0]
    }

    /// Gauss's and Newton's steps, damped; with whether they ended at the bottom.
    fn settle(&self, mut model: Model, radius: f64, is_pulled: bool) -> Option<(Model, bool)> {
        let cost = |left: &[Left], model: &Model| {
            let own: f64 = left.iter().map(|left| left.squares).sum();
            own + self.beside(model, is_pulled)
        };
        let left = self.left(&model, radius)?;
        let mut least = cost(&left, &model);
        let mut sums = self.sums_beside(&model, &left)?;
        let (mut damping, mut is_still, mut before) = (0.0, false, least);
        for count in 1..=STEPS {
            let step = self.step(&sums, &model, damping, is_pulled);
            is_still = damping == 0.0 && step.as_ref().is_some_and(|(_, gain)| *gain < STILL * self.variance);
            let next = step.and_then(|(next, _)| Some((self.left(&next, radius)?, next)));
            let next = next.map(|(left, next)| (cost(&left, &next), left, next));
            let is_less = next.as_ref().is_some_and(|(less, ..)| *less <= least);
            // the derivatives are dear, and not asked for where a step is not taken
            let taken = next
                .filter(|_| is_less)
                .and_then(|(less, left, next)| Some((self.sums_beside(&next, &left)?, next, less)));
            match taken {
                Some((there, next, less)) => {
                    (model, sums, least) = (next, there, less);
                    damping = if damping > DAMPING { damping / CHANGE } else { 0.0 };
                }
                // at the bottom rounding alone decides
                None => damping = f64::max(CHANGE * damping, DAMPING),
            }
            if is_still || damping > MOST_DAMPING {
                break;
            }
            if count % LOOK == 0 {
                if before - least < CREEP * self.variance {
                    break;
                }
                before = least;
            }
        }
        Some((model, is_still))
    }

    /// By how much columns and coordinates differ from those of the weak estimate.
    fn apart(&self, model: &Model) -> DVector<f64> {
        let of = |at: &Unknowns| DVector::from_iterator(self.common(), at.c.iter().chain(&at.x).copied());
        of(&model.at) - of(&self.weak.at)
    }

    /// Squares of the priors of the columns, and of the pull.
    fn beside(&self, model: &Model, is_pulled: bool) -> f64 {
        let priors = self.weak.columns.iter().zip(&model.at.c);
        let own: f64 =
            priors.filter_map(|(column, c)| Some(c / column.prior?)).map(|share| share * share).sum();
        let apart = self.apart(model);
        let pull = if is_pulled { apart.dot(&(&self.pull * &apart)) } else { 0.0 };
        own * self.variance + pull
    }

    /// Information and gradient of what all stretches share, each start at its best for it.
    fn reduced(
        &self,
        all: &[Sums],
        model: &Model,
        damping: f64,
        is_pulled: bool,
    ) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let common = self.common();
        let (mut information, mut gradient) = (DMatrix::zeros(common, common), DVector::zeros(common));
        for sums in all {
            let Eliminated { inverse, mixed, of_start } = sums.eliminated(common, damping)?;
            information += sums.matrix.view((0, 0), (common, common)) - &mixed * inverse * mixed.transpose();
            gradient += sums.gradient.rows(0, common) - &mixed * (inverse * of_start);
        }
        for (k, column) in self.weak.columns.iter().enumerate() {
            if let Some(prior) = column.prior {
                let weight = self.variance / (prior * prior);
                information[(k, k)] += weight;
                gradient[k] -= weight * model.at.c[k];
            }
        }
        if is_pulled {
            information += &self.pull;
            gradient -= &self.pull * self.apart(model);
        }
        for k in 0..common {
            information[(k, k)] *= 1.0 + damping;
        }
        Some((information, gradient))
    }

    /// The model after a step, and by how much the linear problem lowers the sum of squares.
    fn step(&self, all: &[Sums], model: &Model, damping: f64, is_pulled: bool) -> Option<(Model, f64)> {
        let common = self.common();
        let (information, gradient) = self.reduced(all, model, damping, is_pulled)?;
        let step = information.cholesky()?.solve(&gradient);
        let mut gain = step.dot(&gradient);
        let mut next = model.clone();
        let count = self.weak.columns.len();
        next.at.c.iter_mut().zip(step.iter()).for_each(|(c, step)| *c += step);
        next.at.x += step.rows(count, 5);
        for (start, sums) in next.starts.iter_mut().zip(all) {
            let Eliminated { inverse, mixed, of_start } = sums.eliminated(common, damping)?;
            gain += of_start.dot(&(inverse * of_start));
            *start += inverse * (of_start - mixed.tr_mul(&step));
        }
        Some((next, gain))
    }

    /// What a model leaves of the readings.
    fn left(&self, model: &Model, radius: f64) -> Option<Vec<Left>> {
        let each = self.tracks.iter().zip(&model.starts);
        each.map(|(track, start)| self.left_of(track, &model.at, start, radius)).collect()
    }

    fn left_of(&self, track: &Track<'_>, at: &Unknowns, start: &Vector3<f64>, radius: f64) -> Option<Left> {
        let terms = terms_of(&self.weak.columns, at, track.stretch);
        let back = terms.sensor.try_inverse()?;
        let motion = Motion::new(&tensor(&at.x), &(track.wheel * terms.input), start)?;
        let reading = |sample: usize| {
            let t = track.stretch.times[sample] - track.middle;
            Some(back * (motion.at(t)? + terms.offset))
        };
        let readings = track.within(radius).map(reading).collect::<Option<Vec<Vector3<f64>>>>()?;
        let each = track.within(radius).zip(&readings);
        let squares: f64 =
            each.map(|(sample, reading)| (track.stretch.rates[sample] - reading).norm_squared()).sum();
        Some(Left { radius, readings, squares: squares * track.weight })
            .filter(|left| left.squares.is_finite())
    }

    fn sums(&self, model: &Model, radius: f64) -> Option<Vec<Sums>> {
        self.sums_beside(model, &self.left(model, radius)?)
    }

    /// The same of what the model leaves.
    fn sums_beside(&self, model: &Model, left: &[Left]) -> Option<Vec<Sums>> {
        let each = self.tracks.iter().zip(&model.starts).zip(left);
        each.map(|((track, start), left)| self.sums_of(track, &model.at, start, left)).collect()
    }

    fn sums_of(&self, track: &Track<'_>, at: &Unknowns, start: &Vector3<f64>, left: &Left) -> Option<Sums> {
        let columns = &self.weak.columns;
        let (count, common, radius) = (columns.len(), self.common(), left.radius);
        let terms = terms_of(columns, at, track.stretch);
        let back = terms.sensor.try_inverse()?;
        let turned = (track.wheel * terms.input).norm() / eigen(terms.j).0[0];
        let h = DIFFERENCE / (1.0 + radius.min(track.reach()) * turned.max(1.0));
        let motion = |k: usize, h: f64| {
            let (mut x, mut u, mut start) = (at.x, terms.input, *start);
            match k {
                k if k < count => u += h,
                k if k < common => x[k - count] += h,
                k => start[k - common] += h,
            }
            Motion::new(&tensor(&x), &(track.wheel * u), &start)
        };
        let of_motion = |k: &usize| *k >= count || columns[*k].class() == Class::Input;
        let moved = (0..common + OWN).filter(of_motion).map(|k| Some((k, motion(k, h)?, motion(k, -h)?)));
        let moved = moved.collect::<Option<Vec<_>>>()?;
        let size = common + OWN;
        let mut sums = Sums {
            matrix: DMatrix::zeros(size, size),
            gradient: DVector::zeros(size),
            squares: left.squares,
            samples: left.readings.len(),
        };
        let mut rows = vec![Vector3::zeros(); size];
        for (sample, reading) in track.within(radius).zip(&left.readings) {
            let t = track.stretch.times[sample] - track.middle;
            let residual = track.stretch.rates[sample] - reading;
            for (k, above, below) in &moved {
                rows[*k] = back * (above.at(t)? - below.at(t)?) / (2.0 * h);
            }
            for (k, column) in columns.iter().enumerate() {
                if let Some(change) = column.effect().change_of_rate(reading) {
                    rows[k] = back * -change;
                }
            }
            for i in 0..size {
                sums.gradient[i] += rows[i].dot(&residual);
                for k in i..size {
                    sums.matrix[(i, k)] += rows[i].dot(&rows[k]);
                }
            }
        }
        sums.matrix.fill_lower_triangle_with_upper_triangle();
        sums.matrix *= track.weight;
        sums.gradient *= track.weight;
        Some(sums)
    }
}

/// A start that is taken out of the equations.
struct Eliminated {
    inverse: Matrix3<f64>,
    /// Rows of what is shared.
    mixed: DMatrix<f64>,
    of_start: Vector3<f64>,
}

impl Sums {
    /// `None` where the start is not determined.
    fn eliminated(&self, common: usize, damping: f64) -> Option<Eliminated> {
        let mut own: Matrix3<f64> = self.matrix.fixed_view::<OWN, OWN>(common, common).into_owned();
        for k in 0..OWN {
            own[(k, k)] *= 1.0 + damping;
        }
        Some(Eliminated {
            inverse: own.cholesky()?.inverse(),
            mixed: self.matrix.view((0, common), (common, OWN)).into_owned(),
            of_start: self.gradient.fixed_rows::<OWN>(common).into_owned(),
        })
    }
}

impl WeakEstimate {
    /// With these unknowns and what the motion tells of them in the place of its own; the equations stay what they are.
    pub(crate) fn moved_to(&mut self, likeliest: &Likeliest) -> Option<()> {
        let stacked = self.stacked.as_ref()?.at_least(&likeliest.at, &likeliest.information)?;
        self.root = stacked.root;
        self.at = likeliest.at.clone();
        self.stacked = Some(stacked);
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::drag::Drag;
    use crate::columns::input::Input;
    use crate::columns::sets::sensor_columns;
    use crate::physical::coordinates::{Coordinates, coordinates, trace_free};
    use crate::settings::sensor::SensorPriors;
    use crate::signal::covariance::Levels;
    use crate::signal::stretch::KnownInputs;
    use crate::signal::test_functions::TestFunctions;
    use crate::solve::linearised::Linearised;
    use crate::solve::stacked::Stacked;
    use polhode::num::Random;

    /// Against the equation of motion, also of moments that no body has.
    #[test]
    fn the_motion_solves_its_equation() {
        let mut random = Random::new(6);
        for moments in [[1.0, 2.0, 2.6], [1.0, 2.0, 3.4], [0.02, 2.0, 2.3]] {
            let j = Matrix3::from_diagonal(&Vector3::from(moments)) + trace_free(&Coordinates::repeat(0.01));
            let j = j / j.trace();
            for wheel in [random.normal_vector() * 0.3, Vector3::zeros()] {
                let start = random.normal_vector();
                let motion = Motion::new(&j, &wheel, &start).unwrap();
                let (t, h) = (3.0, 1e-4);
                let [before, here, after] = [t - h, t, t + h].map(|t| motion.at(t).unwrap());
                let change = j * (after - before) / (2.0 * h);
                assert!((motion.at(0.0).unwrap() - start).norm() < 1e-13);
                let expected = (j * here + wheel).cross(&here);
                assert!((change - expected).norm() < 1e-6 * (1.0 + expected.norm()), "{moments:?}");
            }
        }
    }

    /// The factor of the wheels, an offset and an error of scale, with a body of trace 1, as where a search begins.
    fn weak() -> WeakEstimate {
        let sensor = SensorPriors::default().with_offset(0.05).with_scale(0.02);
        let columns: Vec<Column> =
            [Column::new(Input, None)].into_iter().chain(sensor_columns(&sensor, 1.0)).collect();
        let j = Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45);
        let at = Unknowns { x: coordinates(&j), c: vec![1.2, 0.01, -0.02, 0.03, 0.015] };
        WeakEstimate::plain(columns, at, 0)
    }

    /// Readings for 16 s, of which the middle is at 9 s, that are those of a motion but for so much noise.
    fn stretch(weak: &WeakEstimate, noise: f64) -> Stretch {
        let times: Vec<f64> = (0..=128).map(|k| 1.0 + 0.125 * f64::from(k)).collect();
        let mut stretch = Stretch::new(times, vec![Vector3::zeros(); 129]);
        let all = problem(weak, &stretch);
        let readings = all.left(&model(weak), f64::INFINITY).unwrap().remove(0).readings;
        let mut random = Random::new(5);
        stretch.rates = readings.iter().map(|rate| rate + random.normal_vector() * noise).collect();
        stretch
    }

    fn problem<'a>(weak: &'a WeakEstimate, stretch: &'a Stretch) -> Problem<'a> {
        let (wheel, start) = (Vector3::new(0.05, 0.1, -0.02), Vector3::new(0.5, 0.8, -0.4));
        let track = Track { stretch, middle: 9.0, wheel, start, weight: 0.5 };
        let pull = DMatrix::from_fn(10, 10, |i, k| if i == k { 3.0 } else { 0.25 });
        Problem { tracks: vec![track], weak, variance: 1e-6, pull }
    }

    fn model(weak: &WeakEstimate) -> Model {
        Model { at: weak.at.clone(), starts: vec![Vector3::new(0.5, 0.8, -0.4)] }
    }

    /// With one of its numbers larger by so much: five columns, five coordinates and a start.
    fn moved(from: &Model, k: usize, by: f64) -> Model {
        let mut model = from.clone();
        match k {
            0..5 => model.at.c[k] += by,
            5..10 => model.at.x[k - 5] += by,
            _ => model.starts[0][k - 10] += by,
        }
        model
    }

    /// The squares of a stretch fall by twice their gradient, and about the motion itself they are the quadratic form of their matrix.
    #[test]
    fn sums_of_wheels_are_those_of_differences() {
        let weak = weak();
        let exact = stretch(&weak, 0.0);
        let of_exact = problem(&weak, &exact);
        let here = model(&weak);
        let squares = |all: &Problem<'_>, at: &Model| all.left(at, 3.0).unwrap()[0].squares;
        let form = of_exact.sums(&here, 3.0).unwrap().remove(0);
        // both ends of the window belong to it
        assert_eq!((form.samples, form.squares), (49, 0.0));
        let noisy = stretch(&weak, 0.05);
        let of_noisy = problem(&weak, &noisy);
        let sums = of_noisy.sums(&here, 3.0).unwrap().remove(0);
        assert!((sums.squares / squares(&of_noisy, &here) - 1.0).abs() < 1e-12);
        let h = 1e-5;
        for k in 0..13 {
            let [above, below] = [h, -h].map(|h| squares(&of_noisy, &moved(&here, k, h)));
            let slope = (above - below) / (2.0 * h);
            let near = 1e-3 * sums.gradient.amax();
            assert!((slope + 2.0 * sums.gradient[k]).abs() < near, "{k}: {slope} {}", sums.gradient[k]);
            for other in 0..=k {
                let both = |by: f64| squares(&of_exact, &moved(&moved(&here, k, h), other, by));
                let mixed = (both(h) - both(-h)) / (4.0 * h * h);
                assert_eq!(form.matrix[(k, other)], form.matrix[(other, k)]);
                let apart = (mixed - form.matrix[(k, other)]).abs();
                assert!(apart < 1e-2 * form.matrix.amax(), "{k} {other}: {mixed}");
            }
        }
    }

    /// Priors of the columns and the pull of the weak estimate are squares beside those of the readings; damping grows the diagonal.
    #[test]
    fn priors_and_pull_are_squares_beside_the_readings() {
        let weak = weak();
        let exact = stretch(&weak, 0.0);
        let all = Problem { variance: 0.25, ..problem(&weak, &exact) };
        let here = (0..10).fold(model(&weak), |at, k| moved(&at, k, 0.01 * (k as f64 - 4.5)));
        for is_pulled in [true, false] {
            let (information, gradient) = all.reduced(&[], &here, 0.0, is_pulled).unwrap();
            // priors of 0.05 of the offset and of 0.02 of the scale, none of the wheels
            let priors = [0.0, 400.0, 400.0, 400.0, 2500.0];
            for k in 0..10 {
                let beside = |by: f64| all.beside(&moved(&here, k, by), is_pulled);
                let slope = (beside(0.125) - beside(-0.125)) / 0.25;
                let near = 1e-9 * gradient.amax().max(1.0);
                assert!((slope + 2.0 * gradient[k]).abs() < near, "{k}: {slope} {}", gradient[k]);
                let own = priors.get(k).map_or(0.0, |prior| 0.25 * prior);
                let expected = own + if is_pulled { 3.0 } else { 0.0 };
                assert!((information[(k, k)] - expected).abs() < 1e-9, "{k}");
            }
            let (damped, _) = all.reduced(&[], &here, 0.5, is_pulled).unwrap();
            assert!((damped[(1, 1)] / information[(1, 1)] - 1.5).abs() < 1e-12);
            assert_eq!(damped[(1, 2)], information[(1, 2)]);
        }
    }

    /// A stretch begins with the rate in its middle, at the reading less its noise. Wheels have the mean of their momenta where these change by
    /// no more than 0.3 of the smallest moment in √(n/(white variance)) of 1.2 times them, and no torque is known.
    #[test]
    fn a_stretch_has_the_mean_of_its_wheels() {
        let (weak, count) = (weak(), 33);
        let least = eigen(tensor(&weak.at.x)).0[0];
        let times: Vec<f64> = (0..33).map(|k| 1.0 + 0.25 * f64::from(k)).collect();
        let rates: Vec<Vector3<f64>> = (0..33).map(|k| Vector3::new(0.1 * f64::from(k), 0.5, -0.4)).collect();
        let mut noise = vec![Vector3::<f64>::zeros(); count];
        noise[16] = Vector3::new(0.5, -0.1, 0.2);
        let mean: Vector3<f64> = Vector3::new(0.05, 0.1, -0.02);
        // √(33/(8.25 · 0.25)) = 4
        let (white, variance) = (8.25, 0.25);
        let plain = Stretch::new(times, rates);
        let tests = TestFunctions::new(&plain, 1.0).unwrap();
        let with = |change: f64, torque: f64| {
            let (mut wheel, mut pushed) = (vec![mean; count], vec![Vector3::<f64>::zeros(); count]);
            wheel[0].x += change;
            wheel[32].x -= change;
            pushed[7].z = torque;
            Stretch { inputs: Some(KnownInputs { wheel, torque: pushed }), ..plain.clone() }
        };
        let part = |stretch: &Stretch| Part {
            stretch: 0,
            linearised: Linearised::new(stretch, &noise, &weak.columns, weak.at.clone(), tests.clone()),
            rows: Vec::new(),
            left: Vec::new(),
            levels: Levels { white, ..Levels::WHITE },
            log_determinant: 0.0,
            noise: noise.clone(),
        };
        let limit = 0.3 * least / (1.2 * 4.0);
        let steady = with(0.99 * limit, 0.0);
        let found = Track::new(&steady, &part(&steady), &weak, variance).unwrap();
        assert!((found.wheel - mean).amax() < 1e-15 && found.middle == 5.0 && found.weight == 1.0 / white);
        // an error of scale of 0.015 and three offsets
        let start = Vector3::new(1.6 - 0.5, 0.5 + 0.1, -0.4 - 0.2) * 1.015 - Vector3::new(0.01, -0.02, 0.03);
        assert!((found.start - start).amax() < 1e-14, "{}", found.start);
        assert_eq!(found.reach(), 4.0);
        for other in [with(1.01 * limit, 0.0), with(0.0, 1e-9), plain.clone()] {
            assert!(Track::new(&other, &part(&other), &weak, variance).is_none());
        }
    }

    /// From near it the search comes to rest at the motion of the readings, and one step tells what it gains.
    #[test]
    fn a_search_ends_at_the_motion_of_the_readings() {
        let weak = weak();
        let exact = stretch(&weak, 0.0);
        // priors that say next to nothing
        let all = Problem { variance: 1e-16, ..problem(&weak, &exact) };
        let off = (0..13).fold(model(&weak), |at, k| moved(&at, k, if k % 2 == 0 { 1e-7 } else { -1e-7 }));
        let sums = all.sums(&off, f64::INFINITY).unwrap();
        let (next, gain) = all.step(&sums, &off, 0.0, false).unwrap();
        // all of it but what the first order leaves
        assert!((gain / sums[0].squares - 1.0).abs() < 0.05, "{gain:e} {:e}", sums[0].squares);
        let apart = |at: &Model| {
            let own = all.apart(at).amax();
            own.max((at.starts[0] - all.tracks[0].start).amax())
        };
        assert!(apart(&next) < 0.2 * apart(&off), "{:e}", apart(&next));
        // windows that double go from there too, the estimate off by as much
        let near = WeakEstimate { at: off.at.clone(), ..self::weak() };
        let grown = Problem { weak: &near, variance: 1e-16, ..problem(&weak, &exact) }.grow().unwrap();
        assert!(apart(&grown) < 1e-8, "{:e}", apart(&grown));
        let (found, is_still) = all.settle(off, f64::INFINITY, false).unwrap();
        assert!(is_still && apart(&found) < 1e-8, "{:e}", apart(&found));
        // the wheels turn the momentum by 1.2 of theirs over the smallest moment
        let fastest = all.fastest(&all.tracks[0], &model(&weak));
        let expected: f64 = 1.2 * Vector3::new(0.05, 0.1, -0.02).norm() / eigen(tensor(&weak.at.x)).0[0];
        assert!((fastest / expected - 1.0).abs() < 1e-12);
    }

    /// The motion of the readings is a bottom at once, and a saddle, where only damped steps can be taken, is none.
    #[test]
    fn a_saddle_of_wheels_is_no_bottom() {
        let mut weak = weak();
        weak.at.c[1..].fill(0.0);
        let exact = stretch(&weak, 0.0);
        let (here, radius) = (model(&weak), 2.0);
        let plain = problem(&weak, &exact);
        let sums = plain.sums(&here, radius).unwrap();
        let (information, _) = plain.reduced(&sums, &here, 0.0, false).unwrap();
        let least = information.symmetric_eigenvalues().min();
        for (share, is_still) in [(0.5, true), (1.01, false)] {
            let pull = DMatrix::identity(10, 10) * (-share * least);
            let outwards = Problem { pull, ..problem(&weak, &exact) };
            let (found, still) = outwards.settle(here.clone(), radius, true).unwrap();
            assert!(still == is_still && found.at == here.at, "{share}");
        }
    }

    /// A weak estimate of a stretch with wheels, which leaves no residuals.
    fn estimated(stretch: &Stretch, at: &Unknowns) -> WeakEstimate {
        let base = weak();
        let (tests, noise) = (TestFunctions::new(stretch, 1.0).unwrap(), vec![Vector3::<f64>::zeros(); 129]);
        let linearised = Linearised::new(stretch, &noise, &base.columns, at.clone(), tests);
        let stacked = Some(Stacked::new(&[linearised.rows.as_slice()], &base.columns, at, 2e-4));
        let (rows, left, levels) = (Vec::new(), Vec::new(), Levels::WHITE);
        let part = Part { stretch: 0, linearised, rows, left, levels, log_determinant: 0.0, noise };
        WeakEstimate { at: at.clone(), stacked, rows: 100, parts: vec![part], ..base }
    }

    /// Next to a weak estimate the motion leaves the noise but for thirteen numbers. There is none where torque noise, a drag or a column of one
    /// stretch acts, where the weak equations or the motion leave more than noise, of another stretch, and far from the weak estimate.
    #[test]
    fn the_likeliest_unknowns_are_next_to_the_weak_ones() {
        let base = weak();
        let (free, noisy) = (stretch(&base, 0.0), stretch(&base, 1e-4));
        let inputs = KnownInputs {
            wheel: vec![Vector3::new(0.05, 0.1, -0.02); 129],
            torque: vec![Vector3::zeros(); 129],
        };
        let all = [Stretch { inputs: Some(inputs), ..noisy }];
        // twice the deviation of the noise
        let variance = 4e-8;
        // of 95 equations beyond the unknowns 1 + 5 √(2/95) = 1.73 is noise
        let with = |misfit: f64| {
            let squares = misfit * 95.0 * variance;
            WeakEstimate { squares, ..estimated(&all[0], &base.at) }
        };
        let found = likeliest(&all, &with(1.7), variance).unwrap();
        let squares: f64 = all[0].rates.iter().zip(&free.rates).map(|(a, b)| (a - b).norm_squared()).sum();
        let share = found.misfit * variance * (3 * 129 - 13) as f64 / squares;
        assert!((0.9..1.0).contains(&share), "{share}");
        assert!((found.at.x - base.at.x).amax() < 1e-2, "{:?}", found.at);
        assert_eq!(found.information.shape(), (10, 10));

        let refused = |change: &dyn Fn(&mut WeakEstimate)| {
            let mut weak = with(0.0);
            change(&mut weak);
            likeliest(&all, &weak, variance).is_none()
        };
        assert!(refused(&|weak| weak.parts[0].levels.torque = 0.1));
        assert!(refused(&|weak| weak.parts[0].stretch = 1));
        assert!(refused(&|weak| weak.columns[0] = weak.columns[0].of_segment(0)));
        assert!(refused(&|weak| weak.columns[1] = Column::new(Drag, None)));
        assert!(refused(&|weak| weak.squares = 1.8 * 95.0 * variance));
        assert!(likeliest(&all, &with(0.0), 0.1 * 1e-8).is_none());
        let far = Unknowns { x: base.at.x + Coordinates::repeat(4e-3), ..base.at.clone() };
        assert!(likeliest(&all, &estimated(&all[0], &far), variance).is_none());
    }
}
