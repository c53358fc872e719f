//! What is computed once and read while shading.

pub mod environment;
mod harmonics;
mod irradiance;
mod lobe;
mod octahedral;
mod panorama;
pub mod studio;
