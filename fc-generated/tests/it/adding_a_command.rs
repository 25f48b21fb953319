//! The YAML lines that the README shows are enough to add a command. All generated parts of the command appear and
//! disappear with them.

use crate::support;
use fc_codegen::emit::generate;
use fc_codegen::output::plan;
use fc_codegen::product::Artifact;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model, RangeUse};
use fc_spec::syntax::read_dir;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The name of the command in the README's example.
const NAME: &str = "get_battery";

#[test]
fn readme_steps_add_a_command_and_leave_no_trace() {
    let example = example("README.md");
    assert_eq!(example, self::example("README.zh-CN.md"));
    let project = tempfile::tempdir().unwrap();
    let root = project.path();
    support::copy(&support::root().join("spec"), &root.join("spec"));
    let model = support::model(root);
    // The spec may already have the command of the README.
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
        (&messages, format!("pub fn {name}<'a>(")),
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
    for (readme, part) in printed() {
        let part = part.replace(NAME, &name);
        let part = part.replace("GetBatteryRequest", &request.to_string());
        let part = part.replace("GetBatteryResponse", &response.to_string());
        let mut sources = artifacts
            .iter()
            .filter(|artifact| artifact.path.starts_with("fc-generated/src/"));
        assert!(
            sources.any(|artifact| squeezed(&artifact.contents).contains(&part)),
            "{readme}: {part}"
        );
    }
    write();
    assert_ne!(support::tree(root), before);

    fs::write(&file, text).unwrap();
    write();
    let after = support::tree(root);
    assert_eq!(changed(&before, &after), Vec::<&String>::new());
}

/// The pictures in the READMEs show the error of their command with a code that is in use.
#[test]
fn the_pictures_show_the_error_of_a_code_in_use() {
    let project = tempfile::tempdir().unwrap();
    let root = project.path();
    support::copy(&support::root().join("spec"), &root.join("spec"));
    let example = example("README.md");
    let example = example
        .replace(NAME, &free_name(&support::model(root)))
        .replace(&spelled(code_of(&example)), "0x0A01");
    let file = root.join("spec/commands/recharge.yaml");
    let text = fs::read_to_string(&file).unwrap();
    let (head, tail) = text.split_once("\ncommands:\n").expect("its commands");
    fs::write(&file, format!("{head}\ncommands:\n{example}\n\n{tail}")).unwrap();

    let mut faults = Faults::new();
    let sources = read_dir(root, Path::new("spec"), &mut faults);
    assert!(load(&sources, &mut faults).model().is_none());
    for (picture, lang) in [("error.svg", Lang::En), ("error.zh.svg", Lang::Zh)] {
        let printed = render(&faults, &sources, Format::Text, lang);
        let mut printed = printed.split("\n\n");
        let printed = printed.find(|fault| fault.contains("[FC0301]"));
        let printed = printed.expect("a code in use").lines();
        let path = support::root().join("docs-site/public").join(picture);
        let drawn = lines(&fs::read_to_string(path).unwrap());
        let (typed, drawn) = drawn.split_first().expect("a command");
        assert_eq!(typed, "$ fcproto check", "{picture}");
        // Additions to the spec move lines, so their numbers are not compared.
        let drawn: Vec<&str> = drawn.iter().map(|line| placeless(line)).collect();
        assert_eq!(
            drawn,
            printed.map(placeless).collect::<Vec<_>>(),
            "{picture}"
        );
    }
}

/// Returns the lines of text in a picture of a terminal.
fn lines(picture: &str) -> Vec<String> {
    let lines = picture.lines().filter(|line| line.starts_with("<text "));
    let text = lines.map(|line| {
        let parts = line.split('<').filter_map(|part| part.split_once('>'));
        parts.map(|(_, text)| text).collect::<String>()
    });
    text.map(|text| {
        text.replace("&lt;", "<")
            .replace("&gt;", ">")
            .replace("&amp;", "&")
    })
    .collect()
}

/// Returns a line of an error without its line number and its place in a file.
fn placeless(line: &str) -> &str {
    let line = line.trim_start_matches(|c: char| c == ' ' || c.is_ascii_digit());
    line.split_once(".yaml:").map_or(line, |(file, _)| file)
}

/// Returns the parts of the generated Rust that the READMEs show in their `rs` blocks, squeezed.
fn printed() -> Vec<(&'static str, String)> {
    let mut printed = Vec::new();
    for readme in ["README.md", "README.zh-CN.md"] {
        let text = fs::read_to_string(support::root().join(readme)).unwrap();
        let block = text.split("```rs\n").nth(1).expect("generated Rust");
        let (block, _) = block.split_once("\n```").expect("its end");
        let block = squeezed(block);
        let parts = block.split([';', '{', '}', '…']);
        let parts = parts.filter(|part| !part.is_empty());
        printed.extend(parts.map(|part| (readme, part.to_owned())));
    }
    printed
}

/// Returns Rust without comments, spaces, and the modules before names.
fn squeezed(text: &str) -> String {
    let lines = text.lines();
    let lines = lines.filter(|line| !line.trim_start().starts_with("//"));
    let text: String = lines.flat_map(str::split_whitespace).collect();
    let text = text.replace(",)", ")");
    let paths = ["messages::", "fc_runtime::", "crate::"];
    paths.iter().fold(text, |text, path| text.replace(path, ""))
}

/// Returns the command that a README adds: its only block of YAML.
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

/// Returns the code of the example if it is free, otherwise the first free code in the range of new commands.
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

/// Returns the name of the example, with a suffix if it is in use.
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
