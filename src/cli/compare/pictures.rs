//! Differences and FLIP errors as pictures.

use crate::cli::error::CliError;
use crate::cli::output::{Format, exr, png};
use crate::gpu::formats::Precision;
use crate::metrics::{ErrorMap, Pair, heat};
use crate::scene::RadianceImage;
use glam::{Vec3, Vec4};
use std::path::Path;

/// The file with the differences of the pixels that count; others are black.
pub(in crate::cli) fn difference(path: &Path, pair: &Pair<'_>) -> Result<Vec<u8>, CliError> {
    let texels = pair.actual().texels.iter().zip(&pair.expected().texels).enumerate();
    let signed: Vec<Vec3> =
        texels.map(|(i, (a, b))| if pair.is_selected(i) { (*a - *b).truncate() } else { Vec3::ZERO }).collect();
    let (width, height) = (pair.actual().width, pair.actual().height);
    let bytes = match Format::of(path)? {
        Format::Exr => {
            let texels = signed.iter().map(|difference| difference.extend(1.0)).collect::<Vec<Vec4>>();
            exr(&RadianceImage { width, height, texels }, Precision::Float)
        }
        Format::Png => {
            let largest = signed.iter().map(|d| d.abs().max_element()).fold(f32::MIN_POSITIVE, f32::max);
            let code = |value: f32| (value.abs() / largest * 255.0).round() as u8;
            let rgba: Vec<u8> = signed.iter().flat_map(|d| [code(d.x), code(d.y), code(d.z), 255]).collect();
            png(width, height, &rgba)
        }
    };
    bytes.map_err(|reason| CliError::Write { path: path.to_owned(), reason })
}

/// The file with the errors of the pixels that count; others are black.
pub(in crate::cli) fn heat_map(path: &Path, pair: &Pair<'_>, map: &ErrorMap) -> Result<Vec<u8>, CliError> {
    if Format::of(path)? != Format::Png {
        return Err(CliError::Usage(format!("{}: a heat map is a .png", path.display())));
    }
    let values = map.values.iter().enumerate().map(|(i, &error)| if pair.is_selected(i) { error } else { 0.0 });
    let counted = ErrorMap { values: values.collect(), ..*map };
    let bytes = png(map.width, map.height, &heat::heat_map(&counted));
    bytes.map_err(|reason| CliError::Write { path: path.to_owned(), reason })
}
