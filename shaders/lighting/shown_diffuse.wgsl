// Without what the facets reflect.
fn shown_lobes(lobes: Lobes) -> Lobes {
    var shown = lobes;
    shown.specular_share = 0.0;
    shown.single_scatter = vec3f(0.0);
    shown.multiscatter = vec3f(0.0);
    return shown;
}
