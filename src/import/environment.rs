//! Panoramas: Radiance .hdr and OpenEXR, told apart by their first bytes.

use super::error::{Fault, ImportError};
use super::limits::{Limits, guarded};
use super::{openexr, read_file};
use crate::scene::EnvironmentImage;
use ::image::ImageDecoder;
use ::image::codecs::hdr::HdrDecoder;
use glam::Vec3;
use std::io::Cursor;
use std::path::Path;

/// Imports an equirectangular panorama from a .hdr or .exr file, of any aspect ratio from 2x1 texels up.
///
/// Values that are no radiance are replaced: NaN and negative ones by 0, infinite ones by the largest finite one.
///
/// # Errors
/// When the file cannot be read or decoded, holds no colours, or is larger than [`Limits::image_side_px`].
pub fn environment_from_path(path: &Path) -> Result<EnvironmentImage, ImportError> {
    let source_name = path.display().to_string();
    let bytes = read_file(path, Limits::default().decoded_bytes).map_err(|fault| fault.in_file(&source_name))?;
    environment_from_slice(&bytes, &source_name)
}

/// Imports a panorama from the bytes of its file; `source_name` stands for them in messages.
///
/// # Errors
/// As [`environment_from_path`].
pub fn environment_from_slice(bytes: &[u8], source_name: &str) -> Result<EnvironmentImage, ImportError> {
    let decoded = match bytes {
        [b'#', b'?', ..] => guarded(|| decode_hdr(bytes)),
        [0x76, 0x2F, 0x31, 0x01, ..] => guarded(|| decode_exr(bytes)),
        _ => Some(Err(Fault::at_byte(0, "is neither a Radiance .hdr nor an OpenEXR file")
            .advise("convert the panorama to .hdr or .exr"))),
    };
    let mut image =
        decoded.unwrap_or_else(|| Err(broken("the decoder gave up"))).map_err(|fault| fault.in_file(source_name))?;
    sanitize(&mut image.texels);
    Ok(image)
}

fn broken(error: impl std::fmt::Display) -> Fault {
    Fault::at_byte(0, format!("the image cannot be decoded: {error}")).advise("convert the panorama again")
}

/// Refuses sizes that are no panorama or too large, before memory is allocated for them.
fn check_size(width: usize, height: usize) -> Result<(), Fault> {
    let side = Limits::default().image_side_px as usize;
    if width < 2 || height < 1 || width.max(height) > side {
        let problem = format!("the image is {width} x {height} texels, 2 x 1 to {side} x {side} are supported");
        return Err(Fault::at_byte(0, problem).advise("scale the panorama to a supported size"));
    }
    Ok(())
}

fn decode_hdr(bytes: &[u8]) -> Result<EnvironmentImage, Fault> {
    let reader = Cursor::new(bytes);
    // The decoder's strict mode knows only one of the two signatures that are in use.
    let decoder =
        if bytes.starts_with(b"#?RADIANCE") { HdrDecoder::new(reader) } else { HdrDecoder::new_nonstrict(reader) };
    let decoder = decoder.map_err(broken)?;
    let (width, height) = decoder.dimensions();
    check_size(width as usize, height as usize)?;
    // Run lengths are at most 127 of one byte: a row of any width takes at least this much of the file.
    let least = u64::from(height) * u64::from(width.div_ceil(127)).max(4);
    if (bytes.len() as u64) < least {
        return Err(broken(format_args!("{} bytes cannot hold {width} x {height} texels", bytes.len())));
    }
    let mut texels = vec![Vec3::ZERO; width as usize * height as usize];
    decoder.read_image(bytemuck::cast_slice_mut(&mut texels)).map_err(broken)?;
    Ok(EnvironmentImage { width, height, texels })
}

fn decode_exr(bytes: &[u8]) -> Result<EnvironmentImage, Fault> {
    let layers = openexr::layers(bytes, check_size, broken)?;
    layers.iter().find_map(layer_as_panorama).ok_or_else(|| {
        Fault::at_byte(0, "no layer has the channels R, G and B, or Y, at full resolution")
            .advise("export the panorama with RGB channels")
    })
}

/// A layer's colours; `None` if it has none.
fn layer_as_panorama(layer: &openexr::AnyLayer) -> Option<EnvironmentImage> {
    let (width, height) = openexr::size(layer)?;
    let texels = openexr::colors(layer)?;
    Some(EnvironmentImage { width, height, texels })
}

fn sanitize(texels: &mut [Vec3]) {
    let values = bytemuck::cast_slice_mut::<Vec3, f32>(texels);
    let largest = values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f32::max);
    for value in values {
        *value = match *value {
            value if value.is_nan() || value < 0.0 => 0.0,
            f32::INFINITY => largest,
            value => value,
        };
    }
}
