//! The last samples of a stream, in constant memory.

use core::ops::Range;

use super::rule::MOST_SAMPLES;
use crate::num::Real;
use crate::rotation::Vec3;

/// Samples that are kept: those of the richest rule, and some before them.
pub(super) const KEPT: usize = MOST_SAMPLES + 8;

/// Room for as many again, so that samples are moved once in a while only.
const ROOM: usize = 2 * KEPT;

/// One sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample<S> {
    pub(super) time: S,
    pub(super) reading: Vec3<S>,
}

/// The last samples, by their numbers from 0.
#[derive(Clone, Debug)]
pub(super) struct Window<S> {
    samples: [Sample<S>; ROOM],
    held: usize,
    count: usize,
}

impl<S: Real> Window<S> {
    pub(super) fn new() -> Self {
        let none = Sample { time: S::of(0.0), reading: Vec3::zero() };
        Window { samples: [none; ROOM], held: 0, count: 0 }
    }

    pub(super) fn push(&mut self, sample: Sample<S>) {
        if self.held == ROOM {
            self.samples.copy_within(ROOM - KEPT.., 0);
            self.held = KEPT;
        }
        self.samples[self.held] = sample;
        self.held += 1;
        self.count += 1;
    }

    /// Samples so far.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    pub(super) fn last(&self) -> Option<&Sample<S>> {
        self.samples[..self.held].last()
    }

    /// Those of these numbers, which must be among the last [`KEPT`].
    pub(super) fn get(&self, numbers: Range<usize>) -> &[Sample<S>] {
        let first = self.count - self.held;
        &self.samples[numbers.start - first..numbers.end - first]
    }
}
