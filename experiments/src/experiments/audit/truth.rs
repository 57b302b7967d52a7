//! What is allowed of a record, and whether it is further off than that.

use nalgebra::{Matrix6, SVD, Vector3, Vector6};
use polhode::audit::{Frame, Judgement, Noise, Question, Reading, Trajectory, audit};
use polhode::flow::FreeMotion;
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode_files::error::{Error, unexpected};

use super::TOLERANCE;
use super::motion::Row;
use super::nearest::apart;
use super::specimen::{Distance, Specimen};
use super::writing::{Form, Writing, convention, one_of, written};

/// Deviations of a row up to so many standard deviations of a component are within noise that is declared: of a million rows
/// noise alone takes some to six.
const WITHIN_NOISE: f64 = 10.0;

/// Which columns are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Columns {
    Both,
    Attitude,
    Rates,
    /// Attitude, and L in space.
    Momentum,
}

/// How a record is written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    pub(super) columns: Columns,
    pub(super) form: Form,
    pub(super) writing: Writing,
    /// Standard deviation that is declared, rad and relative to ω; 0 without.
    pub(super) noise: f64,
}

impl Columns {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Both => "attitude, rates",
            Self::Attitude => "attitude",
            Self::Rates => "rates",
            Self::Momentum => "attitude, L",
        }
    }
}

impl Style {
    /// What limits the numbers.
    pub(super) fn limit(self) -> &'static str {
        if self.noise > 0.0 { "declared noise" } else { self.writing.limit() }
    }

    /// Any columns and digits; with noise in one of three.
    pub(super) fn random(random: &mut Random) -> Self {
        let columns = match random.below(10) {
            0 | 1 => Columns::Attitude,
            2 => Columns::Rates,
            3 => Columns::Momentum,
            _ => Columns::Both,
        };
        let form = one_of(random, [Form::Quaternion, Form::Matrix, Form::Angles, Form::Rodrigues]);
        let writing = Writing { noise: 0.0, ..Writing::random(random) };
        let noise = if random.below(3) == 0 { libm::exp10(random.between(-7.0, -3.0)) } else { 0.0 };
        Style { columns, form, writing, noise }
    }
}

/// What became of a record.
pub(super) struct Judged {
    pub(super) judgement: Judgement,
    pub(super) style: Style,
    /// The largest distance of a row from the motion over what is allowed there; above 1 the record is not right.
    pub(super) excess: f64,
    /// The integrator that is named.
    pub(super) integrator: Option<String>,
}

impl Judged {
    pub(super) fn is_false_right(&self) -> bool {
        self.judgement == Judgement::Right && self.excess > 1.0
    }
}

/// Writes `specimen`, and has it judged.
pub(super) fn judged(specimen: &Specimen, style: Style, random: &mut Random) -> Result<Judged, Error> {
    let body = specimen.body()?;
    let size = specimen.size();
    let mut reading = convention(random, style.form);
    if style.columns == Columns::Rates {
        // without attitude, components in space tell nothing of the body
        reading.omega_frame = Some(Frame::Body);
    }
    let rounding = rounding(specimen, &reading, style, random);
    let noisy: Vec<Row> =
        specimen.rows.iter().map(|row| with_noise(*row, style.noise, size, random)).collect();
    let record = record(specimen, &noisy, &reading, style, random);
    let mut question = Question::new(Some(body));
    question.tolerance = TOLERANCE;
    let unless = |columns: Columns| if style.columns == columns { 0.0 } else { style.noise };
    question.noise = Noise { attitude: unless(Columns::Rates), rates: unless(Columns::Attitude) * size };
    if question.noise.rates > 0.0 {
        // who declares a noise in rad/s knows the unit, which the motion of a sphere does not tell
        question.claims.rate_unit = reading.rate_unit;
    }
    let verdict = audit(&record, &question).map_err(unexpected)?;
    let limit = |rounding: f64| TOLERANCE.max(rounding).max(WITHIN_NOISE * style.noise);
    let limits = Distance { attitude: limit(rounding.attitude), rates: limit(rounding.rates) };
    let mut excess = over(style.columns, specimen.distance()?, limits);
    if verdict.judgement == Judgement::Right && excess > 1.0 {
        // what another start explains is no deviation
        excess = excess.min(least_excess(specimen, style.columns, limits).unwrap_or(excess));
    }
    let integrator = verdict.signature.map(|found| found.method);
    Ok(Judged { judgement: verdict.judgement, style, excess, integrator })
}

/// The largest distance of the columns that are written, over what is allowed.
fn over(columns: Columns, distance: Distance, limits: Distance) -> f64 {
    let attitude = if columns == Columns::Rates { 0.0 } else { distance.attitude / limits.attitude };
    let rates = if columns == Columns::Attitude { 0.0 } else { distance.rates / limits.rates };
    attitude.max(rates)
}

fn with_noise(row: Row, sigma: f64, size: f64, random: &mut Random) -> Row {
    if sigma == 0.0 {
        return row;
    }
    let turn = Quat::cayley(Vec3::from(random.normal_vector()) * (0.5 * sigma));
    let omega = row.omega + Vec3::from(random.normal_vector()) * (sigma * size);
    Row { attitude: row.attitude * turn, omega, ..row }
}

fn record(
    specimen: &Specimen,
    rows: &[Row],
    reading: &Reading,
    style: Style,
    random: &mut Random,
) -> Trajectory {
    let mut record = written(random, rows, reading, style.form, style.writing);
    match style.columns {
        Columns::Both => {}
        Columns::Attitude => record.rates = None,
        Columns::Rates => record.attitude = None,
        Columns::Momentum => {
            let moments = Vec3(specimen.moments);
            let in_space = |row: &Row| row.attitude.normalized().rotate(row.omega.times(moments)).0;
            let write = |row: &Row| in_space(row).map(|x| style.writing.number(random, x, 1.0));
            record.momentum = Some(rows.iter().map(write).collect());
            record.rates = None;
        }
    }
    record
}

/// Rows that the rounding is read off.
const LOOKS: usize = 400;

/// How far the digits take a row from what is written.
fn rounding(specimen: &Specimen, reading: &Reading, style: Style, random: &mut Random) -> Distance {
    let size = specimen.size();
    let every = specimen.rows.len().div_ceil(LOOKS);
    let rows: Vec<Row> = specimen.rows.iter().step_by(every).copied().collect();
    let record = record(specimen, &rows, reading, style, random);
    let mut in_space = *reading;
    in_space.momentum_frame = Some(Frame::Space);
    let [a, b, c] = specimen.moments;
    let inverse = Vec3([1.0 / a, 1.0 / b, 1.0 / c]);
    let mut most = Distance::default();
    for (k, row) in rows.iter().enumerate() {
        if let Some(read) = reading.attitude(&record, k) {
            most.attitude = most.attitude.max(rotation_angle(row.attitude.normalized(), read));
        }
        let by_momentum = in_space.momentum_body(&record, k).map(|m| m.times(inverse));
        if let Some(read) = reading.omega_body(&record, k).or(by_momentum) {
            most.rates = most.rates.max((row.omega - read).norm() / size);
        }
    }
    most
}

/// Rounds of Lawson's iteration, by which the largest distance becomes small.
const ROUNDS: usize = 40;

/// Most sweeps of a decomposition.
const SWEEPS: usize = 1000;

/// Change of the start for derivatives, rad and relative.
const CHANGE: f64 = 1e-6;

/// The largest distance over what is allowed from the exact motion that comes nearest to the rows: least squares, weighed
/// again and again by the distances that are left.
///
/// Source: C. L. Lawson, Contributions to the theory of linear least maximum approximation (1961).
fn least_excess(specimen: &Specimen, columns: Columns, limits: Distance) -> Option<f64> {
    let body = specimen.body().ok()?;
    let size = specimen.size();
    let rows = &specimen.rows;
    let start = specimen.start;
    let motion = |p: &Vector6<f64>| {
        let turn: nalgebra::UnitQuaternion<f64> =
            Quat::cayley(Vec3([p[0], p[1], p[2]]) * 0.5).normalized().into();
        let omega = start.1 + Vector3::new(p[3], p[4], p[5]) * size;
        FreeMotion::from_omega(body.inertia(), start.0 * turn, omega).ok()
    };
    let a = if columns == Columns::Rates { 0.0 } else { 1.0 / limits.attitude };
    let b = if columns == Columns::Attitude { 0.0 } else { 1.0 / limits.rates };
    let apart = |motion: &FreeMotion, row: &Row| -> Option<[f64; 6]> {
        let [p, q, r, x, y, z] = apart(&body, motion, row, size)?;
        Some([p * a, q * a, r * a, x * b, y * b, z * b])
    };
    let mut p = Vector6::zeros();
    let mut weights = vec![1.0; rows.len()];
    let mut best: Option<f64> = None;
    for _ in 0..ROUNDS {
        let centre = motion(&p)?;
        let around = (0..6).map(|k| motion(&(p + Vector6::ith(k, CHANGE)))).collect::<Option<Vec<_>>>()?;
        let (mut normal, mut side) = (Matrix6::zeros(), Vector6::zeros());
        let mut sizes = Vec::with_capacity(rows.len());
        for (row, weight) in rows.iter().zip(&weights) {
            let here = apart(&centre, row)?;
            let there = around.iter().map(|motion| apart(motion, row)).collect::<Option<Vec<_>>>()?;
            for n in 0..6 {
                let slope = Vector6::from_fn(|k, _| (here[n] - there[k][n]) / CHANGE);
                normal += slope * slope.transpose() * *weight;
                side += slope * (here[n] * weight);
            }
            let [a, b, c, x, y, z] = here;
            sizes.push(Vec3([a, b, c]).norm().max(Vec3([x, y, z]).norm()));
        }
        let most = sizes.iter().fold(0.0_f64, |most, size| most.max(*size));
        best = Some(best.map_or(most, |best: f64| best.min(most)));
        let finite = |x: &f64| x.is_finite();
        if most == 0.0 || !most.is_finite() || !normal.iter().chain(side.iter()).all(finite) {
            break;
        }
        for (weight, size) in weights.iter_mut().zip(&sizes) {
            *weight *= size / most;
        }
        let total: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight *= rows.len() as f64 / total);
        let parts = SVD::try_new(normal, true, true, f64::EPSILON, SWEEPS)?;
        p += parts.pseudo_inverse(1e-14 * normal.norm()).ok()? * side;
    }
    best.filter(|excess| excess.is_finite())
}
