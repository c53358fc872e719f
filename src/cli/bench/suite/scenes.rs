//! The fixed scenes of the suite.

use crate::bake::studio::studio;
use crate::import::{environment_from_path, model_from_path};
use crate::scene::framing::default_view;
use crate::scene::light_field::{self, LightField};
use crate::scene::patches::{self, Kind, Order, Sight};
use crate::scene::{Background, Environment, Material, Mesh, Node, Scene, View, shapes};
use glam::UVec2;
use std::path::PathBuf;

/// Circles of light over a place of the floor, on average; bodies and corners see fewer: 7 reach a pixel.
const REACHING: f64 = 8.0;

/// A scene with a view of it.
pub(super) struct SuiteScene {
    pub(super) name: &'static str,
    /// For people.
    pub(super) what: &'static str,
    side_px: u32,
    /// Samples a pixel of the rasteriser.
    pub(super) samples: u32,
    content: Content,
}

#[derive(Clone, Copy)]
enum Content {
    Helmet,
    Sphere,
    Lights(u32),
    Field(usize),
    Crowd(usize),
    Hull(usize),
    Sheets,
    Materials(usize),
}

const fn scene(name: &'static str, what: &'static str, (side_px, samples): (u32, u32), content: Content) -> SuiteScene {
    SuiteScene { name, what, side_px, samples, content }
}

/// What is measured unless names are given, in this order.
pub(super) const SCENES: &[SuiteScene] = &[
    scene("helmet", "DamagedHelmet in chinese_garden_1k", (1024, 4), Content::Helmet),
    scene("helmet-1-sample", "the same without MSAA", (1024, 1), Content::Helmet),
    scene("sphere", "a metal sphere of 8100 triangles in the studio", (1024, 4), Content::Sphere),
    scene("lights-1", "a floor with bodies under 1 point light", (512, 1), Content::Lights(1)),
    scene("lights-16", "16 point lights", (512, 1), Content::Lights(16)),
    scene("lights-256", "256 point lights, 7 of which reach a pixel", (512, 1), Content::Lights(256)),
    scene("lights-4096", "4096 point lights, 7 of which reach a pixel", (512, 1), Content::Lights(4096)),
    scene("instances-1", "1 patch of 100 triangles", (1024, 1), Content::Field(1)),
    scene("instances-100", "100 of them in the same square", (1024, 1), Content::Field(100)),
    scene("instances-10000", "10 000 of them", (1024, 1), Content::Field(10_000)),
    scene("instances-100000", "100 000 of them", (1024, 1), Content::Field(100_000)),
    scene("offscreen-0", "100 patches in the picture", (1024, 1), Content::Crowd(0)),
    scene("offscreen-10000", "and 10 000 beside it", (1024, 1), Content::Crowd(10_000)),
    scene("offscreen-100000", "and 100 000 beside it", (1024, 1), Content::Crowd(100_000)),
    scene("hidden-0", "a closed sphere of 16 128 triangles", (1024, 1), Content::Hull(0)),
    scene("hidden-10000", "10 000 patches inside of it", (1024, 1), Content::Hull(10_000)),
    scene("overdraw", "32 sheets one behind the other, listed from the back", (1024, 1), Content::Sheets),
    scene("materials-200", "1000 meshes of 200 materials with 6 pipelines", (1024, 1), Content::Materials(200)),
];

/// The sample model and the panorama around it, where there are any.
pub(super) fn helmet() -> Result<[PathBuf; 2], String> {
    let files = |root: PathBuf| ["models/DamagedHelmet.glb", "env/chinese_garden_1k.hdr"].map(|file| root.join(file));
    let root =
        std::env::var_os("SPECULA_SAMPLES").ok_or("SPECULA_SAMPLES is not set to the folder of sample models")?;
    let files = files(root.into());
    match files.iter().find(|file| !file.is_file()) {
        Some(missing) => Err(format!("there is no {}", missing.display())),
        None => Ok(files),
    }
}

impl SuiteScene {
    /// The scene, and how it is looked at; an error is why there is none.
    pub(super) fn build(&self) -> Result<(Scene, View), String> {
        let size = UVec2::splat(self.side_px);
        let framed = |scene: Scene, background| {
            let view = View { background, ..default_view(&scene, size) };
            (scene, view)
        };
        let near = |scene| (scene, patches::view(Sight::Near, self.side_px, 0));
        Ok(match self.content {
            Content::Helmet => {
                let [model, panorama] = helmet()?;
                let imported = model_from_path(&model, &Default::default()).map_err(|error| error.to_string())?;
                let image = environment_from_path(&panorama).map_err(|error| error.to_string())?;
                let environment = Some(Environment::new(image));
                framed(Scene { environment, ..imported.scene }, Background::Environment)
            }
            Content::Sphere => framed(sphere(), default_view(&Scene::default(), size).background),
            Content::Lights(lights) => {
                let field = LightField { lights, range_m: Some(range_m(lights)), spot_every: 0 };
                (field.scene(), light_field::view(self.side_px, 0))
            }
            Content::Field(count) => (patches::field(count, false), patches::view(Sight::Far, self.side_px, 0)),
            Content::Crowd(beside) => near(patches::crowd(100, beside, Kind::Copies)),
            Content::Hull(inside) => near(patches::hull(inside)),
            Content::Sheets => near(patches::sheets(Order::BackToFront, 1)),
            Content::Materials(count) => near(patches::mixture(count)),
        })
    }
}

fn sphere() -> Scene {
    Scene {
        nodes: vec![Node { mesh: Some(0), ..Default::default() }],
        roots: vec![0],
        meshes: vec![Mesh { name: None, primitives: vec![shapes::sphere(1.0, 45, 0)] }],
        materials: vec![Material { perceptual_roughness: 0.4, ..Default::default() }],
        environment: Some(Environment::new(studio())),
        ..Default::default()
    }
}

/// Where circles around so many places on the floor cover a point of it [`REACHING`] times; all of it for a few lights.
fn range_m(lights: u32) -> f64 {
    let area_m2 = f64::from(light_field::FLOOR_M).powi(2) * (REACHING / f64::from(lights)).min(1.0);
    if f64::from(lights) <= 2.0 * REACHING {
        return 2.0 * f64::from(light_field::FLOOR_M);
    }
    (area_m2 / std::f64::consts::PI).sqrt()
}

/// Those that are named, by whole names or by what stands before a dash of theirs; all without names. With them, whether
/// the cold start is among them.
pub(super) fn chosen(names: &[String]) -> Result<(Vec<&'static SuiteScene>, bool), String> {
    let fits =
        |name: &str, wanted: &String| name == wanted || name.strip_prefix(wanted.as_str()).is_some_and(is_suffix);
    let is_known = |wanted: &&String| *wanted == COLD_START || SCENES.iter().any(|scene| fits(scene.name, wanted));
    if let Some(unknown) = names.iter().find(|wanted| !is_known(wanted)) {
        let known: Vec<&str> = SCENES.iter().map(|scene| scene.name).chain([COLD_START]).collect();
        return Err(format!("no scene of the suite is called `{unknown}`; there are {}", known.join(", ")));
    }
    let is_chosen = |name: &str| names.is_empty() || names.iter().any(|wanted| fits(name, wanted));
    Ok((SCENES.iter().filter(|scene| is_chosen(scene.name)).collect(), is_chosen(COLD_START)))
}

/// The name of what is no scene but a program that starts.
pub(super) const COLD_START: &str = "cold-start";

fn is_suffix(rest: &str) -> bool {
    rest.starts_with('-')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_have_names_of_their_own_and_can_be_named_together() {
        for (i, scene) in SCENES.iter().enumerate() {
            assert!(SCENES[..i].iter().all(|other| other.name != scene.name), "{}", scene.name);
        }
        let names = |wanted: &[&str]| {
            let wanted: Vec<String> = wanted.iter().map(|name| (*name).to_owned()).collect();
            chosen(&wanted).map(|(scenes, cold)| (scenes.iter().map(|scene| scene.name).collect::<Vec<_>>(), cold))
        };
        assert_eq!(names(&[]).unwrap().0.len(), SCENES.len());
        assert!(names(&[]).unwrap().1);
        assert_eq!(
            names(&["lights", "overdraw"]).unwrap().0,
            ["lights-1", "lights-16", "lights-256", "lights-4096", "overdraw"]
        );
        assert_eq!(names(&["lights-1"]).unwrap(), (vec!["lights-1"], false));
        assert_eq!(names(&["cold-start"]).unwrap(), (vec![], true));
        assert!(names(&["light"]).unwrap_err().contains("`light`; there are helmet, "));
    }

    #[test]
    fn scenes_that_are_made_in_code_can_be_built() {
        for scene in SCENES.iter().filter(|scene| !matches!(scene.content, Content::Helmet)) {
            let (built, view) = scene.build().unwrap();
            assert!(!built.instances().is_empty() && view.size_px == UVec2::splat(scene.side_px), "{}", scene.name);
        }
    }

    #[test]
    fn lights_reach_a_few_pixels_each_or_all() {
        assert_eq!(range_m(16), 128.0);
        let covered = |lights: u32| f64::from(lights) * std::f64::consts::PI * range_m(lights).powi(2) / 4096.0;
        assert!((covered(256) - 8.0).abs() < 1e-9 && (covered(4096) - 8.0).abs() < 1e-9);
    }
}
