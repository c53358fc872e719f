// Unit vector halfway between the unit vectors `l` and `v`; shorter, not infinite, where they are opposed.
fn unit_half_vector(l: vec3f, v: vec3f) -> vec3f {
    let half_vector = l + v;
    return half_vector * inverseSqrt(max(dot(half_vector, half_vector), 1e-12));
}
