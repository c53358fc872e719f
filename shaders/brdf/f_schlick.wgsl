// The weight of F90 in Schlick's Fresnel: (1 - v.h)^5, by products because pow of a negative is undefined.
fn F_Schlick_weight(VoH: f32) -> f32 {
    let x = saturate(1.0 - VoH);
    let x2 = x * x;
    return x2 * x2 * x;
}

// Fresnel reflectance. Schlick 1994, eq. 15, with a free value at grazing incidence.
fn F_Schlick(F0: vec3f, F90: f32, VoH: f32) -> vec3f {
    return F0 + (F90 - F0) * F_Schlick_weight(VoH);
}

// Cosine average of Schlick's curve, 2 int_0^1 F(x) x dx = F0 + (F90 - F0) / 21.
fn F_Schlick_average(F0: vec3f, F90: f32) -> vec3f {
    return F0 + (F90 - F0) * (1.0 / 21.0);
}
