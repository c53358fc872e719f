//! A picture beside the one that it should be.

use super::golden::{self, Golden};
use super::limits::{Compared, Limit};
use super::report::MetricReport;
use crate::cli::compare::measure::{Metric, measure};
use crate::cli::compare::pictures;
use crate::cli::error::CliError;
use crate::import::{picture_from_path, picture_from_slice};
use crate::metrics::flip::flip;
use crate::metrics::{Mask, Pair, PairError};
use std::path::Path;

/// What the limits say.
pub(super) struct Comparison {
    pub(super) metrics: Vec<MetricReport>,
    /// PNGs of the difference and of the FLIP errors, where a limit does not hold.
    pub(super) pictures: Option<[Vec<u8>; 2]>,
}

/// The golden and its bytes; `None` where there is none.
///
/// # Errors
/// When there is one that cannot be read.
pub(super) fn read_golden(path: &Path) -> Result<Option<(Vec<u8>, Golden)>, CliError> {
    let failed = |reason: String| CliError::Usage(format!("{}: cannot be read: {reason}", path.display()));
    let bytes = match std::fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(failed(error.to_string())),
    };
    let golden = golden::decode(&bytes).map_err(failed)?;
    Ok(Some((bytes, golden)))
}

/// Compares two PNGs of one size.
///
/// # Errors
/// When one of them or the mask cannot be read, or the mask is of another size.
pub(super) fn compare(
    actual: &[u8],
    (expected, path): (&[u8], &Path),
    limits: &[Limit],
    mask: Option<&Path>,
) -> Result<Comparison, CliError> {
    let actual = picture_from_slice(actual, "the picture of this run")?;
    let expected = picture_from_slice(expected, &path.display().to_string())?;
    let selected = mask.map(picture_from_path).transpose()?.map(|picture| Mask::from_picture(&picture));
    let explain = |error: PairError| match mask {
        Some(mask) => CliError::Usage(format!("{}: {error}", mask.display())),
        None => CliError::Usage(error.to_string()),
    };
    let pair = Pair::new(&actual, &expected, selected.as_ref()).map_err(explain)?;
    let mut wanted: Vec<Metric> = Vec::new();
    for limit in limits {
        if !wanted.contains(&limit.metric()) {
            wanted.push(limit.metric());
        }
    }
    let measured = measure(&pair, &wanted);
    let check = |limit: &Limit| limit.check(Compared::Different { pair: &pair, measured: &measured });
    let metrics: Vec<MetricReport> = limits.iter().map(check).collect();
    let mut drawn = None;
    if metrics.iter().any(|metric| !metric.holds) {
        let map = measured.flip_map.unwrap_or_else(|| flip(&pair));
        // Names alone, which say that both are PNGs.
        let [difference, heat] = ["difference.png", "flip.png"].map(Path::new);
        drawn = Some([pictures::difference(difference, &pair)?, pictures::heat_map(heat, &pair, &map)?]);
    }
    Ok(Comparison { metrics, pictures: drawn })
}
