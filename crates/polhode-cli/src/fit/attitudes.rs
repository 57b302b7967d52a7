//! The attitudes of files: which columns are fitted, and in which convention they are read.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use nalgebra::{UnitQuaternion, Vector3};
use polhode::audit::{Attitudes, Convention, Direction, Frame, Reading, Trajectory};
use polhode_files::ReadAs;
use polhode_files::error::{Error, tell, warn};
use polhode_files::numbers::positive;
use polhode_files::text::visible;
use polhode_files::trajectory::{self, FoundTrajectory};
use polhode_fit::Poses;

use super::frames::{Left, about_space};
use crate::flags::attitude::{AttitudeArguments, check_matrices};
use crate::flags::record::{RecordArguments, tell_shared};

/// What of a file is fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum From {
    /// Angular velocities
    Rates,
    /// Attitudes
    Attitudes,
    /// Attitudes and angular velocities of the same rows, whose errors are independent
    Both,
}

/// What is fitted, and how attitudes are read.
#[derive(Args, Clone, Debug)]
pub(super) struct PoseArguments {
    /// Which columns are fitted [default: the rates if there are any, else the attitudes]
    #[arg(long, value_enum, help_heading = "Reading")]
    from: Option<From>,
    #[command(flatten)]
    convention: AttitudeArguments,
    /// Standard deviation of the noise of an attitude, each component of its rotation vector, rad [default: that of the residuals]
    #[arg(long, value_name = "SIGMA", value_parser = positive, allow_hyphen_values = true, help_heading = "Noise and smoothing")]
    attitude_noise: Option<f64>,
}

/// What is fitted.
pub(super) enum Chosen {
    /// Angular velocities; `beside` are the files whose attitudes are not.
    Rates { beside: Vec<PathBuf> },
    /// Attitudes, alone or with angular velocities; `beside` are the files whose rates are not, because others have none.
    Attitudes { beside: Vec<PathBuf> },
}

impl Chosen {
    /// Says which attitudes, or which rates, are not fitted.
    pub(super) fn tell(&self) {
        let (beside, text) = match self {
            Self::Rates { beside } => (
                beside,
                "the rates are fitted, and the attitudes beside them are not. --from both fits both, but their errors must be \
                 independent: not for attitudes that were computed from these rates",
            ),
            Self::Attitudes { beside } => (
                beside,
                "its attitudes are fitted, and the rates beside them are not, because another file has attitudes alone: fit \
                 the files separately, or state --from attitudes",
            ),
        };
        for path in beside {
            let name = visible(&path.display().to_string()).into_owned();
            tell("note", &format!("{name}: {text}"));
        }
    }
}

/// Attitudes and how they were read.
pub(super) struct Read {
    pub(super) poses: Poses,
    /// The convention of the numbers, in words.
    pub(super) form: String,
    /// The direction that names or flags state.
    pub(super) stated: Option<Direction>,
    /// Units of each file.
    pub(super) read_as: Vec<ReadAs>,
    has_quaternions: bool,
    has_angles: bool,
}

impl PoseArguments {
    pub(super) fn noise(&self) -> Option<f64> {
        self.attitude_noise
    }

    /// What of the files is fitted.
    pub(super) fn chosen(&self, data: &[PathBuf], reading: &RecordArguments) -> Chosen {
        let beside = match self.from {
            Some(From::Rates) => Vec::new(),
            Some(From::Attitudes | From::Both) => return Chosen::Attitudes { beside: Vec::new() },
            None => {
                // standard input and pipes are read once, and for their rates
                let files = data.iter().filter(|path| path.is_file());
                // what is wrong with a file is said where it is read
                let found =
                    files.filter_map(|path| Some((path, trajectory::columns(path, &reading.table()).ok()?)));
                let found: Vec<_> = found.filter(|(_, found)| found.attitudes).collect();
                let is_bare = found.iter().any(|(_, found)| !found.rates);
                let with_rates = found.into_iter().filter(|(_, found)| found.rates);
                let beside = with_rates.map(|(path, _)| path.clone()).collect();
                if is_bare {
                    return Chosen::Attitudes { beside };
                }
                beside
            }
        };
        Chosen::Rates { beside }
    }

    /// Refuses a flag that says how attitudes are written where none are read, not even `beside` the rates.
    pub(super) fn check_stated(&self, beside: &[PathBuf]) -> Result<(), Error> {
        let Some((flag, value)) = self.convention.given().filter(|_| beside.is_empty()) else {
            return Ok(());
        };
        let rule = "says how attitudes are written, and the rates are fitted";
        let remedy = "leave it out, or fit the attitudes: --from attitudes";
        Err(Error::input(flag, &value, rule, remedy))
    }

    /// Refuses files whose rates, by the attitudes beside them, are those about the axes of space.
    pub(super) fn check_frames(&self, beside: &[PathBuf], reading: &RecordArguments) -> Result<(), Error> {
        let (mut has_quaternions, mut has_angles) = (beside.is_empty(), beside.is_empty());
        for path in beside {
            let name = visible(&path.display().to_string()).into_owned();
            // a row that cannot be read may be left out of rates, and not of attitudes
            let of_rates = |error| match error {
                Error::Table(error) if error.is_of_a_row() => {
                    let remedy = format!("{}, or fit the rates as they are: --from rates", error.remedy);
                    Error::from(error.with_remedy(&remedy))
                }
                other => other,
            };
            let mut found = trajectory::read(path, &reading.table()).map_err(of_rates)?;
            for (_, rows) in &found.bodies {
                has_quaternions |= matches!(rows.attitude, Some(Attitudes::Quaternions(_)));
                has_angles |= matches!(rows.attitude, Some(Attitudes::Angles(_)));
            }
            self.convention.note_order(&found.claims, &name);
            self.convention.order(&mut found)?;
            let claims = self.convention.claims(found.claims);
            let [(_, rows)] = &found.bodies[..] else { continue };
            // attitudes whose convention nobody knows say nothing
            let Ok(convention) = convention(rows, &claims, &name) else { continue };
            let attitudes =
                (0..rows.times.len()).map(|row| convention.attitude(rows, row).map(UnitQuaternion::from));
            let Some(attitudes) = attitudes.collect::<Option<Vec<_>>>() else { continue };
            let rates = rates(rows, &convention, &claims, reading, &name)?;
            if let Some(Left { body, space }) = about_space(&rows.times, &attitudes, &rates, claims.attitude)
            {
                let rule = format!(
                    "its rates are those about the axes of space: there they differ by {space:.1e} rad/s from those of its attitudes, about the axes of the body by {body:.1e} rad/s"
                );
                let remedy = "turn them into axes of the body, fit --from attitudes, or state --from rates to fit them as they are";
                return Err(Error::input(&name, "", &rule, remedy));
            }
        }
        self.convention.check_forms(has_quaternions, has_angles)
    }

    /// The attitudes of all files and windows.
    pub(super) fn read(&self, data: &[PathBuf], reading: &RecordArguments) -> Result<Read, Error> {
        reading.check_windows(data.len())?;
        match (self.from, reading.axes()) {
            (Some(From::Both), _) => reading.tell_axes(),
            (_, Some(axes)) => {
                let rule = "says which columns are the rates, and attitudes are fitted";
                return Err(Error::input(
                    "--axes",
                    &axes.to_string(),
                    rule,
                    "leave it out, or fit the rates",
                ));
            }
            _ => {}
        }
        if let Some(unit) = reading.rate_unit().filter(|_| self.from != Some(From::Both)) {
            let rule = "is the unit of the rates, and attitudes are fitted";
            let remedy = "leave it out, or fit the rates";
            return Err(Error::input("--rate-unit", &unit.to_string(), rule, remedy));
        }
        if let Some(share) = reading.skipped_share() {
            let rule = "every row of attitudes is read";
            let remedy = "leave it out, and remove the rows that cannot be read";
            return Err(Error::input("--skip-rows", &share.to_string(), rule, remedy));
        }
        let mut all: Option<Read> = None;
        for (k, path) in data.iter().enumerate() {
            let mut one = self.of_file(path, reading)?;
            let windows = reading.windows(k);
            if !windows.is_empty() {
                let cut = one.poses.windows(&windows);
                one.poses = cut.map_err(|error| Error::Input(format!("{}: {error}", path.display())))?;
            }
            all = Some(match all {
                None => one,
                Some(before) => {
                    let name = visible(&path.display().to_string()).into_owned();
                    tell_shared(&name, (before.poses.shared(&one.poses), one.poses.samples()));
                    joined(before, one, path)?
                }
            });
        }
        let all = all.ok_or_else(|| Error::Input("--window: no file has samples in these windows".into()))?;
        self.convention.check_forms(all.has_quaternions, all.has_angles)?;
        Ok(all)
    }

    fn of_file(&self, path: &Path, reading: &RecordArguments) -> Result<Read, Error> {
        let name = visible(&path.display().to_string()).into_owned();
        let refused = |rule: &str, remedy: &str| Error::input(&name, "", rule, remedy);
        let mut found = trajectory::read(path, &reading.table())?;
        self.convention.note_order(&found.claims, &name);
        self.convention.order(&mut found)?;
        let remark = found.remark();
        let claims = self.convention.claims(found.claims);
        let FoundTrajectory { mut bodies, counts_steps, mut read_as, .. } = found;
        let (1, Some((_, rows))) = (bodies.len(), bodies.pop()) else {
            return Err(refused(
                "it has several bodies, and a tensor is of one",
                "name its columns by --columns",
            ));
        };
        if counts_steps {
            return Err(refused(
                "it counts steps in place of times",
                "give the length of a step, s, as --time-unit",
            ));
        }
        if let Some(remark) = remark {
            warn(&format!("{name}: {remark}"));
        }
        let convention = convention(&rows, &claims, &name)?;
        if let Some(Attitudes::Matrices(matrices)) = &rows.attitude {
            check_matrices(matrices, &rows.times, &name)?;
        }
        let attitudes =
            (0..rows.times.len()).map(|row| convention.attitude(&rows, row).map(UnitQuaternion::from));
        let Some(attitudes) = attitudes.collect::<Option<Vec<_>>>() else {
            return Err(refused(
                "it has no attitudes",
                "name the columns of a quaternion, a matrix or Euler angles by --columns",
            ));
        };
        let poses = match self.from {
            Some(From::Both) => {
                read_as.axes = reading.axes();
                let rates = rates(&rows, &convention, &claims, reading, &name)?;
                Poses::with_rates(&name, &rows.times, &attitudes, &rates)
            }
            _ => {
                read_as.rates = None;
                Poses::new(&name, &rows.times, &attitudes)
            }
        };
        let poses = poses.map_err(|error| Error::Input(error.to_string()))?;
        let poses = if claims.attitude.is_none() { poses.with_open_direction() } else { poses };
        let mut words = convention;
        (words.attitude, words.omega_frame, words.rate_unit) = (None, None, None);
        let form = match words.to_string() {
            plain if plain.is_empty() => rows.attitude.as_ref().map_or("", Attitudes::name).into(),
            plain => plain,
        };
        Ok(Read {
            poses,
            form,
            stated: claims.attitude,
            read_as: vec![read_as],
            has_quaternions: matches!(rows.attitude, Some(Attitudes::Quaternions(_))),
            has_angles: matches!(rows.attitude, Some(Attitudes::Angles(_))),
        })
    }
}

/// Files of one convention and one direction.
fn joined(before: Read, next: Read, path: &Path) -> Result<Read, Error> {
    if (before.stated.is_some(), before.poses.has_rates()) != (next.stated.is_some(), next.poses.has_rates())
    {
        let rule = "its attitudes state another direction, or other columns, than those of the files before";
        return Err(Error::input(
            &path.display().to_string(),
            "",
            rule,
            "fit the files separately, or state --attitude",
        ));
    }
    let form = if before.form == next.form { before.form } else { format!("{}; {}", before.form, next.form) };
    let read_as = [before.read_as, next.read_as].concat();
    Ok(Read {
        poses: before.poses.join(next.poses),
        form,
        stated: before.stated,
        read_as,
        has_quaternions: before.has_quaternions || next.has_quaternions,
        has_angles: before.has_angles || next.has_angles,
    })
}

/// The convention of the attitudes. What the motion cannot tell must be stated: of a quaternion the place of the scalar, since the other
/// place is the inverse attitude in turned axes, and of Euler angles their sequence and unit.
fn convention(rows: &Trajectory, claims: &Convention, name: &str) -> Result<Reading, Error> {
    let refused = |rule: &str, remedy: &str| Err(Error::input(name, "", rule, remedy));
    let mut reading = Reading::default();
    reading.attitude = Some(claims.attitude.unwrap_or(Direction::BodyToSpace));
    match &rows.attitude {
        Some(Attitudes::Quaternions(_)) if claims.quaternion.is_none() => {
            return refused(
                "neither the numbers of its quaternions nor the motion shows which component is the scalar",
                "state --quaternion wxyz or xyzw",
            );
        }
        Some(Attitudes::Quaternions(_)) => reading.quaternion = claims.quaternion,
        Some(Attitudes::Angles(_)) if claims.angles.is_none() => {
            return refused(
                "it does not name the sequence of its Euler angles",
                "state --euler, as zyx, or zyx:extrinsic",
            );
        }
        Some(Attitudes::Angles(_)) if claims.angle_unit.is_none() => {
            return refused("it does not name the unit of its Euler angles", "state --angle-unit rad or deg");
        }
        Some(Attitudes::Angles(_)) => reading.angles = claims.angles,
        _ => {}
    }
    Ok(reading)
}

/// The angular velocities beside the attitudes, rad/s, in body axes of their own.
fn rates(
    rows: &Trajectory,
    convention: &Reading,
    claims: &Convention,
    reading: &RecordArguments,
    name: &str,
) -> Result<Vec<Vector3<f64>>, Error> {
    if claims.omega_frame == Some(Frame::Space) {
        let rule = "its angular velocity is in axes of space, and the fit needs it in axes of the body";
        return Err(Error::input(name, "", rule, "fit its attitudes alone: --from attitudes"));
    }
    let mut convention = *convention;
    (convention.omega_frame, convention.rate_unit) = (Some(Frame::Body), claims.rate_unit);
    let one = |row: usize| {
        let [x, y, z] = convention.omega_body(rows, row)?.0;
        Some(Vector3::from(reading.axes().map_or([x, y, z], |axes| axes.apply([x, y, z]))))
    };
    let all: Option<Vec<Vector3<f64>>> = (0..rows.times.len()).map(one).collect();
    all.ok_or_else(|| {
        Error::input(name, "", "it has no angular velocities", "name their columns, or fit --from attitudes")
    })
}
