//! Every statement of a lecture on rigid bodies, computed and compared.
//!
//! Exact statements hold to rounding. Those that hold in a limit come as a sequence of differences that must fall
//! at the predicted rate.

mod drawings;
mod free;
mod heavy;
mod motion;
mod symmetric;

use nalgebra::Vector3;
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::num::{Dd, Real};
use polhode::rotation::Vec3;
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use crate::experiment::{Context, Report};

/// A measured rate may differ by this share from the predicted one.
const RATE_TOLERANCE: f64 = 0.03;

/// Adds the statements of a part of the lecture.
type Block = fn(&mut Statements) -> Result<(), Error>;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let parts: Vec<Block> =
        vec![motion::general, motion::equations, free::statements, symmetric::statements, heavy::statements];
    let found = context.in_parallel(parts, |part| {
        let mut statements = Statements::default();
        part(&mut statements).map(|()| statements)
    });
    let mut report = Report::default();
    let (mut lecture, mut sequences) = (statements_table(), sequences_table());
    for statements in found {
        let Statements(statements) = statements?;
        for statement in statements {
            statement.write(&mut lecture, &mut sequences);
            if !statement.passed() {
                report.failures.push(format!("{}: {}", statement.section, statement.text));
            }
        }
    }
    report.views.push(lecture.clone());
    report.tables.extend([lecture, sequences]);
    report.drawings = vec![drawings::polhodes()?, drawings::cones()?, drawings::axis_paths()?];
    Ok(report)
}

fn statements_table() -> Table {
    Table::new(
        "lecture",
        "Statements on rotating bodies, formula against computation.",
        vec![
            Column::new("section", "", "section of the lecture"),
            Column::new("statement", "", "what is said"),
            Column::new(
                "formula",
                "",
                "value of the formula; of a vector, its length; of what is constant, its change: 0",
            )
            .digits(6),
            Column::new("computed", "", "value computed without the formula").digits(6),
            Column::new("difference", "", "largest |computed - formula| over the scale of the quantity")
                .digits(2),
            Column::new("tolerance", "", "largest difference that passes").digits(2),
            Column::new("predicted_rate", "", "power of the small quantity with which the difference falls")
                .heading("rate"),
            Column::new("measured_rate", "", "the same, measured at the last halving")
                .heading("measured")
                .digits(4),
            Column::new("verdict", "", "passed or failed"),
            Column::new("note", "", "what the formula needs to be right").hidden(),
        ],
    )
}

fn sequences_table() -> Table {
    Table::new(
        "sequences",
        "Statements that hold in a limit: difference against the small quantity.",
        vec![
            Column::new("section", "", "section of the lecture"),
            Column::new("statement", "", "what is said"),
            Column::new("small", "", "the quantity that goes to zero"),
            Column::new("formula", "", "value of the formula").digits(6),
            Column::new("computed", "", "value computed without the formula").digits(6),
            Column::new("difference", "", "|computed - formula| over |formula|").digits(3),
            Column::new("rate", "", "log2 of the ratio to the row before, per halving").digits(4),
        ],
    )
}

/// One statement and what was found.
struct Statement {
    section: &'static str,
    text: String,
    formula: f64,
    computed: f64,
    difference: f64,
    test: Test,
    note: &'static str,
}

enum Test {
    /// The difference is rounding.
    Exact { tolerance: f64 },
    /// The difference falls as a power of a small quantity.
    Limit { rate: f64, points: Vec<Point> },
}

/// A value of the small quantity, with what formula and computation give there.
#[derive(Clone, Copy)]
struct Point {
    small: f64,
    formula: f64,
    computed: f64,
}

impl Point {
    fn difference(&self) -> f64 {
        (self.computed - self.formula).abs() / self.formula.abs()
    }
}

/// Power with which the difference fell from `a` to `b`.
fn rate_between(a: &Point, b: &Point) -> f64 {
    libm::log2(a.difference() / b.difference()) / libm::log2(a.small / b.small)
}

impl Statement {
    fn measured_rate(&self) -> Option<f64> {
        match &self.test {
            Test::Limit { points, .. } => match points.as_slice() {
                [.., a, b] => Some(rate_between(a, b)),
                _ => None,
            },
            Test::Exact { .. } => None,
        }
    }

    fn passed(&self) -> bool {
        match self.test {
            Test::Exact { tolerance } => self.difference <= tolerance,
            Test::Limit { rate, .. } => {
                self.measured_rate().is_some_and(|measured| (measured / rate - 1.0).abs() <= RATE_TOLERANCE)
            }
        }
    }

    fn write(&self, lecture: &mut Table, sequences: &mut Table) {
        let (tolerance, rate) = match &self.test {
            Test::Exact { tolerance } => (Some(*tolerance), None),
            Test::Limit { rate, .. } => (None, Some(*rate)),
        };
        lecture.push(row![
            self.section,
            self.text.as_str(),
            self.formula,
            self.computed,
            self.difference,
            tolerance,
            rate,
            self.measured_rate(),
            if self.passed() { "passed" } else { "failed" },
            self.note,
        ]);
        if let Test::Limit { points, .. } = &self.test {
            for (k, point) in points.iter().enumerate() {
                let rate = k.checked_sub(1).map(|before| rate_between(&points[before], point));
                sequences.push(row![
                    self.section,
                    self.text.as_str(),
                    point.small,
                    point.formula,
                    point.computed,
                    point.difference(),
                    rate,
                ]);
            }
        }
    }
}

/// The statements of a section, in the order of the lecture.
#[derive(Default)]
struct Statements(Vec<Statement>);

impl Statements {
    /// Two numbers agree to `tolerance`, relative to `scale`.
    fn number(
        &mut self,
        section: &'static str,
        text: impl Into<String>,
        [formula, computed]: [f64; 2],
        scale: f64,
        tolerance: f64,
    ) -> &mut Self {
        let difference = (computed - formula).abs() / scale;
        self.exact(section, text, [formula, computed, difference], tolerance)
    }

    /// Two vectors agree to `tolerance`, relative to the formula's length.
    fn vector(
        &mut self,
        section: &'static str,
        text: impl Into<String>,
        [formula, computed]: [Vector3<f64>; 2],
        tolerance: f64,
    ) -> &mut Self {
        self.vector_in(section, text, [formula, computed], formula.norm(), tolerance)
    }

    /// The same relative to `scale`, the size of what was summed.
    fn vector_in(
        &mut self,
        section: &'static str,
        text: impl Into<String>,
        [formula, computed]: [Vector3<f64>; 2],
        scale: f64,
        tolerance: f64,
    ) -> &mut Self {
        let difference = (computed - formula).norm() / scale;
        self.exact(section, text, [formula.norm(), computed.norm(), difference], tolerance)
    }

    /// Formula, computed value and largest relative difference as they were found.
    fn exact(
        &mut self,
        section: &'static str,
        text: impl Into<String>,
        [formula, computed, difference]: [f64; 3],
        tolerance: f64,
    ) -> &mut Self {
        let (text, test) = (text.into(), Test::Exact { tolerance });
        self.0.push(Statement { section, text, formula, computed, difference, test, note: "" });
        self
    }

    /// What is constant changes by no more than `tolerance`, relative to its size.
    fn constant(
        &mut self,
        section: &'static str,
        text: impl Into<String>,
        change: f64,
        tolerance: f64,
    ) -> &mut Self {
        self.exact(section, text, [0.0, change, change], tolerance)
    }

    /// The difference falls as the small quantity to the power `rate`.
    fn limit(
        &mut self,
        section: &'static str,
        text: impl Into<String>,
        rate: f64,
        points: Vec<Point>,
    ) -> &mut Self {
        let last = points.last().copied().unwrap_or(Point { small: 0.0, formula: 0.0, computed: f64::NAN });
        let Point { formula, computed, .. } = last;
        let (text, test) = (text.into(), Test::Limit { rate, points });
        let difference = last.difference();
        self.0.push(Statement { section, text, formula, computed, difference, test, note: "" });
        self
    }

    /// A remark on the last statement.
    fn note(&mut self, note: &'static str) {
        if let Some(last) = self.0.last_mut() {
            last.note = note;
        }
    }
}

/// The free motion of a body with these moments from this angular velocity.
fn free_motion(moments: [f64; 3], omega: Vector3<f64>) -> Result<FreeMotion, Error> {
    let inertia = Inertia::from_moments(moments).map_err(unexpected)?;
    FreeMotion::from_omega(&inertia, Default::default(), omega).map_err(unexpected)
}

/// Derivative at `t` of a vector known in double-double: central difference, truncated below the rounding of `f64`.
fn derivative(t: f64, f: impl Fn(Dd) -> Vec3<Dd>) -> Vector3<f64> {
    let h = Dd::of(libm::exp2(-30.0));
    let slope = (f(Dd::of(t) + h) - f(Dd::of(t) - h)) * (Dd::ONE / (h * 2.0));
    slope.map(Dd::hi).into()
}

/// Second derivative at `t`, likewise.
fn second_derivative(t: f64, f: impl Fn(Dd) -> Vec3<Dd>) -> Vector3<f64> {
    let h = Dd::of(libm::exp2(-24.0));
    let t = Dd::of(t);
    let sum = f(t + h) + f(t - h) - f(t) * Dd::of(2.0);
    (sum * (Dd::ONE / (h * h))).map(Dd::hi).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limit(rate: f64, power: f64) -> Statement {
        let point = |k: i32| {
            let small = libm::exp2(-f64::from(k));
            Point { small, formula: 2.0, computed: 2.0 + 3.0 * libm::pow(small, power) }
        };
        let mut statements = Statements::default();
        statements.limit("", "", rate, (4..8).map(point).collect());
        statements.0.remove(0)
    }

    #[test]
    fn a_limit_passes_at_its_own_rate_alone() {
        assert!(limit(2.0, 2.0).passed());
        assert!(!limit(2.0, 1.0).passed());
        assert!(!limit(1.0, 2.0).passed(), "faster than predicted is also wrong");
        let mut none = Statements::default();
        none.limit("", "", 1.0, Vec::new());
        assert!(!none.0[0].passed());
    }

    #[test]
    fn a_difference_beyond_its_tolerance_or_without_value_fails() {
        let mut statements = Statements::default();
        statements.number("", "", [1.0, 1.0 + 1e-12], 1.0, 1e-13);
        statements.number("", "", [1.0, f64::NAN], 1.0, 1e-13);
        statements.constant("", "", 1e-16, 1e-15);
        let verdicts: Vec<bool> = statements.0.iter().map(Statement::passed).collect();
        assert_eq!(verdicts, [false, false, true]);
    }

    #[test]
    fn derivatives_are_good_to_rounding() {
        let f = |t: Dd| {
            let (sin, cos) = t.sin_cos();
            Vec3([sin, cos, t * t])
        };
        let (sin, cos) = libm::sincos(0.7);
        assert!((derivative(0.7, f) - Vector3::new(cos, -sin, 1.4)).norm() < 1e-15);
        assert!((second_derivative(0.7, f) - Vector3::new(-sin, -cos, 2.0)).norm() < 1e-14);
    }
}
