//! What a rule of the lint says of itself.

use super::search::Search;
use crate::diagnostic::LintCode;
use crate::model::Lang;
use std::cmp::Ordering;
use std::hash::{Hash, Hasher};

/// What a rule is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Category {
    /// What no protocol should have.
    Minimal,
    /// What makes a protocol easy to use; contains [`Minimal`](Self::Minimal).
    Standard,
    /// Texts.
    Docs,
    /// What receivers in some language cannot keep, or what nothing bounds.
    Wire,
    /// What is withdrawn, and until when.
    Sunset,
    /// Rules of the project, and how it uses the lint.
    House,
}

impl Category {
    /// All of them, in the order of their numbers.
    pub const ALL: &'static [Self] = &[
        Self::Minimal,
        Self::Standard,
        Self::Docs,
        Self::Wire,
        Self::Sunset,
        Self::House,
    ];

    /// As `fc.yaml` names it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Minimal => "MINIMAL",
            Self::Standard => "STANDARD",
            Self::Docs => "DOCS",
            Self::Wire => "WIRE",
            Self::Sunset => "SUNSET",
            Self::House => "HOUSE",
        }
    }

    /// The category that contains this one, if there is one.
    #[must_use]
    pub const fn within(self) -> Option<Self> {
        match self {
            Self::Minimal => Some(Self::Standard),
            _ => None,
        }
    }
}

/// What becomes of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Level {
    /// It is not shown.
    Off,
    /// It is shown.
    Warning,
    /// It is shown, and the lint fails.
    Error,
}

impl Level {
    /// All of them.
    pub const ALL: &'static [Self] = &[Self::Off, Self::Warning, Self::Error];

    /// As `fc.yaml` names it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// A rule of the lint.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Its code, with its title and its explanation.
    pub code: LintCode,
    /// What it is for.
    pub category: Category,
    /// Its name, such as `similar-keys`.
    pub name: &'static str,
    /// What becomes of its findings unless `fc.yaml` says otherwise.
    pub level: Level,
    /// Looks for it; `None` where that takes more than a model.
    pub(super) find: Option<fn(&mut Search<'_>)>,
}

impl Rule {
    /// Every rule, by its code.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        super::RULES.iter().flat_map(|category| category.iter())
    }

    /// The rule with this code, in any case, with or without its `FC` and zeros in front, or with this name.
    #[must_use]
    pub fn parse(text: &str) -> Option<&'static Self> {
        let upper = text.trim().to_ascii_uppercase();
        let digits = upper.strip_prefix("FC").unwrap_or(&upper);
        let padded = format!("FC{digits:0>4}");
        Self::all().find(|rule| rule.code.number == padded || rule.name == text.trim())
    }

    /// What it means and how it is set, as Markdown.
    #[must_use]
    pub fn explain(&self, lang: Lang) -> String {
        let [en, zh] = self.setting();
        format!("{}\n\n{}\n", self.code.text_in(lang), lang.pick(zh, en))
    }

    /// Its category, name and level, in English and in Chinese.
    #[must_use]
    pub fn setting(&self) -> [String; 2] {
        let (category, name, level) = (self.category.name(), self.name, self.level.name());
        [
            format!("Rule `{name}` of {category}, by default `{level}`."),
            format!("{category} 类规则 `{name}`，默认级别 `{level}`。"),
        ]
    }
}

/// Two rules are the same if they have the same code.
impl PartialEq for Rule {
    fn eq(&self, other: &Self) -> bool {
        self.code.number == other.code.number
    }
}

impl Eq for Rule {}

impl PartialOrd for Rule {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rule {
    fn cmp(&self, other: &Self) -> Ordering {
        self.code.number.cmp(other.code.number)
    }
}

impl Hash for Rule {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.code.number.hash(state);
    }
}
