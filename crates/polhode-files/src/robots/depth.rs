//! How deep the elements of an XML text are nested, counted before anything recursive reads it.

use std::path::Path;

use crate::error::Error;

/// Elements inside each other; models of robots have some thirty.
pub(super) const MOST: usize = 500;

/// # Errors
/// The first element that stands deeper than that, with its line.
pub(super) fn check(path: &Path, text: &str) -> Result<(), Error> {
    match too_deep(text) {
        None => Ok(()),
        Some(at) => {
            let line = 1 + text.as_bytes()[..at].iter().filter(|byte| **byte == b'\n').count();
            let place = format!("{}:{line}", path.display());
            let rule = format!("elements are nested {} deep, and at most {MOST} are read", MOST + 1);
            Err(Error::input(&place, "", &rule, "is this the right file?"))
        }
    }
}

/// Where the first element begins that stands too deep. Of a text that is no XML the count may be wrong; it is refused later.
fn too_deep(text: &str) -> Option<usize> {
    let mut depth = 0_usize;
    let mut at = 0;
    while let Some(start) = text[at..].find('<').map(|place| at + place) {
        let rest = &text[start..];
        let behind = |end: &str| rest.find(end).map_or(text.len(), |place| start + place + end.len());
        at = if rest.starts_with("<!--") {
            behind("-->")
        } else if rest.starts_with("<![CDATA[") {
            behind("]]>")
        } else if rest.starts_with("<?") {
            behind("?>")
        } else if rest.starts_with("<!") {
            behind(">")
        } else if rest.starts_with("</") {
            depth = depth.saturating_sub(1);
            behind(">")
        } else {
            let end = start + tag(rest);
            if !text[..end].ends_with("/>") {
                depth += 1;
            }
            if depth > MOST {
                return Some(start);
            }
            end
        };
    }
    None
}

/// Bytes of the tag at the beginning of `text`, whose attributes may hold `>`.
fn tag(text: &str) -> usize {
    let mut quote = None;
    for (place, byte) in text.bytes().enumerate() {
        match (quote, byte) {
            (Some(open), _) if open == byte => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'>') => return place + 1,
            (None, _) => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nested(depth: usize) -> String {
        format!("{}{}", "<a>\n".repeat(depth), "</a>".repeat(depth))
    }

    #[test]
    fn depth_is_that_of_elements_alone() {
        assert_eq!(too_deep(&nested(MOST)), None);
        assert_eq!(too_deep(&nested(MOST + 1)), Some(4 * MOST));
        // what stands beside each other, is closed at once, or is no element
        for one in ["<a></a>", "<a/>", "<a b=\">\" c='/>'/>", "<!-- <a> -->", "<![CDATA[<a>]]>", "<?a <b> ?>"]
        {
            assert_eq!(too_deep(&one.repeat(2 * MOST)), None, "{one}");
        }
        // a slash in an attribute closes nothing
        let open = "<a b=\"/\">";
        assert_eq!(too_deep(&open.repeat(MOST + 1)), Some(open.len() * MOST));
        // no end in sight
        for text in ["<", "<a", "<!--", "<a b=\"", "</", "é<"] {
            assert_eq!(too_deep(text), None);
        }
    }

    #[test]
    fn the_line_is_told() {
        let error = check(Path::new("robot.urdf"), &nested(20_000)).unwrap_err().to_string();
        let expected =
            "robot.urdf:501: elements are nested 501 deep, and at most 500 are read; is this the right file?";
        assert_eq!(error, expected);
    }
}
