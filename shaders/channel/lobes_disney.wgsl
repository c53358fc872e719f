#import <components>

// The components whose bits are set, and nothing of the others.
fn chosen_lobes(lobes: Lobes, bits: u32) -> Lobes {
    var chosen = lobes;
    chosen.diffuse *= f32((bits >> COMPONENT_DIFFUSE) & 1u);
    chosen.specular_share *= f32((bits >> COMPONENT_SPECULAR) & 1u);
    chosen.sheen *= f32((bits >> COMPONENT_SHEEN) & 1u);
    chosen.clearcoat *= f32((bits >> COMPONENT_CLEARCOAT) & 1u);
    return chosen;
}
