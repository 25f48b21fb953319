//! The scripts of `conformance/sessions` as data. `conformance/session.schema.json` documents every key.

use serde::{Deserialize, Deserializer, Serialize};
use serde_json::json;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder with the data for all implementations.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../conformance")
}

/// The files that end with `.json` in a folder, with their text.
pub fn json_files(folder: &Path) -> Vec<(PathBuf, String)> {
    let inside = fs::read_dir(folder).expect("the folder is there");
    let mut paths: Vec<_> = inside.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "json"));
    paths.sort();
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap();
        (path, text)
    };
    paths.into_iter().map(read).collect()
}

/// Properties of a peer in every script; see `conformance/README.md`.
pub mod defaults {
    pub const IN_FLIGHT: usize = 64;
    pub const QUEUED_REPORTS: usize = 16;
    pub const CALL_TIMEOUT: u64 = 3000;
    pub const HANDLER_TIMEOUT: u64 = 2000;
    pub const ACK: super::Ack = super::Ack {
        timeout: 2000,
        retries: 3,
    };
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct File {
    #[serde(rename = "$schema")]
    pub _schema: String,
    pub format: u32,
    #[serde(rename = "subject")]
    pub _subject: String,
    pub level: Level,
    pub scripts: Vec<Script>,
}

/// The tested part.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// The session alone: it returns the meaning of frames and the due requests.
    Session,
    /// A whole client or server, with frames at its other end.
    Peer,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Script {
    pub name: String,
    pub demands: String,
    pub given: Given,
    pub steps: Vec<Step>,
}

impl Script {
    /// Returns `true` if all keys apply at this level. Other keys would check nothing.
    pub fn check(&self, level: Level) -> Result<(), Failure> {
        let given = &self.given;
        let whole = (level == Level::Peer).then_some(given.side);
        let is_narrow = given.id_bits == IdBits::Sixteen;
        let nowhere = [
            (given.remembers.is_some() && whole.is_some(), "remembers"),
            (is_narrow && whole.is_some(), "id_bits"),
            (
                given.receivers.is_some() && whole != Some(Side::App),
                "receivers",
            ),
            (
                given.handler_timeout.is_some() && whole != Some(Side::Robot),
                "handler_timeout",
            ),
        ];
        let nowhere = nowhere.iter().find(|(is_said, _)| *is_said);
        let nowhere = nowhere.map(|(_, key)| *key);
        match nowhere.or_else(|| self.steps.iter().find_map(|step| step.misplaced(level))) {
            Some(key) => Err(format!("`{key}` means nothing here")),
            None => Ok(()),
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    App,
    Robot,
}

/// The initial situation of a script.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Given {
    pub side: Side,
    pub first_id: u32,
    /// Number of bits of a message id in the header.
    #[serde(default)]
    pub id_bits: IdBits,
    pub in_flight: Option<usize>,
    pub queued_reports: Option<usize>,
    pub ack: Option<Ack>,
    pub call_timeout: Option<u64>,
    pub handler_timeout: Option<u64>,
    pub receivers: Option<usize>,
    /// Number of remembered reports, if a script depends on it.
    pub remembers: Option<usize>,
}

/// The widths that a message id may have.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(try_from = "u8")]
pub enum IdBits {
    Sixteen,
    #[default]
    ThirtyTwo,
}

impl TryFrom<u8> for IdBits {
    type Error = &'static str;
    fn try_from(bits: u8) -> Result<Self, Self::Error> {
        match bits {
            16 => Ok(Self::Sixteen),
            32 => Ok(Self::ThirtyTwo),
            _ => Err("an id has 16 or 32 bits"),
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(deny_unknown_fields)]
pub struct Ack {
    pub timeout: u64,
    pub retries: u32,
}

/// One event with all its effects.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Step {
    call: Option<Open>,
    report: Option<Open>,
    receive: Option<Frame>,
    advance: Option<u64>,
    lose: Option<Lose>,
    reconnect: Option<Nothing>,
    handed_on: Option<String>,
    cancel: Option<String>,
    take: Option<Nothing>,
    finish: Option<Finish>,
    close: Option<Nothing>,
    shutdown: Option<Shutdown>,
    repeat: Option<Repeat>,
    /// All effects, in any order.
    pub expect: Vec<Event>,
    pub then: Option<Then>,
}

#[derive(Clone, Copy, Debug)]
pub enum Action<'a> {
    Call(&'a Open),
    Report(&'a Open),
    Receive(&'a Frame),
    Advance(u64),
    Lose(&'a Lose),
    Reconnect,
    HandedOn(&'a str),
    Cancel(&'a str),
    Take,
    Finish(&'a Finish),
    Close,
    Shutdown(&'a Shutdown),
    Repeat(&'a Repeat),
}

impl Step {
    /// A key that does not apply at this level.
    fn misplaced(&self, level: Level) -> Option<&'static str> {
        let (call, report) = (self.call.as_ref(), self.report.as_ref());
        let (frame, lose) = (self.receive.as_ref(), self.lose.as_ref());
        let found = match level {
            Level::Session => [
                (call.is_some_and(|call| call.repeat.is_some()), "repeat"),
                (frame.is_some_and(|frame| frame.result.is_some()), "result"),
                (frame.is_some_and(|frame| frame.broken), "broken"),
                (
                    report.is_some_and(|report| report.repeat.is_some()),
                    "repeat",
                ),
            ],
            Level::Peer => [
                (call.is_some_and(|call| call.retries.is_some()), "retries"),
                (
                    report.is_some_and(|report| report.timeout.is_some()),
                    "timeout",
                ),
                (
                    report.is_some_and(|report| report.retries.is_some()),
                    "retries",
                ),
                (lose.is_some_and(|lose| !lose.keeps.is_empty()), "keeps"),
            ],
        };
        let inside = self.repeat.iter().flat_map(|repeat| &repeat.steps);
        let found = found.iter().find(|(is_said, _)| *is_said);
        (found.map(|(_, key)| *key))
            .or_else(|| inside.into_iter().find_map(|step| step.misplaced(level)))
    }

    /// The event of the step: exactly one.
    pub fn action(&self) -> Result<Action<'_>, String> {
        let all = [
            self.call.as_ref().map(Action::Call),
            self.report.as_ref().map(Action::Report),
            self.receive.as_ref().map(Action::Receive),
            self.advance.map(Action::Advance),
            self.lose.as_ref().map(Action::Lose),
            self.reconnect.as_ref().map(|_| Action::Reconnect),
            self.handed_on.as_deref().map(Action::HandedOn),
            self.cancel.as_deref().map(Action::Cancel),
            self.take.as_ref().map(|_| Action::Take),
            self.finish.as_ref().map(Action::Finish),
            self.close.as_ref().map(|_| Action::Close),
            self.shutdown.as_ref().map(Action::Shutdown),
            self.repeat.as_ref().map(Action::Repeat),
        ];
        let mut actions = all.into_iter().flatten();
        match (actions.next(), actions.next()) {
            (Some(action), None) => Ok(action),
            (None, _) => Err("nothing happens in this step".to_owned()),
            (Some(one), Some(other)) => Err(format!("two things at once: {one:?} and {other:?}")),
        }
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Nothing {}

/// A request that the peer under test opens.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Open {
    #[serde(rename = "as")]
    pub name: String,
    pub code: u16,
    pub timeout: Option<u64>,
    pub retries: Option<u32>,
    /// `true` if it may be sent once more after a loss of the connection; peers only.
    pub repeat: Option<bool>,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    Command,
    Report,
    Stream,
}

/// The meaning of a result code.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    Success,
    Protocol,
    Timeout,
    Invalid,
    Expired,
}

/// A frame that arrives.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Frame {
    #[serde(rename = "as")]
    pub name: Option<String>,
    /// The request that it answers. Other keys replace those of the response.
    pub answer_to: Option<String>,
    pub kind: Option<Kind>,
    pub code: Option<u16>,
    pub id: Option<u32>,
    /// A word for the content of the frame. The same word means the same digest.
    pub data: Option<String>,
    pub result: Option<Outcome>,
    /// The body is not valid for its code.
    #[serde(default)]
    pub broken: bool,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lose {
    /// Requests that wait for the next connection; sessions only, for peers know it themselves.
    #[serde(default)]
    pub keeps: Vec<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finish {
    pub handler_of: String,
    pub result: Option<Outcome>,
    /// Without a result, the handler panics.
    #[serde(default)]
    pub fails: bool,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shutdown {
    pub grace: u64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Repeat {
    pub times: u32,
    /// In each round the ids of frames that arrive are one more than in the last.
    pub steps: Vec<Step>,
}

/// An action of the peer under test.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Event {
    /// A request is sent for the first time.
    Sends(Sent),
    /// It is sent again, with its own id.
    Again(Sent),
    /// A request is not taken: too many are in flight.
    Busy(String),
    /// The frame is the answer to this request, which has ended with it.
    Answer(String),
    /// It is a response to no request in flight.
    Late,
    /// It is a command to be handled.
    Command,
    /// It is a report to be handed on.
    Report,
    /// It is a report that has been handed on before.
    Repeated,
    /// It is raw bytes.
    Stream,
    /// A request has ended without an answer.
    Expired(String),
    /// A request has ended because its connection was lost or its caller stopped waiting.
    Ended(String),
    /// A peer's call or report has ended for its caller.
    Ends(Ends),
    /// A peer answers a request.
    Answers(Answers),
    /// A receiver of the app gets this report.
    HandsOn(String),
    /// The handler of this command begins.
    Handles(String),
    /// The app has a connection.
    Connected,
    /// The app has lost its connection and makes another.
    Connecting,
    /// The app has no connection any more, for good.
    Closed,
    /// The peer has closed its end of the connection.
    Closes,
    /// The robot's shutdown is over.
    Over,
}

#[derive(Clone, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(deny_unknown_fields)]
pub struct Sent {
    #[serde(rename = "as")]
    pub name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub id: Option<u32>,
}

#[derive(Clone, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(deny_unknown_fields)]
pub struct Ends {
    #[serde(rename = "as")]
    pub name: String,
    pub with: String,
}

#[derive(Clone, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(deny_unknown_fields)]
pub struct Answers {
    pub to: String,
    pub result: Outcome,
}

/// The state after a step.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Then {
    pub in_flight: Option<usize>,
    #[serde(deserialize_with = "next_due")]
    pub next_due: Option<NextDue>,
    /// The same, or less: a peer may wake too early, never too late.
    pub next_due_by: Option<u64>,
}

/// Time at which the session must be asked again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NextDue {
    Never,
    /// In this many milliseconds.
    In(u128),
}

impl NextDue {
    pub fn new(milliseconds: Option<u128>) -> Self {
        milliseconds.map_or(Self::Never, Self::In)
    }
}

/// Distinguishes null, which means never, from a missing key.
fn next_due<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<NextDue>, D::Error> {
    let said = Option::<u64>::deserialize(deserializer)?;
    Ok(Some(NextDue::new(said.map(u128::from))))
}

/// The actions of a peer in a step.
#[derive(Debug, Default)]
pub struct Got(Vec<Event>);

impl Got {
    pub fn push(&mut self, event: Event) {
        self.0.push(event);
    }

    /// Compares with the expected actions, in any order.
    pub fn check(self, expected: &[Event]) -> Result<(), String> {
        let (mut left, mut missing) = (self.0, Vec::new());
        for event in expected {
            match left.iter().position(|got| got.is(event)) {
                Some(at) => drop(left.remove(at)),
                None => missing.push(event),
            }
        }
        if left.is_empty() && missing.is_empty() {
            return Ok(());
        }
        // As a script has them.
        let (missing, left) = (json!(missing), json!(left));
        Err(format!(
            "expected and not got: {missing}; got and not expected: {left}"
        ))
    }
}

impl Event {
    /// Returns `true` if the action is as expected. The id is compared only if one is expected.
    fn is(&self, expected: &Self) -> bool {
        let same = |got: &Sent, expected: &Sent| {
            got.name == expected.name && (expected.id.is_none() || got.id == expected.id)
        };
        match (self, expected) {
            (Self::Sends(got), Self::Sends(expected))
            | (Self::Again(got), Self::Again(expected)) => same(got, expected),
            (got, expected) => got == expected,
        }
    }
}

/// A position in a script.
#[derive(Clone, Debug, Default)]
pub struct Place(String);

impl Place {
    pub fn step(&self, index: usize) -> Self {
        let before = if self.0.is_empty() { "step" } else { &self.0 };
        Self(format!("{before} {}", index + 1))
    }

    pub fn round(&self, round: u32) -> Self {
        Self(format!("{}, round {}, step", self.0, round + 1))
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// The reason why a script does not hold.
pub type Failure = String;
