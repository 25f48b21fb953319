//! The data of a lint rule: its code, category, name and default level.

use super::search::Search;
use crate::diagnostic::LintCode;
use crate::model::Lang;

/// The category of a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Category {
    /// Rules that every protocol should keep.
    Minimal,
    /// Rules that make a protocol easy to use. The category contains [`Minimal`](Self::Minimal).
    Standard,
    /// Rules about texts.
    Docs,
    /// Rules about values that some languages cannot hold, and about values without limits.
    Wire,
    /// Rules about removal dates.
    Sunset,
    /// Rules of the project, and errors in its use of the lint.
    House,
}

impl Category {
    /// All categories, in the order of their numbers.
    pub const ALL: &'static [Self] = &[
        Self::Minimal,
        Self::Standard,
        Self::Docs,
        Self::Wire,
        Self::Sunset,
        Self::House,
    ];

    /// Returns the name in `fc.yaml`.
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

    /// Returns the category that contains this one, if there is one.
    #[must_use]
    pub const fn within(self) -> Option<Self> {
        match self {
            Self::Minimal => Some(Self::Standard),
            _ => None,
        }
    }
}

/// The severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Level {
    /// The finding is not shown.
    Off,
    /// The finding is shown.
    Warning,
    /// The finding is shown, and the lint fails.
    Error,
}

impl Level {
    /// All levels.
    pub const ALL: &'static [Self] = &[Self::Off, Self::Warning, Self::Error];

    /// Returns the level with this name, if there is one.
    pub(super) fn named(name: &str) -> Option<Self> {
        let mut levels = Self::ALL.iter();
        levels.find(|level| level.name() == name).copied()
    }

    /// Returns the name in `fc.yaml`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// Declares a rule by its code, name, category, level, search and titles. Its explanation is in `diagnostic/explain`.
macro_rules! rule {
    ($code:ident $name:literal $Category:ident $Level:ident $find:expr, $zh:literal $en:literal) => {
        $crate::lint::Rule {
            code: $crate::diagnostic::LintCode {
                number: stringify!($code),
                title: [$en, $zh],
                text: $crate::diagnostic::explained!($code),
            },
            category: $crate::lint::Category::$Category,
            name: $name,
            level: $crate::lint::Level::$Level,
            find: $find,
        }
    };
}

/// Declares the rules of a category: code, name, level, search and titles.
macro_rules! rules {
    ($Category:ident $($code:ident $name:literal $Level:ident $find:ident $zh:literal $en:literal;)+) => {
        pub(super) const RULES: &[$crate::lint::Rule] = &[
            $($crate::lint::rule::rule!($code $name $Category $Level Some($find), $zh $en)),+
        ];
    };
}

pub(super) use {rule, rules};

/// A rule of the lint.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// The code, with its title and its explanation.
    pub code: LintCode,
    /// The category.
    pub category: Category,
    /// The name, such as `similar-keys`.
    pub name: &'static str,
    /// The level, unless `fc.yaml` sets another.
    pub level: Level,
    /// The search function. `None` if the rule needs more than a model.
    pub(super) find: Option<fn(&mut Search<'_>)>,
}

impl Rule {
    /// Returns every rule.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        super::RULES.iter().flat_map(|category| category.iter())
    }

    /// Returns the rule with this code or name. The code can be in any case, with or without `FC` and leading zeros.
    #[must_use]
    pub fn parse(text: &str) -> Option<&'static Self> {
        let upper = text.trim().to_ascii_uppercase();
        let digits = upper.strip_prefix("FC").unwrap_or(&upper);
        let padded = format!("FC{digits:0>4}");
        Self::all().find(|rule| rule.code.number == padded || rule.name == text.trim())
    }

    /// Returns the explanation of the rule and its default level, as Markdown.
    #[must_use]
    pub fn explain(&self, lang: Lang) -> String {
        let [en, zh] = self.setting();
        format!("{}\n\n{}\n", self.code.text_in(lang), lang.pick(zh, en))
    }

    /// Returns a sentence with the category, the name and the default level, in English and in Chinese.
    #[must_use]
    pub fn setting(&self) -> [String; 2] {
        let (category, name, level) = (self.category.name(), self.name, self.level.name());
        [
            format!("Rule `{name}` of {category}, by default `{level}`."),
            format!("{category} 类规则 `{name}`，默认级别 `{level}`。"),
        ]
    }
}

/// Two rules are equal if they have the same code.
impl PartialEq for Rule {
    fn eq(&self, other: &Self) -> bool {
        self.code.number == other.code.number
    }
}

impl Eq for Rule {}
