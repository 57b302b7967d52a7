//! A body and what acts on it, with the conversions between a user's axes and the solver frame.

use nalgebra::{UnitQuaternion, Vector3};

use super::field::{Field, Forces, Witness};
use super::law::Evaluated;
use super::wheel::{OnCarrier, Wheel, WheelAtStart, WheelError, Wheels};
use super::{Conserved, Exit, Force, LinearPotential, Point, Rotor, State, StateError, Time};
use crate::inertia::Inertia;
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// Kinds of motion, by what acts on the body; the claims of a method differ between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Problem {
    /// Nothing acts.
    Free,
    /// A potential that is [linear](LinearPotential) in the vertical, as that of uniform gravity about a fixed point.
    Linear,
    /// Torques that come from potentials.
    Potential,
    /// The body carries [wheels](Wheel), and nothing else acts.
    Gyrostat,
    /// The body carries wheels, and torques that come from potentials act.
    GyrostatPotential,
    /// Any torque.
    Torque,
}

impl Problem {
    /// All of them, in the order of reports.
    pub const ALL: &[Problem] = &[
        Problem::Free,
        Problem::Linear,
        Problem::Potential,
        Problem::Torque,
        Problem::Gyrostat,
        Problem::GyrostatPotential,
    ];
}

/// A rigid body, the [wheels](Wheel) that it carries and the [forces](Force) that act on it, if any.
///
/// A user's [`State`] refers to the body axes that the inertia was given in. Kernels work on a [`Point`] in the solver
/// frame: along principal axes, with moments and momenta divided by a power of two, so that fourth powers neither over- nor
/// underflow and a change of the unit of mass by a power of two changes no bit. [`enter`](Body::enter) and
/// [`leave`](Body::leave) convert between the two. The momentum of both is that of the carrier, I ω;
/// [`momentum_space`](Self::momentum_space) adds that of wheels.
///
/// ```
/// use polhode::body::{Body, Problem};
/// use polhode::inertia::Inertia;
/// let inertia = Inertia::from_moments([1.0, 2.0, 3.0])?;
/// let body = Body::free(inertia.clone());
/// let start = body.state(Default::default(), [0.0, 0.0, 2.0].into())?;
/// assert!((body.energy(&start) - 6.0).abs() < 1e-14); // ½ I ω²
/// let top = Body::heavy(inertia, [0.0, 0.0, 1.0].into())?;
/// assert_eq!([body.problem(), top.problem()], [Problem::Free, Problem::Linear]);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct Body {
    inertia: Inertia,
    /// The inertia as it was given, where wheels turn freely, which the other is without.
    locked: Option<Inertia>,
    wheels: Vec<Wheel>,
    forces: Vec<Force>,
    /// The sum of those that are linear in the vertical, in the solver frame.
    linear: Option<LinearPotential<Dd>>,
    witness: Option<Witness>,
}

impl Body {
    /// A body on which no torque acts.
    pub fn free(inertia: Inertia) -> Self {
        let (forces, wheels) = (Vec::new(), Vec::new());
        Body { inertia, locked: None, wheels, forces, linear: None, witness: None }
    }

    /// A body with a fixed point, the origin, under uniform gravity along −Z of space.
    ///
    /// `inertia` is about the fixed point; `weight_moment` is the weight M g times the centre of mass, N m, in body
    /// axes: [`Force::gravity`], checked beside the inertia. Without weight moment the body is free.
    ///
    /// # Errors
    /// Components that are not finite, or a size that is out of range beside the inertia.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::Body;
    /// use polhode::inertia::Inertia;
    /// let top = Body::heavy(Inertia::from_moments([1.0, 1.0, 0.25])?, Vector3::new(0.0, 0.0, 2.0))?;
    /// let start = top.state(UnitQuaternion::identity(), Vector3::new(0.0, 0.0, 4.0))?;
    /// assert_eq!(top.energy(&start), 4.0); // 2 J of spin, 2 J of height
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn heavy(inertia: Inertia, weight_moment: Vector3<f64>) -> Result<Self, StateError> {
        let given = Vec3::from(weight_moment);
        check("weight moment", &given.0)?;
        let body = Body::free(inertia);
        if given != Vec3::zero() && !body.has_in_range(given) {
            let (weight_moment, moment) = (given.magnitude(), body.scale());
            return Err(StateError::WeightOutOfRange { weight_moment, moment });
        }
        let not_finite = |_| StateError::NotFinite { quantity: "weight moment", value: given.magnitude() };
        Ok(body.with(Force::gravity(weight_moment).map_err(not_finite)?))
    }

    /// The same body with one more force; all add up.
    ///
    /// The gravity gradient takes the inertia of this body. A linear potential whose moment is too large or too small beside the
    /// inertia for the solver frame acts as any potential does.
    pub fn with(mut self, force: Force) -> Self {
        let given = force.linear_moment();
        if given == Some(Vec3::zero()) {
            return self;
        }
        if let Some(given) = given.filter(|given| self.has_in_range(*given)) {
            let scaled = given.map(|c| c / self.scale());
            let moment = self.inertia.frame().rotate_back(Vec3::of(scaled));
            let moment = self.linear.map_or(moment, |linear| linear.moment + moment);
            self.linear = (moment != Vec3::zero()).then_some(LinearPotential { moment });
        }
        let locked = self.locked_inertia();
        self.forces.push(force.on(locked));
        self
    }

    /// The same body with one more wheel. Its [inertia](Self::locked_inertia) includes that of the wheel, at rest on the body.
    ///
    /// # Errors
    /// A wheel with so large a moment of inertia that no body is left without it.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::body::{Body, Wheel};
    /// use polhode::Inertia;
    /// let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5])?);
    /// let wheel = |inertia| Wheel::new(Vector3::x(), inertia, 50.0);
    /// assert!(body.clone().with_wheel(wheel(0.1)?).is_ok());
    /// assert!(body.with_wheel(wheel(0.6)?).is_err()); // 0.4, 2 and 2.5 kg m² without it: no body
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn with_wheel(mut self, wheel: Wheel) -> Result<Self, WheelError> {
        let locked = self.locked_inertia().clone();
        self.wheels.push(wheel);
        let without = |held: bool| {
            let axial = self.wheels.iter().filter(|wheel| held || !wheel.is_held());
            locked.less_axial(axial.map(|wheel| (wheel.axis_dd(), wheel.inertia())))
        };
        let inertia = without(true).and_then(|_| without(false)).map_err(|rest| {
            let about_axis = wheel.axis().dot(&(locked.tensor() * wheel.axis()));
            WheelError::TooLarge { inertia: wheel.inertia(), about_axis, rest }
        })?;
        if self.wheels.iter().any(|wheel| !wheel.is_held()) {
            (self.inertia, self.locked) = (inertia, Some(locked));
        }
        Ok(self.changed(|wheel| *wheel, |force| Some(force.clone())))
    }

    /// The same body with `wheels`, from a start at the time `t`, s, where it turns at `omega_body`, rad/s, body axes.
    ///
    /// # Errors
    /// As of [`with_wheel`](Self::with_wheel).
    pub fn with_wheels_at_start(
        self,
        wheels: &[WheelAtStart],
        t: f64,
        omega_body: Vector3<f64>,
    ) -> Result<Self, WheelError> {
        wheels.iter().try_fold(self, |body, wheel| body.with_wheel(wheel.of_start(t, omega_body)))
    }

    /// The body with its wheels changed, and with what is left of its forces.
    pub(super) fn changed(
        &self,
        wheel: impl FnMut(&Wheel) -> Wheel,
        left: impl FnMut(&Force) -> Option<Force>,
    ) -> Body {
        let wheels = self.wheels.iter().map(wheel).collect();
        let bare = Body { wheels, locked: self.locked.clone(), ..Body::free(self.inertia.clone()) };
        self.forces.iter().filter_map(left).fold(bare, Body::with)
    }

    /// Whether the solver frame has digits for a potential linear in the vertical with this moment, N m.
    fn has_in_range(&self, moment: Vec3<f64>) -> bool {
        let scaled = moment.map(|c| c / self.scale());
        clear(scaled.magnitude()) && clear(moment.magnitude())
    }

    /// The inertia I of m = I ω: it includes wheels that are held, and is without `J a aᵀ` of each other wheel.
    pub fn inertia(&self) -> &Inertia {
        &self.inertia
    }

    /// The inertia that was given: of body and wheels as if all were one rigid body.
    pub fn locked_inertia(&self) -> &Inertia {
        self.locked.as_ref().unwrap_or(&self.inertia)
    }

    /// The wheels that it carries.
    pub fn wheels(&self) -> &[Wheel] {
        &self.wheels
    }

    /// The forces that act on it, in the order in which they were given.
    pub fn forces(&self) -> &[Force] {
        &self.forces
    }

    /// The forces that are not part of the [linear potential](Self::linear_potential).
    pub(crate) fn remainder(&self) -> impl Iterator<Item = &Force> {
        let is_linear = |force: &Force| force.linear_moment().is_some_and(|c| self.has_in_range(c));
        self.forces.iter().filter(move |force| !is_linear(force))
    }

    /// The name of something that acts on it, or that it carries wheels; `None` of a free body.
    pub(crate) fn acts(&self) -> Option<String> {
        let name = self.remainder().next().or(self.forces.first()).map(|force| force.name().to_owned());
        name.or((!self.wheels.is_empty()).then(|| "wheels".into()))
    }

    /// What kind of motion it makes.
    pub fn problem(&self) -> Problem {
        let have_potentials = self.remainder().all(Force::has_potential);
        match (&self.linear, self.remainder().next()) {
            (None, None) if !self.wheels.is_empty() => Problem::Gyrostat,
            _ if !self.wheels.is_empty() && have_potentials => Problem::GyrostatPotential,
            (None, None) => Problem::Free,
            (Some(_), None) => Problem::Linear,
            _ if have_potentials => Problem::Potential,
            _ => Problem::Torque,
        }
    }

    /// What the motion conserves, in exact arithmetic.
    pub fn conserved(&self) -> Vec<Conserved> {
        let mut free = vec![Conserved::MomentumNorm, Conserved::Momentum, Conserved::MomentumZ];
        if self.wheels.iter().all(|wheel| wheel.motor().is_none()) {
            free.insert(0, Conserved::Energy);
        }
        let linear = self.linear.map(|_| vec![Conserved::Energy, Conserved::MomentumZ]);
        let others = self.remainder().map(Force::conserved);
        linear.into_iter().chain(others).fold(free, |a, b| {
            let mut both = Vec::new();
            for quantity in a.iter().chain(&b) {
                if follows(*quantity, &a) && follows(*quantity, &b) && !both.contains(quantity) {
                    both.push(*quantity);
                }
            }
            both
        })
    }

    /// The sum of the forces whose potential is linear in the vertical, such as uniform gravity: in the solver frame, divided by
    /// the [scale](Self::scale); `None` where there is none.
    #[must_use]
    pub fn linear_potential<S: Real>(&self) -> Option<LinearPotential<S>> {
        self.linear.map(|linear| LinearPotential { moment: linear.moment.map(S::from_dd) })
    }

    /// The constants that kernels read.
    pub fn rotor(&self) -> Rotor {
        Rotor::of_moments(Vec3(self.inertia.scaled_moments()))
    }

    /// The same body; a force that is not finite is reported to `witness`.
    pub(crate) fn witnessed(&self, witness: Witness) -> Body {
        Body { witness: Some(witness), ..self.clone() }
    }

    /// Every force in the solver frame, in one value; wheels act on the momentum of the carrier like torques.
    pub(crate) fn field<S: Evaluated>(&self) -> Forces<S> {
        let wheels = self.wheels.iter().map(|wheel| Force::torque("wheel", OnCarrier(*wheel)));
        self.field_of(self.linear_potential(), self.remainder().cloned().chain(wheels))
    }

    /// The forces alone, without wheels.
    pub(crate) fn field_without_wheels<S: Evaluated>(&self) -> Forces<S> {
        self.field_of(self.linear_potential(), self.remainder().cloned())
    }

    /// The momentum of its wheels in the solver frame; `None` without wheels.
    pub(crate) fn momentum_of_wheels(&self) -> Option<Wheels> {
        let axis = |axis: Vec3<Dd>| self.inertia.along_axes(axis).map(|a| a * (1.0 / self.scale()));
        (!self.wheels.is_empty()).then(|| Wheels::new(&self.wheels, axis))
    }

    /// L, the angular momentum of body and wheels in space at the time `t`, s, in kg m²/s.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::body::{Body, Wheel};
    /// use polhode::Inertia;
    /// let wheel = Wheel::new(Vector3::z(), 0.5, 4.0)?;
    /// let body = Body::free(Inertia::from_moments([3.0, 3.0, 5.0])?).with_wheel(wheel)?;
    /// let start = body.state(Default::default(), Vector3::new(1.0, 0.0, 0.0))?;
    /// assert_eq!(body.momentum_space(0.0, &start), Vector3::new(3.0, 0.0, 2.0));
    /// # Ok::<(), polhode::Error>(())
    /// ```
    #[must_use]
    pub fn momentum_space(&self, t: f64, x: &State) -> Vector3<f64> {
        x.rotation() * (x.momentum() + self.momentum_of_wheels_at(t))
    }

    /// The angular momentum of its wheels at the time `t`, s, body axes, kg m²/s: not part of [`State::momentum`]. Zero without wheels.
    #[must_use]
    pub fn momentum_of_wheels_at(&self, t: f64) -> Vector3<f64> {
        let wheels = self.wheels.iter().map(|wheel| wheel.momentum::<f64>(Time::from_seconds(t)));
        wheels.fold(Vec3::zero(), |sum, one| sum + one).into()
    }

    /// One force alone in the solver frame, evaluated by its law.
    fn field_of_one(&self, force: &Force) -> Forces<Dd> {
        self.field_of(None, core::iter::once(force.clone()))
    }

    fn field_of<S: Evaluated>(
        &self,
        linear: Option<LinearPotential<S>>,
        others: impl Iterator<Item = Force>,
    ) -> Forces<S> {
        let frame = (!self.inertia.is_along_principal_axes()).then(|| self.inertia.frame());
        let tensor = self.locked.is_none().then(|| self.inertia.tensor());
        Forces::new(linear, others, frame, self.scale(), tensor, self.witness.clone())
    }

    /// Kinetic and potential energy, J. A potential that depends on the time is taken at t = 0.
    ///
    /// The kinetic energy is ½ ω·Iω with the tensor of [`inertia`](Self::inertia). The energy of the spin of wheels is left out: l²/2J for one
    /// that turns freely or is driven, J Ω (a·ω + Ω/2) for one that is held.
    #[must_use]
    pub fn energy(&self, x: &State) -> f64 {
        self.energy_at(0.0, x)
    }

    /// Kinetic and potential energy, J, at the time `t`, s; as [`energy`](Self::energy), without that of the spin of wheels.
    #[must_use]
    pub fn energy_at(&self, t: f64, x: &State) -> f64 {
        self.energy_of(Time::from_seconds(t), &self.inside(x)).hi()
    }

    /// Kinetic and potential energy, J, of a point of the solver frame; as [`energy`](Self::energy), without that of the spin of wheels.
    pub fn energy_of<S: Precise>(&self, at: Time, x: &Point<S>) -> Dd {
        self.scaled_energy(at, &x.to_dd()) * self.scale()
    }

    /// Torque of all that acts, in the solver frame, divided by the [scale](Self::scale).
    pub fn torque_of(&self, at: Time, x: &Point<Dd>) -> Vec3<Dd> {
        let omega = x.momentum_body.times(self.rotor().inverse_moments());
        self.field().torque(at, x.attitude, omega)
    }

    /// Kinetic and potential energy, divided by the scale.
    pub(crate) fn scaled_energy(&self, at: Time, x: &Point<Dd>) -> Dd {
        let kinetic = self.rotor().kinetic_energy(x.momentum_body);
        if self.forces.is_empty() {
            return kinetic;
        }
        kinetic + self.field_without_wheels().energy(at, x.attitude)
    }

    /// Σ (|U| + |τ|) over the forces besides the linear potential and wheels at the point `x`, divided by the scale.
    pub(crate) fn size_of_remainder(&self, at: Time, x: &Point<Dd>) -> Dd {
        let omega = x.momentum_body.times(self.rotor().inverse_moments());
        let sizes = self.remainder().map(|force| {
            let alone = self.field_of_one(force);
            let torque = alone.remainder(at, x.attitude, omega).norm();
            alone.remainder_energy(at, x.attitude).abs() + torque
        });
        sizes.fold(Dd::ZERO, |sum, size| sum + size)
    }

    /// The name of a force whose potential energy is not finite.
    pub(crate) fn force_without_energy(&self, at: Time, x: &Point<Dd>) -> Option<&str> {
        let of = |force: &&Force| !self.field_of_one(force).energy(at, x.attitude).hi().is_finite();
        self.remainder().find(of).map(Force::name)
    }

    /// The state with angular velocity `omega_body` (rad/s, body axes): m = I ω.
    ///
    /// # Errors
    /// Components that are not finite, a quaternion of zeros, or a spin whose energy is no finite double.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::Body;
    /// use polhode::inertia::Inertia;
    /// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
    /// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.5, 1.0, -0.25))?;
    /// assert_eq!(start.momentum(), Vector3::new(0.5, 2.0, -0.75));
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn state(
        &self,
        attitude: UnitQuaternion<f64>,
        omega_body: Vector3<f64>,
    ) -> Result<State, StateError> {
        let inside = self.enter_omega(attitude.into(), omega_body.into())?;
        Ok(self.leave(&inside))
    }

    /// The exact point of the solver frame with angular velocity `omega_body`, rad/s, body axes; the attitude may have any
    /// norm but zero.
    ///
    /// # Errors
    /// As [`state`](Self::state).
    pub fn enter_omega(&self, attitude: Quat<f64>, omega_body: Vec3<f64>) -> Result<Point<Dd>, StateError> {
        let attitude = unit(attitude)?;
        check("angular velocity", &omega_body.0)?;
        let inside =
            Point::new(self.inertia.attitude_of_axes(attitude), self.inertia.scaled_momentum(omega_body));
        let value = omega_body.magnitude();
        let error = StateError::OutOfRange { quantity: "angular velocity", value, unit: "rad/s" };
        if self.is_in_range(&inside) { Ok(inside) } else { Err(error) }
    }

    /// The state `x` in the solver frame: principal axes, divided by the power of two; the attitude may have any norm but
    /// zero, and is normalised.
    ///
    /// # Errors
    /// As [`state`](Self::state).
    pub fn enter(&self, x: &State) -> Result<Point<Dd>, StateError> {
        let attitude = unit(x.attitude)?;
        check("momentum", &x.momentum_body.0)?;
        let inside = Point::new(self.inertia.attitude_of_axes(attitude), self.momentum_inside(x));
        let value = x.momentum_body.magnitude();
        let error = StateError::OutOfRange { quantity: "momentum", value, unit: "kg m^2/s" };
        if self.is_in_range(&inside) { Ok(inside) } else { Err(error) }
    }

    /// The state `x` in the solver frame, with an attitude of norm 1 where it has a direction.
    fn inside(&self, x: &State) -> Point<Dd> {
        let attitude = unit(x.attitude).unwrap_or(Quat::of(x.attitude));
        Point::new(self.inertia.attitude_of_axes(attitude), self.momentum_inside(x))
    }

    /// The momentum of `x` in the solver frame.
    fn momentum_inside(&self, x: &State) -> Vec3<Dd> {
        let scale = self.inertia.scale();
        self.inertia.along_axes(x.momentum_body.map(|m| Dd::of(m / scale)))
    }

    /// The point `x` of the solver frame as a state in body axes.
    pub fn leave<S: Precise>(&self, x: &Point<S>) -> State {
        Exit::of(self).state(x.phase())
    }

    /// Angular velocity ω = I⁻¹ m in body axes, rad/s.
    #[must_use]
    pub fn omega_body(&self, x: &State) -> Vector3<f64> {
        self.omega_of(&self.inside(x))
    }

    /// Angular velocity in body axes, rad/s, of a point of the solver frame.
    pub fn omega_of<S: Precise>(&self, x: &Point<S>) -> Vector3<f64> {
        Exit::of(self).omega(self.rotor().inverse_moments(), x.momentum_body)
    }

    /// Moments, momenta and energies of the solver frame times this power of two are those in the user's units.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.inertia.scale()
    }

    /// Whether the energy is a double, with room for the errors of its products.
    fn is_in_range(&self, inside: &Point<Dd>) -> bool {
        // far from the ends doubles tell it
        let (m, i) = (inside.momentum_body.map(Dd::hi), self.rotor().moments::<f64>());
        let rounded = m[0] * m[0] / i[0] + m[1] * m[1] / i[1] + m[2] * m[2] / i[2];
        if [rounded, rounded * self.inertia.scale()].iter().all(|x| (1e-200..1e200).contains(x)) {
            return true;
        }
        let omega = inside.momentum_body.times(self.rotor().inverse_moments());
        let twice_energy = inside.momentum_body.dot(omega).hi();
        let energy = twice_energy * self.inertia.scale();
        let clear = |x: f64| x == 0.0 || clear(x);
        let at_rest = omega.0.iter().all(|w| w.hi() == 0.0);
        clear(twice_energy) && clear(energy) && (at_rest || energy != 0.0)
    }
}

/// Whether `quantity` is conserved where all of `conserved` are.
fn follows(quantity: Conserved, conserved: &[Conserved]) -> bool {
    let has = |other| conserved.contains(&other);
    has(quantity)
        || match quantity {
            Conserved::MomentumNorm | Conserved::MomentumZ => has(Conserved::Momentum),
            Conserved::Jacobi { .. } => has(Conserved::Energy) && follows(Conserved::MomentumZ, conserved),
            Conserved::Energy | Conserved::Momentum => false,
        }
}

/// Dekker products of squares need the exponent to stay clear of both ends.
fn clear(x: f64) -> bool {
    (1e-240..1e240).contains(&x.abs())
}

/// The attitude with norm 1, to the digits of double-double.
fn unit(attitude: Quat<f64>) -> Result<Quat<Dd>, StateError> {
    check("attitude", &attitude.components())?;
    let largest = attitude.magnitude();
    if largest == 0.0 {
        return Err(StateError::NoAttitude);
    }
    // the power of two keeps the squares in range
    let near_one = attitude.map(|x| libm::scalbn(x, -libm::ilogb(largest)));
    Ok(Quat::of(near_one).normalized())
}

fn check(quantity: &'static str, components: &[f64]) -> Result<(), StateError> {
    match components.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(StateError::NotFinite { quantity, value }),
        None => Ok(()),
    }
}
