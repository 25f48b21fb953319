//! No text of the project uses a word of `words/forbidden.yaml`. The test reads guides, templates, explanations and
//! messages of errors, help of the commands, labels of the site and documentation for users. It skips comments that
//! only readers of the source see.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The texts to read: a file or a whole directory, and the endings that count.
const TEXTS: [(&str, &[&str]); 64] = [
    ("README.md", &["md"]),
    ("README.zh-CN.md", &["md"]),
    ("CONTRIBUTING.md", &["md"]),
    ("ARCHITECTURE.md", &["md"]),
    ("conformance", &["json", "md"]),
    ("docs-site/index.md", &["md"]),
    ("docs-site/guides", &["md"]),
    ("docs-site/lab/index.md", &["md"]),
    ("docs-site/lab/engine", &["ts"]),
    ("docs-site/spec", &["md"]),
    ("docs-site/en/index.md", &["md"]),
    ("docs-site/en/guides", &["md"]),
    ("docs-site/en/lab", &["md"]),
    ("docs-site/en/spec", &["md"]),
    ("docs-site/.vitepress/config.ts", &["ts"]),
    ("docs-site/.vitepress/search.ts", &["ts"]),
    ("docs-site/.vitepress/search-terms.ts", &["ts"]),
    ("docs-site/.vitepress/theme/components", &["vue"]),
    ("editors/README.md", &["md"]),
    ("editors/vscode/README.md", &["md"]),
    ("editors/vscode/extension.js", &["js"]),
    ("fc-cli/README.md", &["md"]),
    ("fc-codegen/README.md", &["md"]),
    ("fc-derive/README.md", &["md"]),
    ("fc-diff/README.md", &["md"]),
    ("fc-generated/README.md", &["md"]),
    ("fc-lsp/README.md", &["md"]),
    ("fc-package/README.md", &["md"]),
    ("fc-reflect/README.md", &["md"]),
    ("fc-workshop/README.md", &["md"]),
    ("fc-runtime/README.md", &["md"]),
    ("fc-spec/README.md", &["md"]),
    ("fc-cli/src", &["rs", "md"]),
    ("fc-cli/templates", &["md", "rs"]),
    ("fc-codegen/src", &["rs", "md", "j2", "in"]),
    ("fc-spec/src", &["rs", "md"]),
    ("fc-derive/src", &["rs"]),
    ("fc-generated/examples", &["rs"]),
    ("fc-diff/src", &["rs", "md"]),
    ("fc-lsp/src", &["rs"]),
    ("fc-package/src", &["rs"]),
    ("fc-reflect/src", &["rs"]),
    ("fc-workshop/src", &["rs"]),
    ("fc-runtime/src", &["rs"]),
    ("stubs/cpp/README.md", &["md"]),
    ("stubs/cpp/README.zh-CN.md", &["md"]),
    ("stubs/cpp/examples", &["cpp", "hpp"]),
    ("stubs/cpp/include", &["hpp"]),
    ("stubs/cpp/src", &["cpp", "hpp"]),
    ("stubs/example-csharp/README.md", &["md"]),
    ("stubs/example-csharp/README.zh-CN.md", &["md"]),
    ("stubs/example-csharp/plugin.py", &["py"]),
    ("stubs/example-csharp/runtime", &["cs"]),
    ("stubs/kotlin/README.md", &["md"]),
    ("stubs/kotlin/README.zh-CN.md", &["md"]),
    ("stubs/kotlin/examples", &["java", "kt"]),
    ("stubs/kotlin/runtime/src/main", &["kt"]),
    ("stubs/python/README.md", &["md"]),
    ("stubs/python/README.zh-CN.md", &["md"]),
    ("stubs/python/examples", &["py"]),
    ("stubs/python/src/fc_runtime", &["py"]),
    ("stubs/typescript/README.md", &["md"]),
    ("stubs/typescript/README.zh-CN.md", &["md"]),
    ("stubs/typescript/src", &["ts"]),
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Forbidden {
    never: Vec<String>,
    #[serde(default)]
    but: Vec<String>,
    bad: String,
    say: String,
    why: Option<String>,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn forbidden() -> Vec<Forbidden> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/words/forbidden.yaml");
    let text = fs::read_to_string(path).unwrap();
    let by_language: BTreeMap<String, Vec<Forbidden>> = serde_yaml::from_str(&text).unwrap();
    by_language.into_values().flatten().collect()
}

/// Returns `true` if only readers of the source see a line. The doc comments of `fc-codegen` and `fc-spec` are for
/// their developers.
fn is_internal(file: &str, line: &str) -> bool {
    let line = line.trim_start();
    let internal = file.starts_with("fc-codegen") || file.starts_with("fc-spec");
    let is_doc = line.starts_with("///") || line.starts_with("//!");
    match Path::new(file)
        .extension()
        .and_then(|ending| ending.to_str())
    {
        Some("rs") => line.starts_with("//") && (!is_doc || internal),
        Some("py") => line.starts_with('#'),
        Some("cpp" | "hpp") => line.starts_with("//") && !is_doc,
        // Users read the documentation of items in a package.
        Some("ts" | "kt" | "java") if file.starts_with("stubs") => line.starts_with("//"),
        Some("ts" | "vue") => ["//", "/*", "*"]
            .iter()
            .any(|start| line.starts_with(start)),
        _ => false,
    }
}

impl Forbidden {
    /// Returns the first forbidden word in a line.
    fn find(&self, line: &str, lower: &str) -> Option<&str> {
        let never = self.never.iter().find(|word| {
            let cased = word.chars().any(|c| c.is_ascii_uppercase());
            let line = if cased { line } else { lower };
            line.match_indices(word.as_str()).any(|(at, _)| {
                let place = at..at + word.len();
                let excused = self.but.iter().any(|but| {
                    let mut places = line.match_indices(but.as_str());
                    places.any(|(from, _)| from < place.end && place.start < from + but.len())
                });
                !excused && is_whole(line, place.start, place.end)
            })
        })?;
        Some(never)
    }
}

/// Returns `true` if neither end of the range is inside an ASCII word.
fn is_whole(line: &str, start: usize, end: usize) -> bool {
    let bytes = line.as_bytes();
    let word = |at: Option<usize>| {
        let byte = at.and_then(|at| bytes.get(at));
        byte.is_some_and(u8::is_ascii_alphanumeric)
    };
    let goes_on = |at: usize| word(at.checked_sub(1)) && word(Some(at));
    !goes_on(start) && !goes_on(end)
}

/// Returns the forbidden words of a text, with their lines and replacements.
fn found(list: &[Forbidden], file: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let lines = text.lines().enumerate();
    for (index, line) in lines.filter(|(_, line)| !is_internal(file, line)) {
        let lower = line.to_ascii_lowercase();
        for entry in list {
            if let Some(word) = entry.find(line, &lower) {
                let why = entry.why.as_deref();
                let why = why.map_or_else(String::new, |why| format!(" ({why})"));
                let (line, say) = (index + 1, &entry.say);
                found.push(format!("{file}:{line}: `{word}`; say: {say}{why}"));
            }
        }
    }
    found
}

fn files(path: &Path, endings: &[&str], out: &mut Vec<PathBuf>) {
    if path.is_dir() {
        let inside = fs::read_dir(path).unwrap();
        let mut inside: Vec<_> = inside.map(|entry| entry.unwrap().path()).collect();
        inside.sort();
        for path in inside {
            files(&path, endings, out);
        }
    } else if path
        .extension()
        .is_some_and(|ending| endings.iter().any(|known| ending == *known))
    {
        out.push(path.to_owned());
    }
}

/// Returns the forbidden words in all texts of these places.
fn all_found(places: &[(&str, &[&str])]) -> String {
    let (root, list) = (root(), forbidden());
    let mut all = Vec::new();
    for (place, endings) in places {
        let mut texts = Vec::new();
        files(&root.join(place), endings, &mut texts);
        assert!(!texts.is_empty(), "nothing to read in {place}");
        for path in texts {
            let text = fs::read_to_string(&path).unwrap();
            let name = path.strip_prefix(&root).unwrap_or(&path);
            all.extend(found(&list, &name.to_string_lossy(), &text));
        }
    }
    all.join("\n")
}

#[test]
fn no_text_uses_a_forbidden_word() {
    assert_eq!(all_found(&TEXTS), "");
}

#[test]
#[ignore = "the texts of the spec are its owner's; `.ci/run` asks for them"]
fn no_text_of_the_spec_uses_a_forbidden_word() {
    assert_eq!(all_found(&[("spec", &["yaml"])]), "");
}

#[test]
fn each_entry_catches_its_example_only() {
    let list = forbidden();
    for entry in &list {
        let caught = found(std::slice::from_ref(entry), "x.md", &entry.bad);
        assert_eq!(caught.len(), 1, "`{}` is not caught", entry.bad);
        let fine = entry.but.iter().chain([&entry.say]);
        for text in fine {
            let caught = found(&list, "x.md", text);
            assert!(
                caught.is_empty(),
                "`{text}` may not be said either: {caught:?}"
            );
        }
    }
}
