//! What a shader does for each pixel, counted in its intermediate code.

use super::kinds::{Op, Tap};
use naga::valid::{Capabilities, FunctionInfo, ModuleInfo, ValidationFlags, Validator};
use naga::{
    BinaryOperator, Binding, Block, Expression, Function, Handle, MathFunction, Module, SampleLevel, Statement,
    TypeInner,
};
use std::collections::HashMap;

/// Lookups and operations. A loop counts as one turn, a branch as both of its sides; loads from uniforms and
/// buffers, and what a driver leaves out because it is done twice, are not looked at.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::cli) struct Work {
    taps: [f64; Tap::ALL.len()],
    ops: [f64; Op::ALL.len()],
}

impl Work {
    pub(super) fn taps(&self, tap: Tap) -> f64 {
        self.taps[tap as usize]
    }

    pub(super) fn ops(&self, op: Op) -> f64 {
        self.ops[op as usize]
    }

    /// Adds so many times as much as `other`.
    pub(super) fn add(&mut self, other: &Self, times: f64) {
        self.taps.iter_mut().zip(&other.taps).for_each(|(sum, count)| *sum += count * times);
        self.ops.iter_mut().zip(&other.ops).for_each(|(sum, count)| *sum += count * times);
    }

    fn count(&mut self, op: Op, times: f64) {
        self.ops[op as usize] += times;
    }

    /// Additions, multiplications and the like, alone.
    fn simple(&mut self, times: f64) {
        self.count(Op::MultiplyAdd, 0.5 * times);
    }
}

/// The function that is called for each light that reaches a point.
const LIGHT: &str = "radiance_of_light";

/// The work of a fragment shader.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::cli) struct FragmentWork {
    /// Of a pixel, without its punctual lights.
    pub(in crate::cli) pixel: Work,
    /// Of each of these.
    pub(in crate::cli) light: Work,
}

/// The work of the fragment shader of a module; `None` where the module is not valid or has none.
pub(in crate::cli) fn fragment_work(module: &Module) -> Option<FragmentWork> {
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(module).ok()?;
    let index = module.entry_points.iter().position(|entry| entry.stage == naga::ShaderStage::Fragment)?;
    let function = &module.entry_points[index].function;
    let mut counter = Counter { module, info: &info, known: HashMap::new() };
    let mut work = counter.function(function, info.get_entry_point(index));
    // Each component of an attribute: a plane over the picture, and the division by depth taken back.
    let interpolated = function.arguments.iter().map(|argument| interpolated(module, argument.ty, &argument.binding));
    work.simple(5.0 * interpolated.sum::<f64>());
    let light = module.functions.iter().find(|(_, function)| function.name.as_deref() == Some(LIGHT));
    let light = light.map(|(handle, function)| counter.function(function, &info[handle])).unwrap_or_default();
    Some(FragmentWork { pixel: work, light })
}

/// Components that are interpolated for an argument.
fn interpolated(module: &Module, ty: Handle<naga::Type>, binding: &Option<Binding>) -> f64 {
    match (&module.types[ty].inner, binding) {
        (TypeInner::Struct { members, .. }, _) => {
            members.iter().map(|member| interpolated(module, member.ty, &member.binding)).sum()
        }
        (inner, Some(Binding::Location { .. })) => components(inner),
        _ => 0.0,
    }
}

fn components(inner: &TypeInner) -> f64 {
    match inner {
        TypeInner::Vector { size, .. } => f64::from(*size as u8),
        TypeInner::Matrix { columns, rows, .. } => f64::from(*columns as u8) * f64::from(*rows as u8),
        _ => 1.0,
    }
}

struct Counter<'m> {
    module: &'m Module,
    info: &'m ModuleInfo,
    /// Of functions that were met before.
    known: HashMap<Handle<Function>, Work>,
}

impl Counter<'_> {
    fn function(&mut self, function: &Function, info: &FunctionInfo) -> Work {
        let mut work = Work::default();
        self.block(&function.body, (function, info), &mut work);
        work
    }

    fn block(&mut self, block: &Block, of: (&Function, &FunctionInfo), work: &mut Work) {
        for statement in block {
            match statement {
                Statement::Emit(range) => range.clone().for_each(|handle| self.expression(handle, of, work)),
                Statement::Block(block) => self.block(block, of, work),
                Statement::If { accept, reject, .. } => {
                    self.block(accept, of, work);
                    self.block(reject, of, work);
                }
                Statement::Switch { cases, .. } => cases.iter().for_each(|case| self.block(&case.body, of, work)),
                Statement::Loop { body, continuing, .. } => {
                    self.block(body, of, work);
                    self.block(continuing, of, work);
                }
                Statement::Call { function, .. } => {
                    let called = self.called(*function);
                    work.add(&called, 1.0);
                }
                _ => {}
            }
        }
    }

    fn called(&mut self, function: Handle<Function>) -> Work {
        if let Some(known) = self.known.get(&function) {
            return *known;
        }
        let called = &self.module.functions[function];
        let is_light = called.name.as_deref() == Some(LIGHT);
        let work = if is_light { Work::default() } else { self.function(called, &self.info[function]) };
        self.known.insert(function, work);
        work
    }

    fn expression(&self, handle: Handle<Expression>, of: (&Function, &FunctionInfo), work: &mut Work) {
        let (function, _) = of;
        let size = |handle| components(self.inner(handle, of));
        match &function.expressions[handle] {
            Expression::ImageSample { image, level, .. } => {
                let is_mipmapped = !matches!(level, SampleLevel::Zero | SampleLevel::Exact(_));
                work.taps[self.tap(*image, function, is_mipmapped) as usize] += 1.0;
            }
            Expression::ImageLoad { .. } => work.taps[Tap::Load as usize] += 1.0,
            Expression::Binary { op, left, right } => self.binary(*op, handle, (*left, *right), of, work),
            Expression::Math { fun, arg, .. } => math(*fun, size(*arg), work),
            Expression::Select { .. }
            | Expression::Derivative { .. }
            | Expression::Relational { .. }
            | Expression::As { .. } => work.simple(size(handle)),
            // A sign is part of what follows; the rest names things.
            _ => {}
        }
    }

    fn binary(
        &self,
        op: BinaryOperator,
        handle: Handle<Expression>,
        (left, right): (Handle<Expression>, Handle<Expression>),
        of: (&Function, &FunctionInfo),
        work: &mut Work,
    ) {
        let size = components(self.inner(handle, of));
        let is_constant = matches!(of.0.expressions[right], Expression::Literal(_) | Expression::Constant(_));
        match (op, self.inner(left, of), self.inner(right, of)) {
            // As many products a component of the result as the left side has columns, and sums of them.
            (BinaryOperator::Multiply, TypeInner::Matrix { columns, .. }, other) if is_matrix_or_vector(other) => {
                work.simple(size * (2.0 * f64::from(*columns as u8) - 1.0));
            }
            (BinaryOperator::Multiply, TypeInner::Vector { size: rows, .. }, TypeInner::Matrix { .. }) => {
                work.simple(size * (2.0 * f64::from(*rows as u8) - 1.0));
            }
            (BinaryOperator::Divide, ..) if !is_constant => work.count(Op::Divide, size),
            _ => work.simple(size),
        }
    }

    fn inner<'t>(&'t self, handle: Handle<Expression>, (_, info): (&'t Function, &'t FunctionInfo)) -> &'t TypeInner {
        info[handle].ty.inner_with(&self.module.types)
    }

    /// By what the texture holds, which its name and group tell.
    fn tap(&self, image: Handle<Expression>, function: &Function, is_mipmapped: bool) -> Tap {
        let Expression::GlobalVariable(variable) = function.expressions[image] else { return Tap::Half };
        let variable = &self.module.global_variables[variable];
        match variable.name.as_deref().unwrap_or_default() {
            "environment_atlas" | "panorama" => Tap::Half,
            name if name.ends_with("_table") => Tap::Table,
            _ if !is_mipmapped => Tap::Bilinear,
            "base_color_texture" | "emissive_texture" | "specular_color_texture" => Tap::Color,
            "normal_texture" => Tap::Normal,
            _ => Tap::Data,
        }
    }
}

fn is_matrix_or_vector(inner: &TypeInner) -> bool {
    matches!(inner, TypeInner::Matrix { .. } | TypeInner::Vector { .. })
}

/// A function of `size` components.
fn math(fun: MathFunction, size: f64, work: &mut Work) {
    let dot = 2.0 * size - 1.0;
    match fun {
        MathFunction::Dot => work.simple(dot),
        MathFunction::Cross => work.simple(9.0),
        MathFunction::Reflect => work.simple(dot + 2.0 * size + 1.0),
        MathFunction::Length | MathFunction::Distance => {
            work.simple(dot);
            work.count(Op::Sqrt, 1.0);
        }
        MathFunction::Normalize => {
            work.simple(dot + size);
            work.count(Op::InverseSqrt, 1.0);
        }
        MathFunction::Clamp | MathFunction::Saturate | MathFunction::Mix | MathFunction::Fma => work.simple(2.0 * size),
        MathFunction::Sqrt => work.count(Op::Sqrt, size),
        MathFunction::InverseSqrt => work.count(Op::InverseSqrt, size),
        MathFunction::Exp | MathFunction::Exp2 => work.count(Op::Exp2, size),
        MathFunction::Log | MathFunction::Log2 => work.count(Op::Log2, size),
        MathFunction::Pow => work.count(Op::Pow, size),
        MathFunction::Sin | MathFunction::Cos | MathFunction::Tan => work.count(Op::Sine, size),
        MathFunction::Acos | MathFunction::Asin => work.count(Op::ArcCosine, size),
        MathFunction::Atan | MathFunction::Atan2 => work.count(Op::ArcTangent, size),
        _ => work.simple(size),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn work(body: &str) -> Work {
        let text = format!(
            "@group(0) @binding(0) var environment_atlas: texture_2d<f32>;
            @group(0) @binding(1) var lookup: sampler;
            @group(1) @binding(0) var base_color_texture: texture_2d<f32>;
            @group(1) @binding(1) var dfg_table: texture_2d<f32>;
            fn radiance_of_light(x: vec3f) -> vec3f {{ return x * x; }}
            fn twice(x: vec3f) -> vec3f {{ return x + x; }}
            @vertex fn vertex() -> @builtin(position) vec4f {{ return vec4f(0.0); }}
            @fragment fn fragment(@location(0) p: vec3f, @builtin(position) at: vec4f) -> @location(0) vec4f {{ {body} }}"
        );
        let found = fragment_work(&naga::front::wgsl::parse_str(&text).unwrap()).unwrap();
        assert_eq!(2.0 * found.light.ops(Op::MultiplyAdd), 3.0);
        found.pixel
    }

    #[test]
    fn lookups_are_told_apart_by_what_the_texture_holds() {
        let work = work(
            "let a = textureSample(base_color_texture, lookup, p.xy);
            let b = textureSampleLevel(environment_atlas, lookup, p.xy, 0.0);
            let c = textureSampleLevel(dfg_table, lookup, p.xy, 0.0);
            return a + b + c + textureLoad(base_color_texture, vec2i(0), 0);",
        );
        let counts = Tap::ALL.map(|tap| work.taps(tap));
        assert_eq!(counts, [0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn operations_are_counted_by_component_through_calls_branches_and_loops() {
        let of = |body: &str| {
            let (all, nothing) = (work(&format!("{body} return at;")), work("return at;"));
            Op::ALL.map(|op| all.ops(op) - nothing.ops(op))
        };
        let simple = |body: &str| 2.0 * of(body)[Op::MultiplyAdd as usize];
        // Three interpolated components of five operations each.
        assert_eq!(2.0 * work("return at;").ops(Op::MultiplyAdd), 15.0);
        assert_eq!(simple("let x = twice(p) * p;"), 6.0);
        assert_eq!(simple("let x = dot(p, p);"), 5.0);
        assert_eq!(simple("let x = mat3x3f(p, p, p) * p;"), 15.0);
        assert_eq!(simple("var x = p; if at.x > 0.0 { x = twice(x); } else { x = twice(twice(x)); }"), 10.0);
        assert_eq!(simple("var x = p; loop { x = twice(x); if x.x > 1.0 { break; } }"), 4.0);
        // Lights count apart.
        assert_eq!(simple("var x = p; loop { x += radiance_of_light(x); if x.x > 1.0 { break; } }"), 4.0);
        let work = of("let x = normalize(p) / p + pow(p, p);");
        assert_eq!(Op::ALL.map(|op| work[op as usize]), [5.5, 3.0, 0.0, 1.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0]);
    }
}
