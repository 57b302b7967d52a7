//! Populations of bodies: a body and a start that are known with an uncertainty. Needs the feature `random`.

use thiserror::Error;

use crate::inertia::{Inertia, InertiaError, from_entries};
use crate::num::{Covariance, Distribution, Random, Real};
use crate::rotation::{Quat, Vec3};

/// A draw that no body has is drawn again, up to this many times for one member.
const MOST_DRAWS: u32 = 10_000;

/// Bodies and starts to draw from, each member from random numbers of its own.
///
/// Member k is the same however many others are drawn, in whatever order and on whatever machine: it takes stream k of the seed.
/// Tensors are physically valid: a draw that breaks a law of [`Inertia`] is drawn again, so that what remains is the
/// distribution cut off at the triangle inequalities.
///
/// ```
/// use polhode::body::{AttitudeSpread, Population, Tensors};
/// use polhode::inertia::Inertia;
/// use polhode::num::{Covariance, Distribution};
/// use polhode::rotation::Quat;
/// let uncertain = Population::Independent {
///     attitude: AttitudeSpread::Near { mean: Quat::identity(), turn: Distribution::uniform([[-0.1, 0.1]; 3])? },
///     omega_body: Distribution::Normal { mean: [0.4, 1.0, -0.3], covariance: Covariance::independent([0.01; 3])? },
///     // 20 % of each moment: many a draw has no third side to its triangle
///     inertia: Box::new(Tensors::moments(Inertia::from_moments([1.0, 2.0, 2.5])?, [0.2; 3])?),
/// };
/// let member = uncertain.member(2026, 17)?;
/// let [a, b, c] = member.inertia.principal_moments();
/// assert!(a + b >= c && member.draws >= 1);
/// assert_eq!(member.omega_body, uncertain.member(2026, 17)?.omega_body);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Population {
    /// Attitude, angular velocity and inertia that are independent of each other.
    Independent {
        /// Attitude at the start.
        attitude: AttitudeSpread,
        /// Angular velocity at the start, body axes, rad/s.
        omega_body: Distribution<3>,
        /// Inertia.
        inertia: Box<Tensors>,
    },
    /// A normal distribution of all of them together.
    Joint {
        /// Attitude about which rotation vectors are drawn.
        attitude: Quat<f64>,
        /// Mean angular velocity, body axes, rad/s.
        omega_body: Vec3<f64>,
        /// Inertia to which deviations are added.
        inertia: Inertia,
        /// Of rotation vector (rad, body axes), angular velocity, and the entries xx, yy, zz, xy, xz, yz of the tensor.
        covariance: Box<Covariance<12>>,
    },
}

/// A distribution of attitudes.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum AttitudeSpread {
    /// Always the same; a quaternion of any norm but zero.
    Fixed(Quat<f64>),
    /// A mean, turned by a rotation vector (rad, body axes).
    Near {
        /// The attitude of a rotation vector of zeros.
        mean: Quat<f64>,
        /// Rotation vector.
        turn: Distribution<3>,
    },
    /// Every attitude is as likely as any other (Haar measure): a normalised quaternion of four normal numbers.
    ///
    /// Source: M. E. Muller, A note on a method for generating points uniformly on n-dimensional spheres,
    /// Communications of the ACM 2 (1959) 19.
    Uniform,
}

/// A distribution of inertia tensors.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Tensors {
    /// Always the same.
    Fixed(Inertia),
    /// Principal moments along the axes of a body.
    Moments {
        /// The body whose principal axes are taken.
        axes: Inertia,
        /// Moments: in the order in which they were given, ascending along the axes of a tensor.
        moments: Distribution<3>,
    },
    /// Entries xx, yy, zz, xy, xz, yz of the tensor in body axes.
    Entries(Distribution<6>),
}

/// One member of a population.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Member {
    /// Its inertia.
    pub inertia: Inertia,
    /// Its attitude at the start; of any norm but zero.
    pub attitude: Quat<f64>,
    /// Its angular velocity at the start, body axes, rad/s.
    pub omega_body: Vec3<f64>,
    /// How often its inertia was drawn: again wherever the moments violate the triangle inequality.
    pub draws: u32,
}

impl Population {
    /// Member number `k` of the population with this seed.
    ///
    /// # Errors
    /// Ten thousand tensors in a row that no body has.
    pub fn member(&self, seed: u64, k: u64) -> Result<Member, NoMember> {
        let mut random = Random::new(seed).stream(k);
        match self {
            Self::Independent { attitude, omega_body, inertia } => {
                // the inertia comes last: how often it is drawn changes nothing of the others
                let attitude = attitude.draw(&mut random);
                let omega_body = Vec3(omega_body.draw(&mut random));
                let (inertia, draws) = valid(|| inertia.draw(&mut random))?;
                Ok(Member { inertia, attitude, omega_body, draws })
            }
            Self::Joint { attitude, omega_body, inertia, covariance } => {
                let ((inertia, deviation), draws) = valid(|| {
                    let deviation = covariance.draw(&mut random);
                    let [.., xx, yy, zz, xy, xz, yz] = deviation;
                    let drawn = inertia.tensor() + from_entries([xx, yy, zz, xy, xz, yz]);
                    Ok((Inertia::from_tensor(drawn)?, deviation))
                })?;
                let [a, b, c, x, y, z, ..] = deviation;
                let attitude = *attitude * turned_by(Vec3([a, b, c]));
                Ok(Member { inertia, attitude, omega_body: *omega_body + Vec3([x, y, z]), draws })
            }
        }
    }
}

impl Member {
    /// A member that was not drawn but given.
    #[must_use]
    pub fn new(inertia: Inertia, attitude: Quat<f64>, omega_body: Vec3<f64>) -> Self {
        Member { inertia, attitude, omega_body, draws: 1 }
    }
}

impl Tensors {
    /// Normal moments about those of a body, with standard deviations that are shares of them.
    ///
    /// # Errors
    /// A standard deviation that is negative or not finite.
    pub fn moments(body: Inertia, relative: [f64; 3]) -> Result<Self, crate::num::DistributionError> {
        let mean = body.moments_along_axes();
        let deviations = [0, 1, 2].map(|k| relative[k] * mean[k]);
        let covariance = Covariance::independent(deviations)?;
        Ok(Self::Moments { axes: body, moments: Distribution::Normal { mean, covariance } })
    }

    /// The mean, and the covariance of the entries xx, yy, zz, xy, xz, yz of the tensor in body axes.
    ///
    /// # Errors
    /// A mean that no body has.
    pub(crate) fn entries(&self) -> Result<(Inertia, Covariance<6>), InertiaError> {
        match self {
            Self::Fixed(inertia) => Ok((inertia.clone(), Covariance::zero())),
            Self::Entries(entries) => {
                Ok((Inertia::from_tensor(from_entries(entries.mean()))?, entries.covariance()))
            }
            Self::Moments { axes, moments } => {
                let mean = axes.with_moments(moments.mean())?;
                let frame = axes.frame().map(|x| x.hi());
                let mut columns = [[0.0; 6]; 6];
                for (column, deviation) in columns.iter_mut().zip(moments.covariance().deviations()) {
                    for (k, size) in deviation.into_iter().enumerate() {
                        let Vec3([x, y, z]) = frame.rotate(Vec3::unit(k));
                        let entries = [x * x, y * y, z * z, x * y, x * z, y * z];
                        column.iter_mut().zip(entries).for_each(|(sum, entry)| *sum += size * entry);
                    }
                }
                Ok((mean, Covariance::of_deviations(columns)))
            }
        }
    }

    fn draw(&self, random: &mut Random) -> Result<Inertia, InertiaError> {
        match self {
            Self::Fixed(inertia) => Ok(inertia.clone()),
            Self::Moments { axes, moments } => axes.with_moments(moments.draw(random)),
            Self::Entries(entries) => Inertia::from_tensor(from_entries(entries.draw(random))),
        }
    }
}

impl AttitudeSpread {
    fn draw(&self, random: &mut Random) -> Quat<f64> {
        match self {
            Self::Fixed(attitude) => *attitude,
            Self::Near { mean, turn } => *mean * turned_by(Vec3(turn.draw(random))),
            // of a probability below 1e-100, but zeros have no direction
            Self::Uniform => loop {
                let q = Quat::from_components([0; 4].map(|_| random.normal()));
                if q.magnitude() > 0.0 {
                    return q.normalized();
                }
            },
        }
    }
}

/// The first draw that is a body, and the number of draws.
fn valid<T>(mut draw: impl FnMut() -> Result<T, InertiaError>) -> Result<(T, u32), NoMember> {
    let mut draws = 1;
    loop {
        match draw() {
            Ok(found) => return Ok((found, draws)),
            Err(last) if draws >= MOST_DRAWS => return Err(NoMember { draws, last }),
            Err(_) => draws += 1,
        }
    }
}

/// The turn by a rotation vector. Its bits differ from those of [`Quat::exponential`], and the members of a seed keep theirs.
fn turned_by(vector: Vec3<f64>) -> Quat<f64> {
    let half = vector * 0.5;
    let (sinc, cos) = half.norm_squared().sinc_cos_of_root();
    Quat::new(cos, half * sinc)
}

/// A member that could not be drawn.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("none of {draws} tensors drawn is that of a physical body; the last: {last}")]
#[non_exhaustive]
pub struct NoMember {
    /// How many were drawn.
    pub draws: u32,
    /// What is wrong with the last.
    pub last: InertiaError,
}
