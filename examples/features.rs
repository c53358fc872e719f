//! Prints what each feature costs a scene that has it, and a scene that does not: that one is drawn by the shaders as they
//! are and by shaders from which the feature's last traces were deleted by hand. Figures are processor time, of frames
//! drawn in turn.
//!
//! `cargo run --release --example features`

#![expect(clippy::print_stdout, reason = "the figures are the output")]

mod clock;

use clock::{cpu_seconds, median};
use glam::{DMat4, DVec3, UVec2, Vec3, Vec4};
use specula::bake::environment::{self, BakeOptions};
use specula::capture::{CaptureOptions, CaptureTarget, Wanted, record, submit};
use specula::gpu::formats::Precision;
use specula::gpu::{Gpu, GpuOptions, GpuRequest};
use specula::gpu_scene::GpuScene;
use specula::progress::Silent;
use specula::renderer::Renderer;
use specula::scene::{
    AlphaMode, Background, Camera, Disney, Environment, EnvironmentImage, Image, Light, LightKind, Material, Mesh,
    MetalFresnel, Node, Pixels, Projection, Quality, RadianceImage, Sampler, Scene, Texture, TextureRef, TextureSlot,
    UvTransform, View, framing, shapes,
};
use specula::shader::ShaderSources;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const SIDE_PX: u32 = 512;
const ROUNDS: usize = 15;
/// Side of the textures, texels.
const TEXTURE_SIDE: u32 = 512;

/// A scene and how it is looked at.
#[derive(Clone)]
struct Shot {
    scene: Scene,
    view: View,
}

/// File, what stands there once, and what is put in its place.
type Edit = (&'static str, &'static str, &'static str);

struct Feature {
    name: &'static str,
    with: fn(&mut Shot),
    /// Where the plain shot has the feature.
    without: fn(&mut Shot),
    /// What is left of it in a shader that does not have it.
    by_hand: &'static [Edit],
}

const SURFACE: &str = "surface/surface.wgsl";
const LIT: &str = "lighting/lit.wgsl";
const LOBES: &str = "lighting/lobes.wgsl";
const TAPS: &str = "lighting/environment_taps.wgsl";

const NOTHING: fn(&mut Shot) = |_| {};
const BASE_COLOR: Edit = (SURFACE, " * base_color_texel(v)", "");
const VERTEX_COLOR: Edit = (SURFACE, " * vertex_color(v)", "");
const METALLIC: Edit = (SURFACE, "read_metallic(metallic_roughness)", "saturate(material.metallic)");
const PERCEPTUAL_ROUGHNESS: Edit =
    (SURFACE, "read_perceptual_roughness(metallic_roughness)", "saturate(material.perceptual_roughness)");
const OCCLUSION: Edit = (LIT, " * surface.occlusion", "");
const EMISSION: Edit = (LIT, " + surface.emissive", "");
const TANGENTS: [Edit; 4] = [
    (SURFACE, "    surface.tangents = read_tangents(v, n);\n", ""),
    (LOBES, "    let share = compensated_share(shape);\n", ""),
    (LOBES, "surface.specular), E_avg) * share", "surface.specular), E_avg)"),
    (LOBES, "metal_average(surface), E_avg) * share", "metal_average(surface), E_avg)"),
];
const DIELECTRIC: [Edit; 5] = [
    (
        LOBES,
        "min(surface.dielectric_F0 * surface.specular_color, vec3f(1.0)) * surface.specular",
        "vec3f(surface.dielectric_F0)",
    ),
    (LOBES, "F_Schlick_average(dielectric_F0, surface.specular)", "F_Schlick_average(dielectric_F0, 1.0)"),
    (LOBES, "lobes.coat_F90 = surface.specular", "lobes.coat_F90 = 1.0"),
    ("lighting/fresnel_schlick.wgsl", "mix(surface.specular, 1.0, surface.metallic)", "1.0"),
    (TAPS, " * lobes.coat_F90", ""),
];
const FACING: Edit = (SURFACE, "face_viewer(n, front_facing)", "n");
const ALPHA: Edit = (
    "surface/visible_point.wgsl",
    "premultiply(clamp_to_half(point.xyz), point.w)",
    "vec4f(clamp_to_half(point.xyz), 1.0)",
);
const DISNEY: [Edit; 2] =
    [(SURFACE, "    surface.t = shading_tangent(v, surface.n);\n", ""), (SURFACE, "    t: vec3f,\n", "")];
const PUNCTUAL: Edit = (LIT, "punctual_radiance(lobes, position) + ", "");
const SUNS: [Edit; 2] =
    [(TAPS, " + sun_radiance(lobes)", ""), (LOBES, "lobes.NoV, NoL) * lobes.specular_share", "lobes.NoV, NoL)")];

const FEATURES: &[Feature] = &[
    Feature { name: "nothing, to see the noise", with: NOTHING, without: NOTHING, by_hand: &[] },
    Feature {
        name: "base colour texture",
        with: |s| s.add_texture(TextureSlot::BaseColor),
        without: NOTHING,
        by_hand: &[BASE_COLOR],
    },
    Feature {
        name: "metallic-roughness texture",
        with: |s| s.add_texture(TextureSlot::MetallicRoughness),
        without: NOTHING,
        by_hand: &[METALLIC, PERCEPTUAL_ROUGHNESS],
    },
    Feature { name: "normal map", with: |s| s.add_texture(TextureSlot::Normal), without: NOTHING, by_hand: &[] },
    Feature {
        name: "occlusion",
        with: |s| s.add_texture(TextureSlot::Occlusion),
        without: NOTHING,
        by_hand: &[OCCLUSION],
    },
    Feature {
        name: "occlusion in a lookup of its own",
        with: |s| {
            s.add_texture(TextureSlot::MetallicRoughness);
            s.add_texture(TextureSlot::Occlusion);
            let mut texture = s.scene.materials[0].texture_slots[TextureSlot::Occlusion as usize];
            texture.iter_mut().for_each(|texture| texture.uv_set = 1);
            s.scene.materials[0].set_texture(TextureSlot::Occlusion, texture);
        },
        without: |s| {
            s.add_texture(TextureSlot::MetallicRoughness);
            s.add_texture(TextureSlot::Occlusion);
        },
        by_hand: &[],
    },
    Feature {
        name: "texture transform",
        with: |s| {
            s.add_texture(TextureSlot::BaseColor);
            let mut texture = s.scene.materials[0].texture_slots[TextureSlot::BaseColor as usize];
            texture.iter_mut().for_each(|texture| texture.transform.rotation_rad = 0.5);
            s.scene.materials[0].set_texture(TextureSlot::BaseColor, texture);
        },
        without: |s| s.add_texture(TextureSlot::BaseColor),
        by_hand: &[],
    },
    Feature {
        name: "emission",
        with: |s| s.material().emissive_nits = Vec3::splat(0.1),
        without: NOTHING,
        by_hand: &[EMISSION],
    },
    Feature {
        name: "specular weight and tint",
        with: |s| s.material().specular_color = Vec3::new(0.9, 0.8, 0.7),
        without: NOTHING,
        by_hand: &DIELECTRIC,
    },
    Feature {
        name: "vertex colour",
        with: |s| {
            let primitive = &mut s.scene.meshes[0].primitives[0];
            primitive.colors = Some(vec![Vec4::new(0.9, 0.8, 0.7, 1.0); primitive.positions.len()]);
        },
        without: NOTHING,
        by_hand: &[VERTEX_COLOR],
    },
    Feature {
        name: "alpha mask",
        with: |s| s.material().alpha_mode = AlphaMode::Mask { cutoff: 0.5 },
        without: NOTHING,
        by_hand: &[ALPHA],
    },
    Feature {
        name: "blending",
        with: |s| s.material().alpha_mode = AlphaMode::Blend,
        without: NOTHING,
        by_hand: &[ALPHA],
    },
    Feature { name: "double-sided", with: |s| s.material().double_sided = true, without: NOTHING, by_hand: &[FACING] },
    Feature {
        name: "anisotropy",
        with: |s| s.material().anisotropy_strength = 0.6,
        without: NOTHING,
        by_hand: &TANGENTS,
    },
    Feature {
        name: "Lazanyi's Fresnel",
        with: |s| s.material().metal_fresnel = MetalFresnel::Lazanyi { a: Vec3::ONE },
        without: NOTHING,
        by_hand: &[],
    },
    Feature {
        name: "Disney",
        with: |s| s.material().disney = Some(Disney { anisotropic: 0.5, clearcoat: 0.5, ..Default::default() }),
        without: NOTHING,
        by_hand: &DISNEY,
    },
    Feature { name: "a lamp", with: |s| s.add_lamps(1), without: NOTHING, by_hand: &[PUNCTUAL] },
    Feature { name: "clusters of lights", with: |s| s.add_lamps(16), without: |s| s.add_lamps(1), by_hand: &[] },
    Feature {
        name: "a sun",
        with: |s| s.scene.environment = Some(Environment::new(sky(5e4))),
        without: NOTHING,
        by_hand: &SUNS,
    },
    Feature {
        name: "environment",
        with: |s| s.add_lamps(1),
        without: |s| {
            s.add_lamps(1);
            s.scene.environment = None;
        },
        by_hand: &[(LIT, "environment_radiance(lobes) * surface.occlusion + ", "")],
    },
    Feature {
        name: "multiple scattering",
        with: NOTHING,
        without: |s| s.view.energy_compensation = false,
        by_hand: &[
            (TAPS, " + lobes.multiscatter * multiscatter.x", ""),
            (TAPS, " + lobes.multiscatter * multiscatter.y", ""),
            (TAPS, "(skirt + lobes.multiscatter + lobes.diffuse)", "(skirt + lobes.diffuse)"),
        ],
    },
    Feature {
        name: "tier above the split sum",
        with: NOTHING,
        without: |s| s.view.quality = Quality::SplitSum,
        by_hand: &[],
    },
    Feature {
        name: "light of any kind",
        with: NOTHING,
        without: |s| s.material().unlit = true,
        by_hand: &[
            (SURFACE, "    surface.metallic = read_metallic(metallic_roughness);\n", ""),
            (SURFACE, "    surface.perceptual_roughness = read_perceptual_roughness(metallic_roughness);\n", ""),
            (SURFACE, "    surface.dielectric_F0 = read_dielectric_F0();\n", ""),
        ],
    },
    Feature {
        name: "all of them but the environment",
        with: |s| {
            TextureSlot::ALL.into_iter().for_each(|slot| s.add_texture(slot));
            s.material().emissive_nits = Vec3::splat(0.1);
            s.material().anisotropy_strength = 0.6;
            s.material().double_sided = true;
            s.add_lamps(1);
        },
        without: NOTHING,
        by_hand: &[
            BASE_COLOR,
            VERTEX_COLOR,
            METALLIC,
            PERCEPTUAL_ROUGHNESS,
            OCCLUSION,
            EMISSION,
            FACING,
            ALPHA,
            PUNCTUAL,
            TANGENTS[0],
            TANGENTS[1],
            TANGENTS[2],
            TANGENTS[3],
            DISNEY[0],
            DISNEY[1],
            SUNS[0],
            SUNS[1],
            DIELECTRIC[0],
            DIELECTRIC[2],
            DIELECTRIC[3],
            DIELECTRIC[4],
        ],
    },
];

impl Shot {
    /// A sphere that fills the picture, of numbers alone, under an uneven sky.
    fn plain() -> Self {
        let mut sphere = shapes::sphere(1.0, 24, 0);
        sphere.uvs.push(sphere.uvs[0].clone());
        let material = Material {
            base_color: Vec4::new(0.8, 0.6, 0.4, 1.0),
            metallic: 0.5,
            perceptual_roughness: 0.4,
            ..Default::default()
        };
        let noise = |i: u32| (i.wrapping_mul(2_654_435_761) >> 24) as u8 | 0x80;
        let texels = (0..TEXTURE_SIDE * TEXTURE_SIDE * 4).map(noise).collect::<Vec<u8>>();
        let image =
            Image { name: None, width: TEXTURE_SIDE, height: TEXTURE_SIDE, pixels: Pixels::Rgba8(texels.into()) };
        let scene = Scene {
            nodes: vec![Node { mesh: Some(0), ..Default::default() }],
            roots: vec![0],
            meshes: vec![Mesh { name: None, primitives: vec![sphere] }],
            materials: vec![material],
            images: vec![image],
            textures: vec![Texture { image: 0, sampler: Sampler::default() }],
            environment: Some(Environment::new(sky(1.0))),
            ..Default::default()
        };
        let projection = Projection::Perspective { fov_y_rad: 0.4 };
        let camera = Camera::look_at(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, DVec3::Y, projection, 0.1, 100.0);
        let view = framing::default_view(&scene, UVec2::splat(SIDE_PX));
        Self { view: View { camera, background: Background::Transparent, ..view }, scene }
    }

    fn changed(by: fn(&mut Self)) -> Self {
        let mut shot = Self::plain();
        by(&mut shot);
        shot
    }

    fn material(&mut self) -> &mut Material {
        &mut self.scene.materials[0]
    }

    fn add_texture(&mut self, slot: TextureSlot) {
        let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };
        self.material().set_texture(slot, Some(texture));
    }

    fn add_lamps(&mut self, count: usize) {
        for i in 0..count {
            let place = DVec3::new(2.0 + 0.1 * i as f64, 2.0, 3.0);
            self.scene.roots.push(self.scene.nodes.len());
            let parent_from_node = DMat4::from_translation(place);
            self.scene.nodes.push(Node {
                parent_from_node,
                light: Some(self.scene.lights.len()),
                ..Default::default()
            });
            let kind = LightKind::Point { range_m: Some(20.0) };
            self.scene.lights.push(Light { name: None, kind, color: DVec3::ONE, intensity: 10.0 / count as f64 });
        }
    }
}

/// A gradient with one texel of its own.
fn sky(texel: f32) -> EnvironmentImage {
    let (width, height) = (128, 64);
    let of =
        |i: u32| if i == 20 * width + 96 { Vec3::splat(texel) } else { Vec3::new(0.3, 0.5, (i / width) as f32 / 64.0) };
    EnvironmentImage { width, height, texels: (0..width * height).map(of).collect() }
}

/// The shaders that are built in, with `edits`.
fn edited(edits: &[Edit]) -> Result<ShaderSources> {
    let mut sources = ShaderSources::default();
    for (file, there, instead) in edits {
        let text = sources.get(file).ok_or("no such file")?.to_owned();
        if text.matches(there).count() != 1 {
            return Err(format!("{file}: `{there}` has to stand there once").into());
        }
        sources.insert(file, text.replacen(there, instead, 1));
    }
    Ok(sources)
}

/// A scene with what draws it.
struct Drawn {
    renderer: Renderer,
    uploaded: GpuScene,
    target: CaptureTarget,
    view: View,
    times_ms: Vec<Option<f64>>,
}

impl Drawn {
    fn new(gpu: &Gpu, shot: &Shot, edits: &[Edit]) -> Result<Self> {
        let options = BakeOptions { suns: shot.view.quality.parts_suns(), ..Default::default() };
        let maps = shot.scene.environment.as_ref().map(|e| environment::bake(&e.image, &options, &Silent));
        let renderer = Renderer::with_shaders(&gpu.device, &gpu.queue, edited(edits)?);
        Ok(Self {
            uploaded: renderer.upload(&gpu.device, &gpu.queue, &shot.scene, maps.as_ref())?,
            renderer,
            target: CaptureTarget::new(gpu, &shot.view, CaptureOptions { samples: 1, precision: Precision::Half })?,
            view: shot.view.clone(),
            times_ms: Vec::new(),
        })
    }

    fn draw(&mut self, gpu: &Gpu) -> Result<()> {
        let start = cpu_seconds();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        record(gpu, &mut self.renderer, &mut encoder, &mut self.uploaded, &self.view, &self.target, false)?;
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()?;
        self.times_ms.push(cpu_seconds().zip(start).map(|(end, start)| 1e3 * (end - start)));
        Ok(())
    }

    fn radiance(&mut self, gpu: &Gpu) -> Result<RadianceImage> {
        let wanted = Wanted { radiance: true, display: false };
        let frame = submit(gpu, &mut self.renderer, &mut self.uploaded, &self.view, &self.target, wanted)?.wait(gpu)?;
        Ok(frame.radiance.ok_or("no picture")?)
    }

    /// What its frames take of the other's.
    fn ratio(&self, other: &Self) -> f64 {
        median(self.times_ms.iter().zip(&other.times_ms).map(|(a, b)| Some((*a)? / (*b)?)))
    }
}

fn measure(gpu: &Gpu, feature: &Feature) -> Result<()> {
    let [with, without] = [feature.with, feature.without].map(Shot::changed);
    let mut drawn =
        [Drawn::new(gpu, &with, &[])?, Drawn::new(gpu, &without, &[])?, Drawn::new(gpu, &without, feature.by_hand)?];
    // The first pictures compile.
    let pictures = drawn.iter_mut().map(|drawn| drawn.radiance(gpu)).collect::<Result<Vec<_>>>()?;
    let differing = pictures[1].texels.iter().zip(&pictures[2].texels).filter(|(a, b)| a != b).count();
    for round in 0..ROUNDS {
        // Whoever comes first finds the caches as another has left them.
        for turn in 0..3 {
            drawn[(round + turn) % 3].draw(gpu)?;
        }
    }
    let [with, without, by_hand] = &drawn;
    let ms = |drawn: &Drawn| median(drawn.times_ms.iter().copied());
    println!(
        "| {} | {:.1} | {:.1} | {:.1} | {:.3} | {} | {differing} |",
        feature.name,
        ms(with),
        ms(without),
        ms(by_hand),
        without.ratio(by_hand),
        feature.by_hand.len()
    );
    Ok(())
}

fn main() -> Result<()> {
    let gpu = Gpu::open(&GpuRequest::default(), GpuOptions::default())?;
    println!("{}, medians of {ROUNDS} rounds, {SIDE_PX} x {SIDE_PX}, one sample\n", gpu.description());
    println!(
        "| feature | with it, CPU ms | without it | without it, by hand | ratio of these | deletions | pixels that differ |\n\
         |---|---|---|---|---|---|---|"
    );
    FEATURES.iter().try_for_each(|feature| measure(&gpu, feature))
}
