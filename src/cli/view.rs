//! How a picture is taken of a scene: size, camera, exposure, tone map, background and quality.

use super::camera::CameraArgs;
use super::color::srgb8_from_hex;
use super::error::CliError;
use crate::scene::{Background, Geometry, Quality, Scene, ToneMap, View};
use glam::{UVec2, Vec3};

/// Pictures larger than this on a side are refused before memory is asked for.
const SIDE_MAX: u32 = 16384;

/// Everything that makes a view.
#[derive(Debug, clap::Args)]
pub(super) struct ViewArgs {
    /// Size of the picture in pixels.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1024x1024", value_parser = parse_size)]
    size: UVec2,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    look: LookArgs,
}

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Look")]
struct LookArgs {
    /// Exposure in stops.
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true)]
    exposure: f32,
    /// neutral, aces, agx, reinhard, linear (exposure and clamp) or none (clamp alone).
    #[arg(long, value_name = "CURVE", default_value = "neutral", value_parser = parse_tone_map)]
    tone_map: ToneMap,
    /// transparent, env, or a colour #rrggbb. By default a panorama of yours is seen, and a built-in one is not.
    #[arg(long, value_name = "transparent|env|#rrggbb", value_parser = parse_background)]
    background: Option<Background>,
    /// Blur the panorama in the background, from 0 (sharp) to 1: as a surface of this perceptual roughness mirrors it.
    #[arg(long, value_name = "0..1", default_value_t = 0.0, value_parser = parse_blur)]
    background_blur: f32,
    /// Give back the energy that single-scattering microfacets lose.
    #[arg(long, value_enum, default_value = "on")]
    energy_compensation: Switch,
    /// How microfacets hide each other, for punctual lights.
    #[arg(long, value_name = "MODEL", default_value = "smith-correlated", value_parser = parse_geometry)]
    geometry: Geometry,
    /// Time against error of light from the environment: split-sum (the baseline), draft, standard or high.
    #[arg(long, value_name = "TIER", default_value = "standard", value_parser = parse_quality)]
    quality: Quality,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Switch {
    On,
    Off,
}

pub(super) fn parse_size(text: &str) -> Result<UVec2, String> {
    let (width, height) = text.split_once('x').ok_or("expected WIDTHxHEIGHT, such as 1024x768")?;
    let side = |text: &str| match text.parse::<u32>() {
        Ok(side) if (1..=SIDE_MAX).contains(&side) => Ok(side),
        _ => Err(format!("`{text}` is not a number of pixels from 1 to {SIDE_MAX}")),
    };
    Ok(UVec2::new(side(width)?, side(height)?))
}

fn parse_tone_map(text: &str) -> Result<ToneMap, String> {
    let names = || ToneMap::ALL.map(ToneMap::name).join(", ");
    ToneMap::by_name(text).ok_or_else(|| format!("expected one of {}", names()))
}

fn parse_geometry(text: &str) -> Result<Geometry, String> {
    let names = || Geometry::ALL.map(Geometry::name).join(", ");
    Geometry::by_name(text).ok_or_else(|| format!("expected one of {}", names()))
}

fn parse_quality(text: &str) -> Result<Quality, String> {
    let names = || Quality::ALL.map(Quality::name).join(", ");
    Quality::by_name(text).ok_or_else(|| format!("expected one of {}", names()))
}

fn parse_background(text: &str) -> Result<Background, String> {
    match text {
        "transparent" => Ok(Background::Transparent),
        "env" => Ok(Background::Environment),
        color => {
            let channels = srgb8_from_hex(color).ok_or("expected transparent, env, or a colour #rrggbb")?;
            Ok(Background::Color(Vec3::from(channels.map(f32::from)) / 255.0))
        }
    }
}

fn parse_blur(text: &str) -> Result<f32, String> {
    let blur = text.parse::<f32>().ok().filter(|blur| (0.0..=1.0).contains(blur));
    blur.ok_or_else(|| "expected a number from 0 to 1".into())
}

impl ViewArgs {
    /// What stands for the camera in names: that of the file, or how it was placed.
    pub(super) fn camera_name(&self) -> &str {
        self.camera.name()
    }

    /// The view of `scene`; `panorama_is_given` says that it has a panorama of the user's. On a turntable the camera has
    /// turned by `turn_rad`.
    ///
    /// # Errors
    /// When the exposure is no number, or the camera cannot be placed.
    pub(super) fn view(&self, scene: &Scene, panorama_is_given: bool, turn_rad: Option<f64>) -> Result<View, CliError> {
        if !self.look.exposure.is_finite() {
            return Err(CliError::Usage("--exposure takes a finite number of stops".into()));
        }
        let background = self.look.background.unwrap_or(if panorama_is_given {
            Background::Environment
        } else {
            Background::Color(Vec3::splat(0.16))
        });
        Ok(View {
            camera: self.camera.camera(scene, self.size, turn_rad)?,
            size_px: self.size,
            exposure_ev: self.look.exposure,
            tone_map: self.look.tone_map,
            background,
            background_blur: self.look.background_blur,
            energy_compensation: self.look.energy_compensation == Switch::On,
            geometry: self.look.geometry,
            quality: self.look.quality,
            term: None,
            channel: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_parse() {
        assert_eq!(parse_size("640x480").unwrap(), UVec2::new(640, 480));
        for bad in ["640", "0x1", "1x0", "x", "-1x5", "99999x1", "1x1x1"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn blurs_parse() {
        assert_eq!([parse_blur("0"), parse_blur("0.25"), parse_blur("1")], [Ok(0.0), Ok(0.25), Ok(1.0)]);
        for bad in ["-0.1", "1.01", "NaN", "inf", "", "much"] {
            assert!(parse_blur(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn backgrounds_parse() {
        assert_eq!(parse_background("#ff0080").unwrap(), Background::Color(Vec3::new(1.0, 0.0, 128.0 / 255.0)));
        for bad in ["ff0080", "#ff008", "#gg0000", "#ff00801", ""] {
            assert!(parse_background(bad).is_err(), "{bad}");
        }
    }
}
