//! `specula render`: a model to a picture.

use super::camera::CameraArgs;
use super::color::srgb8_from_hex;
use super::environment::EnvironmentArgs;
use super::error::CliError;
use super::light::LightArgs;
use super::output::{self, Format};
use super::overrides;
use super::progress::StderrProgress;
use super::stats::{AdapterStats, GpuStats, RenderStats, Stopwatch};
use super::truth::TruthArgs;
use crate::bake::environment::{self, BakeOptions};
use crate::capture::{CaptureError, CaptureOptions, CaptureTarget, Wanted, submit};
use crate::gpu::formats::Precision;
use crate::gpu::{Gpu, GpuError, GpuOptions, GpuRequest};
use crate::import::{ImportOptions, Imported, SceneChoice, model_from_path, model_from_slice};
use crate::progress::Progress;
use crate::reference::color::to_srgb8;
use crate::reference::estimate;
use crate::renderer::Renderer;
use crate::scene::{Background, EnvironmentMaps, Geometry, Quality, RadianceImage, Scene, ToneMap, View};
use glam::{UVec2, Vec3};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Pictures larger than this on a side are refused before memory is asked for.
const SIDE_MAX: u32 = 16384;

#[derive(Debug, clap::Args)]
pub(super) struct RenderArgs {
    /// glTF model (.gltf or .glb); - reads it from stdin.
    model: PathBuf,
    /// The picture: .png (display-referred) or .exr (linear radiance); - writes PNG to stdout.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Kind of picture, when the name does not tell.
    #[arg(long)]
    format: Option<Format>,
    /// Size of the picture in pixels.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1024x1024", value_parser = parse_size)]
    size: UVec2,
    #[command(flatten)]
    environment: EnvironmentArgs,
    #[command(flatten)]
    lights: LightArgs,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    look: LookArgs,
    #[command(flatten)]
    driver: DriverArgs,
    #[command(flatten)]
    truth: TruthArgs,
    /// Which scene of the file, by number or name, instead of its default.
    #[arg(long, value_name = "N|NAME")]
    scene: Option<String>,
    /// Set a number of materials: their name or index (* stands for any text), a parameter, and its value. A disney.*
    /// parameter turns a material into a Disney one; colours are #rrggbb or r,g,b; a texture of the parameter goes.
    #[arg(long = "override", value_name = "NAME.PARAMETER=VALUE")]
    overrides: Vec<String>,
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

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Look")]
struct LookArgs {
    /// Exposure in stops.
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true)]
    exposure: f32,
    #[arg(long, value_enum, default_value = "neutral")]
    tone_map: ToneMapArg,
    /// transparent, env, or a colour #rrggbb. By default a panorama of yours is seen, and a built-in one is not.
    #[arg(long, value_name = "transparent|env|#rrggbb", value_parser = parse_background)]
    background: Option<Background>,
    /// Give back the energy that single-scattering microfacets lose.
    #[arg(long, value_enum, default_value = "on")]
    energy_compensation: Switch,
    /// How microfacets hide each other, for punctual lights.
    #[arg(long, value_name = "MODEL", default_value = "smith-correlated", value_parser = parse_geometry)]
    geometry: Geometry,
    /// Time against error of light from the environment: split-sum (the baseline), draft, standard or high.
    #[arg(long, value_name = "TIER", default_value = "standard", value_parser = parse_quality)]
    quality: Quality,
}

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Renderer")]
struct DriverArgs {
    /// auto takes the GPU (a software driver counts as one), and the CPU reference where there is none.
    #[arg(long, value_enum, default_value = "auto")]
    renderer: RendererArg,
    /// Samples a pixel of the rasteriser.
    #[arg(long, value_name = "1|4", default_value_t = 4)]
    msaa: u32,
    /// Precision of the radiance target, and of .exr files.
    #[arg(long, value_enum, default_value = "half")]
    precision: PrecisionArg,
    /// Part of the name of the adapter to use.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    #[arg(long, value_enum)]
    backend: Option<BackendArg>,
    /// Fail with exit code 3 when there is no adapter, instead of using the CPU reference renderer.
    #[arg(long)]
    require_gpu: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Switch {
    On,
    Off,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum RendererArg {
    Auto,
    Gpu,
    Reference,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum PrecisionArg {
    Half,
    Float,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum BackendArg {
    Vulkan,
    Gl,
    Metal,
    Dx12,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum ToneMapArg {
    Neutral,
    Aces,
    Agx,
    Reinhard,
    Linear,
    None,
}

impl From<PrecisionArg> for Precision {
    fn from(arg: PrecisionArg) -> Self {
        match arg {
            PrecisionArg::Half => Self::Half,
            PrecisionArg::Float => Self::Float,
        }
    }
}

impl From<ToneMapArg> for ToneMap {
    fn from(arg: ToneMapArg) -> Self {
        match arg {
            ToneMapArg::Neutral => Self::Neutral,
            ToneMapArg::Aces => Self::Aces,
            ToneMapArg::Agx => Self::AgX,
            ToneMapArg::Reinhard => Self::Reinhard,
            ToneMapArg::Linear => Self::Linear,
            ToneMapArg::None => Self::None,
        }
    }
}

fn parse_size(text: &str) -> Result<UVec2, String> {
    let (width, height) = text.split_once('x').ok_or("expected WIDTHxHEIGHT, such as 1024x768")?;
    let side = |text: &str| match text.parse::<u32>() {
        Ok(side) if (1..=SIDE_MAX).contains(&side) => Ok(side),
        _ => Err(format!("`{text}` is not a number of pixels from 1 to {SIDE_MAX}")),
    };
    Ok(UVec2::new(side(width)?, side(height)?))
}

fn parse_geometry(text: &str) -> Result<Geometry, String> {
    let names = || Geometry::ALL.map(Geometry::name).join(", ");
    Geometry::by_name(text).ok_or_else(|| format!("expected one of {}", names()))
}

fn parse_quality(text: &str) -> Result<Quality, String> {
    let names = || Quality::ALL.map(Quality::name).join(", ");
    Quality::by_name(text).ok_or_else(|| format!("expected one of {}", names()))
}

fn parse_background(text: &str) -> Result<Background, String> {
    match text {
        "transparent" => Ok(Background::Transparent),
        "env" => Ok(Background::Environment),
        color => {
            let channels = srgb8_from_hex(color).ok_or("expected transparent, env, or a colour #rrggbb")?;
            Ok(Background::Color(Vec3::from(channels.map(f32::from)) / 255.0))
        }
    }
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
    let format = args.format.map_or_else(|| Format::of(&args.output), Ok)?;
    if args.json && args.output == Path::new("-") {
        return Err(CliError::Usage("--json and `-o -` both want stdout; use --stats FILE.json".into()));
    }
    args.truth.check(args.driver.renderer == RendererArg::Reference)?;
    let lights = args.lights.parse()?;
    let progress = StderrProgress::new(args.quiet);
    let mut watch = Stopwatch::default();

    let Imported { mut scene, warnings, .. } = watch.time("decode", || load(args, &progress))?;
    let mut warnings: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    overrides::apply(&mut scene, &args.overrides)?;
    scene.environment = watch.time("environment decode", || args.environment.load())?;
    for light in lights {
        warnings.extend(light.note);
        scene.add_light(light.light, light.position_in_world, light.direction_in_world);
    }
    let view = args.view(&scene)?;

    let gpu = match args.driver.renderer {
        RendererArg::Reference => None,
        wanted => watch.time("device", || open_gpu(&args.driver, wanted, &mut warnings))?,
    };
    let rendered = match gpu {
        Some(gpu) => draw(args, &gpu, &scene, &view, format, (&progress, &mut watch))?,
        None => trace(args, &scene, &view, format, (&progress, &mut watch)),
    };
    progress.finish();
    warnings.extend(rendered.warnings);
    if !args.quiet {
        warnings.iter().for_each(|warning| eprintln!("specula: warning: {warning}"));
    }
    let bytes = watch.time("encode", || encode(&rendered.picture, &view, args.driver.precision.into()));
    let bytes = bytes.map_err(|reason| CliError::Write { path: args.output.clone(), reason })?;
    watch.time("write", || output::write(&args.output, &bytes))?;
    write_error_image(args, rendered.standard_error.as_ref())?;

    let stats = RenderStats {
        schema: "specula-render-stats/1",
        specula: env!("CARGO_PKG_VERSION"),
        model: args.model.display().to_string(),
        output: args.output.display().to_string(),
        renderer: if rendered.gpu.is_some() { "gpu" } else { "reference" },
        adapter: rendered.adapter,
        size_px: view.size_px.to_array(),
        samples: rendered.samples,
        relative_error: rendered.relative_error,
        gpu: rendered.gpu,
        milliseconds: watch.stages(),
        warnings,
    };
    report(args, &stats)
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

fn load(args: &RenderArgs, progress: &dyn Progress) -> Result<Imported, CliError> {
    let scene = args.scene.as_ref().map(|scene| match scene.parse() {
        Ok(index) => SceneChoice::Index(index),
        Err(_) => SceneChoice::Name(scene.clone()),
    });
    load_model(&args.model, &ImportOptions { scene, progress, ..Default::default() })
}

/// The model of a file, or of stdin for `-`.
pub(super) fn load_model(path: &Path, options: &ImportOptions<'_>) -> Result<Imported, CliError> {
    if path != Path::new("-") {
        return Ok(model_from_path(path, options)?);
    }
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().read_to_end(&mut bytes);
    read.map_err(|error| CliError::Usage(format!("stdin: cannot read the model: {error}")))?;
    Ok(model_from_slice(&bytes, "stdin", None, options)?)
}

impl RenderArgs {
    fn view(&self, scene: &Scene) -> Result<View, CliError> {
        if !self.look.exposure.is_finite() {
            return Err(CliError::Usage("--exposure takes a finite number of stops".into()));
        }
        let background = self.look.background.unwrap_or(if self.environment.is_file() {
            Background::Environment
        } else {
            Background::Color(Vec3::splat(0.16))
        });
        Ok(View {
            camera: self.camera.camera(scene, self.size)?,
            size_px: self.size,
            exposure_ev: self.look.exposure,
            tone_map: self.look.tone_map.into(),
            background,
            energy_compensation: self.look.energy_compensation == Switch::On,
            geometry: self.look.geometry,
            quality: self.look.quality,
        })
    }
}

/// The device, or `None` with a warning when the reference renderer has to do.
fn open_gpu(args: &DriverArgs, wanted: RendererArg, warnings: &mut Vec<String>) -> Result<Option<Gpu>, CliError> {
    let backends = args.backend.map(|backend| match backend {
        BackendArg::Vulkan => crate::wgpu::Backends::VULKAN,
        BackendArg::Gl => crate::wgpu::Backends::GL,
        BackendArg::Metal => crate::wgpu::Backends::METAL,
        BackendArg::Dx12 => crate::wgpu::Backends::DX12,
    });
    let request = GpuRequest { adapter: args.adapter.clone(), backends };
    match Gpu::open(&request, GpuOptions { precision: args.precision.into() }) {
        Ok(gpu) => Ok(Some(gpu)),
        Err(error @ (GpuError::NoAdapter { .. } | GpuError::NoMatch { .. })) => {
            if args.require_gpu || wanted == RendererArg::Gpu {
                return Err(CliError::NoAdapter(error));
            }
            warnings.push(format!("{error}; the CPU reference renderer draws instead"));
            Ok(None)
        }
        Err(error) => Err(CaptureError::from(error).into()),
    }
}

fn bake_maps(scene: &Scene, quality: Quality, progress: &dyn Progress) -> Option<EnvironmentMaps> {
    let options = BakeOptions { suns: quality.parts_suns(), ..Default::default() };
    let environment = scene.environment.as_ref().filter(|environment| environment.intensity > 0.0)?;
    Some(environment::bake(&environment.image, &options, progress))
}

fn draw(
    args: &RenderArgs,
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    format: Format,
    (progress, watch): (&dyn Progress, &mut Stopwatch),
) -> Result<Rendered, CliError> {
    let options = CaptureOptions { samples: args.driver.msaa, precision: args.driver.precision.into() };
    let target = CaptureTarget::new(gpu, view, options)?;
    let maps = watch.time("environment bake", || bake_maps(scene, view.quality, progress));
    let (device, queue) = (&gpu.device, &gpu.queue);
    let (mut renderer, mut uploaded) = watch.time("upload", || -> Result<_, CliError> {
        let renderer = Renderer::new(device, queue);
        let uploaded = renderer.upload(device, queue, scene, maps.as_ref()).map_err(CaptureError::from)?;
        Ok((renderer, uploaded))
    })?;
    let plan = watch.time("pipelines", || renderer.prepare(device, &uploaded, view, target.forward_target()));
    let plan = plan.map_err(CaptureError::from)?;
    if args.verbose {
        eprintln!("specula: {}\n{plan}", gpu.description());
    }
    let wanted = Wanted { radiance: format == Format::Exr, display: format == Format::Png };
    let pending = watch.time("first frame", || -> Result<_, CliError> {
        let pending = submit(gpu, &mut renderer, &mut uploaded, view, &target, wanted)?;
        pending.wait_drawn(gpu)?;
        Ok(pending)
    })?;
    let stats = pending.stats.clone();
    let frame = watch.time("readback", || pending.wait(gpu))?;
    if let Some(folder) = &args.dump_wgsl {
        dump_wgsl(&renderer, folder)?;
    }
    let picture = match (frame.display, frame.radiance) {
        (Some(display), _) => Picture::Display(display),
        (None, Some(radiance)) => Picture::Radiance(radiance),
        (None, None) => Picture::Display(Vec::new()),
    };
    Ok(Rendered {
        picture,
        adapter: Some(AdapterStats {
            name: gpu.info.name.clone(),
            kind: format!("{:?}", gpu.info.device_type),
            backend: gpu.info.backend.to_string(),
            driver: format!("{} {}", gpu.info.driver, gpu.info.driver_info).trim().to_owned(),
        }),
        gpu: Some(GpuStats {
            draws: stats.draws,
            triangles: stats.triangles,
            pipelines: stats.pipelines,
            geometry_bytes: uploaded.bytes.geometry,
            texture_bytes: uploaded.bytes.textures,
            environment_bytes: uploaded.bytes.environment,
            punctual_lights: scene.lights_in_world().len() as u32,
            environment: uploaded.features.environment,
        }),
        warnings: uploaded.warnings,
        samples: args.driver.msaa,
        standard_error: None,
        relative_error: None,
    })
}

fn trace(
    args: &RenderArgs,
    scene: &Scene,
    view: &View,
    format: Format,
    (progress, watch): (&dyn Progress, &mut Stopwatch),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_parse() {
        assert_eq!(parse_size("640x480").unwrap(), UVec2::new(640, 480));
        for bad in ["640", "0x1", "1x0", "x", "-1x5", "99999x1", "1x1x1"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn backgrounds_parse() {
        assert_eq!(parse_background("#ff0080").unwrap(), Background::Color(Vec3::new(1.0, 0.0, 128.0 / 255.0)));
        for bad in ["ff0080", "#ff008", "#gg0000", "#ff00801", ""] {
            assert!(parse_background(bad).is_err(), "{bad}");
        }
    }
}
