//! A thruster that fires until body z is within 10 degrees of space x, and the attitude after a day of free motion from there:
//! cargo run --release --example thruster

use nalgebra::Vector3;
use polhode::body::Force;
use polhode::events::Event;
use polhode::{Body, FreeMotion, Inertia, Run, method};

fn main() -> Result<(), polhode::Error> {
    let free = Body::free(Inertia::from_moments([2.0, 2.4, 3.0])?);
    let firing = free.clone().with(Force::constant_torque_body(Vector3::new(0.0, 0.1, 0.0))?);
    let start = firing.state(Default::default(), Vector3::new(0.0, 0.0, 0.1))?;
    let aimed = Event::enters_cone(Vector3::z(), Vector3::x(), 10_f64.to_radians())?;
    match Run::new(&method("dop853:1e-12")?, &firing, &start, 0.1)?.until(&aimed, 600.0)? {
        None => println!("not within 600 s"),
        Some(there) => {
            let day_later = FreeMotion::from_state(free.inertia(), &there.state)?.at(86_400.0)?;
            println!("off at {:.6} s; a day later {:?}", there.time.hi(), day_later.attitude);
        }
    }
    Ok(())
}

#[test]
fn it_runs() -> Result<(), polhode::Error> {
    main()
}
