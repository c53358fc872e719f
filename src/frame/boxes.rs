//! Where every placed primitive can be, as boxes side by side: made once, tested every frame.

use crate::scene::Bounds;
use glam::{DMat4, DVec3, Vec3};

/// Steps of f32 that a vertex may be off when a GPU places it: the rounding of the matrix, of the position and of three
/// products and sums, each half a step of the largest of them, come to 4; the rest is room.
const STEPS: f64 = 16.0;
const STEP: f64 = f32::EPSILON as f64;

/// Axis-aligned boxes around the scene's origin, one array a coordinate so that eight are tested at a time.
///
/// A box holds every vertex where float32 arithmetic puts it. One that float32 cannot hold is infinite: no test with it
/// comes out negative, and so it is never culled.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Boxes {
    center: [Vec<f32>; 3],
    half: [Vec<f32>; 3],
}

impl Boxes {
    /// Adds the box of a primitive with bounds `object`, placed by `origin_from_object`.
    pub fn push(&mut self, object: &Bounds, origin_from_object: &DMat4) {
        let (center, half) = held(object, origin_from_object);
        for axis in 0..3 {
            self.center[axis].push(center[axis]);
            self.half[axis].push(half[axis]);
        }
    }

    /// Replaces a box by that of the primitive at another place.
    pub(super) fn set(&mut self, index: usize, object: &Bounds, origin_from_object: &DMat4) {
        let (center, half) = held(object, origin_from_object);
        for axis in 0..3 {
            self.center[axis][index] = center[axis];
            self.half[axis][index] = half[axis];
        }
    }

    pub fn len(&self) -> usize {
        self.center[0].len()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Centre and half extent of a box.
    pub fn get(&self, index: usize) -> (Vec3, Vec3) {
        let at = |arrays: &[Vec<f32>; 3]| Vec3::new(arrays[0][index], arrays[1][index], arrays[2][index]);
        (at(&self.center), at(&self.half))
    }

    /// Coordinates of the centres and half extents of the boxes in a range.
    pub(super) fn slices(&self, range: std::ops::Range<usize>) -> [[&[f32]; 3]; 2] {
        [&self.center, &self.half].map(|arrays| [0, 1, 2].map(|axis: usize| &arrays[axis][range.clone()]))
    }

    /// The box around the boxes in a range.
    pub(super) fn union(&self, range: std::ops::Range<usize>) -> (Vec3, Vec3) {
        let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for index in range {
            let (center, half) = self.get(index);
            (min, max) = (min.min(center - half), max.max(center + half));
        }
        let center = 0.5 * min + 0.5 * max;
        if center.is_finite() { (center, (max - center).max(center - min)) } else { (Vec3::ZERO, Vec3::INFINITY) }
    }
}

/// Centre and half extent of a placed box in f32, infinite where that cannot hold it.
fn held(object: &Bounds, origin_from_object: &DMat4) -> (Vec3, Vec3) {
    let (center, half) = placed(object, origin_from_object);
    let fits = center.is_finite() && half.is_finite() && (center.abs() + half).max_element() < f64::from(f32::MAX);
    if fits { (center.as_vec3(), half.as_vec3()) } else { (Vec3::ZERO, Vec3::INFINITY) }
}

/// Centre and half extent of a placed box, the latter with room for all rounding on the way to a vertex's place.
fn placed(object: &Bounds, origin_from_object: &DMat4) -> (DVec3, DVec3) {
    let center = origin_from_object.transform_point3(object.center());
    let half = absolute(origin_from_object, 0.5 * (object.max - object.min));
    (center, half + rounding(object, origin_from_object))
}

/// How far from where it should be a GPU may put a vertex, on each axis.
pub(super) fn rounding(object: &Bounds, origin_from_object: &DMat4) -> DVec3 {
    // What is added up to one coordinate: large terms that cancel leave their rounding behind.
    let reach = object.min.abs().max(object.max.abs());
    let summed = absolute(origin_from_object, reach) + origin_from_object.w_axis.truncate().abs();
    STEPS * STEP * summed + f64::from(f32::MIN_POSITIVE)
}

/// The product with the sizes of a matrix's numbers, without its translation.
fn absolute(matrix: &DMat4, v: DVec3) -> DVec3 {
    matrix.x_axis.truncate().abs() * v.x + matrix.y_axis.truncate().abs() * v.y + matrix.z_axis.truncate().abs() * v.z
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, Mat4};

    #[test]
    fn vertices_placed_in_f32_are_inside() {
        // Far from the object's own origin, and brought back by the translation.
        for (scale, offset) in [(1.0, 0.0), (1e-3, 1e4), (1e3, 1e6), (1.0, 1e7)] {
            let points: Vec<DVec3> = (0..64)
                .map(|i| DVec3::new((f64::from(i) * 1.7).sin(), (f64::from(i) * 0.9).cos(), (f64::from(i) * 2.3).sin()))
                .map(|p| (p * scale + offset).as_vec3().as_dvec3())
                .collect();
            let mut object = Bounds::EMPTY;
            points.iter().for_each(|&point| object.grow(point));
            let rotation = DQuat::from_axis_angle(DVec3::new(0.3, 0.5, 0.8).normalize(), 0.7);
            let turned = DMat4::from_scale_rotation_translation(DVec3::new(2.0, -0.5, 1.0), rotation, DVec3::ZERO);
            let world = DMat4::from_translation(-turned.transform_point3(DVec3::splat(offset))) * turned;
            let mut boxes = Boxes::default();
            boxes.push(&object, &world);
            let (center, half) = boxes.get(0);
            let gpu: Mat4 = world.as_mat4();
            for point in points {
                let p = point.as_vec3();
                let placed = gpu.x_axis.truncate() * p.x
                    + gpu.y_axis.truncate() * p.y
                    + gpu.z_axis.truncate() * p.z
                    + gpu.w_axis.truncate();
                assert!((placed - center).abs().cmple(half).all(), "{offset}: {placed} is outside {center} +- {half}");
            }
        }
    }

    #[test]
    fn what_f32_cannot_hold_is_infinite() {
        let mut boxes = Boxes::default();
        let unit = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };
        boxes.push(&unit, &DMat4::from_scale(DVec3::splat(1e39)));
        boxes.push(&unit, &DMat4::IDENTITY);
        assert_eq!(boxes.get(0), (Vec3::ZERO, Vec3::INFINITY));
        assert!(boxes.get(1).1.max_element() < 1.01);
        assert_eq!(boxes.union(0..2), (Vec3::ZERO, Vec3::INFINITY));
    }
}
