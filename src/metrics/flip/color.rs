//! The colour spaces that FLIP passes through, for a display with Rec.709 primaries.

use glam::{DMat3, DVec2, DVec3};

/// Chromaticities x, y of red, green, blue and white (ITU-R BT.709-6, table 1, items 1.3 and 1.4).
const PRIMARIES: [DVec2; 3] = [DVec2::new(0.64, 0.33), DVec2::new(0.30, 0.60), DVec2::new(0.15, 0.06)];
const WHITE: DVec2 = DVec2::new(0.3127, 0.3290);

/// Weight of chroma in the Hunt adjustment: colours of dark pixels are seen less.
const HUNT: f64 = 0.01;

/// Below this ratio CIELAB's cube root is replaced by a line (CIE 15).
const LAB_DELTA: f64 = 6.0 / 29.0;

/// Conversions between linear Rec.709, CIE XYZ relative to white, and what is made of that.
#[derive(Debug)]
pub(super) struct ColorSpaces {
    /// XYZ divided by that of white, so that white is (1, 1, 1).
    relative_xyz_from_linear: DMat3,
    linear_from_relative_xyz: DMat3,
}

impl ColorSpaces {
    pub(super) fn rec709() -> Self {
        let xyz = |xy: DVec2| DVec3::new(xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y);
        let primaries = DMat3::from_cols(xyz(PRIMARIES[0]), xyz(PRIMARIES[1]), xyz(PRIMARIES[2]));
        let white = xyz(WHITE);
        // As much of each primary as makes white.
        let amounts = primaries.inverse() * white;
        let matrix = DMat3::from_diagonal(white.recip()) * primaries * DMat3::from_diagonal(amounts);
        Self { relative_xyz_from_linear: matrix, linear_from_relative_xyz: matrix.inverse() }
    }

    /// Opponent space that is linear in light: luminance, red-green, blue-yellow.
    pub(super) fn ycxcz_from_linear(&self, linear: DVec3) -> DVec3 {
        let xyz = self.relative_xyz_from_linear * linear;
        DVec3::new(116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z))
    }

    /// Inverse of [`Self::ycxcz_from_linear`].
    pub(super) fn linear_from_ycxcz(&self, ycxcz: DVec3) -> DVec3 {
        let y = (ycxcz.x + 16.0) / 116.0;
        self.linear_from_relative_xyz * DVec3::new(y + ycxcz.y / 500.0, y, y - ycxcz.z / 200.0)
    }

    /// CIELAB (CIE 15).
    pub(super) fn lab_from_linear(&self, linear: DVec3) -> DVec3 {
        let f = |t: f64| {
            if t > LAB_DELTA.powi(3) { t.cbrt() } else { t / (3.0 * LAB_DELTA * LAB_DELTA) + 4.0 / 29.0 }
        };
        let [x, y, z] = (self.relative_xyz_from_linear * linear).to_array().map(f);
        DVec3::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
    }
}

/// Scales chroma by lightness.
pub(super) fn hunt_adjusted(lab: DVec3) -> DVec3 {
    DVec3::new(lab.x, HUNT * lab.x * lab.y, HUNT * lab.x * lab.z)
}

/// Colour distance for large differences: lightness by absolute value, chroma by length (Abasi et al. 2020).
pub(super) fn hyab(a: DVec3, b: DVec3) -> f64 {
    let difference = a - b;
    difference.x.abs() + difference.y.hypot(difference.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_colours() {
        let spaces = ColorSpaces::rec709();
        assert!((spaces.lab_from_linear(DVec3::ONE) - DVec3::new(100.0, 0.0, 0.0)).length() < 1e-9);
        assert!(spaces.lab_from_linear(DVec3::ZERO).length() < 1e-9);
        // Published CIELAB of sRGB red under D65: 53.24, 80.09, 67.20, rounded to two digits.
        assert!((spaces.lab_from_linear(DVec3::X) - DVec3::new(53.24, 80.09, 67.20)).length() < 0.02);
        let color = DVec3::new(0.2, 0.7, 0.1);
        assert!((spaces.linear_from_ycxcz(spaces.ycxcz_from_linear(color)) - color).length() < 1e-12);
    }
}
