//! Dumps that contain program text. No text of a dump may become code in any language.

use crate::good_spec;
use fc_codegen::emit::generate;
use fc_codegen::inspect;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_spec::model::Dump;
use proc_macro2::{TokenStream, TokenTree};
use serde_json::Value;
use std::collections::HashMap;
use std::path::PathBuf;

/// A word that no spec has. Outside comments and literals it is code.
const MARK: &str = "PWNED";

/// Texts that end a literal or a comment of some language and continue as code.
const PAYLOADS: &[&str] = &[
    "PWNED();",
    "x: i32 = PWNED(); y",
    "\"; PWNED(); \"",
    "'; PWNED(); '",
    "`; PWNED(); `",
    "\nPWNED();\n",
    "\rPWNED();\r",
    "\u{2028}PWNED();\u{2028}",
    "\u{85}PWNED();",
    "*/ PWNED(); /*",
    "/* PWNED(); //",
    "\"\"\"\nPWNED()\n\"\"\"",
    "'''\nPWNED()\n'''",
    "${PWNED()}",
    "$PWNED",
    "{PWNED()}",
    "\\",
    "\\\"; PWNED(); //",
    "\\u0022; PWNED(); //",
    "*\\u002f PWNED(); /*",
    "\"#; PWNED(); r#\"",
    ")\"; PWNED(); R\"(",
    "```\n\n```\nPWNED();\n```",
    "x\n\n    PWNED();\n",
    "@PWNED()",
    "\0PWNED()",
];

/// Collects every text of a value with its path.
fn texts(value: &Value, at: &str, out: &mut Vec<(String, String)>) {
    match value {
        Value::String(text) => out.push((at.to_owned(), text.clone())),
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                texts(item, &format!("{at}/{index}"), out);
            }
        }
        Value::Object(entries) => {
            for (key, entry) in entries {
                let key = key.replace('~', "~0").replace('/', "~1");
                texts(entry, &format!("{at}/{key}"), out);
            }
        }
        Value::Null | Value::Bool(_) | Value::Number(_) => {}
    }
}

/// The syntax of comments and literals in a language.
struct Lexis {
    line_comment: &'static str,
    has_block_comments: bool,
    nests_comments: bool,
    quotes: &'static [&'static str],
    /// The start of code inside a literal, and the quotes that allow it.
    interpolation: Option<(&'static str, &'static [&'static str])>,
}

fn lexis(extension: &str) -> Option<Lexis> {
    Some(match extension {
        "py" | "pyi" => Lexis {
            line_comment: "#",
            has_block_comments: false,
            nests_comments: false,
            quotes: &["\"\"\"", "'''", "\"", "'"],
            interpolation: None,
        },
        "ts" => Lexis {
            line_comment: "//",
            has_block_comments: true,
            nests_comments: false,
            quotes: &["\"", "'", "`"],
            interpolation: Some(("${", &["`"])),
        },
        "kt" => Lexis {
            line_comment: "//",
            has_block_comments: true,
            nests_comments: true,
            quotes: &["\"\"\"", "\"", "'"],
            interpolation: Some(("$", &["\"\"\"", "\""])),
        },
        "hpp" | "cpp" | "java" => Lexis {
            line_comment: "//",
            has_block_comments: true,
            nests_comments: false,
            quotes: &["\"", "'"],
            interpolation: None,
        },
        _ => return None,
    })
}

/// Returns the code of a file without comments and literals. Code inside a literal stays.
fn code(text: &str, lexis: &Lexis) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let after = |rest: &str, end: usize| rest.get(end..).unwrap_or_default().len();
        let left = if rest.starts_with(lexis.line_comment) {
            // C++ joins lines that end with a backslash.
            let end = |rest: &str| rest.find(['\n', '\r', '\u{2028}', '\u{2029}', '\u{85}']);
            let mut to = end(rest).unwrap_or(rest.len());
            while rest[..to].ends_with('\\') && to < rest.len() {
                to += 1 + end(&rest[to + 1..]).unwrap_or(rest.len() - to - 1);
            }
            after(rest, to)
        } else if lexis.has_block_comments && rest.starts_with("/*") {
            let mut to = 2;
            let mut depth = 1;
            while depth > 0 && to < rest.len() {
                let here = &rest[to..];
                if here.starts_with("*/") {
                    depth -= 1;
                    to += 2;
                } else if lexis.nests_comments && here.starts_with("/*") {
                    depth += 1;
                    to += 2;
                } else {
                    to += here.chars().next().map_or(1, char::len_utf8);
                }
            }
            after(rest, to)
        } else if let Some((mark, _)) = rest.strip_prefix("R\"").and_then(|it| it.split_once('(')) {
            let open = mark.len() + 3;
            let close = rest[open..].find(&format!("){mark}\""));
            after(
                rest,
                close.map_or(rest.len(), |at| open + at + mark.len() + 2),
            )
        } else if let Some(quote) = lexis.quotes.iter().find(|it| rest.starts_with(**it)) {
            let mut to = quote.len();
            while to < rest.len() && !rest[to..].starts_with(quote) {
                let here = &rest[to..];
                let is_raw = quote.len() == 3 && lexis.nests_comments;
                if here.starts_with('\\') && !is_raw {
                    to += 1;
                } else if quote.len() == 1 && *quote != "`" && here.starts_with(['\n', '\r']) {
                    // An open literal: the rest is code.
                    break;
                } else if let Some((mark, quotes)) = lexis.interpolation
                    && quotes.contains(quote)
                    && here.starts_with(mark)
                {
                    code.push_str(here.lines().next().unwrap_or_default());
                }
                to += rest[to..].chars().next().map_or(1, char::len_utf8);
            }
            after(rest, (to + quote.len()).min(rest.len()))
        } else {
            code.push(first);
            after(rest, first.len_utf8())
        };
        rest = &rest[rest.len() - left..];
    }
    code
}

/// Returns `true` if Rust code contains the mark outside comments and literals.
fn has_mark(tokens: TokenStream) -> bool {
    tokens.into_iter().any(|tree| match tree {
        TokenTree::Group(group) => has_mark(group.stream()),
        TokenTree::Ident(ident) => ident == MARK,
        TokenTree::Punct(_) | TokenTree::Literal(_) => false,
    })
}

/// Returns `true` if a sample in a doc comment contains the mark. rustdoc compiles samples in fences and samples that
/// are indented by four spaces.
fn is_sampled(text: &str) -> bool {
    let docs = text.lines().filter_map(|line| {
        let line = line.trim_start();
        line.strip_prefix("///").or(line.strip_prefix("//!"))
    });
    // The language of the open fence.
    let mut open: Option<&str> = None;
    for line in docs {
        let is_compiled = open.map_or(line.starts_with("     "), |language| {
            matches!(language, "" | "rust")
        });
        if let Some(language) = line.trim_start().strip_prefix("```") {
            open = open.is_none().then_some(language.trim());
        } else if is_compiled && line.contains(MARK) {
            return true;
        }
    }
    false
}

/// Returns the reason why a file contains a text of the spec as code.
fn fault(path: &str, text: &str) -> Option<String> {
    let extension = path.rsplit_once('.').map(|(_, extension)| extension);
    if extension == Some("rs") {
        return match text.parse::<TokenStream>() {
            Err(error) => Some(format!("it is not Rust: {error}")),
            Ok(_) if syn::parse_file(text).is_err() => Some("it does not parse".to_owned()),
            Ok(tokens) if has_mark(tokens.clone()) => Some("it has the text as code".to_owned()),
            Ok(_) => is_sampled(text).then(|| "a sample has the text as code".to_owned()),
        };
    }
    if extension == Some("json") {
        let parsed = serde_json::from_str::<Value>(text);
        return parsed.err().map(|error| error.to_string());
    }
    let lexis = lexis(extension?)?;
    let code = code(text, &lexis);
    let at = code.find(MARK)?;
    let line = code[..at].lines().last().unwrap_or_default();
    Some(format!("it has the text as code behind {line:?}"))
}

/// The test tries one of this many mutations. `FC_EVERY=1` tries all. `FC_DUMPS` names a folder for dumps that are
/// accepted and change a file.
const EVERY: usize = 97;

#[test]
fn no_text_of_a_dump_becomes_code() {
    let keep = std::env::var_os("FC_DUMPS").map(PathBuf::from);
    let every = std::env::var("FC_EVERY").map_or(EVERY, |every| every.parse().unwrap());
    let targets = Targets::of([
        Product::Rust,
        Product::TypeScript,
        Product::Python,
        Product::Kotlin,
        Product::Cpp,
    ])
    .with_newtypes();
    let model = good_spec::model();
    let before: HashMap<_, _> = generate(&model, &targets)
        .unwrap()
        .into_iter()
        .map(|it| (it.path, it.contents))
        .collect();
    let dump: Value = serde_json::from_str(&inspect::json(&model)).unwrap();
    let mut places = Vec::new();
    texts(&dump, "", &mut places);
    let mut faults = Vec::new();
    let [mut refused, mut made] = [0, 0];
    let mutations = places.iter().flat_map(|(place, text)| {
        let payloads = PAYLOADS.iter();
        payloads.flat_map(move |payload| {
            [(*payload).to_owned(), format!("{text}{payload}")].map(|text| (place, text))
        })
    });
    for (place, text) in mutations.step_by(every) {
        let mut dump = dump.clone();
        *dump.pointer_mut(place).unwrap() = Value::String(text.clone());
        let artifacts = Dump::read(&dump.to_string())
            .ok()
            .map(|model| generate(&model, &targets));
        let Some(Ok(artifacts)) = artifacts else {
            refused += 1;
            continue;
        };
        made += 1;
        let mut changed = artifacts;
        changed.retain(|it| before.get(&it.path) != Some(&it.contents));
        if let Some(folder) = keep.as_ref().filter(|_| !changed.is_empty()) {
            std::fs::write(folder.join(format!("{made:05}.json")), dump.to_string()).unwrap();
        }
        for artifact in changed {
            if let Some(fault) = fault(&artifact.path, &artifact.contents) {
                faults.push(format!("{place} = {text:?}: {}: {fault}", artifact.path));
            }
        }
    }
    println!("{} texts: {refused} refused, {made} made", places.len());
    assert!(refused > 0 && made > 0);
    let first: Vec<_> = faults.iter().take(40).cloned().collect();
    assert!(
        faults.is_empty(),
        "{} of {made}:\n{}",
        faults.len(),
        first.join("\n")
    );
}
