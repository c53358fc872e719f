//! What is computed once and read while shading: tables from the float64 reference, maps from an environment.

pub mod dfg;
pub mod disney;
pub mod environment;
mod harmonics;
mod irradiance;
mod lobe;
mod octahedral;
mod panorama;
pub mod studio;
