//! Commands and reports, and their descriptions for tools.

use crate::json::{Allowance, BodyError};
use crate::message::{Message, check, transcode};
use crate::preconditions::{Cadence, Preconditions};
use std::fmt::Debug;
use std::time::Duration;

/// A result code and its text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResultText {
    /// Code.
    pub code: i64,
    /// Text.
    pub text: &'static str,
}

/// How the sender of a report waits for its acknowledgement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AckPolicy {
    /// Wait before the report is sent again. A server waits up to an eighth longer on some connections, so that
    /// repetitions to many apps do not coincide.
    pub timeout: Duration,
    /// Number of repetitions before the sender gives up.
    pub retries: u32,
}

/// The effect of a command on the peer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Only asks.
    Read,
    /// Changes data or behaviour of the peer.
    Config,
    /// Sets something in motion.
    Motion,
    /// Not specified. Such a command is never repeated automatically, like a motion.
    Unknown,
}

impl Effect {
    /// All effects.
    pub const ALL: [Self; 4] = [Self::Read, Self::Config, Self::Motion, Self::Unknown];
}

/// A request with a code and a response type. `#[derive(Command)]` implements it.
#[diagnostic::on_unimplemented(message = "`{Self}` is not a command", note = "derive `Command`")]
pub trait Command: Message {
    /// Response type.
    type Response: Message;
    /// Declared errors.
    type Error: DeclaredError;
    /// Command code.
    const CODE: u16;
    /// Name in the spec.
    const NAME: &'static str;
    /// Effect on the peer.
    const EFFECT: Effect;
}

/// A command that a peer accepts only in some states, as values of an enum. `#[derive(Command)]` implements it.
///
/// A robot refuses with it in one line:
///
/// ```ignore
/// if !CloseDoorRequest::accepted_in(&state) {
///     return Err(Refusal::new(code, "not now"));
/// }
/// ```
pub trait AcceptedIn<State: PartialEq + 'static>: Command {
    /// All accepted states.
    const STATES: &'static [State];

    /// Returns `true` if the command is accepted in this state. States of other enums may also matter. Returns
    /// `false` for a state that the spec does not have.
    #[must_use]
    fn accepted_in(state: &State) -> bool {
        Self::STATES.contains(state)
    }
}

/// An error that a command declares. `#[derive(DeclaredError)]` implements it.
///
/// A handler converts it into a [`Refusal`](crate::Refusal). An app gets it back with
/// [`Refusal::declared`](crate::Refusal::declared).
pub trait DeclaredError: Copy + Debug + 'static {
    /// All errors that the command declares.
    const ALL: &'static [Self];

    /// Returns the result code and its text.
    fn result(self) -> ResultText;

    /// Returns the error with this result code.
    #[must_use]
    fn of(code: i64) -> Option<Self> {
        let mut all = Self::ALL.iter().copied();
        all.find(|error| error.result().code == code)
    }
}

/// The error type of a command that declares no errors. It has no values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Undeclared {}

impl DeclaredError for Undeclared {
    const ALL: &'static [Self] = &[];

    fn result(self) -> ResultText {
        match self {}
    }
}

/// A message that the server pushes and the app acknowledges. `#[derive(Report)]` implements it.
#[diagnostic::on_unimplemented(message = "`{Self}` is not a report", note = "derive `Report`")]
pub trait Report: Message {
    /// Command code.
    const CODE: u16;
    /// Name in the spec.
    const NAME: &'static str;
    /// Acknowledgement policy; `None` for the protocol's default.
    const ACK: Option<AckPolicy>;
    /// The state of the process in this report, or [`Stateless`] if it has none.
    type State: State;

    /// Returns the state of the process, or `None` if the report does not contain it.
    fn state(&self) -> Option<Self::State> {
        None
    }

    /// Returns `true` if the report means a failure.
    fn is_failure(&self) -> bool {
        self.state().is_some_and(|state| state.says_failed())
    }
}

/// A state of a process. `#[derive(OpenEnum)]` implements it for enums whose values are states.
pub trait State: Send + Sync + 'static {
    /// Returns `true` for a final state.
    fn is_end(&self) -> bool;

    /// Returns `true` for a failure.
    fn says_failed(&self) -> bool;

    /// Returns `true` if the spec allows this state after `previous`. Without a rule, every state is allowed. The same
    /// state and a failure are always allowed.
    fn is_in_order(&self, previous: &Self) -> bool;
}

/// The state type of a report without a state. It has no values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stateless {}

impl State for Stateless {
    fn is_end(&self) -> bool {
        match *self {}
    }

    fn says_failed(&self) -> bool {
        match *self {}
    }

    fn is_in_order(&self, _: &Self) -> bool {
        match *self {}
    }
}

/// A command that sets off the reports `R`. `#[derive(Command)]` implements it.
#[diagnostic::on_unimplemented(
    message = "nothing is said of `{Self}` setting off `{R}`",
    note = "`#[fc(sets_off(…))]` says which reports a command sets off"
)]
pub trait SetsOff<R: Report>: Command + Clone {
    /// Returns `true` if the report belongs to this call with response `answer`: the linking fields are equal. Always
    /// returns `true` if no fields link them.
    fn has_set_off(&self, answer: &Self::Response, report: &R) -> bool {
        let _ = (answer, report);
        true
    }
}

/// The kind of an operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OperationKind {
    /// A request and its response.
    Command,
    /// A pushed message and its acknowledgement.
    Report,
    /// Frames of raw bytes.
    Stream,
}

/// A description of an operation for tools, without its types.
#[derive(Clone, Copy, Debug)]
pub struct OperationInfo {
    /// Name in the spec.
    pub name: &'static str,
    /// Command code; `None` if the spec does not specify one yet.
    pub code: Option<u16>,
    /// Kind.
    pub kind: OperationKind,
    /// Effect of a command on the peer; `None` for reports and streams.
    pub effect: Option<Effect>,
    /// Preconditions of a command; `None` if the spec does not specify them.
    pub preconditions: Option<Preconditions>,
    /// Time at which a report is sent; `None` if the spec does not specify it.
    pub cadence: Option<Cadence>,
    /// Chinese title.
    pub zh: &'static str,
    /// English title.
    pub en: &'static str,
    /// First version of the spec that contains it, as `YYYY-MM` or `YYYY-MM-DD`.
    pub since: Option<&'static str>,
    /// `true` if the operation is deprecated.
    pub deprecated: bool,
    /// Path of its page below the documentation's root.
    pub docs: &'static str,
    /// File of the spec that defines it, as a path from the project's root.
    pub spec: &'static str,
    /// Its request, or the body of a report.
    pub request: BodyInfo,
    /// Its response, or the acknowledgement of a report.
    pub response: BodyInfo,
}

/// A body without its type.
#[derive(Clone, Copy, Debug)]
pub struct BodyInfo {
    /// The spec's example as JSON, without the keys of the envelope.
    pub example: &'static str,
    /// Reads the body's own keys as the typed message and writes it again in canonical form.
    pub transcode: fn(&[u8]) -> Result<Vec<u8>, BodyError>,
    /// Reads the body's own keys as the typed message, within this allowance, and returns the first error.
    pub check: fn(&[u8], Allowance) -> Result<(), BodyError>,
}

impl BodyInfo {
    /// Describes the body type `M`.
    #[must_use]
    pub const fn of<M: Message>() -> Self {
        Self {
            example: M::EXAMPLE,
            transcode: transcode::<M>,
            check: check::<M>,
        }
    }
}

/// Rejects a code that occurs earlier in the list, at compile time. The derives call it.
///
/// # Panics
/// If an earlier code is equal.
#[allow(
    clippy::panic,
    clippy::indexing_slicing,
    reason = "evaluated by the compiler, which reports the panic at the place of the code"
)]
pub const fn first_of_its_code(codes: &[u16], index: usize) {
    let mut earlier = 0;
    while earlier < index {
        assert!(
            codes[earlier] != codes[index],
            "an earlier one has the same command code"
        );
        earlier += 1;
    }
}
