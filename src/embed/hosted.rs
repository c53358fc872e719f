//! Textures of a host in the materials of its models.

use super::ModelId;
use crate::gpu::Identity;
use crate::gpu_scene::HostTextures;
use std::collections::HashMap;

/// The views that a host has given, by model and image.
#[derive(Debug, Default)]
pub(super) struct Hosted {
    views: HashMap<(ModelId, usize), OfDevice>,
}

/// A view, and the renderer on whose device it is.
#[derive(Debug)]
struct OfDevice {
    renderer: Identity,
    view: wgpu::TextureView,
}

impl Hosted {
    pub(super) fn insert(&mut self, place: (ModelId, usize), renderer: Identity, view: wgpu::TextureView) {
        self.views.insert(place, OfDevice { renderer, view });
    }

    /// Lets go of those of a model.
    pub(super) fn forget(&mut self, model: ModelId) {
        self.views.retain(|(of, _), _| *of != model);
    }

    /// Those on a renderer's device, by their images in the scene; `first_image` is that of a model.
    pub(super) fn of(&self, renderer: &Identity, first_image: impl Fn(ModelId) -> Option<usize>) -> HostTextures {
        let on_device = self.views.iter().filter(|(_, view)| view.renderer == *renderer);
        let by_image = |(&(model, image), of): (&(ModelId, usize), &OfDevice)| {
            Some((first_image(model)? + image, of.view.clone()))
        };
        on_device.filter_map(by_image).collect()
    }
}
