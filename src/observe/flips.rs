//! How often a body turns over.

use crate::rotation::Vec3;

/// Changes of sign of the momentum along the middle axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flips {
    axis: usize,
    pub(super) positive: Option<bool>,
    pub(crate) count: u64,
}

impl Flips {
    pub(crate) fn new(axis: usize) -> Self {
        Flips { axis, positive: None, count: 0 }
    }

    #[inline]
    pub(crate) fn observe(&mut self, m: &Vec3<f64>) {
        let component = m[self.axis];
        if component == 0.0 {
            return;
        }
        let positive = component > 0.0;
        if self.positive.is_some_and(|before| before != positive) {
            self.count += 1;
        }
        self.positive = Some(positive);
    }
}
