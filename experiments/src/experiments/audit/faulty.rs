//! Records with one fault each: of rows, of columns, of time stamps, of the body and of what acts on it. The generators know
//! nothing of the judge.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::Force;
use polhode::method::method;
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};
use polhode::run::{Run, Watch};
use polhode_files::error::{Error, unexpected};

use super::motion::{Row, exact, generic};
use super::specimen::Specimen;

/// What is done to a record.
type Spoil = fn(&mut Specimen, &mut Random) -> Result<(), Error>;

/// A fault: its name, and what it does.
pub(super) type Fault = (&'static str, Spoil);

pub(super) const FAULTS: [Fault; 42] = [
    ("attitude of one row lost", |x, r| x.one(r, |row, _| row.attitude = Quat::identity())),
    ("attitude of one row inverted", |x, r| x.one(r, |row, _| row.attitude = row.attitude.conjugate())),
    ("attitude of one row with a wrong sign", |x, r| x.one(r, |row, _| row.attitude.v.0[1] *= -1.0)),
    ("attitude of one row with two components exchanged", |x, r| {
        x.one(r, |row, _| row.attitude.v.0.swap(0, 2))
    }),
    ("attitude of one row off by 1e-5", |x, r| x.one(r, |row, r| row.turn(r, 1e-5))),
    ("attitude of ten rows off by 1e-4", |x, r| x.some(r, 10, |row, r| row.turn(r, 1e-4))),
    ("attitude of the last row off by 1e-3", |x, r| x.at(usize::MAX, r, |row, r| row.turn(r, 1e-3))),
    ("attitude of the first row off by 1e-3", |x, r| x.at(0, r, |row, r| row.turn(r, 1e-3))),
    ("angular velocity of one row lost", |x, r| x.one(r, |row, _| row.omega = Vec3::zero())),
    ("angular velocity of one row reversed", |x, r| x.one(r, |row, _| row.omega = row.omega * -1.0)),
    ("angular velocity of one row off by 1e-5", |x, r| x.one(r, |row, r| row.push(r, 1e-5))),
    ("angular velocity of ten rows off by 1e-4", |x, r| x.some(r, 10, |row, r| row.push(r, 1e-4))),
    ("angular velocity of the last row off by 1e-3", |x, r| x.at(usize::MAX, r, |row, r| row.push(r, 1e-3))),
    ("angular velocity of one row with axes exchanged", |x, r| x.one(r, |row, _| row.omega.0.swap(0, 1))),
    ("one axis of the angular velocity 1 % too large", |x, r| {
        let axis = r.below(3) as usize;
        x.all(r, |row, _| row.omega.0[axis] *= 1.01)
    }),
    ("angular velocity 0.1 % too large", |x, r| x.all(r, |row, _| row.omega = row.omega * 1.001)),
    ("angular velocity with an offset of 1e-4", |x, r| {
        let offset = Vec3::from(generic(r)) * (1e-4 * x.rows[0].omega.norm());
        x.all(r, |row, _| row.omega = row.omega + offset)
    }),
    ("angular velocity one row late", |x, _| x.late(false, true)),
    ("attitude one row late", |x, _| x.late(true, false)),
    ("every second row frozen", |x, _| x.freeze((1..x.rows.len()).step_by(2).collect(), true)),
    ("five rows frozen", |x, r| {
        let first = x.place(r, 6);
        x.freeze((first..first + 5).collect(), true)
    }),
    ("attitude of five rows frozen", |x, r| {
        let first = x.place(r, 6);
        x.freeze((first..first + 5).collect(), false)
    }),
    ("two neighbours exchanged", |x, r| {
        let row = x.place(r, 2);
        x.exchange(row)
    }),
    ("all neighbours exchanged", |x, _| (0..x.rows.len() - 1).step_by(2).try_for_each(|row| x.exchange(row))),
    ("every second row interpolated", |x, _| x.interpolate(2)),
    ("every eighth row interpolated", |x, _| x.interpolate(8)),
    ("one row dropped and the times closed up", |x, r| {
        let row = x.place(r, 2).max(2);
        x.rows.remove(row);
        x.stamp()
    }),
    ("one row twice and the times moved on", |x, r| {
        let row = x.place(r, 2).max(2);
        x.rows.insert(row, x.rows[row]);
        x.stamp()
    }),
    ("time stamps with a jitter of 1e-3 of the interval", |x, r| {
        let interval = x.interval;
        x.all(r, |row, r| row.t += 1e-3 * interval * (r.between(0.0, 1.0) - 0.5))
    }),
    ("a clock that is 1e-4 too fast", |x, r| x.all(r, |row, _| row.t *= 1.0001)),
    ("a clock that jumps by a third of the interval", |x, r| {
        let (from, by) = (x.place(r, 2), x.interval / 3.0);
        x.rows[from..].iter_mut().for_each(|row| row.t += by);
        Ok(())
    }),
    ("thirty-three rows reset", |x, r| {
        let from = x.place(r, 40);
        x.rows[from..from + 33]
            .iter_mut()
            .for_each(|row| (row.attitude, row.omega) = (Quat::identity(), Vec3::zero()));
        Ok(())
    }),
    ("a turn of 1e-3 from one row on", |x, r| {
        let (from, turn) = (x.place(r, 2), small(r, 1e-3));
        x.rows[from..].iter_mut().for_each(|row| row.attitude = turn * row.attitude);
        Ok(())
    }),
    ("another motion from one row on", |x, r| {
        let from = x.place(r, 2);
        let (attitude, omega) = (x.rows[from].attitude, x.rows[from].omega + Vec3::from(generic(r)) * 1e-3);
        let (t, count) = (x.rows[from].t, (x.rows.len() - from) as u64);
        let later = x.motion_from((attitude.into(), omega.into()), count)?;
        for (row, new) in x.rows[from..].iter_mut().zip(later) {
            *row = Row { t: t + new.t, ..new };
        }
        Ok(())
    }),
    ("a drift of the attitude about an axis in space", |x, r| {
        let (axis, end) = (Vec3::from(generic(r)), x.end());
        x.all(r, |row, _| row.attitude = about(axis * (1e-4 * row.t / end)) * row.attitude)
    }),
    ("a drift of the attitude about an axis of the body", |x, r| {
        let (axis, end) = (Vec3::from(generic(r)), x.end());
        x.all(r, |row, _| row.attitude = row.attitude * about(axis * (1e-4 * row.t / end)))
    }),
    ("a component of the angular velocity clamped", |x, r| {
        let axis = r.below(3) as usize;
        let most = x.rows.iter().map(|row| row.omega.0[axis].abs()).fold(0.0, f64::max);
        x.all(r, |row, _| row.omega.0[axis] = row.omega.0[axis].clamp(-0.8 * most, 0.8 * most))
    }),
    ("an attitude that swings from row to row", |x, r| {
        let turn = small(r, 1e-3);
        let mut sign = false;
        x.all(r, |row, _| {
            sign = !sign;
            row.attitude = row.attitude * if sign { turn } else { turn.conjugate() };
        })
    }),
    ("noise of 1e-3 that nobody declares", |x, r| {
        x.all(r, |row, r| {
            let noise = Vec3::from(r.normal_vector()) * 1e-3;
            row.attitude = row.attitude * about(noise);
            row.omega = row.omega + Vec3::from(r.normal_vector()) * (1e-3 * row.omega.norm());
        })
    }),
    ("a moment of inertia 1 % off", |x, r| x.of_another_body(r, 1e-2)),
    ("a moment of inertia 0.1 % off", |x, r| x.of_another_body(r, 1e-3)),
    ("a weak torque that is not told", |x, r| {
        let size = 1e-3 * x.start.1.norm_squared() * x.moments[0];
        let force = Force::constant_torque_body(generic(r) * size).map_err(unexpected)?;
        let body = x.body()?.with(force);
        let start = body.state(x.start.0, x.start.1).map_err(unexpected)?;
        let rk8 = method("rk8").map_err(unexpected)?;
        let mut run =
            Run::new(&rk8, &body, &start, x.interval / 4.0).map_err(unexpected)?.watching(Watch::Never);
        for k in 0..x.rows.len() {
            let sample = run.advance_to(4 * k as u64).map_err(unexpected)?;
            let omega = Vec3::from(sample.omega_body);
            x.rows[k] = Row { attitude: sample.state.attitude.normalized(), omega, ..x.rows[k] };
        }
        Ok(())
    }),
];

/// The motion `right`, some hundred rows of it, with a fault.
pub(super) fn faulty(mut right: Specimen, (_, put): &Fault, random: &mut Random) -> Result<Specimen, Error> {
    put(&mut right, random)?;
    Ok(right)
}

/// Ways in which single rows of a long record are bad.
const BAD: [Spoil; 5] = [
    |x, r| x.one(r, |row, r| row.turn(r, 1e-3)),
    |x, r| x.one(r, |row, r| row.push(r, 1e-3)),
    |x, r| x.one(r, |row, _| (row.attitude, row.omega) = (Quat::identity(), Vec3::zero())),
    |x, r| {
        let row = x.place(r, 2);
        x.exchange(row)
    },
    |x, r| {
        let row = x.place(r, 2);
        x.freeze(vec![row], true)
    },
];

/// The long record `right` with `bad` bad rows of one kind, spread at random.
pub(super) fn bad_rows(mut right: Specimen, bad: usize, random: &mut Random) -> Result<Specimen, Error> {
    let kind = BAD[random.below(BAD.len() as u64) as usize];
    (0..bad).try_for_each(|_| kind(&mut right, random))?;
    Ok(right)
}

impl Specimen {
    fn motion_from(
        &self,
        (attitude, omega): (UnitQuaternion<f64>, Vector3<f64>),
        count: u64,
    ) -> Result<Vec<Row>, Error> {
        let body = self.body()?;
        let start = body.state(attitude, omega).map_err(unexpected)?;
        exact(&body, &start, self.interval, count)
    }

    fn end(&self) -> f64 {
        self.rows.last().map_or(1.0, |row| row.t)
    }

    /// A row with at least `behind` rows behind it.
    fn place(&self, random: &mut Random, behind: usize) -> usize {
        1 + random.below((self.rows.len() - 1 - behind) as u64) as usize
    }

    fn at(
        &mut self,
        row: usize,
        random: &mut Random,
        change: impl Fn(&mut Row, &mut Random),
    ) -> Result<(), Error> {
        let last = self.rows.len() - 1;
        change(&mut self.rows[row.min(last)], random);
        Ok(())
    }

    fn one(&mut self, random: &mut Random, change: impl Fn(&mut Row, &mut Random)) -> Result<(), Error> {
        let row = self.place(random, 1);
        self.at(row, random, change)
    }

    fn some(
        &mut self,
        random: &mut Random,
        count: usize,
        change: impl Fn(&mut Row, &mut Random),
    ) -> Result<(), Error> {
        (0..count).try_for_each(|_| self.one(random, &change))
    }

    fn all(
        &mut self,
        random: &mut Random,
        mut change: impl FnMut(&mut Row, &mut Random),
    ) -> Result<(), Error> {
        self.rows.iter_mut().for_each(|row| change(row, random));
        Ok(())
    }

    fn late(&mut self, attitude: bool, rates: bool) -> Result<(), Error> {
        for row in (1..self.rows.len()).rev() {
            let before = self.rows[row - 1];
            if attitude {
                self.rows[row].attitude = before.attitude;
            }
            if rates {
                self.rows[row].omega = before.omega;
            }
        }
        Ok(())
    }

    fn freeze(&mut self, rows: Vec<usize>, rates: bool) -> Result<(), Error> {
        for row in rows {
            let before = self.rows[row - 1];
            self.rows[row].attitude = before.attitude;
            if rates {
                self.rows[row].omega = before.omega;
            }
        }
        Ok(())
    }

    fn exchange(&mut self, row: usize) -> Result<(), Error> {
        let [a, b] = [self.rows[row], self.rows[row + 1]];
        self.rows[row] = Row { t: a.t, ..b };
        self.rows[row + 1] = Row { t: b.t, ..a };
        Ok(())
    }

    fn interpolate(&mut self, every: usize) -> Result<(), Error> {
        for row in (1..self.rows.len() - 1).step_by(every) {
            let [a, b] = [self.rows[row - 1], self.rows[row + 1]];
            let near = a.attitude.w * b.attitude.w + a.attitude.v.dot(b.attitude.v) >= 0.0;
            let other = if near { b.attitude } else { -b.attitude };
            self.rows[row].attitude = (a.attitude + other).normalized();
            self.rows[row].omega = (a.omega + b.omega) * 0.5;
        }
        Ok(())
    }

    /// Times at equal distances again.
    fn stamp(&mut self) -> Result<(), Error> {
        let interval = self.interval;
        self.rows.iter_mut().enumerate().for_each(|(k, row)| row.t = k as f64 * interval);
        Ok(())
    }

    /// The rows of a body one of whose moments is another.
    fn of_another_body(&mut self, random: &mut Random, by: f64) -> Result<(), Error> {
        let axis = random.below(3) as usize;
        let right = self.moments;
        self.moments[axis] *= 1.0 - by;
        let rows = self.motion_from(self.start, self.rows.len() as u64);
        self.moments = right;
        self.rows = rows?;
        Ok(())
    }
}

impl Row {
    fn turn(&mut self, random: &mut Random, angle: f64) {
        self.attitude = self.attitude * small(random, angle);
    }

    /// Changes ω by this part of it.
    fn push(&mut self, random: &mut Random, part: f64) {
        self.omega = self.omega + Vec3::from(generic(random)) * (part * self.omega.norm());
    }
}

/// A small turn about a random axis.
fn small(random: &mut Random, angle: f64) -> Quat<f64> {
    about(Vec3::from(generic(random)) * angle)
}

/// A turn by a small vector, in arithmetic alone.
fn about(v: Vec3<f64>) -> Quat<f64> {
    Quat::cayley(v * 0.5)
}
