//! Python.

use super::{Case, Language, Role, Words};

/// Python with plain integers and strings as ids.
pub static PYTHON: Language = python(Some(&PYTHON_WITH_IDS));

/// Python with an id type for each entity: `newtypes: true` in `fc.yaml`.
static PYTHON_WITH_IDS: Language = python(None);

/// Builds the rules of Python.
///
/// The keywords exclude soft ones. They include built-in types and types of the runtime that annotations use, because a
/// field or method with that name would hide them. The types are built-in types and exceptions that look like type
/// names, and those of the generated package.
const fn python(with_ids: Option<&'static Language>) -> Language {
    Language {
        name: "python",
        title: "Python",
        case: |role| match role {
            Role::Type => Case::Pascal,
            Role::Value => Case::Screaming,
            Role::Field | Role::Method | Role::Module | Role::Function => Case::Snake,
        },
        keywords: Words::new(
            "False None True and as assert async await bool break bytes class continue def del elif else except finally float \
        for from global if import in int is lambda list nonlocal not or pass raise return rt str try while with yield",
        ),
        types: Words::new(
            "ABC Annotated Any AnyReport ArithmeticError AssertionError AttributeError BaseException ClassVar Client \
        ConnectionError Dict EOFError Ellipsis Enum ExampleRobot Exception False Final IndexError IntEnum KeyError List \
        LookupError MemoryError NameError NewType None NotImplemented NotImplementedError OSError Optional OverflowError \
        PartialRobot PermissionError Reporter RequestEnvelope ResponseEnvelope ResultCode Robot RuntimeError \
        StopIteration Streamer Streams SyntaxError SystemError TimeoutError True TypeAlias TypeError Union UserWarning \
        ValueError Warning",
        ),
        fields: Words::new("checked example extra field from_json property self to_json validate"),
        methods: Words::new(
            "abstractmethod call close closed connect connect_lazy connection counters data handlers_by_code messages \
        operations protocol raw_handler reports self server state states unknown wait",
        ),
        escape: |_, word| Some(format!("{word}_")),
        group_types: &[],
        has_file_per_type: false,
        has_id_types: with_ids.is_none(),
        with_ids,
        has_field_types: false,
    }
}
