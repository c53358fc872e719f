//! The panel's library between our events and our device.

use super::input::{Button, InputEvent, Modifiers};
use super::viewer::Claims;
use crate::gpu::Gpu;
use egui::{Event, Pos2, pos2, vec2};
use egui_winit::winit::window::Window;
use std::collections::BTreeMap;
use std::time::Duration;

/// Places of named parts of the panel, in pixels: left, top, width and height.
type Places = BTreeMap<String, [f32; 4]>;

/// Where a frame takes a second, as on a software driver that compiles a shader, a click must not count as held.
const LONGEST_CLICK_S: f64 = 30.0;

/// What lies over the picture, and its state.
pub(super) struct Gui {
    pub(super) context: egui::Context,
    platform: egui_winit::State,
    renderer: egui_wgpu::Renderer,
    events: Vec<Event>,
    pointer: Pos2,
    modifiers: Modifiers,
    scale: f32,
}

/// A frame of it, ready to be painted.
pub(super) struct GuiFrame {
    shapes: Vec<egui::ClippedPrimitive>,
    screen: egui_wgpu::ScreenDescriptor,
    freed: Vec<egui::TextureId>,
    /// After which it wants to be drawn once more.
    pub(super) again: Duration,
}

impl Gui {
    pub(super) fn new(gpu: &Gpu, window: &Window, format: wgpu::TextureFormat) -> Self {
        let context = egui::Context::default();
        context.set_theme(egui::Theme::Dark);
        context.options_mut(|options| options.input_options.max_click_duration = LONGEST_CLICK_S);
        // The same bits for the same state: no dithering.
        let options = egui_wgpu::RendererOptions { dithering: false, ..Default::default() };
        let scale = window.scale_factor() as f32;
        let max_side = gpu.device.limits().max_texture_dimension_2d as usize;
        let viewport = egui::ViewportId::ROOT;
        Self {
            platform: egui_winit::State::new(context.clone(), viewport, window, Some(scale), None, Some(max_side)),
            renderer: egui_wgpu::Renderer::new(&gpu.device, format, options),
            context,
            events: Vec::new(),
            pointer: Pos2::ZERO,
            modifiers: Modifiers::default(),
            scale,
        }
    }

    pub(super) fn set_scale(&mut self, scale: f64) {
        self.scale = scale as f32;
    }

    /// Whose the next event is.
    pub(super) fn claims(&self) -> Claims {
        let pointer = self.context.egui_wants_pointer_input() || self.context.is_pointer_over_egui();
        Claims { pointer, keyboard: self.context.egui_wants_keyboard_input() }
    }

    /// Takes an event, for the next frame.
    pub(super) fn input(&mut self, event: &InputEvent) {
        let modifiers = modifiers(self.modifiers);
        match event {
            InputEvent::Pointer { x, y } => {
                self.pointer = pos2(*x as f32 / self.scale, *y as f32 / self.scale);
                self.events.push(Event::PointerMoved(self.pointer));
            }
            InputEvent::PointerLeft => self.events.push(Event::PointerGone),
            InputEvent::Button { button, pressed } => {
                let button = match button {
                    Button::Left => egui::PointerButton::Primary,
                    Button::Middle => egui::PointerButton::Middle,
                    Button::Right => egui::PointerButton::Secondary,
                };
                self.events.push(Event::PointerButton { pos: self.pointer, button, pressed: *pressed, modifiers });
            }
            InputEvent::Wheel { x, y } => {
                let delta = vec2(*x as f32, *y as f32);
                let wheel = Event::MouseWheel {
                    unit: egui::MouseWheelUnit::Line,
                    delta,
                    phase: egui::TouchPhase::Move,
                    modifiers,
                    source: egui::MouseWheelSource::Unknown,
                };
                self.events.push(wheel);
            }
            InputEvent::Modifiers(held) => self.modifiers = *held,
            // Keys are the viewer's, except while someone types.
            InputEvent::Key { key, pressed, text } if self.context.egui_wants_keyboard_input() => {
                self.key(key, *pressed, text.as_deref(), modifiers);
            }
            _ => {}
        }
    }

    fn key(&mut self, name: &str, pressed: bool, text: Option<&str>, modifiers: egui::Modifiers) {
        if pressed && modifiers.command {
            match name {
                "C" => self.events.push(Event::Copy),
                "X" => self.events.push(Event::Cut),
                "V" => self.events.extend(self.platform.clipboard_text().map(Event::Paste)),
                _ => {}
            }
        } else if let Some(text) = text.filter(|text| pressed && !text.chars().any(char::is_control)) {
            self.events.push(Event::Text(text.to_owned()));
        }
        if let Some(key) = egui::Key::from_name(name) {
            self.events.push(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
        }
    }

    /// Lays out a frame.
    pub(super) fn run(
        &mut self,
        gpu: &Gpu,
        window: &Window,
        (size_px, at_s): ([u32; 2], f64),
        mut content: impl FnMut(&mut egui::Ui),
    ) -> GuiFrame {
        let size = vec2(size_px[0] as f32, size_px[1] as f32) / self.scale;
        let viewport = egui::ViewportInfo { native_pixels_per_point: Some(self.scale), ..Default::default() };
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(Pos2::ZERO, size)),
            viewports: std::iter::once((egui::ViewportId::ROOT, viewport)).collect(),
            time: Some(at_s),
            events: std::mem::take(&mut self.events),
            focused: true,
            ..Default::default()
        };
        // What is not shown any more has no place.
        self.context.data_mut(|data| data.remove::<Places>(egui::Id::unique("places")));
        let mut output = self.context.run_ui(input, |ui| content(ui));
        for (id, deltas) in output.textures_delta.set.drain() {
            deltas.iter().for_each(|delta| self.renderer.update_texture(&gpu.device, &gpu.queue, id, delta));
        }
        let freed = output.textures_delta.free.drain().collect();
        self.platform.handle_platform_output(window, output.platform_output);
        let root = output.viewport_output.get(&egui::ViewportId::ROOT);
        GuiFrame {
            again: root.map_or(Duration::MAX, |viewport| viewport.repaint_delay),
            shapes: self.context.tessellate(output.shapes, output.pixels_per_point),
            screen: egui_wgpu::ScreenDescriptor { size_in_pixels: size_px, pixels_per_point: output.pixels_per_point },
            freed,
        }
    }

    /// Pixels that so many points are, rounded.
    pub(super) fn pixels(&self, points: f32) -> u32 {
        (points * self.scale).round() as u32
    }

    /// Uploads what a frame needs.
    pub(super) fn prepare(&mut self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, frame: &GuiFrame) {
        // There are no callbacks, and so no commands of theirs.
        let commands = self.renderer.update_buffers(&gpu.device, &gpu.queue, encoder, &frame.shapes, &frame.screen);
        gpu.queue.submit(commands);
    }

    /// Paints a frame over what `pass` shows.
    pub(super) fn paint(&self, pass: &mut wgpu::RenderPass<'static>, frame: &GuiFrame) {
        self.renderer.render(pass, &frame.shapes, &frame.screen);
    }

    /// Lets go of what the frame was the last to need.
    pub(super) fn finish(&mut self, frame: &GuiFrame) {
        frame.freed.iter().for_each(|id| self.renderer.free_texture(id));
    }

    /// The place of a named part of the panel: the point at these shares of its width and height, in pixels.
    pub(super) fn place(&self, name: &str, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        let [left, top, width, height] = *places(&self.context).get(name)?;
        let share =
            |from: f32, size: f32, share: f64| (f64::from(from) + f64::from(size) * share) * f64::from(self.scale);
        Some((share(left, width, x), share(top, height, y)))
    }
}

/// Gives a part of the panel a name, by which recordings find it.
pub(super) fn name_place(response: &egui::Response, name: impl Into<String>) {
    let rect = response.rect;
    let place = [rect.left(), rect.top(), rect.width(), rect.height()];
    response.ctx.data_mut(|data| {
        data.get_temp_mut_or_default::<Places>(egui::Id::unique("places")).insert(name.into(), place);
    });
}

fn places(context: &egui::Context) -> Places {
    context.data(|data| data.get_temp(egui::Id::unique("places"))).unwrap_or_default()
}

fn modifiers(held: Modifiers) -> egui::Modifiers {
    let Modifiers { shift, ctrl, alt } = held;
    egui::Modifiers { alt, ctrl, shift, mac_cmd: false, command: ctrl }
}
