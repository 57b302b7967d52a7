//! What acts on the bodies of a block.

use nalgebra::Matrix3;

use crate::body::{Drag, KnownForces, LinearPotential, Orbit, Place, Time, gradient_torque};
use crate::num::{LANES, Lane};
use crate::rotation::{Quat, Vec3};

/// Forces of one kind on all bodies, on one orbit. What differs between the bodies are numbers: the moment of gravity, the frame of
/// the axes in which the others are evaluated, the tensor, the coefficients of drag, and what the torque is multiplied by.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Acting {
    linear: bool,
    framed: bool,
    gradient: Option<Orbit>,
    /// Of the tensor.
    diagonal: bool,
    drag: Option<Resistance>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Resistance {
    Linear,
    Quadratic,
}

/// How many numbers of each body that is.
pub(super) const FORCES: usize = 19;

/// Room for the torques of a block, and for what they are worked out from.
#[derive(Debug)]
pub(super) struct Torques {
    pub(super) torque: [Lane; 3],
    attitude: [Lane; 4],
    omega: [Lane; 3],
}

impl Torques {
    pub(super) const ZERO: Torques =
        Torques { torque: [Lane::ZERO; 3], attitude: [Lane::ZERO; 4], omega: [Lane::ZERO; 3] };
}

/// The `n`-th lanes as a vector.
#[inline(always)]
pub(super) fn vector(lanes: &[Lane; 3], n: usize) -> Vec3<f64> {
    Vec3([lanes[0][n], lanes[1][n], lanes[2][n]])
}

#[inline(always)]
pub(super) fn set_vector(lanes: &mut [Lane; 3], n: usize, Vec3([x, y, z]): Vec3<f64>) {
    (lanes[0][n], lanes[1][n], lanes[2][n]) = (x, y, z);
}

/// The `n`-th lanes as a quaternion.
#[inline(always)]
pub(super) fn quaternion(lanes: &[Lane; 4], n: usize) -> Quat<f64> {
    Quat::from_components([lanes[0][n], lanes[1][n], lanes[2][n], lanes[3][n]])
}

#[inline(always)]
pub(super) fn set_quaternion(lanes: &mut [Lane; 4], n: usize, q: Quat<f64>) {
    (lanes[0][n], lanes[1][n], lanes[2][n], lanes[3][n]) = (q.w, q.v[0], q.v[1], q.v[2]);
}

impl Acting {
    /// Of one body, with its numbers.
    pub(super) fn of(forces: &KnownForces) -> (Acting, [f64; FORCES]) {
        let KnownForces { linear, gradient, drag, frame, scale } = forces;
        let Vec3([c1, c2, c3]) = linear.map_or(Vec3::zero(), |linear| linear.moment);
        let [w, x, y, z] = frame.unwrap_or(Quat::identity()).components();
        let tensor = gradient.as_ref().map_or(Matrix3::zeros(), |gradient| gradient.0);
        let [[a, b, c], [d, e, f], [g, h, i]] = tensor.data.0;
        let Drag { linear: once, quadratic: twice } = drag.unwrap_or(Drag { linear: 0.0, quadratic: 0.0 });
        let acting = Acting {
            linear: linear.is_some(),
            framed: frame.is_some(),
            gradient: gradient.as_ref().map(|gradient| gradient.1.clone()),
            diagonal: [b, c, d, f, g, h] == [0.0; 6],
            drag: drag
                .map(|drag| if drag.quadratic == 0.0 { Resistance::Linear } else { Resistance::Quadratic }),
        };
        (acting, [c1, c2, c3, w, x, y, z, a, b, c, d, e, f, g, h, i, once, twice, 1.0 / scale])
    }

    pub(super) fn is_on_orbit(&self) -> bool {
        self.gradient.is_some()
    }

    /// Where the bodies are on their orbit at the time `at`.
    pub(super) fn place(&self, at: Time) -> Option<Place<f64>> {
        self.gradient.as_ref().map(|orbit| orbit.at(at))
    }

    /// The torques at `place` in `room`: for each lane the operations of [`Forces`](crate::body::Forces) in their order.
    #[inline(always)]
    pub(super) fn torques(
        &self,
        numbers: &[Lane; FORCES],
        place: Option<&Place<f64>>,
        attitude: &[Lane; 4],
        omega: &[Lane; 3],
        room: &mut Torques,
    ) {
        let [c1, c2, c3, w, x, y, z, tensor @ .., once, twice, share] = numbers;
        let linear = |n: usize| LinearPotential { moment: Vec3([c1[n], c2[n], c3[n]]) };
        let frame = |n: usize| Quat::from_components([w[n], x[n], y[n], z[n]]);
        let torque = &mut room.torque;
        if self.gradient.is_none() && self.drag.is_none() {
            for n in 0..LANES {
                set_vector(torque, n, linear(n).torque(quaternion(attitude, n)));
            }
            return;
        }
        let (attitudes, omegas) = if self.framed {
            for n in 0..LANES {
                set_quaternion(&mut room.attitude, n, quaternion(attitude, n) * frame(n).conjugate());
            }
            if self.drag.is_some() {
                for n in 0..LANES {
                    set_vector(&mut room.omega, n, frame(n).rotate(vector(omega, n)));
                }
            }
            (&room.attitude, &room.omega)
        } else {
            (attitude, omega)
        };
        if let Some(place) = place {
            let [a, b, c, d, e, f, g, h, i] = tensor;
            if self.diagonal {
                // products by zero are left out: they change the sign of a zero at most, which the sum does not keep
                for n in 0..LANES {
                    let r = quaternion(attitudes, n).rotate_back(place.direction);
                    let one = r.cross(Vec3([a[n], e[n], i[n]]).times(r)) * place.strength;
                    set_vector(torque, n, Vec3::zero() + one);
                }
            } else {
                for n in 0..LANES {
                    let tensor = [[a[n], b[n], c[n]], [d[n], e[n], f[n]], [g[n], h[n], i[n]]];
                    let one = gradient_torque(
                        &Matrix3::from_data(nalgebra::ArrayStorage(tensor)),
                        place,
                        quaternion(attitudes, n),
                    );
                    set_vector(torque, n, Vec3::zero() + one);
                }
            }
        } else {
            *torque = [Lane::ZERO; 3];
        }
        let drag = |n: usize| Drag { linear: once[n], quadratic: twice[n] };
        match self.drag {
            None => {}
            Some(Resistance::Linear) => {
                for n in 0..LANES {
                    let one = drag(n).of::<false, f64>(vector(omegas, n));
                    set_vector(torque, n, vector(torque, n) + one);
                }
            }
            Some(Resistance::Quadratic) => {
                for n in 0..LANES {
                    let one = drag(n).of::<true, f64>(vector(omegas, n));
                    set_vector(torque, n, vector(torque, n) + one);
                }
            }
        }
        if self.framed {
            for n in 0..LANES {
                set_vector(torque, n, frame(n).rotate_back(vector(torque, n)));
            }
        }
        if self.linear {
            for n in 0..LANES {
                let rest = vector(torque, n) * share[n];
                set_vector(torque, n, linear(n).torque(quaternion(attitude, n)) + rest);
            }
        } else {
            for n in 0..LANES {
                set_vector(torque, n, vector(torque, n) * share[n]);
            }
        }
    }
}
