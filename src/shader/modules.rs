//! Which file fills which slot, for each pass.

use super::compose::{Composed, ShaderError, Slot, Slots, compose};
use super::features::{Alpha, ForwardFeatures, FresnelFeature, LightList, Shading};
use super::interface::Gradients;
use super::pulled::Seen;
use super::sources::ShaderSources;
use super::{channels, interface, pulled, types};
use crate::scene::{Components, Geometry, Quality, Term, TextureSlot, ToneMap};

/// What a target holds where something is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TargetLight {
    /// Scene radiance in cd/m2, multiplied with coverage.
    #[default]
    Radiance,
    /// Display light, multiplied with coverage.
    Display(DisplayFeatures),
}

/// The forward pass of one kind of draw, into radiance.
pub fn forward_module(sources: &ShaderSources, features: &ForwardFeatures) -> Result<Composed, ShaderError> {
    forward_module_into(sources, features, TargetLight::Radiance)
}

/// The same into what a target holds.
pub fn forward_module_into(
    sources: &ShaderSources,
    features: &ForwardFeatures,
    light: TargetLight,
) -> Result<Composed, ShaderError> {
    let mut slots = forward_slots(features);
    slots.extend(target_slots(light, "frame"));
    compose(sources, "pass/forward.wgsl", &slots)
}

/// What turns radiance into what the target holds; `uniform` has the exposure.
fn target_slots(light: TargetLight, uniform: &str) -> Slots {
    match light {
        TargetLight::Radiance => Slots::from([("target", Slot::File("pass/target_radiance.wgsl"))]),
        TargetLight::Display(features) => {
            let exposure = format!("fn exposure() -> f32 {{\n    return {uniform}.exposure;\n}}\n");
            let mut slots = display_slots(features);
            slots.insert("target", Slot::File("pass/target_display.wgsl"));
            slots.insert("exposure", Slot::Text(exposure));
            slots
        }
    }
}

/// The pass that shades what the visibility pass has seen of one kind of draw, by the shader that the forward pass has.
pub fn deferred_module(
    sources: &ShaderSources,
    features: &ForwardFeatures,
    seen: Seen,
) -> Result<Composed, ShaderError> {
    let mut slots = forward_slots(features);
    slots.insert("interface", Slot::Text(pulled::vertex_interface(&features.vertex, features.channel)));
    slots.insert("material", Slot::Text(interface::material_interface(&features.material, Gradients::Explicit)));
    slots.insert("seen", Slot::Text(pulled::seen(seen, 2)));
    slots.insert("share", Slot::File(if seen.under { "pass/share_under.wgsl" } else { "pass/share.wgsl" }));
    compose(sources, "pass/deferred.wgsl", &slots)
}

/// What each sample of the picture shows, to be shaded later.
pub fn visibility_module(sources: &ShaderSources) -> Result<Composed, ShaderError> {
    // Before all declarations, which this slot begins.
    let text = format!("enable primitive_index;\n\n{}", types::wgsl());
    compose(sources, "pass/visibility.wgsl", &Slots::from([("types", Slot::Text(text))]))
}

/// Which draw has a pixel, as depth.
pub fn covered_module(sources: &ShaderSources, seen: Seen) -> Result<Composed, ShaderError> {
    let slots = Slots::from([("types", Slot::Text(types::wgsl())), ("seen", Slot::Text(pulled::seen(seen, 0)))]);
    compose(sources, "pass/covered.wgsl", &slots)
}

/// What was drawn over that, into radiance.
pub fn over_module(sources: &ShaderSources, samples: u32) -> Result<Composed, ShaderError> {
    compose(sources, "pass/over.wgsl", &Slots::from([("over", Slot::Text(pulled::over(samples, 0)))]))
}

/// What fills the slots of the forward pass.
pub fn forward_slots(features: &ForwardFeatures) -> Slots {
    let choose = |on: bool, with: &'static str, without: &'static str| Slot::File(if on { with } else { without });
    let ForwardFeatures { scene, material, vertex, energy_compensation, geometry, term, channel, .. } = features;
    let term = term.filter(|_| !channel);
    let punctual = scene.punctual && term.is_none_or(Term::is_direct);
    let environment = scene.environment && term.is_none_or(Term::is_of_environment);
    let normal_mapped = material.texture(TextureSlot::Normal).is_some();
    Slots::from([
        ("types", Slot::Text(types::wgsl())),
        ("interface", Slot::Text(interface::vertex_interface(vertex, *channel))),
        ("material", Slot::Text(interface::material_interface(material, Gradients::Implicit))),
        (
            "normal",
            match (material.shading.is_lit(), normal_mapped) {
                (true, true) => Slot::File("surface/normal_map.wgsl"),
                (true, false) => Slot::File("surface/normal_vertex.wgsl"),
                (false, _) => Slot::File("surface/normal_none.wgsl"),
            },
        ),
        (
            "tangent",
            match (material.shading, material.disney_anisotropic) {
                (_, true) => Slot::File("surface/tangent_vertex.wgsl"),
                (Shading::Disney, false) => Slot::File("surface/tangent_any.wgsl"),
                _ => Slot::File("surface/tangent_none.wgsl"),
            },
        ),
        (
            "facing",
            choose(
                material.double_sided && material.shading.is_lit(),
                "surface/facing_double.wgsl",
                "surface/facing_single.wgsl",
            ),
        ),
        ("emission", choose(material.emissive, "surface/emission.wgsl", "surface/emission_none.wgsl")),
        ("occlusion", choose(material.reads_occlusion(), "surface/occlusion.wgsl", "surface/occlusion_none.wgsl")),
        ("dielectric", choose(material.specular, "surface/dielectric.wgsl", "surface/dielectric_plain.wgsl")),
        ("reflecting", choose(material.shading.is_lit(), "surface/reflecting.wgsl", "surface/reflecting_none.wgsl")),
        ("shading", Slot::File(shading(material.shading, term))),
        ("components", Slot::Text(channels::components(term.and_then(Term::components).unwrap_or(Components::ALL)))),
        ("tangents", choose(material.anisotropic, "surface/tangents_anisotropic.wgsl", "surface/tangents_none.wgsl")),
        ("shape", choose(material.anisotropic, "lighting/shape_anisotropic.wgsl", "lighting/shape_isotropic.wgsl")),
        ("visibility", Slot::File(visibility(*geometry))),
        ("visibility_anisotropic", Slot::File(visibility_anisotropic(*geometry))),
        (
            "fresnel",
            Slot::File(match material.fresnel {
                FresnelFeature::Schlick => "lighting/fresnel_schlick.wgsl",
                FresnelFeature::Lazanyi => "lighting/fresnel_lazanyi.wgsl",
                FresnelFeature::Conductor => "lighting/fresnel_conductor.wgsl",
            }),
        ),
        ("lobes", choose(material.shading == Shading::Disney, "lighting/disney.wgsl", "lighting/lobes.wgsl")),
        (
            "punctual",
            Slot::File(match (punctual, scene.light_list) {
                (false, _) => "lighting/punctual_none.wgsl",
                (true, LightList::Named(_)) => "lighting/punctual_named.wgsl",
                (true, LightList::Few | LightList::All) => "lighting/punctual.wgsl",
                (true, LightList::Clustered | LightList::ClusteredAndUnbounded) => "lighting/punctual_clustered.wgsl",
            }),
        ),
        ("each_light", Slot::Text(each_light(scene.light_list))),
        ("lights", choose(scene.light_list.is_uniform(), "lighting/lights_few.wgsl", "lighting/lights.wgsl")),
        (
            "unbounded",
            choose(
                scene.light_list == LightList::ClusteredAndUnbounded,
                "lighting/unbounded.wgsl",
                "lighting/unbounded_none.wgsl",
            ),
        ),
        (
            "environment",
            match (environment, material.shading) {
                (true, Shading::Disney) => Slot::File("lighting/environment_disney.wgsl"),
                (true, _) if features.reads_taps() => Slot::File("lighting/environment_taps.wgsl"),
                (true, _) => Slot::File("lighting/environment.wgsl"),
                (false, _) => Slot::File("lighting/environment_none.wgsl"),
            },
        ),
        (
            "suns",
            Slot::File(match (scene.suns > 0, channel) {
                (false, _) => "lighting/suns_none.wgsl",
                (true, false) => "lighting/suns.wgsl",
                (true, true) => "channel/suns.wgsl",
            }),
        ),
        ("each_sun", Slot::Text(each_sun(scene.suns))),
        ("output", choose(*channel, "channel/channel.wgsl", "channel/radiance.wgsl")),
        ("channels", Slot::Text(channels::channels(features))),
        ("radiance_channel", choose(material.shading.is_lit(), "channel/lit.wgsl", "channel/unlit.wgsl")),
        (
            "chosen_lobes",
            choose(material.shading == Shading::Disney, "channel/lobes_disney.wgsl", "channel/lobes_standard.wgsl"),
        ),
        ("reflection", Slot::File(reflection(features))),
        (
            "irradiance",
            Slot::File(match features.reflection() {
                Quality::SplitSum | Quality::Draft => "lighting/irradiance_harmonics.wgsl",
                Quality::Standard | Quality::High => "lighting/irradiance_map.wgsl",
            }),
        ),
        (
            "other_lookups",
            Slot::File(match features.reflection() {
                Quality::SplitSum => "lighting/disney_lookups_plain.wgsl",
                Quality::Draft => "lighting/disney_lookups_draft.wgsl",
                Quality::Standard | Quality::High => "lighting/disney_lookups_standard.wgsl",
            }),
        ),
        (
            "facets",
            choose(material.shading == Shading::Disney, "lighting/facets_disney.wgsl", "lighting/facets_standard.wgsl"),
        ),
        (
            "multiscatter",
            choose(*energy_compensation, "lobe/multiscatter_kulla_conty.wgsl", "lobe/multiscatter_none.wgsl"),
        ),
        (
            "alpha",
            Slot::File(match material.alpha {
                Alpha::Opaque => "surface/alpha_opaque.wgsl",
                Alpha::Mask => "surface/alpha_mask.wgsl",
                Alpha::Blend => "surface/alpha_blend.wgsl",
            }),
        ),
    ])
}

/// What a surface sends to the eye: everything, or only the term.
fn shading(shading: Shading, term: Option<Term>) -> &'static str {
    match (shading, term) {
        (Shading::Unlit, None | Some(Term::Emission)) => "lighting/unlit.wgsl",
        (Shading::Lit | Shading::Disney, None) => "lighting/lit.wgsl",
        (_, None | Some(Term::Emission)) => "lighting/emissive_only.wgsl",
        (Shading::Lit | Shading::Disney, Some(_)) => "lighting/lit_term.wgsl",
        (_, Some(_)) => "lighting/black.wgsl",
    }
}

/// The sum over the suns, without a loop.
fn each_sun(suns: u8) -> String {
    let sum = named((0..suns).map(|i| format!("radiance_of_sun(lobes, {i}u)")));
    format!("fn radiance_of_suns(lobes: Lobes) -> vec3f {{\n    return {sum};\n}}\n")
}

/// The sum over lights that are named, and their number.
fn each_light(list: LightList) -> String {
    let LightList::Named(lights) = list else { return String::new() };
    let sum = named((0..lights).map(|i| format!("radiance_of_light(lobes, position, {i}u)")));
    format!(
        "const NAMED_LIGHTS: u32 = {lights}u;\n\n\
         fn radiance_of_named(lobes: Lobes, position: vec3f) -> vec3f {{\n    return {sum};\n}}\n"
    )
}

fn named(radiances: impl Iterator<Item = String>) -> String {
    radiances.collect::<Vec<_>>().join(" + ")
}

fn reflection(features: &ForwardFeatures) -> &'static str {
    match (features.reflection(), features.material.has_round_lobes()) {
        (Quality::SplitSum, _) if features.material.shading == Shading::Disney => {
            "lighting/reflection_mirror_disney.wgsl"
        }
        (Quality::SplitSum, _) => "lighting/reflection_mirror.wgsl",
        (Quality::Draft, true) => "lighting/reflection_draft.wgsl",
        (Quality::Standard, true) => "lighting/reflection_standard.wgsl",
        (Quality::High, true) => "lighting/reflection_high.wgsl",
        (Quality::Draft, false) => "lighting/reflection_line_draft.wgsl",
        // Its alpha along the tangent goes up to 3: three taps would leave gaps.
        (Quality::Standard, false) if features.material.disney_anisotropic => "lighting/reflection_line_high.wgsl",
        (Quality::Standard, false) => "lighting/reflection_line_standard.wgsl",
        (Quality::High, false) => "lighting/reflection_line_high.wgsl",
    }
}

fn visibility(geometry: Geometry) -> &'static str {
    match geometry {
        Geometry::SmithCorrelated => "lobe/visibility_smith_correlated.wgsl",
        Geometry::SmithSeparable => "lobe/visibility_smith_separable.wgsl",
        Geometry::SchlickHalfAlpha => "lobe/visibility_schlick_half_alpha.wgsl",
        Geometry::SchlickKaris => "lobe/visibility_schlick_karis.wgsl",
        Geometry::SchlickLecture => "lobe/visibility_schlick_lecture.wgsl",
    }
}

fn visibility_anisotropic(geometry: Geometry) -> &'static str {
    match geometry {
        Geometry::SmithCorrelated => "lobe/visibility_anisotropic_smith_correlated.wgsl",
        Geometry::SmithSeparable => "lobe/visibility_anisotropic_smith_separable.wgsl",
        _ => "lighting/visibility_anisotropic_mean.wgsl",
    }
}

/// How the panorama is seen behind the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Backdrop {
    Sharp,
    /// Through a lobe of its prefiltered maps.
    Blurred,
}

/// The panorama behind the scene, into radiance.
pub fn background_module(sources: &ShaderSources, backdrop: Backdrop) -> Result<Composed, ShaderError> {
    background_module_into(sources, backdrop, TargetLight::Radiance)
}

/// The same into what a target holds.
pub fn background_module_into(
    sources: &ShaderSources,
    backdrop: Backdrop,
    light: TargetLight,
) -> Result<Composed, ShaderError> {
    let mut slots = target_slots(light, "background");
    let file = match backdrop {
        Backdrop::Sharp => "background/sharp.wgsl",
        Backdrop::Blurred => "background/blurred.wgsl",
    };
    slots.insert("backdrop", Slot::File(file));
    slots.insert("types", Slot::Text(types::wgsl()));
    compose(sources, "pass/background.wgsl", &slots)
}

/// Finished pictures to a window.
pub fn present_module(sources: &ShaderSources) -> Result<Composed, ShaderError> {
    compose(sources, "pass/present.wgsl", &Slots::from([("types", Slot::Text(types::wgsl()))]))
}

/// What chooses the display shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DisplayFeatures {
    pub tone_map: ToneMap,
    /// Whether the shader applies the sRGB transfer, because the target format does not.
    pub encode_srgb: bool,
}

/// Scene radiance to display values.
pub fn display_module(sources: &ShaderSources, features: DisplayFeatures) -> Result<Composed, ShaderError> {
    let mut slots = display_slots(features);
    slots.insert("types", Slot::Text(types::wgsl()));
    compose(sources, "pass/display.wgsl", &slots)
}

fn display_slots(features: DisplayFeatures) -> Slots {
    let tone_map = match features.tone_map {
        ToneMap::Neutral => "color/tone_map_neutral.wgsl",
        ToneMap::Aces => "color/tone_map_aces.wgsl",
        ToneMap::AgX => "color/tone_map_agx.wgsl",
        ToneMap::Reinhard => "color/tone_map_reinhard.wgsl",
        ToneMap::Linear | ToneMap::None => "color/tone_map_linear.wgsl",
    };
    let encode = if features.encode_srgb { "color/encode_srgb.wgsl" } else { "color/encode_linear.wgsl" };
    Slots::from([("tone_map", Slot::File(tone_map)), ("encode", Slot::File(encode))])
}
