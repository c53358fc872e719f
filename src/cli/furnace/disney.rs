//! Surfaces with the Disney BRDF.

use super::{Subject, SurfaceKind};
use crate::reference::disney::bsdf::DisneyMaterial;
use crate::scene::disney_grid::ROWS;
use crate::scene::{Disney, Material};

/// Columns of the grid that are checked.
const COLUMNS: u8 = 5;

/// Every row of the Disney grid, from 0 to 1.
pub(super) fn grid() -> Vec<Subject> {
    let cell = |(parameter, material_of): &(&str, fn(f32) -> Material), column: u8| {
        let value = f32::from(column) / f32::from(COLUMNS - 1);
        let material = material_of(value);
        let parameters = material.disney.unwrap_or_default();
        of_material((*parameter).to_owned(), format!("{parameter} {value:.2}"), &material, parameters)
    };
    ROWS.iter().flat_map(|row| (0..COLUMNS).map(move |column| cell(row, column))).collect()
}

/// A Disney material with its factors alone.
pub(super) fn of_material(group: String, label: String, material: &Material, parameters: Disney) -> Subject {
    let surface = DisneyMaterial {
        base_color: material.base_color.truncate().as_dvec3(),
        metallic: material.metallic.into(),
        perceptual_roughness: material.perceptual_roughness.into(),
        parameters,
    };
    Subject { group, label, surface: SurfaceKind::Disney(surface) }
}
