//! What must be so, whatever the pictures.

use super::pairs::{DISPLAYED, HEIGHT, RADIANT, WIDTH, displayed, radiant};
use crate::metrics::difference::{differing_pixels, max_abs, psnr_db, relative_rms};
use crate::metrics::flip::{flip, hdr_flip};
use crate::metrics::ssim::mean_ssim;
use crate::metrics::{ErrorMap, Mask, Pair, PairError, Side};
use crate::scene::{Encoding, Picture};
use glam::Vec4;

fn constant(width: u32, height: u32, encoding: Encoding, texel: Vec4) -> Picture {
    Picture { width, height, encoding, texels: vec![texel; (width * height) as usize] }
}

fn grey(value: f32) -> Picture {
    constant(WIDTH, HEIGHT, Encoding::Srgb, Vec4::new(value, value, value, 1.0))
}

#[test]
fn a_picture_equals_itself() {
    for (kind, _) in DISPLAYED {
        let picture = displayed(kind);
        let pair = Pair::new(&picture, &picture, None).unwrap();
        assert_eq!((differing_pixels(&pair), max_abs(&pair).value, relative_rms(&pair)), (0.0, 0.0, 0.0));
        assert_eq!(psnr_db(&pair), f64::INFINITY);
        assert!((mean_ssim(&pair).unwrap() - 1.0).abs() < 1e-12);
        assert!(flip(&pair).values.iter().all(|&error| error == 0.0));
    }
    for (kind, _) in RADIANT {
        let picture = radiant(kind);
        let pair = Pair::new(&picture, &picture, None).unwrap();
        assert!(hdr_flip(&pair).values.iter().all(|&error| error == 0.0));
    }
}

#[test]
fn one_pixel_is_found_where_it_is() {
    let expected = grey(0.5);
    let mut actual = expected.clone();
    actual.texels[(3 * WIDTH + 7) as usize].z = 0.25;
    let pair = Pair::new(&actual, &expected, None).unwrap();
    let worst = max_abs(&pair);
    assert_eq!((worst.value, worst.at, worst.channel), (0.25, (7, 3), "B"));
    assert_eq!((worst.actual, worst.expected), (0.25, 0.5));
    let pixels = f64::from(WIDTH * HEIGHT);
    assert_eq!(differing_pixels(&pair), 1.0 / pixels);
    let mse = 0.0625 / (3.0 * pixels);
    assert!((psnr_db(&pair) + 10.0 * mse.log10()).abs() < 1e-9);
    assert_eq!(flip(&pair).pool(&pair).max_at, (7, 3));
}

#[test]
fn relative_rms_is_of_light() {
    let [a, b] = [1.1, 1.0].map(|value| constant(4, 4, Encoding::Linear, Vec4::new(value, value, value, 1.0)));
    assert!((relative_rms(&Pair::new(&a, &b, None).unwrap()) - 0.1).abs() < 1e-6);
    // sRGB 0.5 is a light of 0.21404.
    let (half, white) = (grey(0.5), grey(1.0));
    assert!((relative_rms(&Pair::new(&half, &white, None).unwrap()) - (1.0 - 0.21404)).abs() < 1e-5);
    let black = grey(0.0);
    assert_eq!(relative_rms(&Pair::new(&white, &black, None).unwrap()), f64::INFINITY);
    assert_eq!(relative_rms(&Pair::new(&black, &black, None).unwrap()), 0.0);
}

#[test]
fn only_selected_pixels_count() {
    let expected = grey(0.5);
    let mut actual = expected.clone();
    actual.texels[0] = Vec4::ZERO;
    let mut mask = Mask { width: WIDTH, height: HEIGHT, selected: vec![true; (WIDTH * HEIGHT) as usize] };
    mask.selected[0] = false;
    let pair = Pair::new(&actual, &expected, Some(&mask)).unwrap();
    assert_eq!((differing_pixels(&pair), max_abs(&pair).value, relative_rms(&pair)), (0.0, 0.0, 0.0));
    mask.selected.fill(false);
    mask.selected[0] = true;
    let pair = Pair::new(&actual, &expected, Some(&mask)).unwrap();
    // Alpha is the channel that is furthest off.
    assert_eq!((differing_pixels(&pair), max_abs(&pair).value, relative_rms(&pair)), (1.0, 1.0, 1.0));
    assert_eq!(mean_ssim(&pair), None, "no window about a corner lies within the picture");
    let map = flip(&pair);
    assert_eq!(map.pool(&pair).mean, map.values[0]);
}

#[test]
fn the_largest_floats_are_compared() {
    let [a, b] = [f32::MAX, 1.0].map(|value| constant(16, 16, Encoding::Linear, Vec4::new(value, value, value, 1.0)));
    for (actual, expected) in [(&a, &b), (&b, &a)] {
        let pair = Pair::new(actual, expected, None).unwrap();
        assert!(hdr_flip(&pair).values.iter().all(|error| (0.0..=1.0).contains(error)));
        assert!(relative_rms(&pair).is_finite());
    }
}

#[test]
fn black_and_negative_radiance_have_an_error() {
    let [black, lit, negative] = [0.0, 1.0, -1.0].map(|v| constant(16, 16, Encoding::Linear, Vec4::new(v, v, v, 1.0)));
    let mean = |actual, expected| {
        let pair = Pair::new(actual, expected, None).unwrap();
        hdr_flip(&pair).pool(&pair).mean
    };
    assert!(mean(&lit, &black) > 0.5);
    assert_eq!(mean(&negative, &black), 0.0);
}

#[test]
fn small_pictures_have_no_ssim_and_some_flip() {
    let [a, b] = [0.0, 1.0].map(|value| constant(1, 1, Encoding::Srgb, Vec4::new(value, value, value, 1.0)));
    let pair = Pair::new(&a, &b, None).unwrap();
    assert_eq!(mean_ssim(&pair), None);
    // One pixel continued in all directions: as two pictures of one colour.
    let (black, white) = (grey(0.0), grey(1.0));
    let large = flip(&Pair::new(&black, &white, None).unwrap());
    assert!((flip(&pair).values[0] - large.values[0]).abs() < 1e-12);
}

#[test]
fn what_cannot_be_compared_is_named() {
    let (a, b) = (grey(0.5), constant(WIDTH, HEIGHT - 1, Encoding::Srgb, Vec4::ONE));
    assert!(matches!(Pair::new(&a, &b, None), Err(PairError::Size { .. })));
    let linear = constant(WIDTH, HEIGHT, Encoding::Linear, Vec4::ONE);
    assert!(matches!(Pair::new(&a, &linear, None), Err(PairError::Encoding { .. })));
    let mut broken = linear.clone();
    broken.texels[(2 * WIDTH + 5) as usize].y = f32::NAN;
    let error = Pair::new(&linear, &broken, None).unwrap_err();
    assert!(matches!(error, PairError::NotFinite { side: Side::Expected, x: 5, y: 2, channel: "G", .. }), "{error}");
    let none = Mask { width: WIDTH, height: HEIGHT, selected: vec![false; (WIDTH * HEIGHT) as usize] };
    assert_eq!(Pair::new(&a, &a, Some(&none)).unwrap_err(), PairError::MaskEmpty);
    let small = Mask { width: 1, height: 1, selected: vec![true] };
    assert!(matches!(Pair::new(&a, &a, Some(&small)), Err(PairError::MaskSize { .. })));
}

#[test]
fn pools_are_ranks() {
    let picture = constant(20, 10, Encoding::Srgb, Vec4::ONE);
    let pair = Pair::new(&picture, &picture, None).unwrap();
    // 1 to 200 in no order.
    let values = (0..200).map(|i| f64::from(i * 77 % 200 + 1)).collect();
    let pool = ErrorMap { width: 20, height: 10, values }.pool(&pair);
    assert_eq!((pool.mean, pool.median, pool.p99, pool.max), (100.5, 100.0, 198.0, 200.0));
    // 77 i = 199 modulo 200 at i = 187.
    assert_eq!(pool.max_at, (7, 9));
}
