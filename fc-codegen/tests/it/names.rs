//! Names of a spec that a language does not allow. Each fixture of `names/` is added to the small good spec.
//!
//! Comments at the top of a fixture list all expected findings with their languages: `# expect: FC0209 at 6:3 in
//! Kotlin`.

use crate::good_spec;
use fc_codegen::package::items::clashes;
use fc_codegen::package::language::{CPP, JAVA, KOTLIN, Language, PYTHON, RUST, Role, TYPESCRIPT};
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::index::definitions;
use fc_spec::load::load;
use fc_spec::model::Lang;
use fc_spec::source::Sources;
use std::fs;
use std::path::Path;

/// Returns the findings for these files, in the format of the fixtures.
fn found(files: &[(String, String)], shown: &str) -> Vec<String> {
    let sources = Sources::from_texts(files.iter().map(|(path, text)| (path, text)));
    let mut faults = Faults::new();
    let loaded = load(&sources, &mut faults);
    assert!(
        !faults.has_errors(),
        "{}",
        render(&faults, &sources, Format::Text, Lang::En)
    );
    let places = definitions(&sources);
    let model = loaded.model().expect("it has no errors");
    let clashes = clashes(&model, &Language::ALL);
    let say = |clash: &fc_codegen::package::name::Clash<'_>| {
        let fault = clash.fault(&places).expect("it has a place");
        assert_eq!(sources.path(fault.primary.span), shown, "{fault:?}");
        let at = sources.line_col(fault.primary.span);
        let code = fault.code.as_str();
        format!("{code} at {}:{} in {}", at.line, at.column, clash.language)
    };
    clashes.iter().map(say).collect()
}

/// Returns the good spec with another file of commands.
fn with(text: &str) -> Vec<(String, String)> {
    let good = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    let more = ("spec/commands/bad.yaml".to_owned(), text.to_owned());
    good.into_iter().chain([more]).collect()
}

/// Returns the languages that refuse a name of `protocol.yaml`.
fn languages(files: &[(String, String)]) -> Vec<String> {
    let found = found(files, "spec/protocol.yaml");
    let language = |it: String| it.split(" in ").nth(1).map(str::to_owned);
    found.into_iter().filter_map(language).collect()
}

#[test]
fn every_fixture_has_the_clashes_that_it_expects() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/names");
    let mut count = 0;
    let mut wrong = Vec::new();
    for entry in fs::read_dir(folder).expect("the fixtures") {
        let path = entry.expect("an entry").path();
        let text = fs::read_to_string(&path).expect("a fixture");
        let expected = text
            .lines()
            .filter_map(|line| line.strip_prefix("# expect: "));
        let expected: Vec<_> = expected.collect();
        let found = found(&with(&text), "spec/commands/bad.yaml");
        if found != expected {
            wrong.push(format!("{}: {found:#?}", path.display()));
        }
        count += 1;
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(count >= 9, "{count}");
}

#[test]
fn the_name_of_the_protocol_is_a_type_as_well() {
    let mut files = with("group: { id: bad, zh: 坏的, en: Bad }\n");
    for (_, text) in &mut files {
        *text = text.replacen("id: demo", "id: option", 1);
    }
    assert_eq!(languages(&files), ["Rust"]);
}

#[test]
fn similar_envelope_keys_clash_in_some_languages() {
    let mut files = with("group: { id: bad, zh: 坏的, en: Bad }\n");
    for (_, text) in &mut files {
        *text = text.replacen("result: { type", "result: { name: sent_at1, type", 1);
        *text = text.replacen("text: { type", "text: { name: sent_at_1, type", 1);
    }
    assert_eq!(languages(&files), ["TypeScript", "Kotlin", "Java"]);
}

/// A language that allows a name only in another spelling uses that spelling.
#[test]
fn reserved_words_are_escaped() {
    for (language, role, name, spelling) in [
        (&RUST, Role::Field, "type", "r#type"),
        (&RUST, Role::Field, "self", "self_"),
        (&RUST, Role::Method, "connect", "connect_"),
        (&RUST, Role::Module, "match", "r#match"),
        (&TYPESCRIPT, Role::Field, "class", "class"),
        (&TYPESCRIPT, Role::Field, "extra", "extra_"),
        (&TYPESCRIPT, Role::Method, "delete", "delete_"),
        (&TYPESCRIPT, Role::Method, "then", "then_"),
        (&TYPESCRIPT, Role::Module, "index", "index_"),
        (&TYPESCRIPT, Role::Field, "prototype", "prototype_"),
        (&KOTLIN, Role::Field, "val", "val_"),
        (&KOTLIN, Role::Method, "hash_code", "hashCode_"),
        (&JAVA, Role::Field, "class", "class_"),
        (&JAVA, Role::Method, "wait", "wait_"),
        (&CPP, Role::Field, "operator", "operator_"),
        (&CPP, Role::Field, "co_await", "co_await_"),
        (&PYTHON, Role::Field, "lambda", "lambda_"),
        (&PYTHON, Role::Value, "none", "NONE"),
    ] {
        let found = language.spelling(role, name);
        assert_eq!(found.as_deref(), Ok(spelling), "{} {name}", language.title);
    }
    for (language, role, name) in [
        (&RUST, Role::Type, "Option"),
        (&RUST, Role::Module, "crate"),
        (&TYPESCRIPT, Role::Type, "Promise"),
        (&KOTLIN, Role::Type, "Pair"),
        (&JAVA, Role::Type, "Object"),
        (&CPP, Role::Type, "NULL"),
        (&PYTHON, Role::Type, "TimeoutError"),
    ] {
        assert!(language.spelling(role, name).is_err(), "{name}");
    }
}

/// The ID type of an entity clashes with another name only in packages that have ID types.
#[test]
fn the_type_of_ids_is_a_name_like_any_other() {
    let text = "\
group: { id: bad, zh: 坏的, en: Bad }
commands:
  do_it:
    code: 0x0102
    zh: 动作
    en: Do it
    effect: config
    source: { sections: [] }
    request:
      own: { type: ThingId, zh: 甲, en: First }
types:
  ThingId: { zh: 编号, en: Number, fields: { value: { type: u8, example: 1, zh: 值, en: Value } } }
";
    let files = with(text);
    let sources = Sources::from_texts(files.iter().map(|(path, text)| (path, text)));
    let mut faults = Faults::new();
    let loaded = load(&sources, &mut faults);
    let model = loaded.model().expect("it has no errors");
    assert_eq!(clashes(&model, &[&RUST]), []);
    let found = clashes(&model, &[RUST.with_ids()]);
    let found: Vec<String> = found.iter().map(ToString::to_string).collect();
    assert_eq!(
        found,
        ["`entity thing` cannot be called `ThingId` in Rust, like `struct ThingId`"]
    );
}
