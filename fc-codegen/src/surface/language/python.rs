//! Python.

use super::{Case, Language, Role, Words};

/// Keywords, soft ones not included; the built-in types and exceptions whose names look like those of a type.
pub static PYTHON: Language = Language {
    name: "python",
    title: "Python",
    case: |role| match role {
        Role::Type => Case::Pascal,
        Role::Value => Case::Screaming,
        Role::Field | Role::Method | Role::Module | Role::Function => Case::Snake,
    },
    keywords: Words::new(
        "False None True and as assert async await break class continue def del elif else except finally for \
        from global if import in is lambda nonlocal not or pass raise return try while with yield",
    ),
    types: Words::new(
        "Any ArithmeticError AssertionError AttributeError BaseException Client ConnectionError Dict EOFError \
        Ellipsis Enum Exception False IndexError IntEnum KeyError List LookupError MemoryError NameError \
        None NotImplemented NotImplementedError OSError Optional OverflowError PermissionError ResultCode \
        Robot RuntimeError StopIteration SyntaxError SystemError TimeoutError True TypeError Union \
        UserWarning ValueError Warning",
    ),
    fields: Words::new("self"),
    methods: Words::new("self"),
    escape: |_, word| Some(format!("{word}_")),
    has_file_per_type: false,
    has_id_types: false,
};
