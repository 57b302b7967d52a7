//! Coning in closed form, beside the optimal coning algorithms of the literature.

use core::f64::consts::TAU;

use polhode::num::Real;
use polhode::rotation::{Quat, Vec3};
use polhode::strapdown::{Kind, Rule, Strapdown};
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure};
use polhode_pages::table::{Column, Table, row};

use crate::experiment::{Context, Report};

/// Half angles of the cone, rad: the coefficients of the literature are for small ones, where rounding hides drifts below 1e-10.
const AMPLITUDES: [f64; 2] = [1e-3, 0.02];

/// Coning frequency over sampling frequency, in thousandths: whole cycles fit into the record.
const RATIOS: [u32; 12] = [1, 2, 5, 10, 20, 50, 100, 150, 200, 250, 300, 400];

/// Coefficients c_i of `Φ = Σ θ_i + (Σ c_i θ_i) × θ_N` over N increments, optimal for coning.
///
/// N = 2 and 3: Miller, J. Guidance 6 (1983) 287, in the form of Ignagni, J. Guidance Control Dyn. 19 (1996) 424; N = 4 and 5: Lee, Yoon,
/// Mark, Tazartes, J. Guidance 13 (1990) 490, and Park, Kim, Lee, Chung, J. Guidance Control Dyn. 22 (1999) 165. Their leading errors,
/// of order 2N + 1 in the coning angle of a sample, are checked below.
const OPTIMAL: [&[f64]; 4] = [
    &[2.0 / 3.0],
    &[9.0 / 20.0, 27.0 / 20.0],
    &[54.0 / 105.0, 92.0 / 105.0, 214.0 / 105.0],
    &[250.0 / 504.0, 525.0 / 504.0, 650.0 / 504.0, 1375.0 / 504.0],
];

/// How attitudes are found.
#[derive(Clone, Copy)]
enum Way {
    Rule(Kind, Rule),
    Coefficients(&'static [f64]),
}

/// Pure coning: `q(t) = (cos a/2, sin a/2 cos Ωt, sin a/2 sin Ωt, 0)` a sample every second.
#[derive(Clone, Copy)]
struct Coning {
    amplitude: f64, // a
    rate: f64,      // Ω
}

impl Coning {
    fn attitude(self, t: f64) -> Quat<f64> {
        let (half_sin, half_cos) = Real::sin_cos(0.5 * self.amplitude);
        let (sin, cos) = Real::sin_cos(self.rate * t);
        Quat::new(half_cos, Vec3([half_sin * cos, half_sin * sin, 0.0]))
    }

    /// ω = Ω (−sin a sin Ωt, sin a cos Ωt, −2 sin² a/2), body axes.
    fn omega(self, t: f64) -> Vec3<f64> {
        let (tilt, half) = (Real::sin_cos(self.amplitude).0, Real::sin_cos(0.5 * self.amplitude).0);
        let (sin, cos) = Real::sin_cos(self.rate * t);
        Vec3([-tilt * sin, tilt * cos, -2.0 * half * half]) * self.rate
    }

    /// ∫ω dt over the second before t.
    fn increment(self, t: f64) -> Vec3<f64> {
        let (tilt, half) = (Real::sin_cos(self.amplitude).0, Real::sin_cos(0.5 * self.amplitude).0);
        // differences of cosines and sines as products, without cancellation
        let chord = 2.0 * Real::sin_cos(0.5 * self.rate).0 * tilt;
        let (sin, cos) = Real::sin_cos(self.rate * (t - 0.5));
        Vec3([-chord * sin, chord * cos, -2.0 * half * half * self.rate])
    }

    /// Error of the attitude about the axis of the cone after `samples` s, over the turn about it that coning would have made
    /// unseen: `Ω (1 − cos a) t`.
    fn drift(self, attitude: Quat<f64>, samples: u32) -> f64 {
        let t = f64::from(samples);
        let error = (attitude * self.attitude(t).conjugate()).logarithm();
        let half = Real::sin_cos(0.5 * self.amplitude).0;
        error[2].abs() / (2.0 * half * half * self.rate * t)
    }

    fn by(self, way: Way, samples: u32) -> Result<f64, Error> {
        match way {
            Way::Rule(kind, rule) => self.by_rule(kind, rule, samples),
            Way::Coefficients(coefficients) => Ok(self.by_coefficients(coefficients, samples)),
        }
    }

    fn by_rule(self, kind: Kind, rule: Rule, samples: u32) -> Result<f64, Error> {
        let mut strapdown = Strapdown::new(kind, rule, self.attitude(0.0)).map_err(unexpected)?;
        for k in 0..=samples {
            let t = f64::from(k);
            let reading = if kind == Kind::Rate { self.omega(t) } else { self.increment(t) };
            strapdown.push(t, reading).map_err(unexpected)?;
        }
        strapdown.finish();
        Ok(self.drift(strapdown.attitude(), samples))
    }

    fn by_coefficients(self, coefficients: &[f64], samples: u32) -> f64 {
        let count = coefficients.len() as u32 + 1;
        let mut attitude = self.attitude(0.0);
        for first in (0..samples).step_by(count as usize) {
            let increments: Vec<Vec3<f64>> =
                (1..=count).map(|k| self.increment(f64::from(first + k))).collect();
            let sum = increments.iter().fold(Vec3::zero(), |sum, next| sum + *next);
            let lever = increments.iter().zip(coefficients);
            let lever = lever.fold(Vec3::zero(), |sum, (next, c)| sum + *next * *c);
            let last = increments[increments.len() - 1];
            attitude = (attitude * Quat::exponential(sum + lever.cross(last))).normalized();
        }
        self.drift(attitude, samples)
    }
}

pub(super) fn coning(context: &Context, report: &mut Report) -> Result<(), Error> {
    // a multiple of 1000 and of 2, 3, 4 and 5
    let samples = context.scale.pick(6_000, 6_000, 60_000);
    let magnus = |order, count| Rule::magnus(order, count).map_err(unexpected);
    let mut rules =
        vec![("rate", Kind::Rate, Rule::Trapezoid), ("increment", Kind::Increment, Rule::Trapezoid)];
    for (order, count) in [(4, 4), (6, 6), (6, 8), (6, 12)] {
        rules.push(("rate", Kind::Rate, magnus(order, count)?));
        rules.push(("increment", Kind::Increment, magnus(order, count)?));
    }
    let mut table = Table::new(
        "coning",
        "Pure coning: drift about the axis of the cone, over the drift of a rule that does not see the coning, by the ratio of coning to \
         sampling frequency.",
        vec![
            Column::new("amplitude", "rad", "half angle of the cone"),
            Column::new("readings", "", "what a reading is"),
            Column::new("rule", "", "rule, or optimal:N for N increments with published coefficients"),
            Column::new("ratio", "", "coning frequency over sampling frequency"),
            Column::new("drift", "", "relative drift").digits(2),
        ],
    );
    let mut figure = Figure::log_log(
        "coning",
        "Relative drift from increments on a cone of 0.02 rad: optimal:N with published coefficients, magnus:P,N as here",
        "coning frequency over sampling frequency",
        "relative drift",
    );
    for amplitude in AMPLITUDES {
        let motions = RATIOS.map(|thousandths| {
            let ratio = f64::from(thousandths) / 1000.0;
            (ratio, Coning { amplitude, rate: TAU * ratio })
        });
        let ways = rules.iter().map(|(name, kind, rule)| (*name, rule.to_string(), Way::Rule(*kind, *rule)));
        let published = OPTIMAL.iter().map(|coefficients| {
            ("increment", format!("optimal:{}", coefficients.len() + 1), Way::Coefficients(coefficients))
        });
        let ways: Vec<(&str, String, Way)> = ways.chain(published).collect();
        let curves = context.in_parallel(ways, |(name, rule, way)| {
            let points = motions.iter().map(|(x, motion)| Ok((*x, motion.by(way, samples)?)));
            Ok((name, rule, points.collect::<Result<Vec<_>, Error>>()?))
        });
        let curves = curves.into_iter().collect::<Result<Vec<_>, Error>>()?;
        for (name, rule, points) in curves {
            points.iter().for_each(|(x, drift)| table.push(row![amplitude, name, &*rule, *x, *drift]));
            if amplitude == AMPLITUDES[1] && name == "increment" {
                figure.series.push(Curve::new(rule, points));
            }
        }
    }
    report.tables.push(table);
    report.figures.push(figure);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_coefficients_have_their_order() {
        // θ_i × θ_{i+k} = 2 a² (1 − cos λ) sin kλ along the axis, and ½ ∫ α × ω dt = ½ a² (Nλ − sin Nλ) is to be had
        for coefficients in OPTIMAL {
            let count = coefficients.len() + 1;
            let missed = |angle: f64| {
                let terms = coefficients.iter().enumerate();
                let term = |(i, c): (usize, &f64)| c * Real::sin_cos((count - 1 - i) as f64 * angle).0;
                let sum: f64 = terms.map(term).sum();
                let whole = count as f64 * angle;
                let half = Real::sin_cos(0.5 * angle).0;
                (4.0 * half * half * sum - 0.5 * (whole - Real::sin_cos(whole).0)).abs()
            };
            let order = libm::log2(missed(0.4) / missed(0.2));
            assert!((order - (2 * count + 1) as f64).abs() < 0.5, "{count}: {order}");
        }
    }

    #[test]
    fn rates_are_those_of_the_attitude() {
        let motion = Coning { amplitude: 0.02, rate: 0.3 };
        for t in [0.0, 1.7, 20.0] {
            let h = 1e-4;
            let turn = motion.attitude(t - h).conjugate() * motion.attitude(t + h);
            let rate = turn.logarithm() * (0.5 / h);
            assert!((rate - motion.omega(t)).norm() < 1e-9);
        }
        let sum = (1..=10).fold(Vec3::zero(), |sum, k| sum + motion.increment(f64::from(k)));
        let simpson = (0..1000).fold(Vec3::zero(), |sum, k| {
            let t = 0.01 * f64::from(k);
            sum + (motion.omega(t) + motion.omega(t + 0.005) * 4.0 + motion.omega(t + 0.01)) * (0.01 / 6.0)
        });
        assert!((sum - simpson).norm() < 1e-12);
    }
}
