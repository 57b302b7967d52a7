//! The likelihood of attitudes of a body on which torques act, known ones of unknown size and white torque noise.
//!
//! Between two samples the motion follows Euler's equations with the torque of the model; torque noise lets it leave that path. Attitude
//! and rate at every sample, the tensor and the coefficients of the torque are found together: a Kalman filter along a path gives the
//! likelihood and its linear equations, the smoother moves the path, and this is repeated until it stands still. It begins with so
//! much torque noise that each sample stands nearly alone, where any first path will do.
//!
//! Source: B. M. Bell, SIAM J. Optimization 4 (1994) 626 (the iterated smoother is the method of Gauss and Newton); F. C. Schweppe,
//! IEEE Trans. Inf. Theory 11 (1965) 61 (the likelihood of innovations).

pub(crate) mod choice;
mod dynamics;
mod filter;
pub(crate) mod search;
