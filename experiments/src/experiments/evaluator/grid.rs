//! The grid: bodies of every shape, from every energy, started at every phase.

use polhode::num::Random;

/// Moments about body x, y, z, and the angular velocity at the start; the attitude is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Start {
    pub(super) moments: [f64; 3],
    pub(super) omega: [f64; 3],
}

/// Shapes of bodies, by how the moments approach a case of more symmetry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Shape {
    Generic,
    NearSymmetric,
    NearSphere,
    Needle,
}

impl Shape {
    pub(super) const ALL: [Shape; 4] =
        [Shape::Generic, Shape::NearSymmetric, Shape::NearSphere, Shape::Needle];

    pub(super) fn name(self) -> &'static str {
        match self {
            Shape::Generic => "generic",
            Shape::NearSymmetric => "near-symmetric",
            Shape::NearSphere => "near-sphere",
            Shape::Needle => "needle",
        }
    }

    /// Three moments in ascending order, the largest about 1; `nearness` from 0 to 1 is how far the approach has gone.
    fn moments(self, nearness: f64, random: &mut Random) -> [f64; 3] {
        let small =
            |decades: f64, random: &mut Random| libm::exp10(-1.0 - decades * nearness - random.uniform());
        match self {
            Shape::Generic => {
                let smallest = random.between(0.1, 0.9);
                // the triangle inequality leaves the middle one this share of the way to the largest
                let room = (1.0 - smallest).min(smallest);
                [smallest, 1.0 - room * random.between(0.1, 0.9), 1.0]
            }
            Shape::NearSymmetric => {
                let (other, split) = (random.between(0.55, 0.95), small(13.0, random));
                if random.below(2) == 0 {
                    [other, 1.0 - split, 1.0]
                } else {
                    [other, other * (1.0 + split), 1.0]
                }
            }
            Shape::NearSphere => {
                let split = small(13.0, random);
                [1.0 - split, 1.0 - split * random.between(0.05, 0.95), 1.0]
            }
            Shape::Needle => {
                let smallest = small(7.0, random);
                [smallest, 1.0 - smallest * random.between(0.05, 0.95), 1.0]
            }
        }
    }
}

/// How the energy approaches one of its limits.
#[derive(Clone, Copy, Debug)]
enum Energy {
    /// k² anywhere, at any phase.
    Between,
    /// k'² → 0 at any phase.
    Separatrix,
    /// From beside the unstable axis: k'² → 0 beyond what a rounded momentum leaves elsewhere.
    Unstable,
    /// k² → 0, towards a steady spin.
    Steady,
}

/// Energies with the side of the separatrix, which about the unstable axis is of either sign by itself.
const ENERGIES: [(Energy, bool); 7] = [
    (Energy::Between, false),
    (Energy::Between, true),
    (Energy::Separatrix, false),
    (Energy::Separatrix, true),
    (Energy::Unstable, false),
    (Energy::Steady, false),
    (Energy::Steady, true),
];

/// Steps of each approach.
const STEPS: u64 = 16;

/// Cells of the grid: shapes, their approach, energies, and theirs.
pub(super) const CELLS: u64 = Shape::ALL.len() as u64 * STEPS * ENERGIES.len() as u64 * STEPS;

/// A start in a cell of the grid, with its shape; another for each stream of `random`. `None` where rounding leaves no motion along a
/// polhode.
pub(super) fn start(cell: u64, random: &mut Random) -> Option<(Shape, Start)> {
    let mut rest = cell;
    let mut digit = |base: usize| {
        let digit = rest % base as u64;
        rest /= base as u64;
        digit as usize
    };
    let (shape, energy) = (Shape::ALL[digit(Shape::ALL.len())], ENERGIES[digit(ENERGIES.len())]);
    let steps = STEPS as usize;
    let mut nearness = || (digit(steps) as f64 + random.uniform()) / steps as f64;
    let (of_shape, of_energy) = (nearness(), nearness());
    let sorted = shape.moments(of_shape, random);
    let momentum = momentum(sorted, energy, of_energy, random);

    // the axes in any order, each component of either sign
    let mut places = [0, 1, 2];
    places.swap(0, random.below(3) as usize);
    places.swap(1, 1 + random.below(2) as usize);
    let mut start = Start { moments: [0.0; 3], omega: [0.0; 3] };
    for k in 0..3 {
        start.moments[places[k]] = sorted[k];
        let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
        start.omega[places[k]] = sign * momentum[k] / sorted[k];
    }
    let moving = momentum.iter().all(|m| *m != 0.0) && sorted[0] < sorted[1] && sorted[1] < sorted[2];
    moving.then_some((shape, start))
}

/// The momentum along the axes of ascending moments, of length 1 but for rounding.
fn momentum(i: [f64; 3], (energy, largest): (Energy, bool), nearness: f64, random: &mut Random) -> [f64; 3] {
    let (sin, cos) = libm::sincos(random.between(0.0, std::f64::consts::FRAC_PI_2));
    let tiny = |decades: f64| libm::exp10(-decades * nearness);
    let [a, b, c] = if largest { [2, 1, 0] } else { [0, 1, 2] };
    let mut m = [0.0; 3];
    match energy {
        Energy::Unstable => {
            let off = tiny(100.0);
            (m[0], m[1], m[2]) = (off * cos, 1.0, off * sin);
        }
        Energy::Steady => {
            let off = tiny(20.0);
            (m[a], m[b], m[c]) = (1.0, off * sin, off * cos);
        }
        Energy::Between | Energy::Separatrix => {
            let complement = if matches!(energy, Energy::Between) { 1.0 - nearness } else { tiny(17.0) };
            let k2 = 1.0 - complement;
            // A², B² and C² over G²
            let kappa = k2 * (i[b] - i[a]) / (i[c] - i[b]);
            let below = i[a] + kappa * i[c];
            let amplitudes =
                [i[a] / below, i[b] * k2 * (i[c] - i[a]) / ((i[c] - i[b]) * below), i[c] * kappa / below];
            let [amp_a, amp_b, amp_c] = amplitudes.map(f64::sqrt);
            m[a] = amp_a * (cos * cos + complement * sin * sin).sqrt();
            (m[b], m[c]) = (amp_b * sin, amp_c * cos);
        }
    }
    m
}
