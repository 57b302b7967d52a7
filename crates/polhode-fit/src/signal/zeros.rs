//! Zeros that sums are added to.

use core::hint::black_box;

/// Numbers in the smallest page of memory that systems have.
const PAGE: usize = 4096 / size_of::<f64>();

/// As many zeros, of whose memory each page is written here.
///
/// The system hands out one page of zeros for all that is read before it is written, and a page of its own only with the first sum, when
/// every processor at work on the same memory has to be told: that took a fifth of the time of a long record.
pub(crate) fn zeros(count: usize) -> Vec<f64> {
    let mut all = vec![0.0; count];
    // opaque, since the compiler knows that what it would write is there
    all.iter_mut().step_by(PAGE).for_each(|number| *number = black_box(0.0));
    all
}

#[cfg(test)]
mod tests {
    use super::{PAGE, zeros};

    #[test]
    fn all_are_zero_whatever_their_count() {
        for count in [0, 1, PAGE, 3 * PAGE + 1] {
            assert_eq!(zeros(count), vec![0.0; count]);
        }
    }
}
