//! Derive macros for FC protocol messages, enums, headers and dispatch.
//!
//! A generated item is a data structure with attributes, and the derives implement its behaviour. They work on
//! handwritten items as well. All derives read the attribute `#[fc(…)]`. All accept `#[fc(crate = path)]` if the
//! runtime is not at `::fc_runtime`.
//!
//! **Architecture invariant:** an expansion is small. It names fields, keys and numbers in order. Code that does not
//! depend on the item belongs in `fc-runtime`.

mod attr;
#[cfg(any(feature = "client", feature = "server"))]
mod codes;
mod declared;
mod defaults;
#[cfg(feature = "server")]
mod dispatch;
mod envelope;
mod errors;
mod header;
mod id;
mod item;
mod json;
mod message;
mod new;
mod one_of;
mod open_enum;
mod operation;
mod process;
mod redacted;
#[cfg(feature = "client")]
mod reports;
mod span;
#[cfg(test)]
mod tests;

use proc_macro::TokenStream;

fn derive(input: TokenStream, expand: item::Expand) -> TokenStream {
    item::derive(input.into(), expand).into()
}

/// A JSON object with known keys: `FromJson`, `ToJson` and `Message`.
///
/// On the struct:
///
/// - `example = "…"`: the spec's example in wire form, without the keys of the envelope.
///
/// On a field (an `Option` may be absent):
///
/// - `key = "stationName"`: its wire key; by default the field's name.
/// - `also("taskId", …)`: other keys that are read for it.
/// - `wire = "string"`: a number or bool that is sent inside a JSON string.
/// - `wire = "number"`: a bool that is sent as `1` or `0`.
/// - `lenient(number)`: read from a number, a decimal string or a `0x` string.
/// - `lenient(bool)`: read from `true`, `false`, their strings, `0` or `1`.
/// - `empty_is_absent`: `null`, `{}`, `[]` and `""` are read as `None`.
/// - `min = 0`, `max = 100`: limits of a number. `length = 15`, `length = 1..=32`: characters of a string, items of a
///   list, bytes of base64. `pattern = "[0-9]{15}"`: for a whole string. `only(1, 6)`, `only("day")`: the allowed
///   values of an [`OpenEnum`], as sent. Reading and `Message::check` check these constraints.
/// - `when(mode = 2 | 3, on = true)`, for an `Option`: the field is present exactly if each of these other fields has
///   one of its values; values of enums as sent. `unless(…)`: present in all other cases. Reading and sending ignore
///   conditions. The method `checked` of the message verifies them.
/// - `sensitive`: hidden by [`RedactedDebug`].
/// - `extra`: an `Extra` that keeps unknown keys.
///
/// ```
/// use fc_derive::Message;
/// use fc_runtime::{Extra, Message};
///
/// #[derive(Clone, Debug, PartialEq, Message)]
/// #[fc(example = r#"{"stationId":3}"#)]
/// pub struct Station {
///     #[fc(key = "stationId", min = 0)]
///     pub station_id: i32,
///     #[fc(extra)]
///     pub extra: Extra,
/// }
///
/// assert_eq!(Station::example().station_id, 3);
/// ```
#[proc_macro_derive(Message, attributes(fc))]
pub fn derive_message(input: TokenStream) -> TokenStream {
    derive(input, message::expand)
}

/// `new` with the required fields of a struct in their order, and `with_…` for each `Option`.
///
/// With `#[non_exhaustive]`, a message can get further optional fields without breaking code that creates one. A
/// `String` field accepts any type that converts into a `String`. A field marked `#[fc(extra)]` is empty at first.
///
/// ```
/// use fc_derive::{Message, New};
///
/// #[derive(Clone, Debug, PartialEq, Message, New)]
/// #[non_exhaustive]
/// pub struct Station {
///     pub name: String,
///     pub floor: Option<i32>,
/// }
///
/// let station = Station::new("lobby").with_floor(1);
/// assert_eq!((station.name.as_str(), station.floor), ("lobby", Some(1)));
/// ```
#[proc_macro_derive(New, attributes(fc))]
pub fn derive_new(input: TokenStream) -> TokenStream {
    derive(input, new::expand)
}

/// The meaning of absent fields, together with [`Message`](derive@Message): for each `Option` with `#[fc(default = …)]`
/// a constant `DEFAULT_…` and an accessor `…_or_default`.
///
/// The default of a `String` is a literal, and its accessor returns a `&str`. Reading and writing ignore defaults: an
/// absent field stays absent.
///
/// ```
/// use fc_derive::{Defaults, Message};
///
/// #[derive(Clone, Debug, PartialEq, Message, Defaults)]
/// pub struct Station {
///     #[fc(default = "lobby")]
///     pub name: Option<String>,
///     #[fc(default = -1)]
///     pub floor: Option<i32>,
/// }
///
/// let station = Station { name: Some("roof".to_owned()), floor: None };
/// assert_eq!((station.name_or_default(), station.floor_or_default()), ("roof", -1));
/// assert_eq!((Station::DEFAULT_NAME, Station::DEFAULT_FLOOR), ("lobby", -1));
/// ```
#[proc_macro_derive(Defaults, attributes(fc))]
pub fn derive_defaults(input: TokenStream) -> TokenStream {
    derive(input, defaults::expand)
}

/// An enum of values: `FromJson`, `ToJson`, `wire()`, `VALUES`, and `From` its wire type. Without a variant `other` it
/// is closed and has `TryFrom` instead of `From`.
///
/// On the enum: `repr = u8` (any integer type up to 64 bits) or `repr = str`. On a variant: `value = 4` or `value =
/// "gate"`; `other` on the variant that keeps an unknown value.
///
/// ```
/// use fc_derive::OpenEnum;
///
/// #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, OpenEnum)]
/// #[fc(repr = u8)]
/// pub enum RechargeStatus {
///     #[fc(value = 0)]
///     Idle,
///     #[fc(other)]
///     Unknown(u8),
/// }
///
/// assert_eq!(RechargeStatus::from(0), RechargeStatus::Idle);
/// assert_eq!(RechargeStatus::Unknown(7).wire(), 7);
/// ```
#[proc_macro_derive(OpenEnum, attributes(fc))]
pub fn derive_open_enum(input: TokenStream) -> TokenStream {
    derive(input, open_enum::expand)
}

/// An id with its own type, so that it cannot be mistaken for another: `FromJson`, `ToJson`, `Display`, and `From` in
/// both directions.
///
/// On a struct of one integer or `String`, which is its wire form. A field of this type may have the attributes of a
/// field of the inner type: `wire`, `lenient(number)`, `min`, `max`; `length`, `pattern`.
///
/// ```
/// use fc_derive::{Id, Message};
/// use fc_runtime::Allowance;
/// use fc_runtime::json::{self, BodyError};
///
/// #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Id)]
/// pub struct StationId(pub i64);
///
/// #[derive(Clone, Debug, PartialEq, Message)]
/// pub struct Station {
///     #[fc(min = 1)]
///     pub id: StationId,
/// }
///
/// let station: Station = json::from_str(r#"{"id":7}"#, Allowance::depth(1))?;
/// assert_eq!((station.id, station.id.to_string()), (StationId(7), "7".to_owned()));
/// # Ok::<(), BodyError>(())
/// ```
#[proc_macro_derive(Id, attributes(fc))]
pub fn derive_id(input: TokenStream) -> TokenStream {
    derive(input, id::expand)
}

/// A one-of: an enum of messages, distinguished by their required keys: `FromJson` and `ToJson`.
///
/// Each variant contains one message. The first variant whose required keys are all present is read. Unlike an
/// [`OpenEnum`](derive@OpenEnum) it is closed: a value without all required keys of a variant is an error.
#[proc_macro_derive(OneOf, attributes(fc))]
pub fn derive_one_of(input: TokenStream) -> TokenStream {
    derive(input, one_of::expand)
}

/// A request with a code, together with [`Message`](derive@Message): `Command`.
///
/// `#[fc(code = 0x0A03, name = "get_station", effect = "read", response = GetStationResponse)]`; `effect` is `"read"`,
/// `"config"`, `"motion"` or `"unknown"`. `error = SetTargetError` is the enum of errors that the command declares,
/// with [`DeclaredError`](derive@DeclaredError); without it, the command declares none. `accepted_in(Door(Shut,
/// Locked))` lists the values of an enum in which the command is accepted, and implements `AcceptedIn`.
/// `sets_off(StationReached, RouteProgress(response.route = data?.route))` lists the reports that the command sets off,
/// and implements `SetsOff`. The parentheses of a report link it to the call: a field of the request or response, and
/// the field of the report with the same value. A field that is an `Option` is marked with `?`.
#[proc_macro_derive(Command, attributes(fc))]
pub fn derive_command(input: TokenStream) -> TokenStream {
    derive(input, operation::expand_command)
}

/// The errors that a command declares, by name: `DeclaredError`.
///
/// On each variant: `code = 41`, the result code, and `text = "…"`, its text.
///
/// ```
/// use fc_derive::DeclaredError;
/// use fc_runtime::{DeclaredError, Refusal};
///
/// #[derive(Clone, Copy, Debug, PartialEq, DeclaredError)]
/// pub enum SetTargetError {
///     #[fc(code = 41, text = "no such station")]
///     NoStation,
/// }
///
/// assert_eq!(SetTargetError::of(41), Some(SetTargetError::NoStation));
/// assert_eq!(Refusal::from(SetTargetError::NoStation), Refusal::new(41, "no such station"));
/// ```
#[proc_macro_derive(DeclaredError, attributes(fc))]
pub fn derive_declared_error(input: TokenStream) -> TokenStream {
    derive(input, declared::expand)
}

/// A report with a code, together with [`Message`](derive@Message): `Report`.
///
/// `#[fc(code = 0x0B01, name = "recharge_progress", ack(timeout_ms = 2000, retries = 3))]`; without `ack` the
/// protocol's default applies. `state(data.status: RechargeStatus)` is the field with the state of the process, and its
/// type, an enum of states. `failure(data.error)` lists other fields that mean a failure. A field that is an `Option`
/// is marked with `?`: `state(data?.status: RechargeStatus)`.
#[proc_macro_derive(Report, attributes(fc))]
pub fn derive_report(input: TokenStream) -> TokenStream {
    derive(input, operation::expand_report)
}

/// The fixed bytes in front of the data of a frame: `Header`.
///
/// On the struct: `byte_order = "big"` or `"little"`. The fields are `u8`, `u16`, `u32`, `u64` or `[u8; N]`, in the
/// order in which they are sent. On a field, `role = "…"`: `head` (`[u8; N]`, the first field), `kind` (`u8`), `code`
/// (`u16`), `id` (`u16` or `u32`) and `total_length` (`u32`), each exactly once; `encoding` (`u8`), `plain_length`
/// (`u32`) and `digest`, each at most once. A digest is `[u8; 16]` for MD5, or `u32` with `algorithm = "crc32"`. Every
/// other field has `value = 0`, its constant value (`role = "status"` is allowed as well).
#[proc_macro_derive(Header, attributes(fc))]
pub fn derive_header(input: TokenStream) -> TokenStream {
    derive(input, header::expand)
}

/// The keys of an envelope, together with [`Message`](derive@Message): `RequestEnvelope` or `ResponseEnvelope`.
///
/// On the struct: `envelope = "request"` or `"response"`. On its fields: `role = "time"` (`i64` or an `Option` of it);
/// in a response also `role = "result_code"` (an integer) and with it `role = "result_text"` (`String` or an `Option`
/// of it). Without a result code, every response means success, and failed requests are not answered. Other fields are
/// sent with their `Default`.
#[proc_macro_derive(Envelope, attributes(fc))]
pub fn derive_envelope(input: TokenStream) -> TokenStream {
    derive(input, envelope::expand)
}

/// An enum of reports, distinguished by code: `from_raw`.
///
/// On the enum: `protocol = Fc`. Each variant contains one report; `unknown` marks the variant with the raw report of
/// any other code.
#[cfg(feature = "client")]
#[proc_macro_derive(Dispatch, attributes(fc))]
pub fn derive_dispatch(input: TokenStream) -> TokenStream {
    derive(input, reports::expand)
}

/// `Debug` that does not print the fields marked `#[fc(sensitive)]`.
#[proc_macro_derive(RedactedDebug, attributes(fc))]
pub fn derive_redacted_debug(input: TokenStream) -> TokenStream {
    derive(input, redacted::expand)
}

/// Makes a trait of `async` methods, one per command, into a service.
///
/// `#[dispatch(protocol = Fc, service = RobotService)]` on
///
/// ```ignore
/// pub trait Robot: Send + Sync + 'static {
///     /// The request type says which command this answers.
///     async fn get_station(&self, context: Context<Fc>, request: GetStationRequest)
///         -> Result<GetStationResponse, Refusal>;
///     #[fc(range = 0x0200..=0x0300)]
///     async fn pass_through(&self, context: Context<Fc>, request: RawRequest)
///         -> Result<RawAnswer, Refusal>;
///     #[fc(unknown)]
///     async fn unknown(&self, context: Context<Fc>, request: RawRequest)
///         -> Result<RawAnswer, Refusal>;
/// }
/// ```
///
/// makes the futures of the methods `Send` and writes `RobotService<T>`, which serves any `T: Robot`. A code is passed
/// to the method of its command, or else to the method of its range, or else to `unknown`.
///
/// With `partial = PartialRobot` it also writes that trait with the same methods, all of them optional. Methods without
/// a body above refuse with `Context::not_implemented` by default. `RobotService` then serves either trait.
#[cfg(feature = "server")]
#[proc_macro_attribute]
pub fn dispatch(attribute: TokenStream, item: TokenStream) -> TokenStream {
    dispatch::expand(attribute.into(), item.into()).into()
}

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
