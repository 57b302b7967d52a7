//! The turn from the body axes of attitudes to those of rates, from both along one motion.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::rotation::Quat;

use crate::likelihood::local::Node;
use crate::thresholds::likelihood::MIRRORED;

/// How rates and attitudes of one body compare.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Alignment {
    /// Takes coordinates along the body axes of the attitudes to those of the rates.
    pub(crate) turn: Quat<f64>,
    /// Whether a mirrored axis would bring them nearer.
    pub(crate) is_mirror: bool,
    /// The rates over those of the attitudes.
    pub(crate) scale: f64,
}

/// Of nodes and the rates at their times, by least squares. `None` where nothing turns.
///
/// Source: W. Kabsch, Acta Cryst. A 32 (1976) 922.
pub(crate) fn align(nodes: &[Node], rates: &[Vector3<f64>]) -> Option<Alignment> {
    let mut both = Matrix3::zeros();
    let (mut of_attitudes, mut of_rates) = (0.0, 0.0);
    for (node, rate) in nodes.iter().zip(rates) {
        both += rate * node.rate.transpose();
        of_attitudes += node.rate.norm_squared();
        of_rates += rate.norm_squared();
    }
    if !(of_attitudes > 0.0 && of_rates > 0.0) {
        return None;
    }
    let svd = both.try_svd(true, true, f64::EPSILON, crate::thresholds::stacked::ITERATIONS)?;
    let (u, v) = (svd.u?, svd.v_t?);
    let sign = (u * v).determinant().signum();
    let mut last = Matrix3::identity();
    let least = svd.singular_values.imin();
    last[(least, least)] = sign;
    let turn = UnitQuaternion::from_matrix(&(u * last * v));
    let [smallest, largest] = [svd.singular_values.min(), svd.singular_values.max()];
    Some(Alignment {
        turn: turn.into(),
        is_mirror: sign < 0.0 && smallest > MIRRORED * largest,
        scale: (of_rates / of_attitudes).sqrt(),
    })
}

/// The rate at the time of each node: the mean of the samples within a quarter of `width` on both sides, or of the next sample behind that, or
/// of the last where there is none.
pub(crate) fn at_nodes(
    nodes: &[Node],
    times: &[f64],
    rates: &[Vector3<f64>],
    width: f64,
) -> Vec<Vector3<f64>> {
    let of = |node: &Node| {
        let low = times.partition_point(|t| *t < node.time - 0.25 * width);
        let high = times.partition_point(|t| *t <= node.time + 0.25 * width).max(low + 1).min(times.len());
        let low = low.min(high - 1);
        rates[low..high].iter().sum::<Vector3<f64>>() / (high - low) as f64
    };
    nodes.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use polhode::num::Random;
    use polhode::rotation::Vec3;

    #[test]
    fn a_turn_is_found_and_a_mirror_is_seen() {
        let mut random = Random::new(2);
        let turn = Quat::exponential(Vec3::from(random.normal_vector()));
        let nodes: Vec<Node> = (0..50)
            .map(|k| Node {
                time: f64::from(k),
                attitude: Quat::identity(),
                rate: random.normal_vector(),
                variance: 0.0,
            })
            .collect();
        let rates: Vec<Vector3<f64>> = nodes.iter().map(|n| turn.rotate(Vec3::from(n.rate)).into()).collect();
        let found = align(&nodes, &rates).unwrap();
        assert!((found.turn.conjugate() * turn).logarithm().norm() < 1e-14 && !found.is_mirror);
        assert!((found.scale - 1.0).abs() < 1e-14);
        let mirrored: Vec<Vector3<f64>> = rates.iter().map(|w| Vector3::new(-w.x, w.y, w.z)).collect();
        assert!(align(&nodes, &mirrored).unwrap().is_mirror);
    }

    /// Rates of three times the size along turned axes have that scale, and what does not turn has no axes.
    #[test]
    fn the_scale_is_that_of_the_rates() {
        let node = |rate| Node { time: 0.0, attitude: Quat::identity(), rate, variance: 0.0 };
        let nodes = [Vector3::x(), Vector3::y() * 2.0, Vector3::z()].map(node);
        let turn = Quat::exponential(Vec3([0.0, 0.0, 0.5]));
        let rates = nodes.map(|node| Vector3::from(turn.rotate(Vec3::from(node.rate * 3.0)).0));
        let found = align(&nodes, &rates).unwrap();
        assert!((found.scale - 3.0).abs() < 1e-14 && !found.is_mirror);
        assert!((found.turn.conjugate() * turn).logarithm().norm() < 1e-14);
        assert!(align(&nodes, &[Vector3::zeros(); 3]).is_none());
        assert!(align(&[Vector3::zeros(); 3].map(node), &rates).is_none());
    }

    /// Both ends of half of the width belong to a mean; where no sample lies within them the next one counts, and behind the last that.
    #[test]
    fn rates_between_samples_are_those_of_the_next() {
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        let at = |time: f64, width: f64| {
            let rate = Vector3::zeros();
            let node = Node { time, attitude: Quat::identity(), rate, variance: 0.0 };
            at_nodes(&[node], &[0.0, 1.0, 2.0], &[x, y, z], width)[0]
        };
        for (time, rate) in [(-1.0, x), (0.6, y), (0.9, y), (1.1, y), (1.5, z), (2.0, z), (5.0, z)] {
            assert_eq!(at(time, 0.5), rate, "{time}");
        }
        assert_eq!((at(0.5, 2.0), at(1.0, 4.0)), ((x + y) * 0.5, (x + y + z) / 3.0));
        assert_eq!(at(1.0, 3.75), y);
    }

    /// Rates that leave a plane by little are their own mirror image up to a turn: a twentieth of the squares along the widest axis tells
    /// the two apart.
    #[test]
    fn a_mirror_is_seen_where_rates_leave_a_plane() {
        let node = |rate| Node { time: 0.0, attitude: Quat::identity(), rate, variance: 0.0 };
        for (share, is_mirror) in [(0.06, true), (0.04, false), (0.0, false)] {
            let nodes = [Vector3::x(), Vector3::y(), Vector3::z() * f64::sqrt(share)].map(node);
            let rates = nodes.map(|node| Vector3::new(node.rate.x, node.rate.y, -node.rate.z));
            let found = align(&nodes, &rates).unwrap();
            assert_eq!(found.is_mirror, is_mirror, "{share}");
            assert!((found.scale - 1.0).abs() < 1e-15 && found.turn.v.norm() < 1e-13, "{share}");
        }
    }
}
