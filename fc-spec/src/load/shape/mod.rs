//! Checks that a file has the shape of the grammar's tables: known and required keys, values of the correct kind,
//! well-formed scalars. One walk covers a file, and the draft omits everything it reports.

mod expected;
mod forms;
mod keys;
mod scalars;
mod stray;

pub(super) use forms::{lacks_form, marker, misread_marker};
pub(crate) use keys::check_keys;

use super::texts;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{FIELD_KIND, File, Kind, TEXT, Table};
use crate::language::scalar;
use crate::model::{Lang, Languages};
use crate::source::Span;
use crate::syntax::{Entry, Items, Node, NodeKind};
use crate::text;
use expected::{describe, describe_key, wrong_kind};
use keys::{missing_keys, unknown_keys};
use scalars::{Wanted, check_scalar, check_spelling};
use std::collections::HashMap;
use stray::{is_split, misplaced, misplaced_entry, section_of};

/// Reports the root of a file if it is not a mapping.
pub(crate) fn check_root(root: Node<'_>, faults: &mut Faults) {
    if root.as_mapping().is_none() {
        let kind = Kind::Map(File::TABLE);
        check_kind(&kind, root, root.span(), Languages::Any, faults);
    }
}

/// Reports differences between `node` and `kind`. Each text must be in the languages `texts`.
pub(crate) fn check_kind(
    kind: &Kind,
    node: Node<'_>,
    at: Span,
    texts: Languages,
    faults: &mut Faults,
) {
    Shape { texts, faults }.kind(kind, node, at);
}

/// The walk through a file. `at` is the place of a value that is missing.
struct Shape<'f> {
    /// Languages that each text requires.
    texts: Languages,
    faults: &'f mut Faults,
}

impl Shape<'_> {
    fn kind(&mut self, kind: &Kind, node: Node<'_>, at: Span) {
        match kind {
            Kind::Map(table) => self.map(table, node, at),
            Kind::Entries { key, value, min } => self.entries(key, value, *min, node, at),
            Kind::Body => self.entries(&Kind::WireKey, &FIELD_KIND, 0, node, at),
            Kind::List { of, min, max } => self.list(of, (*min, *max), node, at),
            Kind::Either(kinds) => self.either(kinds, node, at),
            Kind::ByKey { tables, otherwise } => self.by_key(tables, otherwise, node, at),
            Kind::Json => check_json(node, Wanted::Either, self.faults),
            Kind::Type => check_type(node, at, self.faults),
            Kind::Ref { name, .. } => check_scalar(name, node, at, self.faults),
            _ => check_scalar(kind, node, at, self.faults),
        }
    }

    fn map(&mut self, table: &'static Table, node: Node<'_>, at: Span) {
        let Some(entries) = node.as_mapping() else {
            return wrong_kind(&describe(&Kind::Map(table)), node, at, self.faults);
        };
        for entry in entries.clone() {
            let Some(key) = table.key(entry.name()) else {
                continue;
            };
            if entry.value.is_null() && is_left_behind(table, node, entry) {
                continue;
            }
            if matches!(key.kind, Kind::Json) {
                check_json(entry.value, Wanted::of(node), self.faults);
            } else {
                self.kind(&key.kind, entry.value, entry.key.span());
            }
        }
        // A misspelled key does not count as missing as well.
        let (meant, strangers) = unknown_keys(table, node, self.faults);
        if table.key(TEXT.zh.name).is_some() {
            texts::check(node, self.faults);
        }
        let missing =
            |name: &str| node.entry(name).is_none() && !meant.iter().any(|meant| meant == name);
        let is_needed = |name: &str| match name {
            _ if name == TEXT.zh.name => self.texts.require(Lang::Zh, !missing(TEXT.en.name)),
            _ if name == TEXT.en.name => self.texts.require(Lang::En, !missing(TEXT.zh.name)),
            _ => true,
        };
        let required = table.keys.iter().filter(|key| key.required);
        let missing: Vec<&str> = required
            .map(|key| key.name)
            .filter(|name| is_needed(name) && missing(name))
            .collect();
        // Each unrecognized key may also replace one missing key.
        if missing.len() > strangers && !node.lacks(self.faults.gaps(), at) {
            self.faults.push(missing_keys(table, &missing, at));
        }
    }

    fn entries(&mut self, key: &Kind, value: &Kind, min: usize, node: Node<'_>, at: Span) {
        let Some(entries) = node.as_mapping() else {
            let expected = text!(
                "映射（键为{keys}）",
                "a mapping from {keys}",
                keys = describe_key(key).spaced()
            );
            return wrong_kind(&expected, node, at, self.faults);
        };
        let mut numbers: HashMap<i128, Span> = HashMap::new();
        let mut count = 0;
        let mut stray: Option<(Entry<'_>, &Table, usize)> = None;
        for entry in entries {
            count += 1;
            if let Some(table) = misplaced(value, entry.value) {
                self.faults.hide(entry.span());
                match &mut stray {
                    Some((_, first, more)) if section_of(first) == section_of(table) => *more += 1,
                    _ => self
                        .faults
                        .extend(stray.replace((entry, table, 0)).map(misplaced_entry)),
                }
                continue;
            }
            if let Some(slip) = entry.key.slip().filter(|_| entry.value.is_null()) {
                self.faults.push(slip);
                continue;
            }
            check_key(key, entry.key, self.faults);
            if let (Kind::Int { .. } | Kind::Scalar, Some(number)) =
                (key.form(), scalar::int(entry.key))
            {
                let span = entry.key.span();
                let first = *numbers.entry(number).or_insert(span);
                if first != span {
                    let message = text!(
                        "{number} 出现两次，写法不同",
                        "{number} occurs twice, written in two ways"
                    );
                    let fault = Diagnostic::error(FaultCode::DuplicateNumber, span, message);
                    self.faults.push(fault.also_first(first));
                }
            }
            self.kind(value, entry.value, entry.key.span());
        }
        self.faults.extend(stray.map(misplaced_entry));
        if count < min {
            let message = text!(
                "应至少 {min} 项，实际为 {count} 项",
                "expected at least {min} {entries}, found {count}",
                entries = if min == 1 { "entry" } else { "entries" }
            );
            let fault = Diagnostic::error(FaultCode::ListLength, node.span(), message);
            self.faults.push(fault);
        }
    }

    fn list(&mut self, of: &Kind, (min, max): (usize, usize), node: Node<'_>, at: Span) {
        let Some(items) = node.as_sequence() else {
            return wrong_kind(&text!("列表", "a list"), node, at, self.faults);
        };
        let mut count = 0;
        let mut rest = items.clone().peekable();
        while let Some(item) = rest.next() {
            count += 1;
            if let Some(second) = rest.next_if(|second| is_split(of, item, *second)) {
                let message = text!(
                    "一项的键分成了两项",
                    "the keys of one item are in two items"
                );
                self.faults.push(
                    Diagnostic::error(FaultCode::SplitItem, second.span(), message)
                        .label(text!(
                            "这些键属于上面一项",
                            "these keys belong to the item above"
                        ))
                        .also(item.span(), text!("这一项缺少它们", "this item lacks them"))
                        .note(text!("删除第二个 `-`", "delete the second `-`")),
                );
                self.faults.hide(item.span().to(second.span()));
                continue;
            }
            self.kind(of, item, item.span());
        }
        if matches!(
            of.form(),
            Kind::Word(_) | Kind::Name | Kind::ConflictId | Kind::Text
        ) {
            check_repeated(items, self.faults);
        }
        if count < min || count > max {
            let expected = if min == max {
                text!("应为 {min} 项", "{min} items")
            } else {
                text!("应至少 {min} 项", "at least {min}")
            };
            let message = text!(
                "{expected}，实际为 {count} 项",
                "expected {expected}, found {count}",
                expected = expected
            );
            let fault = Diagnostic::error(FaultCode::ListLength, node.span(), message);
            self.faults.push(fault);
        }
    }
}

/// Returns `true` if the content of an empty key follows it on the same level as an unknown key, which has its own
/// error.
pub(super) fn is_left_behind(table: &Table, node: Node<'_>, entry: Entry<'_>) -> bool {
    let mut behind = node
        .entries()
        .skip_while(|other| other.key.span() != entry.key.span());
    behind
        .nth(1)
        .is_some_and(|next| table.key(next.name()).is_none() && !next.value.is_null())
}

fn check_key(kind: &Kind, key: Node<'_>, faults: &mut Faults) {
    match kind {
        Kind::WireKey => check_wire_key(key, faults),
        _ => check_scalar(kind.form(), key, key.span(), faults),
    }
}

/// Checks a wire key. It is a string regardless of its spelling.
fn check_wire_key(key: Node<'_>, faults: &mut Faults) {
    // All relevant readers agree on a plain `y`, which is common for coordinates, and on a decimal integer.
    let is_common = |text: &str| {
        matches!(text, "y" | "n" | "Y" | "N")
            || scalar::int_text(text).is_some_and(|number| number.to_string() == text)
    };
    if !key.as_plain().is_some_and(is_common) {
        let before = faults.len();
        check_spelling(key, Wanted::Text, faults);
        if faults.len() == before && key.as_plain().is_some() && scalar::number(key).is_some() {
            let text = key.as_str().unwrap_or_default();
            let message = text!(
                "不同的 YAML 解析器对数值 `{text}` 的写法不同",
                "YAML parsers write the number `{text}` differently"
            );
            let fault = Diagnostic::error(FaultCode::AmbiguousWord, key.span(), message);
            faults.push(fault.quote(text));
        }
    }
}

/// Reports repeated words in a list.
fn check_repeated(items: Items<'_>, faults: &mut Faults) {
    let mut first: HashMap<&str, Span> = HashMap::new();
    for item in items {
        let Some(text) = item.as_str() else {
            continue;
        };
        if let Some(earlier) = first.insert(text, item.span()) {
            let message = text!(
                "`{text}` 在这个列表中出现两次",
                "`{text}` occurs twice in this list"
            );
            let fault = Diagnostic::error(FaultCode::DuplicateItem, item.span(), message);
            faults.push(fault.also(earlier, text!("第一次在这里", "first here")));
        }
    }
}

/// Checks values of examples and rows: any form, except scalars that YAML readers disagree about.
fn check_json(node: Node<'_>, wanted: Wanted, faults: &mut Faults) {
    match node.kind() {
        NodeKind::Null => {}
        NodeKind::Scalar(_) => check_spelling(node, wanted, faults),
        NodeKind::Sequence(items) => items.for_each(|item| check_json(item, wanted, faults)),
        NodeKind::Mapping(entries) => {
            entries.for_each(|entry| {
                check_wire_key(entry.key, faults);
                check_json(entry.value, Wanted::Either, faults);
            });
        }
    }
}

fn check_type(node: Node<'_>, at: Span, faults: &mut Faults) {
    if node.as_mapping().is_some() || node.is_null() {
        wrong_kind(&text!("类型", "a type"), node, at, faults);
    } else if scalar::field_type(node).is_none() {
        faults.hide(node.span());
        let message = text!("类型的写法不对", "this is not a valid type");
        let remedy = text!(
            "类型可以是内置类型，例如 `u8`，也可以是已声明的类型名；`[T]` 表示 `T` 的列表；最后加 `?` 表示可选字段",
            "a type is a built-in such as `u8` or the name of a declared type; `[T]` is a list of `T`; `?` at the very end marks an optional field"
        );
        let fault = Diagnostic::error(FaultCode::BadType, node.span(), message);
        faults.push(fault.note(remedy));
    }
}
