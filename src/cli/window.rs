//! `specula view`: a model in a window.

use super::error::CliError;
use super::view::parse_size;
use crate::app::input::{Recorded, parse_recording};
use crate::app::{ViewOptions, ViewerState, is_state, run as open_window, shaders_in};
use crate::cache::user_folder;
use crate::gpu::GpuRequest;
use glam::UVec2;
use std::path::{Path, PathBuf};

/// Open a window and look at a model. H shows what the keys do.
#[derive(Debug, clap::Args)]
pub(super) struct WindowArgs {
    /// glTF model (.gltf or .glb), a folder of models, or a state (.json) that the viewer has saved. Without, the window
    /// is empty and waits for one to be dropped.
    model: Option<PathBuf>,
    /// Panorama (.hdr or .exr), or one of: neutral (a built-in studio), white, black.
    #[arg(long, value_name = "FILE|neutral|white|black")]
    env: Option<String>,
    /// Size of the picture in pixels.
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    size: Option<UVec2>,
    /// Part of the name of the adapter to use.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Read the model, and the shaders of --shaders, again when their files change. What does not work is named in the
    /// window, and what worked last stays.
    #[arg(long)]
    watch: bool,
    /// Take the shader files (.wgsl) of this folder in place of those that are built in: a copy of the sources' `shaders`
    /// that is worked on.
    #[arg(long, value_name = "FOLDER")]
    shaders: Option<PathBuf>,
    /// Keep nothing for the next time: neither prefiltered panoramas nor the list of recent files. Both are in the folder
    /// that SPECULA_CACHE_DIR names, or else in the system's place for caches.
    #[arg(long)]
    no_cache: bool,
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
    let mut state = match &args.model {
        Some(path) if is_state(path) => ViewerState::read(path)?,
        model => ViewerState { model: model.clone(), ..ViewerState::default() },
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
    let shaders = args.shaders.clone();
    if let Some(folder) = &shaders {
        // Later a folder that cannot be read is named in the window.
        shaders_in(folder).map_err(CliError::Usage)?;
    }
    let cache = if args.no_cache { None } else { user_folder() };
    let watch = args.watch;
    open_window(ViewOptions { state, request, watch, shaders, cache, record, replay, screenshot_at_end })?;
    Ok(())
}

fn recording(path: &Path) -> Result<Vec<Recorded>, CliError> {
    let problem = |problem: String| CliError::Usage(format!("{}: {problem}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|error| problem(format!("cannot read: {error}")))?;
    parse_recording(&text).map_err(problem)
}
