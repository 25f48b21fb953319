//! Samples that call and answer each operation, for the documentation's pages.
//!
//! A file of each package contains the same samples and runs them.

use super::context::Context;
use super::source::Source;
use super::style::Style;
use crate::package::expr::Record;
use crate::package::items::{Call, Spelled};
use crate::package::language::Language;
use crate::sample::Profile;
use fc_spec::model::{Direction, Kind, Operation, Side};

/// The width of a line on a page, in columns. A page is narrower than a file.
pub const PAGE_WIDTH: usize = 80;

/// A language in which the pages show every operation.
pub struct SampleTab {
    /// The language of a fence.
    pub fence: &'static str,
    /// The file with all samples, relative to the product's root.
    pub file: &'static str,
    /// The rules for names.
    pub language: &'static Language,
    /// The style on a page.
    pub style: &'static Style,
    /// Writes a sample.
    pub write: fn(&mut Source, &Context<'_>, &Sample<'_, '_>),
}

/// A sample with its values. A stream without a value carries bytes.
pub enum Sample<'p, 'm> {
    /// An app calls a command.
    Call(Call<'p>, Record<'p>),
    /// An app receives a report.
    Take(Call<'p>),
    /// An app subscribes to a stream.
    Subscribe(&'p Spelled<'m, Operation>),
    /// An app sends a stream.
    Send(&'p Spelled<'m, Operation>, Option<Record<'p>>),
    /// A robot answers a command.
    Answer(Call<'p>, Record<'p>),
    /// A robot pushes a report.
    Push(Call<'p>, Record<'p>),
    /// A robot sends a stream.
    Stream(&'p Spelled<'m, Operation>, Option<Record<'p>>),
}

/// The bytes that a stream carries in the samples.
pub const BYTES: &str = "any bytes";

/// Returns the app's sample of an operation; `None` without a code.
pub fn app<'p, 'm>(context: &'p Context<'m>, operation: &'p Operation) -> Option<Sample<'p, 'm>> {
    let example = || example(context, operation, Direction::Request);
    Some(match operation.kind() {
        Kind::Command => Sample::Call(context.package.call(operation)?, example()?),
        Kind::Report => Sample::Take(context.package.call(operation)?),
        Kind::Stream => {
            let stream = context.package.stream(operation)?;
            match stream.sender {
                Side::Robot => Sample::Subscribe(stream),
                Side::App => Sample::Send(stream, example()),
            }
        }
    })
}

/// Returns the robot's sample of an operation; `None` without a code, and for a stream of the app.
pub fn robot<'p, 'm>(context: &'p Context<'m>, operation: &'p Operation) -> Option<Sample<'p, 'm>> {
    let example = |direction| example(context, operation, direction);
    Some(match operation.kind() {
        Kind::Command => {
            let call = context.package.call(operation)?;
            Sample::Answer(call, example(Direction::Response)?)
        }
        Kind::Report => {
            let call = context.package.call(operation)?;
            Sample::Push(call, example(Direction::Request)?)
        }
        Kind::Stream => {
            let stream = context.package.stream(operation)?;
            if stream.sender == Side::App {
                return None;
            }
            Sample::Stream(stream, example(Direction::Request))
        }
    })
}

/// Returns the spec's example of a body; `None` for a stream of bytes.
fn example<'p>(
    context: &'p Context<'_>,
    operation: &Operation,
    direction: Direction,
) -> Option<Record<'p>> {
    let body = operation.body(direction)?;
    let value = context
        .samples()
        .body(operation, direction, Profile::Example);
    Some(context.package.record(&body.ty, &value))
}

/// All samples of a package, in the order of the file. Each is built when it is written.
pub struct SampleRun<'p, 'm> {
    context: &'p Context<'m>,
    steps: Vec<SampleStep<'p>>,
}

/// A function that contains a sample.
#[derive(Clone, Copy, Debug)]
pub struct SampleStep<'p> {
    /// The action of the function.
    pub verb: Verb,
    /// The operation in the spec.
    pub operation: &'p Operation,
}

/// The action of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verb {
    /// An app calls a command.
    Call,
    /// An app receives a report.
    Take,
    /// A robot pushes a report.
    Push,
    /// An app subscribes to a stream.
    Subscribe,
    /// A robot sends a stream.
    Stream,
    /// An app sends a stream.
    Send,
}

impl<'p, 'm> SampleRun<'p, 'm> {
    /// Lists the samples of a package.
    pub fn build(context: &'p Context<'m>) -> Self {
        let mut steps = Vec::new();
        let mut add = |verb, operation| steps.push(SampleStep { verb, operation });
        for Call { operation, .. } in context.commands() {
            add(Verb::Call, operation);
        }
        for Call { operation, .. } in context.reports() {
            add(Verb::Take, operation);
            add(Verb::Push, operation);
        }
        let streams = context.package.streams.iter().map(|stream| stream.of);
        for operation in streams.clone().filter(|it| it.sender == Side::Robot) {
            add(Verb::Subscribe, operation);
            add(Verb::Stream, operation);
        }
        for operation in streams.filter(|it| it.sender == Side::App) {
            add(Verb::Send, operation);
        }
        Self { context, steps }
    }

    /// Returns the robot's responses.
    pub fn answers(&self) -> impl Iterator<Item = Sample<'p, 'm>> {
        let commands = self.that(Verb::Call);
        commands.filter_map(|step| robot(self.context, step.operation))
    }

    /// Returns all steps with their samples.
    pub fn samples(&self) -> impl Iterator<Item = (SampleStep<'p>, Sample<'p, 'm>)> {
        let steps = self.steps.iter().copied();
        steps.filter_map(|step| Some((step, self.sample(step)?)))
    }

    /// Returns the sample of a step.
    pub fn sample(&self, step: SampleStep<'p>) -> Option<Sample<'p, 'm>> {
        match step.verb {
            Verb::Call | Verb::Take | Verb::Subscribe | Verb::Send => {
                app(self.context, step.operation)
            }
            Verb::Push | Verb::Stream => robot(self.context, step.operation),
        }
    }

    /// Returns the steps with this action.
    pub fn that(&self, verb: Verb) -> impl Iterator<Item = SampleStep<'p>> {
        let steps = self.steps.iter().copied();
        steps.filter(move |step| step.verb == verb)
    }

    /// Returns `true` if any step has this action.
    pub fn has(&self, verb: Verb) -> bool {
        self.that(verb).next().is_some()
    }

    /// Returns `true` if any step needs the data port.
    pub fn has_streams(&self) -> bool {
        self.has(Verb::Subscribe) || self.has(Verb::Send)
    }
}

impl SampleStep<'_> {
    /// Returns the name of the function in words: `call_get_station`.
    pub fn name(self) -> String {
        let verb = match self.verb {
            Verb::Call => "call",
            Verb::Take => "take",
            Verb::Push => "push",
            Verb::Subscribe => "subscribe",
            Verb::Stream | Verb::Send => "send",
        };
        [verb, "_", &self.operation.name].concat()
    }

    /// Returns the name and the type of the parameter, which is a stub.
    pub fn parameter(self) -> [&'static str; 2] {
        match self.verb {
            Verb::Call | Verb::Take => ["client", "Client"],
            Verb::Push => ["reporter", "Reporter"],
            Verb::Stream => ["streamer", "Streamer"],
            Verb::Subscribe | Verb::Send => ["streams", "Streams"],
        }
    }
}
