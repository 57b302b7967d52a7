//! The free motions through two attitudes.

use nalgebra::{UnitQuaternion, Vector3};

use polhode::flow::{FreeMotion, Interpolation, Passages, ThroughError};
use polhode::inertia::Inertia;

const BODIES: [[f64; 3]; 5] =
    [[1.0, 2.0, 3.0], [0.6, 0.8, 1.0], [1.0, 1.0, 1.7], [0.3, 1.0, 1.0], [1.0, 3.0836, 3.235]];

fn body(moments: [f64; 3]) -> Inertia {
    Inertia::from_moments(moments).unwrap()
}

/// Each solution starts at the one attitude and reaches the other, and turns as often as it says.
fn check(found: &Passages, q0: UnitQuaternion<f64>, q1: UnitQuaternion<f64>, time: f64, turns: f64) {
    let mut before = 0.0;
    for passage in &found.list {
        assert!(passage.motion.at(0.0).unwrap().rotation().angle_to(&q0) < 1e-15);
        let missed = passage.motion.at(time).unwrap().rotation().angle_to(&q1);
        assert!(missed < 1e-12, "{missed:.1e}: {passage:?}");
        assert!(passage.turns <= turns * (1.0 + 1e-9) && passage.turns >= before, "{passage:?}");
        let spin = passage.motion.character().map_or(0.0, |character| character.spin);
        assert!((passage.turns - spin * time / core::f64::consts::TAU).abs() < 1e-9);
        before = passage.turns;
    }
}

#[cfg(feature = "random")]
mod random {
    use super::*;
    use polhode::num::Random;

    struct Pair {
        inertia: Inertia,
        q0: UnitQuaternion<f64>,
        q1: UnitQuaternion<f64>,
        omega: Vector3<f64>,
        time: f64,
        turns: f64,
    }

    /// A body that turns 0.01 to 4 times between two looks.
    fn pair(random: &mut Random) -> Pair {
        let inertia = body(BODIES[random.below(5) as usize]);
        let q0 = UnitQuaternion::from_scaled_axis(random.normal_vector());
        let omega = random.normal_vector();
        let motion = FreeMotion::from_omega(&inertia, q0, omega).unwrap();
        let turns = libm::exp10(random.between(-2.0, libm::log10(4.0)));
        let time = turns * core::f64::consts::TAU / motion.character().unwrap().spin;
        let q1 = motion.at(time).unwrap().rotation();
        Pair { inertia, q0, q1, omega, time, turns }
    }

    fn true_motion_is_found(pairs: usize, seed: u64) {
        let mut random = Random::new(seed);
        let (mut solutions, mut missed, mut incomplete, mut iterations) = (0, 0, 0, [0_usize; 10]);
        for number in 0..pairs {
            let Pair { inertia, q0, q1, omega, time, turns } = pair(&mut random);
            let most = turns + 0.05;
            let found = FreeMotion::through(&inertia, (0.0, q0), (time, q1), most);
            let nearest = found.as_ref().ok().and_then(|found| found.nearest(omega));
            let distance = nearest.map_or(1.0, |near| (near.omega_body - omega).norm() / omega.norm());
            // the attitude at the end is rounded: next to conjugate attitudes that moves the rate more
            if distance > 1e-7 {
                println!(
                    "pair {number}: {distance:.1e}, {turns} turns, {:?}, {omega:?}",
                    inertia.principal_moments()
                );
                missed += 1;
            }
            let Ok(found) = found else { continue };
            check(&found, q0, q1, time, most);
            assert!(!found.families);
            incomplete += usize::from(!found.complete);
            solutions += found.list.len();
            for passage in &found.list {
                iterations[passage.iterations as usize] += 1;
            }
        }
        println!(
            "{solutions} solutions of {pairs} pairs, of which {incomplete} may lack some; Newton's iterations {iterations:?}"
        );
        assert_eq!(missed, 0);
    }

    #[test]
    fn the_true_motion_is_among_the_solutions() {
        true_motion_is_found(150, 3);
    }

    #[test]
    #[ignore = "a hundred thousand pairs take minutes"]
    fn the_true_motion_is_among_the_solutions_of_many_pairs() {
        true_motion_is_found(100_000, 4);
    }

    fn counts_agree(pairs: usize, seed: u64, finer: u32) {
        let mut random = Random::new(seed);
        let (mut more, mut fewer, mut all) = (0, 0, 0);
        for _ in 0..pairs {
            let Pair { inertia, q0, q1, time, turns, .. } = pair(&mut random);
            let (first, second) = ((0.0, q0), (time, q1));
            let usual = FreeMotion::through(&inertia, first, second, turns + 0.05).unwrap();
            let fine = FreeMotion::through_finely(&inertia, first, second, turns + 0.05, finer).unwrap();
            let missing = |of: &Passages, from: &Passages| {
                let same = |w: Vector3<f64>| {
                    from.list.iter().any(|other| (other.omega_body - w).norm() < 1e-6 * w.norm())
                };
                of.list.iter().filter(|passage| !same(passage.omega_body)).count()
            };
            more += missing(&fine, &usual);
            fewer += missing(&usual, &fine);
            all += fine.list.len();
        }
        println!("{all} solutions; {more} of a fine scan alone, {fewer} of the usual one alone");
        assert_eq!((more, fewer), (0, 0), "of {all}");
    }

    #[test]
    fn a_finer_search_finds_no_more() {
        counts_agree(20, 5, 8);
    }

    #[test]
    #[ignore = "a fine scan of 200 pairs takes a minute"]
    fn a_much_finer_search_finds_no_more() {
        counts_agree(200, 6, 32);
    }
}

/// Of a body that starts with `omega` and turns as often as stated, the motions to the attitude that it reaches.
fn to_the_end_of(moments: [f64; 3], q0: [f64; 4], omega: [f64; 3], turns: f64) -> (Passages, Vector3<f64>) {
    let inertia = body(moments);
    let [w, x, y, z] = q0;
    let q0 = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
    let omega = Vector3::from(omega);
    let motion = FreeMotion::from_omega(&inertia, q0, omega).unwrap();
    let time = turns * core::f64::consts::TAU / motion.character().unwrap().spin;
    let q1 = motion.at(time).unwrap().rotation();
    let found = FreeMotion::through(&inertia, (0.0, q0), (time, q1), turns + 0.05).unwrap();
    check(&found, q0, q1, time, turns + 0.05);
    (found, omega)
}

#[test]
fn motions_that_almost_coincide_are_both_found() {
    // half angles that turn round 1e-6 rad beyond zero, and one next to the end of a piece: of some 1e5 random pairs those
    // that a search by values alone has missed
    let double = to_the_end_of(
        [1.0, 2.0, 3.0],
        [-0.919_226_525_305_41, -0.057_673_206_309_872_78, 0.239_667_845_907_254_6, -0.307_010_944_572_107_6],
        [0.361_569_241_444_340_1, -1.571_729_571_703_864_2, 0.977_716_905_458_177_4],
        1.371_658_830_410_933,
    );
    let round = to_the_end_of(
        [1.0, 1.0, 0.25],
        [
            -0.298_109_908_756_286_9,
            0.355_653_194_502_881_9,
            -0.185_834_164_823_673_04,
            -0.866_087_493_815_907_2,
        ],
        [0.257_053_142_823_082_56, 1.122_661_621_323_099, 0.090_393_435_087_041_33],
        2.938_064_518_581_405,
    );
    for (found, omega) in [double, round] {
        let nearest = found.nearest(omega).unwrap().omega_body;
        assert!((nearest - omega).norm() < 1e-9 * omega.norm(), "{nearest} beside {omega}");
        assert!(found.complete);
    }
}

#[test]
fn a_sphere_turns_about_one_axis_either_way() {
    let turn = UnitQuaternion::from_scaled_axis([0.3, -0.4, 1.2].into());
    let angle = turn.angle();
    let found =
        FreeMotion::through(&body([2.0; 3]), (1.0, UnitQuaternion::identity()), (3.0, turn), 2.0).unwrap();
    check(&found, UnitQuaternion::identity(), turn, 2.0, 2.0);
    let rates: Vec<f64> = found.list.iter().map(|passage| passage.omega_body.norm()).collect();
    let tau = core::f64::consts::TAU;
    let exact = [angle, tau - angle, tau + angle, 2.0 * tau - angle].map(|angle| angle / 2.0);
    assert!(found.families && found.complete && rates.len() == exact.len(), "{rates:?}");
    for (rate, exact) in rates.iter().zip(exact) {
        assert!((rate - exact).abs() < 1e-14);
    }
}

#[test]
fn equal_attitudes_have_families_of_motions_and_one_at_rest() {
    let here = UnitQuaternion::from_euler_angles(0.1, 0.2, 0.3);
    let found = FreeMotion::through(&body([1.0, 2.0, 3.0]), (0.0, here), (5.0, here), 1.5).unwrap();
    assert!(found.families);
    // and whole turns about the three axes either way
    assert_eq!(found.list.len(), 7);
    assert_eq!(found.list[0].omega_body, Vector3::zeros());
}

#[test]
fn a_turn_about_a_principal_axis_is_among_the_solutions() {
    for axis in 0..3 {
        let turn = UnitQuaternion::from_scaled_axis(Vector3::ith(axis, -2.0));
        let found =
            FreeMotion::through(&body([1.0, 2.0, 3.0]), (0.0, UnitQuaternion::identity()), (4.0, turn), 1.0)
                .unwrap();
        check(&found, UnitQuaternion::identity(), turn, 4.0, 1.0);
        let steady = found.nearest(Vector3::ith(axis, -0.5)).unwrap();
        assert!((steady.omega_body - Vector3::ith(axis, -0.5)).norm() < 1e-14);
    }
}

#[test]
fn what_no_motion_connects_is_refused_with_the_reason() {
    let here = UnitQuaternion::identity();
    let there = UnitQuaternion::from_euler_angles(1.0, 0.5, -0.7);
    let inertia = body([1.0, 2.0, 3.0]);
    let through = |t0: f64, t1: f64, turns: f64| {
        FreeMotion::through(&inertia, (t0, here), (t1, there), turns).unwrap_err()
    };
    assert_eq!(through(2.0, 2.0, 1.0), ThroughError::SameTime { t: 2.0 });
    assert!(matches!(through(f64::NAN, 2.0, 1.0), ThroughError::NotFinite { .. }));
    for turns in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(through(0.0, 2.0, turns), ThroughError::Turns { .. }));
    }
    let error = through(0.0, 2.0, 0.05);
    assert!(
        matches!(error, ThroughError::NoneWithin { .. }) && error.to_string().contains("rad apart"),
        "{error}"
    );
}

#[test]
fn the_order_of_the_attitudes_does_not_matter() {
    let here = UnitQuaternion::identity();
    let there = UnitQuaternion::from_euler_angles(1.0, 0.5, -0.7);
    let inertia = body([1.0, 2.0, 3.0]);
    let forth = FreeMotion::through(&inertia, (1.0, here), (2.5, there), 1.0).unwrap();
    let back = FreeMotion::through(&inertia, (2.5, there), (1.0, here), 1.0).unwrap();
    let rates = |found: &Passages| found.list.iter().map(|passage| passage.omega_body).collect::<Vec<_>>();
    assert_eq!(rates(&forth), rates(&back));
}

/// A free motion of a body that tumbles, and looks at it every 0.7 s.
fn looks(count: usize) -> (Inertia, FreeMotion, Vec<(f64, UnitQuaternion<f64>)>) {
    let inertia = body([1.0, 2.0, 3.0]);
    let start = UnitQuaternion::from_euler_angles(0.1, 0.7, -0.4);
    let motion = FreeMotion::from_omega(&inertia, start, [1.4, 1.0, -0.3].into()).unwrap();
    let look = |n: usize| {
        let t = 5.0 + 0.7 * n as f64;
        (t, motion.at(t - 5.0).unwrap().rotation())
    };
    let table = (0..count).map(look).collect();
    (inertia, motion, table)
}

#[test]
fn a_table_of_a_free_motion_is_continued_between_its_rows() {
    let (inertia, motion, table) = looks(30);
    let between = Interpolation::new(&inertia, &table, 1.0).unwrap();
    assert!(between.largest_jump() < 1e-11, "{:.1e}", between.largest_jump());
    let (mut worst, mut slerp) = (0.0_f64, 0.0_f64);
    for n in 0..200 {
        let t = 5.0 + 0.1 * f64::from(n);
        let (state, slerp_error) = between.at(t).unwrap();
        worst = worst.max(state.rotation().angle_to(&motion.at(t - 5.0).unwrap().rotation()));
        slerp = slerp.max(slerp_error);
    }
    assert!(worst < 1e-12 && slerp > 0.02, "{worst:.1e}, slerp {slerp:.1e}");
    for t in [4.9, 1e9, f64::NAN] {
        assert!(matches!(between.at(t), Err(ThroughError::Outside { .. })));
    }
}

#[test]
fn tables_that_cannot_be_used_are_refused() {
    let (inertia, motion, table) = looks(5);
    let of = |table: &[(f64, UnitQuaternion<f64>)]| Interpolation::new(&inertia, table, 1.0).unwrap_err();
    assert_eq!(of(&table[..1]), ThroughError::TooFew { attitudes: 1 });
    let swapped = [table[1], table[0]];
    assert!(matches!(of(&swapped), ThroughError::NotAscending { .. }));
    let twice = swapped.repeat(2);
    let fitted = |table, noise| FreeMotion::fitted(&inertia, table, noise, &motion).unwrap_err();
    assert_eq!(fitted(&table[..2], 1e-3), ThroughError::TooFew { attitudes: 2 });
    assert!(matches!(fitted(&twice, 1e-3), ThroughError::NotAscending { .. }));
    for noise in [0.0, -1.0, f64::NAN] {
        assert!(matches!(fitted(&table, noise), ThroughError::Noise { .. }));
    }
}

#[test]
fn a_fit_from_a_guess_of_another_body_is_a_motion_of_the_body_asked_for() {
    let (inertia, motion, table) = looks(20);
    let start = motion.at(0.0).unwrap().rotation();
    let guess = FreeMotion::from_omega(&body([1.0, 2.1, 3.0]), start, [1.41, 1.0, -0.3].into()).unwrap();
    let fit = FreeMotion::fitted(&inertia, &table, 1e-3, &guess).unwrap();
    assert_eq!(fit.motion.body().inertia(), &inertia);
    let missed = (fit.motion.omega_at(0.0).unwrap() - motion.omega_at(0.0).unwrap()).norm();
    assert!(missed < 1e-9, "{missed:.1e}");
    // the motion that the table is of, whose body is not the one that is asked for
    let other = body([1.0, 2.2, 3.0]);
    match FreeMotion::fitted(&other, &table, 1e-3, &motion) {
        Ok(fit) => assert_eq!(fit.motion.body().inertia(), &other),
        Err(error) => assert!(matches!(error, ThroughError::NotConverged { .. }), "{error}"),
    }
}

#[cfg(feature = "random")]
#[test]
fn a_fit_through_noisy_attitudes_has_the_errors_that_its_covariance_states() {
    use polhode::num::Random;
    let (inertia, motion, table) = looks(100);
    let noise = 1e-3;
    let (mut squares, mut chi2) = (0.0, 0.0);
    const TRIALS: u64 = 20;
    for trial in 0..TRIALS {
        let mut random = Random::new(11).stream(trial);
        let noisy: Vec<_> = table
            .iter()
            .map(|&(t, q)| (t, UnitQuaternion::from_scaled_axis(random.normal_vector() * noise) * q))
            .collect();
        let first = Interpolation::new(&inertia, &noisy[..4], 1.0).unwrap();
        let fit = FreeMotion::fitted(&inertia, &noisy, noise, &first.pieces()[0].motion).unwrap();
        let (found, exact) = (fit.motion.at(0.0).unwrap(), motion.at(0.0).unwrap());
        let turn = (found.rotation() * exact.rotation().inverse()).scaled_axis();
        let change = found.momentum() - exact.momentum();
        let error = nalgebra::Vector6::from_iterator(turn.iter().chain(change.iter()).copied());
        squares += (error.transpose() * fit.covariance.try_inverse().unwrap() * error)[0];
        chi2 += fit.chi2_per_dof;
    }
    // six degrees of freedom each: the mean of 20 is within 4 standard deviations of 6
    let mean = squares / TRIALS as f64;
    assert!((mean - 6.0).abs() < 4.0 * (12.0 / TRIALS as f64).sqrt(), "{mean}");
    assert!((chi2 / TRIALS as f64 - 1.0).abs() < 0.1, "{chi2}");
}
