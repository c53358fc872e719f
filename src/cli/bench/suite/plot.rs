//! The suite as bars: what each scene takes, its floor, and the baseline.

use super::report::{SceneReport, SuiteReport};
use crate::cli::svg::{document, escape, ramp};
use std::fmt::Write;

const WIDTH: f64 = 900.0;
const LEFT: f64 = 170.0;
const RIGHT: f64 = 150.0;
const TOP: f64 = 70.0;
const BOTTOM: f64 = 40.0;
const ROW: f64 = 26.0;
const BAR: f64 = 15.0;

/// Bars from the left on a logarithmic axis that begins with a whole decade; both ends as powers of ten.
struct Axis {
    low: i32,
    high: f64,
}

impl Axis {
    fn around(values: impl Iterator<Item = f64>) -> Self {
        let logs = values.filter(|ms| *ms > 0.0 && ms.is_finite()).map(f64::log10);
        let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        if low > high {
            return Self { low: 0, high: 1.0 };
        }
        let low = low.floor() as i32;
        Self { low, high: high.max(f64::from(low) + 1.0) }
    }

    fn at(&self, ms: f64) -> f64 {
        let share = (ms.log10() - f64::from(self.low)) / (self.high - f64::from(self.low));
        LEFT + (WIDTH - LEFT - RIGHT) * share.clamp(0.0, 1.0)
    }
}

/// The report as a picture.
pub(super) fn svg(report: &SuiteReport) -> String {
    let time = |scene: &SceneReport| report.basis.of(&scene.steady.median);
    let floor = |scene: &SceneReport| scene.floor.as_ref().map(|floor| floor.ms);
    let baseline = |scene: &SceneReport| scene.baseline.map(|found| found.baseline_ms);
    let all = report.scenes.iter().flat_map(|scene| [time(scene), floor(scene), baseline(scene)]).flatten();
    let axis = Axis::around(all);
    let bottom = TOP + ROW * report.scenes.len() as f64;
    // Writing to a String cannot fail.
    let mut body = String::new();
    head(&mut body, report);
    for decade in axis.low..=axis.high.floor() as i32 {
        let (ms, x) = (10_f64.powi(decade), axis.at(10_f64.powi(decade)));
        let _ = writeln!(body, "<path d=\"M{x:.1} {TOP}V{bottom:.1}\" stroke=\"#dddddd\"/>");
        let _ = writeln!(body, "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{ms}</text>", bottom + 18.0);
    }
    for (row, scene) in report.scenes.iter().enumerate() {
        let Some(ms) = time(scene) else { continue };
        let top = TOP + ROW * row as f64 + 0.5 * (ROW - BAR);
        let (x, text_y) = (axis.at(ms), top + BAR - 3.0);
        let _ = writeln!(
            body,
            "<text x=\"{:.1}\" y=\"{text_y:.1}\" text-anchor=\"end\">{}</text>",
            LEFT - 8.0,
            escape(scene.name)
        );
        let _ = writeln!(
            body,
            "<rect x=\"{LEFT}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{BAR}\" fill=\"{}\"/>",
            x - LEFT,
            ramp(0.3)
        );
        if let Some(floor) = floor(scene) {
            let _ = writeln!(
                body,
                "<rect x=\"{LEFT}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{BAR}\" fill=\"{}\"/>",
                axis.at(floor) - LEFT,
                ramp(0.6)
            );
        }
        let label = baseline(scene).map_or_else(String::new, |other| {
            let x = axis.at(other);
            let (above, below) = (top - 3.0, top + BAR + 3.0);
            let _ = writeln!(body, "<path d=\"M{x:.1} {above:.1}V{below:.1}\" stroke=\"black\" stroke-width=\"2\"/>");
            scene.baseline.map(|found| format!(", {:.2} of baseline", found.ratio)).unwrap_or_default()
        });
        let end = baseline(scene).map_or(x, |other| x.max(axis.at(other))) + 7.0;
        let _ = writeln!(body, "<text x=\"{end:.1}\" y=\"{text_y:.1}\">{ms:.1}{label}</text>");
    }
    document(WIDTH, bottom + BOTTOM, &body)
}

/// Title and legend.
fn head(body: &mut String, report: &SuiteReport) {
    let has_baseline = report.scenes.iter().any(|scene| scene.baseline.is_some());
    let title = format!("A frame on {}: {}, median, ms", report.adapter.name, report.basis.name());
    let _ = writeln!(body, "<text x=\"16\" y=\"26\" font-size=\"15\">{}</text>", escape(&title));
    for (x, color, what) in [(16.0, ramp(0.6), "floor"), (90.0, ramp(0.3), "frame")] {
        let _ = writeln!(body, "<rect x=\"{x}\" y=\"40\" width=\"14\" height=\"12\" fill=\"{color}\"/>");
        let _ = writeln!(body, "<text x=\"{}\" y=\"51\">{what}</text>", x + 20.0);
    }
    if has_baseline {
        let _ = writeln!(body, "<path d=\"M170 38V54\" stroke=\"black\" stroke-width=\"2\"/>");
        let _ = writeln!(body, "<text x=\"178\" y=\"51\">baseline</text>");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_begin_with_a_whole_decade_and_end_with_the_largest_value() {
        let axis = Axis::around([3.0, 450.0, f64::NAN].into_iter());
        assert_eq!(axis.low, 0);
        assert_eq!((axis.at(1.0), axis.at(450.0)), (LEFT, WIDTH - RIGHT));
        assert_eq!(Axis::around(std::iter::empty()).high, 1.0);
        let one = Axis::around([10.0].into_iter());
        assert_eq!((one.low, one.high), (1, 2.0));
    }
}
