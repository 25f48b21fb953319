//! MINIMAL: rules that every protocol should keep.

use super::finding::Finding;
use super::rule::{Category, Level, Rule};
use super::search::{Search, of_field, of_group, of_operation};
use crate::diagnostic::LintCode;
use crate::model::Effect;
use crate::text;
use std::collections::HashMap;

pub(super) const RULES: &[Rule] = &[
    Rule {
        code: LintCode {
            number: "FC0801",
            title: ["group and file with different names", "分组与文件名不一致"],
            text: [
                "A reader looks for the commands of a group in the file of that name. Rename the file. If no program uses the generated module of the \
             group yet, you can change the `id` of the group instead.",
                "读者会在同名的文件里找某一组的指令。改文件名；如果还没有程序使用这一组生成的模块，也可以改分组的 `id`。",
            ],
        },
        category: Category::Minimal,
        name: "group-file",
        level: Level::Error,
        find: Some(group_file),
    },
    Rule {
        code: LintCode {
            number: "FC0802",
            title: ["wire keys that differ only in case", "仅大小写不同的键名"],
            text: [
                "Two keys of one object differ only in case, `_` or `-`. People confuse them in handwritten code, and JSON readers that ignore case \
             treat them as one key. Rename one of them.",
                "同一个对象中有两个键，只有大小写、`_` 或 `-` 不同。手写代码时容易混淆，忽略大小写的 JSON 库会把两者当成一个键。给其中一个改名。",
            ],
        },
        category: Category::Minimal,
        name: "similar-keys",
        level: Level::Error,
        find: Some(similar_keys),
    },
    Rule {
        code: LintCode {
            number: "FC0803",
            title: [
                "command with a name that contradicts its effect",
                "名称与影响不符的指令",
            ],
            text: [
                "Clients resend a command that only reads, but not one that changes or moves the robot. A name with `get_`, `list_` or `query_` promises \
             that nothing changes. A name with `set_`, `delete_`, `start_` or a similar verb promises a change. Correct the `effect` or the name.",
                "客户端会重发只读取的指令，不会重发改变机器人或让它运动的指令。以 `get_`、`list_`、`query_` 开头的名称表示不会改变任何东西；以 `set_`、`delete_`、`start_` 等开头的则表示会改变。改正 `effect` 或名称。",
            ],
        },
        category: Category::Minimal,
        name: "name-against-effect",
        level: Level::Error,
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
                    "分组 `{id}` 写在文件 `{file}` 中",
                    "the group `{id}` is in the file `{file}`",
                    id = group.id
                ),
            );
        }
    }
}

/// Returns the key in lower case, without `_` and `-`.
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
                "名称以 `{verb}` 开头，而影响是 `{effect}`",
                "the name starts with `{verb}`, but the effect is `{effect}`"
            ),
        );
    }
}
