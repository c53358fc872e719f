//! Thresholds: what measurements of a case have to be, and who says so.

use super::report::MetricReport;
use crate::cli::compare::conditions::{Condition, share};
use crate::cli::compare::measure::{Measured, Metric};
use crate::metrics::difference::pixel_max_abs;
use crate::metrics::{ErrorMap, Pair};
use crate::scene::Encoding;

/// Steps of an 8-bit channel.
const STEPS: f64 = 255.0;

/// A condition as `specula compare --fail` has it, with two differences: `max-abs` counts steps of 255, and
/// `max-abs <= 24 @ 0.05%` lets so large a share of the pixels differ by more. `flip.max` can have a share too.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Limit {
    condition: Condition,
    /// Share of the pixels in [0, 1) that need not meet the condition; the condition is of single pixels then.
    exceptions: Option<f64>,
    /// The place where it is written.
    from: String,
}

/// What a golden and a picture of the same size have turned out to be.
#[derive(Debug, Clone, Copy)]
pub(super) enum Compared<'a> {
    /// Bit for bit.
    Equal,
    Different {
        pair: &'a Pair<'a>,
        measured: &'a Measured,
    },
}

impl Limit {
    /// # Errors
    /// What is wrong with the text.
    pub(super) fn parse(text: &str, from: String) -> Result<Self, String> {
        let (text, exceptions) = match text.split_once('@') {
            Some((text, of)) => (text, Some(exceptions(of)?)),
            None => (text, None),
        };
        let condition: Condition = text.parse()?;
        let Condition { name, bound, metric, .. } = &condition;
        if !metric.suits(Encoding::Srgb) {
            return Err(format!("{name} is for radiance; goldens are PNGs: take flip.mean, flip.p99 or flip.max"));
        }
        if *metric == Metric::MaxAbs && !(*bound == 0.0 || (1.0..=STEPS).contains(bound)) {
            return Err(format!("max-abs counts steps of 255 here: take 0, or 1 to 255, instead of {bound}"));
        }
        if exceptions.is_some() && !(condition.is_upper_bound() && ["max-abs", "flip.max"].contains(&name.as_str())) {
            return Err(format!(
                "`@` is for upper bounds on max-abs and flip.max, which single pixels have; leave it out of {name}"
            ));
        }
        Ok(Self { condition, exceptions, from })
    }

    pub(super) fn metric(&self) -> Metric {
        self.condition.metric
    }

    /// Holds the limit against what was found.
    pub(super) fn check(&self, compared: Compared<'_>) -> MetricReport {
        let Condition { name, metric, .. } = &self.condition;
        let (value, remark) = match compared {
            Compared::Equal if self.exceptions.is_some() => (Some(0.0), String::new()),
            Compared::Equal => (Some(metric.of_equal_pictures()), "bit for bit the same".to_owned()),
            Compared::Different { pair, measured } if self.exceptions.is_some() => {
                (self.share_beyond(pair, measured.flip_map.as_ref()), "share of the pixels".to_owned())
            }
            Compared::Different { measured, .. } => {
                let found = measured.measurements.iter().find(|measurement| measurement.name == name);
                let value = found.and_then(|found| found.value).map(|value| in_units(*metric, value));
                (value, found.map_or_else(String::new, |found| found.remark.clone()))
            }
        };
        let sign = self.condition.sign();
        let (name, comparison, limit, holds) = match self.exceptions {
            None => (name.clone(), sign, self.condition.bound, value.is_some_and(|value| self.condition.holds(value))),
            Some(share) => {
                let broken = if sign == "<" { ">=" } else { ">" };
                let name = format!("{name} {broken} {}", self.condition.bound);
                (name, "<=", share, value.is_some_and(|value| value <= share))
            }
        };
        MetricReport {
            name,
            value: value.filter(|value| value.is_finite()),
            comparison: comparison.to_owned(),
            limit,
            limit_from: self.from.clone(),
            holds,
            remark,
        }
    }

    /// Share of the pixels that count and do not meet the condition by themselves.
    fn share_beyond(&self, pair: &Pair<'_>, flip: Option<&ErrorMap>) -> Option<f64> {
        let of_pixel = |index: usize| match self.metric() {
            Metric::MaxAbs => Some(in_units(Metric::MaxAbs, pixel_max_abs(pair, index))),
            _ => flip.map(|map| map.values[index]),
        };
        let (mut beyond, mut count) = (0_u64, 0_u64);
        for index in pair.selected() {
            beyond += u64::from(!self.condition.holds(of_pixel(index)?));
            count += 1;
        }
        Some(beyond as f64 / count as f64)
    }
}

/// A measurement in the unit of its limits. Steps are whole but for pixels that are partly covered; what f32 has made of
/// them is rounded off.
fn in_units(metric: Metric, value: f64) -> f64 {
    if metric == Metric::MaxAbs { (value * STEPS * 1e3).round() / 1e3 } else { value }
}

fn exceptions(text: &str) -> Result<f64, String> {
    share(text)
        .filter(|share| (0.0..1.0).contains(share))
        .ok_or_else(|| format!("`{}` is no share of the pixels, such as 0.05%", text.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::compare::measure::measure;
    use crate::scene::Picture;
    use glam::Vec4;

    fn limit(text: &str) -> Result<Limit, String> {
        Limit::parse(text, "s.toml:3".into())
    }

    /// 32 x 32 grey pixels; the first `count` are lighter by `steps`.
    fn picture(count: usize, steps: f32) -> Picture {
        let texel = |i: usize| Vec4::splat((100.0 + if i < count { steps } else { 0.0 }) / 255.0).with_w(1.0);
        Picture { width: 32, height: 32, encoding: Encoding::Srgb, texels: (0..1024).map(texel).collect() }
    }

    fn check(text: &str, count: usize, steps: f32) -> MetricReport {
        let (limit, actual, expected) = (limit(text).unwrap(), picture(count, steps), picture(0, 0.0));
        let pair = Pair::new(&actual, &expected, None).unwrap();
        let measured = measure(&pair, &[limit.metric()]);
        limit.check(Compared::Different { pair: &pair, measured: &measured })
    }

    #[test]
    fn largest_differences_count_steps() {
        assert!(check("max-abs <= 24", 1, 24.0).holds);
        let report = check("max-abs <= 24", 1, 25.0);
        assert!(!report.holds && report.value == Some(25.0) && report.limit == 24.0, "{report:?}");
        assert_eq!(report.limit_from, "s.toml:3");
    }

    #[test]
    fn a_share_of_the_pixels_may_differ_by_more() {
        assert!(check("max-abs <= 24 @ 0.2%", 2, 200.0).holds);
        let report = check("max-abs <= 24 @ 0.2%", 3, 200.0);
        assert!(!report.holds && report.value == Some(3.0 / 1024.0) && report.name == "max-abs > 24", "{report:?}");
        assert!(check("max-abs <= 24 @ 0%", 1024, 24.0).holds && !check("max-abs < 24 @ 0%", 1, 24.0).holds);
        assert!(check("flip.max <= 0.9 @ 0%", 1024, 10.0).holds && !check("flip.max <= 0.01 @ 1%", 1024, 50.0).holds);
    }

    #[test]
    fn equal_pictures_meet_what_they_can() {
        for text in ["max-abs <= 0", "flip.mean <= 0", "psnr >= 99", "ssim >= 1", "max-abs <= 0 @ 0%", "pixels <= 0"] {
            assert!(limit(text).unwrap().check(Compared::Equal).holds, "{text}");
        }
        assert!(!limit("max-abs > 1").unwrap().check(Compared::Equal).holds);
    }

    #[test]
    fn what_would_check_nothing_is_refused() {
        for (text, expected) in [
            ("max-abs <= 0.1", "steps of 255"),
            ("max-abs <= 256", "steps of 255"),
            ("max-abs <= 24 @ 100%", "no share"),
            ("max-abs <= 24 @", "no share"),
            ("flip.mean <= 0.1 @ 1%", "single pixels"),
            ("max-abs >= 2 @ 1%", "upper bounds"),
            ("hdr-flip.mean <= 1", "for radiance"),
            ("flip <= 1", "no measurement"),
        ] {
            let error = limit(text).unwrap_err();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
