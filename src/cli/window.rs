//! `specula view`: a model in a window.

use super::error::CliError;
use super::view::parse_size;
use crate::app::input::{Recorded, parse_recording};
use crate::app::{ViewOptions, ViewerState, run as open_window};
use crate::gpu::GpuRequest;
use glam::UVec2;
use std::path::{Path, PathBuf};

/// Open a window and look at a model. H shows what the keys do.
#[derive(Debug, clap::Args)]
pub(super) struct WindowArgs {
    /// glTF model (.gltf or .glb), a folder of models, or a state (.json) that the viewer has saved.
    model: PathBuf,
    /// Panorama (.hdr or .exr), or one of: neutral (a built-in studio), white, black.
    #[arg(long, value_name = "FILE|neutral|white|black")]
    env: Option<String>,
    /// Size of the picture in pixels.
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    size: Option<UVec2>,
    /// Part of the name of the adapter to use.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Read the model again when its files change.
    #[arg(long)]
    watch: bool,
    /// Write down what is done, a line of JSON an event.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Do what was written down, and close the window.
    #[arg(long, value_name = "FILE", conflicts_with = "record")]
    replay: Option<PathBuf>,
    /// Save the last picture of a replay, and beside it, as .json, the state that makes it again.
    #[arg(long, value_name = "FILE.png", requires = "replay")]
    screenshot_at_end: Option<PathBuf>,
}

pub(super) fn run(args: &WindowArgs) -> Result<(), CliError> {
    let is_state = args.model.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    let mut state = if is_state {
        ViewerState::read(&args.model)?
    } else {
        ViewerState { model: Some(args.model.clone()), ..ViewerState::default() }
    };
    if let Some(env) = &args.env {
        state.environment.source.clone_from(env);
    }
    if let Some(size) = args.size {
        state.size_px = size.to_array();
    }
    let replay = args.replay.as_deref().map(recording).transpose()?;
    let request = GpuRequest { adapter: args.adapter.clone(), backends: None };
    let (record, screenshot_at_end) = (args.record.clone(), args.screenshot_at_end.clone());
    open_window(ViewOptions { state, request, watch: args.watch, record, replay, screenshot_at_end })?;
    Ok(())
}

fn recording(path: &Path) -> Result<Vec<Recorded>, CliError> {
    let problem = |problem: String| CliError::Usage(format!("{}: {problem}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|error| problem(format!("cannot read: {error}")))?;
    parse_recording(&text).map_err(problem)
}
