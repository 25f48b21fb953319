//! The table of error codes. A published code keeps its meaning; a retired code is not used again.
//!
//! To add a code, add a line here, in order, and the files `explain/FC….md` and `explain/FC….zh.md`. A text starts with
//! a paragraph about the error, its reason and its fix. An example with the error follows in a block fenced as `yaml bad`,
//! and the corrected example in one fenced as `yaml good`.
//!
//! Ranges: `FC00xx` YAML itself, `FC01xx` shape (unknown key, missing key, wrong kind, bad scalar), `FC02xx`
//! names and references, `FC03xx` codes, `FC04xx` fields, constraints and examples, `FC05xx` frame,
//! transport, envelope and results, `FC06xx` texts, history and answers. `FC07xx` are the rules of `fcproto diff`, `FC08xx` those of
//! the lint. Each lint rule declares its code next to its search ([`LintCode`]), and has the same two files.

use crate::model::Lang;

/// The code of a lint rule. The number identifies it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LintCode {
    /// Number, such as `FC0801`.
    pub number: &'static str,
    /// Title of a few words, in English and in Chinese.
    pub title: [&'static str; 2],
    /// Reason and fix, in English and in Chinese.
    pub text: [&'static str; 2],
}

impl LintCode {
    /// Returns the title.
    #[must_use]
    pub fn title_in(&self, lang: Lang) -> &'static str {
        let [en, zh] = self.title;
        lang.pick(zh, en)
    }

    /// Returns the reason and the fix.
    #[must_use]
    pub fn text_in(&self, lang: Lang) -> &'static str {
        let [en, zh] = self.text;
        lang.pick(zh, en).trim_end()
    }
}

/// Returns the explanations of a code in `explain`, in English and in Chinese.
macro_rules! explained {
    (@in $language:literal $code:ident) => {
        include_str!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/src/diagnostic/explain/",
            stringify!($code),
            $language
        ))
    };
    ($code:ident) => {
        [
            $crate::diagnostic::explained!(@in ".md" $code),
            $crate::diagnostic::explained!(@in ".zh.md" $code),
        ]
    };
}

pub(crate) use explained;

macro_rules! fault_codes {
    ($($code:ident $variant:ident $zh:literal $en:literal;)+) => {
        /// A code of an error or a lint finding.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[allow(clippy::doc_markdown, reason = "the titles are shown to users, as plain text")]
        pub enum FaultCode {
            $(#[doc = $en] $variant,)+
            /// A finding of a lint rule.
            Lint(&'static LintCode),
        }

        impl FaultCode {
            /// All codes except those of the lint, in order.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Returns the number, such as `FC0012`.
            #[must_use]
            pub const fn as_str(self) -> &'static str {
                match self {
                    $(Self::$variant => stringify!($code),)+
                    Self::Lint(code) => code.number,
                }
            }

            /// Returns a title of a few words.
            #[must_use]
            pub fn title(self, lang: Lang) -> &'static str {
                match self {
                    $(Self::$variant => lang.pick($zh, $en),)+
                    Self::Lint(code) => code.title_in(lang),
                }
            }

            /// Returns the explanation as Markdown: the error, its reason and its fix.
            #[must_use]
            pub fn explain(self, lang: Lang) -> &'static str {
                match self {
                    $(Self::$variant => {
                        let [en, zh] = explained!($code);
                        lang.pick(zh, en)
                    })+
                    Self::Lint(code) => code.text_in(lang),
                }
            }
        }
    };
}

fault_codes! {
    FC0001 Unreadable "文件或目录无法读取" "unreadable file or directory";
    FC0002 NotUtf8 "文件不是 UTF-8" "file that is not UTF-8";
    FC0003 TooLarge "文件或规范过大" "file or spec that is too large";
    FC0004 StrayFile "YAML 文件放错位置" "YAML file in the wrong place";
    FC0005 EmptyFile "空文件" "empty file";
    FC0006 ControlCharacter "不可见的控制字符" "invisible control character";
    FC0007 BadYaml "YAML 无效" "invalid YAML";
    FC0008 Unclosed "括号或引号没有闭合" "unclosed bracket or quote";
    FC0009 Tab "引号之外的制表符" "tab outside quotes";
    FC0010 BadIndentation "缩进错误" "wrong indentation";
    FC0011 BadEscape "未知的转义" "unknown escape";
    FC0012 DuplicateKey "重复的键" "duplicate key";
    FC0013 KeyNotScalar "键不是一个词" "key that is not a word";
    FC0014 Anchor "YAML 锚点" "anchor";
    FC0015 Alias "YAML 别名" "alias";
    FC0016 MergeKey "YAML 合并键" "merge key";
    FC0017 Tag "YAML 标签" "tag";
    FC0018 Directive "YAML 指示" "YAML directive";
    FC0019 SeveralDocuments "一个文件中有第二个文档" "second document in one file";
    FC0020 TooDeep "嵌套过深" "nesting that is too deep";
    FC0021 ScalarTooLong "文本过长" "text that is too long";
    FC0022 TooManyNodes "文件中的值过多" "file with too many values";
    FC0023 ConflictMarker "未解决的合并冲突" "unresolved merge conflict";
    FC0024 FullWidth "全角标点" "full-width punctuation";
    FC0025 MissingSpace "冒号或短横后面缺少空格" "colon or dash without a space after it";
    FC0101 UnknownKey "未知的键" "unknown key";
    FC0102 MissingKey "缺少必填的键" "missing required key";
    FC0103 WrongKind "值的种类不对" "wrong kind of value";
    FC0104 BadBool "布尔值不是 true 或 false" "boolean other than true or false";
    FC0105 AmbiguousWord "不同 YAML 解析器理解不同的值" "value that YAML parsers disagree about";
    FC0106 LeadingZero "数值有前导零" "number with leading zeros";
    FC0107 BadInteger "值不是整数" "value that is not an integer";
    FC0108 IntegerRange "整数过小或过大" "integer that is too small or too large";
    FC0109 BadWord "这里不允许的词" "word that is not allowed here";
    FC0110 BadName "名称不是 snake_case" "name that is not snake_case";
    FC0111 BadTypeName "类型名不是 PascalCase" "type name that is not PascalCase";
    FC0112 BadCode "功能码的写法不对" "malformed code";
    FC0113 BadDate "日期的写法不对或日期不存在" "malformed or nonexistent date";
    FC0114 SectionTwice "规范的某个部分重复" "duplicate part of the spec";
    FC0115 SectionMissing "规范的某个部分缺失" "missing part of the spec";
    FC0116 MisplacedSection "接口不在 commands/ 中" "operations outside `commands/`";
    FC0117 MisplacedKey "键不适用于这里" "key that does not apply here";
    FC0118 BadConflictId "疑问编号的写法不对" "malformed conflict id";
    FC0119 DuplicateNumber "同一个数的两种写法" "same number written in two ways";
    FC0120 TwoForms "字段有两种定义" "field with two definitions";
    FC0121 BadNumber "值不是数值" "value that is not a number";
    FC0122 BadType "类型的写法不对" "malformed type";
    FC0123 ListLength "列表的项数不对" "list with too few or too many items";
    FC0124 MarkerAsKey "被当作关键字的键名" "wire key that is read as a keyword";
    FC0125 DuplicateItem "列表中有重复的项" "duplicate list item";
    FC0126 TextCut "文本被注释截断" "text cut off by a comment";
    FC0127 UnknownUnit "未知的单位" "unknown unit";
    FC0128 MisplacedEntry "接口或类型写在别的部分中" "operation or type in another section";
    FC0129 SplitItem "列表项被短横截成两项" "list item cut in two by a dash";
    FC0201 DuplicateOperation "两个接口同名" "two operations with the same name";
    FC0202 DuplicateType "两个类型同名" "two types with the same name";
    FC0203 UnknownType "未知的类型" "unknown type";
    FC0204 UnusedType "未使用的类型" "unused type";
    FC0205 RecursiveType "包含自身的类型" "type that contains itself";
    FC0206 DuplicateFieldName "两个字段在代码中同名" "two fields with the same name in code";
    FC0207 DuplicateWireKey "一个对象中有重复的键名" "duplicate wire key in an object";
    FC0208 UnusableName "键名无法得出代码中的名称" "wire key without a valid name in code";
    FC0209 ReservedName "保留的名称" "reserved name";
    FC0210 NotAStruct "类型应当是结构" "type that should be a struct";
    FC0211 UnknownOperation "未知的接口" "unknown operation";
    FC0212 DuplicateGroup "两个分组的 id 相同" "two groups with the same id";
    FC0213 EnvelopeKey "消息体中有公共字段" "envelope key in a body";
    FC0214 DuplicateTable "两个常量表的 id 相同" "two tables with the same id";
    FC0215 UnknownResult "未知的结果码" "unknown result code";
    FC0216 DuplicateName "两个名称在代码中相同" "two names that are the same in code";
    FC0217 BodyTooLarge "过大的消息体" "body that is too large";
    FC0218 SuccessAsError "把成功列为错误" "success listed as an error";
    FC0219 SharedWord "一个词属于两条术语" "word that belongs to two terms";
    FC0220 UnknownValue "未知的枚举值" "unknown enum value";
    FC0221 NotAReport "接口应当是上报" "operation that should be a report";
    FC0222 UnknownEntity "未知的实体" "unknown entity";
    FC0223 UnusedEntity "未使用的实体" "unused entity";
    FC0224 IdTypes "同一实体的 ID 类型不同" "ids of one entity with different types";
    FC0225 UnknownSibling "条件所用的字段不在同一个对象中" "condition on a field outside the object";
    FC0226 OwnCondition "字段以自己为条件" "field with a condition on itself";
    FC0227 UnknownAvailability "未知的受众、机型或版本系列" "unknown audience, hardware or series of releases";
    FC0228 UnusedAvailability "未使用的受众、机型或版本系列" "unused audience, hardware or series of releases";
    FC0229 UnknownBodyKey "消息体中没有的键" "unknown key of a body";
    FC0230 AmbiguousState "上报中有两个键可能是状态" "report with two keys that may be its state";
    FC0231 BadMediaType "媒体类型的写法不对" "malformed media type";
    FC0232 StreamContent "数据流用了 JSON 的媒体类型" "stream with a media type for JSON";
    FC0233 NotAnEnum "状态的类型不是枚举" "state of a type that is not an enum";
    FC0234 UnseenState "机器人的消息中没有的状态" "state that no message of the robot carries";
    FC0235 NotACommand "接口应当是指令" "operation that should be a command";
    FC0236 ComesBeforeItself "指令互为先后" "commands in a cycle of `after`";
    FC0237 UnknownField "未知的字段" "unknown field";
    FC0238 UnknownCoordinates "未知的坐标系" "unknown coordinate system";
    FC0239 UnusedCoordinates "未使用的坐标系" "unused coordinate system";
    FC0240 UnknownStore "未知的存储位置" "unknown store";
    FC0241 UnusedStore "未使用的存储位置" "unused store";
    FC0242 BadWaiver "豁免编号的写法不对" "malformed number of a waiver";
    FC0243 UnknownGroup "未知的分组" "unknown group";
    FC0301 DuplicateCode "两个接口的功能码相同" "two operations with the same code";
    FC0302 RetiredCode "退役的功能码" "retired code";
    FC0303 CodeOutsideRanges "功能码不在任何号段中" "code outside all ranges";
    FC0304 CodeInWrongRange "功能码所在的号段另有用途" "code in a range for something else";
    FC0305 RangeInverted "号段的终点在起点之前" "range that ends before it starts";
    FC0306 RangesOverlap "号段重叠" "overlapping ranges";
    FC0307 DuplicateRetired "功能码重复退役" "code that is retired twice";
    FC0401 ExampleType "示例的类型不对" "example of the wrong type";
    FC0402 ExampleRange "示例超出 min 和 max" "example outside min and max";
    FC0403 ExampleLength "示例的长度不对" "example of the wrong length";
    FC0404 ExamplePattern "示例与 pattern 不匹配" "example that does not match its pattern";
    FC0405 ExampleValue "示例不在枚举或 only 中" "example outside its enum or `only`";
    FC0406 MissingExample "必填字段没有示例" "required field without an example";
    FC0407 MinAboveMax "min 大于 max" "min larger than max";
    FC0408 BoundsOnWrongType "不是数值却写了 min 或 max" "min or max on something that is not a number";
    FC0409 BoundsBeyondType "上下限超出类型的范围" "limit outside the range of its type";
    FC0410 LengthOnWrongType "类型没有长度" "length on a type that has none";
    FC0411 LengthInverted "最小长度大于最大长度" "minimum length larger than maximum";
    FC0412 PatternOnWrongType "不是字符串却写了 pattern" "pattern on something that is not a string";
    FC0413 BadPattern "正则表达式无效" "invalid regular expression";
    FC0414 DefaultOnRequired "必填字段写了默认值" "default on a required field";
    FC0415 DefaultType "默认值的类型不对，或不在 only 中" "default of the wrong type or outside `only`";
    FC0416 QuirkOnWrongType "quirk 不适用于这个类型" "quirk that does not apply to the type";
    FC0417 WireOnWrongType "wire 不适用于这个类型" "wire form that does not apply to the type";
    FC0418 EnumValueType "枚举值的类型不对" "enum value of the wrong type";
    FC0419 EmptyEnum "枚举或多选一的取值不够" "enum or choice without enough values";
    FC0420 SameVariants "选项永远匹配不到" "unreachable variant";
    FC0421 OpenBodyFields "标为 open 的消息体写了字段" "open body with fields";
    FC0422 RowMismatch "常量表的行与类型不符" "table row of the wrong type";
    FC0423 AbsentRequired "必填字段在示例中省略" "required field left out of examples";
    FC0424 ShortForm "字段没有说明" "field without a description";
    FC0425 DefaultConstraint "默认值不符合约束" "default that breaks a constraint";
    FC0426 OnlyOnWrongType "不是枚举却写了 only" "`only` on something that is not an enum";
    FC0427 OnlyValue "only 中有枚举没有的值" "`only` with an unknown value";
    FC0428 OnlyTwice "only 中有重复的值" "`only` with a duplicate value";
    FC0429 OrderWithoutStates "order 和 then 只写了一个" "`order` without `then`, or the reverse";
    FC0430 UnreachedState "无法到达的状态" "unreachable state";
    FC0431 FollowedFinal "终态之后还有取值" "final state with a successor";
    FC0432 RefersOnWrongType "refers 用在不能作 ID 的类型上" "reference on a type that cannot be an id";
    FC0433 ConditionOnOptional "以可选字段为条件" "condition on an optional field";
    FC0434 ConditionOnWrongType "以没有单个取值的字段为条件" "condition on a field without single values";
    FC0435 ConditionValue "条件中的值字段不可能取到" "condition on a value that its field cannot have";
    FC0436 ConditionTwice "条件中有重复的值" "condition with a duplicate value";
    FC0437 WhenAndUnless "字段同时写了 when 和 unless" "field with both `when` and `unless`";
    FC0438 LimitsNothing "available 没有限制任何东西" "`available` without a limit";
    FC0439 LimitedButRequired "带 available 的键却是必填" "required key with `available`";
    FC0440 LimitBeyondOperation "面向的受众不在接口的受众之内" "audience outside those of the operation";
    FC0441 NothingLeft "某种受众没有可用的取值或选项" "audience without values or variants";
    FC0442 BadRelease "版本号的写法不对" "malformed release number";
    FC0443 ReleasesOutOfOrder "最后的版本早于最初的版本" "last release before the first";
    FC0444 TieType "相互对应的键不可能是同一个 ID" "tie between keys that cannot hold the same ID";
    FC0445 NotAState "state_in 所指的键没有状态" "`state_in` on a key without states";
    FC0446 NoPrecondition "受理条件为空" "empty precondition";
    FC0447 StateValue "枚举没有的状态" "unknown state of an enum";
    FC0448 CadenceRules "上报时机没有规则或有几条规则" "cadence without a rule, or with several";
    FC0449 StepOnWrongType "不是数值却写了步长" "step on something that is not a number";
    FC0450 StepOfNothing "步长不适用于字段" "step that does not fit its field";
    FC0451 DeadlineOfNothing "上报有期限却没有引起它的指令" "`within_ms` without a command that sets off the report";
    FC0452 CoordinatesOnWrongType "不是对象却写了坐标系" "coordinates on something that is not an object";
    FC0453 CoordinatesWithoutLength "有坐标系却没有长度单位" "coordinates without a unit of length";
    FC0454 CoordinatesTwice "一个对象有两个坐标系" "two coordinate systems for one object";
    FC0501 RoleMissing "角色没有指定" "unassigned role";
    FC0502 RoleTwice "角色重复指定" "role assigned twice";
    FC0503 HeaderWidth "包头字段的宽度与角色不符" "header field of the wrong width for its role";
    FC0504 BadHeaderType "包头字段的类型未知" "unknown header field type";
    FC0505 HeadNotFirst "帧不以帧头开始" "frame that does not start with the head";
    FC0506 HeadLength "帧头的长度不对" "head of the wrong length";
    FC0507 HeadsEqual "帧头相同" "identical heads";
    FC0508 HeaderValue "包头字段不可能取到的值" "value that a header field cannot have";
    FC0509 HeaderQuirk "quirk 用在错误的包头字段上" "quirk on the wrong header field";
    FC0510 KindPort "数据类型所在的端口不对" "kind on the wrong port";
    FC0511 SamePort "同一个端口用了两次" "same port used twice";
    FC0512 EnvelopeType "公共字段的类型与角色不符" "envelope key of the wrong type for its role";
    FC0513 ResultInRequest "请求的公共字段中有结果" "result in the envelope of requests";
    FC0514 LimitTooSmall "上限放不下规范的报文" "limit too small for the messages";
    FC0515 AlgorithmWithoutDigest "不是摘要的包头字段写了 algorithm" "algorithm on a header field without a digest";
    FC0516 AgeWithoutTime "消息没有时间却有有效期" "age limit for messages without a time";
    FC0601 MissingTranslation "缺少译文" "missing translation";
    FC0602 EmptyText "空文本" "empty text";
    FC0603 TextSpacing "文本首尾有空白" "text with surrounding white space";
    FC0604 SameText "两种语言的文本相同" "same text in both languages";
    FC0605 NotChinese "中文文本没有汉字" "Chinese text without Chinese characters";
    FC0606 NotEnglish "英文文本是中文" "English text written in Chinese";
    FC0607 DatesOutOfOrder "弃用早于加入" "deprecated before it was added";
    FC0608 UnknownConflict "答复了未知的疑问" "answer to an unknown conflict";
    FC0609 UnansweredConflict "没有答复的疑问" "unanswered conflict";
    FC0610 MissingSectionUsed "缺失的章节被写作出处" "missing section used as a source";
    FC0611 SectionGap "源文档的章节既未使用，也未列为缺失" "section of the source that is neither used nor listed";
    FC0612 LostButStated "同一项内容既标为缺失，又当作已写明" "fact that is marked both missing and stated";
    FC0613 Placeholder "待写的文本" "text still to be written";
    FC0614 AnswerToNothing "答复没有 ids，也没有 about" "answer without `ids` and `about`";
    FC0615 GovernsNothing "答复涉及的内容不存在" "answer about something that does not exist";
    FC0616 GovernedFact "问题未确认而内容已改" "fact changed although its question is open";
    FC0617 SettledButUntouched "问题已确认而内容未改" "question settled although its fact has not changed";
    FC0618 HiddenCharacter "文本中有看不见的字符" "invisible character in a text";
}

impl FaultCode {
    /// Errors about declared things: a name without a declaration, and a declaration without a use.
    pub(crate) const DECLARED: [[Self; 2]; 5] = [
        [Self::UnknownAvailability, Self::UnusedAvailability],
        [Self::UnknownType, Self::UnusedType],
        [Self::UnknownEntity, Self::UnusedEntity],
        [Self::UnknownStore, Self::UnusedStore],
        [Self::UnknownCoordinates, Self::UnusedCoordinates],
    ];

    /// Returns the code with this number. Case, the prefix `FC` and leading zeros make no difference.
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
