//! The window's surface: configured to the window's size, and brought back when it is lost.

use crate::gpu::{Gpu, GpuError, formats};
use std::sync::Arc;
use winit::window::Window;

/// What is to be done about a surface that gave no texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Trouble {
    /// The window cannot be seen, or the system is busy: try again when something happens.
    Skip,
    /// Configured anew, it will do.
    Configure,
    /// It has to be made anew.
    Recreate,
}

/// A surface that is drawn on in [`formats::presented`].
pub(super) struct Screen {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    pub(super) format: wgpu::TextureFormat,
    configuration: Option<wgpu::SurfaceConfiguration>,
}

impl Screen {
    /// # Errors
    /// When the surface has no format that takes display values.
    pub(super) fn new(gpu: &Gpu, window: Arc<Window>, surface: wgpu::Surface<'static>) -> Result<Self, GpuError> {
        let possible = surface.get_capabilities(&gpu.adapter).formats;
        let format = formats::presented(&possible)
            .ok_or_else(|| GpuError::NoSurface(format!("its formats are {possible:?}, none of 8 bits without sRGB")))?;
        Ok(Self { window, surface, format, configuration: None })
    }

    /// The next texture to draw into, of the given size. Nothing while the window cannot be seen or has no size.
    ///
    /// # Errors
    /// When the surface is lost and cannot be had again.
    pub(super) fn next(
        &mut self,
        gpu: &Gpu,
        [width, height]: [u32; 2],
    ) -> Result<Option<wgpu::SurfaceTexture>, GpuError> {
        if width == 0 || height == 0 {
            return Ok(None);
        }
        let is_other =
            |configuration: &wgpu::SurfaceConfiguration| (configuration.width, configuration.height) != (width, height);
        if self.configuration.as_ref().is_none_or(is_other) {
            self.configure(gpu, width, height);
        }
        // A surface that is outdated or lost is repaired once; what then still does not work is left for the next frame.
        for _ in 0..2 {
            match judge(self.surface.get_current_texture()) {
                Ok(texture) => return Ok(Some(texture)),
                Err(Trouble::Skip) => return Ok(None),
                Err(Trouble::Configure) => self.configure(gpu, width, height),
                Err(Trouble::Recreate) => {
                    self.surface = gpu.surface(Arc::clone(&self.window))?;
                    self.configure(gpu, width, height);
                }
            }
        }
        Ok(None)
    }

    fn configure(&mut self, gpu: &Gpu, width: u32, height: u32) {
        let configuration = self.surface.get_default_config(&gpu.adapter, width, height);
        let configuration = configuration.map(|default| wgpu::SurfaceConfiguration {
            format: self.format,
            present_mode: wgpu::PresentMode::AutoVsync,
            desired_maximum_frame_latency: 2,
            ..default
        });
        if let Some(configuration) = &configuration {
            self.surface.configure(&gpu.device, configuration);
        }
        self.configuration = configuration;
    }
}

fn judge(texture: wgpu::CurrentSurfaceTexture) -> Result<wgpu::SurfaceTexture, Trouble> {
    use wgpu::CurrentSurfaceTexture::{Lost, Occluded, Outdated, Suboptimal, Success, Timeout, Validation};
    match texture {
        // One that is suboptimal can be shown; the size is checked before each frame.
        Success(texture) | Suboptimal(texture) => Ok(texture),
        Timeout | Occluded => Err(Trouble::Skip),
        Outdated | Validation => Err(Trouble::Configure),
        Lost => Err(Trouble::Recreate),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_trouble_has_its_cure() {
        use wgpu::CurrentSurfaceTexture as Current;
        let cure = |texture| judge(texture).map(|_| ()).unwrap_err();
        assert_eq!([Current::Timeout, Current::Occluded].map(cure), [Trouble::Skip; 2]);
        assert_eq!([Current::Outdated, Current::Validation].map(cure), [Trouble::Configure; 2]);
        assert_eq!(cure(Current::Lost), Trouble::Recreate);
    }
}
