//! MINIMAL: what no protocol should have.

use super::finding::Finding;
use super::rule::{Category, Level, Rule};
use super::search::{Search, of_field, of_group, of_operation};
use crate::model::Effect;
use crate::text;
use std::collections::HashMap;

pub(super) const RULES: &[Rule] = &[
    Rule {
        code: "FC0801",
        category: Category::Minimal,
        name: "group-file",
        level: Level::Error,
        title: [
            "group that is not called as its file",
            "接口组与文件名不一致",
        ],
        text: [
            "Anyone who looks for a command of a group opens the file of that name. Rename the file, or the `id` of the group where nobody uses \
             the group's module in a generated package yet.",
            "找某一组的指令时，人们会打开同名的文件。请改文件名；如果生成的代码还没有人使用，也可以改接口组的 `id`。",
        ],
        find: Some(group_file),
    },
    Rule {
        code: "FC0802",
        category: Category::Minimal,
        name: "similar-keys",
        level: Level::Error,
        title: ["wire keys that differ only in case", "仅大小写不同的键名"],
        text: [
            "Two keys of one object are the same but for upper and lower case, `_` or `-`. They are mixed up when programs are written by \
             hand, and JSON readers that ignore case take one for the other. Give one of them another key.",
            "同一个对象中有两个键，除大小写、`_`、`-` 之外完全相同。手写代码时容易混淆，忽略大小写的 JSON 库会把两者当成一个键。请为其中一个换一个键名。",
        ],
        find: Some(similar_keys),
    },
    Rule {
        code: "FC0803",
        category: Category::Minimal,
        name: "name-against-effect",
        level: Level::Error,
        title: [
            "command whose name says another effect",
            "名称与作用相反的指令",
        ],
        text: [
            "Clients repeat a command that only reads, and ask before one that moves the robot. A name that begins with `get_`, `list_` or \
             `query_` promises that nothing changes, one that begins with `set_`, `delete_`, `start_` and the like that something does. Correct \
             the `effect`, or the name.",
            "客户端会重发只读取的指令，发送让机器人运动的指令前会先询问。以 `get_`、`list_`、`query_` 开头的名称表示不会改变任何东西；以 `set_`、`delete_`、`start_` 等开头的则表示会改变。请改正 `effect` 或名称。",
        ],
        find: Some(name_against_effect),
    },
];

fn group_file(search: &mut Search<'_>) {
    for group in &search.model.groups {
        let file = group.location.file.rsplit('/').next().unwrap_or_default();
        let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
        if stem != group.id {
            search.report(
                of_group(group),
                text!(
                    "接口组 `{id}` 写在 `{file}` 中",
                    "the group `{id}` is in a file called `{file}`",
                    id = group.id
                ),
            );
        }
    }
}

/// A key without what is easily mixed up.
pub(super) fn folded(key: &str) -> String {
    let plain = key.chars().filter(|c| !matches!(c, '_' | '-'));
    plain.flat_map(char::to_lowercase).collect()
}

fn similar_keys(search: &mut Search<'_>) {
    for (ty, shape) in search.structs() {
        let mut seen = HashMap::new();
        for field in &shape.fields {
            let first = *seen.entry(folded(&field.wire)).or_insert(field);
            if first.wire != field.wire {
                let (one, other) = (&first.wire, &field.wire);
                search.add(
                    Finding::new(
                        search.rule,
                        of_field(ty, field),
                        text!(
                            "`{other}` 与 `{one}` 仅大小写或 `_` 不同",
                            "`{other}` differs from `{one}` only in case or `_`"
                        ),
                    )
                    .with(of_field(ty, first), text!("另一个", "the other one")),
                );
            }
        }
    }
}

const READS: [&str; 3] = ["get", "list", "query"];
const CHANGES: [&str; 14] = [
    "set", "add", "create", "delete", "remove", "update", "save", "start", "stop", "cancel",
    "clear", "reset", "move", "switch",
];

fn name_against_effect(search: &mut Search<'_>) {
    for operation in search.operations() {
        let verb = operation.name.split('_').next().unwrap_or_default();
        let says_read = READS.contains(&verb);
        let effect = match operation.effect() {
            Some(effect @ Effect::Read) if CHANGES.contains(&verb) => effect,
            Some(effect @ (Effect::Config | Effect::Motion)) if says_read => effect,
            _ => continue,
        };
        let effect = effect.name();
        search.report(
            of_operation(operation),
            text!(
                "名称以 `{verb}` 开头，而作用是 `{effect}`",
                "the name begins with `{verb}`, but the effect is `{effect}`"
            ),
        );
    }
}
