//! The forms of a value: each is a type with the kind that the grammar requires and the Rust type that the reader returns.

use super::kind::Kind;
use super::{field, operation};
use crate::language::scalar;
use crate::model::{self, BodyState, Effect, EnumRepr, Fact, HeaderType, Lang, WireForm};
use crate::syntax::{Entries as NodeEntries, Node};
use crate::vocabulary::{IntKind, Meaning, Word};
use std::marker::PhantomData;

/// The form of a value.
pub(crate) trait Form {
    /// The kind that the grammar requires.
    const KIND: Kind;
    /// The Rust type of the value.
    type Value<'a>;

    /// Returns the value of a node. `None` for a malformed value, which has been reported.
    fn read(node: Node<'_>) -> Option<Self::Value<'_>>;
}

forms! {
    /// Any string.
    Str: Kind::Text => String, scalar::text;
    /// `true` or `false`.
    Bool: Kind::Bool => bool, scalar::bool;
    /// An integer or a decimal fraction.
    Number: Kind::Number => model::Number, scalar::number;
    /// A bool, a number or a string.
    Scalar: Kind::Scalar => model::Scalar, scalar::scalar;
    /// Any JSON value.
    Json: Kind::Json => model::Value, |node| Some(scalar::value(node));
    /// A code of an operation, with its spelling.
    Code: Kind::Code => (u16, String), |node| scalar::code(node).zip(scalar::text(node));
    /// A month or a day.
    Date: Kind::Date => String, scalar::text;
    /// A name in code.
    Name: Kind::Name => String, scalar::text;
    /// The name of a declared type.
    TypeName: Kind::TypeName => String, scalar::text;
    /// A type, and `true` if it has the mark of an optional field.
    Type: Kind::Type => (model::Type, bool), scalar::field_type;
    /// Id of a conflict.
    ConflictId: Kind::ConflictId => String, scalar::text;
    /// A media type.
    MediaType: Kind::MediaType => String, scalar::text;
    /// A unit of measurement.
    Unit: Kind::Unit => String, scalar::text;
    /// A key of a JSON object or a name from the source document.
    WireKey: Kind::WireKey => String, scalar::text;
    /// A language of texts.
    LangName: Kind::Word(&[
        ("zh", "Chinese.", "中文。"),
        ("en", "English.", "英文。"),
    ]) => Lang, |node: Node<'_>| match node.as_str()? {
        "zh" => Some(Lang::Zh),
        "en" => Some(Lang::En),
        _ => None,
    };
    /// The level of a lint rule.
    LevelName: Kind::Word(&[
        ("off", "The findings are not shown.", "不显示提示。"),
        ("warning", "The findings are shown.", "显示提示。"),
        ("error", "The findings are shown, and the lint fails.", "显示提示，检查失败。"),
    ]) => String, scalar::text;
    /// The kind of things that a rule of the project tests.
    TestedKind: Kind::Word(&[
        ("operation", "Commands, reports and streams.", "指令、上报和数据流。"),
        ("type", "Structs, enums and choices.", "结构、枚举和多选一。"),
        (operation::Command::NAME, "Commands.", "指令。"),
        (operation::Report::NAME, "Reports.", "上报。"),
        (operation::Stream::NAME, "Streams.", "数据流。"),
        (field::Struct::NAME, "Structs.", "结构。"),
        (field::Enum::NAME, "Enums.", "枚举。"),
        (field::OneOf::NAME, "Choices.", "多选一。"),
        (operation::Group::NAME, "Groups.", "分组。"),
        (field::Field::NAME, "Fields.", "字段。"),
        (field::EnumValue::NAME, "Values of enums.", "枚举的取值。"),
        (field::NamedVariant::NAME, "Variants of choices.", "多选一的选项。"),
    ]) => String, scalar::text;
    /// The word for a missing code.
    Unassigned: Kind::Word(&[(
        "unassigned",
        "No code yet: types and documentation are generated, but it cannot be sent.",
        "还没有功能码：照常生成类型和文档，但不能发送。",
    )]) => (), |_| Some(());
    /// Any state.
    AnyState: Kind::Word(&[("any", "In any state.", "任何状态下。")]) => (), |_| Some(());
    /// An age without a limit.
    Never: Kind::Word(&[("never", "No message is too old.", "消息永不过期。")]) => (), |_| Some(());
    /// A wire form that differs from the type.
    OtherForm: Kind::Word(&[WireForm::String.entry(), WireForm::Number.entry()]) => WireForm, word;
    /// The state of a fact.
    FactState: Kind::Word(&[BodyState::Stated.entry(), BodyState::Inferred.entry()]) => BodyState, word;
    /// A fact that the source document may lack.
    SourceFact: Kind::Word(&[
        Fact::Title.entry(),
        (
            Fact::Type.name(),
            "The type byte; it is inferred from the other operations of the kind.",
            "数据类型；由同类的其他接口推断。",
        ),
        Fact::Code.entry(),
        Fact::Request.entry(),
        Fact::Response.entry(),
    ]) => Fact, word;
    /// The state of a body.
    State: Kind::Word(&[
        (
            BodyState::Inferred.name(),
            "The source gives evidence for the body.",
            "源文档中有这个消息体的依据。",
        ),
        (
            BodyState::Open.name(),
            "The body is missing: no keys are known, and receivers keep every key.",
            "消息体缺失：不知道有哪些键，收到的键都原样保留。",
        ),
        (
            BodyState::Free.name(),
            "The body may have any keys, by design; receivers keep every key.",
            "有意不限定键：收到的键都原样保留。",
        ),
    ]) => BodyState, word;
    /// An effect with evidence in the source document.
    KnownEffect: Kind::Word(&[
        Effect::Read.entry(),
        Effect::Config.entry(),
        Effect::Motion.entry(),
    ]) => Effect, word;
    /// The type of a header field.
    HeaderWidth: Kind::Either(&[
        Kind::Word(&[
            (IntKind::U8.name(), "One byte.", "1 字节。"),
            (IntKind::U16.name(), "Two bytes.", "2 字节。"),
            (IntKind::U32.name(), "Four bytes.", "4 字节。"),
            (IntKind::U64.name(), "Eight bytes.", "8 字节。"),
        ]),
        Kind::Text,
    ]) => HeaderType, |node: Node<'_>| node.as_str()?.parse().ok();
    /// A body or object: wire keys and their fields.
    Body: Kind::Body => NodeEntries<'a>, Node::as_mapping;
    /// The type of the values of an enum, as sent.
    EnumType: Kind::Word(&[
        integer(IntKind::U8),
        integer(IntKind::U16),
        integer(IntKind::U32),
        integer(IntKind::U64),
        integer(IntKind::I8),
        integer(IntKind::I16),
        integer(IntKind::I32),
        integer(IntKind::I64),
        ("string", "A text.", "文本。"),
    ]) => EnumRepr, |node: Node<'_>| node.as_str()?.parse().ok();
}

const fn integer(kind: IntKind) -> Meaning {
    (kind.name(), "An integer.", "整数。")
}

fn word<W: Word>(node: Node<'_>) -> Option<W> {
    W::named(node.as_str()?)
}

/// A word of a closed set.
impl<W: Word> Form for W {
    const KIND: Kind = Kind::Word(W::WORDS);
    type Value<'a> = W;

    fn read(node: Node<'_>) -> Option<W> {
        word(node)
    }
}

/// An integer that fits `T`, from `MIN` to `MAX`.
#[derive(Debug)]
pub(crate) struct Int<T, const MIN: i128 = 0, const MAX: i128 = { i128::MAX }>(PhantomData<T>);

/// A Rust integer type.
pub(crate) trait Whole: TryFrom<i128> {
    /// The greatest value.
    const MAX: i128;
}

macro_rules! whole {
    ($($Int:ident)+) => { $(
        impl Whole for $Int {
            const MAX: i128 = $Int::MAX as i128;
        }
    )+ };
}

whole! { u8 u16 u32 u64 i64 }

impl<T: Whole, const MIN: i128, const MAX: i128> Form for Int<T, MIN, MAX> {
    const KIND: Kind = Kind::Int {
        min: MIN,
        max: if MAX < T::MAX { MAX } else { T::MAX },
    };
    type Value<'a> = T;

    fn read(node: Node<'_>) -> Option<T> {
        scalar::small_int(node)
    }
}

/// A result code: a signed 64-bit integer.
pub(crate) type ResultNumber = Int<i64, { i64::MIN as i128 }>;

/// A list of at least `MIN` and at most `MAX` items.
#[derive(Debug)]
pub(crate) struct List<F, const MIN: usize = 0, const MAX: usize = { usize::MAX }>(PhantomData<F>);

impl<F: Form, const MIN: usize, const MAX: usize> Form for List<F, MIN, MAX> {
    const KIND: Kind = Kind::List {
        of: &F::KIND,
        min: MIN,
        max: MAX,
    };
    type Value<'a> = Vec<F::Value<'a>>;

    fn read(node: Node<'_>) -> Option<Self::Value<'_>> {
        Some(node.items().filter_map(F::read).collect())
    }
}

/// A mapping with freely chosen keys, at least `MIN`.
#[derive(Debug)]
pub(crate) struct Entries<K, F, const MIN: usize = 0>(PhantomData<(K, F)>);

impl<K: Form, F: Form, const MIN: usize> Form for Entries<K, F, MIN> {
    const KIND: Kind = Kind::Entries {
        key: &K::KIND,
        value: &F::KIND,
        min: MIN,
    };
    type Value<'a> = NodeEntries<'a>;

    fn read(node: Node<'_>) -> Option<NodeEntries<'_>> {
        node.as_mapping()
    }
}

/// One of two forms. The reader inspects the node to find out which.
impl<A: Form, B: Form> Form for (A, B) {
    const KIND: Kind = Kind::Either(&[A::KIND, B::KIND]);
    type Value<'a> = Node<'a>;

    fn read(node: Node<'_>) -> Option<Node<'_>> {
        Some(node)
    }
}

/// One of three forms.
impl<A: Form, B: Form, C: Form> Form for (A, B, C) {
    const KIND: Kind = Kind::Either(&[A::KIND, B::KIND, C::KIND]);
    type Value<'a> = Node<'a>;

    fn read(node: Node<'_>) -> Option<Node<'_>> {
        Some(node)
    }
}
