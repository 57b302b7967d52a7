//! `polhode plot`: pictures of one body's motion.

pub(crate) mod animation;
pub(crate) mod looks;
mod over_time;
mod paths;
pub(crate) mod poinsot;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use polhode::method::{Claimed, method};
use polhode_files::error::{Error, warn};
use polhode_files::instant::{duration, positive_duration};
use polhode_files::numbers::{numbers, positive};
use polhode_pages::figure::Canvas;
use polhode_pages::output::Output;

use crate::flags::motion::MotionArguments;
use crate::flags::times::span_until;
use looks::{Course, Ended, Flags, Looks};

const USAGE: &str = "polhode plot <KIND> <BODY> [START] --until <T> --out <FILE> [OPTIONS]
  BODY:  --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>
  START: --omega <wx,wy,wz> | --momentum-body <mx,my,mz> | ...
         and --attitude <w,x,y,z> | --angles <phi,theta,psi> | ...";

const EXAMPLES: &str = "Examples:
  polhode plot omega --body t-handle --until 60 --out flips.svg
  polhode plot polhode --moments 1,2,3 --omega 0.4,1,-0.3 --until 20 --out p.png
  polhode plot poinsot --moments 1,2,3 --omega 0.4,1,-0.3 --until 60 \\
    --out p.html
  polhode plot angles --body gyroscope --until 1 --out angles.svg
  polhode plot conserved --moments 1,2,3 --omega 0.4,1,-0.3 --until 1000 \\
    --method rk4 --step 0.05 --out rk4.svg";

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Path of the angular momentum in the body, on the sphere of its directions
    Polhode,
    /// Path of omega in the plane perpendicular to the angular momentum
    Herpolhode,
    /// Components of omega against time, with the flips marked
    Omega,
    /// Euler angles against time; for a symmetric top also the effective potential of its tilt
    Angles,
    /// Path of an axis of the body in space, on the sphere of its directions
    Trace,
    /// The ellipsoid of inertia, which rolls on a plane; as .html an animation
    Poinsot,
    /// Errors of energy and angular momentum against time
    Conserved,
}

/// How large a picture is, pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Size(Option<[f64; 2]>);

const SIZES: [(&str, [f64; 2]); 3] =
    [("column", [500.0, 400.0]), ("wide", [860.0, 400.0]), ("slide", [960.0, 540.0])];
/// The smallest and the largest width and height of a picture, pixels.
const SIDES: [[f64; 2]; 2] = [[400.0, 4000.0], [240.0, 4000.0]];

fn size(text: &str) -> Result<Size, String> {
    if let Some((_, size)) = SIZES.iter().find(|(name, _)| *name == text) {
        return Ok(Size(Some(*size)));
    }
    let names: Vec<&str> = SIZES.iter().map(|(name, _)| *name).collect();
    let unknown =
        || format!("no such size; known: {}, and WIDTHxHEIGHT in pixels as in 640x480", names.join(", "));
    let (width, height) = text.split_once(['x', '×']).ok_or_else(unknown)?;
    let sides = [width, height].map(positive);
    let [Ok(width), Ok(height)] = sides else { return Err(unknown()) };
    for ((name, side), [least, most]) in [("width", width), ("height", height)].into_iter().zip(SIDES) {
        if !(least..=most).contains(&side) {
            return Err(format!("the {name} must lie between {least} and {most} pixels"));
        }
    }
    Ok(Size(Some([width, height])))
}

/// An axis of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum BodyAxis {
    X,
    Y,
    Z,
}

/// Pictures of a motion: polhode, herpolhode, angular velocity, angles, trace, Poinsot's construction, conserved quantities
///
/// The ending of FILE names the format: .svg, .png, or .html for the animation of poinsot, a page that needs no network. The curves
/// are those of --method; if its numbers stop being those of a rotation, the exit code is 1. The title names body, forces, angular
/// velocity at the start, method and step.
#[derive(Args, Clone, Debug)]
#[command(override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Plot {
    /// What is drawn
    #[arg(value_enum, value_name = "KIND")]
    kind: Kind,
    #[command(flatten)]
    pub(crate) motion: MotionArguments,
    /// End of the motion: s, or with a unit (ms, min, h, d)
    #[arg(long, value_name = "T", value_parser = duration, allow_hyphen_values = true, help_heading = "Motion")]
    until: f64,
    /// Time of the start: s, or with a unit; forces may depend on it
    #[arg(long, value_name = "t0", value_parser = duration, allow_hyphen_values = true, default_value = "0", hide_default_value = true, help_heading = "Motion")]
    start_time: f64,
    /// Method: exact, or BASE[:ARGUMENT][@SCHEME][+phase]; see `polhode methods`
    #[arg(long, value_name = "NAME", default_value = "exact", help_heading = "Motion")]
    method: String,
    /// Step of a method with fixed steps, s; exact takes none; taylor, dop853 and tsit5 need none
    #[arg(long, value_name = "h", value_parser = positive_duration, allow_hyphen_values = true, help_heading = "Motion")]
    step: Option<f64>,
    /// Relative tolerance of the methods that choose their steps: taylor, dop853, tsit5
    #[arg(long, value_name = "TOL", value_parser = positive, allow_hyphen_values = true, help_heading = "Motion")]
    tolerance: Option<f64>,
    /// Axis whose path trace draws [default: that of the weight of a top, else z]
    #[arg(long, value_enum, value_name = "AXIS", help_heading = "Picture")]
    axis: Option<BodyAxis>,
    /// Direction from which spheres are seen: azimuth and elevation, deg [default: one that shows the path]
    #[arg(long, value_name = "AZ,EL", value_parser = numbers::<2>, allow_hyphen_values = true, help_heading = "Picture")]
    view: Option<[f64; 2]>,
    /// Size: column (500x400), wide (860x400), slide (960x540) or WIDTHxHEIGHT, in pixels. Long titles, several panels and equal scales make a picture higher. A PNG has twice as many pixels in each direction [default: column]
    #[arg(long, value_name = "SIZE", value_parser = size, help_heading = "Picture")]
    size: Option<Size>,
    /// The picture; its ending names the format: .svg, .png or .html
    #[arg(long, value_name = "FILE", help_heading = "Picture")]
    out: PathBuf,
}

/// Format of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Picture {
    Svg,
    Png,
    Html,
}

impl Picture {
    /// By the ending of the file that `flag` names; one of `known`.
    pub(crate) fn of(flag: &str, path: &Path, known: &[Picture]) -> Result<Self, Error> {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or("").to_ascii_lowercase();
        if let Some(found) = known.iter().find(|picture| picture.ending() == ending) {
            return Ok(*found);
        }
        let endings: Vec<String> = known.iter().map(|picture| format!(".{}", picture.ending())).collect();
        let remedy = format!("known here: {}", endings.join(", "));
        let rule = if ending == "html" {
            "only poinsot is a page that moves"
        } else {
            "its ending is not that of a picture format"
        };
        Err(Error::input(flag, &path.display().to_string(), rule, &remedy))
    }

    fn ending(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Html => "html",
        }
    }
}

/// Writes a page as SVG or PNG.
pub(crate) fn write(file: Output, picture: Picture, page: &Canvas) -> Result<(), Error> {
    match picture {
        Picture::Png => file.write_whole_bytes(&page.png()?),
        Picture::Svg | Picture::Html => file.write_whole(&page.svg()),
    }
}

impl Plot {
    pub(crate) fn run(&self) -> Result<(), Error> {
        self.motion.start.check_angles(false, self.kind == Kind::Angles)?;
        let known: &[Picture] = match self.kind {
            Kind::Poinsot => &[Picture::Svg, Picture::Png, Picture::Html],
            _ => &[Picture::Svg, Picture::Png],
        };
        let picture = Picture::of("--out", &self.out, known)?;
        if self.axis.is_some() && self.kind != Kind::Trace {
            return Err(Error::Input("--axis: only trace draws the path of one axis; leave it out".into()));
        }
        let seen_from = match self.kind {
            Kind::Polhode | Kind::Trace => true,
            Kind::Poinsot => picture != Picture::Html,
            Kind::Herpolhode | Kind::Omega | Kind::Angles | Kind::Conserved => false,
        };
        if self.view.is_some() && !seen_from {
            return Err(Error::Input(
                "--view: only polhode, trace and the still of poinsot are seen from a direction; leave it out".into(),
            ));
        }
        if self.size.is_some() && picture == Picture::Html {
            return Err(Error::Input("--size: only .svg and .png have a size; leave it out".into()));
        }
        if self.kind == Kind::Poinsot && self.method.starts_with("dissipating:") {
            return Err(Error::Input(
                "poinsot: the ellipsoid needs a constant energy, and inner friction changes it; plot polhode or trace"
                    .into(),
            ));
        }
        span_until(self.start_time, self.until)?;
        let file = Output::to_file("--out", &self.out)?;
        let looks = Looks::of(&self.course())?;
        if !looks.is_resolved() {
            let words = format!(
                "--until: '{}': the body turns by {} rad from one of {} points to the next",
                polhode_files::text::short(self.until),
                short(looks.turn()),
                looks.times.len()
            );
            if picture == Picture::Html {
                return Err(Error::Input(format!(
                    "{words}, too far to show the motion; give an earlier end"
                )));
            }
            warn(&format!(
                "{words}, and the points are not joined; an earlier end or a smaller step shows the curve"
            ));
        }
        if picture == Picture::Html {
            file.write_whole(&animation::page(self, &looks)?)?;
        } else {
            write(file, picture, &self.page(&looks)?)?;
        }
        match looks.ended {
            Some(Ended { why, .. }) => {
                Err(Error::Failed(format!("--method {}: {why}; what came before is drawn", self.method)))
            }
            None => Ok(()),
        }
    }

    fn page(&self, looks: &Looks) -> Result<Canvas, Error> {
        Ok(match self.kind {
            Kind::Polhode => paths::polhode(self, looks)?,
            Kind::Herpolhode => paths::herpolhode(self, looks)?,
            Kind::Trace => paths::trace(self, looks)?,
            Kind::Omega => over_time::omega(self, looks),
            Kind::Angles => over_time::angles(self, looks),
            Kind::Conserved => over_time::conserved(self, looks)?,
            Kind::Poinsot => poinsot::still(self, looks)?,
        })
    }

    fn course(&self) -> Course<'_> {
        Course {
            motion: &self.motion,
            method: &self.method,
            step: self.step,
            tolerance: self.tolerance,
            start_time: self.start_time,
            until: self.until,
            one_round: self.kind == Kind::Polhode,
            fewest: looks::FEWEST,
            most: looks::MOST,
            flags: Flags::OWN,
        }
    }

    /// Width and height, pixels.
    fn size(&self) -> [f64; 2] {
        self.size.unwrap_or_default().0.unwrap_or(SIZES[0].1)
    }

    /// What is seen, of which body, from which start on, by which method.
    fn title(&self, what: &str, looks: &Looks) -> String {
        title(what, &self.course(), looks)
    }
}

/// What is seen, of which body, from which start on, by which method.
pub(crate) fn title(what: &str, course: &Course, looks: &Looks) -> String {
    // the step of a method that chooses its own is the time between points
    let has_own = method(course.method).is_ok_and(|method| method.tolerance().is_some());
    let step = course.step.filter(|_| course.method != "exact" && !has_own);
    let method = match (step, course.tolerance) {
        (Some(h), _) => format!("{}, h = {} s", course.method, polhode_files::text::short(h)),
        (None, Some(tolerance)) => format!("{}, tolerance {tolerance:e}", course.method),
        (None, None) => course.method.to_owned(),
    };
    let omega = looks.omegas.first().copied().unwrap_or_default();
    // what is rounding beside the others was a zero
    let rounded = |w: &f64| if w.abs() < 1e-15 * omega.norm() { 0.0 } else { *w };
    let omega: Vec<String> = omega.iter().map(|w| short(rounded(w))).collect();
    let (body, forces, omega) = (course.motion.body.label(), looks.forces(), omega.join(", "));
    format!("{what}: {body}{forces}, ω = ({omega}) rad/s at the start, {method}")
}

/// To four digits, with a true minus.
fn short(x: f64) -> String {
    let four: f64 = format!("{x:.3e}").parse().unwrap_or(x) + 0.0;
    let text = if (1e-3..1e6).contains(&four.abs()) || four == 0.0 {
        format!("{four}")
    } else {
        format!("{four:e}")
    };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_names_or_pixels_within_bounds() {
        assert_eq!(size("wide"), Ok(Size(Some([860.0, 400.0]))));
        assert_eq!(size("640x480"), Ok(Size(Some([640.0, 480.0]))));
        assert!(size("10x480").unwrap_err().contains("the width must lie between 400 and 4000"));
        assert!(size("480x10").unwrap_err().contains("the height must lie between 240 and 4000"));
        assert!(size("huge").unwrap_err().contains("known: column, wide, slide"));
        assert!(size("axb").unwrap_err().contains("WIDTHxHEIGHT"));
    }

    #[test]
    fn titles_have_short_numbers() {
        assert_eq!([0.1 + 0.2, -1e-9, -0.0, 2e-5].map(short), ["0.3", "−1e−9", "0", "2e−5"]);
    }
}
