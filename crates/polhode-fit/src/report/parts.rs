//! Whether the parts of a record have the same tensor: both sides of a cut, and all parts of equal length.

use nalgebra::Vector3;

use crate::columns::sets::torque_columns;
use crate::models::equations::Equations;
use crate::physical::coordinates::{Coordinates, Form, eigen, pair, tensor};
use crate::physical::law::LARGEST_SHARE;
use crate::settings::torque::TorqueModel;
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::rounds::BEYOND;
use crate::thresholds::stacked::ITERATIONS;
use crate::thresholds::warnings::{AS_WELL, CUTS, HALVES, OPEN, SCATTERED, SEEN};

/// Two tensors of one record that contradict each other, cut where they do so most.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halves {
    /// Share of the equations before the cut: an eighth or a multiple of it.
    pub share: f64,
    /// Principal moments by the equations before the cut, ascending, as shares of the trace.
    pub first: [f64; 3],
    /// The same by those after it.
    pub second: [f64; 3],
    /// Square of their distance in standard deviations of it: χ² of five degrees of freedom where both are right.
    pub chi2: f64,
}

/// The tensors of both parts, where they differ by more than chance brings; `variance` is that of the noise with what it does
/// not explain.
pub(crate) fn halves(weak: &WeakEstimate, variance: f64) -> Option<Halves> {
    let each = (1..CUTS).filter_map(|k| parts(weak, variance, k as f64 / CUTS as f64));
    each.max_by(|a, b| a.chi2.total_cmp(&b.chi2)).filter(|most| most.chi2 > HALVES)
}

/// The tensors of the segments before a border and of those after it, where these without a torque explain the record as well as a torque along
/// three axes, each by its log-likelihood less one for every unknown; and their log-likelihood less that of the torque. `variance` as above.
///
/// Both are by the equations of one estimate, to first order. Parts that leave the tensor open, or tell one of no body, explain nothing.
pub(crate) fn instead(equations: &Equations, torque: TorqueModel, variance: f64) -> Option<(Halves, f64)> {
    if !matches!(torque, TorqueModel::Constant | TorqueModel::Drag3) {
        return None;
    }
    let none = equations.of(TorqueModel::None);
    let (share, parts) = none.parted()?;
    let apart: f64 = parts.iter().map(|part| part.squares).sum();
    let chi2 = (none.stacked().squares - apart) / variance;
    let gain = 0.5 * (equations.of(torque).stacked().squares - apart) / variance;
    // a second tensor, with columns of its own
    let more = (5 + parts[0].own.nrows()) as f64 - torque_columns(torque).len() as f64;
    let of = |part: &Stacked| Some(eigen(tensor(&part.minimiser()?.x)).0.into());
    let (first, second): ([f64; 3], [f64; 3]) = (of(&parts[0])?, of(&parts[1])?);
    let is_of_body = |moments: &[f64; 3]| moments[0] > 0.0 && moments[2] - LARGEST_SHARE <= BEYOND;
    let is_likely = chi2 > HALVES && gain - more > -AS_WELL;
    let are_bodies = is_of_body(&first) && is_of_body(&second);
    (is_likely && are_bodies).then_some((Halves { share, first, second, chi2 }, gain))
}

/// The tensors of the parts of a record, each by itself, contradict each other.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// Parts of the same number of equations that tell anything of the tensor.
    pub parts: usize,
    /// Square of their distances from their weighted mean, in standard deviations.
    pub chi2: f64,
    /// Its degrees of freedom.
    pub dof: usize,
}

impl Scatter {
    /// By how much the variance of the answer is enlarged.
    pub(crate) fn excess(&self) -> f64 {
        self.chi2 / self.dof as f64
    }
}

/// How the tensors of all parts scatter, where that is more than chance brings; `variance` as above.
pub(crate) fn scatter(weak: &WeakEstimate, variance: f64) -> Option<Scatter> {
    let each = (0..CUTS).map(|k| stacked(weak, variance, [k, k + 1].map(|k| k as f64 / CUTS as f64)));
    let each = each.collect::<Option<Vec<Stacked>>>()?;
    let each: Vec<(Form, Coordinates)> = each.iter().map(|part| (part.root, part.left())).collect();
    let scatter = scattered(&each, variance)?;
    (scatter.chi2 > quantile(scatter.dof as f64, SCATTERED)).then_some(scatter)
}

/// How parts |R x + z|² scatter about the x that is best for all. Of a part that leaves numbers open the others count.
fn scattered(parts: &[(Form, Coordinates)], variance: f64) -> Option<Scatter> {
    let total: Form = parts.iter().map(|(root, _)| root.transpose() * root).sum();
    let right: Coordinates = parts.iter().map(|(root, z)| root.transpose() * z).sum();
    let step = total.cholesky()?.solve(&-right);
    let (mut scatter, mut numbers) = (Scatter { parts: 0, chi2: 0.0, dof: 0 }, 0);
    for (root, z) in parts {
        let svd = root.try_svd(true, false, f64::EPSILON, ITERATIONS)?;
        // what is left outside of the range of R no x removes
        let (left, u, most) = (root * step + z, svd.u?, svd.singular_values.max());
        let told = (0..5).filter(|&k| svd.singular_values[k] > OPEN * most);
        let squares: Vec<f64> = told.map(|k| u.column(k).dot(&left)).map(|part| part * part).collect();
        scatter.chi2 += squares.iter().sum::<f64>() / variance;
        scatter.parts += usize::from(!squares.is_empty());
        numbers += squares.len();
    }
    scatter.dof = numbers.checked_sub(5).filter(|dof| *dof > 0)?;
    Some(scatter)
}

/// The value that chi squared exceeds as rarely as a normal deviate exceeds `z` standard deviations.
///
/// Source: E. B. Wilson and M. M. Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684.
pub(crate) fn quantile(dof: f64, z: f64) -> f64 {
    let variance = 2.0 / (9.0 * dof);
    let root = 1.0 - variance + z * variance.sqrt();
    dof * root * root * root
}

/// The normal deviate that is exceeded as rarely as a ratio of two mean squares with these degrees of freedom.
///
/// Source: E. Paulson, Ann. Math. Stat. 13 (1942) 233.
pub(crate) fn deviate_of_ratio(ratio: f64, dof: [f64; 2]) -> f64 {
    let [above, below] = dof.map(|dof| 2.0 / (9.0 * dof));
    let root = libm::cbrt(ratio);
    ((1.0 - below) * root - (1.0 - above)) / (above + below * root * root).sqrt()
}

/// The change of each principal moment, along these axes, from one half of a record to the other that may go unseen: of a larger one, whatever
/// else changes, the halves contradict each other in 999 of 1,000 records. `variance` as above.
///
/// With the covariance C of the difference of both tensors a change d is √(dᵀ C⁻¹ d) deviations large, and all d that change a moment by δ = gᵀ d
/// at least δ/√(gᵀ C g).
pub(crate) fn unseen(weak: &WeakEstimate, variance: f64, axes: &[Vector3<f64>; 3]) -> Option<[f64; 3]> {
    let (_, covariance) = sides(weak, variance, 0.5)?;
    Some([0, 1, 2].map(|k| {
        let slope = pair(&axes[k], &axes[k]);
        (SEEN * slope.dot(&(covariance * slope)).sqrt()).min(LARGEST_SHARE)
    }))
}

/// Both tensors, the record being cut after a share of the equations, and their contradiction.
fn parts(weak: &WeakEstimate, variance: f64, share: f64) -> Option<Halves> {
    let ([one, other], both) = sides(weak, variance, share)?;
    let apart = one - other;
    let chi2 = apart.dot(&both.cholesky()?.solve(&apart));
    let moments = |x: &Coordinates| eigen(tensor(x)).0.into();
    Some(Halves { share, first: moments(&one), second: moments(&other), chi2 })
}

/// Both tensors, and the covariance of their difference.
fn sides(weak: &WeakEstimate, variance: f64, share: f64) -> Option<([Coordinates; 2], Form)> {
    let (one, of_one) = solved(weak, variance, [0.0, share])?;
    let (other, of_other) = solved(weak, variance, [share, 1.0])?;
    Some(([one, other], of_one.cholesky()?.inverse() + of_other.cholesky()?.inverse()))
}

/// The tensor by the equations between two shares of them, and its information.
fn solved(weak: &WeakEstimate, variance: f64, shares: [f64; 2]) -> Option<(Coordinates, Form)> {
    let part = stacked(weak, variance, shares)?;
    Some((part.minimiser()?.x, part.information() / variance))
}

/// The equations between two shares of them.
fn stacked(weak: &WeakEstimate, variance: f64, shares: [f64; 2]) -> Option<Stacked> {
    let stacked = weak.stacked.as_ref()?;
    Some(Stacked::new(&rows_between(weak, shares), &weak.columns, &stacked.origin, variance.sqrt()))
}

/// The rows between two shares of the equations.
pub(super) fn rows_between(weak: &WeakEstimate, shares: [f64; 2]) -> Vec<&[f64]> {
    let width = 3 * (weak.columns.len() + 6);
    let equations: usize = weak.parts.iter().map(|part| part.rows.len() / width).sum();
    let [from, to] = shares.map(|share| (share * equations as f64) as usize);
    let mut first = 0;
    let each = weak.parts.iter().map(|part| {
        let last = first + part.rows.len() / width;
        let [from, to] = [from, to].map(|place| width * (place.clamp(first, last) - first));
        first = last;
        &part.rows[from..to]
    });
    each.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::column::Unknowns;
    use crate::physical::coordinates::coordinates;
    use crate::solve::weak_estimate::tests::one_row_each;
    use nalgebra::Matrix3;

    /// Eight parts that tell each number of the tensor with this weight, moved from that of the moments 0.2, 0.3 and 0.5; the variance of
    /// their noise is a quarter.
    fn eight(weight: f64, moved: impl Fn(usize) -> Coordinates) -> WeakEstimate {
        let x = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.2, 0.3, 0.5)));
        let part = |part: usize| {
            let left = moved(part) * -weight;
            // parts are cut at whole equations of three rows
            let mut rows = one_row_each(&[weight; 5], left.as_slice());
            rows.extend([0.0; 6]);
            rows
        };
        let at = Unknowns { x, c: Vec::new() };
        WeakEstimate::of_rows(&[], &at, (0..CUTS).map(part).collect(), 0.5)
    }

    /// Parts that lie alternately on both sides of their mean scatter by the square of their distances over the noise of each, 35 numbers beside
    /// the mean of eight, where that is more than chance brings.
    #[test]
    fn parts_scatter_by_their_distances_from_the_mean() {
        let (weight, by_chance) = (20.0, quantile(35.0, SCATTERED));
        let of = |chi2: f64| {
            // forty numbers of that size, over their variance
            let size = (chi2 / 40.0 * 0.25).sqrt() / weight;
            let sign = |part: usize| if part.is_multiple_of(2) { 1.0 } else { -1.0 };
            scatter(&eight(weight, |part| Coordinates::repeat(size * sign(part))), 0.25)
        };
        assert_eq!(of(0.999 * by_chance), None);
        let found = of(1.001 * by_chance).unwrap();
        assert!((found.parts, found.dof) == (8, 35), "{found:?}");
        assert!((found.excess() * 35.0 / by_chance - 1.001).abs() < 1e-9, "{found:?}");
    }

    /// A tensor that changes after so many eighths is cut there: with the noise of both sides χ² is the square of the change over it, and
    /// both tensors are told.
    #[test]
    fn a_record_is_cut_where_its_tensor_changes() {
        let weight = 1e3;
        for before in 1..CUTS {
            let of = |chi2: f64| {
                // the inverses of the information of both sides add up
                let both = 0.25 / (weight * weight) * (1.0 / before as f64 + 1.0 / (CUTS - before) as f64);
                let half = 0.5 * (chi2 * both).sqrt();
                let moved = |part: usize| {
                    Coordinates::new(if part < before { half } else { -half }, 0.0, 0.0, 0.0, 0.0)
                };
                (halves(&eight(weight, moved), 0.25), half * core::f64::consts::FRAC_1_SQRT_2)
            };
            assert_eq!(of(0.999 * HALVES).0, None, "{before}");
            let (found, apart) = of(1.001 * HALVES);
            let Halves { share, first, second, chi2 } = found.unwrap();
            assert!(share == before as f64 / 8.0 && (chi2 / HALVES - 1.001).abs() < 1e-6, "{share} {chi2}");
            for (found, sign) in [(first, 1.0), (second, -1.0)] {
                let expected = [0.2 + sign * apart, 0.3 - sign * apart, 0.5];
                for (found, expected) in found.into_iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-9, "{before}: {found} {expected}");
                }
            }
        }
    }

    /// Two halves of four parts each know a moment with the variance 2/3 of a coordinate over four: a change may go unseen up to SEEN
    /// deviations of their difference, and no moment changes by more than half of the trace.
    #[test]
    fn what_may_go_unseen_is_measured_by_both_halves() {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let of = |weight: f64| unseen(&eight(weight, |_| Coordinates::zeros()), 0.25, &axes).unwrap();
        let deviation = (2.0 / 3.0 * 0.25 * (0.25 + 0.25_f64)).sqrt() / 40.0;
        for change in of(40.0) {
            assert!((change / (SEEN * deviation) - 1.0).abs() < 1e-9, "{change}");
        }
        assert_eq!(of(0.1), [LARGEST_SHARE; 3]);
    }

    /// A part that tells one number counts for that one, and a part that tells none for nothing.
    #[test]
    fn parts_that_leave_numbers_open_say_what_they_know() {
        let whole = Form::identity() * 2.0;
        let at = |x: f64| (whole, Coordinates::repeat(-2.0 * x));
        let both = scattered(&[at(0.1), at(0.3)], 0.01).unwrap();
        // each of five numbers is 0.1 from the mean, and known to 0.1/2
        assert!((both.chi2 - 40.0).abs() < 1e-12 && (both.parts, both.dof) == (2, 5), "{both:?}");
        let nothing = (Form::zeros(), Coordinates::repeat(7.0));
        assert_eq!(scattered(&[at(0.1), nothing, at(0.3)], 0.01), Some(both));
        let mut one = Form::zeros();
        one[(0, 0)] = 2.0;
        let with = scattered(&[at(0.2), at(0.2), (one, Coordinates::repeat(-1.0))], 0.01).unwrap();
        // 0.2, 0.2 and 0.5: the mean is 0.3; what rows of zeros leave is no contradiction
        assert!((with.chi2 - (0.04 + 0.04 + 0.16) / 0.01).abs() < 1e-11, "{with:?}");
        assert_eq!((with.parts, with.dof), (3, 6));
        assert_eq!(scattered(&[at(0.1)], 0.01), None);
    }

    /// A change by SEEN deviations is missed once in 1,000 records. Along it the distance of both tensors is a normal number t of that mean m, across
    /// it the square of the distance exceeds y with a chance of (1 + y/2) exp(−y/2); the miss is the integral over t² < r² with y = r² − t².
    #[test]
    fn a_change_that_may_go_unseen_is_missed_once_in_a_thousand_records() {
        let (r, m) = (HALVES.sqrt(), SEEN);
        let normal = |x: f64| 0.5 * libm::erfc(-x * core::f64::consts::FRAC_1_SQRT_2);
        let (sinh, cosh) = (libm::sinh(m * r), libm::cosh(m * r));
        // of exp(m t) (1 + (r² − t²)/2) from −r to r
        let integral = 2.0 * sinh / m + 2.0 * (m * r * cosh - sinh) / (m * m * m);
        let beyond = libm::exp(-0.5 * (m * m + r * r)) / core::f64::consts::TAU.sqrt() * integral;
        let missed = normal(r - m) - normal(-r - m) - beyond;
        assert!((missed / 1e-3 - 1.0).abs() < 1e-9, "{missed:e}");
    }

    /// Chances of 1e-6 and 1e-5, by the incomplete gamma function.
    #[test]
    fn quantiles_are_those_of_chi_squared() {
        for (dof, z, exact) in
            [(35.0, 4.753_424, 89.947), (35.0, 4.264_891, 82.640), (5.0, 4.264_891, 30.856)]
        {
            assert!((quantile(dof, z) / exact - 1.0).abs() < 0.04, "{}", quantile(dof, z));
        }
    }

    /// A ratio of mean squares with 2 and n degrees of freedom exceeds r with the chance (1 + 2 r/n)^(−n/2); over many it is chi squared over its
    /// number.
    #[test]
    fn a_ratio_of_mean_squares_is_as_rare_as_its_deviate() {
        for n in [10.0, 40.0, 400.0] {
            let ratio = 0.5 * n * (libm::pow(1e-4, -2.0 / n) - 1.0);
            let deviate = deviate_of_ratio(ratio, [2.0, n]);
            assert!((deviate / 3.719_016_485 - 1.0).abs() < 0.03, "{n}: {deviate}");
        }
        for (dof, z) in [(3.0, 3.7), (5.0, -0.5)] {
            let deviate = deviate_of_ratio(quantile(dof, z) / dof, [dof, 1e12]);
            assert!((deviate - z).abs() < 1e-9, "{dof}: {deviate}");
        }
    }

    /// The cubes of Wilson and Hilferty: with two degrees of freedom the variance is 1/9, with eight 1/36.
    #[test]
    fn quantiles_are_cubes_of_normal_numbers() {
        let thirds = [(2.0, 0.0, 2.0 * 512.0 / 729.0), (2.0, 1.0, 2.0 * 1331.0 / 729.0)];
        let sixths = [(8.0, 1.0, 8.0 * 68_921.0 / 46_656.0), (8.0, -1.0, 8.0 * 24_389.0 / 46_656.0)];
        for (dof, z, exact) in thirds.into_iter().chain(sixths) {
            assert!((quantile(dof, z) / exact - 1.0).abs() < 1e-14, "{dof} {z}: {}", quantile(dof, z));
        }
    }
}
