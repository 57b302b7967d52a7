//! Random arguments over the whole range of doubles: no panic, no endless call, nothing but numbers in what is `Ok`.
//!
//! `POLHODE_HOSTILE` asks for another number of calls of each constructor, `POLHODE_HOSTILE_SEED` for other ones.

use std::fmt::Display;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::audit::{Attitudes, Noise, Question, Trajectory, audit};
use polhode::body::{Body, Clock, Force, Point, Problem, Rotor, State, Time};
use polhode::flow::{Casimir, Flow, FreeFlow, FreeMotion, LagrangeTop, Turn};
use polhode::inertia::{
    Amount, Closing, Evidence, FLOAT_WELD, Inertia, InertiaShape, MassProperties, Mesh, Region, Solid,
    Surface, Twin, diagnose,
};
use polhode::method::schemes::{Pairs, Part, Scheme, Stages};
use polhode::method::{Claimed, PhaseError, UnknownMethod, method};
use polhode::num::elliptic::{Modulus, incomplete, jacobi, r_c, r_d, r_f, r_j};
use polhode::num::{Dd, Expansion, Precise, Random, Real, trig};
use polhode::rotation::{Quat, Vec3};
use polhode::run::{Checkpoint, Run, Watch};

struct Draw(Random);

impl Draw {
    fn below(&mut self, count: u64) -> u64 {
        self.0.below(count)
    }

    fn one_in(&mut self, count: u64) -> bool {
        self.below(count) == 0
    }

    /// In (0, 1).
    fn share(&mut self) -> f64 {
        self.0.uniform()
    }

    fn sign(&mut self) -> f64 {
        if self.one_in(2) { -1.0 } else { 1.0 }
    }

    /// Any double: its logarithm uniform over normal and subnormal numbers, and now and then a special one.
    fn any(&mut self) -> f64 {
        const SPECIAL: [f64; 14] = [
            0.0,
            -0.0,
            f64::from_bits(1),
            -f64::from_bits(1),
            f64::MIN_POSITIVE,
            f64::MAX,
            -f64::MAX,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
            1.0,
            -1.0,
            1.0 + f64::EPSILON,
            1e-160,
        ];
        if self.one_in(12) {
            return SPECIAL[self.below(SPECIAL.len() as u64) as usize];
        }
        let exponent = -1074 + self.below(1074 + 1024) as i32;
        self.sign() * libm::scalbn(1.0 + self.share(), exponent)
    }

    /// Mostly numbers within `decades` of `size`, which lie in the domain of a function; else any.
    fn near(&mut self, size: f64, decades: f64) -> f64 {
        match self.below(20) {
            0 => self.any(),
            1 => 0.0,
            2 => size,
            _ => size * libm::exp10(decades * (2.0 * self.share() - 1.0)),
        }
    }

    /// A size that a list of numbers has in common, and the decades over which they scatter.
    fn scale(&mut self) -> (f64, f64) {
        let size = match self.below(4) {
            0 => 1.0,
            1 => libm::exp10(40.0 * (2.0 * self.share() - 1.0)),
            _ => self.any().abs(),
        };
        let decades = [0.0, 1e-15, 0.2, 1.0, 20.0, 300.0];
        (size, decades[self.below(decades.len() as u64) as usize])
    }

    fn list<const N: usize>(&mut self) -> [f64; N] {
        let (size, decades) = self.scale();
        let signed = self.one_in(2);
        std::array::from_fn(|_| {
            let x = self.near(size, decades);
            if signed { self.sign() * x } else { x }
        })
    }

    fn vector(&mut self) -> Vector3<f64> {
        self.list().into()
    }

    fn attitude(&mut self) -> UnitQuaternion<f64> {
        let q = [0; 4].map(|_| self.share() - 0.5);
        polhode::rotation::Quat::from_components(q).into()
    }

    /// A tensor: any matrix, any symmetric one, or a body's that is turned, spoiled by rounding, or scaled.
    fn tensor(&mut self) -> Matrix3<f64> {
        if self.one_in(8) {
            return Matrix3::from(self.list::<3>().map(|_| self.list::<3>()));
        }
        let [xx, yy, zz] = self.list::<3>();
        let mut off = self.list::<3>();
        if self.one_in(2) {
            let (a, b, c) = (xx.abs(), yy.abs(), zz.abs());
            let moments = Matrix3::from_diagonal(&Vector3::new(b + c, a + c, a + b));
            let r = self.attitude().to_rotation_matrix();
            let tensor = r.matrix() * moments * r.matrix().transpose();
            return if self.one_in(2) { moments } else { (tensor + tensor.transpose()) * 0.5 };
        }
        if self.one_in(2) {
            off = off.map(|x| if x.is_finite() { 1e-3 * x } else { x });
        }
        let [xy, xz, yz] = off;
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }
}

/// No call takes longer.
const LONGEST: Duration = Duration::from_secs(1);

/// The processor time of this thread so far, which other programs on the machine do not lengthen; where the system does not tell
/// it, what has passed.
fn processor_time() -> Duration {
    static BEGUN: LazyLock<Instant> = LazyLock::new(Instant::now);
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split(' ').next()?.parse().ok());
    nanoseconds.map_or_else(|| BEGUN.elapsed(), Duration::from_nanos)
}

/// Runs `call` often, each time with another stream of random numbers; it returns what is wrong.
fn hostile(seed: u64, share: f64, mut call: impl FnMut(&mut Draw) -> Result<(), String>) {
    let count = std::env::var("POLHODE_HOSTILE").map_or(3000.0, |count| count.parse().unwrap());
    let other: u64 = std::env::var("POLHODE_HOSTILE_SEED").map_or(0, |seed| seed.parse().unwrap());
    let (seed, count) = (seed ^ (other << 32), (count * share) as u64);
    let random = Random::new(seed);
    let mut slowest = Duration::ZERO;
    for number in 0..count {
        let begun = processor_time();
        if let Err(what) = call(&mut Draw(random.stream(number))) {
            panic!("seed {seed}, stream {number}: {what}");
        }
        let took = processor_time().saturating_sub(begun);
        assert!(took < LONGEST, "seed {seed}, stream {number} took {took:?}");
        slowest = slowest.max(took);
    }
    let thread = std::thread::current();
    println!("{}: {count} calls, the slowest {slowest:?}", thread.name().unwrap_or_default());
}

/// A refusal in words, without hundreds of digits.
fn refused(error: &impl Display) -> Result<(), String> {
    let text = error.to_string();
    let digits = text.split(|c: char| !c.is_ascii_digit()).map(str::len).max().unwrap_or(0);
    if digits > 25 || text.len() > 800 { Err(format!("unreadable refusal: {text}")) } else { Ok(()) }
}

fn all(good: bool, what: &str, of: &dyn std::fmt::Debug) -> Result<(), String> {
    if good { Ok(()) } else { Err(format!("{what}: {of:?}")) }
}

fn finite(values: &[f64]) -> bool {
    values.iter().all(|x| x.is_finite())
}

fn check_inertia(inertia: &Inertia, draw: &mut Draw) -> Result<(), String> {
    let moments = inertia.principal_moments();
    all(finite(&moments) && moments[0] > 0.0 && moments.is_sorted(), "moments", inertia)?;
    let tensor = inertia.tensor();
    all(finite(tensor.as_slice()) && tensor == tensor.transpose(), "tensor", inertia)?;
    let axes = inertia.principal_axes();
    all((axes.norm() - 1.0).abs() < 1e-15, "axes", inertia)?;
    all(!inertia.symmetry().name().is_empty(), "symmetry", inertia)?;
    check_shape(&inertia.shape(), draw)
}

fn check_shape(shape: &InertiaShape, draw: &mut Draw) -> Result<(), String> {
    let tensor = shape.tensor();
    all(finite(tensor.as_slice()) && (tensor.trace() - 1.0).abs() < 1e-15, "shape", shape)?;
    let trace = draw.any();
    match shape.with_trace(trace) {
        Ok(inertia) => {
            let got = inertia.tensor() / trace;
            all((got - tensor).amax() < 1e-15, "with_trace", &(trace, inertia))
        }
        Err(error) => refused(&error),
    }
}

#[test]
fn inertia() {
    hostile(1, 1.0, |draw| {
        let moments = draw.list::<3>();
        match Inertia::from_moments(moments) {
            Ok(inertia) => {
                let mut sorted = moments;
                sorted.sort_by(f64::total_cmp);
                all(inertia.principal_moments() == sorted, "other moments", &moments)?;
                check_inertia(&inertia, draw)?;
            }
            Err(error) => refused(&error)?,
        }
        match Inertia::from_positive_moments(moments) {
            Ok(inertia) => check_inertia(&inertia, draw)?,
            Err(error) => refused(&error)?,
        }
        match Inertia::from_products(draw.list(), draw.list()) {
            Ok(inertia) => check_inertia(&inertia, draw)?,
            Err(error) => refused(&error)?,
        }
        let tensor = draw.tensor();
        match Inertia::from_tensor(tensor) {
            Ok(inertia) => {
                let (size, exact) = (tensor.amax(), inertia.tensor());
                all((exact - tensor).amax() <= 1e-11 * size, "another tensor", &tensor)?;
                check_inertia(&inertia, draw)?;
            }
            Err(error) => refused(&error)?,
        }
        match InertiaShape::from_tensor(tensor) {
            Ok(shape) => check_shape(&shape, draw),
            Err(error) => refused(&error),
        }
    });
}

fn check_mass(body: &MassProperties, draw: &mut Draw) -> Result<(), String> {
    all(body.mass() > 0.0 && body.mass().is_finite(), "mass", body)?;
    all(finite(body.center_of_mass().as_slice()) && finite(body.tensor().as_slice()), "readings", body)?;
    let moments = body.principal_moments();
    all(finite(&moments) && moments[0] >= 0.0 && moments.is_sorted(), "moments", body)?;
    all(finite(&body.triangle_margins()), "margins", body)?;
    all((body.principal_axes().norm() - 1.0).abs() < 1e-15, "axes", body)?;
    all(!body.class().name().is_empty(), "class", body)?;
    match body.inertia() {
        Ok(inertia) => check_inertia(&inertia, draw)?,
        Err(error) => refused(&error)?,
    }
    let point = draw.vector();
    match body.inertia_about(point) {
        Ok(inertia) => check_inertia(&inertia, draw)?,
        Err(error) => refused(&error)?,
    }
    match body.tensor_about(point) {
        Ok(tensor) => all(finite(tensor.as_slice()), "tensor about a point", &(body, point)),
        Err(error) => refused(&error),
    }
}

#[test]
fn mass() {
    hostile(2, 1.0, |draw| {
        let [mass] = draw.list();
        let new = MassProperties::new(mass, draw.vector(), draw.tensor());
        let about = MassProperties::from_tensor_about(draw.vector(), mass, draw.vector(), draw.tensor());
        let points: Vec<_> = (0..draw.below(4)).map(|_| (draw.list::<1>()[0].abs(), draw.vector())).collect();
        let points = MassProperties::of_points(points);
        let bodies: Vec<MassProperties> =
            [&new, &about, &points].into_iter().filter_map(|body| body.as_ref().ok()).copied().collect();
        for result in [new, about, points, MassProperties::sum(bodies.clone())] {
            match result {
                Ok(body) => check_mass(&body, draw)?,
                Err(error) => refused(&error)?,
            }
        }
        for body in bodies {
            check_mass(&body.turned(draw.attitude()), draw)?;
            match body.moved(draw.vector()) {
                Ok(body) => check_mass(&body, draw)?,
                Err(error) => refused(&error)?,
            }
        }
        Ok(())
    });
}

fn amount(draw: &mut Draw) -> Amount {
    let [x] = draw.list();
    if draw.one_in(2) { Amount::Mass(x) } else { Amount::Density(x) }
}

#[test]
fn solids() {
    hostile(3, 1.0, |draw| {
        let name = Solid::names().nth(draw.below(14) as usize).unwrap_or("brick");
        let sizes = draw.list::<3>();
        let solid = match Solid::named(name, &sizes[..draw.below(4) as usize]) {
            Ok(solid) => solid,
            Err(error) => return refused(&error),
        };
        match solid.with(amount(draw)) {
            Ok(body) => {
                all(body.principal_moments()[2] > 0.0, "a solid without a moment", &solid)?;
                check_mass(&body, draw)
            }
            Err(error) => refused(&error),
        }
    });
}

#[test]
fn distributions() {
    hostile(4, 0.002, |draw| {
        let region = match draw.below(4) {
            0 => Region::Box(draw.list()),
            1 => Region::Ellipsoid(draw.list()),
            2 => Region::Layer { inner: draw.list::<1>()[0], outer: draw.list::<1>()[0] },
            _ => Region::Cylinder { radius: draw.list::<1>()[0], height: draw.list::<1>()[0] },
        };
        let [density] = draw.list();
        match region.filled(|_| density, 1e-6) {
            Ok(body) => check_mass(&body, draw),
            Err(error) => refused(&error),
        }
    });
}

#[test]
fn meshes() {
    hostile(5, 1.0, |draw| {
        let (size, decades) = draw.scale();
        let [o, a, b, c] = [0; 4].map(|_| {
            Vector3::from([0; 3].map(|_| {
                let x = draw.near(size, decades);
                draw.sign() * x
            }))
        });
        let faces = [[o, b, a], [o, a, c], [o, c, b], [a, b, c]];
        let turned = faces.map(|[a, b, c]| [a, c, b]);
        for faces in [faces, turned] {
            match Mesh::new(faces) {
                Ok(mesh) => {
                    all(mesh.volume() > 0.0 && mesh.volume().is_finite(), "volume", &faces)?;
                    all(mesh.triangles() == 4 && mesh.vertices() == 4, "count", &faces)?;
                    match mesh.with(amount(draw)) {
                        Ok(body) => check_mass(&body, draw)?,
                        Err(error) => refused(&error)?,
                    }
                }
                Err(error) => refused(&error)?,
            }
        }
        Ok(())
    });
}

#[test]
fn surfaces() {
    hostile(7, 1.0, |draw| {
        let (size, decades) = draw.scale();
        let corners: Vec<Vector3<f64>> = (0..3 + draw.below(6))
            .map(|_| {
                Vector3::from([0; 3].map(|_| {
                    let x = draw.near(size, decades);
                    draw.sign() * x
                }))
            })
            .collect();
        let faces: Vec<[Vector3<f64>; 3]> = (0..1 + draw.below(8))
            .map(|_| [0; 3].map(|_| corners[draw.below(corners.len() as u64) as usize]))
            .collect();
        let weld = if draw.one_in(2) { FLOAT_WELD } else { draw.list::<1>()[0] };
        let surface = match Surface::new(faces) {
            Ok(surface) => surface,
            Err(error) => return refused(&error),
        };
        let closed = [Closing::Fan, Closing::Hull].map(|how| surface.closed(weld, how));
        for found in closed.into_iter().chain([surface.mended(weld)]) {
            match found {
                Ok((mesh, repairs)) => {
                    all(mesh.volume() > 0.0 && mesh.volume().is_finite(), "volume", &repairs)?;
                }
                Err(error) => refused(&error)?,
            }
        }
        match surface.sheet(amount(draw)) {
            Ok(body) => check_mass(&body, draw),
            Err(error) => refused(&error),
        }
    });
}

#[test]
fn doctor() {
    hostile(6, 1.0, |draw| {
        let evidence = Evidence::default()
            .with_mass(draw.one_in(2).then(|| draw.list::<1>()[0].abs()))
            .with_center_of_mass(draw.one_in(2).then(|| draw.vector()))
            .with_extents(draw.one_in(2).then(|| draw.list::<3>().map(f64::abs)))
            .with_twin(draw.one_in(2).then(|| Twin { center_of_mass: draw.vector(), tensor: draw.tensor() }));
        let tensor = draw.tensor();
        let found = match diagnose(tensor, &evidence) {
            Ok(found) => found,
            Err(error) => return refused(&error),
        };
        let readings = [found.principal_moments, found.triangle_margins, found.equivalent_box];
        let good = finite(readings.as_flattened())
            && finite(found.nearest.as_slice())
            && found.distance.is_finite()
            && found.misfit.is_none_or(|misfit| misfit.ratio.is_finite())
            && found.causes.iter().all(|c| c.cost.is_finite() && finite(c.corrected.as_slice()));
        all(good, "diagnosis", &(tensor, evidence, &found))?;
        found.causes.iter().try_for_each(|cause| refused(&cause.cause))?;
        found.violation.iter().try_for_each(refused)
    });
}

#[test]
fn flow() {
    hostile(7, 1.0, |draw| {
        let moments = draw.list::<3>().map(f64::abs);
        let inertia = if draw.one_in(2) {
            Inertia::from_positive_moments(moments)
        } else {
            Inertia::from_tensor(draw.tensor())
        };
        let Ok(inertia) = inertia else { return Ok(()) };
        let omega = draw.vector();
        let motion = match FreeMotion::from_omega(&inertia, draw.attitude(), omega) {
            Ok(motion) => motion,
            Err(error) => return refused(&error),
        };
        all(motion.reach() > 0.0, "reach", &(&inertia, omega))?;
        let rate = omega.norm();
        let times = [draw.any(), 1.0 / rate, -3e3 / rate, draw.share() * motion.reach(), 0.0];
        for t in times {
            match (motion.at(t), motion.omega_at(t)) {
                (Ok(x), Ok(omega)) => {
                    let norm = x.attitude.norm_squared();
                    let good = x.is_finite() && finite(omega.as_slice()) && (norm - 1.0).abs() < 1e-12;
                    all(good, "state", &(&inertia, motion.at(0.0), omega, t, x))?;
                }
                (Err(a), Err(b)) => {
                    all(a == b || t.is_nan(), "two answers", &(&inertia, omega, t))?;
                    refused(&a)?;
                }
                other => return Err(format!("{inertia:?} {omega} at {t}: {other:?}")),
            }
        }
        if let Ok(found) = motion.character() {
            let options = [
                found.parameter,
                found.complement,
                found.polhode_period,
                found.nutation_period,
                found.precession_rate,
            ];
            let readings = options.into_iter().flatten().chain([found.spin, found.separatrix_distance]);
            all(readings.into_iter().all(f64::is_finite), "character", &(&inertia, omega, found))?;
        }
        Ok(())
    });
}

#[test]
fn rotors_and_their_flows() {
    hostile(11, 1.0, |draw| {
        let rotor = match Rotor::new(draw.list::<3>()) {
            Ok(rotor) => rotor,
            Err(error) => return refused(&error),
        };
        let m = Vec3(draw.list::<3>().map(|m| m.clamp(-1e6, 1e6)));
        let [turn, ..] = Turn::of(&rotor);
        let [ball, ..] = Casimir::of(&rotor);
        let flows: [&dyn Flow<f64>; 3] = [&turn, &ball, &FreeFlow::new(&rotor)];
        for flow in flows {
            let mut x = Point::new(Quat::identity(), m);
            let now = Time::from_seconds(0.0);
            flow.flow(now, draw.share(), &mut x);
            all(x.is_finite() || !finite(&m.0), "point", &(rotor, x))?;
        }
        Ok(())
    });
}

/// What may follow the base of a name, thousands of times: no call for each, which would fill the stack.
#[test]
fn names_of_methods() {
    for part in ["+phase", ":10", "+phase@kahan-li-8", ":", "@"] {
        let name = format!("rattle{}", part.repeat(20_000));
        assert!(method(&name).is_err(), "{part}");
    }
    let often = method(&format!("rattle{}", "+phase".repeat(20_000)));
    let Err(error) = often else { panic!("what is taken back is so once") };
    assert!(matches!(error, UnknownMethod::Phase(PhaseError::TakenBack { .. })), "{error:?}");
    refused(&error).unwrap();
}

#[test]
fn schemes() {
    hostile(12, 0.2, |draw| {
        let mut list = |most: u64| -> &'static [Dd] {
            let count = draw.below(most);
            (0..count).map(|_| Dd::of(draw.near(0.3, 1.0))).collect::<Vec<_>>().leak()
        };
        let (a, b, c, d) = (list(4), list(4), list(3), list(3));
        let pairs = match draw.below(4) {
            0 => Pairs::Any,
            1 => Pairs::Nystrom,
            2 => Pairs::NearIntegrable(&[4, 2]),
            _ => Pairs::NearIntegrableNystrom(&[6, 2]),
        };
        let first = if draw.one_in(2) { Part::A } else { Part::B };
        let stages = match draw.below(5) {
            0 => Stages::Composition(a),
            1 => Stages::Processed { kernel: a, processor: b },
            2 => Stages::ForceGradient { first, a, b, c },
            3 => Stages::ProcessedAlternating { a, b, processor_a: c, processor_b: d, pairs },
            _ => Stages::Alternating { first, a, b, pairs },
        };
        let order = [2, 4, 6, 32, 0, u32::MAX][draw.below(6) as usize];
        match Scheme::new("hostile", order, stages, "") {
            Ok(scheme) => all(order == 2 && scheme.stages() == stages, "order", &scheme),
            Err(error) => refused(&error),
        }
    });
}

#[test]
fn tops() {
    hostile(10, 1.0, |draw| {
        let [a, c] = draw.list::<2>().map(f64::abs);
        let Ok(inertia) = Inertia::from_positive_moments([a, a, c]) else { return Ok(()) };
        let (size, decades) = draw.scale();
        let weight = Vector3::new(0.0, 0.0, a * draw.near(size, decades));
        let body = match Body::heavy(inertia, weight) {
            Ok(body) => body,
            Err(error) => return refused(&error),
        };
        let omega = Vector3::from([0; 3].map(|_| draw.near(size, decades)));
        let attitude = match draw.below(3) {
            0 => UnitQuaternion::identity(),
            1 => UnitQuaternion::from_scaled_axis(Vector3::new(
                draw.near(1.0, 20.0).clamp(-3.0, 3.0),
                0.0,
                0.0,
            )),
            _ => draw.attitude(),
        };
        let top = match LagrangeTop::from_omega(&body, attitude, omega) {
            Ok(top) => top,
            Err(error) => return refused(&error),
        };
        all(top.reach() > 0.0, "reach", &(&body, attitude, omega))?;
        for t in [draw.any(), 1.0 / omega.norm(), -3e3 / omega.norm(), draw.share() * top.reach(), 0.0] {
            match top.at(t) {
                Ok(x) => {
                    let good = x.is_finite() && (x.attitude.norm_squared() - 1.0).abs() < 1e-12;
                    all(good, "state", &(&body, attitude, omega, t, x))?;
                }
                Err(error) => refused(&error)?,
            }
        }
        let readings = top.turning_points().into_iter().chain(top.nutation_period());
        let mut readings = readings.chain(top.precession_per_nutation());
        all(readings.all(f64::is_finite), "readings", &(&body, attitude, omega))
    });
}

#[test]
fn numbers() {
    hostile(8, 1.0, |draw| {
        let [x, y, z, p] = draw.list::<4>();
        let valid = [x, y, z, p].iter().all(|x| *x >= 0.0);
        let integrals = [r_f(x, y, z), r_c(x, y), r_j(x, y, z, p), r_d(x, y, z)];
        all(!valid || integrals.iter().all(|i| *i >= 0.0), "Carlson", &([x, y, z, p], integrals))?;
        let precise = [x, y, z, p].map(Dd::from);
        let [a, b, c, d] = precise;
        let integrals = [r_f(a, b, c), r_c(a, b), r_j(a, b, c, d), r_d(a, b, c)].map(Dd::hi);
        all(!valid || integrals.iter().all(|i| *i >= 0.0), "Carlson in Dd", &([x, y, z, p], integrals))?;

        let (u, m1) =
            (draw.any(), if draw.one_in(4) { draw.any() } else { draw.share() * draw.any().abs().min(1.0) });
        let (sn, cn, dn) = jacobi(u, m1);
        let good = [sn, cn].iter().all(|x| x.abs() <= 1.0 + 1e-15) && (0.0..=1.0 + 1e-15).contains(&dn);
        all(good || !(0.0..=1.0).contains(&m1) || !u.is_finite(), "Jacobi", &(u, m1, sn, cn, dn))?;
        if m1 > 0.0 && m1 <= 1.0 {
            let quarter = Modulus::new(m1).quarter_period();
            all((1.57..1e3).contains(&quarter), "quarter period", &m1)?;
            let angle = draw.share() * std::f64::consts::FRAC_PI_2;
            let (sn, cn) = trig::sin_cos(angle);
            let u = incomplete(sn, cn, 1.0 - m1, m1);
            all((0.0..=quarter * (1.0 + 1e-14)).contains(&u), "incomplete", &(angle, m1, u))?;
        }
        let (s, c) = trig::sin_cos(x);
        all(!x.is_finite() || (s.abs() <= 1.0 && c.abs() <= 1.0), "sine", &x)?;

        let mut pair = Dd::sum(x, y);
        if draw.one_in(2) {
            pair = Dd::from(x);
        }
        all(!pair.hi().is_finite() || pair.lo().is_finite(), "sum", &(x, y, pair))?;
        // beyond, products of parts overflow
        if pair.hi().abs() < 1e307 {
            let (s, c) = pair.sin_cos();
            all(s.magnitude() <= 1.0 && c.magnitude() <= 1.0, "sine in Dd", &pair)?;
            all(!pair.exp().hi().is_nan() && !pair.exp_m1().hi().is_nan(), "exponential", &pair)?;
            all(pair.hi() < 0.0 || !pair.sqrt().hi().is_nan(), "root", &pair)?;
            all(pair.hi() < 0.0 || !pair.ln().hi().is_nan(), "logarithm", &pair)?;
            all(!pair.atan2(Dd::from(z)).hi().is_nan() || z.is_nan(), "arctangent", &(pair, z))?;
            let back: Result<Dd, _> = pair.to_string().parse();
            all(back.is_ok_and(|back| back.hi().is_finite()), "text", &pair)?;
            all((pair.round() - pair).magnitude() <= 0.5, "round", &pair)?;
        }
        let sum = Expansion::sum([x, y, z]).to_dd();
        all(
            !finite(&[x, y, z]) || x.abs().max(y.abs()).max(z.abs()) > 1e307 || sum.hi().is_finite(),
            "sum",
            &[x, y, z],
        )
    });
}

#[test]
fn records() {
    use polhode::record::{Record, Segment};
    let check = |segments: &[Segment]| -> Result<(), String> {
        for segment in segments {
            let (times, rates) = (segment.times(), segment.rates());
            let good = finite(times)
                && rates.iter().all(|w| finite(w.as_slice()))
                && times.len() == rates.len()
                && times.is_sorted_by(|a, b| a < b);
            all(good, "segment", segment)?;
        }
        Ok(())
    };
    hostile(9, 1.0, |draw| {
        let count = draw.below(12) as usize;
        let mut times: Vec<f64> = (0..count).map(|_| draw.list::<1>()[0]).collect();
        if draw.one_in(2) {
            let (size, _) = draw.scale();
            times = (0..count).map(|k| k as f64 * size).collect();
        }
        if draw.one_in(2) {
            times.sort_by(f64::total_cmp);
        }
        let longer = usize::from(draw.one_in(8));
        let rates: Vec<Vector3<f64>> = (0..count + longer).map(|_| draw.vector()).collect();
        match Segment::new("a", times.clone(), rates.clone()) {
            Ok(segment) => check(&[segment])?,
            Err(error) => refused(&error)?,
        }
        let record = match Record::from_samples(&times, &rates) {
            Ok(record) => record,
            Err(error) => return refused(&error),
        };
        check(&record.segments)?;
        match record.windows(&[(draw.any(), draw.any()), (times[0], draw.any())]) {
            Ok(cut) => check(&cut.segments)?,
            Err(error) => refused(&error)?,
        }
        Ok(())
    });
}

#[test]
fn attitudes() {
    use polhode::strapdown::{Budgeted, Kind, Rule, Sensor, Strapdown, choose, noise};
    let rules =
        [(2, 2), (4, 4), (6, 8), (6, 12)].map(|(order, samples)| Rule::magnus(order, samples).unwrap());
    let rules: Vec<Rule> = rules.into_iter().chain(Rule::RIVALS).collect();
    hostile(12, 0.5, |draw| {
        let count = draw.below(30) as usize;
        let (size, decades) = draw.scale();
        let mut t = 0.0;
        let mut times = Vec::new();
        for _ in 0..count {
            t += if draw.one_in(20) { draw.any() } else { draw.near(size, decades) };
            times.push(t);
        }
        let slow = draw.share() / size;
        let readings: Vec<Vector3<f64>> = (0..count)
            .map(|_| if draw.one_in(40) { draw.vector() } else { Vector3::repeat(slow * draw.sign()) })
            .collect();
        let kind = Kind::ALL[draw.below(3) as usize];
        let rule = rules[draw.below(rules.len() as u64) as usize];
        let start = draw.attitude();
        let mut plain = match Strapdown::new(kind, rule, start.into()) {
            Ok(strapdown) => strapdown,
            Err(error) => return refused(&error),
        };
        let sensor = Sensor::default().with_noise(draw.share()).with_stamps(draw.share());
        let mut budgeted = Budgeted::new(kind, rule, start, sensor).map_err(|error| error.to_string())?;
        let (mut known, mut estimated) = (Vec::new(), Vec::new());
        for (t, reading) in times.iter().zip(&readings) {
            match plain.push(*t, (*reading).into()) {
                Ok(ready) => known.extend_from_slice(ready),
                Err(error) => refused(&error)?,
            }
            match budgeted.push(*t, *reading) {
                Ok(ready) => estimated.extend_from_slice(ready),
                Err(error) => refused(&error)?,
            }
        }
        known.extend_from_slice(plain.finish());
        estimated.extend_from_slice(budgeted.finish());
        all(known.len() == estimated.len(), "lengths", &(known.len(), estimated.len()))?;
        for (stamped, estimate) in known.iter().zip(&estimated) {
            let q = stamped.attitude;
            let good = (q.norm_squared() - 1.0).abs() < 1e-12 && estimate.budget.truncation.is_finite();
            all(good, "attitude", &(kind, rule, &times, &readings, stamped, estimate))?;
        }
        let found = noise(&times, &readings);
        all(found >= 0.0, "noise", &(&times, &readings, found))?;
        choose(&times, &readings, kind, None, None, sensor).map_or_else(|error| refused(&error), |_| Ok(()))
    });
}

/// Forces of any parameters; those built in that are refused are left out.
fn forces(draw: &mut Draw) -> Result<Vec<Force>, String> {
    let made = [
        Force::drag(draw.any(), draw.any()),
        Force::constant_torque_body(draw.vector()),
        Force::constant_torque_space(draw.vector()),
        Force::gravity_gradient(draw.any(), draw.share() * 1.1),
    ];
    let mut kept = Vec::new();
    for force in made {
        match force {
            Ok(force) if draw.one_in(3) => kept.push(force),
            Ok(_) => {}
            Err(error) => refused(&error)?,
        }
    }
    if draw.one_in(6) {
        let value = draw.any();
        kept.push(Force::torque_fn("constant", move |_, _, _| Vector3::repeat(value)));
    }
    Ok(kept)
}

/// A state of a body, read in every way.
fn check_state(body: &Body, x: &State, t: f64) -> Result<(), String> {
    let at = |what: &str| format!("{what} of {body:?}");
    all(x.is_finite(), &at("state"), x)?;
    all(finite(body.omega_body(x).as_slice()), &at("omega"), x)?;
    if matches!(body.problem(), Problem::Free | Problem::Linear) {
        all(body.energy_at(t, x).is_finite(), &at("energy"), x)?;
    }
    Ok(())
}

#[test]
fn bodies_and_runs() {
    const METHODS: [&str; 9] = [
        "explicit-euler",
        "semi-implicit-euler",
        "rk4",
        "rk4-normalized",
        "implicit-midpoint",
        "rattle",
        "lie-poisson:321@kahan-li-6",
        "kick-drift",
        "kick-drift@srkn-6b",
    ];
    hostile(11, 0.3, |draw| {
        let Ok(inertia) = Inertia::from_moments(draw.list::<3>().map(f64::abs)) else { return Ok(()) };
        let weight = if draw.one_in(2) { Vector3::zeros() } else { draw.vector() };
        let mut body = match Body::heavy(inertia.clone(), weight) {
            Ok(body) => body,
            Err(error) => return refused(&error),
        };
        if draw.one_in(3) {
            for force in forces(draw)? {
                body = body.with(force);
            }
        }
        let attitude = polhode::rotation::Quat::from_components(draw.list());
        let start = if draw.one_in(2) {
            let point = body.enter_omega(attitude, polhode::rotation::Vec3(draw.list()));
            point.map(|point| body.leave(&point))
        } else {
            let state = State { attitude, momentum_body: polhode::rotation::Vec3(draw.list()) };
            body.enter(&state).map(|point| body.leave(&point))
        };
        let start = match start {
            Ok(start) => start,
            Err(error) => return refused(&error),
        };
        check_state(&body, &start, 0.0)?;
        let rate = body.omega_body(&start).norm();
        let step = if draw.one_in(3) { draw.any() } else { 0.1 * draw.share() / rate.max(1e-300) };
        let clock = Clock { start: if draw.one_in(4) { draw.any() } else { 0.0 }, step };
        let method = method(METHODS[draw.below(METHODS.len() as u64) as usize]).unwrap();
        let watch = [Watch::EveryStep, Watch::AtSamples, Watch::Never][draw.below(3) as usize];
        let run = match Run::by_clock(&method, &body, &start, clock) {
            Ok(run) => run,
            Err(error) => return refused(&error),
        };
        let mut run = run.watching(watch);
        for steps in [0, 1, 40] {
            match run.advance_to(steps) {
                Ok(sample) => {
                    let name = format!("{} {clock:?} {watch:?} {body:?} {start:?}", method.name());
                    all(sample.state.is_finite(), &name, &sample.state)?;
                    let readings =
                        [sample.energy, sample.momentum_norm, sample.energy_change, sample.time.hi()];
                    all(finite(&readings), &name, &readings)?;
                    for errors in [sample.errors, sample.worst] {
                        let parts = [
                            errors.energy,
                            errors.momentum_norm,
                            errors.momentum_vector,
                            errors.momentum_z,
                            errors.jacobi,
                        ];
                        all(parts.into_iter().flatten().all(f64::is_finite), &name, &errors)?;
                    }
                }
                Err(error) => return refused(&error),
            }
        }
        let text = run.checkpoint().to_string();
        let read = text.parse::<Checkpoint>().map_err(|error| error.to_string())?;
        all(read == run.checkpoint(), "checkpoint", &text)
    });
}

/// Records of a motion with numbers of any size in some rows or in all.
#[test]
fn audits() {
    hostile(12, 0.03, |draw| {
        let rows = draw.below(60) as usize;
        let inertia = Inertia::from_moments([1.0, 2.0, 2.5]).map_err(|error| error.to_string())?;
        let (attitude, omega) = (draw.attitude(), Vector3::new(0.4, 1.0, -0.3));
        let motion = FreeMotion::from_omega(&inertia, attitude, omega).map_err(|error| error.to_string())?;
        let step = if draw.one_in(4) { draw.any() } else { 0.05 };
        let times: Vec<f64> = (0..rows).map(|row| step * row as f64).collect();
        let states = motion.at_many(&times).unwrap_or_default();
        let body = Body::free(inertia);
        let (mut q, mut w): (Vec<[f64; 4]>, Vec<[f64; 3]>) =
            states.iter().map(|x| (x.attitude.components(), <[f64; 3]>::from(body.omega_body(x)))).unzip();
        let all_rows = draw.one_in(3);
        for row in 0..q.len() {
            if all_rows || draw.one_in(10) {
                if draw.one_in(2) {
                    q[row] = draw.list();
                } else {
                    w[row] = draw.list();
                }
            }
        }
        let mut record = Trajectory::new(times);
        if draw.one_in(2) {
            record = record.with_attitude(Attitudes::Quaternions(q));
        }
        record = match draw.below(3) {
            0 => record.with_rates(w),
            1 => record.with_momentum(w),
            _ => record,
        };
        let mut question = Question::new(if draw.one_in(2) { None } else { Some(body) });
        if draw.one_in(3) {
            question.tolerance = draw.any();
        }
        if draw.one_in(3) {
            question.noise = Noise { attitude: draw.any(), rates: draw.any() };
        }
        match audit(&record, &question) {
            Ok(verdict) => {
                let numbers = format!("{:?} {:?}", verdict.conservation, verdict.attitude_error);
                all(!numbers.contains("NaN"), "verdict", &numbers)
            }
            Err(error) => refused(&error),
        }
    });
}
