//! What cannot be in the picture: boxes outside of it, and boxes between its samples.

use super::boxes::Boxes;
use crate::scene::View;
use glam::{DMat4, DVec2, DVec3, DVec4, Mat4, UVec2, Vec3, Vec4};
use std::ops::Range;

/// How far a clip coordinate may be off, of the sum of its terms' sizes: four products and three sums make at most 4
/// steps of f32, here as on the GPU, and the rest is room.
const ROUNDING: f32 = 16.0 * f32::EPSILON;

/// Pixels by which the picture is taken to be larger on each side: points and lines are wider than their vertices, and
/// rasterisers round places in the picture.
pub(super) const BORDER_PX: f64 = 2.0;

/// Vulkan lets a rasteriser round places in the picture to this, px; WebGPU's other backends to less.
const SNAP_PX: f64 = 1.0 / 16.0;

/// Boxes are tested in runs of this many, whose results stay in registers and the nearest cache.
const RUN: usize = 256;

/// What is left out. Others than `On` are for measuring and testing: the picture is the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Culling {
    #[default]
    On,
    /// All but what is hidden behind other things.
    NotHidden,
    Off,
}

impl Culling {
    /// The same, but with what is hidden.
    pub fn but_hidden(self) -> Self {
        if self == Self::On { Self::NotHidden } else { self }
    }
}

/// `clip_from_origin`: what every vertex is multiplied with, around the scene's origin so that float32 suffices.
pub fn clip_from_origin(view: &View, origin_in_world: DVec3) -> Mat4 {
    let mut camera = view.camera.clone();
    camera.world_from_view.w_axis = (camera.position_in_world() - origin_in_world).extend(1.0);
    (camera.clip_from_view(view.size_px).as_dmat4() * camera.world_from_view.inverse()).as_mat4()
}

/// Where a box is. Each is proven: a box is called `Outside` or `BetweenSamples` only if nothing in it makes a fragment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Seen {
    Perhaps,
    Outside,
    BetweenSamples,
}

/// Where a box can be in the picture, px from the top left, and how near, as z / w.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shadow {
    pub(super) low: DVec2,
    pub(super) high: DVec2,
    pub(super) nearest: f64,
}

/// The half-space `normal . p + offset >= 0`, in which all is that one side of the picture leaves visible.
#[derive(Debug, Clone, Copy)]
struct Side {
    normal: Vec3,
    offset: f32,
    /// Sizes of the terms that make up normal and offset: where they cancel, their rounding stays.
    sizes: Vec4,
}

/// What a view sees, around the scene's origin.
#[derive(Debug, Clone)]
pub(super) struct Frustum {
    sides: [Side; 6],
    pub(super) clip_from_origin: DMat4,
    pub(super) size_px: UVec2,
    /// Where the samples of a pixel are; empty where that is not known.
    samples: &'static [DVec2],
}

/// The sides of a picture with room for the rounding of whatever lies in one box.
#[derive(Debug, Clone, Copy)]
struct Sides([(Vec3, f32); 6]);

/// The place of the only sample, and of the four that WebGPU prescribes.
const ONE_SAMPLE: [DVec2; 1] = [DVec2::splat(0.5)];
const FOUR_SAMPLES: [DVec2; 4] =
    [DVec2::new(0.375, 0.125), DVec2::new(0.875, 0.375), DVec2::new(0.125, 0.625), DVec2::new(0.625, 0.875)];

impl Shadow {
    /// How much of a picture it takes up, of all.
    pub(super) fn share(&self, size_px: UVec2) -> f32 {
        let size = size_px.as_dvec2();
        let part = (self.high.min(size) - self.low.max(DVec2::ZERO)).max(DVec2::ZERO) / size;
        part.element_product() as f32
    }
}

impl Sides {
    /// Whether all of a box is outside of one side.
    fn exclude(&self, (center, half): (Vec3, Vec3)) -> bool {
        self.0.iter().any(|(normal, offset)| normal.dot(center) + normal.abs().dot(half) + offset < 0.0)
    }
}

impl Frustum {
    /// What `clip_from_origin` sees, with `samples` samples a pixel.
    pub(super) fn new(clip_from_origin: Mat4, size_px: UVec2, samples: u32) -> Self {
        let clip = clip_from_origin.as_dmat4();
        let [x, y, z, w] = [0, 1, 2, 3].map(|row| clip.row(row));
        let side = |a: DVec4, b: DVec4| {
            let plane = a + b;
            let (normal, offset) = (plane.truncate().as_vec3(), plane.w as f32);
            Side { normal, offset, sizes: (a.abs() + b.abs()).as_vec4() }
        };
        let border = 1.0 + 2.0 * BORDER_PX / size_px.as_dvec2();
        let (wide, high) = (border.x * w, border.y * w);
        Self {
            sides: [side(wide, x), side(wide, -x), side(high, y), side(high, -y), side(w, -z), side(z, DVec4::ZERO)],
            clip_from_origin: clip,
            size_px,
            samples: match samples {
                1 => &ONE_SAMPLE,
                4 => &FOUR_SAMPLES,
                _ => &[],
            },
        }
    }

    /// The sides for what lies in a box.
    fn sides(&self, (center, half): (Vec3, Vec3)) -> Sides {
        let reach = (center.abs() + half).extend(1.0);
        Sides(self.sides.map(|Side { normal, offset, sizes }| (normal, offset + ROUNDING * sizes.dot(reach))))
    }

    /// Whether nothing in a box is seen.
    pub(super) fn is_outside(&self, bounds: (Vec3, Vec3)) -> bool {
        self.sides(bounds).exclude(bounds)
    }

    /// Tells `each` of every box in `range` where it is, in their order. All are in `bounds`. `filled`: what is drawn has
    /// no width beyond its vertices, so that it may fall between samples.
    pub(super) fn classify(
        &self,
        (boxes, bounds): (&Boxes, (Vec3, Vec3)),
        range: Range<usize>,
        filled: bool,
        mut each: impl FnMut(usize, Seen),
    ) {
        let sides = self.sides(bounds);
        let mut start = range.start;
        while start < range.end {
            let end = range.end.min(start + RUN);
            let mut outside = [false; RUN];
            mark_outside(&sides, boxes, start..end, &mut outside);
            for index in start..end {
                let seen = match outside[index - start] {
                    true => Seen::Outside,
                    false if filled && self.is_between_samples(boxes.get(index)) => Seen::BetweenSamples,
                    false => Seen::Perhaps,
                };
                each(index, seen);
            }
            start = end;
        }
    }

    /// Whether a box's shadow on the picture contains no sample, wherever in it the rasteriser rounds its vertices to.
    fn is_between_samples(&self, bounds: (Vec3, Vec3)) -> bool {
        let (false, Some(extents)) = (self.samples.is_empty(), self.extents(bounds)) else { return false };
        let mut low = DVec2::ZERO;
        let mut high = DVec2::ZERO;
        for axis in 0..2 {
            let extent = extents.of(axis);
            if extent.half * f64::from(self.size_px[axis]) > extents.near_w {
                // Wider than a pixel, which has a sample.
                return false;
            }
            [low[axis], high[axis]] = self.px(axis, extents.over_w(extent));
        }
        let (low, high) = (low - SNAP_PX, high + SNAP_PX);
        // A sample lies at a whole number beside its place in the pixel.
        let is_inside = |&sample: &DVec2| (low - sample).ceil().cmple((high - sample).floor()).all();
        !self.samples.iter().any(is_inside)
    }

    /// Where the fragments of what is in a box can be, if all of it is before the eye.
    pub(super) fn shadow(&self, bounds: (Vec3, Vec3)) -> Option<Shadow> {
        let extents = self.extents(bounds)?;
        let [[left, right], [top, bottom]] = [0, 1].map(|axis| self.px(axis, extents.over_w(extents.of(axis))));
        let (low, high) = (DVec2::new(left, top), DVec2::new(right, bottom));
        Some(Shadow { low, high, nearest: extents.over_w(extents.of(2))[1] })
    }

    /// Tells `each` of every box in `range` that may take up more than this share of the picture, if all of it is before
    /// the eye.
    pub(super) fn large(&self, boxes: &Boxes, range: Range<usize>, share: f32, mut each: impl FnMut(usize)) {
        let [x, y, w] = [0, 1, 3].map(|row| self.clip_from_origin.row(row).as_vec4());
        let (size, toward) = (x.truncate().length() * y.truncate().length(), w.truncate().abs());
        let mut start = range.start;
        while start < range.end {
            let end = range.end.min(start + RUN);
            let [[cx, cy, cz], [hx, hy, hz]] = boxes.slices(start..end);
            let mut is_large = [false; RUN];
            for (i, is_large) in is_large.iter_mut().enumerate().take(end - start) {
                let near = w.x * cx[i] + w.y * cy[i] + w.z * cz[i] + w.w
                    - (toward.x * hx[i] + toward.y * hy[i] + toward.z * hz[i]);
                let reach = hx[i] * hx[i] + hy[i] * hy[i] + hz[i] * hz[i];
                *is_large = near > 0.0 && reach * size > share * near * near;
            }
            (start..end).zip(is_large).filter(|(_, is_large)| *is_large).for_each(|(index, _)| each(index));
            start = end;
        }
    }

    /// From the top or the left, of what is from one to another coordinate divided by w.
    fn px(&self, axis: usize, [least, most]: [f64; 2]) -> [f64; 2] {
        let size = f64::from(self.size_px[axis]);
        // Rows count downward.
        let ndc = if axis == 1 { [-most, -least] } else { [least, most] };
        ndc.map(|ndc| 0.5 * (ndc + 1.0) * size)
    }

    /// `None` for a box that is not all before the eye.
    fn extents(&self, (center, half): (Vec3, Vec3)) -> Option<Extents<'_>> {
        let (center, half) = (center.as_dvec3(), half.as_dvec3());
        let reach = (center.abs() + half).extend(1.0);
        let none = Extents { clip_from_origin: &self.clip_from_origin, center, half, reach, near_w: 0.0, far_w: 0.0 };
        let w = none.of(3);
        let (near_w, far_w) = (w.middle - w.half, w.middle + w.half);
        // Also where it is no number.
        (near_w > 0.0).then_some(Extents { near_w, far_w, ..none })
    }
}

/// Between which clip coordinates a box is, worked out when they are asked for.
#[derive(Debug, Clone, Copy)]
struct Extents<'a> {
    clip_from_origin: &'a DMat4,
    center: DVec3,
    half: DVec3,
    reach: DVec4,
    near_w: f64,
    far_w: f64,
}

/// Of one clip coordinate.
#[derive(Debug, Clone, Copy)]
struct Extent {
    middle: f64,
    half: f64,
}

impl Extents<'_> {
    /// With room for rounding.
    fn of(&self, row: usize) -> Extent {
        let row = self.clip_from_origin.row(row);
        let half = spread(row, self.half, self.reach);
        Extent { middle: row.truncate().dot(self.center) + row.w, half }
    }

    /// The least and the most of a coordinate divided by w.
    fn over_w(&self, Extent { middle, half }: Extent) -> [f64; 2] {
        let (least, most) = (middle - half, middle + half);
        [(least / self.near_w).min(least / self.far_w), (most / self.near_w).max(most / self.far_w)]
    }
}

/// How far from its middle a clip coordinate, a `row`, may be where a point may be `half` from the middle and its coordinates
/// are at most as large as `reach`: rounding included.
pub(super) fn spread(row: DVec4, half: DVec3, reach: DVec4) -> f64 {
    row.truncate().abs().dot(half) + f64::from(ROUNDING) * row.abs().dot(reach)
}

/// [`Sides::exclude`] of many boxes: plain loops over arrays, which the compiler turns into SIMD.
fn mark_outside(sides: &Sides, boxes: &Boxes, range: Range<usize>, outside: &mut [bool; RUN]) {
    let count = range.len();
    let [[cx, cy, cz], [hx, hy, hz]] = boxes.slices(range);
    let (cx, cy, cz) = (&cx[..count], &cy[..count], &cz[..count]);
    let (hx, hy, hz) = (&hx[..count], &hy[..count], &hz[..count]);
    for &(n, offset) in &sides.0 {
        let a = n.abs();
        for i in 0..count {
            let reach = n.x * cx[i] + n.y * cy[i] + n.z * cz[i] + a.x * hx[i] + a.y * hy[i] + a.z * hz[i] + offset;
            outside[i] |= reach < 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Bounds, Camera, Projection, framing};

    fn view(projection: Projection) -> View {
        let camera = Camera::look_at(DVec3::new(0.0, 0.0, 10.0), DVec3::ZERO, DVec3::Y, projection, 0.5, 30.0);
        View { camera, ..framing::default_view(&Default::default(), UVec2::new(200, 100)) }
    }

    fn boxes(places: &[(DVec3, f64)]) -> Boxes {
        let mut boxes = Boxes::default();
        for &(center, half) in places {
            let bounds = Bounds { min: DVec3::splat(-half), max: DVec3::splat(half) };
            boxes.push(&bounds, &DMat4::from_translation(center));
        }
        boxes
    }

    fn seen(view: &View, boxes: &Boxes, samples: u32) -> Vec<Seen> {
        let frustum = Frustum::new(clip_from_origin(view, DVec3::ZERO), view.size_px, samples);
        let mut all = Vec::new();
        let bounds = boxes.union(0..boxes.len());
        frustum.classify((boxes, bounds), 0..boxes.len(), true, |index, seen| {
            assert_eq!(index, all.len());
            assert!(seen != Seen::Outside || frustum.is_outside(boxes.get(index)));
            all.push(seen);
        });
        all
    }

    #[test]
    fn each_side_of_the_picture_hides_what_is_behind_it() {
        // Half a height of 5 at the origin, half a width of 10, in both projections.
        let fov_y_rad = 2.0 * (0.5_f64).atan();
        for projection in [Projection::Perspective { fov_y_rad }, Projection::Orthographic { height_m: 10.0 }] {
            let places = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y].map(|axis| axis * DVec3::new(10.0, 5.0, 0.0));
            let inside: Vec<(DVec3, f64)> = places.iter().map(|&edge| (edge * 1.09, 1.0)).collect();
            let outside: Vec<(DVec3, f64)> = places.iter().map(|&edge| (edge * 1.5, 1.0)).collect();
            let view = view(projection);
            assert!(seen(&view, &boxes(&inside), 1).iter().all(|&seen| seen == Seen::Perhaps), "{projection:?}");
            assert!(seen(&view, &boxes(&outside), 1).iter().all(|&seen| seen == Seen::Outside), "{projection:?}");
            // Before the near plane, and behind the camera.
            let near = [(DVec3::Z * 9.8, 0.2), (DVec3::Z * 20.0, 1.0), (DVec3::Z * 9.6, 0.2)];
            assert_eq!(seen(&view, &boxes(&near), 1), [Seen::Outside, Seen::Outside, Seen::Perhaps]);
            // The far plane of a perspective is at infinity.
            let far = seen(&view, &boxes(&[(DVec3::Z * -30.0, 1.0), (DVec3::Z * -19.0, 1.5)]), 1);
            let behind =
                if matches!(projection, Projection::Orthographic { .. }) { Seen::Outside } else { Seen::Perhaps };
            assert_eq!(far, [behind, Seen::Perhaps]);
        }
    }

    #[test]
    fn small_boxes_are_dropped_between_samples_only() {
        // Ten pixels a metre: pixel centres at odd multiples of 0.05 m.
        let view = view(Projection::Orthographic { height_m: 10.0 });
        let at = |x: f64, y: f64, half: f64| boxes(&[(DVec3::new(x, y, 0.0), half)]);
        assert_eq!(seen(&view, &at(0.05, 0.05, 0.01), 1), [Seen::Perhaps]);
        assert_eq!(seen(&view, &at(0.0, 0.05, 0.01), 1), [Seen::BetweenSamples]);
        assert_eq!(seen(&view, &at(0.05, 0.0, 0.01), 1), [Seen::BetweenSamples]);
        // Within the grid that vertices are rounded to of a sample.
        assert_eq!(seen(&view, &at(0.0, 0.05, 0.045), 1), [Seen::Perhaps]);
        // One pixel wide: it has a sample wherever it is.
        assert_eq!(seen(&view, &at(0.0, 0.0, 0.051), 1), [Seen::Perhaps]);
        // The middle is no sample of four, and their places are: 0.375, 0.125 from the top left of pixel (100, 50).
        assert_eq!(seen(&view, &at(0.05, -0.05, 0.005), 4), [Seen::BetweenSamples]);
        assert_eq!(seen(&view, &at(0.0375, -0.0125, 0.005), 4), [Seen::Perhaps]);
        assert_eq!(seen(&view, &at(0.0125, -0.0375, 0.005), 4), [Seen::BetweenSamples]);
        // Nothing is known of other patterns.
        assert_eq!(seen(&view, &at(0.0, 0.05, 0.01), 8), [Seen::Perhaps]);
    }

    /// Where float32 puts a point of the picture, px; `None` where it is clipped.
    fn pixel(clip: Mat4, point: Vec3, size_px: UVec2) -> Option<DVec2> {
        let clip = (clip * point.extend(1.0)).as_dvec4();
        let inside =
            clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && (0.0..=clip.w).contains(&clip.z);
        let ndc = DVec2::new(clip.x, -clip.y) / clip.w;
        inside.then(|| 0.5 * (ndc + 1.0) * size_px.as_dvec2())
    }

    #[test]
    fn no_point_of_a_culled_box_is_seen_and_few_boxes_are_kept_for_nothing() {
        let noise = |i: u32, salt: u32| {
            let mixed = (i.wrapping_mul(0x9E37_79B9) ^ salt.wrapping_mul(0x85EB_CA6B)).wrapping_mul(0xC2B2_AE35);
            f64::from((mixed ^ mixed >> 15).wrapping_mul(0x27D4_EB2F) >> 8) / f64::from(1 << 23) - 1.0
        };
        let vector = |i, salt| DVec3::new(noise(i, salt), noise(i, salt + 1), noise(i, salt + 2));
        for projection in [Projection::Perspective { fov_y_rad: 0.9 }, Projection::Orthographic { height_m: 10.0 }] {
            let view = view(projection);
            let places: Vec<(DVec3, f64)> =
                (0..4000).map(|i| (vector(i, 1) * 12.0, 10.0_f64.powf(2.0 * noise(i, 7) - 2.0))).collect();
            let (boxes, clip) = (boxes(&places), clip_from_origin(&view, DVec3::ZERO));
            let (mut culled, mut kept_for_nothing) = (0, 0);
            for (i, seen) in (0..).zip(seen(&view, &boxes, 1)) {
                let (center, half) = places[i as usize];
                let point = |k: u32| (center + vector(i * 64 + k, 11) * half).as_vec3();
                let pixels: Vec<DVec2> = (0..64).filter_map(|k| pixel(clip, point(k), view.size_px)).collect();
                let low = pixels.iter().fold(DVec2::INFINITY, |low, &pixel| low.min(pixel));
                let high = pixels.iter().fold(DVec2::NEG_INFINITY, |high, &pixel| high.max(pixel));
                let has_sample = (low - 0.5).ceil().cmple((high - 0.5).floor()).all();
                culled += u32::from(seen != Seen::Perhaps);
                match seen {
                    Seen::Outside => assert!(pixels.is_empty(), "{projection:?}: box {i} is at {low}"),
                    Seen::BetweenSamples => assert!(!has_sample, "{projection:?}: box {i} from {low} to {high}"),
                    Seen::Perhaps => kept_for_nothing += u32::from(!has_sample),
                }
            }
            assert!(culled > 2000 && kept_for_nothing < 400, "{projection:?}: {culled}, {kept_for_nothing}");
        }
    }

    #[test]
    fn infinite_boxes_and_boxes_around_the_eye_are_kept() {
        let mut boxes = boxes(&[(DVec3::Z * 10.0, 1.0), (DVec3::ZERO, 1e6)]);
        boxes.push(&Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE }, &DMat4::from_scale(DVec3::splat(1e300)));
        let seen = seen(&view(Projection::Perspective { fov_y_rad: 0.1 }), &boxes, 1);
        assert!(seen.iter().all(|&seen| seen == Seen::Perhaps), "{seen:?}");
    }
}
