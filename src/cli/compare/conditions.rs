//! What must hold: `flip.mean<=0.01`.

use super::measure::{Measured, Metric};
use crate::cli::error::CliError;
use std::fmt;
use std::str::FromStr;

/// A bound on a measurement.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::cli) struct Condition {
    /// `max-abs`, `flip.p99`.
    pub(in crate::cli) name: String,
    /// What the name belongs to.
    pub(in crate::cli) metric: Metric,
    comparison: Comparison,
    pub(in crate::cli) bound: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Comparison {
    AtMost,
    AtLeast,
    Below,
    Above,
}

/// Longer signs first: `<` begins `<=`.
const SIGNS: [(&str, Comparison); 4] =
    [("<=", Comparison::AtMost), (">=", Comparison::AtLeast), ("<", Comparison::Below), (">", Comparison::Above)];

impl Condition {
    /// Whether small measurements are good ones.
    pub(in crate::cli) fn is_upper_bound(&self) -> bool {
        matches!(self.comparison, Comparison::AtMost | Comparison::Below)
    }

    /// `<=`, `<`, `>=` or `>`.
    pub(in crate::cli) fn sign(&self) -> &'static str {
        SIGNS.iter().find(|(_, comparison)| *comparison == self.comparison).map_or("", |(sign, _)| sign)
    }

    pub(in crate::cli) fn holds(&self, value: f64) -> bool {
        match self.comparison {
            Comparison::AtMost => value <= self.bound,
            Comparison::AtLeast => value >= self.bound,
            Comparison::Below => value < self.bound,
            Comparison::Above => value > self.bound,
        }
    }
}

impl FromStr for Condition {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let split = SIGNS.iter().find_map(|&(sign, comparison)| Some((text.split_once(sign)?, comparison)));
        let Some(((name, bound), comparison)) = split else {
            return Err(format!("{text:?} is no condition; write one such as flip.mean<=0.01"));
        };
        let (name, bound) = (name.trim(), bound.trim());
        let metric = Metric::of_measurement(name).ok_or_else(|| {
            format!("{name:?} is no measurement; there are {}", Metric::all_measurements().join(", "))
        })?;
        let bound = share(bound).ok_or_else(|| format!("{bound:?} is no number to compare {name} with"))?;
        Ok(Self { name: name.to_owned(), metric, comparison, bound })
    }
}

/// `0.5` or `50%`.
pub(in crate::cli) fn share(text: &str) -> Option<f64> {
    let (number, unit) = text.trim().strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    Some(number.trim().parse::<f64>().ok().filter(|number| number.is_finite())? * unit)
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.sign(), self.bound)
    }
}

/// The conditions that do not hold, with what was measured.
pub(in crate::cli) fn broken<'a>(
    conditions: &'a [Condition],
    measured: &Measured,
) -> Result<Vec<(&'a Condition, f64)>, CliError> {
    let mut broken = Vec::new();
    for condition in conditions {
        let value = measured.value(&condition.name).ok_or_else(|| {
            CliError::Usage(format!("{} cannot be measured: the counted pixels hold no whole window", condition.name))
        })?;
        if !condition.holds(value) {
            broken.push((condition, value));
        }
    }
    Ok(broken)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_parse_and_hold() {
        let parse = |text: &str| text.parse::<Condition>().unwrap();
        let condition = parse(" flip.mean <= 0.01 ");
        assert_eq!((condition.name.as_str(), condition.metric), ("flip.mean", Metric::Flip));
        assert!(condition.holds(0.01) && !condition.holds(0.011) && !condition.holds(f64::INFINITY));
        assert!(
            parse("psnr>=40").holds(f64::INFINITY) && parse("psnr>=40").holds(40.0) && !parse("psnr>=40").holds(39.0)
        );
        assert!(!parse("max-abs<0.5").holds(0.5) && parse("max-abs<0.5").holds(0.4));
        assert!(!parse("ssim>0.5").holds(0.5) && parse("ssim>0.5").holds(0.6));
        assert!(parse("pixels<=0.5%").holds(0.005) && !parse("pixels<=0.5%").holds(0.006));
        assert_eq!(parse("pixels<=0.5").to_string(), "<= 0.5");
    }

    #[test]
    fn what_is_no_condition_is_refused() {
        for (text, expected) in [
            ("", "no condition"),
            ("flip.mean", "no condition"),
            ("flip.mean=0.1", "no condition"),
            ("flip<=0.1", "no measurement"),
            ("beauty<=1", "no measurement"),
            ("flip.mean<=", "no number"),
            ("flip.mean<=x", "no number"),
            ("flip.mean<=NaN", "no number"),
            ("flip.mean<=inf", "no number"),
            ("flip.mean<==1", "no number"),
        ] {
            let error = text.parse::<Condition>().unwrap_err();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
