//! The generated part of the C++ package.

use crate::product::Artifact;
use crate::target::Targets;
use fc_spec::model::Model;

/// All of its files.
#[must_use]
pub fn emit(_model: &Model, _targets: &Targets) -> Vec<Artifact> {
    Vec::new()
}
