//! Checks that the results pages show the reports of the packages, and that a new block leaves the rest of a page as it
//! was.

use fc_bench_report::packages;

#[test]
fn pages_show_the_figures_of_the_packages() {
    let reports = packages::read().expect("reports");
    assert!(reports.len() > 1);
    for (path, language) in packages::pages() {
        let page = std::fs::read_to_string(&path).expect("the page");
        let block = packages::block(&reports, language);
        assert!(page.contains(&block), "{}: stale; run the program of fc-bench-report", path.display());
    }
}

#[test]
fn a_page_keeps_its_other_text() {
    let (old, new) = (packages::block(&[], fc_bench_report::Language::English), "new\n");
    let page = format!("before\n{old}after\n");
    assert_eq!(packages::replaced(&page, new).expect("a part"), "before\nnew\nafter\n");
    packages::replaced("nothing", new).expect_err("no part");
}
