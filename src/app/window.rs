//! The window: events in, pictures out. It draws when something has changed, and sleeps otherwise.

mod replay;

use super::desk::{Desk, DeskOptions};
use super::gui::{Gui, GuiFrame};
use super::input::{InputEvent, Recorded};
use super::panel;
use super::recording::{Player, Recorder};
use super::stage::Stage;
use super::state::ViewerState;
use super::surface::Screen;
use super::translate::{Fingers, translate};
use super::viewer::Effect;
use crate::capture::CaptureError;
use crate::gpu::{Gpu, GpuError, GpuOptions, GpuRequest};
use crate::passes::{PresentPass, Presented};
use crate::renderer::RenderError;
use crate::shader::ShaderSources;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::window::{Fullscreen, Window, WindowId};

/// Behind what is not covered, display values.
const BEHIND: [f32; 3] = [0.16; 3];
/// Repaints that the panel asks for later than this do not matter.
const NEVER: Duration = Duration::from_secs(3600);
/// Between two steps of a flight.
const FLIGHT_STEP: Duration = Duration::from_millis(16);

/// How the viewer is started.
#[derive(Debug, Clone, Default)]
pub struct ViewOptions {
    /// What is shown first; `model` may name a folder.
    pub state: ViewerState,
    pub request: GpuRequest,
    /// Whether a model and the shaders are read again when their files change.
    pub watch: bool,
    /// A folder of shader files in place of those that are built in.
    pub shaders: Option<PathBuf>,
    /// The folder below which prefiltered panoramas and the list of recent files are kept; without, nothing is.
    pub cache: Option<PathBuf>,
    /// Where what the user does is written down.
    pub record: Option<PathBuf>,
    /// What is done in place of a user; then the window is closed.
    pub replay: Option<Vec<Recorded>>,
    /// The last picture of a replay.
    pub screenshot_at_end: Option<PathBuf>,
}

/// Why the viewer has ended before the user wanted it to.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ViewError {
    #[error("no window can be opened here: {0}; `specula render` needs none")]
    NoWindow(String),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Capture(#[from] CaptureError),
    #[error("{path}: cannot write: {reason}", path = .path.display())]
    Record { path: PathBuf, reason: String },
    #[error("{0}")]
    Replay(String),
}

/// Opens a window and returns when it is closed.
///
/// # Errors
/// When there is no window system or no device that can draw in a window, or a replay cannot go on.
pub fn run(options: ViewOptions) -> Result<(), ViewError> {
    let no_window = |error: winit::error::EventLoopError| {
        // Before the reason stands the place in winit's code.
        let text = error.to_string();
        ViewError::NoWindow(text.rsplit(": ").next().unwrap_or(&text).to_owned())
    };
    let event_loop = EventLoop::<()>::with_user_event().build().map_err(no_window)?;
    let proxy = event_loop.create_proxy();
    // A window that is gone needs no waking.
    let wake = Arc::new(move || proxy.send_event(()).unwrap_or_default());
    let recorder = options.record.as_deref().map(Recorder::create).transpose()?;
    let of_desk = DeskOptions { watch: options.watch, cache: options.cache, shaders: options.shaders };
    let mut app = App {
        desk: Desk::new(options.state, of_desk, wake),
        request: options.request,
        recorder,
        player: options.replay.map(Player::new),
        screenshot_at_end: options.screenshot_at_end,
        began: Instant::now(),
        open: None,
        fingers: Fingers::default(),
        panel_px: 0,
        titled: None,
        stale: true,
        due: None,
        passed: None,
        failure: None,
    };
    event_loop.run_app(&mut app).map_err(no_window)?;
    app.failure.map_or(Ok(()), Err)
}

/// A window with a device that draws in it.
struct Open {
    window: Arc<Window>,
    screen: Screen,
    stage: Stage,
    gui: Gui,
    present: PresentPass,
    /// Shown while there is no picture.
    blank: wgpu::TextureView,
}

struct App {
    desk: Desk,
    request: GpuRequest,
    recorder: Option<Recorder>,
    player: Option<Player>,
    screenshot_at_end: Option<PathBuf>,
    began: Instant,
    open: Option<Open>,
    fingers: Fingers,
    /// How wide the panel is.
    panel_px: u32,
    /// The model that the title of the window names.
    titled: Option<PathBuf>,
    /// Something may look different than it is on the screen.
    stale: bool,
    /// When it will, if nothing else happens.
    due: Option<Instant>,
    /// When a flight was moved last.
    passed: Option<Instant>,
    failure: Option<ViewError>,
}

impl Open {
    fn new(
        event_loop: &ActiveEventLoop,
        window: Arc<Window>,
        (request, shaders): (&GpuRequest, ShaderSources),
    ) -> Result<Self, ViewError> {
        let display = Box::new(event_loop.owned_display_handle());
        let (gpu, surface) = Gpu::open_for_window(request, GpuOptions::default(), display, Arc::clone(&window))?;
        let screen = Screen::new(&gpu, Arc::clone(&window), surface)?;
        let gui = Gui::new(&gpu, &window, screen.format);
        let present = PresentPass::new(&gpu.device, &ShaderSources::default(), screen.format);
        let present = present.map_err(|error| CaptureError::from(RenderError::from(error)))?;
        let blank = super::stage::upload_picture(&gpu, [1, 1], &[0; 4]);
        Ok(Self { window, screen, stage: Stage::new(gpu, shaders), gui, present, blank })
    }

    /// Shows the picture with the panel beside it, and from a place on, pixels from the left, another picture.
    fn show(
        &mut self,
        size_px: [u32; 2],
        frame: &GuiFrame,
        other: Option<&(wgpu::TextureView, f32)>,
    ) -> Result<(), GpuError> {
        let gpu = &self.stage.gpu;
        let Some(texture) = self.screen.next(gpu, size_px)? else {
            self.gui.finish(frame);
            return Ok(());
        };
        let target = texture.texture.create_view(&Default::default());
        let left = self.stage.shown().unwrap_or(&self.blank);
        let (right, split_px) = match other {
            Some((right, split_px)) => (right, *split_px),
            None => (left, f32::MAX),
        };
        let presented = Presented { left, right, split_px, behind: BEHIND };
        let group = self.present.prepare((&gpu.device, &gpu.queue), &presented)?;
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("window") });
        self.gui.prepare(gpu, &mut encoder, frame);
        {
            let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("window"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                depth_stencil_attachment: None,
                timestamp_writes: None,
                occlusion_query_set: None,
                multiview_mask: None,
            });
            let mut pass = pass.forget_lifetime();
            self.present.draw(&mut pass, &group);
            self.gui.paint(&mut pass, frame);
        }
        gpu.queue.submit([encoder.finish()]);
        self.window.pre_present_notify();
        gpu.queue.present(texture);
        self.gui.finish(frame);
        Ok(())
    }
}

impl App {
    fn fail(&mut self, event_loop: &ActiveEventLoop, error: impl Into<ViewError>) {
        self.failure = Some(error.into());
        event_loop.exit();
    }

    fn at_s(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    /// Takes what a user, or a recording, has done at a time.
    fn input(&mut self, event_loop: &ActiveEventLoop, event: &InputEvent, at_s: f64) {
        let Some(open) = &mut self.open else { return };
        open.gui.input(event);
        let effects = self.desk.viewer.input(event, at_s, open.gui.claims());
        self.do_effects(event_loop, effects);
        self.refresh();
    }

    fn do_effects(&mut self, event_loop: &ActiveEventLoop, effects: Vec<Effect>) {
        for effect in effects {
            if let (Effect::Fullscreen, Some(open)) = (&effect, &self.open) {
                let whole = open.window.fullscreen().is_none().then_some(Fullscreen::Borderless(None));
                open.window.set_fullscreen(whole);
            }
            let stage = self.open.as_ref().map(|open| &open.stage);
            if !self.desk.effect(effect, stage) {
                self.end(event_loop);
            }
        }
    }

    /// Asks for a frame.
    fn refresh(&mut self) {
        self.stale = true;
        if let Some(open) = &self.open {
            open.window.request_redraw();
        }
    }

    fn redraw(&mut self, event_loop: &ActiveEventLoop) {
        let at_s = self.at_s();
        let Some(open) = &mut self.open else { return };
        if open.stage.gpu.is_lost() {
            return self.recover(event_loop);
        }
        (self.stale, self.due) = (false, None);
        let size = open.window.inner_size();
        let size_px = [size.width, size.height];
        if size_px.contains(&0) {
            return;
        }
        self.desk.viewer.state.size_px = beside(size_px, self.panel_px);
        self.desk.turn(&mut open.stage);
        let (desk, stage, mut effects, mut panel) = (&mut self.desk, &open.stage, Vec::new(), 0.0);
        let frame = open.gui.run(&open.stage.gpu, &open.window, (size_px, at_s), |ui| {
            let (asked, width) = panel::show(ui, desk, stage);
            effects.extend(asked);
            panel = width;
        });
        // What the panel has changed is seen at once, and the picture has the room that it leaves.
        self.panel_px = open.gui.pixels(panel);
        self.desk.viewer.state.size_px = beside(size_px, self.panel_px);
        self.desk.turn(&mut open.stage);
        if self.titled != self.desk.viewer.state.model {
            self.titled.clone_from(&self.desk.viewer.state.model);
            open.window.set_title(&title(self.titled.as_deref()));
        }
        let before = open.stage.frames;
        let (drawn, split) = draw_picture(&mut self.desk, &mut open.stage);
        if open.stage.timing.is_some() && open.stage.frames > before {
            // The panel was laid out before its times were known.
            self.due = Some(Instant::now());
        }
        let asked = ask_shaders(&mut self.desk, &mut open.stage);
        if asked.as_ref().is_ok_and(|is_new| *is_new) {
            self.due = Some(Instant::now());
        }
        let shown = open.show(size_px, &frame, split.as_ref()).map_err(CaptureError::from);
        self.desk.is_seen();
        let checked = open.stage.gpu.check().map_err(CaptureError::from);
        if let Err(error) = drawn.and(asked).and(shown).and(checked) {
            if open.stage.gpu.is_lost() {
                return self.recover(event_loop);
            }
            // The next frame says so; that it fails like this one changes nothing any more.
            if self.desk.frame_failed(&error, &mut open.stage) {
                self.due = Some(Instant::now());
            }
        }
        if frame.again < NEVER {
            let again = Instant::now() + frame.again;
            self.due = Some(self.due.map_or(again, |due| due.min(again)));
        }
        self.do_effects(event_loop, effects);
    }

    /// Opens a device again after one was lost, and puts the scene on it.
    fn recover(&mut self, event_loop: &ActiveEventLoop) {
        let Some(Open { window, .. }) = self.open.take() else { return };
        match Open::new(event_loop, window, (&self.request, self.desk.good_shaders())) {
            Ok(mut open) => {
                self.desk.move_to(&mut open.stage);
                self.open = Some(open);
                self.refresh();
            }
            Err(error) => self.fail(event_loop, error),
        }
    }

    /// Moves a flight on.
    fn fly(&mut self, event_loop: &ActiveEventLoop) {
        if !self.desk.viewer.is_flying() {
            self.passed = None;
            return;
        }
        let now = Instant::now();
        let since = now.duration_since(*self.passed.get_or_insert(now));
        if since >= FLIGHT_STEP {
            self.passed = Some(now);
            self.happened(
                event_loop,
                &InputEvent::Pass { seconds: since.min(Duration::from_millis(100)).as_secs_f64() },
            );
        }
        self.due = Some(self.due.unwrap_or(now + FLIGHT_STEP).min(now + FLIGHT_STEP));
    }

    /// Takes an event that comes from the window.
    fn happened(&mut self, event_loop: &ActiveEventLoop, event: &InputEvent) {
        let at_s = self.at_s();
        if let Some(recorder) = &mut self.recorder
            && let Err(error) = recorder.write(at_s, event)
        {
            return self.fail(event_loop, error);
        }
        self.input(event_loop, event, at_s);
    }
}

/// Of the window in which a model is open.
fn title(model: Option<&Path>) -> String {
    let name = model.and_then(Path::file_name).map(|name| name.to_string_lossy());
    name.map_or("Specula".into(), |name| format!("{name} - Specula"))
}

/// The size of a picture beside a panel of a window.
fn beside([width, height]: [u32; 2], panel_px: u32) -> [u32; 2] {
    [width.saturating_sub(panel_px).max(1), height]
}

/// Draws what the state asks for. What is shown beyond a place, and that place, where there is something.
fn draw_picture(desk: &mut Desk, stage: &mut Stage) -> (Result<(), CaptureError>, Option<(wgpu::TextureView, f32)>) {
    let Some(view) = desk.view() else { return (Ok(()), None) };
    desk.turn_truth(stage, &view);
    let interface = &desk.viewer.interface;
    let drawn = stage.draw(&view, interface.statistics);
    let truth = desk.truth.as_mut().and_then(|truth| truth.texture(stage, &view, interface.errors));
    let split_px = (interface.split * f64::from(view.size_px.x)) as f32;
    (drawn, truth.map(|truth| (truth, split_px)))
}

/// Asks the shaders about the pixel that is looked into. Whether there is something new to show.
fn ask_shaders(desk: &mut Desk, stage: &mut Stage) -> Result<bool, CaptureError> {
    if desk.viewer.interface.inspector { desk.inspected.ask(stage) } else { Ok(false) }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.open.is_some() {
            return;
        }
        let [width, height] = self.desk.viewer.state.size_px;
        let attributes =
            Window::default_attributes().with_title("Specula").with_inner_size(PhysicalSize::new(width, height));
        let window = match event_loop.create_window(attributes) {
            Ok(window) => Arc::new(window),
            Err(error) => return self.fail(event_loop, ViewError::NoWindow(error.to_string())),
        };
        match Open::new(event_loop, window, (&self.request, self.desk.good_shaders())) {
            Ok(open) => {
                // Whoever waits for it goes on.
                let _ = self.desk.max_side.set(open.stage.gpu.device.limits().max_texture_dimension_2d);
                self.open = Some(open);
                self.refresh();
            }
            Err(error) => self.fail(event_loop, error),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, (): ()) {
        self.refresh();
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::RedrawRequested => self.redraw(event_loop),
            WindowEvent::ScaleFactorChanged { scale_factor, .. } => {
                if let Some(open) = &mut self.open {
                    open.gui.set_scale(scale_factor);
                }
                self.refresh();
            }
            WindowEvent::Focused(false) if self.player.is_none() => {
                self.desk.viewer.releases().iter().for_each(|event| self.happened(event_loop, event));
                self.refresh();
            }
            WindowEvent::Occluded(false) | WindowEvent::Focused(_) => self.refresh(),
            // While a recording is played, nobody else has a say; but the window has the size that it has.
            event if self.player.is_some() => {
                if matches!(event, WindowEvent::Resized(_)) {
                    self.refresh();
                }
            }
            event => {
                let events = translate(&event, &mut self.fingers);
                events.iter().for_each(|event| self.happened(event_loop, event));
            }
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        self.fly(event_loop);
        if self.due.is_some_and(|due| due <= Instant::now()) {
            self.refresh();
        }
        self.play(event_loop);
        let is_held = self.player.as_mut().is_some_and(|player| player.held_until().is_some());
        let busy = self.player.is_some() && !self.stale && self.desk.loading.is_none() && !is_held;
        event_loop.set_control_flow(match self.due {
            _ if busy => ControlFlow::Poll,
            Some(due) => ControlFlow::WaitUntil(due),
            None => ControlFlow::Wait,
        });
    }
}
