//! Types of fields in each language. `tests/it/packages.rs` compares them with the output of `fc-codegen`.

use crate::rule::Language;
use crate::rules::EVERY;
use fc_spec::model::{Field, FloatKind, IntKind, Number, Type};
use std::borrow::Cow;

/// The largest integer that a `number` of JavaScript holds exactly.
const SAFE: i128 = (1 << 53) - 1;

/// Returns the languages in which two fields have different types.
pub(super) fn changed(old: &Field, new: &Field) -> Vec<Language> {
    let differs = |language: &Language| held(*language, old) != held(*language, new);
    EVERY.iter().copied().filter(differs).collect()
}

/// Returns the type of a member, and `true` if the type includes its absence.
fn held(language: Language, field: &Field) -> (Cow<'static, str>, bool) {
    let ty = spelled(language, &field.ty, is_large(field));
    // Compiled code distinguishes `int` from `Integer`, but not `String` from `String?`.
    let is_told = language != Language::JvmBinary
        || matches!(&*ty, "Boolean" | "Int" | "Long" | "Float" | "Double");
    (ty, field.optional && is_told)
}

/// Returns a text that is the same for equal types of a language.
fn spelled(language: Language, ty: &Type, is_large: bool) -> Cow<'static, str> {
    use Language::{Cpp, JvmBinary, Kotlin, Python, Rust, Typescript};
    let is_time = matches!(ty, Type::TimestampMs | Type::TimestampS);
    let text = match (language, ty) {
        // Compiled code does not know the items of a list.
        (JvmBinary, Type::Array(_)) => "List",
        (_, Type::Array(item)) => {
            return format!("[{}]", spelled(language, item, is_large)).into();
        }
        (_, Type::Named(named)) => return named.name().to_owned().into(),
        (_, Type::Bool) => "Boolean",
        (_, Type::String) => "String",
        (_, Type::Base64) => "Bytes",
        (_, Type::Json) => "Json",
        (Rust | Cpp, Type::Int(kind)) => kind.name(),
        (Rust | Cpp, Type::Float(kind)) => kind.name(),
        (Rust | Cpp, _) if is_time => "i64",
        (Kotlin | JvmBinary, Type::Int(IntKind::U64)) => "BigInteger",
        (Kotlin | JvmBinary, Type::Int(IntKind::I64 | IntKind::U32)) => "Long",
        (Kotlin | JvmBinary, Type::Int(_)) => "Int",
        (Kotlin | JvmBinary, Type::Float(FloatKind::F32)) => "Float",
        (Kotlin | JvmBinary, Type::Float(FloatKind::F64)) => "Double",
        (Kotlin | JvmBinary, _) => "Long",
        (Python, Type::Float(_)) => "float",
        (Python, _) => "int",
        (Typescript, _) if is_large => "bigint",
        (Typescript | Rust | Cpp, _) => "number",
    };
    Cow::Borrowed(text)
}

/// Returns `true` if a `number` of JavaScript cannot hold all values of a field.
fn is_large(field: &Field) -> bool {
    let least = match field.ty.item() {
        Type::Int(IntKind::U64) => 0,
        Type::Int(IntKind::I64) | Type::TimestampMs | Type::TimestampS => i128::MAX,
        _ => return false,
    };
    let fits = |limit: &Option<Number>, or: i128| match limit {
        Some(Number::Int(value)) => value.abs() <= SAFE,
        Some(Number::Float(_)) => false,
        None => or <= SAFE,
    };
    let details = field.details();
    !(fits(&details.constraints.min, least) && fits(&details.constraints.max, i128::MAX))
}
