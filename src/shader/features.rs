//! What a draw uses: the key of its shader. Numbers (light counts, sizes) are data and not part of it, but that of suns.

use crate::scene::{
    AlphaMode, Geometry, LightInWorld, MAX_SUNS, Material, MetalFresnel, Primitive, Quality, Sampler, Scene, Term,
    TextureRef, TextureSlot, Topology, UvTransform,
};
use std::fmt;

/// How one texture slot is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TextureUse {
    pub uv_set: u8,
    /// Index into the distinct samplers of the textures that are read.
    pub sampler: u8,
    /// Whether the coordinates are transformed at all.
    pub transformed: bool,
}

/// What becomes of the base colour's alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Alpha {
    Opaque,
    Mask,
    Blend,
}

/// What names of pipelines say about suns, by their number.
const SUN_FLAGS: [&str; MAX_SUNS + 1] = ["", "sun", "two_suns", "three_suns", "four_suns"];

/// Where the light comes from, for a whole scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SceneFeatures {
    pub punctual: bool,
    /// How lights are found, where there are any.
    pub light_list: LightList,
    pub environment: bool,
    /// Some metal's Fresnel curve is not Schlick's, so a table of the difference is bound.
    pub fresnel_tail: bool,
    /// How many suns, [`MAX_SUNS`] at most, come with the environment's maps, which do not hold them. Shaders name each, because software drivers
    /// take a loop over them at a high price (docs/performance.md, "Two paths from triangles to radiance").
    pub suns: u8,
}

/// The fewest lights with a range that are sorted into clusters: of so many, the loop over all takes longer where half of
/// them reach a pixel (docs/performance.md, "Many lights").
const CLUSTERED_FROM: usize = 16;
/// The most lights that are bound as a uniform, which software drivers read faster than a storage buffer.
pub const FEW_LIGHTS: usize = 64;

/// The most lights that shaders name one by one: llvmpipe takes a loop at the price of another light, and compiles and keeps a
/// shader anew for a number of turns that is a uniform (docs/performance.md, "Many lights").
const NAMED_LIGHTS: usize = 4;

/// How shaders find the punctual lights that reach a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LightList {
    /// So many that shine, 1 to 4, of [`FEW_LIGHTS`] at most.
    Named(u8),
    /// All of them, [`FEW_LIGHTS`] at most.
    Few,
    /// All of them.
    All,
    /// Those of the point's cluster of the view: every light has a range.
    Clustered,
    /// The same, after those that have no range.
    ClusteredAndUnbounded,
}

impl LightList {
    /// Of so many lights, of which so many shine, and of those so many have a range.
    fn of(lights: usize, lit: usize, with_range: usize) -> Self {
        match (with_range >= CLUSTERED_FROM, with_range == lit) {
            (true, true) => Self::Clustered,
            (true, false) => Self::ClusteredAndUnbounded,
            (false, _) if lights <= FEW_LIGHTS && (1..=NAMED_LIGHTS).contains(&lit) => Self::Named(lit as u8),
            (false, _) if lights <= FEW_LIGHTS => Self::Few,
            (false, _) => Self::All,
        }
    }

    /// What finds `wanted` lights in a scene where this has been found before: names suffice for fewer, the others are dark.
    pub(crate) fn kept_for(self, wanted: Self) -> Self {
        match (self, wanted) {
            (Self::Named(places), Self::Named(lights)) if lights <= places => self,
            _ => wanted,
        }
    }

    /// Whether the lights are a uniform, of [`FEW_LIGHTS`] places.
    pub fn is_uniform(self) -> bool {
        matches!(self, Self::Named(_) | Self::Few)
    }

    /// What names of pipelines say.
    fn flag(self) -> &'static str {
        match self {
            Self::Named(lights) => ["", "one", "two", "three", "four"][usize::from(lights).min(NAMED_LIGHTS)],
            Self::Few => "few",
            Self::All => "many",
            Self::Clustered | Self::ClusteredAndUnbounded => "clustered",
        }
    }

    /// Whether lights are sorted into clusters.
    pub fn is_clustered(self) -> bool {
        matches!(self, Self::Clustered | Self::ClusteredAndUnbounded)
    }
}

impl SceneFeatures {
    /// What `scene` says; `suns` is for its environment's maps to tell.
    pub fn of(scene: &Scene) -> Self {
        Self::lit_by(scene, &scene.lights_in_world())
    }

    /// The same, with the scene's lights where they are in the world.
    pub fn lit_by(scene: &Scene, lights: &[LightInWorld]) -> Self {
        let lit = || lights.iter().filter(|light| light.intensity != glam::DVec3::ZERO);
        let with_range = lit().filter(|light| light.finite_range_m().is_some()).count();
        Self {
            suns: 0,
            punctual: lit().next().is_some(),
            light_list: LightList::of(lights.len(), lit().count(), with_range),
            environment: scene.lit_environment().is_some(),
            fresnel_tail: scene
                .materials
                .iter()
                .any(|material| FresnelFeature::of(material) != FresnelFeature::Schlick),
        }
    }

    /// Whether any light falls on surfaces.
    pub fn is_lit(self) -> bool {
        self.punctual || self.environment
    }
}

/// How the surface answers light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Shading {
    /// The standard lobes of docs/model.md.
    Lit,
    /// The lobes of docs/disney.md.
    Disney,
    /// The scene has no light: only emission shows.
    EmissiveOnly,
    Unlit,
}

/// The Fresnel curve of the metal part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FresnelFeature {
    Schlick,
    Lazanyi,
    Conductor,
}

impl FresnelFeature {
    fn of(material: &Material) -> Self {
        match material.metal_fresnel {
            _ if material.metallic == 0.0 || material.unlit || material.disney.is_some() => Self::Schlick,
            MetalFresnel::Schlick => Self::Schlick,
            MetalFresnel::Lazanyi { .. } => Self::Lazanyi,
            MetalFresnel::Conductor { .. } => Self::Conductor,
        }
    }
}

impl Shading {
    /// Whether light is evaluated.
    pub fn is_lit(self) -> bool {
        matches!(self, Self::Lit | Self::Disney)
    }
}

/// What the pixels of a draw read and do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialFeatures {
    pub shading: Shading,
    pub alpha: Alpha,
    pub double_sided: bool,
    /// Microfacets are spread along the tangent (KHR_materials_anisotropy).
    pub anisotropic: bool,
    pub fresnel: FresnelFeature,
    /// The Disney highlight has a direction along the surface, and the primitive has tangents to tell it.
    pub disney_anisotropic: bool,
    pub emissive: bool,
    /// The dielectric part has a weight or a tint (KHR_materials_specular).
    pub specular: bool,
    /// The table of the Disney lobes' albedos is read.
    pub disney_table: bool,
    /// Occlusion is in R of the metallic-roughness texture, which is the occlusion texture too or has been packed with it.
    pub packed_occlusion: bool,
    textures: [Option<TextureUse>; TextureSlot::ALL.len()],
}

impl MaterialFeatures {
    /// Only what can change a pixel: an unlit material reads no normal map, an opaque one in the dark no base colour.
    pub fn of(material: &Material, primitive: &Primitive, scene: &Scene, light: SceneFeatures) -> Self {
        let shading = if material.unlit || primitive.normals.is_none() {
            Shading::Unlit
        } else if !light.is_lit() {
            Shading::EmissiveOnly
        } else if material.disney.is_some() {
            Shading::Disney
        } else {
            Shading::Lit
        };
        let alpha = match material.alpha_mode {
            AlphaMode::Opaque => Alpha::Opaque,
            AlphaMode::Mask { .. } => Alpha::Mask,
            AlphaMode::Blend => Alpha::Blend,
        };
        let mut samplers: Vec<Sampler> = Vec::new();
        let lit = shading == Shading::Lit;
        let disney = material.disney.filter(|_| shading == Shading::Disney);
        let mut features = Self {
            shading,
            alpha,
            double_sided: material.double_sided,
            anisotropic: lit && material.anisotropy_strength > 0.0 && primitive.tangents.is_some(),
            fresnel: if lit { FresnelFeature::of(material) } else { FresnelFeature::Schlick },
            disney_anisotropic: disney.is_some_and(|d| d.anisotropic > 0.0) && primitive.tangents.is_some(),
            disney_table: disney.is_some() && light.environment,
            emissive: shading != Shading::Unlit && material.emissive_nits != glam::Vec3::ZERO,
            specular: lit && (material.specular, material.specular_color) != (1.0, glam::Vec3::ONE),
            packed_occlusion: false,
            textures: [None; _],
        };
        for (slot, texture) in material.textures() {
            if !features.reads(slot, material, primitive) {
                continue;
            }
            let sampler = scene.textures[texture.texture].sampler;
            let index = samplers.iter().position(|&other| other == sampler).unwrap_or(samplers.len());
            if index == samplers.len() {
                samplers.push(sampler);
            }
            features.textures[slot as usize] = Some(TextureUse {
                uv_set: texture.uv_set as u8,
                sampler: index as u8,
                transformed: texture.transform != UvTransform::IDENTITY,
            });
        }
        let of_specular = |slot| features.texture(slot).is_some();
        features.specular |= [TextureSlot::Specular, TextureSlot::SpecularColor].into_iter().any(of_specular);
        features.pack_occlusion(material, scene);
        features
    }

    /// Leaves the occlusion texture out where one lookup gives both.
    fn pack_occlusion(&mut self, material: &Material, scene: &Scene) {
        let [occlusion, other] = [TextureSlot::Occlusion, TextureSlot::MetallicRoughness].map(|slot| {
            self.texture(slot)?;
            material.texture(slot)
        });
        if occlusion.zip(other).is_some_and(|(occlusion, other)| are_packable(occlusion, other, scene)) {
            self.textures[TextureSlot::Occlusion as usize] = None;
            self.packed_occlusion = true;
        }
    }

    /// What of the textures that the material samples the geometry and the light let through.
    fn reads(&self, slot: TextureSlot, material: &Material, primitive: &Primitive) -> bool {
        let reaches = match slot {
            TextureSlot::BaseColor => self.shading != Shading::EmissiveOnly || self.alpha != Alpha::Opaque,
            TextureSlot::Emissive => self.emissive,
            TextureSlot::Normal => self.shading.is_lit() && primitive.tangents.is_some(),
            TextureSlot::Anisotropy => self.anisotropic,
            TextureSlot::Specular | TextureSlot::SpecularColor => self.shading == Shading::Lit,
            TextureSlot::Occlusion | TextureSlot::MetallicRoughness => self.shading.is_lit(),
        };
        reaches && material.samples(slot)
    }

    pub fn texture(&self, slot: TextureSlot) -> Option<TextureUse> {
        self.textures[slot as usize]
    }

    /// Whether the environment's light is weakened by a texture.
    pub fn reads_occlusion(&self) -> bool {
        self.packed_occlusion || self.texture(TextureSlot::Occlusion).is_some()
    }

    /// Whether the specular lobe is the one that `bake::taps` was fitted for: GGX, the same in all directions.
    pub fn has_round_lobes(&self) -> bool {
        self.shading == Shading::Lit && !self.anisotropic
    }

    /// The texture slots that are sampled.
    pub fn textures(&self) -> impl Iterator<Item = (TextureSlot, TextureUse)> {
        TextureSlot::ALL.into_iter().filter_map(|slot| Some((slot, self.texture(slot)?)))
    }

    /// How many samplers are bound.
    pub fn sampler_count(&self) -> u32 {
        self.textures().map(|(_, texture)| u32::from(texture.sampler) + 1).max().unwrap_or(0)
    }
}

/// Whether two textures always read the same texel of images of one size, so that their channels can share one image.
fn are_packable(a: &TextureRef, b: &TextureRef, scene: &Scene) -> bool {
    let [of_a, of_b] = [a, b].map(|reference| scene.textures[reference.texture]);
    let is_alike = || {
        let images = scene.images.get(of_a.image).zip(scene.images.get(of_b.image));
        images.is_some_and(|(a, b)| a.has_layout_of(b))
    };
    (a.uv_set, a.transform, of_a.sampler) == (b.uv_set, b.transform, of_b.sampler)
        && (of_a.image == of_b.image || is_alike())
}

/// The samplers that are bound, in the order of [`TextureUse::sampler`].
pub fn material_samplers(features: &MaterialFeatures, material: &Material, scene: &Scene) -> Vec<Sampler> {
    let mut samplers = Vec::new();
    for (slot, texture) in features.textures() {
        // Samplers are numbered as they are first met.
        if let (true, Some(source)) = (usize::from(texture.sampler) == samplers.len(), material.texture(slot)) {
            samplers.push(scene.textures[source.texture].sampler);
        }
    }
    samplers
}

/// The vertex attributes that a draw reads beside the position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct VertexFeatures {
    pub normal: bool,
    pub tangent: bool,
    pub color: bool,
    /// One bit a texture coordinate set.
    pub uv_sets: u8,
}

impl VertexFeatures {
    pub fn of(material: &MaterialFeatures, primitive: &Primitive) -> Self {
        let lit = material.shading.is_lit();
        let reads_color = material.shading != Shading::EmissiveOnly || material.alpha != Alpha::Opaque;
        Self {
            normal: lit,
            tangent: material.anisotropic
                || material.disney_anisotropic
                || material.texture(TextureSlot::Normal).is_some(),
            color: reads_color && primitive.colors.is_some(),
            uv_sets: material.textures().fold(0, |sets, (_, texture)| sets | 1 << texture.uv_set),
        }
    }

    pub fn uv_sets(&self) -> impl Iterator<Item = u32> + use<> {
        let sets = self.uv_sets;
        (0..8).filter(move |set| sets >> set & 1 == 1)
    }
}

/// Everything that chooses the forward shader of a draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ForwardFeatures {
    pub scene: SceneFeatures,
    pub material: MaterialFeatures,
    pub vertex: VertexFeatures,
    pub energy_compensation: bool,
    pub geometry: Geometry,
    pub quality: Quality,
    /// The only part of the radiance that is evaluated.
    pub term: Option<Term>,
    pub topology: Topology,
    /// A channel of the surface is drawn in place of its radiance; which one is data.
    pub channel: bool,
}

impl ForwardFeatures {
    /// How the environment is reflected.
    pub fn reflection(&self) -> Quality {
        let reflects = self.material.shading.is_lit() && self.scene.environment;
        if reflects { self.quality } else { Quality::SplitSum }
    }

    /// Whether the table of `bake::taps` is read.
    pub fn reads_taps(&self) -> bool {
        self.reflection() != Quality::SplitSum && self.material.has_round_lobes()
    }

    /// Topology changes no code, so modules are shared across it.
    pub fn module_key(mut self) -> Self {
        self.topology = Topology::Triangles;
        self
    }
}

impl fmt::Display for ForwardFeatures {
    /// A name such as `lit+environment+base_color+normal+mask`, for labels, reports and dumped files.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = vec![match self.material.shading {
            Shading::Lit => "lit",
            Shading::Disney => "disney",
            Shading::EmissiveOnly => "dark",
            Shading::Unlit => "unlit",
        }];
        let lit = self.material.shading.is_lit();
        let flags = [
            (lit && self.scene.punctual, "punctual"),
            (lit && self.scene.punctual, self.scene.light_list.flag()),
            (lit && self.scene.light_list == LightList::ClusteredAndUnbounded, "unbounded"),
            (lit && self.scene.environment, "environment"),
            (lit && !self.energy_compensation, "single_scatter"),
            (lit && self.scene.suns > 0, SUN_FLAGS[usize::from(self.scene.suns).min(MAX_SUNS)]),
            (self.reflection() != Quality::SplitSum, self.quality.name()),
            (self.material.anisotropic, "anisotropic"),
            (self.material.fresnel == FresnelFeature::Lazanyi, "lazanyi"),
            (self.material.fresnel == FresnelFeature::Conductor, "conductor"),
            (lit && self.geometry != Geometry::SmithCorrelated, self.geometry.name()),
            (self.vertex.color, "vertex_color"),
            (self.material.emissive, "emissive_factor"),
            (self.material.specular, "specular_factors"),
            (self.material.packed_occlusion, "packed_occlusion"),
            (self.material.alpha == Alpha::Mask, "mask"),
            (self.material.alpha == Alpha::Blend, "blend"),
            (self.material.double_sided, "double_sided"),
            (self.channel, "channel"),
        ];
        parts.extend(flags.into_iter().filter(|(on, _)| *on).map(|(_, name)| name));
        f.write_str(&parts.join("+"))?;
        if let Some(term) = self.term {
            write!(f, "+only_{}", term.name().replace(' ', "_"))?;
        }
        for (slot, texture) in self.material.textures() {
            write!(f, "+{}", slot.name())?;
            if texture.uv_set > 0 || texture.sampler > 0 || texture.transformed {
                let transformed = if texture.transformed { "t" } else { "" };
                write!(f, ".{}{}{transformed}", texture.uv_set, texture.sampler)?;
            }
        }
        match self.topology {
            Topology::Triangles => Ok(()),
            Topology::Lines => f.write_str("+lines"),
            Topology::Points => f.write_str("+points"),
        }
    }
}
