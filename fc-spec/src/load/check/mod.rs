//! What no grammar can say: names that must exist, codes that must differ, examples that must fit.
//!
//! One function per check, one file per subject. A check reports and changes nothing; it is silent about what
//! an earlier step has reported.

mod answers;
mod available;
mod cadence;
mod codes;
mod conditions;
mod each;
mod entities;
mod enums;
mod envelope;
mod examples;
mod expand;
mod fields;
mod frame;
mod glossary;
mod governed;
mod history;
mod names;
mod places;
mod preconditions;
mod process;
mod reach;
mod references;
mod results;
mod states;
mod streams;
mod value;

use super::draft::Draft;
use crate::diagnostic::Faults;

/// All checks.
///
/// `whole`: every file could be parsed. What is missing or unused is reported only then, since what is looked for
/// may stand in a file that could not.
pub(super) fn check(draft: &Draft<'_>, whole: bool, faults: &mut Faults) {
    frame::check_ports(draft, faults);
    frame::check_header_types(draft, faults);
    frame::check_header_roles(draft, faults);
    frame::check_header_values(draft, faults);
    frame::check_header_names(draft, faults);
    frame::check_heads(draft, faults);
    frame::check_kinds(draft, faults);
    frame::check_encodings(draft, faults);
    frame::check_limits(draft, faults);
    envelope::check_roles(draft, faults);
    envelope::check_fields(draft, faults);
    envelope::check_age(draft, faults);
    results::check_roles(draft, faults);
    results::check_names(draft, faults);
    results::check_errors(draft, faults);

    codes::check_retired(draft, faults);
    codes::check_unique(draft, faults);
    if codes::check_ranges(draft, faults) {
        codes::check_places(draft, faults);
    }

    names::check_groups(draft, faults);
    names::check_operations(draft, faults);
    names::check_tables(draft, faults);
    names::check_types(draft, faults);
    names::check_fields(draft, faults);
    names::check_wire_keys(draft, faults);

    fields::check_short_forms(draft, faults);
    fields::check_texts(draft, faults);
    fields::check_bounds(draft, faults);
    fields::check_lengths(draft, faults);
    fields::check_patterns(draft, faults);
    fields::check_only(draft, faults);
    fields::check_defaults(draft, faults);
    fields::check_quirks(draft, faults);
    fields::check_wire_forms(draft, faults);
    fields::check_open_bodies(draft, faults);
    conditions::check_one(draft, faults);
    conditions::check_fields(draft, faults);
    conditions::check_values(draft, faults);
    enums::check_values(draft, faults);
    enums::check_names(draft, faults);
    states::check_order(draft, faults);
    states::check_names(draft, faults);
    states::check_final(draft, faults);
    states::check_reached(draft, faults);
    preconditions::check_said(draft, faults);
    preconditions::check_circles(draft, faults);
    cadence::check_one_rule(draft, faults);
    cadence::check_fields(draft, faults);

    available::check_limits(draft, faults);
    available::check_optional(draft, faults);
    available::check_within(draft, faults);
    available::check_left(draft, faults);
    available::check_releases(draft, faults);
    entities::check_ids(draft, faults);
    entities::check_types(draft, faults);
    places::check_objects(draft, faults);
    places::check_lengths(draft, faults);
    glossary::check_words(draft, faults);
    history::check_order(draft, faults);
    answers::check_lost(draft, faults);
    streams::check_content(draft, faults);
    governed::check_purpose(draft, faults);
    governed::check_paths(draft, faults);
    governed::check_held(draft, faults);

    enums::check_variants(draft, faults);
    examples::check_present(draft, faults);
    if expand::check_recursion(draft, faults) {
        expand::check_size(draft, faults);
        examples::check_values(draft, faults);
        examples::check_rows(draft, faults);
    }

    if whole {
        references::check_types(draft, faults);
        references::check_structs(draft, faults);
        references::check_operations(draft, faults);
        references::check_set_off(draft, faults);
        streams::check_commands(draft, faults);
        process::check_ties(draft, faults);
        process::check_state(draft, faults);
        references::check_results(draft, faults);
        cadence::check_deadlines(draft, faults);
        preconditions::check_names(draft, faults);
        preconditions::check_states(draft, faults);
        reach::check_unused(draft, faults);
        entities::check_declared(draft, faults);
        entities::check_unused(draft, faults);
        places::check_declared(draft, faults);
        places::check_unused(draft, faults);
        available::check_declared(draft, faults);
        available::check_unused(draft, faults);
        answers::check_known(draft, faults);
        answers::check_answered(draft, faults);
        answers::check_sections(draft, faults);
    }
}
