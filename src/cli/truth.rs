//! Flags of the reference renderer: how much light, how many samples, how small an error.

use super::error::CliError;
use super::output::Format;
use crate::progress::Progress;
use crate::reference::EstimateOptions;
use std::path::PathBuf;
use std::time::Duration;

/// Samples a pixel where nothing else is said.
const SAMPLES: u32 = 64;
/// Samples a pixel at which even an error that is never reached ends.
const SAMPLES_MAX: u32 = 1 << 20;

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Reference renderer")]
pub(super) struct TruthArgs {
    /// Samples a pixel; with --error or --time the most of them. 64 without any of the three.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    samples: Option<u32>,
    /// Stop when the standard error, relative to the radiance, is this small (root mean square over pixels with surfaces).
    #[arg(long, value_name = "PERCENT%", value_parser = parse_error)]
    error: Option<f64>,
    /// Stop in time to be done after this many seconds of rendering.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    time: Option<Duration>,
    /// Write the standard error of every pixel and channel.
    #[arg(long, value_name = "FILE.exr")]
    pub(super) error_image: Option<PathBuf>,
    /// Most reflections between a source of light and the eye: 0 is one without shadows, as the GPU draws it; 1 is one with
    /// shadows; more let surfaces light each other.
    #[arg(long, value_name = "N", default_value_t = 0)]
    bounces: u32,
}

impl TruthArgs {
    /// What only the reference renderer heeds, if any of it was given.
    ///
    /// # Errors
    /// When the picture of errors is no .exr, or the renderer is not the reference.
    pub(super) fn check(&self, is_reference: bool) -> Result<(), CliError> {
        let wants = [
            (self.error.is_some(), "--error"),
            (self.time.is_some(), "--time"),
            (self.error_image.is_some(), "--error-image"),
            (self.bounces > 0, "--bounces"),
        ];
        if let Some((_, flag)) = wants.into_iter().find(|(given, _)| *given && !is_reference) {
            return Err(CliError::Usage(format!("{flag} is of the reference renderer; add --renderer reference")));
        }
        match &self.error_image {
            Some(path) if Format::of(path)? != Format::Exr => {
                Err(CliError::Usage(format!("--error-image {}: end the name in .exr", path.display())))
            }
            _ => Ok(()),
        }
    }

    pub(super) fn options<'a>(&self, progress: &'a dyn Progress) -> EstimateOptions<'a> {
        let open_ended = self.error.is_some() || self.time.is_some();
        EstimateOptions {
            bounces: self.bounces,
            samples: self.samples.unwrap_or(if open_ended { SAMPLES_MAX } else { SAMPLES }),
            relative_error: self.error,
            time: self.time,
            standard_error: self.error_image.is_some(),
            centers: false,
            seed: 0,
            progress,
        }
    }

    /// What to tell when the error that was asked for is not reached.
    pub(super) fn warning(&self, reached: Option<f64>) -> Option<String> {
        let (wanted, reached) = (self.error?, reached?);
        (reached > wanted).then(|| {
            format!("the standard error is {:.3} %, more than the {:.3} % asked for", 100.0 * reached, 100.0 * wanted)
        })
    }
}

/// `0.5%` or `0.005`.
pub(super) fn parse_error(text: &str) -> Result<f64, String> {
    let (number, scale) = text.strip_suffix('%').map_or((text, 1.0), |percent| (percent, 0.01));
    match number.trim().parse::<f64>() {
        Ok(error) if error > 0.0 && error.is_finite() => Ok(error * scale),
        _ => Err("expected a share above 0, such as 0.5% or 0.005".into()),
    }
}

fn parse_seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse::<f64>().ok().filter(|seconds| *seconds > 0.0);
    seconds
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "expected seconds, more than 0".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_shares_or_percent() {
        assert_eq!(parse_error("0.5%"), Ok(0.005));
        assert_eq!(parse_error("0.02"), Ok(0.02));
        for bad in ["", "%", "0", "-1%", "NaN", "inf", "x"] {
            assert!(parse_error(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn times_are_positive() {
        assert_eq!(parse_seconds("1.5"), Ok(Duration::from_millis(1500)));
        for bad in ["0", "-1", "NaN", "inf", "1e300", "s"] {
            assert!(parse_seconds(bad).is_err(), "{bad}");
        }
    }
}
