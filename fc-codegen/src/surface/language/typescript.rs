//! TypeScript.

use super::{Case, Language, Role, Words};

/// Reserved words; the types of the language and of its library that every file has. A field may have any name.
pub static TYPESCRIPT: Language = Language {
    name: "typescript",
    title: "TypeScript",
    case: |role| match role {
        Role::Type | Role::Value => Case::Pascal,
        Role::Field | Role::Method | Role::Function => Case::Camel,
        Role::Module => Case::Snake,
    },
    keywords: Words::new(
        "any arguments as async await boolean break case catch class const constructor continue debugger \
        declare default delete do else enum eval export extends false finally for from function get if \
        implements import in instanceof interface is keyof let module namespace never new null number object \
        of package private protected public readonly require return set static string super switch symbol \
        this throw true try type typeof undefined unique unknown var void while with yield",
    ),
    types: Words::new(
        "Array ArrayBuffer BigInt Boolean Client DataView Date Error Exclude Extract Float32Array \
        Float64Array Function Infinity Int16Array Int32Array Int8Array Intl Iterable Iterator JSON Map Math \
        NaN NonNullable Number Object Omit Parameters Partial Pick Promise Proxy Readonly Record RegExp \
        Required ResultCode ReturnType Robot Set String Symbol Uint16Array Uint32Array Uint8Array WeakMap \
        WeakSet",
    ),
    fields: Words::new("constructor prototype toString valueOf"),
    methods: Words::new("constructor prototype toString valueOf"),
    escape: |_, word| Some(format!("{word}_")),
    has_file_per_type: false,
    has_id_types: false,
};
