//! Trajectories as simulators write them: read with their claims, or refused by line and column.

use polhode::audit::{Attitudes, Direction, Frame, QuaternionOrder};
use polhode::units::{AngleUnit, RateUnit};
use polhode_files::trajectory::{FoundTrajectory, read};
use polhode_files::{ColumnNames, ReadOptions};

fn found(text: &str, columns: &str) -> Result<FoundTrajectory, String> {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("run.csv");
    std::fs::write(&path, text).unwrap();
    let mut reading = ReadOptions::default();
    if !columns.is_empty() {
        reading.columns = ColumnNames::parse(columns).unwrap();
    }
    read(&path, &reading).map_err(|error| {
        error.to_string().rsplit_once("run.csv").map_or(String::new(), |(_, rest)| rest.into())
    })
}

fn quaternions(found: &FoundTrajectory, body: usize) -> &[[f64; 4]] {
    match &found.bodies[body].1.attitude {
        Some(Attitudes::Quaternions(rows)) => rows,
        other => panic!("{other:?}"),
    }
}

#[test]
fn tables_with_a_header_in_a_comment_or_in_none() {
    for text in ["t,w,x,y,z\n0,1,0,0,0\n1,0,1,0,0\n", "# t w x y z\n0 1 0 0 0\n1  0 1 0 0\n"] {
        let found = found(text, "").unwrap();
        assert_eq!(found.bodies[0].1.times, [0.0, 1.0]);
        assert_eq!(quaternions(&found, 0), [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]]);
        assert_eq!(found.claims.quaternion, Some(QuaternionOrder::ScalarFirst));
    }
    let found = found("0;1;2;3;4\n5;6;7;8;9\n", "t=1,q0=2,q1=3,q2=4,q3=5").unwrap();
    assert_eq!((quaternions(&found, 0)[1], found.claims.quaternion), ([6.0, 7.0, 8.0, 9.0], None));
}

/// The messages of flight controllers define times, the place of the scalar, units and axes; the same numbers under other names
/// claim nothing.
#[test]
fn messages_claim_what_their_definitions_state() {
    let (first, body) = (Some(QuaternionOrder::ScalarFirst), Some(Frame::Body));
    for (header, order, frame, times) in [
        ("timestamp,timestamp_sample,q[0],q[1],q[2],q[3]", first, None, [21.0, 21.01]),
        ("timestamp,delta_q_reset[0],q[0],q[1],q[2],q[3]", first, None, [21.0, 21.01]),
        ("TimeUS,C,Q1,Q2,Q3,Q4", first, None, [21.0, 21.01]),
        ("time_usec,id_of_row,q1,q2,q3,q4,rollspeed,pitchspeed,yawspeed", first, body, [21.0, 21.01]),
        ("t (us),n,Quat_q0,Quat_q1,Quat_q2,Quat_q3", first, None, [21.0, 21.01]),
        ("timestamp,n,q[0],q[1],q[2],q[3]", None, None, [21e6, 21.01e6]),
        ("time_us,n,q1,q2,q3,q4", None, None, [21.0, 21.01]),
    ] {
        let rates = if frame.is_some() { ",0,0,1" } else { "" };
        let found = found(&format!("{header}\n21000000,7,1,0,0,0{rates}\n21010000,7,0,1,0,0{rates}\n"), "");
        let found = found.unwrap_or_else(|error| panic!("{header}: {error}"));
        assert_eq!((found.claims.quaternion, found.claims.omega_frame), (order, frame), "{header}");
        assert_eq!(quaternions(&found, 0)[1], [0.0, 1.0, 0.0, 0.0], "{header}");
        for (time, expected) in found.bodies[0].1.times.iter().zip(times) {
            assert!((time / expected - 1.0).abs() < 1e-15, "{header}: {time}");
        }
    }
    let angles =
        found("time_boot_ms,roll,pitch,yaw,rollspeed,pitchspeed,yawspeed\n1,0,0,0,0,0,1\n", "").unwrap();
    let claims = angles.claims;
    assert_eq!(
        (claims.angle_unit, claims.rate_unit),
        (Some(AngleUnit::Radians), Some(RateUnit::RadiansPerSecond))
    );
}

/// Roll, pitch and yaw beside a quaternion are read by nobody, and told.
#[test]
fn a_quaternion_is_read_and_the_angles_beside_it_are_told() {
    let found = found("t,yaw,pitch,roll,qw,qx,qy,qz\n0,7,8,9,1,0,0,0\n", "").unwrap();
    assert_eq!(quaternions(&found, 0), [[1.0, 0.0, 0.0, 0.0]]);
    assert_eq!(found.unread, ["yaw", "pitch", "roll"]);
    assert!(found.second_attitude.is_empty(), "{:?}", found.second_attitude);
}

/// A sensor that estimates no attitude writes zeros beside its rates.
#[test]
fn an_attitude_of_zeros_beside_rates_is_none() {
    let zeros = "t,qw,qx,qy,qz,wx,wy,wz\n0,0,0,0,0,1,2,3\n1,0,0,0,0,4,5,6\n";
    let read = found(zeros, "").unwrap();
    assert!(read.bodies[0].1.attitude.is_none() && read.claims.quaternion.is_none());
    assert_eq!(read.bodies[0].1.rates, Some(vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]));
    assert_eq!(read.unread, ["qw", "qx", "qy", "qz"]);
    // in some rows only it is refused
    let later = found(&zeros.replace("1,0,0,0,0", "1,1,0,0,0"), "").unwrap_err();
    assert!(
        later.starts_with(", line 3, column 2 (qw): '1': an attitude, and the first row has none"),
        "{later}"
    );
    let earlier = found(&zeros.replace("0,0,0,0,0,1", "0,1,0,0,0,1"), "").unwrap_err();
    assert!(earlier.starts_with(", line 3, column 2 (qw): '0': every component"), "{earlier}");
}

#[test]
fn generalized_positions_of_two_free_joints() {
    let header = |stem: &str, n: usize| (0..n).map(|k| format!(",{stem}_{k}")).collect::<String>();
    let row: String = (0..26).map(|k| format!(",{k}")).collect();
    let text = format!("time{}{}\n0{row}\n", header("qpos", 14), header("qvel", 12));
    let found = found(&text, "").unwrap();
    assert_eq!(quaternions(&found, 1), [[10.0, 11.0, 12.0, 13.0]]);
    assert_eq!(found.bodies[1].1.rates, Some(vec![[23.0, 24.0, 25.0]]));
    assert_eq!(found.bodies[1].0.as_deref(), Some("free joint 2"));
    assert_eq!(found.claims.omega_frame, Some(Frame::Body));
}

#[test]
fn dumps_and_ids_part_the_bodies() {
    let block = |step: u32| {
        format!(
            "ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n\
             ITEM: ATOMS id c_q[1] c_q[2] c_q[3] c_q[4] angmomx angmomy angmomz\n\
             7 {step} 0 0 1 1 2 3\n3 1 0 0 0 4 5 6\n"
        )
    };
    // the second row would not be read
    let error = found(&block(0).replace("ATOMS\n2", "ATOMS\n1"), "").unwrap_err();
    assert!(error.starts_with(", line 11: one row more than the 1 that the block announces"), "{error}");
    let found = found(&(block(0) + &block(100)), "").unwrap();
    assert!(found.counts_steps);
    assert_eq!(found.bodies[0].0.as_deref(), Some("7"));
    assert_eq!(found.bodies[0].1.times, [0.0, 100.0]);
    assert_eq!(quaternions(&found, 0)[1], [100.0, 0.0, 0.0, 1.0]);
    assert_eq!(found.bodies[1].1.momentum, Some(vec![[4.0, 5.0, 6.0]; 2]));
    assert_eq!(found.claims.attitude, Some(Direction::BodyToSpace));
}

/// What the names of one body claim is claimed of all.
#[test]
fn bodies_of_one_file_claim_one_convention() {
    let quaternion = |body: &str| ["w", "x", "y", "z"].map(|part| format!("{body}_q{part}")).join(",");
    let rates =
        |body: &str, frame: &str| ["x", "y", "z"].map(|axis| format!("{body}_w{axis}_{frame}")).join(",");
    let (one, two) = (quaternion("box1"), quaternion("box2"));
    let both = |frames: [&str; 2]| {
        let [first, second] = [rates("box1", frames[0]), rates("box2", frames[1])];
        found(&format!("t,{one},{first},{two},{second}\n0,1,0,0,0,0,0,1,1,0,0,0,0,0,1\n"), "")
    };
    let error = both(["body", "space"]).unwrap_err();
    assert!(error.contains("box2_wx_space") && error.contains("another convention"), "{error}");
    assert_eq!(both(["space"; 2]).unwrap().claims.omega_frame, Some(Frame::Space));
    // also where the first has no such columns
    let of_second = rates("box2", "space");
    let found = found(&format!("t,{one},{two},{of_second}\n0,1,0,0,0,1,0,0,0,0,0,1\n"), "").unwrap();
    assert_eq!(found.claims.omega_frame, Some(Frame::Space));
}

#[test]
fn what_cannot_be_read_is_refused_with_line_and_column() {
    for (text, columns, says) in [
        ("", "", ": no rows"),
        ("t,w,x,y,z\n", "", ": no rows"),
        ("t,a,b\n0,1,2\n", "", ", line 1: no attitude and no angular velocity among the columns"),
        (
            "a,w,x,y,z\n0,1,0,0,0\n",
            "",
            ", line 1: no column for time; the header has 'a', 'w', 'x', 'y', 'z'; name",
        ),
        ("0,1\n", "", ": no column for time; the header has none"),
        (
            "t,w,x,y,z\n0,1,0,0\n",
            "",
            ", line 2: the row has 4 of 5 columns; leave the row out, or complete it",
        ),
        ("t,w,x,y,z\n0,1,0,,0\n", "", ", line 2, column 4 (y): a number is missing"),
        ("t,w,x,y,z\n0,1,0,0,x\n", "", ", line 2, column 5 (z): 'x': is not a number"),
        ("t,w,x,y,z\n0,1,0,0,nan\n", "", ", line 2, column 5 (z): 'nan': is not a finite number"),
        (
            "t,w,x,y,z\n1,1,0,0,0\n1,1,0,0,0\n",
            "",
            ", line 3, column 1 (t): '1': does not come after the time",
        ),
        ("t,wx,wy,wz\n", "wx=q", ", line 1: no column for 'q'; the header has 't', 'wx', 'wy', 'wz'"),
        (
            "t,wx,wy,wz\n",
            "wx=wx,wy=2",
            ", line 1: only a part of wx, wy, wz in --columns: wz=NAME is missing;",
        ),
        (
            "t,wx,wy,wz,gyro_x,gyro_y,gyro_z\n",
            "",
            ", line 1: two angular velocities: one from column 'wx' on, one from 'gyro_x'",
        ),
        ("t,qpos0,qpos1\n", "", ", line 1: 2 columns qpos and 0 columns qvel are not those of free joints"),
    ] {
        let error = found(text, columns).err().unwrap_or_default();
        assert!(error.starts_with(says), "{text:?}: {error}");
    }
}

/// LAMMPS writes units and time before the step: `dump_modify units yes time yes`.
#[test]
fn dumps_tell_their_time_before_the_step() {
    let block = |time: &str, step: u32| {
        format!(
            "ITEM: UNITS\nlj\nITEM: TIME\n{time}\nITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n\
             0 1\n0 1\n0 1\nITEM: ATOMS id c_q[1] c_q[2] c_q[3] c_q[4]\n1 1 0 0 0\n"
        )
    };
    let text = block("0", 0) + &block("0.5", 100);
    let moving = text
        .replace("c_q[4]\n", "c_q[4] omegax omegay omegaz angmomx angmomy angmomz\n")
        .replace("1 1 0 0 0\n", "1 1 0 0 0 0.25 0 0 0 2 0\n");
    for (style, unit) in [("lj", 1.0), ("real", 1e-15), ("metal", 1e-12), ("micro", 1e-6), ("si", 1.0)] {
        let moving = moving.replace("\nlj\n", &format!("\n{style}\n"));
        let untimed = moving.replace("ITEM: TIME\n0\n", "").replace("ITEM: TIME\n0.5\n", "");
        let (found, untimed) = (found(&moving, "").unwrap(), found(&untimed, "").unwrap());
        let body = &found.bodies[0].1;
        let near = |value: f64, expected: f64| (value / expected - 1.0).abs() < 1e-12;
        assert!(near(body.times[1], 0.5 * unit), "{style}: {:?}", body.times);
        // rates and momenta go with the times
        assert!(near(body.rates.as_ref().unwrap()[1][0], 0.25 / unit), "{style}: {:?}", body.rates);
        assert!(near(body.momentum.as_ref().unwrap()[1][1], 2.0 / unit), "{style}: {:?}", body.momentum);
        // without times too, where the steps are counted
        let rates = untimed.bodies[0].1.rates.as_ref().unwrap();
        assert!(near(rates[1][0], 0.25 / unit), "{style}: {rates:?}");
    }
    let error = found(&text.replace("\nlj\n", "\nreel\n"), "").unwrap_err();
    assert!(error.starts_with(", line 2: 'reel': unknown unit; known: lj, real"), "{error}");
    let found = found(&text, "").unwrap();
    assert!(!found.counts_steps);
    assert_eq!(found.bodies[0].1.times, [0.0, 0.5]);
}
