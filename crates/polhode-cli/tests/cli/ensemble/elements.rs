//! Ensembles of tumbling bodies: spread of published elements, several solutions, dates and an observer.

use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;

use super::{array, column, contents, done, refusals::refusal};
use crate::harness::{Scratch, golden};

/// (99942) Apophis after Pravec et al., Icarus 233 (2014) 48, with another solution of the periods.
const APOPHIS: &str = "[body]
moments = [0.61, 0.965, 1.0]
[start]
periods = [\"27.38h\", \"263h\"]
mode = \"sam\"
pole = [250, -75]
phases = [152, 14]
angle_unit = \"deg\"
epoch = \"2012-12-23T04:14 UTC\"
[spread]
periods = [\"0.07h\", \"6h\"]
pole = [9, 4]
phases = 5
ratios = [0.08, 0.008]
[[solution]]
weight = 3
[[solution]]
weight = 1
periods = \"P_1=30.56h, P_psi=290h\"
spread = { periods = [\"0.05h\", \"2h\"] }
[observer]
direction = [30, 5]
[run]
members = 800
times = [\"2012-12-23T04:14 UTC\", \"2013-01-05 UTC\", \"40d\"]
";

const HOUR: f64 = 3600.0;

/// Periods P_phi and P_psi of the members, h, and latitude of their poles, degrees.
fn drawn(attitudes: &[f64], omegas: &[f64], ratios: impl Fn(usize) -> [f64; 3]) -> Vec<[f64; 3]> {
    let member = |k: usize| {
        let [w, x, y, z] = attitudes[4 * k..4 * k + 4].try_into().unwrap();
        let attitude = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
        let omega: [f64; 3] = omegas[3 * k..3 * k + 3].try_into().unwrap();
        let inertia = Inertia::from_moments(ratios(k)).unwrap();
        let found = FreeMotion::from_omega(&inertia, attitude, omega.into()).unwrap().tumbling().unwrap();
        [found.precession_period / HOUR, found.rotation_period / HOUR, found.pole[1].to_degrees()]
    };
    (0..attitudes.len() / 4).map(member).collect()
}

#[test]
fn members_have_the_periods_of_their_solutions() {
    let scratch = Scratch::new("ensemble-elements");
    // known moments, so that the periods of a member follow from its state
    scratch.file("spec.toml", APOPHIS.replace("ratios = [0.08, 0.008]\n", ""));
    done("ensemble spec.toml --out out", &scratch);
    let out = scratch.0.join("out");
    let (shape, attitudes) = array(&out.join("attitudes.npy"));
    assert_eq!(shape, "(3, 800, 4)");
    let (_, omegas) = array(&out.join("omegas.npy"));
    let members = drawn(&attitudes[..4 * 800], &omegas[..3 * 800], |_| [0.61, 0.965, 1.0]);
    let (second, first): (Vec<_>, Vec<_>) = members.iter().partition(|member| member[1] > 280.0);
    // binomial with 800 members; 280 h are three standard deviations from the first solution
    assert!((second.len() as f64 - 200.0).abs() < 5.0 * 12.3, "{}", second.len());
    let mean = |of: &[[f64; 3]], k: usize| of.iter().map(|member| member[k]).sum::<f64>() / of.len() as f64;
    assert!((mean(&first, 0) - 27.38).abs() < 0.02, "{}", mean(&first, 0));
    assert!((mean(&first, 1) - 263.0).abs() < 1.5, "{}", mean(&first, 1));
    assert!((mean(&second, 1) - 290.0).abs() < 1.0, "{}", mean(&second, 1));
    let expected = 1.0 / (1.0 / 30.56 + 1.0 / 290.0);
    assert!((mean(&second, 0) - expected).abs() < 0.02, "{} for {expected}", mean(&second, 0));
    // P_phi, P_psi and the latitude have the deviations that were given
    for (members, k, deviation) in [(&first, 0, 0.07), (&first, 1, 6.0), (&second, 0, 0.05), (&first, 2, 4.0)]
    {
        let centre = mean(members, k);
        let squares = members.iter().map(|member| (member[k] - centre).powi(2)).sum::<f64>();
        let found = (squares / members.len() as f64).sqrt();
        assert!((found / deviation - 1.0).abs() < 0.2, "{k}: {found} for {deviation}");
    }
    // 12.82 days from the epoch, and a span beside the dates
    let times = column(&out, "summary.csv", "t");
    assert_eq!(times, [0.0, 12.0 * 86_400.0 + 71_160.0, 40.0 * 86_400.0]);
}

#[test]
fn the_observer_stands_where_the_members_see_him() {
    let scratch = Scratch::new("ensemble-observer");
    scratch.file("spec.toml", APOPHIS);
    done("ensemble spec.toml --out whole", &scratch);
    let whole = scratch.0.join("whole");
    let (_, attitudes) = array(&whole.join("attitudes.npy"));
    let direction = {
        let (longitude, latitude) = (30_f64.to_radians(), 5_f64.to_radians());
        nalgebra::Vector3::new(
            longitude.cos() * latitude.cos(),
            longitude.sin() * latitude.cos(),
            latitude.sin(),
        )
    };
    let seen: Vec<_> = attitudes[..4 * 800]
        .chunks_exact(4)
        .map(|q| {
            let q = nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]);
            nalgebra::UnitQuaternion::from_quaternion(q).inverse() * direction
        })
        .collect();
    let mean = seen.iter().sum::<nalgebra::Vector3<f64>>().normalize();
    let first = |name: &str| column(&whole, "observer.csv", name)[0];
    let (longitude, latitude) = (first("longitude"), first("latitude"));
    assert!((latitude - mean.z.asin()).abs() < 1e-12);
    assert!((longitude - mean.y.atan2(mean.x).rem_euclid(std::f64::consts::TAU)).abs() < 1e-12);
    let within = |angle: f64| seen.iter().filter(|seen| seen.angle(&mean) <= angle + 1e-12).count();
    assert_eq!(
        (within(first("angle_p50")), within(first("angle_p95")), within(first("angle_max"))),
        (400, 760, 800)
    );

    // the directions one by one are the same as one for all, and shards the same as the whole
    let each = "directions = [[30, 5], [30, 5], [30, 5]]";
    scratch.file("each.toml", APOPHIS.replace("direction = [30, 5]", each));
    done("ensemble each.toml --out each", &scratch);
    assert_eq!(contents(&scratch.0.join("each"))["observer.csv"], contents(&whole)["observer.csv"]);
    for shard in ["1/2", "2/2"] {
        done(&format!("ensemble spec.toml --out shards --shard {shard}"), &scratch);
    }
    done("gather shards", &scratch);
    let (gathered, whole) = (contents(&scratch.0.join("shards")), contents(&whole));
    for file in ["observer.csv", "summary.csv", "attitudes.npy"] {
        assert!(gathered[file] == whole[file], "{file}");
    }
}

#[test]
fn elements_are_refused_with_line_and_law() {
    let scratch = Scratch::new("ensemble-elements-refused");
    let mut told = String::new();
    for (what, from, to) in [
        ("a mode that is missing", "mode = \"sam\"\n", ""),
        ("a mode that is none", "\"sam\"", "\"short\""),
        ("three periods", "[\"27.38h\", \"263h\"]", "[\"27.38h\", \"263h\", \"30.56h\"]"),
        ("a period that is none", "P_1=", "P_2="),
        ("a ratio of periods that no motion has", "263h", "200h"),
        ("a combined period that no motion has", "P_1=30.56h", "P_1=300h"),
        ("a period with a name beside one without", "P_psi=290h", "290h"),
        ("a pole without periods", "periods = [\"27.38h\", \"263h\"]\nmode = \"sam\"\n", ""),
        ("an angular velocity beside periods", "[spread]", "omega = [0, 0, 1]\n[spread]"),
        ("a spread of both kinds", "phases = 5", "omega = 0.1"),
        ("moments that are spread otherwise", "ratios = [0.08, 0.008]", "moments = 0.1"),
        ("a negative deviation", "phases = 5", "phases = -5"),
        ("a weight that is missing", "weight = 1\n", ""),
        ("a weight of nothing", "weight = 1\n", "weight = 0\n"),
        ("a solution with a key too many", "weight = 1\n", "weight = 1\nomega = [0, 0, 1]\n"),
        ("a mode without its periods", "weight = 3\n", "weight = 3\nmode = \"lam\"\n"),
        ("a date that is none", "2012-12-23T04:14 UTC\"\n[spread]", "2012-13-23 UTC\"\n[spread]"),
        ("a date without a scale", "\"2013-01-05 UTC\"", "\"2013-01-05\""),
        ("a date without an epoch", "epoch = \"2012-12-23T04:14 UTC\"\n", ""),
        ("degrees that would be rad", "angle_unit = \"deg\"\n", ""),
        ("an observer beyond the pole", "direction = [30, 5]", "direction = [30, 95]"),
        ("directions that are too few", "direction = [30, 5]", "directions = [[30, 5]]"),
        ("a direction twice", "direction = [30, 5]", "direction = [30, 5]\ndirections = [[30, 5]]"),
        (
            "a spread of one solution beside the covariance of all",
            "[spread]\nperiods = [\"0.07h\", \"6h\"]\npole = [9, 4]\nphases = 5\nratios = [0.08, 0.008]\n",
            &format!("[spread.covariance]\nelements = {:?}\n", [[0.0; 8]; 8]),
        ),
    ] {
        assert!(APOPHIS.contains(from), "{what}");
        scratch.file("spec.toml", APOPHIS.replace(from, to));
        told += &format!("# {what}\n{}", refusal(&scratch, "ensemble spec.toml --out out"));
    }
    golden("ensemble/elements.txt", &told);
}
