// Octahedral chart of a unit direction, +Y at the centre; coordinates in [0, 1]^2.
// Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors", listing 1.
fn octahedral_from_direction(direction: vec3f) -> vec2f {
    let d = direction * (1.0 / (abs(direction.x) + abs(direction.y) + abs(direction.z)));
    let sign = select(vec2f(-1.0), vec2f(1.0), d.xz >= vec2f(0.0));
    let folded = select((1.0 - abs(d.zx)) * sign, d.xz, d.y >= 0.0);
    return folded * 0.5 + 0.5;
}
