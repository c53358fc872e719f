//! Specula: a real-time, physically based glTF renderer on wgpu.

pub mod import;
pub mod math;
pub mod progress;
pub mod scene;
