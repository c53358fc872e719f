//! A report as JUnit XML, which most CI systems show.

use super::report::{CaseReport, Status, SuiteReport};
use super::verdicts::visible;
use crate::cli::error::CliError;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use std::time::Duration;

/// The file's text.
///
/// # Errors
/// When it cannot be written as XML.
pub(super) fn xml(report: &SuiteReport) -> Result<String, CliError> {
    let name = visible(&report.suite);
    let mut suite = TestSuite::new(name.as_str());
    suite.set_time(duration(report.milliseconds));
    let properties = [
        ("specula", &report.version),
        ("adapter", &report.adapter.name),
        ("driver", &report.adapter.driver),
        ("class", &report.adapter.class),
        ("cpu", &report.adapter.cpu),
    ];
    for (name, value) in properties {
        suite.add_property((name, visible(value).as_str()));
    }
    suite.add_test_cases(report.cases.iter().map(|case| test_case(&name, case)));
    let mut whole = Report::new(name.as_str());
    whole.set_time(duration(report.milliseconds)).add_test_suite(suite);
    whole.to_string().map_err(|error| CliError::Usage(format!("the report cannot be written as JUnit XML: {error}")))
}

fn test_case(suite: &str, case: &CaseReport) -> TestCase {
    let mut test = TestCase::new(visible(&case.id), status(case));
    test.set_classname(suite).set_time(duration(case.milliseconds()));
    let lines = [pictures(case), accept(case)].concat();
    if !lines.is_empty() {
        test.set_system_out(lines.join("\n"));
    }
    test
}

fn status(case: &CaseReport) -> TestCaseStatus {
    let complaints: Vec<String> = case.account().iter().map(|line| visible(line)).collect();
    let mut status = match case.status {
        Status::Pass => return TestCaseStatus::success(),
        Status::Skipped => TestCaseStatus::skipped(),
        Status::Fail | Status::New => TestCaseStatus::non_success(NonSuccessKind::Failure),
        Status::Error => TestCaseStatus::non_success(NonSuccessKind::Error),
    };
    if let Some(first) = complaints.first() {
        status.set_message(first.as_str()).set_description(complaints.join("\n"));
    }
    status.set_type(case.status.word());
    status
}

/// As GitLab and the attachment plugin of Jenkins find files.
fn pictures(case: &CaseReport) -> Vec<String> {
    let paths = &case.paths;
    let golden = paths.golden.as_ref().filter(|_| case.status != Status::New);
    let files = [&paths.actual, &golden.cloned(), &paths.difference, &paths.heat_map].map(Clone::clone);
    let shown = files.into_iter().flatten().map(|path| visible(&path.display().to_string()));
    if case.status.is_broken() { shown.map(|path| format!("[[ATTACHMENT|{path}]]")).collect() } else { Vec::new() }
}

fn accept(case: &CaseReport) -> Vec<String> {
    case.accept.iter().map(|command| format!("to accept: {}", visible(command))).collect()
}

/// Zero for what is no time.
fn duration(milliseconds: f64) -> Duration {
    Duration::try_from_secs_f64(milliseconds / 1e3).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::super::report::tests::example;
    use super::*;

    #[test]
    fn states_are_those_of_junit() {
        let mut report = example();
        report.cases[1].paths.actual = Some("out/a.png".into());
        let read = Report::deserialize_from_str(&xml(&report).unwrap()).unwrap();
        assert_eq!((read.tests, read.failures, read.errors), (5, 2, 1));
        let suite = &read.test_suites[0];
        assert!(matches!(suite.test_cases[2].status, TestCaseStatus::Skipped { .. }), "{suite:?}");
        assert_eq!(suite.name.as_str(), "example");
        let failed = &suite.test_cases[1];
        let TestCaseStatus::NonSuccess { message, ty, description, .. } = &failed.status else {
            panic!("{:?}", failed.status)
        };
        assert_eq!(ty.as_deref(), Some("fail"));
        let sentence = "flip.mean is 0.020000, not <= 0.004 (suite.toml:3)";
        assert_eq!((message.as_deref(), description.as_deref()), (Some(sentence), Some(sentence)));
        let out = failed.system_out.as_ref().unwrap().as_str();
        assert_eq!(out, "[[ATTACHMENT|out/a.png]]\nto accept: specula accept suite.toml helmet");
    }

    #[test]
    fn names_of_strangers_stay_names() {
        let hostile = "</testcase>]]><!-- \"'&\u{1}\u{1b}[31m\u{202e}\u{ffff}";
        let mut report = example();
        report.suite = hostile.into();
        report.cases[1].id = hostile.into();
        report.cases[3].reason = Some(hostile.into());
        report.cases[1].accept = Some(hostile.into());
        let read = Report::deserialize_from_str(&xml(&report).unwrap()).unwrap();
        assert_eq!(read.test_suites[0].test_cases.len(), 5);
        let shown = "</testcase>]]><!-- \"'&\\u{1}\\u{1b}[31m\\u{202e}\\u{ffff}";
        assert_eq!(read.test_suites[0].test_cases[1].name.as_str(), shown);
        assert_eq!(read.name.unwrap().as_str(), shown);
    }
}
