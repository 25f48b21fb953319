//! Java.

use super::{Case, Language, Role, Words};

/// Java with plain integers and strings as ids.
pub static JAVA: Language = java(Some(&JAVA_WITH_IDS));

/// Java with an id type for each entity: `newtypes: true` in `fc.yaml`.
static JAVA_WITH_IDS: Language = java(None);

/// Builds the rules of Java.
///
/// The keywords include literals (JLS 3.9) and contextual keywords that a type cannot use. The types are those of
/// `java.lang` that a stub uses.
const fn java(with_ids: Option<&'static Language>) -> Language {
    Language {
        name: "java",
        title: "Java",
        case: |role| match role {
            Role::Type => Case::Pascal,
            Role::Value => Case::Screaming,
            Role::Field | Role::Method | Role::Function => Case::Camel,
            Role::Module => Case::Snake,
        },
        keywords: Words::new(
            "_ abstract assert boolean break byte case catch char class const continue default do double else \
            enum extends false final finally float for goto if implements import instanceof int interface long \
            native new null package private protected public return short static strictfp super switch \
            synchronized this throw throws transient true try void volatile while",
        ),
        types: Words::new(
            "AutoCloseable Boolean Byte CharSequence Character Class ClassLoader Cloneable Comparable Deprecated \
            Double Enum Error Exception Float FunctionalInterface Integer Iterable List Long Map Math Module \
            Number Object Optional Override Package Process Record Runnable Runtime RuntimeException Set Short \
            String StringBuilder SuppressWarnings System Thread Throwable Void permits sealed",
        ),
        fields: Words::new(
            "clone equals finalize getClass hashCode notify notifyAll toString wait",
        ),
        methods: Words::new(
            "clone equals finalize getClass hashCode notify notifyAll toString wait",
        ),
        escape: |_, word| Some(format!("{word}_")),
        group_types: &[],
        has_file_per_type: true,
        has_id_types: with_ids.is_none(),
        with_ids,
        has_field_types: false,
    }
}
