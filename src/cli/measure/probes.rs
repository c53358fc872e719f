//! Shaders that do one thing over and over: straight-line code, every step of which the picture depends on.

use super::kinds::{Op, Tap};
use std::fmt::Write;

/// Texels on a side of the texture that is looked up in.
pub(super) const TEXTURE_SIDE: u32 = 1024;

/// `probe` is the uniform (1 / picture side, a little less than 1, a little more than 0, 2): not known to the compiler.
const HEAD: &str = "\
#import \"pass/fullscreen.wgsl\"

@group(0) @binding(0) var<uniform> probe: vec4f;
@group(0) @binding(1) var probed: texture_2d<f32>;
@group(0) @binding(2) var probed_sampler: sampler;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(fullscreen_position(index), 0.5, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
";

fn module(body: &str) -> String {
    format!("{HEAD}{body}}}\n")
}

/// Writes a colour that differs from pixel to pixel, so that no driver takes it for a clear.
pub(super) fn fill() -> String {
    module("    return vec4f(position.xy * probe.x, probe.yz);\n")
}

/// So many lookups, each at a place of its own.
pub(super) fn taps(tap: Tap, count: u32) -> String {
    // Between two levels, and between texels, where all weights are needed.
    let scale = match tap {
        Tap::Color | Tap::Data | Tap::Normal => 1.37,
        _ => 1.0,
    };
    let mut body =
        format!("    let uv = position.xy * (probe.y * {scale} / {TEXTURE_SIDE}.0);\n    var sum = vec4f(probe.z);\n");
    for i in 0..count {
        // Within a few texels of each other, as those of one surface are.
        let [u, v] = [i * 7 % 16, i * 11 % 16].map(|step| (f64::from(step) + 0.3) / f64::from(TEXTURE_SIDE));
        let _ = match tap {
            Tap::Load => {
                let [x, y] = [i * 7 % 16, i * 11 % 16];
                writeln!(body, "    sum += textureLoad(probed, vec2i(position.xy) + vec2i({x}, {y}), 0);")
            }
            Tap::Color | Tap::Data | Tap::Normal => {
                writeln!(body, "    sum += textureSample(probed, probed_sampler, uv + vec2f({u:.8}, {v:.8}));")
            }
            Tap::Bilinear | Tap::Half | Tap::Table => {
                writeln!(
                    body,
                    "    sum += textureSampleLevel(probed, probed_sampler, uv + vec2f({u:.8}, {v:.8}), 0.0);"
                )
            }
        };
    }
    module(&(body + "    return sum;\n"))
}

/// So many operations, in four chains; the count is a multiple of four. With it, multiply-adds that they bring along, each.
pub(super) fn arithmetic(op: Op, count: u32) -> (String, f64) {
    let (step, beside) = match op {
        Op::MultiplyAdd => ("x * probe.yyyy + probe.zzzz", 0.0),
        Op::Divide => ("probe.yyyy / x", 0.0),
        Op::Sqrt => ("sqrt(x)", 0.0),
        Op::InverseSqrt => ("inverseSqrt(x)", 0.0),
        Op::Exp2 => ("exp2(-x)", 0.0),
        Op::Log2 => ("log2(x + probe.wwww)", 0.5),
        Op::Pow => ("pow(x, probe.yyyy)", 0.0),
        Op::Sine => ("sin(x)", 0.0),
        // Within its domain, whatever came before.
        Op::ArcCosine => ("acos(x * 0.5)", 0.5),
        Op::ArcTangent => ("atan2(x, probe.yyyy)", 0.0),
    };
    let steps = format!("    x = {step};\n").repeat(count as usize / 4);
    let start = "    var x = vec4f(position.xy, position.yx * probe.y) * (0.5 * probe.x) + 0.25;\n";
    (module(&format!("{start}{steps}    return x;\n")), beside)
}

/// How many are compared with twice as many: some ten milliseconds of a software driver.
pub(super) fn count_of(op: Op) -> u32 {
    match op {
        Op::MultiplyAdd => 256,
        Op::Divide | Op::Sqrt | Op::InverseSqrt => 64,
        _ => 32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::{ShaderSources, Slots, compose};

    #[test]
    fn probes_are_wgsl_and_do_as_much_as_they_say() {
        let texts = Tap::ALL.map(|tap| taps(tap, 8)).into_iter().chain(Op::ALL.map(|op| arithmetic(op, 8).0));
        for text in texts.chain([fill()]) {
            let mut sources = ShaderSources::default();
            sources.insert("probe.wgsl", text.clone());
            let composed = compose(&sources, "probe.wgsl", &Slots::new()).unwrap();
            composed.parse().unwrap_or_else(|error| panic!("{error}: {text}"));
        }
        assert_eq!(taps(Tap::Color, 8).matches("textureSample(").count(), 8);
        assert_eq!(arithmetic(Op::Pow, 64).0.matches("pow(").count(), 16);
    }
}
