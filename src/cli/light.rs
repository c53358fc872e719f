//! `--light`: lights beside those of the model, in the units on their boxes.

use super::camera::{Point, number};
use super::color::srgb8_from_hex;
use super::error::CliError;
use crate::math::color::linear_from_srgb;
use crate::radiometry::{
    Illuminance, Irradiance, Luminance, LuminousEfficacy, LuminousFlux, LuminousIntensity, Radiance, RadiantFlux,
    RadiantIntensity, RadiometryError,
};
use crate::scene::{Light, SpotCone};
use glam::DVec3;
use std::collections::BTreeMap;
use std::fmt::Display;

/// Without a spectrum, watts count as light of 555 nm.
const EFFICACY: LuminousEfficacy = LuminousEfficacy::MONOCHROMATIC_555_NM;
/// The outer cone of a spot light that names none, degrees: glTF's default.
const OUTER_CONE_DEGREES: f64 = 45.0;

#[derive(Debug, PartialEq, Eq, clap::Args)]
#[command(next_help_heading = "Lights")]
pub(super) struct LightArgs {
    /// Add a light; repeat for more. The environment stays on; --env black leaves the lights alone.
    ///
    /// Point lights: point:flux=1200lm,at=1,2,3 or point:intensity=100cd,at=1,2,3. Spot lights also take dir=X,Y,Z or
    /// to=X,Y,Z, and half angles in degrees, inner=20,outer=30 (0 and 45 without). Directional lights:
    /// directional:illuminance=50000lux,dir=0,-1,0 or directional:radiance=1.6e9nits,angular-diameter=0.53,dir=0,-1,0.
    /// All take color=#rrggbb, which tints and keeps the lumens; all but directional ones take range=METERS.
    ///
    /// Units: lm, cd, lux and nits; W, W/sr, W/m2 and W/m2/sr count 683 lm/W, as light of 555 nm. Positions are in metres,
    /// directions point from the light into the scene.
    #[arg(long = "light", value_name = "KIND:NAME=VALUE,...")]
    specs: Vec<String>,
}

/// A light of the command line and where it goes.
#[derive(Debug, PartialEq)]
pub(super) struct PlacedLight {
    pub(super) light: Light,
    pub(super) position_in_world: DVec3,
    /// Unit vector.
    pub(super) direction_in_world: DVec3,
    /// Something that the user did not say and had better know.
    pub(super) note: Option<String>,
}

impl LightArgs {
    /// All lights, in the order in which they were given.
    pub(super) fn parse(&self) -> Result<Vec<PlacedLight>, CliError> {
        let explain = |spec: &String, problem: String| CliError::Usage(format!("--light {spec}: {problem}"));
        self.specs.iter().map(|spec| parse(spec).map_err(|problem| explain(spec, problem))).collect()
    }
}

fn parse(spec: &str) -> Result<PlacedLight, String> {
    let (kind, rest) = spec.split_once(':').ok_or("expected point:..., spot:... or directional:...")?;
    let mut values = Values::parse(rest)?;
    let (light, position_in_world, direction_in_world) = match kind {
        "point" => (point(&mut values)?, values.vector("at")?, DVec3::NEG_Y),
        "spot" => {
            let light = spot(&mut values)?;
            let at = values.vector("at")?;
            (light, at, values.direction(Some(at))?)
        }
        "directional" => (directional(&mut values)?, DVec3::ZERO, values.direction(None)?),
        _ => return Err(format!("`{kind}` is no kind of light; there are point, spot and directional")),
    };
    let light = values.color(light)?;
    values.finish(kind)?;
    let note = values.converted.map(|conversion| {
        let efficacy = EFFICACY.as_lumens_per_watt();
        format!("--light {spec}: {conversion}, by {efficacy} lm/W as if it were all of 555 nm")
    });
    Ok(PlacedLight { light, position_in_world, direction_in_world, note })
}

fn point(values: &mut Values) -> Result<Light, String> {
    let light = match values.flux_or_intensity()? {
        Strength::Flux(flux) => Light::point_from_flux(flux),
        Strength::Intensity(intensity) => Light::point_from_intensity(intensity),
    };
    values.range(named("flux or intensity", light)?)
}

fn spot(values: &mut Values) -> Result<Light, String> {
    let strength = values.flux_or_intensity()?;
    let (inner, outer) =
        (values.number("inner")?.unwrap_or(0.0), values.number("outer")?.unwrap_or(OUTER_CONE_DEGREES));
    if !(outer > 0.0 && outer <= 90.0) {
        return Err(format!("outer: {outer} degrees, expected a half angle above 0 and up to 90"));
    }
    if !(0.0..=outer).contains(&inner) {
        return Err(format!("inner: {inner} degrees, expected a half angle from 0 to that of the outer cone, {outer}"));
    }
    let cone = named("inner and outer", SpotCone::new(inner.to_radians(), outer.to_radians()))?;
    let light = match strength {
        Strength::Flux(flux) => Light::spot_from_flux(flux, cone),
        Strength::Intensity(intensity) => Light::spot_from_intensity(intensity, cone),
    };
    values.range(named("flux or intensity", light)?)
}

fn directional(values: &mut Values) -> Result<Light, String> {
    let illuminance = values.quantity(
        "illuminance",
        (&["lux", "lx"], Illuminance::from_lux),
        (&["W/m2"], |value| Ok(Irradiance::from_watts_per_square_meter(value)?.to_photometric(EFFICACY))),
    )?;
    let luminance = values.quantity(
        "radiance",
        (&["nits", "nit", "cd/m2"], Luminance::from_nits),
        (&["W/m2/sr"], |value| Ok(Radiance::from_watts_per_square_meter_steradian(value)?.to_photometric(EFFICACY))),
    )?;
    match (illuminance, luminance) {
        (Some(illuminance), None) => named("illuminance", Light::directional_from_illuminance(illuminance)),
        (None, Some(luminance)) => {
            let degrees = values.number("angular-diameter")?.ok_or("angular-diameter is missing, in degrees")?;
            if !(degrees > 0.0 && degrees <= 180.0) {
                return Err(format!("angular-diameter: {degrees} degrees, expected above 0 and up to 180"));
            }
            named("radiance", Light::directional_from_luminance(luminance, degrees.to_radians()))
        }
        _ => Err("expected either illuminance or radiance".into()),
    }
}

/// Puts the user's name for a parameter before what is wrong with it.
fn named<T>(name: &str, result: Result<T, RadiometryError>) -> Result<T, String> {
    result.map_err(|error| format!("{name}: {error}"))
}

enum Strength {
    Flux(LuminousFlux),
    Intensity(LuminousIntensity),
}

/// Units of a quantity, and how a number of them becomes photometric.
type Units<'a, Q> = (&'a [&'a str], fn(f64) -> Result<Q, RadiometryError>);

/// The parameters of one light; reading one takes it away.
struct Values {
    remaining: BTreeMap<String, String>,
    converted: Option<String>,
}

impl Values {
    /// `name=value,...`; values may hold commas of their own.
    fn parse(text: &str) -> Result<Self, String> {
        let mut pairs: Vec<(String, String)> = Vec::new();
        for part in text.split(',') {
            match (part.split_once('='), pairs.last_mut()) {
                (Some((name, value)), _) => pairs.push((name.trim().to_owned(), value.trim().to_owned())),
                (None, Some((_, value))) => *value = format!("{value},{part}"),
                (None, None) => return Err(format!("expected name=value, found `{part}`")),
            }
        }
        let mut remaining = BTreeMap::new();
        for (name, value) in pairs {
            if remaining.insert(name.clone(), value).is_some() {
                return Err(format!("{name} is given twice"));
            }
        }
        Ok(Self { remaining, converted: None })
    }

    /// Complains of what nobody asked for.
    fn finish(&self, kind: &str) -> Result<(), String> {
        let known = match kind {
            "point" => "flux or intensity, at, color and range",
            "spot" => "flux or intensity, at, dir or to, inner, outer, color and range",
            _ => "illuminance, or radiance and angular-diameter, dir and color",
        };
        match self.remaining.keys().next() {
            Some(name) => Err(format!("`{name}` is no parameter of a {kind} light, which takes {known}")),
            None => Ok(()),
        }
    }

    fn flux_or_intensity(&mut self) -> Result<Strength, String> {
        let flux = self.quantity(
            "flux",
            (&["lm"], LuminousFlux::from_lumens),
            (&["W"], |value| Ok(RadiantFlux::from_watts(value)?.to_photometric(EFFICACY))),
        )?;
        let intensity = self.quantity(
            "intensity",
            (&["cd"], LuminousIntensity::from_candelas),
            (&["W/sr"], |value| Ok(RadiantIntensity::from_watts_per_steradian(value)?.to_photometric(EFFICACY))),
        )?;
        match (flux, intensity) {
            (Some(flux), None) => Ok(Strength::Flux(flux)),
            (None, Some(intensity)) => Ok(Strength::Intensity(intensity)),
            _ => Err("expected either flux or intensity".into()),
        }
    }

    /// A number with a unit of one system or of the other.
    fn quantity<Q: Display>(
        &mut self,
        name: &str,
        (luminous, from_luminous): Units<'_, Q>,
        (radiant, from_radiant): Units<'_, Q>,
    ) -> Result<Option<Q>, String> {
        let Some(text) = self.remaining.remove(name) else { return Ok(None) };
        let (value, unit) =
            split_unit(&text).ok_or_else(|| format!("{name}: `{text}` does not begin with a number"))?;
        if luminous.contains(&unit) {
            return named(name, from_luminous(value)).map(Some);
        }
        if !radiant.contains(&unit) {
            let (luminous, radiant) = (luminous.first().unwrap_or(&""), radiant.first().unwrap_or(&""));
            let found = if unit.is_empty() { "no unit".into() } else { format!("the unit `{unit}`") };
            return Err(format!("{name}: `{text}` has {found}, expected {luminous} or {radiant}"));
        }
        let quantity = named(name, from_radiant(value))?;
        self.converted = Some(format!("{value} {unit} count as {quantity}"));
        Ok(Some(quantity))
    }

    fn number(&mut self, name: &str) -> Result<Option<f64>, String> {
        let Some(text) = self.remaining.remove(name) else { return Ok(None) };
        number(&text).map(Some).map_err(|problem| format!("{name}: {problem}"))
    }

    fn vector(&mut self, name: &str) -> Result<DVec3, String> {
        let text = self.remaining.remove(name).ok_or_else(|| format!("{name}=X,Y,Z is missing"))?;
        text.parse().map(|Point(vector)| vector).map_err(|problem| format!("{name}: {problem}"))
    }

    /// Along `dir`, or from `at` toward `to`.
    fn direction(&mut self, at: Option<DVec3>) -> Result<DVec3, String> {
        let given = |values: &Self, name| values.remaining.contains_key(name);
        match (at, given(self, "dir"), given(self, "to")) {
            (Some(at), false, true) => {
                let way = self.vector("to")? - at;
                way.try_normalize().ok_or_else(|| "to: the light stands there itself, expected another place".into())
            }
            (Some(_), true, true) => Err("dir and to: expected one of them".into()),
            (Some(_), false, false) => Err("dir=X,Y,Z or to=X,Y,Z is missing".into()),
            _ => {
                let direction = self.vector("dir")?;
                direction.try_normalize().ok_or_else(|| "dir: expected a vector with a length above 0".into())
            }
        }
    }

    fn range(&mut self, light: Light) -> Result<Light, String> {
        match self.number("range")? {
            Some(range_m) => named("range", light.with_range(range_m)),
            None => Ok(light),
        }
    }

    fn color(&mut self, light: Light) -> Result<Light, String> {
        let Some(text) = self.remaining.remove("color") else { return Ok(light) };
        let channels = srgb8_from_hex(&text).ok_or_else(|| format!("color: `{text}` is no colour #rrggbb"))?;
        let linear = channels.map(|channel| linear_from_srgb(f64::from(channel) / 255.0));
        named("color", light.with_color(DVec3::from_array(linear)))
    }
}

/// A number and the unit after it: the longest beginning that is a number.
fn split_unit(text: &str) -> Option<(f64, &str)> {
    let ends = text.char_indices().map(|(index, _)| index).chain([text.len()]).rev();
    ends.map(|end| text.split_at(end)).find_map(|(number, unit)| Some((number.trim().parse().ok()?, unit.trim())))
}

#[cfg(test)]
mod tests;
