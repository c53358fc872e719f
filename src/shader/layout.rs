//! One declaration for a struct that both sides read: Rust memory and WGSL text.

/// The Rust type with the memory layout of a WGSL type. Matrices are columns of vec4.
macro_rules! rust_type {
    (f32) => {
        f32
    };
    (u32) => {
        u32
    };
    (vec2f) => {
        [f32; 2]
    };
    (vec3f) => {
        [f32; 3]
    };
    (vec4f) => {
        [f32; 4]
    };
    (mat3x3f) => {
        [[f32; 4]; 3]
    };
    (mat3x4f) => {
        [[f32; 4]; 3]
    };
    (mat4x4f) => {
        [[f32; 4]; 4]
    };
    ([$element:ident; $count:literal]) => {
        [$crate::shader::layout::rust_type!($element); $count]
    };
}

/// The WGSL spelling of the same type.
macro_rules! wgsl_type {
    ([$element:ident; $count:literal]) => {
        concat!("array<", stringify!($element), ", ", stringify!($count), ">")
    };
    ($type:ident) => {
        stringify!($type)
    };
}

/// Declares a `#[repr(C)]` plain-data struct together with `WGSL`, the text that declares it in a shader.
///
/// WGSL aligns vec3f and matrices to 16 bytes: order the fields so that no hole arises, or name the hole. A test
/// compares every offset with the one that naga computes.
macro_rules! gpu_struct {
    ($(#[$meta:meta])* pub struct $name:ident { $($(#[$field_meta:meta])* $field:ident: $type:tt,)* }) => {
        $(#[$meta])*
        #[repr(C)]
        #[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
        pub struct $name { $($(#[$field_meta])* pub $field: $crate::shader::layout::rust_type!($type),)* }

        impl $name {
            /// The declaration of this struct in WGSL.
            pub const WGSL: &str = concat!(
                "struct ", stringify!($name), " {\n",
                $("    ", stringify!($field), ": ", $crate::shader::layout::wgsl_type!($type), ",\n",)*
                "}\n"
            );
            /// Name and byte offset of each field.
            pub const FIELDS: &[(&str, usize)] =
                &[$((stringify!($field), std::mem::offset_of!($name, $field)),)*];
        }

        impl Default for $name {
            fn default() -> Self {
                bytemuck::Zeroable::zeroed()
            }
        }
    };
}

pub(super) use {gpu_struct, rust_type, wgsl_type};
