//! Whether triangles close, and whether they face outwards.

use super::boxes::{Bounds, Boxes};
use super::welded::{NONE, Welded};
use super::{Edge, MeshError};
use crate::rotation::Vec3;

impl Welded {
    /// Through every edge as many triangles run one way as the other.
    pub(super) fn check_edges(&self) -> Result<(), MeshError> {
        let mut edges = Vec::with_capacity(3 * self.triangles.len());
        for &triangle in &self.triangles {
            edges.extend(directed(triangle).map(key));
        }
        edges.sort_unstable();
        let (mut open, mut crowded, mut turned) = (Kind::default(), Kind::default(), Kind::default());
        for uses in edges.chunk_by(|a, b| a >> 1 == b >> 1) {
            let backward = uses.iter().filter(|key| *key & 1 == 1).count();
            match uses {
                _ if 2 * backward == uses.len() => {}
                [a] => open.add(*a, 1),
                [a, _] => turned.add(*a, 2),
                [a, ..] => crowded.add(*a, uses.len()),
                [] => {}
            }
        }
        if let Some((key, uses)) = crowded.first {
            return Err(MeshError::NonManifold { edges: crowded.count, edge: self.edge(key), uses });
        }
        if let Some((key, _)) = open.first {
            return Err(MeshError::Open { edges: open.count, edge: self.edge(key) });
        }
        if let Some((key, _)) = turned.first {
            return Err(MeshError::Orientation { edges: turned.count, edge: self.edge(key) });
        }
        Ok(())
    }

    /// The edge of a key, with the first triangle that it bounds.
    fn edge(&self, found: u64) -> Edge {
        let of_found = |edge| key(edge) >> 1 == found >> 1;
        let place = self.triangles.iter().position(|&t| directed(t).into_iter().any(of_found)).unwrap_or(0);
        let ends = directed(self.triangles[place]).into_iter().find(|&edge| of_found(edge));
        self.named_edge(place, ends.unwrap_or((0, 0)))
    }

    fn named_edge(&self, place: usize, (from, to): (u32, u32)) -> Edge {
        let mut number = place as u64 + 1;
        for &skipped in &self.skipped {
            number += u64::from(skipped <= number);
        }
        let at = |k: u32| self.vertices[k as usize].into();
        Edge { from: at(from), to: at(to), triangle: number }
    }

    /// Every connected part faces outwards, or is a cavity: it lies within a part that does.
    pub(super) fn check_parts(&self) -> Result<(), MeshError> {
        let (parts, _) = self.parts();
        match inside_out(&parts).first() {
            Some(&inner) => {
                let inner = &parts[inner];
                let edge = self.named_edge(inner.place, directed(self.triangles[inner.place])[0]);
                Err(MeshError::InsideOut { edge, volume: inner.volume6 / 6.0 })
            }
            None => Ok(()),
        }
    }

    /// Turns over every part that neither faces outwards nor is a cavity; how many they are.
    pub(super) fn turn_parts_out(&mut self) -> usize {
        let (parts, part_of) = self.parts();
        let wrong = inside_out(&parts);
        let mut is_wrong = vec![false; parts.len()];
        wrong.iter().for_each(|&part| is_wrong[part] = true);
        for (triangle, part) in self.triangles.iter_mut().zip(part_of) {
            if is_wrong[part as usize] {
                triangle.swap(1, 2);
            }
        }
        wrong.len()
    }

    /// The connected parts, and of each triangle the number of its part.
    fn parts(&self) -> (Vec<Part>, Vec<u32>) {
        let mut roots: Vec<u32> = (0..self.vertices.len() as u32).collect();
        for &[a, b, c] in &self.triangles {
            for other in [b, c] {
                join(&mut roots, a, other);
            }
        }
        let mut parts: Vec<Part> = Vec::new();
        let mut part_at = vec![NONE; self.vertices.len()];
        let mut part_of = Vec::with_capacity(self.triangles.len());
        for (place, &triangle) in self.triangles.iter().enumerate() {
            let root = root(&mut roots, triangle[0]) as usize;
            if part_at[root] == NONE {
                part_at[root] = parts.len() as u32;
                let origin = Vec3(self.vertices[triangle[0] as usize]);
                parts.push(Part { origin, volume6: 0.0, bounds: Bounds::default(), place });
            }
            parts[part_at[root] as usize].add(self.corners(triangle));
            part_of.push(part_at[root]);
        }
        (parts, part_of)
    }
}

/// The parts of negative volume that lie in none of positive volume.
fn inside_out(parts: &[Part]) -> Vec<usize> {
    let outer = parts.iter().filter(|part| part.volume6 > 0.0);
    let outer = Boxes::new(outer.map(|part| part.bounds).collect());
    let is_wrong = |part: &Part| part.volume6 < 0.0 && !outer.contain(&part.bounds);
    parts.iter().enumerate().filter(|(_, part)| is_wrong(part)).map(|(place, _)| place).collect()
}

/// Edges of one kind: the first, with the number of its triangles, and how many.
#[derive(Default)]
struct Kind {
    first: Option<(u64, usize)>,
    count: usize,
}

impl Kind {
    fn add(&mut self, key: u64, uses: usize) {
        self.first.get_or_insert((key, uses));
        self.count += 1;
    }
}

/// A connected part of the mesh.
struct Part {
    origin: Vec3<f64>,
    volume6: f64,
    bounds: Bounds,
    /// Its first triangle.
    place: usize,
}

impl Part {
    fn add(&mut self, corners: [Vec3<f64>; 3]) {
        let [a, b, c] = corners.map(|v| v + -self.origin);
        self.volume6 += a.dot(b.cross(c));
        corners.iter().for_each(|v| self.bounds.add(&v.0));
    }
}

pub(super) fn directed([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

/// Lower end, upper end, and in the last bit the direction.
pub(super) fn key((from, to): (u32, u32)) -> u64 {
    u64::from(from.min(to)) << 32 | u64::from(from.max(to)) << 1 | u64::from(from > to)
}

/// Makes one set of those of two vertices.
pub(super) fn join(roots: &mut [u32], a: u32, b: u32) {
    let (r, s) = (root(roots, a), root(roots, b));
    roots[r.max(s) as usize] = r.min(s);
}

/// The representative of a set of connected vertices; paths are halved on the way.
pub(super) fn root(roots: &mut [u32], mut k: u32) -> u32 {
    while roots[k as usize] != k {
        roots[k as usize] = roots[roots[k as usize] as usize];
        k = roots[k as usize];
    }
    k
}
