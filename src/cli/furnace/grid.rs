//! Surfaces from parameters on the command line.

use super::{Subject, SurfaceKind};
use crate::cli::error::CliError;
use crate::math::parameter::ParameterError;
use crate::reference::bsdf::{SurfaceMaterial, dielectric_reflectance};
use crate::reference::microfacet::{Distribution, Ellipsoid, Fresnel, Geometry, Metal, Microfacet, Transfer};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use glam::DVec3;

/// Values of a grid are refused beyond this many.
const VALUES_MAX: usize = 1001;

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Parameters, where no model is given")]
pub(super) struct GridArgs {
    /// Values, as 0.1,0.5 or as FIRST..LAST:COUNT.
    #[arg(long, value_name = "VALUES", default_value = "0..1:11", value_parser = parse_numbers)]
    #[arg(conflicts_with_all = ["glossiness", "model"], allow_negative_numbers = true)]
    perceptual_roughness: Numbers,
    /// The same by alpha = (1 - glossiness)^2.
    #[arg(long, value_name = "VALUES", value_parser = parse_numbers, conflicts_with = "model")]
    #[arg(allow_negative_numbers = true)]
    glossiness: Option<Numbers>,
    /// Of the standard material.
    #[arg(long, value_name = "VALUES", default_value = "0,1", value_parser = parse_numbers)]
    #[arg(conflicts_with_all = ["ndf", "geometry", "fresnel", "model"], allow_negative_numbers = true)]
    metallic: Numbers,
    /// Linear red, green and blue, or one number for all. F0 with --fresnel schlick.
    #[arg(long, value_name = "R,G,B", default_value = "1", value_parser = parse_numbers, conflicts_with = "model")]
    #[arg(allow_negative_numbers = true)]
    base_color: Numbers,
    /// Index of refraction of the dielectric.
    #[arg(long, value_name = "N", default_value_t = 1.5, conflicts_with = "model")]
    ior: f64,
    #[command(flatten)]
    lobe: LobeArgs,
}

/// Any of --ndf, --geometry and --fresnel asks for a lobe of named models instead of the standard material.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "A single-scattering lobe of named models")]
struct LobeArgs {
    /// Distribution of facet normals.
    #[arg(long, value_enum, conflicts_with = "model")]
    ndf: Option<NdfArg>,
    /// How facets hide each other.
    #[arg(long, value_parser = geometry_parser(), conflicts_with = "model")]
    geometry: Option<Geometry>,
    /// What facets reflect.
    #[arg(long, value_enum, conflicts_with = "model")]
    fresnel: Option<FresnelArg>,
    /// From 0 to 1: alpha_x and alpha_y are alpha divided by and times sqrt(1 - 0.9 anisotropy) (Burley 2012).
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, requires = "ndf")]
    anisotropy: f64,
    /// Turns the axes of the anisotropy about the normal.
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_negative_numbers = true, requires = "ndf")]
    rotation: f64,
    /// Lean of the ellipsoid's predominant normal, along the tangent.
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, requires = "ndf")]
    tilt: f64,
    /// Metal of the table, for lazanyi, f82 and conductor: ag, al, au, cu, cuzn, fe, ti.
    #[arg(long, value_name = "SYMBOL", value_parser = parse_metal, requires = "fresnel")]
    metal: Option<Metal>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum NdfArg {
    Ggx,
    GgxAnisotropic,
    Ellipsoid,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum FresnelArg {
    /// Reflect everything.
    One,
    Schlick,
    Lazanyi,
    F82,
    Dielectric,
    Conductor,
}

/// A list of numbers.
#[derive(Debug, Clone, PartialEq)]
struct Numbers(Vec<f64>);

fn parse_numbers(text: &str) -> Result<Numbers, String> {
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| format!("`{text}` is not a number"));
    let Some((first, rest)) = text.split_once("..") else {
        return Ok(Numbers(text.split(',').map(number).collect::<Result<_, _>>()?));
    };
    let (last, count) = rest.split_once(':').ok_or("expected FIRST..LAST:COUNT, such as 0..1:11")?;
    let (first, last) = (number(first)?, number(last)?);
    match count.trim().parse::<usize>() {
        Ok(count) if (2..=VALUES_MAX).contains(&count) => {
            let step = (last - first) / (count - 1) as f64;
            Ok(Numbers((0..count).map(|i| first + step * i as f64).collect()))
        }
        _ => Err(format!("`{count}` is not a count from 2 to {VALUES_MAX}")),
    }
}

fn geometry_parser() -> impl TypedValueParser<Value = Geometry> {
    let by_name = |name: String| Geometry::by_name(&name).ok_or("unknown geometry");
    PossibleValuesParser::new(Geometry::ALL.map(Geometry::name)).try_map(by_name)
}

fn parse_metal(symbol: &str) -> Result<Metal, String> {
    Metal::by_symbol(symbol).copied().ok_or_else(|| "expected one of ag, al, au, cu, cuzn, fe, ti".into())
}

impl GridArgs {
    /// The standard material, or a lobe, at each of the perceptual roughnesses.
    pub(super) fn subjects(&self) -> Result<Vec<Subject>, CliError> {
        let (transfer, values) = match &self.glossiness {
            Some(values) => (Transfer::Glossiness, values),
            None => (Transfer::PerceptualRoughness, &self.perceptual_roughness),
        };
        let base_color = self.base_color()?;
        let mut subjects = Vec::new();
        let metallics = if self.lobe.is_wanted() { &[0.0][..] } else { &self.metallic.0 };
        for &metallic in metallics {
            ParameterError::check_unit("metallic", metallic)?;
            for &value in &values.0 {
                let perceptual_roughness = transfer.perceptual_roughness(value)?;
                let (group, surface) = if self.lobe.is_wanted() {
                    let lobe = self.lobe.at(transfer.alpha(value)?, base_color, self.ior)?;
                    (self.lobe.describe(), SurfaceKind::Lobe(lobe))
                } else {
                    let material = self.material(base_color, metallic, perceptual_roughness)?;
                    (format!("metallic {metallic}"), SurfaceKind::Standard(material))
                };
                let label = match transfer {
                    Transfer::PerceptualRoughness => format!("r {value:.3}"),
                    Transfer::Glossiness => format!("glossiness {value:.3}"),
                };
                subjects.push(Subject { group, label, surface });
            }
        }
        Ok(subjects)
    }

    fn base_color(&self) -> Result<DVec3, CliError> {
        let color = match self.base_color.0[..] {
            [grey] => DVec3::splat(grey),
            [r, g, b] => DVec3::new(r, g, b),
            _ => return Err(CliError::Usage("--base-color takes one number or three".into())),
        };
        for channel in color.to_array() {
            ParameterError::check_unit("base_color", channel)?;
        }
        Ok(color)
    }

    fn material(
        &self,
        base_color: DVec3,
        metallic: f64,
        perceptual_roughness: f64,
    ) -> Result<SurfaceMaterial, CliError> {
        ParameterError::check("ior", self.ior, 1.0..=f64::MAX, "from 1 up")?;
        let (dielectric_f0, dielectric_f90) = dielectric_reflectance(self.ior, 1.0, DVec3::ONE);
        Ok(SurfaceMaterial { base_color, metallic, perceptual_roughness, dielectric_f0, dielectric_f90 })
    }
}

impl LobeArgs {
    fn is_wanted(&self) -> bool {
        self.ndf.is_some() || self.geometry.is_some() || self.fresnel.is_some()
    }

    fn at(&self, alpha: f64, f0: DVec3, ior: f64) -> Result<Microfacet, CliError> {
        ParameterError::check_unit("anisotropy", self.anisotropy)?;
        let aspect = (1.0 - 0.9 * self.anisotropy).sqrt();
        let (alpha_x, alpha_y, rotation_rad) = (alpha / aspect, alpha * aspect, self.rotation.to_radians());
        let ndf = self.ndf.unwrap_or(NdfArg::Ggx);
        if ndf == NdfArg::Ggx && (self.anisotropy != 0.0 || self.rotation != 0.0) {
            return Err(CliError::Usage("--anisotropy and --rotation need --ndf ggx-anisotropic or ellipsoid".into()));
        }
        if ndf != NdfArg::Ellipsoid && self.tilt != 0.0 {
            return Err(CliError::Usage("--tilt needs --ndf ellipsoid".into()));
        }
        let distribution = match ndf {
            NdfArg::Ggx => Distribution::ggx(alpha)?,
            NdfArg::GgxAnisotropic => Distribution::ggx_anisotropic(alpha_x, alpha_y, rotation_rad)?,
            NdfArg::Ellipsoid => {
                let tilt_rad = self.tilt.to_radians();
                Distribution::Ellipsoid(Ellipsoid::new(alpha_x, alpha_y, rotation_rad, tilt_rad, 0.0)?)
            }
        };
        let metal = || {
            self.metal
                .ok_or_else(|| CliError::Usage("--fresnel lazanyi, f82 and conductor need --metal, such as au".into()))
        };
        let fresnel = match self.fresnel.unwrap_or(FresnelArg::One) {
            FresnelArg::One => Fresnel::One,
            FresnelArg::Schlick => Fresnel::schlick(f0, 1.0)?,
            FresnelArg::Lazanyi => Fresnel::lazanyi(metal()?.f0(), metal()?.a)?,
            FresnelArg::F82 => Fresnel::f82(metal()?.f0(), metal()?.f82())?,
            FresnelArg::Dielectric => Fresnel::dielectric(ior)?,
            FresnelArg::Conductor => Fresnel::of_metal(&metal()?),
        };
        Ok(Microfacet { distribution, geometry: self.geometry.unwrap_or(Geometry::SmithCorrelated), fresnel })
    }

    fn describe(&self) -> String {
        let value =
            |value: Option<clap::builder::PossibleValue>| value.map_or_else(String::new, |v| v.get_name().into());
        let ndf = value(clap::ValueEnum::to_possible_value(&self.ndf.unwrap_or(NdfArg::Ggx)));
        let fresnel = value(clap::ValueEnum::to_possible_value(&self.fresnel.unwrap_or(FresnelArg::One)));
        let metal = self.metal.map_or_else(String::new, |metal| format!(" of {}", metal.name));
        let geometry = self.geometry.unwrap_or(Geometry::SmithCorrelated).name();
        format!("ndf {ndf}, geometry {geometry}, fresnel {fresnel}{metal}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_ranges_of_numbers() {
        assert_eq!(parse_numbers("0.5"), Ok(Numbers(vec![0.5])));
        assert_eq!(parse_numbers("0, 1e-3,1"), Ok(Numbers(vec![0.0, 1e-3, 1.0])));
        assert_eq!(parse_numbers("0..1:5"), Ok(Numbers(vec![0.0, 0.25, 0.5, 0.75, 1.0])));
        for bad in ["", "a", "0..1", "0..1:1", "0..1:9999", "0..b:3", "1,,2"] {
            assert!(parse_numbers(bad).is_err(), "{bad}");
        }
    }
}
