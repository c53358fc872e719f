@group(0) @binding(4) var<uniform> lights: array<Light, 64>;
