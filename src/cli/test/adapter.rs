//! What draws, and whose pictures are expected to be like its own.

use super::report::AdapterReport;
use crate::gpu::Gpu;
use crate::wgpu::{AdapterInfo, Backend};

impl AdapterReport {
    pub(super) fn of(gpu: &Gpu) -> Self {
        let info = &gpu.info;
        Self {
            name: info.name.clone(),
            backend: info.backend.to_string(),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            class: class(info),
            cpu: cpu(),
        }
    }
}

/// The adapter's name without what stands in brackets, and major and minor version of its driver: `llvmpipe-22.3`. GL has
/// drivers of its own, and so `-gl`.
fn class(info: &AdapterInfo) -> String {
    let name = info.name.split('(').next().unwrap_or_default();
    let mut class = String::new();
    for c in name.chars() {
        match c {
            _ if c.is_ascii_alphanumeric() => class.push(c.to_ascii_lowercase()),
            _ if !class.is_empty() && !class.ends_with('-') => class.push('-'),
            _ => {}
        }
    }
    let mut parts = vec![class.trim_end_matches('-').to_owned()];
    if parts[0].is_empty() {
        parts = vec!["unnamed".to_owned()];
    }
    // Mesa's GL drivers begin with the version of GL.
    let told = info.driver_info.split_once("Mesa ").map_or(info.driver_info.as_str(), |(_, told)| told);
    parts.extend(version(told));
    if info.backend == Backend::Gl {
        parts.push("gl".into());
    }
    parts.join("-")
}

/// The first two numbers that have a dot between them.
fn version(text: &str) -> Option<String> {
    let is_word = |c: char| c.is_ascii_digit() || c == '.';
    let mut words = text.split(|c| !is_word(c));
    words.find_map(|word| {
        let mut numbers = word.split('.').filter(|number| !number.is_empty());
        Some(format!("{}.{}", numbers.next()?, numbers.next()?))
    })
}

/// Instruction set and the widest vectors that a software driver may compile for.
fn cpu() -> String {
    #[cfg(target_arch = "x86_64")]
    let vectors = [
        ("avx512", std::arch::is_x86_feature_detected!("avx512f")),
        ("avx2", std::arch::is_x86_feature_detected!("avx2")),
        ("avx", std::arch::is_x86_feature_detected!("avx")),
        ("sse4.1", std::arch::is_x86_feature_detected!("sse4.1")),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let vectors: [(&str, bool); 0] = [];
    let widest = vectors.iter().find(|(_, has)| *has).map(|(name, _)| format!("-{name}"));
    format!("{}{}", std::env::consts::ARCH, widest.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_two_numbers() {
        for (told, expected) in [
            ("Mesa 22.3.6 (LLVM 15.0.6)", Some("22.3")),
            ("550.54.15", Some("550.54")),
            ("git 7 of 24.1", Some("24.1")),
            ("31", None),
            ("", None),
        ] {
            assert_eq!(version(told).as_deref(), expected, "{told}");
        }
        assert!(cpu().starts_with(std::env::consts::ARCH));
    }
}
