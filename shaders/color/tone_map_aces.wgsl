// ACES RRT + ODT as a rational fit (Hill 2016): input matrix sRGB -> AP1 with RRT saturation, curve, output matrix back.
// Exposed by 1/0.6 first, as is customary.
fn tone_map(exposed: vec3f) -> vec3f {
    const INPUT = mat3x3f(
        0.59719, 0.07600, 0.02840,
        0.35458, 0.90834, 0.13383,
        0.04823, 0.01566, 0.83777,
    );
    const OUTPUT = mat3x3f(
        1.60475, -0.10208, -0.00327,
        -0.53108, 1.10813, -0.07276,
        -0.07367, -0.00605, 1.07602,
    );
    // The curve is flat long before 1e4; beyond 1e18 its squares would overflow.
    let x = INPUT * (min(exposed, vec3f(1e4)) / 0.6);
    let fitted = (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
    return saturate(OUTPUT * fitted);
}
