//! Tests of the importer, on small files made in memory and on the sample models.

mod accessors;
mod builder;
mod environments;
mod geometry;
mod hostile;
mod images;
mod instancing;
mod materials;
mod mutants;
mod nodes;
mod resources;
pub(crate) mod samples;
mod tangents;
mod variants;
