//! All that stands in the way of making products of a spec: its own faults, and names that a language cannot have.

use crate::package::items::clashes;
use crate::package::language::Language;
use fc_spec::diagnostic::Faults;
use fc_spec::index::definitions;
use fc_spec::load::{Partial, Trees};
use fc_spec::model::{Languages, Model};
use fc_spec::source::Sources;

/// A spec that has been checked.
#[derive(Debug)]
pub struct Checked {
    /// What it means, or what could be read of it if there is an error in it.
    pub read: Result<Model, Box<Partial>>,
    /// Whether all of its files could be read as YAML.
    pub is_whole: bool,
    /// Whether its names are free in all languages that were asked for.
    pub is_spellable: bool,
}

impl Checked {
    /// The model; `None` if there is any error.
    #[must_use]
    pub fn model(self) -> Option<Model> {
        self.read.ok().filter(|_| self.is_spellable)
    }
}

/// The requirements that a project has on its spec.
#[derive(Clone, Debug)]
pub struct Requirements {
    /// Languages in which each text is required.
    pub texts: Languages,
    /// Programming languages in which each name has to be free.
    pub names: Vec<&'static Language>,
}

/// Reads a spec and adds its faults to those of reading its files, all in the order of their places.
pub fn check(sources: &Sources, requirements: &Requirements, faults: &mut Faults) -> Checked {
    check_trees(&Trees::new(sources), requirements, faults)
}

/// The same of files that have been parsed.
pub fn check_trees(trees: &Trees, requirements: &Requirements, faults: &mut Faults) -> Checked {
    let loaded = trees.load(requirements.texts, faults);
    let is_whole = loaded.whole;
    let read = loaded.into_model();
    let clashes = match &read {
        Ok(model) => clashes(model, &requirements.names),
        Err(_) => Vec::new(),
    };
    if !clashes.is_empty() {
        let places = definitions(trees.sources());
        faults.extend(clashes.iter().filter_map(|clash| clash.fault(&places)));
    }
    let is_spellable = clashes.is_empty();
    faults.sort();
    Checked {
        read,
        is_whole,
        is_spellable,
    }
}
