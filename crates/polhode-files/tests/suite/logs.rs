//! Small samples of the logs that phones, flight controllers and sensors write, as their formats are documented: two rows
//! each, by hand, with the rates 0.5, -1 and 2 rad/s or deg/s and then 0.25, 1, -2.

use polhode::units::{RateUnit, TimeUnit};
use polhode_files::ColumnNames;
use polhode_files::record::{self, ReadOptions};

const DEGREE: f64 = core::f64::consts::PI / 180.0;

/// Times and rates of the only segment.
fn read(text: &str, reading: ReadOptions) -> (Vec<f64>, Vec<[f64; 3]>) {
    let record = record::read(text, "log", &reading).unwrap_or_else(|error| panic!("{error}\n{text}")).record;
    assert_eq!(record.segments.len(), 1, "{text}");
    let segment = &record.segments[0];
    (segment.times().to_vec(), segment.rates().iter().map(|w| [w.x, w.y, w.z]).collect())
}

/// Reads the sample `text`; its rows are 10 ms apart, and its rates are in `unit` rad/s.
fn check(name: &str, text: &str, unit: f64) {
    let (times, rates) = read(text, ReadOptions::default());
    assert_eq!(times.len(), 2, "{name}");
    assert!((times[1] - times[0] - 0.01).abs() < 1e-9, "{name}: {times:?}");
    for (found, expected) in rates.concat().into_iter().zip([0.5, -1.0, 2.0, 0.25, 1.0, -2.0]) {
        assert!((found - expected * unit).abs() < 1e-12, "{name}: {rates:?}");
    }
}

#[test]
fn phones() {
    check(
        "Sensor Logger",
        "time,seconds_elapsed,z,y,x\n1727600000250000000,0.25,2,-1,0.5\n1727600000260000000,0.26,-2,1,0.25\n",
        1.0,
    );
    check(
        "AndroSensor",
        "ACCELEROMETER X (m/s²);GYROSCOPE X (rad/s);GYROSCOPE Y (rad/s);GYROSCOPE Z (rad/s);Time since start in ms ;YYYY-MO-DD HH-MI-SS_SSS\n\
         0.1;0.5;-1;2;10;2025-11-22 10:20:30:120\n0.1;0.25;1;-2;20;2025-11-22 10:20:30:130\n",
        1.0,
    );
    check("Physics Toolbox", "time,wx,wy,wz\n0.01,0.5,-1,2\n0.02,0.25,1,-2\n", 1.0);
    check(
        "SensorLog of iOS",
        "loggingTime(txt),loggingSample(N),gyroTimestamp_sinceReboot(s),gyroRotationX(rad/s),gyroRotationY(rad/s),gyroRotationZ(rad/s),motionYaw(rad)\n\
         2025-11-22 10:20:30.123 +0100,1,5021.25,0.5,-1,2,0\n2025-11-22 10:20:30.133 +0100,2,5021.26,0.25,1,-2,0\n",
        1.0,
    );
    check(
        "SensorLog of iOS, motion alone",
        "loggingTime(txt),motionRotationRateX(rad/s),motionRotationRateY(rad/s),motionRotationRateZ(rad/s)\n\
         2025-11-22 10:20:30.123 +0100,0.5,-1,2\n2025-11-22 10:20:30.133 +0100,0.25,1,-2\n",
        1.0,
    );
    check(
        "MATLAB Mobile",
        "Timestamp,X,Y,Z\n22-Nov-2025 10:20:30.120,0.5,-1,2\n22-Nov-2025 10:20:30.130,0.25,1,-2\n",
        1.0,
    );
}

#[test]
fn phyphox_in_its_languages() {
    for (time, rate) in [
        ("Time (s)", "Gyroscope"),
        ("Zeit (s)", "Gyroskop"),
        ("Temps (s)", "Gyroscope"),
        ("Tiempo (s)", "Giroscopio"),
        ("Tempo (s)", "Giroscopio"),
        ("Tempo (s)", "Giroscópio"),
        ("Tijd (s)", "Gyroscoop"),
        ("Czas (s)", "Żyroskop"),
        ("Čas (s)", "Gyroskop"),
        ("Zaman (s)", "Jiroskop"),
        ("Χρόνος (s)", "Γυροσκόπιο"),
        ("Время (с)", "Гироскоп"),
        ("时间 (s)", "陀螺仪"),
        ("時間 (s)", "ジャイロスコープ"),
    ] {
        let head =
            format!("\"{time}\";\"{rate} x (rad/s)\";\"{rate} y (rad/s)\";\"{rate} z (rad/s)\";\"| |\"");
        check(time, &format!("{head}\n1,0E-2;5E-1;-1;2;9\n2,0E-2;2,5E-1;1;-2;9\n"), 1.0);
    }
}

#[test]
fn flight_controllers() {
    check(
        "PX4, sensor_combined",
        "timestamp,gyro_rad[0],gyro_rad[1],gyro_rad[2],gyro_integral_dt,accelerometer_m_s2[0]\n\
         21000000,0.5,-1,2,5000,0\n21010000,0.25,1,-2,5000,0\n",
        1.0,
    );
    check(
        "PX4, vehicle_angular_velocity",
        "timestamp,timestamp_sample,xyz[0],xyz[1],xyz[2],xyz_derivative[0],xyz_derivative[1],xyz_derivative[2]\n\
         21000100,21000000,0.5,-1,2,7,7,7\n21010100,21010000,0.25,1,-2,7,7,7\n",
        1.0,
    );
    let betaflight = "loopIteration, time (us), axisP[0], gyroADC[0], gyroADC[1], gyroADC[2], gyroUnfilt[0]\n\
                      0, 21000000, 4, 0.5, -1, 2, 3\n1, 21010000, 4, 0.25, 1, -2, 3\n";
    check("Betaflight", betaflight, DEGREE);
    // sixteen steps to a degree per second: 0.0625 as the bits of a float
    check("Betaflight with its scale", &format!("H gyro_scale:0x3d800000\n{betaflight}"), DEGREE / 16.0);
    let explored = betaflight.replace("time (us)", "time");
    check("blackbox explorer, bare time", &format!("\"gyro_scale\",\"1.0\"\n{explored}"), DEGREE);
    check("blackbox explorer", &format!("\"gyro_scale\",\"1.7453292519943295e-8\"\n{betaflight}"), DEGREE);
    check(
        "Betaflight in rad/s",
        &betaflight.replace("],", "] (rad/s),").replace("axisP[0] (rad/s)", "axisP[0]"),
        1.0,
    );
    check("flight dynamics", "t,p,q,r\n0.01,0.5,-1,2\n0.02,0.25,1,-2\n", 1.0);
    check("unit at the end", "time_ms,gyro_x_dps,gyro_y_dps,gyro_z_dps\n10,0.5,-1,2\n20,0.25,1,-2\n", DEGREE);
}

#[test]
fn robots() {
    check(
        "rostopic echo -p",
        "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.angular_velocity.x,field.angular_velocity.y,field.angular_velocity.z\n\
         1727600000250000000,1,1727600000249000000,imu,0.5,-1,2\n1727600000260000000,2,1727600000259000000,imu,0.25,1,-2\n",
        1.0,
    );
    check(
        "bag as a table",
        "header.seq,header.stamp.secs,header.stamp.nsecs,header.frame_id,angular_velocity.x,angular_velocity.y,angular_velocity.z\n\
         1,1727600000,995000000,imu,0.5,-1,2\n2,1727600001,5000000,imu,0.25,1,-2\n",
        1.0,
    );
    let covariance = "0,0,0,0,0,0,0,0,0";
    let row = |stamp: &str, rates: &str| {
        format!("{stamp},imu_link,0.1,0.2,0.3,0.9,{covariance},{rates},{covariance},0,0,9.8,{covariance}\n")
    };
    check(
        "ros2 topic echo --csv",
        &(row("1727600000,995000000", "0.5,-1,2") + &row("1727600001,5000000", "0.25,1,-2")),
        1.0,
    );
    let message = |seconds: &str, nanoseconds: &str, [x, y, z]: [&str; 3]| {
        format!(
            "header:\n  stamp:\n    sec: {seconds}\n    nanosec: {nanoseconds}\n  frame_id: imu\norientation:\n  x: 9\n  y: 9\n  z: 9\n  w: 9\n\
             angular_velocity:\n  x: {x}\n  y: {y}\n  z: {z}\nlinear_acceleration:\n  x: 7\n  y: 7\n  z: 7\n---\n"
        )
    };
    let echoed = message("1727600000", "995000000", ["0.5", "-1", "2"])
        + &message("1727600001", "5000000", ["0.25", "1", "-2"]);
    check("ros2 topic echo", &echoed, 1.0);
    check("rostopic echo", &echoed.replace("nanosec", "nsecs").replace("sec:", "secs:"), 1.0);
    let lacking = echoed.replacen("angular_velocity:\n  x: 0.5\n  y: -1\n  z: 2\n", "", 1);
    let refused = record::read(&lacking, "log", &ReadOptions::default()).unwrap_err().to_string();
    assert!(
        refused.starts_with("log, line 15, column 7 (angular_velocity.x): a number is missing"),
        "{refused}"
    );
}

/// Times and rates of messages, in the units that their definitions state.
#[test]
fn messages_with_their_units() {
    let log = |header: &str, time: [&str; 2], before: &str| {
        format!("{header}\n{},{before}0.5,-1,2\n{},{before}0.25,1,-2\n", time[0], time[1])
    };
    let (us, ns) = (["21000000", "21010000"], ["10000000", "20000000"]);
    let speeds = "rollspeed,pitchspeed,yawspeed";
    for (name, text) in [
        ("MAVLink, ATTITUDE", log(&format!("time_boot_ms,roll,pitch,yaw,{speeds}"), ["10", "20"], "0,0,0,")),
        (
            "MAVLink, ATTITUDE_QUATERNION",
            log(&format!("time_boot_ms,q1,q2,q3,q4,{speeds}"), ["10", "20"], "1,0,0,0,"),
        ),
        (
            "MAVLink, dumped",
            log(
                "timestamp,ATTITUDE.roll,ATTITUDE.pitch,ATTITUDE.yaw,ATTITUDE.rollspeed,ATTITUDE.pitchspeed,ATTITUDE.yawspeed",
                ["0.01", "0.02"],
                "0,0,0,",
            ),
        ),
        ("MAVLink, HIGHRES_IMU", log("time_usec,xacc,xgyro,ygyro,zgyro", us, "9,")),
        ("ArduPilot", log("TimeUS,I,GyrX,GyrY,GyrZ", us, "0,")),
        ("ArduPilot, with the message", log("IMU.TimeUS,IMU.I,IMU.GyrX,IMU.GyrY,IMU.GyrZ", us, "0,")),
        ("PX4, vehicle_attitude", log(&format!("timestamp,q[0],q[1],q[2],q[3],{speeds}"), us, "1,0,0,0,")),
        (
            "PX4, vehicle_odometry",
            log(
                "timestamp,timestamp_sample,q[0],q[1],q[2],q[3],angular_velocity[0],angular_velocity[1],angular_velocity[2]",
                us,
                "7,1,0,0,0,",
            ),
        ),
        (
            "ROS 1, Odometry",
            log(
                "%time,field.pose.pose.orientation.x,field.twist.twist.angular.x,field.twist.twist.angular.y,field.twist.twist.angular.z",
                ns,
                "0,",
            ),
        ),
        (
            "JSBSim",
            log(
                "Time,/fdm/jsbsim/velocities/p-rad_sec,/fdm/jsbsim/velocities/q-rad_sec,/fdm/jsbsim/velocities/r-rad_sec",
                ["0.01", "0.02"],
                "",
            ),
        ),
    ] {
        check(name, &text, 1.0);
    }
    // where two messages have a time, neither is that of the rows
    let two = log("IMU.TimeUS,ATT.TimeUS,IMU.GyrX,IMU.GyrY,IMU.GyrZ", us, "0,");
    let refused = record::read(&two, "log", &ReadOptions::default()).unwrap_err().to_string();
    assert!(refused.contains("no column for time"), "{refused}");
}

#[test]
fn boards_and_sensors() {
    check("Arduino, millis", "millis,gx,gy,gz\n10,0.5,-1,2\n20,0.25,1,-2\n", 1.0);
    check("Arduino, micros", "micros\tgX\tgY\tgZ\n10000\t0.5\t-1\t2\n20000\t0.25\t1\t-2\n", 1.0);
    check("Arduino, spelled out", "time_ms gyroX gyroY gyroZ\n10 0.5 -1 2\n20 0.25 1 -2\n", 1.0);
    check(
        "Xsens MT Manager",
        "// Start Time: Unknown\n// Update Rate: 100.0Hz\n// Filter Profile: human\nPacketCounter\tSampleTimeFine\tAcc_X\tGyr_X\tGyr_Y\tGyr_Z\n\
         11\t5000\t1\t0.5\t-1\t2\n12\t5100\t1\t0.25\t1\t-2\n",
        1.0,
    );
    check(
        "Xsens MT Manager, counter alone",
        "// Update Rate: 100.0Hz\nPacketCounter,Gyr_X,Gyr_Y,Gyr_Z\n11,0.5,-1,2\n12,0.25,1,-2\n",
        1.0,
    );
    check(
        "Xsens DOT",
        "sep=,\nDeviceTag: DOT1\nFirmwareVersion: 2.0.0\nPacketCounter,SampleTimeFine,Euler_X,Gyr_X,Gyr_Y,Gyr_Z\n\
         1,10000,3,0.5,-1,2\n2,20000,3,0.25,1,-2\n",
        DEGREE,
    );
    check(
        "MVN",
        "Frame rate,100\nSample rate: 100\nFrame,Sensor Angular Velocity x,Sensor Angular Velocity y,Sensor Angular Velocity z\n\
         0,0.5,-1,2\n1,0.25,1,-2\n",
        1.0,
    );
    check(
        "APDM",
        "Time (us),Accelerometer X (m/s^2),Gyroscope X (rad/s),Gyroscope Y (rad/s),Gyroscope Z (rad/s)\n\
         1727600000250000,1,0.5,-1,2\n1727600000260000,1,0.25,1,-2\n",
        1.0,
    );
    check(
        "mbient MetaWear",
        "epoc (ms),timestamp (+0200),elapsed (s),x-axis (deg/s),y-axis (deg/s),z-axis (deg/s)\n\
         1727600000250,2024-09-29T10.53.20.250,0.01,0.5,-1,2\n1727600000260,2024-09-29T10.53.20.260,0.02,0.25,1,-2\n",
        DEGREE,
    );
}

#[test]
fn times_of_the_clock_and_no_header() {
    check(
        "ISO 8601",
        "time,wx,wy,wz\n2025-11-22T10:20:30.120Z,0.5,-1,2\n2025-11-22T10:20:30.130Z,0.25,1,-2\n",
        1.0,
    );
    for (name, times) in [
        ("ms since 1970", ["1727600000250", "1727600000260"]),
        ("us since 1970", ["1727600000250000", "1727600000260000"]),
        ("ns since 1970", ["1727600000250000000", "1727600000260000000"]),
        ("s since 1970", ["1727600000.25", "1727600000.26"]),
    ] {
        let text = format!("timestamp,wx,wy,wz\n{},0.5,-1,2\n{},0.25,1,-2\n", times[0], times[1]);
        let (found, _) = read(&text, ReadOptions::default());
        assert!((found[1] - found[0] - 0.01).abs() < 3e-7, "{name}: {found:?}");
    }
    check("no header", "0.01,0.5,-1,2\n0.02,0.25,1,-2\n", 1.0);
    check("no header, blanks", "0.01 0.5 -1 2\n0.02 0.25 1 -2\n", 1.0);
    check("comments", "% made by a script\n0.01,0.5,-1,2\n// pause\n0.02,0.25,1,-2\n", 1.0);
    check("units below the names", "t,wx,wy,wz\nms,deg/s,deg/s,deg/s\n10,0.5,-1,2\n20,0.25,1,-2\n", DEGREE);
}

#[test]
fn columns_are_named_or_numbered() {
    let of = |[t, x, y, z]: [&str; 4]| {
        let columns = ColumnNames::parse(&format!("t={t},x={x},y={y},z={z}")).unwrap();
        ReadOptions::default().with_columns(columns)
    };
    let expected = (vec![0.0, 0.5], vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    let text = "note,A,B,C,D\nr1,3,2,1,0\nr2,6,5,4,0.5\n";
    assert_eq!(read(text, of(["D", "C", "B", "A"])), expected);
    assert_eq!(read(text, of(["5", "c", "3", "A"])), expected);
    assert_eq!(read("3,2,1,0\n6,5,4,0.5\n", of(["4", "3", "2", "1"])), expected);
    // what the names would say otherwise does not count
    assert_eq!(read("t,wx,wy,wz\n3,2,1,0\n6,5,4,0.5\n", of(["wz", "wy", "wx", "t"])), expected);
    let refused = |text: &str, columns| record::read(text, "log", &of(columns)).unwrap_err().to_string();
    let message = refused(text, ["D", "C", "B", "gyro"]);
    assert!(
        message.starts_with("log, line 1: no column for 'gyro'; the header has 'note', 'A', 'B', 'C', 'D'"),
        "{message}"
    );
    assert!(refused("1,2,3,4\n", ["1", "2", "3", "5"]).contains("no column for "));
    let units = of(["1", "2", "3", "4"])
        .with_time_unit(TimeUnit::Multiple(0.005))
        .with_rate_unit(RateUnit::DegreesPerSecond);
    let (times, rates) = read("0,90,0,0\n2,90,0,0\n", units);
    assert_eq!((times[1], rates[1][0]), (0.01, 90.0 * DEGREE));
}

#[test]
fn bad_rows_are_left_out_up_to_a_share_and_counted() {
    let row = |k: usize| format!("{},0.5,-1,{k}\n", k as f64 / 100.0);
    let log = |bad: &[(usize, &str)], rows: usize| -> String {
        let line = |k: usize| {
            bad.iter().find(|(at, _)| *at == k).map_or_else(|| row(k), |(_, text)| format!("{text}\n"))
        };
        "t,wx,wy,wz\n".to_string() + &(0..rows).map(line).collect::<String>()
    };
    for bad in ["0.5,,1,2", "0.5,nan,1,2", "0.5,1", "0.1,1,2,3", "0.5,1,2,3,4,5", "0.5,x,1,2", ""] {
        let found = record::read(&log(&[(50, bad)], 100), "log", &ReadOptions::default()).unwrap();
        let skipped = &found.skipped;
        assert_eq!((found.record.samples(), skipped.len()), (99, usize::from(!bad.is_empty())), "{bad}");
        assert!(skipped.iter().all(|error| error.to_string().starts_with("log, line 52")), "{skipped:?}");
    }
    // two rows that have changed places cost one
    let swapped =
        record::read(&log(&[(50, "0.51,1,2,3"), (51, "0.5,1,2,3")], 100), "log", &ReadOptions::default());
    assert_eq!(swapped.unwrap().skipped.len(), 1);
    // three of a hundred are too many, unless more are allowed
    let three = log(&[(50, "a,,,"), (60, ",,,"), (70, "0.7,1,2,")], 100);
    let error = record::read(&three, "log", &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("log, line 52, column 1 (t): 'a'"), "{error}");
    let allowed = ReadOptions::default().with_most_skipped(0.05);
    assert_eq!(record::read(&three, "log", &allowed).unwrap().skipped.len(), 3);
    let none = ReadOptions::default().with_most_skipped(0.0);
    assert!(record::read(&log(&[(50, "")], 100), "log", &none).is_ok());
    assert!(record::read(&log(&[(50, "x,1,2,3")], 100), "log", &none).is_err());
    // the file ends in the middle of a row
    let torn = log(&[], 60) + "0.6,0.5,-";
    let found = record::read(&torn, "log", &ReadOptions::default()).unwrap();
    assert_eq!((found.record.samples(), found.skipped.len()), (60, 1));
    let says = "log, line 62: the file ends in the middle of this row";
    assert!(found.skipped[0].to_string().starts_with(says), "{}", found.skipped[0]);
    assert!(record::read(&torn, "log", &none).unwrap_err().to_string().starts_with(says));
}

#[test]
fn loggers_of_the_second_review() {
    check(
        "Xsens MTi",
        "// Sample rate: 100.0Hz\nCounter\tAcc_X\tGyr_X\tGyr_Y\tGyr_Z\n11\t1\t0.5\t-1\t2\n12\t1\t0.25\t1\t-2\n",
        1.0,
    );
    check(
        "EuRoC",
        "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2]\n\
         1403636579758555392,0.5,-1,2,9\n1403636579768555392,0.25,1,-2,9\n",
        1.0,
    );
    check(
        "VectorNav",
        "TimeStartup(ns),gyroX(rad/s),gyroY(rad/s),gyroZ(rad/s)\n10000000,0.5,-1,2\n20000000,0.25,1,-2\n",
        1.0,
    );
    check(
        "OpenIMU",
        "time(s),rollRate(deg/s),pitchRate(deg/s),yawRate(deg/s)\n0.01,0.5,-1,2\n0.02,0.25,1,-2\n",
        DEGREE,
    );
    check(
        "Shimmer",
        "\"sep=\t\"\nShimmer_5E3B_Timestamp_Unix_CAL\tShimmer_5E3B_Gyro_X_CAL\tShimmer_5E3B_Gyro_Y_CAL\tShimmer_5E3B_Gyro_Z_CAL\n\
         ms\tdeg/s\tdeg/s\tdeg/s\n1727600000250\t0.5\t-1\t2\n1727600000260\t0.25\t1\t-2\n",
        DEGREE,
    );
    check(
        "Delsys",
        "X[s],Trigno 1: Gyro.X 1 [deg/s],Trigno 1: Gyro.Y 1 [deg/s],Trigno 1: Gyro.Z 1 [deg/s]\n0.01,0.5,-1,2\n0.02,0.25,1,-2\n",
        DEGREE,
    );
    check("Arduino", "millis,GyX,GyY,GyZ\n10,0.5,-1,2\n20,0.25,1,-2\n", 1.0);
    check("Crazyflie", "Timestamp,gyro.x,gyro.y,gyro.z\n10,0.5,-1,2\n20,0.25,1,-2\n", DEGREE);
    check(
        "Basilisk",
        "time,sigma_BN_1,sigma_BN_2,sigma_BN_3,omega_BN_B_1,omega_BN_B_2,omega_BN_B_3\n0.01,0,0,0,0.5,-1,2\n0.02,0,0,0,0.25,1,-2\n",
        1.0,
    );
}

#[test]
fn lines_above_the_rows_tell_the_rate_of_the_gyroscope() {
    let read_at = |lines: &str| {
        let text = format!("{lines}\nCounter;Gyr_X;Gyr_Y;Gyr_Z\n7;0,5;-1;2\n8;0,25;1;-2\n");
        let found = record::read(&text, "log", &ReadOptions::default());
        found.map(|found| found.read_as.sample_rate.unwrap()).map_err(|error| error.to_string())
    };
    for (lines, rate) in [
        ("// Update Rate: 37,5Hz", 37.5),
        ("// Update Rate = 37.5 Hz", 37.5),
        ("Sample rate,100", 100.0),
        ("// Gyroscope sample rate: 100 Hz\n// Accelerometer sample rate: 50 Hz", 100.0),
        ("// Mag sample rate=20\n// Gyroscope and accelerometer sample rate: 100 Hz", 100.0),
        ("// Sample rate: 100 Hz\n// Update rate: 100.0Hz", 100.0),
    ] {
        let found = read_at(lines).unwrap_or_else(|error| panic!("{lines}: {error}"));
        assert!((found - rate).abs() < 1e-9 * rate, "{lines}: {found}");
    }
    for lines in [
        "// Sample rate: 100 Hz\n// Update rate: 50 Hz",
        "// Magnetometer sample rate=20",
        "// GPS update rate: 5 Hz",
        "// Sample rate: 1,000 Hz",
        "// Sample rate: 100 Hz, decimated by 10",
    ] {
        let refused = read_at(lines).unwrap_err();
        assert!(refused.contains("(Counter): counts samples"), "{lines}: {refused}");
    }
}

#[test]
fn a_counter_needs_the_rate_of_its_samples() {
    let text = "Packet number,Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s)\n7,0.5,-1,2\n8,0.25,1,-2\n";
    let refused = record::read(text, "log", &ReadOptions::default()).unwrap_err().to_string();
    assert!(refused.starts_with("log, line 1, column 1 (Packet number): counts samples"), "{refused}");
    assert!(refused.contains("--sample-rate HZ"), "{refused}");
    let rated = ReadOptions::default().with_sample_rate(100.0);
    let found = record::read(text, "log", &rated).unwrap().record;
    assert!((found.segments[0].times()[1] - found.segments[0].times()[0] - 0.01).abs() < 1e-15);
    // rows without a time are counted
    let bare = "gx,gy,gz\n0.5,-1,2\n0.25,1,-2\n";
    assert_eq!(record::read(bare, "log", &rated).unwrap().record.segments[0].times(), [0.0, 0.01]);
    assert!(record::read(bare, "log", &ReadOptions::default()).is_err());
    // a time is not counted
    let timed = record::read("t,gx,gy,gz\n0,1,2,3\n", "log", &rated).unwrap_err().to_string();
    assert!(timed.contains("drop --sample-rate"), "{timed}");
}
