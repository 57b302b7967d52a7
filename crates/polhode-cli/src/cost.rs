//! What a run of many steps will cost, said before it begins.

use std::time::{Duration, Instant};

use polhode::body::{Body, Clock, Point};
use polhode::method::AnyMethod;
use polhode::run::{Run, Watch};
use polhode_files::error::{Error, tell, warn};
use polhode_files::text::short;

/// A run of one body has fewer steps than this: a day or more of the fastest method.
const MOST_STEPS: f64 = 1e12;
/// The steps of all members of an ensemble in one process are fewer than this: a week or more on a core.
const MOST_OF_ALL: f64 = 1e14;
/// A run that takes longer says so.
const LONG: Duration = Duration::from_secs(10);
/// Time for finding out how long a step takes.
const TRIAL: Duration = Duration::from_millis(20);

/// Refuses a run of too many steps; `place` and `value` are the flag or key that a `remedy` would change.
pub(crate) fn check(place: &str, value: f64, steps: f64, remedy: &str) -> Result<(), Error> {
    if steps < MOST_STEPS {
        return Ok(());
    }
    let rule = format!("asks for {} steps, and a run has fewer than {MOST_STEPS:e}", counted(steps));
    Err(Error::input(place, &short(value), &rule, remedy))
}

/// The same for a method that chooses its steps, of which there is about one a radian at least.
pub(crate) fn check_turn(place: &str, value: f64, turn: f64) -> Result<(), Error> {
    // an overflow is refused where the state is
    if turn < MOST_STEPS || !turn.is_finite() {
        return Ok(());
    }
    let rule = format!(
        "the body turns by {} rad up to then, with about one step a rad, and a run has fewer than {MOST_STEPS:e}",
        counted(turn)
    );
    Err(Error::input(
        place,
        &short(value),
        &rule,
        "give an earlier time, or use --method exact where it is known",
    ))
}

/// Refuses more steps of all members together than one process takes.
pub(crate) fn check_all(place: &str, members: u64, steps: f64) -> Result<(), Error> {
    let all = steps * members as f64;
    if steps < MOST_STEPS && all < MOST_OF_ALL {
        return Ok(());
    }
    let (rule, remedy) = if steps < MOST_STEPS {
        (
            format!(
                "{members} members of {} steps are {} steps, and a process takes fewer than {MOST_OF_ALL:e}",
                counted(steps),
                counted(all)
            ),
            "split the members with --shard K/N, or use a larger step",
        )
    } else {
        (
            format!("{} steps to the last time, and a run has fewer than {MOST_STEPS:e}", counted(steps)),
            "use a larger step or earlier times",
        )
    };
    Err(Error::input(place, "", &rule, remedy))
}

/// Warns where a step of `step` s, set by a flag or key, turns a body of this `speed`, rad/s, so far that no method is accurate.
pub(crate) fn warn_coarse(place: &str, step: f64, speed: f64) {
    if step * speed > 1.0 {
        warn(&format!(
            "{place}: '{}': turns the body by {:.1} rad per step; above 1 rad no stepping method is accurate; use a smaller step",
            short(step),
            step * speed
        ));
    }
}

/// Says how long a run of `steps` takes, where that is long.
pub(crate) fn announce(method: &dyn AnyMethod, body: &Body, start: Point<f64>, clock: Clock, steps: u64) {
    let Some(whole) = estimate(method, body, start, clock, steps).filter(|whole| *whole > LONG) else {
        return;
    };
    tell(
        "note",
        &format!("{} steps of {} take about {}", counted(steps as f64), method.name(), shown(whole)),
    );
}

/// How long `steps` steps take, from some of them; `None` where they cannot be taken.
fn estimate(
    method: &dyn AnyMethod,
    body: &Body,
    start: Point<f64>,
    clock: Clock,
    steps: u64,
) -> Option<Duration> {
    let mut run = Run::from_point(method, body, start, clock).ok()?.watching(Watch::Never);
    let begin = Instant::now();
    let mut taken = 0_u64;
    while begin.elapsed() < TRIAL && taken < steps {
        taken = taken.saturating_mul(2).clamp(1, steps);
        run.advance_to(taken).ok()?;
    }
    let seconds = begin.elapsed().as_secs_f64() / taken.max(1) as f64 * steps as f64;
    Duration::try_from_secs_f64(seconds).ok()
}

/// A number of steps for reading.
fn counted(steps: f64) -> String {
    let three: f64 = format!("{steps:.2e}").parse().unwrap_or(steps);
    if three < 1e6 { format!("{three}") } else { format!("{three:e}") }
}

/// A time for reading.
fn shown(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    let units = [(86_400.0, "days"), (3600.0, "hours"), (60.0, "minutes")];
    let (size, name) = units.into_iter().find(|(size, _)| seconds >= 2.0 * size).unwrap_or((1.0, "seconds"));
    format!("{:.0} {name}", seconds / size)
}

#[cfg(test)]
mod tests {
    use polhode::inertia::Inertia;
    use polhode::method::method;
    use polhode::rotation::{Quat, Vec3};

    use super::*;

    #[test]
    fn an_estimate_grows_with_the_steps() {
        let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap());
        let start = body.enter_omega(Quat::identity(), Vec3([0.4, 1.0, -0.3])).unwrap().to_f64();
        let method = method("rk4").unwrap();
        let of =
            |steps| estimate(method.as_ref(), &body, start, Clock::new(1e-9), steps).unwrap().as_secs_f64();
        // a step of rk4 takes more than a nanosecond and less than a tenth of a millisecond, on any machine and under load
        assert!((10.0..1e6).contains(&of(10_000_000_000)), "{}", of(10_000_000_000));
        assert!(of(1) < 1.0);
    }

    #[test]
    fn refusals_name_the_bound() {
        assert!(check("--step", 1e-12, 9.9e11, "use a larger step").is_ok());
        let error = check("--step", 1e-12, 1e12, "use a larger step").unwrap_err().to_string();
        assert_eq!(
            error,
            "--step: '1e-12': asks for 1e12 steps, and a run has fewer than 1e12; use a larger step"
        );
        let all = check_all("spec.toml:3", 1_000_000, 1e9).unwrap_err().to_string();
        assert!(
            all.contains("1000000 members of 1e9 steps are 1e15 steps") && all.contains("--shard"),
            "{all}"
        );
        assert!(check_all("spec.toml:3", 1, 1e12).unwrap_err().to_string().contains("larger step"));
        assert!(check_turn("--until", 1e13, 1e13).unwrap_err().to_string().contains("turns by 1e13 rad"));
        assert_eq!(
            [5.0, 119.0, 121.0, 7300.0, 2e5].map(|s| shown(Duration::from_secs_f64(s))),
            ["5 seconds", "119 seconds", "2 minutes", "2 hours", "2 days"]
        );
        assert_eq!([1234.0, 123_456_789.0].map(counted), ["1230", "1.23e8"]);
    }
}
