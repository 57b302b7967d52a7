//! The members that a file lists.

use std::path::Path;

use nalgebra::Matrix3;
use polhode::body::Member;
use polhode::inertia::Inertia;
use polhode::rotation::{Quat, Vec3};
use polhode_files::error::Error;
use polhode_files::members::{self, Columns};

use super::nominal::Nominal;
use super::{Acting, Plan};

/// The members of a file.
#[derive(Debug)]
pub(super) struct Candidates {
    columns: Columns,
    /// Row after row.
    numbers: Vec<f64>,
    /// What rows do not state.
    inertia: Option<Inertia>,
    attitude: Quat<f64>,
    omega: Option<Vec3<f64>>,
}

impl Candidates {
    /// Reads the file, and checks every row.
    pub(super) fn read(path: &Path, nominal: &Nominal, plan: &Plan) -> Result<Self, Error> {
        let mut found = Self {
            columns: Columns::default(),
            numbers: Vec::new(),
            inertia: nominal.inertia.clone(),
            attitude: nominal.attitude,
            omega: nominal.omega,
        };
        let keep = |columns: &Columns, row: &[f64]| {
            found.columns = *columns;
            let is_rate = |place| columns.omega.is_some_and(|omega| (omega..omega + 3).contains(&place));
            let unit = |place| if is_rate(place) { nominal.units.rate } else { 1.0 };
            found.numbers.extend(row.iter().enumerate().map(|(place, value)| value * unit(place)));
            found.check(found.len() - 1, &nominal.acting, plan)
        };
        members::read(path, |columns| check(columns, nominal), keep)?;
        Ok(found)
    }

    pub(super) fn len(&self) -> u64 {
        (self.numbers.len() / self.columns.width) as u64
    }

    pub(super) fn bytes(&self) -> u64 {
        self.numbers.len() as u64 * 8
    }

    /// What is wrong with row `k`.
    fn check(&self, k: u64, acting: &Acting, plan: &Plan) -> Result<(), String> {
        let member = self.member(k)?;
        let body = acting.of_start(member.inertia, plan.start, member.omega_body);
        let body = body.map_err(|error| error.to_string())?;
        plan.check(&body, member.attitude, member.omega_body)
    }

    /// The member of row `k`.
    pub(super) fn member(&self, k: u64) -> Result<Member, String> {
        let Columns { moments, tensor, attitude, omega, width, .. } = self.columns;
        let row = self.numbers.chunks_exact(width).nth(k as usize).unwrap_or_default();
        let inertia = if let Some(moments) = taken::<3>(row, moments) {
            Inertia::from_moments(moments).map_err(|error| error.to_string())?
        } else if let Some([xx, yy, zz, xy, xz, yz]) = taken::<6>(row, tensor) {
            let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
            Inertia::from_tensor(tensor).map_err(|error| error.to_string())?
        } else {
            self.inertia.clone().ok_or("its inertia is missing")?
        };
        let attitude = taken::<4>(row, attitude).map_or(self.attitude, Quat::from_components);
        let omega =
            taken::<3>(row, omega).map(Vec3).or(self.omega).ok_or("its angular velocity is missing")?;
        Ok(Member::new(inertia, attitude, omega))
    }
}

/// The numbers of a group.
fn taken<const N: usize>(row: &[f64], place: Option<usize>) -> Option<[f64; N]> {
    row.get(place?..)?.first_chunk().copied()
}

/// Refuses columns that leave a member without inertia or angular velocity, or say nothing.
fn check(columns: &Columns, nominal: &Nominal) -> Result<(), (&'static str, &'static str)> {
    if columns.moments.is_none() && columns.tensor.is_none() && nominal.inertia.is_none() {
        return Err(("no columns of the inertia", "add i1,i2,i3 or ixx,...,iyz, or give [body]"));
    }
    if columns.omega.is_none() && nominal.omega.is_none() {
        return Err(("no columns of the angular velocity", "add omega_x,omega_y,omega_z, or give [start]"));
    }
    if columns.width == 0 {
        return Err(("no columns that tell members apart", "add some, or leave members_file out"));
    }
    Ok(())
}
