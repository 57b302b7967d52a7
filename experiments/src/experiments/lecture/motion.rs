//! Sections 17.2 and 17.3: motion in general, by direct sums over point masses.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use polhode::body::Body;
use polhode::flow::LagrangeTop;
use polhode::inertia::Inertia;
use polhode::num::elliptic::Modulus;
use polhode::num::{Dd, Random, Real};
use polhode::rotation::{EulerSequence, Quat, Vec3};
use polhode_files::error::Error;

use super::{Point, Statements, derivative, free_motion, unexpected};
use crate::statistics::larger;

const ROTATION: &str = "17.2";
const EQUATIONS: &str = "17.3";

/// Sums of a dozen terms in `f64`.
const SUMS: f64 = 1e-14;

type V = Vector3<f64>;

/// Point masses with velocities and the external forces on them.
struct Particles {
    mass: Vec<f64>,
    place: Vec<V>,
    velocity: Vec<V>,
    force: Vec<V>,
}

impl Particles {
    /// Twelve particles, no two alike.
    fn scattered() -> Self {
        let mut random = Random::new(17);
        let mut vector = || V::from_fn(|_, _| random.between(-1.0, 1.0));
        let (away, drift) = (V::new(1.0, -2.0, 0.5), V::new(0.5, 0.25, -1.0));
        Particles {
            mass: (0..12).map(|_| 1.5 + vector().x).collect(),
            place: (0..12).map(|_| away + vector()).collect(),
            velocity: (0..12).map(|_| drift + vector()).collect(),
            force: (0..12).map(|_| vector()).collect(),
        }
    }

    /// The same masses turning rigidly with `omega` about the point `q`.
    fn turning(omega: V, q: V) -> Self {
        let scattered = Self::scattered();
        let velocity = scattered.place.iter().map(|r| omega.cross(&(r - q))).collect();
        Particles { velocity, ..scattered }
    }

    fn total_mass(&self) -> f64 {
        self.mass.iter().sum()
    }

    fn weighted(&self, of: impl Fn(usize) -> V) -> V {
        self.mass.iter().enumerate().map(|(i, m)| of(i) * *m).sum()
    }

    fn centre(&self) -> V {
        self.weighted(|i| self.place[i]) / self.total_mass()
    }

    fn centre_velocity(&self) -> V {
        self.weighted(|i| self.velocity[i]) / self.total_mass()
    }

    /// Angular momentum about `q` as seen from a frame that moves with `velocity`.
    fn angular_momentum(&self, q: V, velocity: V) -> V {
        self.weighted(|i| (self.place[i] - q).cross(&(self.velocity[i] - velocity)))
    }

    fn kinetic_energy(&self, velocity: V) -> f64 {
        let squared = |i: usize| (self.velocity[i] - velocity).norm_squared();
        0.5 * self.mass.iter().enumerate().map(|(i, m)| m * squared(i)).sum::<f64>()
    }

    fn inertia(&self, q: V) -> Matrix3<f64> {
        let part = |i: usize| {
            let s = self.place[i] - q;
            (Matrix3::identity() * s.norm_squared() - s * s.transpose()) * self.mass[i]
        };
        (0..self.mass.len()).map(part).sum()
    }

    /// Accelerations under the external forces and springs between all pairs.
    fn accelerations(&self) -> Vec<V> {
        let inner = |i: usize| -> V { self.place.iter().map(|r| (r - self.place[i]) * 3.0).sum() };
        (0..self.mass.len()).map(|i| (self.force[i] + inner(i)) / self.mass[i]).collect()
    }
}

pub(super) fn general(s: &mut Statements) -> Result<(), Error> {
    splitting(s);
    about_a_point(s);
    rolling_and_pendulum(s)
}

fn splitting(s: &mut Statements) {
    let p = Particles::scattered();
    let (mass, r, v) = (p.total_mass(), p.centre(), p.centre_velocity());
    let momentum = p.weighted(|i| p.velocity[i]);
    s.vector(ROTATION, "P of a system is that of its mass at the centre of mass", [v * mass, momentum], SUMS);
    let internal = p.weighted(|i| p.velocity[i] - v).norm();
    s.number(ROTATION, "P within the centre-of-mass frame is zero", [0.0, internal], momentum.norm(), SUMS);
    let split = r.cross(&(v * mass)) + p.angular_momentum(r, v);
    let whole = p.angular_momentum(V::zeros(), V::zeros());
    s.vector(ROTATION, "L splits into that of the centre of mass and the internal one", [split, whole], SUMS);
    let split = 0.5 * mass * v.norm_squared() + p.kinetic_energy(v);
    let whole = p.kinetic_energy(V::zeros());
    s.number(
        ROTATION,
        "T splits into that of the centre of mass and the internal one",
        [split, whole],
        whole,
        SUMS,
    );
    let other = p.velocity[0];
    let left_over = whole - 0.5 * mass * other.norm_squared() - p.kinetic_energy(other);
    let formula = mass * other.dot(&(v - other));
    let text = "T seen from another point A does not split: M V_A.(V - V_A) is left over";
    s.number(ROTATION, text, [formula, left_over], whole, SUMS);
}

fn about_a_point(s: &mut Statements) {
    let (omega, q) = (V::new(0.3, -1.1, 0.7), V::new(0.4, 0.9, -1.3));
    let p = Particles::turning(omega, q);
    let inertia = p.inertia(q);
    let momentum = p.angular_momentum(q, V::zeros());
    s.vector(ROTATION, "L = I_Q w in a pure rotation about Q", [inertia * omega, momentum], SUMS);
    let energy = p.kinetic_energy(V::zeros());
    let formula = 0.5 * omega.dot(&(inertia * omega));
    s.number(ROTATION, "T = w.I_Q w / 2 in a pure rotation about Q", [formula, energy], formula, SUMS);
    let (c, mass) = (p.centre(), p.total_mass());
    let r = c - q;
    let shifted = p.inertia(c) + (Matrix3::identity() * r.norm_squared() - r * r.transpose()) * mass;
    let difference = (shifted - inertia).norm() / inertia.norm();
    let text = "parallel axis theorem: I_Q = M(R^2 - R R^T) + I";
    s.exact(ROTATION, text, [shifted.norm(), inertia.norm(), difference], SUMS);
}

/// The motions that the lecture names as pure rotations.
fn rolling_and_pendulum(s: &mut Statements) -> Result<(), Error> {
    // a wheel that rolls along x at the rate w: the centre moves with w r, the rim's lowest point rests
    let (radius, rate, mass) = (0.31, 7.0, 1.5);
    let (centre, contact) = (V::new(0.0, 0.0, radius), V::zeros());
    let omega = V::new(0.0, rate, 0.0);
    let rim = |k: i32| {
        let (sin, cos) = libm::sincos(f64::from(k) * 0.4);
        V::new(sin, 0.0, cos) * radius
    };
    let worst = (0..16).map(|k| {
        let rolling = V::new(rate * radius, 0.0, 0.0) + omega.cross(&rim(k));
        (rolling - omega.cross(&(centre + rim(k) - contact))).norm()
    });
    let worst = worst.fold(0.0, larger);
    let text = "a rolling wheel turns about its contact point: v = w x (r - Q) on the rim";
    s.exact(ROTATION, text, [rate * radius, rate * radius, worst / (rate * radius)], SUMS);
    let (hoop, v) = (mass * radius * radius, rate * radius);
    let formula = 0.5 * (hoop + mass * radius * radius) * rate * rate;
    let computed = 0.5 * mass * v * v + 0.5 * hoop * rate * rate;
    s.number(ROTATION, "T of the rolling wheel is w^2 I_Q / 2", [formula, computed], formula, SUMS);

    // a rod hung by its end, let go at rest: the swing of a heavy body without spin
    let (mass, length, g) = (0.8, 0.7, 9.81);
    let about_pivot = mass * length * length / 3.0;
    let torque = mass * g * 0.5 * length;
    let rod = Inertia::from_moments([about_pivot, about_pivot, 1e-3 * about_pivot]).map_err(unexpected)?;
    let body = Body::heavy(rod, V::new(0.0, 0.0, torque)).map_err(unexpected)?;
    let swing = |amplitude: f64| -> Result<f64, Error> {
        let tilt = core::f64::consts::PI - amplitude;
        let attitude = EulerSequence::ALL[9].attitude([0.0, tilt, 0.0]);
        let top = LagrangeTop::from_omega(&body, attitude, V::zeros()).map_err(unexpected)?;
        // from one side to the other is a nutation
        let half = top.nutation_period().ok_or_else(|| unexpected("the pendulum does not swing"))?;
        Ok(2.0 * half)
    };
    let frequency = libm::sqrt(torque / about_pivot);
    let cos = libm::cos(0.5 * 1.2);
    let formula = 4.0 * Modulus::new(cos * cos).quarter_period() / frequency;
    let text = "physical pendulum: I_Q alone gives the period 4 K(sin(a/2)) sqrt(I_Q/M g l)";
    s.number(ROTATION, text, [formula, swing(1.2)?], formula, 1e-14);
    let formula = core::f64::consts::TAU / frequency;
    let mut points = Vec::new();
    for k in 2..9 {
        let small = libm::exp2(-f64::from(k));
        points.push(Point { small, formula, computed: swing(small)? });
    }
    s.limit(ROTATION, "physical pendulum: small swings take 2 pi sqrt(I_Q/M g l)", 2.0, points);
    Ok(())
}

pub(super) fn equations(s: &mut Statements) -> Result<(), Error> {
    three_sets(s);
    yo_yo(s)?;
    rotating_frame(s)?;
    euler_angles(s)?;
    bearings(s)
}

fn three_sets(s: &mut Statements) {
    let p = Particles::scattered();
    let a = p.accelerations();
    let (r, mass) = (p.centre(), p.total_mass());
    let force: V = p.force.iter().sum();
    // of the springs too, which cancel
    let forces: f64 = p.mass.iter().zip(&a).map(|(m, a)| m * a.norm()).sum();
    let reach = p.place.iter().map(V::norm).fold(0.0, larger);
    let text = "sets 1 to 3 hold for any particles, with springs between them: P' = F";
    s.vector_in(EQUATIONS, text, [force, p.weighted(|i| a[i])], forces, SUMS);
    let acceleration = p.weighted(|i| a[i]) / mass;
    let internal = p.weighted(|i| (p.place[i] - r).cross(&(a[i] - acceleration)));
    let torque = |q: V| -> V { p.place.iter().zip(&p.force).map(|(x, f)| (x - q).cross(f)).sum() };
    let text = "sets 1 and 2: L' about the moving centre of mass is the external torque about it";
    s.vector_in(EQUATIONS, text, [torque(r), internal], forces * reach, SUMS);
    let text = "set 2: L' of the mass at the centre of mass is R x F";
    s.vector_in(EQUATIONS, text, [r.cross(&force), r.cross(&(acceleration * mass))], forces * reach, SUMS);
    let whole = p.weighted(|i| p.place[i].cross(&a[i]));
    let text = "set 3: L' about a fixed point is the external torque about it";
    s.vector_in(EQUATIONS, text, [torque(V::zeros()), whole], forces * reach, SUMS)
        .note("printed twice as \"L = net external torque\": it is the rate of L");
}

/// A yo-yo that unwinds from a string held at rest.
fn yo_yo(s: &mut Statements) -> Result<(), Error> {
    let (mass, inertia, radius, g) = (0.06, 4e-5, 0.008, 9.81);
    // set 1, unknown acceleration a and tension S: M a = M g - S, I a / r = r S
    let equations = Matrix2::new(mass, 1.0, inertia / radius, -radius);
    let solution = equations.lu().solve(&Vector2::new(mass * g, 0.0));
    let [acceleration, tension] =
        solution.map(|x| [x.x, x.y]).ok_or_else(|| unexpected("the yo-yo is singular"))?;
    // set 3, about the point where the string leaves the axle
    let about_contact = inertia + mass * radius * radius;
    let formula = mass * g * radius / about_contact * radius;
    let text = "yo-yo: set 3 about the string's last point gives the acceleration of set 1";
    s.number(EQUATIONS, text, [formula, acceleration], formula, 1e-14);
    // set 2 about a point at the side, where the string does not pass
    let aside = 0.3;
    let formula = (aside * (mass * g - tension)) / (aside * mass);
    let text = "yo-yo: set 2 gives it too";
    s.number(EQUATIONS, text, [formula, acceleration], formula, 1e-14);
    Ok(())
}

/// The angular velocity in the axes of the solver frame.
fn omega(body: &Body, momentum: Vec3<Dd>) -> Vec3<Dd> {
    momentum.times(body.rotor().inverse_moments())
}

fn double(v: Vec3<Dd>) -> V {
    v.map(Dd::hi).into()
}

fn rotating_frame(s: &mut Statements) -> Result<(), Error> {
    let moments = V::new(1.0, 2.0, 3.0);
    let free = free_motion(moments.into(), V::new(0.4, 1.0, -0.3))?;
    let t = 1.75;
    // a vector that moves in the body, seen from space and from the body
    let in_body = |t: Dd| {
        let (sin, cos) = t.sin_cos();
        Vec3([cos, sin * 2.0, t * t])
    };
    let at = |t: Dd| free.point_at_dd(t);
    let seen_from_space = derivative(t, |t| at(t).attitude.rotate(in_body(t)));
    let now = at(Dd::of(t));
    let w = double(omega(free.body(), now.momentum_body));
    let seen_from_body = derivative(t, in_body) + w.cross(&double(in_body(Dd::of(t))));
    let formula = double(now.attitude.rotate(Vec3::of(seen_from_body.into())));
    let text = "a rate of change seen from space is that seen from the body plus w x A";
    s.vector(EQUATIONS, text, [formula, seen_from_space], 1e-14);

    let rate = derivative(t, |t| omega(free.body(), at(t).momentum_body));
    let inertia_w = moments.component_mul(&w);
    let text = "Euler's equations without torque: I w' = -w x (I w) on the exact motion";
    s.vector(EQUATIONS, text, [-w.cross(&inertia_w), moments.component_mul(&rate)], 1e-13);

    let moments = V::new(1.25, 1.25, 0.75);
    let inertia = Inertia::from_moments(moments.into()).map_err(unexpected)?;
    let c = V::new(0.0, 0.0, 2.0);
    let body = Body::heavy(inertia, c).map_err(unexpected)?;
    let tilted = EulerSequence::ALL[9].attitude([0.3, 0.8, 0.1]);
    let top = LagrangeTop::from_omega(&body, tilted, V::new(0.7, -0.4, 5.0)).map_err(unexpected)?;
    let at = |t: Dd| top.point_at_dd(t);
    let now = at(Dd::of(t));
    let w = double(omega(&body, now.momentum_body));
    let up = double(now.attitude.rotate_back(Vec3::unit(2)));
    let rate = derivative(t, |t| omega(&body, at(t).momentum_body));
    let torque = up.cross(&c);
    let computed = moments.component_mul(&rate) + w.cross(&moments.component_mul(&w));
    let text = "Euler's equations with torque: I w' + w x (I w) = N on the exact motion of a top";
    s.vector(EQUATIONS, text, [torque, computed], 1e-13);
    for axis in 0..3 {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let computed = moments[axis] * rate[axis] - (moments[j] - moments[k]) * w[j] * w[k];
        let [a, b, c] = [axis + 1, j + 1, k + 1];
        let text = format!("I{a} w{a}' - (I{b} - I{c}) w{b} w{c} = N{a}");
        s.number(EQUATIONS, text, [torque[axis], computed], torque.norm(), 1e-13);
    }
    Ok(())
}

fn euler_angles(s: &mut Statements) -> Result<(), Error> {
    let zxz: EulerSequence = "zxz".parse().map_err(unexpected)?;
    let (angles, rates) = ([0.7, 1.1, -0.4], [0.3, -0.9, 2.0]);
    let [phi, theta, psi] = angles;
    let [phi_rate, theta_rate, psi_rate] = rates;
    let (sin_theta, cos_theta) = libm::sincos(theta);
    let (sin_phi, cos_phi) = libm::sincos(phi);
    let (sin_psi, cos_psi) = libm::sincos(psi);
    let axis = V::new(sin_theta * sin_phi, -sin_theta * cos_phi, cos_theta);
    let text = "phi and theta are the angles of the body's z axis on the sphere";
    s.vector(EQUATIONS, text, [axis, zxz.attitude(angles) * V::z()], SUMS)
        .note("phi is the azimuth of the line of nodes, a right angle ahead of that of the z axis");
    let formula = V::new(
        phi_rate * sin_theta * sin_psi + theta_rate * cos_psi,
        phi_rate * sin_theta * cos_psi - theta_rate * sin_psi,
        psi_rate + phi_rate * cos_theta,
    );
    // three turns one after the other, whose angles grow: w = 2 q* q'
    let turn = |axis: usize, k: usize, t: Dd| {
        let (sin, cos) = ((Dd::of(angles[k]) + t * rates[k]) * 0.5).sin_cos();
        Quat::new(cos, Vec3::unit(axis) * sin)
    };
    let attitude = |t: Dd| turn(2, 0, t) * turn(0, 1, t) * turn(2, 2, t);
    let here = attitude(Dd::ZERO).conjugate();
    let w = derivative(0.0, |t| (here * attitude(t)).v * Dd::of(2.0));
    let text = "w in the body from the rates of Euler's angles, all three components";
    s.vector(EQUATIONS, text, [formula, w], 1e-14);
    let text = "the same from the library's angles";
    s.vector(EQUATIONS, text, [formula, zxz.omega_body(angles, rates)], SUMS);
    let back = zxz.rates(angles, formula).ok_or_else(|| unexpected("the angles are locked"))?;
    s.vector(EQUATIONS, "and back: the rates of the angles from w", [rates.into(), back.into()], SUMS);
    Ok(())
}

/// A wheel whose symmetry axis is off the axle, turned at a constant rate: section 17.4 opens with it.
fn bearings(s: &mut Statements) -> Result<(), Error> {
    let (across, along, tilt, rate) = (0.08, 0.15, 0.02, 90.0);
    let (sin, cos) = libm::sincos(tilt);
    let w = V::new(sin, 0.0, cos) * rate;
    let moments = V::new(across, across, along);
    let momentum = moments.component_mul(&w);
    // point masses with these moments: pairs at unit distance on the axes
    let pair = |k: usize| 0.25 * (moments.sum() - 2.0 * moments[k]);
    let masses = (0..3).flat_map(|k| [1.0, -1.0].map(|side| (pair(k), V::ith(k, side))));
    let needed: V = masses.map(|(m, r)| r.cross(&w.cross(&w.cross(&r))) * m).sum();
    let formula = (along - across) * rate * rate * sin * cos;
    let text = "an unbalanced wheel at constant w needs the torque w x (I w) = (I3 - I) w^2 sin cos";
    s.number("17.4", text, [formula, needed.norm()], formula, 1e-13);
    s.number("17.4", "that torque has no part along the axle", [0.0, needed.dot(&w) / rate], formula, 1e-13);
    let free = free_motion(moments.into(), w)?;
    let bent = derivative(0.0, |t| {
        free.point_at_dd(t).attitude.rotate(omega(free.body(), free.point_at_dd(t).momentum_body))
    });
    let formula = -needed.component_div(&moments);
    let text = "without bearings w leaves the axle at the rate -I^-1 (w x I w)";
    s.vector("17.4", text, [formula, bent], 1e-13);
    let angle = libm::atan2(w.cross(&momentum).norm(), w.dot(&momentum));
    let (tangent, moment) = (sin / cos, across / along);
    let formula = libm::atan(tangent) - libm::atan(tangent * moment);
    s.number("17.4", "L of that wheel is off the axle", [formula, angle], formula, 1e-13);
    Ok(())
}
