//! Numbers of a page, as short as what it shows allows.

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let at = |k: usize| u32::from(group.get(k).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for k in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * k)) as usize & 63];
            text.push(if k > group.len() { '=' } else { char::from(digit) });
        }
    }
    text
}

/// Numbers from −1 to 1 in units of 1/32767.
pub(super) fn shares(values: impl IntoIterator<Item = f64>) -> String {
    let bytes: Vec<u8> =
        values.into_iter().flat_map(|x| (libm::round(x * 32767.0) as i16).to_le_bytes()).collect();
    base64(&bytes)
}

/// Numbers up to 65535.
pub(super) fn indices(values: impl IntoIterator<Item = u32>) -> String {
    let bytes: Vec<u8> = values.into_iter().flat_map(|k| (k as u16).to_le_bytes()).collect();
    base64(&bytes)
}

/// Numbers below 256.
pub(super) fn bytes(values: &[u8]) -> String {
    base64(values)
}

/// Numbers to seven digits; those above 3e38 are written as that.
pub(super) fn singles(values: &[f64]) -> String {
    let most = f64::from(f32::MAX);
    base64(&values.iter().flat_map(|x| (x.clamp(-most, most) as f32).to_le_bytes()).collect::<Vec<u8>>())
}

/// Numbers to all their digits.
pub(super) fn doubles(values: impl IntoIterator<Item = f64>) -> String {
    base64(&values.into_iter().flat_map(f64::to_le_bytes).collect::<Vec<u8>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The vectors of RFC 4648, section 10.
    #[test]
    fn bytes_are_written_in_base_64() {
        let found = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|text| base64(text.as_bytes()));
        assert_eq!(found, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }

    #[test]
    fn numbers_keep_their_order_and_their_bytes() {
        // 0x0001 and 0xffff, least byte first
        assert_eq!(indices([1, 65535]), base64(&[1, 0, 255, 255]));
        assert_eq!(shares([1.0, -1.0, 0.0]), base64(&[255, 127, 1, 128, 0, 0]));
        assert_eq!(singles(&[1.0]), base64(&[0, 0, 128, 63]));
        assert_eq!(singles(&[1e300]), base64(&f32::MAX.to_le_bytes()));
        assert_eq!(doubles([1.0]), base64(&[0, 0, 0, 0, 0, 0, 240, 63]));
    }
}
