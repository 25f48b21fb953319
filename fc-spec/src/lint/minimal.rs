//! MINIMAL: rules that every protocol should keep.

use super::finding::Finding;
use super::rule::rules;
use super::search::{Search, Subject};
use crate::model::Effect;
use crate::text;
use std::collections::HashMap;

rules! { Minimal
    FC0801 "group-file" Error group_file "分组与文件名不一致" "group and file with different names";
    FC0802 "similar-keys" Error similar_keys "仅大小写不同的键名" "wire keys that differ only in case";
    FC0803 "name-against-effect" Error name_against_effect "名称与影响不符的指令" "command with a name that contradicts its effect";
}

fn group_file(search: &mut Search<'_>) {
    for group in &search.model.groups {
        let file = group.location.file.rsplit('/').next().unwrap_or_default();
        let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
        if stem != group.id {
            search.report(
                Subject::Group(group),
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
                let message = text!(
                    "`{other}` 与 `{one}` 仅大小写或 `_` 不同",
                    "`{other}` differs from `{one}` only in case or `_`"
                );
                let finding = Finding::new(search.rule, Subject::Field(ty, field), message);
                search
                    .add(finding.with(Subject::Field(ty, first), text!("另一个", "the other one")));
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
            Subject::Operation(operation),
            text!(
                "名称以 `{verb}` 开头，而影响是 `{effect}`",
                "the name starts with `{verb}`, but the effect is `{effect}`"
            ),
        );
    }
}
