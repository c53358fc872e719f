//! Kinds of pictures, and the program's results.

use super::error::CliError;
use crate::gpu::formats::Precision;
use crate::output::{self, WriteError};
use crate::scene::RadianceImage;
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Text, WritableImage};
use half::f16;
use std::io::Cursor;
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

pub(super) use crate::output::{clear_stale, clear_stale_below, png, png_with_texts};

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
    output::write(path, bytes).map_err(|WriteError { path, reason }| CliError::Write { path, reason })
}

/// Writes a file, and makes the folders that it is in.
///
/// # Errors
/// When that is not possible.
pub(super) fn write_in_folders(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    if let Some(folder) = path.parent() {
        let failed = |error: std::io::Error| CliError::Write { path: path.to_owned(), reason: error.to_string() };
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    write(path, bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::{ReadChannels, ReadLayers};
    use glam::Vec4;

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
