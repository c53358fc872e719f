@group(0) @binding(3) var clamp_sampler: sampler;
