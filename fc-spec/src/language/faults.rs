//! The possible errors of each key: those that its kind implies in [`shape`](crate::load), and those in its declaration.

use crate::diagnostic::FaultCode;
use crate::language::grammar::{
    AT_MOST_ONCE, AnyKey, Command, FIELD_FORMS, File, GROUPED, Kind, ONCE, Report, Stream, TEXT,
    Table,
};

/// Returns the errors of a mapping as a whole: errors of its keys, not of their values.
pub(super) fn of_table(table: &Table) -> Vec<FaultCode> {
    let is_one_of = |tables: &[&Table]| tables.iter().any(|other| other.name == table.name);
    let forms = FIELD_FORMS.map(|(_, table)| table);
    let is_form = is_one_of(&forms);
    let has_text = |key: &&AnyKey| key.name == TEXT.zh.name || key.name == TEXT.en.name;
    let mut required = table.keys.iter().filter(|key| key.required);
    let mut found = vec![FaultCode::WrongKind, FaultCode::UnknownKey];
    add(
        &mut found,
        required.clone().any(|key| !has_text(&key)),
        &[FaultCode::MissingKey],
    );
    add(
        &mut found,
        required.any(|key| has_text(&key)),
        &[FaultCode::MissingTranslation],
    );
    let is_operation = is_one_of(&[Command::TABLE, Report::TABLE, Stream::TABLE]);
    add(
        &mut found,
        is_operation || is_form,
        &[FaultCode::MisplacedKey],
    );
    add(
        &mut found,
        is_form,
        &[FaultCode::TwoForms, FaultCode::MarkerAsKey],
    );
    add(
        &mut found,
        is_one_of(&[File::TABLE]),
        &[FaultCode::SectionMissing],
    );
    sorted(found)
}

/// Returns the errors of the value of a key. The part of a mapping with known keys lists the errors of that mapping.
pub(super) fn of_key(table: &Table, key: &AnyKey) -> Vec<FaultCode> {
    let mut found = key.said.faults.to_vec();
    of_kind(&key.kind, &mut found);
    if table.name == File::TABLE.name {
        let once = ONCE.contains(&key.name) || AT_MOST_ONCE.contains(&key.name);
        add(&mut found, once, &[FaultCode::SectionTwice]);
        add(
            &mut found,
            GROUPED.contains(&key.name),
            &[FaultCode::MisplacedSection, FaultCode::SectionMissing],
        );
    }
    sorted(found)
}

fn add(found: &mut Vec<FaultCode>, holds: bool, faults: &[FaultCode]) {
    if holds {
        found.extend(faults);
    }
}

fn sorted(mut found: Vec<FaultCode>) -> Vec<FaultCode> {
    found.sort();
    found.dedup();
    found
}

fn of_kind(kind: &Kind, found: &mut Vec<FaultCode>) {
    let kind = kind.form();
    let own: &[FaultCode] = match kind {
        Kind::Text | Kind::Scalar | Kind::Json => &[FaultCode::TextCut],
        Kind::Bool => &[FaultCode::BadBool],
        Kind::Int { .. } => &[FaultCode::BadInteger, FaultCode::IntegerRange],
        Kind::Number => &[FaultCode::BadNumber],
        Kind::Code => &[FaultCode::BadCode],
        Kind::Date => &[FaultCode::BadDate],
        Kind::Name => &[FaultCode::BadName],
        Kind::TypeName => &[FaultCode::BadTypeName],
        Kind::Type => &[
            FaultCode::BadType,
            FaultCode::UnknownType,
            FaultCode::RecursiveType,
            FaultCode::IdTypes,
        ],
        Kind::ConflictId => &[FaultCode::BadConflictId],
        Kind::MediaType => &[FaultCode::BadMediaType],
        Kind::Unit => &[FaultCode::UnknownUnit],
        Kind::Word(_) => &[FaultCode::BadWord],
        Kind::WireKey => &[],
        Kind::Body => BODY,
        // The part of the mapping lists its errors.
        Kind::Map(_) | Kind::ByKey { .. } | Kind::Ref { .. } => return,
        Kind::Either(kinds) => return kinds.iter().for_each(|kind| of_kind(kind, found)),
        Kind::List { of, min, max } => {
            of_kind(of, found);
            let is_of_words = matches!(
                of.form(),
                Kind::Word(_) | Kind::Name | Kind::ConflictId | Kind::Text
            );
            add(found, true, &[FaultCode::WrongKind]);
            add(found, is_of_words, &[FaultCode::DuplicateItem]);
            add(found, matches!(of, Kind::Map(_)), &[FaultCode::SplitItem]);
            return add(
                found,
                *min > 0 || *max < usize::MAX,
                &[FaultCode::ListLength],
            );
        }
        Kind::Entries { key, value, min } => {
            of_kind(key, found);
            of_kind(value, found);
            let is_number = matches!(key.form(), Kind::Int { .. } | Kind::Scalar);
            add(found, true, &[FaultCode::WrongKind]);
            add(found, is_number, &[FaultCode::DuplicateNumber]);
            return add(found, *min > 0, &[FaultCode::ListLength]);
        }
    };
    found.extend(own);
    let is_plain = matches!(kind, Kind::Bool | Kind::Code | Kind::Date);
    add(found, !matches!(kind, Kind::Json), &[FaultCode::WrongKind]);
    add(
        found,
        !is_plain,
        &[FaultCode::AmbiguousWord, FaultCode::LeadingZero],
    );
}

/// The errors of wire keys, and of types written directly as their value.
const BODY: &[FaultCode] = &[
    FaultCode::BadType,
    FaultCode::UnknownType,
    FaultCode::RecursiveType,
    FaultCode::DuplicateType,
    FaultCode::DuplicateFieldName,
    FaultCode::UnusableName,
    FaultCode::MissingExample,
    FaultCode::ShortForm,
    FaultCode::NothingLeft,
];
