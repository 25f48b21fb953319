//! Derive macros for FC protocol messages, enums, headers and dispatch.
//!
//! A generated item is a data structure with attributes; what it does is written here. The same
//! derives work on hand-written items. All of them read the attribute `#[fc(…)]`, and all take
//! `#[fc(crate = path)]` where the runtime is not found as `::fc_runtime`.
//!
//! **Architecture invariant:** an expansion is small. It names fields, keys and numbers in order;
//! what can be written once stands in `fc-runtime`.

mod attr;
#[cfg(any(feature = "client", feature = "server"))]
mod codes;
mod declared;
mod defaults;
#[cfg(feature = "server")]
mod dispatch;
mod envelope;
mod faults;
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
/// - `example = "…"`: the spec's example in wire form, own keys only.
///
/// On a field (an `Option` may be missing):
///
/// - `key = "stationName"`: its key on the wire; without it, the field's name.
/// - `also("taskId", …)`: other keys that are read for it.
/// - `wire = "string"`: a number or bool that travels inside a JSON string.
/// - `wire = "number"`: a bool that travels as `1` or `0`.
/// - `lenient(number)`: read from a number, a decimal string or a `0x` string.
/// - `lenient(bool)`: read from `true`, `false`, their strings, `0` or `1`.
/// - `empty_is_absent`: `null`, `{}`, `[]` and `""` are read as `None`.
/// - `min = 0`, `max = 100`: of a number. `length = 15`, `length = 1..=32`: characters of a string,
///   items of a list, bytes of base64. `pattern = "[0-9]{15}"`: of a whole string. `only(1, 6)`,
///   `only("day")`: of an [`OpenEnum`], the values it takes, as they travel. Checked on reading, and by
///   `Message::check`.
/// - `when(mode = 2 | 3, on = true)`, of an `Option`: it is there exactly where each of these other fields has one of its
///   values, those of an enum as they travel; `unless(…)`: everywhere else. Reading and sending ask nothing; a message with such a field
///   has `checked`, which tells whether each is there as it should be.
/// - `sensitive`: hidden by [`RedactedDebug`].
/// - `extra`: an `Extra` that keeps the unknown keys.
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

/// `new` with the required fields of a struct, in their order, and `with_…` for each that is an
/// `Option`.
///
/// Beside `#[non_exhaustive]` it lets a message gain an optional field without breaking the code that
/// makes one. For a `String`, anything is taken that becomes one. A field marked `#[fc(extra)]` starts empty.
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

/// What the absence of a field means, beside [`Message`](derive@Message): for each `Option` with
/// `#[fc(default = …)]` a constant `DEFAULT_…` and an accessor `…_or_default`.
///
/// The default of a `String` is a literal, and its accessor lends a `&str`. Reading and writing know nothing of
/// defaults: what is absent stays absent.
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

/// A choice of values: `FromJson`, `ToJson`, `wire()`, `VALUES`, and `From` its wire type; without a
/// variant `other` it is closed, and `TryFrom` takes the place of `From`.
///
/// On the enum: `repr = u8` (any integer type up to 64 bits) or `repr = str`. On a variant:
/// `value = 4` or `value = "gate"`; `other` on the one that keeps an unknown value.
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

/// An id with a type of its own, so that none is taken for another: `FromJson`, `ToJson`, `Display`, and `From` what it
/// holds and back.
///
/// On a struct of one integer or `String`, as which it travels. A field of it may have what one of the integer or the
/// text may have: `wire`, `lenient(number)`, `min`, `max`; `length`, `pattern`.
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

/// A choice of messages, told apart by their required keys: `FromJson` and `ToJson`.
///
/// Each variant holds one message. The first one whose required keys are all there is read. Unlike an
/// [`OpenEnum`](derive@OpenEnum) it is closed: a value that has the required keys of none is refused.
#[proc_macro_derive(OneOf, attributes(fc))]
pub fn derive_one_of(input: TokenStream) -> TokenStream {
    derive(input, one_of::expand)
}

/// A request with a code, beside [`Message`](derive@Message): `Command`.
///
/// `#[fc(code = 0x0A03, name = "get_station", effect = "read", response = GetStationResponse)]`;
/// `effect` is `"read"`, `"config"`, `"motion"` or `"unknown"`. `error = SetTargetError` names the enum of what the
/// command may be refused with, which derives [`DeclaredError`](derive@DeclaredError); without it, nothing is declared.
/// `accepted_in(Door(Shut, Locked))` says in which values of an enum the command is accepted, and writes `AcceptedIn`
/// for it.
/// `sets_off(StationReached, RouteProgress(response.route = data?.route))` names the reports that the command sets off:
/// `SetsOff`. In the parentheses of a report stands what ties it to the call, a field of the
/// request or of the response and the field of the report that has the same value; a field that is an `Option` is
/// marked with `?`.
#[proc_macro_derive(Command, attributes(fc))]
pub fn derive_command(input: TokenStream) -> TokenStream {
    derive(input, operation::expand_command)
}

/// The results besides success with which a command may be refused, by name: `DeclaredError`.
///
/// On each variant: `code = 41`, the result code, and `text = "…"`, what is sent beside it.
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

/// A report with a code, beside [`Message`](derive@Message): `Report`.
///
/// `#[fc(code = 0x0B01, name = "recharge_progress", ack(timeout_ms = 2000, retries = 3))]`; without
/// `ack` the protocol's default holds. `state(data.status: RechargeStatus)` names the field that says how far a process
/// has come and its type, an enum of states; `failure(data.error)` names other fields by which it says that something
/// failed. A field that is an `Option` is marked with `?`: `state(data?.status: RechargeStatus)`.
#[proc_macro_derive(Report, attributes(fc))]
pub fn derive_report(input: TokenStream) -> TokenStream {
    derive(input, operation::expand_report)
}

/// The fixed bytes in front of a frame's data: `Header`.
///
/// On the struct: `byte_order = "big"` or `"little"`. The fields are `u8`, `u16`, `u32`, `u64` or
/// `[u8; N]`, in the order in which they travel. On a field, `role = "…"`: `head` (`[u8; N]`, the
/// first field), `kind` (`u8`), `code` (`u16`), `id` (`u16` or `u32`) and `total_length` (`u32`), each
/// exactly once; `encoding` (`u8`), `plain_length` (`u32`) and `digest`, each at most once. A digest
/// is `[u8; 16]`, by MD5, or `u32` with `algorithm = "crc32"`. Every other field has `value = 0`, the
/// value it is sent with (`role = "status"` may be given as well).
#[proc_macro_derive(Header, attributes(fc))]
pub fn derive_header(input: TokenStream) -> TokenStream {
    derive(input, header::expand)
}

/// The keys beside a message's own, beside [`Message`](derive@Message): `RequestEnvelope` or
/// `ResponseEnvelope`.
///
/// On the struct: `envelope = "request"` or `"response"`. On its fields: `role = "time"` (`i64` or
/// an `Option` of it); in a response also `role = "result_code"` (an integer) and
/// beside it `role = "result_text"` (`String` or an `Option` of it). Without a result code a response
/// says that all went well, and what did not is not answered. Other fields are sent as their `Default`.
#[proc_macro_derive(Envelope, attributes(fc))]
pub fn derive_envelope(input: TokenStream) -> TokenStream {
    derive(input, envelope::expand)
}

/// A choice of reports, told apart by code: `from_raw`.
///
/// On the enum: `protocol = Fc`. Each variant holds one report; `unknown` marks the one that holds
/// the raw report of any other code.
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
/// makes the methods' futures `Send` and writes `RobotService<T>`, which serves any `T: Robot`. A
/// code goes to the method of its command, else to that of its range, else to `unknown`.
///
/// With `partial = PartialRobot` it also writes that trait, with the same methods, none of which has
/// to be implemented: those without a body above are refused by `Context::not_implemented`.
/// `RobotService` then serves either.
#[cfg(feature = "server")]
#[proc_macro_attribute]
pub fn dispatch(attribute: TokenStream, item: TokenStream) -> TokenStream {
    dispatch::expand(attribute.into(), item.into()).into()
}

/// Its examples compile.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
