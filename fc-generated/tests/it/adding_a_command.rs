//! Adding a command is the few lines of YAML that the readme shows, and nothing else: everything that
//! follows from them appears with them and disappears with them.

use crate::support;
use fc_codegen::emit::generate;
use fc_codegen::output::plan;
use fc_codegen::product::Artifact;
use fc_codegen::target::Targets;
use fc_spec::model::{Model, RangeUse};
use std::collections::BTreeMap;
use std::fs;

/// What the readme's example calls its command.
const NAME: &str = "get_battery";

#[test]
fn the_lines_of_the_readme_are_enough_and_leave_no_trace() {
    let example = example("README.md");
    assert_eq!(example, self::example("README.zh-CN.md"));
    let project = tempfile::tempdir().unwrap();
    let root = project.path();
    support::copy(&support::root().join("spec"), &root.join("spec"));
    let model = support::model(root);
    // The owner may have done as the readme says.
    let code = free_code(&model, code_of(&example));
    let name = free_name(&model);
    let example = example
        .replace(NAME, &name)
        .replace(&spelled(code_of(&example)), &spelled(code));
    let write = || {
        plan(
            generate(&support::model(root), &Targets::default()).unwrap(),
            root,
            &[],
        )
        .unwrap()
        .write()
        .unwrap();
    };
    write();
    let before = support::tree(root);

    let group = model.groups.iter().find(|group| {
        let mut operations = model.operations.iter();
        operations.any(|operation| operation.group == group.id && operation.effect().is_some())
    });
    let group = group.expect("a group with commands");
    let file = root.join(&group.location.file);
    let text = fs::read_to_string(&file).unwrap();
    let (head, tail) = text.split_once("\ncommands:\n").expect("its commands");
    fs::write(&file, format!("{head}\ncommands:\n{example}\n{tail}")).unwrap();

    let model = support::model(root);
    let added = model.operation(&name).expect("it is there");
    assert_eq!(added.code.value, Some(code));
    let messages = added.messages().expect("a command has both");
    let (request, response) = (&messages.request.ty, &messages.response.ty);
    let artifacts = generate(&model, &Targets::default()).unwrap();
    let messages = format!("fc-generated/src/messages/{}.rs", group.id);
    for (path, part) in [
        (messages.as_str(), format!("pub struct {request} {{")),
        (&messages, "pub level: u8,".to_owned()),
        (&messages, format!("pub async fn {name}(")),
        ("fc-generated/src/robot.rs", format!("async fn {name}(")),
        (
            "fc-generated/src/descriptors.rs",
            format!("const {}: OperationInfo", name.to_uppercase()),
        ),
        (
            "fc-generated/src/descriptors.rs",
            format!("{name} {request} {response};"),
        ),
        (
            &format!("fc-generated/vectors/{name}.json"),
            "\"accepted\"".to_owned(),
        ),
        (
            &format!("docs-site/reference/commands/{name}.md"),
            added.title.zh.clone(),
        ),
        (
            &format!("docs-site/en/reference/commands/{name}.md"),
            added.title.en.clone(),
        ),
        ("docs-site/reference/index.md", spelled(code)),
        ("docs-site/en/reference/index.md", spelled(code)),
    ] {
        let artifact = find(&artifacts, path);
        assert!(
            artifact.contents.contains(&part),
            "{path} has no {part}:\n{}",
            artifact.contents
        );
    }
    write();
    assert_ne!(support::tree(root), before);

    fs::write(&file, text).unwrap();
    write();
    let after = support::tree(root);
    assert_eq!(changed(&before, &after), Vec::<&String>::new());
}

/// The command that a readme adds: its one block of YAML.
fn example(readme: &str) -> String {
    let text = fs::read_to_string(support::root().join(readme)).unwrap();
    let mut blocks = text.split("```yaml\n").skip(1);
    let block = blocks.next().expect("an example");
    assert_eq!(blocks.next(), None, "{readme} has one example");
    let (block, _) = block.split_once("\n```").expect("its end");
    assert!(block.starts_with(&format!("  {NAME}:\n")), "{block}");
    block.to_owned()
}

fn code_of(example: &str) -> u16 {
    let digits = example.split("code: 0x").nth(1).expect("a code");
    u16::from_str_radix(digits.get(..4).expect("four digits"), 16).unwrap()
}

fn spelled(code: u16) -> String {
    format!("0x{code:04X}")
}

/// The code of the example, or the next in the range of new commands that nobody has.
fn free_code(model: &Model, wish: u16) -> u16 {
    let mut ranges = model
        .ranges
        .iter()
        .filter(|range| range.usage == RangeUse::Commands);
    let range = ranges.next().expect("new commands have a range");
    let taken = |code: &u16| {
        model
            .operations
            .iter()
            .any(|operation| operation.code.value == Some(*code))
            || model.retired.iter().any(|retired| retired.code == *code)
    };
    std::iter::once(wish)
        .chain(range.first..=range.last)
        .find(|code| !taken(code))
        .expect("the range is not full")
}

/// The name of the example, or one like it that nobody has.
fn free_name(model: &Model) -> String {
    let mut name = NAME.to_owned();
    while model.operation(&name).is_some() {
        name.push_str("_again");
    }
    name
}

fn find<'a>(artifacts: &'a [Artifact], path: &str) -> &'a Artifact {
    let found = artifacts.iter().find(|artifact| artifact.path == path);
    found.unwrap_or_else(|| panic!("{path} is not made"))
}

fn changed<'a>(
    before: &'a BTreeMap<String, Vec<u8>>,
    after: &'a BTreeMap<String, Vec<u8>>,
) -> Vec<&'a String> {
    let paths = before.keys().chain(after.keys());
    paths
        .filter(|path| before.get(*path) != after.get(*path))
        .collect()
}
