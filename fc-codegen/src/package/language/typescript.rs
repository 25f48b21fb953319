//! TypeScript.

use super::{Case, Language, Role, Words};

/// TypeScript with plain integers and strings as ids.
pub static TYPESCRIPT: Language = typescript(Some(&TYPESCRIPT_WITH_IDS));

/// TypeScript with an id type for each entity: `newtypes: true` in `fc.yaml`.
static TYPESCRIPT_WITH_IDS: Language = typescript(None);

/// Builds the rules of TypeScript.
///
/// The keywords include the imports of the files of constants, and the file that every folder has. Fields may use any
/// of these words. The types are those of the language, of its library and of the package's root. The members are those
/// that every object has.
const fn typescript(with_ids: Option<&'static Language>) -> Language {
    Language {
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
            implements import in index instanceof interface is keyof let messages module namespace never new null \
            number object of package private protected public readonly require return schemas set static string super \
            switch symbol this throw true try type typeof undefined unique unknown var void while with yield",
        ),
        types: Words::new(
            "AnyReport Array ArrayBuffer BigInt Boolean Client DataView Date Error ExampleRobot Exclude Extract \
            Float32Array Float64Array Function Infinity Int16Array Int32Array Int8Array Intl Iterable Iterator JSON Map \
            Math NaN NonNullable Number Object Omit Parameters Partial PartialRobot Pick Promise Proxy Readonly Record \
            RegExp Reporter RequestEnvelope Required ResponseEnvelope ResultCode ReturnType Robot Set Streamer Streams \
            String Symbol Uint16Array Uint32Array Uint8Array Unknown WeakMap WeakSet",
        ),
        fields: Words::new(
            "constructor extra hasOwnProperty isPrototypeOf propertyIsEnumerable prototype toLocaleString toString \
            valueOf",
        ),
        methods: Words::new(
            "begin call callAny callRaw close closed closedBy connect connectLazy connection constructor core counters data \
            hasOwnProperty inFlight isPrototypeOf on pretendMotion propertyIsEnumerable prototype reports server state \
            states then toLocaleString toString valueOf",
        ),
        escape: |role, word| match (role, word) {
            (Role::Field | Role::Value, "constructor") | (Role::Module, "index") => {
                Some(format!("{word}_"))
            }
            // Keys of objects and names of files may be keywords.
            (Role::Field | Role::Value | Role::Module, word) => Some(word.to_owned()),
            (_, word) => Some(format!("{word}_")),
        },
        group_types: &[],
        has_file_per_type: false,
        has_id_types: with_ids.is_none(),
        with_ids,
        has_field_types: false,
    }
}
