// Without what comes from below the surface, and without sheen.
fn shown_lobes(lobes: Lobes) -> Lobes {
    var shown = lobes;
    shown.diffuse = vec3f(0.0);
    shown.sheen = vec3f(0.0);
    return shown;
}
