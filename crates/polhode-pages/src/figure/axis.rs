//! Axes: logarithmic, linear, and logarithmic to both sides of zero.

/// How an axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
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
/// A logarithmic axis shows at least so many.
const LEAST: f64 = 0.8;
/// Values whose relative difference is smaller are one value, with rounding.
const SAME: f64 = 1e-12;

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
        let missing = LEAST - (last - first);
        if missing > 0.0 {
            // two labels at least
            (first, last) = (first - 0.5 * missing, last + 0.5 * missing);
        }
        let margin = 0.03 * (last - first);
        Axis { scale: Scale::Log, first: first - margin, last: last + margin, floor }
    }

    fn linear(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low.is_finite() { (low, high) } else { (0.0, 1.0) };
        let size = high.abs().max(low.abs());
        let width = match high - low {
            width if width > SAME * size => width,
            _ if size > 0.0 => size,
            _ => 1.0,
        };
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

    /// Where `value` stands between the ends, as a share of the axis.
    pub(super) fn share(&self, value: f64) -> f64 {
        self.share_of_place(self.place(value))
    }

    /// The same of a coordinate.
    pub(super) fn share_of_place(&self, place: f64) -> f64 {
        (place - self.first) / (self.last - self.first)
    }

    /// Gives two linear axes of so many pixels the same scale.
    pub(super) fn equalize(axes: &mut [Self; 2], pixels: [f64; 2]) {
        let scale = |k: usize| (axes[k].last - axes[k].first) / pixels[k];
        let scale = scale(0).max(scale(1));
        for (axis, pixels) in axes.iter_mut().zip(pixels) {
            let middle = 0.5 * (axis.first + axis.last);
            (axis.first, axis.last) = (middle - 0.5 * scale * pixels, middle + 0.5 * scale * pixels);
        }
    }

    /// Marks along `length` pixels, whose labels need `room` pixels each.
    pub(super) fn ticks(&self, length: f64, room: f64) -> Vec<Tick> {
        let most = (length / room).clamp(2.0, 20.0);
        match self.scale {
            Scale::Linear => self.linear_ticks(most.min(8.0)),
            Scale::Log if self.last - self.first < 1.8 && self.floor.is_none() => self.fine_ticks(most),
            _ => self.decade_ticks(most),
        }
    }

    fn linear_ticks(&self, most: f64) -> Vec<Tick> {
        let least = (self.last - self.first) / most;
        // below the normal numbers no power of ten has the digits that marks need
        if !least.is_normal() {
            return Vec::new();
        }
        let decade = libm::exp10(libm::floor(libm::log10(least)));
        let fits = |factor: &&f64| *factor * decade >= least * (1.0 - 1e-9);
        let tick = [1.0, 2.0, 5.0].iter().find(fits).map_or(10.0 * decade, |factor| factor * decade);
        let (first, last) = (libm::ceil(self.first / tick) as i64, libm::floor(self.last / tick) as i64);
        let size = tick * (first.abs().max(last.abs()) as f64);
        let power = if (1e-3..1e5).contains(&size) { 0 } else { libm::floor(libm::log10(size)) as i32 };
        let digits = (f64::from(power) - libm::floor(libm::log10(tick) + 1e-9)).max(0.0) as usize;
        let label = |k: i64| {
            let text = format!("{:.digits$}", k as f64 * tick / libm::exp10(f64::from(power)));
            let text =
                if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
            with_power(text, if k == 0 { 0 } else { power })
        };
        (first..=last).map(|k| Tick { at: k as f64 * tick, label: Some(label(k)) }).collect()
    }

    /// Of less than two decades: 1, 2 and 5 of each.
    fn fine_ticks(&self, most: f64) -> Vec<Tick> {
        let (first, last) = (libm::floor(self.first) as i32, libm::ceil(self.last) as i32);
        let mut ticks: Vec<(i32, Tick)> = Vec::new();
        for decade in first..=last {
            for digit in 1..10 {
                let at = f64::from(decade) + libm::log10(f64::from(digit));
                let label = [1, 2, 5].contains(&digit).then(|| match (decade, digit) {
                    (-2..=3, _) => plain(digit, decade),
                    (_, 1) => ten_to(decade),
                    _ => with_power(&digit.to_string(), decade),
                });
                if (self.first..=self.last).contains(&at) {
                    ticks.push((digit, Tick { at, label }));
                }
            }
        }
        // where there is no room for all of them, decades and halves
        if ticks.iter().filter(|(_, tick)| tick.label.is_some()).count() as f64 > most {
            for (_, tick) in ticks.iter_mut().filter(|(digit, _)| *digit == 2) {
                tick.label = None;
            }
        }
        ticks.into_iter().map(|(_, tick)| tick).collect()
    }

    fn decade_ticks(&self, most: f64) -> Vec<Tick> {
        let (first, last) = (libm::ceil(self.first) as i32, libm::floor(self.last) as i32);
        let every = (f64::from(last - first + 1) / most).max(1.0);
        let every = [1, 2, 3, 5, 10, 20, 50, 100].into_iter().find(|k| f64::from(*k) >= every).unwrap_or(200);
        let is_labelled = |k: i32| match (self.scale, self.floor) {
            // zero, and from the first decade on to both sides
            (Scale::Signed, _) => k == 0 || (k.abs() - 1) % every == 0 && (every == 1 || k.abs() > 1),
            // the floor is always labelled, and nothing that would touch its label
            (_, Some(floor)) => k == floor || k % every == 0 && k - floor >= every,
            _ => k % every == 0,
        };
        let mark = |k: i32| Tick {
            at: f64::from(k),
            label: is_labelled(k).then(|| match (self.scale, self.floor) {
                (Scale::Signed, _) if k == 0 => "0".into(),
                (Scale::Signed, Some(floor)) => {
                    format!("{}{}", if k < 0 { "−" } else { "" }, ten_to(floor + k.abs() - 1))
                }
                (_, Some(floor)) if floor == k => "0".into(),
                _ => ten_to(k),
            }),
        };
        (first..=last).map(mark).collect()
    }
}

/// A mark of an axis at a coordinate.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) at: f64,
    pub(super) label: Option<String>,
}

fn power(decade: i32) -> f64 {
    libm::exp10(f64::from(decade))
}

/// `digit` of a decade between thousandths and thousands.
fn plain(digit: i32, decade: i32) -> String {
    let digits = (-decade).max(0) as usize;
    format!("{:.digits$}", f64::from(digit) * power(decade))
}

/// A number with a true minus, times a power of ten.
fn with_power(text: &str, decade: i32) -> String {
    let text = text.replace('-', "−");
    match (decade, text.as_str()) {
        (0, _) => text,
        (_, "1") => ten_to(decade),
        (_, "−1") => format!("−{}", ten_to(decade)),
        _ => format!("{text}·{}", ten_to(decade)),
    }
}

/// A power of ten as it is printed, 10⁻³.
pub fn ten_to(power: i32) -> String {
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

    fn labels(axis: &Axis, length: f64) -> Vec<String> {
        axis.ticks(length, 40.0).into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn zeros_stand_on_a_floor_below_the_smallest_value() {
        let decades = Axis::over(Scale::Log, [0.0, 3e-12, 2e-3].into_iter());
        assert_eq!(decades.floor, Some(-13));
        assert_eq!(decades.place(0.0), -13.0);
        let labels = labels(&decades, 800.0);
        assert_eq!((labels[0].as_str(), labels[1].as_str(), labels.len()), ("0", "10⁻¹²", 11));
        assert_eq!(ten_to(30), "10³⁰");
    }

    #[test]
    fn an_axis_of_subnormal_length_has_no_marks() {
        assert!(Axis::over(Scale::Linear, [0.0, 5e-324].into_iter()).ticks(300.0, 40.0).is_empty());
    }

    #[test]
    fn every_value_lies_on_the_axis_and_two_places_are_labelled() {
        for values in [[1e-16, 1.0], [2e-300, 9e-1], [10.0, 10.0], [0.0, 0.0], [0.0, 7.0], [2.0, 9.0]] {
            for scale in [Scale::Log, Scale::Linear, Scale::Signed] {
                let axis = Axis::over(scale, values.into_iter());
                for value in values {
                    assert!((0.0..=1.0).contains(&axis.share(value)), "{scale:?} {values:?}");
                }
                assert!(labels(&axis, 300.0).len() >= 2, "{scale:?} {values:?}");
            }
        }
    }

    #[test]
    fn a_signed_axis_is_odd_continuous_and_labelled_on_both_sides() {
        let axis = Axis::over(Scale::Signed, [-1e-3, 0.0, 2e-6, 1e-9].into_iter());
        assert_eq!([1e-9, 1e-8, -1e-8, 0.0].map(|v| axis.place(v)), [1.0, 2.0, -2.0, 0.0]);
        assert!((axis.place(0.5e-9) - 0.5).abs() < 1e-12);
        let labels = labels(&axis, 800.0);
        for label in ["−10⁻⁸", "0", "10⁻⁹", "−10⁻³"] {
            assert!(labels.iter().any(|found| found == label), "{label}: {labels:?}");
        }
    }

    #[test]
    fn a_linear_axis_is_labelled_at_round_numbers() {
        let of = |low: f64, high: f64| labels(&Axis::over(Scale::Linear, [low, high].into_iter()), 240.0);
        assert_eq!(of(-0.13, 0.31), ["−0.1", "0", "0.1", "0.2", "0.3"]);
        assert_eq!(of(1e9, 1e9 + 4.0).first().map(String::as_str), Some("10⁹"));
        assert_eq!(of(0.0, 3e6), ["0", "10⁶", "2·10⁶", "3·10⁶"]);
        assert_eq!(of(-2e-7, 0.0), ["−2·10⁻⁷", "−1.5·10⁻⁷", "−10⁻⁷", "−0.5·10⁻⁷", "0"]);
    }

    #[test]
    fn less_than_two_decades_are_labelled_within() {
        let axis = Axis::over(Scale::Log, [0.03, 0.4].into_iter());
        assert_eq!(labels(&axis, 400.0), ["0.05", "0.1", "0.2"]);
    }
}
