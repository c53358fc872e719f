//! Which metrics suit a pair, and what they say.

use super::conditions::Condition;
use super::kind;
use crate::cli::error::CliError;
use crate::metrics::flip::{flip, hdr_flip};
use crate::metrics::{ErrorMap, Pair, difference, ssim};
use crate::scene::Encoding;
use clap::ValueEnum;

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Metric {
    /// Share of the pixels that differ at all.
    Pixels,
    /// Largest difference of one channel, alpha included, in the numbers of the files.
    MaxAbs,
    /// Root mean square difference over root mean square of the expected picture, in linear light.
    RelativeRms,
    /// Peak signal-to-noise ratio in dB (PNG).
    Psnr,
    /// Structural similarity of the luma, Wang et al. 2004 (PNG).
    Ssim,
    /// Difference as seen by people, Andersson et al. 2020 (PNG).
    Flip,
    /// The same for radiance, over all exposures that matter, Andersson et al. 2021 (EXR).
    HdrFlip,
}

impl Metric {
    /// The names of what it measures.
    fn measurements(self) -> &'static [&'static str] {
        match self {
            Self::Pixels => &["pixels"],
            Self::MaxAbs => &["max-abs"],
            Self::RelativeRms => &["relative-rms"],
            Self::Psnr => &["psnr"],
            Self::Ssim => &["ssim"],
            Self::Flip => &["flip.mean", "flip.median", "flip.p99", "flip.max"],
            Self::HdrFlip => &["hdr-flip.mean", "hdr-flip.median", "hdr-flip.p99", "hdr-flip.max"],
        }
    }

    pub(in crate::cli) fn of_measurement(name: &str) -> Option<Self> {
        Self::value_variants().iter().copied().find(|metric| metric.measurements().contains(&name))
    }

    /// What [`measure`] finds between a picture and itself.
    pub(in crate::cli) fn of_equal_pictures(self) -> f64 {
        match self {
            Self::Pixels | Self::MaxAbs | Self::RelativeRms | Self::Flip | Self::HdrFlip => 0.0,
            Self::Psnr => f64::INFINITY,
            Self::Ssim => 1.0,
        }
    }

    pub(in crate::cli) fn all_measurements() -> Vec<&'static str> {
        Self::value_variants().iter().flat_map(|metric| metric.measurements()).copied().collect()
    }

    pub(in crate::cli) fn suits(self, encoding: Encoding) -> bool {
        match self {
            Self::Pixels | Self::MaxAbs | Self::RelativeRms => true,
            Self::Psnr | Self::Ssim | Self::Flip => encoding == Encoding::Srgb,
            Self::HdrFlip => encoding == Encoding::Linear,
        }
    }
}

/// The metrics that were asked for, by name, by a condition or by the heat map; all that suit the pictures if no name
/// was given.
pub(in crate::cli) fn chosen(
    named: &[Metric],
    conditions: &[Condition],
    heat_map: bool,
    encoding: Encoding,
) -> Result<Vec<Metric>, CliError> {
    let asked = |metric: &Metric| named.contains(metric) || conditions.iter().any(|c| c.metric == *metric);
    if let Some(metric) = Metric::value_variants().iter().find(|metric| asked(metric) && !metric.suits(encoding)) {
        let name = metric.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
        let instead = if *metric == Metric::HdrFlip { "flip" } else { "hdr-flip, relative-rms or max-abs" };
        return Err(CliError::Usage(format!("{name} is not for pictures that are {}; take {instead}", kind(encoding))));
    }
    let for_heat_map = |metric: &Metric| heat_map && matches!(metric, Metric::Flip | Metric::HdrFlip);
    let wanted = |metric: &Metric| named.is_empty() || asked(metric) || for_heat_map(metric);
    Ok(Metric::value_variants().iter().copied().filter(|m| m.suits(encoding) && wanted(m)).collect())
}

/// A number with its name, and what else there is to say about it.
#[derive(Debug)]
pub(in crate::cli) struct Measurement {
    pub(in crate::cli) name: &'static str,
    /// `None` where the picture is too small for it.
    pub(in crate::cli) value: Option<f64>,
    pub(in crate::cli) remark: String,
}

#[derive(Debug)]
pub(in crate::cli) struct Measured {
    pub(in crate::cli) measurements: Vec<Measurement>,
    /// Share of the pixels that differ, whatever was asked for.
    pub(in crate::cli) differing: f64,
    /// The FLIP error of every pixel, if that was among the metrics.
    pub(in crate::cli) flip_map: Option<ErrorMap>,
}

impl Measured {
    pub(in crate::cli) fn value(&self, name: &str) -> Option<f64> {
        self.measurements.iter().find(|measurement| measurement.name == name)?.value
    }

    fn push(&mut self, metric: Metric, values: &[(Option<f64>, String)]) {
        let named = metric.measurements().iter().zip(values);
        self.measurements.extend(named.map(|(name, (value, remark))| Measurement {
            name,
            value: *value,
            remark: remark.clone(),
        }));
    }
}

pub(in crate::cli) fn measure(pair: &Pair<'_>, metrics: &[Metric]) -> Measured {
    let differing = difference::differing_pixels(pair);
    let mut measured = Measured { measurements: Vec::new(), differing, flip_map: None };
    for &metric in metrics {
        match metric {
            Metric::Pixels => measured.push(metric, &[(Some(differing), "share that differs".into())]),
            Metric::MaxAbs => {
                let worst = difference::max_abs(pair);
                let ((x, y), channel) = (worst.at, worst.channel);
                let remark = format!("{channel} of pixel ({x}, {y}): {} against {}", worst.actual, worst.expected);
                measured.push(metric, &[(Some(worst.value), remark_if(worst.value > 0.0, remark))]);
            }
            Metric::RelativeRms => {
                measured.push(metric, &[(Some(difference::relative_rms(pair)), "in linear light".into())]);
            }
            Metric::Psnr => measured.push(metric, &[(Some(difference::psnr_db(pair)), "dB".into())]),
            Metric::Ssim => measured.push(metric, &[(ssim::mean_ssim(pair), "of luma".into())]),
            Metric::Flip | Metric::HdrFlip => {
                let map = if metric == Metric::Flip { flip(pair) } else { hdr_flip(pair) };
                let pool = map.pool(pair);
                let (x, y) = pool.max_at;
                let plain = |value: f64| (Some(value), String::new());
                let worst = (Some(pool.max), remark_if(pool.max > 0.0, format!("pixel ({x}, {y})")));
                measured.push(metric, &[plain(pool.mean), plain(pool.median), plain(pool.p99), worst]);
                measured.flip_map = Some(map);
            }
        }
    }
    measured
}

/// No place is the worst where all are right.
fn remark_if(worth_it: bool, remark: String) -> String {
    if worth_it { remark } else { String::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Picture;
    use glam::Vec4;

    #[test]
    fn a_picture_is_equal_to_itself() {
        for encoding in [Encoding::Srgb, Encoding::Linear] {
            let texels = (0..24 * 24).map(|i| Vec4::new((i % 7) as f32 / 7.0, (i % 24) as f32 / 24.0, 0.5, 1.0));
            let picture = Picture { width: 24, height: 24, encoding, texels: texels.collect() };
            let pair = Pair::new(&picture, &picture, None).unwrap();
            for metric in Metric::value_variants().iter().filter(|metric| metric.suits(encoding)) {
                for name in metric.measurements() {
                    assert_eq!(measure(&pair, &[*metric]).value(name), Some(metric.of_equal_pictures()), "{name}");
                }
            }
        }
    }
}
