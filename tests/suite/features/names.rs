//! What a composed module declares, reads and does, by name.

use naga::proc::TypeResolution;
use naga::valid::{Capabilities, FunctionInfo, ModuleInfo, ValidationFlags, Validator};
use naga::{Expression, Function, Handle, Module, Statement, TypeInner};
use specula::shader::Composed;
use std::collections::BTreeSet;

/// The names in a module: bindings, members of bound structs and attributes, and functions that do anything.
#[derive(Debug, Default)]
pub(super) struct Names {
    pub(super) data: BTreeSet<String>,
    functions: BTreeSet<String>,
}

impl Names {
    /// Of all that is declared and bound, and of the code that the entry points reach.
    pub(super) fn of(composed: &Composed) -> Self {
        let module = composed.parse().unwrap();
        let info = Validator::new(ValidationFlags::all(), Capabilities::PRIMITIVE_INDEX).validate(&module).unwrap();
        let mut names = Self::default();
        for (_, ty) in module.types.iter().filter(|(_, ty)| ty.name.as_deref() == Some("VertexIn")) {
            let TypeInner::Struct { members, .. } = &ty.inner else { panic!("VertexIn is a struct") };
            let name =
                |member: &naga::StructMember| format!("attribute {}", member.name.as_deref().unwrap_or_default());
            names.data.extend(members.iter().map(name));
        }
        let bound = module.global_variables.iter().filter(|(_, variable)| variable.binding.is_some());
        names.data.extend(bound.filter_map(|(_, variable)| variable.name.clone()));
        for (index, entry) in module.entry_points.iter().enumerate() {
            let mut walk = Walk { module: &module, info: &info, reached: BTreeSet::new(), names: &mut names };
            walk.function(&entry.function, info.get_entry_point(index));
        }
        names
    }

    pub(super) fn contains(&self, name: &str) -> bool {
        self.data.contains(name) || self.functions.contains(name)
    }
}

struct Walk<'a> {
    module: &'a Module,
    info: &'a ModuleInfo,
    reached: BTreeSet<Handle<Function>>,
    names: &'a mut Names,
}

impl Walk<'_> {
    fn function(&mut self, function: &Function, info: &FunctionInfo) {
        for (_, expression) in function.expressions.iter() {
            if let &Expression::AccessIndex { base, index } = expression {
                self.member(function, info, base, index);
            }
        }
        self.block(&function.body);
    }

    /// Notes a member of something bound.
    fn member(&mut self, function: &Function, info: &FunctionInfo, base: Handle<Expression>, index: u32) {
        let mut root = base;
        while let Expression::Access { base, .. }
        | Expression::AccessIndex { base, .. }
        | Expression::Load { pointer: base } = function.expressions[root]
        {
            root = base;
        }
        // Values of whole structs that are bound are read through variables of these types only.
        let inner = match &info[base].ty {
            TypeResolution::Handle(ty) => &self.module.types[*ty].inner,
            TypeResolution::Value(inner) => inner,
        };
        let inner = if let TypeInner::Pointer { base, .. } = inner { &self.module.types[*base].inner } else { inner };
        let TypeInner::Struct { members, .. } = inner else { return };
        let is_bound = match function.expressions[root] {
            Expression::GlobalVariable(variable) => self.module.global_variables[variable].binding.is_some(),
            _ => false,
        };
        if is_bound {
            self.names.data.extend(members[index as usize].name.clone());
        }
    }

    fn block(&mut self, block: &[Statement]) {
        for statement in block {
            match statement {
                Statement::Call { function, .. } => {
                    let callee = &self.module.functions[*function];
                    if self.reached.insert(*function) && !is_free(callee) {
                        self.names.functions.extend(callee.name.clone());
                        self.function(callee, &self.info[*function]);
                    }
                }
                Statement::Kill => {
                    self.names.functions.insert("discard".into());
                }
                Statement::Block(block) => self.block(block),
                Statement::If { accept, reject, .. } => {
                    [accept, reject].into_iter().for_each(|block| self.block(block));
                }
                Statement::Switch { cases, .. } => cases.iter().for_each(|case| self.block(&case.body)),
                Statement::Loop { body, continuing, .. } => {
                    [body, continuing].into_iter().for_each(|block| self.block(block));
                }
                _ => {}
            }
        }
    }
}

/// Whether a function only returns constants and what it was given: every compiler takes it away.
fn is_free(function: &Function) -> bool {
    let is_free = |(_, expression): (_, &Expression)| {
        matches!(
            expression,
            Expression::Literal(_)
                | Expression::Constant(_)
                | Expression::ZeroValue(_)
                | Expression::Splat { .. }
                | Expression::Compose { .. }
                | Expression::FunctionArgument(_)
        )
    };
    function.body.iter().all(|statement| matches!(statement, Statement::Emit(_) | Statement::Return { .. }))
        && function.expressions.iter().all(is_free)
}
