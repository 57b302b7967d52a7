//! The report, drawn from the record, its weak estimate and the nearest physical tensor.

use crate::report::scale::{Noise, by_prior, check_constant, check_same, scale_of};
use nalgebra::{DMatrix, Matrix3, SMatrix, Vector3};
use polhode::inertia::Inertia;
use polhode::record::{Record, Spike};

use crate::bound::motions::Motions;
use crate::columns::column::{Unknowns, terms_of_all};
use crate::columns::effect::Class;
use crate::error::FitError;
use crate::models::equations::Equations;
use crate::physical::constraint::{ActiveConstraint, Constraint};
use crate::physical::coordinates::{ENTRIES, Form, entries_of_coordinates};
use crate::physical::dissipation::Dissipation;
use crate::physical::face::Nearest;
use crate::physical::failure::SolverFailure;
use crate::physical::law::LARGEST_SHARE;
use crate::physical::nearest::Normal;
use crate::physical::prior::Prior;
use crate::report::answer::{Answer, of_entries, ratios, ratios_at, shape_of, sigmas};
use crate::report::deviations::{Deviations, deviations};
use crate::report::differing::Differing;
use crate::report::estimate::{Estimate, Method, Residuals};
use crate::report::identifiability::Identifiability;
use crate::report::mirror::{mirror_sigmas, mirrored};
use crate::report::model::{as_well, models, reading_errors};
use crate::report::nuisance::{Agreement, FittedTorque, Nuisance, nuisances};
use crate::report::parts::{Scatter, instead, unseen};
use crate::report::segments::SegmentSummary;
use crate::report::suspect::{Suspect, refuted};
use crate::report::systematic::systematic;
use crate::report::torque_free::{InvariantTrend, Whiteness, trends};
use crate::report::warnings::{Grounds, warnings};
use crate::settings::Settings;
use crate::settings::torque::{TorqueModel, TorqueNoise};
use crate::signal::covariance::{Levels, torque_shape};
use crate::signal::filtered::filtered;
use crate::signal::noise;
use crate::signal::stretch::Stretch;
use crate::solve::joint::Joint;
use crate::solve::ladder::Chosen;
use crate::thresholds::noise::SURE;
use crate::units::{Motion, Others};

/// What the report is drawn from.
pub(crate) struct Facts<'a> {
    pub(crate) record: &'a Record,
    pub(crate) settings: &'a Settings,
    pub(crate) stretches: &'a [Stretch],
    pub(crate) rms: f64,
    pub(crate) variance: f64,
    pub(crate) chosen: &'a Chosen,
    pub(crate) misfit: f64,
    /// How far the parts of the record contradict each other.
    pub(crate) scatter: Option<Scatter>,
    /// The unknowns beside the tensor in which they differ.
    pub(crate) differing: Option<&'a Differing>,
    pub(crate) spikes: Vec<Spike>,
    /// Unit of the column of wheel momenta and torques, kg m².
    pub(crate) input: Option<f64>,
    pub(crate) joint: &'a Joint,
    /// What record and prior tell of the columns that are kept and the tensor.
    pub(crate) told: &'a Normal,
    pub(crate) per_segment: Vec<SegmentSummary>,
    /// Whether the weak estimate was moved to the largest likelihood on the exact motion with wheels.
    pub(crate) is_exact: bool,
    pub(crate) prior: Option<Agreement>,
    /// What the fit takes to be zero and would explain the record better.
    pub(crate) suspect: Option<&'a Suspect>,
    pub(crate) dissipation: &'a [Dissipation],
}

impl Facts<'_> {
    /// Everything that can be said of the answer.
    pub(crate) fn report(
        &self,
        nearest: Nearest,
        identifiability: Identifiability,
        motion: Option<&Motion>,
        open: Option<&Others>,
    ) -> Result<Estimate, FitError> {
        let weak = &self.chosen.weak;
        let limits = &self.settings.limits;
        let Deviations { free, on_face, together, held } =
            deviations(self.told, &self.joint.kept, limits, self.dissipation, &nearest)?;
        let Answer { shape, moments, axes, v } = Answer::new(&nearest.x)?;
        let j = shape.tensor();
        let (sigma_principal, sigma_axes) = sigmas(&on_face, &v, &moments);
        let ratios = ratios(&on_face, &v, &moments);
        let entries = entries_of_coordinates();
        // a motion under torques, or of other rates than those of the record, is not that of a free body
        let free_body = weak.columns.is_empty();
        let motions =
            free_body.then(|| Motions::nearest(self.stretches, &nearest.x, self.variance)).flatten();
        let of_motion = || Some((weak.root.transpose() * weak.root / self.variance).cholesky()?.inverse());
        let bound =
            if self.is_exact { of_motion() } else { motions.as_ref().and_then(|m| m.bound(self.variance)) };
        let statistical = self.statistical();
        let bound_ratio =
            bound.zip(statistical).filter(|_| self.prior.is_none()).map(|(b, own)| own / b.trace().sqrt());
        let covariance = on_face * on_face.transpose();
        let at = self.joint.unknowns(&nearest.others, nearest.x);
        let (inertia, inertia_covariance) =
            self.absolute(&j, &covariance, &together, motions.as_ref(), &at)?;
        let enlarged = self.enlarged();
        let terms = terms_of_all(&weak.columns, &at);
        let torque_noise = |stretch| self.torque_noise(stretch, &j);
        let (momentum, energy) = trends(self.stretches, |w| terms.rate(w), &j, enlarged, torque_noise);
        // wheels and torques change both
        let per_second = |d: InvariantTrend| {
            let (rate, sigma) = (d.rate * self.rms, d.sigma * self.rms);
            self.input.is_none().then_some(InvariantTrend { rate, sigma })
        };
        let residuals = self.residuals(&at);
        let (torques, sensor) = self.nuisances(&at, &held);
        let pull = nearest.pull;
        let systematic = |equations: &Equations| {
            systematic(weak, equations, self.stretches, &v, &moments.into(), self.variance, self.rms)
        };
        let lines = self.chosen.equations.as_ref().map(systematic).unwrap_or_default();
        let mut estimate = Estimate {
            principal: moments.into(),
            sigma_principal,
            axes,
            sigma_axes,
            ratios: ratios.map(|r| r.0),
            sigma_ratios: ratios.map(|r| r.1),
            covariance: of_entries(&on_face),
            free_covariance: of_entries(&free),
            bound: bound.map(|b| entries * b * entries.transpose()),
            bound_ratio,
            inertia,
            inertia_covariance,
            quanta: self.settings.quantum.map_or_else(|| self.record.quanta().into(), |quantum| [quantum; 3]),
            rms_rate: self.rms,
            noise_sigma: self.variance.sqrt() * self.rms,
            chi2_per_dof: self.misfit + pull * pull * self.misfit.max(1.0) / weak.dof().max(1) as f64,
            pull,
            dof: weak.dof(),
            samples: weak.parts.iter().map(|part| self.stretches[part.stretch].times.len()).sum(),
            segments: residuals.chunk_by(|a, b| a.segment == b.segment).count(),
            radius: Some(weak.radius / self.rms),
            method: if self.is_exact { Method::ExactMotionWithWheels } else { Method::WeakForm },
            attitudes: None,
            identifiability,
            triangle_slack: (2.0 * (LARGEST_SHARE - moments[2])).max(0.0),
            active_constraints: nearest.active.into_iter().map(|c| self.in_seconds(c)).collect(),
            certificate: nearest.certificate,
            momentum_trend: per_second(momentum),
            energy_trend: per_second(energy),
            whiteness: Whiteness::new(residuals.iter().map(|r| r.values.as_flattened())),
            torque: torques,
            models: models(&self.chosen.models, self.chosen.model, motion),
            reading_errors: reading_errors(&self.chosen.models, self.chosen.model),
            nuisances: sensor,
            systematic: lines,
            prior: self.prior,
            per_segment: self.per_segment.clone(),
            unexplained: motion.and_then(|motion| motion.unexplained(&j)),
            mirror: if self.input.is_none() { shape_of(&mirrored(&j)).ok() } else { None },
            sigma_mirror: self.input.is_none().then(|| mirror_sigmas(&nearest.x, &on_face)),
            unseen_change: unseen(weak, enlarged, &v),
            spikes: self.spikes.clone(),
            residuals,
            warnings: Vec::new(),
            shape,
        };
        let is_free = free_body && !weak.has_torque_noise();
        let left = motions.as_ref().map(|motions| motions.left).filter(|_| is_free);
        let size = self.size(&together, &at).map(|(_, size)| size);
        let rounding = self.record.rounding(&Vector3::from(estimate.quanta)) / self.rms / self.rms;
        // with wheels a motion is faster than the body turns
        let filtered = if self.input.is_none() { filtered(self.stretches, rounding) } else { None };
        let grounds = Grounds { size, filtered, ..self.grounds(open, left) };
        estimate.warnings = warnings(&estimate, &grounds);
        Ok(estimate)
    }

    /// Levels of the noise of a stretch.
    fn levels(&self, stretch: usize) -> Levels {
        let part = self.chosen.weak.parts.iter().find(|part| part.stretch == stretch);
        part.map_or(Levels::WHITE, |part| part.levels)
    }

    /// Density of the torque noise of a stretch.
    fn torque_noise(&self, stretch: usize, j: &Matrix3<f64>) -> Matrix3<f64> {
        let levels = self.levels(stretch);
        torque_shape(levels.shape, j) * (levels.torque * self.variance)
    }

    /// By how much the variance of the noise is enlarged: what it does not explain, and how far parts of the record contradict each other.
    fn excess(&self) -> f64 {
        self.misfit.max(1.0) * self.scatter.map_or(1.0, |scatter| scatter.excess())
    }

    /// Variance of the noise with what it does not explain.
    fn enlarged(&self) -> f64 {
        self.variance * self.misfit.max(1.0)
    }

    /// Root of the trace of the covariance under the chosen model alone.
    fn statistical(&self) -> Option<f64> {
        self.chosen.weak.root.try_inverse().map(|factor| factor.norm() * self.enlarged().sqrt())
    }

    /// What warnings are drawn from.
    fn grounds<'b>(&'b self, open: Option<&'b Others>, left: Option<(f64, f64)>) -> Grounds<'b> {
        let found = self.settings.torque == TorqueModel::Auto;
        let equations = self.chosen.equations.as_ref().filter(|_| found);
        Grounds {
            left,
            record: self.record,
            weak: &self.chosen.weak,
            misfit: self.misfit,
            variance: self.variance,
            open,
            contradicted: self.contradicted(),
            filtered: None,
            suspect: self.suspect,
            refuted: refuted(&self.chosen.weak, self.stretches, (self.variance, self.rms)),
            as_well: as_well(&self.chosen.models, self.chosen.model),
            instead: equations.and_then(|equations| instead(equations, self.chosen.model, self.enlarged())),
            scatter: self.scatter,
            differing: self.differing,
            found,
            noise_found: self.settings.torque_noise == TorqueNoise::Fitted,
            driven: self.input.is_some(),
            size: None,
        }
    }

    /// The noise that is stated, and the one that the readings show, rad/s, where they contradict each other.
    fn contradicted(&self) -> Option<(f64, f64)> {
        let stated = self.settings.noise?;
        let rounding = self.record.rounding(&self.record.quanta()) / self.rms / self.rms;
        let left = (self.misfit, self.chosen.weak.dof());
        let shown = noise::contradicting(self.stretches, self.variance, rounding, left)?;
        Some((stated, shown.sqrt() * self.rms))
    }

    /// The multiplier of a drag per unit of it in 1/s.
    fn in_seconds(&self, active: ActiveConstraint) -> ActiveConstraint {
        let unit = match active.constraint {
            Constraint::Drag { .. } => self.rms,
            _ => 1.0,
        };
        ActiveConstraint { multiplier: active.multiplier / unit, ..active }
    }

    fn absolute(
        &self,
        j: &Matrix3<f64>,
        covariance: &Form,
        together: &DMatrix<f64>,
        motions: Option<&Motions<'_>>,
        at: &Unknowns,
    ) -> Result<(Option<Inertia>, Option<SMatrix<f64, 6, 6>>), FitError> {
        if let Some(unit) = self.input {
            return self.by_inputs(j, unit, together, at);
        }
        let prior = self.settings.prior.as_ref().map(Prior::told).transpose()?.filter(|prior| prior.sized);
        let Some(known) = self.settings.known else {
            return prior.map_or(Ok((None, None)), |prior| by_prior(j, &prior, covariance, &at.x));
        };
        check_constant(known, &self.chosen.weak.columns)?;
        let scale = |stretches: &[Stretch], first: usize, variance: f64| {
            let scale = scale_of(known, stretches, self.rms, j, Noise { variance, is_in_rates: true });
            scale.walking(stretches, self.rms, |k| self.torque_noise(first + k, j))
        };
        let excess = self.excess();
        let of_segment = |segment: &[Stretch], first: usize| {
            scale(segment, first, self.levels(first).white * self.variance)
        };
        check_same(known, self.stretches, covariance, excess, of_segment)?;
        let scale = scale(self.stretches, 0, self.variance);
        let (inertia, covariance) = scale.sized(known, prior.as_ref(), j, covariance, excess, motions)?;
        Ok((Some(inertia), Some(covariance)))
    }

    /// The place among the columns that are kept of the factor u of wheel momenta and torques, and u in its standard deviations.
    fn size(&self, together: &DMatrix<f64>, at: &Unknowns) -> Option<(usize, f64)> {
        let is_input = |&k: &usize| self.chosen.weak.columns[k].class() == Class::Input;
        let place = self.joint.kept.iter().position(is_input)?;
        Some((place, at.c[self.joint.kept[place]] / together[(place, place)].sqrt()))
    }

    /// The absolute tensor J/u by wheel momenta and torques, where u stands out of its noise; `together` is the covariance
    /// of the columns that are kept and the tensor.
    fn by_inputs(
        &self,
        j: &Matrix3<f64>,
        unit: f64,
        together: &DMatrix<f64>,
        at: &Unknowns,
    ) -> Result<(Option<Inertia>, Option<SMatrix<f64, 6, 6>>), FitError> {
        let Some((place, _)) = self.size(together, at).filter(|(_, size)| *size > SURE) else {
            return Ok((None, None));
        };
        let u = at.c[self.joint.kept[place]];
        let trace = unit / u;
        let inertia =
            Inertia::from_tensor(j * trace).map_err(|error| FitError::Solver(SolverFailure::Scale(error)))?;
        // d(J/u) = dJ/u − J du/u²
        let entries = entries_of_coordinates();
        let first = self.joint.kept.len();
        let slope = DMatrix::from_fn(6, first + 5, |row, l| match l {
            l if l >= first => trace * entries[(row, l - first)],
            l if l == place => -trace * j[ENTRIES[row]] / u,
            _ => 0.0,
        });
        let covariance = &slope * together * slope.transpose();
        Ok((Some(inertia), Some(SMatrix::from_fn(|row, column| covariance[(row, column)]))))
    }

    /// The coefficients of the torque, and what was estimated of the sensor.
    fn nuisances(&self, at: &Unknowns, held: &[(usize, f64)]) -> (FittedTorque, Vec<Nuisance>) {
        let variance = self.variance * self.excess();
        let all = nuisances(&self.chosen.weak, &at.c, variance, self.rms, held, self.differing);
        let (torques, sensor) = all
            .into_iter()
            .filter(|n| n.column.class() != Class::Input)
            .partition(|n| n.column.class().is_torque());
        let ratios_without = self.chosen.without.as_ref().map(ratios_at);
        let torque = FittedTorque {
            model: self.chosen.model,
            is_chosen: self.settings.torque == TorqueModel::Auto,
            coefficients: torques,
            gain: self.chosen.gain,
            ratios_without,
        };
        (torque, sensor)
    }

    fn residuals(&self, at: &Unknowns) -> Vec<Residuals> {
        let deviation = self.variance.sqrt();
        let each = self.chosen.weak.parts.iter();
        each.map(|part| {
            let Stretch { segment, start, .. } = self.stretches[part.stretch];
            let e = part.residuals(at);
            let values = e.chunks_exact(3).map(|r| [r[0], r[1], r[2]].map(|v| v / deviation));
            let times = part.centres().iter().map(|c| start + c / self.rms).collect();
            Residuals::new(segment, times, values.collect())
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::column::Column;
    use crate::columns::drag::Drag;
    use crate::columns::input::Input;
    use crate::physical::coordinates::{Coordinates, coordinates, eigen, tensor};
    use crate::signal::covariance::Shape;
    use crate::solve::weak_estimate::WeakEstimate;
    use crate::solve::weak_estimate::tests::one_row_each;

    fn body() -> Matrix3<f64> {
        Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45)
    }

    /// Of a record in units of 2 rad/s with a drag and an input of 4 per unit, which are told with the weights 10 and 20, and a tensor that is told
    /// with 40, for noise of the variance 0.25; what `ask` asks of it where so much is left.
    fn asked<T>(misfit: f64, scatter: Option<Scatter>, ask: impl FnOnce(&Facts<'_>) -> T) -> T {
        let columns = [Column::new(Drag, None), Column::new(Input, None)];
        let at = Unknowns { x: coordinates(&body()), c: vec![0.1, 4.0] };
        let rows = one_row_each(&[10.0, 20.0, 40.0, 40.0, 40.0, 40.0, 40.0], &[0.0; 7]);
        let mut weak = WeakEstimate::of_rows(&columns, &at, vec![rows], 0.5);
        weak.parts[0].stretch = 1;
        weak.parts[0].levels = Levels { white: 2.0, torque: 3.0, shape: Shape::Alike };
        let joint = Joint::new(&weak, |column| column.class() == Class::Input, 0.5).unwrap();
        let (model, gain, without) = (TorqueModel::Drag, Some(9.0), Some(coordinates(&body())));
        let chosen = Chosen { weak, model, gain, without, models: Vec::new(), equations: None };
        ask(&Facts {
            record: &Record::default(),
            settings: &Settings::default(),
            stretches: &[],
            rms: 2.0,
            variance: 0.25,
            chosen: &chosen,
            misfit,
            scatter,
            differing: None,
            spikes: Vec::new(),
            input: Some(8.0),
            told: &joint.told,
            joint: &joint,
            per_segment: Vec::new(),
            is_exact: false,
            prior: None,
            suspect: None,
            dissipation: &[],
        })
    }

    /// Noise that does not explain the residuals is enlarged by what it leaves, and not where they are less; parts that scatter enlarge it further. Five
    /// numbers with the weight 40 have the deviation √5/40 of it, a drag with 10 a tenth of it.
    #[test]
    fn noise_is_enlarged_by_what_it_does_not_explain() {
        for (misfit, times) in [(0.5, 1.0), (1.2, 1.2), (3.0, 3.0)] {
            let deviation = f64::sqrt(5.0 * 0.25 * times) / 40.0;
            let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-6;
            asked(misfit, None, |facts| {
                assert!(
                    near(facts.enlarged(), 0.25 * times) && near(facts.statistical().unwrap(), deviation)
                );
                assert_eq!(facts.excess(), times);
            });
            let scatter = Some(Scatter { parts: 8, chi2: 140.0, dof: 35 });
            asked(misfit, scatter, |facts| {
                assert!(near(facts.enlarged(), 0.25 * times) && near(facts.excess(), 4.0 * times));
                let at = &facts.chosen.weak.at;
                let (torque, sensor) = facts.nuisances(at, &[]);
                let [drag] = &torque.coefficients[..] else { panic!("{torque:?}") };
                // in 1/s, and the input is none of them
                assert!(drag.name == "drag" && near(drag.value, 0.2) && sensor.is_empty(), "{drag:?}");
                assert!(near(drag.sigma, 2.0 * 0.05 * f64::sqrt(4.0 * times)), "{drag:?}");
                let (moments, _) = eigen(body());
                let [low, middle] = torque.ratios_without.unwrap();
                assert!(near(low, moments[0] / moments[2]) && near(middle, moments[1] / moments[2]));
                assert!(torque.is_chosen && torque.gain == Some(9.0));
            });
        }
    }

    /// The levels of a stretch are those of its part, and white of one without; torque noise alike along all axes has a ninth of its level, over the
    /// noise. A multiplier of drag is per 1/s.
    #[test]
    fn levels_and_multipliers_have_their_units() {
        asked(1.0, None, |facts| {
            assert_eq!((facts.levels(0), facts.levels(1).torque), (Levels::WHITE, 3.0));
            assert_eq!(facts.torque_noise(0, &body()), Matrix3::zeros());
            let expected = Matrix3::identity() * (3.0 * 0.25 / 9.0);
            assert!((facts.torque_noise(1, &body()) - expected).amax() < 1e-15);
            let of =
                |constraint| facts.in_seconds(ActiveConstraint { constraint, multiplier: 6.0 }).multiplier;
            assert_eq!((of(Constraint::Drag { name: "drag" }), of(Constraint::Triangle)), (3.0, 6.0));
        });
    }

    /// The tensor is J/u where u stands five deviations out of its noise, with the covariance of differences by u and by the tensor.
    #[test]
    fn a_tensor_by_inputs_has_the_covariance_of_its_quotient() {
        asked(1.0, None, |facts| {
            let (x, u, unit) = (coordinates(&body()), 4.0, 8.0);
            let at = Unknowns { x, c: vec![0.1, u] };
            let factor = DMatrix::from_fn(6, 6, |i, k| 1e-3 / (1.0 + ((3 * i + 2 * k) % 5) as f64));
            let together = &factor * factor.transpose();
            assert_eq!(facts.size(&together, &at), Some((0, u / together[(0, 0)].sqrt())));
            let (inertia, covariance) = facts.by_inputs(&body(), unit, &together, &at).unwrap();
            assert!((inertia.unwrap().tensor() - body() * 2.0).amax() < 1e-14);
            let moved = |k: usize, by: f64| {
                let step = Coordinates::from_fn(|i, _| by * factor[(i + 1, k)]);
                let j = tensor(&(x + step)) * (unit / (u + by * factor[(0, k)]));
                SMatrix::<f64, 6, 1>::from_fn(|row, _| j[ENTRIES[row]])
            };
            let expected: SMatrix<f64, 6, 6> = (0..6)
                .map(|k| (moved(k, 0.1) - moved(k, -0.1)) / 0.2)
                .map(|slope| slope * slope.transpose())
                .sum();
            assert!((covariance.unwrap() - expected).amax() < 1e-6 * expected.amax());
            for (deviations, is_told) in [(0.999 * SURE, false), (1.001 * SURE, true)] {
                let mut together = together.clone();
                together[(0, 0)] = (u / deviations) * (u / deviations);
                let (inertia, covariance) = facts.by_inputs(&body(), unit, &together, &at).unwrap();
                assert_eq!((inertia.is_some(), covariance.is_some()), (is_told, is_told));
            }
        });
    }
}
