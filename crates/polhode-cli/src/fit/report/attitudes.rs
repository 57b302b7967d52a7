//! What a fit says of attitudes, in words and as JSON.

use polhode::audit::Direction;
use polhode::rotation::Quat;
use polhode_fit::{AttitudeFit, Estimate};
use serde_json::{Value, json};

use super::super::attitudes::Read;
use super::with_error;

/// The direction in which the attitudes were taken.
fn direction(of: &AttitudeFit, read: &Read) -> Direction {
    let as_read = read.stated.unwrap_or(Direction::BodyToSpace);
    if of.is_inverse { as_read.other() } else { as_read }
}

/// How the attitudes were read, their noise, and how they compare with rates: a sentence each, without its full stop.
pub(in super::super) fn sentences(e: &Estimate, read: Option<&Read>) -> Vec<String> {
    let (Some(of), Some(read)) = (&e.attitudes, read) else { return Vec::new() };
    let words = direction(of, read).to_string().replace('-', " ");
    let told = match (read.stated, of.direction_gain) {
        (Some(_), _) => "as stated".into(),
        (None, Some(gain)) if gain.is_finite() => {
            format!("found from the motion: log-likelihood higher by {gain:.0} than that of the inverse")
        }
        _ => "found from the motion: no free motion follows the inverse".into(),
    };
    let degrees = of.noise_sigma.to_degrees();
    let source = if of.noise_is_given { "as stated" } else { "from the residuals" };
    let near = of
        .local_noise
        .map_or(String::new(), |noise| format!("; neighbouring attitudes alone show {noise:.3e} rad"));
    let mut lines = vec![
        format!("attitudes read as {}, {words} ({told})", read.form),
        format!(
            "noise of a component of the rotation vector {:.3e} rad ({degrees:.2} deg), {source}{near}",
            of.noise_sigma
        ),
    ];
    if of.noise_is_given {
        lines.push(format!("rms of the residuals of a component {:.3e} rad", of.residual));
    }
    lines.push(format!("largest turn from one attitude to the next {:.3} rad", of.largest_turn));
    if let Some(alignment) = of.alignment {
        let turn = Quat::from(alignment.turn).logarithm();
        let parts = [0, 1, 2].map(|k| with_error(turn[k].to_degrees(), alignment.sigma[k].to_degrees()));
        lines.push(format!(
            "the axes of the rates are turned from those of the attitudes by the rotation vector ({}) deg; the tensor is in the axes of the rates",
            parts.join(", ")
        ));
        lines.push(format!(
            "from the first sample to the last they turn against each other by {:.1e} rad (gain of log-likelihood {:.1})",
            alignment.moving, alignment.moving_gain
        ));
    }
    lines
}

pub(super) fn json(e: &Estimate, read: Option<&Read>) -> Value {
    let (Some(of), Some(read)) = (&e.attitudes, read) else { return Value::Null };
    json!({
        "reading": read.form,
        "direction": direction(of, read).to_string(),
        "direction_stated": read.stated.is_some(),
        "direction_gain": of.direction_gain.filter(|gain| gain.is_finite()),
        "noise_sigma": of.noise_sigma,
        "noise_given": of.noise_is_given,
        "residual": of.residual,
        "local_noise": of.local_noise,
        "largest_turn": of.largest_turn,
        "left_out": of.left_out,
        "repeated": of.repeated,
        "alignment": of.alignment.map(|a| {
            let q = a.turn.quaternion();
            json!({
                "turn": [q.w, q.i, q.j, q.k], "sigma": a.sigma, "moving": a.moving, "moving_gain": a.moving_gain,
            })
        }),
    })
}
