//! Texture fetches in float64: wrap, filter at the base level, decode.

use crate::math::color::linear_from_srgb;
use crate::scene::{Image, Pixels, Scene, TextureRef, TextureSlot, Wrap};
use glam::{DVec2, DVec4};

/// Reads the textures of a scene; the many samples of a pixel stand in for mip levels.
#[derive(Debug)]
pub struct Textures<'a> {
    scene: &'a Scene,
    /// Linear light of each 8-bit sRGB code.
    linear_from_srgb8: [f64; 256],
}

impl<'a> Textures<'a> {
    pub fn new(scene: &'a Scene) -> Self {
        Self { scene, linear_from_srgb8: std::array::from_fn(|code| linear_from_srgb(code as f64 / 255.0)) }
    }

    /// RGBA of `texture` as `slot` uses it, at the texture coordinates of the primitive (before the slot's transform).
    /// The magnification filter decides between bilinear and nearest. Colours are decoded before they are filtered.
    pub fn sample(&self, slot: TextureSlot, texture: &TextureRef, uv: DVec2) -> DVec4 {
        let uv = (texture.transform.matrix().as_dmat3() * uv.extend(1.0)).truncate();
        let source = &self.scene.textures[texture.texture];
        let image = &self.scene.images[source.image];
        let (sampler, srgb) = (source.sampler, slot.is_srgb());
        let position = uv * DVec2::new(f64::from(image.width), f64::from(image.height));
        let texel = |x: f64, y: f64| {
            let (x, y) = (wrap(sampler.wrap_u, x, image.width), wrap(sampler.wrap_v, y, image.height));
            self.texel(image, srgb, x, y)
        };
        if !sampler.mag_linear {
            return texel(position.x.floor(), position.y.floor());
        }
        let corner = (position - 0.5).floor();
        let f = position - 0.5 - corner;
        let row = |y: f64| texel(corner.x, y).lerp(texel(corner.x + 1.0, y), f.x);
        row(corner.y).lerp(row(corner.y + 1.0), f.y)
    }

    fn texel(&self, image: &Image, srgb: bool, x: usize, y: usize) -> DVec4 {
        let start = 4 * (y * image.width as usize + x);
        match &image.pixels {
            Pixels::Rgba8(data) => {
                let color = |i: usize| {
                    let code = data[start + i];
                    if srgb { self.linear_from_srgb8[usize::from(code)] } else { f64::from(code) / 255.0 }
                };
                DVec4::new(color(0), color(1), color(2), f64::from(data[start + 3]) / 255.0)
            }
            Pixels::Rgba16(data) => {
                let value = |i: usize| f64::from(data[start + i]) / 65535.0;
                let color = |i: usize| if srgb { linear_from_srgb(value(i)) } else { value(i) };
                DVec4::new(color(0), color(1), color(2), value(3))
            }
            Pixels::OfHost => DVec4::ONE,
        }
    }
}

/// The texel that a whole coordinate falls on; coordinates that are no number fall on the first.
fn wrap(mode: Wrap, coordinate: f64, size: u32) -> usize {
    let size = f64::from(size);
    let wrapped = match mode {
        Wrap::Repeat => coordinate.rem_euclid(size),
        Wrap::MirroredRepeat => {
            let position = coordinate.rem_euclid(2.0 * size);
            if position < size { position } else { 2.0 * size - 1.0 - position }
        }
        Wrap::ClampToEdge => coordinate,
    };
    wrapped.clamp(0.0, size - 1.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Sampler, Texture, UvTransform};
    use glam::Vec2;

    #[test]
    fn wrap_modes() {
        let row = |mode| (-3..6).map(|x| wrap(mode, f64::from(x), 3)).collect::<Vec<_>>();
        assert_eq!(row(Wrap::Repeat), [0, 1, 2, 0, 1, 2, 0, 1, 2]);
        assert_eq!(row(Wrap::MirroredRepeat), [2, 1, 0, 0, 1, 2, 2, 1, 0]);
        assert_eq!(row(Wrap::ClampToEdge), [0, 0, 0, 0, 1, 2, 2, 2, 2]);
        assert_eq!(wrap(Wrap::Repeat, f64::NAN, 3), 0);
        assert_eq!(wrap(Wrap::ClampToEdge, f64::INFINITY, 3), 2);
    }

    /// Two texels: black, and white of half alpha.
    fn scene(mag_linear: bool) -> Scene {
        let pixels = Pixels::Rgba8(vec![0, 0, 0, 255, 255, 255, 255, 127].into());
        let sampler = Sampler { mag_linear, wrap_u: Wrap::ClampToEdge, ..Sampler::default() };
        Scene {
            images: vec![Image { name: None, width: 2, height: 1, pixels }],
            textures: vec![Texture { image: 0, sampler }],
            ..Scene::default()
        }
    }

    const PLAIN: TextureRef = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };

    #[test]
    fn bilinear_and_nearest() {
        let (linear, nearest) = (scene(true), scene(false));
        let at =
            |scene: &Scene, u: f64| Textures::new(scene).sample(TextureSlot::BaseColor, &PLAIN, DVec2::new(u, 0.3));
        assert!((at(&linear, 0.5).x - 0.5).abs() < 1e-12, "decoded first, then filtered");
        assert!((at(&linear, 0.25).x).abs() < 1e-12);
        assert_eq!(at(&nearest, 0.49).x, 0.0);
        assert_eq!(at(&nearest, 0.51).x, 1.0);
        assert!((at(&nearest, 0.51).w - 127.0 / 255.0).abs() < 1e-12);
    }

    #[test]
    fn coordinates_are_transformed() {
        let transform = UvTransform { offset: Vec2::new(0.5, 0.0), ..UvTransform::IDENTITY };
        let texture = TextureRef { transform, ..PLAIN };
        let scene = scene(false);
        assert_eq!(Textures::new(&scene).sample(TextureSlot::BaseColor, &texture, DVec2::new(0.1, 0.5)).x, 1.0);
    }
}
