//! Clusters against brute force: points are drawn at random, and every light that reaches one is in its cluster's list.

use super::*;
use crate::scene::LightInWorld;
use crate::scene::light_field::{LightField, camera};
use glam::{DVec2, Mat4, Vec4};

/// What `lighting/clusters.wgsl` does.
fn listed(clusters: &Clusters, point: DVec3) -> &[u32] {
    let uniform = &clusters.uniform;
    let at: Vec4 = Mat4::from_cols_array_2d(&uniform.tiles_from_world) * point.as_vec3().extend(1.0);
    let w = at.w.max(1e-30);
    let slice = w.log2() * uniform.slice_per_octave + at.z * uniform.slice_per_clip_z + uniform.slice_bias;
    let cell = |value: f32, count: u32| (value.max(0.0) as u32).min(count - 1);
    let (x, y) = (cell(at.x / w, uniform.columns), cell(at.y / w, uniform.rows));
    let cluster = ((cell(slice, uniform.slices) * uniform.rows + y) * uniform.columns + x) as usize;
    &clusters.table[clusters.table[cluster] as usize..clusters.table[cluster + 1] as usize]
}

/// Uniform in [0, 1), the `i`th of a Kronecker sequence (Roberts 2018).
fn sample(i: u32) -> DVec3 {
    let i = f64::from(i);
    DVec3::new(0.819_172_513_396_164_4 * i, 0.671_043_606_703_789_2 * i, 0.549_700_477_901_970_2 * i).fract()
}

/// Entries that reach a point, and all entries of its list, over many points of the view.
fn check(lights: &[LightInWorld], camera: &Camera, size_px: UVec2, depths_m: [f64; 2]) -> (usize, usize) {
    let origin = DVec3::new(3.0, -1.0, 2.0);
    let reach: Vec<Reach> = lights.iter().filter_map(|light| Reach::new(light, origin)).collect();
    assert_eq!(reach.len(), lights.len());
    let clusters = clusters(&reach, 5, origin, camera, size_px);
    let (mut reaching, mut all) = (0, 0);
    for i in 0..4000 {
        let at = sample(i);
        let (eye, direction) = camera.ray(DVec2::new(at.x, at.y) * size_px.as_dvec2(), size_px);
        let depth_m = depths_m[0] + (depths_m[1] - depths_m[0]) * at.z * at.z;
        let point = eye + direction * (depth_m / direction.dot(camera.forward_in_world()));
        let list = listed(&clusters, point - origin);
        assert!(list.is_sorted_by(|a, b| a < b), "{list:?}");
        for (light, index) in lights.iter().zip(5..) {
            if light.reaches(point) {
                reaching += 1;
                assert!(list.contains(&index), "{size_px}: {light:?} is not listed at {point}");
            }
        }
        all += list.len();
    }
    (reaching, all)
}

fn lights(count: u32, range_m: f64, spot_every: u32) -> Vec<LightInWorld> {
    LightField { lights: count, range_m: Some(range_m), spot_every }.scene().lights_in_world()
}

#[test]
fn every_light_that_reaches_a_point_is_listed_there() {
    let sizes = [UVec2::new(512, 512), UVec2::new(1921, 1079), UVec2::new(3, 700), UVec2::ONE, UVec2::new(40, 1)];
    for size_px in sizes {
        for (count, range_m, spot_every) in [(1024, 3.0, 0), (400, 9.0, 1), (64, 40.0, 3)] {
            let (reaching, all) = check(&lights(count, range_m, spot_every), &camera(), size_px, [0.1, 70.0]);
            assert!(reaching > 100, "{size_px}, {count}: only {reaching} of {all}");
        }
    }
}

#[test]
fn cameras_of_every_kind_find_their_lights() {
    let (from, to) = (DVec3::new(2.0, 5.0, 3.0), DVec3::new(-4.0, 0.0, -6.0));
    let size_px = UVec2::new(640, 360);
    let perspective = |fov_y_rad| Projection::Perspective { fov_y_rad };
    for (projection, depths_m) in [
        // Amid the lights, wide and narrow.
        (perspective(2.6), [0.01, 30.0]),
        (perspective(0.02), [0.01, 60.0]),
        // Lights behind an orthographic camera's eye are seen as far as its near plane is.
        (Projection::Orthographic { height_m: 30.0 }, [-20.0, 40.0]),
        (Projection::Orthographic { height_m: 0.5 }, [-20.0, 40.0]),
    ] {
        let camera = Camera::look_at(from, to, DVec3::Y, projection, 0.01, 500.0);
        for (range_m, spot_every) in [(4.0, 0), (8.0, 2)] {
            let (reaching, all) = check(&lights(900, range_m, spot_every), &camera, size_px, depths_m);
            assert!(reaching > 100, "{projection:?}: only {reaching} of {all}");
        }
    }
}

#[test]
fn lists_are_little_longer_than_they_have_to_be() {
    // Measured 1.318 for points and 2.665 for cones, many of which are thinner than a cluster; margin 1.1.
    for (spot_every, most) in [(0, 1.45), (1, 2.93)] {
        let (reaching, all) = check(&lights(400, 9.0, spot_every), &camera(), UVec2::splat(512), [5.0, 60.0]);
        let ratio = all as f64 / reaching as f64;
        assert!(ratio < most, "{spot_every}: {ratio}");
    }
}

#[test]
fn lights_that_fill_the_view_make_the_grid_coarser_and_are_all_listed() {
    let many = lights(4096, 1000.0, 0);
    let reach: Vec<Reach> = many.iter().filter_map(|light| Reach::new(light, DVec3::ZERO)).collect();
    let of = clusters(&reach, 0, DVec3::ZERO, &camera(), UVec2::new(1920, 1080));
    assert!(of.table.len() <= MOST_ENTRIES + 200_000, "{}", of.table.len());
    assert_eq!(listed(&of, DVec3::ZERO).len(), 4096);
}

#[test]
fn without_lights_in_view_all_lists_are_empty() {
    let behind = Camera::look_at(
        DVec3::new(0.0, 1.0, 90.0),
        DVec3::new(0.0, 1.0, 200.0),
        DVec3::Y,
        Projection::Perspective { fov_y_rad: 1.0 },
        0.1,
        10.0,
    );
    let reach: Vec<Reach> = lights(64, 3.0, 2).iter().filter_map(|light| Reach::new(light, DVec3::ZERO)).collect();
    for reaches in [&reach[..], &[]] {
        let clusters = clusters(reaches, 0, DVec3::ZERO, &behind, UVec2::splat(64));
        assert_eq!(clusters.table.len(), 4 * 4 * 64 + 1);
        assert!(listed(&clusters, DVec3::new(0.0, 1.0, 150.0)).is_empty());
    }
}
