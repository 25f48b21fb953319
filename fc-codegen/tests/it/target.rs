//! The settings of `fc.yaml`, and the files that they generate.

use crate::good_spec;
use fc_codegen::emit::generate;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_spec::language::project_schema;
use serde_json::Value;

fn made(yaml: &str) -> Vec<String> {
    let targets = Targets::read(yaml).expect("sound");
    let artifacts = generate(&good_spec::model(), &targets).expect("made");
    artifacts
        .into_iter()
        .map(|artifact| artifact.path)
        .collect()
}

#[test]
fn target_is_written_to_its_directory_alone() {
    let paths = made("targets:\n  vectors: { out: golden/frames/ }\n");
    assert!(paths.len() > 3);
    let outside = paths
        .iter()
        .filter(|path| !path.starts_with("golden/frames/"));
    assert_eq!(outside.count(), 0, "{paths:?}");
    assert_eq!(
        made("targets: { schema: { out: . } }"),
        ["fc-spec.schema.json"]
    );
    assert_eq!(made("targets: { schema: }"), ["spec/fc-spec.schema.json"]);
}

#[test]
fn without_a_file_all_products_have_defaults() {
    let targets = Targets::default();
    for product in Product::ALL {
        assert_eq!(targets.place(product), Some(product.usual_place()));
    }
    assert_eq!(targets.spec, "spec");
}

#[test]
fn docs_are_made_in_the_languages_asked_for() {
    let paths = made("targets: { markdown: { out: d, languages: [en] } }");
    assert!(
        paths.iter().any(|path| path == "d/en/reference/index.md"),
        "{paths:?}"
    );
    assert!(
        !paths.iter().any(|path| path == "d/reference/index.md"),
        "{paths:?}"
    );
}

/// Comments link to the pages in their own languages. They have no links if the project has no pages.
#[test]
fn comments_name_the_docs_directory() {
    let comments = |yaml: &str| {
        let targets = Targets::read(yaml).expect("sound");
        let targets = targets.only(&["rust".to_owned()]).expect("there");
        let artifacts = generate(&good_spec::model(), &targets).expect("made");
        let rust = artifacts.into_iter();
        rust.map(|artifact| artifact.contents).collect::<String>()
    };
    let without = comments("targets: { rust: }");
    assert!(without.contains("Spec: `commands.get_thing`"));
    assert!(!without.contains("Docs: "));
    let zh = "- 文档：`handbook/reference/commands/get_thing.md`";
    let en = "- Docs: `handbook/en/reference/commands/get_thing.md`";
    for (of_docs, of_rust, links) in [
        ("[zh, en]", "[zh, en]", [true, true]),
        ("[zh]", "[zh, en]", [true, false]),
        ("[en]", "[zh, en]", [false, true]),
        ("[zh, en]", "[zh]", [true, false]),
        ("[zh]", "[en]", [false, false]),
    ] {
        let docs = format!("markdown: {{ out: handbook, languages: {of_docs} }}");
        let rust = format!("rust: {{ languages: {of_rust} }}");
        let elsewhere = comments(&format!("targets: {{ {rust}, {docs} }}"));
        let found = [zh, en].map(|link| elsewhere.contains(link));
        assert_eq!(found, links, "{rust}, {docs}");
    }
}

/// Each entity has an ID type if the target requests it, and only then. Pages that are generated alone show the same
/// code.
#[test]
fn ids_have_types_if_requested() {
    let all = |yaml: &str, only: &[&str]| {
        let only: Vec<_> = only.iter().map(ToString::to_string).collect();
        let targets = Targets::read(yaml).expect("sound");
        let targets = targets.only(&only).expect("there");
        let artifacts = generate(&good_spec::model(), &targets).expect("whole");
        let text = artifacts
            .into_iter()
            .map(|it| format!("{}\n{}", it.path, it.contents));
        text.collect::<String>()
    };
    let with = "targets: { rust: { newtypes: true }, markdown: }";
    let rust = all(with, &["rust"]);
    assert!(rust.contains("pub struct ThingId(pub i64);"));
    assert!(rust.contains("fc-generated/src/ids.rs\n"));
    assert!(rust.contains("pub thing_id: ThingId,"));
    assert!(
        rust.contains("- Docs: `docs-site/en/reference/"),
        "a package that is made alone points to the docs as well"
    );
    let pages = all(with, &["markdown"]);
    assert!(pages.contains("ThingMoved::new(ThingId(7))"), "{pages}");
    for without in [
        "targets: { rust: { newtypes: false }, markdown: }",
        "targets: { rust: , markdown: }",
    ] {
        assert!(!all(without, &[]).contains("ThingId"));
    }
}

#[test]
fn invalid_settings_are_refused_by_name() {
    for (yaml, message) in [
        (
            "targets: [rust]",
            "fc.yaml:1:10: expected a mapping from texts, found a list",
        ),
        (
            "targets:\n  rust: { ouut: a }\n",
            "fc.yaml:2:11: `ouut` is not a key of the target",
        ),
        (
            "target: {}\n",
            "fc.yaml:1:1: `target` is not a key of the project",
        ),
        (
            "targets: { cobol: { out: a } }",
            "fc.yaml:1:12: there is no product `cobol`",
        ),
        (
            "targets: { rust: { plugin: x } }",
            "the target `rust` cannot have `plugin`",
        ),
        (
            "targets: { schema: { audience: product_app } }",
            "the target `schema` cannot have `audience`",
        ),
        (
            "targets: { vectors: { languages: [zh] } }",
            "the target `vectors` cannot have `languages`",
        ),
        (
            "targets: { mine: { plugin: x } }",
            "the target `mine` needs `out`",
        ),
        (
            "targets: { vectors: { newtypes: true } }",
            "the target `vectors` cannot have `newtypes`",
        ),
        (
            "targets: { mine: { plugin: x, out: a, newtypes: true } }",
            "the target `mine` cannot have `newtypes`",
        ),
        (
            "targets: { mine: { plugin: x, out: a, languages: [zh] } }",
            "the target `mine` cannot have `languages`",
        ),
        (
            "targets: { rust: { names: rust } }",
            "the target `rust` cannot have `names`",
        ),
        (
            "targets: { mine: { plugin: x, out: a, names: cobol } }",
            "there is no programming language `cobol`",
        ),
        (
            "targets: { markdown: { languages: [fr] } }",
            "`fr` is not allowed here",
        ),
        (
            "languages: []",
            "fc.yaml:1:12: expected at least 1, found 0",
        ),
        (
            "targets: { markdown: { languages: [] } }",
            "expected at least 1, found 0",
        ),
    ] {
        let error = Targets::read(yaml).expect_err(yaml).to_string();
        assert!(
            error.starts_with("fc.yaml:") && error.contains(message),
            "{yaml}: {error}"
        );
    }
}

/// An editor shows the defaults of the grammar. The generator must have the same ones.
#[test]
fn defaults_are_those_of_the_schema() {
    let schema: Value = serde_json::from_str(&project_schema()).expect("JSON");
    let target = &schema["$defs"]["target"]["properties"];
    let targets =
        Targets::read("targets: { rust: {}, mine: { plugin: x, out: a } }").expect("sound");
    let plugin = targets.plugins().first().expect("a plugin");
    assert_eq!(schema["properties"]["spec"]["default"], targets.spec);
    assert_eq!(target["crate"]["default"], targets.krate());
    assert_eq!(target["newtypes"]["default"], targets.has_id_types());
    let timeout = u64::try_from(plugin.timeout.as_millis()).expect("a short time");
    assert_eq!(target["timeout_ms"]["default"], timeout);
    assert_eq!(target["output_bytes"]["default"], plugin.output_bytes);
}

#[test]
fn only_names_targets() {
    let targets =
        || Targets::read("targets: { rust: , mine: { plugin: x, out: a } }").expect("sound");
    let only = |names: &[&str]| {
        let names: Vec<_> = names.iter().map(ToString::to_string).collect();
        targets()
            .only(&names)
            .map(|targets| targets.names().collect::<Vec<_>>().join(" "))
    };
    assert_eq!(only(&[]).expect("all"), "rust mine");
    assert_eq!(only(&["mine"]).expect("there"), "mine");
    assert_eq!(
        only(&["vectors"]).expect_err("not there").to_string(),
        "there is no target `vectors`; the targets are `rust`, `mine`"
    );
}

/// A target contains the part of its audience.
#[test]
fn a_target_is_made_for_its_audience() {
    let yaml = "targets: { rust: { audience: product_app }, typescript: , mine: { plugin: x, out: a, audience: debugging_app } }";
    let targets = Targets::read(yaml).expect("sound");
    let model = good_spec::model();
    targets.check_audiences(&model).expect("both are declared");
    let artifacts = generate(&model, &targets).expect("made");
    let says = |target: &str, text: &str| {
        let mut artifacts = artifacts.iter();
        artifacts.any(|it| it.target == target && it.contents.contains(text))
    };
    assert!(says("rust", "pub x: f64") && !says("rust", "pub y: Option<f64>"));
    assert!(says("typescript", "key: 'y'"));
    let audiences = targets.plugins().iter().map(|it| it.audience.as_deref());
    assert_eq!(audiences.collect::<Vec<_>>(), [Some("debugging_app")]);

    let targets = Targets::read("targets: { rust: { audience: nobody } }").expect("sound");
    let message = "there is no audience `nobody`; the spec declares `product_app`, `debugging_app`";
    let checked = targets.check_audiences(&model).expect_err("unknown");
    assert_eq!(checked.to_string(), message);
    let made = generate(&model, &targets).expect_err("unknown");
    assert_eq!(made.to_string(), message);
}

/// A page shows all packages of the project and no others, even if this run does not generate them.
#[test]
fn pages_show_the_languages_of_the_project() {
    let tabs = |yaml: &str, only: &[&str]| {
        let only: Vec<_> = only.iter().map(ToString::to_string).collect();
        let targets = Targets::read(yaml).expect("sound");
        let targets = targets.only(&only).expect("there");
        let artifacts = generate(&good_spec::model(), &targets).expect("made");
        let page = "d/en/reference/commands/get_thing.md";
        let page = artifacts.iter().find(|artifact| artifact.path == page);
        let lines = page.expect("made").contents.lines();
        let tabs = lines.filter_map(|line| line.strip_prefix("```")?.split_once(" ["));
        let tabs: Vec<_> = tabs.map(|(_, title)| title.to_owned()).collect();
        tabs.join(" ")
    };
    let all = "targets: { rust: , typescript: { out: t }, python: , markdown: { out: d } }";
    let both = "Rust] TypeScript] Python] Rust] TypeScript] Python]";
    assert_eq!(tabs(all, &[]), both);
    assert_eq!(tabs(all, &["markdown"]), both);
    let kotlin = "targets: { kotlin: { out: k }, rust: , markdown: { out: d } }";
    assert_eq!(tabs(kotlin, &[]), "Rust] Kotlin] Rust] Kotlin]");
    let python = "targets: { python: , markdown: { out: d } }";
    assert_eq!(tabs(python, &[]), "Python] Python]");
    assert_eq!(tabs("targets: { markdown: { out: d } }", &[]), "");
}
