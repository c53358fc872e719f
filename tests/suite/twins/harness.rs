//! Runs one WGSL function on the GPU over a grid of arguments and compares it with its float64 twin.

use naga::{Function, Module, TypeInner};
use specula::gpu::Gpu;
use specula::shader::{Composed, ShaderError, ShaderSources, Slots, compose, create_module};
use std::fmt;
use wgpu::util::DeviceExt;

/// One WGSL function, what it is compared with, and where.
#[derive(Clone, Copy)]
pub(crate) struct Twin {
    pub(crate) file: &'static str,
    pub(crate) function: &'static str,
    /// The arguments of every call, components of vectors and arrays in a row.
    pub(crate) grid: fn() -> Vec<Vec<f32>>,
    /// The components of the true result at one point of the grid.
    pub(crate) truth: fn(&[f64]) -> Vec<f64>,
    pub(crate) scale: Scale,
    /// Largest error allowed, in units of the scale.
    pub(crate) limit: f64,
}

/// What an error is measured against.
#[derive(Clone, Copy)]
pub(crate) enum Scale {
    /// The true result: relative error, for products and sums that cannot cancel.
    Result,
    /// 1: absolute error, for what ends on a display or in a texture coordinate.
    One,
    /// The largest term of a sum that may cancel, from the arguments.
    Terms(fn(&[f64]) -> f64),
}

/// The point of a grid where a function is farthest from its twin.
#[derive(Debug, Clone, Default)]
pub(crate) struct Worst {
    /// In units of the scale; infinite for a result that is no number.
    pub(crate) error: f64,
    arguments: Vec<(String, f32)>,
    component: usize,
    got: f32,
    expected: f64,
}

#[derive(Debug, Clone)]
pub(crate) struct Outcome {
    pub(crate) comparisons: usize,
    pub(crate) worst: Worst,
}

/// A NaN that no arithmetic makes: what a cell holds that no invocation wrote.
const UNWRITTEN: u32 = 0xffff_dead;

impl Twin {
    pub(crate) fn name(&self) -> String {
        format!("{} {}", self.file, self.function)
    }

    /// A compute module that calls the function once a grid point.
    pub(crate) fn compose(&self, sources: &ShaderSources) -> Result<Composed, ShaderError> {
        let alone = compose(sources, self.file, &Slots::new())?.parse()?;
        let mut sources = sources.clone();
        let root = format!("#import \"{}\"\n{}", self.file, caller(&alone, find(&alone, self.function)));
        sources.insert("twin.wgsl", root);
        compose(&sources, "twin.wgsl", &Slots::new())
    }

    /// Calls the function at every point and compares.
    pub(crate) fn run(&self, gpu: &Gpu, sources: &ShaderSources) -> Result<Outcome, ShaderError> {
        let composed = self.compose(sources)?;
        let module = composed.parse()?;
        let function = find(&module, self.function);
        let names = argument_names(&module, function);
        let grid = (self.grid)();
        assert!(!grid.is_empty(), "{}: the grid is empty", self.name());
        for point in &grid {
            assert_eq!(point.len(), names.len(), "{}: arguments of a grid point", self.name());
        }
        let width = components(&module, function.result.as_ref().map(|result| result.ty));
        let shader = create_module(&gpu.device, &self.name(), &composed)?;
        let results = call(gpu, &shader, &grid.concat(), grid.len() * width);
        Ok(self.compare(&names, &grid, &results, width))
    }

    pub(super) fn compare(&self, names: &[String], grid: &[Vec<f32>], results: &[f32], width: usize) -> Outcome {
        let mut outcome = Outcome { comparisons: 0, worst: Worst { error: -1.0, ..Default::default() } };
        for (point, results) in grid.iter().zip(results.chunks_exact(width)) {
            let exact: Vec<f64> = point.iter().copied().map(f64::from).collect();
            let truth = (self.truth)(&exact);
            assert_eq!(truth.len(), width, "{}: components of the twin", self.name());
            for (component, (&got, &expected)) in results.iter().zip(&truth).enumerate() {
                assert!(expected.is_finite(), "{}: the twin gives {expected} at {point:?}", self.name());
                outcome.comparisons += 1;
                let error = self.error(&exact, got, expected);
                if error > outcome.worst.error {
                    let arguments = names.iter().cloned().zip(point.iter().copied()).collect();
                    outcome.worst = Worst { error, arguments, component, got, expected };
                }
            }
        }
        outcome
    }

    fn error(&self, arguments: &[f64], got: f32, expected: f64) -> f64 {
        let difference = (f64::from(got) - expected).abs();
        let scale = match self.scale {
            Scale::Result => expected.abs(),
            Scale::One => 1.0,
            Scale::Terms(terms) => terms(arguments),
        };
        match (got.is_finite(), difference) {
            (false, _) => f64::INFINITY,
            // Shaders may flush what is below the smallest normal number to zero.
            (true, difference) if difference < f64::from(f32::MIN_POSITIVE) => 0.0,
            (true, difference) => difference / scale,
        }
    }
}

impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let in_eps = self.error / f64::from(f32::EPSILON);
        write!(f, "{:.2e} of the scale ({in_eps:.2} eps) at ", self.error)?;
        // Of an array of coefficients, those that take part.
        let told = |value: f32| value != 0.0 || self.arguments.len() <= 8;
        for (name, value) in self.arguments.iter().filter(|(_, value)| told(*value)) {
            write!(f, "{name} = {value:e}, ")?;
        }
        let got = if self.got.to_bits() == UNWRITTEN { "nothing".to_owned() } else { format!("{:e}", self.got) };
        write!(f, "component {}: got {got}, expected {:e}", self.component, self.expected)?;
        let relative = (f64::from(self.got) - self.expected).abs() / self.expected.abs();
        if self.expected == 0.0 { Ok(()) } else { write!(f, ", relative {relative:.2e}") }
    }
}

/// The names of the functions that `composed` takes from `file`.
pub(crate) fn functions_of(composed: &Composed, file: &str) -> Vec<String> {
    let module = composed.parse().unwrap();
    let from_file = |handle| {
        let line = module.functions.get_span(handle).location(&composed.text).line_number as usize;
        composed.origin(line).is_some_and(|(origin, _)| origin == file)
    };
    let functions = module.functions.iter().filter(|(handle, _)| from_file(*handle));
    functions.filter_map(|(_, function)| function.name.clone()).collect()
}

fn find<'m>(module: &'m Module, name: &str) -> &'m Function {
    let mut functions = module.functions.iter().map(|(_, function)| function);
    functions.find(|function| function.name.as_deref() == Some(name)).unwrap_or_else(|| panic!("no function {name}"))
}

/// An entry point that unpacks the arguments, calls `function` and writes the components of its result.
fn caller(module: &Module, function: &Function) -> String {
    let mut read = 0;
    let arguments: Vec<String> =
        function.arguments.iter().map(|argument| unpack(module, argument.ty, &mut read)).collect();
    let width = components(module, function.result.as_ref().map(|result| result.ty));
    let writes = (0..width).map(|component| {
        let swizzle = if width == 1 { "" } else { [".x", ".y", ".z", ".w"][component] };
        format!("    results[{width}u * id.x + {component}u] = result{swizzle};\n")
    });
    let declaration = "@group(0) @binding(1) var<storage, read> arguments: array<f32>;\n";
    format!(
        "@group(0) @binding(0) var<storage, read_write> results: array<f32>;\n{}\
         @compute @workgroup_size(64)\n\
         fn main(@builtin(global_invocation_id) id: vec3u) {{\n\
         \x20   if id.x >= arrayLength(&results) / {width}u {{ return; }}\n\
         \x20   let first = {read}u * id.x;\n\
         \x20   let result = {}({});\n{}}}\n",
        if read > 0 { declaration } else { "" },
        function.name.as_deref().unwrap_or_default(),
        arguments.join(", "),
        writes.collect::<String>(),
    )
}

/// The expression that reads a value of type `ty` from the argument buffer, from its `read`th float on.
fn unpack(module: &Module, ty: naga::Handle<naga::Type>, read: &mut usize) -> String {
    let mut list = |count: usize, part: &mut dyn FnMut(&mut usize) -> String| {
        (0..count).map(|_| part(read)).collect::<Vec<_>>().join(", ")
    };
    let mut scalar = |read: &mut usize| {
        *read += 1;
        format!("arguments[first + {}u]", *read - 1)
    };
    match module.types[ty].inner {
        TypeInner::Scalar(naga::Scalar::F32) => scalar(read),
        TypeInner::Vector { size, scalar: naga::Scalar::F32 } => {
            format!("vec{}f({})", size as u8, list(size as usize, &mut scalar))
        }
        TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
            format!("array({})", list(count.get() as usize, &mut |read| unpack(module, base, read)))
        }
        ref other => panic!("no twin takes a {other:?} yet"),
    }
}

/// How many floats a value consists of.
fn components(module: &Module, ty: Option<naga::Handle<naga::Type>>) -> usize {
    match ty.map(|ty| &module.types[ty].inner) {
        Some(TypeInner::Scalar(naga::Scalar::F32)) => 1,
        Some(TypeInner::Vector { size, scalar: naga::Scalar::F32 }) => *size as usize,
        Some(TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. }) => {
            count.get() as usize * components(module, Some(*base))
        }
        other => panic!("no twin has a {other:?} yet"),
    }
}

/// A name for every float of the argument buffer: `alpha`, `n.x`, `coefficients[2].y`.
fn argument_names(module: &Module, function: &Function) -> Vec<String> {
    let mut names = Vec::new();
    for argument in &function.arguments {
        name_parts(module, argument.ty, argument.name.clone().unwrap_or_default(), &mut names);
    }
    names
}

fn name_parts(module: &Module, ty: naga::Handle<naga::Type>, name: String, names: &mut Vec<String>) {
    match module.types[ty].inner {
        TypeInner::Vector { size, .. } => {
            names.extend(["x", "y", "z", "w"][..size as usize].iter().map(|part| format!("{name}.{part}")));
        }
        TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
            (0..count.get()).for_each(|index| name_parts(module, base, format!("{name}[{index}]"), names));
        }
        _ => names.push(name),
    }
}

/// Dispatches the module's entry point and reads the results back.
pub(super) fn call(gpu: &Gpu, shader: &wgpu::ShaderModule, arguments: &[f32], results: usize) -> Vec<f32> {
    let device = &gpu.device;
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("twin"),
        layout: None,
        module: shader,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let buffer = |contents: &[u8], usage| {
        let descriptor = wgpu::util::BufferInitDescriptor { label: Some("twin"), contents, usage };
        device.create_buffer_init(&descriptor)
    };
    let storage = wgpu::BufferUsages::STORAGE;
    let output = buffer(bytemuck::cast_slice(&vec![UNWRITTEN; results]), storage | wgpu::BufferUsages::COPY_SRC);
    let input = (!arguments.is_empty()).then(|| buffer(bytemuck::cast_slice(arguments), storage));
    let entries: Vec<wgpu::BindGroupEntry<'_>> = std::iter::once(&output)
        .chain(&input)
        .zip(0..)
        .map(|(buffer, binding)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
        .collect();
    let layout = pipeline.get_bind_group_layout(0);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("twin"),
        layout: &layout,
        entries: &entries,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    // Every point has at least one component, so this many workgroups reach every point.
    pass.dispatch_workgroups(results.div_ceil(64) as u32, 1, 1);
    drop(pass);
    let mapped = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("twin"),
        size: output.size(),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    encoder.copy_buffer_to_buffer(&output, 0, &mapped, 0, output.size());
    gpu.queue.submit([encoder.finish()]);
    mapped.slice(..).map_async(wgpu::MapMode::Read, |result| result.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    gpu.check().unwrap();
    let bytes = mapped.slice(..).get_mapped_range().unwrap();
    bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect()
}
