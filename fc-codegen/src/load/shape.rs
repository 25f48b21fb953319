//! Whether a file has the shape that the grammar's tables give: keys known and present, values of the
//! right kind, scalars well formed. One walk; everything it reports is left out of the draft.

use super::grammar::{FIELD, KeyKind, Kind, Table};
use super::{names, scalar, texts};
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::syntax::{Entry, Node, NodeKind, Span, Style};
use std::collections::HashMap;

/// Reports what `node` lacks of `kind`.
pub(super) fn check_kind(kind: &Kind, node: &Node, at: Span, faults: &mut Faults) {
    match kind {
        Kind::Map(table) => check_map(table, node, at, faults),
        Kind::Entries { key, value, min } => check_entries(*key, value, *min, node, at, faults),
        Kind::Body => check_entries(KeyKind::Wire, &FIELD, 0, node, at, faults),
        Kind::List { of, min, max } => check_list(of, (*min, *max), node, at, faults),
        Kind::Either(kinds) => check_either(kinds, node, at, faults),
        Kind::ByKey { tables, otherwise } => check_by_key(tables, otherwise, node, at, faults),
        Kind::Json => check_json(node, faults),
        Kind::Type => check_type(node, at, faults),
        _ => check_scalar(kind, node, at, faults),
    }
}

fn check_map(table: &'static Table, node: &Node, at: Span, faults: &mut Faults) {
    let Some(entries) = node.as_mapping() else {
        wrong_kind(
            &format!("a mapping with the keys of {}", article(table.name)),
            node,
            at,
            faults,
        );
        return;
    };
    // A key that an unknown one is a slip of is not missing as well.
    let mut meant = Vec::new();
    for entry in entries {
        match table.key(entry.name()) {
            Some(key) => check_kind(&key.kind, &entry.value, entry.key.span, faults),
            None => {
                let fault = unknown_key(table, entry, entries);
                meant.extend(fault.fixes.iter().map(|fix| fix.replacement.clone()));
                faults.push(fault);
            }
        }
    }
    if table.key("zh").is_some() {
        texts::check(node, faults);
    }
    let missing = |name: &str| {
        !entries.iter().any(|entry| entry.name() == name)
            && !meant.iter().any(|meant| meant == name)
    };
    for key in table
        .keys
        .iter()
        .filter(|key| key.required && missing(key.name))
    {
        faults.push(missing_key(table, key.name, at));
    }
}

fn missing_key(table: &Table, key: &str, at: Span) -> Diagnostic {
    let (code, what) = match key {
        "zh" => (FaultCode::MissingTranslation, "the Chinese text `zh`"),
        "en" => (FaultCode::MissingTranslation, "the English text `en`"),
        _ => {
            return Diagnostic::error(
                FaultCode::MissingKey,
                at,
                format!("`{key}` is missing from the {}", table.name),
            );
        }
    };
    Diagnostic::error(code, at, format!("{what} of the {} is missing", table.name))
}

/// A key that the table does not have.
pub(super) fn unknown_key(table: &Table, entry: &Entry, siblings: &[Entry]) -> Diagnostic {
    let name = entry.name();
    let span = entry.key.span;
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
        format!("`{name}` is no key of the {}", table.name),
    );
    if entry.value.is_null() {
        return fault
            .note("inside `{ }` a comma ends a text: if this is the rest of one, quote the text");
    }
    let free = table
        .keys
        .iter()
        .map(|key| key.name)
        .filter(|key| !siblings.iter().any(|entry| entry.name() == *key));
    match nearest(name, free) {
        Some(near) => fault.fix(span, near, format!("did you mean `{near}`?")),
        None => {
            let known: Vec<_> = table.keys.iter().map(|key| key.name).collect();
            fault.note(format!("its keys are {}", known.join(", ")))
        }
    }
}

/// With the indefinite article.
fn article(name: &str) -> String {
    let article = if name.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    format!("{article} {name}")
}

/// The table among those easily mixed up with this one that has the key.
fn owner_of_key(table: &Table, key: &str) -> Option<&'static str> {
    use super::grammar::{COMMAND, FIELD_FORMS, REPORT, STREAM};
    let operations = [&COMMAND, &REPORT, &STREAM];
    let forms = FIELD_FORMS.iter().map(|(_, table)| *table);
    let is_self = |other: &&Table| other.name == table.name;
    let owner = |mut family: Box<dyn Iterator<Item = &'static Table>>| {
        family.find(|other| other.key(key).is_some())
    };
    if operations.iter().any(is_self) {
        owner(Box::new(operations.into_iter())).map(|table| table.name)
    } else if forms.clone().any(|form| form.name == table.name) {
        owner(Box::new(forms)).map(|table| table.name)
    } else {
        None
    }
}

fn check_entries(
    key: KeyKind,
    value: &Kind,
    min: usize,
    node: &Node,
    at: Span,
    faults: &mut Faults,
) {
    let Some(entries) = node.as_mapping() else {
        wrong_kind(
            &format!("a mapping from {}", describe_key(key)),
            node,
            at,
            faults,
        );
        return;
    };
    let mut numbers: HashMap<i128, Span> = HashMap::new();
    for entry in entries {
        check_key(key, &entry.key, faults);
        if let (KeyKind::Int(..) | KeyKind::EnumValue, Some(number)) =
            (key, scalar::int(&entry.key))
        {
            match numbers.get(&number) {
                Some(first) => faults.push(
                    Diagnostic::error(
                        FaultCode::DuplicateNumber,
                        entry.key.span,
                        format!("{number} stands here twice, in two spellings"),
                    )
                    .also(*first, "first used here"),
                ),
                None => {
                    numbers.insert(number, entry.key.span);
                }
            }
        }
        check_kind(value, &entry.value, entry.key.span, faults);
    }
    if entries.len() < min {
        faults.push(Diagnostic::error(
            FaultCode::ListLength,
            node.span,
            format!("expected at least {min} entries, found {}", entries.len()),
        ));
    }
}

fn describe_key(key: KeyKind) -> &'static str {
    match key {
        KeyKind::Name => "snake_case names",
        KeyKind::TypeName => "PascalCase names",
        KeyKind::Wire => "wire keys",
        KeyKind::Int(..) => "numbers",
        KeyKind::EnumValue => "what travels",
        KeyKind::ConflictId => "conflict ids",
    }
}

fn check_key(kind: KeyKind, key: &Node, faults: &mut Faults) {
    match kind {
        KeyKind::Name => check_scalar(&Kind::Name, key, key.span, faults),
        KeyKind::TypeName => check_scalar(&Kind::TypeName, key, key.span, faults),
        KeyKind::ConflictId => check_scalar(&Kind::ConflictId, key, key.span, faults),
        KeyKind::Int(min, max) => check_scalar(&Kind::Int { min, max }, key, key.span, faults),
        // A plain `y` as wire key is common (coordinates) and read alike everywhere that matters.
        KeyKind::Wire => {}
        KeyKind::EnumValue => check_scalar(&Kind::Scalar, key, key.span, faults),
    }
}

fn check_list(of: &Kind, (min, max): (usize, usize), node: &Node, at: Span, faults: &mut Faults) {
    let Some(items) = node.as_sequence() else {
        wrong_kind("a list", node, at, faults);
        return;
    };
    for item in items {
        check_kind(of, item, item.span, faults);
    }
    if matches!(of, Kind::Word(_) | Kind::ConflictId | Kind::Text) {
        check_repeated(items, faults);
    }
    if items.len() < min || items.len() > max {
        let expected = if min == max {
            format!("{min} items")
        } else {
            format!("at least {min}")
        };
        faults.push(Diagnostic::error(
            FaultCode::ListLength,
            node.span,
            format!("expected {expected}, found {}", items.len()),
        ));
    }
}

/// Lists of words say each once.
fn check_repeated(items: &[Node], faults: &mut Faults) {
    let mut first: HashMap<&str, Span> = HashMap::new();
    for item in items {
        let Some(text) = item.as_str() else {
            continue;
        };
        if let Some(earlier) = first.insert(text, item.span) {
            let message = format!("`{text}` stands in this list twice");
            faults.push(
                Diagnostic::error(FaultCode::DuplicateItem, item.span, message)
                    .also(earlier, "first here"),
            );
        }
    }
}

/// Takes the first alternative that the node could be meant as; the last for scalars that fit none.
fn check_either(kinds: &[Kind], node: &Node, at: Span, faults: &mut Faults) {
    let candidates: Vec<_> = kinds.iter().filter(|kind| could_be(kind, node)).collect();
    let chosen = candidates
        .iter()
        .find(|kind| fits(kind, node))
        .or_else(|| candidates.iter().find(|kind| is_nearly(kind, node)))
        .or(candidates.first());
    match chosen {
        Some(kind) => check_kind(kind, node, at, faults),
        None => {
            let expected: Vec<_> = kinds.iter().map(describe).collect();
            wrong_kind(&expected.join(" or "), node, at, faults);
        }
    }
}

/// Whether the node has the outer form (scalar, list or mapping) of the kind.
fn could_be(kind: &Kind, node: &Node) -> bool {
    match kind {
        Kind::Map(_) | Kind::Entries { .. } | Kind::ByKey { .. } | Kind::Body => {
            node.as_mapping().is_some()
        }
        Kind::List { .. } => node.as_sequence().is_some(),
        Kind::Type => node.as_scalar().is_some() || node.as_sequence().is_some(),
        Kind::Either(kinds) => kinds.iter().any(|kind| could_be(kind, node)),
        Kind::Json => true,
        _ => node.as_scalar().is_some(),
    }
}

/// Whether a scalar is exactly what the kind asks for.
fn fits(kind: &Kind, node: &Node) -> bool {
    match kind {
        Kind::Code => scalar::code(node).is_some(),
        Kind::Int { .. } => scalar::int(node).is_some(),
        Kind::Word(words) => node
            .as_str()
            .is_some_and(|text| words.iter().any(|(word, _)| *word == text)),
        _ => true,
    }
}

/// Whether a scalar is a slip of one of the kind's words.
fn is_nearly(kind: &Kind, node: &Node) -> bool {
    match (kind, node.as_str()) {
        (Kind::Word(words), Some(text)) => {
            nearest(text, words.iter().map(|(word, _)| *word)).is_some()
        }
        _ => false,
    }
}

fn describe(kind: &Kind) -> String {
    match kind {
        Kind::Text => "a text".to_owned(),
        Kind::Bool => "`true` or `false`".to_owned(),
        Kind::Int { .. } => "an integer".to_owned(),
        Kind::Number => "a number".to_owned(),
        Kind::Scalar => "a number, text or truth value".to_owned(),
        Kind::Json => "a JSON value".to_owned(),
        Kind::Code => "a code such as 0x0A01".to_owned(),
        Kind::Date => "a date such as 2024-01".to_owned(),
        Kind::Name => "a snake_case name".to_owned(),
        Kind::TypeName => "the name of a type".to_owned(),
        Kind::Type => "a type".to_owned(),
        Kind::ConflictId => "a conflict id such as C040".to_owned(),
        Kind::Word(words) => list_words(words),
        Kind::List { .. } => "a list".to_owned(),
        Kind::Map(table) => format!("a mapping with the keys of {}", article(table.name)),
        Kind::Entries { .. } | Kind::ByKey { .. } | Kind::Body => "a mapping".to_owned(),
        Kind::Either(kinds) => kinds.iter().map(describe).collect::<Vec<_>>().join(" or "),
    }
}

fn check_by_key(
    tables: &'static [(&'static str, &'static Table)],
    otherwise: &Kind,
    node: &Node,
    at: Span,
    faults: &mut Faults,
) {
    let marks: Vec<_> = tables
        .iter()
        .filter_map(|(mark, table)| Some((node.entry(mark)?, *table)))
        .collect();
    let Some((first, table)) = marks.first() else {
        check_kind(otherwise, node, at, faults);
        return;
    };
    if first.name() == "type" && first.value.as_mapping().is_some() {
        faults.push(
            Diagnostic::error(
                FaultCode::MarkerAsKey,
                first.key.span,
                "`type` marks the longhand of a field, so this is not read as a wire key",
            )
            .note("write the object that holds it as `{ fields: { type: … } }`; below `fields:` every key is a wire key"),
        );
        return;
    }
    if let Some((second, _)) = marks.get(1) {
        faults.push(
            Diagnostic::error(
                FaultCode::TwoForms,
                second.key.span,
                format!(
                    "`{}` and `{}` do not go together",
                    first.name(),
                    second.name()
                ),
            )
            .also(first.key.span, "this already says what the field is"),
        );
        return;
    }
    check_map(table, node, at, faults);
}

/// Values of examples and rows: any form, but no scalar that YAML readers disagree about.
fn check_json(node: &Node, faults: &mut Faults) {
    match &node.kind {
        NodeKind::Null => {}
        NodeKind::Scalar(_) => {
            check_spelling(node, faults);
        }
        NodeKind::Sequence(items) => items.iter().for_each(|item| check_json(item, faults)),
        NodeKind::Mapping(entries) => entries
            .iter()
            .for_each(|entry| check_json(&entry.value, faults)),
    }
}

fn check_type(node: &Node, at: Span, faults: &mut Faults) {
    if node.as_mapping().is_some() || node.is_null() {
        wrong_kind("a type", node, at, faults);
    } else if scalar::field_type(node).is_none() {
        let fault = Diagnostic::error(
            FaultCode::BadType,
            node.span,
            "this is not how a type is written",
        );
        faults.push(fault.note(
            "a type is a built-in such as `u8` or the name of a declared type; `[T]` is a list of it; `?` at the very end marks an optional field",
        ));
    }
}

/// A plain scalar that other YAML readers take for something else; `true` if it was reported.
fn check_spelling(node: &Node, faults: &mut Faults) -> bool {
    let Some(text) = node.as_plain() else {
        return false;
    };
    if scalar::is_ambiguous(text) {
        faults.push(
            Diagnostic::error(
                FaultCode::AmbiguousWord,
                node.span,
                format!("other YAML readers take a plain `{text}` for a truth value"),
            )
            .fix(node.span, format!("\"{text}\""), "quote it"),
        );
        return true;
    }
    if scalar::has_leading_zero(text) {
        let digits = text.trim_start_matches('0');
        let digits = if digits.is_empty() { "0" } else { digits };
        faults.push(
            Diagnostic::error(
                FaultCode::LeadingZero,
                node.span,
                format!("some YAML readers take `{text}` for octal"),
            )
            .fix(node.span, digits, "drop the zeros if it is a number")
            .fix(node.span, format!("\"{text}\""), "quote it if it is a text"),
        );
        return true;
    }
    false
}

fn check_scalar(kind: &Kind, node: &Node, at: Span, faults: &mut Faults) {
    let Some(scalar) = node.as_scalar() else {
        wrong_kind(&describe(kind), node, at, faults);
        return;
    };
    let text = scalar.text.as_str();
    let span = node.span;
    if matches!(kind, Kind::Bool) {
        if scalar::bool(node).is_none() {
            faults.push(bad_bool(text, span));
        }
        return;
    }
    if check_spelling(node, faults) {
        return;
    }
    let error = |code, message: String| Diagnostic::error(code, span, message);
    let fault = match kind {
        Kind::Text => check_text(node),
        Kind::Int { min, max } => check_int(node, *min, *max),
        Kind::Number => scalar::number(node)
            .is_none()
            .then(|| error(FaultCode::BadNumber, format!("`{text}` is not a number"))),
        Kind::Code => scalar::code(node)
            .is_none()
            .then(|| bad_code(text, scalar.style, span)),
        Kind::Date => scalar::date(text).is_none().then(|| {
            error(FaultCode::BadDate, format!("`{text}` is not a date"))
                .note("dates are written 2024-01 or 2024-01-31")
        }),
        Kind::Name => (!names::is_snake(text)).then(|| bad_name(text, span)),
        Kind::TypeName => (!names::is_pascal(text)).then(|| bad_type_name(text, span)),
        Kind::ConflictId => (!scalar::is_conflict_id(text)).then(|| {
            error(
                FaultCode::BadConflictId,
                format!("`{text}` is not the id of a conflict"),
            )
            .note("ids are written C and three digits, such as C040")
        }),
        Kind::Word(words) => {
            (!words.iter().any(|(word, _)| *word == text)).then(|| bad_word(text, words, span))
        }
        _ => None,
    };
    faults.extend(fault);
}

/// A text that other readers would take for a number or truth value.
fn check_text(node: &Node) -> Option<Diagnostic> {
    let text = node.as_plain()?;
    let taken_for = match (scalar::bool(node), scalar::number(node)) {
        (Some(_), _) => "truth value",
        (_, Some(_)) => "number",
        _ => return None,
    };
    let message = format!("expected a text, found a {taken_for}");
    Some(
        Diagnostic::error(FaultCode::WrongKind, node.span, message).fix(
            node.span,
            format!("\"{text}\""),
            "quote it",
        ),
    )
}

fn check_int(node: &Node, min: i128, max: i128) -> Option<Diagnostic> {
    let text = node.as_str().unwrap_or_default();
    match scalar::int(node) {
        None => {
            let fault = Diagnostic::error(
                FaultCode::BadInteger,
                node.span,
                format!("`{text}` is not an integer"),
            );
            Some(match (node.as_plain(), scalar::int_text(text)) {
                (None, Some(_)) => fault.fix(node.span, text, "drop the quotes"),
                _ => fault,
            })
        }
        Some(value) if value < min || value > max => Some(Diagnostic::error(
            FaultCode::IntegerRange,
            node.span,
            format!("{value} does not lie in {min}..={max}"),
        )),
        Some(_) => None,
    }
}

fn bad_bool(text: &str, span: Span) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadBool,
        span,
        format!("expected `true` or `false`, found `{text}`"),
    );
    match text.to_ascii_lowercase().as_str() {
        "on" | "yes" | "y" | "1" | "true" => fault.fix(span, "true", "write `true`"),
        "off" | "no" | "n" | "0" | "false" => fault.fix(span, "false", "write `false`"),
        _ => fault,
    }
}

fn bad_code(text: &str, style: Style, span: Span) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadCode,
        span,
        format!("`{text}` is not how a code is written"),
    );
    let digits = text
        .strip_prefix("0x")
        .or_else(|| text.strip_prefix("0X"))
        .and_then(|digits| u16::from_str_radix(digits, 16).ok())
        .or_else(|| text.parse().ok());
    match digits {
        Some(code) if style == Style::Plain => {
            let spelling = format!("0x{code:04X}");
            let message = format!("write `{spelling}`");
            fault.fix(span, spelling, message)
        }
        Some(code) => fault.fix(span, format!("0x{code:04X}"), "drop the quotes"),
        None => fault.note("a code is `0x` and four upper-case hex digits, such as 0x0A01"),
    }
}

fn bad_name(text: &str, span: Span) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadName,
        span,
        format!("`{text}` is not a snake_case name"),
    );
    let better = names::snake(text);
    if names::is_snake(&better) {
        let message = format!("write `{better}`");
        fault.fix(span, better, message)
    } else {
        fault.note("a name has lower-case letters and digits in parts joined by `_`, and starts with a letter")
    }
}

fn bad_type_name(text: &str, span: Span) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadTypeName,
        span,
        format!("`{text}` is not a PascalCase name"),
    );
    let better = names::pascal(&names::snake(text));
    if names::is_pascal(&better) {
        let message = format!("write `{better}`");
        fault.fix(span, better, message)
    } else {
        fault.note(
            "the name of a type has letters and digits only and starts with an upper-case letter",
        )
    }
}

fn bad_word(text: &str, words: &[(&'static str, &'static str)], span: Span) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadWord,
        span,
        format!("`{text}` is not one of the words that may stand here"),
    );
    match nearest(text, words.iter().map(|(word, _)| *word)) {
        Some(near) => fault.fix(span, near, format!("did you mean `{near}`?")),
        None => fault.note(format!("expected one of {}", list_words(words))),
    }
}

fn list_words(words: &[(&'static str, &'static str)]) -> String {
    let quoted: Vec<_> = words.iter().map(|(word, _)| format!("`{word}`")).collect();
    quoted.join(", ")
}

fn wrong_kind(expected: &str, node: &Node, at: Span, faults: &mut Faults) {
    let span = if node.is_null() { at } else { node.span };
    let fault = Diagnostic::error(
        FaultCode::WrongKind,
        span,
        format!("expected {expected}, found {}", node.describe()),
    );
    faults.push(
        if node.is_null() && expected.starts_with("a mapping from") {
            fault.note("write `{}` if there are none")
        } else if node.is_null() && expected == "a list" {
            fault.note("write `[]` if there are none")
        } else {
            fault
        },
    );
}
