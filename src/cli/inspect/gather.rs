//! Both renderers asked about one pixel.

use super::rows::{Channels, Group, Row};
use super::shaders::Shaders;
use crate::capture::CapturedPixel;
use crate::cli::error::CliError;
use crate::reference::color::{display, exposure_scale, to_srgb8, tone_map};
use crate::reference::geometry::Ray;
use crate::reference::inspect::{Inspector, Leaving};
use crate::reference::surface::{Details, Layer};
use crate::scene::{
    Channel, Component, Components, Disney, Input, LightKind, LightSource, RadianceImage, Scene, Topology, View,
};
use glam::{DVec3, DVec4, UVec2};

/// What is known of a pixel.
pub(super) struct Explained {
    pub(super) pixel: UVec2,
    /// Who drew the GPU's values.
    pub(super) adapter: Option<String>,
    pub(super) ray: Ray,
    /// The nearest surface; `None` where the background is seen.
    pub(super) hit: Option<Seen>,
    /// Everything that the pixel shows, front to back.
    pub(super) layers: Vec<Seen>,
    pub(super) rows: Vec<Row>,
    pub(super) notes: Vec<String>,
}

/// A surface along the ray.
#[derive(Clone)]
pub(super) struct Seen {
    pub(super) layer: Layer,
    pub(super) details: Details,
    pub(super) node: String,
    pub(super) mesh: String,
    pub(super) material: String,
    /// What it sends to the eye, cd/m2, by the reference.
    pub(super) radiance: DVec3,
}

/// Rows in the order in which they are reported.
struct Gatherer<'a> {
    scene: &'a Scene,
    view: &'a View,
    inspector: Inspector<'a>,
    shaders: Option<Shaders<'a>>,
    rows: Vec<Row>,
}

/// Asks both renderers, the reference with `samples` of each technique.
pub(super) fn explain(
    scene: &Scene,
    view: &View,
    pixel: UVec2,
    samples: u32,
    shaders: Option<Shaders<'_>>,
) -> Result<Explained, CliError> {
    let inspector = Inspector::new(scene, view);
    let adapter = shaders.as_ref().map(Shaders::description);
    let mut gatherer = Gatherer { scene, view, inspector, shaders, rows: Vec::new() };
    let (ray, layers) = gatherer.inspector.layers(pixel);
    let (mut seen, mut sent) = (Vec::new(), Vec::new());
    for layer in layers {
        let details = gatherer.inspector.details(&layer.hit, &ray);
        let leaving = gatherer.inspector.leaving(&details.surface, &ray, samples);
        seen.push(gatherer.seen(layer, details, leaving.sum()));
        sent.push((layer.alpha, leaving));
    }
    if let (Some(front), Some((_, leaving))) = (seen.first(), sent.first()) {
        gatherer.inputs(front, &ray)?;
        gatherer.light(front, leaving)?;
    }
    let layers: Vec<(f64, DVec3)> = sent.iter().map(|(alpha, leaving)| (*alpha, leaving.sum())).collect();
    let picture = gatherer.shaders.as_mut().map(Shaders::picture).transpose()?;
    gatherer.shown(&layers, &ray, picture);
    let mut notes = notes(scene, seen.first(), &gatherer.rows);
    let covered = picture.map(|picture| picture.radiance.w > 0.0);
    let is_background = seen.is_empty() && view.background != crate::scene::Background::Environment;
    if (covered == Some(false) && !seen.is_empty()) || (covered == Some(true) && is_background) {
        notes.push("the rasteriser and the ray do not see the same surface: the pixel's middle lies on an edge".into());
    }
    Ok(Explained { pixel, adapter, ray, hit: seen.first().cloned(), layers: seen, rows: gatherer.rows, notes })
}

impl Gatherer<'_> {
    fn seen(&self, layer: Layer, details: Details, radiance: DVec3) -> Seen {
        let name = |name: &Option<String>| name.clone().unwrap_or_else(|| "unnamed".into());
        Seen {
            node: name(&self.scene.nodes[details.node].name),
            mesh: name(&self.scene.meshes[details.mesh].name),
            material: name(&self.scene.materials[details.material].name),
            layer,
            details,
            radiance,
        }
    }

    /// Adds an input; `reference` has as many channels as are of interest.
    fn input(&mut self, name: &str, input: Input, reference: Option<Vec<f64>>, of: &Details) -> Result<(), CliError> {
        let place = (of.mesh, of.primitive);
        let gpu = self.shaders.as_mut().map(|shaders| shaders.input(input, place)).transpose()?.flatten();
        let count = reference.as_ref().map_or(3, Vec::len);
        let gpu = gpu.map(|value| value.to_array()[..count].to_vec());
        if gpu.is_some() || reference.is_some() {
            self.rows.push(Row::new(Group::Input, name, gpu, reference));
        }
        Ok(())
    }

    fn inputs(&mut self, seen: &Seen, ray: &Ray) -> Result<(), CliError> {
        let details = &seen.details;
        let (surface, material) = (&details.surface, &details.surface.material);
        let inputs = self.inspector.inputs(surface, ray);
        let set = self.shaders.as_ref().and_then(|shaders| shaders.uv_set((details.mesh, details.primitive)));
        let uv = self.inspector.uv(&seen.layer.hit, set.unwrap_or(0));
        let lit = !surface.unlit;
        let has_tangent = lit && surface.tangent_in_world != DVec3::ZERO;
        let list = [
            ("position, m", Input::Position, Some(surface.position_in_world.channels())),
            ("texture coordinates", Input::Uv, uv.map(Channels::channels)),
            ("base colour", Input::BaseColor, Some(material.base_color.channels())),
            ("alpha (coverage)", Input::Alpha, Some(details.base_color_alpha.channels())),
            ("metallic", Input::Metallic, lit.then(|| material.metallic.channels())),
            ("perceptual roughness", Input::PerceptualRoughness, lit.then(|| material.perceptual_roughness.channels())),
            ("alpha of facets: along, across", Input::Alphas, lit.then(|| inputs.alphas.channels())),
            ("F0", Input::F0, lit.then(|| inputs.f0.channels())),
            ("occlusion", Input::Occlusion, lit.then(|| surface.occlusion.channels())),
            ("emissive, cd/m2", Input::Emissive, lit.then(|| surface.emissive_nits.channels())),
            (
                "normal of the triangle",
                Input::GeometricNormal,
                details.geometric_normal_in_world.map(Channels::channels),
            ),
            ("normal of the vertices", Input::VertexNormal, lit.then(|| details.vertex_normal_in_world.channels())),
            ("normal, mapped", Input::Normal, lit.then(|| surface.normal_in_world.channels())),
            ("tangent", Input::Tangent, has_tangent.then(|| inputs.tangent_in_world.channels())),
            ("N.V", Input::NoV, lit.then(|| inputs.n_dot_v.channels())),
        ];
        for (name, input, reference) in list {
            self.input(name, input, reference, details)?;
        }
        let constants = material.anisotropy.map(|anisotropy| ("anisotropy strength".to_owned(), anisotropy.strength));
        let disney = surface.disney.map(disney_parameters).unwrap_or_default();
        let constants = constants.into_iter().chain(disney);
        self.rows.extend(constants.map(|(name, value)| Row::new(Group::Input, name, None, Some(value.channels()))));
        Ok(())
    }

    fn light(&mut self, seen: &Seen, leaving: &Leaving) -> Result<(), CliError> {
        let surface = &seen.details.surface;
        let (first, components) = (self.rows.len(), components(surface.disney.is_some()));
        if !surface.unlit {
            for (index, (label, by_component)) in light_labels(self.scene).iter().zip(&leaving.lights).enumerate() {
                for component in components {
                    let name = format!("{label}: {}", component.name());
                    let gpu = self.radiance(LightSource::Light(index as u32), *component)?;
                    let reference = by_component[*component as usize].channels();
                    self.rows.push(Row::new(Group::Light, name, gpu, Some(reference)));
                }
            }
            if self.scene.environment.is_some() {
                for component in components {
                    let estimate = &leaving.environment;
                    let gpu = self.radiance(LightSource::Environment, *component)?;
                    let name = format!("environment: {}", component.name());
                    let reference = estimate.mean[*component as usize].channels();
                    let row = Row::new(Group::Light, name, gpu, Some(reference));
                    self.rows.push(row.with_standard_error(estimate.standard_error[*component as usize]));
                }
            }
        }
        let name = if surface.unlit { "unlit base colour" } else { "emissive" };
        let input = if surface.unlit { Input::BaseColor } else { Input::Emissive };
        let gpu = match &mut self.shaders {
            Some(shaders) => shaders.input(input, (seen.details.mesh, seen.details.primitive))?,
            None => None,
        };
        self.rows.push(Row::new(Group::Light, name, gpu.map(Channels::channels), Some(leaving.emitted.channels())));
        let sum = self.rows[first..].iter().try_fold(DVec3::ZERO, |sum, row| Some(sum + of_row(row.gpu.as_ref()?)));
        self.rows.push(Row::new(Group::Light, "sum", sum.map(Channels::channels), Some(leaving.sum().channels())));
        if !surface.unlit {
            self.suns(components)?;
        }
        Ok(())
    }

    /// What the environment's light consists of by the shaders. The reference integrates it whole: smooth surfaces see a
    /// part of each sun in the prefiltered maps, so that the shares of the two are a choice of the approximation.
    fn suns(&mut self, components: &[Component]) -> Result<(), CliError> {
        let suns = self.shaders.as_ref().map_or(0, |shaders| shaders.suns.len()) as u32;
        let sources = (0..suns).map(|index| (format!("of which sun {index}"), LightSource::Sun(index)));
        let sky = (suns > 0).then(|| ("of which the rest".to_owned(), LightSource::Sky));
        for (label, source) in sources.chain(sky) {
            for component in components {
                let gpu = self.radiance(source, *component)?;
                self.rows.push(Row::new(Group::Light, format!("{label}: {}", component.name()), gpu, None));
            }
        }
        Ok(())
    }

    fn radiance(&mut self, source: LightSource, component: Component) -> Result<Option<Vec<f64>>, CliError> {
        let channel = Channel::Radiance { source, components: Components::of(&[component]) };
        let value = self.shaders.as_mut().map(|shaders| shaders.channel(channel)).transpose()?;
        Ok(value.map(Channels::channels))
    }

    /// From radiance to the display.
    fn shown(&mut self, layers: &[(f64, DVec3)], ray: &Ray, picture: Option<CapturedPixel>) {
        let reference = self.inspector.composite(layers, ray);
        let gpu = picture.map(|picture| picture.radiance.as_dvec4());
        if layers.is_empty() && self.scene.environment.is_some() {
            let radiance = self.inspector.background(ray).channels();
            self.rows.push(Row::new(Group::Pixel, "environment along the ray, cd/m2", None, Some(radiance)));
        }
        let both = |name: &str, of: &dyn Fn(DVec4) -> DVec3| {
            Row::new(Group::Pixel, name, gpu.map(|pixel| of(pixel).channels()), Some(of(reference).channels()))
        };
        let straight = |pixel: DVec4| if pixel.w > 0.0 { pixel.truncate() / pixel.w } else { DVec3::ZERO };
        let scale = exposure_scale(self.view);
        let rows = [
            both("radiance, cd/m2", &straight),
            Row::new(Group::Pixel, "coverage", gpu.map(|pixel| pixel.w.channels()), Some(reference.w.channels())),
            both("exposed", &|pixel| straight(pixel) * scale),
        ];
        self.rows.extend(rows);
        let mapped = tone_map(self.view.tone_map, straight(reference) * scale);
        self.rows.push(Row::new(Group::Pixel, "tone-mapped, linear", None, Some(mapped.channels())));
        let [r, g, b, _] = display(self.view, reference);
        self.rows.push(Row::new(Group::Pixel, "over the background", None, Some(DVec3::new(r, g, b).channels())));
        let one = RadianceImage { width: 1, height: 1, texels: vec![reference.as_vec4()] };
        let codes = to_srgb8(&one, self.view).into_iter().take(3).map(f64::from).collect();
        let gpu = picture.map(|picture| picture.display.truncate().as_dvec3() * 255.0);
        let gpu = gpu.map(|codes| codes.round().channels());
        self.rows.push(Row::new(Group::Pixel, "display, sRGB of 255", gpu, Some(codes)));
    }
}

fn of_row(values: &[f64]) -> DVec3 {
    DVec3::from_slice(values)
}

/// The components that a material's BRDF has.
fn components(is_disney: bool) -> &'static [Component] {
    use Component::{Clearcoat, Diffuse, MultipleScattering, Sheen, Specular};
    if is_disney { &[Diffuse, Specular, Sheen, Clearcoat] } else { &[Diffuse, Specular, MultipleScattering] }
}

fn disney_parameters(mut disney: Disney) -> Vec<(String, f64)> {
    let value = |name: &&str| disney.parameter_mut(name).map_or(f64::NAN, |value| f64::from(*value));
    let values: Vec<f64> = Disney::NAMES.iter().map(value).collect();
    Disney::NAMES.iter().map(|name| format!("disney.{name}")).zip(values).collect()
}

/// A name for each light, in the order of [`Scene::lights_in_world`].
pub(super) fn light_labels(scene: &Scene) -> Vec<String> {
    let lights = scene.world_transforms().into_iter().filter_map(|(node, _)| {
        let light = &scene.lights[scene.nodes[node].light?];
        let kind = match light.kind {
            LightKind::Point { .. } => "point",
            LightKind::Spot { .. } => "spot",
            LightKind::Directional => "directional",
        };
        let name = light.name.as_ref().or(scene.nodes[node].name.as_ref());
        Some(name.map_or_else(|| kind.to_owned(), |name| format!("{kind} \"{name}\"")))
    });
    lights.enumerate().map(|(index, label)| format!("light {index}, {label}")).collect()
}

/// What a reader has to know to judge the differences.
fn notes(scene: &Scene, seen: Option<&Seen>, rows: &[Row]) -> Vec<String> {
    let Some(Seen { details, .. }) = seen else { return Vec::new() };
    let mut notes = Vec::new();
    let material = &scene.materials[details.material];
    if material.textures().next().is_some() {
        notes.push(
            "textures: the reference reads their base level, the GPU the mip levels that its filter chose".into(),
        );
    }
    let primitive = &scene.meshes[details.mesh].primitives[details.primitive];
    if primitive.topology != Topology::Triangles {
        notes.push(
            "points and lines are as wide as the driver makes them; the reference draws them one pixel wide".into(),
        );
    }
    let position = rows.iter().find(|row| row.name.starts_with("position"));
    let apart = position.and_then(|row| row.relative_difference);
    if apart.is_some_and(|apart| apart > 1e-3) {
        notes.push("the two renderers see different places: the pixel's middle lies on an edge".into());
    }
    notes
}
