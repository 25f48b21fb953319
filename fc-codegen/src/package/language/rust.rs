//! Rust.

use super::{Case, Language, Role, Words};

/// Rust with plain integers and strings as ids.
pub static RUST: Language = rust(Some(&RUST_WITH_IDS));

/// Rust with an id type for each entity: `newtypes: true` in `fc.yaml`.
static RUST_WITH_IDS: Language = rust(None);

/// Builds the rules of Rust.
///
/// The keywords are the strict and reserved ones of every edition up to 2024. The types are those of the prelude, of
/// the generated crate, and of the runtime in its messages.
const fn rust(with_ids: Option<&'static Language>) -> Language {
    Language {
        name: "rust",
        title: "Rust",
        case: |role| match role {
            Role::Type | Role::Value => Case::Pascal,
            Role::Field | Role::Method | Role::Module | Role::Function => Case::Snake,
        },
        keywords: Words::new(
            "Self abstract as async await become box break const continue crate do dyn else enum extern false \
            final fn for gen if impl in let loop macro match mod move mut override priv pub ref return self \
            static struct super trait true try type typeof unsafe unsized use virtual where while yield",
        ),
        types: Words::new(
            "AnyReport AsMut AsRef AsyncFn AsyncFnMut AsyncFnOnce Box Bytes64 Client Clone Copy Default \
            DoubleEndedIterator Drop Eq Err ExactSizeIterator ExampleRobot Extend Extra Fn FnMut FnOnce \
            FrameHeader From FromIterator Future Into IntoFuture IntoIterator Iterator Json None Ok Option Ord \
            PartialEq PartialOrd PartialRobot Reporter Reports RequestEnvelope ResponseEnvelope Result \
            ResultCode Robot RobotService Self Send Sized Some StreamCode Streamer Streams String Sync ToOwned ToString TryFrom \
            TryInto Unpin Vec",
        ),
        fields: Words::new(""),
        methods: Words::new(
            "clone clone_from clone_into closed connect connect_lazy connection data default from into new reports state \
            states to_owned try_from try_into unknown",
        ),
        escape: |role, word| match (role, word) {
            // These words begin paths, or the file already exists.
            (Role::Module, "crate" | "mod" | "self" | "super") => None,
            // These words are no names even as `r#self`.
            (_, "crate" | "self" | "super" | "Self") => Some(format!("{word}_")),
            _ => Some(format!("r#{word}")),
        },
        group_types: &[],
        has_file_per_type: false,
        has_id_types: with_ids.is_none(),
        with_ids,
        has_field_types: true,
    }
}
