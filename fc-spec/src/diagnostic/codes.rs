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
    FC0001 Unreadable "unreadable file or directory";
    FC0002 NotUtf8 "file that is not UTF-8";
    FC0003 TooLarge "file or spec that is too large";
    FC0004 StrayFile "YAML file in the wrong place";
    FC0005 EmptyFile "empty file";
    FC0006 ControlCharacter "invisible control character";
    FC0007 BadYaml "invalid YAML";
    FC0008 Unclosed "unclosed bracket or quote";
    FC0009 Tab "tab outside quotes";
    FC0010 BadIndentation "wrong indentation";
    FC0011 BadEscape "unknown escape";
    FC0012 DuplicateKey "duplicate key";
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
    FC0023 ConflictMarker "unresolved merge conflict";
    FC0024 FullWidth "full-width punctuation";
    FC0025 MissingSpace "colon or dash without a space after it";
    FC0101 UnknownKey "unknown key";
    FC0102 MissingKey "missing required key";
    FC0103 WrongKind "wrong kind of value";
    FC0104 BadBool "boolean other than true or false";
    FC0105 AmbiguousWord "value that YAML parsers disagree about";
    FC0106 LeadingZero "number with leading zeros";
    FC0107 BadInteger "value that is not an integer";
    FC0108 IntegerRange "integer that is too small or too large";
    FC0109 BadWord "word that is not allowed here";
    FC0110 BadName "name that is not snake_case";
    FC0111 BadTypeName "type name that is not PascalCase";
    FC0112 BadCode "malformed code";
    FC0113 BadDate "malformed or nonexistent date";
    FC0114 SectionTwice "duplicate part of the spec";
    FC0115 SectionMissing "missing part of the spec";
    FC0116 MisplacedSection "operations outside `commands/`";
    FC0117 MisplacedKey "key that does not apply here";
    FC0118 BadConflictId "malformed conflict id";
    FC0119 DuplicateNumber "same number written in two ways";
    FC0120 TwoForms "field with two definitions";
    FC0121 BadNumber "value that is not a number";
    FC0122 BadType "malformed type";
    FC0123 ListLength "list with too few or too many items";
    FC0124 MarkerAsKey "wire key that is read as a keyword";
    FC0125 DuplicateItem "duplicate list item";
    FC0126 TextCut "text cut off by a comment";
    FC0127 UnknownUnit "unknown unit";
    FC0201 DuplicateOperation "two operations with the same name";
    FC0202 DuplicateType "two types with the same name";
    FC0203 UnknownType "unknown type";
    FC0204 UnusedType "unused type";
    FC0205 RecursiveType "type that contains itself";
    FC0206 DuplicateFieldName "two fields with the same name in code";
    FC0207 DuplicateWireKey "duplicate wire key in an object";
    FC0208 UnusableName "wire key that gives no name in code";
    FC0209 ReservedName "reserved name";
    FC0210 NotAStruct "type that should be a struct";
    FC0211 UnknownOperation "unknown operation";
    FC0212 DuplicateGroup "two groups with the same id";
    FC0213 EnvelopeKey "envelope key in a body";
    FC0214 DuplicateTable "two tables with the same id";
    FC0215 UnknownResult "unknown result code";
    FC0216 DuplicateName "two names that are the same in code";
    FC0217 BodyTooLarge "body that is too large";
    FC0218 SuccessAsError "success listed as an error";
    FC0219 SharedWord "word that stands for two terms";
    FC0220 UnknownValue "unknown enum value";
    FC0221 NotAReport "operation that should be a report";
    FC0222 UnknownEntity "unknown entity";
    FC0223 UnusedEntity "unused entity";
    FC0224 IdTypes "ids of one entity with different types";
    FC0225 UnknownSibling "condition on a field that is not beside it";
    FC0226 OwnCondition "condition of a field on itself";
    FC0227 UnknownAvailability "unknown audience, hardware or series of releases";
    FC0228 UnusedAvailability "unused audience, hardware or series of releases";
    FC0229 UnknownBodyKey "unknown key of a body";
    FC0230 AmbiguousState "report with two keys that may be its state";
    FC0231 BadMediaType "malformed media type";
    FC0232 StreamContent "stream with a media type for JSON";
    FC0233 NotAnEnum "state of a type that is not an enum";
    FC0234 UnseenState "state that no message of the robot carries";
    FC0235 NotACommand "operation that should be a command";
    FC0236 ComesBeforeItself "command that comes before itself";
    FC0237 UnknownField "unknown field";
    FC0238 UnknownCoordinates "unknown coordinate system";
    FC0239 UnusedCoordinates "unused coordinate system";
    FC0240 UnknownStore "unknown store";
    FC0241 UnusedStore "unused store";
    FC0242 BadWaiver "waiver of something that is not a finding";
    FC0301 DuplicateCode "two operations with the same code";
    FC0302 RetiredCode "retired code";
    FC0303 CodeOutsideRanges "code outside all ranges";
    FC0304 CodeInWrongRange "code in a range for something else";
    FC0305 RangeInverted "range that ends before it starts";
    FC0306 RangesOverlap "overlapping ranges";
    FC0307 DuplicateRetired "code that is retired twice";
    FC0401 ExampleType "example of the wrong type";
    FC0402 ExampleRange "example outside min and max";
    FC0403 ExampleLength "example of the wrong length";
    FC0404 ExamplePattern "example that does not match its pattern";
    FC0405 ExampleValue "example that is not in its enum, or that its field does not take";
    FC0406 MissingExample "required field without an example";
    FC0407 MinAboveMax "min larger than max";
    FC0408 BoundsOnWrongType "min or max on something that is not a number";
    FC0409 BoundsBeyondType "limit outside the range of its type";
    FC0410 LengthOnWrongType "length on a type that has none";
    FC0411 LengthInverted "minimum length larger than maximum";
    FC0412 PatternOnWrongType "pattern on something that is not a string";
    FC0413 BadPattern "invalid regular expression";
    FC0414 DefaultOnRequired "default on a required field";
    FC0415 DefaultType "default of the wrong type, or that its field does not take";
    FC0416 QuirkOnWrongType "quirk that does not apply to the type";
    FC0417 WireOnWrongType "wire form that does not apply to the type";
    FC0418 EnumValueType "enum value of the wrong type";
    FC0419 EmptyEnum "enum or choice without enough values";
    FC0420 SameVariants "unreachable variant";
    FC0421 OpenBodyFields "open body with fields";
    FC0422 RowMismatch "table row of the wrong type";
    FC0423 AbsentRequired "required field left out of examples";
    FC0424 ShortForm "field without a description";
    FC0425 DefaultConstraint "default that breaks a constraint";
    FC0426 OnlyOnWrongType "only on something that is not an enum";
    FC0427 OnlyValue "only with a value that its enum does not have";
    FC0428 OnlyTwice "only with a value twice";
    FC0429 OrderWithoutStates "order without `then`, or `then` without an order";
    FC0430 UnreachedState "state that nothing leads to";
    FC0431 FollowedFinal "final state that something follows";
    FC0432 RefersOnWrongType "reference on a type that cannot be an id";
    FC0433 ConditionOnOptional "condition on an optional field";
    FC0434 ConditionOnWrongType "condition on a field without single values";
    FC0435 ConditionValue "condition on a value that its field cannot have";
    FC0436 ConditionTwice "condition with a value twice";
    FC0437 WhenAndUnless "field with both `when` and `unless`";
    FC0438 LimitsNothing "available that limits nothing";
    FC0439 LimitedButRequired "required key that not everyone has";
    FC0440 LimitBeyondOperation "available to an audience that the operation is not for";
    FC0441 NothingLeft "audience without values or variants";
    FC0442 BadRelease "malformed number of a release";
    FC0443 ReleasesOutOfOrder "last release before the first";
    FC0444 TieType "tie between keys that cannot have the same ID";
    FC0445 NotAState "state in a key that has none";
    FC0446 NoPrecondition "precondition that says nothing";
    FC0447 StateValue "state that its enum does not have";
    FC0448 CadenceRules "cadence without a rule, or with several";
    FC0449 StepOnWrongType "step of something that is not a number";
    FC0450 StepOfNothing "step that its field cannot take";
    FC0451 DeadlineOfNothing "deadline of a report that no command sets off";
    FC0452 CoordinatesOnWrongType "coordinates on something that is not an object";
    FC0453 CoordinatesWithoutLength "coordinates without a length";
    FC0454 CoordinatesTwice "two coordinate systems for one object";
    FC0501 RoleMissing "unassigned role";
    FC0502 RoleTwice "role assigned twice";
    FC0503 HeaderWidth "header field of the wrong width for its role";
    FC0504 BadHeaderType "unknown header field type";
    FC0505 HeadNotFirst "frame that does not start with the head";
    FC0506 HeadLength "head of the wrong length";
    FC0507 HeadsEqual "identical heads";
    FC0508 HeaderValue "value that a header field cannot have";
    FC0509 HeaderQuirk "quirk on the wrong header field";
    FC0510 KindPort "kind on the wrong port";
    FC0511 SamePort "same port used twice";
    FC0512 EnvelopeType "envelope key of the wrong type for its role";
    FC0513 ResultInRequest "result in the envelope of requests";
    FC0514 LimitTooSmall "frame limit below the header";
    FC0515 AlgorithmWithoutDigest "algorithm on a header field without a digest";
    FC0516 AgeWithoutTime "age limit for messages without a time";
    FC0601 MissingTranslation "missing translation";
    FC0602 EmptyText "empty text";
    FC0603 TextSpacing "text with surrounding white space";
    FC0604 SameText "same text in both languages";
    FC0605 NotChinese "Chinese text without Chinese characters";
    FC0606 NotEnglish "English text that is Chinese";
    FC0607 DatesOutOfOrder "deprecated before it was added";
    FC0608 UnknownConflict "answer to an unknown conflict";
    FC0609 UnansweredConflict "unanswered conflict";
    FC0610 SectionRetained "missing section used as a source";
    FC0611 SectionGap "section of the source that is not accounted for";
    FC0612 LostButStated "fact that is marked both missing and stated";
    FC0613 Placeholder "text still to be written";
    FC0614 AnswerToNothing "answer that does not say what it answers";
    FC0615 GovernsNothing "answer about something that is not there";
    FC0616 GovernedFact "fact changed although its question is open";
    FC0617 SettledButUntouched "question settled although its fact is as before";
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
