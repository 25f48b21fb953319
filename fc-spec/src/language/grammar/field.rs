//! Types, bodies and fields.

use super::common::{BothLanguages, COMMON, FieldDeprecated, TEXT};
use super::coordinates::CoordinateSystem;
use super::entity::Entity;
use super::form::{
    Body, Bool, Entries, EnumType, Int, Json, List, Name, Number, OtherForm, Scalar, Str, Type,
    TypeName, Unit, WireKey,
};
use super::kind::{Kind, Table};
use super::refers::Ref;
use crate::syntax::Node;
use crate::vocabulary::{Quirk, StateOrder};

/// The long forms of a field, each with the key that marks it.
pub(crate) const FIELD_FORMS: [(&str, &Table); 4] = [
    (FIELD.r#type.name, Field::TABLE),
    (OBJECT.fields.name, Object::TABLE),
    (ITEMS.items.name, Items::TABLE),
    (CHOICE.one_of.name, Choice::TABLE),
];

/// A field: a short type, one of the longhand forms, or an inline object.
pub(crate) static FIELD_KIND: Kind = Kind::Either(&[
    Kind::Type,
    Kind::ByKey {
        tables: &FIELD_FORMS,
        otherwise: &Kind::Body,
    },
]);

/// The form of a condition: for each field, one value or a list of possible values.
type Condition = Entries<WireKey, (Scalar, List<Scalar, 1>), 1>;

/// An exact length, or minimum and maximum.
type Length = (Int<u32>, List<Int<u32>, 2, 2>);

grammar! {
    /// A field of a JSON object.
    /// JSON 对象的一个字段。
    FIELD: Field = "field" "字段" {
        /// Its type, followed by `?` if the field is optional.
        /// 类型；可选字段在后面加 `?`。
        required r#type: Type, example "u16?";
        /// `true` if it may be absent.
        /// 写 `true` 表示可以没有。
        optional optional: Bool, default "false";
        /// Condition: other fields of the object, each with the values that are sent; all must match. An optional field is present only then. A required field is valid only then.
        /// 条件：同一个对象的其他字段，各写须发送的值，须全部符合。可选字段只在这时出现；必填字段总是出现，但只在这时有效。
        optional when: Condition,
            example "{ mode: 1 }",
            faults [UnknownSibling, OwnCondition, ConditionOnOptional, ConditionOnWrongType, ConditionValue, ConditionTwice];
        /// The opposite of `when`: the field is present, or valid, unless all of these match.
        /// 与 `when` 相反：全部符合时没有这个字段，或者无效。
        optional unless: Condition,
            example "{ mode: [0, 2] }",
            faults [UnknownSibling, OwnCondition, ConditionOnOptional, ConditionOnWrongType, ConditionValue, ConditionTwice, WhenAndUnless];
        /// The values of an enum that this field takes, in the form that is sent. Any other value is refused, even if the enum is open.
        /// 这个字段只取枚举的哪些值，按发送的形式书写；其他的值一律拒收，开放的枚举也不例外。
        optional only: List<Scalar, 1>, example "[0, 1]", faults [OnlyOnWrongType, OnlyValue, OnlyTwice, NothingLeft];
        use COMMON.available;
        /// The entity that its value identifies, or each value of its list; declared under `entities`.
        /// 它的值（列表则为每一项）是哪种实体的 ID；实体在 `entities` 中声明。
        optional refers: Ref<Entity>, example "station", faults [UnknownEntity, RefersOnWrongType];
        use COMMON.kept, COMMON.name;
        /// Other wire keys that the decoder accepts for it.
        /// 解析时还接受哪些键名。
        optional also: List<Str, 1>, example "[id]", faults [DuplicateWireKey];
        /// Form in which it is sent, if that differs from its type.
        /// 发送的形式；与类型不同时才写。
        optional wire: OtherForm, faults [WireOnWrongType];
        /// The coordinate system of its positions; declared under `coordinates`.
        /// 其中的位置以哪个坐标系为准；坐标系在 `coordinates` 中声明。
        optional coordinates: Ref<CoordinateSystem>,
            example "map",
            faults [UnknownCoordinates, CoordinatesOnWrongType, CoordinatesWithoutLength, CoordinatesTwice];
        use COMMON.since;
        /// Smallest value of a number.
        /// 数值的最小值。
        optional min: Number, example "0", faults [MinAboveMax, BoundsOnWrongType, BoundsBeyondType];
        /// Largest value of a number.
        /// 数值的最大值。
        optional max: Number, example "100", faults [BoundsOnWrongType, BoundsBeyondType];
        /// Characters of a string, bytes of a base64 value or items of a list: an exact number, or minimum and maximum.
        /// 字符串的字符数、base64 的字节数或列表的项数：写一个数，或写最小值和最大值。
        optional length: Length, example "[1, 20]", faults [LengthOnWrongType, LengthInverted];
        /// Regular expression that the whole string must match.
        /// 正则表达式，整个字符串都要匹配。
        optional pattern: Str, example r#""[A-Z]{2}[0-9]+""#, faults [PatternOnWrongType, BadPattern];
        /// Unit, such as `m`, `rad`, `ms`.
        /// 单位，例如 `m`、`rad`、`ms`。
        optional unit: Unit, example "mm";
        /// Leniencies of the decoder; the encoder has none.
        /// 解析时的放宽处理；发送时不放宽。
        optional quirk: List<Quirk, 1>, faults [QuirkOnWrongType];
        /// Value that the receiver uses if the field is absent. It is in the documentation and the code, and is not sent.
        /// 没有这个字段时接收方采用的值；写进文档和代码，不发送。
        optional default: Scalar, example "0", faults [DefaultOnRequired, DefaultType, DefaultConstraint];
        /// Never shown in logs.
        /// 不写进日志。
        optional sensitive: Bool, default "false";
        /// Value in generated examples, in the form that is sent; `absent` leaves an optional field out.
        /// 示例中的值，按发送的形式书写；写 `absent` 时，示例中不出现这个可选字段。
        optional example: Json,
            example "7",
            faults [ExampleType, ExampleRange, ExampleLength, ExamplePattern, ExampleValue, AbsentRequired];
        use TEXT.zh, TEXT.en;
        /// Additional notes, such as special values and origin.
        /// 补充说明，例如特殊取值、出处。
        optional note: BothLanguages;
        /// Deprecated.
        /// 已弃用。
        optional deprecated: FieldDeprecated;
        use COMMON.answers;
    }

    /// A field that holds an inline object.
    /// 内嵌对象字段。
    OBJECT: Object = "inline object" "内嵌对象" {
        use FIELD.optional, FIELD.when, FIELD.unless, COMMON.available, COMMON.kept, COMMON.name, FIELD.also;
        /// Name of its type in code, if the one derived from its keys is not suitable.
        /// 它的类型在代码中的名称；由各级键名得出的名称不合适时才写。
        optional type_name: TypeName, example "MapHeader";
        use FIELD.coordinates, COMMON.since, FIELD.quirk, FIELD.sensitive, FIELD.example;
        // The key `data` has a default text, so that the table cannot ask for one; a check does.
        /// In Chinese; only `data` may leave it out.
        /// 中文；只有 `data` 可以不写。
        optional zh: Str, example "地图信息", faults [EmptyText, HiddenCharacter, TextSpacing, NotChinese, Placeholder];
        /// In English; only `data` may leave it out.
        /// 英文；只有 `data` 可以不写。
        optional en: Str, example "About the map", faults [EmptyText, HiddenCharacter, TextSpacing, SameText, NotEnglish, Placeholder];
        use FIELD.note, FIELD.deprecated;
        /// Its keys, in the order sent.
        /// 它的键，按发送的顺序书写。
        required fields: Body;
        use COMMON.answers;
    }

    /// A field that holds a list of inline objects.
    /// 内嵌对象列表字段。
    ITEMS: Items = "inline list" "内嵌列表" {
        use FIELD.optional, FIELD.when, FIELD.unless, COMMON.available, COMMON.kept, COMMON.name, FIELD.also, OBJECT.type_name,
            FIELD.coordinates, COMMON.since, FIELD.length, FIELD.quirk, FIELD.sensitive, FIELD.example, OBJECT.zh, OBJECT.en, FIELD.note,
            FIELD.deprecated;
        /// Keys of each item, in the order sent.
        /// 每一项的键，按发送的顺序书写。
        required items: Body;
        use COMMON.answers;
    }

    /// A field that holds one of several objects, distinguished by their keys. An object that matches none is refused.
    /// 在几种对象中取其一的字段，靠键区分；都不符合的拒收。
    CHOICE: Choice = "inline choice" "内嵌多选一" {
        use FIELD.optional, FIELD.when, FIELD.unless, COMMON.available, COMMON.kept, COMMON.name, FIELD.also, OBJECT.type_name,
            COMMON.since, FIELD.quirk, FIELD.sensitive, FIELD.example, OBJECT.zh, OBJECT.en, FIELD.note, FIELD.deprecated;
        /// The objects, in the order of matching.
        /// 各种对象，按匹配的顺序书写。
        required one_of: Entries<Name, Variant>, faults [EmptyEnum, SameVariants];
        use COMMON.answers;
    }

    /// A variant that is a struct declared elsewhere.
    /// 用已声明的结构作为一种对象。
    NAMED_VARIANT: NamedVariant = "variant" "选项" {
        /// Its struct.
        /// 它的结构。
        required r#type: Ref<Struct>, example "Station", faults [UnknownType, RecursiveType, NotAStruct];
        use COMMON.available, TEXT.zh, TEXT.en, FIELD.deprecated;
    }

    /// An inline variant.
    /// 内嵌的一种对象。
    _: InlineVariant = "inline variant" "内嵌选项" {
        use OBJECT.type_name, COMMON.available, TEXT.zh, TEXT.en, FIELD.deprecated, OBJECT.fields;
    }

    /// An object with known keys; unknown keys are kept.
    /// 键已知的对象；未知的键原样保留。
    _: Struct = "struct" "结构" {
        use TEXT.zh, TEXT.en, COMMON.about, FIELD.coordinates, COMMON.since, OBJECT.fields, COMMON.changes, COMMON.answers;
    }

    /// A choice of named values.
    /// 一组命名的取值。
    ENUM: Enum = "enum" "枚举" {
        /// Type in which the values are sent.
        /// 发送时取值的类型。
        required r#enum: EnumType;
        /// `true`: an unknown value is an error instead of being kept.
        /// 写 `true` 时，未知的值算错误，不予保留。
        optional closed: Bool, default "false";
        use TEXT.zh, TEXT.en, COMMON.about, COMMON.since;
        /// Meaning of `then`, if the values are states of a process: the normal order, or all changes.
        /// 取值是一个过程的各个状态时，`then` 的含义：正常顺序，还是全部切换。
        optional order: StateOrder, faults [OrderWithoutStates];
        /// Its values, each under the value that is sent.
        /// 各个取值，以发送的值为键。
        required values: Entries<Scalar, EnumValue>, faults [EnumValueType, EmptyEnum, UnreachedState];
        use COMMON.changes, COMMON.answers;
    }

    /// A value of an enum.
    /// 枚举的一个取值。
    ENUM_VALUE: EnumValue = "enum value" "枚举值" {
        /// Name in code.
        /// 代码中的名称。
        required name: Name, example "moving", faults [DuplicateName];
        /// `true` if the process begins here.
        /// 写 `true` 表示过程从这里开始。
        optional start: Bool, default "false";
        /// Names of the values that can follow it. The `order` of the enum gives the meaning of the list.
        /// 接在它后面的取值的名称；这个列表的含义由枚举的 `order` 决定。
        optional then: List<Ref<EnumValue>, 1>,
            example "[arrived, failed]",
            faults [UnknownValue, OrderWithoutStates, FollowedFinal];
        /// `true` if the process ends here: no value follows.
        /// 写 `true` 表示过程到此结束，其后没有别的取值。
        optional r#final: Bool, default "false";
        /// `true` if it means that something failed.
        /// 写 `true` 表示失败或异常。
        optional error: Bool, default "false";
        use COMMON.available, COMMON.since, TEXT.zh, TEXT.en;
    }

    /// A choice of objects, distinguished by their keys. An object that matches none is refused.
    /// 在几种对象中取其一，靠键区分；都不符合的拒收。
    _: OneOf = "choice" "多选一" {
        use TEXT.zh, TEXT.en, COMMON.about, COMMON.since, CHOICE.one_of, COMMON.changes, COMMON.answers;
    }

    /// A published table of constants.
    /// 公布的常量表。
    TABLE: Constants = "table" "常量表" {
        use TEXT.zh, TEXT.en, COMMON.about, COMMON.kept;
        /// Struct of a row.
        /// 一行的结构。
        required row: Ref<Struct>, example "Station", faults [NotAStruct];
        /// Rows, in the form that is sent.
        /// 各行，按发送的形式书写。
        required rows: List<Json>, example "[{ id: 1, name: dock }]", faults [RowMismatch];
        use COMMON.answers;
    }
}

forms! {
    /// An object of a choice, declared elsewhere or in place.
    Variant: Kind::ByKey {
        tables: &[
            (NAMED_VARIANT.r#type.name, NamedVariant::TABLE),
            (OBJECT.fields.name, InlineVariant::TABLE),
        ],
        otherwise: &InlineVariant::KIND,
    } => Node<'a>, Some;
    /// A declared type.
    TypeDef: Kind::ByKey {
        tables: &[
            (ENUM.r#enum.name, Enum::TABLE),
            (CHOICE.one_of.name, OneOf::TABLE),
            (OBJECT.fields.name, Struct::TABLE),
        ],
        otherwise: &Struct::KIND,
    } => Node<'a>, Some;
}
