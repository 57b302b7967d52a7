//! Readings of a motion against time.

use polhode::flow::LagrangeTop;
use polhode::observe::Errors;
use polhode::rotation::EulerSequence;
use polhode_files::error::Error;
use polhode_pages::figure::{Canvas, Curve, Figure, Scale, page_of};

use super::looks::Looks;
use super::{Plot, short};

impl Looks {
    /// A curve against time: a line where the looks are close enough, else dots.
    fn curve(&self, name: &str, values: impl Iterator<Item = Option<f64>>) -> Curve {
        let points = self.times.iter().zip(values).filter_map(|(t, value)| Some((*t, value?))).collect();
        let series = Curve::new(name, points);
        if self.is_resolved() { series.plain() } else { series.dots() }
    }
}

fn panel(y: &str, scale: Scale, [width, height]: [f64; 2]) -> Figure {
    Figure::new("plot", "", ("time (s)", Scale::Linear), (y, scale)).sized(width, height)
}

/// Components of ω against time, with the flips.
pub(super) fn omega(plot: &Plot, looks: &Looks) -> Canvas {
    let mut figure = panel("angular velocity in body axes (rad/s)", Scale::Linear, plot.size());
    let mut title = plot.title("Angular velocity", looks);
    title += &looks.remark();
    for (axis, name) in ["ωx", "ωy", "ωz"].into_iter().enumerate() {
        figure.series.push(looks.curve(name, looks.omegas.iter().map(|omega| Some(omega[axis]))));
    }
    match &looks.flips {
        Some(flips) if !flips.can_be_told_apart() => {
            title += &format!("; {} flips, too close to mark", flips.count);
        }
        Some(flips) if flips.count > 0 => {
            let label = match flips.count {
                1 => "a flip: L changes its side along the middle axis".to_owned(),
                count => format!("{count} flips: L changes its side along the middle axis"),
            };
            figure.events(label, "flip", flips.times.clone());
        }
        _ => {}
    }
    figure.title = title;
    figure.page()
}

/// Euler angles against time; of a symmetric top also the potential of its tilt.
pub(super) fn angles(plot: &Plot, looks: &Looks) -> Canvas {
    let sequence = plot.motion.start.euler.unwrap_or_default();
    let [width, height] = plot.size();
    let size = [width, (0.5 * height).max(190.0)];
    let found: Vec<_> = looks.states.iter().map(|state| sequence.angles(state.rotation())).collect();
    // where both outer axes lie on one line, only the turn about that line has a meaning, and stands as the first angle
    let locked = found.iter().all(|found| found.locked);
    let names: &[&str] =
        if locked { &["φ ± ψ (rad)", "θ (rad)"] } else { &["φ (rad)", "θ (rad)", "ψ (rad)"] };
    let mut panels = Vec::new();
    for (k, name) in names.iter().enumerate() {
        let mut figure = panel(name, Scale::Linear, size);
        let values = found.iter().map(|found| (locked || k == 1 || !found.locked).then_some(found.angles[k]));
        let values: Vec<Option<f64>> = if k == 1 { values.collect() } else { unwrapped(values) };
        let curve = looks.curve("", values.into_iter());
        if let (1, Some(top)) = (k, looks.top().filter(|_| is_tilt(looks, sequence))) {
            let [least, most] = top.turning_points();
            if most > least {
                figure.level(format!("θ₂ = {}", short(most)), most);
            }
            figure.level(format!("θ₁ = {}", short(least)), least);
        }
        figure.series.push(curve);
        panels.push(figure);
    }
    if let Some(top) = looks.top() {
        panels.extend(potential(looks, top, [width, height.min(320.0)]));
    }
    let name = format!("Euler angles {sequence}");
    let mut title = plot.title(&name, looks) + &looks.remark();
    if locked {
        title += "; both outer axes lie on one line at all times, so only φ ± ψ is defined";
    }
    page_of(&title, 1, &panels)
}

/// Whether the second angle is the tilt of the weight: z-x-z, the weight on the body's z axis, upwards.
fn is_tilt(looks: &Looks, sequence: EulerSequence) -> bool {
    let axes = sequence.axes();
    axes[0] == 2 && axes[2] == 2 && looks.weight().is_some_and(|weight| weight.z > 1.0 - 1e-12)
}

/// V(θ) − E around the turning points.
fn potential(looks: &Looks, top: &LagrangeTop, [width, height]: [f64; 2]) -> Option<Figure> {
    const POINTS: u32 = 400;
    let energy = looks.body.energy(looks.states.first()?);
    let [least, most] = top.turning_points();
    let margin = (0.4 * (most - least)).max(0.08);
    let (from, to) = ((least - margin).max(0.0), (most + margin).min(core::f64::consts::PI));
    let above = |tilt: f64| top.effective_potential(tilt) - energy;
    let tilts = (0..=POINTS).map(|k| from + (to - from) * f64::from(k) / f64::from(POINTS));
    let points: Vec<(f64, f64)> =
        tilts.map(|tilt| (tilt, above(tilt))).filter(|point| point.1.is_finite()).collect();
    let depth = points.iter().map(|point| point.1).fold(0.0, f64::min).abs();
    // the walls at the poles are out of sight
    let within = |point: &&(f64, f64)| depth == 0.0 || point.1 <= 2.5 * depth || most - least < 1e-6;
    let points: Vec<(f64, f64)> = points.iter().filter(within).copied().collect();
    let mut figure = Figure::new(
        "potential",
        "",
        ("tilt θ of the weight from the vertical (rad)", Scale::Linear),
        ("V(θ) − E (J)", Scale::Linear),
    )
    .sized(width, height);
    figure.series.push(Curve::new("", points).plain());
    figure.level("E", 0.0);
    let turning = if most > least { vec![least, most] } else { vec![least] };
    let label = match turning.len() {
        1 => format!("θ stays at {}", short(least)),
        _ => format!("turning points θ₁ = {}, θ₂ = {}", short(least), short(most)),
    };
    figure.events(label, "turning-point", turning);
    Some(figure)
}

/// Angles without their jumps by a turn.
fn unwrapped(angles: impl Iterator<Item = Option<f64>>) -> Vec<Option<f64>> {
    let mut before: Option<f64> = None;
    let next = |angle: f64, before: f64| {
        angle - core::f64::consts::TAU * libm::round((angle - before) / core::f64::consts::TAU)
    };
    let mut follow = |angle: Option<f64>| {
        let angle = angle.map(|angle| before.map_or(angle, |before| next(angle, before)));
        before = angle.or(before);
        angle
    };
    angles.map(&mut follow).collect()
}

/// One of the errors, where it has a meaning.
type Reading = fn(&Errors) -> Option<f64>;

/// Errors of what the motion conserves against time.
pub(super) fn conserved(plot: &Plot, looks: &Looks) -> Result<Canvas, Error> {
    let mut figure = panel("relative error", Scale::Log, plot.size());
    figure.title = plot.title("Errors of conserved quantities", looks) + &looks.remark();
    let quantities: [(&str, Reading); 5] = [
        ("energy", |errors| errors.energy),
        ("|m|", |errors| errors.momentum_norm),
        ("L in space", |errors| errors.momentum_vector),
        ("L_z", |errors| errors.momentum_z),
        ("Jacobi", |errors| errors.jacobi),
    ];
    // the start itself has no error, and would stretch the axis
    let shown = |k: usize| k > 0 || looks.errors.len() == 1;
    for (name, error) in quantities {
        let errors = looks.errors.iter().enumerate().map(|(k, errors)| error(errors).filter(|_| shown(k)));
        let series = looks.curve(name, errors);
        if !series.points.is_empty() {
            figure.series.push(series);
        }
    }
    if figure.series.is_empty() {
        return Err(Error::Input(
            "conserved: this motion conserves neither energy nor angular momentum; plot omega or angles instead".into(),
        ));
    }
    Ok(figure.page())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_go_on_across_the_cut() {
        let seen = [Some(3.0), None, Some(-3.0), Some(-2.9)];
        let found = unwrapped(seen.into_iter());
        let tau = core::f64::consts::TAU;
        assert_eq!(found, [Some(3.0), None, Some(tau - 3.0), Some(tau - 2.9)]);
    }
}
