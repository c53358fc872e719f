//! A quantity by the shaders beside the same by the reference.

use glam::{DVec2, DVec3};
use serde::Serialize;

/// What a row is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Group {
    /// What shading reads.
    Input,
    /// Radiance toward the eye, cd/m2.
    Light,
    /// From radiance to what is shown.
    Pixel,
}

/// One quantity, as a number for each of its channels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Row {
    pub(super) group: Group,
    pub(super) name: String,
    pub(super) gpu: Option<Vec<f64>>,
    pub(super) reference: Option<Vec<f64>>,
    /// Of the reference, where it is an estimate.
    pub(super) standard_error: Option<Vec<f64>>,
    /// Largest difference of a channel over the largest channel of the reference. `None` where one of the two is
    /// missing, or the reference is 0 and the other is not.
    pub(super) relative_difference: Option<f64>,
}

impl Row {
    pub(super) fn new(
        group: Group,
        name: impl Into<String>,
        gpu: Option<Vec<f64>>,
        reference: Option<Vec<f64>>,
    ) -> Self {
        let relative_difference = gpu.as_ref().zip(reference.as_ref()).and_then(|(gpu, reference)| {
            let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
            let difference = largest(&mut gpu.iter().zip(reference).map(|(a, b)| (a - b).abs()));
            let size = largest(&mut reference.iter().map(|value| value.abs()));
            if difference == 0.0 { Some(0.0) } else { (size > 0.0).then_some(difference / size) }
        });
        Self { group, name: name.into(), gpu, reference, standard_error: None, relative_difference }
    }

    pub(super) fn with_standard_error(self, standard_error: DVec3) -> Self {
        Self { standard_error: Some(standard_error.to_array().to_vec()), ..self }
    }
}

/// The channels of a quantity.
pub(super) trait Channels {
    fn channels(self) -> Vec<f64>;
}

impl Channels for f64 {
    fn channels(self) -> Vec<f64> {
        vec![self]
    }
}

impl Channels for DVec2 {
    fn channels(self) -> Vec<f64> {
        self.to_array().to_vec()
    }
}

impl Channels for DVec3 {
    fn channels(self) -> Vec<f64> {
        self.to_array().to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_relative_to_the_largest_channel() {
        let difference = |gpu: Vec<f64>, reference: Vec<f64>| {
            Row::new(Group::Light, "x", Some(gpu), Some(reference)).relative_difference
        };
        assert_eq!(difference(vec![1.0, 3.0], vec![1.0, 4.0]), Some(0.25));
        assert_eq!(difference(vec![0.0], vec![0.0]), Some(0.0));
        assert_eq!(difference(vec![1.0], vec![0.0]), None);
        assert_eq!(Row::new(Group::Light, "x", None, Some(vec![1.0])).relative_difference, None);
    }
}
