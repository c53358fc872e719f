//! A model into a picture, without a window: `cargo run --example minimal -- model.glb picture.png`.

use specula::capture::{CaptureOptions, CaptureTarget, Wanted, submit};
use specula::gpu::{Gpu, GpuOptions, GpuRequest};
use specula::progress::Silent;
use specula::scene::{Environment, framing::default_view};
use specula::{bake, import, renderer::Renderer};
use std::path::Path;

pub(crate) fn picture(model: &Path, side_px: u32) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let mut scene = import::model_from_path(model, &Default::default())?.scene;
    let environment = scene.environment.insert(Environment::new(bake::studio::studio()));
    let maps = bake::environment::bake(&environment.image, &Default::default(), &Silent);
    let view = default_view(&scene, (side_px, side_px).into());

    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue);
    let mut uploaded = renderer.upload(&gpu.device, &gpu.queue, &scene, Some(&maps))?;
    let target = CaptureTarget::new(&gpu, &view, CaptureOptions::default())?;
    let wanted = Wanted { radiance: false, display: true };
    let frame = submit(&gpu, &mut renderer, &mut uploaded, &view, &target, wanted)?.wait(&gpu)?;
    frame.display.ok_or_else(|| "display light was wanted".into())
}

#[allow(dead_code, reason = "tests take the picture alone")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(model), Some(path)) = (arguments.next(), arguments.next()) else { return Err("MODEL PICTURE".into()) };
    Ok(image::save_buffer(path, &picture(model.as_ref(), 512)?, 512, 512, image::ColorType::Rgba8)?)
}
