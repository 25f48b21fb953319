//! Keys that a mapping should not have, or should have.

use crate::diagnostic::{Diagnostic, FaultCode, nearest};
use crate::load::grammar::{Command, FIELD_FORMS, Report, Stream, TEXT, Table};
use crate::model::Text;
use crate::syntax::{Entries, Entry, Span};
use crate::text;

/// A required key that is not there.
pub(super) fn missing_key(table: &Table, key: &str, at: Span) -> Diagnostic {
    let (zh, en) = (table.name_zh, table.name);
    let language = match key {
        _ if key == TEXT.zh.name => text!("中文", "Chinese"),
        _ if key == TEXT.en.name => text!("英文", "English"),
        _ => {
            let message = text!("“{zh}”缺少 `{key}`", "`{key}` is missing from the {en}");
            return Diagnostic::error(FaultCode::MissingKey, at, message);
        }
    };
    let message = text!(
        "“{zh}”缺少{language} `{key}`",
        "the {language} text `{key}` of the {en} is missing",
        language = language
    );
    Diagnostic::error(FaultCode::MissingTranslation, at, message)
}

/// A key that the table does not have.
pub(in crate::load) fn unknown_key(
    table: &Table,
    entry: Entry<'_>,
    siblings: &Entries<'_>,
) -> Diagnostic {
    let name = entry.name();
    let span = entry.key.span();
    if let Some(slip) = entry.key.slip() {
        return slip;
    }
    if let Some(other) = owner_of_key(table, name) {
        return Diagnostic::error(
            FaultCode::MisplacedKey,
            span,
            text!(
                "`{name}` 是“{other}”的键，不是“{this}”的键",
                "`{name}` is a key of {other}, not of {this}",
                other = article(other),
                this = article(table)
            ),
        );
    }
    let (zh, en) = (table.name_zh, table.name);
    let fault = Diagnostic::error(
        FaultCode::UnknownKey,
        span,
        text!("“{zh}”没有键 `{name}`", "`{name}` is not a key of the {en}"),
    );
    if entry.value.is_null() {
        return fault.note(text!(
            "在 `{{ }}` 中逗号会结束文本；如果这是文本的后半部分，请给文本加上引号",
            "inside `{{ }}` a comma ends a text; if this is the rest of a text, quote it"
        ));
    }
    let free = table
        .keys
        .iter()
        .map(|key| key.name)
        .filter(|key| !siblings.clone().any(|entry| entry.name() == *key));
    if let Some(near) = nearest(name, free) {
        return fault.fix(
            span,
            near,
            text!("是否想写 `{near}`？", "did you mean `{near}`?"),
        );
    }
    let known: Vec<_> = table.keys.iter().map(|key| key.name).collect();
    fault.note(text!(
        "它的键有：{known}",
        "its keys are {known}",
        known = Text::listed(known)
    ))
}

/// The name of a table, in English with the indefinite article.
pub(super) fn article(table: &Table) -> Text {
    let (zh, en) = (table.name_zh, table.name);
    let article = if en.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    text!("{zh}", "{article} {en}")
}

/// The table among those easily mixed up with this one that has the key.
fn owner_of_key(table: &Table, key: &str) -> Option<&'static Table> {
    let operations = [Command::TABLE, Report::TABLE, Stream::TABLE];
    let forms = FIELD_FORMS.map(|(_, table)| table);
    let family = [operations.as_slice(), forms.as_slice()]
        .into_iter()
        .find(|family| family.iter().any(|other| other.name == table.name))?;
    let owner = family.iter().find(|other| other.key(key).is_some())?;
    Some(owner)
}
