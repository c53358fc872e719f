// AgX, default look (Sobotka 2022), with the sixth-degree fit of its contrast curve by Wrensch 2023, evaluated by Horner.
fn tone_map(exposed: vec3f) -> vec3f {
    const INSET = mat3x3f(
        0.842479062253094, 0.0423282422610123, 0.0423756549057051,
        0.0784335999999992, 0.878468636469772, 0.0784336,
        0.0792237451477643, 0.0791661274605434, 0.879142973793104,
    );
    const OUTSET = mat3x3f(
        1.19687900512017, -0.0528968517574562, -0.0529716355144438,
        -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
        -0.0990297440797205, -0.0989611768448433, 1.15107367264116,
    );
    const MIN_EV: f32 = -12.47393;
    const MAX_EV: f32 = 4.026069;

    let log_encoded = log2(max(INSET * exposed, vec3f(1e-10)));
    let x = saturate((log_encoded - MIN_EV) / (MAX_EV - MIN_EV));
    let contrast = (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
    // The curve ends in display-encoded values; decode with its 2.2 power.
    return pow(saturate(OUTSET * contrast), vec3f(2.2));
}
