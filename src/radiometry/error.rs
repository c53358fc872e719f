//! The one way in which radiometry fails: a number that no light can have.

/// A parameter outside its domain.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{parameter} is {value}, expected {expected}")]
pub struct RadiometryError {
    /// What the number was meant to be.
    pub parameter: &'static str,
    pub value: f64,
    /// The domain and the unit.
    pub expected: &'static str,
}

impl RadiometryError {
    /// `value` itself when it is in its domain.
    pub(crate) fn check(
        in_domain: bool,
        parameter: &'static str,
        value: f64,
        expected: &'static str,
    ) -> Result<f64, Self> {
        if in_domain { Ok(value) } else { Err(Self { parameter, value, expected }) }
    }
}
