//! Shared by every layer: directions, projections, colour, quadrature. No scene, no GPU.

pub mod color;
pub mod quadrature;
pub mod spaces;
