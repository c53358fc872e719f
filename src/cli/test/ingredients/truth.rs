//! A picture beside the truth of the same scene and view, by part of the light and by material: both sides are there, so
//! that they can be asked for the same.

use super::seen::Seen;
use super::words::{material, percent, vector};
use super::{Finding, Moved};
use crate::reference::{Estimate, EstimateOptions};
use crate::scene::{RadianceImage, Scene, Term, View};
use glam::{DVec3, UVec2, Vec4};

/// Longest side of the views that are compared: the reference traces every part of the light again.
const SIDE_MAX: u32 = 96;
/// Samples a pixel of the reference.
const SAMPLES: u32 = 32;
/// Less than this of a material's light is not told.
const SAME: f64 = 0.01;
/// The same pixel by pixel, root mean square.
const SAME_RMS: f64 = 0.03;
/// What is nearer to the truth than so many of its standard errors is not told.
const ERRORS: f64 = 4.0;
/// More findings than these are of less and less light.
const MOST: usize = 8;

/// Light of one kind, in the mean over the pixels of each material.
struct Part {
    what: What,
    materials: Vec<Means>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum What {
    Term(Term),
    /// All light with shadows and reflections among surfaces, beside all light without; of the truth alone.
    Bounces(u32),
}

#[derive(Debug, Clone, Copy, Default)]
struct Means {
    drawn: DVec3,
    truth: DVec3,
    /// Standard error of the truth.
    error: DVec3,
    /// Mean squares of the difference, pixel by pixel, and of the standard error of the truth.
    gap_squared: f64,
    noise_squared: f64,
}

impl Means {
    /// Root mean square of the difference, without what the truth's noise has of it; `None` where that is most of it.
    fn rms(&self) -> Option<f64> {
        let is_clear = self.gap_squared > ERRORS * self.noise_squared;
        is_clear.then(|| (self.gap_squared - self.noise_squared).sqrt())
    }

    fn is_in_mean(&self, total: DVec3) -> bool {
        (self.drawn - self.truth).abs().cmpgt((SAME * total).max(ERRORS * self.error)).any()
    }
}

/// The parts on their way.
pub(in crate::cli::test) struct BesideTruth {
    seen: Seen,
    names: Vec<String>,
    parts: Vec<Part>,
}

impl BesideTruth {
    pub(in crate::cli::test) fn new(scene: &Scene, view: &View) -> Self {
        let seen = Seen::of(scene, view);
        let names = (0..seen.materials.len()).map(|place| seen.name(scene, place)).collect();
        Self { seen, names, parts: Vec::new() }
    }

    /// The size of the views for a picture of a size, pixels.
    pub(in crate::cli::test) fn size(picture_px: UVec2) -> UVec2 {
        super::gather::no_larger(picture_px, SIDE_MAX)
    }

    /// How the truth of a part is estimated: what a rasteriser shades, with one sample, are the middles of pixels.
    pub(in crate::cli::test) fn options(asked: EstimateOptions<'_>) -> EstimateOptions<'_> {
        let (relative_error, time) = (None, None);
        EstimateOptions { samples: SAMPLES, relative_error, time, standard_error: true, centers: true, ..asked }
    }

    /// The kinds of light that the scene can have.
    pub(in crate::cli::test) fn terms(scene: &Scene) -> impl Iterator<Item = Term> {
        let (has_lights, is_surrounded) = (!scene.lights_in_world().is_empty(), scene.lit_environment().is_some());
        let can_be =
            move |term: &Term| (has_lights || !term.is_direct()) && (is_surrounded || !term.is_of_environment());
        Term::ALL.into_iter().filter(can_be)
    }

    /// Compares one term, without shadows on either side.
    pub(in crate::cli::test) fn take(&mut self, term: Term, drawn: &RadianceImage, truth: &Estimate) {
        self.part(What::Term(term), drawn, truth);
    }

    /// Takes the truth of all light without shadows and with as many reflections as the case asks for.
    pub(in crate::cli::test) fn take_bounces(&mut self, without: &Estimate, with: &Estimate, bounces: u32) {
        self.part(What::Bounces(bounces), &without.radiance, with);
    }

    fn part(&mut self, what: What, drawn: &RadianceImage, truth: &Estimate) {
        let mut materials = vec![Means::default(); self.names.len()];
        let mut counts = vec![0.0_f64; self.names.len()];
        let value = |texel: Vec4| if texel.w > 0.0 { (texel.truncate() / texel.w).as_dvec3() } else { DVec3::ZERO };
        for (pixel, seen) in self.seen.measured.iter().enumerate() {
            let Some(place) = *seen else { continue };
            let error = truth.standard_error.as_ref().map_or(Vec4::ZERO, |error| error.texels[pixel]);
            let means = &mut materials[place];
            let [drawn, truth] = [drawn.texels[pixel], truth.radiance.texels[pixel]].map(value);
            let error = error.truncate().as_dvec3();
            means.drawn += drawn;
            means.truth += truth;
            means.error += error * error;
            means.gap_squared += drawn.distance_squared(truth);
            means.noise_squared += error.length_squared();
            counts[place] += 1.0;
        }
        for (means, count) in materials.iter_mut().zip(counts) {
            let count = count.max(1.0);
            *means = Means {
                drawn: means.drawn / count,
                truth: means.truth / count,
                error: means.error.map(f64::sqrt) / count,
                gap_squared: means.gap_squared / count,
                noise_squared: means.noise_squared / count,
            };
        }
        self.parts.push(Part { what, materials });
    }

    /// What is not the truth, by how much of the picture's light it is; never nothing.
    pub(in crate::cli::test) fn findings(&self) -> Vec<Finding> {
        let mut found: Vec<(f64, Finding)> = Vec::new();
        for (place, name) in self.names.iter().enumerate() {
            let pixels = self.seen.nearest.iter().filter(|&&seen| seen == Some(place)).count() as f64;
            let terms = self.parts.iter().filter(|part| matches!(part.what, What::Term(_)));
            let total: DVec3 = terms.map(|part| part.materials[place].truth).sum();
            for part in &self.parts {
                let means = part.materials[place];
                let size = match (means.is_in_mean(total), means.rms()) {
                    (true, _) => (means.drawn - means.truth).length(),
                    (false, Some(rms)) if rms > SAME_RMS * total.length() => rms,
                    _ => continue,
                };
                found.push((size * pixels, finding(part.what, name, &means, means.is_in_mean(total))));
            }
        }
        found.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        found.truncate(MOST);
        if found.is_empty() {
            let text = format!(
                "in the mean the light of every material is the truth's, each lobe within {} % or its noise: what is left is \
                 edges and what more samples a pixel make of them, the background, or noise of the truth",
                100.0 * SAME
            );
            return vec![Finding { moved: Moved::Display, material: None, quantities: Vec::new(), text }];
        }
        found.into_iter().map(|(_, finding)| finding).collect()
    }
}

/// The name of the part in reports, as debug views have it.
fn name_of(term: Term) -> &'static str {
    match term {
        Term::Emission => "emissive",
        Term::DirectDiffuse => "direct-diffuse",
        Term::DirectSpecular => "direct-specular",
        Term::EnvironmentDiffuse => "ibl-diffuse",
        Term::EnvironmentSpecular => "ibl-specular",
    }
}

fn finding(what: What, name: &str, means: &Means, is_in_mean: bool) -> Finding {
    let [drawn, truth] = [means.drawn, means.truth].map(|radiance| vector(&radiance.to_array()));
    let share = means.drawn.element_sum() / means.truth.element_sum() - 1.0;
    let noise = means.error.element_sum() / means.truth.element_sum();
    let by = |share: f64, more: &str, less: &str| match share.is_finite() {
        true => format!("{} {}", percent(share.abs()), if share > 0.0 { more } else { less }),
        false => "all of it more".into(),
    };
    let head = material(name);
    let (moved, quantity, text) = match what {
        What::Term(term) => {
            let quantity = name_of(term);
            let noise =
                if noise > 0.0 && noise.is_finite() { format!(" (+- {})", percent(noise)) } else { String::new() };
            let text = match means.rms().filter(|_| !is_in_mean) {
                Some(rms) => {
                    let share = percent(rms / means.truth.length());
                    format!(
                        "{head}: {quantity} differs by about {share} of the truth's {truth} cd/m2 (RMS), not in the mean"
                    )
                }
                None => {
                    let by = by(share, "more", "less");
                    format!("{head}: {quantity} is {drawn} cd/m2, {by} than the truth's {truth}{noise}")
                }
            };
            (Moved::Shading, quantity, text)
        }
        What::Bounces(bounces) => {
            let by = by(means.truth.element_sum() / means.drawn.element_sum() - 1.0, "brighter", "darker");
            let text = format!(
                "{head}: shadows and light from other surfaces make the truth of {bounces} bounces {by}, {truth} instead of \
                 {drawn} cd/m2; pictures have neither"
            );
            (Moved::Lights, "bounces", text)
        }
    };
    Finding { moved, material: Some(name.to_owned()), quantities: vec![quantity.into()], text }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two materials of four pixels each.
    fn beside() -> BesideTruth {
        let seen = || (0..8).map(|pixel| Some(pixel / 4)).collect();
        let seen = Seen { nearest: seen(), measured: seen(), materials: vec![0, 1] };
        BesideTruth { seen, names: vec!["paint".into(), "glass".into()], parts: Vec::new() }
    }

    fn image(paint: f32, glass: f32) -> RadianceImage {
        let texel = |pixel: usize| Vec4::new(1.0, 1.0, 1.0, 0.0) * if pixel < 4 { paint } else { glass } + Vec4::W;
        RadianceImage { width: 4, height: 2, texels: (0..8).map(texel).collect() }
    }

    fn truth(paint: f32, glass: f32, error: f32) -> Estimate {
        let standard_error = Some(image(error, error));
        Estimate { radiance: image(paint, glass), standard_error, relative_error: None, samples: 32 }
    }

    #[test]
    fn the_lobe_that_is_not_the_truth_is_named() {
        let mut beside = beside();
        beside.take(Term::EnvironmentDiffuse, &image(0.502, 0.3), &truth(0.5, 0.3, 1e-4));
        beside.take(Term::EnvironmentSpecular, &image(0.2, 0.5), &truth(0.25, 0.4, 1e-4));
        beside.take(Term::Emission, &image(0.1, 0.0), &truth(0.0, 0.0, 0.0));
        let found = beside.findings();
        let texts: Vec<&str> = found.iter().map(|finding| finding.text.as_str()).collect();
        let expected = [
            "material \"paint\": emissive is 0.100 cd/m2, all of it more than the truth's 0",
            "material \"glass\": ibl-specular is 0.500 cd/m2, 25 % more than the truth's 0.400 (+- 0.01 %)",
            "material \"paint\": ibl-specular is 0.200 cd/m2, 20 % less than the truth's 0.250 (+- 0.02 %)",
        ];
        let mut sorted = texts.clone();
        sorted.sort_unstable();
        let mut all = expected;
        all.sort_unstable();
        assert_eq!(sorted, all);
        assert!(found.iter().all(|finding| finding.moved == Moved::Shading));
    }

    #[test]
    fn noise_is_no_finding_and_shadows_are_one() {
        let mut noisy = beside();
        noisy.take(Term::DirectDiffuse, &image(0.5, 0.5), &truth(0.45, 0.5, 0.1));
        let mut uneven = beside();
        let mut drawn = image(0.5, 0.5);
        drawn.texels[0] += Vec4::new(0.2, 0.2, 0.2, 0.0);
        drawn.texels[1] -= Vec4::new(0.2, 0.2, 0.2, 0.0);
        uneven.take(Term::DirectDiffuse, &drawn, &truth(0.5, 0.5, 1e-3));
        let found = uneven.findings();
        let text = "material \"paint\": direct-diffuse differs by about 28 % of the truth's 0.500 cd/m2 (RMS), not in the mean";
        assert_eq!((found.len(), found[0].text.as_str()), (1, text));
        let found = noisy.findings();
        assert!(found[0].moved == Moved::Display && found[0].text.contains("within 1 %"), "{found:?}");
        noisy.take_bounces(&truth(0.45, 0.5, 0.0), &truth(0.2, 0.5, 0.001), 3);
        let found = noisy.findings();
        assert_eq!((found.len(), found[0].moved), (1, Moved::Lights));
        assert!(
            found[0].text.contains("the truth of 3 bounces 56 % darker, 0.200 instead of 0.450 cd/m2"),
            "{found:?}"
        );
    }
}
