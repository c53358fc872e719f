//! `specula doctor`: which adapters there are, and what of Specula works on the one that would be taken.

use super::clock::Basis;
use super::driver::DriverArgs;
use super::error::CliError;
use super::measure::{Fill, Rates, RatesReport};
use super::output;
use super::progress::StderrProgress;
use crate::gpu::formats::{self, Precision};
use crate::gpu::{Gpu, GpuError, GpuOptions, adapters};
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;

/// Say which adapters there are, and what of Specula works less well on the one that is taken.
///
/// Exit codes: 0 all is well; 1 something works less well; 3 no adapter.
#[derive(Debug, clap::Args)]
pub(super) struct DoctorArgs {
    #[command(flatten)]
    driver: DriverArgs,
    /// Measure what the adapter does at best, in some ten seconds: fills of targets, lookups in textures, arithmetic. Of
    /// these `specula bench` makes the floor of a frame.
    #[arg(long)]
    measure: bool,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
}

/// Everything that is found.
#[derive(Debug, Serialize)]
struct Report {
    /// Name and version of this layout.
    schema: &'static str,
    specula: &'static str,
    /// The first is the one that is taken.
    adapters: Vec<Adapter>,
    /// Of the first.
    limits: Vec<Limit>,
    findings: Vec<Finding>,
    /// Of the first, where that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    measured: Option<RatesReport>,
}

#[derive(Debug, Serialize)]
struct Adapter {
    name: String,
    kind: String,
    backend: String,
    driver: String,
}

#[derive(Debug, Serialize)]
struct Limit {
    name: &'static str,
    value: u64,
}

/// Something that Specula uses, and what becomes of it without.
#[derive(Debug, Serialize)]
struct Finding {
    uses: &'static str,
    there: bool,
    without: &'static str,
}

pub(super) fn run(args: &DoctorArgs) -> Result<(), CliError> {
    let found = adapters(&args.driver.request()).map_err(CliError::NeedsAdapter)?;
    let Some(taken) = found.first() else {
        return Err(CliError::NeedsAdapter(GpuError::NoAdapter { looked_at: "all backends".into() }));
    };
    let report = Report {
        schema: "specula-doctor/1",
        specula: env!("CARGO_PKG_VERSION"),
        adapters: found.iter().map(|adapter| describe(&adapter.get_info())).collect(),
        limits: limits(&taken.limits()),
        findings: findings(taken),
        measured: args.measure.then(|| measured(args)).transpose()?,
    };
    let text = if args.json { json(&report)? } else { report.text() };
    output::write(Path::new("-"), text.as_bytes())?;
    match report.findings.iter().filter(|finding| !finding.there).count() {
        0 => Ok(()),
        1 => Err(CliError::CheckFailed("one thing works less well on this adapter".into())),
        count => Err(CliError::CheckFailed(format!("{count} things work less well on this adapter"))),
    }
}

/// On the adapter that is taken.
fn measured(args: &DoctorArgs) -> Result<RatesReport, CliError> {
    let gpu = Gpu::open(&args.driver.request(), GpuOptions::default()).map_err(CliError::NeedsAdapter)?;
    let progress = StderrProgress::new(false);
    let rates = Rates::measure(&gpu, Basis::suiting(&gpu), &Fill::ALL, &progress);
    progress.finish();
    Ok(rates?.report())
}

fn json(report: &Report) -> Result<String, CliError> {
    let text = serde_json::to_string_pretty(report);
    text.map(|text| text + "\n").map_err(|error| CliError::Usage(format!("the report is no JSON: {error}")))
}

fn describe(info: &wgpu::AdapterInfo) -> Adapter {
    Adapter {
        name: info.name.clone(),
        kind: format!("{:?}", info.device_type),
        backend: info.backend.to_string(),
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
    }
}

fn limits(limits: &wgpu::Limits) -> Vec<Limit> {
    let limit = |name, value| Limit { name, value };
    vec![
        limit("side of a texture, pixels", u64::from(limits.max_texture_dimension_2d)),
        limit("buffer, bytes", limits.max_buffer_size),
        limit("storage buffer that is bound, bytes", limits.max_storage_buffer_binding_size),
        limit("storage buffers of a shader stage", u64::from(limits.max_storage_buffers_per_shader_stage)),
        limit("textures of a shader stage", u64::from(limits.max_sampled_textures_per_shader_stage)),
        limit("samplers of a shader stage", u64::from(limits.max_samplers_per_shader_stage)),
    ]
}

fn findings(adapter: &wgpu::Adapter) -> Vec<Finding> {
    let (features, limits) = (adapter.features(), adapter.limits());
    let blends_and_resolves = |precision: Precision| {
        let features = adapter.get_texture_format_features(precision.hdr_format());
        let flags = features.flags;
        flags.sample_count_supported(4)
            && flags.contains(wgpu::TextureFormatFeatureFlags::MULTISAMPLE_RESOLVE)
            && flags.contains(wgpu::TextureFormatFeatureFlags::BLENDABLE)
    };
    let depth_multisamples = adapter.get_texture_format_features(formats::DEPTH).flags.sample_count_supported(4);
    let timestamps = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    let finding = |uses, there, without| Finding { uses, there, without };
    vec![
        finding(
            "storage buffers in vertex and fragment shaders",
            limits.max_storage_buffers_per_shader_stage >= 2,
            "nothing can be drawn; use --renderer reference",
        ),
        finding(
            "textures of 8192 pixels",
            limits.max_texture_dimension_2d >= 8192,
            "large panoramas and pictures are refused",
        ),
        finding(
            "half floats with blending and 4 samples",
            blends_and_resolves(Precision::Half) && depth_multisamples,
            "edges are not smoothed: use --msaa 1",
        ),
        finding(
            "floats with blending and 4 samples",
            blends_and_resolves(Precision::Float) && features.contains(wgpu::Features::FLOAT32_BLENDABLE),
            "--precision float draws nothing that blends, and needs --msaa 1",
        ),
        finding(
            "16-bit normalised textures",
            features.contains(wgpu::Features::TEXTURE_FORMAT_16BIT_NORM),
            "tables are half floats, with an error of 1e-4 instead of 4e-5",
        ),
        finding("timestamps", features.contains(timestamps), "bench --clock gpu cannot measure"),
    ]
}

impl Report {
    fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail.
        for (index, adapter) in self.adapters.iter().enumerate() {
            let Adapter { name, kind, backend, driver } = adapter;
            let mark = if index == 0 { "*" } else { " " };
            let _ = writeln!(text, "{mark} {name} ({kind}, {backend}, {driver})");
        }
        text.push('\n');
        for Limit { name, value } in &self.limits {
            let _ = writeln!(text, "  {value:>12}  {name}");
        }
        text.push('\n');
        for Finding { uses, there, without } in &self.findings {
            let _ = if *there { writeln!(text, "  yes  {uses}") } else { writeln!(text, "  NO   {uses}: {without}") };
        }
        if let Some(measured) = &self.measured {
            text.push('\n');
            text.push_str(&measured.text());
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_said_with_what_it_costs() {
        let finding = |there| Finding { uses: "timestamps", there, without: "no clock" };
        let report = Report {
            schema: "specula-doctor/1",
            specula: "0",
            adapters: Vec::new(),
            limits: limits(&wgpu::Limits::default()),
            findings: vec![finding(true), finding(false)],
            measured: None,
        };
        let text = report.text();
        assert!(text.contains("yes  timestamps\n") && text.contains("NO   timestamps: no clock\n"), "{text}");
        assert!(json(&report).unwrap().contains("\"there\": false"));
    }
}
