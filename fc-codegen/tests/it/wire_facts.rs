//! Only `spec/` defines the wire format. No handwritten source contains a code, port, host, head, result code or key of
//! this project's spec. The test takes these facts from the model and does not read comments and tests.
//! `wire_facts/exceptions.yaml` lists the allowed exceptions.
//!
//! The test searches for distinctive facts only: numbers that are not round, codes as the spec writes them, and keys in
//! camel case. Additions to the spec therefore do not clash with words and numbers of another meaning.

use camino::Utf8Path;
use fc_spec::diagnostic::Faults;
use fc_spec::load::load;
use fc_spec::model::{Model, TypeShape};
use fc_spec::syntax::read_dir;
use regex_lite::Regex;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// Handwritten sources: a file or a whole directory, and the endings that count.
const SOURCES: [(&str, &[&str]); 28] = [
    ("fc-cli/src", &["rs"]),
    ("fc-codegen/src", &["rs", "j2"]),
    ("fc-derive/src", &["rs"]),
    ("fc-diff/src", &["rs"]),
    ("fc-lsp/src", &["rs"]),
    ("editors/vscode/extension.js", &["js"]),
    ("fc-package/src", &["rs"]),
    ("fc-reflect/src", &["rs"]),
    ("fc-workshop/src", &["rs"]),
    ("fc-runtime/src", &["rs"]),
    ("fc-spec/src", &["rs"]),
    ("fc-generated/examples", &["rs"]),
    ("docs-site/.vitepress", &["ts", "vue"]),
    ("docs-site/lab", &["ts"]),
    ("docs-site/guides", &["py"]),
    ("fuzz/fuzz_targets", &["rs"]),
    ("load/src", &["rs"]),
    ("stubs/cpp/examples", &["cpp", "hpp"]),
    ("stubs/cpp/include", &["hpp"]),
    ("stubs/cpp/src", &["cpp", "hpp"]),
    ("stubs/example-csharp/plugin.py", &["py"]),
    ("stubs/example-csharp/runtime", &["cs"]),
    ("stubs/kotlin/examples", &["java", "kt"]),
    ("stubs/kotlin/runtime/src/main", &["kt"]),
    ("stubs/python/examples", &["py"]),
    ("stubs/python/src/fc_runtime", &["py"]),
    ("stubs/typescript/examples", &["ts"]),
    ("stubs/typescript/src", &["ts"]),
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Exceptions {
    /// Numbers and words that have another meaning in one file.
    means_something_else: Vec<Exception>,
    /// Files that use the words of another format.
    other_formats: Vec<OtherFormat>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Exception {
    file: String,
    fact: String,
    because: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OtherFormat {
    file: String,
    because: String,
}

/// The first bytes of frames.
struct Head {
    shown: String,
    /// The first byte in hex and in decimal. A line without either needs no closer check.
    first: [String; 2],
    pattern: Regex,
}

/// The facts that a source must not contain.
struct Facts {
    /// Codes as the spec writes them, with four hex digits.
    codes: BTreeSet<u64>,
    /// Codes, ports and result codes in decimal.
    numbers: BTreeSet<u64>,
    keys: BTreeSet<String>,
    heads: Vec<Head>,
    /// `None` if the host is a name that any program may use, such as `localhost`.
    host: Option<String>,
}

fn root() -> &'static Path {
    Utf8Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .as_std_path()
}

fn model() -> Model {
    let mut faults = Faults::new();
    let sources = read_dir(root(), "spec".as_ref(), &mut faults);
    load(&sources, &mut faults)
        .model()
        .expect("the spec has no faults")
}

/// Returns `true` for numbers that are often sizes, percentages or times. They identify no fact of the spec.
fn is_round(number: u64) -> bool {
    number < 0x100
        || number.is_multiple_of(50)
        || number.is_multiple_of(64)
        || (number + 1).is_power_of_two()
}

/// Returns `true` if a word looks like a key of a message and not like a word of a language.
fn is_camel(word: &str) -> bool {
    let mut letters = word.chars().zip(word.chars().skip(1));
    word.len() > 6
        && letters.any(|(one, next)| one.is_ascii_lowercase() && next.is_ascii_uppercase())
}

impl Facts {
    fn of(model: &Model) -> Self {
        let codes: BTreeSet<u64> = model
            .operations
            .iter()
            .filter_map(|operation| operation.code.value)
            .map(u64::from)
            .filter(|code| *code >= 0x100)
            .collect();
        let ports = model.transport.ports.each().into_iter();
        let results = model.results.iter();
        let numbers = ports
            .map(|port| u64::from(port.number))
            .chain(results.filter_map(|result| u64::try_from(result.code).ok()))
            .chain(codes.iter().copied())
            .filter(|number| !is_round(*number))
            .collect();

        let fields = model.types.iter().flat_map(|def| match &def.shape {
            TypeShape::Struct(shape) => shape.fields.as_slice(),
            _ => &[],
        });
        let envelope = model
            .envelope
            .request
            .iter()
            .chain(&model.envelope.response);
        let keys = fields
            .map(|field| &field.wire)
            .chain(envelope.map(|field| &field.wire))
            .chain(model.frame.header.iter().map(|field| &field.wire))
            // The search supports only keys that are a single ASCII word.
            .filter(|key| is_camel(key) && pieces(key).map(|(_, piece)| piece).eq([key.as_str()]))
            .cloned()
            .collect();

        let mut heads = Vec::new();
        for head in [&model.frame.request_head, &model.frame.response_head] {
            let (mut hex, mut decimal, mut shown) = (String::new(), String::new(), String::new());
            for (index, byte) in head.iter().enumerate() {
                let between = if index == 0 { "" } else { "[^0-9A-Za-z]*" };
                write!(hex, r"{between}(?:0x|\\x)?{byte:02x}").unwrap();
                let between = if index == 0 { "" } else { r",\s*" };
                write!(decimal, "{between}{byte}").unwrap();
                write!(shown, "{byte:02X}").unwrap();
            }
            // A single byte is too common to search for.
            if head.len() > 1 {
                let pattern =
                    format!(r"(?i)(?:^|[^0-9A-Za-z])(?:{hex}|{decimal})(?:[^0-9A-Za-z]|$)");
                heads.push(Head {
                    shown,
                    first: [format!("{:02x}", head[0]), head[0].to_string()],
                    pattern: Regex::new(&pattern).unwrap(),
                });
            }
        }
        let own = ["localhost", "127.", "0.0.0.0", "::"];
        let host = &model.transport.host;
        let is_own = own.iter().any(|own| host.starts_with(own));
        Self {
            codes,
            numbers,
            keys,
            heads,
            host: (!is_own).then(|| host.clone()),
        }
    }

    /// Returns the facts in a line, as the line writes them.
    fn in_line(&self, ending: &str, line: &str) -> Vec<String> {
        let mut found: Vec<String> = numbers(line)
            .filter(|(token, number)| {
                let is_code = token.len() == 6 && token.starts_with("0x");
                (is_code && self.codes.contains(number)) || self.numbers.contains(number)
            })
            .map(|(token, _)| token.to_owned())
            .collect();
        let words = words(ending, line);
        found.extend(words.into_iter().filter(|word| self.keys.contains(word)));
        let lower = line.to_ascii_lowercase();
        let heads = self.heads.iter().filter(|head| {
            let begins = head.first.iter().any(|byte| lower.contains(byte.as_str()));
            begins && head.pattern.is_match(line)
        });
        found.extend(heads.map(|head| head.shown.clone()));
        let host = self.host.iter().filter(|host| line.contains(host.as_str()));
        found.extend(host.cloned());
        found
    }
}

/// Returns the numbers in a line, as written and as values. It skips parts of dates, fractions, standards and character
/// escapes.
fn numbers(line: &str) -> impl Iterator<Item = (&str, u64)> {
    pieces(line).filter_map(|(at, piece)| {
        let (before, after) = (&line[..at], &line[at + piece.len()..]);
        let date = after.starts_with('-') && after[1..].starts_with(|c: char| c.is_ascii_digit());
        let fraction = before.ends_with(|c: char| c.is_ascii_digit() || c == '.');
        if date || fraction || before.ends_with("RFC ") || before.ends_with(r"\u{") {
            return None;
        }
        let hex = piece.strip_prefix("0x");
        let digits = hex.unwrap_or(piece);
        let radix = if hex.is_some() { 16 } else { 10 };
        let end = digits
            .find(|c: char| c != '_' && !c.is_digit(radix))
            .unwrap_or(digits.len());
        let (digits, suffix) = digits.split_at(end);
        // `5656u16` is a number, `5656th` is not.
        if !matches!(
            suffix,
            "" | "u16" | "u32" | "u64" | "i32" | "i64" | "usize" | "n"
        ) {
            return None;
        }
        let number = u64::from_str_radix(&digits.replace('_', ""), radix).ok()?;
        let written = piece.strip_suffix(suffix)?.trim_end_matches('_');
        Some((written, number))
    })
}

/// Returns runs of letters, digits and underscores with their offsets.
fn pieces(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let inside = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.split(move |c: char| !inside(c))
        .filter(|piece| !piece.is_empty())
        .map(|piece| (piece.as_ptr() as usize - text.as_ptr() as usize, piece))
}

/// Returns the pattern for the strings of a line.
fn strings(ending: &str) -> &'static Regex {
    static DOUBLE: LazyLock<Regex> = LazyLock::new(|| Regex::new(r#""(?:[^"\\]|\\.)*""#).unwrap());
    static SCRIPT: LazyLock<Regex> =
        LazyLock::new(|| Regex::new(r"'(?:[^'\\]|\\.)*'|`[^`]*`").unwrap());
    static PYTHON: LazyLock<Regex> =
        LazyLock::new(|| Regex::new(r#""(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'"#).unwrap());
    static ALL: LazyLock<Regex> = LazyLock::new(|| Regex::new(".+").unwrap());
    match ending {
        "rs" | "cs" | "kt" | "java" | "cpp" | "hpp" => &DOUBLE,
        "ts" | "vue" => &SCRIPT,
        "py" => &PYTHON,
        _ => &ALL,
    }
}

/// Returns the camel case words in the strings of a line. Outside strings, such words are names of the program.
fn words(ending: &str, line: &str) -> Vec<String> {
    static INSERTED: LazyLock<Regex> =
        LazyLock::new(|| Regex::new(r"\$(?:\{[^}]*\}|[a-z]\w*)").unwrap());
    let mut found = Vec::new();
    if !pieces(line).any(|(_, word)| is_camel(word)) {
        return found;
    }
    for string in strings(ending).find_iter(line) {
        let string = INSERTED.replace_all(string.as_str(), " ");
        let words = pieces(&string).map(|(_, word)| word.to_owned());
        found.extend(words.filter(|word| is_camel(word)));
    }
    found
}

/// Returns the lines of a source that are neither comments nor tests, with their numbers.
fn code<'t>(ending: &str, text: &'t str) -> Vec<(usize, &'t str)> {
    let own = |line: &&str| ending != "rs" || !line.starts_with("#[cfg(test)]");
    let (comment, behind): (&[&str], &str) = match ending {
        "py" => (&["#"], "  # "),
        "j2" => (&["{#"], "{#"),
        _ => (&["//", "/*", "* ", "*/"], " // "),
    };
    text.lines()
        .take_while(own)
        .enumerate()
        .filter(|(_, line)| {
            !comment
                .iter()
                .any(|start| line.trim_start().starts_with(start))
        })
        .map(|(index, line)| (index + 1, line.split(behind).next().unwrap_or(line)))
        .collect()
}

fn files(path: &Path, endings: &[&str], out: &mut Vec<PathBuf>) {
    let name = path.file_name().unwrap_or_default();
    if path.is_dir() {
        // The output of the site repeats the spec.
        if ["tests", "dist", "cache"]
            .iter()
            .any(|other| name == *other)
        {
            return;
        }
        let mut inside: Vec<_> = fs::read_dir(path)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        inside.sort();
        for path in inside {
            files(&path, endings, out);
        }
    } else if name != "tests.rs" && endings.iter().any(|ending| is_ending(path, ending)) {
        out.push(path.to_owned());
    }
}

fn is_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|own| own == ending)
}

/// Returns every source by its path in the project, with its ending.
fn sources() -> BTreeMap<String, (String, String)> {
    let mut sources = BTreeMap::new();
    for (place, endings) in SOURCES {
        let mut found = Vec::new();
        files(&root().join(place), endings, &mut found);
        assert!(!found.is_empty(), "nothing to read in {place}");
        for path in found {
            let name = path.strip_prefix(root()).unwrap().to_string_lossy();
            let ending = path.extension().unwrap_or_default().to_string_lossy();
            let text = fs::read_to_string(&path).unwrap();
            sources.insert(name.into_owned(), (ending.into_owned(), text));
        }
    }
    sources
}

fn exceptions() -> Exceptions {
    let path = root().join("fc-codegen/tests/wire_facts/exceptions.yaml");
    serde_yaml::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn no_source_holds_a_wire_fact() {
    let (facts, exceptions) = (Facts::of(&model()), exceptions());
    let mut found = Vec::new();
    for (file, (ending, text)) in sources() {
        let other_words = exceptions
            .other_formats
            .iter()
            .any(|other| other.file == file);
        for (number, line) in code(&ending, &text) {
            for fact in facts.in_line(&ending, line) {
                let excused = exceptions.means_something_else.iter();
                let mut excused = excused.filter(|other| other.file == file);
                let is_word = other_words && facts.keys.contains(&fact);
                if !is_word && !excused.any(|other| other.fact == fact) {
                    found.push(format!("{file}:{number}: `{fact}` is a fact of spec/"));
                }
            }
        }
    }
    assert!(found.is_empty(), "\n{}\n", found.join("\n"));
}

#[test]
fn every_exception_is_needed() {
    let (sources, exceptions) = (sources(), exceptions());
    let lines = |file: &str| {
        let (ending, text) = sources.get(file).expect(file);
        let lines = code(ending, text).into_iter();
        lines
            .map(|(_, line)| (ending.clone(), line.to_owned()))
            .collect::<Vec<_>>()
    };
    for Exception {
        file,
        fact,
        because,
    } in &exceptions.means_something_else
    {
        let here = lines(file);
        let held = here.iter().any(|(ending, line)| {
            numbers(line).any(|(token, _)| token == fact) || words(ending, line).contains(fact)
        });
        assert!(held, "{file} does not hold {fact}");
        assert!(!because.is_empty(), "{file}: {fact}");
    }
    for OtherFormat { file, because } in &exceptions.other_formats {
        let here = lines(file);
        let any = here
            .iter()
            .any(|(ending, line)| !words(ending, line).is_empty());
        assert!(any, "{file} has no words to excuse");
        assert!(!because.is_empty(), "{file}");
    }
}

#[test]
fn each_fact_would_be_seen() {
    let model = model();
    let facts = Facts::of(&model);
    let seen = |ending: &str, text: &str| {
        let lines = code(ending, text).into_iter();
        lines
            .map(|(_, line)| facts.in_line(ending, line).len())
            .sum::<usize>()
    };
    for number in &facts.numbers {
        for text in [
            format!("const A: u16 = {number};"),
            format!("const A: u16 = {number}_u16;"),
            format!("let a = \"port {number}\";"),
        ] {
            assert_eq!(seen("rs", &text), 1, "{text}");
        }
    }
    // A code counts more than once if a frame head is the same number.
    for code in &facts.codes {
        let text = format!("if (code === 0x{code:04X}) {{");
        assert!(seen("ts", &text) >= 1, "{text}");
        let text = format!("0x{code:04x} => true,");
        assert!(seen("rs", &text) >= 1, "{text}");
    }
    for key in &facts.keys {
        assert_eq!(seen("rs", &format!("#[fc(wire = \"{key}\")]")), 1, "{key}");
        assert_eq!(seen("ts", &format!("body['{key}']")), 1, "{key}");
    }
    for head in [&model.frame.request_head, &model.frame.response_head] {
        let join = |between: &str| {
            let bytes = head.iter().map(|byte| format!("{byte:02x}"));
            bytes.collect::<Vec<_>>().join(between)
        };
        assert_eq!(seen("rs", &format!("&[0x{}]", join(", 0x"))), 1);
        assert_eq!(seen("py", &format!("b\"\\x{}\"", join("\\x"))), 1);
        assert_eq!(seen("ts", &format!("startsWith('{}')", join(" "))), 1);
    }
    if let Some(host) = &facts.host {
        assert_eq!(seen("vue", &format!("const host = '{host}'")), 1);
    }
    let any = facts.numbers.first().expect("a port");
    assert_eq!(seen("rs", &format!("/// Such as {any}.")), 0);
    assert_eq!(
        seen(
            "rs",
            &format!("#[cfg(test)]\nmod tests {{\n    const A: u16 = {any};")
        ),
        0
    );
    assert_eq!(seen("rs", &format!("(RFC {any})")), 0);
}
