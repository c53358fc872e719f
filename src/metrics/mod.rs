//! How far two pictures are apart.
//!
//! A [`Pair`] is checked once: equal sizes, equal encodings, finite values. Every metric takes a pair, compares its
//! `actual` picture with its `expected` one, and counts the pixels of the pair's mask alone.

pub mod difference;
mod filter;
pub mod flip;
pub mod heat;
mod map;
mod pair;
pub mod ssim;
#[cfg(test)]
mod tests;
pub mod truth;

pub use map::{ErrorMap, Pool};
pub use pair::{CHANNELS, Mask, Pair, PairError, Side};
