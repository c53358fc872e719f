//! What a report says of its cases, worst first, in words that all its forms share.

use super::report::{CaseReport, MetricReport, Status, SuiteReport};
use super::text::broken;
use std::fmt::Write;

impl Status {
    pub(super) const ALL: [Self; 5] = [Self::Error, Self::Fail, Self::New, Self::Pass, Self::Skipped];

    /// States that fail the suite.
    pub(super) const BROKEN: [Self; 3] = [Self::Error, Self::Fail, Self::New];

    pub(super) fn is_broken(self) -> bool {
        Self::BROKEN.contains(&self)
    }

    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Skipped => "skipped",
            Self::Error => "error",
            Self::New => "new",
        }
    }
}

impl MetricReport {
    /// The value in units of its limit: above 1 it is broken, 0 is as good as can be. Infinite where there is no number.
    pub(super) fn excess(&self) -> f64 {
        let is_lower_limit = self.comparison.starts_with('>');
        let ratio = |a: f64, b: f64| if a <= 0.0 { 0.0 } else { a / b.max(0.0) };
        match self.value {
            // PSNR of equal pictures, which no limit refuses.
            None if self.holds => 0.0,
            None => f64::INFINITY,
            Some(value) if is_lower_limit => ratio(self.limit, value),
            Some(value) => ratio(value, self.limit),
        }
    }
}

impl CaseReport {
    /// Of the metric that is farthest from its limit.
    pub(super) fn worst(&self) -> Option<&MetricReport> {
        self.metrics.iter().max_by(|a, b| a.excess().total_cmp(&b.excess()))
    }

    /// What is wrong, a line each: the reason, then the limits that are broken.
    pub(super) fn complaints(&self) -> Vec<String> {
        let broken = self.metrics.iter().filter(|metric| !metric.holds).map(broken);
        let no_golden = (self.status == Status::New && self.reason.is_none()).then(|| "there is no golden yet".into());
        self.reason.iter().cloned().chain(no_golden).chain(broken).collect()
    }

    /// The same, and then what has moved.
    pub(super) fn account(&self) -> Vec<String> {
        let moved = self.moved.iter().map(|finding| format!("moved: {}", finding.text));
        self.complaints().into_iter().chain(moved).collect()
    }

    pub(super) fn milliseconds(&self) -> f64 {
        self.times.load_ms + self.times.draw_ms + self.times.judge_ms
    }
}

impl SuiteReport {
    /// Worst first: what is broken, what passes, what was skipped; each by how far it is from its limits. What has no
    /// number to be judged by is worse than any number.
    pub(super) fn by_error(&self) -> Vec<&CaseReport> {
        let mut cases: Vec<&CaseReport> = self.cases.iter().collect();
        let rank = |case: &CaseReport| match case.status {
            Status::Error | Status::Fail | Status::New => 0,
            Status::Pass => 1,
            Status::Skipped => 2,
        };
        let excess = |case: &CaseReport| match case.worst() {
            Some(metric) => metric.excess(),
            None if case.status.is_broken() => f64::INFINITY,
            None => 0.0,
        };
        cases.sort_by(|a, b| rank(a).cmp(&rank(b)).then(excess(b).total_cmp(&excess(a))).then(a.index.cmp(&b.index)));
        cases
    }

    /// `2 of 30 cases failed: 1 fail, 1 new; 1 skipped`.
    pub(super) fn summary(&self) -> String {
        let counts = |states: &[Status]| {
            let named = states.iter().map(|&status| (status, self.count(&[status]))).filter(|(_, count)| *count > 0);
            named.map(|(status, count)| format!("{count} {}", status.word())).collect::<Vec<_>>().join(", ")
        };
        let all = self.cases.len();
        let mut text = match self.count(&Status::BROKEN) {
            0 => format!("{} of {all} cases passed", self.count(&[Status::Pass])),
            broken => format!("{broken} of {all} cases failed: {}", counts(&Status::BROKEN)),
        };
        if self.count(&[Status::Skipped]) > 0 {
            let _ = write!(text, "; {}", counts(&[Status::Skipped]));
        }
        text
    }
}

/// A name from a stranger's file with what would hide or reorder it made visible: control characters, marks of direction,
/// spaces without width.
pub(super) fn visible(text: &str) -> String {
    let hides = |c: char| {
        c.is_control()
            || matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}' | '\u{200e}' | '\u{200f}' | '\u{feff}')
            // Not allowed in XML.
            || matches!(c, '\u{fffe}' | '\u{ffff}')
            || matches!(c, '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{e0000}'..='\u{e007f}')
    };
    let mut shown = String::new();
    for c in text.chars() {
        if hides(c) {
            shown.extend(c.escape_unicode());
        } else {
            shown.push(c);
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::super::report::tests::example;
    use super::*;

    fn metric(comparison: &str, value: Option<f64>, limit: f64, holds: bool) -> MetricReport {
        let name = "psnr".into();
        let (limit_from, remark) = ("s.toml:3".into(), "dB".into());
        MetricReport { name, value, comparison: comparison.into(), limit, limit_from, holds, remark }
    }

    #[test]
    fn distance_from_a_limit_goes_by_its_side() {
        assert_eq!(metric("<=", Some(0.02), 0.01, false).excess(), 2.0);
        assert_eq!(metric(">=", Some(20.0), 40.0, false).excess(), 2.0);
        assert_eq!(metric(">=", None, 40.0, true).excess(), 0.0);
        assert_eq!(metric("<=", None, 40.0, false).excess(), f64::INFINITY);
        assert_eq!(metric("<=", Some(0.0), 0.0, true).excess(), 0.0);
        assert_eq!(metric("<=", Some(0.1), 0.0, false).excess(), f64::INFINITY);
    }

    #[test]
    fn the_worst_comes_first() {
        let mut report = example();
        // As in the example: pass, fail, skipped, error, new.
        report.cases[3].metrics.clear();
        report.cases[4].metrics = vec![metric("<=", Some(9.0), 1.0, false)];
        let states: Vec<Status> = report.by_error().iter().map(|case| case.status).collect();
        assert_eq!(states, [Status::Error, Status::New, Status::Fail, Status::Pass, Status::Skipped]);
        assert_eq!(report.summary(), "3 of 5 cases failed: 1 error, 1 fail, 1 new; 1 skipped");
        report.cases.retain(|case| case.status == Status::Pass);
        assert_eq!(report.summary(), "1 of 1 cases passed");
    }

    #[test]
    fn hidden_characters_are_shown() {
        assert_eq!(visible("a\u{202e}b\n\u{200b}é中"), "a\\u{202e}b\\u{a}\\u{200b}é中");
    }
}
