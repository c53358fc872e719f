fn face_viewer(n: vec3f, front_facing: bool) -> vec3f {
    return n;
}
