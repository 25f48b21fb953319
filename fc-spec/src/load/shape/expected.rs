//! Builds messages about values of the wrong kind.

use super::keys::article;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::Kind;
use crate::model::Text;
use crate::source::Span;
use crate::syntax::Node;
use crate::text;
use crate::vocabulary::Meaning;

/// Reports a node of an unexpected kind.
pub(super) fn wrong_kind(expected: &Text, node: Node<'_>, at: Span, faults: &mut Faults) {
    if let Some(slip) = node.slip() {
        faults.push(slip);
        return;
    }
    if node.is_null() && node.lacks(faults.gaps(), at) {
        return;
    }
    let span = if node.is_null() { at } else { node.span() };
    faults.hide(node.span());
    // If the file ends here, the rest of it is lost.
    if node.ends_file() {
        faults.lose();
    }
    let message = text!(
        "应为{expected}，实际为{found}",
        "expected {expected}, found {found}",
        found = node.describe(),
        expected = expected.clone().spaced()
    );
    let fault = Diagnostic::error(FaultCode::WrongKind, span, message);
    faults.push(
        if node.is_null() && expected.en.starts_with("a mapping from") {
            fault.note(text!("没有内容时写 `{{}}`", "write `{{}}` if it is empty"))
        } else if node.is_null() && expected.en == "a list" {
            fault.note(text!("没有内容时写 `[]`", "write `[]` if it is empty"))
        } else {
            fault
        },
    );
}

/// Describes the values of a kind.
pub(super) fn describe(kind: &Kind) -> Text {
    match kind {
        Kind::Ref { name, .. } => describe(name),
        Kind::Text | Kind::WireKey => text!("文本", "a text"),
        Kind::Bool => text!("`true` 或 `false`", "`true` or `false`"),
        Kind::Int { .. } => text!("整数", "an integer"),
        Kind::Number => text!("数值", "a number"),
        Kind::Scalar => text!("数值、文本或布尔值", "a number, text or boolean"),
        Kind::Json => text!("JSON 值", "a JSON value"),
        Kind::Code => text!("功能码，例如 0x0A01", "a code such as 0x0A01"),
        Kind::Date => text!("日期，例如 2024-01", "a date such as 2024-01"),
        Kind::Name => text!("snake_case 名称", "a snake_case name"),
        Kind::TypeName => text!("类型名", "the name of a type"),
        Kind::Type => text!("类型", "a type"),
        Kind::ConflictId => text!("疑问的编号，例如 C040", "a conflict id such as C040"),
        Kind::MediaType => text!(
            "媒体类型，例如 `image/png`",
            "a media type such as `image/png`"
        ),
        Kind::Unit => text!("单位，例如 `ms`", "a unit such as `ms`"),
        Kind::Word(words) => list_words(words),
        Kind::List { .. } => text!("列表", "a list"),
        Kind::Map(table) => text!(
            "“{table}”映射",
            "a mapping with the keys of {table}",
            table = article(table)
        ),
        Kind::Entries { .. } | Kind::ByKey { .. } | Kind::Body => text!("映射", "a mapping"),
        Kind::Either(kinds) => describe_either(kinds),
    }
}

/// Describes the values of several kinds.
pub(super) fn describe_either(kinds: &[Kind]) -> Text {
    let kinds = kinds.iter().map(describe).enumerate();
    let each = kinds.map(|(index, it)| if index > 0 { it.spaced() } else { it });
    Text::joined(each, "，或", " or ")
}

/// Describes the keys of a mapping.
pub(super) fn describe_key(key: &Kind) -> Text {
    match key.form() {
        Kind::Name => text!("snake_case 名称", "snake_case names"),
        Kind::TypeName => text!("PascalCase 名称", "PascalCase names"),
        Kind::Int { .. } => text!("数值", "numbers"),
        Kind::Scalar => text!("发送的值", "the values that are sent"),
        Kind::ConflictId => text!("疑问的编号", "conflict ids"),
        Kind::Text => text!("文本", "texts"),
        _ => text!("报文中的键名", "wire keys"),
    }
}

/// Lists words in a sentence.
pub(super) fn list_words(words: &[Meaning]) -> Text {
    let quoted = words.iter().map(|(word, ..)| text!("`{word}`", "`{word}`"));
    Text::joined(quoted, "、", ", ")
}
