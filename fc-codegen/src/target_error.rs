//! Reasons why a project has no targets.

use fc_spec::diagnostic::Faults;
use fc_spec::model::{ProjectionError, Text};
use fc_spec::source::Sources;
use std::fmt;

/// The path of the file, relative to the project's root.
pub const FILE: &str = "fc.yaml";

/// The reason why a project has no targets.
#[derive(Debug, thiserror::Error)]
pub enum TargetError {
    /// `fc.yaml` has errors.
    #[error("{0}")]
    Settings(Box<InvalidSettings>),
    /// A target has an audience that the spec does not declare.
    #[error("{0}")]
    Audience(#[from] ProjectionError),
    /// `--only` names a target that the project does not have.
    #[error("there is no target `{name}`; the targets are {known}")]
    NotThere {
        /// The name.
        name: String,
        /// The targets of the project.
        known: String,
    },
}

/// A `fc.yaml` with errors.
#[derive(Debug)]
pub struct InvalidSettings {
    /// The file.
    pub sources: Sources,
    /// Its errors.
    pub faults: Faults,
}

impl InvalidSettings {
    /// Returns the errors with their places, one per line.
    #[must_use]
    pub fn text(&self) -> Text {
        let lines = self.faults.iter().map(|fault| {
            let place = self.sources.line_col(fault.primary.span);
            let place = format!("{FILE}:{}:{}", place.line, place.column);
            let Text { zh, en } = &fault.message;
            Text {
                zh: format!("{place}: {zh}"),
                en: format!("{place}: {en}"),
            }
        });
        Text::joined(lines, "\n", "\n")
    }
}

impl fmt::Display for InvalidSettings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text().en)
    }
}

impl TargetError {
    /// Returns the message for the user, in both languages.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Settings(settings) => settings.text(),
            Self::Audience(error) => error.text(),
            Self::NotThere { name, known } => Text {
                zh: format!("没有目标 `{name}`；目标有：{known}"),
                en: self.to_string(),
            },
        }
    }
}

pub(crate) fn quoted<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let names: Vec<_> = names.map(|name| format!("`{name}`")).collect();
    names.join(", ")
}
