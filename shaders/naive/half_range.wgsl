// Naive: shown beside the form in use by `specula stability`, and part of no frame.

// What a half-float target makes of two radiances that it has to mix, as a resolve does. Halves end at 65520, from
// where they round to infinity: written out, because pack2x16float leaves its result open there.
fn resolve_halves_naive(a: f32, b: f32, coverage: f32) -> f32 {
    return mix(half_from_float(a), half_from_float(b), coverage);
}

fn half_from_float(x: f32) -> f32 {
    if abs(x) >= 65520.0 {
        return bitcast<f32>(bitcast<u32>(x) & 0x80000000u | 0x7f800000u);
    }
    return unpack2x16float(pack2x16float(vec2f(x, 0.0))).x;
}
