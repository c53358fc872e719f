//! The small pictures of the showcase, drawn by formula, as PNG files.

use glam::{DVec2, DVec3};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageResult};

/// Texels along each side of a pattern that repeats.
const PATTERN_SIZE: u32 = 64;

/// What a texel of the enamelled tile is: a domed metal stud in the middle of a square of enamel.
struct Enamel {
    /// 1 on the stud, 0 on the enamel, with a soft step between.
    stud: f64,
    /// Slope of the surface along u and v.
    slope: DVec2,
}

impl Enamel {
    /// `uv` in [0, 1]^2.
    fn at(uv: DVec2) -> Self {
        let from_center = 2.0 * uv - 1.0;
        let radius = from_center.length();
        let (stud_radius, edge) = (0.52, 0.06);
        let stud = smoothstep(stud_radius + edge, stud_radius - edge, radius);
        // A dome on the stud; around it the enamel swells between thin grooves along the tile's joints.
        let dome = from_center * (1.1 * stud);
        let joint = |x: f64| x.signum() * smoothstep(0.80, 0.97, x.abs()) * smoothstep(1.0, 0.97, x.abs());
        let groove = DVec2::new(joint(from_center.x), joint(from_center.y)) * 0.9;
        let rim = from_center.normalize_or_zero() * (-0.8 * (-((radius - 0.62) / 0.05).powi(2)).exp());
        Self { stud, slope: dome + groove + rim }
    }
}

pub(crate) fn enamel_base_color() -> ImageResult<Vec<u8>> {
    rgb_pattern(|uv| DVec3::new(0.05, 0.30, 0.42).lerp(DVec3::new(0.93, 0.80, 0.55), Enamel::at(uv).stud))
}

/// Perceptual roughness in green, metallic in blue.
pub(crate) fn enamel_metallic_roughness() -> ImageResult<Vec<u8>> {
    rgb_pattern(|uv| DVec3::new(0.0, 0.12, 0.0).lerp(DVec3::new(0.0, 0.34, 1.0), Enamel::at(uv).stud))
}

/// Tangent-space normals; green points up in the picture, as glTF has it, while v runs down.
pub(crate) fn enamel_normals() -> ImageResult<Vec<u8>> {
    rgb_pattern(|uv| {
        let Enamel { slope, .. } = Enamel::at(uv);
        DVec3::new(slope.x, -slope.y, 1.0).normalize() * 0.5 + 0.5
    })
}

/// A sheet with round holes in a hexagonal pattern, twice as high as wide in holes; colour is white, alpha the sheet.
pub(crate) fn perforation() -> ImageResult<Vec<u8>> {
    let (width, height) = (PATTERN_SIZE, PATTERN_SIZE);
    let texel = |i: u32| {
        let uv = texel_uv(i, width, height);
        // Holes sit at the corners and in the middle of the pattern.
        let distance = |center: DVec2| {
            let offset = uv - center;
            (offset - offset.round()).length()
        };
        let nearest = distance(DVec2::ZERO).min(distance(DVec2::splat(0.5)));
        let sheet = smoothstep(0.21, 0.29, nearest);
        [255, byte(sheet)]
    };
    let pixels: Vec<u8> = (0..width * height).flat_map(texel).collect();
    png(&pixels, width, height, ExtendedColorType::La8)
}

/// A grey picture; `value` takes texture coordinates and gives [0, 1].
pub(crate) fn grey(width: u32, height: u32, value: impl Fn(DVec2) -> f64) -> ImageResult<Vec<u8>> {
    let pixels: Vec<u8> = (0..width * height).map(|i| byte(value(texel_uv(i, width, height)))).collect();
    png(&pixels, width, height, ExtendedColorType::L8)
}

fn rgb_pattern(color: impl Fn(DVec2) -> DVec3) -> ImageResult<Vec<u8>> {
    let size = PATTERN_SIZE;
    let pixels: Vec<u8> = (0..size * size).flat_map(|i| color(texel_uv(i, size, size)).to_array().map(byte)).collect();
    png(&pixels, size, size, ExtendedColorType::Rgb8)
}

fn png(pixels: &[u8], width: u32, height: u32, color: ExtendedColorType) -> ImageResult<Vec<u8>> {
    let mut file = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut file, CompressionType::Best, FilterType::Adaptive);
    encoder.write_image(pixels, width, height, color)?;
    Ok(file)
}

fn texel_uv(i: u32, width: u32, height: u32) -> DVec2 {
    (DVec2::new(f64::from(i % width), f64::from(i / width)) + 0.5) / DVec2::new(f64::from(width), f64::from(height))
}

fn byte(value: f64) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
