//! `specula test`: pictures of a suite against goldens, the reference and the laws of energy.

mod limits;
mod report;
mod suite;
