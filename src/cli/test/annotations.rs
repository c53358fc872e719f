//! Failures as workflow commands of GitHub Actions, which shows them beside the line of the suite.

use super::report::{CaseReport, SuiteReport};
use super::verdicts::visible;

/// GitHub shows ten errors of a step and drops the others.
const MOST: usize = 10;

/// A line for each failing case, worst first; the last says how many more there are.
pub(super) fn github(report: &SuiteReport) -> String {
    let broken: Vec<&CaseReport> = report.by_error().into_iter().filter(|case| case.status.is_broken()).collect();
    let shown = if broken.len() > MOST { MOST - 1 } else { broken.len() };
    let mut lines: Vec<String> = broken[..shown].iter().map(|case| annotation(report, case)).collect();
    if broken.len() > shown {
        let text = format!("{} more cases failed; the report has them", broken.len() - shown);
        lines.push(format!("::error title={}::{}", property(&visible(&report.suite)), data(&text)));
    }
    lines.iter().map(|line| format!("{line}\n")).collect()
}

fn annotation(report: &SuiteReport, case: &CaseReport) -> String {
    let mut lines: Vec<String> = case.account().iter().map(|line| visible(line)).collect();
    if lines.is_empty() {
        lines.push(format!("{} ({})", case.status.word(), visible(&case.model)));
    }
    lines.extend(case.accept.iter().map(|command| format!("to accept: {}", visible(command))));
    let file = property(&report.suite_file.display().to_string());
    let title = property(&format!("{}: {}", case.status.word(), visible(&case.id)));
    format!("::error file={file},line={},title={title}::{}", case.line, data(&lines.join("\n")))
}

/// As `escapeData` of GitHub's own toolkit (actions/toolkit, packages/core/src/command.ts).
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// As `escapeProperty` of the same.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::super::report::Status;
    use super::super::report::tests::example;
    use super::*;

    #[test]
    fn a_failure_is_a_line_with_its_place() {
        let mut report = example();
        report.cases.retain(|case| case.status == Status::Fail);
        let expected = "::error file=suite.toml,line=7,title=fail%3A helmet/quality=Fail::\
                        flip.mean is 0.020000, not <= 0.004 (suite.toml:3)\
                        %0Ato accept: specula accept suite.toml helmet\n";
        assert_eq!(github(&report), expected);
    }

    #[test]
    fn names_of_strangers_make_no_commands() {
        let hostile = "a\n::set-env name=A::b,c:100%\r";
        let mut report = example();
        report.suite_file = hostile.into();
        for case in &mut report.cases {
            case.id = hostile.into();
            case.reason = Some(hostile.into());
        }
        let text = github(&report);
        assert_eq!(text.lines().count(), 3, "{text}");
        assert!(text.lines().all(|line| line.starts_with("::error file=a%0A%3A%3Aset-env name=A")), "{text}");
        assert!(!text.contains('\r') && text.contains("100%25"), "{text}");
    }

    #[test]
    fn what_github_would_drop_is_counted() {
        let mut report = example();
        let failed = report.cases.remove(1);
        report.cases = vec![failed.clone(); 10];
        assert_eq!(github(&report).lines().count(), 10);
        report.cases = vec![failed; 25];
        let text = github(&report);
        assert_eq!(text.lines().count(), 10);
        assert!(text.ends_with("::error title=example::16 more cases failed; the report has them\n"), "{text}");
    }
}
