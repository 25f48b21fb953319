//! Python.

use super::{Case, Language, Role, Words};

/// With the ids of all entities as plain integers and texts.
pub static PYTHON: Language = python(false);

/// With a type for the ids of each entity: `newtypes: true` in `fc.yaml`.
pub static PYTHON_WITH_IDS: Language = python(true);

/// Keywords, soft ones not included; the names of built-in types that annotations of fields, parameters and results use,
/// and with them the runtime's, since a field or method of that name would stand in their way; the built-in types and
/// exceptions whose names look like those of a type, and those of the generated package.
const fn python(has_id_types: bool) -> Language {
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
        has_id_types,
        has_field_types: false,
    }
}
