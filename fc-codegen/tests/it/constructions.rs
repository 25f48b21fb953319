//! Counts the sentences of the project that have a construction of `words/constructions.yaml`, by area. Each number in
//! `words/counts.yaml` may only fall.
//!
//! The owner of the spec writes its texts, so neither `spec/` nor files generated from it count. The output for the
//! spec of `tests/docs` shows the text that the generator itself writes.

mod matcher;
mod texts;

use crate::docs_support::{fixture, model, project};
use fc_codegen::emit;
use fc_codegen::product::Artifact;
use fc_codegen::target::Targets;
use matcher::{Matcher, expand, phrase, rules, sentences, words};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use texts::{comments, ending, literals, marks, prose, test_names};

/// The part of a file to read.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    /// The prose of Markdown.
    Prose,
    /// Comments and docstrings.
    Comments,
    /// String literals of Rust.
    Literals,
    /// Names of tests.
    TestNames,
}

/// An area, the part of its files that counts, and its paths from the root of the project.
type Area = (&'static str, Part, &'static [&'static str]);

const AREAS: [Area; 32] = [
    (
        "documents",
        Part::Prose,
        &[
            "README.md",
            "ARCHITECTURE.md",
            "CHANGELOG.md",
            "CONTRIBUTING.md",
            "bench",
            "conformance",
            "editors",
            "fc-cli/README.md",
            "fc-codegen/README.md",
            "fc-derive/README.md",
            "fc-diff/README.md",
            "fc-generated/README.md",
            "fc-lsp/README.md",
            "fc-package/README.md",
            "fc-reflect/README.md",
            "fc-runtime/README.md",
            "fc-spec/README.md",
            "fc-workshop/README.md",
            "load",
            "operations",
            "stubs",
        ],
    ),
    (
        "guides",
        Part::Prose,
        &[
            "docs-site/en/guides",
            "docs-site/en/index.md",
            "docs-site/en/lab",
            "docs-site/en/spec",
        ],
    ),
    ("templates", Part::Prose, &["fc-cli/templates"]),
    (
        "explain",
        Part::Prose,
        &[
            "fc-spec/src/diagnostic/explain",
            "fc-diff/src/rules/explain",
        ],
    ),
    (
        "messages",
        Part::Literals,
        &["fc-spec/src", "fc-diff/src", "fc-package/src"],
    ),
    ("help", Part::Literals, &["fc-cli/src", "fc-lsp/src"]),
    ("help of commands", Part::Prose, &["fc-cli/src/help/texts"]),
    (
        "test names",
        Part::TestNames,
        &[
            "conformance",
            "docs-site/tests",
            "fc-cli",
            "fc-codegen",
            "fc-derive",
            "fc-diff",
            "fc-generated",
            "fc-lsp",
            "fc-package",
            "fc-reflect",
            "fc-runtime",
            "fc-spec",
            "fc-test",
            "fc-workshop",
            "stubs",
        ],
    ),
    (".ci", Part::Comments, &[".ci"]),
    ("comments of bench", Part::Comments, &["bench"]),
    ("comments of conformance", Part::Comments, &["conformance"]),
    (
        "comments of docs-site",
        Part::Comments,
        &[
            "docs-site/.vitepress/config.ts",
            "docs-site/.vitepress/search.ts",
            "docs-site/.vitepress/theme",
            "docs-site/lab/engine",
            "docs-site/tests",
        ],
    ),
    ("comments of editors", Part::Comments, &["editors"]),
    ("comments of fc-cli", Part::Comments, &["fc-cli"]),
    ("comments of fc-codegen", Part::Comments, &["fc-codegen"]),
    ("comments of fc-derive", Part::Comments, &["fc-derive"]),
    ("comments of fc-diff", Part::Comments, &["fc-diff"]),
    (
        "comments of fc-generated",
        Part::Comments,
        &["fc-generated"],
    ),
    ("comments of fc-lsp", Part::Comments, &["fc-lsp"]),
    ("comments of fc-package", Part::Comments, &["fc-package"]),
    ("comments of fc-reflect", Part::Comments, &["fc-reflect"]),
    ("comments of fc-runtime", Part::Comments, &["fc-runtime"]),
    ("comments of fc-spec", Part::Comments, &["fc-spec"]),
    ("comments of fc-test", Part::Comments, &["fc-test"]),
    ("comments of fc-workshop", Part::Comments, &["fc-workshop"]),
    ("comments of fuzz", Part::Comments, &["fuzz"]),
    ("comments of load", Part::Comments, &["load"]),
    ("comments of stubs/cpp", Part::Comments, &["stubs/cpp"]),
    (
        "comments of stubs/example-csharp",
        Part::Comments,
        &["stubs/example-csharp"],
    ),
    (
        "comments of stubs/kotlin",
        Part::Comments,
        &["stubs/kotlin"],
    ),
    (
        "comments of stubs/python",
        Part::Comments,
        &["stubs/python"],
    ),
    (
        "comments of stubs/typescript",
        Part::Comments,
        &["stubs/typescript"],
    ),
];

/// The area whose text the test generates.
const GENERATED: &str = "generated text";

/// Directories without text of the project.
const SKIPPED: [&str; 13] = [
    "node_modules",
    "target",
    "build",
    "dist",
    "cache",
    ".temp",
    "corpus",
    "artifacts",
    "coverage",
    ".gradle",
    ".venv",
    "__pycache__",
    "generated",
];

/// Returns `true` if files with this ending have such a part.
fn is_read(part: Part, ending: Option<&str>) -> bool {
    match part {
        Part::Prose => ending == Some("md"),
        Part::Comments => marks(ending).is_some(),
        Part::Literals => ending == Some("rs"),
        Part::TestNames => matches!(ending, Some("rs" | "py" | "mjs" | "ts")),
    }
}

fn files(path: &Path, out: &mut Vec<PathBuf>) {
    let name = path.file_name().and_then(|name| name.to_str());
    if path.is_dir() {
        if name.is_some_and(|name| SKIPPED.contains(&name)) {
            return;
        }
        let inside = fs::read_dir(path).unwrap();
        let mut inside: Vec<_> = inside.map(|entry| entry.unwrap().path()).collect();
        inside.sort();
        for path in &inside {
            files(path, out);
        }
    } else {
        out.push(path.to_owned());
    }
}

/// Returns the sentences of an area that count.
fn found(matcher: &Matcher, (_, part, places): &Area) -> Vec<String> {
    let root = project();
    let mut paths = Vec::new();
    for place in *places {
        let before = paths.len();
        files(&root.join(place), &mut paths);
        assert!(paths.len() > before, "nothing to read in {place}");
    }
    let read = |path: &PathBuf| {
        if !is_read(*part, ending(path)) {
            return Vec::new();
        }
        let Ok(text) = fs::read_to_string(path) else {
            return Vec::new();
        };
        if text.lines().take(3).any(|line| line.contains("@generated")) {
            return Vec::new();
        }
        let found = match part {
            Part::Prose => matcher.count(&prose(&text)),
            Part::Comments => matcher.count(&comments(path, &text)),
            Part::Literals => matcher.count(&literals(&text)),
            Part::TestNames => test_names(path, &text)
                .into_iter()
                .filter(|name| name.len() > matcher.test_name || matcher.find(name).is_some())
                .collect(),
        };
        let name = path.strip_prefix(&root).unwrap_or(path).display();
        found.iter().map(|it| format!("{name}: {it}")).collect()
    };
    paths.par_iter().flat_map_iter(read).collect()
}

/// Returns the sentences that count in the output for the spec of `tests/docs`. Pages about errors belong to another
/// area.
fn found_in_generated(matcher: &Matcher) -> Vec<String> {
    let artifacts = emit::generate(&model(&fixture()), &Targets::default()).unwrap();
    let read = |artifact: Artifact| {
        let path = Path::new(&artifact.path);
        if artifact.path.ends_with("/errors.md") {
            return Vec::new();
        }
        let blocks = if ending(path) == Some("md") {
            prose(&artifact.contents)
        } else {
            comments(path, &artifact.contents)
        };
        let found = matcher.count(&blocks);
        let found = found.iter().map(|it| format!("{}: {it}", artifact.path));
        found.collect::<Vec<_>>()
    };
    artifacts.into_par_iter().flat_map_iter(read).collect()
}

fn counts_path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/words/counts.yaml")
}

#[test]
fn constructions_only_become_fewer() {
    const HEAD: &str = "\
# Sentences with a construction of `constructions.yaml`, by area. The numbers may only fall. After a fall,
# `BLESS=1 cargo test -p fc-codegen constructions` writes the lower numbers.
";
    let matcher = Matcher::new(&rules());
    let (areas, generated) = rayon::join(
        || -> Vec<(&str, Vec<String>)> {
            let areas = AREAS.par_iter();
            areas.map(|area| (area.0, found(&matcher, area))).collect()
        },
        || found_in_generated(&matcher),
    );
    let areas: BTreeMap<&str, Vec<String>> =
        areas.into_iter().chain([(GENERATED, generated)]).collect();
    let written = fs::read_to_string(counts_path()).unwrap_or_default();
    let most: BTreeMap<String, usize> = serde_yaml::from_str(&written).unwrap_or_default();
    let mut wrong = Vec::new();
    let mut lower = HEAD.to_owned();
    for (area, found) in &areas {
        let most = most.get(*area).copied();
        let count = found.len();
        let least = most.map_or(count, |most| most.min(count));
        let _ = writeln!(lower, "{area}: {least}");
        match most {
            Some(most) if count > most => wrong.push(format!(
                "{area}: {count} sentences have a construction of words/constructions.yaml, \
                 and counts.yaml allows {most}. Rewrite one:\n  {}",
                found.join("\n  ")
            )),
            Some(most) if count == most => {}
            _ => wrong.push(format!(
                "{area}: write the lower number {count} into words/counts.yaml, with BLESS=1"
            )),
        }
    }
    if std::env::var_os("BLESS").is_some() {
        fs::write(counts_path(), &lower).unwrap();
        wrong.retain(|it| it.contains("Rewrite one"));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn construction_catches_its_example() {
    let rules = rules();
    let matcher = Matcher::new(&rules);
    for (it, starts) in (rules.starts.iter().map(|it| (it, true)))
        .chain(rules.anywhere.iter().map(|it| (it, false)))
    {
        let phrases = expand(std::slice::from_ref(it));
        let words = words(&it.bad);
        let mut rests = (0..words.len()).map(|at| &words[at..]);
        let is_caught = if starts {
            phrase(&phrases, &words).is_some()
        } else {
            rests.any(|rest| phrase(&phrases, rest).is_some())
        };
        assert!(is_caught, "`{}` is not caught", it.bad);
        assert_eq!(matcher.find(&it.say), None, "`{}` counts itself", it.say);
    }
}

#[test]
fn text_is_cut_into_sentences() {
    let markdown = "---\ntitle: x\n---\n\n# Head of it\n\nOne `a b` two [three](x). Four *five* six.\n\n| a b c | d<br>e f g |\n|---|---|\n\n- item one two\n- item three four\n\n```sh\nno text here\n```\n";
    let found: Vec<String> = prose(markdown)
        .iter()
        .flat_map(|it| sentences(it))
        .collect();
    assert_eq!(
        found,
        [
            "One X two three.",
            "Four five six.",
            "a b c",
            "e f g",
            "item one two",
            "item three four"
        ]
    );
    let rust =
        "/// 中文。One two three.\n///\n/// Four five\n/// six.\nlet x = 1; // not here it is\n";
    let found = comments(Path::new("x.rs"), rust);
    let found: Vec<String> = found.iter().flat_map(|it| sentences(it)).collect();
    assert_eq!(found, ["One two three.", "Four five six."]);
    let code = "f(\"one two \\\n   three four\", r#\"five \"six\" seven eight ten\"#, '\"', \"nine\"); // \"no no no no\"\n";
    assert_eq!(
        literals(code),
        ["one two     three four", "five \"six\" seven eight ten"]
    );
}
