//! The records: what the body is, what acts on it, how it is measured.

use super::body::Acting;
use super::sensor::Error;

/// How the fit stands to a case.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Model {
    /// It has a model of it: the answer and its deviations must hold.
    AtHand,
    /// It has none: the answer may be off, but not silently.
    Missing,
    /// No record of rates shows it: the report of every fit names it.
    Invisible,
}

impl Model {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::AtHand => "at hand",
            Self::Missing => "missing",
            Self::Invisible => "invisible",
        }
    }
}

/// The times of the samples.
#[derive(Clone, Copy)]
pub(super) enum Sampling {
    Regular,
    /// True times scatter by this share of the interval, and the record does not know.
    HiddenJitter(f64),
    /// The same, and it knows.
    KnownJitter(f64),
    /// This share of the rows is lost.
    Lost(f64),
}

/// How the body starts, rad/s.
#[derive(Clone, Copy)]
pub(super) enum Start {
    /// Of this size, in a random direction.
    Random(f64),
    /// About a principal axis, 0 to 2, at 1 rad/s, off it by this angle, rad.
    Near(usize, f64),
}

/// One row.
#[derive(Clone, Copy)]
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) model: Model,
    pub(super) moments: [f64; 3],
    pub(super) start: Start,
    pub(super) seconds: f64,
    /// Samples a second.
    pub(super) rate: f64,
    /// How often it is tossed.
    pub(super) tosses: usize,
    /// Of a component, rad/s.
    pub(super) noise: f64,
    pub(super) acting: Acting,
    pub(super) sampling: Sampling,
    pub(super) error: Error,
}

/// A minute at 100 Hz of a body that tumbles at 1 rad/s.
const USUAL: Case = Case {
    name: "ideal",
    model: Model::AtHand,
    moments: [1.0, 2.0, 2.6],
    start: Start::Random(1.0),
    seconds: 60.0,
    rate: 100.0,
    tosses: 1,
    noise: 0.01,
    acting: Acting::Nothing,
    sampling: Sampling::Regular,
    error: Error::None,
};
/// A second in the air.
const TOSS: Case = Case { start: Start::Random(12.0), seconds: 1.0, noise: 0.02, ..USUAL };

const fn sampled(name: &'static str, rate: f64, seconds: f64) -> Case {
    Case { name, rate, seconds, ..USUAL }
}

const fn shaped(name: &'static str, moments: [f64; 3]) -> Case {
    Case { name, moments, ..USUAL }
}

const fn started(name: &'static str, axis: usize, angle: f64) -> Case {
    Case { name, start: Start::Near(axis, angle), ..USUAL }
}

const fn acted(name: &'static str, model: Model, acting: Acting) -> Case {
    Case { name, model, acting, ..USUAL }
}

const fn read(name: &'static str, model: Model, error: Error) -> Case {
    Case { name, model, error, ..USUAL }
}

use Model::{AtHand, Invisible, Missing};

/// The rows.
pub(super) const CASES: [Case; 56] = [
    USUAL,
    sampled("20 Hz", 20.0, 60.0),
    sampled("1 kHz, 10 s", 1000.0, 10.0),
    sampled("2 Hz, 5 min", 2.0, 300.0),
    sampled("0.5 Hz, 20 min", 0.5, 1200.0),
    Case { name: "hidden jitter 20 %", sampling: Sampling::HiddenJitter(0.2), model: Missing, ..USUAL },
    Case { name: "known jitter 40 %", sampling: Sampling::KnownJitter(0.4), ..USUAL },
    Case { name: "lost rows 20 %", sampling: Sampling::Lost(0.2), ..USUAL },
    Case { name: "noise 0.1", noise: 0.1, ..USUAL },
    shaped("nearly a sphere", [1.0, 1.02, 1.05]),
    shaped("needle", [0.05, 1.0, 1.02]),
    shaped("lamina", [1.0, 1.6, 2.6]),
    shaped("symmetric", [1.0, 2.0, 2.0]),
    started("1 deg off the major axis", 2, 0.017_453),
    started("1 deg off the minor axis", 0, 0.017_453),
    started("1 deg off the middle axis", 1, 0.017_453),
    Case { name: "one toss", ..TOSS },
    Case { name: "20 tosses", tosses: 20, ..TOSS },
    acted("drag 1 %/s", AtHand, Acting::Drag(0.01)),
    acted("drag 10 %/s", AtHand, Acting::Drag(0.1)),
    acted("quadratic drag 5 %", AtHand, Acting::Quadratic(0.05)),
    acted("constant torque 1e-3", AtHand, Acting::Constant(1e-3)),
    acted("torque noise 3e-3", AtHand, Acting::Noise(3e-3)),
    acted("magnet 1e-3", Missing, Acting::Magnet(1e-3)),
    acted("magnet 1e-2", Missing, Acting::Magnet(1e-2)),
    acted("eddy currents 1 %/s", Missing, Acting::Eddy(0.005)),
    acted("wheel 0.1 %", Missing, Acting::Wheel(1e-3)),
    acted("flexible 2 %, 0.5 Hz", Missing, Acting::Flexible(0.02, 0.5)),
    Case { noise: 1e-3, ..acted("flexible 2 %, 0.5 Hz, quiet", Missing, Acting::Flexible(0.02, 0.5)) },
    acted("fluid 5 %, 2 s", Missing, Acting::Fluid(0.05, 2.0)),
    acted("fluid 5 %, 20 s", Missing, Acting::Fluid(0.05, 20.0)),
    acted("grows by 3 % midway", Missing, Acting::Deployed(0.03, 0.5)),
    acted("grows by 3 % at a third", Missing, Acting::Deployed(0.03, 1.0 / 3.0)),
    acted("grows by 10 % near the end", Missing, Acting::Deployed(0.1, 0.9)),
    Case {
        acting: Acting::Hand(20.0, 0.0, 0.05),
        model: Missing,
        name: "hand at the start of a toss",
        ..TOSS
    },
    Case { acting: Acting::Hand(20.0, 1.0, 0.05), model: Missing, name: "hand at the end of a toss", ..TOSS },
    acted("hand, 1 s of a minute", Missing, Acting::Hand(0.5, 0.4, 0.25)),
    read("scale 1 %", Missing, Error::Scale(0.01)),
    read("axis scales 2 %", Missing, Error::AxisScales(0.02)),
    read("misaligned by 0.01", Missing, Error::Misalignment(0.01)),
    read("offset 0.01", Missing, Error::Offset(0.01)),
    read("offset grows to 0.01", Missing, Error::Ramp(0.01)),
    read("offset walk 5e-4", Missing, Error::Walk(5e-4)),
    read("skew 2 ms", Missing, Error::Skew(2e-3)),
    Case { error: Error::Skew(2e-3), model: Missing, name: "skew 2 ms, toss", ..TOSS },
    read("steps of 1 deg/s", AtHand, Error::Quantum(0.017_453)),
    read("clipped at 90 %", Missing, Error::Clipped(0.9)),
    read("25 Hz repeated", AtHand, Error::Repeated(4)),
    read("one reading in 16 stale", Missing, Error::Stale(16)),
    read("20 bursts", Missing, Error::Bursts(20)),
    read("spikes, 2 %", AtHand, Error::Spikes(0.02)),
    read("low-pass, 5 Hz", Missing, Error::LowPass(5.0)),
    read("vibration, 23 Hz", Missing, Error::Vibration(23.0, 0.02)),
    read("reads acceleration", Missing, Error::Acceleration(1e-3)),
    read("x reversed", Invisible, Error::Mirrored),
    read("x and y exchanged", Invisible, Error::Exchanged),
];
