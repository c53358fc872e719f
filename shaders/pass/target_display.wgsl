#import <tone_map>
#import <encode>
#import <exposure>

// The target holds display light, multiplied with coverage: the tone map sees the colour of the covered part.
fn target_value(stored: vec4f) -> vec4f {
    let straight = stored.xyz * (1.0 / max(stored.w, 1e-4));
    return vec4f(encode(tone_map(straight * exposure())) * stored.w, stored.w);
}
