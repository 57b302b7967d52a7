//! Which columns of a header hold which quantity.

use polhode::audit::{Direction, Frame};
use polhode::units::{RateUnit, TimeUnit};

use super::flags::ColumnNames;
use super::name::Name;
use super::spellings::{
    ANGLE_ENDINGS, NO_ENDINGS, Quantity, RATE_ENDINGS, SPELLINGS, direction, frame, is_id, is_of_message,
    says_no_motion, says_rates,
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
        let mut names: Vec<Name> = cells.iter().zip(spelled).map(named).collect();
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
        if header.time.is_none() {
            // behind the name of its message, where it is the only one: `ATTITUDE.time_boot_ms`
            let behind = |name: &Name| {
                let own = Name::of(name.text.rsplit_once(['.', '/'])?.1);
                (own.time_rank().is_some() && !own.is_counter()).then_some(own.letters)
            };
            let mut timed = (0..).zip(&names).filter_map(|(place, name)| Some((place, behind(name)?)));
            let alone = timed.next().filter(|_| timed.next().is_none());
            if let Some((place, letters)) = alone {
                names[place].letters = letters;
                header.time = Some(place);
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
            None if wanted.is_empty() => bodies(&names)?,
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
        // the angles that a message has beside its quaternion are no other attitude
        let is_other = |body: &Columns| {
            body.attitude.as_ref().is_some_and(|group| !(group.is_restated() && body.key().is_empty()))
        };
        let second = owned(&others).unwrap_or_default().into_iter().find(is_other);
        let places = second.and_then(|body| body.attitude).map_or(Vec::new(), |group| group.places);
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

    /// Units, and places of the scalar, that layouts of known programs define.
    fn imply(&mut self) {
        let Some(time) = self.time.map(|place| &self.names[place]) else { return };
        let body = self.bodies.first();
        let name = |group: Option<&Group>| group.map(|group| &self.names[group.places[0]]);
        let (rates, attitude) =
            (body.and_then(|body| body.rates.as_ref()), body.and_then(|body| body.attitude.as_ref()));
        let (stem, of_rates) = (rates.map_or("", |rates| rates.stem), name(rates));
        let has = |letters: &str| self.names.iter().any(|name| name.letters == letters);
        let is_timestamp = time.letters == "timestamp";
        let is_crazyflie =
            is_timestamp && of_rates.is_some_and(|name| name.text.trim().eq_ignore_ascii_case("gyro.x"));
        let is_mavlink = of_rates.is_some_and(|name| name.letters.ends_with("rollspeed"));
        // what other programs have no column of
        let is_of_px4 = || {
            has("timestampsample")
                || has("deltaqreset0")
                || is_mavlink && self.names.iter().any(|name| name.text.trim() == "q[0]")
        };
        let is_px4 = (is_timestamp || time.letters == "timestampsample")
            && (["gyrorad", "xyz"].contains(&stem) || has("timestamp") && is_of_px4());
        let is_ros = of_rates.or(name(attitude)).is_some_and(|name| name.letters.starts_with("field"));
        let time_unit = match time.letters.as_str() {
            _ if is_px4 => Some(TimeUnit::Microseconds),
            "time" | "fieldheaderstamp" if is_ros => Some(TimeUnit::Nanoseconds),
            // the explorer of Betaflight's logs
            "time" if stem == "gyroadc" => Some(TimeUnit::Microseconds),
            _ if is_crazyflie => Some(TimeUnit::Milliseconds),
            _ => None,
        };
        // q0 of Xsens, and q1 of MAVLink's ATTITUDE_QUATERNION and of ArduPilot
        let is_scalar_first = is_px4
            || is_mavlink
            || time.text.trim().ends_with("TimeUS")
            || attitude.is_some_and(|attitude| attitude.stem == "quatq");
        self.time_unit = self.time_unit.or(time_unit);
        self.rate_unit = match stem {
            "gyroadc" => Some(RateUnit::DegreesPerSecond),
            "gyrorad" => Some(RateUnit::RadiansPerSecond),
            _ if is_crazyflie => Some(RateUnit::DegreesPerSecond),
            _ if is_mavlink => Some(RateUnit::RadiansPerSecond),
            _ => None,
        };
        for attitude in self.bodies.iter_mut().filter_map(|body| body.attitude.as_mut()) {
            // a group without a stem is named by a flag
            if is_scalar_first && attitude.quantity == Quantity::Numbered && !attitude.stem.is_empty() {
                attitude.quantity = Quantity::Quaternion;
            }
            if is_mavlink && attitude.is_restated() && attitude.units.iter().all(Option::is_none) {
                attitude.units = vec![Some("rad".into()); 3];
            }
        }
    }
}

impl Group {
    /// Of columns whose names state nothing.
    pub(crate) fn of(quantity: Quantity, places: Vec<usize>) -> Self {
        let units = vec![None; places.len()];
        let (frame, direction, angle_axes) = (None, None, None);
        Group { quantity, places, units, frame, direction, angle_axes, stem: "", yields: false }
    }

    /// Whether these are roll, pitch and yaw or the like, which many programs write beside the quaternion of which they are.
    fn is_restated(&self) -> bool {
        self.quantity == Quantity::Angles && self.stem.is_empty()
    }

    /// Whether it is a quaternion.
    fn is_quaternion(&self) -> bool {
        matches!(self.quantity, Quantity::Quaternion | Quantity::Numbered)
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
                Some(before) if before.is_quaternion() && group.is_restated() => {}
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

    /// With what exactly one of `others` has, where it has none itself.
    fn filled(self, others: &[Columns]) -> Self {
        let only = |of: fn(&Columns) -> Option<&Group>| {
            let mut having = others.iter().filter_map(of);
            having.next().filter(|_| having.next().is_none()).cloned()
        };
        Columns {
            label: self.label,
            attitude: self.attitude.or_else(|| only(|other| other.attitude.as_ref())),
            rates: self.rates.or_else(|| only(|other| other.rates.as_ref())),
            momentum: self.momentum.or_else(|| only(|other| other.momentum.as_ref())),
        }
    }

    /// The words of the label that are not those of messages: the name of the body, of messages alone none.
    fn key(&self) -> String {
        let lower = self.label.as_deref().unwrap_or_default().to_lowercase();
        let words = lower.split(|c: char| !c.is_alphanumeric());
        words.filter(|word| !word.is_empty() && !is_of_message(word)).collect::<Vec<_>>().join(" ")
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
                let frame = match stem {
                    // MAVLink's rates are p, q and r about the axes of the body, and no derivatives of roll, pitch and yaw: "body
                    // frame roll / phi angular speed" (common.xml, HIL_STATE_QUATERNION)
                    "" if targets[0] == "rollspeed" => Some(Frame::Body),
                    "" => None,
                    _ => frame(stem).or_else(behind),
                };
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

/// The bodies of a header: that whose columns have no owner, with what messages have of it; else those of the owners.
fn bodies(names: &[Name]) -> Result<Vec<Columns>, Rule> {
    let bare = Columns::of(groups(names)?, names)?;
    if !bare.is_empty() {
        let mut messages = owned(names).unwrap_or_default();
        messages.retain(|columns| columns.key().is_empty());
        return Ok(vec![bare.filled(&messages)]);
    }
    let mut sets: Vec<(String, Vec<Columns>)> = Vec::new();
    for columns in owned(names)? {
        let key = columns.key();
        match sets.iter_mut().find(|(known, _)| *known == key) {
            Some((_, set)) => set.push(columns),
            None => sets.push((key, vec![columns])),
        }
    }
    let mut found = Vec::new();
    for (_, mut set) in sets {
        let has_quaternion =
            set.iter().filter_map(|columns| columns.attitude.as_ref()).any(Group::is_quaternion);
        for columns in &mut set {
            columns.attitude =
                columns.attitude.take().filter(|group| !(has_quaternion && group.is_restated()));
        }
        // several messages of one body, as pose and twist of an odometer
        let attitudes = set.iter().filter(|columns| columns.attitude.is_some()).count();
        let rates = set.iter().filter(|columns| columns.rates.is_some()).count();
        if attitudes <= 1 && rates <= 1 {
            let first = set.iter().find(|columns| columns.attitude.is_some()).or(set.first());
            let label = first.and_then(|columns| columns.label.clone());
            found.push(Columns { label, ..Columns::default() }.filled(&set));
        } else {
            found.extend(set);
        }
    }
    if found.iter().any(|body| body.attitude.is_some()) {
        found.retain(|body| body.attitude.is_some());
    } else if let [first, second, ..] = &found[..] {
        let name = |body: &Columns| {
            body.rates.as_ref().map_or("", |group| names[group.places[0]].text.as_str()).to_string()
        };
        return Err(Rule::OneGroup(Quantity::Rates.words(), name(first), name(second)));
    }
    if let [alone] = &mut found[..] {
        alone.label = None;
    }
    Ok(if found.is_empty() { vec![bare] } else { found })
}

/// Columns whose owner, a body, a topic or a message, stands in front of their quantity: `model_body_qw`, `/imu/orientation/w`,
/// `field.pose.pose.orientation.w`. Without an attitude, rates must be called so.
fn owned(names: &[Name]) -> Result<Vec<Columns>, Rule> {
    // any mark may be the end of the name of the owner
    let mut parts: Vec<(usize, &str, &str)> = Vec::new();
    for (place, name) in names.iter().enumerate() {
        let text = name.text.as_str();
        let ends = text.match_indices(['_', '.', '/']).filter(|(at, _)| *at > 0);
        parts.extend(ends.map(|(at, _)| (place, &text[..at], &text[at + 1..])));
    }
    let mut owners: Vec<&str> = parts.iter().map(|(_, owner, _)| *owner).collect();
    owners.sort_unstable();
    owners.dedup();
    let mut found: Vec<Columns> = Vec::new();
    for owner in owners {
        let own = parts.iter().filter(|part| part.1 == owner);
        let (places, own): (Vec<usize>, Vec<Name>) =
            own.map(|(place, _, quantity)| (*place, Name::of(quantity))).unzip();
        let mut columns = Columns::of(groups(&own)?, &own)?;
        // of `angular.x` the axes are no quantity
        let is_axes = |group: &Group| group.stem.is_empty() && own[group.places[0]].letters == "x";
        columns.rates = columns.rates.filter(|group| !is_axes(group));
        let groups = [&mut columns.attitude, &mut columns.rates, &mut columns.momentum];
        for place in groups.into_iter().flatten().flat_map(|group| &mut group.places) {
            *place = places[*place];
        }
        // `a_euler_angle_x` is `euler_angle_x` of a and `angle_x` of a_euler
        let is_new = |group: &Group| {
            let mut known = found.iter().flat_map(|columns| [&columns.attitude, &columns.rates]);
            !known.any(|known| known.as_ref().is_some_and(|known| known.places == group.places))
        };
        let attitude = columns.attitude.filter(|group| !group.yields && is_new(group));
        let is_said = |group: &Group| {
            let is_unit = |unit: &Option<String>| unit.as_deref().and_then(RateUnit::named).is_some();
            let said = says_rates(&names[group.places[0]].letters) || group.units.iter().all(is_unit);
            said && is_new(group) && !says_no_motion(owner)
        };
        let rates = columns.rates.filter(|group| attitude.is_some() || is_said(group));
        let momentum = columns.momentum.filter(|_| attitude.is_some());
        if attitude.is_some() || rates.is_some() {
            found.push(Columns { label: Some(owner.to_string()), attitude, rates, momentum });
        }
    }
    Ok(found)
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

    /// `stem` before each of the `parts`.
    fn each(stem: &str, parts: &str) -> String {
        parts.split(' ').map(|part| format!(",{stem}{part}")).collect()
    }

    /// What stands before a quantity may be a message of the one body: then its columns are those without it.
    #[test]
    fn quantities_of_messages_are_those_of_one_body() {
        use Quantity::{Angles, Numbered, Quaternion, Rates};
        let both = |attitude: Quantity, places: &[usize], first: usize| {
            vec![(attitude, places.to_vec()), (Rates, vec![first, first + 1, first + 2])]
        };
        let (wxyz, xyzw, three) = (&[1, 2, 3, 4][..], &[4, 1, 2, 3][..], &[1, 2, 3][..]);
        for (attitude, parts, rates, of_rates, expected) in [
            ("field.orientation.", "x y z w", "field.angular_velocity.", "x y z", both(Quaternion, xyzw, 5)),
            (
                "field.pose.pose.orientation.",
                "x y z w",
                "field.twist.twist.angular.",
                "x y z",
                both(Quaternion, xyzw, 5),
            ),
            ("pose.pose.orientation.", "x y z w", "twist.twist.angular.", "x y z", both(Quaternion, xyzw, 5)),
            (
                "/odom/pose/pose/orientation/",
                "x y z w",
                "/odom/twist/twist/angular/",
                "x y z",
                both(Quaternion, xyzw, 5),
            ),
            (
                "/imu/data/orientation/",
                "x y z w",
                "/imu/data/angular_velocity/",
                "x y z",
                both(Quaternion, xyzw, 5),
            ),
            (
                "vehicle_attitude/q.",
                "00 01 02 03",
                "vehicle_angular_velocity/xyz.",
                "00 01 02",
                both(Numbered, wxyz, 5),
            ),
            ("Attitude_Quaternion_", "x y z w", "IMU_AngularRate_", "x y z", both(Quaternion, xyzw, 5)),
            (
                "transform.rotation.",
                "x y z w",
                "rigidbody.angularVelocity.",
                "x y z",
                both(Quaternion, xyzw, 5),
            ),
            ("stateEstimate.q", "x y z w", "gyro.", "x y z", both(Quaternion, xyzw, 5)),
            ("base_orn_", "x y z w", "base_ang_vel_", "x y z", both(Quaternion, xyzw, 5)),
            (
                "motionQuaternion",
                "X(R) Y(R) Z(R) W(R)",
                "motionRotationRate",
                "X(rad/s) Y(rad/s) Z(rad/s)",
                both(Quaternion, xyzw, 5),
            ),
            (
                "ATTITUDE.",
                "roll pitch yaw",
                "ATTITUDE.",
                "rollspeed pitchspeed yawspeed",
                both(Angles, three, 4),
            ),
            (
                "/fdm/jsbsim/attitude/",
                "phi-rad theta-rad psi-rad",
                "/fdm/jsbsim/velocities/",
                "p-rad_sec q-rad_sec r-rad_sec",
                both(Angles, three, 4),
            ),
        ] {
            let header = format!("time{}{}", each(attitude, parts), each(rates, of_rates));
            assert_eq!(found(&header), expected, "{header}");
        }
        // rates alone, behind any name
        assert_eq!(found(&format!("t{}", each("ICM20948.gyro.", "x y z"))), [(Rates, vec![1, 2, 3])]);
        // what a program derives from the quaternion of its message is no second body
        let derived = each("/imu/data/orientation/", "x y z w roll pitch yaw");
        assert_eq!(found(&format!("t{derived}")), [(Quaternion, vec![4, 1, 2, 3])]);
    }

    /// What may be another quantity, or that of another body, is not read.
    #[test]
    fn names_that_can_mean_two_things_are_not_read() {
        for (first, second) in [
            // an angular velocity in a Twist, an acceleration in an Accel
            ("field.angular.", ""),
            ("field.linear_acceleration.", ""),
            ("imu0.angular_velocity.", "imu1.angular_velocity."),
            ("imu.bias.gyro.", ""),
            ("target.omega.", ""),
            ("accel_g_", ""),
            ("velocity_w_", ""),
        ] {
            let second = if second.is_empty() { String::new() } else { each(second, "x y z") };
            assert_eq!(found(&format!("t{}{second}", each(first, "x y z"))), [], "{first}");
        }
        assert_eq!(found(&format!("t{}", each("vehicle_acceleration/xyz.", "00 01 02"))), []);
        let q = each("q_", "w x y z");
        for other in ["velocity_w_", "b_w_RS_S_", "box.omega."] {
            let header = format!("t{q}{}", each(other, "x y z"));
            assert_eq!(found(&header), [(Quantity::Quaternion, vec![1, 2, 3, 4])], "{header}");
        }
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
