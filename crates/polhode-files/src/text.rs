//! Text from files and numbers as they are shown.

use std::borrow::Cow;

use polhode::num::{Computed, Shown};

/// Whether a terminal would obey the character rather than show it: C0, DEL, C1 and the controls of writing direction.
fn is_obeyed(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{200e}' | '\u{200f}' | '\u{061c}')
}

/// `text` with every character that a terminal would obey written out, as `\u{1b}`.
pub fn visible(text: &str) -> Cow<'_, str> {
    escaped(text, is_obeyed, |c| c.escape_default().to_string())
}

/// The same of a text that may have several lines.
pub fn visible_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |c| c != '\n' && is_obeyed(c), |c| c.escape_default().to_string())
}

/// A JSON value or a quoted TOML key with the same characters written out; programs read what it was.
pub fn visible_json(text: &str) -> Cow<'_, str> {
    // none of them is outside of the sixteen bits that the notation has
    escaped(text, |c| c != '\n' && is_obeyed(c), |c| format!("\\u{:04x}", u32::from(c)))
}

/// `text` for the contents and the attributes of HTML.
pub fn escaped_html(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn escaped(text: &str, which: impl Fn(char) -> bool, how: impl Fn(char) -> String) -> Cow<'_, str> {
    if !text.contains(&which) {
        return text.into();
    }
    let each = |c: char| if which(c) { how(c) } else { c.to_string() };
    text.chars().map(each).collect::<String>().into()
}

/// What a file is that has another coding than text of bytes, by the mark at its beginning, and what helps.
pub(crate) fn foreign(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    match bytes {
        // the mark of byte order in two bytes
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some(("the text is UTF-16", "save it as UTF-8")),
        [0x1f, 0x8b, ..] => Some(("the file is compressed by gzip", "unpack it first")),
        [b'P', b'K', 3, 4, ..] => {
            Some(("the file is a zip archive, as a workbook is", "unpack it, or save its rows as CSV"))
        }
        _ => None,
    }
}

/// A number with all its digits, written out where that is short.
pub fn short(x: f64) -> String {
    Shown(x).to_string()
}

/// The same without the noise of the last digit, as of 0.30000000000000004.
pub fn rounded(x: f64) -> String {
    Computed(x).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_written_out() {
        assert_eq!(visible("\u{1b}]0;x\u{7}\u{9b}\u{7f}"), "\\u{1b}]0;x\\u{7}\\u{9b}\\u{7f}");
        assert_eq!(visible("a\nb\tc\r"), "a\\nb\\tc\\r");
        assert_eq!(visible_lines("a\nb\r"), "a\nb\\r");
        for c in ['\u{202a}', '\u{202e}', '\u{2066}', '\u{2069}', '\u{200e}', '\u{200f}', '\u{61c}'] {
            assert_eq!(visible(&format!("a{c}b")), format!("a\\u{{{:x}}}b", u32::from(c)));
        }
        let plain = "Brüls, Δω · 10 µs, 日本, \u{1f600}";
        assert!(matches!(visible(plain), Cow::Borrowed(same) if same == plain));
    }

    #[test]
    fn json_keeps_its_value() {
        let name = "\u{1b}\u{9b}\u{202e}\"\n\u{7f}";
        let written = serde_json::to_string(name).unwrap();
        let shown = visible_json(&written);
        assert!(shown.is_ascii() && !shown.contains('\u{7f}'), "{shown}");
        assert_eq!(serde_json::from_str::<String>(&shown).unwrap(), name);
    }
}
