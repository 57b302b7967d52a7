//! A force and a splitting scheme of one's own: a spring that pulls the body upright, stepped by a scheme of order 4:
//! cargo run --release --example own_force_and_scheme

use polhode::body::{Body, Conserved, Force, Potential, Time};
use polhode::inertia::Inertia;
use polhode::method::schemes::{Pairs, Part, Scheme, Stages};
use polhode::method::{ExactFlow, SchemeError, Splitting};
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3};
use polhode::run::Run;

/// U = ½ k |e − z|², e body z in space: a spring from the tip of the body to the zenith.
struct Spring(f64);

impl<S: Real> Potential<S> for Spring {
    fn energy(&self, _: Time, attitude: Quat<S>) -> S {
        S::of(self.0) * (S::of(1.0) - attitude.rotate(Vec3::unit(2))[2])
    }
    fn torque(&self, _: Time, attitude: Quat<S>) -> Vec3<S> {
        Vec3::unit(2).cross(attitude.rotate_back(Vec3::unit(2))) * S::of(self.0)
    }
}

/// Kicks and drifts of Forest and Ruth, Physica D 43 (1990) 105: the first half of each palindrome, without the middle, which follows from the sum.
const B: &[Dd] = &[Dd::sum(0.675_603_595_979_828_8, 4.213_708_877_725_88e-17)];
const A: &[Dd] = &[Dd::sum(1.351_207_191_959_657_5, 8.427_417_755_451_76e-17)];
const STAGES: Stages = Stages::Alternating { first: Part::B, a: A, b: B, pairs: Pairs::Any };

/// The order is checked here.
fn ruth_4() -> Result<Scheme, SchemeError> {
    Scheme::new("ruth-4", 4, STAGES, "Forest and Ruth 1990")
}

fn main() -> Result<(), polhode::Error> {
    let body =
        Body::free(Inertia::from_moments([1.0, 2.0, 2.5])?).with(Force::potential("spring", Spring(0.5)));
    let start = body.state(Default::default(), [0.1, 0.7, 0.3].into())?;
    let mut run = Run::new(&Splitting::kicked(ExactFlow, ruth_4()?)?, &body, &start, 0.05)?;
    let end = run.advance_to(100_000)?;
    println!("{:?} after {} s", end.worst.of(Conserved::Energy), end.elapsed.hi());
    Ok(())
}

#[test]
fn the_scheme_has_its_order_in_the_field_of_the_force() -> Result<(), polhode::Error> {
    let body =
        Body::free(Inertia::from_moments([1.0, 2.0, 2.5])?).with(Force::potential("spring", Spring(0.5)));
    let start = body.state(Default::default(), [0.1, 0.7, 0.3].into())?;
    let worst = |h: f64| -> Result<f64, polhode::Error> {
        let mut run = Run::new(&Splitting::kicked(ExactFlow, ruth_4()?)?, &body, &start, h)?;
        Ok(run.advance_to((50.0 / h) as u64)?.worst.of(Conserved::Energy).unwrap_or(f64::NAN))
    };
    let ratio = worst(0.0625)? / worst(0.03125)?;
    assert!((ratio - 16.0).abs() < 1.0, "the energy error falls {ratio} times, not 16 times");
    Ok(())
}
