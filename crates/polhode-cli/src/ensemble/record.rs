//! `run.toml` of a shard or of results: what they belong to.

use std::collections::BTreeMap;

use polhode::num::Real;
use polhode::rotation::Vec3;
use polhode_experiments::build;
use polhode_pages::output::MARK;
use serde::{Deserialize, Serialize};

use super::checksum::Checksum;
use super::shard::Shard;
use super::spec::Spec;

/// What all shards of a run agree on, and its results too.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Identity {
    /// Of everything that the numbers depend on.
    pub(super) spec_hash: String,
    pub(super) version: String,
    pub(super) commit: String,
    pub(super) members: u64,
    pub(super) times: u64,
    /// Whether the arrays are kept.
    pub(super) attitudes: bool,
    pub(super) omegas: bool,
    /// The event whose first passages are looked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) event: Option<String>,
    /// Longitude and latitude of the direction to the observer, rad, at each time or at all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) observer: Vec<[String; 2]>,
}

/// The contents of `run.toml`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Record {
    /// What this folder is.
    pub(super) kind: String,
    /// Of a shard.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) shard: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) shards: Option<u64>,
    pub(super) method: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) seed: Option<u64>,
    /// Draws, with those that belong to no body and were drawn again.
    pub(super) draws: u64,
    /// Members that have no rows from some time on.
    pub(super) failed: u64,
    pub(super) rustc: String,
    pub(super) profile: String,
    pub(super) target: String,
    pub(super) identity: Identity,
    /// Checksums of the files beside it, and under [`MARK`] of this record without that line.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub(super) sha256: BTreeMap<String, String>,
    /// Columns and arrays of the files beside it.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub(super) files: BTreeMap<String, BTreeMap<String, String>>,
}

const SHARD: &str = "ensemble shard";
const RESULTS: &str = "ensemble";

impl Identity {
    /// Of a specification, run by this program.
    pub(super) fn of(spec: &Spec) -> Self {
        Self {
            spec_hash: spec.hash.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            commit: build::COMMIT.into(),
            members: spec.members,
            times: spec.plan.times.len() as u64,
            attitudes: spec.attitudes,
            omegas: spec.omegas,
            event: spec.watched.as_ref().map(|watched| watched.event.text().into()),
            observer: spec.observer.iter().map(|angles| angles.map(|angle| format!("{angle:?}"))).collect(),
        }
    }

    /// The direction to the observer at each time, axes of space; none where there is none.
    pub(super) fn directions(&self) -> Vec<Vec3<f64>> {
        let direction = |angles: &[String; 2]| {
            // as this program wrote them
            let [(sin, cos), (up, across)] =
                angles.each_ref().map(|angle| Real::sin_cos(angle.parse::<f64>().unwrap_or(f64::NAN)));
            Vec3([cos * across, sin * across, up])
        };
        match &self.observer[..] {
            [one] => vec![direction(one); self.times as usize],
            each => each.iter().map(direction).collect(),
        }
    }

    /// In what another run differs from this one.
    pub(super) fn difference(&self, other: &Self) -> Option<String> {
        let said = |what: &str, here: &str, there: &str| Some(format!("{what} {there}, not {here}"));
        if self.version != other.version {
            return said("of version", &self.version, &other.version);
        }
        if self.commit != other.commit {
            return said("of commit", &self.commit, &other.commit);
        }
        if self != other {
            return said("of the specification with hash", &self.spec_hash, &other.spec_hash);
        }
        None
    }
}

impl Record {
    /// Of a shard, or of results where there is none.
    pub(super) fn new(spec: &Spec, shard: Option<Shard>, draws: u64, failed: u64) -> Self {
        Self {
            kind: if shard.is_some() { SHARD } else { RESULTS }.into(),
            shard: shard.map(|shard| shard.number),
            shards: shard.map(|shard| shard.count),
            method: spec.plan.method_name().into(),
            seed: spec.is_drawn().then_some(spec.seed),
            draws,
            failed,
            rustc: build::RUSTC.into(),
            profile: build::PROFILE.into(),
            target: build::TARGET.into(),
            identity: Identity::of(spec),
            sha256: BTreeMap::new(),
            files: BTreeMap::new(),
        }
    }

    /// Of the results of all shards.
    pub(super) fn of_shards(shards: &[Self]) -> Option<Self> {
        let first = shards.first()?.clone();
        let sum = |of: fn(&Self) -> u64| shards.iter().map(of).sum();
        Some(Self {
            kind: RESULTS.into(),
            shard: None,
            shards: None,
            draws: sum(|shard| shard.draws),
            failed: sum(|shard| shard.failed),
            sha256: BTreeMap::new(),
            ..first
        })
    }

    /// The share that a folder of this record has.
    pub(super) fn place(&self) -> Option<Shard> {
        let (number, count) = (self.shard?, self.shards?);
        (self.kind == SHARD && (1..=count).contains(&number)).then_some(Shard { number, count })
    }

    /// Whether two shards have the method and the seed in common, as all of one specification do.
    pub(super) fn is_alike(&self, other: &Self) -> bool {
        (&self.method, self.seed) == (&other.method, other.seed)
    }

    pub(super) fn is_results(&self) -> bool {
        self.kind == RESULTS
    }

    pub(super) fn parse(text: &str) -> Result<Self, toml::de::Error> {
        toml::from_str(text)
    }

    pub(super) fn text(&self) -> Result<String, toml::ser::Error> {
        toml::to_string(self)
    }

    /// The same with a checksum of itself.
    pub(super) fn sealed_text(mut self) -> Result<String, toml::ser::Error> {
        let seal = self.seal()?;
        self.sha256.insert(MARK.into(), seal);
        self.text()
    }

    /// Whether the record is the one that its checksum was made of.
    pub(super) fn is_as_written(&self) -> bool {
        self.seal().is_ok_and(|seal| self.sha256.get(MARK) == Some(&seal))
    }

    fn seal(&self) -> Result<String, toml::ser::Error> {
        let mut bare = self.clone();
        bare.sha256.remove(MARK);
        let mut sum = Checksum::new();
        sum.add(bare.text()?.as_bytes());
        Ok(sum.hexadecimal())
    }
}
