//! Sequences as one file: animations, and sheets with all frames side by side.

use crate::math::color::{linear_from_srgb, srgb_from_linear};
use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, Rgba, RgbaImage};
use std::path::Path;

/// Quality of GIF's palettes against time, 1 (best) to 30.
const GIF_SPEED: i32 = 10;

/// Longest side of a picture on a contact sheet, pixels.
const THUMBNAIL_PX: u32 = 256;

/// Between the pictures of a sheet, pixels.
const GAP_PX: u32 = 4;

/// Which file an animation becomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum AnimationFormat {
    /// PNG with several frames.
    Apng,
    Gif,
}

impl AnimationFormat {
    /// By the ending of the name.
    ///
    /// # Errors
    /// When it is none of those that are known.
    pub(super) fn of(path: &Path) -> Result<Self, String> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("png" | "apng") => Ok(Self::Apng),
            Some("gif") => Ok(Self::Gif),
            _ => Err(format!("{}: unknown kind of animation; end the name in .png, .apng or .gif", path.display())),
        }
    }
}

/// An animation that repeats for ever.
///
/// # Errors
/// When a frame cannot be read, or is of another size than the first.
pub(super) fn animation(format: AnimationFormat, frames: &[&Path], frames_per_second: f64) -> Result<Vec<u8>, String> {
    match format {
        AnimationFormat::Apng => apng(frames, frames_per_second),
        AnimationFormat::Gif => gif(frames, frames_per_second),
    }
}

fn read(path: &Path) -> Result<RgbaImage, String> {
    let picture = image::open(path).map_err(|error| format!("{}: cannot be read: {error}", path.display()))?;
    Ok(picture.to_rgba8())
}

/// All frames in turn, which have to be of one size.
fn each(frames: &[&Path], mut take: impl FnMut(RgbaImage) -> Result<(), String>) -> Result<(), String> {
    let mut size = None;
    for path in frames {
        let frame = read(path)?;
        if *size.get_or_insert(frame.dimensions()) != frame.dimensions() {
            return Err(format!("{}: is not of the size of the first frame", path.display()));
        }
        take(frame)?;
    }
    Ok(())
}

fn apng(frames: &[&Path], frames_per_second: f64) -> Result<Vec<u8>, String> {
    let Some(first) = frames.first() else { return Err("there are no frames".into()) };
    let (width, height) = read(first)?.dimensions();
    let mut bytes = Vec::new();
    let text = |error: png::EncodingError| error.to_string();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.set_animated(frames.len() as u32, 0).map_err(text)?;
    // In milliseconds, as far as they go.
    encoder.set_frame_delay((1e3 / frames_per_second).round().clamp(1.0, 65535.0) as u16, 1000).map_err(text)?;
    let mut writer = encoder.write_header().map_err(text)?;
    each(frames, |frame| writer.write_image_data(&frame).map_err(text))?;
    writer.finish().map_err(text)?;
    Ok(bytes)
}

fn gif(frames: &[&Path], frames_per_second: f64) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let text = |error: image::ImageError| error.to_string();
    {
        let mut encoder = GifEncoder::new_with_speed(&mut bytes, GIF_SPEED);
        encoder.set_repeat(Repeat::Infinite).map_err(text)?;
        // GIF counts hundredths of a second.
        let hundredths = (100.0 / frames_per_second).round().clamp(1.0, 65535.0) as u32;
        let delay = Delay::from_numer_denom_ms(10 * hundredths, 1);
        each(frames, |frame| encoder.encode_frame(Frame::from_parts(frame, 0, 0, delay)).map_err(text))?;
    }
    Ok(bytes)
}

/// All frames, small, row by row, as many in a row as there are rows; transparent between them.
///
/// # Errors
/// As [`animation`].
pub(super) fn contact_sheet(frames: &[&Path]) -> Result<RgbaImage, String> {
    let columns = (frames.len() as f64).sqrt().ceil() as u32;
    let mut sheet = RgbaImage::new(0, 0);
    let mut index = 0;
    each(frames, |frame| {
        let small = shrunk(&frame, frame.width().max(frame.height()).div_ceil(THUMBNAIL_PX));
        let (width, height) = small.dimensions();
        if index == 0 {
            let rows = (frames.len() as u32).div_ceil(columns);
            sheet = RgbaImage::new(columns * (width + GAP_PX) - GAP_PX, rows * (height + GAP_PX) - GAP_PX);
        }
        let (x, y) = (index % columns * (width + GAP_PX), index / columns * (height + GAP_PX));
        image::imageops::replace(&mut sheet, &small, x.into(), y.into());
        index += 1;
        Ok(())
    })?;
    Ok(sheet)
}

/// Means of blocks of so many pixels on a side, in linear light, multiplied with their coverage.
fn shrunk(picture: &RgbaImage, by: u32) -> RgbaImage {
    if by <= 1 {
        return picture.clone();
    }
    let (width, height) = (picture.width().div_ceil(by), picture.height().div_ceil(by));
    RgbaImage::from_fn(width, height, |x, y| {
        let columns = by * x..(by * (x + 1)).min(picture.width());
        let rows = by * y..(by * (y + 1)).min(picture.height());
        let (mut sum, mut count) = ([0.0; 4], 0.0);
        for (row, column) in rows.flat_map(|row| columns.clone().map(move |column| (row, column))) {
            let [r, g, b, a] = picture.get_pixel(column, row).0.map(|code| f64::from(code) / 255.0);
            let premultiplied = [r, g, b].map(|channel| linear_from_srgb(channel) * a);
            sum[..3].iter_mut().zip(premultiplied).for_each(|(sum, value)| *sum += value);
            sum[3] += a;
            count += 1.0;
        }
        let color = |channel: f64| if sum[3] > 0.0 { srgb_from_linear(channel / sum[3]) } else { 0.0 };
        let codes = [color(sum[0]), color(sum[1]), color(sum[2]), sum[3] / count];
        Rgba(codes.map(|value| (255.0 * value).round() as u8))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::AnimationDecoder;
    use std::path::PathBuf;

    /// Frames of one colour each.
    fn frames(folder: &Path, count: u8) -> Vec<PathBuf> {
        let picture = |index: u8| RgbaImage::from_pixel(20, 10, Rgba([40 * index, 200, 90, 255]));
        let write = |index| {
            let path = folder.join(format!("{index}.png"));
            picture(index).save(&path).unwrap();
            path
        };
        (0..count).map(write).collect()
    }

    #[test]
    fn animations_have_all_frames_and_their_times() {
        let folder = tempfile::tempdir().unwrap();
        let files = frames(folder.path(), 5);
        let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
        let apng = animation(AnimationFormat::Apng, &paths, 25.0).unwrap();
        let decoder = image::codecs::png::PngDecoder::new(std::io::Cursor::new(&apng)).unwrap();
        let read = decoder.apng().unwrap().into_frames().collect_frames().unwrap();
        let gif = animation(AnimationFormat::Gif, &paths, 25.0).unwrap();
        let decoder = image::codecs::gif::GifDecoder::new(std::io::Cursor::new(&gif)).unwrap();
        for (frames, error) in [(read, 0), (decoder.into_frames().collect_frames().unwrap(), 3)] {
            assert_eq!(frames.len(), 5);
            for (index, frame) in frames.iter().enumerate() {
                assert_eq!(frame.delay().numer_denom_ms(), (40, 1));
                let red = frame.buffer().get_pixel(3, 3).0[0];
                assert!(red.abs_diff(40 * index as u8) <= error, "frame {index}: {red}");
            }
        }
        let other = folder.path().join("other.png");
        RgbaImage::new(3, 3).save(&other).unwrap();
        assert!(animation(AnimationFormat::Apng, &[paths[0], &other], 25.0).unwrap_err().contains("size of the first"));
        assert!(animation(AnimationFormat::Gif, &[&folder.path().join("none.png")], 25.0).is_err());
    }

    #[test]
    fn a_sheet_has_all_frames_in_rows() {
        let folder = tempfile::tempdir().unwrap();
        let files = frames(folder.path(), 5);
        let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
        let sheet = contact_sheet(&paths).unwrap();
        assert_eq!(sheet.dimensions(), (3 * 24 - 4, 2 * 14 - 4));
        assert_eq!(sheet.get_pixel(24 + 3, 14 + 3).0[0], 160, "the last is the second of the second row");
        assert_eq!(sheet.get_pixel(21, 3).0[3], 0);
        assert_eq!(sheet.get_pixel(48 + 3, 14 + 3).0[3], 0);
    }

    #[test]
    fn small_pictures_are_means_of_light() {
        let checker = RgbaImage::from_fn(4, 4, |x, y| Rgba([if (x + y) % 2 == 0 { 255 } else { 0 }, 0, 0, 255]));
        let small = shrunk(&checker, 2);
        assert_eq!((small.dimensions(), small.get_pixel(1, 1).0), ((2, 2), [188, 0, 0, 255]));
        // What is transparent has no colour of its own.
        let half = RgbaImage::from_fn(2, 1, |x, _| Rgba(if x == 0 { [255, 0, 0, 255] } else { [0, 255, 0, 0] }));
        assert_eq!(shrunk(&half, 2).get_pixel(0, 0).0, [255, 0, 0, 128]);
    }
}
