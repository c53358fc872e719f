//! Moves in words.

use super::moves::{Class, Move, class};

/// `perceptual-roughness 0.300 -> 0.450`, `normal turned by 3.2 degrees (RMS)`, `direct-specular -34 %`.
pub(super) fn said(found: &Move) -> String {
    let Move { name, was, is, rms, scale } = found;
    match (class(name), rms) {
        (Class::Fault, _) => shares_at_fault(is),
        (Class::Light, _) => light(found),
        // Unit vectors: the chord says the angle.
        (_, Some(rms)) if is_direction(name) => {
            let degrees = 2.0 * (0.5 * rms.min(2.0)).asin().to_degrees();
            format!("{name} turned by about {degrees:.1} degrees")
        }
        (_, Some(rms)) if !found.is_in_mean() => {
            format!("{name} differs by about {} of {} (RMS), not in the mean", plain(*rms), plain(*scale))
        }
        _ => format!("{name} {} -> {}{}", vector(was), vector(is), unit(name)),
    }
}

fn is_direction(name: &str) -> bool {
    name == "tangent" || name.ends_with("normal")
}

fn unit(name: &str) -> &'static str {
    match name {
        "position" | "depth" => " m",
        "emissive" => " cd/m2",
        _ => "",
    }
}

/// Shares of the pixels whose radiance is at fault.
pub(super) fn shares_at_fault(share: &[f64; 3]) -> String {
    let kinds = ["NaN", "infinite", "negative"].into_iter().zip(share).filter(|(_, share)| **share > 0.0);
    let shares: Vec<String> = kinds.map(|(kind, share)| format!("{kind} in {}", percent(*share))).collect();
    format!("radiance is {} of its pixels", shares.join(" and "))
}

fn light(found: &Move) -> String {
    let [was, is] = [found.was, found.is].map(|rgb| rgb.iter().sum::<f64>());
    let name = &found.name;
    if is > 10.0 * was {
        return format!("{name} {} -> {} cd/m2", vector(&found.was), vector(&found.is));
    }
    match found.rms {
        Some(rms) if !found.is_in_mean() => {
            format!("{name} differs by about {} (RMS), not in the mean", percent(rms / found.scale))
        }
        _ => format!("{name} {}{}", if is >= was { "+" } else { "-" }, percent((is / was - 1.0).abs())),
    }
}

pub(super) fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent >= 9.95 || percent == 0.0 { format!("{percent:.0} %") } else { format!("{percent:.2} %") }
}

/// Three numbers, or one where no digit tells them apart.
pub(super) fn vector(value: &[f64; 3]) -> String {
    let [x, y, z] = value.map(plain);
    if x == y && y == z { x } else { format!("({x}, {y}, {z})") }
}

/// Three digits.
pub(super) fn plain(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 1e-3 => format!("{value:.3}"),
        _ => format!("{value:.2e}"),
    }
}

/// `material "ball"`.
pub(super) fn material(name: &str) -> String {
    format!("material {name:?}")
}

/// `-1.0, +0.5 pixels`: to the right and down.
pub(super) fn shift(pixels: [f64; 2]) -> String {
    // No minus before a zero.
    let [x, y] = pixels.map(|pixels| if pixels.abs() < 0.005 { 0.0 } else { pixels });
    format!("{x:+.2} pixels to the right and {y:+.2} down")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moves_are_sentences_with_units() {
        let said = |name: &str, was, is, rms, scale| said(&Move { name: name.into(), was, is, rms, scale });
        assert_eq!(said("metallic", [0.25; 3], [0.5; 3], Some(0.25), 0.5), "metallic 0.250 -> 0.500");
        assert_eq!(
            said("base-color", [0.5; 3], [0.5; 3], Some(0.3), 0.9),
            "base-color differs by about 0.300 of 0.900 (RMS), not in the mean"
        );
        assert_eq!(said("depth", [2.0; 3], [2.5; 3], Some(0.5), 4.0), "depth 2.000 -> 2.500 m");
        assert_eq!(said("normal", [0.0; 3], [0.1, 0.0, 0.0], Some(0.0349), 1.0), "normal turned by about 2.0 degrees");
        assert_eq!(said("direct-specular", [3.0; 3], [0.0; 3], Some(3.0), 5.0), "direct-specular -100 %");
        assert_eq!(said("ibl-diffuse", [1.0; 3], [1.05; 3], None, 1.7), "ibl-diffuse +5.00 %");
        assert_eq!(
            said("ibl-diffuse", [0.0; 3], [2.0, 1.0, 0.0], None, 2.0),
            "ibl-diffuse 0 -> (2.000, 1.000, 0) cd/m2"
        );
        assert_eq!(
            said("ibl-specular", [1.0; 3], [1.0; 3], Some(0.2), 2.0),
            "ibl-specular differs by about 10 % (RMS), not in the mean"
        );
        assert_eq!(
            said("nan", [0.0; 3], [0.5, 0.0, 0.01], None, 1.0),
            "radiance is NaN in 50 % and negative in 1.00 % of its pixels"
        );
    }
}
