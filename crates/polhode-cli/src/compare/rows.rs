//! The rows of a comparison.

use polhode::body::{Body, Conserved};
use polhode::method::Claimed;
use polhode::run::Sample;
use polhode::truth::{Ending, Judged, Truth};
use polhode_files::error::{Error, warn};
use polhode_pages::table::{Cell, Column, row};

use super::Compare;
use super::entries::Entry;
use super::trajectory::{ROUNDING, Trajectory};
use crate::plot::looks::middle_axis;

/// Whether ω along the middle axis is more than rounding at any look at the true motion, or at the end of a run.
fn turns_over(truth: &Truth, last: &Sample) -> bool {
    let Some(axis) = middle_axis(truth.body()) else { return true };
    let looks = truth.times().filter_map(|time| truth.point_at(time.into()).ok());
    let rates = looks.map(|point| truth.body().omega_of(&point));
    rates.chain([last.omega_body]).any(|omega| omega.dot(&axis).abs() > ROUNDING * omega.norm())
}

impl Compare {
    pub(super) fn row(
        &self,
        truth: &Truth,
        entry: &Entry,
        judged: &Judged,
        (seconds, rk4_steps): (f64, f64),
    ) -> Vec<Cell> {
        let Judged { last, ending, evaluations, .. } = judged;
        let known = truth.known_until();
        let whole = last.elapsed.hi() <= known * (1.0 + 1e-12);
        // of rounding about a steady spin nobody counts the signs
        let real = |flips: u64| if turns_over(truth, last) { flips } else { 0 };
        let counted = last.flips.map(real);
        let flips = counted.filter(|_| whole && matches!(ending, Ending::Held | Ending::Lost(_)));
        let exact = flips.and_then(|_| truth.flips(known)).map(real);
        let right = match (flips, exact) {
            (Some(flips), Some(exact)) => Some(if flips == exact { "right" } else { "wrong" }),
            _ => None,
        };
        let worst = last.worst;
        let attitude = judged.attitude_error();
        row![
            if entry.step.is_some() { entry.family.clone() } else { entry.method.name() },
            entry.step,
            entry.tolerance,
            attitude,
            judged.largest_attitude_error(known),
            attitude.map(|_| self.start_time + known),
            worst.energy,
            truth.exchanged_energy_error(&worst),
            worst.momentum_norm,
            worst.momentum_vector,
            worst.momentum_z,
            worst.jacobi,
            (*evaluations > 0).then_some(*evaluations),
            seconds,
            rk4_steps,
            counted,
            exact,
            right,
            ending.by_clock(self.start_time).to_string(),
        ]
        .to_vec()
    }

    /// The row of a file, and why it is no comparison.
    pub(super) fn foreign(
        &self,
        truth: &Truth,
        trajectory: &Trajectory,
    ) -> Result<(Vec<Cell>, Option<&'static str>), Error> {
        let found = trajectory.against(truth, self.start_time)?;
        let columns = self.columns(truth.body());
        let mut row = vec![Cell::Empty; columns.len()];
        let mut set = |name: &str, value: Cell| {
            if let Some(place) = columns.iter().position(|column| column.name == name) {
                row[place] = value;
            }
        };
        set("method", trajectory.name.clone().into());
        set("status", found.ending.by_clock(self.start_time).to_string().into());
        if let Some(angle) = found.elsewhere {
            warn(&format!(
                "{}: its first attitude differs by {angle:.2} rad from the true motion: another start, another body or another \
                 convention; see `polhode audit`",
                trajectory.name
            ));
        }
        if let Some(share) = found.contradiction {
            set("status", "rates contradict".into());
            warn(&format!(
                "{}: its angular velocities differ from the true motion by {share:.2} of their size (root mean square), its \
                 attitudes by at most {:.1e} rad: rates and attitudes contradict each other; see `polhode audit`",
                trajectory.name, found.largest
            ));
        }
        if let Some((worst, flips)) = found.invariants {
            let exact = found.true_flips;
            set("energy_error", worst.energy.into());
            set("exchanged_energy_error", truth.exchanged_energy_error(&worst).into());
            set("momentum_error", worst.momentum_norm.into());
            set("momentum_vector_error", worst.momentum_vector.into());
            set("momentum_z_error", worst.momentum_z.into());
            set("flips", flips.into());
            set("flips_exact", exact.into());
            set("flips_right", exact.map(|exact| if flips == exact { "right" } else { "wrong" }).into());
        }
        if found.ending == Ending::Held {
            set("attitude_error", found.attitude_error.into());
            set("largest_attitude_error", found.largest.into());
            set("attitude_time", found.at.map(|at| self.start_time + at).into());
        }
        let failure = if found.contradiction.is_some() {
            Some("rates and attitudes contradict each other")
        } else if found.ending == Ending::Held && found.at == Some(0.0) {
            Some("no row after the start is compared")
        } else {
            None
        };
        Ok((row, failure))
    }

    pub(super) fn columns(&self, body: &Body) -> Vec<Column> {
        let mut columns = columns(body);
        if self.phase {
            columns.extend(super::phase::columns());
        }
        columns
    }
}

fn columns(body: &Body) -> Vec<Column> {
    let conserved = body.conserved();
    let free = conserved.contains(&Conserved::Momentum);
    let shown = |column: Column, shown: bool| if shown { column } else { column.hidden() };
    let energy = conserved.contains(&Conserved::Energy);
    let jacobi = !energy && !conserved.is_empty();
    vec![
        Column::new("method", "", "name in the catalogue, or the file of the trajectory"),
        Column::new("step", "s", "step").heading("h"),
        Column::new("tolerance", "", "tolerance of a method that chooses its steps").hidden(),
        Column::new("attitude_error", "rad", "angle to the true attitude at the end")
            .heading("attitude")
            .digits(2),
        Column::new(
            "largest_attitude_error",
            "rad",
            "the largest up to then, at 64 times or at the rows of the file",
        )
        .hidden(),
        Column::new("attitude_time", "s", "time of the attitude error").hidden(),
        shown(
            Column::new("energy_error", "", "largest relative error of the energy")
                .heading("energy")
                .digits(2),
            energy,
        ),
        Column::new("exchanged_energy_error", "", "max |E - E0| over (max U - min U), under gravity")
            .hidden(),
        Column::new("momentum_error", "", "largest relative error of |m|").hidden(),
        shown(
            Column::new("momentum_vector_error", "", "largest relative error of L in space")
                .heading("L")
                .digits(2),
            free,
        ),
        shown(
            Column::new("momentum_z_error", "", "largest relative error of L along space z, under torque")
                .heading("L_z")
                .digits(2),
            energy && !free,
        ),
        shown(
            Column::new("jacobi_error", "", "largest relative error of E - n L_z")
                .heading("Jacobi")
                .digits(2),
            jacobi,
        ),
        Column::new("evaluations", "", "right sides, turns, flows, solutions and kicks together")
            .heading("evals"),
        Column::new("seconds", "s", "processor time without the check of errors").hidden(),
        Column::new("rk4_steps", "", "the same in steps of rk4").heading("rk4 steps").digits(2),
        Column::new(
            "flips",
            "",
            "changes of sign of the momentum along the middle axis, more than rounding; of a file from row to row",
        )
        .hidden(),
        Column::new("flips_exact", "", "the same of the true motion, beside a file at its rows").hidden(),
        Column::new("flips_right", "", "whether they agree").heading("flips"),
        Column::new("status", "", "ok, what became of the run, or that rates of a file contradict its attitudes"),
    ]
}
