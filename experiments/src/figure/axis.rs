//! Axes: logarithmic, linear, and logarithmic to both sides of zero.

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

/// How an axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scale {
    /// Decades around the data; what is zero stands on a marked floor below them.
    Log,
    /// Equal differences.
    Linear,
    /// Decades of either sign, from the smallest one of the data; what is smaller lies between them, in proportion.
    Signed,
}

/// An axis around the data. Its coordinate is the decimal logarithm, the value itself, or the signed number of decades.
#[derive(Clone)]
pub(super) struct Axis {
    scale: Scale,
    first: f64,
    last: f64,
    /// The decade that stands for zero, if zeros are to be drawn; of [`Scale::Signed`] the one that begins at coordinate 1.
    floor: Option<i32>,
}

/// A signed axis shows at most so many decades of either sign.
const DECADES: i32 = 17;

impl Axis {
    pub(super) fn over(scale: Scale, values: impl Iterator<Item = f64> + Clone) -> Self {
        match scale {
            Scale::Log => Self::decades(values),
            Scale::Linear => Self::linear(values),
            Scale::Signed => Self::signed(values),
        }
    }

    fn decades(values: impl Iterator<Item = f64> + Clone) -> Self {
        let positive = values.clone().filter(|v| *v > 0.0);
        let (low, high) = positive.fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low.is_finite() { (low, high) } else { (1.0, 1.0) };
        let (mut first, mut last) = (libm::log10(low), libm::log10(high));
        let zeros = values.into_iter().any(|v| v == 0.0);
        let floor = zeros.then(|| libm::floor(first + 1e-9) as i32 - 1);
        first = floor.map_or(first, f64::from);
        if libm::floor(last) - libm::ceil(first) < 1.0 {
            // two labels at least
            (first, last) = (libm::floor(first), libm::floor(last) + 1.0);
        }
        let margin = 0.03 * (last - first);
        Axis { scale: Scale::Log, first: first - margin, last: last + margin, floor }
    }

    fn linear(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low.is_finite() { (low, high) } else { (0.0, 1.0) };
        let width = if high > low { high - low } else { high.abs().max(1.0) };
        Axis { scale: Scale::Linear, first: low - 0.04 * width, last: high + 0.04 * width, floor: None }
    }

    fn signed(values: impl Iterator<Item = f64> + Clone) -> Self {
        let sizes = values.clone().filter(|v| *v != 0.0).map(f64::abs);
        let (low, high) = sizes.fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low.is_finite() { (low, high) } else { (1.0, 1.0) };
        let top = libm::ceil(libm::log10(high) - 1e-9) as i32;
        let floor = (libm::floor(libm::log10(low) + 1e-9) as i32).max(top - DECADES).min(top - 1);
        let mut axis = Axis { scale: Scale::Signed, first: 0.0, last: 0.0, floor: Some(floor) };
        let places = values.map(|v| axis.place(v));
        let (first, last) = places.fold((-1.0_f64, 1.0_f64), |(l, h), place| (l.min(place), h.max(place)));
        let margin = 0.03 * (last - first);
        (axis.first, axis.last) = (first - margin, last + margin);
        axis
    }

    /// Where `value` stands: its coordinate.
    pub(super) fn place(&self, value: f64) -> f64 {
        match (self.scale, self.floor) {
            (Scale::Linear, _) => value,
            (Scale::Signed, floor) => {
                let decades = libm::log10(value.abs()) - f64::from(floor.unwrap_or(0));
                let size =
                    if decades > 0.0 { 1.0 + decades } else { value.abs() / power(floor.unwrap_or(0)) };
                size.copysign(value)
            }
            (Scale::Log, Some(floor)) if value == 0.0 => f64::from(floor),
            (Scale::Log, _) => libm::log10(value),
        }
    }

    /// The coordinates that are seen.
    pub(super) fn limits(&self) -> [f64; 2] {
        [self.first, self.last]
    }

    /// Distance of the labels of a linear axis.
    fn tick(&self, room: usize) -> f64 {
        let least = (self.last - self.first) / room.clamp(2, 8) as f64;
        let decade = libm::exp10(libm::floor(libm::log10(least)));
        let fits = |factor: &&f64| *factor * decade >= least;
        [1.0, 2.0, 5.0].iter().find(fits).map_or(10.0 * decade, |factor| factor * decade)
    }
}

fn power(decade: i32) -> f64 {
    libm::exp10(f64::from(decade))
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value - self.first) / (self.last - self.first);
        limit.0 + libm::round(share * f64::from(limit.1 - limit.0)) as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if self.scale == Scale::Linear {
            let tick = self.tick(hint.max_num_points());
            let (first, last) = (libm::ceil(self.first / tick) as i64, libm::floor(self.last / tick) as i64);
            return (first..=last).map(|k| k as f64 * tick).collect();
        }
        let (first, last) = (libm::ceil(self.first) as i32, libm::floor(self.last) as i32);
        let room = hint.max_num_points().clamp(2, 12) as i32;
        let every = ((last - first) / room + 1).max(1);
        let marks = (first..=last).filter(|k| match (self.scale, self.floor) {
            // zero, and from the first decade on to both sides
            (Scale::Signed, _) => *k == 0 || (k.abs() - 1) % every == 0 && (every == 1 || k.abs() > 1),
            // the floor is always labelled, and nothing that would touch its label
            (_, Some(floor)) => *k == floor || (k - last) % every == 0 && k - floor >= every,
            _ => (k - last) % every == 0,
        });
        marks.map(f64::from).collect()
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.first..self.last
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        if self.scale == Scale::Linear {
            // a multiple of a round number: more digits are rounding
            let text = format!("{value:.3e}").parse::<f64>().unwrap_or(*value);
            return match text.abs() {
                0.0 => "0".into(),
                size if (1e-3..1e5).contains(&size) => format!("{text}"),
                _ => format!("{text:e}"),
            }
            .replace('-', "−");
        }
        let decade = libm::round(*value) as i32;
        match (self.scale, self.floor) {
            (Scale::Signed, _) if decade == 0 => "0".into(),
            (Scale::Signed, Some(floor)) => {
                let sign = if decade < 0 { "−" } else { "" };
                format!("{sign}{}", ten_to(floor + decade.abs() - 1))
            }
            (_, Some(floor)) if floor == decade => "0".into(),
            _ => ten_to(decade),
        }
    }
}

/// A power of ten as it is printed, 10⁻³.
pub(crate) fn ten_to(power: i32) -> String {
    let raised = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    format!("10{}", power.to_string().chars().map(raised).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_stand_on_a_floor_below_the_smallest_value() {
        let decades = Axis::over(Scale::Log, [0.0, 3e-12, 2e-3].into_iter());
        assert_eq!(decades.floor, Some(-13));
        assert_eq!(decades.place(0.0), -13.0);
        assert_eq!(decades.format_ext(&-13.0), "0");
        assert_eq!(decades.format_ext(&-12.0), "10⁻¹²");
        assert_eq!(decades.format_ext(&30.0), "10³⁰");
    }

    #[test]
    fn every_value_lies_on_the_axis_and_two_places_are_labelled() {
        for values in [[1e-16, 1.0], [2e-300, 9e-1], [10.0, 10.0], [0.0, 0.0], [0.0, 7.0], [2.0, 9.0]] {
            for scale in [Scale::Log, Scale::Linear, Scale::Signed] {
                let axis = Axis::over(scale, values.into_iter());
                for value in values {
                    assert!(axis.range().contains(&axis.place(value)), "{scale:?} {values:?}");
                }
                assert!(axis.key_points(10).len() >= 2, "{scale:?} {values:?}");
            }
        }
    }

    #[test]
    fn a_signed_axis_is_odd_continuous_and_labelled_on_both_sides() {
        let axis = Axis::over(Scale::Signed, [-1e-3, 0.0, 2e-6, 1e-9].into_iter());
        assert_eq!([1e-9, 1e-8, -1e-8, 0.0].map(|v| axis.place(v)), [1.0, 2.0, -2.0, 0.0]);
        assert!((axis.place(0.5e-9) - 0.5).abs() < 1e-12);
        assert_eq!([-2.0, 0.0, 1.0].map(|k| axis.format_ext(&k)), ["−10⁻⁸", "0", "10⁻⁹"]);
        let labels = axis.key_points(30);
        assert!(labels.contains(&-7.0) && labels.contains(&0.0) && labels.contains(&1.0), "{labels:?}");
    }

    #[test]
    fn a_linear_axis_is_labelled_at_round_numbers() {
        let axis = Axis::over(Scale::Linear, [-0.13, 0.31].into_iter());
        let labels: Vec<String> = axis.key_points(6).iter().map(|k| axis.format_ext(k)).collect();
        assert_eq!(labels, ["−0.1", "0", "0.1", "0.2", "0.3"]);
    }
}
