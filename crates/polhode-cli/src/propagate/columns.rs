//! The columns of a trajectory, of which a user may choose.

use nalgebra::Vector3;
use polhode::body::{Body, Conserved, Point, State, Time};
use polhode::observe::{Errors, Invariants};
use polhode::rotation::{EulerSequence, Vec3};
use polhode::units::Date;
use polhode_files::error::Error;
use polhode_pages::table::{Cell, Column, Table};

/// One quantity of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    Time,
    Attitude(usize),
    Omega(usize),
    Angle(usize),
    Energy,
    Momentum,
    EnergyError,
    MomentumError,
    MomentumVectorError,
    MomentumZError,
    JacobiError,
    AttitudeError,
    /// Of the time, where t = 0 has a date.
    JulianDate,
    /// Longitude and latitude of the direction to an observer in the axes of the body.
    Observer(usize),
}

use Quantity::{
    Angle, Attitude, AttitudeError, Energy, EnergyError, JacobiError, JulianDate, Momentum, MomentumError,
    MomentumVectorError, MomentumZError, Observer, Omega,
};

/// Group, name, unit, meaning and digits of each quantity, in the order of the columns.
const ALL: [(Quantity, &str, &str, &str, &str, usize); 22] = [
    (Quantity::Time, "t", "t", "s", "time", 6),
    (Attitude(0), "q", "q_w", "", "attitude, body to space, scalar part", 6),
    (Attitude(1), "q", "q_x", "", "attitude, x", 6),
    (Attitude(2), "q", "q_y", "", "attitude, y", 6),
    (Attitude(3), "q", "q_z", "", "attitude, z", 6),
    (Omega(0), "omega", "omega_body_x", "rad/s", "angular velocity, body axis x", 6),
    (Omega(1), "omega", "omega_body_y", "rad/s", "angular velocity, body axis y", 6),
    (Omega(2), "omega", "omega_body_z", "rad/s", "angular velocity, body axis z", 6),
    (Energy, "energy", "energy", "J", "energy", 6),
    (Momentum, "momentum", "momentum", "kg m^2/s", "size of the angular momentum", 6),
    (EnergyError, "errors", "energy_error", "", "largest relative error of the energy so far", 2),
    (MomentumError, "errors", "momentum_error", "", "largest relative error of |m| so far", 2),
    (
        MomentumVectorError,
        "errors",
        "momentum_vector_error",
        "",
        "largest relative error of L in space so far",
        2,
    ),
    (
        MomentumZError,
        "errors",
        "momentum_z_error",
        "",
        "largest relative error of L along space z, under torque",
        2,
    ),
    (AttitudeError, "errors", "attitude_error", "rad", "angle to the exact attitude", 2),
    (JacobiError, "errors", "jacobi_error", "", "largest relative error of E - n L_z so far", 2),
    (Angle(0), "euler", "phi", "rad", "first Euler angle", 6),
    (Angle(1), "euler", "theta", "rad", "second Euler angle", 6),
    (Angle(2), "euler", "psi", "rad", "third Euler angle", 6),
    (Observer(0), "observer", "observer_longitude", "rad", "of the direction to the observer, body axes", 6),
    (Observer(1), "observer", "observer_latitude", "rad", "of the direction to the observer, body axes", 6),
    (JulianDate, "jd", "jd", "d", "Julian date in the time scale of the epoch", 12),
];

/// The columns of one run.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    /// Places in [`ALL`].
    places: Vec<usize>,
    asked: Asked,
}

/// What columns beside those of every motion are worked out by.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Asked {
    pub(super) sequence: Option<EulerSequence>,
    /// Direction to the observer, axes of space.
    pub(super) observer: Option<Vec3<f64>>,
    /// The date of t = 0.
    pub(super) epoch: Option<Date>,
}

/// What a row is made of.
pub(super) struct Reading<'a> {
    pub(super) at: Time,
    /// Body axes.
    pub(super) state: State,
    /// Body axes, rad/s.
    pub(super) omega: Vector3<f64>,
    /// In the solver frame.
    pub(super) point: &'a Point<f64>,
    /// The largest errors so far, where they are asked for.
    pub(super) worst: Option<Errors>,
    pub(super) attitude_error: Option<f64>,
}

impl Columns {
    /// Those that `fields` names, by groups or by columns, or all that the motion of `body` has.
    pub(super) fn chosen(fields: &[String], asked: Asked, body: &Body) -> Result<Self, Error> {
        let has = |quantity: Quantity| match quantity {
            JacobiError => has_jacobi(body),
            Angle(_) => asked.sequence.is_some(),
            Observer(_) => asked.observer.is_some(),
            JulianDate => asked.epoch.is_some(),
            _ => true,
        };
        let mut places: Vec<usize> = Vec::new();
        for field in fields {
            let named = ALL.iter().enumerate();
            let mut named: Vec<usize> = named
                .filter(|(_, (_, group, name, ..))| group == field || name == field)
                .map(|(place, _)| place)
                .collect();
            if named.is_empty() {
                let mut known: Vec<&str> =
                    ALL.iter().flat_map(|(_, group, name, ..)| [*group, *name]).collect();
                known.sort_unstable();
                known.dedup();
                return Err(Error::unknown_name("--fields", "column", field, known));
            }
            // angles that are asked for by name need no sequence
            named.retain(|place| field == "euler" || matches!(ALL[*place].0, Angle(_)) || has(ALL[*place].0));
            if named.is_empty() {
                return Err(no_such(field));
            }
            if named.iter().any(|place| places.contains(place)) {
                return Err(Error::input("--fields", field, "names a column twice", "name each once"));
            }
            places.extend(named);
        }
        if fields.is_empty() {
            // a date is another name of the time: by name alone
            let shown = |place: &usize| ALL[*place].0 != JulianDate && has(ALL[*place].0);
            places = (0..ALL.len()).filter(shown).collect();
        }
        if places.is_empty() {
            return Err(no_such(&fields.join(",")));
        }
        if asked.observer.is_some() && !places.iter().any(|place| matches!(ALL[*place].0, Observer(_))) {
            let rule = "none of its columns is among --fields";
            return Err(Error::input("--observer", "", rule, "add observer there, or leave it out"));
        }
        Ok(Self { places, asked })
    }

    /// As [`chosen`](Self::chosen), of single states: without what is compared with a start or an exact motion.
    pub(super) fn of_states(fields: &[String], asked: Asked, body: &Body) -> Result<Self, Error> {
        let mut columns = Columns::chosen(fields, asked, body)?;
        let is_error = |place: &usize| ALL[*place].1 == "errors";
        if let (false, Some(place)) = (fields.is_empty(), columns.places.iter().find(|place| is_error(place)))
        {
            let rule = "is an error along a run, and the rows of --event are events";
            return Err(Error::input("--fields", ALL[*place].2, rule, "leave it out"));
        }
        columns.places.retain(|place| !is_error(place));
        Ok(columns)
    }

    pub(super) fn columns(&self) -> Vec<Column> {
        let column = |place: &usize| {
            let (_, _, name, unit, meaning, digits) = ALL[*place];
            Column::new(name, unit, meaning).digits(digits)
        };
        self.places.iter().map(column).collect()
    }

    pub(super) fn table(&self) -> Table {
        Table::new("trajectory", "Motion of a body.", self.columns())
    }

    fn quantities(&self) -> impl Iterator<Item = Quantity> + '_ {
        self.places.iter().map(|place| ALL[*place].0)
    }

    /// Whether errors of invariants are among them, which every step is watched for.
    pub(super) fn errors(&self) -> bool {
        let watched = [EnergyError, MomentumError, MomentumVectorError, MomentumZError, JacobiError];
        self.quantities().any(|quantity| watched.contains(&quantity))
    }

    /// Whether the attitude is compared with the exact one.
    pub(super) fn attitude_error(&self) -> bool {
        self.quantities().any(|quantity| quantity == AttitudeError)
    }

    /// The cells of a row; only what has a column is worked out.
    pub(super) fn cells<'a>(
        &'a self,
        body: &'a Body,
        reading: &'a Reading<'a>,
    ) -> impl Iterator<Item = Cell> + 'a {
        let angles = self.quantities().any(|quantity| matches!(quantity, Angle(_)));
        let sequence = self.asked.sequence.unwrap_or_default();
        let angles = angles.then(|| sequence.angles(reading.state.rotation()).angles);
        let seen = self.asked.observer.map(|observer| {
            let [x, y, z] = reading.state.attitude.rotate_back(observer).0;
            let longitude = libm::atan2(y, x).rem_euclid(core::f64::consts::TAU);
            [longitude, libm::atan2(z, libm::hypot(x, y))]
        });
        let energies = self.quantities().any(|quantity| matches!(quantity, Energy | Momentum));
        let invariants = energies.then(|| Invariants::of(body, reading.at, reading.point));
        self.quantities().map(move |quantity| match quantity {
            Quantity::Time => reading.at.seconds::<f64>().into(),
            Attitude(k) => reading.state.attitude.components()[k].into(),
            Omega(k) => reading.omega[k].into(),
            Angle(k) => angles.map(|angles| angles[k]).into(),
            Energy => invariants.map(|found| found.energy.hi() * body.scale()).into(),
            Momentum => invariants.map(|found| found.momentum_norm().hi() * body.scale()).into(),
            EnergyError => reading.worst.and_then(|worst| worst.energy).into(),
            MomentumError => reading.worst.and_then(|worst| worst.momentum_norm).into(),
            MomentumVectorError => reading.worst.and_then(|worst| worst.momentum_vector).into(),
            MomentumZError => reading.worst.and_then(|worst| worst.momentum_z).into(),
            JacobiError => reading.worst.and_then(|worst| worst.jacobi).into(),
            AttitudeError => reading.attitude_error.into(),
            Observer(k) => seen.map(|seen| seen[k]).into(),
            JulianDate => self.asked.epoch.map(|epoch| epoch.later(reading.at.seconds()).julian()).into(),
        })
    }
}

/// Fields that this motion does not have.
fn no_such(fields: &str) -> Error {
    let remedy = "name others; jd needs --epoch, observer needs --observer";
    Error::input("--fields", fields, "the motion has no such quantity", remedy)
}

/// Whether Jacobi's constant is what the motion conserves in place of the energy.
fn has_jacobi(body: &Body) -> bool {
    let conserved = body.conserved();
    !conserved.contains(&Conserved::Energy) && conserved.iter().any(|q| matches!(q, Conserved::Jacobi { .. }))
}
