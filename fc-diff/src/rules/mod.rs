//! The rules, by section: what each judges, whom it can break, and its texts in both languages.

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

/// Programs in every language.
const EVERY: &[Language] = &[
    Language::Rust,
    Language::Kotlin,
    Language::JvmBinary,
    Language::Cpp,
    Language::Python,
    Language::Typescript,
];

/// What a rule has unless it says otherwise.
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

/// Declares the rules of a section, each by what is not as in [`BASE`], and the list of them.
macro_rules! rules {
    ($($NAME:ident { $($field:ident: $value:expr,)+ })+) => {
        $(pub(crate) static $NAME: Rule = Rule { $($field: $value,)+ ..BASE };)+

        /// All of the section.
        pub(crate) const RULES: &[&Rule] = &[$(&$NAME),+];
    };
}

use rules;

/// A difference that no rule judges.
pub(crate) static UNJUDGED: Rule = Rule {
    name: "unjudged",
    about: About::Text,
    no_mirror: [
        "where a rule judges one way only, the way back is left here",
        "有的规则只评估一个方向，反方向的变更归在这里",
    ],
    title: ["a change that no rule judges", "没有规则评估的变更"],
    text: [
        "The two versions differ here, and no rule says whom that breaks. Most such changes are texts, conditions, \
         examples and notes; read them.",
        "两个版本在这里不同，但没有规则说明会影响谁。多数是文字、条件、示例和备注，请人工查看。",
    ],
    ..BASE
};
