#import "lighting/clamp_sampler.wgsl"

@group(0) @binding(2) var dfg_table: texture_2d<f32>;

const DFG_SIZE: f32 = 128.0;

// Texel centres lie on the end points of sqrt(cosine) and perceptual roughness, which costs a sixteenth of the texels of
// the usual layout.
fn dfg_uv(perceptual_roughness: f32, cos_theta: f32) -> vec2f {
    return (vec2f(sqrt(cos_theta), perceptual_roughness) * (DFG_SIZE - 1.0) + 0.5) / DFG_SIZE;
}

// Split-sum pair and its cosine average: (scale, bias, scale_avg, bias_avg).
fn dfg(perceptual_roughness: f32, cos_theta: f32) -> vec4f {
    return textureSampleLevel(dfg_table, clamp_sampler, dfg_uv(perceptual_roughness, cos_theta), 0.0);
}
