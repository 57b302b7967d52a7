//! The profile of the likelihood along the wide axes of the ellipsoid of the tensor, walked to both ends.
//!
//! With x at s deviations along that direction and all else at its best, twice the log-likelihood falls by s² where it is quadratic. Near
//! a steady spin bodies of other moments may follow the samples nearly as well, along a path that bends: the likelihood falls by less, and
//! the ellipsoid of its second derivative is too small.
//!
//! Source: D. J. Venzon, S. H. Moolgavkar, Applied Statistics 37 (1988) 87.

use crate::likelihood::descent::{Problem, moved};
use crate::likelihood::sums::{Pull, Reduced};
use crate::likelihood::track::Model;
use crate::physical::coordinates::{Coordinates, Form, eigen};
use crate::thresholds::identifiability::VAGUE;
use crate::thresholds::likelihood::{END, FARTHEST, FIXED, HIGHER, NARROW, QUADRATIC, STRAIGHT, STRIDE};

/// What a walk found.
pub(crate) enum Profile {
    /// A model of higher likelihood.
    Higher(Box<Model>),
    /// The largest deviation by the second derivative, and displacements of x by which that ellipsoid is too small, as one deviation each.
    Beyond { deviation: f64, each: Vec<Coordinates> },
}

/// The profile about `model`, at which `problem` is least; `None` where the samples do not determine it.
pub(crate) fn profile(problem: &Problem<'_>, model: &Model) -> Option<Profile> {
    let (sums, least) = problem.sums(model)?;
    let form = Reduced::new(&sums)?.of_tensor()?;
    let (values, directions) = eigen(form);
    let deviation = |k: usize| 1.0 / values[k].sqrt();
    let mut each = Vec::new();
    if deviation(0) > VAGUE {
        // refused as it is
        return Some(Profile::Beyond { deviation: deviation(0), each });
    }
    for k in (0..5).filter(|&k| deviation(k) > NARROW) {
        let along = directions.column(k) * deviation(k);
        for direction in [along, -along] {
            let walk = Walk { problem, model, direction, least, form, information: values[k] };
            match walk.to_its_end() {
                Ok(beyond) => each.extend(beyond),
                Err(higher) => return Some(Profile::Higher(Box::new(higher))),
            }
        }
    }
    Some(Profile::Beyond { deviation: deviation(0), each })
}

/// The fall of twice the log-likelihood from `model` to the tensor `x`, all else at its best; `None` where there is no motion.
pub(crate) fn fall(problem: &Problem<'_>, model: &Model, x: &Coordinates) -> Option<f64> {
    let (sums, least) = problem.sums(model)?;
    let reduced = Reduced::new(&sums)?;
    let information = Form::identity() * (FIXED * eigen(reduced.of_tensor()?).0[4]);
    let pull = Some(Pull { information, centre: *x, drag: 0.0 });
    let held = Problem { pull, ..*problem }.settle(moved(model, &reduced.following(&(x - model.x))?))?;
    Some(problem.sums(&held.model)?.1 - least)
}

/// A walk from the most likely model.
struct Walk<'a> {
    problem: &'a Problem<'a>,
    model: &'a Model,
    /// Its length is one deviation.
    direction: Coordinates,
    /// The information along it, and on all.
    information: f64,
    form: Form,
    least: f64,
}

impl Walk<'_> {
    /// What lies beyond the ellipsoid, or a model of higher likelihood.
    fn to_its_end(&self) -> Result<Vec<Coordinates>, Model> {
        let (mut distance, mut end) = (END, None);
        let mut from = self.model.clone();
        while let Some((model, fall)) = self.settled(&from, distance) {
            if fall < -HIGHER {
                return Err(model);
            }
            if distance == END && fall >= QUADRATIC * END * END {
                return Ok(self.bend(&model.x).into_iter().collect());
            }
            from = model;
            end = Some(distance);
            if fall >= END * END || distance * self.direction.norm() > FARTHEST {
                break;
            }
            distance *= STRIDE;
        }
        let Some(distance) = end else { return Ok(Vec::new()) };
        // the path bends: its middle lies off the chord
        let middle = self.settled(self.model, 0.5 * distance).map(|(model, _)| model.x);
        let each = [Some(from.x), middle].into_iter().flatten();
        Ok(each.map(|x| (x - self.model.x) / END).collect())
    }

    /// The way off the axis at the end of a walk, so much of it that the ellipsoid reaches the path.
    fn bend(&self, end: &Coordinates) -> Option<Coordinates> {
        let (unit, way) = (self.direction.normalize(), end - self.model.x);
        let off = way - unit * unit.dot(&way);
        (off.dot(&(self.form * off)) > STRAIGHT).then(|| off * (2.0 / END))
    }

    /// The model at `distance`, all else at its best, from one nearby; and by how much twice the log-likelihood has fallen.
    fn settled(&self, from: &Model, distance: f64) -> Option<(Model, f64)> {
        let at = self.model.x + self.direction * distance;
        let unit = self.direction.normalize();
        let (sums, _) = self.problem.sums(from)?;
        let step = Reduced::new(&sums)?.following(&(unit * unit.dot(&(at - from.x))))?;
        let information = unit * unit.transpose() * (FIXED * self.information);
        let pull = Some(Pull { information, centre: at, drag: 0.0 });
        let model = Problem { pull, ..*self.problem }.settle(moved(from, &step))?.model;
        let (_, cost) = self.problem.sums(&model)?;
        Some((model, cost - self.least))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::descent::Levels;
    use crate::likelihood::growth::search;
    use crate::likelihood::track::Track;
    use crate::physical::coordinates::coordinates;
    use crate::simulate::simulate;
    use nalgebra::{Matrix3, Vector3};
    use polhode::inertia::Inertia;
    use polhode::num::Random;
    use polhode::rotation::Quat;

    /// The way off the axis of a walk counts where the quadratic form makes more than 1 of it, twice over the end of the walk.
    #[test]
    fn a_walk_bends_by_its_way_off_the_axis() {
        let x = Coordinates::new(0.01, 0.02, 0.03, 0.04, 0.05);
        let alignment = Quat::identity();
        let model = Model { x, alignment, is_aligned: false, drag: None, starts: Vec::new() };
        let levels = Levels { attitude: 1.0, rate: 1.0 };
        let problem = Problem { tracks: &[], levels, radius: f64::INFINITY, pull: None };
        let direction = Coordinates::new(0.0, 0.5, 0.0, 0.0, 0.0);
        let form = Form::identity() * 100.0;
        let walk = Walk { problem: &problem, model: &model, direction, information: 4.0, form, least: 0.0 };
        let end = |off: f64| x + Coordinates::new(0.0, 3.0, off, 0.0, 0.0);
        let found = walk.bend(&end(0.11)).unwrap();
        let expected = Coordinates::new(0.0, 0.0, 0.22 / END, 0.0, 0.0);
        assert!((found - expected).amax() < 1e-15, "{found}");
        assert!(walk.bend(&end(0.09)).is_none());
    }

    /// Where the likelihood is quadratic it falls by the squares of the deviations. Counted from half of the fall at the end of a walk it falls
    /// too slowly there, and by enough half as far again: this and the middle of the way are told. Counted from more than that fall, the end
    /// is another maximum.
    #[test]
    fn walks_end_where_the_likelihood_has_fallen_by_enough() {
        let j = Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45);
        let times: Vec<f64> = (0..200).map(|k| 0.1 * f64::from(k) - 10.0).collect();
        let (body, begin) = (Inertia::from_tensor(j).unwrap(), Vector3::new(0.5, 0.8, -0.4));
        let rates = simulate(&body, begin, &times, 1e-4, &mut Random::new(4)).unwrap();
        let tracks = [Track { attitudes: Vec::new(), rates, used: vec![true; 200], times }];
        let levels = Levels { attitude: 0.0, rate: 1e-4 };
        let found = search(&tracks, coordinates(&j), Quat::identity(), levels, false).unwrap();
        let (tracks, levels) = (&found.tracks[..], found.levels);
        let problem = Problem { tracks, levels, radius: f64::INFINITY, pull: None };
        let (sums, cost) = problem.sums(&found.model).unwrap();
        let form = Reduced::new(&sums).unwrap().of_tensor().unwrap();
        let (values, directions) = eigen(form);
        let direction = directions.column(0) / values[0].sqrt();
        let walk = |raised: f64| {
            let (information, least) = (values[0], cost + raised);
            Walk { problem: &problem, model: &found.model, direction, information, form, least }
        };
        for s in [-2.0, 3.0] {
            let (model, fall) = walk(0.0).settled(&found.model, s).unwrap();
            assert!((fall / (s * s) - 1.0).abs() < 0.05, "{s}: {fall}");
            assert!((model.x - found.model.x - direction * s).norm() < 0.1 * direction.norm(), "{s}");
        }
        assert!(walk(0.0).to_its_end().is_ok_and(|beyond| beyond.is_empty()));
        let Ok(beyond) = walk(0.5 * END * END).to_its_end() else { panic!() };
        assert_eq!(beyond.len(), 2);
        for (own, share) in beyond.iter().zip([1.5, 0.75]) {
            assert!((own - direction * share).norm() < 0.1 * direction.norm(), "{own} {direction}");
        }
        let Err(other) = walk(1.2 * END * END).to_its_end() else { panic!() };
        assert!((other.x - found.model.x - direction * END).norm() < 0.1 * END * direction.norm());
    }
}
