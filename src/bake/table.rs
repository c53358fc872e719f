//! Tables as files: little-endian unorm16, nothing else.

use std::path::Path;

/// The nearest unorm16.
pub(super) fn unorm16(value: f64) -> u16 {
    (value.clamp(0.0, 1.0) * f64::from(u16::MAX)).round() as u16
}

/// A table that is part of the library: `width * height` texels of `channels` unorm16, row-major.
#[derive(Debug, Clone, Copy)]
pub struct EmbeddedTable {
    /// File name under `assets/`.
    pub file: &'static str,
    pub width: usize,
    pub height: usize,
    pub channels: usize,
    /// As the file has them: little-endian.
    pub bytes: &'static [u8],
    /// Computes it anew.
    pub bake: fn() -> Vec<u16>,
    /// Says what is wrong with the embedded values, if anything is.
    pub check: fn(&EmbeddedTable) -> Result<(), String>,
}

impl EmbeddedTable {
    /// The values that the library has.
    pub fn values(&self) -> Vec<u16> {
        self.bytes.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect()
    }

    /// Bakes the table into `folder`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, folder: &Path) -> std::io::Result<()> {
        let bytes: Vec<u8> = (self.bake)().into_iter().flat_map(u16::to_le_bytes).collect();
        std::fs::write(folder.join(self.file), bytes)
    }

    /// The [check](Self::check) of a table that is the same on every bake: within one step of 65535, as the
    /// trigonometric functions of another platform may round the other way.
    pub(super) fn is_what_a_bake_makes(&self) -> Result<(), String> {
        let (baked, embedded) = ((self.bake)(), self.values());
        let differences = baked.iter().zip(&embedded).map(|(a, b)| a.abs_diff(*b));
        match differences.max() {
            Some(0..=1) if baked.len() == embedded.len() => Ok(()),
            steps => Err(format!("{} differs by {} steps", self.file, steps.unwrap_or(u16::MAX))),
        }
    }
}
