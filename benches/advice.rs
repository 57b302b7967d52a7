//! Whether advice is right, on random bodies, starts, times and demands: `cargo bench -p polhode-benches --bench
//! advice`.
//!
//! Each piece of advice is run to the end and compared with the motion; closed forms are left out. Of the first
//! twenty, every other method is run by brute force, in steps of a fine grid, to see what would have been quicker.
//! Ends with 1 if fewer than 95 in 100 demands are met, or if a method is more than twice as quick as the one
//! advised.

#![allow(clippy::expect_used)]

use std::process::ExitCode;
use std::time::Instant;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::advise::{AdviseError, Demand, Setting, advise, check};
use polhode::body::{Body, State};
use polhode::flow::ExactMotion;
use polhode::inertia::Inertia;
use polhode::method::{Claimed, method};
use polhode::rotation::rotation_angle;
use polhode::run::{Run, Watch};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const PROBLEMS: usize = 100;
const BY_BRUTE_FORCE: usize = 20;

/// Methods of the grid with a step; those with a tolerance are beside them.
const FIXED: [&str; 10] = [
    "rk4",
    "rk8",
    "taylor:20",
    "gauss:8",
    "dmv:8",
    "dmv:14",
    "two-turn@blanes-moan-s10",
    "two-turn@kahan-li-8",
    "kick-drift@srkn-6b",
    "kick-drift@srkn-11b",
];

struct Draws(ChaCha8Rng);

impl Draws {
    fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A random problem: free, or a symmetric or asymmetric body under gravity.
    fn problem(&mut self) -> (Body, State, Demand) {
        let densities = [0; 3].map(|_| self.between(0.05, 1.0));
        let [a, b, c] = densities;
        let kind = self.0.next_u64() % 4;
        // moments of three point pairs, which all bodies have
        let moments = if kind == 2 { [a + c, a + c, 2.0 * a] } else { [b + c, a + c, a + b] };
        let inertia = Inertia::from_moments(moments).expect("moments of a body");
        let body = match kind {
            0 | 1 => Body::free(inertia),
            2 => Body::heavy(inertia, Vector3::new(0.0, 0.0, self.between(0.1, 1.0))).expect("a weight"),
            _ => {
                let weight = [0; 3].map(|_| self.between(-0.3, 0.3));
                Body::heavy(inertia, weight.into()).expect("a weight")
            }
        };
        let omega = Vector3::from([0; 3].map(|_| self.between(-3.0, 3.0)));
        let turn = Vector3::from([0; 3].map(|_| self.between(-1.5, 1.5)));
        let start = body.state(UnitQuaternion::from_scaled_axis(turn), omega).expect("a start");
        // tops stay within what a run in double-double reaches
        let longest = if kind < 2 { 5.0 } else { 2.7 };
        let until = libm::exp10(self.between(1.0, longest)) / omega.norm();
        let mut demand = Demand::new(until, libm::exp10(self.between(-10.0, -3.0)));
        demand.excluded = vec!["exact".into()];
        (body, start, demand)
    }
}

/// Processor time and largest attitude error of `name` in `n` steps, against the closed form.
fn tried(body: &Body, start: &State, until: f64, (name, n): (&str, u64)) -> Option<(f64, f64)> {
    let method = method(name).ok()?;
    let begun = Instant::now();
    let run = Run::new(&method, body, start, until / n as f64).ok()?;
    let mut run = run.watching(Watch::Never);
    run.advance_to(n).ok()?;
    let seconds = begun.elapsed().as_secs_f64();
    let motion = ExactMotion::from_point(body, run.start().to_dd()).ok()?;
    let looks = n.min(64);
    let mut run = Run::new(&method, body, start, until / n as f64).ok()?.watching(Watch::Never);
    let mut worst = 0.0_f64;
    for k in 1..=looks {
        let seen = run.advance_to(n * k / looks).ok()?;
        let exact = motion.point_at_dd(seen.elapsed);
        worst = worst.max(rotation_angle(seen.point.to_dd().attitude, exact.attitude).hi());
    }
    Some((seconds, worst))
}

/// The least time in which a method of the grid meets the demand, within `most` seconds each.
fn by_brute_force(body: &Body, start: &State, demand: &Demand, most: f64) -> Option<(f64, String)> {
    let radians = demand.until * body.omega_body(start).norm();
    let steps = (0..60).map(|k| (libm::ceil(0.5 * radians).max(1.0) * libm::exp2(0.5 * f64::from(k))) as u64);
    // methods that are exact for the body are excluded, as closed forms
    let steps_err = |name: &&&str| {
        method(name).is_ok_and(|method| {
            let claims = method.claims(body.problem());
            claims.is_some_and(|claims| claims.order.is_some() || method.tolerance().is_some())
        })
    };
    let fixed = FIXED
        .iter()
        .filter(steps_err)
        .map(|name| steps.clone().map(|n| (name.to_string(), n)).collect::<Vec<_>>());
    let tolerances =
        |base: &str| (6..=30).map(|k| (format!("{base}:1e-{}", 0.5 * f64::from(k)), 1)).collect();
    let adaptive = ["dop853", "taylor"].map(tolerances);
    let mut best: Option<(f64, String)> = None;
    for settings in fixed.chain(adaptive) {
        for (name, n) in settings {
            let Some((seconds, error)) = tried(body, start, demand.until, (&name, n)) else { continue };
            if seconds > most {
                break;
            }
            if error <= demand.attitude_error {
                let again = tried(body, start, demand.until, (&name, n)).map_or(seconds, |again| again.0);
                let seconds = seconds.min(again);
                if best.as_ref().is_none_or(|(least, _)| seconds < *least) {
                    best = Some((seconds, format!("{name}, {n} steps")));
                }
                break;
            }
        }
    }
    best
}

fn main() -> ExitCode {
    let mut draws = Draws(ChaCha8Rng::seed_from_u64(1));
    let (mut met, mut refused, mut far, mut compared, mut slower) = (0, 0, 0, 0, 0);
    let mut ratios = Vec::new();
    let mut asked = 0;
    while asked < PROBLEMS {
        let (body, start, demand) = draws.problem();
        let advice = match advise(&body, &start, &demand) {
            Ok(advice) => advice,
            // what no method can do is no advice
            Err(AdviseError::Conditioning { .. } | AdviseError::Chaotic { .. }) => continue,
            Err(error) => {
                println!("{error}");
                (refused, asked) = (refused + 1, asked + 1);
                continue;
            }
        };
        asked += 1;
        let best = &advice.best;
        let actual = check(&body, &start, &demand, best).unwrap_or(f64::INFINITY);
        let ratio = actual / demand.attitude_error;
        ratios.push(actual / best.attitude_error.value);
        met += usize::from(ratio <= 1.0);
        far += usize::from(ratio < 1.0 / 30.0);
        let head = format!(
            "{:24} {:.1e} s, {:.1e} rad: {ratio:8.2e} of it",
            best.method, demand.until, demand.attitude_error
        );
        if compared == BY_BRUTE_FORCE || ExactMotion::new(&body, &start).is_err() {
            println!("{head}");
            continue;
        }
        compared += 1;
        let (name, n) = match best.setting {
            Setting::Tolerance { tolerance, .. } => (format!("{}:{tolerance:e}", best.method), 1),
            _ => (best.method.clone(), best.steps.unwrap_or(1)),
        };
        let own = (0..3).filter_map(|_| tried(&body, &start, demand.until, (&name, n))).map(|own| own.0);
        let own = own.fold(f64::INFINITY, f64::min);
        let found = by_brute_force(&body, &start, &demand, own);
        let (other, text) =
            found.map_or((own, String::new()), |(seconds, name)| (seconds, format!(", {name}")));
        slower += usize::from(own > 2.0 * other);
        println!("{head}; {:.1} times the quickest of the grid{text}", own / other);
    }
    ratios.sort_by(f64::total_cmp);
    let quantile =
        |share: usize| ratios.get((ratios.len().saturating_sub(1)) * share / 10).copied().unwrap_or(f64::NAN);
    println!("{met} of {PROBLEMS} demands met, {refused} without advice, {far} met more than 30 times over");
    println!(
        "actual over predicted error: median {:.2}, 10 % {:.2}, 90 % {:.2}",
        quantile(5),
        quantile(1),
        quantile(9)
    );
    println!("{slower} of {compared} more than twice as slow as the quickest of the grid");
    if met < 95 || slower > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
