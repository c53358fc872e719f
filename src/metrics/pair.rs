//! Two pictures that can be compared.

use crate::scene::{Encoding, Picture};

/// Names of the four channels of a texel.
pub const CHANNELS: [&str; 4] = ["R", "G", "B", "A"];

/// Which picture of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    Actual,
    Expected,
}

/// Why two pictures cannot be compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PairError {
    #[error("one picture is {actual:?} pixels, the other {expected:?}")]
    Size { actual: (u32, u32), expected: (u32, u32) },
    #[error("one picture is {actual:?}, the other {expected:?}")]
    Encoding { actual: Encoding, expected: Encoding },
    #[error("the {side:?} picture has {value} in {channel} of pixel ({x}, {y})")]
    NotFinite { side: Side, x: u32, y: u32, channel: &'static str, value: f32 },
    #[error("the mask is {mask:?} pixels, the pictures {pictures:?}")]
    MaskSize { mask: (u32, u32), pictures: (u32, u32) },
    #[error("the mask selects no pixel")]
    MaskEmpty,
}

/// The pixels that count.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mask {
    pub width: u32,
    pub height: u32,
    /// `width * height`, from the top left.
    pub selected: Vec<bool>,
}

impl Mask {
    /// Where a picture is at least half white in its brightest channel.
    pub fn from_picture(picture: &Picture) -> Self {
        let selected = picture.texels.iter().map(|texel| texel.truncate().max_element() >= 0.5).collect();
        Self { width: picture.width, height: picture.height, selected }
    }
}

/// Two pictures of one size and encoding, all of whose values are finite, and the pixels that count.
#[derive(Debug, Clone, Copy)]
pub struct Pair<'a> {
    actual: &'a Picture,
    expected: &'a Picture,
    mask: Option<&'a Mask>,
}

impl<'a> Pair<'a> {
    /// # Errors
    /// [`PairError`], for the first thing that keeps the pictures from being compared.
    pub fn new(actual: &'a Picture, expected: &'a Picture, mask: Option<&'a Mask>) -> Result<Self, PairError> {
        let sizes = [actual, expected].map(|picture| (picture.width, picture.height));
        if sizes[0] != sizes[1] {
            return Err(PairError::Size { actual: sizes[0], expected: sizes[1] });
        }
        if actual.encoding != expected.encoding {
            return Err(PairError::Encoding { actual: actual.encoding, expected: expected.encoding });
        }
        check_finite(actual, Side::Actual)?;
        check_finite(expected, Side::Expected)?;
        if let Some(mask) = mask {
            if (mask.width, mask.height) != sizes[0] {
                return Err(PairError::MaskSize { mask: (mask.width, mask.height), pictures: sizes[0] });
            }
            if !mask.selected.contains(&true) {
                return Err(PairError::MaskEmpty);
            }
        }
        Ok(Self { actual, expected, mask })
    }

    pub fn actual(&self) -> &'a Picture {
        self.actual
    }

    pub fn expected(&self) -> &'a Picture {
        self.expected
    }

    pub fn encoding(&self) -> Encoding {
        self.actual.encoding
    }

    /// Whether the pixel counts.
    pub fn is_selected(&self, index: usize) -> bool {
        self.mask.is_none_or(|mask| mask.selected[index])
    }

    /// Indices of the pixels that count, row by row.
    pub fn selected(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.actual.texels.len()).filter(|&index| self.is_selected(index))
    }

    /// Column and row of a pixel.
    pub fn place(&self, index: usize) -> (u32, u32) {
        let index = index as u32;
        (index % self.actual.width, index / self.actual.width)
    }
}

fn check_finite(picture: &Picture, side: Side) -> Result<(), PairError> {
    for (index, texel) in picture.texels.iter().enumerate() {
        if let Some(channel) = (0..4).find(|&channel| !texel[channel].is_finite()) {
            let (x, y) = (index as u32 % picture.width, index as u32 / picture.width);
            return Err(PairError::NotFinite { side, x, y, channel: CHANNELS[channel], value: texel[channel] });
        }
    }
    Ok(())
}
