//! What a picture was made of, material by material: numbers that are kept beside a golden, so that a failure can be told
//! by what has moved. The scene and the program of the golden are gone by then. Of furnaces and truths both sides are there.

mod compare;
mod furnace;
mod gather;
mod moves;
mod pack;
mod seen;
mod sketch;
mod truth;
mod words;

pub(super) use compare::findings;
pub(super) use furnace::findings_in_furnace;
pub(super) use gather::{Gathering, channels, size};
pub(super) use sketch::content_hash;
pub(super) use truth::BesideTruth;

use compare::fault;
use pack::Packed;
use serde::{Deserialize, Serialize};
use sketch::SUMS;

/// Of one picture: every input of shading and every part of its light, by material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::cli) struct Ingredients {
    /// Of the views that were measured, pixels: those of the picture, or smaller ones of the same shape.
    pub(in crate::cli) size_px: [u32; 2],
    /// Width of the picture over that of the views.
    pub(in crate::cli) scale: f64,
    /// What gives light, in words.
    pub(in crate::cli) lights: Vec<String>,
    /// Those that are seen.
    pub(in crate::cli) materials: Vec<MaterialIngredients>,
    /// How many more are seen, in fewer pixels than these.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub(in crate::cli) left_out: usize,
}

/// Of the pixels that show one material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::cli) struct MaterialIngredients {
    /// As the file calls it, or `material N`.
    pub(in crate::cli) name: String,
    /// Pixels in whose middle it is the nearest surface.
    pub(in crate::cli) pixels: u32,
    /// Those of them that its quantities are of: without edges, which show other materials too, unless there is nothing else.
    pub(in crate::cli) measured: u32,
    /// Mean position of all of them, from the top left.
    pub(in crate::cli) center_px: [f64; 2],
    /// Of the textures that it has.
    pub(in crate::cli) textures: Vec<TextureHash>,
    pub(in crate::cli) quantities: Vec<Quantity>,
}

/// The content of a texture.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::cli) struct TextureHash {
    /// What it is used as: `base_color`.
    pub(in crate::cli) slot: String,
    /// First digits of the BLAKE3 of its texels.
    pub(in crate::cli) hash: String,
}

/// A debug view, or a finer part of one, over the pixels of a material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "Packed", try_from = "Packed")]
pub(in crate::cli) struct Quantity {
    /// `perceptual-roughness`, `ibl-specular`.
    pub(in crate::cli) name: String,
    pub(in crate::cli) mean: [f64; 3],
    /// Standard deviation.
    pub(in crate::cli) spread: [f64; 3],
    /// Sums under pseudo-random signs: two of them say how far two pictures are apart. `None` where the quantity is the same
    /// everywhere.
    pub(in crate::cli) sketch: Option<[f64; SUMS]>,
}

impl Quantity {
    /// Zero everywhere.
    fn is_nothing(&self) -> bool {
        self.sketch.is_none() && self.mean == [0.0; 3]
    }
}

impl MaterialIngredients {
    /// One of the quantities; what is not listed is zero.
    fn quantity(&self, name: &str) -> Option<&Quantity> {
        self.quantities.iter().find(|quantity| quantity.name == name)
    }
}

fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// The materials whose radiance is at fault.
fn list_of_faults(of: &Ingredients) -> Vec<Finding> {
    of.materials.iter().filter_map(|of| fault(of, of.quantity(gather::FAULTS)?)).collect()
}

/// What a finding is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(in crate::cli) enum Moved {
    /// Radiance that is NaN, infinite or negative.
    Fault,
    /// What is seen, and where in the picture.
    Geometry,
    /// What shading reads of a material.
    Material,
    /// What gives light.
    Lights,
    /// Light that materials send to the eye, while all that it is made from is the same, or as it should be.
    Shading,
    /// None of these: what comes after them.
    Display,
    /// It cannot be told.
    Unknown,
}

/// Something that is not as it was when the golden was drawn, or not as the truth or a furnace has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::cli) struct Finding {
    pub(in crate::cli) moved: Moved,
    /// None where it is about all.
    pub(in crate::cli) material: Option<String>,
    /// The quantities that are not the same.
    pub(in crate::cli) quantities: Vec<String>,
    /// One line for people.
    pub(in crate::cli) text: String,
}

impl Finding {
    pub(super) fn unknown(text: impl Into<String>) -> Self {
        Self { moved: Moved::Unknown, material: None, quantities: Vec::new(), text: text.into() }
    }
}
