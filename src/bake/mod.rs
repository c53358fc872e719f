//! Tables that the real-time renderer reads, made from the float64 reference.

pub mod dfg;
