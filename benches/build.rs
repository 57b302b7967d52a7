//! Tells the benchmarks how they are compiled.

fn main() {
    let level = std::env::var("OPT_LEVEL").unwrap_or_default();
    println!("cargo:rustc-env=POLHODE_OPT_LEVEL={level}");
    println!("cargo:rerun-if-changed=build.rs");
}
