//! The lecture's examples, the laws, and what must be refused.

mod lecture;
mod quantities;
mod rectangles;
mod solid_angles;
