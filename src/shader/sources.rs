//! The WGSL files, embedded.

use std::collections::BTreeMap;

/// The files at these paths under `shaders/`, with their texts; for a source file two folders below the root.
macro_rules! embedded {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../../shaders/", $path)))),*]
    };
}

#[cfg(feature = "cli")]
pub(crate) use embedded;

/// Every file under `shaders/` that a frame can be made of: its path there, and its text.
pub const SOURCES: &[(&str, &str)] = embedded![
    "background/blurred.wgsl",
    "background/sharp.wgsl",
    "brdf/d_ggx.wgsl",
    "brdf/d_ggx_anisotropic.wgsl",
    "brdf/d_gtr1.wgsl",
    "brdf/f_conductor.wgsl",
    "brdf/f_lazanyi.wgsl",
    "brdf/f_schlick.wgsl",
    "brdf/fd_burley.wgsl",
    "brdf/fd_lambert.wgsl",
    "brdf/fd_subsurface.wgsl",
    "brdf/g1_smith_ggx.wgsl",
    "brdf/v_schlick.wgsl",
    "brdf/v_smith_ggx_correlated.wgsl",
    "brdf/v_smith_ggx_correlated_anisotropic.wgsl",
    "brdf/v_smith_ggx_separable.wgsl",
    "channel/asked.wgsl",
    "channel/channel.wgsl",
    "channel/checker.wgsl",
    "channel/lit.wgsl",
    "channel/lobes_disney.wgsl",
    "channel/lobes_standard.wgsl",
    "channel/radiance.wgsl",
    "channel/suns.wgsl",
    "channel/unlit.wgsl",
    "color/encode_linear.wgsl",
    "color/encode_srgb.wgsl",
    "color/srgb.wgsl",
    "pass/target_display.wgsl",
    "pass/target_radiance.wgsl",
    "color/tone_map_aces.wgsl",
    "color/tone_map_agx.wgsl",
    "color/tone_map_linear.wgsl",
    "color/tone_map_neutral.wgsl",
    "color/tone_map_reinhard.wgsl",
    "light/attenuation.wgsl",
    "light/irradiance_sh.wgsl",
    "lighting/bent_mirror.wgsl",
    "lighting/black.wgsl",
    "lighting/clamp_sampler.wgsl",
    "lighting/clusters.wgsl",
    "lighting/dfg.wgsl",
    "lighting/disney.wgsl",
    "lighting/disney_albedo.wgsl",
    "lighting/disney_lookups_draft.wgsl",
    "lighting/disney_lookups_plain.wgsl",
    "lighting/disney_lookups_standard.wgsl",
    "lighting/disney_smooth.wgsl",
    "lighting/emissive_only.wgsl",
    "lighting/environment.wgsl",
    "lighting/environment_disney.wgsl",
    "lighting/environment_none.wgsl",
    "lighting/environment_taps.wgsl",
    "lighting/facets_disney.wgsl",
    "lighting/facets_standard.wgsl",
    "lighting/flat_lobes.wgsl",
    "lighting/frame.wgsl",
    "lighting/fresnel_conductor.wgsl",
    "lighting/fresnel_lazanyi.wgsl",
    "lighting/fresnel_schlick.wgsl",
    "lighting/fresnel_tail.wgsl",
    "lighting/half_vector.wgsl",
    "lighting/irradiance_harmonics.wgsl",
    "lighting/irradiance_map.wgsl",
    "lighting/lift_view.wgsl",
    "lighting/lights.wgsl",
    "lighting/lights_few.wgsl",
    "lighting/lit.wgsl",
    "lighting/lit_term.wgsl",
    "lighting/lobes.wgsl",
    "lighting/prefiltered.wgsl",
    "lighting/punctual.wgsl",
    "lighting/punctual_clustered.wgsl",
    "lighting/punctual_light.wgsl",
    "lighting/punctual_named.wgsl",
    "lighting/punctual_none.wgsl",
    "lighting/reflection_draft.wgsl",
    "lighting/reflection_high.wgsl",
    "lighting/reflection_line_draft.wgsl",
    "lighting/reflection_line_high.wgsl",
    "lighting/reflection_line_standard.wgsl",
    "lighting/reflection_mirror.wgsl",
    "lighting/reflection_mirror_disney.wgsl",
    "lighting/reflection_standard.wgsl",
    "lighting/shape_anisotropic.wgsl",
    "lighting/shape_isotropic.wgsl",
    "lighting/sun.wgsl",
    "lighting/suns.wgsl",
    "lighting/suns_none.wgsl",
    "lighting/taps.wgsl",
    "lighting/turns.wgsl",
    "lighting/unbounded.wgsl",
    "lighting/unbounded_none.wgsl",
    "lighting/unlit.wgsl",
    "lighting/visibility_anisotropic_mean.wgsl",
    "lighting/visible_facets.wgsl",
    "lobe/albedo.wgsl",
    "lobe/multiscatter_kulla_conty.wgsl",
    "lobe/multiscatter_none.wgsl",
    "lobe/visibility_anisotropic_smith_correlated.wgsl",
    "lobe/visibility_anisotropic_smith_separable.wgsl",
    "lobe/visibility_schlick_half_alpha.wgsl",
    "lobe/visibility_schlick_karis.wgsl",
    "lobe/visibility_schlick_lecture.wgsl",
    "lobe/visibility_smith_correlated.wgsl",
    "lobe/visibility_smith_separable.wgsl",
    "math/constants.wgsl",
    "math/half_range.wgsl",
    "math/octahedral.wgsl",
    "math/orthonormal.wgsl",
    "math/vectors.wgsl",
    "pass/background.wgsl",
    "pass/covered.wgsl",
    "pass/deferred.wgsl",
    "pass/display.wgsl",
    "pass/draw_depth.wgsl",
    "pass/forward.wgsl",
    "pass/fullscreen.wgsl",
    "pass/over.wgsl",
    "pass/present.wgsl",
    "pass/share.wgsl",
    "pass/share_under.wgsl",
    "pass/visibility.wgsl",
    "surface/alpha_blend.wgsl",
    "surface/alpha_mask.wgsl",
    "surface/alpha_opaque.wgsl",
    "surface/dielectric.wgsl",
    "surface/dielectric_plain.wgsl",
    "surface/emission.wgsl",
    "surface/emission_none.wgsl",
    "surface/facing_double.wgsl",
    "surface/facing_single.wgsl",
    "surface/normal_map.wgsl",
    "surface/normal_none.wgsl",
    "surface/normal_vertex.wgsl",
    "surface/occlusion.wgsl",
    "surface/occlusion_none.wgsl",
    "surface/reflecting.wgsl",
    "surface/reflecting_none.wgsl",
    "surface/surface.wgsl",
    "surface/tangent_any.wgsl",
    "surface/tangent_none.wgsl",
    "surface/tangent_vertex.wgsl",
    "surface/tangents_anisotropic.wgsl",
    "surface/tangents_none.wgsl",
    "surface/visible_point.wgsl",
];

/// What imports find: the embedded files, any of which may be replaced, to try out a change without a build or to plant a
/// fault in a test.
#[derive(Debug, Clone, Default)]
pub struct ShaderSources {
    replaced: BTreeMap<String, String>,
}

impl ShaderSources {
    /// Replaces or adds the file at `path` under `shaders/`.
    pub fn insert(&mut self, path: &str, text: String) {
        self.replaced.insert(path.to_owned(), text);
    }

    /// Whether a file is another than the one that is built in.
    pub fn are_changed(&self) -> bool {
        self.replaced.iter().any(|(path, text)| !SOURCES.contains(&(path.as_str(), text.as_str())))
    }

    /// The text of a file.
    pub fn get(&self, path: &str) -> Option<&str> {
        let embedded = || SOURCES.iter().find(|(name, _)| *name == path).map(|(_, text)| *text);
        self.replaced.get(path).map(String::as_str).or_else(embedded)
    }
}
