//! Ingredients in few bytes: a quantity is a short array, a sketch is sixteen numbers of 16 bits in base64, and what is too
//! much is left out.

use super::sketch::SUMS;
use super::{Ingredients, Quantity};
use base64::Engine;
use base64::engine::general_purpose::STANDARD_NO_PAD as BASE64;
use serde::{Deserialize, Serialize};

/// The most that the ingredients of one picture take as JSON.
const BYTES_MAX: usize = 48 << 10;
/// More lights than this are counted.
const LIGHTS_MAX: usize = 64;
/// Longer names of materials are cut.
const NAME_MAX: usize = 120;

/// One number where all three are the same.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum Number {
    Grey(f64),
    Color([f64; 3]),
}

impl From<[f64; 3]> for Number {
    fn from(color: [f64; 3]) -> Self {
        if color == [color[0]; 3] { Self::Grey(color[0]) } else { Self::Color(color) }
    }
}

impl From<Number> for [f64; 3] {
    fn from(number: Number) -> Self {
        match number {
            Number::Grey(grey) => [grey; 3],
            Number::Color(color) => color,
        }
    }
}

/// A [`Quantity`] as it is written.
#[derive(Debug, Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum Packed {
    /// Name and mean of what is the same everywhere.
    Constant(String, Number),
    /// Name, mean, spread and sketch.
    Varying(String, Number, Number, String),
}

impl From<Quantity> for Packed {
    fn from(quantity: Quantity) -> Self {
        let Quantity { name, mean, spread, sketch } = quantity;
        match sketch {
            None => Self::Constant(name, mean.into()),
            Some(sums) => Self::Varying(name, mean.into(), spread.into(), packed(&sums)),
        }
    }
}

impl TryFrom<Packed> for Quantity {
    type Error = &'static str;

    fn try_from(packed: Packed) -> Result<Self, Self::Error> {
        match packed {
            Packed::Constant(name, mean) => Ok(Self { name, mean: mean.into(), spread: [0.0; 3], sketch: None }),
            Packed::Varying(name, mean, spread, sketch) => {
                let sketch = Some(unpacked(&sketch).ok_or("no sketch")?);
                Ok(Self { name, mean: mean.into(), spread: spread.into(), sketch })
            }
        }
    }
}

/// The largest of the sums as f32 and, over that, all of them as 16-bit numbers, little-endian: rounding is 1e-5 of the
/// largest.
fn packed(sums: &[f64; SUMS]) -> String {
    let largest = sums.iter().fold(0.0_f64, |largest, sum| largest.max(sum.abs())) as f32;
    let step = f64::from(largest.max(f32::MIN_POSITIVE)) / f64::from(i16::MAX);
    let numbers = sums.iter().flat_map(|sum| ((sum / step).round() as i16).to_le_bytes());
    BASE64.encode(largest.to_le_bytes().into_iter().chain(numbers).collect::<Vec<u8>>())
}

fn unpacked(text: &str) -> Option<[f64; SUMS]> {
    let bytes = BASE64.decode(text).ok()?;
    let (largest, numbers) = bytes.split_at_checked(4)?;
    let largest = f32::from_le_bytes(largest.try_into().ok()?);
    let step = f64::from(largest) / f64::from(i16::MAX);
    let (numbers, rest) = numbers.as_chunks::<2>();
    let sums: Vec<f64> = numbers.iter().map(|number| f64::from(i16::from_le_bytes(*number)) * step).collect();
    let sums: [f64; SUMS] = sums.try_into().ok()?;
    (rest.is_empty() && sums.iter().all(|sum| sum.is_finite())).then_some(sums)
}

impl Ingredients {
    /// The same in at most [`BYTES_MAX`]: the materials that are least seen are left out, and counted.
    pub(super) fn bounded(mut self) -> Self {
        if self.lights.len() > LIGHTS_MAX {
            let more = self.lights.split_off(LIGHTS_MAX - 1);
            let hash = super::content_hash(more.join("\n").as_bytes());
            self.lights.push(format!("and {} more ({hash})", more.len()));
        }
        for material in &mut self.materials {
            if let Some((end, _)) = material.name.char_indices().nth(NAME_MAX) {
                material.name.truncate(end);
            }
        }
        let bytes = |of: &dyn Fn() -> serde_json::Result<String>| of().map_or(usize::MAX, |text| text.len() + 1);
        let mut by_size: Vec<usize> = (0..self.materials.len()).collect();
        by_size.sort_by_key(|&index| (std::cmp::Reverse(self.materials[index].pixels), index));
        let materials = std::mem::take(&mut self.materials);
        self.left_out += materials.len();
        let mut left = BYTES_MAX.saturating_sub(bytes(&|| serde_json::to_string(&self)));
        let mut kept = vec![false; materials.len()];
        for index in by_size {
            let size = bytes(&|| serde_json::to_string(&materials[index]));
            if size > left {
                break;
            }
            (left, kept[index]) = (left - size, true);
        }
        self.left_out -= kept.iter().filter(|kept| **kept).count();
        self.materials =
            materials.into_iter().zip(kept).filter_map(|(material, kept)| kept.then_some(material)).collect();
        self
    }
}

#[cfg(test)]
mod tests {
    use super::super::MaterialIngredients;
    use super::*;

    fn quantity(name: &str) -> Quantity {
        let sketch = Some(std::array::from_fn(|k| (k as f64 - 7.3) * 123.456));
        Quantity { name: name.into(), mean: [0.123456, 0.234567, 0.345678], spread: [0.1, 0.2, 0.3], sketch }
    }

    #[test]
    fn what_is_read_is_what_was_written_but_for_rounding() {
        let constant = Quantity { name: "metallic".into(), mean: [0.5; 3], spread: [0.0; 3], sketch: None };
        assert_eq!(serde_json::to_string(&constant).unwrap(), r#"["metallic",0.5]"#);
        let text = serde_json::to_string(&[constant.clone(), quantity("f0")]).unwrap();
        assert!(text.len() < 140, "{text}");
        let [same, near]: [Quantity; 2] = serde_json::from_str(&text).unwrap();
        assert_eq!(same, constant);
        let (then, now) = (quantity("f0"), near);
        assert_eq!((then.mean, then.spread), (now.mean, now.spread));
        for (then, now) in then.sketch.unwrap().into_iter().zip(now.sketch.unwrap()) {
            assert!((then - now).abs() < 1e-4 * 123.456 * 8.7, "{then} {now}");
        }
        // Sums of zero are sums too.
        assert_eq!(unpacked(&packed(&[0.0; SUMS])), Some([0.0; SUMS]));
    }

    #[test]
    fn numbers_of_others_are_no_sketch() {
        let good = packed(&[1.0; SUMS]);
        assert!(unpacked(&good).is_some());
        let no_number = BASE64.encode([f32::NAN.to_le_bytes().to_vec(), vec![1; 2 * SUMS]].concat());
        for bad in ["", "é", &good[..8], &good.replace(&good[..2], "??"), &format!("{good}AAAA"), &no_number] {
            assert_eq!(unpacked(bad), None, "{bad}");
        }
    }

    #[test]
    fn a_thousand_materials_are_no_more_than_the_limit() {
        let material = |index: u32| MaterialIngredients {
            name: format!("{index} {}", "é".repeat(1000)),
            // The last are seen most.
            pixels: 1 + index,
            measured: 1,
            center_px: [123.4567, 89.0123],
            textures: Vec::new(),
            quantities: (0..23).map(|k| quantity(&format!("a-rather-long-name-{k}"))).collect(),
        };
        let all = Ingredients {
            size_px: [256, 256],
            scale: 4.0,
            lights: (0..5000).map(|index| format!("point light of {index} cd at (1, 2, 3) m")).collect(),
            materials: (0..1000).map(material).collect(),
            left_out: 0,
        };
        let bounded = all.clone().bounded();
        let text = serde_json::to_string(&bounded).unwrap();
        assert!(text.len() <= BYTES_MAX && text.len() > BYTES_MAX / 2, "{}", text.len());
        assert_eq!(bounded.left_out + bounded.materials.len(), 1000);
        assert_eq!(bounded.materials.last().unwrap().pixels, 1000);
        assert_eq!((bounded.lights.len(), bounded.clone().bounded()), (LIGHTS_MAX, bounded.clone()));
        let mut other = all;
        other.lights[4000] = "another".into();
        assert_ne!(other.bounded().lights, bounded.lights);
        let few = Ingredients { materials: bounded.materials[..3].to_vec(), left_out: 0, ..bounded };
        assert_eq!(few.clone().bounded(), few);
    }
}
