//! Surfaces under a pixel, as the host's models have them.

use super::merge::Model;
use super::{EmbedError, LiveScene, ModelId};
use crate::renderer::{self, PickedSurface, Renderer};
use crate::scene::View;
use glam::{DVec3, UVec2};

/// The nearest surface at a pixel. All indices are those of the model's asset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    pub model: ModelId,
    pub node: usize,
    pub mesh: usize,
    /// Index into the primitives of the mesh.
    pub primitive: usize,
    pub material: usize,
    /// Metres.
    pub position_in_world: DVec3,
    /// From the plane of the eye along the line of sight, metres.
    pub depth_m: f64,
}

/// A question that was recorded, see [`LiveScene::pick`].
#[derive(Debug)]
pub struct Pick {
    surface: renderer::Pick,
    /// As they were then.
    models: Vec<(ModelId, Model)>,
}

impl LiveScene {
    /// Records into the host's encoder what tells which surface is at a pixel of `view`, counted from its top left. The
    /// answer is about the scene as it is now; it has come when the host has submitted the encoder and its device has been
    /// polled after that.
    ///
    /// # Errors
    /// Those of [`Self::update`] and of [`Renderer::pick`].
    pub fn pick(
        &mut self,
        renderer: &mut Renderer,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        (view, pixel): (&View, UVec2),
    ) -> Result<Pick, EmbedError> {
        let scene = self.update(renderer, (device, queue))?;
        let surface = renderer.pick((device, queue), encoder, scene, view, pixel)?;
        Ok(Pick { surface, models: self.models().collect() })
    }
}

impl Pick {
    /// The surface; `None` inside where there is none, and outside as long as there is no answer. Its model may have been
    /// removed since.
    ///
    /// # Errors
    /// Where the device was lost before it answered.
    pub fn try_get(&self) -> Option<Result<Option<Hit>, EmbedError>> {
        let surface = self.surface.try_get()?;
        Some(surface.map(|surface| self.hit(surface?)).map_err(|lost| EmbedError::Render(lost.into())))
    }

    fn hit(&self, surface: PickedSurface) -> Option<Hit> {
        let PickedSurface { node, mesh, primitive, material, position_in_world, depth_m } = surface;
        let is_owner =
            |(_, model): &&(ModelId, Model)| (model.first.nodes..model.first.nodes + model.count.nodes).contains(&node);
        let &(model, Model { first, .. }) = self.models.iter().find(is_owner)?;
        Some(Hit {
            model,
            // The first node is not of the asset.
            node: node - first.nodes - 1,
            mesh: mesh - first.meshes,
            primitive,
            material: material - first.materials,
            position_in_world,
            depth_m,
        })
    }
}
