//! Kotlin.

use super::{Case, Language, Role, Words};

/// Kotlin with plain integers and strings as ids.
pub static KOTLIN: Language = kotlin(Some(&KOTLIN_WITH_IDS));

/// Kotlin with an id type for each entity: `newtypes: true` in `fc.yaml`.
static KOTLIN_WITH_IDS: Language = kotlin(None);

/// Builds the rules of Kotlin.
///
/// The keywords are the hard ones. The types are those that every file imports (`kotlin`, `kotlin.collections`,
/// `java.lang`), those of the runtime in use, and those of the package. The members are those of every message, of
/// `Client` and of `Robot`.
const fn kotlin(with_ids: Option<&'static Language>) -> Language {
    Language {
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
            "AckPolicy Acknowledgement Annotation Any Array AsyncRobot Audience AutoCloseable BigInteger Boolean \
            BooleanArray Builder Byte ByteArray Bytes Cadence CallError CallOptions Char CharArray CharSequence \
            ChoiceType Client ClientConfig Codec Collection Command Comparable Comparator CompletableFuture CompletionStage \
            Connection ConnectionState Content Context DataConnection DeclaredError Defaults Deprecated \
            DigestAlgorithm Double DoubleArray Effect Empty Enum EnumType EnvelopeRole Error ExampleAnswers \
            ExampleRobot Exception Extra Field Float FloatArray Flow Following Function HeaderField HeaderLayout \
            HeaderRole Id Int IntArray IntEnumType IntValue Iterable Iterator Json JvmField JvmOverloads JvmStatic \
            JvmSynthetic Lazy Limits List Long LongArray Loss Map Message MessageBuilder MessageType MutableList \
            MutableMap MutableSet Nothing Number Object Operations OptionalField Override Pair PartialAsyncRobot PartialRobot \
            Protocol RawRequest Record Refusal Report Reporter Reports RequestEnvelope ResponseEnvelope Result \
            ResultCode ResultText Results Robot Runnable Sequence Server Service Set Short ShortArray State \
            StateOrder Steps Streamer Streams String StringBuilder Subscription Suppress System Tables \
            TextEnumType TextValue Thread Throwable Throws Triple Types UByte UInt ULong UShort Unit Void",
        ),
        fields: Words::new(
            "clone equals extra field finalize getClass hashCode messageType notify notifyAll toString wait",
        ),
        methods: Words::new(
            "clone close connection data equals finalize getClass hashCode notify notifyAll reports server state states \
            toString unknown wait",
        ),
        escape: |_, word| Some(format!("{word}_")),
        group_types: &[
            "operations",
            "client",
            "handlers",
            "partial",
            "async_handlers",
            "async_partial",
            "example",
            "reporter",
            "streams",
            "streamer",
        ],
        has_file_per_type: false,
        has_id_types: with_ids.is_none(),
        with_ids,
        has_field_types: false,
    }
}
