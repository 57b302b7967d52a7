//! The derivative of a free motion along its principal axes: of the momentum, and of the attitude by it.

use core::array::from_fn;

use super::functions::{Clock, Values};
use super::momentum::{Direction, Start, Variables};
use crate::flow::free::polhode::{Polhode, exact_separation, scaled};
use crate::num::Dd;
use crate::rotation::{Quat, Vec3};

/// Pairs of axes of the products of inertia, each with the third axis.
pub(super) const PAIRS: [[usize; 3]; 3] = [[0, 1, 2], [0, 2, 1], [1, 2, 0]];

const MOMENTA: [Direction; 3] = [Direction::Momentum(0), Direction::Momentum(1), Direction::Momentum(2)];
const ALL: [Direction; 6] = [
    Direction::Momentum(0),
    Direction::Momentum(1),
    Direction::Momentum(2),
    Direction::Kappa(0),
    Direction::Kappa(1),
    Direction::Kappa(2),
];

/// Constants of the derivative of one motion.
#[derive(Clone, Debug)]
pub(in crate::flow::free) struct Variation {
    clock: Clock,
    /// a, b, c, and the sign of that permutation.
    axes: [usize; 3],
    parity: f64,
    /// Along a, b, c; the momentum divided by 2^unit.
    start: Start,
    moments: [f64; 3],
    unit: i32,
    /// Whether q < p/2: then the axis a may be one of symmetry.
    round: bool,
}

/// Derivatives along the axes of the solver frame; rotation vectors in space.
///
/// Columns: the momentum at the start, then xx, yy, zz, xy, xz, yz of the tensor.
#[derive(Clone, Copy, Debug)]
pub(in crate::flow::free) struct Columns {
    pub(in crate::flow::free) rotation: [Vec3<f64>; 9],
    pub(super) momentum: [Vec3<f64>; 9],
}

impl Columns {
    pub(super) fn zero() -> Self {
        Columns { rotation: [Vec3::zero(); 9], momentum: [Vec3::zero(); 9] }
    }
}

impl Variation {
    /// Of a body with the principal `moments`, from the momentum `m`, with the polhode where that moves.
    pub(in crate::flow::free) fn new(
        moments: Vec3<Dd>,
        momentum: Vec3<Dd>,
        polhode: Option<&Polhode<Dd>>,
    ) -> Self {
        let order @ [l, mu, h] = moments.ascending();
        let axes @ [a, b, c] = match polhode {
            Some(polhode) => polhode.axes,
            None if exact_separation(moments, momentum) <= Dd::ZERO => order,
            None => [h, mu, l],
        };
        debug_assert!(b == mu && a + c == l + h);
        let largest = momentum.magnitude();
        let unit = if largest > 0.0 { libm::ilogb(largest) } else { 0 };
        let m = axes.map(|k| scaled(momentum[k], -unit));
        let i = axes.map(|k| moments[k]);
        let parity = if (b + 3 - a) % 3 == 1 { 1.0 } else { -1.0 };
        // from differences of moments: near a symmetric body it has fewer digits than these
        let kappa = [[1, 2], [2, 0], [0, 1]].map(|[j, k]| (i[j] - i[k]) / (i[j] * i[k]) * parity);
        let [k_a, k_b, k_c] = kappa;
        let [from_a, from_b, from_c] =
            [k_b * k_c * (m[0] * m[0]), k_a * k_c * (m[1] * m[1]), k_a * k_b * (m[2] * m[2])];
        let (p, q) = (from_b - from_a, from_b - from_c);
        let complement = match polhode {
            Some(polhode) => polhode.complement,
            None if p == Dd::ZERO => Dd::ONE,
            None => (from_c - from_a) / p,
        };
        Variation {
            clock: Clock::new(p, q, complement),
            axes,
            parity,
            start: Start { m: m.map(Dd::hi), kappa: kappa.map(Dd::hi) },
            moments: i.map(Dd::hi),
            unit,
            round: q.hi() < 0.5 * p.hi(),
        }
    }

    /// e-folds by which they have grown after the time `t` on the separatrix; 0 elsewhere.
    pub(super) fn folds(&self, t: f64) -> f64 {
        if self.clock.complement > 0.0 { 0.0 } else { self.clock.p.sqrt() * scaled(t.abs(), self.unit) }
    }

    /// The derivatives at the time `t`, where the point is `now`; the attitude at the start is `attitude`.
    pub(super) fn at(&self, t: Dd, attitude: Quat<f64>, now: Quat<f64>) -> Columns {
        let values = self.clock.at(scaled(t, self.unit));
        let variables = Variables::new(&self.clock, self.start, values, ALL);
        let after = variables.momentum();
        let y = after.map(|y| y.value);
        let by = |n: usize| after.map(|y| y.by[n]);
        let [i_a, i_b, i_c] = self.moments;
        let inverse_squares = [i_a, i_b, i_c].map(|i| 1.0 / (i * i));

        let mut momentum = [[0.0; 3]; 9];
        for (n, column) in momentum.iter_mut().enumerate().take(3) {
            *column = by(n);
        }
        // κ_j = 1/I_i − 1/I_k and κ_k = 1/I_j − 1/I_i, (i, j, k) an even permutation of the axes in space
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (by_j, by_k) = (by(3 + j), by(3 + k));
            let factor = inverse_squares[i] * self.parity;
            momentum[3 + i] = from_fn(|r| (by_k[r] - by_j[r]) * factor);
        }
        let integrals = self.integrals(values, y);
        let back = (values.near.is_some() || self.round).then(|| self.gradients(values, y));
        for (n, [i, j, k]) in PAIRS.into_iter().enumerate() {
            let both = 1.0 / (self.moments[i] * self.moments[j]);
            momentum[6 + n] = match &back {
                Some(gradients) if k == 0 || values.near.is_some() => {
                    self.cross(y, gradients[k]).map(|x| x * both)
                }
                _ => self.by_turning(&after.map(|y| [y.by[0], y.by[1], y.by[2]]), y, k).map(|x| x * both),
            };
        }
        let along = self.along(values, y, integrals);
        self.columns(momentum, along, attitude, now)
    }

    /// ∫ m_b m_c, ∫ m_a m_c and ∫ m_a m_b over the time.
    fn integrals(&self, values: Values, y: [f64; 3]) -> [f64; 3] {
        let plain = Variables::<0>::new(&self.clock, self.start, values, []);
        let Start { m, kappa } = self.start;
        let bc = plain.product_bc(y).value;
        if values.near.is_some() {
            [bc, plain.product_ac(y).value, plain.product_ab(y).value]
        } else {
            [bc, (y[1] - m[1]) / kappa[1], (y[2] - m[2]) / kappa[2]]
        }
    }

    /// The gradients of these integrals, taken back to the start, by the momentum `y` at the end; the first alone away from t = 0.
    fn gradients(&self, values: Values, y: [f64; 3]) -> [[f64; 3]; 3] {
        let start = Start { m: y, ..self.start };
        let variables = Variables::new(&self.clock, start, values.reversed(), MOMENTA);
        let before = self.start.m;
        let bc = variables.product_bc(before).by;
        if values.near.is_some() {
            [bc, variables.product_ac(before).by, variables.product_ab(before).by]
        } else {
            [bc, [0.0; 3], [0.0; 3]]
        }
    }

    /// `(e_k × y − M (e_k × m))/κ_k`: what turning the body about the axis k changes, M the derivative of y by m.
    fn by_turning(&self, derivative: &[[f64; 3]; 3], y: [f64; 3], k: usize) -> [f64; 3] {
        let mut axis = [0.0; 3];
        axis[k] = 1.0;
        let (turned, before) = (self.cross(axis, y), self.cross(axis, self.start.m));
        from_fn(|r| {
            let [x, y, z] = derivative[r];
            (turned[r] - (x * before[0] + y * before[1] + z * before[2])) / self.start.kappa[k]
        })
    }

    /// The vector product of components along a, b, c.
    fn cross(&self, u: [f64; 3], v: [f64; 3]) -> [f64; 3] {
        (Vec3(u).cross(Vec3(v)) * self.parity).0
    }

    /// δθ·L for each column: it grows at the rate ω·δm − ω·δI ω, of which `H` keeps all but −½ ω·δI ω.
    fn along(&self, values: Values, y: [f64; 3], [bc, ac, ab]: [f64; 3]) -> [f64; 9] {
        let Start { m, kappa } = self.start;
        let time = values.time;
        let omega: [f64; 3] = from_fn(|k| m[k] / self.moments[k]);
        // ∫ m_b² from the integral of the second kind, the others by m_k² = m_k(0)² + κ_k · (one function)
        let [a2, b2, c2] = m.map(|m| m * m);
        let [k_a, k_b, k_c] = kappa;
        let squares_b = (k_c * b2 - k_b * c2) * (k_a * b2 - k_b * a2) * values.t + m[1] * values.s * y[1];
        let beyond = squares_b - b2 * time;
        let mut along = [0.0; 9];
        for k in 0..3 {
            let share = if k_b == 0.0 { 0.0 } else { kappa[k] / k_b };
            let integral = m[k] * m[k] * time + share * beyond;
            let i = self.moments[k];
            along[k] = time * omega[k];
            along[3 + k] = -0.5 * (time * omega[k] * omega[k] + integral / (i * i));
        }
        for (n, ([i, j, _], integral)) in PAIRS.into_iter().zip([ab, ac, bc]).enumerate() {
            let both = 1.0 / (self.moments[i] * self.moments[j]);
            along[6 + n] = -(time * omega[i] * omega[j] + integral * both);
        }
        along
    }

    /// Adds the rotation vectors, from `δL = Q δm + δθ × L` across L and `along` it, and gives all along the axes of the solver frame,
    /// in its units.
    fn columns(
        &self,
        momentum: [[f64; 3]; 9],
        along: [f64; 9],
        attitude: Quat<f64>,
        now: Quat<f64>,
    ) -> Columns {
        let unit = |k: usize| Vec3::unit(self.axes[k]);
        let place = |v: [f64; 3]| {
            let mut placed = Vec3::zero();
            for (k, axis) in self.axes.into_iter().enumerate() {
                placed[axis] = v[k];
            }
            placed
        };
        let l = attitude.rotate(place(self.start.m));
        let inverse = 1.0 / l.norm_squared();
        let grow = |x: f64| scaled(x, self.unit);
        let shrink = |x: f64| scaled(x, -self.unit);
        let mut columns = Columns::zero();
        for n in 0..9 {
            let change = place(momentum[n]);
            let mut missing = -now.rotate(change);
            if n < 3 {
                missing = missing + attitude.rotate(unit(n));
            }
            let rotation = (l.cross(missing) + l * along[n]) * inverse;
            let (rotation, momentum, column) = if n < 3 {
                (rotation.map(shrink), change, self.axes[n])
            } else if n < 6 {
                (rotation, change.map(grow), 3 + self.axes[n - 3])
            } else {
                (rotation, change.map(grow), self.pair(n - 6))
            };
            columns.rotation[column] = rotation;
            columns.momentum[column] = momentum;
        }
        columns
    }

    /// The column of the product of inertia number `n` along a, b, c.
    fn pair(&self, n: usize) -> usize {
        let [i, j, _] = PAIRS[n];
        5 + self.axes[i] + self.axes[j]
    }
}
