//! From what artists set to alpha, the parameter of the distribution.

use crate::math::parameter::ParameterError;
use crate::reference::brdf::alpha_from_perceptual_roughness;

/// Which of the two customary numbers an artist set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Transfer {
    /// alpha = perceptual_roughness^2 (Burley 2012, section 5.4; glTF 2.0, appendix B).
    PerceptualRoughness,
    /// alpha = (1 - glossiness)^2 (KHR_materials_pbrSpecularGlossiness).
    Glossiness,
}

impl Transfer {
    /// Alpha in [1e-3, 1] of a value in [0, 1]; the floor is that of [`alpha_from_perceptual_roughness`].
    ///
    /// # Errors
    /// When `value` is not in [0, 1].
    pub fn alpha(self, value: f64) -> Result<f64, ParameterError> {
        Ok(alpha_from_perceptual_roughness(self.perceptual_roughness(value)?))
    }

    /// The perceptual roughness in [0, 1] that a value stands for.
    ///
    /// # Errors
    /// As [`Self::alpha`].
    pub fn perceptual_roughness(self, value: f64) -> Result<f64, ParameterError> {
        match self {
            Self::PerceptualRoughness => ParameterError::check_unit("perceptual_roughness", value),
            Self::Glossiness => Ok(1.0 - ParameterError::check_unit("glossiness", value)?),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glossiness_runs_the_other_way() {
        for (value, alpha) in [(0.0, 1e-3), (0.5, 0.25), (0.9, 0.81), (1.0, 1.0)] {
            assert!((Transfer::PerceptualRoughness.alpha(value).unwrap() - alpha).abs() < 1e-15);
            assert!((Transfer::Glossiness.alpha(1.0 - value).unwrap() - alpha).abs() < 1e-15);
        }
        assert_eq!(Transfer::Glossiness.alpha(f64::NAN).unwrap_err().parameter, "glossiness");
        assert_eq!(Transfer::PerceptualRoughness.alpha(-0.1).unwrap_err().parameter, "perceptual_roughness");
    }
}
