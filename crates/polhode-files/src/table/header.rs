//! Which columns of a header hold which quantity.

use polhode::audit::{Direction, Frame};
use polhode::units::{RateUnit, TimeUnit};

use super::flags::ColumnNames;
use super::name::Name;
use super::spellings::{
    ANGLE_ENDINGS, NO_ENDINGS, Quantity, RATE_ENDINGS, SPELLINGS, direction, frame, is_id,
};
use crate::error::Rule;

/// Columns of one quantity.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Group {
    pub(crate) quantity: Quantity,
    pub(crate) places: Vec<usize>,
    /// The unit that each name states.
    pub(crate) units: Vec<Option<String>>,
    /// The axes that the names state.
    pub(crate) frame: Option<Frame>,
    /// What an attitude takes where, as the names state it.
    pub(crate) direction: Option<Direction>,
    /// The axes, from 0, that the names of Euler angles say they turn about: of roll, pitch and yaw x, y and z.
    pub(crate) angle_axes: Option<[usize; 3]>,
    /// The names without the component.
    stem: &'static str,
    yields: bool,
}

/// The columns of one body.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Columns {
    pub(crate) label: Option<String>,
    pub(crate) attitude: Option<Group>,
    pub(crate) rates: Option<Group>,
    pub(crate) momentum: Option<Group>,
}

/// The columns of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Header {
    pub(crate) names: Vec<Name>,
    /// `None`: the rows are counted.
    pub(crate) time: Option<usize>,
    /// Whether a flag names the time.
    pub(crate) time_is_named: bool,
    /// Nanoseconds beside whole seconds.
    pub(crate) nanoseconds: Option<usize>,
    pub(crate) id: Option<usize>,
    pub(crate) bodies: Vec<Columns>,
    /// Whether the columns are those of free joints of MuJoCo.
    pub(crate) is_generalized: bool,
    /// Units that the layout implies where the names state none.
    pub(crate) time_unit: Option<TimeUnit>,
    pub(crate) rate_unit: Option<RateUnit>,
}

impl Header {
    /// Of the cells of a line; `counts_rows` where rows without a time may be counted.
    pub(crate) fn of(cells: &[String], flags: &ColumnNames, counts_rows: bool) -> Result<Self, Rule> {
        Self::spelled(cells, cells, flags, counts_rows)
    }

    /// The same, where `spelled` says what the cells mean, as those of a dump.
    pub(crate) fn spelled(
        cells: &[String],
        spelled: &[String],
        flags: &ColumnNames,
        counts_rows: bool,
    ) -> Result<Self, Rule> {
        let named = |(cell, meant): (&String, &String)| Name { text: cell.clone(), ..Name::of(meant) };
        let names: Vec<Name> = cells.iter().zip(spelled).map(named).collect();
        let mut header = Header { time: flags.place("t", cells)?, ..Header::default() };
        header.time_is_named = header.time.is_some();
        header.id = match flags.place("id", cells)? {
            Some(place) => Some(place),
            None => names.iter().position(|name| is_id(&name.letters)),
        };
        if header.time.is_none() {
            let ranked =
                names.iter().enumerate().filter_map(|(k, name)| name.time_rank().map(|rank| (rank, k)));
            header.time = ranked.min().map(|(_, k)| k);
        }
        if header.time.is_none() {
            // whole seconds and nanoseconds apart, as messages of ROS have them
            let ending = |end: &str| names.iter().position(|name| name.letters.ends_with(end));
            let stamp = ending("stampsecs")
                .zip(ending("stampnsecs"))
                .or(ending("stampsec").zip(ending("stampnanosec")));
            if let Some((seconds, nanoseconds)) = stamp {
                (header.time, header.nanoseconds) = (Some(seconds), Some(nanoseconds));
                header.time_unit = Some(TimeUnit::Seconds);
            }
        }
        if header.time.is_none() && !counts_rows {
            return Err(Rule::Column("time".into(), cells.to_vec()));
        }
        let wanted = flags.groups(cells)?;
        let named: Vec<usize> =
            wanted.iter().flat_map(|group| group.places.clone()).chain(flags.place("t", cells)?).collect();
        header.bodies = match wanted.is_empty().then(|| generalized(&names)).flatten() {
            Some(bodies) => {
                header.is_generalized = true;
                bodies?
            }
            None if wanted.is_empty() => {
                let found = vec![Columns::of(groups(&names)?, &names)?];
                if found.iter().any(Columns::is_empty) { owned(&names)?.unwrap_or(found) } else { found }
            }
            None => vec![Columns::of(wanted, &names)?],
        };
        header.names = names;
        let missing = header.missing(cells);
        let lacks_rates = matches!(&missing, Rule::Column(what, _) if what.contains("rate"))
            && named.is_empty()
            && header.bodies.iter().all(|body| body.rates.is_none());
        if header.columns().is_empty() || lacks_rates {
            return Err(missing);
        }
        header.check_unique(&named)?;
        header.imply();
        Ok(header)
    }

    /// Columns 1, 2, ... of a table of numbers without a header: time and angular velocity.
    pub(crate) fn numbered(count: usize, time: (usize, Option<usize>), rates: [usize; 3]) -> Self {
        let names = (1..=count).map(|n| Name::of(&n.to_string())).collect();
        let rates = Group::of(Quantity::Rates, rates.to_vec());
        let bodies = vec![Columns { rates: Some(rates), ..Columns::default() }];
        Header { names, time: Some(time.0), nanoseconds: time.1, bodies, ..Header::default() }
    }

    /// The places of time and quantities.
    pub(crate) fn columns(&self) -> Vec<usize> {
        let groups = self.bodies.iter().flat_map(|body| [&body.attitude, &body.rates, &body.momentum]);
        groups.flatten().flat_map(|group| group.places.iter().copied()).collect()
    }

    /// The names of the other columns, of those that have one; the places and velocities of MuJoCo are known to be such.
    pub(crate) fn unread(&self) -> impl Iterator<Item = &str> {
        self.others().map(|(_, name)| name.text.trim()).filter(|name| !name.is_empty())
    }

    /// Names of columns that are not read and hold the attitude of a body with a name of its own; none where there is none.
    pub(crate) fn second_attitude(&self) -> Vec<&str> {
        let others: Vec<Name> = self.others().map(|(_, name)| name.clone()).collect();
        let bodies = owned(&others).ok().flatten().unwrap_or_default();
        let places =
            bodies.into_iter().find_map(|body| body.attitude).map_or(Vec::new(), |group| group.places);
        places
            .into_iter()
            .filter_map(|place| self.others().nth(place))
            .map(|(_, name)| name.text.trim())
            .collect()
    }

    /// A column that is a time by its name too, and no counter, beside the one that is read.
    pub(crate) fn second_time(&self) -> Option<usize> {
        self.time?;
        let is_time = |name: &Name| name.time_rank().is_some() && !name.is_counter();
        self.others().find(|(_, name)| is_time(name)).map(|(place, _)| place)
    }

    /// The names that are not read, with their places.
    fn others(&self) -> impl Iterator<Item = (usize, &Name)> {
        let read: Vec<usize> =
            self.columns().into_iter().chain(self.time).chain(self.nanoseconds).chain(self.id).collect();
        (0..).zip(&self.names).filter(move |(place, _)| !self.is_generalized && !read.contains(place))
    }

    /// The one component that a quaternion or an angular velocity lacks, or that there is none.
    fn missing(&self, cells: &[String]) -> Rule {
        let all = SPELLINGS.iter().filter(|spelling| !spelling.yields);
        for spelling in
            all.filter(|spelling| matches!(spelling.quantity, Quantity::Quaternion | Quantity::Rates))
        {
            let Some(components) = spelling.components().next() else { continue };
            for stem in spelling.stems() {
                let lacks =
                    |c: &&str| !self.names.iter().any(|name| name.is(&format!("{stem}{c}"), RATE_ENDINGS));
                let mut lacking = components.clone().filter(lacks);
                let (Some(one), None) = (lacking.next(), lacking.next()) else { continue };
                let what = if spelling.quantity == Quantity::Rates {
                    "rate about"
                } else {
                    "component of the attitude"
                };
                return Rule::Column(format!("the {what} {one}"), cells.to_vec());
            }
        }
        Rule::Quantity(cells.to_vec())
    }

    /// No column that is read has a second one of its name, in whatever spelling, but for those that flags have `named`.
    fn check_unique(&self, named: &[usize]) -> Result<(), Rule> {
        for place in self.columns().into_iter().chain(self.time).filter(|place| !named.contains(place)) {
            // a time may stand in several units, the numbers of a quantity not
            let name = &self.names[place];
            let is_same = |other: &&Name| {
                let same_letters = Some(place) != self.time && other.letters == name.letters;
                same_letters || other.text.trim().eq_ignore_ascii_case(name.text.trim())
            };
            let mut same =
                (1..).zip(&self.names).filter(|(_, other)| is_same(other)).map(|(number, _)| number);
            if let (Some(first), Some(second)) = (same.next(), same.next()) {
                return Err(Rule::Unique(first, second));
            }
        }
        Ok(())
    }

    /// Units that layouts of known programs have.
    fn imply(&mut self) {
        let Some((time, rates)) = self.time.zip(self.bodies.first().and_then(|body| body.rates.as_ref()))
        else {
            return;
        };
        let (stem, first) = (rates.stem, self.names[rates.places[0]].text.trim());
        let is_crazyflie = first.eq_ignore_ascii_case("gyro.x") && self.names[time].letters == "timestamp";
        self.time_unit = self.time_unit.or(match self.names[time].letters.as_str() {
            // the logs of PX4 and the messages of ROS
            "timestamp" | "timestampsample" if ["gyrorad", "xyz"].contains(&stem) => {
                Some(TimeUnit::Microseconds)
            }
            "time" | "fieldheaderstamp" if stem == "fieldangularvelocity" => Some(TimeUnit::Nanoseconds),
            // the explorer of Betaflight's logs
            "time" if stem == "gyroadc" => Some(TimeUnit::Microseconds),
            _ if is_crazyflie => Some(TimeUnit::Milliseconds),
            _ => None,
        });
        self.rate_unit = match stem {
            "gyroadc" => Some(RateUnit::DegreesPerSecond),
            "gyrorad" => Some(RateUnit::RadiansPerSecond),
            _ if is_crazyflie => Some(RateUnit::DegreesPerSecond),
            _ => None,
        };
    }
}

impl Group {
    /// Of columns whose names state nothing.
    pub(crate) fn of(quantity: Quantity, places: Vec<usize>) -> Self {
        let units = vec![None; places.len()];
        let (frame, direction, angle_axes) = (None, None, None);
        Group { quantity, places, units, frame, direction, angle_axes, stem: "", yields: false }
    }
}

impl Columns {
    fn is_empty(&self) -> bool {
        self.attitude.is_none() && self.rates.is_none() && self.momentum.is_none()
    }

    /// Of groups, of which each quantity may have one.
    fn of(groups: Vec<Group>, names: &[Name]) -> Result<Self, Rule> {
        let mut columns = Columns::default();
        for group in groups {
            let slot = match group.quantity {
                Quantity::Rates => &mut columns.rates,
                Quantity::Momentum => &mut columns.momentum,
                _ => &mut columns.attitude,
            };
            match slot {
                None => *slot = Some(group),
                Some(_) if group.yields => {}
                Some(before) if before.yields => *slot = Some(group),
                Some(before) => {
                    let first = |group: &Group| names[group.places[0]].text.clone();
                    return Err(Rule::OneGroup(group.quantity.words(), first(before), first(&group)));
                }
            }
        }
        // three letters beside an attitude are a position
        let is_bare = |group: &Group| group.stem.is_empty() && names[group.places[0]].letters == "x";
        if columns.attitude.is_some() && columns.rates.as_ref().is_some_and(is_bare) {
            columns.rates = None;
        }
        Ok(columns)
    }
}

/// Every complete group of columns.
fn groups(names: &[Name]) -> Result<Vec<Group>, Rule> {
    let mut found: Vec<Group> = Vec::new();
    for spelling in SPELLINGS {
        let endings = match spelling.quantity {
            Quantity::Rates => RATE_ENDINGS,
            Quantity::Angles => ANGLE_ENDINGS,
            _ => NO_ENDINGS,
        };
        for stem in spelling.stems() {
            for components in spelling.components() {
                let targets: Vec<String> = components.map(|component| format!("{stem}{component}")).collect();
                let places: Vec<Option<usize>> = targets
                    .iter()
                    .map(|target| names.iter().position(|name| name.is(target, endings)))
                    .collect();
                let Some(places) = places.iter().copied().collect::<Option<Vec<usize>>>() else {
                    // one name twice stands in place of the one that is missing
                    let twin = targets.iter().zip(&places).find_map(|(target, place)| {
                        let first = (*place)?;
                        let second =
                            names.iter().skip(first + 1).position(|name| name.is(target, endings))?;
                        Some((first + 1, first + second + 2))
                    });
                    let missing = places.iter().filter(|place| place.is_none()).count();
                    if let (1, false, Some((first, second))) = (missing, spelling.yields, twin) {
                        return Err(Rule::Unique(first, second));
                    }
                    continue;
                };
                // the same columns under two spellings
                if found.iter().any(|group| group.places == places) {
                    break;
                }
                let units =
                    places.iter().zip(&targets).map(|(&k, target)| names[k].unit_behind(target, endings));
                let behind = || frame(targets[0].strip_prefix(stem)?.strip_prefix('x')?);
                let frame = if stem.is_empty() { None } else { frame(stem).or_else(behind) };
                let (units, direction) = (units.collect(), direction(stem));
                let (quantity, yields) = (spelling.quantity, spelling.yields);
                let angle_axes = (targets[0] == "roll").then_some([0, 1, 2]);
                found.push(Group { quantity, places, units, frame, direction, angle_axes, stem, yields });
                break;
            }
        }
    }
    Ok(found)
}

/// Bodies whose names stand in front of their quantities, as in the states of Drake and in topics: `model_body_qw`,
/// `/imu/orientation/w`; those that have an attitude.
fn owned(names: &[Name]) -> Result<Option<Vec<Columns>>, Rule> {
    // any mark may be the end of the name of the body
    let mut parts: Vec<(usize, &str, &str)> = Vec::new();
    for (place, name) in names.iter().enumerate() {
        let text = name.text.as_str();
        let ends = text.match_indices(['_', '.', '/']);
        parts.extend(ends.map(|(at, _)| (place, &text[..at], &text[at + 1..])));
    }
    let mut owners: Vec<&str> = parts.iter().map(|(_, owner, _)| *owner).collect();
    owners.sort_unstable();
    owners.dedup();
    let mut bodies = Vec::new();
    for owner in owners {
        let own = parts.iter().filter(|part| part.1 == owner);
        let (places, own): (Vec<usize>, Vec<Name>) =
            own.map(|(place, _, quantity)| (*place, Name::of(quantity))).unzip();
        let mut columns = Columns::of(groups(&own)?, &own)?;
        if columns.attitude.as_ref().is_some_and(|attitude| !attitude.yields) {
            let groups = [&mut columns.attitude, &mut columns.rates, &mut columns.momentum];
            for place in groups.into_iter().flatten().flat_map(|group| &mut group.places) {
                *place = places[*place];
            }
            bodies.push(Columns { label: Some(owner.to_string()), ..columns });
        }
    }
    // `a_euler_angle_x` is `euler_angle_x` of a and `angle_x` of a_euler
    bodies.dedup_by(|later: &mut Columns, before: &mut Columns| {
        let places = |body: &Columns| body.attitude.as_ref().map(|group| group.places.clone());
        places(later) == places(before)
    });
    if let [alone] = &mut bodies[..] {
        alone.label = None;
    }
    Ok((!bodies.is_empty()).then_some(bodies))
}

/// Free joints of MuJoCo: `qpos` holds three positions and a quaternion, scalar first, for each; `qvel` three velocities and
/// the angular velocity in body axes.
fn generalized(names: &[Name]) -> Option<Result<Vec<Columns>, Rule>> {
    let numbered = |stem: &str| {
        let places =
            names.iter().enumerate().filter_map(|(place, name)| Some((name.number_after(stem)?, place)));
        let mut found: Vec<(usize, usize)> = places.collect();
        found.sort_unstable();
        found.into_iter().map(|(_, place)| place).collect::<Vec<usize>>()
    };
    let (positions, velocities) = (numbered("qpos"), numbered("qvel"));
    if positions.is_empty() {
        return None;
    }
    let bodies = positions.len() / 7;
    if positions.len() % 7 != 0 || !(velocities.is_empty() || velocities.len() == 6 * bodies) {
        return Some(Err(Rule::Other(format!(
            "{} columns qpos and {} columns qvel are not those of free joints alone, 7 and 6 for each",
            positions.len(),
            velocities.len()
        ))));
    }
    let body = |k: usize| Columns {
        label: (bodies > 1).then(|| format!("free joint {}", k + 1)),
        attitude: Some(Group::of(Quantity::Quaternion, positions[7 * k + 3..7 * k + 7].to_vec())),
        rates: (!velocities.is_empty()).then(|| Group {
            frame: Some(Frame::Body),
            units: vec![Some("rad/s".into()); 3],
            ..Group::of(Quantity::Rates, velocities[6 * k + 3..6 * k + 6].to_vec())
        }),
        momentum: None,
    };
    Some(Ok((0..bodies).map(body).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quantity and places of each group.
    fn found(header: &str) -> Vec<(Quantity, Vec<usize>)> {
        let cells: Vec<String> = header.split(',').map(String::from).collect();
        let header = Header::of(&cells, &ColumnNames::default(), true).unwrap_or_default();
        let groups = header.bodies.into_iter().flat_map(|body| [body.attitude, body.rates, body.momentum]);
        groups.flatten().map(|group| (group.quantity, group.places)).collect()
    }

    #[test]
    fn spellings_of_the_common_programs() {
        use Quantity::{Momentum, Numbered, Quaternion, Rates, Rodrigues};
        assert_eq!(found("t,w,x,y,z"), [(Quaternion, vec![1, 2, 3, 4])]);
        assert_eq!(found("t,z,y,x"), [(Rates, vec![3, 2, 1])]);
        assert_eq!(
            found("t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z,energy,momentum"),
            [(Quaternion, vec![1, 2, 3, 4]), (Rates, vec![5, 6, 7])]
        );
        assert_eq!(found("time,x,y,z,qx,qy,qz,qw"), [(Quaternion, vec![7, 4, 5, 6])]);
        assert_eq!(found("t,q0,q1,q2,q3,wx,wy,wz"), [(Numbered, vec![1, 2, 3, 4]), (Rates, vec![5, 6, 7])]);
        assert_eq!(
            found("Time [s],sigma_BN[0],sigma_BN[1],sigma_BN[2],omega_BN_B_1,omega_BN_B_2,omega_BN_B_3"),
            [(Rodrigues, vec![1, 2, 3]), (Rates, vec![4, 5, 6])]
        );
        assert_eq!(
            found("t,R[0][0],R[0][1],R[0][2],R[1][0],R[1][1],R[1][2],R[2][0],R[2][1],R[2][2]").len(),
            1
        );
        assert_eq!(found("t,roll,pitch,yaw,p,q,r").len(), 2);
        assert_eq!(
            found("id,quatw,quati,quatj,quatk,angmomx,angmomy,angmomz"),
            [(Quaternion, vec![1, 2, 3, 4]), (Momentum, vec![5, 6, 7])]
        );
        assert_eq!(
            found(
                "t,gyroRotationX,gyroRotationY,gyroRotationZ,motionRotationRateX,motionRotationRateY,motionRotationRateZ"
            ),
            [(Rates, vec![1, 2, 3])]
        );
        assert_eq!(
            found(
                "time,model_a_qw,model_a_qx,model_a_qy,model_a_qz,model_a_x,model_a_y,model_a_z,model_a_wx,model_a_wy,model_a_wz"
            ),
            [(Quaternion, vec![1, 2, 3, 4]), (Rates, vec![8, 9, 10])]
        );
        assert_eq!(
            found("time,/imu/orientation/x,/imu/orientation/y,/imu/orientation/z,/imu/orientation/w"),
            [(Quaternion, vec![4, 1, 2, 3])]
        );
        assert_eq!(
            found("t,body.qw,body.qx,body.qy,body.qz,body.wx,body.wy,body.wz"),
            [(Quaternion, vec![1, 2, 3, 4]), (Rates, vec![5, 6, 7])]
        );
        assert_eq!(found("t,a,b"), []);
    }

    #[test]
    fn directions_stand_in_names() {
        for (stem, direction) in [
            ("q", None),
            ("q_body_to_space", Some(Direction::BodyToSpace)),
            ("q_space_to_body", Some(Direction::SpaceToBody)),
        ] {
            let cells = ["w", "x", "y", "z"].map(|part| format!("{stem}_{part}"));
            let header = Header::of(&cells, &ColumnNames::default(), true).unwrap();
            let attitude = header.bodies[0].attitude.as_ref().unwrap();
            assert_eq!(
                (attitude.quantity, &attitude.places[..], attitude.direction),
                (Quantity::Quaternion, &[0, 1, 2, 3][..], direction),
                "{stem}"
            );
        }
    }

    #[test]
    fn units_and_frames_stand_in_names() {
        let cells = ["time (ms)", "omega_space_x_deg_s", "omega_space_y", "omega_space_z"].map(String::from);
        let header = Header::of(&cells, &ColumnNames::default(), false).unwrap();
        let rates = header.bodies[0].rates.as_ref().unwrap();
        assert_eq!((rates.frame, rates.units[0].as_deref()), (Some(Frame::Space), Some("deg/s")));
        for (of, frame) in [("body", Frame::Body), ("space", Frame::Space), ("world", Frame::Space)] {
            let cells = ["t".to_string(), format!("wx_{of}"), format!("wy_{of}"), format!("wz_{of}")];
            let header = Header::of(&cells, &ColumnNames::default(), false).unwrap();
            let rates = header.bodies[0].rates.as_ref().unwrap();
            assert_eq!((rates.frame, &rates.places[..]), (Some(frame), &[1, 2, 3][..]), "{of}");
        }
    }
}
