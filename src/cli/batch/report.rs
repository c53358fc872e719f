//! What became of many pictures.

use crate::cli::error::CliError;
use crate::cli::stats::AdapterStats;
use crate::gpu::Gpu;
use serde::Serialize;
use std::path::{Path, PathBuf};

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum PictureStatus {
    Drawn,
    /// It was there, and is what would be drawn.
    Kept,
    Failed,
}

#[derive(Debug, Serialize)]
pub(super) struct PictureReport {
    pub(super) output: PathBuf,
    pub(super) status: PictureStatus,
    /// Why it has failed; one line.
    pub(super) reason: Option<String>,
    pub(super) milliseconds: f64,
}

/// Printed by `--json`.
#[derive(Debug, Serialize)]
pub(super) struct BatchReport {
    schema: &'static str,
    specula: &'static str,
    adapter: AdapterStats,
    pictures: Vec<PictureReport>,
    /// Animations and contact sheet.
    pub(super) made: Vec<PathBuf>,
}

impl BatchReport {
    pub(super) fn new(gpu: &Gpu, pictures: Vec<PictureReport>) -> Self {
        let (schema, specula) = ("specula-render-batch/1", env!("CARGO_PKG_VERSION"));
        Self { schema, specula, adapter: AdapterStats::of(gpu), pictures, made: Vec::new() }
    }

    pub(super) fn json(&self) -> Result<String, CliError> {
        let text = serde_json::to_string_pretty(self).map_err(|error| CliError::Usage(error.to_string()))?;
        Ok(format!("{text}\n"))
    }

    fn count(&self, status: PictureStatus) -> usize {
        self.pictures.iter().filter(|picture| picture.status == status).count()
    }

    /// `drew 12 pictures in out, kept 36`.
    pub(super) fn summary(&self, out: &Path) -> String {
        let drawn = format!("drew {} pictures in {}", self.count(PictureStatus::Drawn), out.display());
        let kept = match self.count(PictureStatus::Kept) {
            0 => String::new(),
            kept => format!(", kept {kept}"),
        };
        let made: String = self.made.iter().map(|path| format!(", made {}", path.display())).collect();
        drawn + &kept + &made
    }

    /// What has failed, with the first reason.
    pub(super) fn failure(&self) -> Option<String> {
        let first = self.pictures.iter().find(|picture| picture.status == PictureStatus::Failed)?;
        let (count, all) = (self.count(PictureStatus::Failed), self.pictures.len());
        let reason = first.reason.as_deref().unwrap_or_default();
        let place = first.output.display();
        Some(if count == 1 {
            format!("{place} could not be drawn: {reason}")
        } else {
            format!("{count} of {all} pictures could not be drawn; first {place}: {reason}")
        })
    }
}
