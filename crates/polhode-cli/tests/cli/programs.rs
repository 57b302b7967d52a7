//! Logs that simulators wrote themselves are read without help, and audit names how each of them integrates.

use std::path::{Path, PathBuf};

use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::harness::{run, words};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/programs")
}

/// The verdict on a file of that folder.
fn audit(flags: &str) -> Value {
    let (file, rest) = flags.split_once(' ').unwrap();
    let line = format!("audit {} {rest} --format json", folder().join(file).display());
    let answer = run(&line);
    assert_ne!(answer.code, 2, "{line}: {}", answer.err);
    let found: Value = serde_json::from_str(&answer.out).unwrap();
    assert_eq!(answer.code == 0, found["verdict"] == "right", "{line}");
    found
}

const ELLIPSOID: &str = "--id 1 --moments 0.05,0.068,0.082";
const OTHER: &str = "--id 2 --moments 0.085,0.101,0.065";

/// Two ellipsoids by the method of Richardson, and a rigid molecule by NO_SQUISH, in every form of a dump.
#[test]
fn dumps_of_lammps_are_read_and_its_integrators_named() {
    let steps = "--time-unit 0.01";
    let named = format!(
        "{steps} --columns t=timestep,id=id,qw=c_q[1],qx=c_q[2],qy=c_q[3],qz=c_q[4],lx=c_om[1],ly=c_om[2],lz=c_om[3]"
    );
    for body in [ELLIPSOID, OTHER] {
        // TIME and UNITS stand before TIMESTEP
        for flags in [format!("lammps-digits.dump {body}"), format!("lammps-triclinic.dump {body} {named}")] {
            let found = audit(&flags);
            assert_eq!(found["verdict"], "wrong", "{flags}");
            assert_eq!(found["suspect"], "integrator:richardson", "{flags}");
            let (reading, space) = (&found["reading"], "space");
            assert_eq!(
                (&reading["quaternion"], &reading["attitude"]),
                (&"wxyz".into(), &"body-to-space".into())
            );
            assert_eq!(reading["momentum_frame"], space);
        }
        // attitudes alone tell that it is wrong, and not by which method
        let (attitudes, _) = named.split_once(",lx=").unwrap();
        let found = audit(&format!("lammps-triclinic.dump {body} {attitudes}"));
        assert_eq!((&found["verdict"], &found["suspect"]), (&"wrong".into(), &"none".into()), "{found:#}");
        // six digits tell that it is wrong, and not by which method
        assert_eq!(audit(&format!("lammps-default.dump {body} {steps}"))["verdict"], "wrong");
        assert_eq!(
            audit(&format!("lammps-default.dump {body} {steps} --tolerance 1e-4"))["verdict"],
            "right"
        );
    }
    let rigid = audit(
        "lammps-rigid.dump --moments 1.16,2.18,2.98 --time-unit 0.02 \
         --columns t=timestep,qw=c_r[2],qx=c_r[3],qy=c_r[4],qz=c_r[5],wx=c_r[6],wy=c_r[7],wz=c_r[8]",
    );
    assert_eq!(rigid["suspect"], "integrator:lie-poisson:321");
    assert_eq!(rigid["reading"]["omega_frame"], "space");
}

#[test]
fn what_basilisk_records_is_right_also_as_numpy_stores_it() {
    let body = "--moments 10,20,26";
    let columns = "--columns t=1,s1=2,s2=3,s3=4,wx=5,wy=6,wz=7";
    let tight = "--tolerance 1e-9";
    for flags in [
        format!("basilisk.csv {body} {tight}"),
        format!("numpy.txt {body} {tight} {columns}"),
        format!("numpy.npy {body} {tight} {columns}"),
        // numbers of seven digits
        format!("records.npy {body}"),
    ] {
        let found = audit(&flags);
        assert_eq!(found["verdict"], "right", "{flags}");
        assert_eq!(
            (&found["reading"]["omega_frame"], &found["reading"]["attitude"]),
            (&"body".into(), &"body-to-space".into())
        );
    }
    let coarse = audit(&format!("records.npy {body} --tolerance 1e-9"));
    let fine = audit(&format!("basilisk.csv {body} --tolerance 1e-11"));
    // single precision decides nothing beyond its digits, double precision does
    assert_ne!(coarse["verdict"], "wrong");
    assert_eq!(fine["verdict"], "wrong");
}

#[test]
fn the_names_of_drake_carry_the_model_and_the_body() {
    let found = audit("drake.csv --moments 1,2,2.6 --tolerance 1e-2");
    assert_eq!(found["verdict"], "right");
    assert_eq!(found["reading"]["omega_frame"], "space");
    // its default accuracy
    assert_eq!(audit("drake.csv --moments 1,2,2.6 --tolerance 1e-5")["verdict"], "wrong");
}

#[test]
fn the_integrators_of_mujoco_are_named_and_what_to_switch_to() {
    let body = "--moments 1,2,2.5";
    let cases = [
        ("euler", "", "semi-implicit-euler"),
        ("implicit", "", "linearly-implicit-euler"),
        ("implicitfast", "", "linearly-implicit-euler"),
        ("rk4", "--tolerance 1e-8", "mujoco-rk4"),
    ];
    for (log, tolerance, method) in cases {
        let found = audit(&format!("mujoco-{log}.csv {body} {tolerance}"));
        assert_eq!(found["suspect"], format!("integrator:{method}"), "{log}: {found:#}");
        let step = found["integrator"]["step"].as_f64().unwrap();
        assert!((step - 0.05).abs() < 1e-9, "{log}: {found:#}");
        // without it where thought takes longer than two seconds
        let advice = &found["advice"];
        assert!(advice.is_null() || advice["step"].as_f64().unwrap() > 0.0, "{log}: {advice:#}");
    }
    // within the tolerance by default
    assert_eq!(audit(&format!("mujoco-rk4.csv {body}"))["verdict"], "right");
}

#[test]
fn the_logs_are_those_of_the_register() {
    let register = std::fs::read_to_string(folder().join("programs.toml")).unwrap();
    let register: toml::Table = register.parse().unwrap();
    assert_eq!(register.len(), 13);
    for (file, entry) in register {
        let digest = Sha256::digest(std::fs::read(folder().join(&file)).unwrap());
        let digest: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(entry["sha256"].as_str(), Some(digest.as_str()), "{file}");
        assert!(words(entry["program"].as_str().unwrap()).len() > 1, "{file} names its program and version");
    }
}
