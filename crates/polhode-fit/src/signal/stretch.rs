//! A stretch of samples without gaps, in the units of its record.

use nalgebra::Vector3;

use crate::signal::quadrature;

/// One stretch of samples without gaps, in units of the root mean square rate and its inverse.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    pub(crate) times: Vec<f64>,
    pub(crate) rates: Vec<Vector3<f64>>,
    pub(crate) weights: Vec<f64>,
    /// What acts on the body and is known.
    pub(crate) inputs: Option<KnownInputs>,
    /// Its number among the stretches of the record.
    pub(crate) index: usize,
    /// The segment of the record that it is or is a part of.
    pub(crate) segment: usize,
    /// Time of its first sample in the record, s.
    pub(crate) start: f64,
}

/// Wheel momenta and torques at the times of a stretch, in units of the unit rate and its square.
#[derive(Clone, Debug)]
pub(crate) struct KnownInputs {
    pub(crate) wheel: Vec<Vector3<f64>>,
    pub(crate) torque: Vec<Vector3<f64>>,
}

impl Stretch {
    pub(crate) fn new(times: Vec<f64>, rates: Vec<Vector3<f64>>) -> Self {
        let weights = quadrature::weights(&times);
        Stretch { times, rates, weights, inputs: None, index: 0, segment: 0, start: 0.0 }
    }

    pub(crate) fn duration(&self) -> f64 {
        self.times.last().zip(self.times.first()).map_or(0.0, |(b, a)| b - a)
    }

    /// Its first `count` samples.
    pub(crate) fn head(&self, count: usize) -> Stretch {
        let head = |of: &[Vector3<f64>]| of[..count].to_vec();
        let inputs = self.inputs.as_ref();
        Stretch {
            inputs: inputs.map(|i| KnownInputs { wheel: head(&i.wheel), torque: head(&i.torque) }),
            index: self.index,
            segment: self.segment,
            start: self.start,
            ..Stretch::new(self.times[..count].to_vec(), head(&self.rates))
        }
    }

    /// The same with the components of the momentum of wheels in another order, and with these signs.
    pub(crate) fn with_exchanged(&self, order: [usize; 3], signs: [f64; 3]) -> Stretch {
        let exchange = |h: &Vector3<f64>| Vector3::from_fn(|k, _| signs[k] * h[order[k]]);
        let exchanged = |inputs: &KnownInputs| KnownInputs {
            wheel: inputs.wheel.iter().map(exchange).collect(),
            torque: inputs.torque.clone(),
        };
        Stretch { inputs: self.inputs.as_ref().map(exchanged), ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a stretch from the third segment that begins late, with wheels and torques that differ at every sample.
    fn late() -> Stretch {
        let list = |from: f64| (0..4).map(|k| Vector3::new(from, f64::from(k), -1.0)).collect::<Vec<_>>();
        let inputs = Some(KnownInputs { wheel: list(5.0), torque: list(7.0) });
        let times = vec![0.0, 1.0, 2.0, 4.0];
        Stretch { inputs, index: 4, segment: 2, start: 9.0, ..Stretch::new(times, list(3.0)) }
    }

    /// The head of a stretch keeps its place in the record, its samples and what acts at them; its weights are its own.
    #[test]
    fn the_head_of_a_stretch_keeps_its_place() {
        let (all, head) = (late(), late().head(3));
        assert_eq!((all.duration(), head.duration()), (4.0, 2.0));
        assert_eq!((head.index, head.segment, head.start), (4, 2, 9.0));
        assert_eq!((&head.times[..], &head.rates[..]), (&all.times[..3], &all.rates[..3]));
        assert_eq!(head.weights, quadrature::weights(&[0.0, 1.0, 2.0]));
        let (of_all, of_head) = (all.inputs.unwrap(), head.inputs.unwrap());
        assert_eq!((&of_head.wheel[..], &of_head.torque[..]), (&of_all.wheel[..3], &of_all.torque[..3]));
    }

    /// An exchange turns the momenta of wheels alone: each component is that of its axis in the order, with its sign.
    #[test]
    fn an_exchange_turns_wheels_alone() {
        let (all, other) = (late(), late().with_exchanged([2, 0, 1], [1.0, -1.0, 1.0]));
        assert_eq!((&other.times, &other.rates), (&all.times, &all.rates));
        let (of_all, of_other) = (all.inputs.unwrap(), other.inputs.unwrap());
        assert_eq!(of_other.torque, of_all.torque);
        assert_eq!(of_other.wheel[3], Vector3::new(-1.0, -5.0, 3.0));
        assert_eq!(Stretch::new(Vec::new(), Vec::new()).duration(), 0.0);
    }
}
