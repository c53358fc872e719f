//! Specula: a real-time, physically based glTF renderer on wgpu.

pub mod math;
pub mod progress;
pub mod scene;
pub mod shader;
