//! A new constraint and a new section change few handwritten files. The patches in `tests/touch` add an example of
//! each.

use crate::docs_support::project;
use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

const CONSTRAINT: &str = "fc-codegen/tests/touch/multiple_of.patch";
const SECTION: &str = "fc-codegen/tests/touch/section.patch";

/// The runtimes. Each may change in one file.
const RUNTIMES: [&str; 5] = [
    "fc-runtime/",
    "stubs/typescript/",
    "stubs/python/",
    "stubs/kotlin/",
    "stubs/cpp/",
];

/// The most other files that a constraint may change. This number may only fall.
const MOST_OTHERS: usize = 6;

/// The most files that a section may change. This number may only fall.
const MOST_OF_SECTION: usize = 5;

/// Returns the files that a patch changes.
fn touched(patch: &str) -> BTreeSet<String> {
    let patch = fs::read_to_string(project().join(patch)).expect("the patch");
    let files = patch.lines().filter_map(|line| line.strip_prefix("+++ b/"));
    files.map(str::to_owned).collect()
}

#[test]
fn a_constraint_changes_few_files() {
    let mut others = touched(CONSTRAINT);
    for runtime in RUNTIMES {
        let (own, rest) = others.into_iter().partition(|it| it.starts_with(runtime));
        let own: BTreeSet<String> = own;
        assert_eq!(own.len(), 1, "{runtime}: {own:?}");
        others = rest;
    }
    assert!(others.len() <= MOST_OTHERS, "{others:#?}");
    let is_source = |it: &&String| it.contains("/src/");
    assert_eq!(others.iter().find(|it| !is_source(it)), None);
}

#[test]
fn a_section_changes_few_files() {
    let touched = touched(SECTION);
    assert!(touched.len() <= MOST_OF_SECTION, "{touched:#?}");
}

#[test]
fn the_patches_fit() {
    let root = project();
    let parent = root.parent().expect("the root of the project has a parent");
    for patch in [CONSTRAINT, SECTION] {
        let output = Command::new("git")
            .args(["apply", "--check", patch])
            .current_dir(&root)
            // Outside a repository, git takes paths relative to the current directory.
            .env("GIT_CEILING_DIRECTORIES", parent)
            .output()
            .expect("git");
        let problem = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{problem}");
    }
}

#[test]
fn the_tables_of_contributing_list_the_files() {
    for name in ["CONTRIBUTING.md", "CONTRIBUTING.zh-CN.md"] {
        let text = fs::read_to_string(project().join(name)).expect(name);
        for patch in [CONSTRAINT, SECTION] {
            let mut sections = text.split("\n### ");
            let section = sections.find(|it| it.contains(patch)).expect("a section");
            let rows = section.lines().filter_map(|line| line.strip_prefix("| `"));
            let files = rows.filter_map(|row| Some(row.split_once('`')?.0.to_owned()));
            let files: BTreeSet<String> = files.collect();
            assert_eq!(files, touched(patch), "{name}");
        }
    }
}
