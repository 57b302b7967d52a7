//! Triangles that share vertices.

use core::ops::RangeInclusive;

use super::super::mass::LENGTHS;
use super::MeshError;
use super::boxes::Bounds;
use crate::rotation::Vec3;

/// Vertices are numbered below this, so that an edge and its direction fit into 64 bits.
pub(super) const LIMIT: u32 = 1 << 31;

/// Extents of a mesh.
const EXTENTS: RangeInclusive<f64> = 1e-57..=1e57;

/// Marks an empty place of the hash table.
pub(super) const NONE: u32 = u32::MAX;

/// Triangles over distinct vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Welded {
    pub(super) vertices: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Names of the groups that triangles belong to, and where in the list of triangles that begins.
    pub(super) groups: Vec<(Vec<String>, usize)>,
    /// Numbers of triangles of the input that were left out, for messages that count the input's.
    pub(super) skipped: Vec<u64>,
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

    /// What follows belongs to the groups called `names`, and to no other.
    pub(super) fn begin_groups(&mut self, names: Vec<String>) {
        let start = self.triangles.len();
        // a group without triangles is none
        while self.groups.last().is_some_and(|(_, before)| *before == start) {
            self.groups.pop();
        }
        self.groups.push((names, start));
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
        let bounds = Bounds::around(&self.vertices);
        Vec3([0, 1, 2].map(|k| bounds.low[k] + 0.5 * bounds.edge(k)))
    }

    /// As [`check_extent`] of the vertices.
    pub(super) fn check_extent(&self) -> Result<(), MeshError> {
        check_extent(&self.vertices)
    }
}

/// The fifth power of the longest edge of the bounding box, and the place of that, are doubles with all their digits.
pub(super) fn check_extent(points: &[[f64; 3]]) -> Result<(), MeshError> {
    let bounds = Bounds::around(points);
    let extent = (0..3).map(|k| bounds.edge(k)).fold(0.0, f64::max);
    let reach = (0..3).map(|k| bounds.high[k].max(-bounds.low[k])).fold(0.0, f64::max);
    if EXTENTS.contains(&extent) && LENGTHS.contains(&reach) {
        Ok(())
    } else {
        Err(MeshError::OutOfRange { extent: extent.min(f64::MAX), reach })
    }
}
