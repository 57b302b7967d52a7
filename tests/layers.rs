//! Imports obey the order of the layers: num ← rotation ← body ← flow ← observe ← method ← run.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::fs;
use std::path::{Path, PathBuf};

const ORDER: [&str; 7] = ["num", "rotation", "body", "flow", "observe", "method", "run"];

/// The layers that code in `layer` may name.
fn allowed(layer: &str) -> Vec<&'static str> {
    match layer {
        "fit" => vec!["fit", "num", "rotation", "body", "flow", "observe"],
        "catalog" => vec!["catalog", "num", "rotation", "body"],
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

/// Layers named as `crate::layer` in the code of `text`, comments and test modules left out.
fn imports(text: &str) -> Vec<String> {
    let code: String = text
        .split("#[cfg(test)]")
        .next()
        .unwrap_or_default()
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n");
    code.match_indices("crate::")
        .map(|(at, matched)| {
            let rest = &code[at + matched.len()..];
            rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
        })
        .filter(|name: &String| !name.is_empty())
        .collect()
}

#[test]
fn no_layer_imports_from_above() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut seen = 0;
    for path in sources(&src) {
        let relative = path.strip_prefix(&src).unwrap();
        let first = relative.components().next().unwrap().as_os_str().to_str().unwrap();
        let layer = first.trim_end_matches(".rs");
        if layer == "lib" {
            continue;
        }
        let allowed = allowed(layer);
        for import in imports(&fs::read_to_string(&path).unwrap()) {
            seen += 1;
            assert!(
                allowed.contains(&import.as_str()),
                "{} imports crate::{import} from above",
                relative.display()
            );
        }
    }
    assert!(seen > 20, "only {seen} imports found: the scan is blind");
}

#[test]
fn an_upward_import_would_be_seen() {
    assert_eq!(
        imports("use crate::run::Run;\n// crate::flow\nfn f() { crate::num::Dd::of(1.0); }"),
        ["run", "num"]
    );
    assert!(!allowed("body").contains(&"run"));
}
