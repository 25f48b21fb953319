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
}

impl FaultCode {
    /// The code with this number, in any case and with or without its `FC`.
    #[must_use]
    pub fn parse(number: &str) -> Option<Self> {
        let upper = number.trim().to_ascii_uppercase();
        let digits = upper.strip_prefix("FC").unwrap_or(&upper);
        Self::ALL
            .iter()
            .copied()
            .find(|code| code.as_str().strip_prefix("FC") == Some(digits))
    }
}

impl std::fmt::Display for FaultCode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}
