//! What a scene made by code must hold before anything indexes into it.

use super::EmbedError;
use crate::scene::{Light, LightKind, Material, Mesh, Node, Pixels, Primitive, Scene, TextureRef};

/// Whether every index of an asset is valid, its arrays fit each other and its nodes are trees.
pub(super) fn check(asset: &Scene) -> Result<(), EmbedError> {
    check_nodes(asset)?;
    asset.lights.iter().try_for_each(check_light)?;
    for (index, material) in asset.materials.iter().enumerate() {
        let textures = material.textures().map(|(_, texture)| texture.texture);
        all_below(textures, asset.textures.len(), || format!("material {index}: texture"))?;
    }
    all_below(asset.textures.iter().map(|texture| texture.image), asset.images.len(), || "a texture: image".into())?;
    for (index, image) in asset.images.iter().enumerate() {
        let channels = match &image.pixels {
            Pixels::Rgba8(texels) => texels.len(),
            Pixels::Rgba16(texels) => texels.len(),
            Pixels::OfHost => continue,
        };
        let (width, height) = (image.width, image.height);
        let expected = u64::from(width) * u64::from(height) * 4;
        if width == 0 || height == 0 || channels as u64 != expected {
            return fault(format!("image {index} has {channels} channels of texels, {width} x {height} is {expected}"));
        }
    }
    for (mesh, Mesh { primitives, .. }) in asset.meshes.iter().enumerate() {
        for (index, primitive) in primitives.iter().enumerate() {
            let place = || format!("mesh {mesh}, primitive {index}");
            check_primitive(primitive).map_err(|what| EmbedError::Asset(format!("{}: {what}", place())))?;
            let count = asset.materials.len();
            all_below([primitive.material], count, || format!("{}: material", place()))?;
            check_uvs(&asset.materials[primitive.material], primitive)?;
        }
    }
    Ok(())
}

/// Whether the numbers of a light are ones that it can have.
pub(super) fn check_light(light: &Light) -> Result<(), EmbedError> {
    let check = |what, value: f64, least: f64, expected| {
        let is_valid = value >= least && value.is_finite();
        if is_valid { Ok(()) } else { Err(EmbedError::Number { what, value, expected }) }
    };
    for strength in (light.color * light.intensity).to_array() {
        check("the strength of a light", strength, 0.0, "a finite number from 0 up")?;
    }
    let range = |range_m: Option<f64>| {
        check("the range of a light", range_m.unwrap_or(1.0), f64::MIN_POSITIVE, "a finite number above 0, m")
    };
    match light.kind {
        LightKind::Point { range_m } => range(range_m),
        LightKind::Spot { range_m, inner_cone_rad, outer_cone_rad } => {
            range(range_m)?;
            check("the inner cone of a light", inner_cone_rad, 0.0, "an angle from 0 up, rad")?;
            check("the outer cone of a light", outer_cone_rad, inner_cone_rad, "an angle from the inner cone up, rad")
        }
        LightKind::Directional => Ok(()),
    }
}

/// Whether a primitive has the texture coordinates that a material reads.
pub(super) fn check_uvs(material: &Material, primitive: &Primitive) -> Result<(), EmbedError> {
    let sets = primitive.uvs.len();
    match material.textures().find(|(_, TextureRef { uv_set, .. })| *uv_set as usize >= sets) {
        Some((slot, TextureRef { uv_set, .. })) => {
            let name = slot.name();
            fault(format!("the {name} texture reads the texture coordinates {uv_set}, of which there are {sets} sets"))
        }
        None => Ok(()),
    }
}

/// Whether materials can sample a texture on its device. Whether floats of 32 bits can be filtered is known to that.
pub(super) fn check_host_texture(texture: &wgpu::Texture) -> Result<(), EmbedError> {
    let format = texture.format();
    let features = wgpu::Features::FLOAT32_FILTERABLE;
    let is_float = wgpu::TextureSampleType::Float { filterable: true };
    let faults = [
        (
            texture.dimension() != wgpu::TextureDimension::D2 || texture.depth_or_array_layers() != 1,
            "is not one picture",
        ),
        (texture.sample_count() != 1, "has several samples a pixel"),
        (!texture.usage().contains(wgpu::TextureUsages::TEXTURE_BINDING), "was not made to be bound"),
        (format.sample_type(None, Some(features)) != Some(is_float), "cannot be filtered"),
    ];
    match faults.into_iter().find(|(is_fault, _)| *is_fault) {
        Some((_, what)) => fault(format!("the texture of the host {what}")),
        None => Ok(()),
    }
}

fn check_nodes(asset: &Scene) -> Result<(), EmbedError> {
    let count = asset.nodes.len();
    let mut is_child = vec![false; count];
    let mut hang = |node: usize, of: &dyn Fn() -> String| {
        all_below([node], count, || format!("{}: node", of()))?;
        match std::mem::replace(&mut is_child[node], true) {
            true => fault(format!("{}: node {node} hangs in two places", of())),
            false => Ok(()),
        }
    };
    for &root in &asset.roots {
        hang(root, &|| "the roots".to_owned())?;
    }
    for (index, Node { children, mesh, light, parent_from_node, .. }) in asset.nodes.iter().enumerate() {
        // With one parent at most, and none for roots, what hangs on a root is a tree.
        children.iter().try_for_each(|&child| hang(child, &|| format!("node {index}")))?;
        all_below(*mesh, asset.meshes.len(), || format!("node {index}: mesh"))?;
        all_below(*light, asset.lights.len(), || format!("node {index}: light"))?;
        if !parent_from_node.is_finite() {
            return fault(format!("node {index}: the transform is not finite"));
        }
    }
    Ok(())
}

fn check_primitive(primitive: &Primitive) -> Result<(), String> {
    let vertices = primitive.positions.len();
    let lengths = [
        ("normals", primitive.normals.as_ref().map(Vec::len)),
        ("tangents", primitive.tangents.as_ref().map(Vec::len)),
        ("colors", primitive.colors.as_ref().map(Vec::len)),
    ];
    let uvs = primitive.uvs.iter().map(|uvs| ("texture coordinates", Some(uvs.len())));
    for (what, length) in lengths.into_iter().chain(uvs) {
        if length.is_some_and(|length| length != vertices) {
            return Err(format!("{} {what} for {vertices} positions", length.unwrap_or(0)));
        }
    }
    let (indices, shape) = (primitive.indices.len(), primitive.topology.indices_per_shape());
    if !indices.is_multiple_of(shape) {
        return Err(format!("{indices} indices are no multiple of {shape}"));
    }
    match primitive.indices.iter().find(|index| **index as usize >= vertices) {
        Some(index) => Err(format!("index {index} of {vertices} positions")),
        None => Ok(()),
    }
}

fn all_below(
    indices: impl IntoIterator<Item = usize>,
    count: usize,
    what: impl Fn() -> String,
) -> Result<(), EmbedError> {
    match indices.into_iter().find(|&index| index >= count) {
        Some(index) => fault(format!("{} {index} of {count}", what())),
        None => Ok(()),
    }
}

fn fault(what: String) -> Result<(), EmbedError> {
    Err(EmbedError::Asset(what))
}
