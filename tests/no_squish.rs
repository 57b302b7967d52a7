//! NO_SQUISH, as molecular dynamics programs have it, is `lie-poisson:321` in other variables.

use polhode::body::{Body, Clock, Point, Time, vertical};
use polhode::inertia::Inertia;
use polhode::method::{Claimed, method};
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3};

/// Attitude q and quaternion momentum p = 2 q ∘ (0, m).
struct Quaternions {
    q: Quat<Dd>,
    p: Quat<Dd>,
}

impl Quaternions {
    fn momentum(&self) -> Vec3<Dd> {
        (self.q.conjugate() * self.p).v * Dd::of(0.5)
    }

    /// Miller et al., J. Chem. Phys. 116 (2002) 8649: q and p turn alike, by the angle ζ t with ζ = p·P_k q/(4 I_k), where
    /// P_k q = q ∘ e_k.
    fn turn(&mut self, axis: usize, moment: Dd, t: Dd) {
        let unit = Quat::new(Dd::ZERO, Vec3::unit(axis));
        let (permuted_q, permuted_p) = (self.q * unit, self.p * unit);
        let dot = self.p.components().into_iter().zip(permuted_q.components());
        let dot = dot.fold(Dd::ZERO, |sum, (a, b)| sum + a * b);
        let (sin, cos) = (dot * t / (moment * 4.0)).sin_cos();
        self.q = self.q * cos + permuted_q * sin;
        self.p = self.p * cos + permuted_p * sin;
    }

    fn kick(&mut self, weight_moment: Vec3<Dd>, t: Dd) {
        let torque = vertical(self.q).cross(weight_moment);
        self.p = self.p + self.q * Quat::new(Dd::ZERO, torque * (t * 2.0));
    }
}

#[test]
fn no_squish_is_the_turns_of_three_axes() {
    let (moments, h, steps) = ([1.0, 2.0, 2.5], 0.125, 400);
    assert_eq!(method("no-squish").unwrap().name(), "lie-poisson:321");
    assert_eq!(method("no-squish@suzuki-4").unwrap().name(), "lie-poisson:321@suzuki-4");
    assert!(method("no-squish:321").is_err());
    for weight_moment in [[0.0; 3], [0.25, -0.5, 1.0]] {
        let body = Body::heavy(Inertia::from_moments(moments).unwrap(), weight_moment.into()).unwrap();
        let q = Quat::<Dd>::of(Quat::from_components([0.5, -0.25, 0.75, 0.375])).normalized();
        let start = body.enter_omega(Quat::identity(), Vec3([0.4, 1.0, -0.3])).unwrap();
        let mut x = Point::new(q, start.momentum_body);
        let mut y = Quaternions { q, p: q * Quat::new(Dd::ZERO, start.momentum_body * Dd::of(2.0)) };
        let moments: Vec3<Dd> = body.rotor().moments();
        let weight_moment = Vec3::of(Vec3(weight_moment)) * Dd::of(1.0 / body.scale());

        method("no-squish").unwrap().prepare_dd(Clock::new(h), &body).unwrap().steps(&mut x, steps);
        let half = Dd::of(0.5 * h);
        for _ in 0..steps {
            y.kick(weight_moment, half);
            for (axis, t) in [(2, half), (1, half), (0, Dd::of(h)), (1, half), (2, half)] {
                y.turn(axis, moments[axis], t);
            }
            y.kick(weight_moment, half);
        }
        let off = (x.attitude - y.q).magnitude() + (x.momentum_body - y.momentum()).magnitude();
        assert!(off < 1e-27, "{off:.1e}");
        let energy = |x: &Point<Dd>| body.energy_of(Time::from_seconds(0.0), x).hi();
        assert_ne!(energy(&x), energy(&start));
    }
}
