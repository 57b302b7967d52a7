//! The Taylor series of the torque of a gravity gradient on a conic.

use core::array::from_fn;

use super::turned::Turned;
use crate::body::{Orbit, Rotor, Time, TrueAnomaly};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Coefficients of the torque up to an order.
///
/// In body axes the direction r to the body and the normal h of the orbit turn as `r' = r × (ω − f' h)` and `h' = h × ω`, f the true
/// anomaly. With c = e cos f and s = e sin f it is `f' = k (1 + c)²`, `c' = −s f'`, `s' = c f'`, and the strength is
/// `3 GM/r³ = 3 k f' (1 + c)`. In principal axes the torque r × I r times it has the components `(I_l − I_j) r_j r_l`.
#[derive(Clone, Debug)]
pub(super) struct GradientSeries<S> {
    orbit: Orbit,
    /// Which force of the field it is.
    force: usize,
    /// `I_l − I_j`, cyclic.
    differences: Vec3<S>,
    /// k, 1/s.
    rate: S,
    vectors: Vec<Vectors<S>>,
    /// `r_j r_l`.
    products: Vec<[S; 4]>,
    /// s, c and 1 + c; none of a circle.
    eccentric: Vec<[S; 4]>,
    /// f' and 3 GM/r³; of a circle the first coefficients alone.
    turns: Vec<S>,
    strengths: Vec<S>,
    /// The rates of r, h, and of those of the ellipse, by the coefficients so far.
    rates: [[S; 4]; 3],
}

/// r, h, ω and ω − f' h.
#[derive(Clone, Copy, Debug)]
struct Vectors<S> {
    direction: Turned<S>,
    normal: Turned<S>,
    spin: Turned<S>,
    relative: Turned<S>,
}

impl<S: Real> GradientSeries<S> {
    /// For the torque up to the order `order` − 1 on a body with the moments of `rotor`.
    pub(super) fn new(order: usize, rotor: &Rotor, force: usize, orbit: &Orbit) -> Self {
        let i = rotor.moments::<Dd>();
        GradientSeries {
            orbit: orbit.clone(),
            force,
            differences: Vec3([(1, 2), (2, 0), (0, 1)].map(|(j, l)| S::from_dd(i[l] - i[j]))),
            rate: S::of(0.0),
            vectors: Vec::with_capacity(order),
            products: Vec::with_capacity(order),
            eccentric: Vec::with_capacity(order),
            turns: Vec::with_capacity(order),
            strengths: Vec::with_capacity(order),
            rates: [[S::of(0.0); 4]; 3],
        }
    }

    /// Which force of the field it is.
    pub(super) fn force(&self) -> usize {
        self.force
    }

    /// Begins at the time `at`, with attitude and ω.
    pub(super) fn begin(&mut self, at: Time, attitude: Quat<S>, omega: Vec3<S>) {
        self.vectors.clear();
        self.eccentric.clear();
        self.turns.clear();
        self.strengths.clear();
        // a table has none, and is not handed over
        let Some(anomaly) = self.orbit.true_anomaly::<S>(at) else { return };
        let TrueAnomaly { direction, normal, near, eccentric, rate } = anomaly;
        self.rate = rate;
        match eccentric {
            Some([cos, sin]) => self.eccentric.push([sin, cos, near, S::of(0.0)]),
            None => {
                self.turns.push(rate);
                self.strengths.push(S::of(3.0) * rate * rate);
            }
        }
        self.extend(attitude.rotate_back(direction), attitude.rotate_back(normal), omega);
    }

    /// Takes the next coefficients of r, h and ω.
    #[inline]
    fn extend(&mut self, direction: Vec3<S>, normal: Vec3<S>, omega: Vec3<S>) {
        let (normal, spin) = (Turned::new(normal), Turned::new(omega));
        let mut turn = [S::of(0.0); 4];
        if !self.eccentric.is_empty() {
            let mut squared = S::of(0.0);
            for (a, b) in self.eccentric.iter().zip(self.eccentric.iter().rev()) {
                squared = squared + a[2] * b[2];
            }
            self.turns.push(self.rate * squared);
            let mut sums = [S::of(0.0); 4];
            for (x, turn) in self.eccentric.iter().zip(self.turns.iter().rev()) {
                sums = from_fn(|lane| sums[lane] + x[lane] * *turn);
            }
            self.strengths.push(S::of(3.0) * self.rate * sums[2]);
            let [of_sin, of_cos, ..] = sums;
            self.rates[2] = [of_cos, -of_sin, -of_sin, S::of(0.0)];
            for (vectors, turn_by) in self.vectors.iter().zip(self.turns.iter().skip(1).rev()) {
                turn = from_fn(|lane| turn[lane] + vectors.normal.next[lane] * *turn_by);
            }
        }
        if let Some(first) = self.turns.first() {
            turn = from_fn(|lane| turn[lane] + normal.next[lane] * *first);
        }
        let next: [S; 4] = from_fn(|lane| spin.next[lane] - turn[lane]);
        let relative = Turned::new(Vec3([next[2], next[0], next[1]]));
        self.vectors.push(Vectors { direction: Turned::new(direction), normal, spin, relative });
    }

    /// The coefficient n of the torque, of which all before have been asked for.
    #[inline]
    pub(super) fn torque(&mut self, n: usize) -> Vec3<S> {
        let [mut products, mut direction, mut normal] = [[S::of(0.0); 4]; 3];
        for (a, b) in self.vectors.iter().zip(self.vectors.iter().rev()) {
            let (r, s, h) = (&a.direction, &b.direction, &a.normal);
            products = from_fn(|lane| products[lane] + r.next[lane] * s.after[lane]);
            direction = r.add_cross(&b.relative, direction);
            normal = h.add_cross(&b.spin, normal);
        }
        (self.rates[0], self.rates[1]) = (direction, normal);
        self.products.truncate(n);
        self.products.push(products);
        let mut sums = [S::of(0.0); 4];
        for (strength, products) in self.strengths.iter().zip(self.products.iter().rev()) {
            sums = from_fn(|lane| sums[lane] + products[lane] * *strength);
        }
        let [x, y, z, _] = sums;
        self.differences.times(Vec3([x, y, z]))
    }

    /// Takes the next coefficient of ω; `share` is the unit of the time over the order.
    #[inline]
    pub(super) fn push(&mut self, share: S, omega: Vec3<S>) {
        let [direction, normal, eccentric] = self.rates;
        if !self.eccentric.is_empty() {
            self.eccentric.push(eccentric.map(|rate| rate * share));
        }
        let scaled = |[x, y, z, _]: [S; 4]| Vec3([x, y, z]) * share;
        self.extend(scaled(direction), scaled(normal), omega);
    }
}
