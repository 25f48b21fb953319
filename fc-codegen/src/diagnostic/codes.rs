//! The table of fault codes. A code, once published, keeps its meaning; a retired one is not used again.
//!
//! To add one: a line here, in order, and `explain/FC….md` beside it, which says what is wrong and why
//! that matters in a paragraph, then shows the fault in a block fenced as `yaml bad` and its
//! remedy in one fenced as `yaml good`.
//!
//! Ranges: `FC00xx` YAML itself, `FC01xx` shape (unknown key, missing key, wrong kind, bad scalar), `FC02xx`
//! names and references, `FC03xx` codes, `FC04xx` fields, constraints and examples, `FC05xx` frame,
//! transport, envelope and results, `FC06xx` texts, history and answers.

macro_rules! fault_codes {
    ($($code:ident $variant:ident $title:literal;)+) => {
        /// Which fault it is.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum FaultCode {
            $(#[doc = $title] $variant,)+
        }

        impl FaultCode {
            /// Every code, in order.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Its number, such as `FC0012`.
            #[must_use]
            pub const fn as_str(self) -> &'static str {
                match self {
                    $(Self::$variant => stringify!($code),)+
                }
            }

            /// What it is about, in a few words.
            #[must_use]
            pub const fn title(self) -> &'static str {
                match self {
                    $(Self::$variant => $title,)+
                }
            }

            /// What is wrong, why it matters and what to write instead, as Markdown.
            #[must_use]
            pub const fn explain(self) -> &'static str {
                match self {
                    $(Self::$variant => include_str!(concat!("explain/", stringify!($code), ".md")),)+
                }
            }
        }
    };
}

fault_codes! {
    FC0001 Unreadable "file or directory that cannot be read";
    FC0002 NotUtf8 "file that is not UTF-8";
    FC0003 TooLarge "file or spec that is too large";
    FC0004 StrayFile "YAML file where the spec does not look for it";
    FC0005 EmptyFile "file with nothing in it";
    FC0006 ControlCharacter "invisible control character";
    FC0007 BadYaml "text that is not YAML";
    FC0008 Unclosed "bracket or quote that is never closed";
    FC0009 Tab "tab used as indentation";
    FC0010 BadIndentation "line that is indented wrongly";
    FC0011 BadEscape "escape that does not exist";
    FC0012 DuplicateKey "key that stands twice";
    FC0013 KeyNotScalar "key that is not a word";
    FC0014 Anchor "anchor";
    FC0015 Alias "alias";
    FC0016 MergeKey "merge key";
    FC0017 Tag "tag";
    FC0018 Directive "YAML directive";
    FC0019 SeveralDocuments "second document in one file";
    FC0020 TooDeep "nesting that is too deep";
    FC0021 ScalarTooLong "text that is too long";
    FC0022 TooManyNodes "file with too many values";
    FC0101 UnknownKey "key that the language does not have";
    FC0102 MissingKey "required key that is missing";
    FC0103 WrongKind "value of the wrong kind";
    FC0104 BadBool "truth value other than true or false";
    FC0105 AmbiguousWord "word that YAML readers disagree about";
    FC0106 LeadingZero "number with zeros in front";
    FC0107 BadInteger "value that is not an integer";
    FC0108 IntegerRange "integer that is too small or too large";
    FC0109 BadWord "word that may not stand here";
    FC0110 BadName "name that is not snake_case";
    FC0111 BadTypeName "name of a type that is not PascalCase";
    FC0112 BadCode "code that is spelt wrongly";
    FC0113 BadDate "date that does not exist or is spelt wrongly";
    FC0114 SectionTwice "part of the spec that stands twice";
    FC0115 SectionMissing "part of the spec that is missing";
    FC0116 MisplacedSection "operations outside `commands/`";
    FC0117 MisplacedKey "key of something else";
    FC0118 BadConflictId "id of a conflict that is spelt wrongly";
    FC0119 DuplicateNumber "number that stands twice in different spellings";
    FC0120 TwoForms "two forms of a field at once";
    FC0121 BadNumber "value that is not a number";
    FC0122 BadType "type that is spelt wrongly";
    FC0123 ListLength "list with too few or too many items";
    FC0124 MarkerAsKey "wire key that is read as a keyword";
    FC0601 MissingTranslation "text that is missing in one language";
}

impl FaultCode {
    /// The code with this number, in any case, with or without its `FC` and zeros in front.
    #[must_use]
    pub fn parse(number: &str) -> Option<Self> {
        let upper = number.trim().to_ascii_uppercase();
        let digits = upper.strip_prefix("FC").unwrap_or(&upper);
        let padded = format!("FC{digits:0>4}");
        Self::ALL.iter().copied().find(|code| code.as_str() == padded)
    }
}

impl std::fmt::Display for FaultCode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}
