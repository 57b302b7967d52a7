//! The file that says what an ensemble is: bodies, starts, how they are spread, and what is done with them.

mod candidates;
mod elements;
mod event;
mod nominal;
mod run;
mod spread;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use polhode::body::{Body, Member, Population, WheelAtStart};
use polhode::flow::TumblingPopulation;
use polhode::inertia::Inertia;
use polhode::rotation::Vec3;
use polhode::run::MemberError;
use polhode_files::error::{Error, warn};
use polhode_files::read;
use polhode_files::toml_file::{Section, TomlFile};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::checksum::Checksum;
use crate::cost;
use crate::flags::force::Forces;
use crate::flags::tumbling::latitude;
use candidates::Candidates;
pub(super) use event::Watched;
use nominal::Nominal;
pub(super) use run::{Motion, Plan};

const SECTIONS: [&str; 8] = ["body", "start", "spread", "run", "force", "event", "output", "observer"];

/// An ensemble as it was specified, checked.
#[derive(Debug)]
pub(super) struct Spec {
    pub(super) path: PathBuf,
    /// Where the number of members stands.
    pub(super) place: String,
    pub(super) members: u64,
    pub(super) seed: u64,
    source: Source,
    acting: Acting,
    pub(super) plan: Plan,
    pub(super) watched: Option<Watched>,
    /// Longitude and latitude of the direction to the observer, rad: none, one, or one for each time.
    pub(super) observer: Vec<[f64; 2]>,
    /// Which arrays are kept.
    pub(super) attitudes: bool,
    pub(super) omegas: bool,
    /// By which shards of the same ensemble know each other.
    pub(super) hash: String,
}

/// Where members come from.
#[derive(Debug)]
enum Source {
    Drawn(Box<Population>),
    Tumbling(Box<TumblingPopulation>),
    Listed(Box<Candidates>),
}

/// What acts on every member.
#[derive(Clone, Debug)]
pub(super) struct Acting {
    weight_moment: [f64; 3],
    forces: Forces,
    wheels: Vec<WheelAtStart>,
}

impl Acting {
    /// Whether a torque in N m acts, or what makes one, or a wheel.
    fn is_sized(&self) -> bool {
        let Forces { torque_body, torque_space, drag, .. } = &self.forces;
        self.weight_moment != [0.0; 3]
            || torque_body.is_some()
            || torque_space.is_some()
            || drag.is_some()
            || !self.wheels.is_empty()
    }

    /// The body of a member without its wheels.
    pub(super) fn on(&self, inertia: Inertia) -> Result<Body, MemberError> {
        let body = Body::heavy(inertia, self.weight_moment.into())?;
        // what is wrong with a force is wrong for every inertia, and was found out when the specification was read
        Ok(self.forces.act_on(body.clone()).unwrap_or(body))
    }

    /// The body of a member that turns at `omega`, rad/s, body axes, at the time `t`, s, of its start.
    pub(super) fn of_start(&self, inertia: Inertia, t: f64, omega: Vec3<f64>) -> Result<Body, MemberError> {
        Ok(self.on(inertia)?.with_wheels_at_start(&self.wheels, t, omega.into())?)
    }

    pub(super) fn wheels(&self) -> &[WheelAtStart] {
        &self.wheels
    }
}

impl Spec {
    /// Reads and checks a specification.
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let text = read(path, "name a TOML file with the tables [body], [start], [spread] and [run]")?;
        let file = TomlFile { path, text: &text };
        let document = file.parse()?;
        let top = Section { file: &file, place: 0, keys: document.get_ref() };
        top.only("a specification", &[&SECTIONS[..], &["solution"]].concat())?;
        let empty = DeTable::new();
        let section = |name: &str| match top.value(name) {
            None => Ok(Section { file: &file, place: 0, keys: &empty }),
            Some(value) => match value.get_ref() {
                DeValue::Table(keys) => Ok(Section { file: &file, place: value.span().start, keys }),
                other => Err(top.at(name, &format!("{} given, a table [{name}] needed", other.type_str()))),
            },
        };
        let [body, start, spread, run, force, event, output, observer] = SECTIONS.map(section);
        let (spread, run, output) = (spread?, run?, output?);
        let listed = spread::members_file(&spread)?;
        let nominal = Nominal::read(&body?, &start?, &force?, listed.is_some())?;
        let plan = Plan::read(&run, &nominal)?;
        let seed = run.count("seed")?.unwrap_or(1);
        let members = run.count("members")?;
        if members == Some(0) {
            return Err(run.at("members", "an ensemble needs at least one"));
        }
        let (source, members) = match listed {
            Some(listed) => {
                for (table, key) in [(&top, "solution"), (&run, "seed")] {
                    if table.value(key).is_some() {
                        let rule =
                            "given beside members_file, so that nothing is drawn; leave one of them out";
                        return Err(table.at(key, rule));
                    }
                }
                let candidates = Candidates::read(&listed, &nominal, &plan)?;
                let count = candidates.len();
                if members.is_some_and(|members| members > count) {
                    let rule = format!(
                        "{} has {count} rows; ask for at most as many, or leave the key out",
                        listed.display()
                    );
                    return Err(run.at("members", &rule));
                }
                if let Some(members) = members.filter(|members| *members < count) {
                    warn(&format!(
                        "{}: has {count} rows, and [run]: members asks for {members}: the rest is left out",
                        listed.display()
                    ));
                }
                (Source::Listed(Box::new(candidates)), members.unwrap_or(count))
            }
            None => {
                let source = source(&top, &spread, &nominal)?;
                plan.check_nominal(&run, &nominal)?;
                let missing = || run.at("members", "missing; give how many are drawn");
                (source, members.ok_or_else(missing)?)
            }
        };
        output.only("[output]", &["arrays"])?;
        let observer = directions(&observer?, plan.times.len(), nominal.units.angle)?;
        let [attitudes, omegas] = arrays(&output)?;
        let acting = nominal.acting;
        let place = file.line(run.place_of("members"));
        let mut spec = Self {
            path: path.to_path_buf(),
            place,
            members,
            seed,
            source,
            acting,
            plan,
            watched: None,
            observer,
            attitudes,
            omegas,
            hash: String::new(),
        };
        spec.watched = Watched::read(&event?, &spec)?;
        spec.hash = spec.hashed();
        Ok(spec)
    }

    /// Of everything that the results depend on: numbers as they were understood, not comments or the order of keys.
    fn hashed(&self) -> String {
        let mut sum = Checksum::new();
        let _ = match &self.source {
            Source::Drawn(population) => write!(sum, "{} {population:?}", self.seed),
            Source::Tumbling(population) => write!(sum, "{} {population:?}", self.seed),
            Source::Listed(candidates) => write!(sum, "{candidates:?}"),
        };
        let kept = (self.attitudes, self.omegas);
        let _ = write!(sum, " {} {:?} {:?} {kept:?}", self.members, self.acting, self.plan);
        if let Some(watched) = &self.watched {
            let _ = write!(sum, " {watched:?}");
        }
        if !self.observer.is_empty() {
            let _ = write!(sum, " {:?}", self.observer);
        }
        sum.hexadecimal()
    }

    /// Member number `k`, from 0.
    pub(super) fn member(&self, k: u64) -> Result<Member, String> {
        match &self.source {
            Source::Drawn(population) => population.member(self.seed, k).map_err(|error| error.to_string()),
            Source::Tumbling(population) => {
                population.member(self.seed, k).map_err(|error| error.to_string())
            }
            Source::Listed(candidates) => candidates.member(k),
        }
    }

    /// Steps of a member up to the last time, of a method that chooses them about one for each radian that the first member turns;
    /// 0 for the closed form.
    pub(super) fn steps(&self) -> f64 {
        match &self.plan.motion {
            Motion::Exact { .. } => 0.0,
            Motion::Stepped { method, steps, clock, .. } => {
                let span = steps.last().map_or(0.0, |steps| *steps as f64 * clock.step);
                let speed = self.member(0).map_or(0.0, |member| member.omega_body.norm());
                let own = if method.tolerance().is_some() { span * speed } else { 0.0 };
                steps.last().map_or(0.0, |steps| *steps as f64).max(own)
            }
        }
    }

    /// Warns of a step in which the first member turns too far.
    pub(super) fn warn_coarse(&self) {
        if let Motion::Stepped { method, clock, .. } = &self.plan.motion
            && method.tolerance().is_none()
            && let Ok(first) = self.member(0)
        {
            cost::warn_coarse("[run]: step", clock.step, first.omega_body.norm());
        }
    }

    /// Whether members are drawn, with `seed`.
    pub(super) fn is_drawn(&self) -> bool {
        !matches!(self.source, Source::Listed(_))
    }

    /// The spread of attitude, rates and tensor that members are drawn from, if that is what they are drawn from.
    pub(super) fn population(&self) -> Option<&Population> {
        match &self.source {
            Source::Drawn(population) => Some(population),
            Source::Tumbling(_) | Source::Listed(_) => None,
        }
    }

    pub(super) fn acting(&self) -> Acting {
        self.acting.clone()
    }

    /// Bytes that the members take before any of them moves.
    pub(super) fn bytes_of_source(&self) -> u64 {
        match &self.source {
            Source::Drawn(_) | Source::Tumbling(_) => 0,
            Source::Listed(candidates) => candidates.bytes(),
        }
    }
}

/// What members are drawn from.
fn source(top: &Section<'_>, spread: &Section<'_>, nominal: &Nominal) -> Result<Source, Error> {
    let (Some(elements), Some(inertia)) = (&nominal.elements, &nominal.inertia) else {
        if top.value("solution").is_some() {
            return Err(top.at("solution", "needs periods and mode in [start], which each solution changes"));
        }
        return Ok(Source::Drawn(Box::new(spread::population(spread, nominal)?)));
    };
    let population = elements::population(top, spread, inertia, elements, nominal.units)?;
    Ok(Source::Tumbling(Box::new(population)))
}

/// The direction to the observer: one, or one for each time.
fn directions(observer: &Section<'_>, times: usize, unit: f64) -> Result<Vec<[f64; 2]>, Error> {
    observer.only("[observer]", &["direction", "directions"])?;
    let in_radians = |angles: [f64; 2]| angles.map(|angle| angle * unit);
    let checked =
        |key: &str, angles: [f64; 2]| latitude(angles, unit).map_err(|error| observer.at(key, &error));
    match (observer.numbers::<2>("direction")?, observer.value("directions")) {
        (None, None) => Ok(Vec::new()),
        (Some(one), None) => checked("direction", one).map(|()| vec![in_radians(one)]),
        (Some(_), Some(_)) => Err(observer.at("directions", "given beside direction; leave one of them out")),
        (None, Some(_)) => {
            let pairs = observer.pairs("directions")?;
            if pairs.len() != times {
                let rule = format!("{} given for {times} times; give one for each", pairs.len());
                return Err(observer.at("directions", &rule));
            }
            pairs.iter().try_for_each(|pair| checked("directions", *pair))?;
            Ok(pairs.into_iter().map(in_radians).collect())
        }
    }
}

/// Which arrays are kept: attitudes and angular velocities.
fn arrays(output: &Section<'_>) -> Result<[bool; 2], Error> {
    const KNOWN: [&str; 2] = ["attitudes", "omegas"];
    let Some(value) = output.value("arrays") else { return Ok([true; 2]) };
    let needed =
        || output.at("arrays", "expected a list of names, of \"attitudes\" and \"omegas\"; [] keeps none");
    let DeValue::Array(items) = value.get_ref() else { return Err(needed()) };
    let mut kept = [false; 2];
    for item in items.iter().map(Spanned::get_ref) {
        let name = item.as_str().ok_or_else(needed)?;
        let Some(place) = KNOWN.iter().position(|known| *known == name) else {
            let place = output.file.line(output.place_of("arrays"));
            return Err(Error::unknown_name(&place, "array", name, KNOWN));
        };
        kept[place] = true;
    }
    Ok(kept)
}
