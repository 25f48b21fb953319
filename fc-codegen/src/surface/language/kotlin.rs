//! Kotlin.

use super::{Case, Language, Role, Words};

/// Hard keywords; the types that every file imports (`kotlin`, `kotlin.collections`, `java.lang`).
pub static KOTLIN: Language = Language {
    name: "kotlin",
    title: "Kotlin",
    case: |role| match role {
        Role::Type => Case::Pascal,
        Role::Value => Case::Screaming,
        Role::Field | Role::Method | Role::Function => Case::Camel,
        Role::Module => Case::Snake,
    },
    keywords: Words::new(
        "as break class continue do else false for fun if in interface is null object package return super \
        this throw true try typealias typeof val var when while",
    ),
    types: Words::new(
        "Annotation Any Array Boolean BooleanArray Byte ByteArray Char CharArray CharSequence Collection \
        Comparable Comparator Deprecated Double DoubleArray Enum Error Exception Float FloatArray Function \
        Int IntArray Iterable Iterator Lazy List Long LongArray Map MutableList MutableMap MutableSet \
        Nothing Number Object Pair Record Result Runnable Sequence Set Short ShortArray String StringBuilder \
        Suppress System Thread Throwable Triple UByte UInt ULong UShort Unit Void",
    ),
    fields: Words::new("clone equals finalize getClass hashCode notify notifyAll toString wait"),
    methods: Words::new("clone equals finalize getClass hashCode notify notifyAll toString wait"),
    escape: |_, word| Some(format!("`{word}`")),
    has_file_per_type: false,
    has_id_types: false,
};
