//! What was measured, as tables and as JSON.

use super::pareto::front;
use super::settings::Setting;
use crate::cli::clock::{Basis, FrameTimes};
use crate::cli::error::CliError;
use crate::cli::measure::Floor;
use crate::cli::stats::AdapterStats;
use crate::gpu::formats::Precision;
use crate::metrics::truth::RelativeError;
use crate::scene::{Quality, Term};
use serde::Serialize;
use std::fmt::Write;

/// A relative error.
#[derive(Debug, Clone, Copy, Serialize)]
pub(super) struct Figure {
    /// Root mean square, the truth's noise taken out.
    pub(super) rms: f64,
    /// Whether it stands out from the truth's own noise.
    pub(super) is_visible: bool,
    /// What is drawn and compared: the error, or the smallest that would stand out.
    pub(super) upper: f64,
}

impl Figure {
    fn new(error: &RelativeError) -> Self {
        Self { rms: error.rms(), is_visible: error.is_visible(), upper: error.upper() }
    }

    fn text(&self) -> String {
        // A term that neither side has is not below any noise.
        let bound = if self.is_visible || self.upper == 0.0 { "" } else { "< " };
        format!("{bound}{}", percent(self.upper))
    }
}

/// In percent, with three digits or as many as there are before the point.
pub(super) fn percent(share: f64) -> String {
    if share == 0.0 {
        return "0 %".into();
    }
    let value = 100.0 * share;
    let digits = (2.0 - value.abs().max(1e-4).log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.digits$} %")
}

/// As `--precision` has it.
pub(super) fn precision_name(precision: Precision) -> &'static str {
    match precision {
        Precision::Half => "half",
        Precision::Float => "float",
    }
}

/// Milliseconds, where they are known.
pub(super) fn time_text(ms: Option<f64>) -> String {
    ms.map_or_else(|| "-".into(), |ms| format!("{ms:.2}"))
}

#[derive(Debug, Serialize)]
pub(super) struct Row {
    pub(super) name: String,
    pub(super) quality: &'static str,
    pub(super) msaa: u32,
    pub(super) supersampling: u32,
    pub(super) precision: &'static str,
    pub(super) prefilter_side: u32,
    /// From triangles to radiance: `forward`, `deferred`, or the `faster` of both as estimated.
    pub(super) path: &'static str,
    /// The name without its samples.
    #[serde(skip)]
    pub(super) light_name: String,
    /// Samples, in a word.
    #[serde(skip)]
    pub(super) sampling: &'static str,
    /// Medians.
    pub(super) times: FrameTimes,
    /// Median of the time over that of the base in the same round.
    pub(super) ratio: f64,
    /// Of the picture: edges, textures and light.
    pub(super) picture_error: Figure,
    /// Of the light alone, which does not depend on samples.
    pub(super) shading_error: Figure,
    pub(super) flip_mean: f64,
    /// Whether no other setting beats it in time and error of the picture.
    pub(super) is_on_picture_front: bool,
    /// The same for the light alone, among settings with the base's samples; None for the others.
    pub(super) is_on_shading_front: Option<bool>,
}

impl Row {
    pub(super) fn new(
        setting: &Setting,
        times: FrameTimes,
        ratio: f64,
        (picture, shading): (&RelativeError, &RelativeError),
        flip_mean: f64,
    ) -> Self {
        Self {
            name: setting.to_string(),
            quality: setting.quality.name(),
            msaa: setting.msaa,
            supersampling: setting.supersampling,
            precision: precision_name(setting.precision),
            prefilter_side: setting.prefilter_side,
            path: setting.path.name(),
            light_name: setting.light_name(),
            sampling: setting.sampling(),
            times,
            ratio,
            picture_error: Figure::new(picture),
            shading_error: Figure::new(shading),
            flip_mean,
            is_on_picture_front: false,
            is_on_shading_front: None,
        }
    }

    fn has_samples_of(&self, base: &Self) -> bool {
        (self.msaa, self.supersampling) == (base.msaa, base.supersampling)
    }
}

/// Errors of single terms, over the radiance of all.
#[derive(Debug, Serialize)]
pub(super) struct TermRow {
    quality: &'static str,
    errors: Vec<(&'static str, Figure)>,
}

impl TermRow {
    pub(super) fn new(quality: Quality, errors: &[(Term, RelativeError)]) -> Self {
        let errors = errors.iter().map(|(term, error)| (term.name(), Figure::new(error)));
        Self { quality: quality.name(), errors: errors.collect() }
    }
}

/// Codes of the display pass against those of float64, of the same radiance.
#[derive(Debug, Serialize)]
pub(super) struct DisplayRow {
    /// Root mean square, in steps of 255.
    rms_codes: f64,
    largest_codes: u8,
}

impl DisplayRow {
    pub(super) fn new(differences: impl Iterator<Item = u8>) -> Self {
        let (mut sum, mut count, mut largest) = (0.0, 0.0, 0);
        for difference in differences {
            sum += f64::from(difference).powi(2);
            count += 1.0;
            largest = largest.max(difference);
        }
        Self { rms_codes: (sum / f64::max(count, 1.0)).sqrt(), largest_codes: largest }
    }
}

#[derive(Debug, Serialize)]
pub(super) struct TruthReport {
    /// Samples a pixel, of all terms together.
    samples: u32,
    /// Root mean square of its relative standard error.
    noise: f64,
    /// The smallest error that stands out from it, in the base setting.
    smallest_visible: f64,
}

impl TruthReport {
    pub(super) fn new(samples: u32, base: &RelativeError) -> Self {
        Self { samples, noise: base.noise_rms(), smallest_visible: base.smallest_visible() }
    }

    fn text(&self) -> String {
        let (noise, smallest) = (percent(self.noise), percent(self.smallest_visible));
        format!("{} samples a pixel, its noise of {noise} taken out, errors from {smallest} up show", self.samples)
    }
}

/// Everything, before the front is found.
pub(super) struct Parts {
    pub(super) model: String,
    pub(super) environment: String,
    pub(super) adapter: AdapterStats,
    pub(super) size_px: [u32; 2],
    pub(super) frames: u32,
    pub(super) basis: Basis,
    pub(super) floor: Option<Floor>,
    pub(super) picture_truth: TruthReport,
    pub(super) shading_truth: TruthReport,
    pub(super) rows: Vec<Row>,
    pub(super) terms: Vec<TermRow>,
    pub(super) display: DisplayRow,
    pub(super) warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
pub(super) struct Report {
    /// Name and version of this layout.
    schema: &'static str,
    specula: &'static str,
    pub(super) model: String,
    pub(super) environment: String,
    adapter: AdapterStats,
    pub(super) size_px: [u32; 2],
    frames: u32,
    pub(super) basis: Basis,
    /// Of the base. None where it was not wanted, or the scene is too large for it.
    floor: Option<Floor>,
    picture_truth: TruthReport,
    shading_truth: TruthReport,
    /// The base first.
    pub(super) settings: Vec<Row>,
    terms: Vec<TermRow>,
    display: DisplayRow,
    pub(super) warnings: Vec<String>,
}

impl Report {
    pub(super) fn new(parts: Parts) -> Self {
        let mut settings = parts.rows;
        mark_fronts(&mut settings);
        Self {
            schema: "specula-bench/1",
            specula: env!("CARGO_PKG_VERSION"),
            model: parts.model,
            environment: parts.environment,
            adapter: parts.adapter,
            size_px: parts.size_px,
            frames: parts.frames,
            basis: parts.basis,
            floor: parts.floor,
            picture_truth: parts.picture_truth,
            shading_truth: parts.shading_truth,
            settings,
            terms: parts.terms,
            display: parts.display,
            warnings: parts.warnings,
        }
    }

    /// Markdown that reads well as it is.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        let rows = self.settings.iter().enumerate().map(|(index, row)| {
            let mark = |on: bool| if on { "*" } else { "" };
            let base = if index == 0 { " (base)" } else { "" };
            vec![
                format!("{}{base}", row.name),
                time_text(Some(row.times.wall_ms)),
                time_text(row.times.cpu_ms),
                time_text(row.times.gpu_ms),
                format!("{:.2}", row.ratio),
                row.picture_error.text(),
                mark(row.is_on_picture_front).into(),
                format!("{:.4}", row.flip_mean),
                row.shading_error.text(),
                mark(row.is_on_shading_front == Some(true)).into(),
            ]
        });
        let head = ["setting", "wall ms", "CPU ms", "GPU ms", "time", "picture", "front", "FLIP", "shading", "front"];
        table(&mut text, &head, rows);
        let terms = self.terms.first().map_or(Vec::new(), |row| row.errors.iter().map(|(name, _)| *name).collect());
        let head: Vec<&str> = std::iter::once("shading error of single terms").chain(terms).collect();
        let rows = self.terms.iter().map(|row| {
            std::iter::once(row.quality.to_owned()).chain(row.errors.iter().map(|(_, figure)| figure.text())).collect()
        });
        text.push('\n');
        table(&mut text, &head, rows);
        text + "\n" + &self.remarks()
    }

    fn remarks(&self) -> String {
        let AdapterStats { name, backend, driver, .. } = &self.adapter;
        format!(
            "`time` is the {} of a frame over the base's, median of {} rounds, on {name} ({backend}, {driver}), {}x{} pixels.\n\
             `picture` is the RMS of the relative error of radiance, edges and textures included; truth: {}.\n\
             `shading` is the same of the light alone, through the middle of pixels without mipmaps; truth: {}.\n\
             `<` marks errors that do not stand out from the noise of the truth. `*` marks what no other setting beats in time and error.\n\
             The display pass is off by {:.3} of 255 steps (RMS; {} at most) for the radiance that it is given.\n{}",
            self.basis.name(),
            self.frames,
            self.size_px[0],
            self.size_px[1],
            self.picture_truth.text(),
            self.shading_truth.text(),
            self.display.rms_codes,
            self.display.largest_codes,
            self.floor.as_ref().map(|floor| floor.text(self.basis)).unwrap_or_default(),
        )
    }
}

fn mark_fronts(rows: &mut [Row]) {
    let point = |row: &Row, error: &Figure| (row.ratio, error.upper);
    let pictures: Vec<(f64, f64)> = rows.iter().map(|row| point(row, &row.picture_error)).collect();
    for index in front(&pictures) {
        rows[index].is_on_picture_front = true;
    }
    let comparable: Vec<usize> = (0..rows.len()).filter(|&i| rows[i].has_samples_of(&rows[0])).collect();
    let lights: Vec<(f64, f64)> = comparable.iter().map(|&i| point(&rows[i], &rows[i].shading_error)).collect();
    let front = front(&lights);
    for (place, &index) in comparable.iter().enumerate() {
        rows[index].is_on_shading_front = Some(front.contains(&place));
    }
}

/// A report as it is printed and written.
pub(super) fn json(report: &impl Serialize) -> Result<String, CliError> {
    let json = serde_json::to_string_pretty(report).map_err(|error| CliError::Usage(error.to_string()))?;
    Ok(json + "\n")
}

/// A table whose columns are as wide as their widest cell.
pub(super) fn table(text: &mut String, head: &[&str], rows: impl Iterator<Item = Vec<String>>) {
    let rows: Vec<Vec<String>> = rows.collect();
    let head: Vec<String> = head.iter().map(|name| (*name).to_owned()).collect();
    let cells = |column: usize| rows.iter().chain([&head]).filter_map(move |row| row.get(column));
    let widths: Vec<usize> =
        (0..head.len()).map(|column| cells(column).map(|cell| cell.chars().count()).max().unwrap_or(0)).collect();
    let mut line = |row: &[String]| {
        // Writing to a String cannot fail.
        for (index, (cell, width)) in row.iter().zip(&widths).enumerate() {
            let _ = if index == 0 { write!(text, "| {cell:width$} ") } else { write!(text, "| {cell:>width$} ") };
        }
        text.push_str("|\n");
    };
    line(&head);
    let dashes =
        widths.iter().enumerate().map(|(i, w)| "-".repeat(w - usize::from(i > 0)) + if i > 0 { ":" } else { "" });
    line(&dashes.collect::<Vec<String>>());
    rows.iter().for_each(|row| line(row));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_have_three_digits() {
        let texts = [0.1234, 0.01234, 0.001234, 1.234, 1e-9, 0.0].map(percent);
        assert_eq!(texts, ["12.3 %", "1.23 %", "0.123 %", "123 %", "0.000000 %", "0 %"]);
    }

    #[test]
    fn columns_line_up() {
        let mut text = String::new();
        table(&mut text, &["a", "long"], [vec!["wide".into(), "1".into()]].into_iter());
        assert_eq!(text, "| a    | long |\n| ---- | ---: |\n| wide |    1 |\n");
    }

    #[test]
    fn errors_below_the_noise_say_so() {
        let figure = |is_visible| Figure { rms: 0.01, is_visible, upper: if is_visible { 0.01 } else { 0.00447 } };
        assert_eq!([false, true].map(|visible| figure(visible).text()), ["< 0.447 %", "1.00 %"]);
    }
}
