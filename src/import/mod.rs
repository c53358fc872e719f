//! Files to plain data: glTF 2.0 models, environment panoramas, and pictures to compare.
//!
//! Everything a file says is checked here, once, so that a [`Scene`] needs no checks. No bytes make these functions
//! panic; memory is bounded by [`Limits`], time grows linearly with the file. Nothing outside the model's folder is
//! read. What is wrong is an [`ImportError`] of one line that names the place; what is ignored or replaced is a
//! [`Warning`].

mod accessor;
mod buffers;
mod cameras;
mod choice;
mod container;
mod document;
mod environment;
mod error;
mod extensions;
mod files;
mod geometry;
mod images;
mod instancing;
mod lights;
mod limits;
mod materials;
mod nodes;
mod normals;
mod openexr;
mod picture;
mod references;
mod resources;
mod sketch;
mod tangents;
#[cfg(test)]
pub(crate) mod tests;
mod textures;
mod topology;
mod variants;
mod vertices;

pub use choice::Choice;
pub use environment::{environment_from_path, environment_from_slice};
pub use error::{ImportError, Place, Warning};
pub use extensions::SUPPORTED_EXTENSIONS;
pub use files::model_files;
pub use limits::Limits;
pub use picture::{picture_from_path, picture_from_slice};

use crate::progress::{Progress, Silent};
use crate::scene::{Material, Mesh, Node, Primitive, Scene, TextureSlot};
use crate::threads::*;
use accessor::Accessors;
use buffers::Buffers;
use document::Document;
use error::{Fault, Notes};
use gltf::json::Root;
use limits::Budget;
use resources::Resources;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// How a model is imported.
#[derive(Clone)]
pub struct ImportOptions<'a> {
    /// `None` takes the file's default scene, or the first.
    pub scene: Option<Choice>,
    /// `None` takes the materials that primitives have without any variant (KHR_materials_variants).
    pub variant: Option<Choice>,
    pub limits: Limits,
    /// Leaves out the textures that materials have but never sample: normal maps of unlit ones, emission times zero.
    /// Materials must not change after that.
    pub sampled_textures_only: bool,
    /// Told of the stages "read" and "decode", whose steps are primitives and images.
    pub progress: &'a dyn Progress,
    /// Given the scene of a model with images while they are decoded: each is a few texels of half the light, of no metal
    /// and no relief. Nobody knows yet whether the model can be imported.
    pub sketch: Option<&'a (dyn Fn(Scene) + Sync)>,
}

impl Default for ImportOptions<'_> {
    fn default() -> Self {
        Self {
            scene: None,
            variant: None,
            limits: Limits::default(),
            sampled_textures_only: false,
            progress: &Silent,
            sketch: None,
        }
    }
}

impl std::fmt::Debug for ImportOptions<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ImportOptions")
            .field("scene", &self.scene)
            .field("variant", &self.variant)
            .field("limits", &self.limits)
            .field("sampled_textures_only", &self.sampled_textures_only)
            .finish_non_exhaustive()
    }
}

/// A model as imported.
#[derive(Debug)]
pub struct Imported {
    pub scene: Scene,
    pub warnings: Vec<Warning>,
    /// The names of all scenes of the file, in its order.
    pub scene_names: Vec<Option<String>>,
    /// Which of them this is; `None` if the file has no scenes and all its nodes were taken.
    pub scene_index: Option<usize>,
    /// The names of all variants of the file's materials, in its order.
    pub variant_names: Vec<String>,
    /// The extensions that the file says it uses, whether or not they are among [`SUPPORTED_EXTENSIONS`].
    pub extensions_used: Vec<String>,
}

/// Imports a .gltf or .glb file. Files it refers to are read if they lie in its folder or below.
///
/// # Errors
/// When the file or a part of it that the picture needs cannot be read, breaks the specification, is over a limit, or
/// requires an extension that is not supported.
pub fn model_from_path(path: &Path, options: &ImportOptions<'_>) -> Result<Imported, ImportError> {
    let source_name = path.display().to_string();
    options.progress.begin("read", 0);
    let bytes = read_file(path, options.limits.decoded_bytes).map_err(|fault| fault.in_file(&source_name))?;
    import_named(&bytes, &source_name, Some(path.parent().unwrap_or(Path::new(""))), options)
}

/// Imports the bytes of a .gltf or .glb file. `source_name` stands for them in messages; `base_dir` is the folder that
/// uris are relative to, `None` if only data URIs may be followed.
///
/// # Errors
/// As [`model_from_path`].
pub fn model_from_slice(
    bytes: &[u8],
    source_name: &str,
    base_dir: Option<&Path>,
    options: &ImportOptions<'_>,
) -> Result<Imported, ImportError> {
    options.progress.begin("read", 0);
    import_named(bytes, source_name, base_dir, options)
}

fn import_named(
    bytes: &[u8],
    source_name: &str,
    base_dir: Option<&Path>,
    options: &ImportOptions<'_>,
) -> Result<Imported, ImportError> {
    let mut notes = Notes::default();
    let model = import_model(bytes, base_dir, options, &mut notes).map_err(|fault| fault.in_file(source_name))?;
    Ok(Imported { warnings: notes.in_file(source_name), ..model })
}

/// The bytes of a file of at most `limit` bytes.
fn read_file(path: &Path, limit: u64) -> Result<Vec<u8>, Fault> {
    let unreadable = |error: std::io::Error| {
        Fault::of_file(format!("cannot be read: {error}"), "check the path and its permissions")
    };
    let file = File::open(path).map_err(unreadable)?;
    let mut bytes = Vec::new();
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > limit {
        return Err(Fault::of_file(format!("is larger than {limit} bytes"), "raise the limit on decoded bytes"));
    }
    Ok(bytes)
}

fn import_model(
    bytes: &[u8],
    base_dir: Option<&Path>,
    options: &ImportOptions<'_>,
    notes: &mut Notes,
) -> Result<Imported, Fault> {
    let budget = Budget::new(options.limits.decoded_bytes);
    let resources = Resources::new(base_dir, &budget);
    let container = container::split(bytes, notes)?;
    let mut document = document::parse(container.json, container.json_offset, notes)?;
    references::check(&document)?;
    let variant_names = variants::apply(&mut document.root, options.variant.as_ref(), notes)?;
    note_what_does_not_move(&document, notes);

    let root = &document.root;
    let lights = lights::import(root, notes)?;
    let mut nodes = nodes::import(root, lights.len(), notes)?;
    let chosen = nodes::choose_scene(root, &nodes, options.scene.as_ref(), notes)?;
    let cameras = cameras::import(root, notes)?;
    let mut materials = materials::import(root, notes)?;
    if options.sampled_textures_only {
        materials.iter_mut().for_each(forget_what_is_not_sampled);
    }
    let textures = textures::collect(root, &mut materials, &drawn_materials(root, &nodes, &chosen.roots), notes)?;
    if root.meshes.iter().flat_map(|mesh| &mesh.primitives).any(|primitive| primitive.material.is_none()) {
        materials.push(Material::default());
    }

    let buffers = Buffers::load(root, container.binary, &resources)?;
    let accessors = Accessors { root, buffers: &buffers, budget: &budget, limits: &options.limits };
    instancing::import(&accessors, &mut nodes, notes)?;
    let primitives: usize = root.meshes.iter().map(|mesh| mesh.primitives.len()).sum();
    options.progress.begin("decode", (primitives + textures.images.len()) as u64);
    let build = || -> Result<Scene, Fault> {
        let meshes = build_meshes(&accessors, &materials, options.progress, notes)?;
        let scene = Scene {
            name: chosen.name,
            nodes,
            roots: chosen.roots,
            meshes,
            materials,
            textures: textures.textures,
            images: Vec::new(),
            cameras,
            lights,
            environment: None,
        };
        if let (Some(give), false) = (options.sketch, textures.images.is_empty()) {
            give(Scene { images: sketch::images(&scene, textures.images.len()), ..scene.clone() });
        }
        Ok(scene)
    };
    let decode = || images::import(&accessors, &resources, &textures.images, options.progress);
    let (scene, images) = join(build, decode);
    let mut scene = scene?;
    scene.images = images?;
    let scene_names = root.scenes.iter().map(|scene| scene.name.clone()).collect();
    let extensions_used = root.extensions_used.clone();
    let scene_index = chosen.index;
    Ok(Imported { scene, warnings: Vec::new(), scene_names, scene_index, variant_names, extensions_used })
}

fn forget_what_is_not_sampled(material: &mut Material) {
    for slot in TextureSlot::ALL.into_iter().filter(|slot| !material.samples(*slot)).collect::<Vec<_>>() {
        material.set_texture(slot, None);
    }
}

/// Which materials a primitive below `roots` has. No node has two parents.
fn drawn_materials(root: &Root, nodes: &[Node], roots: &[usize]) -> Vec<bool> {
    let mut drawn = vec![false; root.materials.len()];
    let mut left = roots.to_vec();
    while let Some(node) = left.pop() {
        left.extend(&nodes[node].children);
        let primitives = nodes[node].mesh.iter().flat_map(|mesh| &root.meshes[*mesh].primitives);
        primitives.filter_map(|primitive| primitive.material).for_each(|material| drawn[material.value()] = true);
    }
    drawn
}

/// All meshes of the document. Primitives without a material have the last of `materials`.
fn build_meshes(
    accessors: &Accessors<'_>,
    materials: &[Material],
    progress: &dyn Progress,
    notes: &mut Notes,
) -> Result<Vec<Mesh>, Fault> {
    let root = accessors.root;
    let jobs: Vec<(usize, usize)> =
        root.meshes.iter().enumerate().flat_map(|(m, mesh)| (0..mesh.primitives.len()).map(move |p| (m, p))).collect();
    let build = |&(m, p): &(usize, usize)| -> Result<(Option<Primitive>, Notes), Fault> {
        let json = &root.meshes[m].primitives[p];
        let material = json.material.map_or(materials.len() - 1, |material| material.value());
        let mut notes = Notes::default();
        let here = format!("/meshes/{m}/primitives/{p}");
        let primitive = geometry::build(accessors, json, &here, (material, &materials[material]), &mut notes);
        progress.advance(1);
        Ok((primitive?, notes))
    };
    let built: Vec<_> = jobs.par_iter().map(build).collect();

    let mut meshes: Vec<Mesh> =
        root.meshes.iter().map(|json| Mesh { name: json.name.clone(), primitives: Vec::new() }).collect();
    for (&(m, _), built) in jobs.iter().zip(built) {
        let (primitive, later) = built?;
        notes.append(later);
        meshes[m].primitives.extend(primitive);
    }
    Ok(meshes)
}

/// Animations, skins and morph targets are shown in their rest pose.
fn note_what_does_not_move(document: &Document, notes: &mut Notes) {
    let root = &document.root;
    if document.animations.as_array().is_some_and(|animations| !animations.is_empty()) {
        notes.add("/animations", "animations are not played yet");
    }
    if let Some(node) = root.nodes.iter().position(|node| node.skin.is_some() && node.mesh.is_some()) {
        notes.add(format_args!("/nodes/{node}/skin"), "skins are not applied yet; the mesh is shown in its bind pose");
    }
    let morphs = |mesh: &gltf::json::Mesh| mesh.primitives.iter().any(|primitive| primitive.targets.is_some());
    if let Some(mesh) = root.meshes.iter().position(morphs) {
        notes.add(format_args!("/meshes/{mesh}"), "morph targets are not applied yet; the base mesh is shown");
    }
}
