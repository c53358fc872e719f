//! What a ray sees where it hits: interpolated attributes, textures, the shading normal.

mod details;

pub use details::Details;

use super::bsdf::{Anisotropy, SurfaceMaterial, dielectric_reflectance};
use super::geometry::{Draw, Geometry, Hit, Ray};
use super::texture::Textures;
use crate::math::spaces::orthonormal_basis;
use crate::scene::{AlphaMode, Disney, Material, Scene, TextureSlot, Topology, View};
use glam::{DVec2, DVec3, DVec4, Vec4Swizzles};

/// A visible point, ready for light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    pub position_in_world: DVec3,
    /// Unit shading normal, normal map included; turned round on the back of a double-sided surface.
    pub normal_in_world: DVec3,
    /// Interpolated tangent, of any length and not yet across the normal; zero where the primitive has none.
    pub tangent_in_world: DVec3,
    pub material: SurfaceMaterial,
    /// The rest of the material if it is a Disney one.
    pub disney: Option<Disney>,
    /// cd/m2.
    pub emissive_nits: DVec3,
    /// Scale of the environment's light, in [0, 1].
    pub occlusion: f64,
    /// The base colour is the radiance.
    pub unlit: bool,
}

/// A point along a ray and how much of what lies behind it covers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    pub hit: Hit,
    /// In (0, 1].
    pub alpha: f64,
}

/// A scene that can be looked into.
#[derive(Debug)]
pub struct World<'a> {
    pub geometry: Geometry<'a>,
    textures: Textures<'a>,
}

impl<'a> World<'a> {
    /// `view` gives points and lines their width.
    pub fn new(scene: &'a Scene, view: &View) -> Self {
        Self { geometry: Geometry::new(scene, view), textures: Textures::new(scene) }
    }

    /// Everything the ray sees, front to back, up to the first opaque surface.
    pub fn layers(&self, ray: &Ray) -> Vec<Layer> {
        let mut layers: Vec<Layer> = Vec::new();
        let mut nearest_opaque = f64::INFINITY;
        self.geometry.visit_hits(ray, |hit| {
            let alpha = self.alpha(&hit);
            if alpha <= 0.0 || hit.t > nearest_opaque {
                return None;
            }
            layers.push(Layer { hit, alpha });
            (alpha >= 1.0).then(|| {
                nearest_opaque = hit.t;
                hit.t
            })
        });
        // The order of triangles decides between surfaces at the same place, whatever the order of traversal.
        layers.sort_by(|a, b| a.hit.t.total_cmp(&b.hit.t).then(a.hit.triangle.cmp(&b.hit.triangle)));
        let visible = layers.iter().position(|layer| layer.alpha >= 1.0).map_or(layers.len(), |first| first + 1);
        layers.truncate(visible);
        layers
    }

    /// Share of light that passes along the ray, in [0, 1]. Surfaces are where a viewer on the ray would see them.
    pub fn transmittance(&self, ray: &Ray) -> f64 {
        let mut transmittance = 1.0;
        self.geometry.visit_hits(ray, |hit| {
            transmittance *= 1.0 - self.alpha(&hit);
            // Nothing is left to be found.
            (transmittance <= 0.0).then_some(ray.t_min)
        });
        transmittance
    }

    /// The surface that one photon along the ray meets: `u` in (0, 1) decides at blended ones.
    pub fn meets(&self, ray: &Ray, mut u: f64) -> Option<Hit> {
        for layer in self.layers(ray) {
            if u < layer.alpha {
                return Some(layer.hit);
            }
            u = (u - layer.alpha) / (1.0 - layer.alpha);
        }
        None
    }

    /// Unit normal of the triangle, on the side that the ray comes from. `None` for points and lines, which are round.
    pub fn facet_normal(&self, hit: &Hit, ray: &Ray) -> Option<DVec3> {
        let is_area = self.geometry.draw(hit).primitive.topology == Topology::Triangles;
        let normal = self.geometry.triangles[hit.triangle].normal().try_normalize().filter(|_| is_area)?;
        Some(if normal.dot(ray.direction) > 0.0 { -normal } else { normal })
    }

    /// Coverage of a hit, as its material's alpha mode has it, in [0, 1].
    fn alpha(&self, hit: &Hit) -> f64 {
        let point = self.point(hit);
        match point.material().alpha_mode {
            AlphaMode::Opaque => 1.0,
            AlphaMode::Mask { cutoff } => f64::from(u8::from(point.base_color().w >= f64::from(cutoff))),
            AlphaMode::Blend => point.base_color().w.clamp(0.0, 1.0),
        }
    }

    /// The surface at a hit.
    pub fn surface(&self, hit: &Hit) -> Surface {
        let point = self.point(hit);
        let material = point.material();
        let metallic_roughness = point.texture(TextureSlot::MetallicRoughness);
        let occlusion = point.texture(TextureSlot::Occlusion).x;
        let emissive = point.texture(TextureSlot::Emissive).xyz();
        let (dielectric_f0, dielectric_f90) = point.dielectric_reflectance();
        Surface {
            position_in_world: point.interpolate_corners(),
            normal_in_world: point.shading_normal(),
            tangent_in_world: point.tangent().map_or(DVec3::ZERO, |(tangent, _)| tangent),
            disney: material.disney,
            material: SurfaceMaterial {
                base_color: point.base_color().xyz().clamp(DVec3::ZERO, DVec3::ONE),
                metallic: (f64::from(material.metallic) * metallic_roughness.z).clamp(0.0, 1.0),
                perceptual_roughness: (f64::from(material.perceptual_roughness) * metallic_roughness.y).clamp(0.0, 1.0),
                dielectric_f0,
                dielectric_f90,
                metal_fresnel: material.metal_fresnel,
                anisotropy: point.anisotropy(),
            },
            emissive_nits: material.emissive_nits.as_dvec3() * emissive,
            occlusion: 1.0 + f64::from(material.occlusion_strength) * (occlusion - 1.0),
            unlit: material.unlit || point.draw.primitive.normals.is_none(),
        }
    }

    fn point<'w>(&'w self, hit: &'w Hit) -> Point<'w> {
        Point { world: self, draw: self.geometry.draw(hit), hit }
    }
}

/// A hit with what is needed to look up its attributes.
struct Point<'w> {
    world: &'w World<'w>,
    draw: &'w Draw<'w>,
    hit: &'w Hit,
}

impl Point<'_> {
    fn material(&self) -> &Material {
        self.draw.material
    }

    fn triangle(&self) -> &super::geometry::Triangle {
        &self.world.geometry.triangles[self.hit.triangle]
    }

    /// The sum of a vertex attribute, weighted with the barycentric coordinates.
    fn interpolate<T>(&self, attribute: impl Fn(usize) -> T) -> T
    where
        T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
    {
        let [a, b, c] = self.triangle().vertices.map(|vertex| attribute(vertex as usize));
        let weights = self.hit.barycentric;
        a * weights.x + b * weights.y + c * weights.z
    }

    fn interpolate_corners(&self) -> DVec3 {
        let [a, b, c] = self.triangle().corners;
        let weights = self.hit.barycentric;
        a * weights.x + b * weights.y + c * weights.z
    }

    /// RGBA of a slot; 1 where it has no texture.
    fn texture(&self, slot: TextureSlot) -> DVec4 {
        let Some(texture) = self.material().texture(slot) else { return DVec4::ONE };
        let Some(uvs) = self.draw.primitive.uvs.get(texture.uv_set as usize) else { return DVec4::ONE };
        let uv: DVec2 = self.interpolate(|vertex| uvs[vertex].as_dvec2());
        self.world.textures.sample(slot, texture, uv)
    }

    fn base_color(&self) -> DVec4 {
        let vertex_color = match &self.draw.primitive.colors {
            Some(colors) => self.interpolate(|vertex| colors[vertex].as_dvec4()),
            None => DVec4::ONE,
        };
        self.material().base_color.as_dvec4() * vertex_color * self.texture(TextureSlot::BaseColor)
    }

    /// F0 and F90 of the dielectric (KHR_materials_ior, KHR_materials_specular).
    fn dielectric_reflectance(&self) -> (DVec3, f64) {
        let material = self.material();
        let ior = f64::from(material.ior);
        let weight = (f64::from(material.specular) * self.texture(TextureSlot::Specular).w).clamp(0.0, 1.0);
        let tint = material.specular_color.as_dvec3() * self.texture(TextureSlot::SpecularColor).xyz();
        dielectric_reflectance(ior, weight, tint)
    }

    /// The shading normal on the side of the viewer.
    fn shading_normal(&self) -> DVec3 {
        self.facing_viewer(self.front_normal())
    }

    /// A normal of the front side, turned round where the back is seen.
    fn facing_viewer(&self, normal: DVec3) -> DVec3 {
        let is_area = self.draw.primitive.topology == Topology::Triangles;
        if is_area && !self.hit.front { -normal } else { normal }
    }

    /// The shading normal of the front side.
    fn front_normal(&self) -> DVec3 {
        let (interpolated, smooth) = self.vertex_normal();
        interpolated.and_then(|normal| self.mapped_normal(normal)).unwrap_or(smooth)
    }

    /// The interpolated normal, of any length and where there is one, and the unit vector that it comes to.
    fn vertex_normal(&self) -> (Option<DVec3>, DVec3) {
        let geometric = self.triangle().normal().normalize_or(DVec3::Y) * self.draw.handedness;
        let Some(normals) = &self.draw.primitive.normals else { return (None, geometric) };
        // Unit vectors at the vertices, and no longer so in between: what MikkTSpace's bakers assume.
        let normal =
            self.interpolate(|vertex| (self.draw.normal_from_object * normals[vertex].as_dvec3()).normalize_or_zero());
        (Some(normal), normal.normalize_or(geometric))
    }

    /// The interpolated tangent and the sign of the bitangent. A mirrored instance mirrors the bitangent, which a cross
    /// product of mirrored vectors does not.
    fn tangent(&self) -> Option<(DVec3, f64)> {
        let tangents = self.draw.primitive.tangents.as_ref()?;
        let tangent = self.interpolate(|vertex| {
            (self.draw.world_from_object * tangents[vertex].truncate().as_dvec3()).normalize_or_zero()
        });
        // The sign is the same at all vertices of a triangle.
        let sign = f64::from(tangents[self.triangle().vertices[0] as usize].w) * self.draw.handedness;
        Some((tangent, sign))
    }

    /// KHR_materials_anisotropy: a direction in tangent space and a strength, the direction turned by the material's
    /// rotation.
    fn anisotropy(&self) -> Option<Anisotropy> {
        let material = self.material();
        if material.anisotropy_strength <= 0.0 {
            return None;
        }
        let (tangent, sign) = self.tangent()?;
        let normal = self.front_normal();
        let along = (tangent - normal * normal.dot(tangent)).normalize_or(orthonormal_basis(normal).0);
        let across = normal.cross(along) * sign;
        let (direction, strength) = match material.texture(TextureSlot::Anisotropy) {
            Some(_) => {
                let texel = self.texture(TextureSlot::Anisotropy);
                (texel.xy() * 2.0 - 1.0, texel.z)
            }
            None => (DVec2::X, 1.0),
        };
        let direction = DVec2::from_angle(f64::from(material.anisotropy_rotation_rad)).rotate(direction);
        let tangent = (along * direction.x + across * direction.y).try_normalize().unwrap_or(along);
        Some(Anisotropy {
            tangent,
            bitangent: normal.cross(tangent),
            strength: f64::from(material.anisotropy_strength) * strength,
        })
    }

    /// The normal map's normal in the frame of tangent, bitangent and `normal`, none of which is normalised
    /// (Mikkelsen 2008; glTF 2.0, 3.9.3). `None` without a normal map, or where the frame collapses.
    fn mapped_normal(&self, normal: DVec3) -> Option<DVec3> {
        self.material().texture(TextureSlot::Normal)?;
        let (tangent, sign) = self.tangent()?;
        let bitangent = normal.cross(tangent) * sign;
        let scale = f64::from(self.material().normal_scale);
        let local = (self.texture(TextureSlot::Normal).xyz() * 2.0 - 1.0) * DVec3::new(scale, scale, 1.0);
        (tangent * local.x + bitangent * local.y + normal * local.z).try_normalize()
    }
}
