//! Imports obey the order of the layers: num ← rotation ← inertia ← body ← flow ← observe ← method ← run ←
//! advise ← audit.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::fs;
use std::path::{Path, PathBuf};

const ORDER: [&str; 10] =
    ["num", "rotation", "inertia", "body", "flow", "observe", "method", "run", "advise", "audit"];

/// The layers that code in `layer` may name.
fn allowed(layer: &str) -> Vec<&'static str> {
    match layer {
        "fit" => vec!["fit", "num", "rotation", "inertia", "body", "flow", "observe"],
        "catalogue" => vec!["catalogue", "num", "rotation", "inertia", "body"],
        _ => {
            let rank = ORDER.iter().position(|name| *name == layer);
            let rank = rank.unwrap_or_else(|| panic!("src/{layer} has no place in the order of the layers"));
            ORDER[..=rank].to_vec()
        }
    }
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found
}

/// Names and marks of Rust code, without comments, strings, characters and lifetimes; `::` is one mark.
fn tokens(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if let Some(hashes) = raw_string(rest) {
            let end = format!("\"{}", "#".repeat(hashes));
            let start = rest.find('"').unwrap() + 1;
            rest[start..].find(&end).map_or(rest.len(), |at| start + at + end.len())
        } else if first == '"' {
            quoted(rest, '"')
        } else if first == '\'' {
            // a lifetime has no closing quote behind its first letter
            let closing = rest.char_indices().nth(2).filter(|(_, c)| *c == '\'');
            if rest.starts_with("'\\") || closing.is_some() { quoted(rest, '\'') } else { 1 }
        } else if is_name(first) {
            rest.find(|c| !is_name(c)).unwrap_or(rest.len())
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        let token = &rest[..length];
        if is_name(first) && !token.contains('"') || token == "::" || "{}#[],;*()".contains(token) {
            found.push(token.to_owned());
        }
        rest = &rest[length..];
    }
    found
}

/// The number of hashes of a raw string that begins here.
fn raw_string(text: &str) -> Option<usize> {
    let after = text.strip_prefix('r').or_else(|| text.strip_prefix("br"))?;
    let hashes = after.len() - after.trim_start_matches('#').len();
    after[hashes..].starts_with('"').then_some(hashes)
}

/// Length of the literal that begins here and ends with `quote`.
fn quoted(text: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            '\\' if !escaped => escaped = true,
            c if c == quote && !escaped => return at + c.len_utf8(),
            _ => escaped = false,
        }
    }
    text.len()
}

/// The same without the items behind `#[cfg(test)]`.
fn without_tests(tokens: &[String]) -> Vec<String> {
    let mark: Vec<String> = ["#", "[", "cfg", "(", "test", ")", "]"].map(String::from).into();
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if tokens[at..].starts_with(&mark) {
            let (mut depth, mut end) = (0, at + mark.len());
            // to the end of the item: its closing brace, or a semicolon outside of braces
            loop {
                match tokens.get(end).map(String::as_str) {
                    Some("{") => depth += 1,
                    Some("}") => depth -= 1,
                    Some(";") if depth == 0 => break,
                    None => break,
                    _ => {}
                }
                if depth == 0 && tokens[end] == "}" {
                    break;
                }
                end += 1;
            }
            at = end + 1;
        } else {
            kept.push(tokens[at].clone());
            at += 1;
        }
    }
    kept
}

/// The layers that the module `path` (its layer first) names by `crate::` or by `super::` beyond its own layer, in trees
/// of `use` of any shape and in paths anywhere in the code.
fn imports(text: &str, path: &[&str]) -> Vec<String> {
    let tokens = without_tests(&tokens(text));
    let mut found = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        let begins = at == 0 || tokens[at - 1] != "::";
        match token.as_str() {
            "crate" if begins && tokens.get(at + 1).is_some_and(|next| next == "::") => {
                heads(&tokens, at + 2, 0, &mut found);
            }
            "super" if begins => {
                let mut levels = 1;
                while tokens[at + 1..].get(2 * levels - 1).is_some_and(|next| next == "super") {
                    levels += 1;
                }
                // as many levels up as the module is deep lead to the root of the crate
                let above = (levels >= path.len()).then_some(at + 2 * levels);
                if let Some(head) = above {
                    heads(&tokens, head, levels - path.len(), &mut found);
                }
            }
            _ => {}
        }
    }
    found
}

/// The first names of the tree of paths that begins at `at`: one, or those in braces.
fn heads(tokens: &[String], at: usize, above: usize, found: &mut Vec<String>) {
    assert_eq!(above, 0, "a path that leads above the crate");
    match tokens.get(at).map(String::as_str) {
        Some("{") => {
            let (mut depth, mut head, mut at) = (1, true, at + 1);
            while depth > 0 {
                let token = tokens[at].as_str();
                match token {
                    "{" => depth += 1,
                    "}" => depth -= 1,
                    "," if depth == 1 => head = true,
                    name if head && depth == 1 => {
                        found.push(name.to_owned());
                        head = false;
                    }
                    _ => {}
                }
                at += 1;
            }
        }
        Some("*") => panic!("crate::* names every layer"),
        Some(name) => found.push(name.to_owned()),
        None => {}
    }
}

/// The module that a file under `src` is, its layer first.
fn module(relative: &Path) -> Vec<&str> {
    let mut parts: Vec<&str> = relative.iter().map(|part| part.to_str().unwrap()).collect();
    let file = parts.pop().unwrap().trim_end_matches(".rs");
    if file != "mod" {
        parts.push(file);
    }
    parts
}

#[test]
fn no_layer_imports_from_above() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut seen = 0;
    for path in sources(&src) {
        let relative = path.strip_prefix(&src).unwrap();
        let module = module(relative);
        if module == ["lib"] {
            continue;
        }
        let allowed = allowed(module[0]);
        for import in imports(&fs::read_to_string(&path).unwrap(), &module) {
            seen += 1;
            assert!(allowed.contains(&import.as_str()), "{} imports {import} from above", relative.display());
        }
    }
    assert!(seen > 100, "only {seen} imports found: the scan is blind");
}

#[test]
fn an_upward_import_of_any_shape_would_be_seen() {
    let found = |text: &str| imports(text, &["num", "sum"]);
    assert_eq!(
        found("use crate::run::Run;\n// crate::flow\nfn f() { crate::num::Dd::of(1.0); }"),
        ["run", "num"]
    );
    assert_eq!(found("use crate::{run::Schedule as _, num::{Dd, Real}, flow};"), ["run", "num", "flow"]);
    assert_eq!(
        found("pub(crate) use crate::{\n    num::{\n        Dd, // crate::fit\n    },\n    run,\n};"),
        ["num", "run"]
    );
    assert_eq!(found("use super::super::run::Run; use super::Real;"), ["run"]);
    assert_eq!(found("use super::super::{run::{Run, Schedule}, body};"), ["run", "body"]);
    assert_eq!(
        found(
            "#[cfg(test)]\nmod tests { use crate::fit::Record; }\nfn after() -> crate::method::Rk4 { todo() }"
        ),
        ["method"]
    );
    assert_eq!(found("#[cfg(test)]\nuse crate::fit::Record;\nuse crate::run::Run;"), ["run"]);
    assert_eq!(
        found(
            r##"const A: &str = "use crate::run;"; const B: &str = r#"crate::"fit"#; fn f<'a>() { crate::flow::g('{') }"##
        ),
        ["flow"]
    );
    assert_eq!(found("/* use crate::run; */ use crate :: body :: Body;"), ["body"]);
    assert!(!allowed("body").contains(&"run"));
    assert_eq!(module(Path::new("flow/theta.rs")), ["flow", "theta"]);
    assert_eq!(module(Path::new("flow/mod.rs")), ["flow"]);
}
