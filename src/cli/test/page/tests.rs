//! What is in the page as text; tests/suite/report_page.rs looks at it in a browser.

use super::super::report::tests::example;
use super::super::report::{Status, SuiteReport};
use super::*;
use crate::cli::output::png;

/// A report whose cases have a picture in the folder, each case but the skipped one.
fn with_pictures(folder: &Path) -> SuiteReport {
    let mut report = example();
    for (index, case) in report.cases.iter_mut().enumerate() {
        let path = folder.join(format!("{index}.png"));
        std::fs::write(&path, png(8, 4, &[index as u8; 8 * 4 * 4]).unwrap()).unwrap();
        case.paths.actual = (case.status != Status::Skipped).then_some(path);
    }
    report
}

fn pictures(page: &str) -> usize {
    page.matches("src=\"data:image/png;base64,").count()
}

#[test]
fn pictures_are_in_the_page_as_far_as_there_is_room() {
    let folder = tempfile::tempdir().unwrap();
    let report = with_pictures(folder.path());
    let page = |limit| html(&report, folder.path(), limit).unwrap();
    let all = page(1 << 20);
    assert_eq!(pictures(&all), 4);
    assert!(all.contains("width=\"8\" height=\"4\"") && !all.contains("The page is full"), "{all}");
    let none = page(0);
    assert_eq!((pictures(&none), none.matches("The page is full").count()), (0, 4));
    // Room for one: that of the worst case, whose file is not named as left out.
    let length = std::fs::metadata(folder.path().join("1.png")).unwrap().len();
    let one = page(length.div_ceil(3) * 4 + 8);
    assert_eq!((pictures(&one), one.matches("The page is full").count()), (1, 3));
    let (picture, full) = (one.find("data:image").unwrap(), one.find("The page is full").unwrap());
    assert!(picture < full, "the worst case has no picture");
}

#[test]
fn pictures_that_are_none_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let report = with_pictures(folder.path());
    std::fs::write(folder.path().join("1.png"), "<svg onload=alert(1)>").unwrap();
    std::fs::remove_file(folder.path().join("0.png")).unwrap();
    let page = html(&report, folder.path(), 1 << 20).unwrap();
    assert_eq!(pictures(&page), 2);
    assert!(page.contains("1.png is no PNG") && page.contains("0.png: of the case"), "{page}");
}

#[test]
fn the_script_and_the_style_stay_in_their_elements() {
    assert!(!SCRIPT.contains("</script") && !SCRIPT.contains("<!--"));
    assert!(!STYLE.contains("</style"));
    let folder = tempfile::tempdir().unwrap();
    let mut report = example();
    report.suite = "</title></style></script><script>1</script>".into();
    let page = html(&report, folder.path(), 0).unwrap();
    assert_eq!((page.matches("<script").count(), page.matches("</script").count()), (1, 1));
    assert_eq!((page.matches("</style").count(), page.matches("</title").count()), (1, 1));
}
