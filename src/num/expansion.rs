//! Exact sums and products.

use core::ops::{Mul, Sub};

use super::Dd;
use super::dd::{two_prod, two_sum};

/// A sum of doubles, exact.
#[derive(Clone, Debug)]
pub struct Expansion(Vec<f64>);

impl From<Dd> for Expansion {
    fn from(x: Dd) -> Self {
        Expansion(vec![x.lo(), x.hi()])
    }
}

impl Expansion {
    fn grow(&mut self, x: f64) {
        let mut q = x;
        let mut parts = Vec::with_capacity(self.0.len() + 1);
        for &e in &self.0 {
            let (s, r) = two_sum(q, e);
            if r != 0.0 {
                parts.push(r);
            }
            q = s;
        }
        if q != 0.0 || parts.is_empty() {
            parts.push(q);
        }
        self.0 = parts;
    }

    /// Rounded to double-double.
    pub fn to_dd(&self) -> Dd {
        self.0.iter().fold(Dd::ZERO, |sum, &x| sum + Dd::sum(x, 0.0))
    }
}

impl Mul for &Expansion {
    type Output = Expansion;
    fn mul(self, other: &Expansion) -> Expansion {
        let mut product = Expansion(vec![]);
        for &a in &self.0 {
            for &b in &other.0 {
                let (p, e) = two_prod(a, b);
                product.grow(e);
                product.grow(p);
            }
        }
        product
    }
}

impl Sub for &Expansion {
    type Output = Expansion;
    fn sub(self, other: &Expansion) -> Expansion {
        let mut sum = self.clone();
        for &x in &other.0 {
            sum.grow(-x);
        }
        sum
    }
}
