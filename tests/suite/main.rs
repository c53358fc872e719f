//! One test binary for all that needs the whole crate: each test binary links wgpu.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod frames;
mod lights;
mod support;
