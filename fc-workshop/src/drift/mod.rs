//! Compares recorded frames with the spec.
//!
//! ```text
//! Records of `decode` ──message, exchange, process──► Deviations ──text, json──► output
//! ```

mod exchange;
mod json;
mod message;
mod process;
mod suggest;
mod text;

pub use json::line as json;
pub use suggest::suggest;
pub use text::deviation as text;

use crate::capture::Flow;
use crate::decode::Record;
use exchange::Exchanges;
use fc_reflect::{BodyErrorKind, Error, FrameFault};
use fc_spec::model::{Direction, Model, Operation};
use process::Processes;
use std::collections::HashMap;
use std::time::Duration;

/// Different deviations that are kept. Others are only counted.
const KEPT: usize = 10_000;

/// Bytes of an example.
const EXAMPLE: usize = 1024;

/// A way in which peers differ from the spec.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DeviationKind {
    /// A frame is invalid.
    Frame(FrameFault),
    /// A body is invalid.
    Body(BodyErrorKind),
    /// The spec has no operation with this kind and code.
    UnknownCode,
    /// The spec has no field with this key.
    UnknownKey,
    /// An open enum has no such value.
    UnknownEnumValue,
    /// The spec has no result with this code.
    UnknownResult,
    /// A command has no response.
    Unanswered,
    /// A report has no acknowledgement.
    Unacknowledged,
    /// A state follows one that it cannot follow.
    StateOrder,
    /// A report comes at another time than its cadence allows.
    Cadence,
}

impl DeviationKind {
    /// Returns the name. Errors of frames and bodies have the same name as in all products of the spec.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Frame(fault) => fault.name(),
            Self::Body(kind) => kind.name(),
            Self::UnknownCode => "unknown_code",
            Self::UnknownKey => "unknown_key",
            Self::UnknownEnumValue => "unknown_enum_value",
            Self::UnknownResult => "unknown_result",
            Self::Unanswered => "unanswered",
            Self::Unacknowledged => "unacknowledged",
            Self::StateOrder => "state_order",
            Self::Cadence => "cadence",
        }
    }
}

/// The place of a deviation in the protocol. Deviations at the same place are counted together.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    /// The way in which peers differ.
    pub kind: DeviationKind,
    /// The kind and code of the frame, if its header shows them.
    pub code: Option<(u8, u16)>,
    /// The side of the message.
    pub direction: Option<Direction>,
    /// The struct with the key at the end of the path, as far as a valid body shows it.
    pub owner: Option<String>,
    /// The path of wire keys, such as `data.stations[].x`. Empty for a whole message.
    pub path: String,
    /// An unknown value or result as JSON; empty for other kinds.
    pub value: String,
}

/// A difference between the spec and the recorded frames.
#[derive(Clone, Debug)]
pub struct Deviation<'m> {
    /// The place in the protocol.
    pub place: Place,
    /// The operation, or `None` if the spec has none with this code.
    pub operation: Option<&'m Operation>,
    /// The number of times.
    pub count: u64,
    /// The time of the first frame, if the input has times.
    pub time: Option<Duration>,
    /// The connection of the first frame, if the input has connections.
    pub flow: Option<Flow>,
    /// The position of the first frame in the input, or in its direction of the connection.
    pub offset: u64,
    /// The content of the first frame there, as JSON text if it is a value. Long content is cut.
    pub example: String,
    /// The content that the spec demands, if an error describes it.
    pub expected: String,
}

/// Collects the deviations of records. Memory is bounded.
pub struct Drift<'m> {
    model: &'m Model,
    found: Found<'m>,
    exchanges: Exchanges<'m>,
    processes: Processes<'m>,
    frames: usize,
}

impl<'m> Drift<'m> {
    /// Creates an empty collection.
    #[must_use]
    pub fn new(model: &'m Model) -> Self {
        Self {
            model,
            found: Found::default(),
            exchanges: Exchanges::default(),
            processes: Processes::default(),
            frames: 0,
        }
    }

    /// Compares a record with the spec. Records of a connection must come in their order.
    pub fn observe(&mut self, record: &Record<'m>) {
        self.frames += usize::from(record.frame.is_some());
        message::compare(self.model, record, &mut self.found);
        let repeated = self.exchanges.follow(self.model, record, &mut self.found);
        if !repeated && record.error.is_none() {
            self.processes.follow(self.model, record, &mut self.found);
        }
    }

    /// Ends the input, and returns all deviations in the order of their first frames.
    #[must_use]
    pub fn finish(mut self) -> Report<'m> {
        self.exchanges.finish(&mut self.found);
        Report {
            frames: self.frames,
            uncounted: self.found.dropped,
            deviations: self.found.list,
        }
    }
}

/// The deviations of an input.
#[derive(Clone, Debug)]
pub struct Report<'m> {
    /// The valid frames.
    pub frames: usize,
    /// The deviations in the order of their first frames.
    pub deviations: Vec<Deviation<'m>>,
    /// Deviations at further places, which are not in the list because it is full.
    pub uncounted: u64,
}

/// The deviations found so far.
#[derive(Default)]
struct Found<'m> {
    list: Vec<Deviation<'m>>,
    places: HashMap<Place, usize>,
    dropped: u64,
}

impl<'m> Found<'m> {
    /// Counts a deviation of a record.
    fn add(&mut self, record: &Record<'m>, place: Place, example: impl FnOnce() -> String) {
        self.add_at(&Moment::of(record), place, || (example(), String::new()));
    }

    /// Counts a deviation of an earlier record. `content` returns the example and the expected content.
    fn add_at(
        &mut self,
        moment: &Moment<'m>,
        place: Place,
        content: impl FnOnce() -> (String, String),
    ) {
        if let Some(&index) = self.places.get(&place) {
            if let Some(deviation) = self.list.get_mut(index) {
                deviation.count += 1;
            }
            return;
        }
        if self.list.len() >= KEPT {
            self.dropped += 1;
            return;
        }
        self.places.insert(place.clone(), self.list.len());
        let (example, expected) = content();
        self.list.push(Deviation {
            place,
            operation: moment.operation,
            count: 1,
            time: moment.time,
            flow: moment.flow,
            offset: moment.offset,
            example: cut(example),
            expected: cut(expected),
        });
    }
}

/// The identity of a frame in the input.
#[derive(Clone, Copy)]
struct Moment<'m> {
    operation: Option<&'m Operation>,
    time: Option<Duration>,
    flow: Option<Flow>,
    offset: u64,
}

impl<'m> Moment<'m> {
    fn of(record: &Record<'m>) -> Self {
        Self {
            operation: record.operation,
            time: record.time,
            flow: record.flow,
            offset: record.offset,
        }
    }
}

/// Returns the place of a whole message.
fn place(record: &Record<'_>, kind: DeviationKind) -> Place {
    let id = record.id;
    Place {
        kind,
        code: id.map(|id| (id.kind, id.code)),
        direction: id.map(|id| id.direction),
        owner: None,
        path: String::new(),
        value: String::new(),
    }
}

/// Returns the kind of the error in a record.
fn kind(error: &Error) -> DeviationKind {
    match error {
        Error::Frame(error) => DeviationKind::Frame(error.fault),
        Error::Body { error, .. } => DeviationKind::Body(error.kind()),
    }
}

/// Returns a path with `[]` for each index, so that all items of a list share it.
fn of_all_items(path: &str) -> String {
    let mut all = String::with_capacity(path.len());
    let mut inside = false;
    for char in path.chars() {
        inside &= char != ']';
        if !inside {
            all.push(char);
        }
        inside |= char == '[';
    }
    all
}

/// Returns the beginning of a text.
fn cut(mut text: String) -> String {
    let end = (0..=EXAMPLE.min(text.len())).rev();
    let end = end.into_iter().find(|end| text.is_char_boundary(*end));
    text.truncate(end.unwrap_or_default());
    text
}
