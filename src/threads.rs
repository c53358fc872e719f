//! Work that is shared among threads, where the crate may have any: with the feature `threads`. Without it the same calls
//! are loops on the caller's thread, and give the same bits.

#[cfg(feature = "threads")]
pub(crate) use rayon::{join, prelude::*};

#[cfg(not(feature = "threads"))]
pub(crate) use alone::{Loops, Slices, Whole, join};

#[cfg(not(feature = "threads"))]
mod alone {
    use std::slice::{Chunks, ChunksExactMut, ChunksMut, Iter};

    /// Both, the first first.
    pub(crate) fn join<A, B>(first: impl FnOnce() -> A, second: impl FnOnce() -> B) -> (A, B) {
        (first(), second())
    }

    /// Rayon's names for parts of slices.
    pub(crate) trait Slices<T> {
        fn par_iter(&self) -> Iter<'_, T>;
        fn par_chunks(&self, size: usize) -> Chunks<'_, T>;
        fn par_chunks_mut(&mut self, size: usize) -> ChunksMut<'_, T>;
        fn par_chunks_exact_mut(&mut self, size: usize) -> ChunksExactMut<'_, T>;
    }

    impl<T> Slices<T> for [T] {
        fn par_iter(&self) -> Iter<'_, T> {
            self.iter()
        }

        fn par_chunks(&self, size: usize) -> Chunks<'_, T> {
            self.chunks(size)
        }

        fn par_chunks_mut(&mut self, size: usize) -> ChunksMut<'_, T> {
            self.chunks_mut(size)
        }

        fn par_chunks_exact_mut(&mut self, size: usize) -> ChunksExactMut<'_, T> {
            self.chunks_exact_mut(size)
        }
    }

    /// Of ranges.
    pub(crate) trait Whole: IntoIterator + Sized {
        fn into_par_iter(self) -> Self::IntoIter {
            self.into_iter()
        }
    }

    impl<I: IntoIterator> Whole for I {}

    /// Of what is done with them.
    pub(crate) trait Loops: Iterator + Sized {
        fn par_bridge(self) -> Self {
            self
        }

        fn flat_map_iter<I: IntoIterator>(self, each: impl FnMut(Self::Item) -> I) -> impl Iterator<Item = I::Item> {
            self.flat_map(each)
        }

        fn for_each_init<S>(self, init: impl FnOnce() -> S, mut each: impl FnMut(&mut S, Self::Item)) {
            let mut scratch = init();
            self.for_each(|item| each(&mut scratch, item));
        }
    }

    impl<I: Iterator> Loops for I {}
}
