//! Checks what the grammar cannot express: names must exist, codes must differ, examples must match their types.
//!
//! Each check is one function, each subject one file. A check only reports errors and does not repeat those of an
//! earlier step.

mod answers;
mod available;
mod cadence;
mod codes;
mod conditions;
mod coordinates;
mod declared;
mod entities;
mod enums;
mod envelope;
mod examples;
mod expand;
mod fields;
mod frame;
mod glossary;
mod governed;
mod graph;
mod history;
mod iter;
mod limits;
mod names;
mod preconditions;
mod process;
mod references;
mod results;
mod states;
mod streams;
mod unused_types;
mod value;
mod value_list;
mod waivers;

use super::draft::Draft;
use super::follow_ups::Earlier;
use crate::diagnostic::Faults;
use crate::source::Sources;
use rayon::iter::{
    IndexedParallelIterator as _, IntoParallelRefIterator as _, ParallelIterator as _,
};

/// Reports errors. The result and its order depend on the draft alone.
type Check = fn(&Draft<'_>, &mut Faults);

/// Checks that apply to every draft.
const ALWAYS: &[Check] = &[
    frame::check_ports,
    frame::check_header_types,
    frame::check_header_roles,
    frame::check_header_values,
    frame::check_header_names,
    frame::check_heads,
    frame::check_kinds,
    frame::check_encodings,
    limits::check_header,
    envelope::check_roles,
    envelope::check_fields,
    envelope::check_age,
    results::check_roles,
    results::check_names,
    results::check_errors,
    codes::check_retired,
    codes::check_unique,
    check_codes,
    names::check_groups,
    names::check_operations,
    names::check_files,
    names::check_tables,
    names::check_types,
    names::check_fields,
    names::check_wire_keys,
    fields::check_short_forms,
    fields::check_texts,
    fields::check_bounds,
    fields::check_lengths,
    fields::check_patterns,
    fields::check_only,
    fields::check_defaults,
    fields::check_quirks,
    fields::check_wire_forms,
    fields::check_open_bodies,
    conditions::check_one,
    conditions::check_fields,
    conditions::check_values,
    enums::check_values,
    enums::check_names,
    states::check_order,
    states::check_names,
    states::check_final,
    states::check_reached,
    preconditions::check_said,
    preconditions::check_circles,
    cadence::check_one_rule,
    cadence::check_fields,
    available::check_limits,
    available::check_optional,
    available::check_within,
    available::check_left,
    available::check_releases,
    entities::check_ids,
    entities::check_types,
    coordinates::check_objects,
    coordinates::check_lengths,
    glossary::check_words,
    waivers::check_ids,
    history::check_order,
    answers::check_lost,
    streams::check_content,
    governed::check_purpose,
    governed::check_paths,
    governed::check_held,
    enums::check_variants,
    examples::check_present,
    check_values,
];

/// Checks for missing or unused things. They need every file, because the thing may be in a file that failed to parse.
const ONLY_IF_ALL_FILES_PARSED: &[Check] = &[
    references::check_types,
    references::check_structs,
    references::check_operations,
    codes::check_groups,
    process::check_ties,
    process::check_state,
    references::check_results,
    cadence::check_deadlines,
    preconditions::check_names,
    preconditions::check_states,
    unused_types::check_unused,
    declared::check_declared,
    declared::check_unused,
    answers::check_known,
    answers::check_answered,
    answers::check_sections,
];

/// Runs all checks in parallel and reports their errors in the order of the lists.
///
/// `whole`: `true` if every file was parsed.
pub(super) fn check(draft: &Draft<'_>, sources: &Sources, whole: bool, faults: &mut Faults) {
    let checks = ALWAYS
        .iter()
        .chain(ONLY_IF_ALL_FILES_PARSED.iter().filter(|_| whole));
    let checks: Vec<&Check> = checks.collect();
    // Durations differ widely, so each check is a task of the pool.
    let found: Vec<_> = checks
        .par_iter()
        .with_max_len(1)
        .map(|check| {
            let mut found = Faults::new();
            check(draft, &mut found);
            found
        })
        .collect();
    let mut all = Faults::new();
    for found in found {
        all.append(found);
    }
    Earlier::new(draft, sources, faults).suppress(&mut all);
    faults.append(all);
}

/// Places codes in ranges only if the ranges are valid.
fn check_codes(draft: &Draft<'_>, faults: &mut Faults) {
    if codes::check_ranges(draft, faults) {
        codes::check_ranges_of_codes(draft, faults);
    }
}

/// Skips sizes and examples if a type contains itself, because they would be infinite.
fn check_values(draft: &Draft<'_>, faults: &mut Faults) {
    if let Some(order) = expand::check_recursion(draft, faults) {
        if expand::check_size(draft, &order, faults) {
            limits::check_bodies(draft, &order, faults);
        }
        examples::check_values(draft, faults);
        examples::check_rows(draft, faults);
    }
}
