//! Shared by every layer: directions, projections, colour, quadrature. No scene, no GPU.

pub mod blur;
pub mod color;
pub mod descent;
pub mod parameter;
pub mod quadrature;
pub mod simplex;
pub mod spaces;
