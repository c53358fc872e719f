//! Flags that make many pictures of one call.

use super::names::NamePattern;
use crate::cli::test::PartitionRequest;
use std::path::PathBuf;
use std::str::FromStr;

/// Frames of a sequence, from `first` to before `end`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FrameRange {
    pub(super) first: u32,
    pub(super) end: u32,
}

/// More frames than this are a slip of the pen.
const MOST: u32 = 1_000_000;

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (first, end) = text.split_once("..").ok_or("expected A..B, such as 0..48 for frames 0 to 47")?;
        let number = |text: &str| match text.parse() {
            Ok(number) if number <= MOST => Ok(number),
            _ => Err(format!("`{text}` is no number of a frame from 0 to {MOST}")),
        };
        let range = Self { first: number(first)?, end: number(end)? };
        if range.first < range.end { Ok(range) } else { Err(format!("{text} has no frame: B has to be above A")) }
    }
}

fn parse_turn(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(degrees) if degrees.is_finite() => Ok(degrees),
        _ => Err(format!("`{text}` is no number of degrees")),
    }
}

fn parse_rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(rate) if (0.1..=100.0).contains(&rate) => Ok(rate),
        _ => Err(format!("`{text}` is no number of frames a second from 0.1 to 100")),
    }
}

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Many pictures (docs/sequences.md)")]
pub(in crate::cli) struct BatchArgs {
    /// Draw frames A to B - 1 of a turntable into the folder -o: from frame to frame the camera turns about the vertical
    /// axis through --target, --look-at or the middle of the scene, far enough away for all of them.
    #[arg(long, value_name = "A..B", group = "many", conflicts_with_all = SINGLE)]
    pub(super) frames: Option<FrameRange>,
    /// By how much, counter-clockwise from above [default: a full turn in B frames].
    #[arg(long, value_name = "DEGREES", requires = "frames", allow_hyphen_values = true, value_parser = parse_turn)]
    pub(super) turn: Option<f64>,
    /// Names of the frames, without .png [default: {model}_{view}_{frame:4}].
    #[arg(long, value_name = "PATTERN", requires = "frames")]
    pub(super) frame_name: Option<NamePattern>,
    /// Also make one file of all frames: .png or .apng for an animated PNG, .gif. Repeat for more.
    #[arg(long, value_name = "FILE", requires = "frames", conflicts_with = "partition")]
    pub(super) animation: Vec<PathBuf>,
    /// Frames a second of animations [default: 24].
    #[arg(long, value_name = "RATE", requires = "animation", value_parser = parse_rate)]
    pub(super) fps: Option<f64>,
    /// Also put all frames side by side, small.
    #[arg(long, value_name = "FILE.png", requires = "frames", conflicts_with = "partition")]
    pub(super) contact_sheet: Option<PathBuf>,
    /// Draw a picture for each line of a file into the folder -o: JSON objects with model, output and flags of render by
    /// their long names. - reads them from stdin.
    #[arg(long, value_name = "FILE.jsonl", group = "many", conflicts_with_all = SINGLE, conflicts_with_all = SUBJECT, conflicts_with_all = ["model", "FrameArgs"])]
    pub(super) manifest: Option<PathBuf>,
    /// Draw one part of the pictures, such as hash:2/4; a scheduler's variables stand in for numbers (docs/sharding.md).
    #[arg(long, value_name = "slice|hash[:K/N]", requires = "many")]
    pub(super) partition: Option<PartitionRequest>,
    /// Leave out pictures that are there, whole and of the same files, settings, driver and version.
    #[arg(long, requires = "many")]
    pub(super) resume: bool,
}

/// Flags of a single picture.
const SINGLE: [&str; 6] = ["state", "format", "stats", "dump_wgsl", "TierArgs", "TruthArgs"];

/// Flags that say what is drawn and from where; states and the lines of manifests have their own. (Structs with others
/// inside are no groups to clap, so that some are named one by one.)
pub(in crate::cli) const SUBJECT: [&str; 11] = [
    "scene",
    "variant",
    "overrides",
    "debug_view",
    "size",
    "CameraArgs",
    "LookArgs",
    "env",
    "env_rotation",
    "env_intensity",
    "LightArgs",
];

impl BatchArgs {
    /// Whether many pictures are asked for.
    pub(in crate::cli) fn is_asked(&self) -> bool {
        self.frames.is_some() || self.manifest.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_end_before_their_end() {
        assert_eq!("0..48".parse(), Ok(FrameRange { first: 0, end: 48 }));
        for bad in ["48", "0..0", "5..2", "-1..3", "0..x", "0..", "0..=3", "0..99999999"] {
            assert!(bad.parse::<FrameRange>().is_err(), "{bad}");
        }
        assert!(parse_rate("0").is_err() && parse_rate("inf").is_err() && parse_turn("nan").is_err());
    }
}
