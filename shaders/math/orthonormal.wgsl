// A unit vector across the unit vector `n`, without a branch on its direction. Duff et al. 2017, "Building an
// Orthonormal Basis, Revisited", listing 3, the first of the two.
fn any_orthonormal(n: vec3f) -> vec3f {
    let sign = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (sign + n.z);
    return vec3f(1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x);
}
