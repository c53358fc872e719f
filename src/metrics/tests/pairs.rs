//! Small pairs of pictures, made of integers so that any program can make the same ones.

use crate::scene::{Encoding, Picture};
use glam::{UVec3, Vec3};

pub(super) const WIDTH: u32 = 40;
pub(super) const HEIGHT: u32 = 32;

/// Numbers without a pattern from 0 to 255 (the output step of Jarzynski and Olano's 2020 pcg3d).
fn noise(x: u32, y: u32, seed: u32) -> UVec3 {
    let mut v = UVec3::new(x, y, seed).map(|u| u.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    for _ in 0..2 {
        v.x = v.x.wrapping_add(v.y.wrapping_mul(v.z));
        v.y = v.y.wrapping_add(v.z.wrapping_mul(v.x));
        v.z = v.z.wrapping_add(v.x.wrapping_mul(v.y));
        v ^= v >> 16;
    }
    v & 255
}

/// 8-bit codes of a picture on a display.
fn codes(kind: u32, x: u32, y: u32) -> UVec3 {
    let disc = |x0: i32, y0: i32, r: i32| (x as i32 - x0).pow(2) + (y as i32 - y0).pow(2) < r * r;
    match kind {
        // Ramps.
        0 => UVec3::new(x * 6, y * 7, 128),
        1 => UVec3::new(x * 6 + 3, y * 7, 131),
        // A chessboard, and the same one pixel to the side.
        2 => UVec3::splat(if (x / 4 + y / 4).is_multiple_of(2) { 230 } else { 25 }),
        3 => UVec3::splat(if ((x + 1) / 4 + y / 4).is_multiple_of(2) { 230 } else { 25 }),
        // Noise.
        4 => noise(x, y, 1),
        5 => (noise(x, y, 1) * 3 + noise(x, y, 2)) / 4,
        // Discs of saturated colours.
        6 => {
            if disc(15, 15, 10) {
                UVec3::new(0, 255, 0)
            } else {
                UVec3::new(40, 40, 60)
            }
        }
        7 => {
            if disc(16, 15, 10) {
                UVec3::new(0, 0, 255)
            } else {
                UVec3::new(40, 44, 60)
            }
        }
        // Single points.
        8 => {
            if x % 8 == 3 && y % 8 == 5 {
                UVec3::splat(255)
            } else {
                UVec3::splat(100)
            }
        }
        _ => UVec3::splat(100),
    }
}

/// Pairs on a display: actual and expected.
pub(super) const DISPLAYED: [(u32, u32); 5] = [(0, 1), (2, 3), (4, 5), (6, 7), (8, 9)];

pub(super) fn displayed(kind: u32) -> Picture {
    picture(Encoding::Srgb, |x, y| codes(kind, x, y).as_vec3() / 255.0)
}

/// Radiance; every number is a small integer times a power of two.
fn radiance_at(kind: u32, x: u32, y: u32) -> Vec3 {
    let stops = |ev: i32| 2.0_f32.powi(ev);
    match kind {
        // Eight stops of ramps.
        0 => (codes(0, x, y).as_vec3() + 1.0) * stops((x / 5) as i32 - 10),
        1 => (codes(1, x, y).as_vec3() + 1.0) * stops((x / 5) as i32 - 10),
        // A small sun over noise.
        2 => noise(x, y, 3).as_vec3() / 64.0 + if x / 2 == 10 && y / 2 == 5 { 4096.0 } else { 0.0 },
        3 => noise(x, y, 3).as_vec3() / 64.0 + if x / 2 == 10 && y / 2 == 6 { 4096.0 } else { 0.25 },
        // Something dim in front of black, most of the picture.
        4 => codes(6, x, y).as_vec3() * if x < 20 && y < 24 { stops(-9) } else { 0.0 },
        5 => codes(7, x, y).as_vec3() * if x < 20 && y < 24 { stops(-9) } else { 0.0 },
        // Fireflies.
        6 => noise(x, y, 4).as_vec3() / 16.0 + if noise(x, y, 5).x < 4 { 500.0 } else { 1.0 },
        7 => noise(x, y, 4).as_vec3() / 16.0 + 1.0,
        // Brighter by one part in 64.
        8 => codes(4, x, y).as_vec3() * 65.0 / 1024.0,
        _ => codes(4, x, y).as_vec3() * 64.0 / 1024.0,
    }
}

/// Pairs of radiance: actual and expected.
pub(super) const RADIANT: [(u32, u32); 5] = [(0, 1), (2, 3), (4, 5), (6, 7), (8, 9)];

pub(super) fn radiant(kind: u32) -> Picture {
    picture(Encoding::Linear, |x, y| radiance_at(kind, x, y))
}

fn picture(encoding: Encoding, color: impl Fn(u32, u32) -> Vec3) -> Picture {
    let texels = (0..WIDTH * HEIGHT).map(|i| color(i % WIDTH, i / WIDTH).extend(1.0)).collect();
    Picture { width: WIDTH, height: HEIGHT, encoding, texels }
}
