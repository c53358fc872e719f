// Without what the facets and the clearcoat reflect.
fn shown_lobes(lobes: Lobes) -> Lobes {
    var shown = lobes;
    shown.specular_share = 0.0;
    shown.clearcoat = 0.0;
    return shown;
}
