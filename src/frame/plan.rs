//! One view of the drawables: order and pipelines.

use super::drawables::Drawables;
use crate::scene::{Background, Topology, View};
use crate::shader::{Alpha, ForwardFeatures, SceneFeatures};
use std::fmt;

/// What distinguishes one forward pipeline from another, beside the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PipelineKey {
    pub features: ForwardFeatures,
    /// Front faces are clockwise: the transform mirrors.
    pub mirrored: bool,
    pub cull_back: bool,
}

/// One draw call.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Draw {
    /// Index into [`Drawables::draws`].
    pub drawable: usize,
    /// Index into [`FramePlan::pipelines`].
    pub pipeline: usize,
}

/// The frame in the order in which it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct FramePlan {
    pub scene: SceneFeatures,
    /// Distinct and sorted.
    pub pipelines: Vec<PipelineKey>,
    /// By pipeline, then front to back.
    pub opaque: Vec<Draw>,
    /// Whether the panorama is drawn behind the opaque surfaces.
    pub panorama: bool,
    /// Back to front.
    pub blended: Vec<Draw>,
}

/// Plans a frame.
pub fn plan(drawables: &Drawables, scene: SceneFeatures, view: &View) -> FramePlan {
    let keys: Vec<PipelineKey> = drawables
        .draws
        .iter()
        .map(|drawable| {
            let features = ForwardFeatures {
                scene,
                material: drawable.material_features,
                vertex: drawable.vertex_features,
                energy_compensation: view.energy_compensation,
                geometry: view.geometry,
                quality: view.quality,
                term: view.term,
                topology: drawable.topology,
                channel: view.channel.is_some(),
            };
            let cull_back = !features.material.double_sided && drawable.topology == Topology::Triangles;
            PipelineKey { features, mirrored: drawable.mirrored && drawable.topology == Topology::Triangles, cull_back }
        })
        .collect();
    let mut pipelines = keys.clone();
    pipelines.sort_unstable();
    pipelines.dedup();

    let eye = view.camera.position_in_world();
    let forward = view.camera.forward_in_world();
    let depth = |draw: &Draw| (drawables.draws[draw.drawable].center_in_world - eye).dot(forward);
    let draws = keys.iter().enumerate().map(|(drawable, key)| Draw {
        drawable,
        pipeline: pipelines.binary_search(key).unwrap_or_else(|insertion| insertion),
    });
    let (mut blended, mut opaque): (Vec<Draw>, Vec<Draw>) =
        draws.partition(|draw| keys[draw.drawable].features.material.alpha == Alpha::Blend);
    opaque.sort_by(|a, b| a.pipeline.cmp(&b.pipeline).then(depth(a).total_cmp(&depth(b))));
    blended.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
    // A panorama is radiance.
    let panorama = view.background == Background::Environment && scene.environment && view.channel.is_none();
    FramePlan { scene, pipelines, opaque, panorama, blended }
}

impl fmt::Display for FramePlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "pipelines: {}", self.pipelines.len())?;
        for (index, key) in self.pipelines.iter().enumerate() {
            let mirrored = if key.mirrored { " mirrored" } else { "" };
            writeln!(f, "  {index}: {}{mirrored}", key.features)?;
        }
        let list = |draws: &[Draw]| {
            draws.iter().map(|draw| format!("{}@{}", draw.drawable, draw.pipeline)).collect::<Vec<_>>().join(" ")
        };
        writeln!(f, "opaque (drawable@pipeline): {}", list(&self.opaque))?;
        writeln!(f, "panorama: {}", if self.panorama { "drawn" } else { "not drawn" })?;
        write!(f, "blended, back to front: {}", list(&self.blended))
    }
}
