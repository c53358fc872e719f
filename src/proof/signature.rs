//! What a WGSL function takes and gives, and an entry point that calls it.

use super::ProofError;
use crate::shader::Composed;
use naga::{Function, Handle, Module, Type, TypeInner};

/// The names of the functions that `composed` takes from `file`.
///
/// # Errors
/// When the text is no WGSL.
pub fn functions_of(composed: &Composed, file: &str) -> Result<Vec<String>, ProofError> {
    let module = composed.parse()?;
    let from_file = |handle| {
        let line = module.functions.get_span(handle).location(&composed.text).line_number as usize;
        composed.origin(line).is_some_and(|(origin, _)| origin == file)
    };
    let functions = module.functions.iter().filter(|(handle, _)| from_file(*handle));
    Ok(functions.filter_map(|(_, function)| function.name.clone()).collect())
}

/// One function of a module.
pub(super) struct Signature<'m> {
    module: &'m Module,
    function: &'m Function,
    name: &'m str,
}

impl<'m> Signature<'m> {
    pub(super) fn find(module: &'m Module, name: &'m str) -> Result<Self, ProofError> {
        let mut functions = module.functions.iter().map(|(_, function)| function);
        let function = functions
            .find(|function| function.name.as_deref() == Some(name))
            .ok_or_else(|| ProofError::Row { row: name.to_owned(), reason: "there is no such function".into() })?;
        Ok(Self { module, function, name })
    }

    /// How many floats the result consists of.
    pub(super) fn width(&self) -> Result<usize, ProofError> {
        self.function.result.as_ref().map_or(Ok(0), |result| self.components(result.ty))
    }

    /// A name for every float of the arguments: `alpha`, `n.x`, `coefficients[2].y`.
    pub(super) fn argument_names(&self) -> Vec<String> {
        let mut names = Vec::new();
        for argument in &self.function.arguments {
            self.name_parts(argument.ty, argument.name.clone().unwrap_or_default(), &mut names);
        }
        names
    }

    /// An entry point that unpacks the arguments, calls the function and writes the components of its result.
    pub(super) fn caller(&self) -> Result<String, ProofError> {
        let mut read = 0;
        let arguments: Result<Vec<String>, ProofError> =
            self.function.arguments.iter().map(|argument| self.unpack(argument.ty, &mut read)).collect();
        let width = self.width()?;
        let writes = (0..width).map(|component| {
            let swizzle = if width == 1 { "" } else { [".x", ".y", ".z", ".w"][component] };
            format!("    results[{width}u * id.x + {component}u] = result{swizzle};\n")
        });
        let declaration = "@group(0) @binding(1) var<storage, read> arguments: array<f32>;\n";
        Ok(format!(
            "@group(0) @binding(0) var<storage, read_write> results: array<f32>;\n{}\
             @compute @workgroup_size(64)\n\
             fn main(@builtin(global_invocation_id) id: vec3u) {{\n\
             \x20   if id.x >= arrayLength(&results) / {width}u {{ return; }}\n\
             \x20   let first = {read}u * id.x;\n\
             \x20   let result = {}({});\n{}}}\n",
            if read > 0 { declaration } else { "" },
            self.name,
            arguments?.join(", "),
            writes.collect::<String>(),
        ))
    }

    /// The expression that reads a value of type `ty` from the argument buffer, from its `read`th float on.
    fn unpack(&self, ty: Handle<Type>, read: &mut usize) -> Result<String, ProofError> {
        let mut scalar = || {
            *read += 1;
            format!("arguments[first + {}u]", *read - 1)
        };
        match self.module.types[ty].inner {
            TypeInner::Scalar(naga::Scalar::F32) => Ok(scalar()),
            TypeInner::Vector { size, scalar: naga::Scalar::F32 } => {
                let parts: Vec<String> = (0..size as usize).map(|_| scalar()).collect();
                Ok(format!("vec{}f({})", size as u8, parts.join(", ")))
            }
            TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
                let parts: Result<Vec<String>, _> = (0..count.get()).map(|_| self.unpack(base, read)).collect();
                Ok(format!("array({})", parts?.join(", ")))
            }
            ref other => Err(self.unknown(other)),
        }
    }

    /// How many floats a value consists of.
    fn components(&self, ty: Handle<Type>) -> Result<usize, ProofError> {
        match self.module.types[ty].inner {
            TypeInner::Scalar(naga::Scalar::F32) => Ok(1),
            TypeInner::Vector { size, scalar: naga::Scalar::F32 } => Ok(size as usize),
            ref other => Err(self.unknown(other)),
        }
    }

    fn name_parts(&self, ty: Handle<Type>, name: String, names: &mut Vec<String>) {
        match self.module.types[ty].inner {
            TypeInner::Vector { size, .. } => {
                names.extend(["x", "y", "z", "w"][..size as usize].iter().map(|part| format!("{name}.{part}")));
            }
            TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
                (0..count.get()).for_each(|index| self.name_parts(base, format!("{name}[{index}]"), names));
            }
            _ => names.push(name),
        }
    }

    fn unknown(&self, ty: &TypeInner) -> ProofError {
        ProofError::Row { row: self.name.to_owned(), reason: format!("no twin takes or gives a {ty:?} yet") }
    }
}
