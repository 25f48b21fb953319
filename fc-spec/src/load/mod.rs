//! Turns the files of a spec into the resolved model, or into a list of all their errors.
//!
//! 1. [`syntax`](crate::syntax) makes a tree of each file;
//! 2. `shape` compares the trees with the language's `grammar`;
//! 3. `lower` makes a draft of them: model items, each with its place;
//! 4. `resolve` fills in derived values, and `questions` lists the open questions;
//! 5. `check` verifies names, codes, examples and gaps, which the grammar cannot express;
//! 6. `partial` removes the places and builds the readable part, and the model if there is no error.
//!
//! **Architecture invariant.** No step stops at an error, and none repeats an error of an earlier step. One run reports
//! all errors of a spec.

mod answer_edit;
mod answer_scope;
mod check;
pub(crate) mod draft;
#[cfg(test)]
mod examples;
mod follow_ups;
mod lower;
mod partial;
mod process;
mod questions;
mod remedy;
mod resolve;
mod section;
mod settle;
mod shape;
pub(crate) mod texts;
mod trees;

use crate::diagnostic::Faults;
use crate::model::Languages;
use crate::source::Sources;
use draft::Draft;

pub use crate::model::Partial;
pub use partial::Loaded;
pub use settle::{Said, SettleError, Settled, settle};
pub use trees::Trees;

pub(crate) use crate::names::is_snake as is_operation_name;
pub(crate) use answer_edit::text as yaml_scalar;
pub(crate) use shape::{check_keys, check_kind, check_root};
pub(crate) use texts::{TO_BE_WRITTEN_EN, TO_BE_WRITTEN_ZH};

/// Reads a spec whose texts are in both languages. Returns everything readable and adds all errors to `faults`.
#[must_use]
pub fn load(sources: &Sources, faults: &mut Faults) -> Loaded {
    Trees::new(sources).load(Languages::All, faults)
}

/// Reads a spec as a draft, whose places lie in its trees. The flag for `then` is `true` if all of it was readable.
fn read<T>(
    trees: &Trees,
    texts: Languages,
    faults: &mut Faults,
    then: impl FnOnce(Draft<'_>, bool, &mut Faults) -> T,
) -> T {
    let (parsed, mut whole) = trees.parsed(faults);
    let sections = section::collect(&parsed, texts, &mut whole, faults);
    whole &= !faults.has_lost();
    let mut draft = lower::lower(&sections, trees.sources(), texts);
    draft.note_doubtful(faults);
    resolve::resolve(&mut draft);
    draft.plain.questions = questions::questions(&draft, trees.sources());
    then(draft, whole, faults)
}
