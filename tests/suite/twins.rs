//! Every function of the shading model in WGSL against its float64 twin, and proof that none is left out.

use crate::support::gpu;
use specula::gpu::formats::Precision;
use specula::proof::{TWINS, Twin, call, functions_of};
use specula::shader::{SOURCES, ShaderSources, Slots, compose, create_module};
use std::collections::BTreeSet;
use std::f32::consts::{FRAC_1_PI, PI};

/// The folders of `shaders/` whose functions take numbers and give numbers.
const FOLDERS: [&str; 5] = ["brdf/", "lobe/", "light/", "color/", "math/"];

/// The files in [`FOLDERS`].
pub(crate) fn files() -> impl Iterator<Item = &'static str> {
    SOURCES.iter().map(|(path, _)| *path).filter(|path| FOLDERS.iter().any(|folder| path.starts_with(folder)))
}

#[test]
fn every_function_agrees_with_its_twin() {
    let gpu = gpu(Precision::Half);
    let sources = ShaderSources::default();
    let mut failures = Vec::new();
    for twin in TWINS {
        let outcome = twin.measure(&gpu, &sources).unwrap_or_else(|error| panic!("{}: {error}", twin.name()));
        let (comparisons, worst) = (outcome.summary().comparisons, outcome.worst());
        let line = format!("{}: {comparisons} comparisons, worst {worst}", twin.name());
        println!("{line}");
        if comparisons == 0 || worst.error > twin.limit {
            failures.push(format!("{line}; allowed {:.2e}", twin.limit));
        }
    }
    assert!(failures.is_empty(), "on {}:\n{}", gpu.description(), failures.join("\n"));
}

#[test]
fn constants_are_the_floats_nearest_to_what_they_are_named_after() {
    let constants = [("PI", PI), ("INV_PI", FRAC_1_PI)];
    let module = compose(&ShaderSources::default(), "math/constants.wgsl", &Slots::new()).unwrap().parse().unwrap();
    assert_eq!(module.constants.len(), constants.len(), "a constant is not in this test's list");
    for (name, value) in constants {
        let (_, constant) = module.constants.iter().find(|(_, c)| c.name.as_deref() == Some(name)).unwrap();
        let literal = &module.global_expressions[constant.init];
        let naga::Expression::Literal(naga::Literal::F32(got)) = *literal else { panic!("{name} is {literal:?}") };
        assert_eq!(got, value, "{name}");
    }
}

#[test]
fn every_function_has_a_twin_and_every_twin_a_function() {
    let of_file = |file: &'static str| {
        let composed = compose(&ShaderSources::default(), file, &Slots::new()).unwrap();
        functions_of(&composed, file).unwrap().into_iter().map(move |function| (file.to_owned(), function))
    };
    let functions: BTreeSet<_> = files().flat_map(of_file).collect();
    let twins: BTreeSet<_> = TWINS.iter().map(|twin| (twin.file.to_owned(), twin.function.to_owned())).collect();
    assert_eq!(functions.difference(&twins).collect::<Vec<_>>(), Vec::<&(String, String)>::new(), "without a twin");
    assert_eq!(twins.difference(&functions).collect::<Vec<_>>(), Vec::<&(String, String)>::new(), "without a function");
    assert_eq!(twins.len(), TWINS.len(), "two rows for one function");
}

#[test]
fn a_result_that_was_not_written_is_an_infinite_error() {
    let gpu = gpu(Precision::Half);
    let mut sources = ShaderSources::default();
    let writes_every_other = "@group(0) @binding(0) var<storage, read_write> results: array<f32>;\n\
        @compute @workgroup_size(2) fn main(@builtin(local_invocation_index) i: u32) { results[2u * i] = 0.0; }";
    sources.insert("half.wgsl", writes_every_other.to_owned());
    let composed = compose(&sources, "half.wgsl", &Slots::new()).unwrap();
    let results = call(&gpu, &create_module(&gpu.device, "half", &composed).unwrap(), &[], 4).unwrap();
    assert_eq!(results.iter().map(|result| result.is_nan()).collect::<Vec<_>>(), [false, true, false, true]);
    let twin = Twin { truth: |_| vec![0.0], ..TWINS[0] };
    let worst_of = |results: &[f32]| {
        let points = vec![vec![]; results.len()];
        twin.compare(vec![], points, results.to_vec(), 1).unwrap().worst().error
    };
    assert_eq!(worst_of(&results), f64::INFINITY);
    assert_eq!(worst_of(&results[..1]), 0.0);
}
