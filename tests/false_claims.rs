//! False claims are named, and nothing else: methods, forces and schemes that say what they do not do.

use nalgebra::Vector3;
use polhode::body::{Body, Clock, Conserved, Field, Force, Point, Potential, Problem, Rotor, Time};
use polhode::inertia::Inertia;
use polhode::laws::{
    Finding, Law, Quantity, Report, Verdict, check, check_cost, check_force, check_only, check_scheme,
};
use polhode::method::schemes::{self, Scheme, Stages};
use polhode::method::{
    AnyMethod, Buss, Claimed, Claims, Cost, Dmv, Energy, Kept, Kicks, Map, Method, Rk4, Splitting, Step,
    StepError, TwoTurn, method,
};
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3};

/// A method with claims of another's making.
#[derive(Clone)]
struct Claiming<M> {
    base: M,
    change: fn(&mut Claims),
}

impl<M: Claimed> Claimed for Claiming<M> {
    fn name(&self) -> String {
        format!("false-{}", self.base.name())
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let mut claims = self.base.claims(problem)?;
        (self.change)(&mut claims);
        Some(claims)
    }
}

impl<S: Real, M: Method<S>> Method<S> for Claiming<M> {
    type Map<F: Field<S>> = M::Map<F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> M::Map<F> {
        self.base.map(h, rotor, field)
    }
}

const RK4: Rk4 = Rk4 { normalized: false };

/// Laws and quantities of the false claims, each once, in the order of the report.
fn found(report: &Report) -> Vec<(Law, Quantity)> {
    let mut found: Vec<(Law, Quantity)> = Vec::new();
    for Finding { law, quantity, .. } in report.false_claims() {
        if !found.contains(&(*law, *quantity)) {
            found.push((*law, *quantity));
        }
    }
    found
}

/// All laws of one kind of motion.
fn checked_in(problem: Problem, method: &dyn AnyMethod) -> Report {
    let report = check_only(method, &[problem], Law::ALL).unwrap();
    assert!(report.to_string().lines().all(|line| line.chars().count() <= 80), "{report}");
    report
}

fn checked(method: &dyn AnyMethod) -> Report {
    checked_in(Problem::Free, method)
}

#[test]
fn an_order_that_is_not_reached_is_named() {
    let report = checked(&Claiming { base: Buss { augmented: false }, change: |c| c.order = Some(4) });
    assert_eq!(found(&report), [(Law::Order, Quantity::Attitude), (Law::Order, Quantity::Momentum)]);
    let measured = report.false_claims().next().unwrap().measured.unwrap();
    assert!((measured - 2.0).abs() < 0.05, "{report}");
}

/// The reversibility follows from the claimed symmetry.
#[test]
fn a_symmetry_that_is_none_is_named() {
    let report = checked(&Claiming { base: RK4, change: |c| c.symmetric = true });
    assert_eq!(found(&report), [(Law::Symmetry, Quantity::State), (Law::Reversibility, Quantity::State)]);
}

#[test]
fn a_bracket_that_is_not_kept_is_named() {
    let report = checked(&Claiming { base: RK4, change: |c| c.poisson = true });
    assert_eq!(found(&report), [(Law::Poisson, Quantity::Bracket)]);
}

#[test]
fn a_form_that_is_not_kept_is_named() {
    let report = checked(&Claiming { base: RK4, change: |c| c.symplectic = true });
    assert_eq!(found(&report), [(Law::Symplectic, Quantity::Form)]);
}

#[test]
fn an_energy_that_drifts_is_named() {
    let report = checked(&Claiming { base: RK4, change: |c| c.kept.energy = Energy::Exact });
    assert_eq!(found(&report), [(Law::Conserved, Quantity::Energy)]);
    let finding = report.false_claims().next().unwrap();
    assert!(finding.drift.unwrap().is_secular() && finding.measured.unwrap() > 1e-9, "{report}");
    let report = checked(&Claiming { base: RK4, change: |c| c.kept.energy = Energy::Bounded });
    assert_eq!(found(&report), [(Law::Drift, Quantity::Amplitude), (Law::Drift, Quantity::Energy)]);
}

#[test]
fn a_momentum_that_is_lost_is_named() {
    let report = checked(&Claiming { base: RK4, change: |c| c.kept.momentum_space = true });
    assert_eq!(found(&report), [(Law::Conserved, Quantity::MomentumSpace)]);
    let report = checked(&Claiming { base: RK4, change: |c| c.kept.momentum_norm = true });
    assert_eq!(found(&report), [(Law::Conserved, Quantity::MomentumNorm)]);
}

#[test]
fn a_norm_that_is_lost_is_named() {
    let report = checked(&Claiming { base: RK4, change: |c| c.kept.norm = true });
    assert_eq!(found(&report), [(Law::Conserved, Quantity::Norm)]);
}

#[test]
fn a_cost_that_is_too_low_is_named() {
    let report =
        checked_in(Problem::Potential, &Claiming { base: RK4, change: |c| c.cost = Cost::right_sides(3) });
    assert_eq!(found(&report), [(Law::Cost, Quantity::Torques)]);
    assert_eq!(report.false_claims().next().unwrap().measured, Some(4.0));
    let base = Splitting::strang(TwoTurn { axes: None }, Kicks);
    let report = check_cost(&Claiming { base, change: |c| c.cost = c.cost + Cost::turns(1) });
    assert_eq!(found(&report.unwrap()), [(Law::Cost, Quantity::Turns)]);
}

/// The discrete Moser–Veselov step, and a factor that is 1 but for the rounding of a double.
#[derive(Clone)]
struct Biased;

struct BiasedMap<S, M> {
    dmv: M,
    factor: S,
}

impl Claimed for Biased {
    fn name(&self) -> String {
        "biased".into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        method("rattle").unwrap().claims(problem).filter(|_| problem == Problem::Free)
    }
}

impl<S: Real> Method<S> for Biased {
    type Map<F: Field<S>> = BiasedMap<S, <Dmv as Method<S>>::Map<F>>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Self::Map<F> {
        let factor = S::from_dd(Dd::ONE / 49.0) * S::of(49.0);
        BiasedMap { dmv: Dmv.map(h, rotor, field), factor }
    }
}

impl<S: Real, M: Map<S>> Map<S> for BiasedMap<S, M> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.dmv.apply(at, x);
        x.momentum_body = x.momentum_body * self.factor;
    }
}

#[test]
fn a_bias_of_rounding_is_named() {
    let report = checked(&Biased);
    assert_eq!(found(&report), [(Law::Rounding, Quantity::Energy), (Law::Rounding, Quantity::MomentumNorm)]);
}

/// Nothing is claimed of rk4 with a unit quaternion but its order, and |q| is kept.
#[test]
fn what_holds_unclaimed_is_shown_and_is_no_false_claim() {
    let report = checked(&Claiming { base: Rk4 { normalized: true }, change: |c| c.kept = Kept::NOTHING });
    assert_eq!(report.false_claims().count(), 0);
    let unclaimed: Vec<_> = report.unclaimed().map(|finding| (finding.law, finding.quantity)).collect();
    assert_eq!(unclaimed, [(Law::Conserved, Quantity::Norm)]);
}

/// Claims to take everything, and prepares nothing.
#[derive(Clone)]
struct Refusing;

impl Claimed for Refusing {
    fn name(&self) -> String {
        "refusing\tall\n".into()
    }
    fn claims(&self, _: Problem) -> Option<Claims> {
        Some(Claims::new(Some(1), Kept::NOTHING, Cost::right_sides(1), ""))
    }
}

impl AnyMethod for Refusing {
    fn prepare_f64(&self, clock: Clock, _: &Body) -> Result<Box<dyn Step<f64>>, StepError> {
        Err(StepError::NotAStep { h: clock.step })
    }
    fn prepare_dd(&self, clock: Clock, _: &Body) -> Result<Box<dyn Step<Dd>>, StepError> {
        Err(StepError::NotAStep { h: clock.step })
    }
    fn prepare_part(&self, _: Clock, h: Dd, _: &Body) -> Result<Box<dyn Step<f64>>, StepError> {
        Err(StepError::NotAStep { h: h.hi() })
    }
    fn boxed(&self) -> Box<dyn AnyMethod> {
        Box::new(self.clone())
    }
}

#[test]
fn a_method_that_refuses_what_it_claims_to_take_is_named() {
    let report = check(&Refusing).unwrap();
    assert_eq!(found(&report), [(Law::Takes, Quantity::Method)]);
    assert_eq!(report.findings.len(), 6);
    assert_eq!(report.text().parse(), Ok(report));
}

/// Refuses to go backwards.
#[derive(Clone)]
struct OneWay(Box<dyn AnyMethod>);

impl Claimed for OneWay {
    fn name(&self) -> String {
        "one-way".into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        self.0.claims(problem)
    }
}

impl AnyMethod for OneWay {
    fn prepare_f64(&self, clock: Clock, body: &Body) -> Result<Box<dyn Step<f64>>, StepError> {
        if clock.step < 0.0 {
            Err(StepError::NotAStep { h: clock.step })
        } else {
            self.0.prepare_f64(clock, body)
        }
    }
    fn prepare_dd(&self, clock: Clock, body: &Body) -> Result<Box<dyn Step<Dd>>, StepError> {
        if clock.step < 0.0 {
            Err(StepError::NotAStep { h: clock.step })
        } else {
            self.0.prepare_dd(clock, body)
        }
    }
    fn prepare_part(&self, clock: Clock, h: Dd, body: &Body) -> Result<Box<dyn Step<f64>>, StepError> {
        self.0.prepare_part(clock, h, body)
    }
    fn boxed(&self) -> Box<dyn AnyMethod> {
        Box::new(self.clone())
    }
}

#[test]
fn a_law_that_a_refused_step_leaves_open_is_undecided() {
    let report = checked(&OneWay(method("rattle").unwrap()));
    assert_eq!(report.false_claims().count(), 0, "{report}");
    let open = report.undecided().find(|finding| finding.law == Law::Symmetry).unwrap();
    assert!(open.why.contains("step -0.125 is not usable"), "{report}");
}

#[test]
fn a_method_that_refuses_a_motion_claims_nothing_of_it() {
    let report = check_only(&method("exact-step").unwrap(), &[Problem::Torque], Law::ALL).unwrap();
    assert_eq!((report.findings.len(), report.with(Verdict::Holds).count()), (1, 1));
}

/// Leaves no number.
#[derive(Clone)]
struct NotANumber;

struct NotANumberMap;

impl Claimed for NotANumber {
    fn name(&self) -> String {
        "not-a-number".into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let all = Kept::all_of_free_motion(Energy::Exact);
        (problem == Problem::Free).then(|| Claims::new(Some(2), all, Cost::turns(1), ""))
    }
}

impl<S: Real> Method<S> for NotANumber {
    type Map<F: Field<S>> = NotANumberMap;
    fn map<F: Field<S>>(&self, _: Dd, _: &Rotor, _: &F) -> NotANumberMap {
        NotANumberMap
    }
}

impl<S: Real> Map<S> for NotANumberMap {
    fn apply(&mut self, _: Time, x: &mut Point<S>) {
        x.momentum_body = Vec3::of(Vec3([f64::NAN; 3]));
        x.attitude = Quat::of(Quat::from_components([f64::NAN; 4]));
    }
}

#[test]
fn numbers_that_are_none_keep_nothing() {
    let report = check(&NotANumber).unwrap();
    println!("{report}");
    for quantity in [Quantity::Energy, Quantity::MomentumSpace, Quantity::MomentumZ, Quantity::Norm] {
        assert!(found(&report).contains(&(Law::Conserved, quantity)), "{report}");
    }
    assert!(found(&report).contains(&(Law::Order, Quantity::Attitude)));
    let decided = report.with(Verdict::Holds).filter(|finding| finding.law != Law::Takes);
    assert_eq!(decided.count(), 0, "{report}");
    assert_eq!(report.text().parse(), Ok(report));
}

#[test]
fn coefficients_that_are_not_of_their_order_make_no_scheme() {
    // a wrong digit in the third place
    let Stages::Composition([first, second]) = schemes::SUZUKI_4.stages() else { panic!("two lengths") };
    let wrong: &[Dd] = Box::leak(Box::new([*first + Dd::of(1e-3), *second]));
    assert!(Scheme::new("wrong", 4, Stages::Composition(wrong), "").is_err());
    for order in [0, 3, u32::MAX] {
        assert!(Scheme::new("strang", order, schemes::STRANG.stages(), "").is_err(), "{order}");
    }
    assert_eq!(check_scheme(&schemes::SUZUKI_4).unwrap().false_claims().count(), 0);
}

/// A spring whose law says what it does not do.
struct Spring {
    torque: f64,
    conserved: Vec<Conserved>,
}

impl<S: Real> Potential<S> for Spring {
    fn energy(&self, _: Time, attitude: Quat<S>) -> S {
        // pulled along x of space, so that L_z is not kept
        S::of(0.5) * (S::of(1.0) - attitude.rotate(Vec3::unit(2))[0])
    }
    fn torque(&self, _: Time, attitude: Quat<S>) -> Vec3<S> {
        Vec3::unit(2).cross(attitude.rotate_back(Vec3::unit(0))) * S::of(self.torque)
    }
    fn conserved(&self) -> Vec<Conserved> {
        self.conserved.clone()
    }
}

#[test]
fn what_a_force_does_not_keep_is_named() {
    let inertia = Inertia::from_moments([1.0, 2.0, 2.5]).unwrap();
    let of = |torque, conserved: &[Conserved]| {
        let spring = Spring { torque, conserved: conserved.to_vec() };
        let report = check_force(&Force::potential("spring", spring), &inertia).unwrap();
        println!("{report}");
        report
    };
    let right = of(0.5, &[Conserved::Energy]);
    assert!(right.findings.iter().all(|finding| finding.verdict == Verdict::Holds), "{right}");
    let wrong = of(0.501, &[Conserved::Energy]);
    assert_eq!(found(&wrong), [(Law::Gradient, Quantity::Torque), (Law::Conserved, Quantity::Energy)]);
    let wrong = of(0.5, &[Conserved::Energy, Conserved::MomentumZ]);
    assert_eq!(found(&wrong), [(Law::Conserved, Quantity::MomentumZ)]);
    let modest = of(0.5, &[]);
    assert_eq!(modest.unclaimed().map(|finding| finding.quantity).collect::<Vec<_>>(), [Quantity::Energy]);
}

/// Of a molecule as of an asteroid, a spring that turns it slowly or fast.
#[test]
fn no_size_of_a_body_is_special() {
    for (size, stiffness) in [(1e-47, 1e-20), (1e-47, 1e-60), (1e33, 1e10), (1e33, 1e40)] {
        let inertia = Inertia::from_moments([1.0, 2.0, 2.5].map(|i| i * size)).unwrap();
        let force = |torque: f64| {
            Force::potential_fn(
                "spring",
                move |q| stiffness * (1.0 - (q * Vector3::z()).x),
                move |q| torque * Vector3::z().cross(&(q.inverse() * Vector3::x())),
            )
        };
        let right = check_force(&force(stiffness), &inertia).unwrap();
        assert!(right.findings.iter().all(|finding| finding.verdict == Verdict::Holds), "{right}");
        let wrong = check_force(&force(1.01 * stiffness), &inertia).unwrap();
        assert!(found(&wrong).contains(&(Law::Gradient, Quantity::Torque)), "{wrong}");
    }
}

#[test]
fn closures_are_measured_to_the_digits_of_a_double() {
    let inertia = Inertia::from_moments([1.0, 2.0, 2.5]).unwrap();
    let spring = |torque: f64, zero: f64| {
        let force = Force::potential_fn(
            "spring",
            move |q| 0.5 * (1.0 - (q * Vector3::z()).x) / zero,
            move |q| torque * Vector3::z().cross(&(q.inverse() * Vector3::x())),
        );
        check_force(&force, &inertia).unwrap()
    };
    let right = spring(0.5, 1.0);
    assert!(right.findings.iter().all(|finding| finding.verdict == Verdict::Holds), "{right}");
    assert!(found(&spring(0.501, 1.0)).contains(&(Law::Gradient, Quantity::Torque)));
    assert_eq!(found(&spring(0.5, 0.0)), [(Law::Finite, Quantity::Energy)]);
    let drag = check_force(&Force::drag(0.1, 0.0).unwrap(), &inertia).unwrap();
    assert!(drag.findings.iter().all(|finding| finding.verdict == Verdict::Holds), "{drag}");
}

#[test]
fn a_report_is_text_and_back() {
    let report = check_only(&RK4, &[Problem::Linear], &[Law::Conserved, Law::Cost, Law::Drift]).unwrap();
    assert_eq!(report.text().parse(), Ok(report.clone()));
    let broken = report.text().replace("holds", "unsure");
    let error = broken.parse::<Report>().unwrap_err();
    assert!(error.to_string().contains("it should hold motion, law"), "{error}");
    assert_eq!("".parse::<Report>().unwrap_err().line, 1);
    assert_eq!("polhode laws 1".parse::<Report>().unwrap_err().line, 2);
}

/// A method whose momenta shrink at a rate of 1/s, which it says nothing of.
#[derive(Clone)]
struct Damped<M> {
    base: M,
    rate: f64,
}

struct DampedMap<S, M> {
    base: M,
    factor: S,
}

impl<M: Claimed> Claimed for Damped<M> {
    fn name(&self) -> String {
        format!("damped-{}", self.base.name())
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        self.base.claims(problem)
    }
}

impl<S: Real, M: Method<S>> Method<S> for Damped<M> {
    type Map<F: Field<S>> = DampedMap<S, M::Map<F>>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Self::Map<F> {
        let factor = S::from_dd(Dd::ONE - h * self.rate);
        DampedMap { base: self.base.map(h, rotor, field), factor }
    }
}

impl<S: Real, M: Map<S>> Map<S> for DampedMap<S, M> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.base.apply(at, x);
        x.momentum_body = x.momentum_body * self.factor;
    }
}

/// Over 250 s the energy falls by about the amplitude of its oscillation; the law decides from a fifth of it on.
#[test]
fn a_slow_loss_of_energy_under_forces_is_named() {
    let drifts = |rate: f64, problem| {
        let damped = Damped { base: Splitting::strang(TwoTurn { axes: None }, Kicks), rate };
        let report = check_only(&damped, &[problem], &[Law::Drift]).unwrap();
        found(&report).contains(&(Law::Drift, Quantity::Energy))
    };
    for problem in [Problem::Free, Problem::Linear, Problem::Potential] {
        assert!(drifts(1e-6, problem) && !drifts(0.0, problem), "{problem:?}");
    }
}
