//! The tumbling bodies of the catalogue beside figures of their papers that were not put in.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use polhode::catalogue::{self, NamedBody};
use polhode::flow::{FreeMotion, TumblingElements};
use polhode::method::method;
use polhode::rotation::{EulerSequence, rotation_angle};
use polhode::run::Run;
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use crate::experiment::{Context, Report};

const HOUR: f64 = 3600.0;
const DAY: f64 = 86_400.0;

const URAKAWA: &str = "Urakawa et al. 2019";
const ZHAO: &str = "Zhao et al. 2015";
const PRAVEC: &str = "Pravec et al. 2014";
const BELTON_HALLEY: &str = "Belton et al. 1991";
const BELTON: &str = "Belton et al. 2018";
const GOLDBERG: &str = "Goldberg et al. 2024";
const HARBISON: &str = "Harbison et al. 2011";

/// Neighbours that are followed for Lyapunov's time: how far apart at the start, rad, and how long, d.
const APART: f64 = 1e-11;
const FOLLOWED: f64 = 1200.0;

/// A figure of a paper.
struct Figure {
    body: &'static str,
    quantity: &'static str,
    unit: &'static str,
    source: &'static str,
    printed: f64,
    /// The deviation that is printed with it, or half of its last digit; none where only the order is said.
    within: Option<f64>,
    computed: f64,
}

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let mut report = Report::default();
    let mut table = Table::new(
        "figures",
        "Figures of papers, and what the bodies of the catalogue have.",
        vec![
            Column::new("body", "", "name in the catalogue"),
            Column::new("quantity", "", "what is printed"),
            Column::new("unit", "", "of the next three"),
            Column::new("printed", "", "in the paper").digits(6),
            Column::new("within", "", "deviation that is printed, or half of the last digit").digits(2),
            Column::new("computed", "", "from the catalogue").digits(6),
            Column::new("source", "", "of the printed figure"),
        ],
    );
    let mut figures = elements()?;
    figures.extend(hyperion(context)?);
    for figure in figures {
        let Figure { body, quantity, unit, source, printed, within, computed } = figure;
        if let Some(within) = within {
            report.checks += 1;
            // decimal digits are no doubles
            let off = (computed - printed).abs();
            if off.is_nan() || off > within * (1.0 + 1e-9) {
                let message =
                    format!("tumblers: {body}: {quantity} is {computed}, printed is {printed} +- {within}");
                report.failures.push(message);
            }
        }
        table.push(row![body, quantity, unit, printed, within, computed, source]);
    }
    report.tables.push(table);
    Ok(report)
}

fn named(name: &str) -> Result<NamedBody, Error> {
    catalogue::body(name).ok_or_else(|| unexpected("a body of the catalogue is missing"))
}

fn attitude(body: &NamedBody) -> UnitQuaternion<f64> {
    let [w, x, y, z] = body.attitude;
    UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
}

/// The free motion of a body and its elements.
fn motion(body: &NamedBody) -> Result<(FreeMotion, TumblingElements), Error> {
    let motion = FreeMotion::from_omega(&body.inertia, attitude(body), body.omega_body.into());
    let motion = motion.map_err(unexpected)?;
    let elements = motion.tumbling().ok_or_else(|| unexpected("a body that tumbles does not"))?;
    Ok((motion, elements))
}

/// Of bodies whose free motion is published.
fn elements() -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    let mut add = |body, quantity, unit, source, printed, within, computed| {
        figures.push(Figure { body, quantity, unit, source, printed, within: Some(within), computed });
    };
    let degrees = |angle: f64| angle.to_degrees().rem_euclid(360.0);

    let (_, toutatis) = motion(&named("toutatis")?)?;
    add("toutatis", "P_psi", "d", ZHAO, 5.38, 0.005, toutatis.rotation_period / DAY);
    add("toutatis", "P_phi", "d", ZHAO, 7.40, 0.005, toutatis.precession_period / DAY);
    // angles of the attitude are given to 0.1 degrees, rates to 0.1 degrees a day
    add("toutatis", "lambda", "deg", ZHAO, 180.2, 0.3, degrees(toutatis.pole[0]));
    add("toutatis", "beta", "deg", ZHAO, -54.75, 0.3, toutatis.pole[1].to_degrees());

    let (free, apophis) = motion(&named("apophis")?)?;
    let momentum = free.at(0.0).map_err(unexpected)?.momentum().norm();
    let energy_ratio = free.character().map_err(unexpected)?.spin / momentum;
    add("apophis", "P_1", "h", PRAVEC, 30.56, 0.01, apophis.combined_period() / HOUR);
    add("apophis", "E/E_0", "", PRAVEC, 1.024, 0.013, energy_ratio);

    let (_, tc4) = motion(&named("2012-tc4")?)?;
    add("2012-tc4", "P_phi", "min", URAKAWA, 12.25, 0.01, tc4.precession_period / 60.0);
    add("2012-tc4", "P_psi", "min", URAKAWA, 8.47, 0.01, tc4.rotation_period / 60.0);

    let (free, halley) = motion(&named("halley")?)?;
    let [tilt, _] = free.tilt_range().ok_or_else(|| unexpected("a body that tumbles does not"))?;
    add("halley", "P_phi", "d", BELTON_HALLEY, 3.69, 0.005, halley.precession_period / DAY);
    add("halley", "P_psi", "d", BELTON_HALLEY, 7.1, 0.05, halley.rotation_period / DAY);
    add("halley", "theta", "deg", BELTON_HALLEY, 66.0, 0.5, tilt.to_degrees());

    let (_, oumuamua) = motion(&named("oumuamua")?)?;
    add("oumuamua", "1/P_phi", "1/d", BELTON, 2.77, 0.11, DAY / oumuamua.precession_period);
    add("oumuamua", "2/P_1", "1/d", BELTON, 6.42, 0.18, 2.0 * DAY / oumuamua.combined_period());
    Ok(figures)
}

/// Of Hyperion at its flybys.
fn hyperion(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for (body, rate) in [
        ("hyperion-1981", 4.225),
        ("hyperion-2005-06", 4.433),
        ("hyperion-2005-08", 4.255),
        ("hyperion", 4.255),
    ] {
        let found = named(body)?;
        let orbit = found.orbit.as_ref().ok_or_else(|| unexpected("Hyperion has no orbit"))?;
        let spin = Vector3::from(found.omega_body).norm();
        let (quantity, unit, source) = ("|omega|/n", "", GOLDBERG);
        let computed = spin / orbit.mean_motion;
        figures.push(Figure { body, quantity, unit, source, printed: rate, within: Some(0.0005), computed });
        let (quantity, unit, source) = ("Lyapunov time, order of magnitude", "d", HARBISON);
        let computed = lyapunov(context, &found)?;
        figures.push(Figure { body, quantity, unit, source, printed: 100.0, within: None, computed });
        // what is said of the precession in the body is said of 2005
        if body == "hyperion-1981" {
            continue;
        }
        let (_, elements) = motion(&found)?;
        let (quantity, unit, source) = ("P_psi", "d", HARBISON);
        let computed = elements.rotation_period / DAY;
        figures.push(Figure { body, quantity, unit, source, printed: 16.0, within: Some(1.0), computed });
    }
    let last = named("hyperion")?;
    let body = "hyperion";
    let per_day = Vector3::from(last.omega_body).norm().to_degrees() * DAY;
    let other = EulerSequence::default().attitude([2.989, 1.685, 1.641]);
    let apart = attitude(&last).angle_to(&other);
    for (quantity, unit, printed, within, computed) in [
        ("|omega|", "deg/d", 72.0, Some(0.5), per_day),
        ("angle between the attitudes of both prints", "rad", 0.0, Some(1e-3), apart),
    ] {
        figures.push(Figure { body, quantity, unit, source: HARBISON, printed, within, computed });
    }
    Ok(figures)
}

/// The time in which neighbours part by a factor of e, d, over that in which they are followed.
fn lyapunov(context: &Context, named: &NamedBody) -> Result<f64, Error> {
    let body = named.body().map_err(unexpected)?;
    let taylor = method("taylor").map_err(unexpected)?;
    let ends = context.in_parallel(vec![0.0, APART], |angle| {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), angle);
        let start = body.state(attitude(named) * turn, named.omega_body.into()).map_err(unexpected)?;
        let mut run = Run::new(&taylor, &body, &start, FOLLOWED * DAY).map_err(unexpected)?;
        Ok(run.advance_to(1).map_err(unexpected)?.point.to_dd().attitude)
    });
    let ends = ends.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let [one, other] = ends[..] else { return Err(unexpected("two neighbours are two")) };
    Ok(FOLLOWED / libm::log(rotation_angle(one, other).hi() / APART))
}
