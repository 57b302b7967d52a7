//! Heavy tops against fixtures of 32 digits (tests/data/tops, mpmath).

mod fixtures;

use fixtures::{TopCase, tops};
use polhode::body::{Body, Inertia, State};
use polhode::flow::LagrangeTop;
use polhode::num::{Dd, Precise, Real};
use polhode::rotation::{Quat, Vec3, rotation_angle};

/// The body and its start as kernels see it, the attitude normalised in double-double.
fn problem(case: &TopCase) -> (Body, State<Dd>) {
    let inertia = Inertia::from_positive_moments(case.free.moments).unwrap();
    let body = Body::heavy(inertia, case.weight_moment.into()).unwrap();
    let attitude = Quat::from_components(case.free.attitude);
    let start = if case.free.from_omega {
        body.enter_omega(attitude, Vec3(case.free.start))
    } else {
        body.enter(&State { attitude, momentum_body: Vec3(case.free.start) })
    };
    let mut start = start.unwrap();
    start.attitude = start.attitude.normalized();
    (body, start)
}

/// Attitude error in rad and momentum error over |m| of a kernel's state.
fn errors<S: Precise>(case: &TopCase, body: &Body, x: &State<S>) -> [f64; 2] {
    let scale = Dd::of(body.scale());
    let q = Quat::from_components(x.attitude.components().map(S::to_dd));
    let m = Vec3(x.momentum_body.0.map(|m| m.to_dd() * scale));
    let exact = Quat::from_components(case.free.result);
    let momentum = Vec3(case.free.momentum);
    // the lift is continuous: the sign of q is part of the answer
    let same_sheet = (q - exact).magnitude() < 1.0;
    let attitude = if same_sheet { rotation_angle(q, exact).hi() } else { 2.0 * core::f64::consts::PI };
    [attitude, ((m - momentum).norm() / momentum.norm()).hi()]
}

fn is_symmetric(case: &TopCase) -> bool {
    let (body, start) = problem(case);
    LagrangeTop::new(&body, start).is_ok()
}

fn closed_form<S: Precise>(print: bool) -> f64 {
    let mut worst = 0.0_f64;
    for case in tops("reference.csv").iter().filter(|case| is_symmetric(case)) {
        let (body, start) = problem(case);
        let top = LagrangeTop::new(&body, start).unwrap();
        let [attitude, momentum] = errors(case, &body, &top.inside_at::<S>(Dd::from(case.free.t)));
        if print {
            println!("{:22} t = {:6}: {attitude:.1e} rad, {momentum:.1e}", case.free.scenario, case.free.t);
        }
        worst = worst.max(attitude).max(momentum);
        if attitude.is_nan() || momentum.is_nan() {
            worst = f64::INFINITY;
        }
    }
    worst
}

#[test]
fn the_closed_form_is_exact_in_every_regime() {
    let worst = closed_form::<f64>(true);
    assert!(worst < 1e-12, "{worst:.1e}");
}

#[test]
fn the_closed_form_in_double_double_is_exact_to_conditioning() {
    let worst = closed_form::<Dd>(true);
    assert!(worst < 1e-14, "{worst:.1e}");
}
