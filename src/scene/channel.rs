//! What the pixels of a picture can show instead of the light that reaches the eye.

/// What shading knows of a visible point before any light falls on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Input {
    /// Linear Rec.709, in [0, 1].
    BaseColor,
    /// In [0, 1].
    Metallic,
    /// In [0, 1].
    PerceptualRoughness,
    /// Alpha of the microfacets along the tangent and across it.
    Alphas,
    /// Reflectance at normal incidence, dielectric and metal mixed, in [0, 1].
    F0,
    /// Scale of the environment's light, in [0, 1].
    Occlusion,
    /// cd/m2.
    Emissive,
    /// Of the base colour: what covers.
    Alpha,
    /// Unit shading normal in the world, normal map included, turned round on the back of a double-sided surface.
    Normal,
    /// The same without the normal map.
    VertexNormal,
    /// Unit normal of the triangle in the world, on the side of the viewer.
    GeometricNormal,
    /// Unit vector in the world along which microfacets are spread, or along which a texture's u grows; zero where there
    /// is none.
    Tangent,
    /// The first set of texture coordinates that the material reads.
    Uv,
    /// Metres, relative to the centre of the scene.
    Position,
    /// z and w in clip space.
    Depth,
    /// Cosine between the normal and the viewer, once that is lifted above the horizon.
    NoV,
}

impl Input {
    /// In the order of the numbers that shaders know them by.
    pub const ALL: [Self; 16] = [
        Self::BaseColor,
        Self::Metallic,
        Self::PerceptualRoughness,
        Self::Alphas,
        Self::F0,
        Self::Occlusion,
        Self::Emissive,
        Self::Alpha,
        Self::Normal,
        Self::VertexNormal,
        Self::GeometricNormal,
        Self::Tangent,
        Self::Uv,
        Self::Position,
        Self::Depth,
        Self::NoV,
    ];

    /// The name in reports and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::BaseColor => "base-color",
            Self::Metallic => "metallic",
            Self::PerceptualRoughness => "perceptual-roughness",
            Self::Alphas => "alphas",
            Self::F0 => "f0",
            Self::Occlusion => "occlusion",
            Self::Emissive => "emissive",
            Self::Alpha => "alpha",
            Self::Normal => "normal",
            Self::VertexNormal => "vertex-normal",
            Self::GeometricNormal => "geometric-normal",
            Self::Tangent => "tangent",
            Self::Uv => "uv",
            Self::Position => "position",
            Self::Depth => "depth",
            Self::NoV => "nov",
        }
    }
}

/// A component of a BRDF. Materials of glTF have the first three, Disney materials the others but multiple scattering.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Component {
    Diffuse,
    /// Light that was mirrored at one microfacet.
    Specular,
    /// What single scattering loses and energy compensation gives back.
    MultipleScattering,
    Sheen,
    Clearcoat,
}

impl Component {
    pub const ALL: [Self; 5] = [Self::Diffuse, Self::Specular, Self::MultipleScattering, Self::Sheen, Self::Clearcoat];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Diffuse => "diffuse",
            Self::Specular => "specular",
            Self::MultipleScattering => "multiple scattering",
            Self::Sheen => "sheen",
            Self::Clearcoat => "clearcoat",
        }
    }
}

/// A set of components.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Components(u32);

impl Components {
    /// Light that enters the surface, or a cloth's fibres.
    pub const DIFFUSE: Self = Self::of(&[Component::Diffuse, Component::Sheen]);
    /// Light that is mirrored, however often.
    pub const SPECULAR: Self = Self::of(&[Component::Specular, Component::MultipleScattering, Component::Clearcoat]);
    pub const ALL: Self = Self::of(&Component::ALL);

    pub const fn of(parts: &[Component]) -> Self {
        let (mut bits, mut i) = (0, 0);
        while i < parts.len() {
            bits |= 1 << parts[i] as u32;
            i += 1;
        }
        Self(bits)
    }

    pub fn contains(self, component: Component) -> bool {
        self.0 >> component as u32 & 1 == 1
    }

    /// One bit each, in the order of [`Component::ALL`].
    pub fn bits(self) -> u32 {
        self.0
    }
}

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LightSource {
    /// All point, spot and directional lights.
    Punctual,
    /// One of them, in the order of [`super::Scene::lights_in_world`].
    Light(u32),
    /// All of the environment.
    Environment,
    /// The environment without the suns that its maps were parted from.
    Sky,
    /// One of those suns.
    Sun(u32),
}

/// What a pixel shows instead of the light that reaches the eye: of the nearest surface, and nothing where none is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Channel {
    Input(Input),
    /// Radiance toward the eye that comes from `source` by way of `components`, cd/m2.
    Radiance {
        source: LightSource,
        components: Components,
    },
    /// How many punctual lights are looked at for the surface: those that its place in the view lists, whether or not they
    /// reach it.
    LightCount,
    /// A chequered pattern over the first set of texture coordinates that the material reads, colours in [0, 1]: eight
    /// squares to a unit, each with a hue of its place. Grey where no set is read.
    UvChecker,
    /// The share of light, in [0, 1] if nothing is gained, that the surface returns to the eye where the same radiance comes
    /// from everywhere and nothing else shines: what its lobes, their lookups of the environment and its occlusion leave of
    /// it. Zero on unlit surfaces. The scene needs an environment, whichever: surfaces that nothing lights have no lobes.
    Furnace,
    /// How many surfaces are drawn over each other, hidden ones too: what would be shaded if nothing was sorted or tested.
    Overdraw,
    /// 1 on the edges of triangles that no surface hides, on lines and on points; 0 between them.
    Wireframe,
    /// Faults of the radiance before it is clamped: red is 1 where it is no number, green where it is infinite, blue
    /// where it is negative.
    Nan,
    /// A whole number below 2^32 in three digits that half floats hold exactly, see [`from_digits`].
    Digits(Number),
}

/// A whole number that is known of the nearest surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Number {
    /// Its place in the frame's list of instances that are drawn.
    Placement,
    /// The bits of its depth, z / w in clip space as float32.
    DepthBits,
}

/// The number that digits of base 2048 stand for, the least first, as [`Channel::Digits`] shows it.
pub fn from_digits(digits: glam::Vec3) -> u32 {
    let [low, middle, high] = digits.to_array().map(|digit| digit as u32);
    low | middle << 11 | high << 22
}

impl Channel {
    /// All that have a name.
    pub fn named() -> impl Iterator<Item = (&'static str, Self)> {
        use LightSource::{Environment, Punctual};
        let radiance = |name, source, components| (name, Self::Radiance { source, components });
        let light = [
            radiance("direct-diffuse", Punctual, Components::DIFFUSE),
            radiance("direct-specular", Punctual, Components::SPECULAR),
            radiance("ibl-diffuse", Environment, Components::DIFFUSE),
            radiance("ibl-specular", Environment, Components::SPECULAR),
            ("light-count", Self::LightCount),
            ("uv-checker", Self::UvChecker),
            ("furnace", Self::Furnace),
            ("overdraw", Self::Overdraw),
            ("wireframe", Self::Wireframe),
            ("nan", Self::Nan),
        ];
        Input::ALL.into_iter().map(|input| (input.name(), Self::Input(input))).chain(light)
    }

    /// The channel of a name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::named().find(|(other, _)| *other == name).map(|(_, channel)| channel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_channel_has_a_name_of_its_own() {
        let names: BTreeSet<_> = Channel::named().map(|(name, _)| name).collect();
        assert_eq!(names.len(), Input::ALL.len() + 10);
        assert!(Channel::named().all(|(name, channel)| Channel::by_name(name) == Some(channel)));
        assert_eq!(Channel::by_name("radiance"), None);
    }

    #[test]
    fn a_component_is_either_diffuse_or_specular() {
        assert_eq!(Components::DIFFUSE.bits() & Components::SPECULAR.bits(), 0);
        assert_eq!(Components::DIFFUSE.bits() | Components::SPECULAR.bits(), Components::ALL.bits());
        assert!(Input::ALL.iter().zip(0..).all(|(input, number)| *input as usize == number));
    }
}
