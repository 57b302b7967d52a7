//! Convex hulls: C. B. Barber, D. P. Dobkin and H. Huhdanpaa, The Quickhull algorithm for convex hulls, ACM Transactions on
//! Mathematical Software 22 (1996) 469–483.

use super::welded::check_extent;
use super::{MeshError, largest_triple};
use crate::num::Dd;
use crate::rotation::Vec3;

/// Points that a hull is computed of.
pub(super) const LIMIT: usize = 1 << 26;

/// Rounding of the plain determinant over the sum of its terms without sign (Shewchuk's bound A).
const PLAIN: f64 = 7.8e-16;
/// The same in double-double; determinants below it count as zero.
const CAREFUL: f64 = 1e-29;

/// The facets of the hull, triangles counterclockwise from outside; points that lie on a facet need not be corners.
pub(super) fn hull(points: &[[f64; 3]]) -> Result<Vec<[u32; 3]>, MeshError> {
    if points.len() > LIMIT {
        return Err(MeshError::TooLargeForHull);
    }
    // points that are all one span nothing, whatever their size
    if points.windows(2).any(|pair| pair[0] != pair[1]) {
        check_extent(points)?;
    }
    let mut hull = Hull { points, faces: Vec::new() };
    let start = hull.simplex().ok_or(MeshError::Flat)?;
    hull.begin(start);
    let mut open: Vec<usize> = (0..4).collect();
    while let Some(face) = open.pop() {
        if let Some(point) = hull.farthest(face) {
            let before = hull.faces.len();
            if hull.add(face, point) {
                open.extend(before..hull.faces.len());
            } else {
                // a horizon that is no circle, which only points within rounding of a plane can have: the point is left inside
                hull.faces[face].outside.retain(|other| *other != point);
                open.push(face);
            }
        }
    }
    Ok(hull.faces.iter().filter(|face| face.is_there).map(|face| face.corners).collect())
}

struct Face {
    corners: [u32; 3],
    /// Across the edges from corner k to the next.
    neighbours: [usize; 3],
    /// Points that see it, each in the list of one face alone.
    outside: Vec<u32>,
    is_there: bool,
}

struct Hull<'p> {
    points: &'p [[f64; 3]],
    faces: Vec<Face>,
}

impl Hull<'_> {
    fn at(&self, k: u32) -> Vec3<f64> {
        Vec3(self.points[k as usize])
    }

    /// Four points that are not in one plane: the ends of an axis, the farthest from their line, the farthest from that plane.
    fn simplex(&self) -> Option<[u32; 4]> {
        let all = 0..self.points.len() as u32;
        let farthest = |measure: &dyn Fn(u32) -> f64| {
            all.clone().map(|k| (measure(k), k)).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
        };
        let axis = |k: usize| {
            let low = farthest(&|p| -self.at(p)[k])?;
            let high = farthest(&|p| self.at(p)[k])?;
            Some((self.at(high)[k] - self.at(low)[k], low, high))
        };
        let [x, y, z] = [axis(0)?, axis(1)?, axis(2)?];
        let (_, a, b) = [x, y, z].into_iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let along = self.at(b) + -self.at(a);
        let c = farthest(&|p| along.cross(self.at(p) + -self.at(a)).norm_squared())?;
        let normal = along.cross(self.at(c) + -self.at(a));
        let d = farthest(&|p| normal.dot(self.at(p) + -self.at(a)).abs())?;
        match self.side([a, b, c], d) {
            side if side > 0.0 => Some([a, c, b, d]),
            side if side < 0.0 => Some([a, b, c, d]),
            _ => None,
        }
    }

    /// The simplex whose fourth corner is below its first face.
    fn begin(&mut self, [a, b, c, d]: [u32; 4]) {
        let face = |corners, neighbours| Face { corners, neighbours, outside: Vec::new(), is_there: true };
        self.faces.push(face([a, b, c], [1, 2, 3]));
        self.faces.push(face([b, a, d], [0, 3, 2]));
        self.faces.push(face([c, b, d], [0, 1, 3]));
        self.faces.push(face([a, c, d], [0, 2, 1]));
        let points: Vec<u32> = (0..self.points.len() as u32).collect();
        self.distribute(&points, 0..4);
    }

    fn distribute(&mut self, points: &[u32], faces: core::ops::Range<usize>) {
        for &point in points {
            if let Some(face) = faces.clone().find(|&face| self.side(self.faces[face].corners, point) > 0.0) {
                self.faces[face].outside.push(point);
            }
        }
    }

    fn farthest(&self, face: usize) -> Option<u32> {
        let face = &self.faces[face];
        if !face.is_there {
            return None;
        }
        let [a, b, c] = face.corners.map(|k| self.at(k));
        let normal = (b + -a).cross(c + -a);
        let height = |p: u32| normal.dot(self.at(p) + -a);
        face.outside.iter().copied().max_by(|&p, &q| height(p).total_cmp(&height(q)))
    }

    /// Replaces the faces that `point` sees by those from it to their horizon; `false` if that is no simple circle.
    fn add(&mut self, first: usize, point: u32) -> bool {
        let mut seen = vec![first];
        let mut is_seen = std::collections::BTreeSet::from([first]);
        // edges of the horizon by their first corner: second corner and the face beyond
        let mut horizon = std::collections::BTreeMap::new();
        let mut next = 0;
        while next < seen.len() {
            let face = seen[next];
            next += 1;
            for k in 0..3 {
                let beyond = self.faces[face].neighbours[k];
                if is_seen.contains(&beyond) {
                    continue;
                }
                if self.side(self.faces[beyond].corners, point) > 0.0 {
                    is_seen.insert(beyond);
                    seen.push(beyond);
                } else {
                    let corners = self.faces[face].corners;
                    if horizon.insert(corners[k], (corners[(k + 1) % 3], beyond)).is_some() {
                        return false;
                    }
                }
            }
        }
        let Some((&start, _)) = horizon.first_key_value() else { return false };
        let mut circle = Vec::with_capacity(horizon.len());
        let mut from = start;
        while let Some((to, beyond)) = horizon.remove(&from) {
            circle.push((from, to, beyond));
            from = to;
        }
        if from != start || !horizon.is_empty() || circle.len() < 3 {
            return false;
        }
        let (base, count) = (self.faces.len(), circle.len());
        for (k, &(from, to, beyond)) in circle.iter().enumerate() {
            let neighbours = [beyond, base + (k + 1) % count, base + (k + count - 1) % count];
            self.faces.push(Face {
                corners: [from, to, point],
                neighbours,
                outside: Vec::new(),
                is_there: true,
            });
            let outer = &mut self.faces[beyond];
            for j in 0..3 {
                if outer.corners[j] == to && outer.corners[(j + 1) % 3] == from {
                    outer.neighbours[j] = base + k;
                }
            }
        }
        let mut points = Vec::new();
        for face in seen {
            let face = &mut self.faces[face];
            face.is_there = false;
            points.append(&mut face.outside);
        }
        points.retain(|other| *other != point);
        self.distribute(&points, base..base + count);
        true
    }

    /// Positive where `p` lies outside of the plane of the corners, zero where it lies in it: (b − a) × (c − a) · (p − a).
    fn side(&self, [a, b, c]: [u32; 3], p: u32) -> f64 {
        let [a, b, c, p] = [a, b, c, p].map(|k| self.at(k));
        let [u, v, w] = [b, c, p].map(|other| other + -a);
        let plain = u.cross(v).dot(w);
        let size = largest_triple(w, u, v);
        if plain.abs() > PLAIN * size {
            return plain;
        }
        let exact = |x: Vec3<f64>| Vec3([0, 1, 2].map(|k| Dd::sum(x[k], -a[k])));
        let careful = exact(b).cross(exact(c)).dot(exact(p)).hi();
        if careful.abs() > CAREFUL * size { careful } else { 0.0 }
    }
}
