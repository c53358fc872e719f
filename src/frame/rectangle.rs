//! Parts of a picture.

use glam::{Mat4, UVec2, Vec2, Vec3};

/// Pixels from `first` to before `end`, of which there are some.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rectangle {
    pub first: UVec2,
    pub end: UVec2,
}

impl Rectangle {
    /// `None` where there is no pixel.
    fn new(first: UVec2, end: UVec2) -> Option<Self> {
        first.cmplt(end).all().then_some(Self { first, end })
    }

    /// All of a picture.
    pub fn whole(size_px: UVec2) -> Self {
        Self { first: UVec2::ZERO, end: size_px }
    }

    /// What a box can cover, given by its centre and half extent: the rectangle around its corners, or all of the picture
    /// where one is beside or behind the eye. None where it is out of sight.
    pub fn around((center, half): (Vec3, Vec3), clip_from_origin: &Mat4, size_px: UVec2) -> Option<Self> {
        let (mut least, mut largest) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for corner in 0..8 {
            let sign = |axis: u32| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
            let clip = *clip_from_origin * (center + half * Vec3::new(sign(0), sign(1), sign(2))).extend(1.0);
            if !clip.is_finite() || clip.w <= 0.0 {
                return Some(Self::whole(size_px));
            }
            let pixel = (Vec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * size_px.as_vec2();
            (least, largest) = (least.min(pixel), largest.max(pixel));
        }
        // A pixel of room for rounding, here and in the rasteriser, and for lines.
        let first = (least - 1.0).floor().max(Vec2::ZERO).min(size_px.as_vec2());
        let end = (largest + 1.0).ceil().max(Vec2::ZERO).min(size_px.as_vec2());
        Self::new(first.as_uvec2(), end.as_uvec2())
    }

    pub fn size(self) -> UVec2 {
        self.end - self.first
    }

    /// In pixels.
    pub fn area(self) -> f64 {
        self.size().as_dvec2().element_product()
    }

    /// Around both.
    pub fn with(self, other: Self) -> Self {
        Self { first: self.first.min(other.first), end: self.end.max(other.end) }
    }

    /// What both hold.
    pub fn within(self, other: Self) -> Option<Self> {
        Self::new(self.first.max(other.first), self.end.min(other.end))
    }

    /// What `hole` leaves, in pieces.
    pub fn beside(self, hole: Option<Self>) -> impl Iterator<Item = Self> {
        // Without a hole, the first piece is everything.
        let Self { first, end } = hole.and_then(|hole| self.within(hole)).unwrap_or(Self { first: self.end, ..self });
        let pieces = [
            Self::new(self.first, UVec2::new(self.end.x, first.y)),
            Self::new(UVec2::new(self.first.x, first.y), UVec2::new(first.x, end.y)),
            Self::new(UVec2::new(end.x, first.y), UVec2::new(self.end.x, end.y)),
            Self::new(UVec2::new(self.first.x, end.y), self.end),
        ];
        pieces.into_iter().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::cull::clip_from_origin;
    use crate::scene::framing::default_view;
    use crate::scene::{Mesh, Node, Scene, shapes};

    #[test]
    fn rectangles_hold_what_is_seen_of_a_box() {
        let size = UVec2::new(300, 200);
        let scene = Scene {
            nodes: vec![Node { mesh: Some(0), ..Default::default() }],
            roots: vec![0],
            meshes: vec![Mesh { name: None, primitives: vec![shapes::sphere(1.0, 64, 0)] }],
            materials: vec![Default::default()],
            ..Default::default()
        };
        let view = default_view(&scene, size);
        let clip = clip_from_origin(&view, glam::DVec3::ZERO);
        let all = Some(Rectangle::whole(size));
        assert_eq!(Rectangle::around((Vec3::ZERO, Vec3::splat(100.0)), &clip, size), all);
        assert_eq!(Rectangle::around((Vec3::ZERO, Vec3::INFINITY), &clip, size), all);
        let Some(Rectangle { first, end }) = Rectangle::around((Vec3::ZERO, Vec3::splat(0.1)), &clip, size) else {
            panic!("out of sight")
        };
        assert!(first.cmpgt(UVec2::new(100, 60)).all() && end.cmplt(UVec2::new(200, 140)).all());
        let beside = view.camera.world_from_view.transform_point3(glam::DVec3::new(1e3, 0.0, -10.0)).as_vec3();
        assert_eq!(Rectangle::around((beside, Vec3::ONE), &clip, size), None);
    }

    #[test]
    fn a_hole_and_what_is_beside_it_are_everything_once() {
        let all = Rectangle { first: UVec2::new(2, 3), end: UVec2::new(9, 8) };
        let rectangle = |x, y, right, below| Rectangle { first: UVec2::new(x, y), end: UVec2::new(right, below) };
        let holes = [
            rectangle(4, 4, 6, 6),
            rectangle(0, 0, 20, 20),
            rectangle(0, 0, 3, 4),
            rectangle(8, 5, 12, 9),
            rectangle(10, 10, 12, 12),
            rectangle(2, 3, 9, 4),
        ];
        for hole in holes.map(Some).into_iter().chain([None]) {
            let mut times = [[0; 10]; 10];
            let inside = hole.and_then(|hole| all.within(hole));
            for piece in all.beside(hole).chain(inside) {
                for y in piece.first.y..piece.end.y {
                    (piece.first.x..piece.end.x).for_each(|x| times[y as usize][x as usize] += 1);
                }
            }
            for (y, row) in times.iter().enumerate() {
                for (x, &times) in row.iter().enumerate() {
                    let is_in = (2..9).contains(&x) && (3..8).contains(&y);
                    assert_eq!(times, i32::from(is_in), "{hole:?}: {x}, {y}");
                }
            }
        }
    }
}
