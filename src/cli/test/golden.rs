//! Goldens: pictures with their provenance, and which pictures can be none.

use super::ingredients::Ingredients;
use super::report::Provenance;
use crate::cli::error::CliError;
use crate::cli::output::{self, write_in_folders};
use crate::scene::RadianceImage;
use serde::Deserialize;
use std::io::Cursor;
use std::path::Path;

/// Keyword of the provenance in a PNG.
const KEYWORD: &str = "specula:provenance";

/// A picture as its file has it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Golden {
    pub(super) width: u32,
    pub(super) height: u32,
    /// sRGB with straight alpha, 8 bits each.
    pub(super) rgba: Vec<u8>,
    /// `None` where the file does not say, or says it in a way of another version.
    pub(super) provenance: Option<Provenance>,
}

/// What stands beside a golden.
#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Sidecar {
    #[serde(flatten)]
    provenance: Provenance,
    /// What the picture was made of; none where that could not be found out, or another version says it otherwise.
    #[serde(default, deserialize_with = "if_it_can_be_read")]
    ingredients: Option<Ingredients>,
}

fn if_it_can_be_read<'de, D: serde::Deserializer<'de>>(from: D) -> Result<Option<Ingredients>, D::Error> {
    let value = serde_json::Value::deserialize(from)?;
    Ok(serde_json::from_value(value).ok())
}

/// A [`Sidecar`] as JSON: the provenance for people, then a line for each material and quantity, as there are many numbers.
/// No text has quotes that are not escaped, so that nothing inside of one is cut.
fn sidecar_text(provenance: &Provenance, ingredients: Option<&Ingredients>) -> serde_json::Result<String> {
    let text = serde_json::to_string_pretty(provenance)?;
    let Some(ingredients) = ingredients else { return Ok(format!("{text}\n")) };
    let made_of = serde_json::to_string(ingredients)?.replace("{\"name\":", "\n{\"name\":").replace("[\"", "\n[\"");
    let head = text.trim_end_matches('}').trim_end();
    Ok(format!("{head},\n  \"ingredients\": {made_of}\n}}\n"))
}

/// The PNG of a picture, with its provenance inside.
///
/// # Errors
/// When it cannot be encoded.
pub(super) fn encode(width: u32, height: u32, rgba: &[u8], provenance: &Provenance) -> Result<Vec<u8>, String> {
    let text = serde_json::to_string(provenance).map_err(|error| error.to_string())?;
    let software = concat!("specula ", env!("CARGO_PKG_VERSION"));
    output::png_with_texts(width, height, rgba, &[("Software", software), (KEYWORD, &text)])
}

/// # Errors
/// When the bytes are no PNG.
pub(super) fn decode(bytes: &[u8]) -> Result<Golden, String> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    // Tools that make files smaller write palettes and greys.
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let mut pixels = vec![0; reader.output_buffer_size().ok_or("it is too large")?];
    let frame = reader.next_frame(&mut pixels).map_err(|error| error.to_string())?;
    pixels.truncate(frame.buffer_size());
    let rgba = match frame.color_type.samples() {
        4 => pixels,
        3 => pixels.chunks_exact(3).flat_map(|pixel| [pixel[0], pixel[1], pixel[2], 255]).collect(),
        2 => pixels.chunks_exact(2).flat_map(|pixel| [pixel[0], pixel[0], pixel[0], pixel[1]]).collect(),
        _ => pixels.iter().flat_map(|&grey| [grey, grey, grey, 255]).collect(),
    };
    let text = reader.info().utf8_text.iter().find(|text| text.keyword == KEYWORD);
    let text = text.and_then(|text| text.get_text().ok());
    let provenance = text.and_then(|text| serde_json::from_str(&text).ok());
    Ok(Golden { width: frame.width, height: frame.height, rgba, provenance })
}

/// Writes a golden, and beside it its provenance and what it was made of. The golden is last: where there is one, there
/// is its provenance.
///
/// # Errors
/// When the file is larger than is allowed, or cannot be written; then the one of before is still there.
pub(super) fn write(
    path: &Path,
    png: &[u8],
    (provenance, ingredients): (&Provenance, Option<&Ingredients>),
    bytes_max: u64,
) -> Result<(), CliError> {
    if png.len() as u64 > bytes_max {
        return Err(CliError::Usage(format!(
            "{}: would have {} KiB, more than the {} KiB of `golden-kib`; make the picture smaller",
            path.display(),
            png.len().div_ceil(1024),
            bytes_max >> 10
        )));
    }
    let text = sidecar_text(provenance, ingredients).map_err(|error| CliError::Usage(error.to_string()))?;
    write_in_folders(&path.with_extension("json"), text.as_bytes())?;
    write_in_folders(path, png)
}

/// The picture of a run, which has to be the one that was judged, by the hash of its file.
///
/// # Errors
/// When it cannot be read, or is another.
pub(super) fn read_judged(path: &Path, hash: Option<&str>) -> Result<Vec<u8>, String> {
    let again = "run `specula test` again";
    let png = std::fs::read(path).map_err(|error| format!("{}: cannot be read: {error}; {again}", path.display()))?;
    if hash == Some(blake3::hash(&png).to_hex().as_str()) {
        Ok(png)
    } else {
        Err(format!("{} is not the picture that was judged; {again}", path.display()))
    }
}

/// Why a picture can be no golden, if it cannot: nothing can be seen in it.
pub(super) fn blank(rgba: &[u8]) -> Option<String> {
    if rgba.chunks_exact(4).all(|pixel| pixel[3] == 0) {
        return Some("the picture is transparent everywhere".into());
    }
    let mut range = [[255_u8, 0]; 4];
    for pixel in rgba.chunks_exact(4) {
        for (range, &code) in range.iter_mut().zip(pixel) {
            *range = [range[0].min(code), range[1].max(code)];
        }
    }
    // One step: rounding of a colour that is everywhere the same.
    let is_single = range.iter().all(|[least, most]| most - least <= 1);
    is_single.then(|| {
        let [r, g, b, _] = range.map(|[_, most]| most);
        format!("the picture is blank: #{r:02x}{g:02x}{b:02x} everywhere")
    })
}

/// The first fault of a frame, of which `image` holds [`Channel::Nan`](crate::scene::Channel::Nan): red where the radiance
/// is no number, green where it is infinite. What is negative is dark and no more.
pub(super) fn fault(image: &RadianceImage) -> Option<String> {
    let index = image.texels.iter().position(|texel| texel.x > 0.0 || texel.y > 0.0)?;
    let (x, y) = (index as u32 % image.width, index as u32 / image.width);
    let what = if image.texels[index].x > 0.0 { "NaN" } else { "infinite" };
    Some(format!("the radiance of pixel ({x}, {y}) is {what}"))
}

/// BLAKE3 of a picture's size and values.
pub(super) fn picture_hash(width: u32, height: u32, rgba: &[u8]) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&width.to_le_bytes()).update(&height.to_le_bytes()).update(rgba);
    hasher.finalize().to_hex().to_string()
}

/// The hash that stands beside a golden, if there is one.
pub(super) fn recorded_hash(golden: &Path) -> Option<String> {
    Some(sidecar(golden)?.provenance.picture_hash)
}

/// What the golden with this hash of its picture was made of, if that stands beside it.
pub(super) fn ingredients(golden: &Path, picture_hash: &str) -> Option<Ingredients> {
    sidecar(golden).filter(|sidecar| sidecar.provenance.picture_hash == picture_hash)?.ingredients
}

/// The suite and the case that a golden was drawn for, if that stands beside it.
pub(super) fn recorded(golden: &Path) -> Option<(String, String)> {
    sidecar(golden).map(|sidecar| (sidecar.provenance.suite, sidecar.provenance.case))
}

fn sidecar(golden: &Path) -> Option<Sidecar> {
    serde_json::from_slice(&std::fs::read(golden.with_extension("json")).ok()?).ok()
}

#[cfg(test)]
mod tests {
    use super::super::report::tests::example;
    use super::*;
    use glam::Vec4;

    fn provenance() -> Provenance {
        example().cases.remove(0).provenance.unwrap()
    }

    #[test]
    fn goldens_are_read_as_they_were_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("set/a/b.png");
        let ingredients = Ingredients {
            size_px: [16, 4],
            scale: 1.0,
            lights: vec!["a lamp".into()],
            materials: Vec::new(),
            left_out: 7,
        };
        for alpha in [255, 128] {
            let rgba: Vec<u8> = (0..64).flat_map(|i| [i, 2 * i, 255 - i, alpha]).collect();
            let png = encode(16, 4, &rgba, &provenance()).unwrap();
            write(&path, &png, (&provenance(), Some(&ingredients)), 4096).unwrap();
            let golden = decode(&std::fs::read(&path).unwrap()).unwrap();
            assert_eq!(golden, Golden { width: 16, height: 4, rgba, provenance: Some(provenance()) });
            assert!(write(&path, &png, (&provenance(), None), 10).unwrap_err().to_string().contains("golden-kib"));
            assert!(decode(&png[..png.len() / 2]).is_err());
        }
        let sidecar: Provenance = serde_json::from_slice(&std::fs::read(path.with_extension("json")).unwrap()).unwrap();
        assert_eq!(sidecar, provenance());
        assert_eq!(recorded_hash(&path).as_ref(), Some(&sidecar.picture_hash));
        assert_eq!(super::ingredients(&path, &sidecar.picture_hash), Some(ingredients));
        assert_eq!(super::ingredients(&path, "of another picture"), None);
        assert_eq!(recorded_hash(&folder.path().join("none.png")), None);
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 2, "nothing else is left");
    }

    #[test]
    fn pictures_without_a_picture_are_blank() {
        let picture = |pixel: fn(u8) -> [u8; 4]| (0..100).flat_map(pixel).collect::<Vec<u8>>();
        assert!(blank(&picture(|_| [0, 0, 0, 255])).unwrap().contains("#000000"));
        assert!(blank(&picture(|i| [100 + i % 2, 7, 200, 255])).unwrap().contains("blank"));
        assert!(blank(&picture(|i| [i, i, i, 0])).unwrap().contains("transparent"));
        assert_eq!(blank(&picture(|i| [0, 0, 0, if i == 7 { 255 } else { 0 }])), None);
        assert_eq!(blank(&picture(|i| [3 * u8::from(i == 7), 0, 0, 255])), None);
    }

    #[test]
    fn faults_are_found() {
        let mut image = RadianceImage { width: 4, height: 3, texels: vec![Vec4::W; 12] };
        image.texels[1].z = 1.0;
        assert_eq!(fault(&image), None);
        image.texels[6].y = 0.25;
        assert_eq!(fault(&image).unwrap(), "the radiance of pixel (2, 1) is infinite");
        image.texels[3].x = 1.0;
        assert_eq!(fault(&image).unwrap(), "the radiance of pixel (3, 0) is NaN");
    }
}
