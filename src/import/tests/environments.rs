//! Panoramas.

use super::hostile::assert_clean;
use super::samples;
use crate::import::{environment_from_path, environment_from_slice};
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage};
use glam::Vec3;
use std::io::Cursor;

/// A Radiance file of 2x1 texels, without run lengths, after this signature.
fn hdr(signature: &str) -> Vec<u8> {
    let mut file = format!("{signature}\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n").into_bytes();
    file.extend([128, 64, 32, 129, 0, 0, 128, 132]);
    file
}

#[test]
fn hdr_with_either_signature() {
    for signature in ["#?RADIANCE", "#?RGBE"] {
        let image = environment_from_slice(&hdr(signature), "sky").unwrap();
        assert_eq!((image.width, image.height), (2, 1));
        assert_eq!(image.texels, [Vec3::new(1.0, 0.5, 0.25), Vec3::new(0.0, 0.0, 8.0)], "{signature}");
    }
}

/// An OpenEXR file of 2x1 texels.
fn exr(channels: &[(&str, FlatSamples)]) -> Vec<u8> {
    let channel = |(name, samples): &(&str, FlatSamples)| AnyChannel::new(*name, samples.clone());
    let channels = AnyChannels::sort(channels.iter().map(channel).collect());
    let layer = Layer::new((2, 1), LayerAttributes::default(), Encoding::FAST_LOSSLESS, channels);
    let mut file = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut file).unwrap();
    file.into_inner()
}

#[test]
fn exr_in_colour_in_halves_and_in_grey() {
    let floats = |a: f32, b: f32| FlatSamples::F32(vec![a, b]);
    let halves = |a: f32, b: f32| FlatSamples::F16([a, b].map(half::f16::from_f32).to_vec());
    let color =
        exr(&[("R", floats(1.0, 2.0)), ("G", halves(3.0, 4.0)), ("B", floats(5.0, 6e9)), ("A", floats(0.0, 0.0))]);
    let image = environment_from_slice(&color, "sky").unwrap();
    assert_eq!((image.width, image.height), (2, 1));
    assert_eq!(image.texels, [Vec3::new(1.0, 3.0, 5.0), Vec3::new(2.0, 4.0, 6e9)]);
    let grey = environment_from_slice(&exr(&[("Y", floats(0.5, 7.0))]), "sky").unwrap();
    assert_eq!(grey.texels, [Vec3::splat(0.5), Vec3::splat(7.0)]);
}

#[test]
fn what_is_no_radiance_is_replaced() {
    let floats = |a: f32, b: f32| FlatSamples::F32(vec![a, b]);
    let file =
        exr(&[("R", floats(f32::NAN, -1.0)), ("G", floats(f32::INFINITY, 9.0)), ("B", floats(f32::NEG_INFINITY, 2.0))]);
    let image = environment_from_slice(&file, "sky").unwrap();
    assert_eq!(image.texels, [Vec3::new(0.0, 9.0, 0.0), Vec3::new(0.0, 9.0, 2.0)]);
}

#[test]
fn bad_panoramas_are_refused() {
    let depth = exr(&[("Z", FlatSamples::F32(vec![0.0, 1.0]))]);
    let good = exr(&[("Y", FlatSamples::F32(vec![0.0, 1.0]))]);
    let header = |size: &str| format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n").into_bytes();
    for (name, file) in [
        ("empty", vec![]),
        ("text", b"hello".to_vec()),
        ("HDR signature alone", b"#?RADIANCE\n".to_vec()),
        ("HDR without data", header("-Y 64 +X 128")),
        ("HDR bomb", header("-Y 16384 +X 16384")),
        ("HDR larger than the limit", header("-Y 4000000000 +X 4000000000")),
        ("HDR of no size", header("-Y 0 +X 0")),
        ("HDR of one texel", header("-Y 1 +X 1")),
        ("HDR turned", header("+X 2 -Y 1")),
        ("EXR signature alone", good[..4].to_vec()),
        ("EXR cut", good[..good.len() - 4].to_vec()),
        ("EXR of depth", depth),
    ] {
        let Err(error) = environment_from_slice(&file, "sky") else { panic!("{name} was accepted") };
        assert_clean(name, &error, "sky");
    }
}

#[test]
fn mutants_of_panoramas_never_panic() {
    let floats = FlatSamples::F32(vec![0.5, 1.0]);
    let good_exr = exr(&[("R", floats.clone()), ("G", floats.clone()), ("B", floats)]);
    for good in [hdr("#?RADIANCE"), good_exr] {
        for at in 0..good.len() {
            for bit in 0..8 {
                let mut file = good.clone();
                file[at] ^= 1 << bit;
                if let Err(error) = environment_from_slice(&file, "sky") {
                    assert_clean(&format!("bit {bit} of byte {at}"), &error, "sky");
                }
            }
        }
    }
}

#[test]
fn sample_panoramas_load() {
    for name in ["chinese_garden_1k.hdr", "spiaggia_di_mondello_1k.hdr"] {
        let Some(path) = samples::environment(name) else { return };
        let image = environment_from_path(&path).unwrap();
        assert_eq!((image.width, image.height), (1024, 512), "{name}");
        let largest = image.texels.iter().map(|texel| texel.max_element()).fold(0.0, f32::max);
        assert!(image.texels.iter().all(|texel| texel.is_finite() && texel.min_element() >= 0.0));
        assert!(largest > 65504.0, "{name}: the sun is brighter than half floats, found {largest}");
    }
}
