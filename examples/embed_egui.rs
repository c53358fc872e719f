//! A model among the widgets of egui: one paint callback prepares the frame before egui's render pass and draws in it.
//! What egui lays out later, a window here, covers the model as it covers any widget.
//!
//! `cargo run --release --example embed_egui` writes `docs/pictures/embed_egui.png`, without opening a window. In eframe
//! the callback is the same; there `NativeOptions::depth_buffer` is 32.

mod host;

use egui_wgpu::{Callback, CallbackResources, CallbackTrait, ScreenDescriptor};
use host::{Attachments, read, save};
use specula::bake::environment::bake;
use specula::embed::{EmbedError, LiveScene, ModelId};
use specula::glam::{DMat4, UVec2};
use specula::gpu::pipeline::DepthTarget;
use specula::gpu::{Gpu, GpuOptions, GpuRequest, formats};
use specula::progress::Silent;
use specula::renderer::{FrameState, Output, PassFormat, Renderer};
use specula::scene::{Background, Environment, Scene, View, framing::default_view};
use specula::{import, wgpu};
use std::sync::Arc;

type Failure = Box<dyn std::error::Error>;

pub(crate) const SIZE_PX: UVec2 = UVec2::new(480, 270);

#[allow(dead_code, reason = "tests take the picture alone")]
fn main() -> Result<(), Failure> {
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    let model = import::model_from_path("assets/showcase.glb".as_ref(), &Default::default())?.scene;
    let mut desk = Desk::new(&gpu, &model)?;
    save("embed_egui", SIZE_PX, &desk.picture(&gpu, &Widgets { turn_rad: 0.35, exposure_ev: 0.0 })?)
}

/// egui's pass: it draws in display light, and eframe clears the depth to 1.
fn pass() -> PassFormat {
    let depth = DepthTarget { format: wgpu::TextureFormat::Depth32Float, reversed: false };
    PassFormat { color: formats::CAPTURED_DISPLAY, depth: Some(depth), output: Output::Display, ..PassFormat::own(4) }
}

/// What the widgets say.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Widgets {
    pub(crate) turn_rad: f64,
    pub(crate) exposure_ev: f32,
}

/// What egui keeps for us from frame to frame, among the resources of its callbacks.
struct Module {
    renderer: Renderer,
    scene: LiveScene,
    model: ModelId,
    state: FrameState,
    failure: Option<EmbedError>,
}

/// The model in its place on the screen.
struct Turntable {
    view: View,
    at_px: UVec2,
    turn_rad: f64,
}

impl CallbackTrait for Turntable {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _: &ScreenDescriptor,
        _: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(module) = resources.get_mut::<Module>() {
            module.failure = module.prepare((device, queue), self).err();
        }
        Vec::new()
    }

    fn paint(&self, _: egui::PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, resources: &CallbackResources) {
        let Some(module) = resources.get::<Module>() else { return };
        if let Some(prepared) = module.scene.uploaded().and_then(|scene| module.state.prepared(scene)) {
            prepared.paint(pass);
        }
    }
}

impl Module {
    fn prepare(&mut self, gpu: (&wgpu::Device, &wgpu::Queue), frame: &Turntable) -> Result<(), EmbedError> {
        self.scene.set_transform(self.model, DMat4::from_rotation_y(frame.turn_rad))?;
        let scene = self.scene.update(&self.renderer, gpu)?;
        self.renderer.prepare_frame(gpu, scene, (&frame.view, frame.at_px), &pass(), &mut self.state)?;
        Ok(())
    }
}

/// What eframe does for its applications: a context, a renderer and a screen.
pub(crate) struct Desk {
    context: egui::Context,
    renderer: egui_wgpu::Renderer,
    screen: Attachments,
    view: View,
}

impl Desk {
    pub(crate) fn new(gpu: &Gpu, model: &Scene) -> Result<Self, Failure> {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let options = egui_wgpu::RendererOptions {
            msaa_samples: pass().samples,
            depth_stencil_format: pass().depth.map(|depth| depth.format),
            ..egui_wgpu::RendererOptions::PREDICTABLE
        };
        let mut renderer = egui_wgpu::Renderer::new(device, pass().color, options);
        let environment = Environment::new(specula::bake::studio::studio());
        let maps = bake(&environment.image, &Default::default(), &Silent);
        let mut scene = LiveScene::new();
        let camera = model.cameras_in_world().into_iter().next().ok_or("the showcase has no camera")?;
        let view = View { camera, background: Background::Transparent, ..default_view(model, SIZE_PX) };
        let model = scene.insert(model)?;
        scene.set_environment(Some((environment, Arc::new(maps))));
        let (state, failure) = (FrameState::default(), None);
        let module = Module { renderer: Renderer::new(device, queue), scene, model, state, failure };
        renderer.callback_resources.insert(module);
        let screen = Attachments::new(device, &pass(), SIZE_PX);
        Ok(Self { context: egui::Context::default(), renderer, screen, view })
    }

    /// What is on the screen when the widgets say this, sRGB bytes.
    pub(crate) fn picture(&mut self, gpu: &Gpu, widgets: &Widgets) -> Result<Vec<u8>, Failure> {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let size = egui::vec2(SIZE_PX.x as f32, SIZE_PX.y as f32);
        let screen_rect = Some(egui::Rect::from_min_size(egui::Pos2::ZERO, size));
        let input = || egui::RawInput { screen_rect, ..Default::default() };
        let view = &self.view;
        // Windows have their size from the frame before.
        let first = self.context.run_ui(input(), |ui| lay_out(ui, *widgets, view));
        let mut output = self.context.run_ui(input(), |ui| lay_out(ui, *widgets, view));
        let mut textures = first.textures_delta;
        textures.append(std::mem::take(&mut output.textures_delta));
        for (id, deltas) in textures.set.drain() {
            deltas.iter().for_each(|delta| self.renderer.update_texture(device, queue, id, delta));
        }
        let pixels_per_point = output.pixels_per_point;
        let shapes = self.context.tessellate(output.shapes, pixels_per_point);
        let screen = ScreenDescriptor { size_in_pixels: SIZE_PX.to_array(), pixels_per_point };
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut commands = self.renderer.update_buffers(device, queue, &mut encoder, &shapes, &screen);
        let mut egui_s_pass = self.screen.begin(&mut encoder, &pass(), wgpu::Color::BLACK).forget_lifetime();
        self.renderer.render(&mut egui_s_pass, &shapes, &screen);
        drop(egui_s_pass);
        commands.push(encoder.finish());
        queue.submit(commands);
        let failure = self.renderer.callback_resources.get_mut::<Module>().and_then(|module| module.failure.take());
        failure.map_or(Ok(()), Err)?;
        Ok(read(gpu, device.create_command_encoder(&Default::default()), self.screen.picture())?)
    }
}

/// A panel, the model beside it, and a window over both.
fn lay_out(ui: &mut egui::Ui, Widgets { mut turn_rad, mut exposure_ev }: Widgets, view: &View) {
    egui::Panel::left("panel").exact_size(140.0).show(ui, |ui| {
        ui.heading("Showcase");
        ui.separator();
        ui.spacing_mut().slider_width = 70.0;
        ui.label("turn, rad");
        ui.add(egui::Slider::new(&mut turn_rad, -3.2..=3.2));
        ui.label("exposure, EV");
        ui.add(egui::Slider::new(&mut exposure_ev, -3.0..=3.0));
    });
    egui::CentralPanel::default().show(ui, |ui| {
        let rect = ui.available_rect_before_wrap();
        let scale = ui.ctx().pixels_per_point();
        let px = |points: f32| (points * scale).round() as u32;
        let at_px = UVec2::new(px(rect.left()), px(rect.top()));
        let size_px = UVec2::new(px(rect.right()), px(rect.bottom())) - at_px;
        let view = View { size_px, exposure_ev, ..view.clone() };
        ui.painter().add(Callback::new_paint_callback(rect, Turntable { view, at_px, turn_rad }));
    });
    // There at once: what is shown depends on no clock.
    let window = egui::Window::new("Window").fade_in(false).fixed_pos((330.0, 190.0)).fixed_size((120.0, 40.0));
    window.show(ui.ctx(), |ui| ui.label("covers the model"));
}
