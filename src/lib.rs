//! Specula: a real-time, physically based glTF renderer on wgpu.

#[cfg(feature = "cli")]
pub mod app;
pub mod bake;
#[cfg(feature = "disk-cache")]
pub mod cache;
pub mod capture;
#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "cli")]
mod clock;
pub mod embed;
pub mod frame;
pub mod gpu;
pub mod gpu_scene;
pub mod import;
pub mod math;
pub mod metrics;
#[cfg(feature = "cli")]
mod output;
#[cfg(feature = "cli")]
mod parallel;
pub mod passes;
pub mod progress;
#[cfg(feature = "cli")]
pub mod proof;
pub mod radiometry;
pub mod reference;
pub mod renderer;
pub mod scene;
pub mod shader;
mod threads;

pub use {glam, wgpu};

#[cfg(doctest)]
#[doc = include_str!("../docs/embedding.md")]
struct EmbeddingExamples;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
