//! Keys that a mapping should not have, or should have.

use crate::diagnostic::{Diagnostic, FaultCode, nearest};
use crate::load::grammar::{Command, FIELD_FORMS, Report, Stream, TEXT, Table};
use crate::syntax::{Entries, Entry, Span};

/// A required key that is not there.
pub(super) fn missing_key(table: &Table, key: &str, at: Span) -> Diagnostic {
    let language = match key {
        _ if key == TEXT.zh.name => "Chinese",
        _ if key == TEXT.en.name => "English",
        _ => {
            return Diagnostic::error(
                FaultCode::MissingKey,
                at,
                format!("`{key}` is missing from the {}", table.name),
            );
        }
    };
    let message = format!(
        "the {language} text `{key}` of the {} is missing",
        table.name
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
            format!(
                "`{name}` is a key of {}, not of {}",
                article(other),
                article(table.name)
            ),
        );
    }
    let fault = Diagnostic::error(
        FaultCode::UnknownKey,
        span,
        format!("`{name}` is not a key of the {}", table.name),
    );
    if entry.value.is_null() {
        return fault
            .note("inside `{ }` a comma ends a text; if this is the rest of a text, quote it");
    }
    let free = table
        .keys
        .iter()
        .map(|key| key.name)
        .filter(|key| !siblings.clone().any(|entry| entry.name() == *key));
    if let Some(near) = nearest(name, free) {
        return fault.fix(span, near, format!("did you mean `{near}`?"));
    }
    let known: Vec<_> = table.keys.iter().map(|key| key.name).collect();
    fault.note(format!("its keys are {}", known.join(", ")))
}

/// With the indefinite article.
pub(super) fn article(name: &str) -> String {
    let article = if name.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    format!("{article} {name}")
}

/// The table among those easily mixed up with this one that has the key.
fn owner_of_key(table: &Table, key: &str) -> Option<&'static str> {
    let operations = [Command::TABLE, Report::TABLE, Stream::TABLE];
    let forms = FIELD_FORMS.map(|(_, table)| table);
    let family = [operations.as_slice(), forms.as_slice()]
        .into_iter()
        .find(|family| family.iter().any(|other| other.name == table.name))?;
    let owner = family.iter().find(|other| other.key(key).is_some())?;
    Some(owner.name)
}
