//! Error over time, as SVG: both axes logarithmic, the front drawn through, the base ringed.

use super::report::{Figure, Report, Row};
use crate::cli::svg::{document, escape, ramp};
use crate::scene::Quality;
use std::fmt::Write;

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 500.0;
const PICTURE_WIDTH: f64 = 640.0;
const LEFT: f64 = 72.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 72.0;
const BOTTOM: f64 = 56.0;
const MARKER: f64 = 5.0;
const RING: f64 = 10.0;
/// Of a label, per character (bold on the front) and in all.
const CHARACTER_WIDTH: f64 = 6.0;
const BOLD_WIDTH: f64 = 6.8;
const LABEL_HEIGHT: f64 = 13.0;

/// A point of the picture.
type Point = (f64, f64);

/// A box: left, top, right, bottom.
type Rectangle = [f64; 4];

/// A logarithmic axis between two places of the picture.
struct Axis {
    low: f64,
    high: f64,
    start: f64,
    end: f64,
}

impl Axis {
    /// Room for all `values`, with a tenth of their span on both sides.
    fn around(values: impl Iterator<Item = f64>, (start, end): (f64, f64)) -> Self {
        let logs = values.filter(|value| *value > 0.0 && value.is_finite()).map(f64::ln);
        let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
        let margin = (0.1 * (high - low)).max(0.1);
        Self { low: low - margin, high: high + margin, start, end }
    }

    fn at(&self, value: f64) -> f64 {
        self.start + (self.end - self.start) * (value.ln() - self.low) / (self.high - self.low)
    }

    /// A few round numbers on the axis: of a decade where it spans some, else at even steps.
    fn ticks(&self) -> Vec<f64> {
        let (low, high) = (self.low.exp(), self.high.exp());
        if high < 4.0 * low {
            return even_ticks(low, high);
        }
        let steps: [&[f64]; 3] = [&[1.0], &[1.0, 2.0, 5.0], &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0]];
        let decades = low.log10().floor() as i32..=high.log10().ceil() as i32;
        let of = |steps: &[f64]| -> Vec<f64> {
            let all = decades.clone().flat_map(|decade| steps.iter().map(move |step| step * 10_f64.powi(decade)));
            all.filter(|tick| (low..=high).contains(tick)).collect()
        };
        steps.iter().map(|steps| of(steps)).find(|ticks| ticks.len() >= 4).unwrap_or_else(|| of(steps[2]))
    }
}

/// Multiples of 1, 2 or 5 times a power of ten, 3 to 9 of them.
fn even_ticks(low: f64, high: f64) -> Vec<f64> {
    let rough = (high - low) / 8.0;
    let power = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|s| s * power).into_iter().find(|step| *step >= rough).unwrap_or(rough);
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(|multiple| multiple as f64 * step).collect()
}

/// What one panel shows.
struct Panel<'a> {
    /// Where its area begins.
    left: f64,
    right: f64,
    what: &'static str,
    rows: Vec<Mark<'a>>,
}

/// One setting in a panel.
struct Mark<'a> {
    row: &'a Row,
    name: &'a str,
    error: &'a Figure,
    is_on_front: bool,
    is_base: bool,
}

impl Mark<'_> {
    fn point(&self) -> Option<Point> {
        let point = (self.row.ratio, self.error.upper);
        (point.0 > 0.0 && point.1 > 0.0).then_some(point)
    }
}

pub(super) fn svg(report: &Report) -> String {
    let rows = || report.settings.iter().enumerate();
    let pictures = rows().map(|(index, row)| {
        let (error, is_on_front) = (&row.picture_error, row.is_on_picture_front);
        Mark { row, name: &row.name, error, is_on_front, is_base: index == 0 }
    });
    let lights = rows().filter_map(|(index, row)| {
        let (error, is_on_front) = (&row.shading_error, row.is_on_shading_front?);
        Some(Mark { row, name: &row.light_name, error, is_on_front, is_base: index == 0 })
    });
    let middle = LEFT + PICTURE_WIDTH;
    let panels = [
        Panel { left: LEFT, right: middle, what: "picture", rows: pictures.collect() },
        Panel { left: middle + LEFT, right: WIDTH - RIGHT, what: "light alone", rows: lights.collect() },
    ];
    let panels: String = panels.into_iter().map(|panel| draw(panel, report.basis.name())).collect();
    document(WIDTH, HEIGHT, &(title(report) + &panels))
}

fn draw(mut panel: Panel<'_>, time: &str) -> String {
    panel.rows.retain(|mark| mark.point().is_some());
    let values: Vec<Point> = panel.rows.iter().filter_map(Mark::point).collect();
    let x = Axis::around(values.iter().map(|value| value.0), (panel.left, panel.right));
    let y = Axis::around(values.iter().map(|value| value.1), (HEIGHT - BOTTOM, TOP));
    let points: Vec<Point> = values.iter().map(|value| (x.at(value.0), y.at(value.1))).collect();
    let area = [panel.left + 2.0, TOP, panel.right + RIGHT - 4.0, HEIGHT - BOTTOM - 2.0];
    let mut body = String::new();
    axes(&mut body, (&x, &y), (time, panel.what));
    front_line(&mut body, &front(&panel.rows, &points));
    let labels =
        labels(&label_widths(&panel.rows), &points, &by_importance(&panel.rows), (&area, &front(&panel.rows, &points)));
    for (label, point) in labels.iter().zip(&points) {
        leader(&mut body, label, *point);
    }
    for (mark, point) in panel.rows.iter().zip(&points) {
        marker(&mut body, mark, *point);
    }
    for (label, mark) in labels.iter().zip(&panel.rows) {
        write_label(&mut body, label, mark);
    }
    body
}

fn ring((x, y): Point, radius: f64) -> String {
    format!(
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"none\" stroke=\"#c02020\" stroke-width=\"1.6\"/>"
    )
}

fn title(report: &Report) -> String {
    let model = std::path::Path::new(&report.model)
        .file_name()
        .map_or(report.model.clone(), |name| name.to_string_lossy().into());
    let [width, height] = report.size_px;
    let mut text = format!(
        "<text x=\"{LEFT}\" y=\"24\" font-size=\"15\">{} under {}, {width} x {height} pixels</text>\n",
        escape(&model),
        escape(&report.environment)
    );
    let mut at = LEFT + MARKER;
    for quality in Quality::ALL {
        let _ = writeln!(text, "<circle cx=\"{at:.1}\" cy=\"45\" r=\"{MARKER}\" fill=\"{}\"/>", color(quality.name()));
        at = legend_entry(&mut text, at, quality.name());
    }
    for sampling in ["1 sample", "MSAA", "SSAA", "SSAA+MSAA"] {
        let _ = writeln!(text, "{}", shape(sampling, (at, 45.0), "fill=\"#777777\""));
        at = legend_entry(&mut text, at, sampling);
    }
    text += &ring((at, 45.0), 7.0);
    let at = legend_entry(&mut text, at, "base");
    let _ = writeln!(text, "<path d=\"M{:.1} 45h18\" stroke=\"#333333\" stroke-width=\"1.4\"/>", at - MARKER);
    legend_entry(&mut text, at + 12.0, "front");
    text
}

/// The name beside a symbol; returns where the next symbol goes.
fn legend_entry(text: &mut String, at: f64, name: &str) -> f64 {
    let _ = writeln!(text, "<text x=\"{:.1}\" y=\"49\">{name}</text>", at + 10.0);
    let width = |c: char| if c.is_uppercase() { 8.4 } else { 6.9 };
    at + 30.0 + name.chars().map(width).sum::<f64>()
}

fn color(quality: &str) -> String {
    let index = Quality::ALL.iter().position(|tier| tier.name() == quality).unwrap_or(0);
    ramp(index as f64 / (Quality::ALL.len() - 1) as f64)
}

/// A symbol for how edges are smoothed.
fn shape(sampling: &str, (x, y): Point, style: &str) -> String {
    let r = MARKER;
    match sampling {
        "1 sample" => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{r}\" {style}/>"),
        "MSAA" => format!(
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{}\" height=\"{}\" {style}/>",
            x - 0.9 * r,
            y - 0.9 * r,
            1.8 * r,
            1.8 * r
        ),
        "SSAA" => {
            format!("<path d=\"M{x:.1} {:.1}l{:.1} {:.1}h{:.1}z\" {style}/>", y - 1.2 * r, 1.15 * r, 2.0 * r, -2.3 * r)
        }
        _ => format!("<path d=\"M{x:.1} {:.1}l{d} {d}l-{d} {d}l-{d} -{d}z\" {style}/>", y - 1.25 * r, d = 1.25 * r),
    }
}

/// Hollow where the error does not stand out from the noise of the truth.
fn marker(body: &mut String, mark: &Mark<'_>, point: Point) {
    let color = color(mark.row.quality);
    let fill = if mark.error.is_visible { color.as_str() } else { "white" };
    let style = format!("fill=\"{fill}\" stroke=\"{color}\" stroke-width=\"1.4\"");
    let _ = writeln!(body, "{}", shape(mark.row.sampling, point, &style));
    if mark.is_base {
        let _ = writeln!(body, "{}", ring(point, RING));
    }
}

/// The points on the front, by time.
fn front(rows: &[Mark<'_>], points: &[Point]) -> Vec<Point> {
    let marks = rows.iter().zip(points).filter(|(mark, _)| mark.is_on_front);
    let mut front: Vec<Point> = marks.map(|(_, point)| *point).collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    front
}

fn front_line(body: &mut String, front: &[Point]) {
    let points: Vec<String> = front.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(
        body,
        "<polyline fill=\"none\" stroke=\"#333333\" stroke-width=\"1.4\" points=\"{}\"/>",
        points.join(" ")
    );
}

/// Grid lines, ticks with their numbers, and what the axes are.
fn axes(body: &mut String, (x, y): (&Axis, &Axis), (time, what): (&str, &str)) {
    let (left, right, floor, ceiling) = (x.start, x.end, y.start, y.end);
    for tick in x.ticks() {
        let (at, number) = (x.at(tick), number(tick));
        let _ = writeln!(body, "<path d=\"M{at:.1} {ceiling:.1}V{floor:.1}\" stroke=\"#e4e4e4\"/>");
        let _ = writeln!(body, "<text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{number}</text>", floor + 17.0);
    }
    for tick in y.ticks() {
        let (at, number) = (y.at(tick), number(100.0 * tick));
        let _ = writeln!(body, "<path d=\"M{left:.1} {at:.1}H{right:.1}\" stroke=\"#e4e4e4\"/>");
        let _ =
            writeln!(body, "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{number} %</text>", left - 7.0, at + 4.0);
    }
    let _ =
        writeln!(body, "<path d=\"M{left:.1} {ceiling:.1}V{floor:.1}H{right:.1}\" fill=\"none\" stroke=\"black\"/>");
    let middle = 0.5 * (left + right);
    let _ = writeln!(
        body,
        "<text x=\"{middle:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{time} of a frame, relative to the base</text>",
        floor + 40.0
    );
    let middle = 0.5 * (floor + ceiling);
    let _ = writeln!(
        body,
        "<text x=\"{at:.1}\" y=\"{middle:.1}\" text-anchor=\"middle\" transform=\"rotate(-90 {at:.1} {middle:.1})\">{what}, RMS of the relative error</text>",
        at = left - 54.0,
    );
}

/// Without the last digits of a rounded product.
fn number(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6)
}

/// How wide the label of each row is.
fn label_widths(rows: &[Mark<'_>]) -> Vec<f64> {
    let per_character = |mark: &Mark<'_>| if mark.is_on_front { BOLD_WIDTH } else { CHARACTER_WIDTH };
    rows.iter().map(|mark| per_character(mark) * mark.name.chars().count() as f64).collect()
}

/// The order in which labels choose their places: the base, the front, the rest.
fn by_importance(rows: &[Mark<'_>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by_key(|&i| (!rows[i].is_base, !rows[i].is_on_front));
    order
}

/// Where labels go: beside their points, not on each other, not on points and, if that can be, not on the front line.
/// `None` where there is no room.
fn labels(
    widths: &[f64],
    points: &[Point],
    order: &[usize],
    (area, line): (&Rectangle, &[Point]),
) -> Vec<Option<Rectangle>> {
    let mut placed: Vec<Option<Rectangle>> = vec![None; widths.len()];
    let mut taken: Vec<Rectangle> = points.iter().map(|point| around(*point, MARKER + 1.0)).collect();
    // The base comes first, and has its ring.
    taken.extend(order.first().map(|&base| around(points[base], RING)));
    for &i in order {
        let free = |place: &Rectangle| is_inside(place, area) && !taken.iter().any(|other| overlap(place, other));
        let crosses = |place: &Rectangle| line.windows(2).any(|ends| crosses(place, ends[0], ends[1]));
        let places = || candidates(points[i], widths[i]);
        placed[i] = places().find(|place| free(place) && !crosses(place)).or_else(|| places().find(free));
        taken.extend(placed[i]);
    }
    placed
}

fn around((x, y): Point, r: f64) -> Rectangle {
    [x - r, y - r, x + r, y + r]
}

/// Boxes around a point, the nearest first.
fn candidates((x, y): Point, width: f64) -> impl Iterator<Item = Rectangle> {
    const DIRECTIONS: [Point; 8] =
        [(1.0, 0.0), (-1.0, 0.0), (0.8, -0.6), (0.8, 0.6), (-0.8, -0.6), (-0.8, 0.6), (0.0, -1.0), (0.0, 1.0)];
    [12.0, 18.0, 26.0, 36.0, 48.0, 64.0, 84.0].into_iter().flat_map(move |radius| {
        DIRECTIONS.into_iter().map(move |(dx, dy)| {
            let (at_x, middle_y) = (x + radius * dx, y + radius * dy);
            // The near end of the text is at the place, or its middle straight above and below.
            let left = at_x - width * 0.5 * (1.0 - f64::signum(dx) * f64::from(u8::from(dx != 0.0)));
            [left, middle_y - 0.5 * LABEL_HEIGHT, left + width, middle_y + 0.5 * LABEL_HEIGHT]
        })
    })
}

/// Whether the line from `a` to `b` goes through a place, looked at every few pixels.
fn crosses(place: &Rectangle, a: Point, b: Point) -> bool {
    let steps = ((b.0 - a.0).hypot(b.1 - a.1) / 3.0).ceil().max(1.0);
    (0..=steps as u32).map(|i| f64::from(i) / steps).any(|t| {
        let at = (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
        overlap(place, &around(at, 0.5))
    })
}

fn overlap(a: &Rectangle, b: &Rectangle) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

fn is_inside(place: &Rectangle, area: &Rectangle) -> bool {
    place[0] > area[0] && place[1] > area[1] && place[2] < area[2] && place[3] < area[3]
}

/// A thin line from a point to a label that is not right beside it.
fn leader(body: &mut String, label: &Option<Rectangle>, (x, y): Point) {
    let Some([left, top, right, bottom]) = *label else { return };
    let (to_x, to_y) = (x.clamp(left, right), y.clamp(top, bottom));
    if (to_x - x).hypot(to_y - y) > 14.0 {
        let _ =
            writeln!(body, "<path d=\"M{x:.1} {y:.1}L{to_x:.1} {to_y:.1}\" stroke=\"#aaaaaa\" stroke-width=\"0.8\"/>");
    }
}

fn write_label(body: &mut String, label: &Option<Rectangle>, mark: &Mark<'_>) {
    let Some([left, _, _, bottom]) = label else { return };
    let weight = if mark.is_on_front { "bold" } else { "normal" };
    let _ = writeln!(
        body,
        "<text x=\"{left:.1}\" y=\"{:.1}\" font-size=\"11\" font-weight=\"{weight}\">{}</text>",
        bottom - 3.0,
        escape(mark.name)
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_hold_their_values_and_have_a_few_round_ticks() {
        for values in [[0.7, 4.0], [0.003, 0.3], [1.0, 1.0], [1e-5, 1e3], [0.9, 1.1], [0.041, 0.055], [0.29, 2.1]] {
            let axis = Axis::around(values.into_iter(), (100.0, 600.0));
            assert!(values.iter().all(|&value| (100.0..=600.0).contains(&axis.at(value))), "{values:?}");
            let ticks = axis.ticks();
            assert!((3..=10).contains(&ticks.len()), "{values:?}: {ticks:?}");
            assert!(ticks.is_sorted() && ticks.iter().all(|&tick| (100.0..=600.0).contains(&axis.at(tick))));
        }
    }

    #[test]
    fn labels_lie_neither_on_each_other_nor_on_points() {
        // A dense heap, a pair on the same spot, and one in a corner.
        let area = [50.0, 50.0, 700.0, 450.0];
        let mut points: Vec<Point> =
            (0..12).map(|i| (300.0 + f64::from(i % 4) * 9.0, 250.0 + f64::from(i / 4) * 11.0)).collect();
        points.extend([(500.0, 200.0), (500.0, 200.0), (697.0, 447.0)]);
        let order: Vec<usize> = (0..points.len()).collect();
        let placed = labels(&vec![110.0; points.len()], &points, &order, (&area, &[(60.0, 60.0), (690.0, 60.0)]));
        let boxes: Vec<Rectangle> = placed.iter().flatten().copied().collect();
        assert_eq!(boxes.len(), points.len(), "{placed:?}");
        for (i, label) in boxes.iter().enumerate() {
            assert!(is_inside(label, &area) && !boxes[..i].iter().any(|other| overlap(label, other)), "{label:?}");
            assert!(!points.iter().any(|point| overlap(label, &around(*point, MARKER + 1.0))), "{label:?}");
        }
    }
}
