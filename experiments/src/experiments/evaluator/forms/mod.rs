//! The same motions by other published forms of the solution, in doubles, with constants in doubles as in the programs that use them.
//!
//! Each is written from its formulas with as much care for its constants: one function gives the curve of the momentum to all but the
//! last two, and the inputs have few digits, so that no form rounds the momentum of the start. The forms differ in the angle that is
//! left. Those of Principia and of Orekit are the steps of these programs, cancellations included.

mod celledoni;
mod orekit;
mod plain;
mod van_zon;

use polhode::body::{Body, Time};
use polhode::flow::{Flow, FreeBody};
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};
use polhode::truth::LOST;
use polhode_files::error::Error;
use polhode_pages::table::{Column, Table, row};

use self::plain::Curve;
use super::SEED;
use super::bound::{UNIT, errors, library, motion_of};
use super::grid::Start;
use super::reference::Reference;
use crate::experiment::{Context, Report};
use crate::statistics::rounded;

/// The attitude at a time, after the constants are worked out.
pub(super) type Motion = Box<dyn Fn(f64) -> Quat<f64>>;

/// A form by its name and source.
pub(super) struct Published {
    pub(super) name: &'static str,
    pub(super) source: &'static str,
    pub(super) motion: fn(&Start) -> Motion,
}

pub(super) const FORMS: [Published; 6] = [
    Published {
        name: "third kind, frame of m and dm/dt (Celledoni et al.)",
        source: "Celledoni, Fassò, Säfström and Zanna, SIAM J. Sci. Comput. 30 (2008) 2084, as an early version of Principia's physics/euler_solver_body.hpp follows it; TOMS algorithm 903 has this frame and the next; here 1 - n is no difference that cancels",
        motion: celledoni::moving_frame,
    },
    Published {
        name: "third kind and arc tangent (Celledoni et al.)",
        source: "the quaternions of the same article, whose integral has an elementary part; Carlson's R_J over what is left of a half period",
        motion: celledoni::swing,
    },
    Published {
        name: "the same, of the smaller characteristic",
        source: "polhode::flow::FreeBody in doubles: of the two complementary characteristics the one that loses less",
        motion: smaller_characteristic,
    },
    Published {
        name: "the same, of the whole amplitude (Principia)",
        source: "Principia, physics/euler_solver_body.hpp; the integral of the third kind by Carlson's method in place of Fukushima's",
        motion: celledoni::principia,
    },
    Published {
        name: "theta series and arc tangent (van Zon and Schofield)",
        source: "van Zon and Schofield, J. Comput. Phys. 225 (2007) 145",
        motion: van_zon::motion,
    },
    Published {
        name: "Euler's angles and a quadrature (Orekit)",
        source: "Orekit 12, org.orekit.attitudes.TorqueFree: k^2 from differences; the quadrature over a period here exact to rounding, there to 1e-13",
        motion: orekit::motion,
    },
];

/// The library's flow in doubles, from the start.
fn smaller_characteristic(start: &Start) -> Motion {
    let start = *start;
    Box::new(move |t| {
        let lost = Quat::new(f64::NAN, Vec3([0.0; 3]));
        let Ok(inertia) = Inertia::from_moments(start.moments) else { return lost };
        let body = Body::free(inertia);
        let Ok(point) = body.enter_omega(Quat::identity(), Vec3(start.omega)) else { return lost };
        let mut x = point.to_f64();
        FreeBody::<f64>::new(&body.rotor()).flow(Time::from_seconds(0.0), t, &mut x);
        x.attitude
    })
}

/// Kinds of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Generic,
    NearSeparatrix,
    NearSymmetric,
    Slender,
    NearSteady,
}

const KINDS: [(Kind, &str); 5] = [
    (Kind::Generic, "generic"),
    (Kind::NearSeparatrix, "near the separatrix"),
    (Kind::NearSymmetric, "near-symmetric"),
    (Kind::Slender, "slender"),
    (Kind::NearSteady, "near a steady spin"),
];

/// Angles turned, rad.
const TURNED: [f64; 4] = [1.0, 1e3, 1e6, 1e9];

/// A motion of some kind, whose moments and rates have 24 bits: their products are exact.
fn drawn(kind: Kind, random: &mut Random) -> Start {
    let decades = |from: f64, to: f64, random: &mut Random| libm::exp10(random.between(from, to));
    let smallest = match kind {
        Kind::Slender => decades(-6.0, -3.0, random),
        _ => random.between(0.2, 0.8),
    };
    let room = smallest.min(1.0 - smallest) * random.between(0.1, 0.9);
    let middle = match kind {
        Kind::NearSymmetric => 1.0 - decades(-6.0, -3.0, random),
        _ => 1.0 - room,
    };
    let any = random.normal_vector().normalize();
    let mut omega = [any.x, any.y, any.z];
    let near = decades(-8.0, -2.0, random);
    match kind {
        // across the middle axis
        Kind::NearSeparatrix => (omega[0], omega[2]) = (omega[0] * near, omega[2] * near),
        Kind::NearSteady => {
            let axis = if random.below(2) == 0 { 0 } else { 2 };
            (omega[1], omega[2 - axis]) = (omega[1] * near, omega[2 - axis] * near);
        }
        Kind::Generic | Kind::NearSymmetric | Kind::Slender => {}
    }
    let short = |x: f64| f64::from(x as f32);
    Start { moments: [smallest, middle, 1.0].map(short), omega: omega.map(short) }
}

/// Errors of one form in motions of one kind, by the angle turned, rad.
type Errors = [Vec<f64>; TURNED.len()];

/// For each angle turned: its columns for half of the motions, the largest, and those that are lost, and the heading of the first.
const NAMES: [([&str; 3], &str); TURNED.len()] = [
    (["median_1", "largest_1", "lost_1"], "after 1 rad: median"),
    (["median_1e3", "largest_1e3", "lost_1e3"], "after 1e3 rad: median"),
    (["median_1e6", "largest_1e6", "lost_1e6"], "after 1e6 rad: median"),
    (["median_1e9", "largest_1e9", "lost_1e9"], "after 1e9 rad: median"),
];

pub(super) fn run(context: &Context, report: &mut Report) -> Result<(), Error> {
    let motions = context.scale.pick(40, 400, 4000_u64);
    let mut columns = vec![
        Column::new("motion", "", "kind of motion"),
        Column::new("form", "", "how the angle about L is found"),
    ];
    for ([median, largest, lost], heading) in NAMES {
        columns.extend([
            Column::new(median, "rad", "attitude error of half of the motions, after as many rad")
                .heading(heading)
                .digits(2),
            Column::new(largest, "rad", "largest attitude error; empty where an attitude is lost")
                .heading("largest")
                .digits(2),
            Column::new(lost, "", "motions whose attitude is more than 1 rad off").hidden(),
        ]);
    }
    columns.push(Column::new("source", "", "where the formulas are from").hidden());
    let mut table = Table::new(
        "forms",
        format!(
            "Attitude errors of published forms of the solution in doubles, constants included, {motions} motions of each kind, after 1, 1e3, 1e6 and 1e9 rad. The last form has its constants and phases in double-double."
        ),
        columns,
    );
    let found = context.in_parallel((0..KINDS.len()).collect(), |kind: usize| errors_of(kind, motions));
    for (found, (_, kind)) in found.into_iter().zip(KINDS) {
        let ours = ("two theta functions", "FreeMotion::at");
        let named = FORMS.iter().map(|form| (form.name, form.source)).chain([ours]);
        for ((form, source), by_time) in named.zip(found?) {
            let mut cells = row![kind, form].to_vec();
            for mut errors in by_time {
                errors.sort_by(f64::total_cmp);
                let shown = |error: f64| (error <= LOST).then(|| rounded(error));
                let lost = errors.iter().filter(|error| **error > LOST).count() as u64;
                cells.extend(row![shown(errors[errors.len() / 2]), shown(errors[errors.len() - 1]), lost]);
            }
            cells.push(source.into());
            table.push(cells);
        }
    }
    report.checks += motions * table.rows().len() as u64;
    report.tables.push(table);
    Ok(())
}

/// Of every form and at last of the library.
fn errors_of(kind: usize, motions: u64) -> Result<Vec<Errors>, Error> {
    let mut all: Vec<Errors> = vec![Default::default(); FORMS.len() + 1];
    for number in 0..motions {
        let mut random = Random::new(SEED + 1).stream((kind as u64) << 32 | number);
        let start = drawn(KINDS[kind].0, &mut random);
        let speed = Vec3(start.omega).norm();
        let times = TURNED.map(|turned| turned / speed);
        let reference = Reference::new(&start);
        let exact = times.map(|t| reference.at(t));
        let angle = |q: Quat<f64>, k: usize| {
            let error = errors((q, Vec3(start.omega)), exact[k])[0] * UNIT;
            // a motion without an attitude is lost; a NaN might sort as the least
            if error.is_nan() { f64::INFINITY } else { error }
        };
        for (form, errors) in FORMS.iter().zip(&mut all) {
            let motion = (form.motion)(&start);
            (0..times.len()).for_each(|k| errors[k].push(angle(motion(times[k]), k)));
        }
        let ours = library(&motion_of(&start)?, &times)?;
        (0..times.len()).for_each(|k| all[FORMS.len()][k].push(angle(ours[k].0, k)));
    }
    Ok(all)
}
