//! Refusals and warnings say their numbers.

use crate::columns::column::Column;
use crate::columns::drag::Drag;
use crate::columns::offset::Offset;
use crate::error::{Clash, FitError, ToldComponent};
use crate::models::reading_error::ReadingError;
use crate::physical::constraint::Constraint;
use crate::physical::coordinates::{Coordinates, Form};
use crate::report::identifiability::{Identifiability, PrincipalAxis};
use crate::report::next_step::{Contradiction, NextStep, Origin};
use crate::report::nuisance::{FittedTorque, Nuisance};
use crate::report::parts::{Halves, Scatter};
use crate::report::torque_free::{Blow, InvariantTrend, Memory};
use crate::report::warning::Warning;
use crate::settings::torque::TorqueModel;
use crate::units::product::UnitProduct;
use nalgebra::{Matrix3, Vector3};
use polhode::units::RateUnit;

fn says(text: impl ToString, parts: &[&str]) {
    let text = text.to_string();
    assert!(parts.iter().all(|part| text.contains(part)), "{text}: {parts:?}");
}

#[test]
fn refusals_say_their_numbers() {
    says(
        FitError::NoFlight { share: 0.75, torque: Some(0.031), most: 0.02 },
        &["75 per cent", "0.031 tr(J)", "most 0.02"],
    );
    for torque in [None, Some(0.01)] {
        says(
            FitError::NoFlight { share: 0.75, torque, most: 0.02 },
            &["no part with free rotation is long enough"],
        );
    }
    let told = |axis, factor, sigma| ToldComponent { axis, factor, sigma };
    says(
        FitError::Told(vec![told(1, 1.0345, 0.002), told(2, 0.5, 0.1)]),
        &["hy were 1.0345 +- 0.0020", ", or hz were 0.50 +- 0.10"],
    );
    says(FitError::Exchanged { order: [1, 0, 2], signs: [-1.0, 1.0, -1.0] }, &["(-hy, hx, -hz)"]);
    // noise of a quarter of the mean square: three components of 1/3 of it each
    says(FitError::NoRotation { rms: 1.0, noise: 0.5 }, &["1.000e0 rad/s", "at 1.5e0 rad/s or faster"]);
    says(
        FitError::StatedNoise { rms: 1.0, stated: 0.6, shown: 0.01 },
        &["of 6.00e-1 rad/s is 60 times the 1.00e-2 rad/s", "square of 1.000e0 rad/s", ": check its value"],
    );
    let (place, samples, noise) = (String::from("segment 2 (a.csv, from 1.5 s)"), 300, 0.02);
    says(
        FitError::HeldAxis { place: place.clone(), axis: 'z', value: 34.5, samples, noise },
        &["about z is 34.5 rad/s in all 300 samples of segment 2", "noise of 2.00e-2 rad/s", "is saturated"],
    );
    says(
        FitError::SameAxes { place, axes: ['y', 'z'], samples, noise },
        &["about y and z agree", "all 300 samples of segment 2 (a.csv", "one column was read for both"],
    );
    let driven = |unexplained, growth, pull| FitError::Driven { unexplained, growth, pull };
    says(
        driven(Some(0.37), 0.012, 8.25),
        &["leaves 37 %", "grows by 1.20 per cent", "8.2 standard deviations"],
    );
    let quiet = driven(Some(0.009), -0.1, 0.9).to_string();
    assert!(!quiet.contains("leaves") && !quiet.contains("grows") && !quiet.contains("moves"), "{quiet}");
    let unsettled = |fall, factor| FitError::Unsettled {
        rounds: 12,
        noise: 0.01,
        factor,
        axes: Vec::new(),
        fall,
        mirror: Some(Box::new([0.1, 0.4, 0.5])),
    };
    says(
        unsettled(Some(0.03), Some(1.5)),
        &["12 rounds", "fall by 3.00 per cent", "time 1.5000 times", "0.1000 : 0.4000 : 0.5000"],
    );
    says(
        FitError::SizeDiffers { quantity: "the angular momentum", factor: 1.5004, largest: 2, smallest: 0 },
        &["the angular momentum gives the size", "segment 3 is 1.500 times that of segment 1"],
    );
    says(FitError::Undersampled { turn: 6.0, step: 0.1 }, &["6.000e0 rad", "more than 1.910e1 samples"]);
    let clash = Clash { first: Constraint::Triangle, second: Constraint::Drag { name: "drag" }, gap: 0.2 };
    says(FitError::Contradiction(Box::new(clash)), &["half the trace", "drag >= 0", "2.000e-1 of the trace"]);
    says(
        FitError::Untold { names: vec!["drag_xx", "drag_zz"], rank: 3 },
        &["drag_xx, drag_zz", "3 of 5 numbers"],
    );
    assert!(!FitError::Untold { names: vec!["drag"], rank: 5 }.to_string().contains("of 5"));
}

/// A fact is said from its bound on, and a torque or a noise of none is no fact.
#[test]
fn refusals_say_what_is_beyond_their_bounds() {
    let driven = |unexplained, growth, pull| FitError::Driven { unexplained, growth, pull }.to_string();
    says(driven(Some(0.01), 0.5, 1.2), &["leaves 1.0 % of", "grows by 50.00 per cent", "by 1.2 standard"]);
    for growth in [0.0, f64::INFINITY, f64::NAN] {
        let quiet = driven(None, growth, 1.0);
        assert!(!quiet.contains("leaves") && !quiet.contains("grows") && !quiet.contains("moves"), "{quiet}");
    }
    let at_most = FitError::NoFlight { share: 0.75, torque: Some(0.02), most: 0.02 };
    says(at_most, &["no part with free rotation is long enough"]);
    // three times the noise of a component
    says(FitError::NoRotation { rms: 0.1, noise: 0.1 }, &["at 3.0e-1 rad/s or faster"]);
    assert!(FitError::NoRotation { rms: 0.0, noise: 0.0 }.to_string().ends_with("spin the body"));
}

/// What a record leaves open is said with the axes that it tells, and which record would tell more.
#[test]
fn what_is_open_is_said_in_words() {
    let spin = Matrix3::from_diagonal(&Vector3::new(1e-8, 1.0, 1e-8));
    let (singular, body) = (Coordinates::new(1e4, 1e4, 0.0, 0.0, 0.0), Matrix3::identity() / 3.0);
    let open = Identifiability::new(&(singular, Form::identity()), &spin, &body);
    let text = FitError::Unidentifiable(Box::new(open)).to_string();
    says(&text, &["2 of 5 numbers", "(0.0000, 1.0000, 0.0000), the y axis of the sensor, is a"]);
    says(text, &[". Record a throw that wobbles", "for instance from CAD"]);
    let axis = PrincipalAxis { axis: Vector3::new(0.0, -0.6, -0.8), number: Some(2) };
    assert_eq!(axis.to_string(), "(0.0000, 0.6000, 0.8000) is a principal axis (axis 2 here)");
}

#[test]
fn warnings_say_their_numbers() {
    says(Warning::Residuals { times: 9_999.0, noise: 1e-3 }, &["are 9999.0 times"]);
    says(Warning::Residuals { times: 12_345.0, noise: 1e-3 }, &["are 1.2e4 times"]);
    says(Warning::StatedNoise { stated: 0.06, shown: 1e-3 }, &["is 6.00e-2 rad/s", "show 1.00e-3 rad/s"]);
    let stated = Warning::StatedAttitudeNoise { stated: 0.02, shown: 5e-3 };
    says(stated, &["is 2.00e-2 rad,", "show 5.00e-3 rad,", "leave it out"]);
    says(
        Warning::Filtered { correlation: 0.5, times: 3.162 },
        &["correlation 0.50:", "is 3.2 times", "by up to this factor"],
    );
    says(Warning::Merged { samples: 1 }, &["1 sample was merged"]);
    says(Warning::Outliers { samples: 2 }, &["2 samples were left out"]);
    says(Warning::Saturated { samples: 1 }, &["1 sample at", "was left out"]);
    says(Warning::Bursts { samples: 9, bursts: 1, line: 4 }, &["9 samples", "in 1 burst of", "line 4"]);
    says(Warning::NoScale { size: -6.0 }, &["negative size, by 6 standard deviations"]);
    says(Warning::NoScale { size: -1.0 }, &["does not exceed the noise"]);
    let as_well = |gain| Warning::AsWell { error: ReadingError::Delays, size: 2.5e-3, gain };
    says(as_well(-1.5), &["up to 2.5 ms", "lower by 1.5"]);
    says(as_well(1.5), &["higher by 1.5"]);
    says(Warning::CoarseAttitudes { turn: 2.0 }, &["2.00 rad", "4.28 rad"]);
    let refuted =
        |unit| Warning::RefutedPrior { what: "offsets", size: 0.05, prior: 1e-3, unit, gain: 120.4 };
    says(refuted("rad/s"), &["offsets, up to 5.0e-2 rad/s,", "50 times", "of 1.0e-3 rad/s that", "by 120)"]);
    says(refuted(""), &["up to 5.0e-2,", "of 1.0e-3 that"]);
    let offset = |is_fitted| Warning::RateOffset { size: 0.02, gain: 225.4, is_fitted };
    says(offset(true), &["offset of the rates of 2.0e-2 rad/s", "higher by 225)", "corrects for it"]);
    says(offset(false), &["not part of the fit"]);
    says(
        Warning::RateScale { scale: -0.05, gain: 60.0, is_fitted: true },
        &["scale error of the rates of -5.00 %", "higher by 60)", "corrects for it"],
    );
    says(Warning::RateResiduals { times: 1.43, noise: 0.02 }, &["are 1.4 times", "2.00e-2 rad/s"]);
    let halves = Halves { share: 0.25, first: [0.1, 0.4, 0.5], second: [0.2, 0.3, 0.5], chi2: 44.0 };
    let impossible = Halves { second: [-0.14, 0.47, 0.67], ..halves };
    says(
        Warning::Halves(impossible),
        &["= 0.1000 : 0.4000 : 0.5000, the rest -0.1400", "0.6700, which no rigid body has (chi"],
    );
    let thin = Halves { second: [-0.02, 0.5, 0.52], ..halves };
    assert!(!Warning::Halves(thin).to_string().contains("no rigid body"));
    says(Warning::Halves(halves), &["first 25 %", "0.1000 : 0.4000", "rest 0.2000", "44 of 5"]);
    let two = |gain| Warning::TwoTensors { parts: halves, gain };
    says(two(-2.5), &["lower by 2.5", "first 25 %", "0.1000 : 0.4000 : 0.5000", "0.2000 : 0.3000 : 0.5000"]);
    says(two(2.5), &["higher by 2.5"]);
    let scatter = Scatter { parts: 8, chi2: 140.0, dof: 35 };
    says(Warning::Scatter(scatter), &["8 parts", "140 of 35", "factor of 2.0"]);
    says(
        Warning::Differing { unknowns: vec![("drag", 2.0), ("scale", 3.5)] },
        &["in drag (", "of 2.0), scale (", "3.5)"],
    );
    says(
        Warning::NoisySegment { segment: 2, start: 7.5, times: 3.0 },
        &["segment 3 (from 7.5 s)", "3.0 times"],
    );
    says(
        Warning::Blow(Blow { segment: 1, time: 19.75, deviations: 7.8 }),
        &["at 19.750 s of segment 2", "is 7.8 standard deviations"],
    );
    says(Warning::Memory(Memory { chi2: 99.0, dof: 27 }), &["99 of 27"]);
    says(Warning::MomentumTrend(InvariantTrend { rate: -0.01, sigma: 0.001 }), &["-1.00 +- 0.10 per cent"]);
    says(Warning::Uncertain { deviation: 0.0123 }, &["1.2 per cent"]);
    says(
        Warning::TorqueNoise { density: 2.5e-4, unexplained: Some(0.25) },
        &["density of up to 2.5e-4 (rad/s^2)^2 s; free motion leaves 25 % of"],
    );
    let noise = Warning::TorqueNoise { density: 2.5e-4, unexplained: None }.to_string();
    assert!(noise.contains("2.5e-4 (rad/s^2)^2 s; errors") && !noise.contains("free motion"), "{noise}");
    says(Warning::ShortSegments { short: 1, segments: 4 }, &["1 of 4 segments was left out"]);
    says(Warning::ShortSegments { short: 2, segments: 4 }, &["2 of 4 segments were left out"]);
    says(Warning::Spikes { samples: 3, line: 17 }, &["3 samples were left out", "in line 17"]);
    says(Warning::Repeated { samples: 9, rate: 149.981 }, &["9 samples were", "come at 150 Hz"]);
    says(Warning::Repeated { samples: 9, rate: 33.336 }, &["come at 33.34 Hz"]);
    says(Warning::Stale { samples: 1 }, &["1 sample was left out as repeating"]);
    says(Warning::NotConverged { moved: 0.256 }, &["by 0.26 standard deviations"]);
    let units = Warning::Units { products: vec![UnitProduct::numbered(0.1)], unexplained: 0.5, other: 0.13 };
    says(
        units,
        &["with times in numbers of samples read as s, another", "(13 % of", "unexplained, 50 % as read)"],
    );
    says(Warning::Vibration { times: 1.256, noise: 2e-3 }, &["by 1.26 times", "of 2.000e-3 rad/s"]);
    says(
        Warning::ConstantTorque { gain: 9.26, turn: 0.256 },
        &["higher by 9.3)", "by 0.26 rad within", "less than 0.1 rad"],
    );
    says(Warning::Contradiction { pull: 7.26 }, &["7.3 standard deviations"]);
    says(Warning::EqualMoments { low: 2, high: 3 }, &["moments 2 and 3 agree"]);
    says(Warning::AttitudeResiduals { times: 2.56, noise: 0.02 }, &["are 2.6 times", "of 2.00e-2 rad"]);
    says(Warning::MovingAxes { turn: 0.02, gain: 60.4 }, &["by 2.00e-2 rad from", "higher by 60)"]);
    says(Warning::Profile { times: 1.76 }, &["by a factor of 1.8"]);
    says(Warning::RepeatedAttitudes { samples: 2 }, &["2 samples were left out as repeating"]);
    says(Warning::FewEquations { dof: 7 }, &["only 7 degrees of freedom"]);
    let left_out = |unit, origin| Warning::LeftOut { what: "it", size: 0.05, unit, gain: 60.4, origin };
    says(left_out("rad/s", Origin::Sensor), &["it, up to 5.0e-2 rad/s, would", "by 60)", "with a prior"]);
    says(left_out("", Origin::Wheels), &["it, up to 5.0e-2, would", "speed of each wheel"]);
    for origin in [Origin::Drift, Origin::Body] {
        assert!(left_out("s", origin).to_string().ends_with("wrong by more than its standard deviations"));
    }
    says(ReadingError::Misalignment.of_size(0.01), &["0.57 deg"]);
    says(ReadingError::AxisScales.of_size(0.0234), &["2.3 %"]);
    says(ReadingError::Offsets.of_size(0.01), &["0.57 deg/s"]);
}

#[test]
fn next_steps_say_their_numbers() {
    let sensor = NextStep::Sensor { name: "offset_x", size: 0.01, unit: "rad/s", times: 4.0 };
    says(sensor, &["offset_x of 0.01 rad/s", "4.0 times", "offset_x of 0.0025 rad/s"]);
    says(NextStep::MoreOften { turn: 1.5 }, &["up to 1.50 rad"]);
    let other = |turn, gain| NextStep::OtherStart { times: 30.0, turn, number: 2, gain };
    says(
        other(true, Some(5.0)),
        &["perpendicular to axis 2", "30 times the standard deviation", "be 5 times smaller"],
    );
    says(other(false, None), &["about another axis: I2"]);
    let left_out = |what, origin| NextStep::FindCause(Contradiction::LeftOut { what, origin });
    says(left_out("delays", Origin::Sensor), &["calibrate the sensor", "with a prior", "shows delays"]);
    says(left_out("offsets that change", Origin::Drift), &["drifts less", "shows offsets that change"]);
    says(left_out("an error of hx", Origin::Wheels), &["check the inertia", "shows an error of hx"]);
    says(left_out("a magnet", Origin::Body), &["find out whether there is a magnet"]);
    for origin in [Origin::Drift, Origin::Wheels] {
        let text = left_out("it", origin).to_string();
        assert!(!text.contains("prior") && !text.contains("whether there is"), "{text}");
    }
}

/// Products of common units are told by the fewest mistakes, and none that is near 1 is one.
#[test]
fn units_are_told_by_their_product() {
    let radians = UnitProduct::common(RateUnit::RadiansPerSecond);
    let of =
        |text: &str| radians.iter().find(|product| product.to_string() == text).map(|product| product.factor);
    let degree = core::f64::consts::PI / 180.0;
    let near = |found: Option<f64>, expected: f64| found.is_some_and(|f| (f / expected - 1.0).abs() < 1e-12);
    assert!(near(of("rates in deg/s read as rad/s"), degree) && near(of("times in ms read as s"), 1e-3));
    assert!(
        near(of("rates in rad/s read as deg/s"), 1.0 / degree)
            && near(of("rates in rpm read as rad/s"), 6.0 * degree)
    );
    assert!(near(of("rates in deg/s read as rad/s, and times in s read as ms"), degree * 1e3));
    assert!(radians.iter().all(|product| !(0.5..2.0).contains(&product.factor)));
    for (k, product) in radians.iter().enumerate() {
        let again = radians[..k].iter().any(|other| (other.factor / product.factor - 1.0).abs() < 1e-3);
        assert!(!again, "{product}");
    }
    // of a unit that the record names, only that one may be a mistake
    let degrees = UnitProduct::common(RateUnit::DegreesPerSecond);
    assert!(degrees.iter().all(|product| product.rates[1] == "deg/s"));
    assert!(degrees.iter().any(|product| near(Some(product.factor), 1.0 / degree)));
    let turns = UnitProduct::common(RateUnit::RevolutionsPerMinute);
    assert!(turns.iter().all(|product| product.rates[1] == "rpm"));
}

/// A torque that was found is said with each of its coefficients, and with the ratios that the tensor would have without it.
#[test]
fn torques_are_said_with_their_coefficients() {
    let of = |column: Column, value: f64, sigma: f64| Nuisance::new(&column, value, sigma, 2.0);
    let coefficients =
        vec![of(Column::new(Drag, None), 0.025, 1e-3), of(Column::new(Offset(1), None), -0.5, 0.06)];
    let torque = |ratios_without| {
        let (model, gain, coefficients) = (TorqueModel::Drag, Some(12.0), coefficients.clone());
        Warning::Torque(FittedTorque { model, is_chosen: true, coefficients, gain, ratios_without })
    };
    let reckoned = "drag 0.0500 +- 0.0020 1/s, offset_y -1.00 +- 0.12 rad/s";
    assert_eq!(torque(None).to_string(), format!("not free of torques: the fit includes {reckoned}"));
    let without = "; without it I1/I3 would be 0.5000 and I2/I3 0.7500";
    assert!(torque(Some([0.5, 0.75])).to_string().ends_with(&format!("{reckoned}{without}")));
}
