//! How much a file may make us allocate: asked before every allocation whose size the file decides.

use super::error::Fault;
use std::fmt::Display;
use std::sync::atomic::{AtomicU64, Ordering};

/// Bounds on what one import may use. What is over a bound is an error, found before memory is allocated for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of all files read, geometry and pixels decoded, together.
    pub decoded_bytes: u64,
    /// Longer side of an image, texels.
    pub image_side_px: u32,
    /// Elements of an accessor that has no data of its own: a few bytes of JSON may ask for any number of zeros.
    pub elements_without_data: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { decoded_bytes: 4 << 30, image_side_px: 16384, elements_without_data: 1 << 24 }
    }
}

/// What is left of [`Limits::decoded_bytes`]; shared by the threads of one import.
#[derive(Debug)]
pub(super) struct Budget {
    limit: u64,
    left: AtomicU64,
}

impl Budget {
    pub(super) fn new(limit: u64) -> Self {
        Self { limit, left: AtomicU64::new(limit) }
    }

    /// Spends `count` items of `size` bytes for what is found at `pointer`.
    pub(super) fn take(&self, count: u64, size: u64, pointer: impl Display) -> Result<(), Fault> {
        let spend = |left: u64| left.checked_sub(count.checked_mul(size)?);
        match self.left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, spend) {
            Ok(_) => Ok(()),
            Err(_) => Err(Fault::at(pointer, format!("needs more than is left of {} bytes in all", self.limit))
                .advise("reduce the model, or raise the limit on decoded bytes")),
        }
    }
}

/// Runs somebody else's code on data of the file: a panic inside it is `None`, because no file may take the process
/// down. The last resort, for panics that are known (the exr crate asserts on some damaged files) or feared; the
/// process's panic hook still has its say.
pub(super) fn guarded<T>(decode: impl FnOnce() -> T) -> Option<T> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(decode)).ok()
}
