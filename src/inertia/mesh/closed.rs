//! Triangles that share vertices, and whether they close.

use core::ops::RangeInclusive;

use super::super::mass::LENGTHS;
use super::boxes::{Bounds, Boxes};
use super::{Edge, MeshError};
use crate::rotation::Vec3;

/// Vertices are numbered below this, so that an edge and its direction fit into 64 bits.
pub(super) const LIMIT: u32 = 1 << 31;

/// Extents of a mesh.
const EXTENTS: RangeInclusive<f64> = 1e-57..=1e57;

/// Marks an empty place of the hash table.
const NONE: u32 = u32::MAX;

/// Triangles over distinct vertices.
#[derive(Default)]
pub(super) struct Welded {
    pub(super) vertices: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Triangles of the input before the k-th that was left out, for messages that count the input's.
    skipped: Vec<u64>,
    /// Open addressing: numbers of vertices at the places of their hashes.
    table: Vec<u32>,
}

impl Welded {
    /// Adds a triangle; one with coinciding corners has no area and no side, and is left out.
    pub(super) fn add(&mut self, corners: [Vec3<f64>; 3]) -> Result<(), MeshError> {
        let number = (self.triangles.len() + self.skipped.len()) as u64 + 1;
        let mut triangle = [0; 3];
        for (index, corner) in triangle.iter_mut().zip(corners) {
            if let Some(&value) = corner.0.iter().find(|value| !value.is_finite()) {
                return Err(MeshError::NotFinite { triangle: number, value });
            }
            *index = self.vertex(corner.0)?;
        }
        let [a, b, c] = triangle;
        if a == b || b == c || c == a {
            self.skipped.push(number);
        } else {
            self.triangles.push(triangle);
        }
        Ok(())
    }

    /// The number of a vertex, a new one if these bits were not met before.
    fn vertex(&mut self, at: [f64; 3]) -> Result<u32, MeshError> {
        let at = at.map(|x| x + 0.0); // −0 is 0
        if 2 * (self.vertices.len() + 1) > self.table.len() {
            self.grow();
        }
        let mut place = self.home(&at);
        loop {
            match self.table[place] {
                NONE => break,
                number if self.vertices[number as usize] == at => return Ok(number),
                _ => place = (place + 1) & (self.table.len() - 1),
            }
        }
        let number = self.vertices.len() as u32;
        if number == LIMIT {
            return Err(MeshError::TooLarge);
        }
        self.table[place] = number;
        self.vertices.push(at);
        Ok(number)
    }

    fn grow(&mut self) {
        self.table = vec![NONE; (2 * self.table.len()).max(64)];
        for number in 0..self.vertices.len() {
            let mut place = self.home(&self.vertices[number]);
            while self.table[place] != NONE {
                place = (place + 1) & (self.table.len() - 1);
            }
            self.table[place] = number as u32;
        }
    }

    /// The place in the table, whose length is a power of two, where a vertex is looked for first.
    fn home(&self, at: &[f64; 3]) -> usize {
        let mut hash = 0_u64;
        for x in at {
            hash = (hash ^ x.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            hash ^= hash >> 32;
        }
        hash as usize & (self.table.len() - 1)
    }

    pub(super) fn corners(&self, triangle: [u32; 3]) -> [Vec3<f64>; 3] {
        triangle.map(|k| Vec3(self.vertices[k as usize]))
    }

    /// The middle of the bounding box.
    pub(super) fn middle(&self) -> Vec3<f64> {
        let mut bounds = Bounds::default();
        self.vertices.iter().for_each(|at| bounds.add(at));
        Vec3([0, 1, 2].map(|k| bounds.low[k] + 0.5 * (bounds.high[k] - bounds.low[k])))
    }

    /// The fifth power of the longest edge of the bounding box, and the place of that, are doubles with all their digits.
    pub(super) fn check_extent(&self) -> Result<(), MeshError> {
        let mut bounds = Bounds::default();
        self.vertices.iter().for_each(|at| bounds.add(at));
        let extent = (0..3).map(|k| bounds.high[k] - bounds.low[k]).fold(0.0, f64::max);
        let reach = (0..3).map(|k| bounds.high[k].max(-bounds.low[k])).fold(0.0, f64::max);
        if EXTENTS.contains(&extent) && LENGTHS.contains(&reach) {
            Ok(())
        } else {
            Err(MeshError::OutOfRange { extent: extent.min(f64::MAX), reach })
        }
    }

    /// Every edge bounds two triangles, once in each direction.
    pub(super) fn check_edges(&self) -> Result<(), MeshError> {
        let mut edges = Vec::with_capacity(3 * self.triangles.len());
        for &triangle in &self.triangles {
            edges.extend(directed(triangle).map(key));
        }
        edges.sort_unstable();
        let (mut open, mut crowded, mut turned) = (Kind::default(), Kind::default(), Kind::default());
        for uses in edges.chunk_by(|a, b| a >> 1 == b >> 1) {
            match uses {
                [a, b] if a != b => {}
                [a, _] => turned.add(*a, 2),
                [a] => open.add(*a, 1),
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
        let mut roots: Vec<u32> = (0..self.vertices.len() as u32).collect();
        for &[a, b, c] in &self.triangles {
            for other in [b, c] {
                let (r, s) = (root(&mut roots, a), root(&mut roots, other));
                roots[r.max(s) as usize] = r.min(s);
            }
        }
        let mut parts: Vec<Part> = Vec::new();
        let mut part_of = vec![NONE; self.vertices.len()];
        for (place, &triangle) in self.triangles.iter().enumerate() {
            let root = root(&mut roots, triangle[0]) as usize;
            if part_of[root] == NONE {
                part_of[root] = parts.len() as u32;
                let origin = Vec3(self.vertices[triangle[0] as usize]);
                parts.push(Part { origin, volume6: 0.0, bounds: Bounds::default(), place });
            }
            parts[part_of[root] as usize].add(self.corners(triangle));
        }
        let outer = parts.iter().filter(|part| part.volume6 > 0.0);
        let outer = Boxes::new(outer.map(|part| part.bounds).collect());
        for inner in parts.iter().filter(|part| part.volume6 < 0.0) {
            if !outer.contain(&inner.bounds) {
                let edge = self.named_edge(inner.place, directed(self.triangles[inner.place])[0]);
                return Err(MeshError::InsideOut { edge, volume: inner.volume6 / 6.0 });
            }
        }
        Ok(())
    }
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

fn directed([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

/// Lower end, upper end, and in the last bit the direction.
fn key((from, to): (u32, u32)) -> u64 {
    u64::from(from.min(to)) << 32 | u64::from(from.max(to)) << 1 | u64::from(from > to)
}

/// The representative of a set of connected vertices; paths are halved on the way.
fn root(roots: &mut [u32], mut k: u32) -> u32 {
    while roots[k as usize] != k {
        roots[k as usize] = roots[roots[k as usize] as usize];
        k = roots[k as usize];
    }
    k
}
