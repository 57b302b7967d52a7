//! One's own splitting of the kinetic energy: a nearly symmetric body moves as a symmetric top, and a turn makes up for the difference:
//! cargo run --release --example own_splitting

use polhode::body::{Body, Conserved, Rotor};
use polhode::flow::{SymmetricTop, Turn};
use polhode::inertia::Inertia;
use polhode::method::{KineticSplit, Splitting, schemes::SUZUKI_4};
use polhode::num::{Dd, Precise};
use polhode::run::Run;

/// T = T_top + ½ (1/I₁ − 1/I₂) m₁²: the smaller the difference of I₁ and I₂, the smaller the error.
#[derive(Clone)]
struct TurnAndTop;

impl KineticSplit for TurnAndTop {
    type Flows<S: Precise> = (Turn<S>, SymmetricTop<S>);
    fn name(&self) -> String {
        "turn-and-top".into()
    }
    fn flows<S: Precise>(&self, rotor: &Rotor) -> Self::Flows<S> {
        let [i1, i2, i3] = rotor.moments::<Dd>().0;
        (Turn::about::<0>((i2 - i1) / (i1 * i2)), SymmetricTop::about::<2>(i3, i2))
    }
}

fn main() -> Result<(), polhode::Error> {
    let body = Body::free(Inertia::from_moments([1.0, 1.01, 1.5])?);
    let start = body.state(Default::default(), [0.4, 1.0, -0.3].into())?;
    let method = Splitting::of_flows(TurnAndTop, SUZUKI_4)?;
    let end = Run::new(&method, &body, &start, 0.1)?.advance_to(100_000)?;
    println!("{:?} {:?}", end.worst.of(Conserved::Energy), end.worst.of(Conserved::Momentum));
    Ok(())
}

#[test]
fn it_runs() -> Result<(), polhode::Error> {
    main()
}
