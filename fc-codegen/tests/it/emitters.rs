//! An emitter spells the decisions of `package`. It declares no `Group`. It reads no vocabulary word that `package`
//! turns into names and values.

use std::fs;
use std::path::Path;

const EMITTERS: [&str; 5] = ["cpp", "kotlin", "python", "rust", "typescript"];

/// Words that only `package` reads.
const WORDS: [&str; 5] = [
    "Constraint::",
    "EncodingRole::",
    "Quirk::",
    "ResultRole::",
    "struct Group ",
];

/// Returns the sources of an emitter and its templates, each as one string.
fn texts(emitter: &str) -> [String; 2] {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("src/emit")
        .join(emitter);
    let mut texts = [String::new(), String::new()];
    for file in fs::read_dir(folder).expect("each emitter is a folder") {
        let path = file.expect("it can be read").path();
        let is_template = path.extension().is_some_and(|it| it == "in");
        let text = fs::read_to_string(&path).expect("it is a text");
        texts[usize::from(is_template)].push_str(&text);
    }
    texts
}

#[test]
fn every_template_is_used_and_every_used_one_exists() {
    for emitter in EMITTERS {
        let [sources, templates] = texts(emitter);
        let names = templates.lines().filter_map(|it| it.strip_prefix("---- "));
        let names: Vec<&str> = names.collect();
        let is_named = |name: &str| sources.contains(&format!("\"{name}\""));
        // The name of an `all_…` template is built from a kind.
        let is_unused = |name: &&&str| !is_named(name) && !name.starts_with("all_");
        assert_eq!(names.iter().find(is_unused), None, "{emitter}");
        for call in [".template(\"", ".head(\""] {
            let mut used = sources
                .split(call)
                .skip(1)
                .filter_map(|it| it.split('"').next());
            assert_eq!(used.find(|name| !names.contains(name)), None, "{emitter}");
        }
    }
}

#[test]
fn emitters_read_no_word_that_package_spells() {
    let emit = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/emit");
    let mut found = Vec::new();
    for emitter in EMITTERS {
        let files = fs::read_dir(emit.join(emitter)).expect("each emitter is a folder");
        for file in files {
            let path = file.expect("it can be read").path();
            let text = fs::read_to_string(&path).expect("it is a source");
            // A quirk of the header is not a quirk of a field. Reading a name makes no decision.
            let text = text
                .replace("HeaderQuirk::", "")
                .replace("ResultRole::name", "");
            let words = WORDS.iter().filter(|word| text.contains(**word));
            let path = path.strip_prefix(&emit).expect("it is below").to_owned();
            found.extend(words.map(|word| (path.to_string_lossy().into_owned(), *word)));
        }
    }
    assert_eq!(found, []);
}
