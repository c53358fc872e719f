//! What a device does at best: nanoseconds for a pixel that is filled, a lookup in a texture, an operation. And from them
//! the floor of a frame.

mod apparatus;
mod floor;
mod kinds;
mod probes;
mod work;

use super::clock::Basis;
use super::error::CliError;
use crate::gpu::Gpu;
use crate::gpu::formats::Precision;
use crate::progress::Progress;
use apparatus::Apparatus;
pub(super) use floor::{Floor, FloorOf};
pub(super) use kinds::{Fill, Target};
use kinds::{Op, Tap};
use serde::Serialize;
use std::fmt::Write;

/// Sides of the pictures that are filled: what the larger takes more is free of what a pass takes anyway.
const FILL_SIDES_PX: [u32; 2] = [512, 1024];
/// Side of the pictures on which lookups and operations are counted.
const SIDE_PX: u32 = 512;
/// Lookups that are compared with twice as many.
const TAPS: u32 = 8;

/// What single things take, ns a pixel.
#[derive(Debug)]
pub(super) struct Rates {
    pub(super) basis: Basis,
    fills: Vec<(Fill, f64)>,
    taps: [f64; Tap::ALL.len()],
    ops: [f64; Op::ALL.len()],
}

/// One of them, for a report.
#[derive(Debug, Serialize)]
pub(super) struct Rate {
    name: String,
    /// Nanoseconds a pixel, or for one lookup or operation of a pixel.
    ns: f64,
}

/// All of them, for a report.
#[derive(Debug, Serialize)]
pub(super) struct RatesReport {
    /// Which time this is.
    basis: Basis,
    fill: Vec<Rate>,
    taps: Vec<Rate>,
    arithmetic: Vec<Rate>,
}

impl Rates {
    /// Measures these fills, and everything else, in some seconds.
    ///
    /// # Errors
    /// When the device cannot draw into such a target, or fails.
    pub(super) fn measure(gpu: &Gpu, basis: Basis, fills: &[Fill], progress: &dyn Progress) -> Result<Self, CliError> {
        progress.begin("Measuring the device", (fills.len() + Tap::ALL.len() + Op::ALL.len()) as u64);
        let apparatus = Apparatus::new(gpu, basis);
        let mut rates = Self { basis, fills: Vec::new(), taps: [0.0; _], ops: [0.0; _] };
        let half = Fill { target: Target::Radiance(Precision::Half), samples: 1, depth: false };
        let any = apparatus.texture(Tap::Data);
        for &fill in fills {
            let [less, more] = FILL_SIDES_PX.map(|side| apparatus.probe(probes::fill(), fill, side, &any));
            let ms = apparatus.difference_ms(&less?, &more?)?;
            let pixels = FILL_SIDES_PX.map(|side| f64::from(side).powi(2));
            rates.fills.push((fill, ms * 1e6 / (pixels[1] - pixels[0])));
            progress.advance(1);
        }
        let pixels = f64::from(SIDE_PX).powi(2);
        for tap in Tap::ALL {
            let texture = apparatus.texture(tap);
            let [less, more] =
                [1, 2].map(|times| apparatus.probe(probes::taps(tap, times * TAPS), half, SIDE_PX, &texture));
            rates.taps[tap as usize] = apparatus.difference_ms(&less?, &more?)? * 1e6 / (pixels * f64::from(TAPS));
            progress.advance(1);
        }
        for op in Op::ALL {
            let count = probes::count_of(op);
            let probe = |times| {
                let (wgsl, beside) = probes::arithmetic(op, times * count);
                Ok::<_, CliError>((apparatus.probe(wgsl, half, SIDE_PX, &any)?, beside))
            };
            let ((less, beside), (more, _)) = (probe(1)?, probe(2)?);
            let ns = apparatus.difference_ms(&less, &more)? * 1e6 / (pixels * f64::from(count));
            // The multiply-add is measured first.
            rates.ops[op as usize] = (ns - beside * rates.ops[Op::MultiplyAdd as usize]).max(0.0);
            progress.advance(1);
        }
        Ok(rates)
    }

    /// Of a fill that was measured, ns a pixel.
    fn fill_ns(&self, wanted: Fill) -> Option<f64> {
        self.fills.iter().find(|(fill, _)| *fill == wanted).map(|(_, ns)| *ns)
    }

    pub(super) fn report(&self) -> RatesReport {
        let rate = |(name, ns): (String, f64)| Rate { name, ns };
        let taps = Tap::ALL.map(|tap| tap.name().to_owned()).into_iter().zip(self.taps);
        let ops = Op::ALL.map(|op| op.name().to_owned()).into_iter().zip(self.ops);
        RatesReport {
            basis: self.basis,
            fill: self.fills.iter().map(|(fill, ns)| rate((fill.name(), *ns))).collect(),
            taps: taps.map(rate).collect(),
            arithmetic: ops.map(rate).collect(),
        }
    }
}

impl RatesReport {
    /// For people.
    pub(super) fn text(&self) -> String {
        let Self { basis, fill, taps, arithmetic } = self;
        let mut text = format!("  ns of {}, the empty pass taken out\n", basis.name());
        // Writing to a String cannot fail.
        for (what, rates) in [("fill a pixel", fill), ("a lookup", taps), ("an operation", arithmetic)] {
            for Rate { name, ns } in rates {
                let _ = writeln!(text, "  {ns:>12.3}  {what}: {name}");
            }
        }
        text
    }
}
