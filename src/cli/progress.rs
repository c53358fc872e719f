//! Progress on stderr, once something takes longer than a second.

use crate::progress::Progress;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Work that is done sooner than this shows nothing.
const PATIENCE: Duration = Duration::from_secs(1);

/// A bar on a terminal, a line a stage elsewhere; nothing at all in the first second, or when quiet.
#[derive(Debug)]
pub(super) struct StderrProgress {
    started: Instant,
    quiet: bool,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    stage: String,
    total: u64,
    done: u64,
    announced: bool,
    bar: Option<ProgressBar>,
}

impl StderrProgress {
    pub(super) fn new(quiet: bool) -> Self {
        Self { started: Instant::now(), quiet, state: Mutex::default() }
    }

    /// Removes the bar.
    pub(super) fn finish(&self) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(bar) = state.bar.take() {
            bar.finish_and_clear();
        }
    }

    fn show(&self, state: &mut State) {
        if self.quiet || self.started.elapsed() < PATIENCE {
            return;
        }
        if !std::io::stderr().is_terminal() {
            if !std::mem::replace(&mut state.announced, true) {
                eprintln!("specula: {} ...", state.stage);
            }
            return;
        }
        let bar = state.bar.get_or_insert_with(|| {
            let template = "{msg:>20} [{bar:40}] {pos}/{len} {eta}";
            let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::new(state.total.max(1)).with_style(style)
        });
        bar.set_message(state.stage.clone());
        bar.set_length(state.total.max(1));
        bar.set_position(state.done);
    }
}

impl Progress for StderrProgress {
    fn begin(&self, stage: &str, total: u64) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        stage.clone_into(&mut state.stage);
        (state.total, state.done, state.announced) = (total, 0, false);
        if let Some(bar) = state.bar.take() {
            bar.finish_and_clear();
        }
        self.show(&mut state);
    }

    fn advance(&self, steps: u64) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.done += steps;
        self.show(&mut state);
    }

    fn expect(&self, total: u64) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.total = total;
        self.show(&mut state);
    }
}
