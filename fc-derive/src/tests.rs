//! Expansions as tokens, without a compiler.

use crate::item::{Expand, derive};
use proc_macro2::{TokenStream, TokenTree};
use std::fs;
use std::path::Path;
use std::str::FromStr as _;

const DERIVES: [(&str, Expand); 13] = [
    ("Message", crate::message::expand),
    ("New", crate::new::expand),
    ("Defaults", crate::defaults::expand),
    ("OpenEnum", crate::open_enum::expand),
    ("OneOf", crate::one_of::expand),
    ("Id", crate::id::expand),
    ("DeclaredError", crate::declared::expand),
    ("Command", crate::operation::expand_command),
    ("Report", crate::operation::expand_report),
    ("Header", crate::header::expand),
    ("Envelope", crate::envelope::expand),
    ("Dispatch", crate::reports::expand),
    ("RedactedDebug", crate::redacted::expand),
];

/// Returns the expansion of each macro call of a program.
fn expansions(program: &str) -> Vec<TokenStream> {
    let mut expansions = Vec::new();
    let mut tokens = TokenStream::from_str(program)
        .unwrap_or_default()
        .into_iter()
        .peekable();
    while let Some(token) = tokens.next() {
        // At this level, `#` starts an attribute of an item.
        let TokenTree::Punct(punct) = &token else {
            continue;
        };
        if punct.as_char() != '#' {
            continue;
        }
        let Some(TokenTree::Group(attribute)) = tokens.next() else {
            continue;
        };
        let mut words = attribute.stream().into_iter();
        let name = words.next().map(|word| word.to_string());
        let Some(TokenTree::Group(arguments)) = words.next() else {
            continue;
        };
        // The rest of the item up to its body, including its other attributes.
        let rest = || -> TokenStream {
            let mut ended = false;
            let rest = tokens.clone().take_while(|token| {
                let goes_on = !ended;
                ended |= matches!(token, TokenTree::Group(group)
                    if group.delimiter() == proc_macro2::Delimiter::Brace);
                ended |= token.to_string() == ";";
                goes_on
            });
            rest.collect()
        };
        match name.as_deref() {
            Some("derive") => {
                let names: Vec<_> = arguments
                    .stream()
                    .into_iter()
                    .map(|t| t.to_string())
                    .collect();
                let called = DERIVES
                    .iter()
                    .filter(|(name, _)| names.iter().any(|n| n == name));
                expansions.extend(called.map(|(_, expand)| derive(rest(), *expand)));
            }
            Some("dispatch") => {
                expansions.push(crate::dispatch::expand(arguments.stream(), rest()));
            }
            _ => {}
        }
    }
    expansions
}

fn programs(folder: &str) -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests")
        .join(folder);
    let files = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|file| file.path());
    let mut programs: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .map(|path| {
            let name = path
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            (name, fs::read_to_string(&path).unwrap_or_default())
        })
        .collect();
    programs.sort();
    programs
}

fn is_refusal(expansion: &TokenStream) -> bool {
    !refusals(expansion.clone()).is_empty()
}

/// Returns the texts of all `compile_error!` of an expansion.
fn refusals(expansion: TokenStream) -> Vec<String> {
    let mut texts = Vec::new();
    let mut asked = false;
    for token in expansion {
        match token {
            TokenTree::Ident(name) => asked = name == "compile_error",
            TokenTree::Group(group) if asked => {
                let text = syn::parse2::<syn::LitStr>(group.stream());
                texts.extend(text.map(|text| text.value()));
                asked = false;
            }
            TokenTree::Group(group) => texts.extend(refusals(group.stream())),
            _ => {}
        }
    }
    texts
}

/// The compiler rejects programs whose name starts with `type_`, because of a type in the expansion. The macro rejects
/// all others.
#[test]
fn refuses_every_program() {
    let programs = programs("ui");
    assert!(programs.len() >= 100, "{}", programs.len());
    for (name, program) in &programs {
        let refused = expansions(program).iter().any(is_refusal);
        let by_compiler = name.starts_with("type_") || name == "command_without_message";
        assert_eq!(refused, !by_compiler, "{name}");
    }
}

/// Compares the texts of errors with any compiler. `tests/ui.rs` compares positions with the pinned one.
#[test]
fn refuses_in_the_words_that_are_written_down() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/ui");
    for (name, program) in programs("ui") {
        let written = fs::read_to_string(folder.join(format!("{name}.stderr")));
        let written = written.unwrap_or_default();
        assert!(written.starts_with("error"), "{name}: nothing is written");
        for text in expansions(&program).into_iter().flat_map(refusals) {
            assert!(
                written.contains(&format!("error: {text}\n")),
                "{name}: {text}"
            );
        }
    }
}

#[test]
fn takes_every_program_that_is_right() {
    for (name, program) in programs("pass") {
        assert!(!expansions(&program).iter().any(is_refusal), "{name}");
    }
}

/// Expansions take most of the time to compile the generated crate.
#[test]
fn expansions_stay_small() {
    let size = |tokens: TokenStream| tokens.to_string().split_whitespace().count();
    let message = |fields: &str| {
        let item = format!("struct S {{ {fields} #[fc(extra)] extra: Extra }}");
        let item = TokenStream::from_str(&item).unwrap_or_default();
        size(derive(item, crate::message::expand))
    };
    let fields = |count: usize| -> String {
        let field = |n| format!("#[fc(key = \"field{n}\", min = 0)] field_{n}: i32,");
        (0..count).map(field).collect::<Vec<_>>().concat()
    };
    let [none, one, two] = [0, 1, 2].map(|count| message(&fields(count)));
    assert!(none < 400, "{none}");
    assert!(one - none < 260, "{}", one - none);
    // Tokens per further field.
    assert!(two - one < 150, "{}", two - one);
}
