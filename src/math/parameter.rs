//! Numbers from outside, checked: the error that names the parameter.

use std::ops::RangeInclusive;

/// A parameter outside of what a formula is defined for.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{parameter} is {value}; it must be {expected}")]
pub struct ParameterError {
    /// The name in the formula, as `alpha_x`.
    pub parameter: &'static str,
    pub value: f64,
    /// What would be accepted, as a phrase: "from 0 to 1".
    pub expected: &'static str,
}

impl ParameterError {
    /// `value` where it lies in `range`; NaN lies in none.
    ///
    /// # Errors
    /// Names the parameter and says what was `expected`.
    pub fn check(
        parameter: &'static str,
        value: f64,
        range: RangeInclusive<f64>,
        expected: &'static str,
    ) -> Result<f64, Self> {
        if range.contains(&value) { Ok(value) } else { Err(Self { parameter, value, expected }) }
    }

    /// `value` where it lies in [0, 1].
    ///
    /// # Errors
    /// As [`Self::check`].
    pub fn check_unit(parameter: &'static str, value: f64) -> Result<f64, Self> {
        Self::check(parameter, value, 0.0..=1.0, "from 0 to 1")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_names_the_parameter_and_what_it_should_be() {
        assert_eq!(ParameterError::check_unit("metallic", 1.0), Ok(1.0));
        for value in [-1e-300, 1.1, f64::INFINITY, f64::NAN] {
            let error = ParameterError::check_unit("metallic", value).unwrap_err();
            assert_eq!(error.to_string(), format!("metallic is {value}; it must be from 0 to 1"));
        }
    }
}
