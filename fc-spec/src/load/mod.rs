//! From the files of a spec to the resolved model, or to every fault in them.
//!
//! 1. [`syntax`](crate::syntax) makes a tree of each file;
//! 2. `shape` compares the trees with the language's `grammar`;
//! 3. `lower` makes a draft of them: model items, each with its place;
//! 4. `resolve` fills in what the spec leaves to be derived;
//! 5. `check` looks for what no grammar can say: names, codes, examples, gaps;
//! 6. `build` takes the places off, and the model is done.
//!
//! **Architecture invariant.** No step stops at a fault and none reports what an earlier one has
//! reported: all faults of a spec show up in one run.

mod build;
mod check;
mod draft;
pub(crate) mod grammar;
mod lower;
mod misread;
mod names;
mod resolve;
mod scalar;
mod section;
mod shape;
mod texts;

use crate::diagnostic::Faults;
use crate::model::Model;
use crate::syntax::{Sources, parse};
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

pub(crate) use names::is_snake as is_operation_name;
pub(crate) use texts::{TO_BE_WRITTEN_EN, TO_BE_WRITTEN_ZH};

/// The model of a spec. `None` if there is any error; warnings do not stand in the way.
#[must_use]
pub fn load(sources: &Sources, faults: &mut Faults) -> Option<Model> {
    let files: Vec<_> = sources.iter().collect();
    let parsed: Vec<_> = files
        .par_iter()
        .map(|&(file, source)| {
            let mut faults = Faults::new();
            let tree = source
                .whole
                .then(|| parse(file, &source.text, &mut faults))
                .flatten();
            (tree, faults)
        })
        .collect();
    let mut trees = Vec::new();
    let mut whole = true;
    for ((_, source), (tree, found)) in files.into_iter().zip(parsed) {
        faults.append(found);
        match tree {
            Some(tree) => trees.push(section::Tree {
                path: source.path.clone(),
                tree,
            }),
            None => whole = false,
        }
    }
    let sections = section::collect(&trees, &mut whole, faults);
    let mut draft = lower::lower(&sections, sources);
    resolve::resolve(&mut draft);
    check::check(&draft, whole, faults);
    if faults.has_errors() {
        return None;
    }
    build::build(draft)
}
