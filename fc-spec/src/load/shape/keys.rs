//! Checks unknown and missing keys of a mapping.

use super::stray::SECTIONS;
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::Cursor;
use crate::language::grammar::{Command, FIELD_FORMS, Report, Stream, TEXT, Table};
use crate::model::Text;
use crate::source::Span;
use crate::syntax::width::half_width_text;
use crate::syntax::{Entry, Node, visible};
use crate::text;
use std::collections::HashSet;

/// Returns one error for all missing required keys.
pub(super) fn missing_keys(table: &Table, keys: &[&str], at: Span) -> Diagnostic {
    let language = |key: &str| match key {
        _ if key == TEXT.zh.name => Some(text!("中文", "Chinese")),
        _ if key == TEXT.en.name => Some(text!("英文", "English")),
        _ => None,
    };
    let (zh, en) = (table.name_zh, table.name);
    let listed = keys_and(keys);
    let is_one = keys.len() == 1;
    if !keys.iter().all(|key| language(key).is_some()) {
        let be = if is_one { "is" } else { "are" };
        let message = text!(
            "“{zh}”缺少 {listed}",
            "{listed} {be} missing from the {en}",
            listed = listed
        );
        return Diagnostic::error(FaultCode::MissingKey, at, message);
    }
    let message = match keys.first().copied().and_then(language) {
        Some(language) if is_one => text!(
            "“{zh}”缺少{language} {listed}",
            "the {language} text {listed} of the {en} is missing",
            language = language,
            listed = listed
        ),
        _ => text!(
            "“{zh}”缺少文本 {listed}",
            "the texts {listed} of the {en} are missing",
            listed = listed
        ),
    };
    Diagnostic::error(FaultCode::MissingTranslation, at, message)
}

/// Lists keys in a sentence.
fn keys_and(keys: &[&str]) -> Text {
    let quoted = |keys: &[&str]| Text::listed(keys.iter().map(|key| format!("`{key}`")));
    match keys {
        [others @ .., last] if !others.is_empty() => text!(
            "{others}和 `{last}`",
            "{others} and `{last}`",
            others = quoted(others),
            last = *last
        ),
        keys => quoted(keys),
    }
}

/// Reports the unknown keys of a mapping. Returns the keys that they probably mean, and the number of keys with a value
/// but without a guess.
pub(super) fn unknown_keys(
    table: &Table,
    node: Node<'_>,
    faults: &mut Faults,
) -> (Vec<String>, usize) {
    let (mut meant, mut strangers) = (Vec::new(), 0);
    let present: HashSet<&str> = node.entries().map(Entry::name).collect();
    let keys = table.keys.iter().map(|key| key.name);
    let free: Vec<&str> = keys.filter(|key| !present.contains(key)).collect();
    let mut before: Option<Entry<'_>> = None;
    for entry in node.entries() {
        if table.key(entry.name()).is_some() {
            before = None;
            continue;
        }
        faults.hide(entry.span());
        // Related keys get one error: the rest of a text after its comma, or entries without the line that starts their
        // section.
        let goes_on = before.replace(entry).is_some_and(|before| {
            let is_rest = before.value.is_null() && entry.value.is_null();
            let looks = |entry: Entry<'_>| looks_like(entry.value).map(|table| table.name);
            is_rest || (looks(before).is_some() && looks(entry).is_some())
        });
        if goes_on {
            continue;
        }
        // Invisible characters have their own error.
        let visible = visible(entry.name());
        if visible != entry.name() {
            meant.push(visible);
            continue;
        }
        let fault = unknown_key(table, entry, &free);
        let fixes = fault.fixes.iter();
        let known: Vec<String> = fixes
            .map(|fix| fix.replacement.clone())
            .chain(word_of(entry))
            .collect();
        strangers += usize::from(known.is_empty() && !entry.value.is_null());
        meant.extend(known);
        faults.push(fault);
    }
    (meant, strangers)
}

/// Reports the keys of a mapping that the grammar does not allow there.
pub(crate) fn check_keys(cursor: Cursor, mapping: Node<'_>, faults: &mut Faults) {
    if let Cursor::Declared(table) = cursor {
        unknown_keys(table, mapping, faults);
    }
}

/// Returns the first word of a key that contains a key and its value: `zh` of `zh：标签` and of `zh 标签`.
fn word_of(entry: Entry<'_>) -> Option<String> {
    let name = half_width_text(entry.name());
    let word = name.split([':', ' ']).find(|word| !word.is_empty())?;
    (word.len() < name.len()).then(|| word.to_owned())
}

/// Guesses from the keys of an entry of a file which operation or type it is.
pub(super) fn looks_like(node: Node<'_>) -> Option<&'static Table> {
    /// Fewer keys are too vague.
    const FEWEST: usize = 3;
    let tables = SECTIONS.iter().map(|(_, table)| *table);
    let mut fitting = tables.filter(|table| {
        node.entries()
            .all(|entry| table.key(entry.name()).is_some())
    });
    fitting.next().filter(|_| node.entries().count() >= FEWEST)
}

/// Returns the error for an unknown key. `free` are the keys of the table that the mapping lacks.
fn unknown_key(table: &Table, entry: Entry<'_>, free: &[&str]) -> Diagnostic {
    let name = entry.name();
    let span = entry.key.span();
    if let Some(slip) = entry.key.slip() {
        return slip;
    }
    if let Some(other) = owner_of_key(table, name) {
        let message = text!(
            "`{name}` 是“{other}”的键，不是“{this}”的键",
            "`{name}` is a key of {other}, not of {this}",
            other = article(other),
            this = article(table)
        );
        return Diagnostic::error(FaultCode::MisplacedKey, span, message);
    }
    let (zh, en) = (table.name_zh, table.name);
    let message = text!("“{zh}”没有键 `{name}`", "`{name}` is not a key of the {en}");
    let fault = Diagnostic::error(FaultCode::UnknownKey, span, message);
    if entry.value.is_null() {
        return fault.note(text!(
            "在 `{{ }}` 中逗号会结束文本；如果这是文本的后半部分，请给文本加上引号",
            "inside `{{ }}` a comma ends a text; if this is the rest of a text, quote it"
        ));
    }
    let known: Vec<_> = table.keys.iter().map(|key| key.name).collect();
    let note = text!(
        "它的键有：{known}",
        "its keys are {known}",
        known = Text::listed(known)
    );
    fault.suggest(nearest(name, free.iter().copied()), Some(note))
}

/// Returns the name of a table, in English with the indefinite article.
pub(super) fn article(table: &Table) -> Text {
    let (zh, en) = (table.name_zh, table.name);
    let article = if en.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    text!("{zh}", "{article} {en}")
}

/// Returns the table that has the key, among tables similar to this one.
fn owner_of_key(table: &Table, key: &str) -> Option<&'static Table> {
    let operations = [Command::TABLE, Report::TABLE, Stream::TABLE];
    let forms = FIELD_FORMS.map(|(_, table)| table);
    let family = [operations.as_slice(), forms.as_slice()]
        .into_iter()
        .find(|family| family.iter().any(|other| other.name == table.name))?;
    let owner = family.iter().find(|other| other.key(key).is_some())?;
    Some(owner)
}
