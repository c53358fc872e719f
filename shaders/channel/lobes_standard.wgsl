#import <components>

// The components whose bits are set, and nothing of the others.
fn chosen_lobes(lobes: Lobes, bits: u32) -> Lobes {
    var chosen = lobes;
    chosen.diffuse *= f32((bits >> COMPONENT_DIFFUSE) & 1u);
    chosen.multiscatter *= f32((bits >> COMPONENT_MULTIPLE_SCATTERING) & 1u);
    let specular = f32((bits >> COMPONENT_SPECULAR) & 1u);
    chosen.specular_share *= specular;
    chosen.single_scatter *= specular;
    return chosen;
}
