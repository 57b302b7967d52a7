//! Rows that are made and whitened block by block, so that what is kept of them does not grow with the record.

use core::ops::Range;

use polhode::record::both;

use crate::signal::banded::{Banded, Forward};

/// Tests whose rows are made together: they stand in the cache until they are whitened.
pub(crate) const TOGETHER: usize = 1024;

/// Hands over the rows of `tests` test functions whitened, to the last bit as all at once. `made` are the columns of the covariance that belong to
/// some of them, or of its factor, with their rows. `None` where the covariance is not positive.
pub(crate) fn whitened(
    tests: usize,
    together: usize,
    is_factor: bool,
    made: impl Fn(Range<usize>) -> (Banded, Vec<f64>) + Sync,
    mut take: impl FnMut(&[f64]),
) -> Option<()> {
    let mut blocks = (0..tests).step_by(together).map(|first| first..tests.min(first + together));
    let mut following = || {
        let own = blocks.next()?;
        Some((own.end == tests, made(own)))
    };
    let (mut forward, mut next) = (Forward::default(), following());
    while let Some((is_last, (columns, rows))) = next {
        let whiten = || forward.solved(&columns, is_factor, &rows, is_last).map(&mut take);
        // those that follow are made beside that
        let whitened;
        (next, whitened) = both(!is_last, &mut following, whiten);
        whitened?;
    }
    Some(())
}
