//! `polhode fit`: inertia from measured angular velocity.

mod arguments;
mod as_read;
mod attitudes;
mod calibrate;
mod carrier;
mod flights;
mod frames;
mod outputs;
mod page;
mod plot;
mod refusal;
mod report;
mod residuals;
mod wheel;

use std::path::PathBuf;

use clap::Args;
use nalgebra::Vector3;
use polhode_files::error::{Error, warn};
use polhode_files::numbers::{numbers, positive};
use polhode_fit::{Limit, Method, Settings, TorqueModel, fit, fit_poses};
use polhode_pages::table::Format;

use crate::flags::record::RecordArguments;
use crate::memory;
use arguments::{KnownArguments, PriorArguments, SensorArguments, Torque};
use as_read::AsRead;
use attitudes::{Chosen, PoseArguments, Read};
use carrier::CarrierArguments;
use flights::Spans;
use outputs::Outputs;
use wheel::WheelArguments;

const EXAMPLES: &str = "Examples:
  polhode simulate --body phone --omega 1,9,2 --until 5 --every 0.01 \\
    --noise 0.01 --out record.csv
  polhode fit record.csv
  polhode fit record.csv --window 0,2.5 --trace 0.0007
  polhode fit record.csv --report fit.html --residuals residuals.csv
  polhode fit record.csv --residuals residuals.svg --format json
  polhode fit record.csv --figure fit.svg
  polhode simulate --body phone --omega 1,9,2 --until 5 --every 0.01 \\
    --attitude-noise 0.005 --out poses.csv
  polhode fit poses.csv";

/// Inertia tensor of a torque-free body from its measured angular velocity or attitude
///
/// Rates are fitted, or attitudes (quaternions, matrices, Euler angles, modified Rodrigues parameters) where a file has no rates or
/// --from asks for them. Free rotation determines the tensor up to a factor: it is then given with the trace 1. It is absolute (kg m^2)
/// with one of --body, --trace, --momentum, --twice-energy, --moment and --prior-inertia; with --carrier; or with columns that name
/// their units: `hx (N m s)`, hy, hz (momentum of wheels), `tx (N m)`, ty, tz (known torque), or `wheel (rad/s)` (speed, with --wheel).
///
/// The axes of the sensor are taken as right-handed. Rates cannot show a mirrored axis, so the report also has the moments for
/// left-handed axes; --axes undoes a mirrored axis. Exit code 1: the record does not determine the tensor. The report then says
/// what it does determine, and which record would tell more.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Fit {
    /// Records with times and rates, in columns t, wx, wy, wz or as phone apps name them; or attitudes, in any columns that audit reads; - reads standard input
    #[arg(required_unless_present = "carrier", value_name = "DATA.csv")]
    data: Vec<PathBuf>,
    #[command(flatten)]
    reading: RecordArguments,
    #[command(flatten)]
    poses: PoseArguments,
    /// Half width of the test functions of the weak form, s; rarely needed. With wheels the weak form alone then gives the answer [default: that of the smallest uncertainty]
    #[arg(long, value_name = "R", value_parser = positive, allow_hyphen_values = true, help_heading = "Noise and smoothing")]
    radius: Option<f64>,
    /// Standard deviation of the noise of the rates, rad/s [default: from the samples]
    #[arg(long, value_name = "SIGMA", value_parser = positive, allow_hyphen_values = true, help_heading = "Noise and smoothing")]
    noise: Option<f64>,
    /// Lower limit on the moment about an axis, a fraction of the trace; repeatable
    #[arg(long, value_name = "nx,ny,nz,FRACTION", value_parser = numbers::<4>, allow_hyphen_values = true, help_heading = "Known about the tensor")]
    at_least: Vec<[f64; 4]>,
    /// Upper limit on the moment about an axis, a fraction of the trace; repeatable
    #[arg(long, value_name = "nx,ny,nz,FRACTION", value_parser = numbers::<4>, allow_hyphen_values = true, help_heading = "Known about the tensor")]
    at_most: Vec<[f64; 4]>,
    #[command(flatten)]
    known: KnownArguments,
    #[command(flatten)]
    prior: PriorArguments,
    #[command(flatten)]
    wheel: WheelArguments,
    #[command(flatten)]
    carrier: CarrierArguments,
    /// Model of the torque on the body, besides torques in the record; its coefficients are estimated
    #[arg(long, value_enum, default_value_t = Torque::Auto, help_heading = "Torques and wheels")]
    torque: Torque,
    #[command(flatten)]
    sensor: SensorArguments,
    /// Fit even if other units explain the record far better than those that it was read in
    #[arg(long, help_heading = "Reading")]
    trust_units: bool,
    /// Write the residuals to this file: a plot, or rows in a .csv
    #[arg(long, value_name = "FILE.svg|.png|.csv", help_heading = "Output")]
    residuals: Option<PathBuf>,
    /// Draw measured and fitted rates, and |L| and T along the record, to this file
    #[arg(long, value_name = "FILE.svg|.png", help_heading = "Output")]
    figure: Option<PathBuf>,
    /// Write one page with the answer, its tables and plots to this file, also if there is no answer
    #[arg(long, value_name = "FILE.html|.md", help_heading = "Output")]
    report: Option<PathBuf>,
    /// How the result is printed: table on a terminal, csv otherwise
    #[arg(long, value_enum, help_heading = "Output")]
    format: Option<Format>,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: Option<PathBuf>,
}

impl Fit {
    pub(crate) fn run(&self) -> Result<(), Error> {
        self.check_paths()?;
        self.check_wheel()?;
        let Outputs { output, page, residuals, figure } = self.outputs()?;
        memory::check_files(&self.files(), 3)?;
        if self.carrier.is_given() {
            let format = Format::of(self.format, self.out.as_deref())?;
            let wheel = (self.wheel.momentum(), self.wheel.calibrated().is_some());
            let (settings, wanted) = (self.settings()?, carrier::Wanted { output, format, page });
            return carrier::run(&self.carrier, &self.data, &self.reading, wheel, &settings, wanted);
        }
        let chosen = self.poses.chosen(&self.data, &self.reading);
        let read = match &chosen {
            Chosen::Attitudes { .. } => Some(self.attitudes()?),
            Chosen::Rates { beside } => {
                if let Some(noise) = self.poses.noise() {
                    let rule = "is the noise of attitudes, and the rates are fitted";
                    let remedy = "leave it out, or fit the attitudes: --from attitudes";
                    return Err(Error::input("--attitude-noise", &noise.to_string(), rule, remedy));
                }
                self.poses.check_frames(beside, &self.reading)?;
                None
            }
        };
        let (mut record, files) = match &read {
            Some(read) => (read.poses.rates(), read.read_as.clone()),
            None => self.reading.record(&self.data, self.wheel.momentum())?,
        };
        if let Chosen::Rates { beside } = &chosen {
            self.poses.check_stated(beside)?;
        }
        let as_read = AsRead(files);
        chosen.tell();
        let settings = self.settings()?;
        let format = Format::of(self.format, self.out.as_deref())?;
        let names = report::unused(&record);
        if !names.is_empty() {
            warn(&format!("columns not used: {}", names.join(", ")));
        }
        if let (Some(axis), Some(body)) = (self.wheel.calibrated(), self.known.body()?) {
            let settings = settings.with_known(None);
            return output.write_whole(&calibrate::report(
                &record,
                &body,
                &axis,
                &settings,
                &self.names(),
                (format, &as_read),
            )?);
        }
        let mut spans = Spans::default();
        let fitted = match (&read, self.reading.is_whole()) {
            (Some(read), _) => fit_poses(&read.poses, &settings),
            (None, true) => Spans::find(&mut record, &settings).and_then(|found| {
                spans = found;
                fit(&record, &settings)
            }),
            (None, false) => fit(&record, &settings),
        };
        spans.remark().into_iter().for_each(warn);
        let estimate = match fitted {
            Ok(estimate) => estimate,
            Err(error) => {
                let read_as = (&record, &as_read, &spans);
                let method = self.method(read.is_some());
                return Err(self.refused(&error, read_as, (method, format), (output, page))?);
            }
        };
        // as long a computation as the fit itself, for those outputs alone that show it
        let shown = residuals.is_some() || page.is_some() || figure.is_some();
        if let Some(read) =
            read.as_ref().filter(|_| estimate.attitudes.as_ref().is_some_and(|a| a.is_inverse))
        {
            record = read.poses.inverse().rates();
        }
        let motion = if shown { estimate.fitted(&record) } else { Vec::new() };
        let sources = (&spans, read.as_ref(), &as_read);
        let page = page.map(|(file, form)| {
            (file, page::estimated(&estimate, &record, &motion, sources, &self.names(), form))
        });
        output.write_whole(&report::identified(&estimate, &record, sources, format))?;
        if let Some(remark) = self.known.contradiction(&estimate)? {
            warn(&remark);
        }
        // the JSON holds them too; a file of rows does not
        estimate.warnings.iter().for_each(|warning| warn(&warning.to_string()));
        if let Some((file, text)) = page {
            file.write_whole(&text)?;
        }
        self.draw((&estimate, &record, motion.as_slice()), residuals, figure)
    }

    /// By which method a record without an answer was fitted.
    fn method(&self, has_attitudes: bool) -> Method {
        match (has_attitudes, TorqueModel::from(self.torque)) {
            (false, _) => Method::WeakForm,
            (true, TorqueModel::Drag3 | TorqueModel::Quadratic) => Method::Smoother,
            (true, _) => Method::ExactMotion,
        }
    }

    fn settings(&self) -> Result<Settings, Error> {
        let limit = |axis: &[f64; 4]| Limit {
            axis: Vector3::new(axis[0], axis[1], axis[2]),
            at_least: None,
            at_most: None,
        };
        let least = self.at_least.iter().map(|b| Limit { at_least: Some(b[3]), ..limit(b) });
        let most = self.at_most.iter().map(|b| Limit { at_most: Some(b[3]), ..limit(b) });
        Ok(Settings::default()
            .with_radius(self.radius)
            .with_noise(self.noise)
            .with_attitude_noise(self.poses.noise())
            .with_limits(least.chain(most).collect())
            .with_prior(self.prior.prior())
            .with_known(self.known.known()?)
            .with_check_units(!self.trust_units)
            .with_torque(self.torque.into())
            .with_quantum(self.sensor.quantum())
            .with_sensor(self.sensor.priors()))
    }

    /// Every file that is read, in the order in which --window counts them.
    fn files(&self) -> Vec<PathBuf> {
        self.carrier.files(&self.data).into_iter().flatten().cloned().collect()
    }

    /// The attitudes of the files, which go with no wheel.
    fn attitudes(&self) -> Result<Read, Error> {
        if self.wheel.momentum().is_some() {
            let rule = "a wheel is fitted with rates, and attitudes are fitted";
            return Err(Error::input("--wheel", "", rule, "leave it out, or fit the rates: --from rates"));
        }
        self.poses.read(&self.data, &self.reading)
    }

    /// The inertia of a wheel is found from a body that is known, or from a joint fit.
    fn check_wheel(&self) -> Result<(), Error> {
        if self.wheel.calibrated().is_none() || self.carrier.is_given() {
            return Ok(());
        }
        if self.report.is_some() || self.residuals.is_some() || self.figure.is_some() {
            let rule = "the moment of a wheel alone has no page, no residuals and no figure";
            let remedy = "leave out --report, --residuals and --figure, or give --carrier";
            return Err(Error::input("--calibrate-wheel", "", rule, remedy));
        }
        let unused = [
            self.prior.flag(),
            (!self.at_least.is_empty()).then_some("--at-least"),
            (!self.at_most.is_empty()).then_some("--at-most"),
            self.trust_units.then_some("--trust-units"),
        ];
        if let Some(flag) = unused.into_iter().flatten().next() {
            let rule = "--calibrate-wheel takes the tensor of --body as it is, and does not test the units";
            return Err(Error::input(flag, "", rule, "leave it out"));
        }
        if self.known.body()?.is_some() {
            return Ok(());
        }
        let rule = "the inertia of a wheel is found from a body that is known, or from a joint fit";
        Err(Error::input("--calibrate-wheel", "", rule, "name the body by --body, or give --carrier"))
    }

    fn names(&self) -> String {
        self.data.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
    }
}
