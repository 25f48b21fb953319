//! The session scripts of `conformance/sessions` against a connection, with frames at its other end.

#[allow(dead_code, reason = "the runner of fc-runtime needs the rest")]
#[path = "../../../fc-runtime/tests/it/conformance/script.rs"]
mod script;

use crate::support::small;
use fc_reflect::{Direction, Frame, FrameId, Packing, Reflector};
use fc_runtime::AckPolicy;
use fc_spec::model::{self, Model};
use fc_workshop::connection::{self, Connection, NotSent};
use fc_workshop::stream::FrameStream;
use futures_util::FutureExt as _;
use script::{
    Action, Event, Failure, Given, Got, IdBits, Kind, Level, Open, Script, Sent, Step, defaults,
};
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _, DuplexStream, duplex};
use tokio::runtime::{Builder, Runtime};
use tokio::task::unconstrained;
use tokio::time::{advance, timeout};

/// The largest number of bytes between the two ends.
const PIPE: usize = 1 << 20;

/// Parts of scripts that do not apply to a connection, with the reason.
const SKIPPED: &[(&str, &str)] = &[
    ("lose", "a connection ends with its byte stream"),
    ("reconnect", "a connection ends with its byte stream"),
    ("cancel", "every caller waits for its response"),
    ("id_bits", "the spec of the test has ids of 32 bits"),
    ("timeout", "a call without any time ends at once"),
    (
        "remembers",
        "a connection and its spec have the same limit of requests in flight",
    ),
];

/// Returns the parts of a script that do not apply.
fn skipped(script: &Script) -> Vec<&'static str> {
    fn actions<'s>(steps: &'s [Step], found: &mut Vec<Action<'s>>) {
        for step in steps {
            let action = step.action().unwrap();
            if let Action::Repeat(repeat) = action {
                actions(&repeat.steps, found);
            }
            found.push(action);
        }
    }
    let mut all = Vec::new();
    actions(&script.steps, &mut all);
    let has = |part: &str| match part {
        "lose" => all.iter().any(|it| matches!(it, Action::Lose(_))),
        "reconnect" => all.iter().any(|it| matches!(it, Action::Reconnect)),
        "cancel" => all.iter().any(|it| matches!(it, Action::Cancel(_))),
        "id_bits" => script.given.id_bits == IdBits::Sixteen,
        "timeout" => all
            .iter()
            .any(|it| matches!(it, Action::Call(open) if open.timeout == Some(0))),
        "remembers" => script.given.remembers.is_some(),
        other => panic!("{other}"),
    };
    let parts = SKIPPED.iter().map(|(part, _)| *part);
    parts.filter(|part| has(part)).collect()
}

/// The small protocol, with the limits of a script.
fn model_of(given: &Given) -> Model {
    let mut model = small();
    let number = |count: usize| u32::try_from(count).unwrap();
    model.limits.in_flight = number(given.in_flight.unwrap_or(defaults::IN_FLIGHT));
    model.limits.queued_reports = number(given.queued_reports.unwrap_or(defaults::QUEUED_REPORTS));
    let ack = given.ack.unwrap_or(defaults::ACK);
    model.calls.ack = model::Ack {
        timeout_ms: u32::try_from(ack.timeout).unwrap(),
        retries: ack.retries,
    };
    model
}

/// A request of the connection.
struct Request {
    name: String,
    id: FrameId,
    is_sent: bool,
}

struct Run<'m> {
    reflector: &'m Reflector<'m>,
    given: &'m Given,
    connection: Connection<'m, DuplexStream, String>,
    /// The other end.
    wire: DuplexStream,
    received: FrameStream,
    requests: Vec<Request>,
    /// Names of the frames that were sent to the connection.
    arriving: HashMap<FrameId, String>,
    reports: HashMap<String, Frame<'m>>,
    got: Got,
    acknowledged: usize,
    sent_frames: u32,
}

/// Returns a runtime with a paused clock.
fn paused() -> Runtime {
    let mut builder = Builder::new_current_thread();
    builder.enable_all().start_paused(true).build().unwrap()
}

fn run(script: &Script) -> Result<(), Failure> {
    let model = model_of(&script.given);
    let reflector = Reflector::new(&model);
    let runtime = paused();
    // A step takes all that needs no more time, so a task must not yield within it.
    runtime.block_on(unconstrained(async {
        let (ours, wire) = duplex(PIPE);
        let mut run = Run {
            reflector: &reflector,
            given: &script.given,
            connection: Connection::new(&reflector, ours, script.given.first_id),
            wire,
            received: FrameStream::default(),
            requests: Vec::new(),
            arriving: HashMap::new(),
            reports: HashMap::new(),
            got: Got::default(),
            acknowledged: 0,
            sent_frames: 0,
        };
        run.steps(&script.steps, 0).await
    }))
}

impl<'m> Run<'m> {
    async fn steps(&mut self, steps: &[Step], round: u32) -> Result<(), Failure> {
        for (index, step) in steps.iter().enumerate() {
            if let Action::Repeat(repeat) = step.action()? {
                for round in 0..repeat.times {
                    Box::pin(self.steps(&repeat.steps, round)).await?;
                }
            } else {
                let done = self.step(step, round).await;
                done.map_err(|why| format!("step {}, round {round}: {why}", index + 1))?;
            }
        }
        Ok(())
    }

    async fn step(&mut self, step: &Step, round: u32) -> Result<(), Failure> {
        let mut acknowledged = 0;
        match step.action()? {
            Action::Call(open) => {
                let timeout = self.given.call_timeout.unwrap_or(defaults::CALL_TIMEOUT);
                self.open(open, Kind::Command, timeout, 0)?;
            }
            Action::Report(open) => {
                let ack = self.given.ack.unwrap_or(defaults::ACK);
                self.open(open, Kind::Report, ack.timeout, ack.retries)?;
            }
            Action::Receive(frame) => self.send(frame, round).await?,
            Action::Advance(time) => advance(Duration::from_millis(time)).await,
            Action::HandedOn(name) => {
                let report = self.reports.get(name).ok_or("no such report")?;
                self.connection.acknowledge(report);
                acknowledged = 1;
            }
            other => return Err(format!("a connection cannot do that: {other:?}")),
        }
        self.look()?;
        if acknowledged == 0 && self.acknowledged > 0 {
            // A repetition is acknowledged without an event.
            self.got.push(Event::Repeated);
            acknowledged = 1;
        }
        if std::mem::take(&mut self.acknowledged) != acknowledged {
            return Err("an acknowledgement is missing, or sent twice".to_owned());
        }
        std::mem::take(&mut self.got).check(&step.expect)?;
        let in_flight = self.connection.in_flight();
        match step.then.as_ref().and_then(|then| then.in_flight) {
            Some(expected) if expected != in_flight => {
                Err(format!("{in_flight} requests are in flight"))
            }
            _ => Ok(()),
        }
    }

    fn kind(&self, kind: Kind) -> u8 {
        let kinds = &self.reflector.model().frame.kinds;
        match kind {
            Kind::Command => kinds.command.value,
            Kind::Report => kinds.report.value,
            Kind::Stream => kinds.stream.value,
        }
    }

    fn open(&mut self, open: &Open, kind: Kind, timeout: u64, retries: u32) -> Result<(), Failure> {
        let policy = AckPolicy {
            timeout: Duration::from_millis(open.timeout.unwrap_or(timeout)),
            retries: open.retries.unwrap_or(retries),
        };
        let name = open.name.clone();
        let data: Arc<[u8]> = format!("{{\"name\":\"{name}\"}}").into_bytes().into();
        let kind = self.kind(kind);
        let sent = (self.connection).request(kind, open.code, &data, policy, name.clone());
        match sent {
            Ok(id) => self.requests.push(Request {
                name,
                id,
                is_sent: false,
            }),
            Err(NotSent::Busy(_)) => self.got.push(Event::Busy(name)),
            Err(error) => return Err(error.to_string()),
        }
        Ok(())
    }

    /// Sends a frame to the connection.
    async fn send(&mut self, frame: &script::Frame, round: u32) -> Result<(), Failure> {
        let answered = frame.answer_to.as_ref().map(|name| {
            let mut requests = self.requests.iter().rev();
            requests
                .find(|it| it.name == *name)
                .map(|it| it.id.answer())
        });
        let answered = answered
            .map(|found| found.ok_or("no such request"))
            .transpose()?;
        let missing = "a frame that answers nothing has kind, code and id";
        let kind = frame.kind.map(|kind| self.kind(kind));
        let id = frame.id.map(|id| id.wrapping_add(round));
        let id = FrameId {
            direction: answered.map_or(Direction::Request, |_| Direction::Response),
            kind: kind.or(answered.map(|it| it.kind)).ok_or(missing)?,
            code: frame.code.or(answered.map(|it| it.code)).ok_or(missing)?,
            id: id.or(answered.map(|it| it.id)).ok_or(missing)?,
        };
        self.sent_frames += 1;
        // Without a word, only the id tells whether a report was there before.
        let other = self.sent_frames.to_string();
        let data = frame.data.as_deref().unwrap_or(&other);
        let data = format!("{{\"at\":1,\"rc\":0,\"word\":\"{data}\"}}");
        let sealed = self.reflector.seal(id, data.as_bytes(), Packing::Plain);
        if let Some(name) = &frame.name {
            self.arriving.insert(id, name.clone());
        }
        let bytes = sealed.map_err(|error| error.to_string())?;
        self.wire
            .write_all(&bytes)
            .await
            .map_err(|error| error.to_string())
    }

    /// Takes all events and all frames that need no more time.
    fn look(&mut self) -> Result<(), Failure> {
        loop {
            let before = self.received.rest().len();
            if let Some(event) = self.connection.next().now_or_never() {
                self.event(event)?;
                continue;
            }
            let read = self.wire.read_buf(self.received.room()).now_or_never();
            while let Some(piece) =
                (self.received.next(self.reflector)).map_err(|error| error.to_string())?
            {
                self.sent(piece.frame.map_err(|error| error.to_string())?.id)?;
            }
            if read.is_none() && self.received.rest().len() == before {
                return Ok(());
            }
        }
    }

    fn event(&mut self, event: connection::Event<'m, String>) -> Result<(), Failure> {
        use connection::Event as It;
        self.got.push(match event {
            It::Answer(name, _) => Event::Answer(name),
            It::Expired(name) => Event::Expired(name),
            It::Late(_) => Event::Late,
            It::Command(_) => Event::Command,
            It::Stream(_) => Event::Stream,
            It::Report(frame) => {
                if let Some(name) = self.arriving.get(&frame.id) {
                    self.reports.insert(name.clone(), frame);
                }
                Event::Report
            }
            other => return Err(format!("{other:?}")),
        });
        Ok(())
    }

    /// Takes a frame that the connection has sent.
    fn sent(&mut self, id: FrameId) -> Result<(), Failure> {
        if id.direction == Direction::Response {
            self.acknowledged += 1;
            return Ok(());
        }
        let mut requests = self.requests.iter_mut().rev();
        let request = requests.find(|request| request.id == id);
        let request = request.ok_or_else(|| format!("{id:?} is no request"))?;
        let sent = Sent {
            name: request.name.clone(),
            id: Some(id.id),
        };
        self.got
            .push(if std::mem::replace(&mut request.is_sent, true) {
                Event::Again(sent)
            } else {
                Event::Sends(sent)
            });
        Ok(())
    }
}

#[test]
fn a_connection_holds_the_session_scripts() {
    let mut failures = Vec::new();
    let (mut held, mut unused) = (0, SKIPPED.iter().map(|(part, _)| *part).collect::<Vec<_>>());
    for (path, text) in script::json_files(&script::folder().join("sessions")) {
        let file: script::File = serde_json::from_str(&text).unwrap();
        // Connecting again, queues and handlers are those of whole peers.
        for script in file.scripts.iter().filter(|_| file.level == Level::Session) {
            let skipped = skipped(script);
            unused.retain(|part| !skipped.contains(part));
            if !skipped.is_empty() {
                continue;
            }
            match run(script) {
                Ok(()) => held += 1,
                Err(why) => failures.push(format!("{}: {}: {why}", path.display(), script.name)),
            }
        }
    }
    assert!(failures.is_empty(), "{held} held\n{}", failures.join("\n"));
    assert!(held >= 60, "{held} held");
    assert!(unused.is_empty(), "no script has {unused:?}");
}

#[test]
fn finishing_does_not_wait_for_a_stalled_peer() {
    let model = small();
    let reflector = Reflector::new(&model);
    let runtime = paused();
    runtime.block_on(async {
        let (ours, _wire) = duplex(16);
        let mut connection: Connection<'_, _, ()> = Connection::new(&reflector, ours, 1);
        connection.send(&[0; 64]);
        let finished = timeout(Duration::from_secs(60), connection.finish()).await;
        let error = finished.expect("an end").unwrap_err();
        assert_eq!(error.kind(), std::io::ErrorKind::TimedOut);
    });
}
