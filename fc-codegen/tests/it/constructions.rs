//! Counts the sentences of the project that have a construction of `words/constructions.yaml`, by area. Each number in
//! `words/counts.yaml` may only fall.
//!
//! The texts of the spec are its owner's: neither `spec/` nor files generated from it count. Text that the generator
//! writes itself is counted in the output for the spec of `tests/docs`.

use crate::docs_support::{fixture, model, project};
use fc_codegen::emit;
use fc_codegen::product::Artifact;
use fc_codegen::target::Targets;
use rayon::prelude::*;
use serde::Deserialize;
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Part of a file that is read.
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

/// An area, the part of its files that counts, and its places from the root of the project.
type Area = (&'static str, Part, &'static [&'static str]);

const AREAS: [Area; 29] = [
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
            "fc-reflect/README.md",
            "fc-runtime/README.md",
            "fc-spec/README.md",
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
    ("explain", Part::Prose, &["fc-spec/src/diagnostic/explain"]),
    ("messages", Part::Literals, &["fc-spec/src", "fc-diff/src"]),
    ("help", Part::Literals, &["fc-cli/src", "fc-lsp/src"]),
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
            "fc-reflect",
            "fc-runtime",
            "fc-spec",
            "fc-test",
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
    ("comments of fc-reflect", Part::Comments, &["fc-reflect"]),
    ("comments of fc-runtime", Part::Comments, &["fc-runtime"]),
    ("comments of fc-spec", Part::Comments, &["fc-spec"]),
    ("comments of fc-test", Part::Comments, &["fc-test"]),
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

/// The area that is generated here instead of read.
const GENERATED: &str = "generated text";

/// Directories that are not the project's own text.
const SKIPPED: [&str; 8] = [
    "node_modules",
    "target",
    "build",
    "dist",
    ".gradle",
    ".venv",
    "__pycache__",
    "generated",
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Rules {
    longest: usize,
    test_name: usize,
    starts: Vec<Construction>,
    anywhere: Vec<Construction>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Construction {
    with: String,
    bad: String,
    say: String,
}

/// Phrases by their first word; each is the rest of its words.
type Phrases = HashMap<String, Vec<Vec<String>>>;

struct Matcher {
    longest: usize,
    test_name: usize,
    starts: Phrases,
    anywhere: Phrases,
}

fn rules() -> Rules {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/words/constructions.yaml");
    serde_yaml::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// Every phrase of a pattern such as `of a|an|the`.
fn expand(patterns: &[Construction]) -> Phrases {
    let mut phrases = Phrases::new();
    for pattern in patterns {
        let mut all: Vec<Vec<String>> = vec![Vec::new()];
        for word in pattern.with.split(' ') {
            let longer = all.iter().flat_map(|phrase| {
                word.split('|').map(move |word| {
                    let mut phrase = phrase.clone();
                    phrase.push(word.to_owned());
                    phrase
                })
            });
            all = longer.collect();
        }
        for mut phrase in all {
            let first = phrase.remove(0);
            phrases.entry(first).or_default().push(phrase);
        }
    }
    phrases
}

impl Matcher {
    fn new(rules: &Rules) -> Self {
        Self {
            longest: rules.longest,
            test_name: rules.test_name,
            starts: expand(&rules.starts),
            anywhere: expand(&rules.anywhere),
        }
    }

    /// The construction of a sentence, or its length.
    fn find(&self, sentence: &str) -> Option<String> {
        let words = words(sentence);
        let at_start = words.first().and_then(|_| phrase(&self.starts, &words));
        if let Some(found) = at_start {
            return Some(found);
        }
        let mut rests = (0..words.len()).map(|at| &words[at..]);
        if let Some(found) = rests.find_map(|rest| phrase(&self.anywhere, rest)) {
            return Some(found);
        }
        let length = sentence.split_whitespace().count();
        (length > self.longest).then(|| format!("{length} words"))
    }

    /// The sentences of a text that count, each with its reason.
    fn count(&self, blocks: &[String]) -> Vec<String> {
        let sentences = blocks.iter().flat_map(|block| sentences(block));
        let found = sentences.filter_map(|it| Some((self.find(&it)?, it)));
        found.map(|(why, it)| format!("{it} [{why}]")).collect()
    }
}

/// The phrase with which some words start.
fn phrase(phrases: &Phrases, words: &[String]) -> Option<String> {
    let (first, rest) = words.split_first()?;
    let found = phrases.get(first)?.iter().find(|it| rest.starts_with(it))?;
    let all = std::iter::once(first).chain(found);
    Some(all.map(String::as_str).collect::<Vec<_>>().join(" "))
}

fn words(sentence: &str) -> Vec<String> {
    let is_between = |c: char| !(c.is_alphanumeric() || matches!(c, '\'' | '-' | '_'));
    let words = sentence.split(is_between).filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect()
}

/// Chinese characters and punctuation, and the dot between badges, end a piece of English.
fn ends_piece(character: char) -> bool {
    matches!(character, '·' | '\u{2E80}'..='\u{9FFF}' | '\u{F900}'..='\u{FAFF}' | '\u{FF00}'..='\u{FFEF}' | '“' | '”')
}

/// The English sentences of a block, which is one paragraph. Code spans count as one word.
fn sentences(block: &str) -> Vec<String> {
    let mut text = String::new();
    for (index, part) in block.split('`').enumerate() {
        text.push_str(if index % 2 == 1 { "X" } else { part });
    }
    let mut found = Vec::new();
    for piece in text.split(ends_piece) {
        let words: Vec<&str> = piece.split_whitespace().collect();
        let mut from = 0;
        for at in 1..=words.len() {
            let ends = words[at - 1].ends_with(['.', '!', '?']);
            let starts = words.get(at).and_then(|word| word.chars().next());
            let starts = starts.is_none_or(|c| c.is_ascii_uppercase() || c.is_ascii_digit());
            if at == words.len() || ends && starts {
                if at - from >= 3 {
                    found.push(words[from..at].join(" "));
                }
                from = at;
            }
        }
    }
    found
}

/// The paragraphs, items and cells of Markdown, without code and headings.
fn prose(text: &str) -> Vec<String> {
    let mut blocks = vec![String::new()];
    let mut fence: Option<&str> = None;
    let text = text.strip_prefix("---\n").map_or(text, |rest| {
        rest.split_once("\n---\n").map_or(rest, |(_, text)| text)
    });
    for line in text.lines() {
        let trimmed = line.trim();
        let mark = ["```", "~~~"]
            .into_iter()
            .find(|it| trimmed.starts_with(it));
        match (fence, mark) {
            (Some(open), Some(mark)) if open == mark => fence = None,
            (None, Some(mark)) => fence = Some(mark),
            _ => {}
        }
        let is_kept = fence.is_none() && mark.is_none() && !trimmed.starts_with(['#', '<']);
        if !is_kept || trimmed.is_empty() {
            blocks.push(String::new());
        } else if trimmed.starts_with('|') {
            let cells = trimmed.split('|').flat_map(|cell| cell.split("<br>"));
            blocks.extend(cells.map(plain));
            blocks.push(String::new());
        } else {
            let is_item = trimmed.starts_with(['-', '*', '>'])
                || trimmed.starts_with(|c: char| c.is_ascii_digit());
            let text = plain(trimmed.trim_start_matches(['-', '*', '>', ' ']));
            match blocks.last_mut().filter(|_| !is_item) {
                Some(block) => block.push_str(&(" ".to_owned() + &text)),
                None => blocks.push(text),
            }
        }
    }
    blocks
}

/// Text without links, tags and emphasis.
fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(['[', ']', '<', '*']) {
        let (before, from) = rest.split_at(at);
        out.push_str(before);
        let end = match from.as_bytes()[0] {
            b']' if from.starts_with("](") => from.find(')').map_or(1, |end| end + 1),
            b'<' => from.find('>').map_or(1, |end| end + 1),
            _ => 1,
        };
        rest = &from[end..];
    }
    out + rest
}

/// The end of a file's name behind its dot.
fn ending(path: &Path) -> Option<&str> {
    path.extension().and_then(|ending| ending.to_str())
}

/// The marks of comments in files with this ending. Scripts have none.
fn marks(ending: Option<&str>) -> Option<&'static [&'static str]> {
    match ending {
        Some("rs" | "cs") => Some(&["///", "//!", "//"]),
        Some("ts" | "js" | "mjs" | "vue" | "kt" | "kts" | "java" | "cpp" | "hpp") => {
            Some(&["///", "//", "/**", "/*", "*/", "*"])
        }
        Some("py" | "sh" | "toml" | "cmake" | "yml") | None => Some(&["#"]),
        Some(_) => None,
    }
}

/// Whether files with this ending have such parts.
fn is_read(part: Part, ending: Option<&str>) -> bool {
    match part {
        Part::Prose => ending == Some("md"),
        Part::Comments => marks(ending).is_some(),
        Part::Literals => ending == Some("rs"),
        Part::TestNames => matches!(ending, Some("rs" | "py" | "mjs" | "ts")),
    }
}

/// The comments of a source file, a paragraph each.
fn comments(path: &Path, text: &str) -> Vec<String> {
    let ending = ending(path);
    let Some(marks) = marks(ending) else {
        return Vec::new();
    };
    let mut blocks = vec![String::new()];
    let mut is_in_docstring = false;
    for line in text.lines() {
        let line = line.trim();
        let comment = if ending == Some("py") && (is_in_docstring || line.contains("\"\"\"")) {
            is_in_docstring ^= line.matches("\"\"\"").count() % 2 == 1;
            Some(line.trim_start_matches(['f', 'r']).trim_matches('"'))
        } else if line.starts_with("#!") {
            None
        } else {
            let mark = marks.iter().find(|mark| line.starts_with(**mark));
            mark.map(|mark| line[mark.len()..].trim_end_matches("*/").trim())
        };
        match comment {
            Some(text) if !text.is_empty() && !text.starts_with(['-', '|', '#', '@']) => {
                if let Some(block) = blocks.last_mut() {
                    block.push(' ');
                    block.push_str(&plain(text));
                }
            }
            Some(text) => blocks.push(plain(text.trim_start_matches(['-', '|', '#', ' ']))),
            None => blocks.push(String::new()),
        }
    }
    blocks
}

/// The string literals of a Rust file that are text: those with four words or more. Tests at the end do not count.
fn literals(text: &str) -> Vec<String> {
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    let mut blocks = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find(['"', '/', '\'']) {
        let (before, from) = rest.split_at(at);
        rest = &from[1..];
        if from.starts_with("//") {
            rest = from.find('\n').map_or("", |end| &from[end..]);
        } else if let Some(behind) = QUOTES.iter().find_map(|it| from.strip_prefix(it)) {
            rest = behind;
        } else if let Some(inside) = from.strip_prefix('"') {
            let (literal, behind) = literal(before, inside);
            let text = literal.replace("\\\n", " ").replace("\\n", "\n");
            let paragraphs = text.split("\n\n").filter(|it| is_text(it));
            blocks.extend(paragraphs.map(|it| plain(&without_holes(it))));
            rest = behind;
        }
    }
    blocks
}

/// Quotes as characters.
const QUOTES: [&str; 2] = ["'\"'", "'\\\"'"];

/// What a literal holds, and the text behind it. `before` is the text before its quote.
fn literal<'t>(before: &str, inside: &'t str) -> (&'t str, &'t str) {
    let mark = before.trim_end_matches('#');
    if mark.ends_with('r') {
        let close = format!("\"{}", "#".repeat(before.len() - mark.len()));
        return inside.split_once(&close).unwrap_or((inside, ""));
    }
    let mut is_escaped = false;
    let end = inside.find(|c: char| {
        let ends = c == '"' && !is_escaped;
        is_escaped = c == '\\' && !is_escaped;
        ends
    });
    let (literal, behind) = inside.split_at(end.unwrap_or(inside.len()));
    (literal, behind.strip_prefix('"').unwrap_or_default())
}

/// A format without the names of its arguments, each of which counts as one word.
fn without_holes(format: &str) -> String {
    let mut parts = format.split('{');
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        out.push('X');
        out.push_str(part.split_once('}').map_or(part, |(_, rest)| rest));
    }
    out
}

/// Whether a literal is text for people and not code.
fn is_text(literal: &str) -> bool {
    let is_word =
        |word: &&str| word.len() > 1 && word.bytes().all(|byte| byte.is_ascii_alphabetic());
    literal.split_whitespace().filter(is_word).count() >= 4
}

/// The names of the tests of a file, with spaces between their words.
fn test_names(path: &Path, text: &str) -> Vec<String> {
    let ending = ending(path);
    let mut names = Vec::new();
    let mut is_test = false;
    for line in text.lines().map(str::trim) {
        let name = match ending {
            Some("rs") => {
                is_test |=
                    line.starts_with("#[") && line.contains("test]") | line.contains("test(");
                let function = line.split_once("fn ").filter(|_| is_test);
                is_test &= function.is_none();
                function.and_then(|(_, rest)| rest.split(['(', '<']).next())
            }
            Some("py") => (line.strip_prefix("def test_"))
                .or_else(|| line.strip_prefix("async def test_"))
                .and_then(|rest| rest.split('(').next()),
            Some("mjs" | "ts") => ["test('", "test(\"", "it('", "it(\""]
                .into_iter()
                .find_map(|start| line.strip_prefix(start))
                .and_then(|rest| rest.split(['\'', '"']).next()),
            _ => None,
        };
        names.extend(name.map(|name| name.replace('_', " ")));
    }
    names
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

/// The sentences of an area that count.
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

/// The sentences that count in the output for the spec of `tests/docs`. The errors have an area of their texts.
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
