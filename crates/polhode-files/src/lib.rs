//! Files about rotating bodies: tables of angular velocity, attitude and time, robot models, meshes and arrays.
//!
//! One reader of tables finds the columns of phones, loggers, flight controllers and simulators by their names, with the
//! units and conventions that the names state. [`record`] (angular velocity), [`trajectory`] (attitudes) and [`times`] are
//! views of it; the same columns mean the same in each, and what cannot be read is refused in the same words, with file,
//! line, column, value, rule and remedy ([`TableError`]).
//!
//! ```
//! use polhode_files::{ReadOptions, record};
//! let log = "Timestamp,gyro.x,gyro.y,gyro.z\n100,0,90,0\n110,0,90,1\n";
//! let found = record::read(log, "crazyflie.csv", &ReadOptions::default())?;
//! let segment = &found.record.segments[0];
//! assert_eq!((segment.times().len(), segment.rates()[0].y), (2, core::f64::consts::FRAC_PI_2));
//!
//! let torn = record::read("t,wx,wy,wz\n0,1,2,3\n0.1,1,2", "log.csv", &ReadOptions::default());
//! assert!(torn.unwrap_err().to_string().starts_with("log.csv, line 3: the file ends in the middle of this row"));
//! # Ok::<(), polhode_files::Error>(())
//! ```
//!
//! Robot models ([`robots`]: URDF, MJCF, SDF) and meshes ([`mesh`]: STL, OBJ, PLY) give inertia tensors.

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
struct Readme;

pub mod bodies;
mod did_you_mean;
pub mod error;
pub mod examined;
pub mod given;
pub mod inputs;
pub mod instant;
mod look;
pub mod members;
pub mod mesh;
pub mod npy;
pub mod numbers;
pub mod orbit;
mod read;
mod read_as;
pub mod record;
pub mod robots;
mod table;
pub mod text;
pub mod times;
pub mod toml_file;
pub mod trajectory;
pub mod twins;
pub mod wheel;

pub use error::{Broken, Error, Rule, TableError};
pub use read::{read, read_own};
pub use read_as::{NamedBy, ReadAs};
pub use table::{ColumnNames, ReadOptions, SignedAxes};
