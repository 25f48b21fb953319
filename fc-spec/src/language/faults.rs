//! The possible errors of each key: those that its kind implies in [`shape`](crate::load), and those in its declaration.

use crate::diagnostic::FaultCode;
use crate::language::grammar::{
    AT_MOST_ONCE, AnyKey, Command, FIELD_FORMS, File, GROUPED, Kind, ONCE, Report, Stream, TEXT,
    Table,
};
use std::collections::BTreeSet;

/// Returns the errors of a mapping as a whole: errors of its keys, not of their values.
pub(super) fn of_table(table: &Table) -> Vec<FaultCode> {
    let is_one_of = |tables: &[&Table]| tables.iter().any(|other| other.name == table.name);
    let forms = FIELD_FORMS.map(|(_, table)| table);
    let is_form = is_one_of(&forms);
    let has_text = |key: &&AnyKey| key.name == TEXT.zh.name || key.name == TEXT.en.name;
    let mut required = table.keys.iter().filter(|key| key.required);
    let is_operation = is_one_of(&[Command::TABLE, Report::TABLE, Stream::TABLE]);
    sorted([
        (true, FaultCode::WrongKind),
        (true, FaultCode::UnknownKey),
        (
            required.clone().any(|key| !has_text(&key)),
            FaultCode::MissingKey,
        ),
        (
            required.any(|key| has_text(&key)),
            FaultCode::MissingTranslation,
        ),
        (is_operation || is_form, FaultCode::MisplacedKey),
        (is_form, FaultCode::TwoForms),
        (is_form, FaultCode::MarkerAsKey),
        (is_one_of(&[File::TABLE]), FaultCode::SectionMissing),
    ])
}

/// Returns the errors of the value of a key. The part of a mapping with known keys lists the errors of that mapping.
pub(super) fn of_key(table: &Table, key: &AnyKey) -> Vec<FaultCode> {
    let is_top = table.name == File::TABLE.name;
    let is_once = ONCE.contains(&key.name) || AT_MOST_ONCE.contains(&key.name);
    let is_grouped = is_top && GROUPED.contains(&key.name);
    let of_section = [
        (is_top && is_once, FaultCode::SectionTwice),
        (is_grouped, FaultCode::MisplacedSection),
        (is_grouped, FaultCode::SectionMissing),
    ];
    let own = key.said.faults.iter().map(|fault| (true, *fault));
    sorted(own.chain(of_section).chain(of_kind(&key.kind)))
}

/// Returns the errors that hold, in order.
fn sorted(faults: impl IntoIterator<Item = (bool, FaultCode)>) -> Vec<FaultCode> {
    let held = faults.into_iter().filter(|(holds, _)| *holds);
    let held: BTreeSet<FaultCode> = held.map(|(_, fault)| fault).collect();
    held.into_iter().collect()
}

/// Returns the possible errors of a kind, each with `true` if it holds for this one.
fn of_kind(kind: &Kind) -> Vec<(bool, FaultCode)> {
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
        Kind::Map(_) | Kind::ByKey { .. } | Kind::Ref { .. } => return Vec::new(),
        Kind::Either(kinds) => return kinds.iter().flat_map(of_kind).collect(),
        Kind::List { of, min, max } => {
            let is_of_words = matches!(
                of.form(),
                Kind::Word(_) | Kind::Name | Kind::ConflictId | Kind::Text
            );
            let own = [
                (true, FaultCode::WrongKind),
                (is_of_words, FaultCode::DuplicateItem),
                (matches!(of, Kind::Map(_)), FaultCode::SplitItem),
                (*min > 0 || *max < usize::MAX, FaultCode::ListLength),
            ];
            return of_kind(of).into_iter().chain(own).collect();
        }
        Kind::Entries { key, value, min } => {
            let is_number = matches!(key.form(), Kind::Int { .. } | Kind::Scalar);
            let own = [
                (true, FaultCode::WrongKind),
                (is_number, FaultCode::DuplicateNumber),
                (*min > 0, FaultCode::ListLength),
            ];
            let inside = of_kind(key).into_iter().chain(of_kind(value));
            return inside.chain(own).collect();
        }
    };
    let is_plain = matches!(kind, Kind::Bool | Kind::Code | Kind::Date);
    let of_scalar = [
        (!matches!(kind, Kind::Json), FaultCode::WrongKind),
        (!is_plain, FaultCode::AmbiguousWord),
        (!is_plain, FaultCode::LeadingZero),
    ];
    let own = own.iter().map(|fault| (true, *fault));
    own.chain(of_scalar).collect()
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
