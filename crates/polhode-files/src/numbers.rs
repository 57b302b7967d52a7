//! Numbers on the command line. clap puts the flag and the value before each message.

use nalgebra::{Quaternion, UnitQuaternion};

/// A finite number.
pub fn number(text: &str) -> Result<f64, String> {
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
pub fn positive(text: &str) -> Result<f64, String> {
    match number(text)? {
        value if value > 0.0 => Ok(value),
        value => Err(format!("{value:?} is not positive; give a number above zero")),
    }
}

/// A finite number, zero or above.
pub fn not_negative(text: &str) -> Result<f64, String> {
    match number(text)? {
        value if value >= 0.0 => Ok(value),
        value => Err(format!("{value:?} is negative; give 0 or more")),
    }
}

/// Finite numbers separated by commas.
pub fn list(text: &str) -> Result<Vec<f64>, String> {
    let items = text.split(',').enumerate();
    items.map(|(k, item)| number(item).map_err(|error| format!("item {}: {error}", k + 1))).collect()
}

/// Exactly `N` finite numbers separated by commas.
pub fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    list(text)?
        .try_into()
        .map_err(|found: Vec<f64>| format!("{} given, {N} needed; separate them by commas", found.len()))
}

/// A quaternion w,x,y,z of any non-zero norm, as typed.
pub fn quaternion(text: &str) -> Result<[f64; 4], String> {
    let q = numbers(text)?;
    if q == [0.0; 4] {
        return Err(
            "the zero quaternion is not a rotation; any other norm is accepted, and 1,0,0,0 is the identity"
                .into(),
        );
    }
    Ok(q)
}

/// The turn of a quaternion w,x,y,z of any non-zero norm; `None` of zeros.
pub fn turn(q: [f64; 4]) -> Option<UnitQuaternion<f64>> {
    let largest = q.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    // the power of two keeps the squares in range, and changes no digit
    let near_one = |x| libm::scalbn(x, -libm::ilogb(largest));
    let [w, x, y, z] = if largest > 0.0 { q.map(near_one) } else { return None };
    Some(UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)))
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
}
