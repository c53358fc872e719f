//! The device, the formats by role, the bind-group layouts, and the way back to memory.

pub mod bindings;
mod device;
pub mod formats;
mod kept;
mod lost;
pub mod pipeline;
mod readback;
mod staging;
mod timestamps;

pub use device::{Gpu, GpuError, GpuOptions, GpuRequest, adapters, usable_features, usable_limits};
pub use kept::{Identity, KeptUniform};
pub use lost::{DeviceLost, LostFlag, filled_buffer, write_buffer};
pub use readback::{Download, Readback, read_buffer, read_texel, read_texture};
pub use staging::{Staging, Uploads};
pub use timestamps::{PassClock, PassTime, Timestamps, timed};
