//! Tensors of real robots, broken in the ways that public reports show.

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{Diagnosis, Evidence, Twin, Validity, diagnose};
use polhode::num::Random;
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use super::failed;
use crate::experiment::Context;

/// Links with their mass, centre of mass and tensor.
const LINKS: &str = include_str!("links.csv");

/// Entries that differ by less than this share of the largest are restored.
const RESTORED: f64 = 1e-9;

/// A link, and what a model says of it.
struct Link {
    center_of_mass: Vector3<f64>,
    mass: f64,
    tensor: Matrix3<f64>,
}

/// A mistake: what the table calls it, the name of the cause that should be found, and what it leaves of a link.
type Mistake = (&'static str, &'static str, fn(&Link, &mut Random) -> (Matrix3<f64>, Evidence));

const MISTAKES: [Mistake; 6] = [
    ("in kg mm^2, g cm^2 or g mm^2", "unit", |link, random| {
        let factor = [1e6, 1e7, 1e9][random.below(3) as usize];
        (link.tensor * factor, link.known())
    }),
    ("products with the other sign", "product-signs", |link, _| {
        (link.tensor.map_with_location(|j, k, x| if j == k { x } else { -x }), link.known())
    }),
    ("an entry 10 times too large or too small", "decimal-slip", |link, random| {
        let places = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        let present: Vec<(usize, usize)> =
            places.into_iter().filter(|place| link.tensor[*place] != 0.0).collect();
        let (j, k) = present[random.below(present.len() as u64) as usize];
        let mut tensor = link.tensor;
        tensor[(j, k)] *= if random.below(2) == 0 { 10.0 } else { 0.1 };
        tensor[(k, j)] = tensor[(j, k)];
        (tensor, link.known())
    }),
    ("rows read as xx, yy, zz, xy, xz, yz", "entry-order", |link, _| {
        let t = link.tensor;
        (Matrix3::new(t.m11, t.m22, t.m23, t.m22, t.m12, t.m33, t.m23, t.m33, t.m13), link.known())
    }),
    ("about the origin of the link", "another-point", |link, _| {
        let c = link.center_of_mass;
        let term = (Matrix3::identity() * c.norm_squared() - c * c.transpose()) * link.mass;
        (link.tensor + term, link.known())
    }),
    ("copied from the mirrored twin", "mirrored-twin", |link, random| {
        let mut mirror = Matrix3::identity();
        let axis = random.below(3) as usize;
        mirror[(axis, axis)] = -1.0;
        let tensor = mirror * link.tensor * mirror;
        let twin = Twin { center_of_mass: mirror * link.center_of_mass, tensor };
        (tensor, link.known().with_twin(twin))
    }),
];

impl Link {
    /// What a model states besides the tensor.
    fn known(&self) -> Evidence {
        Evidence::default().with_mass(self.mass).with_center_of_mass(self.center_of_mass)
    }
}

/// What became of one mistake in all links.
#[derive(Clone, Copy, Default)]
struct Counts {
    links: u64,
    noticed: u64,
    first: u64,
    second: u64,
    undecided: u64,
}

impl Counts {
    fn add(&mut self, found: &Diagnosis, word: &str, truth: &Matrix3<f64>) {
        self.links += 1;
        if found.verdict == Validity::Valid {
            return;
        }
        self.noticed += 1;
        let right = |place: usize| {
            found.causes.get(place).is_some_and(|explanation| {
                let apart = (explanation.corrected - truth).amax();
                explanation.cause.name() == word && apart < RESTORED * truth.amax()
            })
        };
        self.first += u64::from(right(0));
        self.second += u64::from(!right(0) && right(1));
        let tied = matches!(found.causes.as_slice(), [first, second, ..] if first.is_tied_with(second));
        self.undecided += u64::from(tied);
    }
}

/// How often the true cause comes first, and how often among the first two.
pub(super) fn rates(context: &Context, random: &Random, failures: &mut Vec<String>) -> Result<Table, Error> {
    let links: Vec<Link> = links()?.into_iter().step_by(context.scale.pick(8, 1, 1)).collect();
    let mut table = Table::new(
        "robots",
        format!(
            "Mistakes made with the tensors of {} links of robots, of which mass and centre of mass are known: how many leave a tensor \
             that is possible, and of the others how often the true cause comes first, or among the first two.",
            links.len()
        ),
        vec![
            Column::new("mistake", "", "what was done to the tensor"),
            Column::new("links", "", "number of links").hidden(),
            Column::new("possible", "%", "tensors that are valid, so that nothing is noticed"),
            Column::new("first", "%", "of the others, the true cause first and the tensor restored to 1e-9"),
            Column::new("first_two", "%", "of the others, the true cause first or second")
                .heading("first two"),
            Column::new("undecided", "%", "of the others, the first two causes explain it equally well"),
        ],
    );
    for link in &links {
        let found = diagnose(link.tensor, &link.known()).map_err(|error| failed(&error))?;
        if found.verdict != Validity::Valid {
            failures.push(format!("a sound link of {} kg is called {}", link.mass, found.verdict.name()));
        }
    }
    let mut all = Counts::default();
    for (name, word, spoil) in MISTAKES {
        let mut random = random.clone();
        let mut counts = Counts::default();
        for link in &links {
            let (tensor, evidence) = spoil(link, &mut random);
            let found = diagnose(tensor, &evidence).map_err(|error| failed(&error))?;
            counts.add(&found, word, &link.tensor);
            all.add(&found, word, &link.tensor);
        }
        push(&mut table, name, counts);
    }
    push(&mut table, "all", all);
    if 10 * all.first < 8 * all.noticed || 10 * (all.first + all.second) < 9 * all.noticed {
        failures.push(format!(
            "of {} mistakes in links the true cause comes first in {}, second in {}",
            all.noticed, all.first, all.second
        ));
    }
    Ok(table)
}

fn push(table: &mut Table, name: &str, counts: Counts) {
    let percent = |part: u64, of: u64| if of == 0 { f64::NAN } else { 100.0 * part as f64 / of as f64 };
    table.push(row![
        name,
        counts.links,
        percent(counts.links - counts.noticed, counts.links),
        percent(counts.first, counts.noticed),
        percent(counts.first + counts.second, counts.noticed),
        percent(counts.undecided, counts.noticed),
    ]);
}

fn links() -> Result<Vec<Link>, Error> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(LINKS.as_bytes());
    let mut found = Vec::new();
    for record in reader.deserialize::<(String, String, f64, [f64; 3], [f64; 6])>() {
        let (_, _, mass, center, [xx, yy, zz, xy, xz, yz]) = record.map_err(unexpected)?;
        let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        found.push(Link { center_of_mass: center.into(), mass, tensor });
    }
    Ok(found)
}
