//! Proof that the shaders compute what the model says: WGSL functions run on the GPU, compared with float64 or searched
//! for faults. `specula stability` writes what is found down, and the tests hold it to limits.

mod call;
mod edge_cases;
mod error;
pub mod formulas;
pub mod fuzz;
mod grid;
pub mod markdown;
pub mod report;
mod rows;
mod signature;
mod sources;
mod stage;
pub mod stress;
mod truth;
mod twin;

pub use call::call;
pub use edge_cases::{EDGE_CASES, EdgeCase, EdgeReport};
pub use error::ProofError;
pub use rows::TWINS;
pub use signature::functions_of;
pub use sources::SOURCES;
pub use twin::{Measurement, Scale, Summary, Twin, Worst};
