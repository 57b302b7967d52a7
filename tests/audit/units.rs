//! A verdict is the same to the last bit in any unit of time and of moments, as nothing in it is compared with a number that has
//! a unit, and on any machine: `tests/data/golden/verdicts.txt`. `POLHODE_BLESS=1` writes that file again; read the difference.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::audit::{
    AngleUnit, Angles, Attitudes, Digits, Fault, Noise, Question, RateUnit, Reading, Trajectory, Turns,
    Verdict, audit,
};
use polhode::body::{Body, Force};
use polhode::inertia::Inertia;
use polhode::rotation::{Quat, Vec3};
use polhode::run::Run;

use crate::fixtures::golden;

use super::records::{Form, Seeded, Writing, Written, record};

/// Units of time and of moments, in those of the case: even powers of two, whose roots are powers of two as well.
#[derive(Clone, Copy)]
struct Units {
    time: f64,
    moment: f64,
}

const PLAIN: Units = Units { time: 1.0, moment: 1.0 };

#[derive(Clone, Copy)]
enum Acting {
    Nothing,
    Torque(Vector3<f64>),
    Weight(Vector3<f64>),
}

/// A tensor that is not along its axes, and what acts on it.
fn body(moments: [f64; 3], acting: Acting, Units { time, moment }: Units) -> Body {
    // sines of the standard library differ from machine to machine
    let turn: UnitQuaternion<f64> = Quat::cayley(Vec3([0.3, -0.4, 0.5])).into();
    let turn = turn.to_rotation_matrix();
    let tensor = turn * Matrix3::from_diagonal(&moments.into()) * turn.inverse();
    let inertia = Inertia::from_tensor(0.5 * (tensor + tensor.transpose()) * moment).unwrap();
    let torque = moment / (time * time);
    match acting {
        Acting::Nothing => Body::free(inertia),
        Acting::Torque(of) => Body::free(inertia).with(Force::constant_torque_space(of * torque).unwrap()),
        Acting::Weight(of) => Body::heavy(inertia, of * torque).unwrap(),
    }
}

/// By `method` in steps of a tenth of the interval between rows, of `dt`.
fn written(body: &Body, method: &str, substeps: u64, dt: f64, rows: u64) -> Vec<Written> {
    let attitude = Quat::cayley(Vec3([0.4, -0.7, 0.2])).into();
    let start = body.state(attitude, Vector3::new(0.4, 1.0, -0.3)).unwrap();
    let method = polhode::method(method).unwrap();
    let mut run = Run::new(&method, body, &start, dt / substeps as f64).unwrap();
    let at = |row: u64| {
        let sample = run.advance_to(substeps * row).unwrap();
        (dt * row as f64, sample.state.attitude, Vec3::from(sample.omega_body))
    };
    (0..rows).map(at).collect()
}

fn plain(states: &[Written], form: Form, writing: Writing) -> Trajectory {
    let mut convention = Reading::default();
    convention.rate_unit = Some(RateUnit::RadiansPerSecond);
    if form == Form::Angles {
        let sequence = "zxz".parse().unwrap();
        convention.angles = Some(Angles { sequence, turns: Turns::Intrinsic, unit: AngleUnit::Radians });
    }
    let digits = Some(writing.digits as u32);
    record(&mut Seeded(3), states, &convention, form, writing).with_digits(Digits {
        attitude: digits,
        rates: digits,
        momentum: digits,
    })
}

/// The record in other units.
fn in_units(record: &Trajectory, Units { time, moment }: Units) -> Trajectory {
    let mut record = record.clone();
    record.times.iter_mut().for_each(|t| *t *= time);
    record.rates.iter_mut().flatten().flatten().for_each(|x| *x /= time);
    record.momentum.iter_mut().flatten().flatten().for_each(|x| *x *= moment / time);
    record
}

/// Everything that a verdict says, with times and moments in the units of the case.
fn said(verdict: &Verdict, Units { time, moment }: Units, has_body: bool) -> String {
    let conservation: Vec<_> = (verdict.conservation.iter())
        .map(|kept| {
            let drift = kept.drift.map(|drift| (drift.slope * time, drift.half_width * time));
            (kept.quantity, kept.error, drift, kept.resolution, kept.conserved)
        })
        .collect();
    let ranking: Vec<_> = (verdict.ranking.iter().take(8))
        .map(|one| (one.reading, one.log_likelihood_ratio, one.attitude_defect, one.rate_defect))
        .collect();
    let faults: Vec<_> = (verdict.faults.iter())
        .map(|fault| match *fault {
            Fault::TimeJump { row, interval, usual, count } => {
                Fault::TimeJump { row, interval: interval / time, usual: usual / time, count }
            }
            other => other,
        })
        .collect();
    let error = verdict.attitude_error.map(|mut error| {
        error.at /= time;
        error
    });
    let signature = verdict.signature.clone().map(|mut found| {
        (found.step, found.at) = (found.step / time, found.at / time);
        found
    });
    let other_body = verdict.other_body.map(|mut other| {
        other.moments = other.moments.map(|x| x / moment);
        other
    });
    let other_torque = verdict.other_torque.map(|mut other| {
        let unit = moment / (time * time);
        other.size /= unit;
        other.constant = other.constant.map(|(frame, torque)| (frame, torque.map(|x| x / unit)));
        other
    });
    let noise = verdict.noise.map(|noise| (noise.attitude, noise.rates * time));
    let traces = &verdict.traces;
    let sums = [&traces.energy, &traces.momentum_norm, &traces.momentum_direction, &traces.attitude]
        .map(|trace| trace.iter().sum::<f64>());
    let tensor = verdict.body.inertia().tensor() / if has_body { moment } else { 1.0 };
    let of = (verdict.judgement, &verdict.suspect, verdict.reading, verdict.tie.clone(), verdict.resolution);
    let more = (&verdict.missing, verdict.flips, verdict.flips_exact);
    format!(
        "{of:?}\n{noise:?}\n{conservation:?}\n{error:?}\n{signature:?}\n{other_body:?}\n{other_torque:?}\n{faults:?}\n{more:?}\n\
         {sums:?}\n{tensor:?}\n{ranking:?}"
    )
}

/// A body that is told, and the record of one.
type Case = (&'static str, Option<([f64; 3], Acting)>, Noise, Trajectory);

/// A change of quaternions, rates and times.
type Change<'a> = &'a dyn Fn(&mut Vec<[f64; 4]>, &mut Vec<[f64; 3]>, &mut Vec<f64>);

fn cases() -> Vec<Case> {
    const MOMENTS: [f64; 3] = [1.0, 2.0, 2.5];
    let (nothing, none) = (Acting::Nothing, Noise::default());
    let torque = Acting::Torque(Vector3::new(2e-3, -1e-3, 3e-3));
    let weight = |c: f64| Acting::Weight(Vector3::new(0.01, 0.02, 0.05) * c);
    let of = |moments, acting, method: &str, substeps| {
        written(&body(moments, acting, PLAIN), method, substeps, 0.05, 240)
    };
    let free = of(MOMENTS, nothing, "rk8", 2);
    let noisy = Writing { noise: 1e-3, ..Writing::EXACT };
    let exact = |states: &[Written]| plain(states, Form::Quaternion, Writing::EXACT);
    let changed = |change: Change| {
        let mut record = exact(&free);
        let (Some(Attitudes::Quaternions(q)), Some(w)) = (&mut record.attitude, &mut record.rates) else {
            panic!("{record:?}")
        };
        change(q, w, &mut record.times);
        record
    };
    let mut momenta = exact(&free);
    let tensor = body(MOMENTS, nothing, PLAIN).inertia().tensor();
    let momentum = |(_, q, w): &Written| q.rotate(Vec3::from(tensor * Vector3::from(*w))).0;
    momenta.momentum = Some(free.iter().map(momentum).collect());
    let mut momenta_alone = momenta.clone();
    momenta_alone.rates = None;
    momenta_alone.momentum.as_mut().unwrap()[100][1] += 1e-3;
    momenta.momentum.as_mut().unwrap()[100][1] += 1e-3;
    let mut rates = exact(&free);
    rates.attitude = None;
    let mut attitudes = plain(&free, Form::Angles, Writing::EXACT);
    attitudes.rates = None;
    let told = Some((MOMENTS, nothing));
    let declared = Noise { attitude: 2.1e-3, rates: 1.2e-3 };
    vec![
        ("right", told, none, plain(&free, Form::Matrix, Writing::EXACT)),
        ("another body", told, none, exact(&of([1.0, 2.0, 2.6], nothing, "rk8", 2))),
        ("a torque", told, none, exact(&of(MOMENTS, torque, "rk8", 2))),
        ("half the weight", Some((MOMENTS, weight(0.5))), none, exact(&of(MOMENTS, weight(1.0), "rk8", 2))),
        ("a coarse run", told, none, plain(&of(MOMENTS, nothing, "rk4", 1), Form::Matrix, Writing::EXACT)),
        (
            "a coarse top",
            Some((MOMENTS, weight(1.0))),
            none,
            exact(&of(MOMENTS, weight(1.0), "lie-poisson", 2)),
        ),
        ("noise", told, none, plain(&free, Form::Quaternion, noisy)),
        ("declared noise", told, declared, plain(&free, Form::Quaternion, noisy)),
        ("five digits", told, none, plain(&free, Form::Rodrigues, Writing { digits: 5, ..Writing::EXACT })),
        ("no body", None, none, exact(&free)),
        ("no body, noise", None, none, plain(&free, Form::Quaternion, noisy)),
        ("rates", Some(([1.0, 2.0, 2.6], nothing)), none, rates),
        ("angles", told, none, attitudes),
        ("momenta beside rates", told, none, momenta),
        ("momenta", told, none, momenta_alone),
        ("a gap", told, none, changed(&|_, _, t| t.iter_mut().skip(100).for_each(|t| *t += 0.75))),
        ("clamped", told, none, changed(&|_, w, _| w.iter_mut().for_each(|w| w[1] = w[1].min(0.5)))),
        (
            "a jump",
            told,
            none,
            changed(&|q, _, _| q.iter_mut().skip(90).for_each(|q| *q = [q[1], -q[0], q[3], -q[2]])),
        ),
        ("a row", told, none, changed(&|q, w, _| (q[77], w[77]) = (q[78], w[76]))),
        ("another sign", told, none, changed(&|_, w, _| w.iter_mut().for_each(|w| *w = w.map(|x| -x)))),
        ("degrees", told, none, changed(&|_, w, _| w.iter_mut().flatten().for_each(|x| *x *= 57.0))),
        ("no rotation", told, none, changed(&|q, _, _| q[77] = q[77].map(|x| 1.5 * x))),
    ]
}

#[test]
fn a_verdict_is_the_same_in_any_units_and_on_any_machine() {
    let mut every = String::new();
    for (name, told, noise, record) in cases() {
        let of = |units: Units| {
            let mut question = Question::new(told.map(|(moments, acting)| body(moments, acting, units)));
            question.noise = Noise { rates: noise.rates / units.time, ..noise };
            let verdict = audit(&in_units(&record, units), &question).unwrap();
            said(&verdict, units, told.is_some())
        };
        let plain = of(PLAIN);
        let there = of(Units { time: 1.0 / 1024.0, moment: 65536.0 });
        for (here, there) in plain.lines().zip(there.lines()) {
            assert_eq!(here, there, "{name}");
        }
        every += &format!("# {name}\n{plain}\n");
    }
    golden("verdicts.txt", &every);
}
