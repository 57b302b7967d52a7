//! Work on many threads, with results that do not depend on them.

use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

/// `work` on each of `parts`, on `threads` threads; the results stand in the order of the parts. Where the system refuses so
/// many, half of them are tried, and at last the calling thread alone.
pub fn map<T: Send, R: Send>(parts: Vec<T>, threads: usize, work: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    let counts = std::iter::successors(Some(threads.min(parts.len())), |count| Some(count / 2));
    let pool = counts
        .take_while(|count| *count > 1)
        .find_map(|count| ThreadPoolBuilder::new().num_threads(count).build().ok());
    match pool {
        Some(pool) => pool.install(|| parts.into_par_iter().with_max_len(1).map(work).collect()),
        None => parts.into_iter().map(work).collect(),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Barrier;

    use super::map;

    #[test]
    fn results_stand_in_the_order_of_the_parts_on_any_number_of_threads() {
        let squares: Vec<u64> = (0..1000).map(|x| x * x).collect();
        for threads in [0, 1, 2, 3, 7, 2000] {
            assert_eq!(map((0..1000).collect(), threads, |x: u64| x * x), squares, "{threads} threads");
        }
        assert!(map(Vec::<u64>::new(), 4, |x| x).is_empty());
    }

    #[test]
    fn parts_are_worked_on_at_the_same_time() {
        // nobody passes before all three have come
        let barrier = Barrier::new(3);
        assert_eq!(map(vec![1, 2, 3], 3, |x| (barrier.wait(), x).1), [1, 2, 3]);
    }
}
