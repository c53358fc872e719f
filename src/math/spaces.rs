//! Directions on the sphere and their two flat charts: equirectangular and octahedral.
//!
//! World space is right-handed with +Y up (glTF). Directions are unit vectors.

use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Texture coordinates of a direction in an equirectangular map.
///
/// u = 0.5 + atan2(z, x) / 2pi, v = acos(y) / pi: row 0 looks up (+Y), the image centre looks toward +X and the
/// picture is not mirrored. `direction` must be unit length. Returns u in [0, 1], v in [0, 1].
pub fn equirect_from_direction(direction: DVec3) -> DVec2 {
    let u = 0.5 + direction.z.atan2(direction.x) / (2.0 * PI);
    DVec2::new(u, direction.y.clamp(-1.0, 1.0).acos() / PI)
}

/// Inverse of [`equirect_from_direction`].
pub fn direction_from_equirect(uv: DVec2) -> DVec3 {
    let (sin_phi, cos_phi) = ((uv.x - 0.5) * 2.0 * PI).sin_cos();
    let (sin_theta, cos_theta) = (uv.y * PI).sin_cos();
    DVec3::new(sin_theta * cos_phi, cos_theta, sin_theta * sin_phi)
}

/// Octahedral chart of a direction (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent
/// Unit Vectors", listing 1), with +Y as the pole. Returns coordinates in [0, 1]^2.
pub fn octahedral_from_direction(direction: DVec3) -> DVec2 {
    let d = direction / (direction.x.abs() + direction.y.abs() + direction.z.abs());
    let folded = if d.y >= 0.0 {
        DVec2::new(d.x, d.z)
    } else {
        DVec2::new((1.0 - d.z.abs()) * sign_not_zero(d.x), (1.0 - d.x.abs()) * sign_not_zero(d.z))
    };
    folded * 0.5 + 0.5
}

/// Inverse of [`octahedral_from_direction`]; returns a unit vector.
pub fn direction_from_octahedral(uv: DVec2) -> DVec3 {
    let p = uv * 2.0 - 1.0;
    let y = 1.0 - p.x.abs() - p.y.abs();
    let (x, z) = if y >= 0.0 {
        (p.x, p.y)
    } else {
        ((1.0 - p.y.abs()) * sign_not_zero(p.x), (1.0 - p.x.abs()) * sign_not_zero(p.y))
    };
    DVec3::new(x, y, z).normalize()
}

fn sign_not_zero(x: f64) -> f64 {
    if x >= 0.0 { 1.0 } else { -1.0 }
}

/// Two unit vectors that complete the unit vector `n` to a right-handed orthonormal basis (b1 x b2 = n), without a
/// branch on the direction (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3).
pub fn orthonormal_basis(n: DVec3) -> (DVec3, DVec3) {
    let sign = 1.0_f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), DVec3::new(b, sign + n.y * n.y * a, -n.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions() -> impl Iterator<Item = DVec3> {
        (0..2000).map(|i| {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 2000.0;
            let phi = f64::from(i) * 2.399_963_229_728_653;
            let r = (1.0 - z * z).sqrt();
            DVec3::new(r * phi.cos(), z, r * phi.sin())
        })
    }

    #[test]
    fn charts_round_trip() {
        for d in directions() {
            assert!((direction_from_equirect(equirect_from_direction(d)) - d).length() < 1e-12, "{d}");
            assert!((direction_from_octahedral(octahedral_from_direction(d)) - d).length() < 1e-12, "{d}");
        }
    }

    #[test]
    fn the_equirectangular_centre_looks_toward_plus_x_and_the_top_row_up() {
        assert!((equirect_from_direction(DVec3::X) - DVec2::new(0.5, 0.5)).length() < 1e-15);
        assert!((equirect_from_direction(DVec3::Z) - DVec2::new(0.75, 0.5)).length() < 1e-15);
        assert!(equirect_from_direction(DVec3::Y).y.abs() < 1e-15);
    }

    #[test]
    fn bases_are_orthonormal_and_right_handed() {
        for n in directions().chain([DVec3::Z, -DVec3::Z]) {
            let (b1, b2) = orthonormal_basis(n);
            assert!((b1.cross(b2) - n).length() < 1e-12, "{n}");
            assert!(b1.dot(n).abs() < 1e-12 && (b1.length() - 1.0).abs() < 1e-12, "{n}");
        }
    }
}
