//! Members of populations: physically valid, distributed as stated, and the same in any order.

use polhode::body::{AttitudeSpread, Member, Population, Tensors};
use polhode::inertia::Inertia;
use polhode::num::{Covariance, Distribution};
use polhode::rotation::{Quat, Vec3, rotation_angle};

const COUNT: u64 = 20_000;

fn with_inertia(inertia: Tensors) -> Population {
    let (attitude, omega_body) =
        (AttitudeSpread::Fixed(Quat::identity()), Distribution::Fixed([0.4, 1.0, -0.3]));
    Population::Independent { attitude, omega_body, inertia: Box::new(inertia) }
}

fn members(population: &Population) -> Vec<Member> {
    (0..COUNT).map(|k| population.member(5, k).unwrap()).collect()
}

fn mean(members: &[Member], of: impl Fn(&Member) -> f64) -> f64 {
    members.iter().map(of).sum::<f64>() / members.len() as f64
}

/// A mean of numbers with this standard deviation is within five of its own of the truth.
fn close(found: f64, truth: f64, deviation: f64) {
    let width = 5.0 * deviation / (COUNT as f64).sqrt();
    assert!((found - truth).abs() < width, "{found} for {truth}, within {width}");
}

#[test]
fn three_uniform_moments_are_a_body_every_second_time() {
    // three uniform numbers are sides of a triangle with probability 1/2, so that draws are geometric with mean 2, variance 2
    let body = Inertia::from_moments([1.0, 1.0, 1.0]).unwrap();
    let moments = Distribution::uniform([[0.0, 1.0]; 3]).unwrap();
    let drawn = members(&with_inertia(Tensors::Moments { axes: body, moments }));
    close(mean(&drawn, |member| f64::from(member.draws)), 2.0, 2.0_f64.sqrt());
    for member in &drawn {
        let [a, b, c] = member.inertia.principal_moments();
        assert!(c - a - b <= 1e-12 * (a + b + c) && c < 1.0, "{a} {b} {c}");
    }
    // pairs a, b < c with a + b > c fill the area c²/2, so the largest has the density 3 c²: mean 3/4, variance 3/80
    let largest = mean(&drawn, |member| member.inertia.principal_moments()[2]);
    close(largest, 0.75, (3.0 / 80.0_f64).sqrt());
}

#[test]
fn moments_of_a_tensor_are_spread_along_its_axes() {
    let tensor = nalgebra::Matrix3::new(2.0, -0.3, 0.1, -0.3, 3.0, 0.2, 0.1, 0.2, 4.0);
    let body = Inertia::from_tensor(tensor).unwrap();
    let moments = body.principal_moments();
    let axes: Quat<f64> = body.principal_axes().into();
    let drawn = members(&with_inertia(Tensors::moments(body, [0.01, 0.0, 0.02]).unwrap()));
    for (k, share) in [0.01_f64, 0.0, 0.02].into_iter().enumerate() {
        let ratio = |member: &Member| member.inertia.principal_moments()[k] / moments[k] - 1.0;
        close(mean(&drawn, ratio), 0.0, share.max(1e-12));
        close(
            mean(&drawn, |member| ratio(member) * ratio(member)),
            share * share,
            (share * share * 1.5).max(1e-20),
        );
    }
    let turned = |member: &Member| rotation_angle(member.inertia.principal_axes().into(), axes);
    assert!(drawn.iter().all(|member| turned(member) < 1e-13));
}

#[test]
fn entries_beyond_the_triangle_inequality_are_cut_off() {
    // a plate on the edge of what is possible: every second draw of its third moment is beyond
    let mut covariance = [[0.0; 6]; 6];
    covariance[2][2] = 1e-4;
    let mean_entries = [1.0, 2.0, 3.0, 0.0, 0.0, 0.0];
    let entries =
        Distribution::Normal { mean: mean_entries, covariance: Covariance::new(covariance).unwrap() };
    let drawn = members(&with_inertia(Tensors::Entries(entries)));
    // the half normal: mean −σ √(2/π), variance σ² (1 − 2/π)
    let sigma = 0.01;
    let third = mean(&drawn, |member| member.inertia.tensor()[(2, 2)]);
    let pi = core::f64::consts::PI;
    close(third, 3.0 - sigma * (2.0 / pi).sqrt(), sigma * (1.0 - 2.0 / pi).sqrt());
    close(mean(&drawn, |member| f64::from(member.draws)), 2.0, 2.0_f64.sqrt());
}

#[test]
fn attitudes_are_spread_as_stated() {
    let body = Tensors::Fixed(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap());
    let of = |attitude| {
        let omega_body = Distribution::Fixed([0.0; 3]);
        members(&Population::Independent { attitude, omega_body, inertia: Box::new(body.clone()) })
    };
    let pi = core::f64::consts::PI;
    // the angle of a uniform rotation has the density (1 − cos θ)/π: mean π/2 + 2/π, mean square π²/3 + 2
    let uniform = of(AttitudeSpread::Uniform);
    let angle = |member: &Member| rotation_angle(Quat::identity(), member.attitude);
    let expected = pi / 2.0 + 2.0 / pi;
    close(mean(&uniform, angle), expected, (pi * pi / 3.0 + 2.0 - expected * expected).sqrt());
    for k in 0..4 {
        // squares of components of a uniform unit vector in four dimensions: mean 1/4, variance 1/16
        close(
            mean(&uniform, |member| member.attitude.components()[k] * member.attitude.components()[k]),
            0.25,
            0.25,
        );
    }
    // rotation vectors in body axes, multiplied from the right
    let about = Quat::from_components([0.5, 0.5, -0.5, 0.5]);
    let near = of(AttitudeSpread::Near { mean: about, turn: Distribution::Fixed([0.0, 0.0, 0.2]) });
    let turn = about.conjugate() * near[3].attitude;
    assert!((turn.v.0[2] - libm::sin(0.1)).abs() < 1e-16 && turn.v.0[0].abs() < 1e-16);
    assert!((turn.w - libm::cos(0.1)).abs() < 1e-15);
}

#[test]
fn a_joint_covariance_correlates_what_it_says() {
    let mut matrix = [[0.0; 12]; 12];
    let deviations = [0.01, 0.02, 0.03, 0.1, 0.2, 0.3, 0.01, 0.02, 0.03, 0.001, 0.002, 0.003];
    let correlated = [(0, 3, 0.8), (4, 7, -0.5), (8, 11, 0.3)];
    for (k, deviation) in deviations.into_iter().enumerate() {
        matrix[k][k] = deviation * deviation;
    }
    for (i, j, rho) in correlated {
        matrix[i][j] = rho * deviations[i] * deviations[j];
        matrix[j][i] = matrix[i][j];
    }
    let inertia = Inertia::from_moments([1.0, 2.0, 2.5]).unwrap();
    let omega = Vec3([0.4, 1.0, -0.3]);
    let population = Population::Joint {
        attitude: Quat::identity(),
        omega_body: omega,
        inertia,
        covariance: Box::new(Covariance::new(matrix).unwrap()),
    };
    let drawn = members(&population);
    let product = |i: usize, j: usize| {
        mean(&drawn, |member| {
            let turn = member.attitude.v * 2.0; // small angles: the rotation vector to 1e-4
            let w = member.omega_body - omega;
            let t = member.inertia.tensor();
            let entries =
                [t[(0, 0)] - 1.0, t[(1, 1)] - 2.0, t[(2, 2)] - 2.5, t[(0, 1)], t[(0, 2)], t[(1, 2)]];
            let all = [turn.0.as_slice(), w.0.as_slice(), entries.as_slice()].concat();
            all[i] * all[j] / (deviations[i] * deviations[j])
        })
    };
    for (i, j, rho) in correlated {
        close(product(i, j), rho, 1.5);
        close(product(i, i), 1.0, 1.5);
    }
    close(product(0, 4), 0.0, 1.0);
    close(product(3, 9), 0.0, 1.0);
}

#[test]
fn a_member_is_the_same_whichever_were_drawn_before() {
    let body = Inertia::from_moments([1.0, 2.0, 2.5]).unwrap();
    let population = with_inertia(Tensors::moments(body, [0.3; 3]).unwrap());
    let forward: Vec<Member> = (0..50).map(|k| population.member(5, k).unwrap()).collect();
    for k in (0..50).rev() {
        assert_eq!(population.member(5, k).unwrap(), forward[k as usize]);
    }
    assert_ne!(population.member(5, 1).unwrap().inertia, forward[2].inertia);
    assert_ne!(population.member(6, 1).unwrap().inertia, forward[1].inertia);
    // how often the inertia is drawn changes nothing of the start
    let spread = |inertia| Population::Independent {
        attitude: AttitudeSpread::Uniform,
        omega_body: Distribution::uniform([[0.0, 1.0]; 3]).unwrap(),
        inertia: Box::new(inertia),
    };
    let body = Inertia::from_moments([1.0, 2.0, 2.5]).unwrap();
    let (wide, fixed) =
        (spread(Tensors::moments(body.clone(), [0.5; 3]).unwrap()), spread(Tensors::Fixed(body)));
    for k in 0..50 {
        let [wide, fixed] = [&wide, &fixed].map(|population| population.member(5, k).unwrap());
        assert_eq!((wide.attitude, wide.omega_body), (fixed.attitude, fixed.omega_body));
    }
}

#[test]
fn a_population_without_bodies_says_so() {
    let body = Inertia::from_moments([1.0, 1.0, 1.0]).unwrap();
    let moments = Distribution::uniform([[1.0, 1.1], [1.0, 1.1], [3.0, 3.1]]).unwrap();
    let error = with_inertia(Tensors::Moments { axes: body, moments }).member(1, 0).unwrap_err();
    assert_eq!(error.draws, 10_000);
    assert!(
        error.to_string().contains(
            "none of 10000 tensors drawn is that of a physical body; the last: principal moments 1.0"
        ),
        "{error}"
    );
}
