//! Reasons why a project has no targets.

use crate::package::language::Language;
use crate::product::Product;
use fc_spec::model::{ProjectionError, Text};

/// The path of the file, relative to the project's root.
pub const FILE: &str = "fc.yaml";

/// The reason why `fc.yaml` cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum TargetError {
    /// The file is not YAML, or has unknown keys.
    #[error("`{FILE}`: {0}")]
    Shape(#[from] serde_yaml::Error),
    /// No product has this name, and the target has no plugin.
    #[error(
        "`{FILE}`: there is no product `{name}`; the products are {}. A target of another name needs a `plugin`",
        products()
    )]
    Unknown {
        /// The name.
        name: String,
    },
    /// A list of languages is empty.
    #[error("`{FILE}`: `languages` needs at least one of `zh` and `en`")]
    NoLanguage,
    /// A key that this target does not support.
    #[error("`{FILE}`: the target `{name}` cannot have `{key}`")]
    Misplaced {
        /// The target.
        name: String,
        /// The key.
        key: &'static str,
    },
    /// A key that this target needs.
    #[error("`{FILE}`: the target `{name}` needs `{key}`")]
    Missing {
        /// The target.
        name: String,
        /// The key.
        key: &'static str,
    },
    /// A number is too small or too large.
    #[error("`{FILE}`: `{key}` of the target `{name}` must be from 1 to {most}")]
    OutOfRange {
        /// The target.
        name: String,
        /// The key.
        key: &'static str,
        /// The largest value.
        most: u64,
    },
    /// The value of `names` is no supported language.
    #[error(
        "`{FILE}`: the target `{target}` has names in `{language}`; the languages are {}",
        languages()
    )]
    Language {
        /// The target.
        target: String,
        /// The value of `names`.
        language: String,
    },
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

impl TargetError {
    /// Returns the message for the user, in both languages.
    #[must_use]
    pub fn text(&self) -> Text {
        let zh = match self {
            Self::Audience(error) => return error.text(),
            Self::Shape(error) => format!("`{FILE}`：{}", crate::yaml_error::chinese(error)),
            Self::Unknown { name } => format!(
                "`{FILE}`：没有产物 `{name}`；产物有：{}。其他名称的目标需要 `plugin`",
                products()
            ),
            Self::NoLanguage => format!("`{FILE}`：`languages` 至少需要 `zh` 和 `en` 中的一个"),
            Self::Misplaced { name, key } => {
                format!("`{FILE}`：目标 `{name}` 不能有 `{key}`")
            }
            Self::Missing { name, key } => format!("`{FILE}`：目标 `{name}` 需要 `{key}`"),
            Self::OutOfRange { name, key, most } => {
                format!("`{FILE}`：目标 `{name}` 的 `{key}` 应为 1 到 {most}")
            }
            Self::Language { target, language } => format!(
                "`{FILE}`：目标 `{target}` 的名称所用的语言是 `{language}`；语言有：{}",
                languages()
            ),
            Self::NotThere { name, known } => format!("没有目标 `{name}`；目标有：{known}"),
        };
        let en = self.to_string();
        Text { zh, en }
    }
}

fn products() -> String {
    quoted(Product::ALL.iter().map(|product| product.name()))
}

fn languages() -> String {
    quoted(Language::ALL.iter().map(|language| language.name))
}

pub(crate) fn quoted<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let names: Vec<_> = names.map(|name| format!("`{name}`")).collect();
    names.join(", ")
}
