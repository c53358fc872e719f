@group(0) @binding(4) var<storage, read> lights: array<Light>;
