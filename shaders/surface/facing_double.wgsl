// The back of a double-sided surface has the opposite normal (glTF 2.0, 3.9.6).
fn face_viewer(n: vec3f, front_facing: bool) -> vec3f {
    return select(-n, n, front_facing);
}
