//! Schemes of a user: a shape that can be stepped, and the order that is claimed.

use super::{Part, Scheme, Stages, order};
use crate::method::SchemeError;
use crate::num::Dd;

/// Words of more letters are not looked at.
const HIGHEST_ORDER: u32 = 32;

impl Scheme {
    /// The scheme `stages`, if it has the order `order`.
    ///
    /// The series of a step in words of the two flows A and B is compared with that of exp(A + B), word by word up to `order`
    /// letters, in double-double; what vanishes for the [pairs](super::Pairs) of the scheme is left out. Of a composition the letters
    /// are the terms of the map, Y₁, Y₃, …. Coefficients of fifteen digits suffice. That the order is not higher than claimed is
    /// not looked at.
    ///
    /// # Errors
    /// Lists that do not alternate, coefficients that are not finite, and an order that the coefficients do not have: the error
    /// says which degree in h is the first to fail, and by how much.
    ///
    /// ```
    /// use polhode::method::SchemeError;
    /// use polhode::method::schemes::{Pairs, Part, Scheme, Stages};
    /// use polhode::num::Dd;
    /// const THIRD: &[Dd] = &[Dd::sum(1.0 / 3.0, 0.0)];
    /// let stages = Stages::Alternating { first: Part::B, a: &[], b: THIRD, pairs: Pairs::Any };
    /// assert_eq!(Scheme::new("thirds", 2, stages, "mine")?.order(), 2);
    /// let error = Scheme::new("thirds", 4, stages, "mine").unwrap_err();
    /// assert!(matches!(error, SchemeError::Order { degree: 3, defect, .. } if 0.03 < defect && defect < 0.3));
    /// # Ok::<(), SchemeError>(())
    /// ```
    pub fn new(
        name: &'static str,
        order: u32,
        stages: Stages,
        source: &'static str,
    ) -> Result<Self, SchemeError> {
        let scheme = Scheme { name, order, source, stages };
        scheme.check_lists()?;
        scheme.check_claim()?;
        order::check(&scheme)?;
        Ok(scheme)
    }

    /// Lists that alternate, of finite numbers.
    fn check_lists(&self) -> Result<(), SchemeError> {
        let scheme = self.name;
        let lists: [&[Dd]; 4] = match self.stages {
            Stages::Composition(gamma) => [gamma, &[], &[], &[]],
            Stages::Processed { kernel, processor } => [kernel, processor, &[], &[]],
            Stages::Alternating { a, b, .. } => [a, b, &[], &[]],
            Stages::ForceGradient { a, b, c, .. } => [a, b, c, &[]],
            Stages::ProcessedAlternating { a, b, processor_a, processor_b, .. } => {
                [a, b, processor_a, processor_b]
            }
        };
        let mut values = lists.iter().copied().flatten().map(|value| value.hi());
        if let Some(value) = values.find(|value| !value.is_finite()) {
            return Err(SchemeError::NotFinite { scheme, value });
        }
        match self.stages {
            Stages::Composition(_) | Stages::Processed { .. } => Ok(()),
            Stages::Alternating { first, a, b, .. } | Stages::ForceGradient { first, a, b, .. } => {
                let (outer, inner) = if first == Part::A { (a.len(), b.len()) } else { (b.len(), a.len()) };
                if outer != inner && outer != inner + 1 {
                    return Err(SchemeError::Lengths { scheme, outer, inner });
                }
                self.check_gradients()
            }
            Stages::ProcessedAlternating { .. } => {
                let kernel = [lists[0].len(), lists[1].len()];
                let processor = [lists[2].len(), lists[3].len()];
                let alternate = processor == [0, 0] || processor[1] == processor[0] + 1;
                if kernel[0] == kernel[1] && alternate {
                    Ok(())
                } else {
                    Err(SchemeError::ProcessedLengths { scheme, kernel, processor })
                }
            }
        }
    }

    /// A gradient for each kick of the first half.
    fn check_gradients(&self) -> Result<(), SchemeError> {
        let Stages::ForceGradient { c, .. } = self.stages else { return Ok(()) };
        let kicks = self.flows().iter().filter(|flow| flow.0 == Part::B).count().div_ceil(2);
        if c.len() == kicks {
            Ok(())
        } else {
            Err(SchemeError::Gradients { scheme: self.name, given: c.len(), kicks })
        }
    }

    /// An order, and orders by powers of the small part that fall to it.
    fn check_claim(&self) -> Result<(), SchemeError> {
        let powers = order::pairs(self).and_then(order::powers);
        let Scheme { name: scheme, order, .. } = *self;
        let claimed = powers.unwrap_or(core::slice::from_ref(&order));
        let in_range = claimed.iter().all(|order| (1..=HIGHEST_ORDER).contains(order));
        if in_range && claimed.last() == Some(&order) && claimed.is_sorted_by(|p, q| p > q) {
            Ok(())
        } else {
            Err(SchemeError::Claim { scheme, order, powers })
        }
    }
}
