//! Which material each pixel of a view shows.

use crate::reference::inspect::Inspector;
use crate::scene::{Scene, View};
use glam::UVec2;
use rayon::prelude::*;

/// Materials by their place among those that are seen.
#[derive(Debug)]
pub(super) struct Seen {
    /// Of the nearest surface in the middle of each pixel.
    pub(super) nearest: Vec<Option<usize>>,
    /// The same without edges, which show other materials too, unless there is nothing else of a material.
    pub(super) measured: Vec<Option<usize>>,
    /// Those that are seen, by their number in the scene.
    pub(super) materials: Vec<usize>,
}

impl Seen {
    pub(super) fn of(scene: &Scene, view: &View) -> Self {
        let inspector = Inspector::new(scene, view);
        let of_pixel = |pixel: u32| {
            let place = UVec2::new(pixel % view.size_px.x, pixel / view.size_px.x);
            inspector.layers(place).1.first().map(|layer| inspector.material(&layer.hit))
        };
        let found: Vec<Option<usize>> = (0..view.size_px.element_product()).into_par_iter().map(of_pixel).collect();
        let mut materials: Vec<usize> = found.iter().flatten().copied().collect();
        materials.sort_unstable();
        materials.dedup();
        let place = |material: usize| materials.binary_search(&material).ok();
        let nearest: Vec<Option<usize>> = found.into_iter().map(|material| material.and_then(place)).collect();
        let measured = without_edges(&nearest, view.size_px.x as usize, materials.len());
        Self { nearest, measured, materials }
    }

    /// What the scene calls a material that is seen.
    pub(super) fn name(&self, scene: &Scene, place: usize) -> String {
        let index = self.materials[place];
        scene.materials[index].name.clone().unwrap_or_else(|| format!("material {index}"))
    }
}

/// Takes out the pixels that have a neighbour of another material, or none: their samples may show either. A material of
/// which nothing would be left keeps all.
fn without_edges(seen: &[Option<usize>], width: usize, materials: usize) -> Vec<Option<usize>> {
    let height = seen.len() / width.max(1);
    let is_inside = |pixel: usize| {
        let (x, y) = (pixel % width, pixel / width);
        let near = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
        near(y, height).all(|row| near(x, width).all(|column| seen[row * width + column] == seen[pixel]))
    };
    let inside: Vec<Option<usize>> =
        seen.iter().enumerate().map(|(pixel, seen)| seen.filter(|_| is_inside(pixel))).collect();
    let mut has_inside = vec![false; materials];
    inside.iter().flatten().for_each(|&material| has_inside[material] = true);
    let keep =
        |(seen, inside): (&Option<usize>, Option<usize>)| inside.or(seen.filter(|&material| !has_inside[material]));
    seen.iter().zip(inside).map(keep).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_measured_where_there_is_nothing_else() {
        let picture = ["........", ".000011.", ".000011.", ".000...."];
        let material = |c: char| c.to_digit(10).map(|digit| digit as usize);
        let seen: Vec<_> = picture.concat().chars().map(material).collect();
        let kept = without_edges(&seen, 8, 2);
        let pixels = |wanted| (0..seen.len()).filter(|&pixel| kept[pixel] == Some(wanted)).collect::<Vec<_>>();
        assert_eq!((pixels(0), pixels(1)), (vec![18, 26], vec![13, 14, 21, 22]));
    }
}
