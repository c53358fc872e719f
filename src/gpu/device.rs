//! Finding an adapter and opening it for headless work.

use super::formats::Precision;
use super::lost::{DeviceLost, LostFlag};
use std::sync::{Arc, Mutex, PoisonError};

/// Which adapter is wanted.
#[derive(Debug, Clone, Default)]
pub struct GpuRequest {
    /// Part of the adapter's name, in any case.
    pub adapter: Option<String>,
    /// Backends to look at; all that were built when empty.
    pub backends: Option<wgpu::Backends>,
}

/// How the device is to be opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GpuOptions {
    /// Ask for what a float32 target with blending and multisampling needs, where the adapter has it.
    pub precision: Precision,
}

/// Why there is no device.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    #[error("no usable graphics adapter was found (looked at {looked_at})")]
    NoAdapter { looked_at: String },
    #[error("no adapter matches {wanted:?}; found: {found}")]
    NoMatch { wanted: String, found: String },
    #[error("the adapter {adapter} gave no device: {reason}")]
    NoDevice { adapter: String, reason: String },
    #[error("the window gives no surface to draw on: {0}")]
    NoSurface(String),
    #[error("the GPU failed: {0}")]
    Failed(String),
    #[error(transparent)]
    Lost(#[from] DeviceLost),
}

/// An open device of our own, for capture and tests; embedders bring theirs.
#[derive(Debug)]
pub struct Gpu {
    pub info: wgpu::AdapterInfo,
    pub adapter: wgpu::Adapter,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    instance: wgpu::Instance,
    errors: Arc<Mutex<Vec<String>>>,
    lost: LostFlag,
}

/// The optional features that Specula uses when they are there; none is required.
pub fn usable_features(precision: Precision) -> wgpu::Features {
    let float_target = match precision {
        Precision::Half => wgpu::Features::empty(),
        Precision::Float => {
            wgpu::Features::FLOAT32_BLENDABLE | wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES
        }
    };
    let timestamps = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    let lines = wgpu::Features::POLYGON_MODE_LINE;
    float_target | timestamps | lines | wgpu::Features::TEXTURE_FORMAT_16BIT_NORM | wgpu::Features::PRIMITIVE_INDEX
}

/// What a device is asked for: the limits that every WebGPU device has, but textures and buffers as large as the adapter
/// can.
pub fn usable_limits(adapter: &wgpu::Limits) -> wgpu::Limits {
    wgpu::Limits {
        max_texture_dimension_2d: adapter.max_texture_dimension_2d,
        max_buffer_size: adapter.max_buffer_size,
        max_storage_buffer_binding_size: adapter.max_storage_buffer_binding_size,
        ..wgpu::Limits::default().or_worse_values_from(adapter)
    }
}

impl Gpu {
    /// Opens the best adapter that matches: hardware before software, a native API before GL.
    pub fn open(request: &GpuRequest, options: GpuOptions) -> Result<Self, GpuError> {
        pollster::block_on(async {
            let (instance, adapter) = choose_adapter(request).await?;
            Self::open_async(instance, adapter, options).await
        })
    }

    /// The same among the adapters that can draw into a window of `display`.
    pub fn open_for_window(
        request: &GpuRequest,
        options: GpuOptions,
        display: Box<dyn wgpu::wgt::WgpuHasDisplayHandle>,
        window: impl Into<wgpu::SurfaceTarget<'static>>,
    ) -> Result<(Self, wgpu::Surface<'static>), GpuError> {
        pollster::block_on(async {
            let instance = instance(request, Some(display));
            let surface = surface(&instance, window)?;
            let mut adapters = matching_adapters(&instance, request).await?;
            adapters.retain(|adapter| adapter.is_surface_supported(&surface));
            Ok((Self::open_async(instance, first(adapters)?, options).await?, surface))
        })
    }

    /// Another surface for the window of this device, after the one before was lost.
    pub fn surface(&self, window: impl Into<wgpu::SurfaceTarget<'static>>) -> Result<wgpu::Surface<'static>, GpuError> {
        surface(&self.instance, window)
    }

    async fn open_async(
        instance: wgpu::Instance,
        adapter: wgpu::Adapter,
        options: GpuOptions,
    ) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("specula"),
            required_features: adapter.features() & usable_features(options.precision),
            required_limits: usable_limits(&adapter.limits()),
            memory_hints: memory_hints(info.device_type),
            ..Default::default()
        };
        let (device, queue) = adapter
            .request_device(&descriptor)
            .await
            .map_err(|error| GpuError::NoDevice { adapter: info.name.clone(), reason: error.to_string() })?;
        let errors = Arc::new(Mutex::new(Vec::new()));
        let sink = Arc::clone(&errors);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            sink.lock().unwrap_or_else(PoisonError::into_inner).push(error.to_string());
        }));
        let lost = LostFlag::watch(&device);
        Ok(Self { info, adapter, device, queue, instance, errors, lost })
    }

    /// Whether the device is gone, and all that was made of it. Asks the driver.
    pub fn is_lost(&self) -> bool {
        // What is wrong with a device that cannot be asked shows in the flag, or at the next frame.
        let _ = self.device.poll(wgpu::PollType::Poll);
        self.lost.is_raised()
    }

    /// What says so without asking the driver.
    pub fn lost_flag(&self) -> &LostFlag {
        &self.lost
    }

    /// Fails when the driver or wgpu has reported anything since the last call.
    pub fn check(&self) -> Result<(), GpuError> {
        let mut errors = self.errors.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(first) = errors.first().map(|message| one_line(message)) else { return Ok(()) };
        errors.clear();
        Err(GpuError::Failed(first))
    }

    /// Waits until all that was submitted is done.
    pub fn wait(&self) -> Result<(), GpuError> {
        let poll = self.device.poll(wgpu::PollType::wait_indefinitely());
        poll.map_err(|error| GpuError::Failed(format!("waiting for the device: {error}")))?;
        self.check()
    }

    /// Name, API and driver in one line.
    pub fn description(&self) -> String {
        let wgpu::AdapterInfo { name, backend, driver, driver_info, .. } = &self.info;
        format!("{name} ({backend}, {driver} {driver_info})")
    }
}

/// All adapters that match, the one that [`Gpu::open`] takes first.
pub fn adapters(request: &GpuRequest) -> Result<Vec<wgpu::Adapter>, GpuError> {
    pollster::block_on(matching_adapters(&instance(request, None), request))
}

/// Memory of a software driver is the process's own, and what is let go of a block that holds something else stays taken.
/// There, textures and what is staged for them shall not share blocks.
fn memory_hints(device: wgpu::DeviceType) -> wgpu::MemoryHints {
    const BLOCK_BYTES: u64 = 8 << 20;
    match device {
        wgpu::DeviceType::Cpu => {
            wgpu::MemoryHints::Manual { suballocated_device_memory_block_size: BLOCK_BYTES..BLOCK_BYTES }
        }
        _ => wgpu::MemoryHints::MemoryUsage,
    }
}

async fn choose_adapter(request: &GpuRequest) -> Result<(wgpu::Instance, wgpu::Adapter), GpuError> {
    // Asking GL loads a second software driver, with which no more is possible than with the first.
    if request.adapter.is_none() && request.backends.is_none() && !may_have_hardware() {
        let without_gl = GpuRequest { backends: Some(wgpu::Backends::all() - wgpu::Backends::GL), adapter: None };
        let instance = instance(&without_gl, None);
        if let Ok(adapters) = matching_adapters(&instance, &without_gl).await
            && let Some(adapter) = adapters.into_iter().next()
        {
            return Ok((instance, adapter));
        }
    }
    let instance = instance(request, None);
    let adapter = first(matching_adapters(&instance, request).await?)?;
    Ok((instance, adapter))
}

/// False where the system has no device that a GL driver could drive; of other systems than Linux this is not known.
fn may_have_hardware() -> bool {
    // Kernel drivers of all graphics cards; NVIDIA's own, WSL's, Adreno's and Mali's.
    const DEVICES: [&str; 5] = ["/dev/dri", "/dev/nvidia0", "/dev/dxg", "/dev/kgsl-3d0", "/dev/mali0"];
    !cfg!(target_os = "linux") || DEVICES.iter().any(|device| std::path::Path::new(device).exists())
}

fn instance(request: &GpuRequest, display: Option<Box<dyn wgpu::wgt::WgpuHasDisplayHandle>>) -> wgpu::Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    descriptor.display = display;
    if let Some(backends) = request.backends {
        descriptor.backends = backends;
    }
    wgpu::Instance::new(descriptor)
}

fn surface(
    instance: &wgpu::Instance,
    window: impl Into<wgpu::SurfaceTarget<'static>>,
) -> Result<wgpu::Surface<'static>, GpuError> {
    instance.create_surface(window).map_err(|error| GpuError::NoSurface(one_line(&error.to_string())))
}

fn first(adapters: Vec<wgpu::Adapter>) -> Result<wgpu::Adapter, GpuError> {
    adapters.into_iter().next().ok_or_else(|| GpuError::NoAdapter { looked_at: "all backends".into() })
}

async fn matching_adapters(instance: &wgpu::Instance, request: &GpuRequest) -> Result<Vec<wgpu::Adapter>, GpuError> {
    let backends = request.backends.unwrap_or_else(|| wgpu::Backends::all().with_env());
    let mut adapters = instance.enumerate_adapters(backends).await;
    if adapters.is_empty() {
        return Err(GpuError::NoAdapter { looked_at: format!("{backends:?}") });
    }
    if let Some(wanted) = &request.adapter {
        let found = adapters.iter().map(|adapter| adapter.get_info().name).collect::<Vec<_>>().join(", ");
        let wanted_lower = wanted.to_lowercase();
        adapters.retain(|adapter| adapter.get_info().name.to_lowercase().contains(&wanted_lower));
        if adapters.is_empty() {
            return Err(GpuError::NoMatch { wanted: wanted.clone(), found });
        }
    }
    adapters.sort_by_key(|adapter| rank(&adapter.get_info()));
    Ok(adapters)
}

/// Lower is better.
fn rank(info: &wgpu::AdapterInfo) -> (u8, u8) {
    let device = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Cpu => 3,
        wgpu::DeviceType::Other => 4,
    };
    (device, u8::from(info.backend == wgpu::Backend::Gl))
}

fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}
