//! `conformance/features.yaml` names a test or a reason for each feature in each language. The page that compares the
//! packages shows the same table.

use crate::docs_support::project;
use regex_lite::{Captures, Regex};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

const FEATURES: &str = "conformance/features.yaml";

const LANGUAGES: [&str; 6] = ["Rust", "TypeScript", "Python", "Kotlin", "Java", "C++"];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Feature {
    en: String,
    zh: String,
    rust: Cell,
    typescript: Cell,
    python: Cell,
    kotlin: Cell,
    java: Cell,
    cpp: Cell,
}

impl Feature {
    /// Returns the cells in the order of [`LANGUAGES`].
    fn cells(&self) -> [&Cell; 6] {
        [
            &self.rust,
            &self.typescript,
            &self.python,
            &self.kotlin,
            &self.java,
            &self.cpp,
        ]
    }
}

/// The state of a feature in one language: either `tests` or `no`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Cell {
    /// The name of the feature in the package.
    api: Option<String>,
    #[serde(default)]
    tests: Vec<String>,
    no: Option<Reason>,
}

/// The reason why a package lacks a feature.
#[derive(Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Reason {
    en: String,
    zh: String,
}

fn features() -> Vec<Feature> {
    let text = fs::read_to_string(project().join(FEATURES)).unwrap();
    serde_yaml::from_str(&text).unwrap()
}

/// Returns the pattern of a test's declaration in a file.
fn declaration(file: &str, name: &str) -> String {
    match Path::new(file).extension().and_then(|it| it.to_str()) {
        Some("rs") if !file.contains("/ui/") => format!("fn {name}("),
        Some("py") => format!("def {name}("),
        Some("cpp") => format!(" {name}("),
        _ => name.to_owned(),
    }
}

#[test]
fn every_cell_has_a_test_or_a_reason() {
    for feature in features() {
        for (cell, language) in feature.cells().into_iter().zip(LANGUAGES) {
            let at = format!("{} in {language}", feature.en);
            let Some(reason) = &cell.no else {
                assert!(!cell.tests.is_empty(), "{at}: neither a test nor a reason");
                continue;
            };
            assert!(cell.tests.is_empty() && cell.api.is_none(), "{at}: both");
            for text in [&reason.en, &reason.zh] {
                assert!(!text.trim().is_empty() && !text.contains('\n'), "{at}");
            }
        }
    }
}

#[test]
fn every_named_test_exists() {
    for test in features()
        .iter()
        .flat_map(Feature::cells)
        .flat_map(|cell| &cell.tests)
    {
        let (file, name) = test.split_once("::").expect("FILE::NAME");
        let text = fs::read_to_string(project().join(file)).expect(file);
        assert!(text.contains(&declaration(file, name)), "{test}");
    }
}

/// Returns the section of the page in one language, without its heading.
fn section(is_english: bool) -> String {
    let text = |reason: &Reason| {
        if is_english {
            reason.en.clone()
        } else {
            reason.zh.clone()
        }
    };
    let mut page = String::from(if is_english {
        "\n`conformance/features.yaml` names a test for each ✓ and each name. [Missing features](#missing) have a reason.\n\n\
         | Feature |"
    } else {
        "\n每个 ✓ 和名称都有测试，见 `conformance/features.yaml`。[缺少的功能](#missing)附有原因。\n\n| 功能 |"
    });
    let _ = write!(
        page,
        " {} |\n|---|{}\n",
        LANGUAGES.join(" | "),
        "---|".repeat(LANGUAGES.len())
    );
    let mut missing = String::new();
    for feature in features() {
        let title = if is_english { &feature.en } else { &feature.zh };
        let _ = write!(page, "| {title} |");
        let mut reasons: Vec<(&Reason, Vec<&str>)> = Vec::new();
        for (cell, language) in feature.cells().into_iter().zip(LANGUAGES) {
            let shown = match (&cell.no, &cell.api) {
                (Some(_), _) => "—".to_owned(),
                (None, Some(api)) => format!("`{api}`"),
                (None, None) => "✓".to_owned(),
            };
            let _ = write!(page, " {shown} |");
            let Some(reason) = &cell.no else { continue };
            match reasons.iter_mut().find(|(it, _)| *it == reason) {
                Some((_, languages)) => languages.push(language),
                None => reasons.push((reason, vec![language])),
            }
        }
        page.push('\n');
        for (reason, languages) in reasons {
            let comma = if is_english { ", " } else { "、" };
            let _ = writeln!(
                missing,
                "| {title} | {} | {} |",
                languages.join(comma),
                text(reason)
            );
        }
    }
    page.push_str(if is_english {
        "\n### Missing features {#missing}\n\n| Feature | Missing in | Reason |\n|---|---|---|\n"
    } else {
        "\n### 缺少的功能 {#missing}\n\n| 功能 | 缺少的语言 | 原因 |\n|---|---|---|\n"
    });
    page + &missing + "\n"
}

#[test]
fn the_page_has_the_table() {
    for (path, is_english) in [
        ("docs-site/guides/packages.md", false),
        ("docs-site/en/guides/packages.md", true),
    ] {
        let path = project().join(path);
        let page = fs::read_to_string(&path).unwrap();
        let heading = page.find("{#features}\n").expect("the section");
        let from = heading + "{#features}\n".len();
        let to = from + page[from..].find("\n## ").expect("a section after it") + 1;
        let section = section(is_english);
        if std::env::var_os("BLESS").is_some() {
            let written = format!("{}{section}{}", &page[..from], &page[to..]);
            fs::write(&path, written).unwrap();
            continue;
        }
        let diff = similar::TextDiff::from_lines(&page[from..to], section.as_str());
        assert!(
            page[from..to] == section,
            "{} differs; run the test with BLESS=1 and read the diff\n{}",
            path.display(),
            diff.unified_diff(),
        );
    }
}

/// The counters of packages that have all client counters: file, class, and the pattern of a name.
const CLIENT_COUNTERS: [(&str, &str, &str); 4] = [
    (
        "stubs/typescript/src/client/counters.ts",
        "ClientCounters {",
        r"(?m)^  (\w+): number$",
    ),
    (
        "stubs/python/src/fc_runtime/states.py",
        "ClientCounters:",
        r"(?m)^    (\w+): int = 0$",
    ),
    (
        "stubs/kotlin/runtime/src/main/kotlin/fc/runtime/Counters.kt",
        "class ClientCounters",
        r"public val (\w+): Long",
    ),
    (
        "stubs/cpp/include/fc_runtime/client_core.hpp",
        "struct ClientCounters {",
        r"(?m)^  Count (\w+);",
    ),
];
const SERVER_COUNTERS: [(&str, &str, &str); 4] = [
    (
        "stubs/typescript/src/server/counters.ts",
        "ServerCounters {",
        r"(?m)^  (\w+): number$",
    ),
    (
        "stubs/python/src/fc_runtime/counters.py",
        "ServerCounters:",
        r"(?m)^    (\w+): int = 0$",
    ),
    (
        "stubs/kotlin/runtime/src/main/kotlin/fc/runtime/Counters.kt",
        "class ServerCounters",
        r"public val (\w+): Long",
    ),
    (
        "stubs/cpp/include/fc_runtime/robot_core.hpp",
        "struct ServerCounters {",
        r"(?m)^  Count (\w+);",
    ),
];

/// Returns the names of the counters of a class, in snake case.
fn counters((file, class, name): (&str, &str, &str)) -> BTreeSet<String> {
    let text = fs::read_to_string(project().join(file)).expect(file);
    let (_, body) = text.split_once(class).expect(class);
    let body = body.split("\n}").next().expect("a body");
    let upper = Regex::new("[A-Z]").unwrap();
    let snake = |name: &str| {
        let lower = |found: &Captures<'_>| format!("_{}", found[0].to_lowercase());
        upper.replace_all(name, lower).into_owned()
    };
    let name = Regex::new(name).unwrap();
    name.captures_iter(body).map(|it| snake(&it[1])).collect()
}

/// In TypeScript and Python, the platform performs the handshakes, so their packages do not count them.
#[test]
fn counters_have_the_same_names() {
    const RUST: &str = r"(?m)^    (\w+)(?: by operation)?,$";
    let client = counters(("fc-runtime/src/client/state.rs", "\ncounters! {", RUST));
    let mut server = counters(("fc-runtime/src/server/counters.rs", "\ncounters! {", RUST));
    assert!(server.remove("handshakes_failed") && server.len() > 30);
    assert!(client.len() > 10);
    for package in CLIENT_COUNTERS {
        assert_eq!(counters(package), client, "{}", package.0);
    }
    for package in SERVER_COUNTERS {
        let mut own = counters(package);
        let counts = own.remove("handshakes_failed");
        let is_own = !package.0.contains("/typescript/") && !package.0.contains("/python/");
        assert_eq!(counts, is_own, "{}", package.0);
        assert_eq!(own, server, "{}", package.0);
    }
}
