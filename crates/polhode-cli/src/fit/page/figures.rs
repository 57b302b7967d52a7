//! The drawings of a page.

use nalgebra::Vector3;
use polhode::record::median;
use polhode_fit::{Estimate, FittedMotion, Record};
use polhode_pages::document::Block;
use polhode_pages::figure::{Canvas, Curve, Figure, page_of};

use super::super::plot::{self, AXES, over_time, without_gaps};
use super::noise;

/// Segments that are drawn one by one.
const DRAWN: usize = 8;

/// Height of a plot of many on a page, pixels.
const SMALL: f64 = 260.0;

/// Measured and fitted rates of each segment, or of those that fit worst.
/// `differenced` says that the rates are those of attitudes, which nobody has measured.
pub(super) fn motions(motion: &[FittedMotion], record: &Record, differenced: bool) -> Vec<Block> {
    let mut chosen: Vec<&FittedMotion> = motion.iter().collect();
    worst_first(&mut chosen);
    let heading = if differenced {
        "Rates of the attitudes and of the fitted motion"
    } else {
        "Measured and fitted rates"
    };
    let mut parts = vec![Block::Heading(heading.into())];
    if differenced {
        let about = "Dots: slopes of parabolas through neighbouring attitudes, for display only; the fit uses the attitudes.";
        parts.push(Block::Paragraph(about.into()));
    }
    if motion.len() > DRAWN {
        parts.push(Block::Paragraph(format!("The {DRAWN} segments of {} that fit worst.", motion.len())));
    }
    for (figure, caption) in chosen.into_iter().filter_map(|m| followed(m, record)) {
        parts.push(Block::Figure(figure.svg(), caption));
    }
    parts
}

/// Measured and fitted rates of a segment, with a caption.
fn followed(m: &FittedMotion, record: &Record) -> Option<(Figure, String)> {
    let s = record.segments.get(m.segment)?;
    let title = format!("Segment {}: measured (dots) and fitted (lines)", m.segment + 1);
    let mut figure = over_time(title, "angular velocity (rad/s)", true, SMALL);
    let lines = m.fitted.as_deref();
    let dots = rates(s.times(), &m.measured, lines.is_none());
    figure.series.extend(dots.into_iter().map(Curve::dots));
    if let Some(fitted) = lines {
        figure.series.extend(rates(s.times(), fitted, true).into_iter().map(Curve::plain));
    }
    let caption = match m.rms() {
        Some(rms) => format!("Segment {}: rms of the difference {rms:.2e} rad/s.", m.segment + 1),
        None => format!("Segment {}: no motion of the fitted body follows it.", m.segment + 1),
    };
    Some((figure, caption))
}

/// Measured and fitted rates of the segments, and |L| and 2T along them, on one page.
pub(in super::super) fn overview(e: &Estimate, motion: &[FittedMotion], record: &Record) -> Canvas {
    let mut chosen: Vec<&FittedMotion> = motion.iter().collect();
    worst_first(&mut chosen);
    let mut figures: Vec<Figure> =
        chosen.into_iter().filter_map(|m| followed(m, record)).map(|(figure, _)| figure).collect();
    figures.push(kept(e, motion, record));
    page_of("", 1, &figures)
}

/// The segments that fit worst, where there are too many to draw.
fn worst_first(chosen: &mut Vec<&FittedMotion>) {
    if chosen.len() > DRAWN {
        chosen.sort_by(|a, b| b.rms().unwrap_or(f64::MAX).total_cmp(&a.rms().unwrap_or(f64::MAX)));
        chosen.truncate(DRAWN);
    }
}

/// The three components of rates, each with its colour, named or not.
fn rates(times: &[f64], rates: &[Vector3<f64>], named: bool) -> Vec<Curve> {
    (0..3)
        .map(|axis| {
            let points = times.iter().zip(rates).map(|(t, w)| (*t, w[axis])).collect();
            Curve::new(if named { AXES[axis] } else { "" }, points).coloured(axis)
        })
        .collect()
}

/// Residuals: whitened against time, their spectrum and their Allan deviation.
pub(super) fn residuals(e: &Estimate, motion: &[FittedMotion], record: &Record) -> Vec<Block> {
    let mut parts = vec![Block::Heading("Residuals".into())];
    let caption = format!(
        "Residuals of {} in standard deviations; the band is two of them wide on each side.",
        plot::what(e)
    );
    parts.push(Block::Figure(plot::residuals(e).svg(), caption));
    if e.attitudes.is_some() {
        return parts;
    }
    let left: Vec<_> = motion.iter().filter_map(FittedMotion::residuals).collect();
    let times = motion.iter().filter_map(|m| record.segments.get(m.segment)).map(|s| s.times());
    let Some(interval) = interval(times).filter(|_| !left.is_empty()) else { return parts };
    let spectrum = noise::spectrum(&left, interval);
    if let (Some(first), Some(last)) = (spectrum.first(), spectrum.last()) {
        let level = 2.0 * e.noise_sigma * e.noise_sigma * interval;
        let mut figure =
            Figure::log_log("spectrum", "Spectrum of measured less fitted", "frequency (Hz)", "(rad/s)²/Hz");
        let white = vec![(first.0, level), (last.0, level)];
        figure.series = vec![Curve::new("residuals", spectrum.clone()), Curve::new("white noise", white)];
        let caption = format!(
            "Power spectral density of measured less fitted rates, mean of the axes; the line is the level of \
             white noise of {:.2e} rad/s.",
            e.noise_sigma
        );
        parts.push(Block::Figure(figure.svg(), caption));
    }
    let allan = noise::allan(&left, interval);
    if let (Some(first), Some(last)) = (allan.first(), allan.last()) {
        let white = [first.0, last.0].map(|t| (t, e.noise_sigma * (interval / t).sqrt())).to_vec();
        let mut figure = Figure::log_log(
            "allan",
            "Allan deviation of measured less fitted",
            "averaging time (s)",
            "Allan deviation (rad/s)",
        );
        figure.series = vec![Curve::new("residuals", allan), Curve::new("white noise", white)];
        let caption = format!(
            "Allan deviation of the same, mean of the axes, with white noise of {:.2e} rad/s.",
            e.noise_sigma
        );
        parts.push(Block::Figure(figure.svg(), caption));
    }
    parts
}

/// The median time between samples.
fn interval<'a>(segments: impl Iterator<Item = &'a [f64]>) -> Option<f64> {
    let mut steps: Vec<f64> =
        segments.flat_map(|times| times.windows(2)).map(|pair| pair[1] - pair[0]).collect();
    median(&mut steps)
}

/// |J ω| and ω·J ω of the samples over their means.
pub(super) fn invariants(e: &Estimate, motion: &[FittedMotion], record: &Record) -> Block {
    let caption =
        "Angular momentum |Jω| and twice the energy, 2T = ω·Jω, which are constant for a free body.";
    Block::Figure(kept(e, motion, record).svg(), caption.into())
}

fn kept(e: &Estimate, motion: &[FittedMotion], record: &Record) -> Figure {
    let j = e.shape.tensor();
    let source = |m: &FittedMotion| record.segments.get(m.segment).map_or(&[][..], |s| s.times());
    let single = motion.len() == 1;
    let times: Vec<Vec<f64>> = if single {
        motion.iter().map(|m| source(m).to_vec()).collect()
    } else {
        without_gaps(motion.iter().map(source))
    };
    let curve = |name: &str, of: &dyn Fn(&Vector3<f64>) -> f64| {
        let mut points = Vec::new();
        for (m, times) in motion.iter().zip(&times) {
            let used = || m.measured.iter().zip(times).zip(&m.used).filter(|(_, used)| **used);
            let count = used().count().max(1) as f64;
            let mean = used().map(|((w, _), _)| of(w)).sum::<f64>() / count;
            points.extend(used().map(|((w, t), _)| (*t, of(w) / mean)));
        }
        Curve::new(name, points).dots()
    };
    let title = "Angular momentum and energy along the record";
    let mut figure = over_time(title, "value / mean of the segment", single, 320.0);
    figure.series = vec![curve("|Jω|", &|w| (j * w).norm()), curve("2T", &|w| w.dot(&(j * w)))];
    figure
}

/// The readings of a record that was refused.
pub(super) fn readings(record: &Record) -> Vec<Block> {
    let shown = record.segments.iter().enumerate().take(DRAWN);
    let mut parts = Vec::new();
    for (k, s) in shown {
        let mut figure = over_time(format!("Segment {}", k + 1), "angular velocity (rad/s)", true, SMALL);
        figure.series = rates(s.times(), s.rates(), true).into_iter().map(Curve::dots).collect();
        parts.push(Block::Figure(figure.svg(), format!("Segment {} of {}.", k + 1, s.source())));
    }
    if record.segments.len() > DRAWN {
        parts.push(Block::Paragraph(format!("The first {DRAWN} segments of {}.", record.segments.len())));
    }
    let lengths = record.segments.iter().flat_map(|s| s.times().iter().zip(s.rates()));
    let single = record.segments.len() == 1;
    let times = without_gaps(record.segments.iter().map(|s| s.times()));
    let points = if single {
        lengths.map(|(t, w)| (*t, w.norm())).collect()
    } else {
        times.into_iter().flatten().zip(lengths).map(|(t, (_, w))| (t, w.norm())).collect()
    };
    let mut figure = over_time("Size of the rate along the record", "|ω| (rad/s)", single, SMALL);
    figure.series = vec![Curve::new("|ω|", points).dots()];
    parts.push(Block::Figure(
        figure.svg(),
        "Size of the rate: jumps are blows or catches, a slow decrease is drag.".into(),
    ));
    parts
}
