//! Writing pictures: whole or not at all.

use super::error::CliError;
use crate::gpu::formats::Precision;
use crate::scene::RadianceImage;
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Text, WritableImage};
use half::f16;
use std::borrow::Cow;
use std::io::{Cursor, Write};
use std::path::Path;

/// What kind of file a picture becomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Format {
    /// Display-referred sRGB, 8 bits, straight alpha.
    Png,
    /// Linear scene radiance, premultiplied alpha; neither exposure nor tone map.
    Exr,
}

impl Format {
    /// By the extension; a pipe gets PNG.
    pub(super) fn of(path: &Path) -> Result<Self, CliError> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            _ if path == Path::new("-") => Ok(Self::Png),
            _ => Err(CliError::Usage(format!(
                "{}: unknown kind of picture; end the name in .png or .exr",
                path.display()
            ))),
        }
    }
}

/// PNG of straight-alpha sRGB; three channels when every pixel is opaque.
pub(super) fn png(width: u32, height: u32, rgba: &[u8]) -> Result<Vec<u8>, String> {
    png_with_texts(width, height, rgba, &[])
}

/// The same with texts, each under a Latin-1 keyword of 1 to 79 characters (iTXt, PNG 11.3.3.4).
pub(super) fn png_with_texts(width: u32, height: u32, rgba: &[u8], texts: &[(&str, &str)]) -> Result<Vec<u8>, String> {
    let opaque = rgba.chunks_exact(4).all(|pixel| pixel[3] == 255);
    let without_alpha = || rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let pixels: Cow<'_, [u8]> = if opaque { Cow::Owned(without_alpha()) } else { Cow::Borrowed(rgba) };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(if opaque { png::ColorType::Rgb } else { png::ColorType::Rgba });
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    let write = |mut encoder: png::Encoder<'_, &mut Vec<u8>>| -> Result<(), png::EncodingError> {
        for (keyword, text) in texts {
            encoder.add_itxt_chunk((*keyword).to_owned(), (*text).to_owned())?;
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&pixels)?;
        writer.finish()
    };
    write(encoder).map_err(|error| error.to_string())?;
    Ok(bytes)
}

/// OpenEXR with R, G, B and A, as half floats or as float32.
pub(super) fn exr(image: &RadianceImage, precision: Precision) -> Result<Vec<u8>, String> {
    let channel = |(index, name): (usize, &str)| {
        let values = image.texels.iter().map(|texel| texel[index]);
        let samples = match precision {
            Precision::Float => FlatSamples::F32(values.collect()),
            Precision::Half => FlatSamples::F16(values.map(f16::from_f32).collect()),
        };
        AnyChannel::new(name, samples)
    };
    let channels = AnyChannels::sort(["R", "G", "B", "A"].into_iter().enumerate().map(channel).collect());
    let size = (image.width as usize, image.height as usize);
    let mut file = Image::from_encoded_channels(size, Encoding::FAST_LOSSLESS, channels);
    file.layer_data.attributes.software_name = Some(Text::from("specula"));
    let mut bytes = Cursor::new(Vec::new());
    file.write().to_buffered(&mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

/// Writes `bytes` to `path`, or to stdout for `-`. A file appears under its name only when it is complete.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    let failed = |error: std::io::Error| CliError::Write { path: path.to_owned(), reason: error.to_string() };
    if path == Path::new("-") {
        let mut stdout = std::io::stdout().lock();
        return stdout.write_all(bytes).and_then(|()| stdout.flush()).map_err(failed);
    }
    if path.is_dir() {
        return Err(CliError::Write { path: path.to_owned(), reason: "it is a folder; name a file in it".into() });
    }
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = new_file_in(folder).map_err(failed)?;
    file.write_all(bytes).and_then(|()| file.as_file().sync_all()).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// A temporary file that is readable by whom the user's umask allows, as any other new file.
fn new_file_in(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".specula-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::{ReadChannels, ReadLayers};
    use glam::Vec4;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.png");
        write(&path, b"first").unwrap();
        write(&path, b"second").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"second");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(write(&folder.path().join("no/such/folder.png"), b"").is_err());
        assert!(write(folder.path(), b"").is_err());
    }

    #[test]
    fn exr_keeps_radiance() {
        let texels = vec![Vec4::new(0.5, 2.0, 60000.0, 1.0), Vec4::new(0.0, 0.1, 1e-4, 0.25)];
        let image = RadianceImage { width: 2, height: 1, texels };
        for (precision, tolerance) in [(Precision::Float, 0.0), (Precision::Half, 5e-4)] {
            let bytes = exr(&image, precision).unwrap();
            let read = exr::prelude::read()
                .no_deep_data()
                .largest_resolution_level()
                .rgba_channels(
                    |size, _| vec![Vec4::ZERO; size.area()],
                    |texels, at, (r, g, b, a): (f32, f32, f32, f32)| texels[at.x()] = Vec4::new(r, g, b, a),
                )
                .first_valid_layer()
                .all_attributes()
                .from_buffered(Cursor::new(bytes))
                .unwrap();
            for (got, expected) in read.layer_data.channel_data.pixels.iter().zip(&image.texels) {
                assert!((*got - *expected).abs().cmple(*expected * tolerance).all(), "{got} instead of {expected}");
            }
        }
    }
}
