//! How much of what a mesh encloses counts more than once: parts that overlap, a surface that passes through itself.

use super::boxes::Bounds;
use super::closed::directed;
use super::welded::Welded;

/// Lines along z through the bounding box, along x and along y.
const LINES: usize = 128;

/// Where in its cell each line runs, in no ratio to the edges of drawn bodies.
const PLACE: f64 = 0.381_966_011_250_105_1;

/// The volume that counts more than once, or as a hole where nothing is, over `volume`: lengths along the lines between the
/// triangles that they cross, by how often these wind around them.
pub(super) fn doubled(mesh: &Welded, volume: f64) -> f64 {
    let bounds = Bounds::around(&mesh.vertices);
    let cell = |axis: usize| bounds.edge(axis) / LINES as f64;
    let at = |axis: usize, line: usize| bounds.low[axis] + (line as f64 + PLACE) * cell(axis);
    // the first line at or above a coordinate
    let first = |axis: usize, x: f64| {
        let mut line = ((x - bounds.low[axis]) / cell(axis) - PLACE).ceil().clamp(0.0, LINES as f64) as usize;
        while line > 0 && at(axis, line - 1) >= x {
            line -= 1;
        }
        while line < LINES && at(axis, line) < x {
            line += 1;
        }
        line
    };
    let mut crossings: Vec<(usize, f64, i32)> = Vec::new();
    for &triangle in &mesh.triangles {
        let heights = triangle.map(|k| mesh.vertices[k as usize][1]);
        let lowest = heights.into_iter().fold(f64::INFINITY, f64::min);
        let highest = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        for row in first(1, lowest)..first(1, highest) {
            let y = at(1, row);
            let mut ends = directed(triangle).into_iter().filter_map(|edge| crossed(mesh, edge, y));
            let (Some(a), Some(b)) = (ends.next(), ends.next()) else { continue };
            let (left, right) = if a.x < b.x { (a, b) } else { (b, a) };
            // seen from above the corners run counterclockwise: the line leaves the body
            let turn = if right.rises { -1 } else { 1 };
            for column in first(0, left.x)..first(0, right.x) {
                let share = (at(0, column) - left.x) / (right.x - left.x);
                crossings.push((row * LINES + column, left.z + share * (right.z - left.z), turn));
            }
        }
    }
    crossings.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut length = 0.0;
    for line in crossings.chunk_by(|a, b| a.0 == b.0) {
        let mut inside = 0;
        for pair in line.windows(2) {
            inside += pair[0].2;
            let excess = if inside > 0 { inside - 1 } else { -inside };
            length += f64::from(excess) * (pair[1].1 - pair[0].1);
        }
    }
    length * cell(0) * cell(1) / volume
}

/// Where an edge crosses a plane of constant y.
struct Crossed {
    x: f64,
    z: f64,
    /// Whether it goes towards larger y.
    rises: bool,
}

/// The crossing of an edge, the same to the last bit for both triangles that share it, so that no line slips between them.
fn crossed(mesh: &Welded, (from, to): (u32, u32), y: f64) -> Option<Crossed> {
    let [a, b] = [from.min(to), from.max(to)].map(|k| mesh.vertices[k as usize]);
    if (a[1] <= y) == (b[1] <= y) {
        return None;
    }
    let share = (y - a[1]) / (b[1] - a[1]);
    let between = |axis: usize| a[axis] + share * (b[axis] - a[axis]);
    Some(Crossed { x: between(0), z: between(2), rises: (a[1] <= y) == (from < to) })
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::super::Surface;
    use crate::inertia::Amount;

    /// A box from `low`, with these edges, facing outwards, or inwards as a cavity does.
    fn cuboid(low: [f64; 3], edges: [f64; 3], outwards: bool) -> Vec<[Vector3<f64>; 3]> {
        let corner = |k: usize| {
            Vector3::from_fn(|axis, _| low[axis] + if k >> axis & 1 == 1 { edges[axis] } else { 0.0 })
        };
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let halves = sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
        halves.map(|[a, b, c]| if outwards { [a, b, c] } else { [a, c, b] }.map(corner)).collect()
    }

    fn doubled(parts: &[Vec<[Vector3<f64>; 3]>]) -> f64 {
        Surface::new(parts.concat()).unwrap().mesh().unwrap().doubled()
    }

    const UNIT: [f64; 3] = [1.0; 3];

    #[test]
    fn parts_that_overlap_count_twice_and_say_how_much() {
        let one = cuboid([0.0; 3], UNIT, true);
        assert_eq!(doubled(std::slice::from_ref(&one)), 0.0);
        let shifted = |by: f64| cuboid([by, 0.0, 0.0], UNIT, true);
        assert!((doubled(&[one.clone(), shifted(0.5)]) - 0.25).abs() < 0.01);
        assert!((doubled(&[one.clone(), cuboid([0.3; 3], UNIT, true)]) - 0.343 / 2.0).abs() < 0.01);
        // a cross of two bars, of which no corner lies within the other
        let bars = [
            cuboid([-3.0, -0.5, -0.5], [6.0, 1.0, 1.0], true),
            cuboid([-0.5, -3.0, -0.4], [1.0, 6.0, 0.8], true),
        ];
        assert!((doubled(&bars) - 0.8 / (6.0 + 4.8)).abs() < 0.01);
        // one within the other, and thrice the same place
        assert!(
            (doubled(&[cuboid([0.0; 3], [2.0; 3], true), cuboid([0.5; 3], UNIT, true)]) - 1.0 / 9.0).abs()
                < 0.01
        );
        let thrice =
            [one.clone(), cuboid([0.0; 3], [1.0, 1.0, 1.25], true), cuboid([0.0; 3], [1.0, 1.0, 1.5], true)];
        assert!((doubled(&thrice) - (1.0 + 1.25) / 3.75).abs() < 0.01);
    }

    #[test]
    fn parts_that_touch_and_cavities_count_once() {
        let one = cuboid([0.1; 3], UNIT, true);
        let beside = [cuboid([1.1, 0.1, 0.1], UNIT, true), cuboid([0.1, 0.1, 1.1], UNIT, true)];
        assert!(doubled(&[one.clone(), beside[0].clone(), beside[1].clone()]) < 1e-15);
        let hollow = [one, cuboid([0.3; 3], [0.5; 3], false)];
        assert_eq!(doubled(&hollow), 0.0);
        let mesh = Surface::new(hollow.concat()).unwrap().mesh().unwrap();
        assert!((mesh.with(Amount::Density(1.0)).unwrap().mass() - 0.875).abs() < 1e-15);
        // turned and far from the origin, with rounded corners
        let turn = |v: Vector3<f64>| {
            Vector3::new(0.6 * v.x - 0.8 * v.y, 0.8 * v.x + 0.6 * v.y, v.z) + Vector3::repeat(1e3)
        };
        let turned = Surface::new(hollow.concat()).unwrap().mapped(turn).unwrap();
        assert_eq!(turned.mesh().unwrap().doubled(), 0.0);
    }
}
