//! An emitter spells the decisions of `package`. It declares no `Group`, and reads no word of the vocabulary that
//! `package` turns into names and values.

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

#[test]
fn emitters_read_no_word_that_package_spells() {
    let emit = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/emit");
    let mut found = Vec::new();
    for emitter in EMITTERS {
        let files = fs::read_dir(emit.join(emitter)).expect("each emitter is a folder");
        for file in files {
            let path = file.expect("it can be read").path();
            let text = fs::read_to_string(&path).expect("it is a source");
            // A quirk of the header is not one of a field, and a name decides nothing.
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
