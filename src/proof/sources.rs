//! WGSL that no frame is made of: naive forms, and entries into the shaders for proofs.

use crate::shader::embedded;

/// Files under `shaders/`: their paths there, and their texts.
pub const SOURCES: &[(&str, &str)] = embedded![
    "naive/attenuation.wgsl",
    "naive/d_ggx.wgsl",
    "naive/f_schlick.wgsl",
    "naive/half_range.wgsl",
    "naive/specular_lobe.wgsl",
    "naive/tangent_frame.wgsl",
    "naive/v_smith_ggx.wgsl",
    "naive/vectors.wgsl",
    "proof/fuzz.wgsl",
    "proof/illuminance.wgsl",
    "proof/inputs.wgsl",
    "proof/random.wgsl",
    "proof/shading_normal.wgsl",
    "proof/specular_lobe.wgsl",
    "proof/store.wgsl",
];
