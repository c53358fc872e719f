//! Which renderer draws, on which device, how precisely.

use super::error::CliError;
use crate::capture::{CaptureError, CaptureOptions};
use crate::gpu::formats::Precision;
use crate::gpu::{Gpu, GpuError, GpuOptions, GpuRequest};
use crate::renderer::PathChoice;
use clap::ValueEnum;

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Renderer")]
pub(super) struct DriverArgs {
    /// auto takes the GPU (a software driver counts as one), and the CPU reference where there is none.
    #[arg(long, value_enum, default_value = "auto")]
    renderer: RendererArg,
    #[command(flatten)]
    frame: FrameArgs,
    #[command(flatten)]
    device: DeviceArgs,
    /// Fail with exit code 3 when there is no adapter, instead of using the CPU reference renderer.
    #[arg(long)]
    require_gpu: bool,
}

/// How a frame is drawn.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Renderer")]
pub(super) struct FrameArgs {
    /// Samples a pixel of the rasteriser.
    #[arg(long, value_name = "1|4", default_value_t = 4)]
    msaa: u32,
    /// forward shades triangle by triangle. deferred finds out first what is seen and shades that, where it can (opaque
    /// triangles), and draws the rest (blended and masked ones, lines, points) over it; it differs at edges alone. auto takes deferred on software drivers where triangles are small, which is
    /// faster there, and else forward.
    #[arg(long, value_enum, default_value = "auto")]
    path: PathArg,
    /// Precision of the radiance target, and of .exr files.
    #[arg(long, value_enum, default_value = "half")]
    precision: PrecisionArg,
}

/// Which adapter draws.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Renderer")]
pub(super) struct DeviceArgs {
    /// Part of the name of the adapter to use.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    #[arg(long, value_enum)]
    backend: Option<BackendArg>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum RendererArg {
    Auto,
    Gpu,
    Reference,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum PathArg {
    Auto,
    Forward,
    Deferred,
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

impl From<PrecisionArg> for Precision {
    fn from(arg: PrecisionArg) -> Self {
        match arg {
            PrecisionArg::Half => Self::Half,
            PrecisionArg::Float => Self::Float,
        }
    }
}

impl FrameArgs {
    pub(super) fn precision(&self) -> Precision {
        self.precision.into()
    }

    /// The same with one sample a pixel, which is shaded in its middle.
    pub(super) fn with_one_sample(&self) -> Self {
        Self { msaa: 1, ..self.clone() }
    }

    pub(super) fn capture_options(&self) -> CaptureOptions {
        CaptureOptions { samples: self.msaa, precision: self.precision() }
    }

    /// The paths that frames may take on a device.
    pub(super) fn paths_on(&self, gpu: &Gpu) -> PathChoice {
        match self.path {
            PathArg::Auto => PathChoice::for_device(gpu.info.device_type),
            PathArg::Forward => PathChoice::Forward,
            PathArg::Deferred => PathChoice::Deferred,
        }
    }
}

impl DeviceArgs {
    /// The adapter that is asked for.
    pub(super) fn request(&self) -> GpuRequest {
        let backends = self.backend.map(|backend| match backend {
            BackendArg::Vulkan => crate::wgpu::Backends::VULKAN,
            BackendArg::Gl => crate::wgpu::Backends::GL,
            BackendArg::Metal => crate::wgpu::Backends::METAL,
            BackendArg::Dx12 => crate::wgpu::Backends::DX12,
        });
        GpuRequest { adapter: self.adapter.clone(), backends }
    }
}

impl DriverArgs {
    /// Whether the reference renderer is asked for.
    pub(super) fn is_reference(&self) -> bool {
        self.renderer == RendererArg::Reference
    }

    /// How a frame is drawn.
    pub(super) fn frame(&self) -> &FrameArgs {
        &self.frame
    }

    pub(super) fn precision(&self) -> Precision {
        self.frame.precision()
    }

    pub(super) fn capture_options(&self) -> CaptureOptions {
        self.frame.capture_options()
    }

    /// The paths that frames may take on a device.
    pub(super) fn paths_on(&self, gpu: &Gpu) -> PathChoice {
        self.frame.paths_on(gpu)
    }

    /// The flags that make another process of this program draw on the same adapter by the same path.
    pub(super) fn arguments(&self) -> Vec<String> {
        let value = |value: &dyn Fn() -> Option<clap::builder::PossibleValue>| value().map(|v| v.get_name().to_owned());
        let flags = [
            ("--adapter", self.device.adapter.clone()),
            ("--backend", self.device.backend.and_then(|backend| value(&|| backend.to_possible_value()))),
            ("--path", value(&|| self.frame.path.to_possible_value())),
            ("--precision", value(&|| self.frame.precision.to_possible_value())),
        ];
        flags.into_iter().filter_map(|(flag, value)| Some([flag.to_owned(), value?])).flatten().collect()
    }

    /// The adapter that is asked for.
    pub(super) fn request(&self) -> GpuRequest {
        self.device.request()
    }

    /// The device, or `None` where the reference renderer is asked for, or has to do, of which a warning tells.
    ///
    /// # Errors
    /// When a GPU is required and there is none, or the device cannot be had.
    pub(super) fn open(&self, warnings: &mut Vec<String>) -> Result<Option<Gpu>, CliError> {
        self.open_for(self.precision(), warnings)
    }

    /// The same for a target of another precision.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub(super) fn open_for(&self, precision: Precision, warnings: &mut Vec<String>) -> Result<Option<Gpu>, CliError> {
        if self.is_reference() {
            return Ok(None);
        }
        match Gpu::open(&self.request(), GpuOptions { precision }) {
            Ok(gpu) => Ok(Some(gpu)),
            Err(error @ (GpuError::NoAdapter { .. } | GpuError::NoMatch { .. })) => {
                if self.require_gpu || self.renderer == RendererArg::Gpu {
                    return Err(CliError::NoAdapter(error));
                }
                warnings.push(format!("{error}; the CPU reference renderer draws instead"));
                Ok(None)
            }
            Err(error) => Err(CaptureError::from(error).into()),
        }
    }
}
