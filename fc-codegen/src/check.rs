//! Checks a spec for errors, and for names that a target language cannot use.

use crate::package::items::clashes;
use crate::package::language::Language;
use fc_spec::diagnostic::Faults;
use fc_spec::index::Index;
use fc_spec::load::{Partial, Trees};
use fc_spec::model::{Languages, Model};
use fc_spec::source::Sources;

/// A spec that has been checked.
#[derive(Debug)]
pub struct Checked {
    /// The model, or its readable part if the spec has an error.
    pub read: Result<Model, Box<Partial>>,
    /// `true` if all files could be read as YAML.
    pub is_whole: bool,
    /// `true` if all required languages can use the names.
    pub is_spellable: bool,
}

impl Checked {
    /// Returns the model; `None` if there is any error.
    #[must_use]
    pub fn model(self) -> Option<Model> {
        self.read.ok().filter(|_| self.is_spellable)
    }
}

/// The requirements that a project has on its spec.
#[derive(Clone, Debug)]
pub struct Requirements {
    /// The languages that each text must have.
    pub texts: Languages,
    /// The programming languages that must be able to use each name.
    pub names: Vec<&'static Language>,
}

/// Checks a spec, and adds its errors to those from reading its files, sorted by position.
pub fn check(sources: &Sources, requirements: &Requirements, faults: &mut Faults) -> Checked {
    check_trees(&Trees::new(sources), requirements, faults)
}

/// Checks a spec whose files are already parsed.
pub fn check_trees(trees: &Trees, requirements: &Requirements, faults: &mut Faults) -> Checked {
    let loaded = trees.load(requirements.texts, faults);
    let is_whole = loaded.whole;
    let read = loaded.into_model();
    let clashes = match &read {
        Ok(model) => clashes(model, &requirements.names),
        Err(_) => Vec::new(),
    };
    if !clashes.is_empty() {
        let places = Index::new(trees.clone()).definitions();
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
