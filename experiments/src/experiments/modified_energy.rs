//! The modified energy of splittings: H + h² H₃ against H, and the exponentially small rest that no modified energy has.
//!
//! # The rest
//! A splitting follows the exact motion of a modified energy up to a rest that is smaller than any power of h. The modified
//! motion has a separatrix through the turns about the middle axis; the splitting, where the rest is not zero, has two curves
//! that miss each other. Near such a turn the momentum moves by a linear map with the eigenvalues `e^{±λh}`, up to cubes of the
//! distance, and the product of the two coordinates along its eigenvectors, times a constant, is the energy above the separatrix.
//! Points that leave one of the turns along its unstable curve arrive at the opposite turn with the energy D; the largest |D|
//! over such points is what is measured, in double-double. `m₂ = G tanh λt` on the separatrix has its pole at `iπ/(2λ)`, so that
//! D is predicted to fall as `exp(−π²/(λh))` times a power of h; λ = |ω| √((I₂−I₁)(I₃−I₂)/(I₁I₃)) (Fontich and Simó, Ergod. Theory
//! Dyn. Syst. 10 (1990) 295; Hairer, Lubich and Wanner, Geometric Numerical Integration, IX.7).

use polhode::body::{Body, Clock, Point};
use polhode::inertia::Inertia;
use polhode::method::{AxisOrder, Step, TwoAxes, method};
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3};
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure, Scale};
use polhode_pages::table::{Column, Table, row};

use crate::experiment::{Context, Report};

/// Moments and angular velocity at the start, rad/s, of the body whose energy is followed.
const MOMENTS: [f64; 3] = [0.625, 0.75, 1.0];
const OMEGA: [f64; 3] = [0.875, 0.25, -0.375];

/// Splittings with an h² term.
const SPLITTINGS: [&str; 4] = ["lie-poisson:321", "lie-poisson:213", "two-turn:13", "two-turn:31"];
/// The body of the rest: its separatrix has λ = 1/√3 at |ω| = 1 rad/s.
const REST_MOMENTS: [f64; 3] = [1.0, 2.0, 3.0];

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let (span, halvings) = context.scale.pick((32.0, 3), (1024.0, 6), (8192.0, 7));
    let swings = context.in_parallel(SPLITTINGS.to_vec(), |name| swings(name, span, halvings));
    let mut energy = Table::new(
        "swing",
        format!(
            "Largest relative change of the energy H and of H + h^2 H3 over {span} s, body 5/8 : 3/4 : 1."
        ),
        vec![
            Column::new("method", "", "splitting with its axes, outermost first"),
            Column::new("h", "s", "step").latex("$h$"),
            Column::new("energy_error", "", "max |H - H(0)| / H").heading("H").digits(3),
            Column::new("energy_order", "", "log2 of the ratio to that at twice the step")
                .heading("order")
                .digits(3),
            Column::new("modified_energy_error", "", "max |H + h^2 H3 - its value at the start| / H")
                .heading("H + h² H3")
                .latex("$H + h^2 H_3$")
                .digits(3),
            Column::new("modified_energy_order", "", "log2 of the ratio to that at twice the step")
                .heading("order")
                .digits(3),
        ],
    );
    let mut swing = Figure::log_log(
        "swing",
        format!("Swing of the energy H and of the modified energy: body 5/8 : 3/4 : 1 over {span} s"),
        "step h (s)",
        "largest relative change",
    );
    for (name, rows) in SPLITTINGS.iter().zip(swings) {
        let rows = rows?;
        let points = |pick: fn(&Swing) -> f64| rows.iter().rev().map(|row| (row.h, pick(row))).collect();
        swing.series.push(Curve::new(format!("{name}: H"), points(|row| row.energy)));
        swing.series.push(Curve::new(format!("{name}: H + h²H₃"), points(|row| row.modified)));
        for (k, now) in rows.iter().enumerate() {
            let order = |pick: fn(&Swing) -> f64| {
                k.checked_sub(1).map(|before| libm::log2(pick(&rows[before]) / pick(now)))
            };
            let orders = [order(|row| row.energy), order(|row| row.modified)];
            energy.push(row![*name, now.h, now.energy, orders[0], now.modified, orders[1]]);
        }
    }

    let steps = context.scale.pick(3, 11, 15);
    let phases = context.scale.pick(4, 12, 24);
    let named = SPLITTINGS.iter().copied().chain(["rattle"]);
    let rests = context.in_parallel(named.clone().collect(), |name| rests(name, steps, phases));
    let mut rest = Table::new(
        "rest",
        "What no modified energy keeps: largest energy above the separatrix, relative, with which points of the unstable curve \
         of a turn about the middle axis arrive at the opposite turn; body 1 : 2 : 3, |omega| = 1 rad/s, lambda = 1/sqrt(3)/s, \
         in double-double. The slope is that of the logarithm against 1/h over the predicted -pi^2/lambda.",
        vec![
            Column::new("method", "", "name in the catalogue, with its axes"),
            Column::new("h", "s", "step").hidden(),
            Column::new("inverse_h", "1/s", "1/h").heading("1/h").latex("$1/h$"),
            Column::new("rest", "", "largest relative energy above the separatrix").digits(3),
            Column::new("slope", "", "slope of ln(rest) against 1/h over -pi^2/lambda").digits(3),
        ],
    );
    let mut fall = Figure::new(
        "rest",
        "Body 1 : 2 : 3 at 1 rad/s: energy above the separatrix after one passage",
        ("1/h (1/s)", Scale::Linear),
        ("largest relative energy", Scale::Log),
    );
    let mut failures = Vec::new();
    for (name, rows) in named.zip(rests) {
        let rows = rows?;
        failures.extend(failure(name, &rows));
        fall.series.push(Curve::new(name, rows.iter().map(|(h, rest)| (1.0 / h, *rest)).collect()));
        for (k, &(h, size)) in rows.iter().enumerate() {
            let slope = k.checked_sub(1).and_then(|before| slope(rows[before], (h, size)));
            rest.push(row![name, h, 1.0 / h, size, slope]);
        }
    }
    Ok(Report { tables: vec![energy, rest], figures: vec![swing, fall], failures, ..Report::default() })
}

/// Slope of the logarithm of the rest against 1/h over −π²/λ, between two steps; `None` where rounding shows.
fn slope((h0, size0): (f64, f64), (h, size): (f64, f64)) -> Option<f64> {
    let pi = core::f64::consts::PI;
    let slope = libm::log(size / size0) / (1.0 / h - 1.0 / h0);
    (size > ROUNDING).then_some(-slope * lambda() / (pi * pi))
}

/// What contradicts the prediction: `rattle` follows the exact motion of another body and has no rest; that of the others falls
/// at the predicted rate, up to the power of h.
fn failure(name: &str, rows: &[(f64, f64)]) -> Option<String> {
    let [.., before, last] = rows else { return None };
    if name == "rattle" {
        return (last.1 > ROUNDING).then(|| format!("{name} leaves a rest of {:e}", last.1));
    }
    let wrong = slope(*before, *last).filter(|slope| !(0.75..1.1).contains(slope));
    wrong.map(|slope| format!("{name}: the rest falls at {slope:.3} of the predicted rate"))
}

/// Largest changes at one step.
struct Swing {
    h: f64,
    energy: f64,
    modified: f64,
}

/// For steps from 1/4 s on, halved `halvings` times.
fn swings(name: &str, span: f64, halvings: u32) -> Result<Vec<Swing>, Error> {
    let body = Body::free(Inertia::from_moments(MOMENTS).map_err(unexpected)?);
    let start = body.enter_omega(Quat::identity(), Vec3(OMEGA)).map_err(unexpected)?.to_f64();
    let (moments, inverse) = (body.rotor().moments::<f64>(), body.rotor().inverse_moments::<f64>());
    let term = |m: Vec3<f64>| match name.split_once(':') {
        Some(("lie-poisson", axes)) => axes.parse().ok().map(|o: AxisOrder| o.modified_energy(m, moments)),
        Some((_, axes)) => axes.parse().ok().map(|a: TwoAxes| a.modified_energy(m, moments)),
        None => None,
    };
    let splitting = method(name).map_err(unexpected)?;
    let mut found = Vec::new();
    for halving in 0..=halvings {
        let h = libm::scalbn(0.25, -(halving as i32));
        let mut step = splitting.prepare_f64(Clock::new(h), &body).map_err(unexpected)?;
        let energies = |x: &Point<f64>| {
            let m = x.momentum_body;
            let energy = 0.5 * m.dot(m.times(inverse));
            (energy, energy + h * h * term(m).unwrap_or_default())
        };
        let first = energies(&start);
        let (mut x, mut largest) = (start, (0.0_f64, 0.0_f64));
        step.open(&mut x);
        let mut block = [x; 64];
        for _ in 0..(span / h / block.len() as f64) as u64 {
            step.fill(&mut x, &mut block);
            for x in &block {
                let now = energies(x);
                largest.0 = largest.0.max((now.0 - first.0).abs());
                largest.1 = largest.1.max((now.1 - first.1).abs());
            }
        }
        found.push(Swing { h, energy: largest.0 / first.0, modified: largest.1 / first.0 });
    }
    Ok(found)
}

/// Below, the rounding of double-double shows.
const ROUNDING: f64 = 1e-27;

/// λ of the separatrix of the body of the rest.
fn lambda() -> f64 {
    let [i1, i2, i3] = REST_MOMENTS;
    libm::sqrt((i2 - i1) * (i3 - i2) / (i1 * i3))
}

/// The rest for `count` steps of equally spaced reciprocals, over `phases` points of the unstable curve.
fn rests(name: &str, count: u32, phases: u32) -> Result<Vec<(f64, f64)>, Error> {
    let body = Body::free(Inertia::from_moments(REST_MOMENTS).map_err(unexpected)?);
    let splitting = method(name).map_err(unexpected)?;
    let mut found = Vec::new();
    for k in 0..count {
        let h = 1.0 / (1.0 + 0.25 * f64::from(k));
        let mut passage = Passage {
            step: splitting.prepare_dd(Clock::new(h), &body).map_err(unexpected)?,
            inverse: body.rotor().inverse_moments(),
            moment: body.rotor().moments::<Dd>()[1],
        };
        found.push((h, passage.largest_energy(phases)));
    }
    Ok(found)
}

/// From one turn about the middle axis to the opposite one.
struct Passage {
    step: Box<dyn Step<Dd>>,
    inverse: Vec3<Dd>,
    /// The middle moment; |ω| = 1 rad/s.
    moment: Dd,
}

/// The linear map of the momentum along the outer axes next to a turn about ±e₂.
struct Saddle {
    /// Factor by which a step takes points away.
    growth: Dd,
    unstable: [Dd; 2],
    stable: [Dd; 2],
}

/// Distance from the turn at which points start and are read, relative to |m|: its fourth power is below rounding.
const NEAR: f64 = 1e-8;

impl Passage {
    /// The momentum one step after `m`.
    fn next(&mut self, m: Vec3<Dd>) -> Vec3<Dd> {
        let mut x = Point::new(Quat::identity(), m);
        self.step.steps(&mut x, 1);
        x.momentum_body
    }

    /// The map at the turn about e₂ times `side`.
    fn saddle(&mut self, side: f64) -> Saddle {
        let tiny = Dd::of(1e-20);
        let size = self.moment * side;
        let mut column = |first: Dd, third: Dd| {
            let m = self.next(Vec3([first, size, third]));
            [m[0] / tiny, m[2] / tiny]
        };
        let (a, b) = (column(tiny, Dd::ZERO), column(Dd::ZERO, tiny));
        // eigenvalues with the product 1 of [[a0, b0], [a1, b1]]
        let half_trace = (a[0] + b[1]) * 0.5;
        let growth = half_trace + (half_trace * half_trace - Dd::ONE).sqrt();
        let vector = |eigenvalue: Dd| [b[0], eigenvalue - a[0]];
        Saddle { growth, unstable: vector(growth), stable: vector(Dd::ONE / growth) }
    }

    fn largest_energy(&mut self, phases: u32) -> f64 {
        let (here, there) = (self.saddle(1.0), self.saddle(-1.0));
        let length = |v: [Dd; 2]| (v[0] * v[0] + v[1] * v[1]).sqrt();
        let mut largest = 0.0_f64;
        for phase in 0..phases {
            let share = f64::from(phase) / f64::from(phases);
            let distance = libm::exp(share * libm::log(here.growth.hi())) * NEAR;
            let scale = self.moment * distance / length(here.unstable);
            let [first, third] = here.unstable.map(|v| v * scale);
            let middle = (self.moment * self.moment - first * first - third * third).sqrt();
            let arrived = self.arrival(Vec3([first, middle, third]));
            largest = largest.max(self.energy_above(&there, arrived).hi().abs());
        }
        largest
    }

    /// Steps on from `m` to where the momentum is nearest to −e₂.
    fn arrival(&mut self, mut m: Vec3<Dd>) -> Vec3<Dd> {
        let off = |m: &Vec3<Dd>| (m[0] * m[0] + m[2] * m[2]).hi();
        loop {
            let next = self.next(m);
            let beyond = m[1].hi() < 0.0 && next[1].hi() < 0.0;
            if beyond && off(&next) > off(&m) || !next[0].hi().is_finite() {
                return m;
            }
            m = next;
            if beyond && off(&m) < NEAR * NEAR * (self.moment * self.moment).hi() {
                return m;
            }
        }
    }

    /// ½ m·I⁻¹m less that of the turn, over that of the turn, of the hyperbola through `m`.
    fn energy_above(&self, saddle: &Saddle, m: Vec3<Dd>) -> Dd {
        let ([u0, u1], [s0, s1]) = (saddle.unstable, saddle.stable);
        let determinant = u0 * s1 - u1 * s0;
        let along_unstable = (m[0] * s1 - m[2] * s0) / determinant;
        let along_stable = (u0 * m[2] - u1 * m[0]) / determinant;
        let [q0, q1] = [0, 2].map(|k| self.inverse[k] - self.inverse[1]);
        let product = u0 * q0 * s0 + u1 * q1 * s1;
        let energy = self.moment * self.moment * self.inverse[1] * 0.5;
        along_unstable * along_stable * product / energy
    }
}
