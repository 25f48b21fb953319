//! Checks the keys of a mapping: each is a word and occurs once.

use super::node::{Entries, Node, NodeKind};
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::text;

/// Returns `true` if the spec can have this key. Reports the error otherwise.
pub(super) fn check(key: Node<'_>, faults: &mut Faults) -> bool {
    match key.kind() {
        NodeKind::Scalar(_) if is_merge(key) => {
            faults.push(
                Diagnostic::error(
                    FaultCode::MergeKey,
                    key.span(),
                    text!("合并键 `<<`", "the merge key `<<`"),
                )
                .label(text!(
                    "规范中不用合并键",
                    "merge keys are not used in the spec"
                ))
                .note(text!(
                    "逐个写出键，或定义一个类型并引用它",
                    "write the keys out, or define a type and refer to it"
                )),
            );
            false
        }
        NodeKind::Scalar(_) => true,
        other => {
            let found = match other {
                NodeKind::Sequence(_) => text!("列表", "a list"),
                NodeKind::Mapping(_) => text!("映射", "a mapping"),
                _ => text!("空值", "empty or null"),
            };
            let message = text!("键不能是{found}", "a key that is {found}", found = found);
            faults.push(
                Diagnostic::error(FaultCode::KeyNotScalar, key.span(), message)
                    .label(text!("键必须是一个词", "a key must be a word"))
                    .note(text!(
                        "如果是文本，加上引号，例如 `\"null\"`",
                        "put it in quotes if it is text, as in `\"null\"`"
                    )),
            );
            false
        }
    }
}

/// Returns `true` for the merge key `<<`.
pub(super) fn is_merge(key: Node<'_>) -> bool {
    key.as_plain() == Some("<<")
}

/// Reports repeated keys. Returns the places of all entries that are removed: each except the first one with its key.
///
/// If each repeated key occurs once before the first repetition, another entry starts there and the line with its name
/// is missing. This is one error, and all keys after it belong to that other entry.
pub(super) fn repeated(entries: Entries<'_>, faults: &mut Faults) -> Vec<usize> {
    // Other errors of keys have been reported already.
    let mut keys: Vec<(&str, Node<'_>)> = entries
        .clone()
        .filter(|entry| !is_merge(entry.key))
        .filter_map(|entry| Some((entry.key.as_str()?, entry.key)))
        .collect();
    keys.sort_unstable_by_key(|(name, key)| (*name, key.at()));
    let mut again: Vec<(Node<'_>, Node<'_>)> = Vec::new();
    for same in keys.chunk_by(|(a, _), (b, _)| a == b) {
        if let [(_, first), rest @ ..] = same {
            again.extend(rest.iter().map(|(_, key)| (*key, *first)));
        }
    }
    again.sort_unstable_by_key(|(key, _)| key.at());
    let Some(begins) = again.first().map(|(key, _)| key.at()) else {
        return Vec::new();
    };
    let is_another = again.iter().all(|(_, first)| first.at() < begins)
        && again.len() > 1
        && keys
            .chunk_by(|(a, _), (b, _)| a == b)
            .all(|same| same.len() < 3);
    let again_at: Vec<usize> = again.iter().map(|(key, _)| key.at()).collect();
    let reported = if is_another { 1 } else { again.len() };
    if is_another {
        faults.lose();
    }
    for (key, first) in again.iter().take(reported) {
        let name = key.as_str().unwrap_or_default();
        let fault = Diagnostic::error(
            FaultCode::DuplicateKey,
            key.span(),
            text!("键 `{name}` 出现两次", "the key `{name}` occurs twice"),
        )
        .label(text!("又出现在这里", "again here"))
        .also(first.span(), text!("第一次在这里", "first here"));
        faults.push(if is_another {
            fault.note(text!(
                "后面的键也是如此：如果另一条从这里开始，缺的是写它名称的那一行",
                "so do keys behind it: if another entry begins here, the line with its name is missing"
            ))
        } else {
            fault.note(text!(
                "删除其中一个，或改名",
                "delete one of them or rename it"
            ))
        });
    }
    let behind = entries.filter(|entry| {
        let at = entry.key.at();
        again_at.binary_search(&at).is_ok() || (is_another && at >= begins)
    });
    behind
        .map(|entry| {
            faults.hide(entry.span());
            entry.key.at()
        })
        .collect()
}
