//! Why nothing could be proven.

use crate::gpu::GpuError;
use crate::shader::ShaderError;

/// A fault of a row of the tables, of a shader, or of the device; never of the numbers that were compared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ProofError {
    #[error(transparent)]
    Shader(#[from] ShaderError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The grid, the twin and the WGSL function do not fit each other.
    #[error("{row}: {reason}")]
    Row { row: String, reason: String },
}
