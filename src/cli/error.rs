//! One line for each failure, and its exit code.

use crate::app::StateError;
use crate::capture::CaptureError;
use crate::gpu::GpuError;
use crate::import::ImportError;
use crate::math::parameter::ParameterError;
use crate::proof::ProofError;
use std::path::PathBuf;
use std::process::ExitCode;

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub(super) enum CliError {
    #[error("{0}")]
    Usage(String),
    #[error(transparent)]
    Import(#[from] ImportError),
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    #[error(transparent)]
    Capture(#[from] CaptureError),
    #[error("{0}; install one (scripts/setup.sh), or leave out --require-gpu to use the CPU reference renderer")]
    NoAdapter(GpuError),
    #[error("{0}; install one (scripts/setup.sh): this runs on a GPU or on a software driver")]
    NeedsAdapter(GpuError),
    #[cfg(feature = "view")]
    #[error(transparent)]
    View(#[from] crate::app::ViewError),
    #[error(transparent)]
    Proof(#[from] ProofError),
    #[error("{path}: cannot write: {reason}", path = .path.display())]
    Write { path: PathBuf, reason: String },
    #[error(transparent)]
    State(#[from] StateError),
    #[error("{0}")]
    CheckFailed(String),
}

impl CliError {
    pub(super) fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::CheckFailed(_) => 1,
            #[cfg(feature = "view")]
            Self::View(crate::app::ViewError::Gpu(GpuError::NoAdapter { .. } | GpuError::NoMatch { .. })) => 3,
            #[cfg(feature = "view")]
            Self::View(_) => 2,
            Self::NoAdapter(_) | Self::NeedsAdapter(_) => 3,
            Self::Usage(_)
            | Self::Parameter(_)
            | Self::Import(_)
            | Self::Capture(_)
            | Self::Proof(_)
            | Self::State(_)
            | Self::Write { .. } => 2,
        })
    }
}
