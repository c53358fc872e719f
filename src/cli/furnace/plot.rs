//! Directional albedo over the angle, as SVG: a panel for each group, a curve for each of its surfaces.

use super::Checked;
use super::table::theta_deg;
use crate::cli::svg::{document, escape, ramp};
use std::fmt::Write;

const PLOT_WIDTH: f64 = 560.0;
const PLOT_HEIGHT: f64 = 320.0;
const LEFT: f64 = 56.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 52.0;
const LEGEND_WIDTH: f64 = 250.0;
const LEGEND_LINE: f64 = 17.0;

/// The picture; albedos are those of the strongest channel.
pub(super) fn svg(checked: &[Checked]) -> String {
    let panels: Vec<&[Checked]> = checked.chunk_by(|a, b| a.subject.group == b.subject.group).collect();
    let top = albedo_axis(checked);
    let (width, mut y, mut body) = (LEFT + PLOT_WIDTH + 24.0 + LEGEND_WIDTH, 0.0, String::new());
    for panel in panels {
        let height = TOP + PLOT_HEIGHT.max(panel.len() as f64 * LEGEND_LINE) + BOTTOM;
        body += &draw_panel(panel, y, top);
        y += height;
    }
    document(width, y, &body)
}

/// The upper end of the axis of albedos: room above 1, and for what is larger.
fn albedo_axis(checked: &[Checked]) -> f64 {
    let largest = |one: &Checked| one.report.albedo.largest.albedo.value.max_element();
    let largest = checked.iter().map(largest).filter(|albedo| albedo.is_finite()).fold(1.0, f64::max);
    (largest * 10.0).ceil().max(11.0) / 10.0
}

fn draw_panel(panel: &[Checked], panel_y: f64, top: f64) -> String {
    let x = |theta_deg: f64| LEFT + PLOT_WIDTH * theta_deg / 90.0;
    let y = |albedo: f64| panel_y + TOP + PLOT_HEIGHT * (1.0 - albedo / top);
    let (mut svg, last) = (String::new(), panel.len().saturating_sub(1).max(1) as f64);
    let title = escape(panel.first().map_or("", |one| &one.subject.group));
    // Writing to a String cannot fail.
    let _ = writeln!(svg, "<text x=\"{LEFT}\" y=\"{}\" font-size=\"15\">{title}</text>", panel_y + 24.0);
    axes(&mut svg, &x, &y, top);
    for (i, one) in panel.iter().enumerate() {
        let color = ramp(i as f64 / last);
        // The gaps of a curve on top of others show those.
        let covered = panel[..i].iter().filter(|other| coincide(one, other)).count();
        let dashes = if covered > 0 { format!(" stroke-dasharray=\"7 {}\"", 7 * covered) } else { String::new() };
        let point = |sample: &_| {
            let (theta, albedo): (f64, f64) = theta_and_albedo(sample);
            albedo.is_finite().then(|| format!("{:.1},{:.1}", x(theta), y(albedo)))
        };
        let points: Vec<String> = one.report.albedo.curve.iter().filter_map(point).collect();
        let _ = writeln!(
            svg,
            "<polyline fill=\"none\" stroke=\"{color}\" stroke-width=\"1.8\"{dashes} points=\"{}\"/>",
            points.join(" ")
        );
        let (legend_x, legend_y) = (LEFT + PLOT_WIDTH + 24.0, panel_y + TOP + 8.0 + LEGEND_LINE * i as f64);
        let _ = writeln!(
            svg,
            "<path d=\"M{legend_x} {legend_y}h22\" stroke=\"{color}\" stroke-width=\"3\"/>\
             <text x=\"{}\" y=\"{}\">{}</text>",
            legend_x + 30.0,
            legend_y + 4.0,
            escape(&one.subject.label)
        );
    }
    svg
}

/// Whether two curves are less than a line's width apart everywhere.
fn coincide(a: &Checked, b: &Checked) -> bool {
    let (a, b) = (&a.report.albedo.curve, &b.report.albedo.curve);
    a.iter().zip(b).all(|(a, b)| (theta_and_albedo(a).1 - theta_and_albedo(b).1).abs() < 0.005)
}

fn theta_and_albedo(sample: &crate::reference::laws::AlbedoSample) -> (f64, f64) {
    (theta_deg(sample), sample.albedo.value.max_element())
}

/// Grid lines, ticks with their numbers, and what the axes are.
fn axes(svg: &mut String, x: &impl Fn(f64) -> f64, y: &impl Fn(f64) -> f64, top: f64) {
    let (left, right, floor, ceiling) = (x(0.0), x(90.0), y(0.0), y(top));
    for theta in [0, 15, 30, 45, 60, 75, 90] {
        let at = x(f64::from(theta));
        let _ = writeln!(svg, "<path d=\"M{at:.1} {ceiling:.1}V{floor:.1}\" stroke=\"#e4e4e4\"/>");
        let _ = writeln!(svg, "<text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{theta}°</text>", floor + 17.0);
    }
    for tenth in (0..=(top * 10.0).round() as u32).step_by(2) {
        let (albedo, at) = (f64::from(tenth) / 10.0, y(f64::from(tenth) / 10.0));
        // All light.
        let stroke = if tenth == 10 { "#777777\" stroke-dasharray=\"5 3" } else { "#e4e4e4" };
        let _ = writeln!(svg, "<path d=\"M{left:.1} {at:.1}H{right:.1}\" stroke=\"{stroke}\"/>");
        let _ =
            writeln!(svg, "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{albedo:.1}</text>", left - 7.0, at + 4.0);
    }
    let _ = writeln!(svg, "<path d=\"M{left:.1} {ceiling:.1}V{floor:.1}H{right:.1}\" fill=\"none\" stroke=\"black\"/>");
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">angle of incidence</text>",
        0.5 * (left + right),
        floor + 36.0
    );
    let middle = 0.5 * (floor + ceiling);
    let _ = writeln!(
        svg,
        "<text x=\"16\" y=\"{middle:.1}\" text-anchor=\"middle\" transform=\"rotate(-90 16 {middle:.1})\">directional albedo E</text>"
    );
}
