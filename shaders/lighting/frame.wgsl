@group(0) @binding(0) var<uniform> frame: FrameUniform;
@group(0) @binding(1) var<storage, read> instances: array<Instance>;
// Of each drawn instance, which it is.
@group(0) @binding(11) var<storage, read> visible_instances: array<u32>;
