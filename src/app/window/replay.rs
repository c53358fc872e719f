//! A recording in place of a user.

use super::{App, ViewError};
use crate::app::input::{InputEvent, Recorded};
use std::time::{Duration, Instant};
use winit::dpi::PhysicalSize;
use winit::event_loop::ActiveEventLoop;

/// Between two looks at what a replay waits for.
const LOOK_AGAIN: Duration = Duration::from_millis(10);

impl App {
    /// Feeds the next event of a recording, once all that came before has been drawn.
    pub(super) fn play(&mut self, event_loop: &ActiveEventLoop) {
        let is_busy = self.stale || self.desk.loading.is_some() || self.due.is_some_and(|due| due <= Instant::now());
        let (Some(open), Some(player), false) = (&mut self.open, &mut self.player, is_busy) else { return };
        if let Some(until) = player.held_until() {
            self.due = Some(self.due.map_or(until, |due| due.min(until)));
            return;
        }
        let size = open.window.inner_size();
        if !player.has_size([size.width, size.height]) {
            self.due = Some(Instant::now() + LOOK_AGAIN);
            return;
        }
        let Some(Recorded { at_s, event }) = player.next() else {
            return self.end(event_loop);
        };
        match event {
            InputEvent::Resize { width, height } => {
                player.wait_for([width, height]);
                let _ = open.window.request_inner_size(PhysicalSize::new(width, height));
                self.refresh();
            }
            InputEvent::Hold { seconds } => {
                player.hold(seconds);
                self.due = Some(Instant::now());
            }
            InputEvent::LoseDevice => {
                open.stage.gpu.device.destroy();
                self.refresh();
            }
            InputEvent::PointAt { widget, x, y } => match open.gui.place(&widget, (x, y)) {
                Some((x, y)) => {
                    player.found();
                    self.input(event_loop, &InputEvent::Pointer { x, y }, at_s);
                }
                None if player
                    .may_come(Recorded { at_s, event: InputEvent::PointAt { widget: widget.clone(), x, y } }) =>
                {
                    self.due = Some(Instant::now() + LOOK_AGAIN);
                }
                None => {
                    let problem = format!("the recording points at `{widget}`, which the panel does not show");
                    self.fail(event_loop, ViewError::Replay(problem));
                }
            },
            event => self.input(event_loop, &event, at_s),
        }
    }

    /// Ends; a replay with its last picture.
    pub(super) fn end(&mut self, event_loop: &ActiveEventLoop) {
        if let (Some(path), Some(open)) = (self.screenshot_at_end.take(), &self.open)
            && let Err(problem) = self.desk.screenshot(&open.stage, &path)
        {
            return self.fail(event_loop, ViewError::Replay(problem));
        }
        event_loop.exit();
    }
}
