//! The scene itself: what is changed, and how little of it is uploaded.

use super::hosted::Hosted;
use super::merge::{self, Model};
use super::slots::Slots;
use super::{EmbedError, ModelId, check};
use crate::gpu::Identity;
use crate::gpu_scene::{GpuScene, TextureLevels};
use crate::renderer::{RenderError, Renderer};
use crate::scene::{Environment, EnvironmentMaps, Light, Material, Pixels, Placed, Scene};
use glam::DMat4;
use std::hash::{BuildHasher, RandomState};
use std::sync::Arc;

/// Models, lights and an environment that a host changes while they are shown. All of it is also on the CPU, so that
/// another device can be given the same scene.
///
/// Changes are collected, and [`Self::update`] brings them to the GPU: transforms, the numbers of materials and lights, and
/// the environment's rotation and intensity are written into the buffers that are there. Models that come or go, and
/// changes that need other shaders (a material that gets a texture or becomes transparent, a transform that begins to
/// mirror, the first light that shines), upload the scene anew; its textures only where models came or went.
#[derive(Debug)]
pub struct LiveScene {
    /// Told from others by chance: a handle of another scene is one in 2^64.
    id: u64,
    scene: Scene,
    maps: Option<Arc<EnvironmentMaps>>,
    models: Slots<Model>,
    hosted: Hosted,
    uploaded: Option<Uploaded>,
    /// As of the last change of a place or a light.
    placed: Placed,
    pending: Pending,
    uploads: u64,
}

#[derive(Debug)]
struct Uploaded {
    /// Of the renderer that it was uploaded for.
    renderer: Identity,
    scene: GpuScene,
}

/// What has changed since the last update.
#[derive(Debug, Default)]
struct Pending {
    /// More than can be written.
    all: bool,
    /// Models have come or gone, and their images with them.
    images: bool,
    /// The environment is of another image.
    other_light: bool,
    moved: bool,
    lights: bool,
    environment: bool,
    /// Materials by their place in the scene, and as they are to be.
    materials: Vec<(usize, Material)>,
}

impl Default for LiveScene {
    fn default() -> Self {
        Self {
            id: RandomState::new().hash_one(0),
            scene: Scene::default(),
            maps: None,
            models: Slots::new(),
            hosted: Hosted::default(),
            uploaded: None,
            placed: Placed::default(),
            pending: Pending::default(),
            uploads: 0,
        }
    }
}

impl LiveScene {
    /// An empty scene in the dark.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a model with its meshes, materials and lights. Its cameras and its environment are left out.
    ///
    /// # Errors
    /// [`EmbedError::Asset`] says what does not fit; a scene that was imported fits.
    pub fn insert(&mut self, asset: &Scene) -> Result<ModelId, EmbedError> {
        check::check(asset)?;
        self.settle_materials();
        let (index, generation) = self.models.insert(merge::append(&mut self.scene, asset));
        (self.pending.all, self.pending.images) = (true, true);
        Ok(ModelId { scene: self.id, index, generation })
    }

    /// Takes a model out.
    ///
    /// # Errors
    /// [`EmbedError::StaleHandle`] where it is gone already.
    pub fn remove(&mut self, id: ModelId) -> Result<(), EmbedError> {
        self.model(id)?;
        self.settle_materials();
        let removed = self.models.remove((id.index, id.generation)).ok_or(EmbedError::StaleHandle)?;
        merge::remove(&mut self.scene, &removed);
        self.hosted.forget(id);
        self.models.values_mut().for_each(|model| *model = merge::moved_up(model, &removed));
        (self.pending.all, self.pending.images) = (true, true);
        Ok(())
    }

    /// Places a model in the world.
    ///
    /// # Errors
    /// For a stale handle or a matrix that is not finite.
    pub fn set_transform(&mut self, id: ModelId, world_from_model: DMat4) -> Result<(), EmbedError> {
        let root = self.model(id)?.first.nodes;
        self.place(root, world_from_model)
    }

    /// Places nodes of a model, numbered as in its asset, each in its parent.
    ///
    /// # Errors
    /// For a stale handle, a node that is not there or a matrix that is not finite; the nodes before it have been placed.
    pub fn set_nodes(
        &mut self,
        id: ModelId,
        parent_from_nodes: impl IntoIterator<Item = (usize, DMat4)>,
    ) -> Result<(), EmbedError> {
        let Model { first, count } = *self.model(id)?;
        // The first one is not of the asset.
        let count = count.nodes - 1;
        for (node, parent_from_node) in parent_from_nodes {
            let node = below("node", node, count)?;
            self.place(first.nodes + 1 + node, parent_from_node)?;
        }
        Ok(())
    }

    /// Replaces a material of a model, numbered as in its asset, as are the textures that it may refer to.
    ///
    /// # Errors
    /// For a stale handle, and for materials, textures and texture coordinates that are not there.
    pub fn set_material(&mut self, id: ModelId, material: usize, new: Material) -> Result<(), EmbedError> {
        let model = *self.model(id)?;
        let place = model.first.materials + below("material", material, model.count.materials)?;
        for (_, texture) in new.textures() {
            below("texture", texture.texture, model.count.textures)?;
        }
        let meshes = &self.scene.meshes[model.first.meshes..model.first.meshes + model.count.meshes];
        let users = meshes.iter().flat_map(|mesh| &mesh.primitives).filter(|primitive| primitive.material == place);
        users.into_iter().try_for_each(|primitive| check::check_uvs(&new, primitive))?;
        self.pending.materials.retain(|(pending, _)| *pending != place);
        self.pending.materials.push((place, merge::of_model(new, &model)));
        Ok(())
    }

    /// Gives an image of a model that is [`Pixels::OfHost`], numbered as in its asset, to a renderer: what the host has drawn
    /// there when its submissions run is what the material shows. Whatever sampling it gives is taken as linear, so colours
    /// come as a view in an sRGB format or as floats; of the view's levels all are used. Normal maps cannot be given.
    ///
    /// A view belongs to a device: after [`Renderer::restore`] the host gives another.
    ///
    /// # Errors
    /// For a stale handle, an image that is not there, one that has texels of its own, and a texture that materials cannot
    /// sample. Images that were not given are [`crate::gpu_scene::UploadError::NoHostTexture`] at the next update.
    pub fn set_image(
        &mut self,
        renderer: &Renderer,
        id: ModelId,
        image: usize,
        view: wgpu::TextureView,
    ) -> Result<(), EmbedError> {
        let Model { first, count } = *self.model(id)?;
        let place = first.images + below("image", image, count.images)?;
        if !matches!(self.scene.images[place].pixels, Pixels::OfHost) {
            return Err(EmbedError::Asset(format!("image {image} has texels of its own")));
        }
        check::check_host_texture(view.texture())?;
        self.hosted.insert((id, image), renderer.identity.clone(), view);
        self.pending.all = true;
        Ok(())
    }

    /// Replaces a light of a model, numbered as in its asset.
    ///
    /// # Errors
    /// For a stale handle, a light that is not there, or one whose numbers are not finite or below 0.
    pub fn set_light(&mut self, id: ModelId, light: usize, new: Light) -> Result<(), EmbedError> {
        let Model { first, count } = *self.model(id)?;
        let light = below("light", light, count.lights)?;
        check::check_light(&new)?;
        self.scene.lights[first.lights + light] = new;
        self.pending.lights = true;
        Ok(())
    }

    /// Sets what the scene stands in: an environment and the maps that were baked from its image; `None` is darkness.
    pub fn set_environment(&mut self, environment: Option<(Environment, Arc<EnvironmentMaps>)>) {
        (self.scene.environment, self.maps) = environment.unzip();
        (self.pending.all, self.pending.other_light) = (true, true);
    }

    /// Turns the environment about +Y, rad, and sets the factor of its radiance. Does nothing in the dark.
    ///
    /// # Errors
    /// For an angle that is not finite, and for an intensity that is not or is below 0.
    pub fn turn_environment(&mut self, rotation_rad: f64, intensity: f64) -> Result<(), EmbedError> {
        number("the environment's rotation", rotation_rad, rotation_rad.is_finite(), "a finite angle, rad")?;
        let is_positive = intensity >= 0.0 && intensity.is_finite();
        number("the environment's intensity", intensity, is_positive, "a finite number from 0 up")?;
        if let Some(environment) = &mut self.scene.environment {
            (environment.rotation_rad, environment.intensity) = (rotation_rad, intensity);
            self.pending.environment = true;
        }
        Ok(())
    }

    /// Everything as it will be drawn after the next update, materials that wait for it apart. Its indices are its own.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What the last update has brought to the GPU, for `FrameState::prepared`.
    pub fn uploaded(&self) -> Option<&GpuScene> {
        self.uploaded.as_ref().map(|uploaded| &uploaded.scene)
    }

    /// How often the whole scene was uploaded.
    pub fn uploads(&self) -> u64 {
        self.uploads
    }

    /// Brings all changes to the device of `renderer`, and returns what that draws. For another renderer than at the last
    /// time, everything is uploaded. Edits are written when the queue is submitted to next: what was recorded before and
    /// not submitted shows them too.
    ///
    /// # Errors
    /// [`RenderError::DeviceLost`], and where the scene does not fit on the device. The changes stay to be made.
    pub fn update(
        &mut self,
        renderer: &Renderer,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
    ) -> Result<&mut GpuScene, EmbedError> {
        renderer.check_device()?;
        let mut previous = self.uploaded.take().filter(|uploaded| uploaded.renderer == renderer.identity);
        let is_written = match &mut previous {
            Some(uploaded) if !self.pending.all => self.write(queue, &mut uploaded.scene),
            _ => false,
        };
        let uploaded = match previous {
            Some(uploaded) if is_written => uploaded,
            previous => {
                self.settle_materials();
                self.pending.all = true;
                let scene = self.upload(renderer, (device, queue), previous.map(|previous| previous.scene));
                // What was there has been used up, textures included.
                self.pending.images |= scene.is_err();
                let scene = scene?;
                self.uploads += 1;
                Uploaded { renderer: renderer.identity.clone(), scene }
            }
        };
        self.pending = Pending::default();
        Ok(&mut self.uploaded.insert(uploaded).scene)
    }

    /// Uploads everything but the textures that `previous` has.
    fn upload(
        &self,
        renderer: &Renderer,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        previous: Option<GpuScene>,
    ) -> Result<GpuScene, RenderError> {
        let maps = self.maps.as_deref();
        let first_image = |id: ModelId| Some(self.models.get((id.index, id.generation))?.first.images);
        let of_host = self.hosted.of(&renderer.identity, first_image);
        match previous.filter(|_| !self.pending.images) {
            Some(mut previous) => {
                previous.set_host_textures(of_host);
                renderer.upload_again(device, queue, &self.scene, (maps, !self.pending.other_light), previous)
            }
            None => {
                let levels = TextureLevels::of(&self.scene, device.limits().max_texture_dimension_2d);
                renderer.upload_with(device, queue, &self.scene, levels.with_host_textures(of_host), maps)
            }
        }
    }

    /// Writes what has changed into the buffers that are there. False where something does not fit.
    fn write(&mut self, queue: &wgpu::Queue, uploaded: &mut GpuScene) -> bool {
        let (moved, lights, environment) = (self.pending.moved, self.pending.lights, self.pending.environment);
        for (index, new) in std::mem::take(&mut self.pending.materials) {
            let fits = uploaded.set_material(queue, &self.scene, index, &new);
            self.scene.materials[index] = new;
            self.pending.all |= !fits;
        }
        if moved || lights {
            self.placed.place(&self.scene);
        }
        if self.pending.all || (moved && !uploaded.move_instances(queue, self.placed.instances())) {
            return false;
        }
        let has_lights = !self.scene.lights.is_empty();
        if (lights || (moved && has_lights)) && !uploaded.set_lights(queue, &self.scene, self.placed.lights()) {
            return false;
        }
        let Some(maps) = &self.maps else { return true };
        !environment || uploaded.set_environment(queue, &self.scene, maps)
    }

    /// Materials as they are to be, for an upload.
    fn settle_materials(&mut self) {
        for (index, new) in std::mem::take(&mut self.pending.materials) {
            self.scene.materials[index] = new;
            self.pending.all = true;
        }
    }

    fn place(&mut self, node: usize, parent_from_node: DMat4) -> Result<(), EmbedError> {
        let numbers = parent_from_node.to_cols_array();
        let not_finite = numbers.into_iter().find(|number| !number.is_finite());
        if let Some(value) = not_finite {
            number("a number of a transform", value, false, "a finite number")?;
        }
        self.scene.nodes[node].parent_from_node = parent_from_node;
        self.pending.moved = true;
        Ok(())
    }

    /// All models with their places in the scene.
    pub(super) fn models(&self) -> impl Iterator<Item = (ModelId, Model)> {
        let scene = self.id;
        self.models.iter().map(move |((index, generation), model)| (ModelId { scene, index, generation }, *model))
    }

    fn model(&self, id: ModelId) -> Result<&Model, EmbedError> {
        let model = self.models.get((id.index, id.generation)).filter(|_| id.scene == self.id);
        model.ok_or(EmbedError::StaleHandle)
    }
}

fn below(what: &'static str, index: usize, count: usize) -> Result<usize, EmbedError> {
    if index < count { Ok(index) } else { Err(EmbedError::NoSuch { what, index, count }) }
}

fn number(what: &'static str, value: f64, is_valid: bool, expected: &'static str) -> Result<(), EmbedError> {
    if is_valid { Ok(()) } else { Err(EmbedError::Number { what, value, expected }) }
}
