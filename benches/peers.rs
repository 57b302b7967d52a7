//! Methods of this crate beside the same of other crates, on one free body from the same starts, in one run: evaluations of the right
//! side and time that each needs for an error of the attitude.
//!
//! ```text
//! cargo bench -p polhode-benches --bench peers
//! cargo bench -p polhode-benches --bench peers -- --write
//! ```
//!
//! The second writes the table into docs/which-method.md.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use differential_equations::prelude::{ExplicitRungeKutta, IVP, ODE};
use nalgebra::{Quaternion, UnitQuaternion};
use ode_solvers::{OutputType, SVector, System};
use polhode::method::method;
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

impl FreeBody {
    fn new() -> Self {
        FreeBody { inverse_moments: MOMENTS.map(|moment| 1.0 / moment) }
    }

    fn rate(&self, x: [f64; 7]) -> [f64; 7] {
        let (m, [a, b, c]) = ([x[4], x[5], x[6]], self.inverse_moments);
        let omega = [m[0] * a, m[1] * b, m[2] * c];
        let [p, q, r] = omega.map(|omega| 0.5 * omega);
        [
            -(x[1] * p + x[2] * q + x[3] * r),
            x[0] * p + x[2] * r - x[3] * q,
            x[0] * q + x[3] * p - x[1] * r,
            x[0] * r + x[1] * q - x[2] * p,
            m[1] * omega[2] - m[2] * omega[1],
            m[2] * omega[0] - m[0] * omega[2],
            m[0] * omega[1] - m[1] * omega[0],
        ]
    }
}

impl System<f64, Phase> for FreeBody {
    fn system(&self, _: f64, x: &Phase, rate: &mut Phase) {
        *rate = self.rate((*x).into()).into();
    }
}

impl ODE<f64, [f64; 7]> for FreeBody {
    fn diff(&self, _: f64, x: &[f64; 7], rate: &mut [f64; 7]) {
        *rate = self.rate(*x);
    }
}

fn start([a, b, c]: [f64; 3]) -> [f64; 7] {
    [1.0, 0.0, 0.0, 0.0, MOMENTS[0] * a, MOMENTS[1] * b, MOMENTS[2] * c]
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
    for _ in 0..8 {
        let begun = Instant::now();
        end = run()?;
        shortest = shortest.min(begun.elapsed().as_secs_f64() * 1e9);
    }
    Ok((end, shortest))
}

fn by_ode_solvers(tolerance: f64, omega: [f64; 3]) -> Result<Outcome, Box<dyn Error>> {
    let ((evaluations, end), nanoseconds) = timed(|| {
        // the defaults of the crate, without its output in between and with steps enough
        let mut solver = ode_solvers::Dop853::from_param(
            FreeBody::new(),
            0.0,
            SPAN,
            SPAN,
            start(omega).into(),
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
    outcome(f64::from(evaluations), end.into(), omega, nanoseconds)
}

fn by_differential_equations(tolerance: f64, omega: [f64; 3]) -> Result<Outcome, Box<dyn Error>> {
    let body = FreeBody::new();
    let ((evaluations, end), nanoseconds) = timed(|| {
        let method = ExplicitRungeKutta::dop853().rtol(tolerance).atol(tolerance).max_steps(usize::MAX);
        let solution = IVP::ode(&body, 0.0, SPAN, start(omega)).t_eval([SPAN]).method(method).solve();
        let solution = solution.map_err(|error| format!("{error:?}"))?;
        let end = solution.y.last().copied().ok_or("no output")?;
        Ok((solution.evals.function, end))
    })?;
    outcome(evaluations as f64, end, omega, nanoseconds)
}

fn outcome(
    evaluations: f64,
    end: [f64; 7],
    omega: [f64; 3],
    nanoseconds: f64,
) -> Result<Outcome, Box<dyn Error>> {
    let attitude = UnitQuaternion::from_quaternion(Quaternion::new(end[0], end[1], end[2], end[3]));
    Ok(Outcome { evaluations, error: off(&attitude, omega)?, nanoseconds })
}

/// A method of this crate that takes a tolerance.
fn ours(name: &str, tolerance: f64, omega: [f64; 3]) -> Result<Outcome, Box<dyn Error>> {
    let body = Body::free(Inertia::from_moments(MOMENTS)?);
    let start = body.state(UnitQuaternion::identity(), omega.into())?;
    let method = method(&format!("{name}:{tolerance:e}"))?;
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

/// What `outcomes`, by falling tolerance, need for the error `error`: straight lines between logarithms.
fn needed(outcomes: &[Outcome], error: f64, of: fn(&Outcome) -> f64) -> Option<f64> {
    outcomes.windows(2).find_map(|pair| {
        let [a, b] = [pair[0], pair[1]];
        let share = libm::log(error / a.error) / libm::log(b.error / a.error);
        let between = (0.0..=1.0).contains(&share);
        between.then(|| of(&a) * libm::pow(of(&b) / of(&a), share))
    })
}

/// The version of a package that the workspace is locked to.
fn version(package: &str, root: &Path) -> Result<String, Box<dyn Error>> {
    let lock = std::fs::read_to_string(root.join("Cargo.lock"))?;
    let of = lock.split_once(&format!("name = \"{package}\"\nversion = \"")).ok_or("not locked")?;
    Ok(of.1.split('"').next().unwrap_or_default().into())
}

/// Name, package, and what a tolerance and a start take.
type Contestant = (&'static str, &'static str, fn(f64, [f64; 3]) -> Result<Outcome, Box<dyn Error>>);

const CONTESTANTS: [Contestant; 4] = [
    ("`dop853`", "polhode", |tolerance, omega| ours("dop853", tolerance, omega)),
    ("`taylor`", "polhode", |tolerance, omega| ours("taylor", tolerance, omega)),
    ("`Dop853`", "ode_solvers", by_ode_solvers),
    ("`dop853`", "differential-equations", by_differential_equations),
];

const ERRORS: [f64; 3] = [1e-4, 1e-6, 1e-8];

const BEGIN: &str = "<!-- begin of the benchmark peers -->\n";
const END: &str = "<!-- end of the benchmark peers -->";

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().ok_or("no workspace")?;
    let mut table = format!(
        "| method | of | {} |\n|---|---|{}\n",
        ERRORS.map(|error| format!("{error:.0e} rad")).join(" | "),
        "--:|".repeat(ERRORS.len())
    );
    for (name, package, run) in CONTESTANTS {
        let tolerances = (6..=28).map(|halves| libm::exp10(-0.5 * f64::from(halves)));
        let outcomes =
            tolerances.map(|tolerance| mean(|omega| run(tolerance, omega))).collect::<Result<Vec<_>, _>>()?;
        let cells = ERRORS.map(|error| {
            let needed = |of: fn(&Outcome) -> f64| needed(&outcomes, error, of);
            match needed(|outcome| outcome.nanoseconds).zip(needed(|outcome| outcome.evaluations)) {
                // a series is no evaluation like those of the others
                Some((time, evaluations)) if name != "`taylor`" => {
                    format!("{:.2} ms, {:.1} k", 1e-6 * time, 1e-3 * evaluations)
                }
                Some((time, _)) => format!("{:.2} ms", 1e-6 * time),
                None => "not reached".into(),
            }
        });
        table += &format!("| {name} | {package} {} | {} |\n", version(package, root)?, cells.join(" | "));
    }
    print!("{table}");
    if std::env::args().any(|argument| argument == "--write") {
        let page = root.join("docs/which-method.md");
        let text = std::fs::read_to_string(&page)?;
        let (before, rest) =
            text.split_once(BEGIN).ok_or("no place for the table in docs/which-method.md")?;
        let (_, after) = rest.split_once(END).ok_or("the place for the table has no end")?;
        std::fs::write(&page, format!("{before}{BEGIN}{table}{END}{after}"))?;
    }
    Ok(())
}
