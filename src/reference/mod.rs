//! The truth: every formula in float64, and a CPU renderer made of them.

pub mod albedo;
pub mod brdf;
pub mod quadrature;
