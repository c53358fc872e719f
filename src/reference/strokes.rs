//! Points and lines as the quads that a one-pixel pen would draw.

use super::geometry::Triangle;
use crate::scene::{Projection, View};
use glam::{DVec2, DVec3};

/// A place in the world and the vertex whose attributes it has.
type End = (DVec3, u32);

/// A square, one pixel wide, that faces the camera.
pub(super) fn point(view: &View, draw: usize, (position, vertex): End) -> Vec<Triangle> {
    let in_view = view.camera.world_from_view.inverse().transform_point3(position);
    let half = 0.5 * pixel_size(view, in_view);
    let corner = |x: f64, y: f64| in_view + DVec3::new(x * half, y * half, 0.0);
    quad(view, draw, [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)], [vertex; 4])
}

/// A ribbon, one pixel wide across the line as it is seen. The part nearer than the near plane is cut off; what remains
/// keeps the attributes of the line's ends.
pub(super) fn line(view: &View, draw: usize, ends: [End; 2]) -> Vec<Triangle> {
    let view_from_world = view.camera.world_from_view.inverse();
    let [a, b] = ends.map(|(position, _)| view_from_world.transform_point3(position));
    let Some([a, b]) = in_front(view.camera.near_m, a, b) else { return Vec::new() };
    let along = (on_screen(view, b) - on_screen(view, a)).normalize_or(DVec2::X);
    let across = along.perp().extend(0.0) * 0.5;
    let (at_a, at_b) = (across * pixel_size(view, a), across * pixel_size(view, b));
    let [from, to] = ends.map(|(_, vertex)| vertex);
    quad(view, draw, [a - at_a, b - at_b, b + at_b, a + at_a], [from, to, to, from])
}

fn quad(view: &View, draw: usize, in_view: [DVec3; 4], vertices: [u32; 4]) -> Vec<Triangle> {
    let corners = in_view.map(|corner| view.camera.world_from_view.transform_point3(corner));
    let triangle = |i: [usize; 3]| Triangle { corners: i.map(|i| corners[i]), vertices: i.map(|i| vertices[i]), draw };
    vec![triangle([0, 1, 2]), triangle([0, 2, 3])]
}

/// The part of a segment, in view space, that is not nearer than the near plane.
fn in_front(near_m: f64, a: DVec3, b: DVec3) -> Option<[DVec3; 2]> {
    let (depth_a, depth_b) = (-a.z, -b.z);
    if depth_a < near_m && depth_b < near_m {
        return None;
    }
    let crossing = || a.lerp(b, (near_m - depth_a) / (depth_b - depth_a));
    Some([if depth_a < near_m { crossing() } else { a }, if depth_b < near_m { crossing() } else { b }])
}

/// Size of a pixel at a point in view space, metres.
fn pixel_size(view: &View, in_view: DVec3) -> f64 {
    let height = match view.camera.projection {
        Projection::Perspective { fov_y_rad } => 2.0 * (0.5 * fov_y_rad).tan() * -in_view.z,
        Projection::Orthographic { height_m } => height_m,
    };
    height / f64::from(view.size_px.y)
}

/// Where a point of view space is seen, up to a scale.
fn on_screen(view: &View, in_view: DVec3) -> DVec2 {
    match view.camera.projection {
        Projection::Perspective { .. } => in_view.truncate() / -in_view.z,
        Projection::Orthographic { .. } => in_view.truncate(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::tests::view;

    fn pixels(view: &View, corner: DVec3) -> DVec2 {
        let clip = view.camera.clip_from_view(view.size_px).as_dmat4() * view.camera.world_from_view.inverse();
        let ndc = clip.project_point3(corner);
        DVec2::new(ndc.x + 1.0, 1.0 - ndc.y) * 0.5 * view.size_px.as_dvec2()
    }

    #[test]
    fn points_and_lines_are_one_pixel_wide_at_any_depth() {
        let view = view();
        let square = point(&view, 0, (DVec3::new(0.3, -0.4, -2.0), 0));
        let [a, b, c] = square[0].corners.map(|corner| pixels(&view, corner));
        // clip_from_view is float32.
        assert!(((b - a).length() - 1.0).abs() < 1e-4 && ((c - b).length() - 1.0).abs() < 1e-4, "{a} {b} {c}");

        let ribbon = line(&view, 0, [(DVec3::new(-0.5, 0.1, 1.0), 0), (DVec3::new(0.7, 0.4, -6.0), 1)]);
        for (near, far) in [(ribbon[0].corners[0], ribbon[1].corners[2]), (ribbon[0].corners[1], ribbon[0].corners[2])]
        {
            let width = (pixels(&view, near) - pixels(&view, far)).length();
            assert!((width - 1.0).abs() < 1e-4, "{width}");
        }
    }

    #[test]
    fn lines_end_at_the_near_plane() {
        let view = view();
        let (behind, ahead) = (DVec3::new(0.0, 0.0, 50.0), DVec3::new(0.2, 0.1, 0.0));
        let ribbon = line(&view, 0, [(behind, 0), (ahead, 1)]);
        assert_eq!(ribbon.len(), 2);
        let view_from_world = view.camera.world_from_view.inverse();
        for corner in ribbon.iter().flat_map(|triangle| triangle.corners) {
            assert!(-view_from_world.transform_point3(corner).z >= view.camera.near_m - 1e-9);
        }
        assert!(line(&view, 0, [(behind, 0), (behind + DVec3::X, 1)]).is_empty());
    }
}
