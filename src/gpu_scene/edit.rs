//! Changes to a scene that stay within its buffers: no pipeline, no bind group and no texture is made for them.

use super::{GpuScene, gpu_instance};
use crate::gpu::write_buffer;
use crate::scene::{EnvironmentMaps, Instance, LightInWorld, Material, Scene, TextureSlot};
use crate::shader::{MaterialFeatures, SceneFeatures, types};

/// Each change is written when the queue is submitted to next, and so seen by all frames that are submitted then. Each
/// returns false, and nothing has changed, where more than numbers would be others: then the scene is to be uploaded again.
/// So it is on a lost device, where that fails.
impl GpuScene {
    /// Moves all instances to their places in `moved`, see [`Scene::instances`]. Such a scene takes the forward path.
    pub fn move_instances(&mut self, queue: &wgpu::Queue, moved: &[Instance]) -> bool {
        let Some(range) = self.drawables.move_instances(moved) else { return false };
        if range.is_empty() {
            return true;
        }
        let placed = &self.drawables.instances[range.clone()];
        self.moved.clear();
        self.moved.extend(placed.iter().map(|placed| gpu_instance(placed, self.drawables.origin_in_world)));
        let offset = range.start * size_of::<types::Instance>();
        if write_buffer(queue, &self.instances, offset as u64, bytemuck::cast_slice(&self.moved)).is_err() {
            return false;
        }
        // It has the place of its instance within.
        self.pulled = None;
        self.was_edited();
        true
    }

    /// Replaces the numbers of a material of `scene`, of which this was made, by those of `new`.
    pub fn set_material(&mut self, queue: &wgpu::Queue, scene: &Scene, index: usize, new: &Material) -> bool {
        let Some(old) = scene.materials.get(index) else { return false };
        let texture = |material: &Material, slot| material.texture(slot).map(|texture| texture.texture);
        if TextureSlot::ALL.into_iter().any(|slot| texture(old, slot) != texture(new, slot)) {
            return false;
        }
        let drawn = || self.drawables.draws.iter().zip(&self.draws).filter(|(drawable, _)| drawable.material == index);
        let is_alike = drawn().all(|(drawable, _)| {
            let primitive = &scene.meshes[drawable.mesh].primitives[drawable.primitive];
            MaterialFeatures::of(new, primitive, scene, self.features) == drawable.material_features
        });
        if is_alike {
            let written = drawn().all(|(_, draw)| draw.material.write(queue, new).is_ok());
            self.was_edited();
            return written;
        }
        false
    }

    /// Takes the lights of `scene`, of which this was made, as they are now, and in the world.
    pub fn set_lights(&mut self, queue: &wgpu::Queue, scene: &Scene, lights_in_world: &[LightInWorld]) -> bool {
        let wanted = SceneFeatures::lit_by(scene, lights_in_world);
        let light_list = self.features.light_list.kept_for(wanted.light_list);
        let features = SceneFeatures { suns: self.features.suns, light_list, ..wanted };
        let origin_in_world = self.drawables.origin_in_world;
        let replaced = features == self.features
            && self.lights.as_mut().is_none_or(|lights| lights.replace(queue, lights_in_world, origin_in_world));
        if replaced {
            self.was_edited();
        }
        replaced
    }

    /// Takes rotation and intensity of the environment of `scene`, of which this was made with the same `maps`, as they are
    /// now.
    pub fn set_environment(&mut self, queue: &wgpu::Queue, scene: &Scene, maps: &EnvironmentMaps) -> bool {
        let (Some(of_gpu), Some(environment)) = (&mut self.environment, scene.lit_environment()) else { return false };
        let replaced = of_gpu.replace(queue, environment, maps);
        if replaced {
            self.was_edited();
        }
        replaced
    }

    fn was_edited(&mut self) {
        self.revision += 1;
    }
}
