//! The truth: every formula in float64, and a CPU renderer made of them.
//!
//! Formulas are in the algebra of the papers; the shaders have other, numerically stable algebra for the same functions
//! and are tested against these. [`render()`] takes the same scene and view as the real-time renderer.

pub mod albedo;
pub mod brdf;
pub mod bsdf;
pub mod color;
pub mod compensation;
pub mod disney;
pub mod environment;
mod estimate;
pub mod geometry;
pub mod inspect;
pub mod integrator;
pub mod laws;
pub mod lights;
pub mod microfacet;
mod render;
pub mod sampling;
mod strokes;
pub mod surface;
pub mod techniques;
#[cfg(test)]
mod tests;
pub mod texture;
pub mod walk;

pub use crate::math::quadrature;
pub use estimate::{Estimate, EstimateOptions, REPLICATES, estimate, refine};
pub use render::{ReferenceOptions, render};
