//! A file that lists members: a CSV with a header, a member a row.

use std::path::Path;

use nalgebra::Matrix3;
use polhode::body::Member;
use polhode::inertia::Inertia;
use polhode::rotation::{Quat, Vec3};
use polhode_files::error::Error;
use polhode_files::numbers::number;
use polhode_files::read;

use super::nominal::Nominal;
use super::{Acting, Plan};

/// Columns by what they are together; each group is stated in whole or not at all.
const GROUPS: [(&str, &[&str]); 4] = [
    ("moments", &["i1", "i2", "i3"]),
    ("tensor", &["ixx", "iyy", "izz", "ixy", "ixz", "iyz"]),
    ("attitude", &["q_w", "q_x", "q_y", "q_z"]),
    ("angular velocity", &["omega_x", "omega_y", "omega_z"]),
];
/// Columns that say nothing of the motion.
const NAMES: [&str; 2] = ["name", "id"];

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

/// Places of the groups in the numbers that are kept of a row.
#[derive(Clone, Debug)]
struct Columns {
    moments: Option<usize>,
    tensor: Option<usize>,
    attitude: Option<usize>,
    omega: Option<usize>,
    width: usize,
}

impl Candidates {
    /// Reads the file, and checks every row.
    pub(super) fn read(path: &Path, nominal: &Nominal, plan: &Plan) -> Result<Self, Error> {
        let text = read(path, "name a CSV with a header and a member a row")?;
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
        let place = |line: u64| format!("{}:{line}", path.display());
        let unreadable = |error: csv::Error| {
            let line = error.position().map_or(1, csv::Position::line);
            if let csv::ErrorKind::UnequalLengths { expected_len, len, .. } = error.kind() {
                let rule = format!("{len} cells, and the header has {expected_len}");
                return Error::Input(format!("{}: {rule}; give every row as many", place(line)));
            }
            Error::Input(format!("{}: {error}; needed is a CSV with a header", place(line)))
        };
        let header = reader.headers().map_err(unreadable)?.clone();
        let (columns, sources) = Columns::of(&header, &place(1), nominal)?;
        let mut found = Self {
            columns,
            numbers: Vec::new(),
            inertia: nominal.inertia.clone(),
            attitude: nominal.attitude,
            omega: nominal.omega,
        };
        for row in reader.records() {
            let row = row.map_err(unreadable)?;
            let line = row.position().map_or(0, csv::Position::line);
            for (place_in_row, source) in sources.iter().enumerate() {
                let value = number(&row[*source]).map_err(|error| {
                    Error::Input(format!("{}: column {}: {error}", place(line), &header[*source]))
                })?;
                let is_rate =
                    found.columns.omega.is_some_and(|omega| (omega..omega + 3).contains(&place_in_row));
                found.numbers.push(if is_rate { value * nominal.units.rate } else { value });
            }
            let k = found.len() - 1;
            found
                .check(k, &nominal.acting, plan)
                .map_err(|error| Error::Input(format!("{}: {error}; mend or remove the row", place(line))))?;
        }
        if found.numbers.is_empty() {
            return Err(Error::Input(format!("{}: no rows; give a member a row", place(1))));
        }
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
        let body = acting.on(member.inertia).map_err(|error| error.to_string())?;
        plan.check(&body, member.attitude, member.omega_body)
    }

    /// The member of row `k`.
    pub(super) fn member(&self, k: u64) -> Result<Member, String> {
        let Columns { moments, tensor, attitude, omega, width } = self.columns;
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

impl Columns {
    /// The groups that a header states, and for each number that is kept the column it comes from.
    fn of(header: &csv::StringRecord, place: &str, nominal: &Nominal) -> Result<(Self, Vec<usize>), Error> {
        let known = || GROUPS.iter().flat_map(|(_, names)| names.iter().copied()).chain(NAMES);
        // other tables here call it by its full name
        let short = |name: &str| name.replace("omega_body_", "omega_").to_lowercase();
        let names: Vec<String> = header.iter().map(short).collect();
        if let Some(k) = names.iter().position(|name| !known().any(|known| known == name)) {
            return Err(Error::unknown_name(place, "column", &header[k], known().collect::<Vec<_>>()));
        }
        let mut places = [None; 4];
        let mut sources: Vec<usize> = Vec::new();
        for ((what, group), start) in GROUPS.iter().zip(&mut places) {
            let found: Vec<Option<usize>> =
                group.iter().map(|wanted| names.iter().position(|name| name == wanted)).collect();
            if found.iter().all(Option::is_none) {
                continue;
            }
            *start = Some(sources.len());
            for (column, wanted) in found.into_iter().zip(*group) {
                let rule = format!("missing beside the other columns of the {what}");
                sources.push(column.ok_or_else(|| Error::input(place, wanted, &rule, "add the column"))?);
            }
        }
        let [moments, tensor, attitude, omega] = places;
        let refused = |rule: &str, remedy: &str| Err(Error::input(place, "", rule, remedy));
        match (moments, tensor) {
            (Some(_), Some(_)) => return refused("moments and a tensor are given", "leave one of them out"),
            (None, None) if nominal.inertia.is_none() => {
                return refused("no columns of the inertia", "add i1,i2,i3 or ixx,...,iyz, or give [body]");
            }
            _ => {}
        }
        if omega.is_none() && nominal.omega.is_none() {
            return refused(
                "no columns of the angular velocity",
                "add omega_x,omega_y,omega_z, or give [start]",
            );
        }
        if sources.is_empty() {
            return refused("no columns that tell members apart", "add some, or leave members_file out");
        }
        let width = sources.len();
        Ok((Self { moments, tensor, attitude, omega, width }, sources))
    }
}
