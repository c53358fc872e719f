#import "lighting/clamp_sampler.wgsl"

// Directional albedos of the Disney lobes, as `bake::disney` lays them out: tiles above one another, each over
// sqrt(NoV) and a parameter of the lobe, with the end points on texel centres.
const DISNEY_SIDE: f32 = 32.0;
const DISNEY_LAYERS: f32 = 8.0;
const DISNEY_TILES: f32 = 4.0 * DISNEY_LAYERS + 1.0;
// ln 10: layers are even in the logarithm of 1 - 0.9 anisotropic, down to 0.1.
const LN_10: f32 = 2.302585092994046;

fn disney_texel(tile: f32, parameter: f32, cos_theta: f32) -> vec4f {
    let texel = vec2f(sqrt(cos_theta), parameter) * (DISNEY_SIDE - 1.0) + 0.5;
    let uv = (texel + vec2f(0.0, tile * DISNEY_SIDE)) / vec2f(DISNEY_SIDE, DISNEY_SIDE * DISNEY_TILES);
    return textureSampleLevel(disney_table, clamp_sampler, uv, 0.0);
}

// The texels of two layers, mixed. `tile` counts within a layer.
fn disney_layered(tile: f32, layer: f32, perceptual_roughness: f32, NoV: f32) -> vec4f {
    let lower = clamp(floor(layer), 0.0, DISNEY_LAYERS - 2.0);
    let below = disney_texel(4.0 * lower + tile, perceptual_roughness, NoV);
    let above = disney_texel(4.0 * lower + 4.0 + tile, perceptual_roughness, NoV);
    return mix(below, above, layer - lower);
}

// Split-sum pair of the specular lobe: its albedo is F0 x + y. `cos_2phi` is of the
// view's azimuth from the tangent. A series of cosines of 2, 4, 6... times the azimuth, relative to the mean, whose
// root comes first: the lobe falls toward grazing angles as NoV squared.
fn E_disney_specular(perceptual_roughness: f32, anisotropic: f32, NoV: f32, cos_2phi: f32) -> vec2f {
    let layer = -log(1.0 - 0.9 * anisotropic) * ((DISNEY_LAYERS - 1.0) / LN_10);
    let first = disney_layered(0.0, layer, perceptual_roughness, NoV);
    let second = disney_layered(1.0, layer, perceptual_roughness, NoV);
    let third = disney_layered(2.0, layer, perceptual_roughness, NoV);
    let fourth = disney_layered(3.0, layer, perceptual_roughness, NoV);

    // Chebyshev polynomials: T_k(cos 2 phi) = cos 2 k phi.
    let c = cos_2phi;
    let T2 = 2.0 * c * c - 1.0;
    let T3 = 2.0 * c * T2 - c;
    let T4 = 2.0 * T2 * T2 - 1.0;
    let T5 = 2.0 * c * T4 - T3;
    let T6 = 2.0 * T3 * T3 - 1.0;
    let T7 = 2.0 * c * T6 - T5;
    let low = vec3f(c, T2, T3) * 3.0;
    let high = vec4f(T4, T5, T6, T7) * 3.0;
    let scale = 1.0 + dot(first.yzw - 0.5, low) + dot(second - 0.5, high);
    let bias = 1.0 + dot(third.yzw - 0.5, low) + dot(fourth - 0.5, high);
    return vec2f(first.x * first.x, third.x * third.x) * max(vec2f(scale, bias), vec2f(0.0));
}

// Albedos for base colour 1 of Fd_Burley and Fd_Subsurface, and of the sheen.
fn E_disney_smooth(perceptual_roughness: f32, NoV: f32) -> vec3f {
    let texel = disney_texel(DISNEY_TILES - 1.0, perceptual_roughness, NoV);
    return vec3f(texel.xy * 2.0, texel.z * texel.z);
}

// Albedo of the clearcoat for weight 1, Fresnel factor included.
fn E_disney_clearcoat(clearcoat_gloss: f32, NoV: f32) -> f32 {
    let root = disney_texel(DISNEY_TILES - 1.0, clearcoat_gloss, NoV).w;
    return root * root;
}
