#import "proof/inputs.wgsl"
#import "proof/random.wgsl"

struct Fuzz {
    seed: u32,
    first: u32,
    count: u32,
    padding: u32,
}

// What was found. Each `first_` is the smallest evaluation with that fault, or 0xffffffff.
struct Findings {
    evaluations: atomic<u32>,
    lit: atomic<u32>,
    not_a_number: atomic<u32>,
    infinite: atomic<u32>,
    negative: atomic<u32>,
    first_not_a_number: atomic<u32>,
    first_infinite: atomic<u32>,
    first_negative: atomic<u32>,
}

// All that one evaluation was given, and what came out.
struct Case {
    material: MaterialUniform,
    light: Light,
    disney: DisneyUniform,
    texels: array<vec4f, TEXTURE_SLOTS>,
    viewer: vec4f,
    position_in_world: vec4f,
    normal: vec4f,
    tangent: vec4f,
    color: vec4f,
    front_facing: vec4f,
    radiance: vec4f,
    stored: vec4f,
}

@group(1) @binding(0) var<uniform> fuzz: Fuzz;
@group(1) @binding(1) var<storage, read_write> findings: Findings;
@group(1) @binding(2) var<storage, read_write> described: Case;

fn random_material() -> MaterialUniform {
    // KHR_materials_ior: 1 and above, and 0 for an interface that reflects all light.
    let iors = array(0.0, 1.0, 1.5, 1.0 + random_positive());
    let ior = iors[random_choice(4u)];
    let f0 = (ior - 1.0) / (ior + 1.0);
    var m: MaterialUniform;
    m.base_color = vec4f(random_unit(), random_unit(), random_unit(), random_unit());
    m.emissive = select(vec3f(0.0), vec3f(random_positive(), random_positive(), random_positive()), random_choice(4u) == 0u);
    m.metallic = random_unit();
    m.specular_color = vec3f(random_positive(), abs(random_unit()), abs(random_unit()));
    m.specular = random_unit();
    m.perceptual_roughness = random_unit();
    m.dielectric_F0 = f0 * f0;
    m.normal_scale = random_positive() * (f32(random_choice(2u)) * 2.0 - 1.0);
    m.occlusion_strength = random_unit();
    let turn = random_direction().xy;
    m.anisotropy = vec4f(random_unit(), turn, 0.0);
    m.lazanyi_a = vec3f(random_even() * 4.0 - 0.5, random_magnitude(1e-3, 10.0), -random_magnitude(1e-3, 10.0));
    m.conductor_n = vec3f(random_magnitude(1e-3, 1e2), random_magnitude(1e-3, 1e2), 1.0);
    m.conductor_k = vec3f(random_magnitude(1e-6, 1e2), random_even(), 0.0);
    return m;
}

fn random_disney() -> DisneyUniform {
    // Checked when a material is made: in [0, 1], the ends included.
    return DisneyUniform(saturate(random_unit()), saturate(random_unit()), saturate(random_unit()),
        saturate(random_unit()), saturate(random_unit()), saturate(random_unit()), saturate(random_unit()),
        saturate(random_unit()));
}

// A texture holds numbers in [0, 1].
fn random_texel() -> vec4f {
    return saturate(vec4f(random_unit(), random_unit(), random_unit(), random_unit()));
}

fn random_point() -> VertexOut {
    var v: VertexOut;
    v.position_in_world = random_direction() * random_distance();
    v.normal = random_attribute();
    v.tangent = vec4f(random_attribute(), f32(random_choice(2u)) * 2.0 - 1.0);
    v.color = vec4f(random_unit(), random_unit(), random_unit(), random_unit());
    return v;
}

// Toward the viewer, who is at a place (w = 1) or a direction (w = 0).
fn random_viewer(v: VertexOut) -> vec4f {
    let toward = random_relative(v.normal, v.normal);
    if random_choice(2u) == 0u {
        return vec4f(toward, 0.0);
    }
    return vec4f(v.position_in_world + toward * random_distance(), 1.0);
}

// Point, spot or directional, with the numbers that the upload makes of ranges and cones.
fn random_light(v: VertexOut, viewer: vec4f) -> Light {
    let to_viewer = normalize_or(viewer.xyz - v.position_in_world * viewer.w, v.normal);
    let toward = random_relative(to_viewer, v.normal);
    let kind = random_choice(3u);
    let distance = random_distance();
    let range = random_magnitude(1e-18, 1e18);
    let cos_outer = mix(-1.0, 1.0, random_even());
    let cos_inner = mix(cos_outer, 1.0, random_even());
    let axis = random_relative(-toward, v.normal);
    let spot_scale = 1.0 / max(cos_inner - cos_outer, 1e-3);
    var light: Light;
    light.intensity = vec3f(random_positive(), random_positive(), random_positive());
    light.spot_offset = 1.0;
    if kind == 0u {
        light.position = toward;
        return light;
    }
    light.position = v.position_in_world + toward * distance;
    light.w = 1.0;
    light.inverse_range_squared = select(0.0, 1.0 / (range * range), random_choice(2u) == 0u);
    if kind == 1u {
        light.direction = axis;
        light.spot_scale = spot_scale;
        light.spot_offset = -cos_outer * spot_scale;
    }
    return light;
}

// Evaluation `index` of the sequence, through all of the forward shader.
fn evaluate_case(index: u32) -> Case {
    begin_random(fuzz.seed, index);
    let v = random_point();
    let front_facing = random_choice(2u) == 0u;
    material = random_material();
    disney = random_disney();
    for (var slot = 0u; slot < TEXTURE_SLOTS; slot++) {
        texels[slot] = random_texel();
    }
    frame.viewer = random_viewer(v);
    frame.light_count = 1u;
    lights[0] = random_light(v, frame.viewer);
    let point = visible_point(v, front_facing);
    let facing = vec4f(select(0.0, 1.0, front_facing));
    return Case(material, lights[0], disney, texels, frame.viewer, vec4f(v.position_in_world, 1.0), vec4f(v.normal, 0.0),
        v.tangent, v.color, facing, point, stored_point(point));
}

// By bit patterns: a compiler may take it for granted that no number is NaN or infinite.
fn magnitudes(x: vec4f) -> vec4u {
    return bitcast<vec4u>(x) & vec4u(0x7fffffffu);
}

const INFINITY_BITS: u32 = 0x7f800000u;

const EVALUATIONS_EACH: u32 = 16u;

var<workgroup> lit: atomic<u32>;
var<workgroup> done: atomic<u32>;

@compute @workgroup_size(64)
fn search(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    for (var i = 0u; i < EVALUATIONS_EACH; i++) {
        let offset = id.x * EVALUATIONS_EACH + i;
        if offset >= fuzz.count {
            break;
        }
        judge(fuzz.first + offset);
    }
    workgroupBarrier();
    if local == 0u {
        atomicAdd(&findings.evaluations, atomicLoad(&done));
        atomicAdd(&findings.lit, atomicLoad(&lit));
    }
}

fn judge(index: u32) {
    let it = evaluate_case(index);
    let stored = magnitudes(it.stored);
    atomicAdd(&done, 1u);
    if any(it.stored.xyz > vec3f(0.0)) {
        atomicAdd(&lit, 1u);
    }
    // Faults are rare: they go to memory directly. What is stored may be infinite before it is clamped, but a clamp
    // hides what is no number on some devices.
    if any(magnitudes(it.radiance) > vec4u(INFINITY_BITS)) || any(stored > vec4u(INFINITY_BITS)) {
        atomicAdd(&findings.not_a_number, 1u);
        atomicMin(&findings.first_not_a_number, index);
    }
    if any(stored == vec4u(INFINITY_BITS)) {
        atomicAdd(&findings.infinite, 1u);
        atomicMin(&findings.first_infinite, index);
    }
    // The sign bit of a number that is not zero.
    if any((bitcast<vec4u>(it.stored) > vec4u(0x80000000u)) & (stored <= vec4u(INFINITY_BITS))) {
        atomicAdd(&findings.negative, 1u);
        atomicMin(&findings.first_negative, index);
    }
}

@compute @workgroup_size(1)
fn describe() {
    described = evaluate_case(fuzz.first);
}
