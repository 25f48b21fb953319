//! The rules, by section, with their effects and their texts in both languages.

pub(crate) mod choices;
pub(crate) mod constraints;
pub(crate) mod fields;
pub(crate) mod frame;
pub(crate) mod operations;
pub(crate) mod process;
pub(crate) mod results;

use crate::rule::{About, Language, Rule, Wire};

/// The sections.
pub(crate) const ALL: [&[&Rule]; 8] = [
    &[&UNJUDGED],
    frame::RULES,
    operations::RULES,
    fields::RULES,
    constraints::RULES,
    choices::RULES,
    results::RULES,
    process::RULES,
];

impl Rule {
    /// Returns every rule by number. The rule for unjudged differences comes first.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        let sections = ALL.iter();
        let mut rules: Vec<&Self> = sections.flat_map(|it| it.iter().copied()).collect();
        rules.sort_by_key(|rule| rule.number);
        rules.into_iter()
    }

    /// Returns the rule with this code, in any case, with or without `FC` and leading zeros.
    #[must_use]
    pub fn parse(code: &str) -> Option<&'static Self> {
        let upper = code.trim().to_ascii_uppercase();
        let digits = upper.strip_prefix("FC").unwrap_or(&upper);
        let padded = format!("FC{digits:0>4}");
        Self::all().find(|rule| rule.code() == padded)
    }
}

/// All languages.
pub(crate) const EVERY: &[Language] = &[
    Language::Rust,
    Language::Kotlin,
    Language::JvmBinary,
    Language::Cpp,
    Language::Python,
    Language::Typescript,
];

/// Defaults of a rule.
const BASE: Rule = Rule {
    number: 0,
    name: "",
    wire: Wire::Fine,
    source: &[],
    behaviour: false,
    silent: false,
    is_error: false,
    about: About::Change,
    mirror: &[],
    no_mirror: ["", ""],
    title: ["", ""],
    text: ["", ""],
};

/// Returns the texts of a code in `explain`, in English and in Chinese.
macro_rules! explained {
    ($code:expr) => {
        [
            include_str!(concat!("explain/", $code, ".md")).trim_ascii_end(),
            include_str!(concat!("explain/", $code, ".zh.md")).trim_ascii_end(),
        ]
    };
}

/// Declares the rules of a section by their differences from [`BASE`], and the list of them. The explanation of a rule is
/// in `explain`.
macro_rules! rules {
    ($($Code:ident $NAME:ident $name:literal $zh:literal $en:literal {
        $($field:ident: $value:expr,)*
    })+) => {
        $(pub(crate) static $NAME: Rule = Rule {
            number: $crate::rule::number(stringify!($Code)),
            name: $name,
            title: [$en, $zh],
            text: $crate::rules::explained!(stringify!($Code)),
            $($field: $value,)*
            ..BASE
        };)+

        /// All of the section.
        pub(crate) const RULES: &[&Rule] = &[$(&$NAME),+];
    };
}

use {explained, rules};

/// A difference that no rule judges.
pub(crate) static UNJUDGED: Rule = Rule {
    name: "unjudged",
    about: About::Text,
    no_mirror: [
        "rules of one direction leave the opposite change to this rule",
        "有的规则只评估一个方向，反方向的变更归在这里",
    ],
    title: ["a change that no rule judges", "没有规则评估的变更"],
    text: explained!("FC0700"),
    ..BASE
};
