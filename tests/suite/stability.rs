//! Numbers at the ends of what f32 can hold: the shaders stay finite, and keep the digits that docs/stability.md shows.

use crate::support::gpu;
use specula::gpu::formats::Precision;
use specula::progress::Silent;
use specula::proof::formulas::{self, FORMULAS, Place};
use specula::proof::fuzz::{FUZZED, FuzzOptions, ShaderFindings, fuzz, search};
use specula::proof::markdown::{self, structure};
use specula::proof::report::StabilityReport;
use specula::proof::stress::{D_CHORD, SPECULAR_LOBE};
use specula::shader::ShaderSources;

#[test]
fn nothing_that_is_stored_is_nan_infinite_or_negative() {
    let gpu = gpu(Precision::Half);
    let options = FuzzOptions { evaluations: 1 << 20, seed: 1 };
    let found = fuzz(&gpu, &ShaderSources::default(), options, |_| {}).unwrap();
    for shader in &found {
        println!("{}: {} evaluations, {} lit", shader.shader, shader.evaluations, shader.lit);
        for fault in &shader.faults {
            if let Some(first) = &fault.first {
                println!("  {} {}: {first}", fault.count, fault.kind);
            }
        }
        // Measured 0.4 and above; the search would find nothing in the dark.
        assert!(shader.lit > shader.evaluations / 5, "{} is dark", shader.shader);
    }
    assert!(found.iter().map(|shader| shader.evaluations).sum::<u64>() >= options.evaluations);
    assert!(found.iter().all(ShaderFindings::is_clean), "on {}", gpu.description());
}

/// Guards whose removal the search has to notice: file, guard, what stands there without it.
const GUARDS: &[(&str, &str, &str)] = &[
    ("math/vectors.wgsl", "v * (1.0 / max(largest, LENGTH_MIN))", "v"),
    ("math/vectors.wgsl", "largest > LENGTH_MIN && largest < LENGTH_MAX", "true"),
    ("math/half_range.wgsl", "min(radiance, vec3f(HALF_MAX))", "radiance"),
    ("light/attenuation.wgsl", "DISTANCE_SQUARED_MAX)", "distance_squared)"),
    ("light/attenuation.wgsl", "DISTANCE_SQUARED_MIN: f32 = 1e-4", "DISTANCE_SQUARED_MIN: f32 = 0.0"),
    ("lighting/lift_view.wgsl", "NOV_MIN: f32 = 1e-4", "NOV_MIN: f32 = 0.0"),
    ("lighting/lobes.wgsl", "ALPHA_MIN: f32 = 1e-3", "ALPHA_MIN: f32 = 0.0"),
    (
        "lighting/half_vector.wgsl",
        "inverseSqrt(max(dot(half_vector, half_vector), 1e-12))",
        "inverseSqrt(dot(half_vector, half_vector))",
    ),
    ("lighting/lobes.wgsl", "saturate(dot(lobes.n, l))", "dot(lobes.n, l)"),
    ("surface/surface.wgsl", "saturate(base_color.xyz)", "base_color.xyz"),
    (
        "surface/dielectric.wgsl",
        "saturate(material.specular * specular_texel(v).w)",
        "material.specular * specular_texel(v).w",
    ),
    ("surface/occlusion.wgsl", "saturate(1.0 + material.occlusion", "(1.0 + material.occlusion"),
    (
        "surface/reflecting.wgsl",
        "saturate(material.metallic * metallic_roughness.z)",
        "material.metallic * metallic_roughness.z",
    ),
    ("surface/alpha_blend.wgsl", "saturate(alpha)", "alpha"),
];

#[test]
fn the_search_notices_every_guard_that_is_taken_away() {
    let gpu = gpu(Precision::Half);
    // Of those in FUZZED the one that has all of the guards.
    let blended = FUZZED.iter().find(|shader| shader.name.starts_with("blended")).unwrap();
    let mut unnoticed = Vec::new();
    for (file, guard, without) in GUARDS {
        let mut sources = ShaderSources::default();
        let text = sources.get(file).unwrap().to_owned();
        assert_eq!(text.matches(guard).count(), 1, "{file}: `{guard}` has to stand there once");
        sources.insert(file, text.replacen(guard, without, 1));
        let found = search(&gpu, &sources, blended, 1 << 16, 1, &mut |_| {}).unwrap();
        println!("{file} without `{guard}`: NaN, infinite, negative {:?}", found.faults.each_ref().map(|f| f.count));
        if found.is_clean() {
            unnoticed.push(format!("{file}: `{guard}`"));
        }
    }
    assert!(unnoticed.is_empty(), "not noticed:\n{}", unnoticed.join("\n"));
}

#[test]
fn the_specular_lobe_keeps_its_digits() {
    let gpu = gpu(Precision::Half);
    let report = SPECULAR_LOBE.run(&gpu, &ShaderSources::default()).unwrap();
    let groups = &report.forms[0].groups;
    println!("{groups:#?}");
    for (group, limit) in groups.iter().zip([2e-3, 2e-4, 2e-5, 2e-6]) {
        assert!(group.comparisons > 1000 && group.not_finite == 0 && group.p99 <= limit, "{group:?}: {limit}");
    }
    let report = D_CHORD.run(&gpu, &ShaderSources::default()).unwrap();
    println!("{:#?}", report.forms[0].groups);
    assert!(report.forms[0].groups.iter().all(|group| group.comparisons > 1000 && group.worst <= 2e-6));
    for naive in &report.forms[1..] {
        assert!(naive.groups[0].worst > 1e-4, "{} is no worse than the form in use", naive.function);
    }
}

/// A small report of this device: structure does not depend on how far the search goes.
fn report() -> StabilityReport {
    let options = FuzzOptions { evaluations: 1 << 12, seed: 1 };
    StabilityReport::measure(&gpu(Precision::Half), options, &Silent).unwrap()
}

#[test]
fn the_committed_documents_have_a_row_for_everything() {
    let report = report();
    assert_eq!(report.offences(), Vec::<String>::new());
    let documents =
        [("docs/stability.md", markdown::stability(&report)), ("docs/brdf.md", formulas::document(&report))];
    for (path, text) in documents {
        let committed = std::fs::read_to_string(path).unwrap();
        assert!(text.lines().count() > 50, "{path} is empty");
        assert_eq!(structure(&committed), structure(&text), "{path}: run `specula stability --write docs`");
    }
}

#[test]
fn every_place_in_the_table_of_formulas_exists() {
    let formulas = FORMULAS.iter().flat_map(|(_, formulas)| formulas.iter());
    let places =
        formulas.flat_map(|formula| [formula.rust].into_iter().chain(formula.wgsl).chain(formula.laws.iter().copied()));
    let missing = |place: &Place| {
        let text = std::fs::read_to_string(place.file).unwrap_or_default();
        let declared = |end: char| text.contains(&format!("fn {}{end}", place.function));
        !declared('(') && !declared('<')
    };
    let missing: Vec<String> =
        places.filter(missing).map(|place| format!("{} in {}", place.function, place.file)).collect();
    assert_eq!(missing, Vec::<String>::new());
}

#[test]
fn an_offence_is_found_in_a_report() {
    let mut report = report();
    report.functions[0].errors.worst = 1.0;
    report.edge_cases[0].error = f64::INFINITY;
    report.fuzz.shaders[0].faults[0].count = 1;
    report.stresses[0].forms[0].groups[0].not_finite = 1;
    let offences = report.offences();
    assert_eq!(offences.len(), 4, "{offences:?}");
}
