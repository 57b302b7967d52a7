//! `polhode show`: a page in which the body turns, and others beside it.

mod against;
mod catalogue;
mod look;
mod span;

use std::path::PathBuf;

use clap::Args;
use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{Body, Problem};
use polhode::flow::ExactMotion;
use polhode_files::error::{Error, tell};
use polhode_files::instant::{duration, positive_duration};
use polhode_files::numbers::positive;
use polhode_files::text::{rounded, short};
use polhode_pages::output::Output;
use polhode_pages::scene::{Scene, Track};

use crate::flags::attitude::{check_used, of_order};
use crate::flags::motion::MotionArguments;
use crate::flags::table::{Order, TableArguments};
use crate::flags::times::span_until;
use crate::plot::animation::{OF_THE_TIME, track};
use crate::plot::looks::{Course, Ended, FEWEST, Flags, Looks};
use crate::plot::poinsot::Construction;
use crate::plot::{Picture, title};
use against::Against;

const USAGE: &str = "polhode show <BODY> [START] --out <FILE.html> [OPTIONS]
  BODY:  --body <NAME|FILE> | --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz>
  START: --omega <wx,wy,wz> | --momentum-body <mx,my,mz> | ...
         and --attitude <w,x,y,z> | --angles <phi,theta,psi> | ...";

const EXAMPLES: &str = "Examples:
  polhode show --body t-handle --out flips.html
  polhode show --body racket --against rk4:0.02 --against rattle:0.02 \\
    --until 10 --out racket.html
  polhode propagate --body phone --until 5 --every 0.01 --method mujoco-rk4 \\
    --step 0.01 --fields t,q,omega --out run.csv
  polhode show --body phone --against run.csv --out phone.html
  polhode show --body gyroscope --out top.html";

/// A page holds at most so many attitudes of a body.
const MOST: u64 = 200_000;
/// Between two attitudes a body turns by at most this, rad: the page is then off by about a thousandth.
const RESOLVED: f64 = 0.1;
/// At most so many bodies beside the first.
const MOST_RIVALS: usize = 3;

/// See the body turn: a page of one file, without network
///
/// The page draws the body where its shape is known: a mesh (STL, OBJ, PLY), a link of a URDF model with its meshes, a TOML file of
/// parts, a body of the catalogue. Else it draws a box with the same inertia, and says so. Checkboxes add the angular velocity, the
/// angular momentum, the polhode on the ellipsoid of inertia and the herpolhode on the invariable plane. The motion is computed
/// before the page is written: the exact one where there is a closed form, else by the method taylor.
///
/// --against draws a second body, faded, which a method moves from the same start, or whose attitudes a file has. The page shows the
/// angle between the two, how often each has turned over, and how the energy of the second has changed. A method that diverges is shown
/// up to then; the page and a warning say when, and the exit code is 0.
///
/// In the page: drag or arrow keys turn the view, + and - zoom, space plays and pauses, comma and full stop step back and forth. The
/// end of the address sets what is shown first: #t=3.5 the time in s, #t=3.5&omega&polhode also checkboxes by name, #view=35,20 the
/// azimuth and elevation of the view in degrees.
#[derive(Args, Clone, Debug)]
#[command(override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Show {
    #[command(flatten)]
    pub(crate) motion: MotionArguments,
    /// End of the motion: s, or with a unit (ms, min, h, d) [default: that of the file of --against, else some turns or flips]
    #[arg(long, value_name = "T", value_parser = duration, allow_hyphen_values = true, help_heading = "Motion")]
    until: Option<f64>,
    /// Time of the start: s, or with a unit; forces may depend on it
    #[arg(long, value_name = "t0", value_parser = duration, allow_hyphen_values = true, default_value = "0", hide_default_value = true, help_heading = "Motion")]
    start_time: f64,
    /// Method of the first body: exact, or BASE[:ARGUMENT][@SCHEME][+phase] [default: exact where there is a closed form, else taylor]
    #[arg(long, value_name = "NAME", help_heading = "Motion")]
    method: Option<String>,
    /// Step of --method, if it has fixed steps, s
    #[arg(long, value_name = "h", value_parser = positive_duration, allow_hyphen_values = true, requires = "method", help_heading = "Motion")]
    step: Option<f64>,
    /// Relative tolerance of --method, if it chooses its steps
    #[arg(long, value_name = "TOL", value_parser = positive, allow_hyphen_values = true, requires = "method", help_heading = "Motion")]
    tolerance: Option<f64>,
    /// A second body, faded: a method with its step after the last colon, as rk4:0.1; a method that chooses its steps, as dop853; or a file with attitudes that `polhode audit` reads. Up to three times
    #[arg(long, value_name = "METHOD:STEP|FILE", help_heading = "Comparison")]
    against: Vec<String>,
    #[command(flatten)]
    table: TableArguments,
    /// Place of the scalar in the quaternions of files [default: as named, else found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    quaternion: Option<Order>,
    /// Draw this mesh (STL, OBJ or PLY, in body axes): its centre at that of the body, or its origin at the fixed point of a top
    #[arg(long, value_name = "FILE", help_heading = "Picture")]
    mesh: Option<PathBuf>,
    /// The page
    #[arg(long, alias = "output", value_name = "FILE.html", help_heading = "Picture")]
    out: PathBuf,
}

impl Show {
    pub(crate) fn run(&self) -> Result<(), Error> {
        self.motion.start.check_angles(false, false)?;
        Picture::of("--out", &self.out, &[Picture::Html])?;
        if self.against.len() > MOST_RIVALS {
            let rule = format!("given {} times, and a page shows at most {MOST_RIVALS}", self.against.len());
            return Err(Error::input("--against", "", &rule, "leave some out"));
        }
        let file = Output::to_file("--out", &self.out)?;
        let body = self.motion.body(self.start_time)?;
        let start = self.motion.start(&body, self.start_time)?;
        let against: Vec<Against> =
            self.against.iter().map(|text| Against::of(text)).collect::<Result<_, _>>()?;
        let reads_files = against.iter().any(|against| matches!(against, Against::File(_)));
        self.table.check_read(reads_files, "--against FILE")?;
        let until = match self.until {
            Some(until) => until,
            None => match against::last_time(&against, &self.table.reading(None))? {
                Some(last) if last > self.start_time => last,
                _ => self.start_time + span::span(&body, &start)?,
            },
        };
        span_until(self.start_time, until)?;
        let chosen = match ExactMotion::from_point(&body, start) {
            Ok(_) => "exact",
            Err(_) => "taylor",
        };
        let course = Course {
            motion: &self.motion,
            method: self.method.as_deref().unwrap_or(chosen),
            step: self.step,
            tolerance: self.tolerance,
            start_time: self.start_time,
            until,
            one_round: false,
            fewest: FEWEST,
            most: MOST,
            flags: Flags::OWN,
        };
        let looks = self.looks(course)?;
        let look = look::of(&self.motion.body, &body, self.mesh.as_deref())?;
        let scene = self.scene(&course, &looks, look, &against)?;
        file.write_whole(&scene.page()?)?;
        match looks.ended {
            Some(Ended { why, .. }) => {
                Err(Error::Failed(format!("--method {}: {why}; what came before is shown", course.method)))
            }
            None => Ok(()),
        }
    }

    /// The motion, at looks that are close enough for the eye.
    fn looks(&self, course: Course) -> Result<Looks, Error> {
        let looks = Looks::of(&course)?;
        // between them a body may turn faster than at the start; a method with fixed steps has no others
        if looks.turn() <= RESOLVED || course.step.is_some() {
            return Ok(looks);
        }
        let needed = looks.times.len() as f64 * looks.turn() / RESOLVED * 1.2;
        let looks = Looks::of(&Course { fewest: needed.min(MOST as f64) as u64, ..course })?;
        if looks.turn() <= RESOLVED {
            return Ok(looks);
        }
        let rule = format!(
            "the body then turns by {:.2} rad from one of {} attitudes to the next, and a page has at most so many",
            looks.turn(),
            looks.times.len()
        );
        let span = span::two_digits(0.7 * course.span() * RESOLVED / looks.turn());
        let earlier = format!("--until {}", course.start_time + span);
        Err(Error::input(
            "--until",
            &short(course.until),
            &rule,
            &format!("give an earlier end, as {earlier}"),
        ))
    }

    fn scene(
        &self,
        course: &Course,
        looks: &Looks,
        look: look::Drawn,
        against: &[Against],
    ) -> Result<Scene, Error> {
        let construction = match looks.body.problem() {
            Problem::Free if moves(&looks.states[0].momentum()) => Some(Construction::of(looks)?),
            _ => None,
        };
        let upright = construction.as_ref().map_or_else(UnitQuaternion::identity, |found| found.upright);
        let first = track(course, looks, upright);
        let mut scene = Scene::new(title("Rotation", course, looks) + &looks.remark(), first);
        if keeps_energy(&looks.body) {
            scene.body.energy_changes = looks.energy_changes.clone();
        }
        if !turns(&scene.body) {
            scene.notes.push("The body is at rest: nothing moves.".into());
            tell("note", "the body is at rest: nothing moves on the page");
        }
        scene.notes.push(sentence(&look.words));
        scene.shape = look.shape;
        scene.ellipsoid = construction.map(|found| found.ellipsoid(looks));
        let mut has_quaternions = false;
        for against in against {
            let rival = self.rival(against, course, looks, upright, &scene.body)?;
            has_quaternions |= rival.has_quaternions;
            scene.notes.push(rival.note);
            scene.rivals.push(rival.track);
        }
        check_used(of_order(self.quaternion), has_quaternions, "a quaternion")?;
        if scene.ellipsoid.is_some() {
            scene
                .notes
                .push("L points down, as in Poinsot's construction: the invariable plane lies below.".into());
            scene.notes.extend((!looks.keeps_ellipsoid()).then(|| OF_THE_TIME.to_owned()));
        }
        if scene.body.times.len() > 2 {
            scene.notes.push(format!(
                "{} attitudes of the body, {}; between two of them the page turns it evenly, at most about {} rad off the motion.",
                scene.body.times.len(),
                course.method,
                rounded(span::two_digits(scene.body.interpolation_error()))
            ));
        }
        Ok(scene)
    }
}

fn moves(momentum: &Vector3<f64>) -> bool {
    momentum.norm() > 0.0
}

/// Whether any attitude differs from the first.
fn turns(track: &Track) -> bool {
    track.attitudes.iter().any(|q| Some(q) != track.attitudes.first())
}

/// With a capital and a full stop.
fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| format!("{}{}.", first.to_uppercase(), letters.as_str()))
}

/// Whether the energy of a body is conserved, so that its change is an error.
fn keeps_energy(body: &Body) -> bool {
    body.conserved().contains(&polhode::body::Conserved::Energy)
}
