use nalgebra::*;
use polhode::body::*;
use polhode::flow::*;
use polhode::method::*;
use polhode::num::*;
use polhode::rotation::*;
use polhode::run::*;
fn main() {
    let body = Body::free(Inertia::from_moments([1., 2., 3.]).unwrap());
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1., -0.3)).unwrap();
    for name in [
        "explicit-euler",
        "semi-implicit-euler",
        "rk4",
        "rk4-normalized",
        "implicit-midpoint",
        "rattle",
        "lie-poisson",
        "lie-poisson:321",
        "lie-poisson:123",
    ] {
        let m = method(name).unwrap();
        let mut run = Run::new(m.as_ref(), &body, &start, 0.01).unwrap();
        let exact = FreeMotion::new(&body, State::<Dd>::of(run.start()));
        let t = std::time::Instant::now();
        let r = run.advance_to(1_000_000);
        let ns = t.elapsed().as_secs_f64() * 1e3;
        let s = match r {
            Ok(s) => s,
            Err(e) => {
                println!("{name} {e}");
                continue;
            }
        };
        let e = exact.inside_at::<Dd>(s.elapsed);
        let mut step = m.prepare_f64(0.01, &body, &run.start()).unwrap();
        let mut x = run.start();
        let mut best = f64::MAX;
        for _ in 0..200 {
            let t = std::time::Instant::now();
            step.advance_unseen(&mut x, 2000);
            best = best.min(t.elapsed().as_secs_f64() * 1e9 / 2000.0);
        }
        println!(
            "{name:20} E {:.3e} m {:.3e} L {:.3e} att {:.3e} flips {} ns/step seen {ns:.1} unseen {best:.1}",
            s.worst.energy,
            s.worst.momentum,
            s.worst.momentum_vector,
            rotation_angle(State::<Dd>::of(s.inside).attitude, e.attitude).hi(),
            s.flips
        );
    }
    let mo = FreeMotion::from_state(body.inertia(), &start).unwrap();
    let mut best = f64::MAX;
    let mut acc = 0.0;
    for k in 0..300 {
        let t = std::time::Instant::now();
        for j in 0..100 {
            acc += mo.at(j as f64 * 1.1 + k as f64).unwrap().attitude.w;
        }
        best = best.min(t.elapsed().as_secs_f64() * 1e9 / 100.0);
    }
    println!("exact at {best:.0} ns {acc}");
    let mut best = f64::MAX;
    for k in 0..100 {
        let t = std::time::Instant::now();
        for j in 0..10 {
            acc += FreeMotion::from_state(body.inertia(), &start)
                .unwrap()
                .at(j as f64 * 1.1 + k as f64)
                .unwrap()
                .attitude
                .w;
        }
        best = best.min(t.elapsed().as_secs_f64() * 1e9 / 10.0);
    }
    println!("exact set-up {best:.0} ns {acc}");
}
