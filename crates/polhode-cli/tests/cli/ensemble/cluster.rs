//! Shares started by real launchers, where they are installed; the scripts say so where they are not.

use std::path::Path;
use std::process::Command;

fn script(name: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cluster").join(name);
    let done = Command::new("bash").arg(&path).arg(env!("CARGO_BIN_EXE_polhode")).output().unwrap();
    let (out, err) = (String::from_utf8_lossy(&done.stdout), String::from_utf8_lossy(&done.stderr));
    assert!(done.status.success(), "{name}: {out}{err}");
    let is_same = out.contains("4 shards, 7 files: the bits of the run of all members");
    if let Some(skipped) = out.lines().find(|line| line.starts_with("skipped: ")) {
        println!("{name}: {skipped}");
    } else {
        assert!(is_same, "{name}: {out}{err}");
    }
}

#[test]
fn shares_of_mpirun_are_the_bits_of_one_run() {
    script("mpi.sh");
}

#[test]
fn shares_of_a_slurm_array_are_the_bits_of_one_run() {
    script("slurm.sh");
}
