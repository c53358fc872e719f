//! The WGSL files, embedded.

macro_rules! sources {
    ($($path:literal),* $(,)?) => {
        /// Every file under `shaders/`: its path there, and its text.
        pub const SOURCES: &[(&str, &str)] = &[$(($path, include_str!(concat!("../../shaders/", $path)))),*];
    };
}

sources![
    "brdf/d_ggx.wgsl",
    "brdf/f_schlick.wgsl",
    "brdf/fd_lambert.wgsl",
    "brdf/v_smith_ggx_correlated.wgsl",
    "color/encode_linear.wgsl",
    "color/encode_srgb.wgsl",
    "color/srgb.wgsl",
    "color/tone_map_aces.wgsl",
    "color/tone_map_agx.wgsl",
    "color/tone_map_linear.wgsl",
    "color/tone_map_neutral.wgsl",
    "color/tone_map_reinhard.wgsl",
    "light/attenuation.wgsl",
    "light/irradiance_sh.wgsl",
    "lighting/dfg.wgsl",
    "lighting/emissive_only.wgsl",
    "lighting/environment.wgsl",
    "lighting/environment_none.wgsl",
    "lighting/frame.wgsl",
    "lighting/lit.wgsl",
    "lighting/lobes.wgsl",
    "lighting/punctual.wgsl",
    "lighting/punctual_none.wgsl",
    "lighting/unlit.wgsl",
    "lobe/albedo.wgsl",
    "lobe/multiscatter_kulla_conty.wgsl",
    "lobe/multiscatter_none.wgsl",
    "math/constants.wgsl",
    "math/octahedral.wgsl",
    "math/vectors.wgsl",
    "pass/background.wgsl",
    "pass/display.wgsl",
    "pass/forward.wgsl",
    "pass/fullscreen.wgsl",
    "surface/alpha_blend.wgsl",
    "surface/alpha_mask.wgsl",
    "surface/alpha_opaque.wgsl",
    "surface/facing_double.wgsl",
    "surface/facing_single.wgsl",
    "surface/normal_map.wgsl",
    "surface/normal_none.wgsl",
    "surface/normal_vertex.wgsl",
    "surface/surface.wgsl",
];

/// The text of a file under `shaders/`.
pub(super) fn source(path: &str) -> Option<&'static str> {
    SOURCES.iter().find(|(name, _)| *name == path).map(|(_, text)| *text)
}
