//! Every threshold of the crate: its value, what it means, and the test whose result shows it.
//!
//! *unmeasured* is one that no test or experiment of this repository has set; *derived* follows from a distribution or
//! from rounding. Sizes of arrays, coefficients of formulas and mathematical constants stand where they are used.

/// No test or experiment has set it.
#[cfg(test)]
const UNMEASURED: &str = "unmeasured";
/// It follows from a distribution or from rounding.
#[cfg(test)]
const DERIVED: &str = "derived";

/// One row of the table.
#[cfg(test)]
struct Threshold {
    place: &'static str,
    about: &'static str,
    name: &'static str,
    value: &'static str,
    meaning: &'static str,
    source: &'static str,
}

macro_rules! thresholds {
    ($($place:ident: $about:literal { $($name:ident: $kind:ty = $value:expr, $meaning:literal, $source:expr;)* })*) => {
        $(#[doc = $about] pub(crate) mod $place { $(#[doc = $meaning] pub(crate) const $name: $kind = $value;)* })*
        #[cfg(test)]
        const TABLE: &[Threshold] = &[$($(Threshold {
            place: stringify!($place),
            about: $about,
            name: stringify!($name),
            value: stringify!($value),
            meaning: $meaning,
            source: $source,
        },)*)*];
    };
}

thresholds! {
    test_functions: "the test functions and the sums over samples" {
        TESTS_PER_RADIUS: f64 = 4.0, "test functions per half width", UNMEASURED;
        SAMPLES_PER_TEST: f64 = 8.0, "fewest samples in the support of one test function", UNMEASURED;
        ROUNDED: f64 = 1e-9, "relative excess of a radius over half of a duration that rounding makes", DERIVED;
        TIE: f64 = 1e-6,
            "nudge by which a number of tests is rounded, so that a change of units cannot change it", DERIVED;
    }
    groups: "neighbouring samples that the covariance sees as one" {
        GROUPS: f64 = 12.0, "groups per half width of a test function: sums are then exact to a millionth", UNMEASURED;
        LONGEST: f64 = 0.15, "longest group, rad of the motion", UNMEASURED;
    }
    quadrature: "weights on irregular samples" {
        NEAREST: f64 = 0.25,
            "distance of a neighbour, over the interval, below which it is passed over", "cubics_are_integrated_exactly_on_irregular_samples";
    }
    noise: "the noise of the rates" {
        SURE: f64 = 5.0, "standard deviations of a mean within which the true one is taken to lie", DERIVED;
        OUTLYING: f64 = 30.0, "squared difference of readings, over its median, beyond which it counts as a blow: a chance of 1e-15", DERIVED;
        LEAST: f64 = 1e-20,
            "variance over the mean square rate that the error of the quadrature alone brings", "without_noise_the_tensor_is_exact_to_the_quadrature";
        MOST: f64 = 0.25,
            "share of the mean square rate that is too much noise to fit", "zero_rates_and_mere_noise_are_no_rotation";
        DEVIATIONS: f64 = 5.0, "standard deviations of the misfit of mere noise that noise explains", DERIVED;
        STATED: f64 = 2.0,
            "factor between a noise that is stated and that of the readings which is worth a warning", "a_stated_noise_is_contradicted_where_the_readings_tell_it";
        WHITE: f64 = 1.5,
            "factor between the variance of the noise of all samples and of every second one up to which it is white", "a_stated_noise_is_contradicted_where_the_readings_tell_it";
    }
    axes: "axes that read nothing" {
        FEWEST: usize = 50,
            "samples in which an axis may read one number by chance: at a noise of half a step a chance of 5e-9", DERIVED;
        LEAST: f64 = 1e-5, "noise over the rates below which digits that a file leaves out may hold an axis still", DERIVED;
    }
    filtered: "noise of readings that was filtered before they were sampled" {
        SLOW: f64 = 0.15,
            "largest turn from one sample of the shortest stride to the next, rad: a motion then does not look like filtered noise", "a_motion_and_other_noise_are_no_filter";
        STRIDES: usize = 6,
            "strides, each twice the one before, three of them at a time: averages over up to eight readings are seen", "averages_are_named_with_their_correlation";
        FEWEST: usize = 200, "fewest places whose mean square is nearly normal", UNMEASURED;
        MOST: usize = 20_000, "most places that are looked at", UNMEASURED;
        SURE: f64 = 5.0,
            "standard deviations of the bend over three strides that white noise and torque noise do not reach: a chance of 3e-7 each, together of 1e-6", DERIVED;
        DITHERED: f64 = 4.0,
            "variance over that of rounding from which on errors of rounding are white: that of noise of half a step, and rounding", DERIVED;
    }
    rounds: "rounds of least squares" {
        ROUNDS: usize = 12, "most rounds at one radius; at low noise two or three do", UNMEASURED;
        FULL_ROUNDS: usize = 6, "rounds that take their whole step", UNMEASURED;
        RELAXED: f64 = 0.5, "share of a later step where torques act: full ones may go to and fro", UNMEASURED;
        BESIDE: usize = 3_000,
            "samples from which parts of a round are worked out side by side: threads cost more than they save below", UNMEASURED;
        SHARES: usize = 30, "halvings of a step that loses the smallest moment", UNMEASURED;
        KEPT: f64 = 0.1, "share of the smallest moment that a round leaves at least", UNMEASURED;
        REACHED: f64 = 0.99, "share of that which counts as reached", UNMEASURED;
        STILL: f64 = 0.01, "standard deviations by which the last round may still move the tensor", UNMEASURED;
        RESTLESS: f64 = 0.5, "the same beyond which there is no answer", UNMEASURED;
        TORQUES: f64 = 4.0, "misfit that noise does not explain", "torque_is_seen_in_the_drifts";
        STANDS: f64 = 0.1, "relative change of a misfit from one round to the next that no longer matters", UNMEASURED;
        SIGNIFICANT_GAIN: f64 = 50.0,
            "fall of chi squared that no wobble of noise brings: a chance of exp(-25) for each frequency", DERIVED;
        CLEAR: f64 = 10.0,
            "times that gain in a part of a record, beyond which the rest is not asked", "long_records_go_on_from_a_part_of_them";
        FIRST: usize = 4, "parts of a stretch of which that is the first, unless it is shorter still", UNMEASURED;
        FALL: f64 = 0.03, "share of its torque noise that a round of a descent leaves at least", UNMEASURED;
        DESCENT: usize = 30, "rounds of a descent from boundless torque noise", UNMEASURED;
        SAME: f64 = 0.05, "relative change of a level of torque noise that no longer matters", UNMEASURED;
        BOUNDLESS: f64 = 1e5, "torque noise over noise of the rates where a descent begins", UNMEASURED;
        NEGLIGIBLE: f64 = 1e-3, "the same below which torque noise counts as none", UNMEASURED;
        BEYOND: f64 = 0.05, "share of the trace by which torques may carry an estimate outside of the physical law", UNMEASURED;
    }
    stacked: "least squares of all stretches" {
        FLAT: f64 = 1e3, "standard deviation of a column without a prior: it says nothing", UNMEASURED;
        TOGETHER: usize = 256, "rows that are brought to a triangle together, so that they stay in the cache", UNMEASURED;
        ITERATIONS: usize = 1_000, "most iterations of a singular value decomposition of five by five, many times what it needs", UNMEASURED;
        RIDGE: f64 = 1e-7, "least ridge over the size of the triangle, far above its rounding", UNMEASURED;
    }
    levels: "levels of torque noise by restricted likelihood" {
        GAIN: f64 = 4.0,
            "gain of twice the log-likelihood up to which there is none: noise surpasses it once in 40 records", UNMEASURED;
        DECADES: usize = 12, "decades of torque noise that are tried", UNMEASURED;
        FIRST_DECADE: f64 = 3.0, "the first of them: a thousandth of the noise of the rates", UNMEASURED;
        BETWEEN: f64 = 0.25,
            "share of GAIN that one of these brings if the likeliest between two of them brings all of it", UNMEASURED;
        SECTIONS: usize = 4, "steps of the golden section within two decades", UNMEASURED;
        STEP: f64 = 0.15, "decades to both sides between which the likelihood is taken for a parabola", UNMEASURED;
        RESHAPED: f64 = 1.0,
            "gain of twice the log-likelihood for which the shape of the torque noise changes", UNMEASURED;
    }
    ladder: "the choice of a torque" {
        FIRST: f64 = 5.0,
            "gain of log-likelihood of a first coefficient; noise brings it once in 600 records", UNMEASURED;
        FURTHER: f64 = 1.5, "the same of each further coefficient, beyond that", UNMEASURED;
        HOPE: f64 = 0.5, "share of it that the equations without a torque must promise before it is fitted", UNMEASURED;
        ALIKE: f64 = 30.0,
            "gain of log-likelihood up to which a torque of an impossible body gives way to one of a possible body; a driven body has no such torque", "a_body_that_gains_half_of_its_momentum_gets_no_tensor";
    }
    choice: "what the choice of a torque adds to the deviations" {
        RARE: f64 = 1e-3, "share of answers that the ellipsoid of 99.9 % leaves out", DERIVED;
        LEAST: f64 = 0.2, "least weight of a model whose share is RARE or more: it then lies within that ellipsoid", "a_far_model_lies_within_the_ellipsoid_unless_it_is_refuted";
    }
    units: "units of rate and time" {
        RADII: usize = 8, "widths of test functions, each twice the one before, at which a record is looked at", UNMEASURED;
        TORQUES: [f64; 6] = [0.1, 1.0, 10.0, 1e2, 1e3, 1e4],
            "torque noise over the noise of the rates in the derivatives of the rates", UNMEASURED;
        STEPS: usize = 40, "most steps of least squares to the nearest free body", UNMEASURED;
        GAINED: f64 = 1e-7, "relative gain of a step after which there is no further", UNMEASURED;
        RAISED: f64 = 1e8, "largest damping of a step", UNMEASURED;
        SMALLEST: f64 = 1e-3, "least share of the trace by which a start is inside of the physical law", UNMEASURED;
        SAMPLES: usize = 1_500, "samples on which these widths are compared", UNMEASURED;
        SAME: f64 = 1e-3, "relative difference of two products that are one", UNMEASURED;
        APART: f64 = 2.0, "factor from which on two products are not taken for each other", UNMEASURED;
        HELPLESS: f64 = 0.1,
            "share of the size of the derivatives that the fastest body reaches in units that are not tried", UNMEASURED;
        OUT_OF_QUESTION: f64 = 4.0, "residual in other units over that in the units as read, from which on they are left out", UNMEASURED;
        OPEN: f64 = 10.0, "difference of log-likelihood up to which units explain a record equally well", UNMEASURED;
        SURELY: f64 = 10.0, "gain of log-likelihood over the units as read of others that are named", UNMEASURED;
        CLEARER: f64 = 2.0, "residual in the units as read over that in units that are named", UNMEASURED;
        EXPLAINED: f64 = 0.1, "largest share of the squared derivatives that is left in units that explain a record", UNMEASURED;
        LISTED: usize = 3, "units that a message lists", UNMEASURED;
        SECOND: f64 = 1.333_521_432_163_324, "ratio of one possible rate of numbered samples to the next: eight a decade", UNMEASURED;
    }
    radius: "the half width of the test functions" {
        SHORTEST: f64 = 0.5, "shortest radius, rad of the motion", UNMEASURED;
        CANDIDATES: usize = 6, "radii to choose from, each twice the one before", UNMEASURED;
        ROOM: f64 = 4.0, "radii that a stretch must hold", UNMEASURED;
        OF_SHORT: f64 = 0.25, "radius of a record with no room for any, over its duration", UNMEASURED;
        COMPARED: usize = 2, "rounds after which radii are compared", UNMEASURED;
        DENSE: f64 = 0.9,
            "equations over samples beyond which their covariance is all but singular", "a_radius_without_room_is_refused";
        PILOT_SAMPLES: usize = 8_000, "samples on which the radius is chosen: more would not change it", UNMEASURED;
        LONG: usize = 100_000,
            "samples from which on a descent begins where that of a part of the record has ended", "long_records_go_on_from_a_part_of_them";
        SPARED: f64 = 1.01,
            "predicted variance over the least that a longer radius of a long record may have: it has fewer equations",
            "long_records_go_on_from_a_part_of_them";
        PART: usize = 30_000, "samples of that part", "long_records_go_on_from_a_part_of_them";
    }
    walk: "columns of a random walk of the offsets" {
        SHORTEST: f64 = 0.5, "shortest radius for these columns, rad of the motion", UNMEASURED;
    }
    next_step: "what to do next" {
        SURE: f64 = 1.959_963_984_540_054, "standard deviations in half of a 95 % interval", DERIVED;
        UNEVEN: f64 = 10.0, "deviation of the weakest combination over that of the best from which on it is named", UNMEASURED;
        HELPS: f64 = 2.0, "factor by which another start must lower that deviation to be advised", "another_start_that_would_not_help_is_not_advised";
        PLANNED: usize = 500, "samples of the record that is planned for that", UNMEASURED;
    }
    judgement: "refusals" {
        EXCLUDED: [f64; 2] = [35.888_186_879_672_87, 38.258_336_377_209_69],
            "chi squared of 5 and 6 degrees of freedom with a chance of 1e-6: prior and record exclude each other", DERIVED;
        OUTSIDE: f64 = 6.0,
            "standard deviations of a prior by which it may lie outside limits and law", "contradictions_are_named_with_their_numbers";
        DRIVEN: f64 = 0.15,
            "share of the squared derivative of the rates that no drag and constant torque explain, from which a body is driven", "a_body_that_a_hand_drives_gets_no_tensor";
        GROWN: f64 = 0.1, "relative growth of |J w| over a segment that drag cannot make", UNMEASURED;
        GROWN_BY_HALF: f64 = 0.5,
            "the same, which only a driven body reaches, however near to the law its tensor is", "a_body_that_gains_half_of_its_momentum_gets_no_tensor";
        OUTSIDE_OF_LAW: f64 = 5.0,
            "standard deviations of the physical tensor from the unconstrained one, beside such growth", UNMEASURED;
        AUDIBLE: f64 = 0.5, "largest share of the squared derivative of the rates that is noise where the share of torques is reported", UNMEASURED;
        UNTOLD: f64 = 1.0,
            "deviation of a torque, in units of the rate, beyond which the record says nothing of it", "torques_that_a_record_cannot_tell_are_named";
        WIDER: f64 = 2.0,
            "how much wider the test functions may be with which another order, or another size of a component, of a wheel's momentum explains the record", "wheels_are_fitted_to_the_bound_over_many_trials";
        ENORMOUS: f64 = 100.0,
            "gain of log-likelihood by another size of a component of that momentum, beside torque noise, from which on it is refused", UNMEASURED;
        PLAUSIBLE: f64 = 3.0, "factor of such a size, beside torque noise, up to which it is taken for a cause", UNMEASURED;
        AS_LIKELY: f64 = 10.0, "difference of log-likelihood up to which two of them are told", UNMEASURED;
        CALMER: f64 = 0.25, "share of the torque noise that is left with it", UNMEASURED;
        TOLD: f64 = 6.0,
            "deviations from 1 of the factor of a component of that momentum from which on it is wrong: a chance of 2e-9", DERIVED;
        ALIKE: f64 = 3e-3,
            "relative difference of the momenta or energies of two segments that may be an error of the sensor", UNMEASURED;
    }
    warnings: "warnings" {
        FAR: f64 = 6.0,
            "standard deviations by which noise alone does not carry five numbers off the physical tensors", "limits_that_contradict_the_record_are_seen_in_the_misfit";
        RESIDUALS: f64 = 1.2, "misfit that is worth a warning", UNMEASURED;
        HALVES: f64 = 25.744_831_959_040_53,
            "chi squared of 5 degrees of freedom with a chance of 1e-4: two parts of a record contradict each other", DERIVED;
        SEEN: f64 = 7.848_145_897_662_035,
            "deviations of the difference of two parts by which a tensor changes that HALVES misses with a chance of 1e-3", DERIVED;
        CUTS: usize = 8, "parts of a record at whose borders it is cut in two", UNMEASURED;
        OPEN: f64 = 1e-12,
            "singular value over the largest, below which it is rounding and a part of the record leaves the number open", DERIVED;
        SCATTERED: f64 = 4.264_890_793_922_825,
            "standard normal deviate with a chance of 1e-5: the parts of a record scatter, or pull the tensor, by more than their noise", DERIVED;
        DIFFERING: f64 = 1.644_853_626_951_472,
            "standard normal deviate with a chance of 0.05: an unknown beside the tensor has the deviation that the parts of a record tell", "what_parts_of_a_record_differ_in_is_less_certain";
        NAMED: f64 = 3.090_232_306_167_813, "the same with a chance of 1e-3, from which on a warning names it", DERIVED;
        NOISY: f64 = 4.0,
            "mean square residual of a segment over that of the median segment from which on it is worth one", UNMEASURED;
        UNCERTAIN: f64 = 5e-3,
            "deviation of the tensor, over the trace, beyond which the covariance is only approximate", "deviations_next_to_a_steady_spin_hold";
        APART: f64 = 3.0, "standard deviations that two moments must be apart to have axes of their own", UNMEASURED;
        UNEXPLAINED: f64 = 0.01,
            "share of the squared derivative of the rates from which torques at random are worth a warning", UNMEASURED;
        SENSOR: f64 = 30.0,
            "gain of log-likelihood from which errors of the sensor are named: at most 15 in measured tosses, at least 62 in 40 records of a sensor misaligned by 0.02", "misaligned_and_unequal_axes_are_named_where_torque_noise_takes_their_place";
        AS_WELL: f64 = 3.0,
            "log-likelihood, less one for each coefficient, by which an error of the sensor may be less likely than the chosen torque and explain the record as well: a share of 5 %", "a_misaligned_sensor_explains_a_record_as_well_as_a_torque";
        LEFT_OUT: f64 = 3.719_016_485_455_709,
            "standard normal deviate with a chance of 1e-4: without torque noise, the gain of log-likelihood by what the fit takes to be zero", DERIVED;
        NEGATIVE: f64 = 3.0, "standard deviations below zero from which on a negative size of the tensor is not noise", UNMEASURED;
        FEW: usize = 20, "degrees of freedom below which chi squared is no check", UNMEASURED;
    }
    trend: "trends of what a free body keeps, and whiteness" {
        SIGNIFICANT: f64 = 5.0,
            "standard deviations of a trend or a correlation that count", "torque_is_seen_in_the_drifts";
        MEMORY: f64 = 4.753_424_308_822_899,
            "standard normal deviate with a chance of 1e-6: residuals within one turn are correlated", DERIVED;
        BLOW: f64 = 1e-6,
            "chance with which noise makes the largest residual of a record: one that it makes as rarely is a blow", DERIVED;
    }
    identifiability: "what a record determines" {
        VAGUE: f64 = 0.1,
            "deviation of an undetermined number, over the trace: tensors differ by 0.4 at most", "pure_spin_tells_an_axis_and_no_ratio";
        LONGER: f64 = 20.0, "largest factor by which a longer record is advised", UNMEASURED;
        PURE: f64 = 0.05, "mean square rate across the spin, over that along it, of a pure spin", UNMEASURED;
        PRINCIPAL: f64 = 0.1,
            "largest part of a null tensor that a principal axis leaves off it", "two_pure_spins_tell_all_axes_and_no_ratio";
    }
    averages: "axes from averages" {
        PARTS: usize = 8, "parts of a stretch whose mean square rates are compared", UNMEASURED;
        UNEVEN: f64 = 0.5, "largest difference of two of them, over their mean, without a torque", UNMEASURED;
    }
    errors: "sizes of the errors of the sensor in the report" {
        OFFSET: f64 = 0.01, "offset of an axis, rad/s", UNMEASURED;
        SCALE: f64 = 0.01, "relative error of scale", UNMEASURED;
        ALIGNMENT: f64 = 0.01, "error of a right angle, rad", UNMEASURED;
        LARGEST: f64 = 0.05,
            "plausible deviation of misalignments, rad, and of axis scales that are tried beside a fit", UNMEASURED;
        LARGEST_OFFSET: f64 = 0.35,
            "the same of offsets, rad/s: 20 deg/s, the largest that makers of small sensors state for one that is not calibrated", UNMEASURED;
        RANDOM_WALK: f64 = 3e-3,
            "the same of a random walk of the offsets, rad/s per root of a second", UNMEASURED;
        LARGEST_MAGNET: f64 = 0.03,
            "the same of a torque that is fixed in space, over the trace, rad/s^2", UNMEASURED;
        HELD: f64 = 1e-6, "deviation of scale and alignment while the tensor is that of a sphere", UNMEASURED;
        DELAY: f64 = 1e-3, "delay of an axis, s", UNMEASURED;
        WHEEL: f64 = 1e-3, "momentum of a wheel over that of the body", UNMEASURED;
        MAGNET: f64 = 1e-3, "torque of a magnet in the body over the trace, rad/s^2", UNMEASURED;
        WALK: f64 = 1e-4, "random walk of the offsets, rad/s per root of a second", UNMEASURED;
        WALK_STEPS: usize = 6, "steps of that walk in each segment: the slow ones matter", UNMEASURED;
        MOST: usize = 60, "most columns of a walk; with more it is left out", UNMEASURED;
    }
    motion: "the fitted motion in the report" {
        FIRST: f64 = 1.0, "first window, rad", UNMEASURED;
        GROWTH: f64 = 1.6, "how much longer each window is than the one before", UNMEASURED;
        STEPS: usize = 12, "steps of the search in each window", UNMEASURED;
        STEP: f64 = 0.05, "longest step of the integrator, rad: errors of order 1e-7", UNMEASURED;
        PARTS: f64 = 1000.0, "most steps of the integrator between two samples", UNMEASURED;
        CLOSE: f64 = 1e-9, "relative gain, and relative step, at which the search ends", UNMEASURED;
        DAMPING: f64 = 1e-4, "first damping of a step that does not help", UNMEASURED;
        CHANGE: f64 = 10.0, "factor by which damping grows; its tenth is that by which it falls", UNMEASURED;
    }
    program: "the nearest physical tensor" {
        CUTS: usize = 40,
            "rounds of cuts; hard random programs took at most 13", "hard_random_programs_end_certified_and_no_feasible_tensor_is_nearer";
        VIOLATION: f64 = 1e-9, "violation of the law that ends the cuts", "answers_are_those_of_a_semidefinite_program";
        STALLED: [f64; 2] = [1e-5, 0.5],
            "violation, and share of the one before, at which the accuracy of the solver ends the cuts", UNMEASURED;
        SHARE: f64 = 1e-3, "size of a standard deviation of drag in the program", UNMEASURED;
        SOLVER: f64 = 1e-11, "tolerance of the solver", UNMEASURED;
        NEAR: f64 = 1e-4, "distance of a wall that the answer may lie on", UNMEASURED;
        NEWTON: usize = 12, "steps of Newton's method on a face", UNMEASURED;
        ROUNDED: f64 = 1e-15, "step at which it ends", DERIVED;
        CERTIFIED: f64 = 1e-9,
            "largest violation, complementarity and negative multiplier of a certified answer", "hard_random_programs_end_certified_and_no_feasible_tensor_is_nearer";
        STATIONARY: f64 = 1e-6,
            "its largest residual of stationarity, standard deviations", "answers_are_those_of_a_semidefinite_program";
        INWARDS: f64 = 1e-14, "relative step towards the sphere that makes an answer on the law physical", DERIVED;
    }
    limits: "limits that the user sets" {
        ROOM: f64 = 1e-6,
            "room that limits must leave, as a share of the trace", "limits_hold_and_contradictions_are_named";
        MET: f64 = 0.1, "share of that by which a tensor may break the law", UNMEASURED;
        ROUNDS: usize = 400, "rounds of cuts until limits are checked", UNMEASURED;
        PUSHES: f64 = 1e-3, "least multiplier of a limit that takes part in a contradiction", UNMEASURED;
        PARALLEL: f64 = 1e-12, "how far the cosine of the angle of two axes may be from 1 if they are one", DERIVED;
        SYMMETRIC: f64 = 1e-9, "relative asymmetry of a covariance that is rounding", DERIVED;
    }
    spread: "the spread of an answer that a wall holds" {
        DRAWN: usize = 10_000, "points that are drawn", "half_a_normal_distribution_keeps_its_mean_square";
        INSIDE: usize = 200, "fewest of them inside the walls that tell the spread", "far_outside_nothing_is_said";
    }
    carrier: "the joint fit of a carrier" {
        INVERSES: usize = 8, "rounds of the closed-form start, each with the weights of the one before", UNMEASURED;
        LEAST: f64 = 1e-3, "least share of carrier and proof body that the carrier starts with", UNMEASURED;
        ROUNDS: usize = 60, "rounds of Gauss's and Newton's method; three to six do", UNMEASURED;
        HALVINGS: usize = 30, "halvings of a step that does not lower the squares", UNMEASURED;
        NEAR: f64 = 0.1, "standard deviations of a step that is taken as it is", UNMEASURED;
        STILL: f64 = 1e-6, "standard deviations by which a further round may still move the answer", UNMEASURED;
        HELD: f64 = 1e-6, "share of the trace within which a triangle inequality counts as an equality", UNMEASURED;
        PARALLEL: f64 = 1e-9, "angle between two axes of one wheel that rounding makes, rad", DERIVED;
        CONTRADICTED: f64 = 4.753_424_308_822_899,
            "deviations of a normal number with a chance of 1e-6: records contradict each other", DERIVED;
    }
    bound: "the Cramér–Rao bound" {
        STEPS: usize = 12, "steps towards the motion nearest to one window", UNMEASURED;
        STILL: f64 = 0.01, "fall of the sum of squares, over the variance, that no longer matters", UNMEASURED;
        DAMPING: f64 = 1e-4, "first damping of a step that does not help", UNMEASURED;
        CHANGE: f64 = 10.0, "factor by which damping grows; its tenth is that by which it falls", UNMEASURED;
        STARTS: [(f64, f64); 6] = [(0.5, 1.0), (0.25, 1.0), (0.75, 1.0), (0.5, 2.0), (0.25, 2.0), (0.75, 2.0)],
            "where to start, over the samples, and the first radius, rad", "the_bound_of_random_records_is_that_of_their_motion";
        WIDTH: f64 = 0.1, "duration of the samples that the search sees as one, rad", UNMEASURED;
        LEFT: f64 = 0.05,
            "share of what noise does not explain that a motion may leave", "where_no_free_motion_explains_the_samples_there_is_no_bound";
        SURE: f64 = 5.0, "standard deviations of the sum of squares that it may leave beside", DERIVED;
        STEP: f64 = 0.1,
            "longest step of the integrator for a free motion, rad: errors of order 1e-6", "the_bound_is_that_of_the_exact_motion";
        PARTS: f64 = 100.0, "most such steps between two samples", UNMEASURED;
        STEP_OF_PLAN: f64 = 0.05,
            "the same for a motion under torques: errors of order 1e-7", "the_bound_of_a_plan_is_that_of_differences";
        PARTS_OF_PLAN: f64 = 1000.0, "most such steps between two samples", UNMEASURED;
        OPEN: f64 = 1e-12, "relative eigenvalue of the information that is rounding", DERIVED;
    }
    likelihood: "the likelihood on the exact motion" {
        NODE: f64 = 1.0, "turn within the samples of a local rate, rad", UNMEASURED;
        FEWEST: usize = 3, "fewest samples of a local rate: those of a parabola", DERIVED;
        LEAST_SHARE: f64 = 0.1,
            "share of the smallest eigenvalue of the equations of the momentum that stays where noise is taken off", UNMEASURED;
        SMALLEST: f64 = 0.02, "smallest moment of a first tensor, as a share of the trace", UNMEASURED;
        FIRST: f64 = 1.0, "first window, rad to either side of the middle of a stretch", UNMEASURED;
        SAMPLES: usize = 4, "fewest samples of a stretch in it", UNMEASURED;
        PULL: f64 = 0.1, "deviation of the first tensor, over the trace, in all windows but the last", UNMEASURED;
        HELD: f64 = 1e16, "information on a tensor that is held", DERIVED;
        BEYOND: f64 = 4.0, "deviations beyond which the size of a residual counts in place of its square", UNMEASURED;
        OUTLIER: f64 = 6.0, "deviations beyond which a reading is left out: a chance of 7e-8", DERIVED;
        SHARE_KEPT: f64 = 0.5, "share of the known noise below which the median of the residuals is not believed", UNMEASURED;
        ROUNDS: usize = 6, "rounds of noise and outliers", UNMEASURED;
        SAME: f64 = 0.01, "relative change of the noise that no longer matters", UNMEASURED;
        STEPS: usize = 400, "most steps in one window: near steady spins it takes a hundred, elsewhere some four", "near_steady_spins_are_answered_rightly_or_refused";
        LOOK: usize = 20, "steps after which the search is checked for progress", UNMEASURED;
        CREEP: f64 = 0.5, "fall of chi squared in as many steps that counts as progress", UNMEASURED;
        STILL: f64 = 1e-4, "fall of chi squared that no longer matters", UNMEASURED;
        DAMPING: f64 = 1e-3, "first damping of a step that does not help", UNMEASURED;
        CHANGE: f64 = 10.0, "factor by which damping grows and falls", UNMEASURED;
        MOST_DAMPING: f64 = 1e9, "damping beyond which no step helps", UNMEASURED;
        PANEL: f64 = 0.2, "longest step of the integral of a torque, rad", UNMEASURED;
        SMALL: f64 = 1e-3, "drag times time below which a series is nearer than the closed form", DERIVED;
        SPARSE: f64 = 0.628_318_530_717_958_6,
            "median turn from one sample to the next, rad, from which on rates are sparse: a tenth of a turn", "sparse_telemetry_goes_to_the_likelihood";
        LINEAR: f64 = 0.1,
            "largest turn by a constant torque, rad, up to which it is reckoned with to first order", UNMEASURED;
        ALIKE: f64 = 0.25, "turn within the samples of one mean where the profile of a weak estimate is asked for, rad", UNMEASURED;
        MEANS: usize = 200, "fewest such means, where there are as many samples", UNMEASURED;
        MOST: usize = 3_000, "most of them", UNMEASURED;
        SEARCHES: usize = 4,
            "searches one after the other for its likeliest tensor, along a path that bends", "deviations_next_to_a_steady_spin_hold";
        SURE: f64 = 5e-3, "deviation of the tensor, over the trace, from which on a second search starts from the sphere", UNMEASURED;
        NARROW: f64 = 2e-3, "deviation along an axis of the ellipsoid, over the trace, up to which the likelihood is taken for quadratic", UNMEASURED;
        END: f64 = 4.529_349_363_035_798,
            "deviations at which the likelihood is compared with its quadratic form: where the 99.9 % ellipsoid of five numbers ends", DERIVED;
        QUADRATIC: f64 = 0.75, "share of the fall of the quadratic form there up to which deviations are those of the likelihood itself", UNMEASURED;
        STRAIGHT: f64 = 1.0, "fall of twice the log-likelihood, by the quadratic form, that the bend of a profile makes up to where it counts as straight", "near_steady_spins_are_answered_rightly_or_refused";
        PARTED: f64 = 4.0,
            "difference of the fall of twice the log-likelihood to a tensor within the law, and half of it, from that of the quadratic form, from which on there is no answer", UNMEASURED;
        HIGHER: f64 = 0.1, "rise of twice the log-likelihood that is another maximum", UNMEASURED;
        STRIDE: f64 = 1.5, "factor from one point of a profile to the next", UNMEASURED;
        FARTHEST: f64 = 0.5, "displacement of the tensor, over the trace, beyond which no profile is walked: tensors differ by 0.4 at most", DERIVED;
        CONSTANT: f64 = 0.3,
            "largest change of the momentum of wheels that counts as none, in the rates and in deviations of the noise over the root of the number of samples", UNMEASURED;
        DIFFERENCE: f64 = 1e-4,
            "step of the differences of the motion with wheels, over the turn of the stretch: errors of order 1e-9", DERIVED;
        LIGHT: f64 = 1e-3, "inertia of the wheel of the motion that is followed, over the smallest moment: any", DERIVED;
        TOGETHER: f64 = 30.0,
            "square of the distance of the likeliest tensor with wheels from the weak estimate, in deviations of that, beyond which the weak one counts", UNMEASURED;
        FIXED: f64 = 1e8, "information on a number that is fixed, over its own", DERIVED;
        MIRRORED: f64 = 0.05,
            "share of the largest singular value that the smallest has where rates are the mirror image of attitudes", "a_turn_is_found_and_a_mirror_is_seen";
    }
    smoothed: "attitudes under torques" {
        STEP: f64 = 0.03, "longest step of the integrator, rad: errors of order 1e-9 a radian", "motions_are_those_of_the_closed_forms";
        PARTS: f64 = 1000.0, "most of them between two samples", UNMEASURED;
        ALONE: f64 = 0.5, "turn within which samples tell of each other where the search begins, rad", UNMEASURED;
        ROUNDS: usize = 40, "most rounds of filter and smoother; some ten do", UNMEASURED;
        DECADES: usize = 14, "decades of torque noise that are tried", UNMEASURED;
        WALKS: f64 = 10.0, "gain of twice the log-likelihood by torque noise from which on a closed form is given up: noise brings it once in 1,000 records", DERIVED;
    }
    poses: "records of attitudes" {
        GAP: f64 = 8.0, "median intervals that make a gap", UNMEASURED;
        JUMP: f64 = 8.0, "median turns beyond which a single attitude lies off both neighbours", "a_bad_frame_is_a_jump_and_a_turn_is_none";
        FEWEST: usize = 8, "fewest attitudes of a segment: 24 numbers for 11 unknowns", UNMEASURED;
        HALF_TURN: f64 = 2.83, "largest turn from one attitude to the next, rad: nine tenths of half a turn", UNMEASURED;
        COARSE: f64 = 0.3, "largest turn between neighbours up to which their differences tell the noise, rad", UNMEASURED;
        DOUBTFUL: f64 = 1.571, "largest turn between neighbours from which on a warning says what it rests on, rad", UNMEASURED;
        STILL: f64 = 5.0,
            "deviations of the noise that the turn of the whole record must exceed; the same number of times the scatter of all readings is that of differences of neighbours", UNMEASURED;
        SAME_SIZE: f64 = 1.25, "factor within which rates and those of the attitudes are the same", UNMEASURED;
        OPEN: f64 = 10.0, "difference of log-likelihood up to which both directions explain a record", UNMEASURED;
        TURNS: usize = 6, "most rounds in which samples of axes that move are turned back; two or three do", UNMEASURED;
        REST: f64 = 0.01, "gain of log-likelihood by a further turn that no longer matters", UNMEASURED;
        MOVING: f64 = 15.0, "gain of log-likelihood from which axes are said to move against each other, and a torque without a model to act: a chance of 1e-6", DERIVED;
        SCALED: f64 = 12.0, "the same of an error of the scale of rates beside attitudes, which is one coefficient in place of three: a chance of 1e-6", DERIVED;
    }
    flights: "flights in a recording" {
        SLOW: f64 = 0.1, "rate below which the body counts as held, over the rate of its motion", UNMEASURED;
        NOISE_OF_SLOPE: f64 = 0.4,
            "largest tr J^2 of the share that the derivative of a test has in the noise", DERIVED;
        NOISE_OF_VALUE: f64 = 0.3, "the same of the test itself, per squared rate", DERIVED;
        NOISE_DEVIATIONS: f64 = 2.0, "deviations of the noise that a residual may have", UNMEASURED;
        WINDOW: usize = 12, "tests of a window", UNMEASURED;
        STRIDE: usize = 2, "tests by which the next window begins later", UNMEASURED;
        MOST_TORQUE: f64 = 0.02,
            "torque of a free window that drag does not explain, over tr(J) |w|^2", "each_throw_of_a_recording_is_found_and_nothing_else";
        OTHERS: f64 = 0.1,
            "turn of a span with another tensor, over that of the longest flight, from which on it is named", UNMEASURED;
        DRAG: f64 = 0.03, "deviation of the drag that is expected: momentum lost in a turn by one radian", UNMEASURED;
        TRIED: usize = 100, "windows whose tensors are tried", UNMEASURED;
        JUDGES: usize = 5_000, "windows on which they are tried", UNMEASURED;
        REFINEMENTS: usize = 4, "refinements of a tensor by the windows that agree with it", UNMEASURED;
        BEYOND: f64 = 0.03, "share of the trace by which a tensor of short windows may break the law", UNMEASURED;
        GROSS: f64 = 0.3,
            "largest torque of a record that is free as a whole, over tr(J) |w|^2", "a_free_record_is_one_flight_and_stays_as_it_is";
        SURE: f64 = 3.0, "deviations of the noise beyond which a residual counts", UNMEASURED;
        LASTING: usize = 4, "tests in a row for which it must, and those of a rest", UNMEASURED;
        FAST: f64 = 0.5,
            "rate of a window before or after a rest that no free body has, over the rate of the motion", "free_rates_vary_by_less_than_the_root_of_two";
        FALL: usize = 4, "tests between the two, of which four are a turn by one radian", UNMEASURED;
        COMMON_TORQUE: f64 = 0.05, "residual that counts in full towards the tensor of a whole record", UNMEASURED;
        REWEIGHTED: usize = 3, "rounds of reweighting of a whole record", UNMEASURED;
    }
    extent: "the ends of a flight" {
        COMMON: f64 = 100.0, "precision of the common tensor in the fit of one flight", UNMEASURED;
        USUAL: f64 = 4.0, "medians of the residuals of a flight that one of its own may reach", UNMEASURED;
        NOISE: f64 = 1.5, "deviations of the noise that it may reach beside", UNMEASURED;
        ENDS: f64 = 0.35, "share of a flight within which an end of it is sought", "flights_reach_the_ends_of_segments";
        ROUNDS: usize = 6, "rounds of trimming and fitting", UNMEASURED;
        FEWEST: usize = 4, "fewest tests of a flight", UNMEASURED;
        BESIDE: usize = 8, "tests next to an end that tell why it is one", UNMEASURED;
    }
    simulate: "simulated motions" {
        IMPULSES: usize = 4, "impulses of the noise of a torque for each sample", "white_torque_makes_a_ball_walk";
        TERMS: usize = 24,
            "terms of the power series in time", "relative_drag_is_free_motion_on_a_clock_that_slows_down";
        TERMS_OF_IMPULSES: usize = 10, "the same between impulses, which are near one another", UNMEASURED;
        LAST_TERM: f64 = 1e-17,
            "last term over the momentum, where a step ends", "relative_drag_is_free_motion_on_a_clock_that_slows_down";
        STEPS: usize = 1000,
            "steps for each sample after which a motion is too fast", "what_cannot_be_simulated_is_refused_by_name";
    }
}

#[cfg(test)]
mod tests;
