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
        #[allow(clippy::doc_markdown, reason = "the titles are shown to users, as plain text")]
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
    FC0125 DuplicateItem "word that stands in a list twice";
    FC0201 DuplicateOperation "two operations of one name";
    FC0202 DuplicateType "two types of one name";
    FC0203 UnknownType "type that does not exist";
    FC0204 UnusedType "type that nothing uses";
    FC0205 RecursiveType "type that holds itself";
    FC0206 DuplicateFieldName "two fields that are one in code";
    FC0207 DuplicateWireKey "wire key that stands in an object twice";
    FC0208 UnusableName "wire name without a name in code";
    FC0209 ReservedName "name that is taken";
    FC0210 NotAStruct "type that should be a struct";
    FC0211 UnknownOperation "operation that does not exist";
    FC0212 DuplicateGroup "two groups of one id";
    FC0213 EnvelopeKey "key of the envelope in a body";
    FC0214 DuplicateTable "two tables of one id";
    FC0215 UnknownResult "result code that does not exist";
    FC0216 DuplicateName "two names that are one in code";
    FC0217 BodyTooLarge "body that is too large";
    FC0301 DuplicateCode "two operations of one code";
    FC0302 RetiredCode "code that was retired";
    FC0303 CodeOutsideRanges "code that lies in no range";
    FC0304 CodeInWrongRange "code in a range of another purpose";
    FC0305 RangeInverted "range that ends before it begins";
    FC0306 RangesOverlap "ranges that overlap";
    FC0307 DuplicateRetired "code that is retired twice";
    FC0401 ExampleType "example that is no value of its type";
    FC0402 ExampleRange "example beyond min or max";
    FC0403 ExampleLength "example of the wrong length";
    FC0404 ExamplePattern "example that does not match its pattern";
    FC0405 ExampleValue "example that is no value of its enum";
    FC0406 MissingExample "required field without an example";
    FC0407 MinAboveMax "smallest value above the largest";
    FC0408 BoundsOnWrongType "min or max on what is no number";
    FC0409 BoundsBeyondType "bound that the type does not hold";
    FC0410 LengthOnWrongType "length on what has none";
    FC0411 LengthInverted "least length above the greatest";
    FC0412 PatternOnWrongType "pattern on what is no string";
    FC0413 BadPattern "pattern that is no regular expression";
    FC0414 DefaultOnRequired "default on a required field";
    FC0415 DefaultType "default that is no value of its type";
    FC0416 QuirkOnWrongType "quirk that its type has no use for";
    FC0417 WireOnWrongType "wire form that its type has no use for";
    FC0418 EnumValueType "enum value that does not fit what travels";
    FC0419 EmptyEnum "enum or choice with nothing to choose";
    FC0420 SameVariants "variant that is never taken";
    FC0421 OpenBodyFields "open body with fields";
    FC0422 RowMismatch "row that is no value of its struct";
    FC0423 AbsentRequired "required field left out of examples";
    FC0424 ShortForm "field that nothing describes";
    FC0501 RoleMissing "role that nothing has";
    FC0502 RoleTwice "role that two things have";
    FC0503 HeaderWidth "header field of the wrong width for its role";
    FC0504 BadHeaderType "header field of no known type";
    FC0505 HeadNotFirst "head that does not open the frame";
    FC0506 HeadLength "head of the wrong length";
    FC0507 HeadsEqual "heads that are the same";
    FC0508 HeaderValue "value that a header field cannot have";
    FC0509 HeaderQuirk "quirk on the wrong header field";
    FC0510 KindPort "kind on the wrong port";
    FC0511 SamePort "ports of one number";
    FC0512 EnvelopeType "envelope key of the wrong type for its role";
    FC0513 ResultInRequest "result in the envelope of requests";
    FC0514 LimitTooSmall "frame limit below the header";
    FC0601 MissingTranslation "text that is missing in one language";
    FC0602 EmptyText "text with nothing in it";
    FC0603 TextSpacing "text with white space around it";
    FC0604 SameText "one text in both languages";
    FC0605 NotChinese "Chinese text without Chinese";
    FC0606 NotEnglish "English text without English";
    FC0607 DatesOutOfOrder "withdrawn before it appeared";
    FC0608 UnknownConflict "answer to a conflict that does not exist";
    FC0609 UnansweredConflict "conflict that nothing answers";
    FC0610 SectionRetained "lost section that an operation comes from";
    FC0611 SectionGap "section of the source that is not accounted for";
    FC0612 LostButStated "fact that is lost and yet stated";
}

impl FaultCode {
    /// The code with this number, in any case, with or without its `FC` and zeros in front.
    #[must_use]
    pub fn parse(number: &str) -> Option<Self> {
        let upper = number.trim().to_ascii_uppercase();
        let digits = upper.strip_prefix("FC").unwrap_or(&upper);
        let padded = format!("FC{digits:0>4}");
        Self::ALL
            .iter()
            .copied()
            .find(|code| code.as_str() == padded)
    }
}

impl std::fmt::Display for FaultCode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}
