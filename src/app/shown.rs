//! A model as a state shows it.

use super::camera::Surroundings;
use super::state::{BackgroundState, ViewerState};
use crate::bake::studio;
use crate::import::{ImportError, environment_from_path};
use crate::reference::geometry::{Geometry, Ray};
use crate::reference::inspect::Inspector;
use crate::scene::{Background, Channel, Environment, EnvironmentImage, Light, Material, Scene, View};
use glam::{DVec2, DVec3, UVec2, Vec3};
use std::path::Path;
use std::sync::Arc;

/// The grey behind a model that stands in a built-in environment, sRGB.
pub(super) const GREY: f32 = 0.16;

/// A scene, and what of it a state changes, as it was in the file.
#[derive(Debug, Clone)]
pub struct Shown {
    /// With the changes of the state that was applied last.
    pub scene: Scene,
    pub around: Surroundings,
    materials: Vec<Material>,
    lights: Vec<Light>,
    /// Mesh and light of each node.
    on_nodes: Vec<(Option<usize>, Option<usize>)>,
}

impl Shown {
    /// `scene` as its file has it, for a picture as `state` asks for.
    pub fn new(scene: Scene, state: &ViewerState) -> Self {
        let around = Surroundings::of(&scene, state.camera.fov_deg.to_radians(), state.size_px());
        let (materials, lights) = (scene.materials.clone(), scene.lights.clone());
        let on_nodes = scene.nodes.iter().map(|node| (node.mesh, node.light)).collect();
        Self { scene, around, materials, lights, on_nodes }
    }

    /// A material as the file has it.
    pub fn original(&self, material: usize) -> Option<&Material> {
        self.materials.get(material)
    }

    /// Whether the file has something to show or a light on this node.
    pub fn has_content(&self, node: usize) -> bool {
        self.on_nodes.get(node).is_some_and(|(mesh, light)| mesh.is_some() || light.is_some())
    }

    /// Changes the scene to what `state` says of it. The panorama stays; see [`environment_image`].
    pub fn apply(&mut self, state: &ViewerState) {
        let scene = &mut self.scene;
        scene.materials.clone_from(&self.materials);
        for (index, edit) in &state.materials {
            if let Some(material) = scene.materials.get_mut(*index) {
                edit.apply(material);
            }
        }
        scene.lights.clone_from(&self.lights);
        for (index, factor) in &state.light_factors {
            if let Some(light) = scene.lights.get_mut(*index) {
                light.intensity *= factor;
            }
        }
        for (node, (mesh, light)) in scene.nodes.iter_mut().zip(&self.on_nodes) {
            (node.mesh, node.light) = (*mesh, *light);
        }
        let mut hidden: Vec<usize> = state.hidden_nodes.iter().copied().collect();
        while let Some(index) = hidden.pop() {
            if let Some(node) = scene.nodes.get_mut(index) {
                (node.mesh, node.light) = (None, None);
                hidden.extend(&node.children);
            }
        }
        if let Some(environment) = &mut scene.environment {
            environment.rotation_rad = state.environment.rotation_deg.to_radians();
            environment.intensity = state.environment.intensity;
        }
    }

    /// The nearest surface that is seen at a place of the picture, in the world.
    pub fn point_at(&self, state: &ViewerState, pixel: DVec2) -> Option<DVec3> {
        let view = view_of(state, &self.around);
        let geometry = Geometry::new(&self.scene, &view);
        let (origin, direction) = view.camera.ray(pixel, view.size_px);
        let ray = Ray { origin, direction, t_min: 0.0, t_max: f64::INFINITY };
        let mut nearest = f64::INFINITY;
        geometry.visit_hits(&ray, |hit| {
            nearest = nearest.min(hit.t);
            Some(nearest)
        });
        nearest.is_finite().then(|| origin + nearest * direction)
    }

    /// Index of the material of the nearest surface that is seen in the middle of a pixel.
    pub fn material_at(&self, state: &ViewerState, pixel: UVec2) -> Option<usize> {
        let view = view_of(state, &self.around);
        let inspector = Inspector::new(&self.scene, &view);
        let (_, layers) = inspector.layers(pixel);
        layers.first().map(|layer| inspector.material(&layer.hit))
    }

    /// Puts a panorama around the scene; `None` is black.
    pub fn surround(&mut self, image: Option<Arc<EnvironmentImage>>, state: &ViewerState) {
        self.scene.environment = image.map(|image| Environment {
            image,
            rotation_rad: state.environment.rotation_deg.to_radians(),
            intensity: state.environment.intensity,
        });
    }
}

/// The picture that a state asks for.
pub fn view_of(state: &ViewerState, around: &Surroundings) -> View {
    let look = &state.look;
    View {
        camera: state.camera.camera(around),
        size_px: state.size_px(),
        exposure_ev: look.exposure_ev,
        tone_map: look.tone_map,
        background: match look.background {
            BackgroundState::Auto if is_file(&state.environment.source) => Background::Environment,
            BackgroundState::Auto => Background::Color(Vec3::splat(GREY)),
            BackgroundState::Transparent => Background::Transparent,
            BackgroundState::Environment => Background::Environment,
            BackgroundState::Color(color) => Background::Color(Vec3::from_array(color)),
        },
        background_blur: look.background_blur,
        energy_compensation: look.energy_compensation,
        geometry: look.geometry,
        quality: look.quality,
        term: None,
        channel: look.debug_view,
    }
}

/// Whether the name of an environment is that of a file.
pub fn is_file(source: &str) -> bool {
    !matches!(source, "neutral" | "white" | "black")
}

/// The panorama of a name; `None` is black, without the cost of one.
///
/// # Errors
/// When it is a file that cannot be read.
pub fn environment_image(source: &str) -> Result<Option<EnvironmentImage>, ImportError> {
    Ok(match source {
        "black" => None,
        "white" => Some(EnvironmentImage::constant(Vec3::ONE)),
        "neutral" => Some(studio::studio()),
        path => Some(environment_from_path(Path::new(path))?),
    })
}

/// A scene without light from around is given a white one where the furnace is to be shown, since surfaces that nothing
/// lights have no lobes.
pub fn light_furnace(scene: &mut Scene, channel: Option<Channel>) {
    if channel == Some(Channel::Furnace) && scene.lit_environment().is_none() {
        scene.environment = Some(Environment::new(EnvironmentImage::constant(Vec3::ONE)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::edit::MaterialEdit;
    use crate::scene::shapes::sphere;
    use crate::scene::{LightKind, Mesh, Node};
    use glam::DMat4;

    /// A ball that hangs on a node with a light, which hangs on a root.
    fn shown() -> Shown {
        let node = |child: usize| Node { parent_from_node: DMat4::IDENTITY, children: vec![child], ..Node::default() };
        let light = Light { name: None, kind: LightKind::Directional, color: DVec3::ONE, intensity: 3.0 };
        let scene = Scene {
            nodes: vec![
                node(1),
                Node { light: Some(0), ..node(2) },
                Node { mesh: Some(0), children: vec![], ..node(0) },
            ],
            roots: vec![0],
            meshes: vec![Mesh { name: None, primitives: vec![sphere(1.0, 16, 0)] }],
            materials: vec![Material::default()],
            lights: vec![light],
            ..Scene::default()
        };
        Shown::new(scene, &ViewerState::default())
    }

    #[test]
    fn changes_come_and_go() {
        let mut shown = shown();
        let mut state = ViewerState::default();
        let edit = MaterialEdit { metallic: 0.25, ..MaterialEdit::of(&Material::default()) };
        state.materials.insert(0, edit);
        state.light_factors.insert(0, 2.0);
        // Of what is not there nobody asks for anything.
        state.light_factors.insert(9, 2.0);
        state.hidden_nodes = [2, 9].into();
        shown.apply(&state);
        shown.apply(&state);
        assert_eq!((shown.scene.materials[0].metallic, shown.scene.lights[0].intensity), (0.25, 6.0));
        assert_eq!((shown.scene.instances().len(), shown.scene.lights_in_world().len()), (0, 1));
        assert!(shown.has_content(2) && !shown.has_content(0));
        state.hidden_nodes = [0].into();
        shown.apply(&state);
        assert_eq!((shown.scene.instances().len(), shown.scene.lights_in_world().len()), (0, 0));
        shown.apply(&ViewerState::default());
        assert_eq!((shown.scene.materials[0].metallic, shown.scene.lights[0].intensity), (1.0, 3.0));
        assert_eq!((shown.scene.instances().len(), shown.scene.lights_in_world().len()), (1, 1));
    }

    #[test]
    fn backgrounds_follow_the_panorama() {
        let shown = shown();
        let mut state = ViewerState::default();
        let background = |state: &ViewerState| view_of(state, &shown.around).background;
        assert_eq!(background(&state), Background::Color(Vec3::splat(GREY)));
        state.environment.source = "sky.hdr".into();
        assert_eq!(background(&state), Background::Environment);
        state.look.background = BackgroundState::Transparent;
        assert_eq!(background(&state), Background::Transparent);
    }
}
