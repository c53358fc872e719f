//! `specula render`: a model to a picture.

use super::batch::{Batch, BatchArgs, SUBJECT};
use super::debug_view;
use super::driver::DriverArgs;
use super::environment::{CacheUse, bake_maps};
use super::error::CliError;
use super::output::{self, Format};
use super::parallel::beside;
use super::progress::StderrProgress;
use super::shot::Shot;
use super::stats::{AdapterStats, CulledStats, GpuStats, RenderStats, Stopwatch};
use super::subject::{SubjectArgs, load_model};
use super::tier::{TierArgs, TierStats};
use super::truth::TruthArgs;
use super::view::ViewArgs;
use crate::app::{Shown, ViewerState, environment_image, in_units, light_furnace, picture, view_of};
use crate::capture::{CaptureError, CaptureTarget, Wanted, submit};
use crate::gpu::formats::Precision;
use crate::gpu::{Gpu, Uploads};
use crate::gpu_scene::TextureLevels;
use crate::import::{Choice, ImportOptions, Imported};
use crate::progress::Progress;
use crate::reference::color::to_srgb8;
use crate::reference::estimate;
use crate::renderer::Renderer;
use crate::scene::{Channel, Image, RadianceImage, Scene, View};
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(Debug, clap::Args)]
// A state file names a model itself, and a manifest many.
#[command(mut_arg("model", |model| model.required(false).required_unless_present_any(["state", "manifest"])))]
pub(super) struct RenderArgs {
    #[command(flatten)]
    subject: SubjectArgs,
    /// Make the picture that the viewer saved with this state (.json): model, camera, light, look and materials. A MODEL
    /// on the command line takes the place of the state's.
    #[arg(long, value_name = "FILE.json", conflicts_with_all = SUBJECT)]
    state: Option<PathBuf>,
    /// The picture: .png (display-referred) or .exr (linear radiance); - writes PNG to stdout. The folder of --frames and
    /// --manifest.
    #[arg(short, long, value_name = "FILE|DIR")]
    output: PathBuf,
    /// Kind of picture, when the name does not tell.
    #[arg(long)]
    format: Option<Format>,
    #[command(flatten)]
    view: ViewArgs,
    #[command(flatten)]
    driver: DriverArgs,
    #[command(flatten)]
    batch: BatchArgs,
    #[command(flatten)]
    tier: TierArgs,
    #[command(flatten)]
    truth: TruthArgs,
    /// Show what shading reads, or one part of the light, instead of the picture: base-color, normal, ibl-specular,
    /// furnace, overdraw, wireframe, uv-checker and others (docs/inspect.md). An .exr holds the numbers as they are.
    #[arg(long, value_name = "NAME", value_parser = debug_view::parse)]
    debug_view: Option<Channel>,
    /// Write what was drawn and how long it took.
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Print the same on stdout.
    #[arg(long)]
    json: bool,
    /// Write every shader that was used into this folder.
    #[arg(long, value_name = "DIR")]
    dump_wgsl: Option<PathBuf>,
    /// Print the frame's plan and more about the driver.
    #[arg(short, long)]
    verbose: bool,
    /// Print neither progress nor warnings.
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,
}

/// A picture before it is a file.
enum Picture {
    Display(Vec<u8>),
    Radiance(RadianceImage),
}

/// What one renderer reports beside the picture.
struct Rendered {
    picture: Picture,
    adapter: Option<AdapterStats>,
    gpu: Option<GpuStats>,
    warnings: Vec<String>,
    /// Samples a pixel.
    samples: u32,
    /// Estimated by the reference renderer where it is asked to.
    standard_error: Option<RadianceImage>,
    relative_error: Option<f64>,
}

pub(super) fn run(args: &RenderArgs) -> Result<(), CliError> {
    if args.batch.is_asked() {
        return many(args);
    }
    let format = args.format.map_or_else(|| Format::of(&args.output), Ok)?;
    if args.json && args.output == Path::new("-") {
        return Err(CliError::Usage("--json and `-o -` both want stdout; use --stats FILE.json".into()));
    }
    args.truth.check(args.driver.is_reference())?;
    if args.tier.is_asked() && args.driver.is_reference() {
        return Err(CliError::Usage("--max-error and --max-ms choose a tier of the GPU; leave out --renderer".into()));
    }
    let progress = StderrProgress::new(args.quiet);
    let watch = Stopwatch::default();
    let mut warnings_of_device = Vec::new();
    let (loaded, gpu) =
        beside(|| load(args, &progress, &watch), || watch.time("device", || args.driver.open(&mut warnings_of_device)));
    let Subject { mut scene, mut warnings, mut view, model } = loaded?;
    let gpu = gpu?;
    warnings.extend(warnings_of_device);
    // A tier is chosen by the picture, whatever of it is drawn then.
    let channel = view.channel.take();
    let tier = watch
        .time("choose the tier", || choose_tier(args, gpu.as_ref(), &scene, &mut view, (&progress, &mut warnings)))?;
    view.channel = channel;
    let rendered = match gpu {
        Some(gpu) => draw(args, &gpu, &mut scene, &view, format, (&progress, &watch))?,
        None if view.channel.is_some() => {
            return Err(CliError::Usage(
                "--debug-view shows what shaders compute; it needs a GPU or a software driver".into(),
            ));
        }
        None => trace(args, &scene, &view, format, (&progress, &watch)),
    };
    progress.finish();
    warnings.extend(rendered.warnings);
    if !args.quiet {
        warnings.iter().for_each(|warning| eprintln!("specula: warning: {warning}"));
    }
    let bytes = watch.time("encode", || encode(&rendered.picture, &view, args.driver.precision()));
    let bytes = bytes.map_err(|reason| CliError::Write { path: args.output.clone(), reason })?;
    watch.time("write", || output::write(&args.output, &bytes))?;
    write_error_image(args, rendered.standard_error.as_ref())?;

    let stats = RenderStats {
        schema: "specula-render-stats/1",
        specula: env!("CARGO_PKG_VERSION"),
        model: model.display().to_string(),
        output: args.output.display().to_string(),
        renderer: if rendered.gpu.is_some() { "gpu" } else { "reference" },
        adapter: rendered.adapter,
        size_px: view.size_px.to_array(),
        samples: rendered.samples,
        relative_error: rendered.relative_error,
        tier,
        gpu: rendered.gpu,
        milliseconds: watch.stages(),
        warnings,
    };
    report(args, &stats)
}

fn many(args: &RenderArgs) -> Result<(), CliError> {
    let RenderArgs { subject, view, debug_view, driver, .. } = args;
    let shot = Shot { subject, view, frame: driver.frame(), debug_view: *debug_view };
    let (batch, cache, out) = (&args.batch, subject.cache(), args.output.as_path());
    Batch { args: batch, shot, driver, cache, out, json: args.json, quiet: args.quiet }.run()
}

/// What is drawn, and from where.
struct Subject {
    scene: Scene,
    warnings: Vec<String>,
    view: View,
    model: PathBuf,
}

fn load(args: &RenderArgs, progress: &dyn Progress, watch: &Stopwatch) -> Result<Subject, CliError> {
    let Some(path) = &args.state else {
        let (mut scene, warnings) = args.subject.load(progress, watch)?;
        light_furnace(&mut scene, args.debug_view);
        let view = args.view.view(&scene, args.subject.has_panorama(), None)?;
        let view = View { channel: args.debug_view, ..view };
        return Ok(Subject { scene, warnings, view, model: args.subject.model().to_owned() });
    };
    let state = ViewerState::read(path)?;
    let model = args.subject.given_model().or(state.model.as_deref());
    let model = model.ok_or_else(|| CliError::Usage(format!("{}: it names no model; name one", path.display())))?;
    let variant = state.variant.clone().map(Choice::Name);
    let (imported, environment) = beside(
        || watch.time("decode", || load_model(model, &ImportOptions { variant, progress, ..Default::default() })),
        || watch.time("environment decode", || environment_image(&state.environment.source)),
    );
    let Imported { scene, warnings, .. } = imported?;
    let mut shown = Shown::new(scene, &state);
    shown.surround(environment?.map(Arc::new), &state);
    shown.apply(&state);
    light_furnace(&mut shown.scene, state.look.debug_view);
    let view = view_of(&state, &shown.around);
    let warnings = warnings.iter().map(ToString::to_string).collect();
    Ok(Subject { view, warnings, model: model.to_owned(), scene: shown.scene })
}

/// Puts the tier that the limits on error and time ask for into the view.
fn choose_tier(
    args: &RenderArgs,
    gpu: Option<&Gpu>,
    scene: &Scene,
    view: &mut View,
    (progress, warnings): (&StderrProgress, &mut Vec<String>),
) -> Result<Option<TierStats>, CliError> {
    let Some(gpu) = gpu.filter(|_| args.tier.is_asked()) else { return Ok(None) };
    let options = (args.driver.capture_options(), args.driver.paths_on(gpu));
    let (quality, stats) =
        args.tier.choose((gpu, args.subject.cache()), (scene, view), options, (progress, warnings))?;
    view.quality = quality;
    progress.finish();
    if !args.quiet {
        eprintln!("specula: {stats}");
    }
    Ok(Some(stats))
}

fn report(args: &RenderArgs, stats: &RenderStats) -> Result<(), CliError> {
    let json = serde_json::to_string_pretty(stats).map_err(|error| CliError::Usage(error.to_string()))?;
    if let Some(path) = &args.stats {
        output::write(path, format!("{json}\n").as_bytes())?;
    }
    if args.json {
        output::write(Path::new("-"), format!("{json}\n").as_bytes())?;
    } else if args.output != Path::new("-") && !args.quiet {
        eprintln!("specula: wrote {}", args.output.display());
    }
    Ok(())
}

fn draw(
    args: &RenderArgs,
    gpu: &Gpu,
    scene: &mut Scene,
    view: &View,
    format: Format,
    (progress, watch): (&dyn Progress, &Stopwatch),
) -> Result<Rendered, CliError> {
    let target = CaptureTarget::new(gpu, view, args.driver.capture_options())?;
    let max_side = gpu.device.limits().max_texture_dimension_2d;
    let (baked, levels) = beside(
        || watch.time("environment bake", || bake_maps(scene, view.quality, args.subject.cache(), progress)),
        || watch.time("mips", || TextureLevels::of(scene, max_side)),
    );
    // Each texture's are in memory only until it is uploaded.
    scene.images.iter_mut().for_each(Image::forget_texels);
    let (device, queue) = (&gpu.device, &gpu.queue);
    let (mut renderer, mut uploaded) = watch.time("upload", || -> Result<_, CliError> {
        let renderer =
            Renderer::new(device, queue).with_uploads(Uploads::Bounded).with_paths(args.driver.paths_on(gpu));
        let uploaded = renderer
            .upload_with(device, queue, scene, levels, baked.as_ref().map(|baked| &baked.maps))
            .map_err(CaptureError::from)?;
        Ok((renderer, uploaded))
    })?;
    // The device has the maps.
    let cache = baked.map(|baked| baked.cache);
    let plan = watch.time("pipelines", || renderer.prepare(device, &uploaded, view, target.forward_target()));
    let plan = plan.map_err(CaptureError::from)?;
    if args.verbose {
        eprintln!("specula: {}\n{plan}", gpu.description());
        if let Some(CacheUse::Unavailable(reason)) = &cache {
            eprintln!("specula: warning: the environment is not kept for the next time: {reason}");
        }
    }
    let radiance = format == Format::Exr || view.channel.is_some();
    let wanted = Wanted { radiance, display: !radiance };
    let pending = watch.time("first frame", || -> Result<_, CliError> {
        let pending = submit(gpu, &mut renderer, &mut uploaded, view, &target, wanted)?;
        pending.wait_drawn(gpu)?;
        Ok(pending)
    })?;
    let stats = pending.stats.clone();
    // The picture is on its way; its way back needs the memory of what it was drawn into.
    drop(target);
    let frame = watch.time("readback", || pending.wait(gpu))?;
    if let Some(folder) = &args.dump_wgsl {
        dump_wgsl(&renderer, folder)?;
    }
    let picture = match (frame.display, frame.radiance, view.channel) {
        (None, Some(image), Some(channel)) => {
            let image = in_units(channel, image, view);
            match format {
                Format::Png => Picture::Display(picture(channel, &image, view)),
                Format::Exr => Picture::Radiance(image),
            }
        }
        (Some(display), ..) => Picture::Display(display),
        (None, Some(radiance), _) => Picture::Radiance(radiance),
        (None, None, _) => Picture::Display(Vec::new()),
    };
    Ok(Rendered {
        picture,
        adapter: Some(AdapterStats::of(gpu)),
        gpu: Some(GpuStats {
            path: stats.path.name(),
            draws: stats.draws,
            triangles: stats.triangles,
            pipelines: stats.pipelines.to_vec(),
            drawables: CulledStats::of(stats.drawables),
            placements: CulledStats::of(stats.placements),
            geometry_bytes: uploaded.bytes.geometry,
            texture_bytes: uploaded.bytes.textures,
            environment_bytes: uploaded.bytes.environment,
            punctual_lights: scene.lights_in_world().len() as u32,
            environment: uploaded.features.environment,
            environment_cache: cache.map(|cache| cache.name()),
        }),
        warnings: uploaded.warnings,
        samples: args.driver.capture_options().samples,
        standard_error: None,
        relative_error: None,
    })
}

fn trace(
    args: &RenderArgs,
    scene: &Scene,
    view: &View,
    format: Format,
    (progress, watch): (&dyn Progress, &Stopwatch),
) -> Rendered {
    let truth = watch.time("reference render", || estimate(scene, view, &args.truth.options(progress)));
    let picture = match format {
        Format::Png => Picture::Display(to_srgb8(&truth.radiance, view)),
        Format::Exr => Picture::Radiance(truth.radiance),
    };
    Rendered {
        picture,
        adapter: None,
        gpu: None,
        warnings: args.truth.warning(truth.relative_error).into_iter().collect(),
        samples: truth.samples,
        standard_error: truth.standard_error,
        relative_error: truth.relative_error,
    }
}

fn write_error_image(args: &RenderArgs, standard_error: Option<&RadianceImage>) -> Result<(), CliError> {
    let (Some(path), Some(image)) = (&args.truth.error_image, standard_error) else { return Ok(()) };
    let bytes = output::exr(image, Precision::Float);
    let bytes = bytes.map_err(|reason| CliError::Write { path: path.clone(), reason })?;
    output::write(path, &bytes)
}

fn encode(picture: &Picture, view: &View, precision: Precision) -> Result<Vec<u8>, String> {
    match picture {
        Picture::Display(rgba) => output::png(view.size_px.x, view.size_px.y, rgba),
        Picture::Radiance(image) => output::exr(image, precision),
    }
}

fn dump_wgsl(renderer: &Renderer, folder: &Path) -> Result<(), CliError> {
    let failed = |error: std::io::Error| CliError::Write { path: folder.to_owned(), reason: error.to_string() };
    std::fs::create_dir_all(folder).map_err(failed)?;
    for (name, text) in renderer.wgsl_sources() {
        output::write(&folder.join(format!("{name}.wgsl")), text.as_bytes())?;
    }
    Ok(())
}
