//! What users do, written down and done again.

use super::input::{InputEvent, Recorded};
use super::window::ViewError;
use std::collections::VecDeque;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A window that has not got the size that was asked for by then will not get it.
const PATIENCE: Duration = Duration::from_secs(2);

/// A part of the panel that has not appeared by then will not.
const LOOKING: Duration = Duration::from_secs(60);

/// A file that grows by a line an event.
pub(super) struct Recorder {
    path: PathBuf,
    file: File,
}

impl Recorder {
    pub(super) fn create(path: &Path) -> Result<Self, ViewError> {
        let failed = |error: std::io::Error| ViewError::Record { path: path.to_owned(), reason: error.to_string() };
        Ok(Self { path: path.to_owned(), file: File::create(path).map_err(failed)? })
    }

    pub(super) fn write(&mut self, at_s: f64, event: &InputEvent) -> Result<(), ViewError> {
        let recorded = Recorded { at_s, event: event.clone() };
        let line = serde_json::to_string(&recorded).unwrap_or_default();
        let failed = |error: std::io::Error| ViewError::Record { path: self.path.clone(), reason: error.to_string() };
        writeln!(self.file, "{line}").map_err(failed)
    }
}

/// A recording that is played.
pub(super) struct Player {
    events: VecDeque<Recorded>,
    size: Option<([u32; 2], Instant)>,
    hold: Option<Instant>,
    /// Since when a part of the panel is looked for.
    missing: Option<Instant>,
}

impl Player {
    pub(super) fn new(events: Vec<Recorded>) -> Self {
        Self { events: events.into(), size: None, hold: None, missing: None }
    }

    pub(super) fn next(&mut self) -> Option<Recorded> {
        self.events.pop_front()
    }

    /// The window was asked to get a size.
    pub(super) fn wait_for(&mut self, size_px: [u32; 2]) {
        self.size = Some((size_px, Instant::now()));
    }

    /// What was looked for is there.
    pub(super) fn found(&mut self) {
        self.missing = None;
    }

    /// Puts an event back whose part of the panel is not there, if it may still come.
    pub(super) fn may_come(&mut self, event: Recorded) -> bool {
        let waits = self.missing.get_or_insert_with(Instant::now).elapsed() < LOOKING;
        if waits {
            self.events.push_front(event);
        }
        waits
    }

    /// Does nothing for a while.
    pub(super) fn hold(&mut self, seconds: f64) {
        let time = Duration::try_from_secs_f64(seconds).unwrap_or_default();
        self.hold = Instant::now().checked_add(time);
    }

    /// Until when nothing is to be done.
    pub(super) fn held_until(&mut self) -> Option<Instant> {
        self.hold = self.hold.filter(|until| *until > Instant::now());
        self.hold
    }

    /// Whether the window has the size that it was asked for, or will not get it.
    pub(super) fn has_size(&mut self, size_px: [u32; 2]) -> bool {
        let has = self.size.is_none_or(|(wanted, since)| wanted == size_px || since.elapsed() > PATIENCE);
        if has {
            self.size = None;
        }
        has
    }
}
