//! How long work reports how far it is, without knowing who listens.

/// A listener for the progress of one job at a time. Called from any thread.
pub trait Progress: Sync {
    /// A new stage begins; `total` steps are expected, 0 when unknown.
    fn begin(&self, stage: &str, total: u64);
    /// `steps` more steps of the current stage are done.
    fn advance(&self, steps: u64);
    /// The current stage is now expected to take `total` steps in all.
    fn expect(&self, _total: u64) {}
}

/// Listens to nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _stage: &str, _total: u64) {}
    fn advance(&self, _steps: u64) {}
}
