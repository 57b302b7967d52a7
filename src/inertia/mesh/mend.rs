//! Repairs of surfaces that do not close as they are.

use core::fmt;
use std::collections::HashMap;

use super::boxes::Bounds;
use super::closed::{directed, join, key, root};
use super::welded::Welded;
use super::{Mesh, MeshError, Surface};
use crate::rotation::Vec3;

/// A distance of welding for vertices that were written in single precision, relative to the largest edge of the bounding box:
/// 2⁻¹⁷, 64 units in the last place of such a number.
pub const FLOAT_WELD: f64 = 7.629_394_531_25e-6;

/// How holes are closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closing {
    /// Triangles from the middle of each rim: right for flat holes, whatever the rest of the surface is like.
    Fan,
    /// The convex hull instead of the surface.
    Hull,
}

/// A change that was made to a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Repair {
    /// Vertices were made one.
    Welded {
        /// How many were replaced by another.
        vertices: usize,
        /// The distance below which they count as the same, in the unit of the vertices.
        distance: f64,
    },
    /// Facets were left out, as two of their corners are the same after welding.
    Collapsed {
        /// How many.
        triangles: usize,
    },
    /// Facets were removed, as another one has the same corners in the same sense.
    Doubled {
        /// How many.
        triangles: usize,
    },
    /// Triangles were turned over, the way of their neighbours.
    Turned {
        /// How many.
        triangles: usize,
    },
    /// Parts that faced inwards were turned over.
    TurnedOut {
        /// How many.
        parts: usize,
    },
    /// Holes were closed by fans.
    Closed {
        /// How many.
        holes: usize,
        /// Length of the longest rim, in the unit of the vertices.
        rim: f64,
        /// Area of the fans over the area of everything.
        area: f64,
        /// Volume between the fans and the middle of the bounding box over the enclosed volume.
        volume: f64,
    },
    /// The convex hull was taken.
    Hull {
        /// Volume of the hull less that between the surface and the middle of its bounding box, over the volume of the hull.
        volume: f64,
    },
}

impl fmt::Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of =
            |count: usize, one: &str, many: &str| format!("{count} {}", if count == 1 { one } else { many });
        match *self {
            Repair::Welded { vertices, distance } => write!(
                f,
                "{} with others within {distance:.3e}",
                of(vertices, "vertex welded", "vertices welded")
            ),
            Repair::Collapsed { triangles } => {
                write!(f, "{} in welding", of(triangles, "facet vanished", "facets vanished"))
            }
            Repair::Doubled { triangles } => {
                write!(f, "{} removed", of(triangles, "doubled facet", "doubled facets"))
            }
            Repair::Turned { triangles } => {
                write!(f, "{} turned over to agree with the neighbours", of(triangles, "facet", "facets"))
            }
            Repair::TurnedOut { parts } => {
                write!(f, "{} turned over", of(parts, "part that faced inwards", "parts that faced inwards"))
            }
            Repair::Closed { holes, rim, area, volume } => write!(
                f,
                "{}, the longest rim {rim:.3e}: {:.2} % of the area, {:+.3} % of the volume",
                of(holes, "hole closed by a fan", "holes closed by fans"),
                100.0 * area,
                100.0 * volume
            ),
            Repair::Hull { volume } => {
                write!(f, "convex hull taken: {:+.3} % of the volume", 100.0 * volume)
            }
        }
    }
}

pub(super) fn mended(surface: &Surface, weld: f64) -> Result<(Mesh, Vec<Repair>), MeshError> {
    if let Ok(mesh) = surface.mesh() {
        return Ok((mesh, Vec::new()));
    }
    let (surface, repairs) = tidied(surface, weld)?;
    Ok((surface.mesh()?, repairs))
}

pub(super) fn closed(surface: &Surface, weld: f64, how: Closing) -> Result<(Mesh, Vec<Repair>), MeshError> {
    if how == Closing::Hull {
        let mesh = surface.hull()?.mesh()?;
        let welded = &surface.welded;
        let volume = 1.0 - welded.spanned_from(welded.middle()).abs() / mesh.volume();
        return Ok((mesh, vec![Repair::Hull { volume }]));
    }
    let found = mended(surface, weld);
    if found.is_ok() {
        return found;
    }
    let (Surface { mut welded }, mut repairs) = tidied(surface, weld)?;
    let rims = welded.rim();
    let open = welded.triangles.len();
    let mut longest = 0.0_f64;
    for rim in &rims {
        let (middle, length) = welded.middle_of(rim);
        longest = longest.max(length);
        for &(from, to) in rim {
            let [from, to] = [from, to].map(|k| Vec3(welded.vertices[k as usize]));
            welded.add([to, from, Vec3(middle)])?;
        }
    }
    let parts = welded.turn_parts_out();
    let mut fans = welded.clone();
    fans.triangles.drain(..open);
    let mesh = Mesh::of_welded(&welded)?;
    let middle = welded.middle();
    let volume = fans.spanned_from(middle) / mesh.volume();
    let area = area(&fans) / area(&welded);
    if parts > 0 {
        repairs.push(Repair::TurnedOut { parts });
    }
    repairs.push(Repair::Closed { holes: rims.len(), rim: longest, area, volume });
    Ok((mesh, repairs))
}

/// Welded, without doubled facets, and turned the same way.
fn tidied(surface: &Surface, weld: f64) -> Result<(Surface, Vec<Repair>), MeshError> {
    let mut repairs = Vec::new();
    let extent = surface.extents().into_iter().fold(0.0, f64::max);
    // closer than rounding nothing is told apart
    let distance = weld.max(f64::EPSILON) * extent;
    surface.welded.check_extent()?;
    let (mut welded, vertices) = weld_vertices(&surface.welded, distance)?;
    if vertices > 0 {
        repairs.push(Repair::Welded { vertices, distance });
    }
    let collapsed = welded.skipped.len();
    if collapsed > 0 {
        repairs.push(Repair::Collapsed { triangles: collapsed });
    }
    let triangles = remove_doubled(&mut welded);
    if triangles > 0 {
        repairs.push(Repair::Doubled { triangles });
    }
    if matches!(
        welded.check_edges(),
        Err(MeshError::Orientation { .. } | MeshError::Open { .. } | MeshError::NonManifold { .. })
    ) {
        let triangles = turn_alike(&mut welded);
        if triangles > 0 {
            repairs.push(Repair::Turned { triangles });
        }
    }
    if welded.check_edges().is_ok() && welded.check_parts().is_err() {
        let parts = welded.turn_parts_out();
        repairs.push(Repair::TurnedOut { parts });
    }
    Ok((Surface::of(welded)?, repairs))
}

/// Vertices closer than `distance` as one, in chains; how many were replaced.
fn weld_vertices(mesh: &Welded, distance: f64) -> Result<(Welded, usize), MeshError> {
    let bounds = Bounds::around(&mesh.vertices);
    let cell = |at: &[f64; 3]| [0, 1, 2].map(|k| ((at[k] - bounds.low[k]) / distance).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut roots: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    for (number, at) in mesh.vertices.iter().enumerate() {
        let [i, j, k] = cell(at);
        for (di, dj, dk) in (0..27).map(|n| (n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)) {
            for &other in cells
                .get(&[i.saturating_add(di), j.saturating_add(dj), k.saturating_add(dk)])
                .into_iter()
                .flatten()
            {
                let there = mesh.vertices[other as usize];
                if (Vec3(*at) + -Vec3(there)).norm_squared() <= distance * distance {
                    join(&mut roots, number as u32, other);
                }
            }
        }
        cells.entry([i, j, k]).or_default().push(number as u32);
    }
    let mut welded = Welded::default();
    for &triangle in &mesh.triangles {
        let corners = triangle.map(|k| Vec3(mesh.vertices[root(&mut roots, k) as usize]));
        welded.add(corners)?;
    }
    let replaced = (0..mesh.vertices.len() as u32).filter(|&k| root(&mut roots, k) != k).count();
    Ok((welded, replaced))
}

/// Leaves one of several triangles with the same corners in the same sense.
fn remove_doubled(mesh: &mut Welded) -> usize {
    let before = mesh.triangles.len();
    let mut known = std::collections::HashSet::new();
    mesh.triangles.retain(|&[a, b, c]| {
        let first = a.min(b).min(c);
        let turned = if first == a {
            [a, b, c]
        } else if first == b {
            [b, c, a]
        } else {
            [c, a, b]
        };
        known.insert(turned)
    });
    before - mesh.triangles.len()
}

/// Turns triangles the way of their neighbours across edges of two, the smaller share of each patch; how many.
fn turn_alike(mesh: &mut Welded) -> usize {
    let mut uses: Vec<(u64, u32)> = Vec::with_capacity(3 * mesh.triangles.len());
    for (number, &triangle) in mesh.triangles.iter().enumerate() {
        uses.extend(directed(triangle).map(|edge| (key(edge), number as u32)));
    }
    uses.sort_unstable();
    // across an edge of two triangles: the other one, and whether both run through it the same way
    let mut beyond: Vec<Vec<(u32, bool)>> = vec![Vec::new(); mesh.triangles.len()];
    for pair in uses.chunk_by(|a, b| a.0 >> 1 == b.0 >> 1) {
        if let &[(a, first), (b, second)] = pair {
            beyond[first as usize].push((second, a == b));
            beyond[second as usize].push((first, a == b));
        }
    }
    let mut turned: Vec<Option<bool>> = vec![None; mesh.triangles.len()];
    let mut count = 0;
    for start in 0..mesh.triangles.len() {
        if turned[start].is_some() {
            continue;
        }
        turned[start] = Some(false);
        let mut patch = vec![start];
        let mut next = 0;
        while next < patch.len() {
            let from = patch[next];
            next += 1;
            let state = turned[from] == Some(true);
            for &(to, same) in &beyond[from] {
                if turned[to as usize].is_none() {
                    turned[to as usize] = Some(state != same);
                    patch.push(to as usize);
                }
            }
        }
        let wrong = patch.iter().filter(|&&k| turned[k] == Some(true)).count();
        let most = 2 * wrong > patch.len();
        for &k in &patch {
            if (turned[k] == Some(true)) != most {
                mesh.triangles[k].swap(1, 2);
                count += 1;
            }
        }
    }
    count
}

fn area(mesh: &Welded) -> f64 {
    let each = mesh.triangles.iter().map(|&triangle| {
        let [a, b, c] = mesh.corners(triangle);
        0.5 * (b + -a).cross(c + -a).norm_squared().sqrt()
    });
    each.sum()
}

impl Welded {
    /// Signed volume between the surface and a point.
    fn spanned_from(&self, apex: Vec3<f64>) -> f64 {
        let each = self.triangles.iter().map(|&triangle| {
            let [a, b, c] = self.corners(triangle).map(|at| at + -apex);
            a.dot(b.cross(c)) / 6.0
        });
        each.sum()
    }
}
