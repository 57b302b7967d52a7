//! Numbers on the command line. clap puts the flag and the value before each message.

use nalgebra::{Quaternion, UnitQuaternion};

/// A finite number.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    let text = text.trim();
    if text.is_empty() {
        return Err("a number is missing".into());
    }
    let value: f64 =
        text.parse().map_err(|_| format!("'{text}' is not a number; write it like 0.5 or 1e-3"))?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(format!("'{text}' is not a finite number; its size must stay below {:e}", f64::MAX))
    }
}

/// A finite number above zero.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match number(text)? {
        value if value > 0.0 => Ok(value),
        value => Err(format!("{value:?} is not positive; give a number above zero")),
    }
}

/// A finite number, zero or above.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    match number(text)? {
        value if value >= 0.0 => Ok(value),
        value => Err(format!("{value:?} is negative; give 0 or more")),
    }
}

/// Finite numbers separated by commas.
pub(crate) fn list(text: &str) -> Result<Vec<f64>, String> {
    let items = text.split(',').enumerate();
    items.map(|(k, item)| number(item).map_err(|error| format!("item {}: {error}", k + 1))).collect()
}

/// Exactly `N` finite numbers separated by commas.
pub(crate) fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    list(text)?
        .try_into()
        .map_err(|found: Vec<f64>| format!("{} given, {N} needed; separate them by commas", found.len()))
}

/// A quaternion w,x,y,z of any non-zero norm, as typed.
pub(crate) fn quaternion(text: &str) -> Result<[f64; 4], String> {
    let q = numbers(text)?;
    if q == [0.0; 4] {
        return Err(
            "the zero quaternion has no direction; any other norm is fine, and 1,0,0,0 is the attitude unturned".into()
        );
    }
    Ok(q)
}

/// The turn of a quaternion w,x,y,z of any non-zero norm; `None` of zeros.
pub(crate) fn turn(q: [f64; 4]) -> Option<UnitQuaternion<f64>> {
    let largest = q.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    // the power of two keeps the squares in range, and changes no digit
    let near_one = |x| libm::scalbn(x, -libm::ilogb(largest));
    let [w, x, y, z] = if largest > 0.0 { q.map(near_one) } else { return None };
    Some(UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)))
}

/// Output times as typed, a value of its own because clap reads `Vec` as a repeated flag.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Times(pub(crate) Vec<f64>);

/// Output times separated by commas.
pub(crate) fn times(text: &str) -> Result<Times, String> {
    list(text).map(Times)
}

/// Rows of one run: more are rather a slip of the pen than a wish.
const MOST_ROWS: f64 = 2e6;

/// The times `start`, `start + every`, … up to `until`.
///
/// `until` itself is among them, as typed, when it lies within 4 ulp of a multiple.
///
/// # Errors
/// `every` zero or pointing away from `until`, and more than [`MOST_ROWS`].
pub(crate) fn regular(
    start: f64,
    until: f64,
    every: f64,
) -> Result<impl ExactSizeIterator<Item = f64>, String> {
    let span = until - start;
    if every == 0.0 {
        return Err("--every: '0': rows need time between them; give a DT that is not zero".into());
    }
    if span != 0.0 && span.signum() != every.signum() {
        return Err(format!(
            "--every: '{every:?}': steps away from --until {until:?} (start time {start:?}); change its sign"
        ));
    }
    let rows = span / every;
    if rows.is_nan() || rows > MOST_ROWS {
        return Err(format!(
            "--every: '{every:?}': {rows:.0e} rows up to --until {until:?}, and at most {MOST_ROWS:e} are written; give a larger DT"
        ));
    }
    let ulp = f64::EPSILON * until.abs().max(start.abs()).max(every.abs());
    let nearest = rows.round();
    let exact = (start + nearest * every - until).abs() <= 4.0 * ulp;
    let last = if exact { nearest } else { rows.floor() } as usize;
    Ok((0..last + 1).map(move |n| if exact && n == last { until } else { start + n as f64 * every }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_every_bit_and_their_sign() {
        assert_eq!(numbers::<3>("0.1,-2e-300, 3"), Ok([0.1, -2e-300, 3.0]));
        assert_eq!(numbers::<1>("-0").map(|x| x[0].is_sign_negative()), Ok(true));
    }

    #[test]
    fn messages_say_what_is_wrong() {
        let message = |text| numbers::<3>(text).unwrap_err();
        assert_eq!(message("1,2"), "2 given, 3 needed; separate them by commas");
        assert_eq!(message("1,,3"), "item 2: a number is missing");
        assert_eq!(message("1,x,3"), "item 2: 'x' is not a number; write it like 0.5 or 1e-3");
        assert!(message("1,2,nan").starts_with("item 3: 'nan' is not a finite number"));
        assert!(message("1,2,1e999").starts_with("item 3: '1e999' is not a finite number"));
        assert_eq!(positive("0").unwrap_err(), "0.0 is not positive; give a number above zero");
        assert!(quaternion("0,0,-0,0").unwrap_err().contains("zero quaternion"));
        assert_eq!(quaternion("1,0.1,0,0"), Ok([1.0, 0.1, 0.0, 0.0]));
    }

    #[test]
    fn a_turn_does_not_depend_on_the_norm() {
        let unit = UnitQuaternion::new_normalize(Quaternion::new(1.0, -3.0, 0.5, 0.25));
        for k in [-1072, -700, 0, 1, 600, 1022] {
            let scale = libm::scalbn(1.0, k);
            assert_eq!(turn([1.0, -3.0, 0.5, 0.25].map(|x| x * scale)), Some(unit), "2^{k}");
        }
        assert_eq!(turn([0.0, -0.0, 0.0, 0.0]), None);
    }

    #[test]
    fn regular_times_end_at_the_typed_end() {
        let regular = |a, b, c| regular(a, b, c).map(Iterator::collect::<Vec<_>>);
        assert_eq!(regular(0.0, 0.3, 0.1), Ok(vec![0.0, 0.1, 0.2, 0.3]));
        assert_eq!(regular(0.0, 1.0, 0.4), Ok(vec![0.0, 0.4, 0.8]));
        assert_eq!(regular(5.0, 3.0, -1.0), Ok(vec![5.0, 4.0, 3.0]));
        assert_eq!(regular(2.0, 2.0, 1.0), Ok(vec![2.0]));
        assert_eq!(regular(0.0, 1e4, 1e-2).map(|t| t.len()), Ok(1_000_001));
    }

    #[test]
    fn regular_times_refuse_what_never_arrives() {
        let message = |a, b, c| regular(a, b, c).err().unwrap();
        assert!(message(0.0, 1.0, 0.0).contains("rows need time between them"));
        assert!(message(0.0, 1.0, -0.1).contains("change its sign"));
        assert!(message(0.0, 1e-200, -1e-200).contains("change its sign"));
        assert!(message(0.0, 1.0, 1e-300).contains("1e300 rows"));
        assert!(message(-f64::MAX, f64::MAX, 1.0).contains("inf rows"));
    }
}
