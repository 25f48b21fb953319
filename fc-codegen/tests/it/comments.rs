//! Comments in a package use the languages of its target.

use crate::docs_support;
use fc_codegen::emit::generate;
use fc_codegen::inspect;
use fc_codegen::product::{Artifact, Product};
use fc_codegen::target::Targets;
use fc_spec::model::{Dump, Model};
use serde_json::Value;

/// The products that contain code.
const PACKAGES: [Product; 5] = [
    Product::Rust,
    Product::TypeScript,
    Product::Python,
    Product::Kotlin,
    Product::Cpp,
];

/// Comments of each package: from the spec, from templates and from facts.
const COMMENTS: &[(Product, [&str; 2])] = &[
    (Product::Rust, ["剩余时间", "Time left"]),
    (
        Product::Rust,
        ["其他键，原样保留。", "Other keys, kept unchanged."],
    ),
    (
        Product::Rust,
        [
            "完整的机器人：处理规范中的全部指令。",
            "A complete robot, which handles",
        ],
    ),
    (
        Product::Rust,
        [
            "下一个上报；连接结束后为 `None`。",
            "Returns the next report, or `None`",
        ],
    ),
    (Product::TypeScript, ["剩余时间", "Time left"]),
    (
        Product::TypeScript,
        ["{@link ResultCode}：各个值。", "Its values."],
    ),
    (
        Product::TypeScript,
        ["本组的上报，按方法名。", "The reports of the group, by"],
    ),
    (
        Product::TypeScript,
        [
            "抛出 `Refusal` 可以拒绝指令。",
            "Throw a `Refusal` to refuse",
        ],
    ),
    (Product::Python, ["剩余时间", "Time left"]),
    (Product::Python, ["命令行工具：", "A command-line tool."]),
    (
        Product::Python,
        [
            "`to` 是某个连接的编号",
            "`to` is the number of a connection.",
        ],
    ),
    (Product::Kotlin, ["剩余时间", "Time left"]),
    (Product::Kotlin, ["供 Java 使用。", "for Java."]),
    (
        Product::Kotlin,
        ["逐项设置 [", "Collects the fields of a ["],
    ),
    (Product::Cpp, ["剩余时间", "Time left"]),
    (
        Product::Cpp,
        ["是否为终态。", "Returns `true` for a final state."],
    ),
    (
        Product::Cpp,
        [
            "收到的上报，按到达的先后。",
            "Reports in the order of arrival.",
        ],
    ),
];

/// Returns the packages of a model. `settings` apply to each target.
fn packages(model: &Model, texts: &str, settings: &str) -> Vec<Artifact> {
    let targets = PACKAGES.map(|it| format!("  {}: {{ {settings} }}\n", it.name()));
    let yaml = format!("{texts}\ntargets:\n{}  markdown:\n", targets.concat());
    let targets = Targets::read(&yaml).expect("sound");
    let targets = targets.only(&PACKAGES.map(|it| it.name().to_owned()));
    generate(model, &targets.expect("there")).expect("made")
}

fn is_chinese(character: char) -> bool {
    ('\u{2E80}'..='\u{9FFF}').contains(&character) || character >= '\u{FF00}'
}

/// Replaces every Chinese text of a dump by its English text, and Chinese characters in other values by letters.
fn translate(value: &mut Value) {
    if let Value::Object(members) = value
        && let Some(en) = members.get("en").cloned()
        && members.contains_key("zh")
    {
        members.insert("zh".to_owned(), en);
    }
    match value {
        Value::Object(members) => members.values_mut().for_each(translate),
        Value::Array(items) => items.iter_mut().for_each(translate),
        Value::String(text) => *text = text.replace(is_chinese, "x"),
        _ => {}
    }
}

#[test]
fn packages_of_an_english_project_have_no_chinese() {
    let model = docs_support::model(&docs_support::fixture());
    let mut dump: Value = serde_json::from_str(&inspect::json(&model)).expect("JSON");
    translate(&mut dump);
    let model = Dump::read(&dump.to_string()).expect("a dump");
    let artifacts = packages(&model, "languages: [en]", "");
    let mut found = Vec::new();
    for artifact in &artifacts {
        let lines = artifact.contents.lines();
        let chinese = lines.filter(|line| line.contains(is_chinese));
        found.extend(chinese.map(|line| format!("{}: {line}", artifact.path)));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn a_target_selects_the_languages_of_comments() {
    let model = docs_support::model(&docs_support::fixture());
    for (settings, selected) in [
        ("", [true, true]),
        ("languages: [zh, en]", [true, true]),
        ("languages: [zh]", [true, false]),
        ("languages: [en]", [false, true]),
    ] {
        let artifacts = packages(&model, "", settings);
        for (product, sentences) in COMMENTS {
            let files = artifacts.iter().filter(|it| it.target == product.name());
            let text: String = files.map(|it| &*it.contents).collect();
            let found = sentences.map(|sentence| text.contains(sentence));
            assert_eq!(
                found,
                selected,
                "{}: {sentences:?} with `{settings}`",
                product.name()
            );
        }
    }
}
