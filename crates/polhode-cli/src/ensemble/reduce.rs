//! Mean attitude and dispersion over time, from the arrays of all shards.

use std::io;

use polhode::rotation::{Directions, Dispersion, Quat, Vec3};
use polhode_experiments::parallel;
use polhode_files::npy::Array;

use super::verify::NORM;

/// Memory for the members of one time, bytes a member: attitudes as read, as quaternions, their angles.
const BYTES: u64 = 32 + 32 + 8;
/// The same of directions to an observer, and their angles.
const BYTES_OF_OBSERVER: u64 = 24 + 8;
/// Memory that the times reduced side by side may take together.
const MOST: u64 = 200_000_000;

/// Dispersion of the members at one time.
#[derive(Clone, Debug)]
pub(super) struct Reduced {
    /// The sign follows that of the time before.
    pub(super) mean: [f64; 4],
    pub(super) root_mean_square: f64,
    /// Half of the members are no further from the mean; 95 % are.
    pub(super) median: f64,
    pub(super) p95: f64,
    pub(super) largest: f64,
    pub(super) deviations: [f64; 3],
    pub(super) axes: [[f64; 3]; 3],
    pub(super) members: u64,
    /// Where the observer stands in the sky of the members, if there is one.
    pub(super) seen: Option<Seen>,
}

/// The direction to the observer in the axes of the members.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    /// Longitude from x towards y and latitude, rad.
    pub(super) mean: [f64; 2],
    /// Angles to it that half of the members do not exceed, 95 % and none.
    pub(super) angles: [f64; 3],
}

/// How many times are reduced side by side on `threads` threads.
fn side_by_side(members: u64, threads: usize, is_observed: bool) -> usize {
    let room = (MOST / bytes(is_observed).saturating_mul(members).max(1)).max(1);
    threads.min(usize::try_from(room).unwrap_or(threads)).max(1)
}

/// Bytes that the reduction takes, with an observer or without.
pub(super) fn memory(members: u64, threads: usize, is_observed: bool) -> u64 {
    let together = side_by_side(members, threads, is_observed) as u64;
    bytes(is_observed).saturating_mul(members).saturating_mul(together)
}

fn bytes(is_observed: bool) -> u64 {
    BYTES + if is_observed { BYTES_OF_OBSERVER } else { 0 }
}

/// The attitude of a quaternion of any norm but zero, which would be its weight in the mean. One that is 1 to rounding stays as it is.
fn attitude(components: [f64; 4]) -> Quat<f64> {
    let q = Quat::from_components(components);
    if (q.norm_squared() - 1.0).abs() <= NORM {
        return q;
    }
    // squares may leave the range of a double
    let largest = q.magnitude();
    Quat::from_components(components.map(|x| x / largest)).normalized()
}

/// Every time of the arrays, whose members follow each other; `None` where no member has a row.
///
/// The numbers depend on the members and their order only: not on where one array ends and the next begins, nor on threads.
///
/// `observer`: the direction to it at each time, axes of space; none where there is none.
pub(super) fn reduce(
    arrays: &mut [Array<4>],
    members: u64,
    threads: usize,
    observer: &[Vec3<f64>],
) -> io::Result<Vec<Option<Reduced>>> {
    let times = arrays.first().map_or(0, Array::times);
    let batch = side_by_side(members, threads, !observer.is_empty());
    let mut reduced: Vec<Option<Reduced>> = Vec::with_capacity(times as usize);
    let mut next = 0;
    while next < times {
        let end = times.min(next + batch as u64);
        let mut slabs = Vec::with_capacity(batch);
        for time in next..end {
            let mut slab = Vec::new();
            let room = usize::try_from(members).ok().filter(|room| slab.try_reserve_exact(*room).is_ok());
            if room.is_none() {
                let rule = format!("the attitudes of {members} members do not fit into memory");
                return Err(io::Error::new(io::ErrorKind::OutOfMemory, rule));
            }
            for array in arrays.iter_mut() {
                // zeros stand where a member has no row
                let rows = array.entries(time)?.filter(|q| *q != [0.0; 4]);
                slab.extend(rows.map(attitude));
            }
            slabs.push((slab, observer.get(time as usize)));
        }
        let spread = |(slab, direction): (Vec<Quat<f64>>, Option<&Vec3<f64>>)| {
            let seen = direction.and_then(|direction| {
                let directions: Vec<_> = slab.iter().map(|q| q.rotate_back(*direction)).collect();
                Directions::of(&directions)
            });
            Some((Dispersion::of(&slab)?, seen))
        };
        for found in parallel::map(slabs, batch, spread) {
            let before = reduced.iter().rev().find_map(|row| row.as_ref().map(|row| row.mean));
            reduced.push(found.map(|(found, seen)| Reduced::of(&found, seen, before)));
        }
        next = end;
    }
    Ok(reduced)
}

impl Reduced {
    fn of(found: &Dispersion, seen: Option<Directions>, before: Option<[f64; 4]>) -> Self {
        let mean = found.mean().components();
        let is_turned_over =
            before.is_some_and(|before| before.iter().zip(mean).map(|(a, b)| a * b).sum::<f64>() < 0.0);
        Self {
            mean: if is_turned_over { mean.map(|x| -x) } else { mean },
            root_mean_square: found.root_mean_square(),
            median: found.quantile(0.5),
            p95: found.quantile(0.95),
            largest: found.largest(),
            deviations: found.deviations(),
            axes: found.axes().map(|axis| axis.0),
            members: found.count() as u64,
            seen: seen.map(|seen| {
                let [x, y, z] = seen.mean().0;
                let mean =
                    [libm::atan2(y, x).rem_euclid(core::f64::consts::TAU), libm::atan2(z, libm::hypot(x, y))];
                Seen { mean, angles: [0.5, 0.95, 1.0].map(|p| seen.quantile(p)) }
            }),
        }
    }
}
