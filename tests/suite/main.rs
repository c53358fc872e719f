//! One test binary for all that needs the whole crate: each test binary links wgpu.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]
// The examples of embedding share a host.
#![allow(clippy::duplicate_mod)]

mod architecture;
mod backdrop;
mod bench;
mod bench_suite;
mod browser;
mod cache;
mod cli;
mod compare;
mod culling;
mod debug_views;
mod disney;
mod embed;
mod features;
mod frames;
mod golden_suites;
mod goldens;
mod grazing;
mod inspect;
mod lights;
mod lit_plane;
mod lobe_tiers;
mod many_lights;
mod memory;
mod merge_reports;
mod mutants;
mod occlusion;
mod packing;
mod paths;
mod report_fixture;
mod report_page;
mod sequences;
mod shaders;
mod sharding;
mod stability;
mod support;
mod terms;
mod tiers;
mod twins;
#[cfg(feature = "view")]
mod viewer;
