//! A free motion in named quantities: periods, mode, pole and start.

use nalgebra::Vector3;
use polhode::body::{Body, Point};
use polhode::flow::{AtRest, Character, FreeMotion, GyrostatMotion, Mode, Stability, SteadySpin};
use polhode::num::Dd;

use crate::table::{Cell, Column, Table, row};

/// Name, symbol of the field, unit, meaning and value of a quantity.
pub type Quantity = (&'static str, &'static str, &'static str, &'static str, Cell);

/// What is to be known of the free `motion` of `body` from `start`; empty where the motion does not have it.
///
/// # Errors
/// A body at rest.
pub fn quantities(body: &Body, start: &Point<Dd>, motion: &FreeMotion) -> Result<Vec<Quantity>, AtRest> {
    let character = &motion.character()?;
    let (tumbling, spin) = (motion.tumbling(), motion.pure_spin());
    let tilt = motion.tilt_range();
    let (axis_name, axis) = axis(body, motion, character);
    let precession_period = character.precession_rate.map(|rate| core::f64::consts::TAU / rate.abs());
    let combined = tumbling.map(|found| found.combined_period());
    let moments = body.inertia().principal_moments();
    let largest = moments.iter().fold(0.0_f64, |most, moment| most.max(*moment));
    let friction = moments.iter().map(|moment| 1.0 / moment - 1.0 / largest).sum::<f64>();
    let is_spherical = friction == 0.0;
    let state = body.leave(start);
    let momentum = state.momentum_body.norm();
    let omega = body.omega_of(start);
    let q = state.attitude.components();
    let pole = tumbling.map(|found| found.pole);
    let whole = |angle: f64| angle.rem_euclid(core::f64::consts::TAU);
    let angles = tumbling.map(|found| found.angles.map(whole));
    Ok(vec![
        ("mode", "", "", "long-axis, short-axis, separatrix or steady", character.mode.name().into()),
        ("modulus", "k", "", "of the elliptic functions", character.parameter.map(|k| k.sqrt() + 0.0).into()),
        ("complement", "1-k^2", "", "", character.complement.into()),
        (
            "polhode_period",
            "P_psi",
            "s",
            "L once round the axis in the body",
            character.polhode_period.into(),
        ),
        ("nutation_period", "", "s", "the axis nods towards L and back", character.nutation_period.into()),
        ("precession_period", "P_phi", "s", "mean, the axis once round L", precession_period.into()),
        ("precession_rate", "", "rad/s", "mean, positive about L", character.precession_rate.into()),
        ("spin", "2E/|L|", "rad/s", "constant part of omega along L", character.spin.into()),
        (
            "separatrix_distance",
            "",
            "",
            "(|L|^2/2E - I_middle)/I_middle, 0 on the separatrix",
            character.separatrix_distance.into(),
        ),
        (
            "combined_period",
            "P_1",
            "s",
            "1/P_1 = 1/P_phi + 1/P_psi (long-axis) or - (short)",
            combined.into(),
        ),
        (
            "energy_ratio",
            "E/E_0",
            "",
            "to the least energy with this L",
            (largest * character.spin / momentum).into(),
        ),
        (
            "damping",
            "",
            "s",
            "e-fold of the energy above that of the steady spin, times the loss of inner friction",
            (!is_spherical).then_some(1.0 / (momentum * friction)).into(),
        ),
        ("axis", "", "", "of the mode or of the spin", axis_name.into()),
        ("axis_x", "", "", "unit vector, body axes", axis.map(|axis| axis.x + 0.0).into()),
        ("axis_y", "", "", "", axis.map(|axis| axis.y + 0.0).into()),
        ("axis_z", "", "", "", axis.map(|axis| axis.z + 0.0).into()),
        ("stability", "", "", "of a steady spin", spin.map(|spin| spin.stability.name()).into()),
        (
            "growth_rate",
            "",
            "rad/s",
            "of deviations from it, e-fold",
            spin.map(|spin| spin.growth_rate).into(),
        ),
        ("theta_min", "theta", "rad", "least angle of the axis to L", tilt.map(|tilt| tilt[0]).into()),
        ("theta_max", "theta", "rad", "largest", tilt.map(|tilt| tilt[1]).into()),
        (
            "lambda",
            "lambda",
            "rad",
            "longitude of L in space, 0 to 2 pi",
            pole.map(|pole| whole(pole[0])).into(),
        ),
        ("beta", "beta", "rad", "latitude of L in space", pole.map(|pole| pole[1]).into()),
        (
            "phi",
            "phi_0",
            "rad",
            "of the axis about L at the start, 0 to 2 pi",
            angles.map(|angles| angles[0]).into(),
        ),
        (
            "psi",
            "psi_0",
            "rad",
            "of the body about the axis at the start, 0 to 2 pi",
            angles.map(|angles| angles[1]).into(),
        ),
        ("q_w", "", "", "attitude at the start, body to space", q[0].into()),
        ("q_x", "", "", "", q[1].into()),
        ("q_y", "", "", "", q[2].into()),
        ("q_z", "", "", "", q[3].into()),
        ("omega_body_x", "", "rad/s", "angular velocity at the start", omega.x.into()),
        ("omega_body_y", "", "rad/s", "", omega.y.into()),
        ("omega_body_z", "", "rad/s", "", omega.z.into()),
    ])
}

/// What is to be known of the `motion` of a body with wheels from `start`; empty where the motion does not have it.
#[must_use]
pub fn with_wheels(motion: &GyrostatMotion, start: &Point<Dd>) -> Vec<Quantity> {
    let (body, character) = (motion.body(), motion.character());
    let state = body.leave(start);
    let momentum = body.momentum_space(0.0, &state);
    let (omega, of_wheels) = (body.omega_of(start), body.momentum_of_wheels_at(0.0));
    let separatrices = character.separatrix_energies;
    let energy_of = |k: usize| Cell::from(separatrices.get(k).copied());
    let spins = motion.steady_spins();
    let stable = spins.iter().filter(|spin| spin.growth_rate == 0.0).count();
    let mode = if character.period.is_some() { "tumbling" } else { "steady" };
    let q = state.attitude.components();
    vec![
        ("mode", "", "", "tumbling or steady", mode.into()),
        ("period", "", "s", "of the angular velocity in the body", character.period.into()),
        (
            "turn_per_period",
            "",
            "rad",
            "about L in a period, less whole turns",
            character.turn_per_period.into(),
        ),
        ("energy", "T", "J", "1/2 w.I w, which wheels leave constant", character.energy.into()),
        ("separatrix_energy_1", "", "J", "of an unstable steady spin with the same |L|", energy_of(0)),
        ("separatrix_energy_2", "", "J", "of the other one", energy_of(1)),
        ("steady_spins", "", "", "with the same |L|; --steady lists them", (spins.len() as u64).into()),
        ("stable_spins", "", "", "of them", (stable as u64).into()),
        ("momentum", "|L|", "kg m^2/s", "of body and wheels", momentum.norm().into()),
        ("momentum_x", "L_x", "kg m^2/s", "in space", momentum.x.into()),
        ("momentum_y", "L_y", "kg m^2/s", "", momentum.y.into()),
        ("momentum_z", "L_z", "kg m^2/s", "", momentum.z.into()),
        ("wheels_x", "h_x", "kg m^2/s", "momentum of the wheels, body axes", of_wheels.x.into()),
        ("wheels_y", "h_y", "kg m^2/s", "", of_wheels.y.into()),
        ("wheels_z", "h_z", "kg m^2/s", "", of_wheels.z.into()),
        ("q_w", "", "", "attitude at the start, body to space", q[0].into()),
        ("q_x", "", "", "", q[1].into()),
        ("q_y", "", "", "", q[2].into()),
        ("q_z", "", "", "", q[3].into()),
        ("omega_body_x", "", "rad/s", "angular velocity at the start", omega.x.into()),
        ("omega_body_y", "", "rad/s", "", omega.y.into()),
        ("omega_body_z", "", "rad/s", "", omega.z.into()),
    ]
}

/// The steady spins of a body with wheels that have the |L| of a motion, by rising energy.
#[must_use]
pub fn steady_spins(spins: &[SteadySpin]) -> Table {
    let columns = vec![
        Column::new("omega_body_x", "rad/s", "angular velocity, body axes").digits(6),
        Column::new("omega_body_y", "rad/s", "").digits(6),
        Column::new("omega_body_z", "rad/s", "").digits(6),
        Column::new("rate", "rad/s", "about L, negative against it").digits(6),
        Column::new("energy", "J", "1/2 w.I w").digits(6),
        Column::new("stability", "", "stable, unstable or neutral"),
        Column::new("frequency", "rad/s", "of small oscillations of a stable one").digits(6),
        Column::new("growth_rate", "1/s", "of deviations of an unstable one").digits(6),
    ];
    let mut table = Table::new("steady", "Steady spins with the |L| of the start.", columns);
    let some = |rate: f64| Some(rate).filter(|rate| *rate > 0.0);
    for spin in spins {
        let [x, y, z]: [f64; 3] = spin.omega_body.into();
        let stability = match spin.stability {
            _ if spin.growth_rate > 0.0 => "unstable",
            Stability::Neutral => "neutral",
            _ => "stable",
        };
        table.push(row![
            x,
            y,
            z,
            spin.rate,
            spin.energy,
            stability,
            some(spin.frequency),
            some(spin.growth_rate)
        ]);
    }
    table
}

/// The axis of the mode or of a steady spin by its place among the moments, and its direction in body axes.
fn axis(
    body: &Body,
    motion: &FreeMotion,
    character: &Character,
) -> (Option<&'static str>, Option<Vector3<f64>>) {
    const NAMES: [&str; 3] = ["long", "middle", "short"];
    let principal = |rank: usize| Some(body.inertia().principal_axes() * Vector3::ith(rank, 1.0));
    if let Some(spin) = motion.pure_spin() {
        let [least, _, most] = body.inertia().principal_moments();
        let name = match spin.stability {
            Stability::Neutral if least == most => "any",
            Stability::Neutral => "equatorial",
            _ => NAMES[spin.rank],
        };
        return (Some(name), Some(spin.axis));
    }
    match character.mode {
        Mode::LongAxis => (Some(NAMES[0]), principal(0)),
        Mode::ShortAxis => (Some(NAMES[2]), principal(2)),
        _ => (Some(NAMES[1]), principal(1)),
    }
}
