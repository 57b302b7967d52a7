//! Fewer triangles for a shape that has more than a page draws: vertices in one cell of a grid become one.
//!
//! J. Rossignac and P. Borrel, Multi-resolution 3D approximations for rendering complex scenes, 1993.

use std::collections::{BTreeSet, HashMap};

use nalgebra::Vector3;

use super::Shape;

/// Cells along the longest side, of the finest grid that is tried.
const FINEST: u32 = 2048;

impl Shape {
    /// With at most `most` triangles: the finest grid whose cells leave so many.
    pub fn decimated(self, most: usize) -> Self {
        if self.triangles.len() <= most {
            return self;
        }
        let (mut coarse, mut fine) = (1, FINEST);
        while fine - coarse > 1 {
            let middle = (coarse + fine) / 2;
            if self.clustered(middle).triangles.len() <= most { coarse = middle } else { fine = middle }
        }
        self.clustered(coarse)
    }

    /// With one vertex in each cell of a grid of so many cells along the longest side: the mean of those in it.
    fn clustered(&self, cells: u32) -> Self {
        let fold = |pick: fn(f64, f64) -> f64| {
            self.vertices.iter().copied().reduce(|a, b| a.zip_map(&b, pick)).unwrap_or_default()
        };
        let (low, high) = (fold(f64::min), fold(f64::max));
        let size = (high - low).amax() / f64::from(cells);
        let cell = |at: &Vector3<f64>| <[f64; 3]>::from(at - low).map(|x| (x / size) as u32);
        let mut places: HashMap<[u32; 3], u32> = HashMap::new();
        let mut sums: Vec<(Vector3<f64>, f64)> = Vec::new();
        let mut of = Vec::with_capacity(self.vertices.len());
        for at in &self.vertices {
            let place = *places.entry(cell(at)).or_insert(sums.len() as u32);
            if place as usize == sums.len() {
                sums.push((Vector3::zeros(), 0.0));
            }
            let (sum, count) = &mut sums[place as usize];
            *sum += at;
            *count += 1.0;
            of.push(place);
        }
        let vertices = sums.into_iter().map(|(sum, count)| sum / count).collect();
        let mut found = Shape { vertices, ..Shape::default() };
        let mut seen = BTreeSet::new();
        for (corners, tint) in self.triangles.iter().zip(&self.tints) {
            let corners = corners.map(|k| of[k as usize]);
            let mut sorted = corners;
            sorted.sort_unstable();
            let [a, b, c] = sorted;
            if a != b && b != c && seen.insert(sorted) {
                found.triangles.push(corners);
                found.tints.push(*tint);
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use polhode::inertia::Solid;

    use super::*;

    #[test]
    fn a_fine_sphere_keeps_its_size_with_fewer_triangles() {
        let sphere = Shape::of_solid(&Solid::Sphere { radius: 2.0 });
        let whole = sphere.triangles();
        let few = sphere.clone().decimated(whole / 4);
        assert!((whole / 16..=whole / 4).contains(&few.triangles()), "{} of {whole}", few.triangles());
        assert!((1.8..=2.0).contains(&few.radius()), "{}", few.radius());
        assert!(few.vertices.iter().all(|at| (1.6..=2.0).contains(&at.norm())));
        assert_eq!(sphere.clone().decimated(whole), sphere);
    }
}
