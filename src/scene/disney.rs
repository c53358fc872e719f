//! What the Disney BRDF asks of a material beside base colour, metallic and perceptual roughness.

use crate::math::parameter::ParameterError;

/// The parameters of Burley 2012, "Physically-Based Shading at Disney", section 5.3, that a glTF material does not have.
/// All are in [0, 1]. Base colour, metallic and perceptual roughness are the material's own, textures included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disney {
    /// From the diffuse lobe to an approximation of subsurface scattering.
    pub subsurface: f32,
    /// Reflectance of the dielectric at normal incidence, as a fraction of 0.08; 0.5 is an index of refraction of 1.5.
    pub specular: f32,
    /// Tints the dielectric reflection toward the hue of the base colour.
    pub specular_tint: f32,
    /// Stretches the highlight; the surface is roughest along its tangent.
    pub anisotropic: f32,
    /// A grazing lobe, for cloth.
    pub sheen: f32,
    /// Tints the sheen toward the hue of the base colour.
    pub sheen_tint: f32,
    /// Strength of a second, colourless reflection.
    pub clearcoat: f32,
    /// From satin (0) to gloss (1).
    pub clearcoat_gloss: f32,
}

impl Default for Disney {
    /// Neutral: nothing but a diffuse lobe under a dielectric reflection of 4 %.
    fn default() -> Self {
        Self {
            subsurface: 0.0,
            specular: 0.5,
            specular_tint: 0.0,
            anisotropic: 0.0,
            sheen: 0.0,
            sheen_tint: 0.0,
            clearcoat: 0.0,
            clearcoat_gloss: 1.0,
        }
    }
}

impl Disney {
    /// The names of the parameters.
    pub const NAMES: [&str; 8] = [
        "subsurface",
        "specular",
        "specular_tint",
        "anisotropic",
        "sheen",
        "sheen_tint",
        "clearcoat",
        "clearcoat_gloss",
    ];

    /// A parameter by its name, to read or to write.
    pub fn parameter_mut(&mut self, name: &str) -> Option<&mut f32> {
        let values = [
            &mut self.subsurface,
            &mut self.specular,
            &mut self.specular_tint,
            &mut self.anisotropic,
            &mut self.sheen,
            &mut self.sheen_tint,
            &mut self.clearcoat,
            &mut self.clearcoat_gloss,
        ];
        let index = Self::NAMES.iter().position(|other| *other == name)?;
        values.into_iter().nth(index)
    }

    /// The same parameters, if every one of them is in [0, 1].
    ///
    /// # Errors
    /// Names the first that is not.
    pub fn checked(mut self) -> Result<Self, ParameterError> {
        for name in Self::NAMES {
            let value = self.parameter_mut(name).map_or(f32::NAN, |value| *value);
            ParameterError::check_unit(name, f64::from(value))?;
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_its_own_parameter_and_is_checked() {
        for name in Disney::NAMES {
            for bad in [-0.001, 1.001, f32::NAN, f32::INFINITY] {
                let mut disney = Disney::default();
                *disney.parameter_mut(name).unwrap() = bad;
                let error = disney.checked().unwrap_err();
                assert_eq!(error.parameter, name);
            }
            let mut disney = Disney::default();
            *disney.parameter_mut(name).unwrap() = 0.25;
            assert!(format!("{disney:?}").contains(&format!(" {name}: 0.25")), "{disney:?}");
        }
        assert_eq!(Disney::default().parameter_mut("metallic"), None);
        assert_eq!(Disney::default().checked(), Ok(Disney::default()));
    }
}
