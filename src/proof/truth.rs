//! Float64 twins of entries that take vectors and put several equations together.

#![expect(non_snake_case, reason = "equations keep the symbols of their papers")]

use crate::reference::brdf::{D_GGX, V_SmithGGXCorrelated};
use crate::reference::bsdf::{SMALLEST_NOV, lift_view};
use glam::DVec3;

pub(super) fn vec3(x: &[f64], first: usize) -> DVec3 {
    DVec3::from_slice(&x[first..])
}

/// Arguments: perceptual roughness, n, v, l.
pub(super) fn specular_lobe(x: &[f64]) -> Vec<f64> {
    let [n, v, l] = [1, 4, 7].map(|first| vec3(x, first).normalize());
    let v = lift_view(n, v);
    let (NoV, NoL) = (n.dot(v).max(SMALLEST_NOV), n.dot(l));
    if NoL <= 0.0 {
        return vec![0.0];
    }
    let alpha = x[0] * x[0];
    vec![D_GGX(alpha, n.dot((l + v).normalize())) * V_SmithGGXCorrelated(alpha, NoV, NoL) * NoL]
}

/// The smaller of n.v and n.l, as they are and not as f32 would multiply them.
pub(super) fn smaller_cosine(x: &[f32]) -> f32 {
    let x: Vec<f64> = x.iter().copied().map(f64::from).collect();
    let [n, v, l] = [1, 4, 7].map(|first| vec3(&x, first).normalize());
    n.dot(v).min(n.dot(l)) as f32
}

/// Arguments: v, fallback. The thresholds are those that the function states.
pub(super) fn normalize_or(x: &[f64]) -> Vec<f64> {
    let (v, fallback) = (vec3(x, 0), vec3(x, 3));
    // The thresholds are floats of 32 bits.
    let largest = v.abs().max_element();
    let told = largest > f64::from(1e-30_f32) && largest < f64::from(1e37_f32);
    if told { v.normalize().to_array().into() } else { fallback.to_array().into() }
}
