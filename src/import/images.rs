//! Pictures: PNG and JPEG, told apart by their first bytes, measured before they are decoded.

use super::accessor::Accessors;
use super::error::{Fault, quote};
use super::limits::guarded;
use super::resources::Resources;
use crate::progress::Progress;
use crate::scene::{Image, Pixels};
use crate::threads::*;
use ::image::codecs::{jpeg::JpegDecoder, png::PngDecoder};
use ::image::{ColorType, DynamicImage, ImageDecoder, ImageResult, Limits as DecoderLimits};
use gltf::json;
use std::borrow::Cow;
use std::cmp::Reverse;
use std::fmt::Display;
use std::io::Cursor;
use std::sync::Arc;
use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;

/// What a PNG may unpack besides its pixels: rows, profiles and comments, which may be bombs as well.
pub(super) const DECODER_BYTES: u64 = 64 << 20;

/// Decodes those images of the document that `indices` list, on all cores; they come in that order.
pub(super) fn import(
    accessors: &Accessors<'_>,
    resources: &Resources<'_>,
    indices: &[usize],
    progress: &dyn Progress,
) -> Result<Vec<Image>, Fault> {
    // One image is decoded on one core: what takes longest must not begin last.
    let mut longest_first: Vec<(usize, usize)> = indices.iter().copied().enumerate().collect();
    longest_first.sort_by_cached_key(|&(_, index)| Reverse(encoded_bytes(accessors, resources, index)));
    let import = |(place, index)| {
        let image = import_one(accessors, resources, index);
        progress.advance(1);
        (place, image)
    };
    // Collected before the first error is looked for, so that the same one is reported every time.
    let mut images: Vec<_> = longest_first.into_iter().par_bridge().map(import).collect();
    images.sort_by_key(|(place, _)| *place);
    images.into_iter().map(|(_, image)| image).collect()
}

/// How long an image's file is; 0 where that is an error to be told of when it is decoded.
fn encoded_bytes(accessors: &Accessors<'_>, resources: &Resources<'_>, index: usize) -> u64 {
    let json = &accessors.root.images[index];
    let length_of_view = |view: json::Index<_>| accessors.root.buffer_views[view.value()].byte_length.0;
    json.buffer_view.map_or_else(|| json.uri.as_deref().map_or(0, |uri| resources.length(uri)), length_of_view)
}

fn import_one(accessors: &Accessors<'_>, resources: &Resources<'_>, index: usize) -> Result<Image, Fault> {
    let json = &accessors.root.images[index];
    let (pointer, bytes) = encoded(accessors, resources, json, index)?;
    let file =
        json.uri.as_deref().filter(|uri| !uri.starts_with("data:")).map_or_else(String::new, |uri| quote(uri) + " ");
    let fault = |problem: String| {
        Fault::at(&pointer, format!("the image {file}{problem}")).advise("convert the image to PNG or JPEG")
    };
    let (width, height, pixels) = decode(&bytes, accessors, &pointer, fault)?;
    Ok(Image { name: json.name.clone(), width, height, pixels })
}

/// The bytes of the image file, and the pointer to what gave them.
fn encoded<'a>(
    accessors: &Accessors<'a>,
    resources: &Resources<'_>,
    json: &json::Image,
    index: usize,
) -> Result<(String, Cow<'a, [u8]>), Fault> {
    if let Some(view) = json.buffer_view {
        return Ok((format!("/images/{index}/bufferView"), Cow::Borrowed(accessors.buffers.view(view.value())?)));
    }
    let pointer = format!("/images/{index}/uri");
    match &json.uri {
        Some(uri) => {
            let bytes = resources.load(uri, &pointer)?;
            Ok((pointer, Cow::Owned(bytes)))
        }
        None => Err(Fault::at(format_args!("/images/{index}"), "has neither a uri nor a bufferView")),
    }
}

/// The kind of an image file, by its signature.
fn kind(bytes: &[u8]) -> &'static str {
    match bytes {
        [0x89, b'P', b'N', b'G', 0x0D, 0x0A, 0x1A, 0x0A, ..] => "PNG",
        [0xFF, 0xD8, 0xFF, ..] => "JPEG",
        [0xAB, b'K', b'T', b'X', b' ', b'2', b'0', ..] => "KTX2",
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => "WebP",
        [b'D', b'D', b'S', b' ', ..] => "DDS",
        [b'G', b'I', b'F', ..] => "GIF",
        [b'B', b'M', ..] => "BMP",
        [] => "an empty file",
        _ => "of an unknown kind",
    }
}

fn decode(
    bytes: &[u8],
    accessors: &Accessors<'_>,
    pointer: &str,
    fault: impl Fn(String) -> Fault,
) -> Result<(u32, u32, Pixels), Fault> {
    let broken = |error: &dyn Display| fault(format!("cannot be decoded: {error}"));
    let mut limits = DecoderLimits::no_limits();
    limits.max_alloc = Some(DECODER_BYTES);
    let image = guarded(|| match kind(bytes) {
        "PNG" => {
            let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(|error| broken(&error))?;
            measured(&decoder, accessors, pointer, &fault)?;
            finish(decoder).map_err(|error| broken(&error))
        }
        "JPEG" => {
            let decoder = JpegDecoder::new(Cursor::new(bytes)).map_err(|error| broken(&error))?;
            measured(&decoder, accessors, pointer, &fault)?;
            let size = decoder.dimensions();
            match jpeg_as_rgba(bytes, size).map_err(|error| broken(&error))? {
                Some(rgba) => Ok((size.0, size.1, Pixels::Rgba8(Arc::new(rgba)))),
                None => finish(decoder).map_err(|error| broken(&error)),
            }
        }
        other => Err(fault(format!("is {other}, which is not supported"))),
    });
    image.unwrap_or_else(|| Err(broken(&"the decoder gave up")))
}

/// Refuses an image that is too large, by its header alone.
fn measured(
    decoder: &impl ImageDecoder,
    accessors: &Accessors<'_>,
    pointer: &str,
    fault: impl Fn(String) -> Fault,
) -> Result<(), Fault> {
    let (width, height) = decoder.dimensions();
    let side = accessors.limits.image_side_px;
    if width == 0 || height == 0 || width.max(height) > side {
        let problem = format!("is {width} x {height} texels, sides from 1 to {side} are supported");
        return Err(fault(problem).advise("scale the image down"));
    }
    let rgba = if is_deep(decoder.color_type()) { 8 } else { 4 };
    let texels = u64::from(width) * u64::from(height);
    accessors.budget.take(texels, u64::from(decoder.color_type().bytes_per_pixel()) + rgba, pointer)
}

fn is_deep(color: ColorType) -> bool {
    matches!(color, ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16)
}

/// A JPEG of colours or grey, decoded by what `image` decodes with, but straight to four channels: to three, and from them to
/// four, takes twice the memory. None of other kinds.
fn jpeg_as_rgba(bytes: &[u8], (width, height): (u32, u32)) -> Result<Option<Vec<u8>>, zune_jpeg::errors::DecodeErrors> {
    let options = DecoderOptions::default()
        .set_strict_mode(false)
        .set_max_width(width as usize)
        .set_max_height(height as usize)
        .jpeg_set_out_colorspace(ColorSpace::RGBA);
    let mut decoder = zune_jpeg::JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers()?;
    let is_direct = matches!(decoder.input_colorspace(), Some(ColorSpace::YCbCr | ColorSpace::Luma));
    let size = width as usize * height as usize * 4;
    if !is_direct || decoder.output_buffer_size() != Some(size) {
        return Ok(None);
    }
    let mut rgba = vec![0; size];
    decoder.decode_into(&mut rgba)?;
    Ok(Some(rgba))
}

/// Decodes to four channels, of 8 bits or of 16.
pub(super) fn finish(decoder: impl ImageDecoder) -> ImageResult<(u32, u32, Pixels)> {
    let deep = is_deep(decoder.color_type());
    let image = DynamicImage::from_decoder(decoder)?;
    let (width, height) = (image.width(), image.height());
    let pixels = if deep {
        Pixels::Rgba16(image.into_rgba16().into_raw().into())
    } else {
        Pixels::Rgba8(image.into_rgba8().into_raw().into())
    };
    Ok((width, height, pixels))
}
