//! What surfaces emit into their hemisphere.

use super::geometry::Cosine;
use super::quantity::{Exitance, Radiance};
use super::system::System;
use crate::math::quadrature::GaussLegendre;
use std::f64::consts::PI;

/// Nodes over the cosine; a polynomial in it up to degree 62 is integrated exactly.
const NODES: usize = 32;

/// M = 2 pi int_0^1 L(mu) mu dmu: exitance of a surface whose radiance depends on the cosine to its normal only.
pub fn exitance<S: System>(radiance: impl Fn(Cosine) -> Radiance<S>) -> Exitance<S> {
    let integrand = |mu: f64| radiance(Cosine::raw(mu)).value() * mu;
    Exitance::raw(2.0 * PI * GaussLegendre::new(NODES).integrate(0.0, 1.0, integrand))
}
