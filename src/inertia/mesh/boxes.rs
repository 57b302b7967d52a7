//! Boxes along the axes, and whether one of many holds another.

/// From the least to the greatest coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
}

impl Default for Bounds {
    fn default() -> Self {
        Bounds { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] }
    }
}

impl Bounds {
    pub(super) fn around(points: &[[f64; 3]]) -> Self {
        let mut bounds = Bounds::default();
        points.iter().for_each(|at| bounds.add(at));
        bounds
    }

    /// How long it is along an axis.
    pub(super) fn edge(&self, axis: usize) -> f64 {
        self.high[axis] - self.low[axis]
    }

    pub(super) fn add(&mut self, at: &[f64; 3]) {
        self.low = [0, 1, 2].map(|k| self.low[k].min(at[k]));
        self.high = [0, 1, 2].map(|k| self.high[k].max(at[k]));
    }

    fn contain(&self, inner: &Bounds) -> bool {
        (0..3).all(|k| self.low[k] <= inner.low[k] && inner.high[k] <= self.high[k])
    }
}

/// A binary tree of boxes: each half of a slice, halved in turn, lies below one node.
///
/// A search goes only where the box around all boxes below holds what is looked for, which of boxes that do not
/// overlap is one way down.
pub(super) struct Boxes {
    boxes: Vec<Bounds>,
    /// Around each slice, its left half and its right half, in this order.
    around: Vec<Bounds>,
}

impl Boxes {
    pub(super) fn new(mut boxes: Vec<Bounds>) -> Self {
        let mut around = Vec::with_capacity(2 * boxes.len());
        build(&mut boxes, &mut around);
        Boxes { boxes, around }
    }

    /// Whether one of them contains `inner`.
    pub(super) fn contain(&self, inner: &Bounds) -> bool {
        let mut open = vec![(0, self.boxes.len(), 0)];
        while let Some((start, end, node)) = open.pop() {
            if start == end || !self.around[node].contain(inner) {
                continue;
            }
            if end - start == 1 {
                return true;
            }
            let middle = usize::midpoint(start, end);
            // a tree of n boxes has 2n - 1 nodes
            open.push((middle, end, node + 2 * (middle - start)));
            open.push((start, middle, node + 1));
        }
        false
    }
}

fn build(boxes: &mut [Bounds], around: &mut Vec<Bounds>) {
    let mut all = Bounds::default();
    for each in boxes.iter() {
        all.add(&each.low);
        all.add(&each.high);
    }
    around.push(all);
    if boxes.len() < 2 {
        return;
    }
    let longer = |one: usize, other: usize| if all.edge(other) > all.edge(one) { other } else { one };
    let axis = (1..3).fold(0, longer);
    let middle = boxes.len() / 2;
    boxes.select_nth_unstable_by(middle, |a, b| {
        (0.5 * a.low[axis] + 0.5 * a.high[axis]).total_cmp(&(0.5 * b.low[axis] + 0.5 * b.high[axis]))
    });
    let (left, right) = boxes.split_at_mut(middle);
    build(left, around);
    build(right, around);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Random;

    fn cube(at: [f64; 3], edge: f64) -> Bounds {
        Bounds { low: at, high: at.map(|x| x + edge) }
    }

    #[test]
    fn the_tree_says_what_a_look_at_every_box_says() {
        let mut numbers = Random::new(1);
        let mut random = || numbers.uniform();
        for count in [0, 1, 2, 3, 7, 64, 321] {
            let boxes: Vec<Bounds> =
                (0..count).map(|_| cube([random(), random(), random()], 0.3 * random())).collect();
            let tree = Boxes::new(boxes.clone());
            let mut found = 0;
            for _ in 0..500 {
                let inner = cube([random(), random(), random()], 0.05 * random());
                let expected = boxes.iter().any(|outer| outer.contain(&inner));
                assert_eq!(tree.contain(&inner), expected);
                found += usize::from(expected);
            }
            assert!(count < 64 || (1..500).contains(&found), "{count}: {found}");
            assert!(boxes.iter().all(|each| tree.contain(each)));
        }
    }
}
