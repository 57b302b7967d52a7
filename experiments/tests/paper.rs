//! The articles name only files that exist, and no result is typed into them.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::PathBuf;

fn root() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// The sources of the articles, with comments taken out.
fn sources() -> Vec<(String, String)> {
    let paper = root().join("paper");
    let mut found = Vec::new();
    for folder in ["", "exact", "phase", "tensor"] {
        let Ok(entries) = fs::read_dir(paper.join(folder)) else { continue };
        for path in entries.map(|entry| entry.unwrap().path()) {
            if path.extension().is_some_and(|ending| ending == "tex") {
                let text = fs::read_to_string(&path).unwrap();
                found.push((path.display().to_string(), text.lines().map(without_comment).collect()));
            }
        }
    }
    found
}

fn without_comment(line: &str) -> String {
    let end = line.match_indices('%').find(|(at, _)| !line[..*at].ends_with('\\')).map(|(at, _)| at);
    format!("{}\n", &line[..end.unwrap_or(line.len())])
}

/// The arguments in braces after each `command`, or after its options in brackets.
fn arguments<'a>(text: &'a str, command: &str) -> Vec<&'a str> {
    let after = text.match_indices(command).map(|(at, _)| &text[at + command.len()..]);
    after
        .filter_map(|rest| {
            let rest = if rest.starts_with('[') { rest.split_once(']')?.1 } else { rest };
            Some(rest.strip_prefix('{')?.split_once('}')?.0)
        })
        .collect()
}

#[test]
fn every_file_that_the_article_names_is_there() {
    for (path, text) in sources() {
        let mut named = Vec::new();
        for command in ["\\input", "\\include", "\\includegraphics", "\\bibliography"] {
            named.extend(arguments(&text, command));
        }
        let csv = text.split(['{', '}']).filter(|word| word.ends_with(".csv"));
        for name in named.into_iter().chain(csv) {
            let there = ["", ".tex", ".bib", ".pdf"]
                .iter()
                .any(|ending| root().join("paper").join(format!("{name}{ending}")).is_file());
            assert!(
                there,
                "{path} names {name}, which is not there; publishing makes the files under generated/"
            );
        }
    }
}

#[test]
fn every_citation_and_reference_has_its_target() {
    let sources = sources();
    let all: String = sources.iter().map(|(_, text)| text.as_str()).collect();
    let bibliography = fs::read_to_string(root().join("paper/references.bib")).unwrap_or_default();
    for key in arguments(&all, "\\cite").iter().flat_map(|keys| keys.split(',')) {
        assert!(bibliography.contains(&format!("{{{},\n", key.trim())), "{key} is not in references.bib");
    }
    for label in arguments(&all, "\\ref").into_iter().filter(|label| label.contains(':')) {
        assert!(all.contains(&format!("{{{label}}}")), "{label} is referred to and not defined");
    }
}

/// Numbers in scientific notation, `1e-9` or `10^{-9}`: what results look like.
fn results(text: &str) -> Vec<&str> {
    let is_result = |word: &&str| {
        let scientific = word.split_once(['e', 'E']).is_some_and(|(mantissa, exponent)| {
            mantissa.ends_with(|c: char| c.is_ascii_digit())
                && exponent.trim_start_matches(['+', '-']).starts_with(|c: char| c.is_ascii_digit())
        });
        scientific || word.contains("10^") || word.contains("10⁻")
    };
    text.split_whitespace().filter(is_result).collect()
}

#[test]
fn results_are_recognised() {
    assert_eq!(results("is 4.3e-10 or $2\\cdot10^{-9}$, at 1E5 and 10⁻⁹").len(), 4);
    assert_eq!(results("3-2-1, h^2, order-8, [1,2,3], 2e, e3, The 2nd edition"), [""; 0]);
}

#[test]
fn no_result_is_typed_into_the_article() {
    for (path, text) in sources() {
        assert_eq!(results(&text), [""; 0], "{path}: numbers come from generated files");
    }
}

#[test]
fn no_result_is_typed_into_the_readme() {
    let text = fs::read_to_string(root().join("README.md")).unwrap();
    let mut typed = String::new();
    let (mut generated, mut fenced) = (false, false);
    for line in text.lines() {
        fenced ^= line.starts_with("```");
        match line {
            line if line.starts_with("<!-- begin generated: ") => generated = true,
            "<!-- end generated -->" => generated = false,
            _ if !generated && !fenced => typed += &format!("{line}\n"),
            _ => {}
        }
    }
    assert!(!generated, "a generated block is not closed");
    assert_eq!(results(&typed), [""; 0]);
    // a table that somebody typed
    assert!(!typed.lines().any(|line| line.starts_with('|') && line.contains(|c: char| c.is_ascii_digit())));
}

#[test]
fn every_generated_file_is_named_by_the_article() {
    let all: String = sources().into_iter().map(|(_, text)| text).collect();
    let Ok(entries) = fs::read_dir(root().join("paper/generated")) else { return };
    for name in entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()) {
        let input = format!("{{generated/{}}}", name.strip_suffix(".tex").unwrap_or(&name));
        assert!(all.contains(&input), "nobody reads paper/generated/{name}: delete it");
    }
}

#[test]
fn generated_files_name_what_made_them() {
    let Ok(entries) = fs::read_dir(root().join("paper/generated")) else { return };
    for path in entries.map(|entry| entry.unwrap().path()) {
        if path.extension().is_some_and(|ending| ending == "tex") {
            let text = fs::read_to_string(&path).unwrap();
            let first = text.lines().next().unwrap_or_default();
            let origin = first.contains(", commit ") && first.ends_with("scale paper");
            assert!(
                origin
                    || first.starts_with("% catalogue of methods")
                    || first.starts_with("% style of figures"),
                "{}: {first}",
                path.display()
            );
        }
    }
}
