//! `specula test`: pictures of a suite against goldens, the reference and the laws of energy.

// The command that fills it follows.
#[cfg_attr(not(test), expect(dead_code))]
mod report;
