//! Pictures to compare: PNG and OpenEXR, told apart by their first bytes. Nothing in them is replaced.

use super::error::{Fault, ImportError};
use super::images::{DECODER_BYTES, finish};
use super::limits::{Limits, guarded};
use super::{openexr, read_file};
use crate::scene::{Encoding, Picture, Pixels};
use ::image::codecs::png::PngDecoder;
use ::image::{ImageDecoder, Limits as DecoderLimits};
use glam::Vec4;
use std::io::Cursor;
use std::path::Path;

/// Imports a picture from a .png (8 or 16 bits, taken as sRGB) or an .exr file (taken as linear Rec.709).
///
/// Infinite values and NaN are kept: a picture that has them is wrong, and who compares it wants to know.
///
/// # Errors
/// When the file cannot be read or decoded, holds no colours, or is larger than [`Limits::image_side_px`].
pub fn picture_from_path(path: &Path) -> Result<Picture, ImportError> {
    let source_name = path.display().to_string();
    let bytes = read_file(path, Limits::default().decoded_bytes).map_err(|fault| fault.in_file(&source_name))?;
    picture_from_slice(&bytes, &source_name)
}

/// Imports a picture from the bytes of its file; `source_name` stands for them in messages.
///
/// # Errors
/// As [`picture_from_path`].
pub fn picture_from_slice(bytes: &[u8], source_name: &str) -> Result<Picture, ImportError> {
    let decoded = match bytes {
        [0x89, b'P', b'N', b'G', ..] => guarded(|| decode_png(bytes)),
        [0x76, 0x2F, 0x31, 0x01, ..] => guarded(|| decode_exr(bytes)),
        _ => Some(Err(
            Fault::at_byte(0, "is neither a PNG nor an OpenEXR file").advise("convert the picture to .png or .exr")
        )),
    };
    decoded.unwrap_or_else(|| Err(broken("the decoder gave up"))).map_err(|fault| fault.in_file(source_name))
}

fn broken(error: impl std::fmt::Display) -> Fault {
    Fault::at_byte(0, format!("the picture cannot be decoded: {error}")).advise("write the picture again")
}

fn check_size(width: usize, height: usize) -> Result<(), Fault> {
    let side = Limits::default().image_side_px as usize;
    if width == 0 || height == 0 || width.max(height) > side {
        let problem = format!("the picture is {width} x {height} pixels, sides from 1 to {side} are supported");
        return Err(Fault::at_byte(0, problem).advise("scale or crop the picture"));
    }
    Ok(())
}

fn decode_png(bytes: &[u8]) -> Result<Picture, Fault> {
    let mut limits = DecoderLimits::no_limits();
    limits.max_alloc = Some(DECODER_BYTES);
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(broken)?;
    let (width, height) = decoder.dimensions();
    check_size(width as usize, height as usize)?;
    let (width, height, pixels) = finish(decoder).map_err(broken)?;
    // Colours of nothing are invisible: covered by their alpha, as a viewer shows them over black.
    let texel = |color: [f32; 3], alpha: f32| Vec4::new(color[0] * alpha, color[1] * alpha, color[2] * alpha, alpha);
    let texels = match &pixels {
        Pixels::Rgba8(values) => values
            .chunks_exact(4)
            .map(|p| {
                let [r, g, b, a] = [p[0], p[1], p[2], p[3]].map(|value| f32::from(value) / 255.0);
                texel([r, g, b], a)
            })
            .collect(),
        Pixels::Rgba16(values) => values
            .chunks_exact(4)
            .map(|p| {
                let [r, g, b, a] = [p[0], p[1], p[2], p[3]].map(|value| f32::from(value) / 65535.0);
                texel([r, g, b], a)
            })
            .collect(),
        Pixels::OfHost => Vec::new(),
    };
    Ok(Picture { width, height, encoding: Encoding::Srgb, texels })
}

fn decode_exr(bytes: &[u8]) -> Result<Picture, Fault> {
    let layers = openexr::layers(bytes, check_size, broken)?;
    layers.iter().find_map(layer_as_picture).ok_or_else(|| {
        Fault::at_byte(0, "no layer has the channels R, G and B, or Y, at full resolution")
            .advise("write the picture with RGB channels")
    })
}

fn layer_as_picture(layer: &openexr::AnyLayer) -> Option<Picture> {
    let (width, height) = openexr::size(layer)?;
    let colors = openexr::colors(layer)?;
    let alpha = openexr::channel(layer, "A").unwrap_or_else(|| vec![1.0; colors.len()]);
    let texels = colors.into_iter().zip(alpha).map(|(color, alpha)| color.extend(alpha)).collect();
    Some(Picture { width, height, encoding: Encoding::Linear, texels })
}
