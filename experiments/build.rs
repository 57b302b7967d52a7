//! Records which source and which compiler made the binary, for `run.toml`.

use std::process::Command;

/// Paths whose changes make a commit "dirty"; results and pages do not.
const SOURCES: [&str; 6] = ["../src", "../crates", "src", "../Cargo.toml", "../Cargo.lock", "Cargo.toml"];

fn main() {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    set("POLHODE_RUSTC", output(&rustc, &["--version"]));
    set("POLHODE_PROFILE", profile());
    set("POLHODE_TARGET", std::env::var("TARGET").ok());
    set("POLHODE_COMMIT", output("git", &["rev-parse", "HEAD"]));
    let status = [&["status", "--porcelain", "--"][..], &SOURCES].concat();
    set("POLHODE_DIRTY", output("git", &status).map(|changes| (!changes.is_empty()).to_string()));

    for source in SOURCES {
        println!("cargo::rerun-if-changed={source}");
    }
    if let Some(log) = output("git", &["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo::rerun-if-changed={log}");
    }
}

/// Cargo names the profile of which another is made: `paper` is the release with these experiments optimised.
fn profile() -> Option<String> {
    let (profile, level) = (std::env::var("PROFILE").ok()?, std::env::var("OPT_LEVEL").ok()?);
    Some(if profile == "release" && level != "0" { "paper".into() } else { profile })
}

fn set(name: &str, value: Option<String>) {
    println!("cargo::rustc-env={name}={}", value.as_deref().unwrap_or("unknown"));
}

fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_string())
}
