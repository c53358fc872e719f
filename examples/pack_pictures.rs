//! Writes PNG files anew, with the same pixels in as few bytes as the encoder can: those of the documents are read more
//! often than written.
//!
//! `cargo run --release --example pack_pictures -- docs/pictures/*.png`

#![expect(clippy::print_stdout, reason = "what was gained is the output")]

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, ImageEncoder, ImageError};

const FILTERS: [FilterType; 6] =
    [FilterType::NoFilter, FilterType::Sub, FilterType::Up, FilterType::Avg, FilterType::Paeth, FilterType::Adaptive];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for path in std::env::args().skip(1) {
        let before = std::fs::read(&path)?;
        let packed = pack(&image::load_from_memory(&before)?)?;
        println!("{path}: {} bytes, packed {}", before.len(), packed.len());
        if packed.len() < before.len() {
            std::fs::write(path, packed)?;
        }
    }
    Ok(())
}

/// The shortest of all files that differ in the filter alone.
fn pack(picture: &DynamicImage) -> Result<Vec<u8>, ImageError> {
    let mut shortest: Option<Vec<u8>> = None;
    for filter in FILTERS {
        let mut bytes = Vec::new();
        let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Level(9), filter);
        encoder.write_image(picture.as_bytes(), picture.width(), picture.height(), picture.color().into())?;
        if shortest.as_ref().is_none_or(|shortest| bytes.len() < shortest.len()) {
            shortest = Some(bytes);
        }
    }
    Ok(shortest.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use image::{DynamicImage, RgbImage, RgbaImage};

    #[test]
    fn pixels_stay_and_smooth_ones_are_packed() {
        let opaque = RgbImage::from_fn(64, 48, |x, y| image::Rgb([2 * x as u8, 3 * y as u8, (x + y) as u8]));
        let clear = RgbaImage::from_fn(20, 10, |x, y| image::Rgba([x as u8, y as u8, 7, (x * y) as u8]));
        for picture in [DynamicImage::from(opaque), DynamicImage::from(clear)] {
            let packed = super::pack(&picture).unwrap();
            assert_eq!(image::load_from_memory(&packed).unwrap(), picture);
            assert!(packed.len() < picture.as_bytes().len() / 4, "{}", packed.len());
        }
    }
}
