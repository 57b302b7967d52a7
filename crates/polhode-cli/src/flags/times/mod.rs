//! Output times: a list, a file, standard input or a regular grid; in seconds, with a unit, or as dates.

mod regular;

use std::path::PathBuf;

use clap::Args;
use polhode::units::{Date, TimeScale};
use polhode_files::error::{Error, warn};
use polhode_files::instant::{Epoch, date, duration, is_moment, seconds, time_scale};
use polhode_files::text::short;
use polhode_files::times::{Asked, Source, TimesColumn};

pub(crate) use regular::{Regular, regular};

/// Times of the rows, and what they count from.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Times")]
pub(crate) struct TimeArguments {
    /// Output times: a list t1,t2,..., a file with one time a line or a column of times, or - for standard input; s, with a unit (12h, 30d), or dates with --epoch
    #[arg(long, value_name = "LIST|FILE|-", value_parser = times, allow_hyphen_values = true,
          conflicts_with_all = ["until", "every"])]
    times: Option<Times>,
    /// Column of the file of --times, by its name or number [default: t]
    #[arg(long, value_name = "NAME|N")]
    times_column: Option<String>,
    /// Last time of the rows, or of the search for --event: s, with a unit, or a date with --epoch
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    until: Option<String>,
    /// Time between rows, or between looks in the search for --event: s, or with a unit (ms, min, h, d)
    #[arg(long, value_name = "DT", value_parser = duration, allow_hyphen_values = true)]
    every: Option<f64>,
    /// Time of the start: s, with a unit, or a date with --epoch
    #[arg(
        long,
        value_name = "t0",
        allow_hyphen_values = true,
        default_value = "0s",
        hide_default_value = true
    )]
    start_time: String,
    /// Date of t = 0: ISO 8601 or a Julian date, followed by its time scale UTC, TAI, TT or TDB. Times without a unit are then Julian dates. If no date has a time scale, every day has 86400 s
    #[arg(long, value_name = "DATE", value_parser = date, allow_hyphen_values = true)]
    epoch: Option<Date>,
    /// Time scale of dates written without one: UTC, TAI, TT or TDB
    #[arg(long, value_name = "SCALE", value_parser = time_scale, requires = "epoch")]
    time_scale: Option<TimeScale>,
}

/// What `--times` names.
#[derive(Clone, Debug)]
enum Times {
    List(Vec<String>),
    File(PathBuf),
    Standard,
}

fn times(text: &str) -> Result<Times, String> {
    if text == "-" {
        return Ok(Times::Standard);
    }
    let items = text.split(',').enumerate();
    let list: Result<Vec<String>, String> = items
        .map(|(k, item)| match is_moment(item) {
            Ok(()) => Ok(item.to_string()),
            Err(error) => Err(item_of(text, k) + &error),
        })
        .collect();
    match list {
        Ok(list) => Ok(Times::List(list)),
        Err(_) if std::path::Path::new(text).exists() => Ok(Times::File(text.into())),
        Err(error) if text.contains(',') || text.is_empty() => Err(error),
        Err(error) => Err(format!("{error}; there is no file of that name either")),
    }
}

/// Which item of a list a message is about.
fn item_of(list: &str, k: usize) -> String {
    if list.contains(',') { format!("item {}: ", k + 1) } else { String::new() }
}

impl TimeArguments {
    /// The date of t = 0.
    pub(crate) fn epoch(&self) -> Option<Epoch> {
        self.epoch.map(|date| Epoch::new(date, self.time_scale))
    }

    /// Time of the start, s.
    pub(crate) fn start(&self) -> Result<f64, Error> {
        self.moment("--start-time", &self.start_time)
    }

    /// Says so where --start-time is another date than that of the `published` start; a date without a scale is taken in that of the
    /// other.
    pub(crate) fn compare_epoch(&self, published: &str) {
        let (Some(Epoch { date: given, .. }), Ok(date)) = (self.epoch(), published.parse::<Date>()) else {
            return;
        };
        let given = date.scale().map_or(given, |scale| given.or_in(scale));
        let later = given.seconds_since(&date).unwrap_or(f64::INFINITY) + self.start().unwrap_or_default();
        if later != 0.0 {
            warn(&format!(
                "--epoch: the published start is that at {published}; here it is used at --start-time, {later:+.0} s from it"
            ));
        }
    }

    /// The flag that the last time comes from.
    pub(crate) fn flag(&self) -> &'static str {
        if self.until.is_some() { "--until" } else { "--times" }
    }

    /// Time between rows, s, if they are regular.
    pub(crate) fn every(&self) -> Option<f64> {
        self.every
    }

    /// The start and --until, between which something is looked for.
    pub(crate) fn span(&self) -> Result<[f64; 2], Error> {
        self.check_column()?;
        match (&self.times, &self.until) {
            (None, Some(until)) => Ok([self.start()?, self.moment("--until", until)?]),
            (Some(_), _) => Err(Error::Input(
                "--times: --event looks from the start to --until; give --until T in its place".into(),
            )),
            (None, None) => {
                Err(Error::Input("--until: missing; --event looks from the start to then".into()))
            }
        }
    }

    /// Refuses the name of a column where --times names no file.
    fn check_column(&self) -> Result<(), Error> {
        if let Some(column) = &self.times_column
            && !matches!(self.times, Some(Times::File(_) | Times::Standard))
        {
            let rule = "names a column of a file, and --times names none";
            return Err(Error::input("--times-column", column, rule, "give --times FILE, or leave it out"));
        }
        Ok(())
    }

    /// The output times. Those of a file are read again with each pass.
    pub(crate) fn output(&self) -> Result<OutputTimes, Error> {
        self.check_column()?;
        match (&self.times, &self.until, self.every) {
            (Some(Times::List(list)), ..) => {
                let each = list.iter().enumerate().map(|(k, text)| {
                    let found = seconds(text, self.epoch());
                    found.map_err(|error| {
                        Error::Input(format!("--times: {}{error}", item_of(&list.join(","), k)))
                    })
                });
                Ok(OutputTimes::List(each.collect::<Result<_, _>>()?))
            }
            (Some(Times::File(path)), ..) => Ok(OutputTimes::Column(self.column(Source::File(path.clone())))),
            (Some(Times::Standard), ..) => Ok(OutputTimes::Column(self.column(Source::Standard))),
            (None, Some(until), Some(every)) => {
                let until = self.moment("--until", until)?;
                Ok(OutputTimes::Regular(regular(self.start()?, until, every).map_err(Error::Input)?))
            }
            (None, Some(until), None) => {
                Err(Error::input("--until", until, "needs the time between rows", "give --every DT too"))
            }
            (None, None, Some(every)) => Err(Error::input(
                "--every",
                &format!("{every:?}"),
                "needs the last output time",
                "give --until T too",
            )),
            (None, None, None) => Err(Error::Input(
                "--times: missing; give --times t1,t2,..., --times FILE or --until T --every DT".into(),
            )),
        }
    }

    fn column(&self, source: Source) -> TimesColumn {
        let asked = Asked { file: "--times".into(), column: "--times-column" };
        TimesColumn { source, wanted: self.times_column.clone(), epoch: self.epoch(), asked }
    }

    fn moment(&self, flag: &str, text: &str) -> Result<f64, Error> {
        seconds(text, self.epoch()).map_err(|error| {
            Error::Input(format!("{flag}: '{}': {error}", polhode_files::text::visible(text)))
        })
    }
}

/// The time from the start to --until, s.
///
/// # Errors
/// An end that does not come after the start.
pub(crate) fn span_until(start_time: f64, until: f64) -> Result<f64, Error> {
    let span = until - start_time;
    if span > 0.0 && span.is_finite() {
        return Ok(span);
    }
    let rule = format!("must come after the start, t = {}", short(start_time));
    Err(Error::input("--until", &short(until), &rule, "give a later time"))
}

/// The times in the file `path`, s, that is named at `place` of a specification, its column by the key `times_column`.
pub(crate) fn of_file(
    path: PathBuf,
    column: Option<String>,
    place: String,
    epoch: Option<Epoch>,
) -> Result<Vec<f64>, Error> {
    let asked = Asked { file: place, column: "times_column" };
    TimesColumn { source: Source::File(path), wanted: column, epoch, asked }.read()?.collect()
}

/// Output times, s, in the order in which they were given.
pub(crate) enum OutputTimes {
    List(Vec<f64>),
    Regular(Regular),
    Column(TimesColumn),
}

impl OutputTimes {
    /// The times one by one; nothing is kept of a file.
    pub(crate) fn iter(&self) -> Result<Box<dyn Iterator<Item = Result<f64, Error>> + '_>, Error> {
        Ok(match self {
            Self::List(list) => Box::new(list.iter().copied().map(Ok)),
            Self::Regular(regular) => Box::new(regular.clone().map(Ok)),
            Self::Column(column) => Box::new(column.read()?),
        })
    }

    /// Looks at every time before the first is used, and counts them; `None` where they can be read only once.
    pub(crate) fn check(
        &self,
        mut check: impl FnMut(f64) -> Result<(), Error>,
    ) -> Result<Option<usize>, Error> {
        match self {
            Self::Column(column) if !column.is_read_again() => return Ok(None),
            // what holds of the first two and of the last holds of those between
            Self::Regular(regular) => {
                let last = regular.len() - 1;
                for n in [0, 1.min(last), last] {
                    check(regular.at(n))?;
                }
                return Ok(Some(regular.len()));
            }
            _ => {}
        }
        let mut count = 0;
        for t in self.iter()? {
            check(t?)?;
            count += 1;
        }
        Ok(Some(count))
    }
}
