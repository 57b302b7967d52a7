//! DOP853 of this crate beside that of the crate ode_solvers, on the same free body from the same starts, at the same
//! tolerances: evaluations of the right side, root mean square of the attitude errors at the end, and the time of an
//! evaluation. Run it with `--release`.

use std::error::Error;
use std::time::Instant;

use nalgebra::{Quaternion, UnitQuaternion};
use ode_solvers::{OutputType, SVector, System};
use polhode::method::Dop853;
use polhode::run::Watch;
use polhode::{Body, FreeMotion, Inertia, Run};

const MOMENTS: [f64; 3] = [1.0, 2.0, 3.0];
/// Several, as the error at one time from one start may be small by chance.
const STARTS: [[f64; 3]; 8] = [
    [0.4, 1.0, -0.3],
    [0.3, 0.9, 0.5],
    [-0.5, 0.8, 0.4],
    [0.9, -0.2, 0.5],
    [0.7, 0.6, 0.6],
    [-0.2, -0.5, 0.9],
    [1.0, 0.3, -0.2],
    [0.6, -0.9, 0.1],
];
const SPAN: f64 = 1000.0;

/// q (w, x, y, z) and m of a free body.
type Phase = SVector<f64, 7>;

struct FreeBody {
    inverse_moments: [f64; 3],
}

impl System<f64, Phase> for FreeBody {
    fn system(&self, _: f64, x: &Phase, rate: &mut Phase) {
        let (m, [a, b, c]) = ([x[4], x[5], x[6]], self.inverse_moments);
        let omega = [m[0] * a, m[1] * b, m[2] * c];
        let [p, q, r] = omega.map(|omega| 0.5 * omega);
        rate[0] = -(x[1] * p + x[2] * q + x[3] * r);
        rate[1] = x[0] * p + x[2] * r - x[3] * q;
        rate[2] = x[0] * q + x[3] * p - x[1] * r;
        rate[3] = x[0] * r + x[1] * q - x[2] * p;
        rate[4] = m[1] * omega[2] - m[2] * omega[1];
        rate[5] = m[2] * omega[0] - m[0] * omega[2];
        rate[6] = m[0] * omega[1] - m[1] * omega[0];
    }
}

/// What a run took and how far off it ended.
#[derive(Clone, Copy)]
struct Outcome {
    evaluations: f64,
    error: f64,
    nanoseconds: f64,
}

/// The shortest of some runs: what else the machine does only adds to it.
fn timed<T>(run: impl Fn() -> Result<T, Box<dyn Error>>) -> Result<(T, f64), Box<dyn Error>> {
    let mut shortest = f64::INFINITY;
    let mut end = run()?;
    for _ in 0..20 {
        let begun = Instant::now();
        end = run()?;
        shortest = shortest.min(begun.elapsed().as_secs_f64() * 1e9);
    }
    Ok((end, shortest))
}

fn theirs(tolerance: f64, omega: [f64; 3]) -> Result<Outcome, Box<dyn Error>> {
    let [a, b, c] = omega;
    let start = Phase::from([1.0, 0.0, 0.0, 0.0, MOMENTS[0] * a, MOMENTS[1] * b, MOMENTS[2] * c]);
    let ((evaluations, end), nanoseconds) = timed(|| {
        let body = FreeBody { inverse_moments: MOMENTS.map(|moment| 1.0 / moment) };
        // the defaults of the crate, without its output in between and with steps enough
        let mut solver = ode_solvers::Dop853::from_param(
            body,
            0.0,
            SPAN,
            SPAN,
            start,
            tolerance,
            tolerance,
            0.9,
            0.0,
            0.333,
            6.0,
            SPAN,
            0.0,
            u32::MAX,
            u32::MAX,
            OutputType::Sparse,
        );
        let stats = solver.integrate()?;
        let end = solver.y_out().last().copied().ok_or("no output")?;
        Ok((stats.num_eval, end))
    })?;
    let attitude = UnitQuaternion::from_quaternion(Quaternion::new(end[0], end[1], end[2], end[3]));
    Ok(Outcome { evaluations: f64::from(evaluations), error: off(&attitude, omega)?, nanoseconds })
}

fn ours(tolerance: f64, omega: [f64; 3]) -> Result<Outcome, Box<dyn Error>> {
    let body = Body::free(Inertia::from_moments(MOMENTS)?);
    let start = body.state(UnitQuaternion::identity(), omega.into())?;
    let method = Dop853::of_tolerance(tolerance)?;
    let ((evaluations, attitude), nanoseconds) = timed(|| {
        let mut run = Run::new(&method, &body, &start, SPAN)?.watching(Watch::Never);
        let attitude = run.advance_to(1)?.state.rotation();
        Ok((run.work().map_or(0, |work| work.evaluations), attitude))
    })?;
    Ok(Outcome { evaluations: evaluations as f64, error: off(&attitude, omega)?, nanoseconds })
}

/// The angle between `attitude` and the exact one.
fn off(attitude: &UnitQuaternion<f64>, omega: [f64; 3]) -> Result<f64, Box<dyn Error>> {
    let body = Body::free(Inertia::from_moments(MOMENTS)?);
    let start = body.state(UnitQuaternion::identity(), omega.into())?;
    let exact = FreeMotion::from_state(body.inertia(), &start)?.at(SPAN)?;
    Ok(attitude.angle_to(&exact.rotation()))
}

/// Means over the starts, of the errors the root mean square.
fn mean(run: impl Fn([f64; 3]) -> Result<Outcome, Box<dyn Error>>) -> Result<Outcome, Box<dyn Error>> {
    let all = STARTS.into_iter().map(run).collect::<Result<Vec<_>, _>>()?;
    let mean = |pick: fn(&Outcome) -> f64| all.iter().map(pick).sum::<f64>() / all.len() as f64;
    let (evaluations, nanoseconds) = (mean(|o| o.evaluations), mean(|o| o.nanoseconds));
    Ok(Outcome { evaluations, error: mean(|o| o.error * o.error).sqrt(), nanoseconds })
}

/// Evaluations that `outcomes`, by falling tolerance, need for the error `error`, straight lines between logarithms.
fn evaluations_at(outcomes: &[Outcome], error: f64) -> Option<f64> {
    outcomes.windows(2).find_map(|pair| {
        let [a, b] = [pair[0], pair[1]];
        let share = libm::log(error / a.error) / libm::log(b.error / a.error);
        let between = (0.0..=1.0).contains(&share);
        between.then(|| a.evaluations * libm::pow(b.evaluations / a.evaluations, share))
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let tolerance = |halves: i32| libm::exp10(-0.5 * f64::from(halves));
    // more of them on both sides, so that errors of ours are between errors of theirs
    let theirs =
        (10..=29).map(|n| mean(|omega| theirs(tolerance(n), omega))).collect::<Result<Vec<_>, _>>()?;
    println!("Free body of the moments {MOMENTS:?} kg m^2 for {SPAN} s; errors of the attitude in rad.");
    println!("ratio: evaluations of polhode over those that ode_solvers needs for the same error.");
    println!("{:9} | {:27} | {:27} |", "", "polhode", "ode_solvers");
    println!("tolerance | evaluations    error ns/ev. | evaluations    error ns/ev. | ratio");
    for n in 12..=28 {
        let (ours, there) = (mean(|omega| ours(tolerance(n), omega))?, &theirs[(n - 10) as usize]);
        let shown = |o: &Outcome| {
            format!("{:11.0} {:8.1e} {:6.1}", o.evaluations, o.error, o.nanoseconds / o.evaluations)
        };
        let ratio = evaluations_at(&theirs, ours.error).map(|evaluations| ours.evaluations / evaluations);
        let ratio = ratio.map_or("-".into(), |ratio| format!("{ratio:.3}"));
        println!("{:9.1e} | {} | {} | {ratio}", tolerance(n), shown(&ours), shown(there));
    }
    Ok(())
}
