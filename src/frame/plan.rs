//! One view of the drawables: what of them is in the picture, in which order, with which pipelines.

use super::cull::{Culling, Frustum, Seen, clip_from_origin};
use super::depth_order::DepthOrder;
use super::drawables::{Drawable, Drawables};
use super::occlusion::Occlusion;
use crate::scene::{Background, Channel, Topology, View};
use crate::shader::{ForwardFeatures, SceneFeatures};
use glam::Vec3;
use std::fmt;
use std::ops::Range;

/// What distinguishes one forward pipeline from another, beside the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PipelineKey {
    pub features: ForwardFeatures,
    /// Front faces are clockwise: the transform mirrors.
    pub mirrored: bool,
    pub cull_back: bool,
    pub raster: Raster,
}

/// Which fragments a pipeline makes, and what becomes of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Raster {
    /// As the material says: the nearest surfaces, blended ones over them.
    Surface,
    /// All of them, hidden or not, added up.
    Layers,
    /// Depth and coverage alone, a little behind the [`Self::Edges`] that are drawn over them.
    Behind,
    /// Those on the edges of triangles.
    Edges,
}

impl Raster {
    fn of(view: &View, topology: Topology) -> Self {
        match view.channel {
            Some(Channel::Overdraw) => Self::Layers,
            Some(Channel::Wireframe) if topology == Topology::Triangles => Self::Behind,
            _ => Self::Surface,
        }
    }
}

impl PipelineKey {
    /// What is drawn over this, once all is drawn.
    pub fn edges(self) -> Option<Self> {
        (self.raster == Raster::Behind).then_some(Self { raster: Raster::Edges, ..self })
    }
}

/// One draw call.
#[derive(Debug, Clone, PartialEq)]
pub struct Draw {
    /// Index into [`Drawables::draws`].
    pub drawable: usize,
    /// Index into [`FramePlan::pipelines`].
    pub pipeline: usize,
    /// Range in [`FramePlan::visible`].
    pub instances: Range<u32>,
}

/// How a plan is made, beside the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlanOptions {
    /// Samples a pixel of the target: what lies between them is not drawn.
    pub samples: u32,
    pub culling: Culling,
}

/// Of a number of things, how many are drawn, and why the others are not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Culled {
    pub all: u32,
    /// Beside the picture, before the near plane or beyond the far one.
    pub outside: u32,
    /// So small that they lie between the samples.
    pub between_samples: u32,
    /// Behind others.
    pub hidden: u32,
}

impl Culled {
    pub fn drawn(self) -> u32 {
        self.all - self.outside - self.between_samples - self.hidden
    }
}

/// The frame in the order in which it is drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FramePlan {
    /// Distinct and sorted: those of all drawables, so that turning the camera compiles nothing.
    pub pipelines: Vec<PipelineKey>,
    /// Front to back, and the instances of each front to back.
    pub opaque: Vec<Draw>,
    /// Whether the panorama is drawn behind the opaque surfaces.
    pub panorama: bool,
    /// Back to front; neighbours of one drawable share a call.
    pub blended: Vec<Draw>,
    /// Indices into [`Drawables::instances`], draw by draw.
    pub visible: Vec<u32>,
    /// Of [`Drawables::draws`].
    pub drawables: Culled,
    /// Of [`Drawables::placements`].
    pub placements: Culled,
}

/// Plans a frame.
pub fn plan(drawables: &Drawables, scene: SceneFeatures, view: &View, options: PlanOptions) -> FramePlan {
    let mut plan = FramePlan::default();
    Planner::default().plan(drawables, scene, view, options, &mut plan);
    plan
}

/// What the shader of a drawable does in a view.
pub fn forward_features(scene: SceneFeatures, view: &View, drawable: &Drawable) -> ForwardFeatures {
    ForwardFeaturesOfView::new(scene, view).key(drawable).features
}

/// Plans frame after frame of one scene, without allocating once it has seen the largest.
#[derive(Debug, Default)]
pub struct Planner {
    /// What the pipelines depend on, and the pipeline of each drawable.
    shaders: Option<ForwardFeaturesOfView>,
    pipeline_of: Vec<usize>,
    occlusion: Occlusion,
    order: DepthOrder,
    blended: Vec<Blended>,
}

/// A blended primitive at one place.
#[derive(Debug, Clone, Copy)]
struct Blended {
    depth: f32,
    drawable: u32,
    placement: u32,
}

/// The part of the shaders' features that the view chooses.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ForwardFeaturesOfView {
    scene: SceneFeatures,
    energy_compensation: bool,
    geometry: crate::scene::Geometry,
    quality: crate::scene::Quality,
    term: Option<crate::scene::Term>,
    channel: bool,
    /// Of triangles, and of lines and points.
    rasters: [Raster; 2],
}

impl ForwardFeaturesOfView {
    fn new(scene: SceneFeatures, view: &View) -> Self {
        Self {
            scene,
            energy_compensation: view.energy_compensation,
            geometry: view.geometry,
            quality: view.quality,
            term: view.term,
            channel: view.channel.is_some(),
            rasters: [Topology::Triangles, Topology::Points].map(|topology| Raster::of(view, topology)),
        }
    }

    fn key(self, drawable: &Drawable) -> PipelineKey {
        let Self { scene, energy_compensation, geometry, quality, term, channel, rasters } = self;
        let is_filled = drawable.topology == Topology::Triangles;
        let features = ForwardFeatures {
            scene,
            material: drawable.material_features,
            vertex: drawable.vertex_features,
            energy_compensation,
            geometry,
            quality,
            term,
            topology: drawable.topology,
            channel,
        };
        let cull_back = !features.material.double_sided && is_filled;
        let raster = rasters[usize::from(!is_filled)];
        PipelineKey { features, mirrored: drawable.mirrored && is_filled, cull_back, raster }
    }
}

impl Planner {
    /// Replaces what is in `plan`, which this planner has made before or nobody has. A planner serves one scene. Returns
    /// whether the pipelines are others than before.
    pub fn plan(
        &mut self,
        drawables: &Drawables,
        scene: SceneFeatures,
        view: &View,
        options: PlanOptions,
        plan: &mut FramePlan,
    ) -> bool {
        let other_pipelines = self.choose_pipelines(drawables, ForwardFeaturesOfView::new(scene, view), plan);
        plan.opaque.clear();
        plan.blended.clear();
        plan.visible.clear();
        self.blended.clear();
        plan.drawables = Culled { all: drawables.draws.len() as u32, ..Default::default() };
        plan.placements = Culled { all: drawables.placements.instances.len() as u32, ..Default::default() };
        // A panorama is radiance.
        plan.panorama = view.background == Background::Environment && scene.environment && view.channel.is_none();

        let clip_from_origin = clip_from_origin(view, drawables.origin_in_world);
        let frustum = Frustum::new(clip_from_origin, view.size_px, options.samples);
        // Channels draw what is hidden too, and wider than it is.
        let hides = options.culling == Culling::On && view.channel.is_none() && !drawables.occluders.is_empty();
        if hides {
            self.occlusion.look(drawables, &frustum);
        } else {
            self.occlusion.clear();
        }
        let frustum = (options.culling != Culling::Off).then_some(&frustum);
        let forward = view.camera.forward_in_world().as_vec3();
        for (index, drawable) in drawables.draws.iter().enumerate() {
            self.look(drawables, (index, drawable), (frustum, forward), plan);
        }
        self.sort_opaque(drawables, forward, plan);
        self.emit_blended(drawables, plan);
        other_pipelines
    }

    fn choose_pipelines(
        &mut self,
        drawables: &Drawables,
        of_view: ForwardFeaturesOfView,
        plan: &mut FramePlan,
    ) -> bool {
        if self.shaders == Some(of_view) && self.pipeline_of.len() == drawables.draws.len() {
            return false;
        }
        let keys: Vec<PipelineKey> = drawables.draws.iter().map(|drawable| of_view.key(drawable)).collect();
        plan.pipelines.clone_from(&keys);
        plan.pipelines.sort_unstable();
        plan.pipelines.dedup();
        let place = |key| plan.pipelines.binary_search(key).unwrap_or_else(|insertion| insertion);
        self.pipeline_of = keys.iter().map(place).collect();
        self.shaders = Some(of_view);
        true
    }

    /// Finds what of a drawable is in the picture. Without a frustum, all of it is drawn.
    fn look(
        &mut self,
        drawables: &Drawables,
        (index, drawable): (usize, &Drawable),
        (frustum, forward): (Option<&Frustum>, Vec3),
        plan: &mut FramePlan,
    ) {
        let count = drawable.placements.len() as u32;
        if frustum.is_some_and(|frustum| frustum.is_outside(drawable.bounds)) {
            plan.placements.outside += count;
            plan.drawables.outside += 1;
            return;
        }
        // Of a single placement the same box is looked at below.
        if count > 1 && frustum.is_some_and(|frustum| self.occlusion.hides(frustum, drawable.bounds)) {
            plan.placements.hidden += count;
            plan.drawables.hidden += 1;
            return;
        }
        let before = plan.placements;
        let boxes = &drawables.placements.boxes;
        let depth = |placement: usize| forward.dot(boxes.get(placement).0);
        let (nearest, farthest) = depths(drawable.bounds, forward);
        let per_depth = 1.0 / (farthest - nearest).max(f32::MIN_POSITIVE);
        self.order.clear();
        let mut each = |placement: usize, seen: Seen| match seen {
            Seen::Outside => plan.placements.outside += 1,
            Seen::BetweenSamples => plan.placements.between_samples += 1,
            Seen::Perhaps if frustum.is_some_and(|frustum| self.occlusion.hides(frustum, boxes.get(placement))) => {
                plan.placements.hidden += 1;
            }
            Seen::Perhaps if drawable.is_blended() => {
                let (depth, drawable, placement) = (depth(placement), index as u32, placement as u32);
                self.blended.push(Blended { depth, drawable, placement });
            }
            Seen::Perhaps => self.order.push(placement as u32, (depth(placement) - nearest) * per_depth),
        };
        match frustum {
            Some(frustum) => {
                let is_filled = drawable.topology == Topology::Triangles;
                frustum.classify((boxes, drawable.bounds), drawable.placements.clone(), is_filled, each);
            }
            None => drawable.placements.clone().for_each(|placement| each(placement, Seen::Perhaps)),
        }
        let (now, is_drawn) = (plan.placements, plan.placements.drawn() + count > before.drawn());
        match is_drawn {
            true => {}
            false if now.hidden > before.hidden => plan.drawables.hidden += 1,
            false if now.between_samples > before.between_samples => plan.drawables.between_samples += 1,
            false => plan.drawables.outside += 1,
        }
        if !self.order.is_empty() {
            let first = plan.visible.len() as u32;
            let instance = |placement: u32| drawables.placements.instances[placement as usize];
            self.order.append_sorted(&mut plan.visible, instance);
            let instances = first..plan.visible.len() as u32;
            plan.opaque.push(Draw { drawable: index, pipeline: self.pipeline_of[index], instances });
        }
    }

    /// By the depth of the middle of all that a drawable has: what is culled does not change the order, and so not which of
    /// two surfaces at the very same depth is seen. Pipelines decide among equals only: what a change of pipeline costs is
    /// little beside pixels that are shaded in vain (docs/performance.md).
    fn sort_opaque(&self, drawables: &Drawables, forward: Vec3, plan: &mut FramePlan) {
        let depth = |draw: &Draw| forward.dot(drawables.draws[draw.drawable].bounds.0);
        plan.opaque.sort_unstable_by(|a, b| {
            let order = depth(a).total_cmp(&depth(b)).then(a.pipeline.cmp(&b.pipeline));
            order.then(a.drawable.cmp(&b.drawable))
        });
    }

    fn emit_blended(&mut self, drawables: &Drawables, plan: &mut FramePlan) {
        self.blended.sort_unstable_by(|a, b| {
            let order = b.depth.total_cmp(&a.depth);
            order.then(a.drawable.cmp(&b.drawable)).then(a.placement.cmp(&b.placement))
        });
        for run in self.blended.chunk_by(|a, b| a.drawable == b.drawable) {
            let first = plan.visible.len() as u32;
            plan.visible.extend(run.iter().map(|found| drawables.placements.instances[found.placement as usize]));
            let drawable = run[0].drawable as usize;
            let instances = first..plan.visible.len() as u32;
            plan.blended.push(Draw { drawable, pipeline: self.pipeline_of[drawable], instances });
        }
    }
}

/// Depths between which a box lies.
fn depths((center, half): (Vec3, Vec3), forward: Vec3) -> (f32, f32) {
    let (middle, reach) = (forward.dot(center), forward.abs().dot(half));
    (middle - reach, middle + reach)
}

impl fmt::Display for FramePlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "pipelines: {}", self.pipelines.len())?;
        for (index, key) in self.pipelines.iter().enumerate() {
            let mirrored = if key.mirrored { " mirrored" } else { "" };
            writeln!(f, "  {index}: {}{mirrored}", key.features)?;
        }
        writeln!(f, "drawables: {}", self.drawables)?;
        writeln!(f, "placements: {}", self.placements)?;
        let name = |draw: &Draw| match draw.instances.len() {
            1 => format!("{}@{}", draw.drawable, draw.pipeline),
            count => format!("{}x{count}@{}", draw.drawable, draw.pipeline),
        };
        let list = |draws: &[Draw]| draws.iter().map(name).collect::<Vec<_>>().join(" ");
        writeln!(f, "opaque (drawable x instances @ pipeline): {}", list(&self.opaque))?;
        writeln!(f, "panorama: {}", if self.panorama { "drawn" } else { "not drawn" })?;
        write!(f, "blended, back to front: {}", list(&self.blended))
    }
}

impl fmt::Display for Culled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { all, outside, between_samples, hidden } = self;
        let drawn = self.drawn();
        write!(f, "{drawn} of {all} drawn, {outside} outside of the picture, {between_samples} between its samples, ")?;
        write!(f, "{hidden} hidden")
    }
}
