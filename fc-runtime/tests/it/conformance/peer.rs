//! The common part of scripts for whole peers: frames at the other end, and a clock that the script controls.

use super::script::{
    Action, Answers, Event, Failure, Frame, Given, Got, Kind, Open, Outcome, Place, Script, Sent,
    Side, Step, defaults,
};
use super::{app, robot};
use crate::common::net::Raw;
use crate::common::{Echo, Go, Moved, Toy};
use fc_runtime::{Command, FrameId, Limits, Protocol, Report as _};
use futures_util::FutureExt as _;
use serde_json::{Value, json};
use tokio::io::DuplexStream;
use tokio::sync::mpsc;
use tokio::task::yield_now;
use tokio::time::{Duration, Instant, advance};

/// A client or server under test.
pub trait Peer: Sized {
    async fn start(given: &Given) -> Self;
    /// The other end of its connection.
    fn wire(&mut self) -> &mut Wire;
    /// Performs an action that only this side has.
    async fn act(&mut self, action: Action<'_>) -> Result<(), Failure>;
    /// Results besides frames.
    fn look(&mut self, got: &mut Got);
    fn in_flight(&self) -> Option<usize>;
}

/// Runs a script in its own runtime.
pub fn run(script: &Script) -> Result<(), Failure> {
    let ack = script.given.ack.unwrap_or(defaults::ACK);
    if ack != defaults::ACK {
        return Err("a whole peer has the acknowledgement policy of its protocol".to_owned());
    }
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .start_paused(true)
        .build()
        .unwrap();
    runtime.block_on(async {
        match script.given.side {
            Side::App => steps::<app::App>(script).await,
            Side::Robot => steps::<robot::Robot>(script).await,
        }
    })
}

async fn steps<P: Peer>(script: &Script) -> Result<(), Failure> {
    let mut peer = P::start(&script.given).await;
    let start = Instant::now();
    for (index, step) in script.steps.iter().enumerate() {
        let at = start.elapsed().as_millis();
        one(&mut peer, step)
            .await
            .map_err(|why| format!("{}, begun at {at} ms: {why}", Place::default().step(index)))?;
    }
    Ok(())
}

async fn one<P: Peer>(peer: &mut P, step: &Step) -> Result<(), Failure> {
    match step.action()? {
        Action::Receive(frame) => peer.wire().send(frame).await?,
        Action::Advance(time) => advance(Duration::from_millis(time)).await,
        Action::HandedOn(_) => return Err("a peer knows itself what it has handed on".to_owned()),
        Action::Repeat(_) => return Err("no script of a peer needs that yet".to_owned()),
        action => peer.act(action).await?,
    }
    let mut got = Got::default();
    // The peer may continue when the other end is closed as well.
    for _ in 0..2 {
        settle().await;
        peer.wire().drain(&mut got)?;
        peer.look(&mut got);
    }
    got.check(&step.expect)?;
    let Some(then) = &step.then else {
        return Ok(());
    };
    if then.next_due.is_some() || then.next_due_by.is_some() {
        return Err("a peer does not tell when it wakes up".to_owned());
    }
    if then.in_flight != peer.in_flight() {
        return Err(format!("{:?} calls are in flight", peer.in_flight()));
    }
    Ok(())
}

/// Lets all tasks go on as far as they can without time.
async fn settle() {
    for _ in 0..100 {
        yield_now().await;
    }
}

pub fn limits(given: &Given) -> Limits {
    Limits {
        in_flight: given.in_flight.unwrap_or(defaults::IN_FLIGHT),
        queued_reports: given.queued_reports.unwrap_or(defaults::QUEUED_REPORTS),
        ..Toy::DEFAULTS.limits
    }
}

pub fn milliseconds(given: Option<u64>, default: u64) -> Duration {
    Duration::from_millis(given.unwrap_or(default))
}

/// Results of a task that reach the test.
pub struct Results<T> {
    pub sender: mpsc::UnboundedSender<T>,
    receiver: mpsc::UnboundedReceiver<T>,
}

impl<T> Results<T> {
    pub fn new() -> Self {
        let (sender, receiver) = mpsc::unbounded_channel();
        Self { sender, receiver }
    }

    pub fn next(&mut self) -> Option<T> {
        self.receiver.try_recv().ok()
    }
}

/// A request of the peer under test.
struct Request {
    name: String,
    code: u16,
    /// Once it has been sent.
    frame: Option<FrameId>,
}

/// A frame that was sent to the peer under test.
struct Arrived {
    name: String,
    frame: FrameId,
    body: Value,
}

/// The other end of the connection.
#[derive(Default)]
pub struct Wire {
    raw: Option<Raw<DuplexStream>>,
    requests: Vec<Request>,
    arrived: Vec<Arrived>,
}

impl Wire {
    /// A new connection; gives the end of the peer under test.
    pub fn connect(&mut self) -> DuplexStream {
        const PIPE: usize = 64 * 1024;

        let (theirs, ours) = tokio::io::duplex(PIPE);
        self.raw = Some(Raw::new(ours));
        theirs
    }

    pub fn lose(&mut self) {
        self.raw = None;
    }

    /// A request of the peer under test. Its number has to be in its body, so that it is known again.
    pub fn request(&mut self, open: &Open) -> usize {
        self.requests.push(Request {
            name: open.name.clone(),
            code: toy(open.code),
            frame: None,
        });
        self.requests.len() - 1
    }

    pub fn number_of(&self, name: &str) -> Result<usize, Failure> {
        let found = self
            .requests
            .iter()
            .rposition(|request| request.name == name);
        found.ok_or_else(|| format!("there is no request {name}"))
    }

    pub fn name_of(&self, number: usize) -> String {
        self.requests[number].name.clone()
    }

    /// The name of the last frame that has arrived with this code, id and body.
    pub fn arrived(&self, code: u16, id: u32, body: Option<&Value>) -> Option<String> {
        let same = |arrived: &&Arrived| {
            (arrived.frame.code, arrived.frame.id) == (code, id)
                && body.is_none_or(|body| *body == arrived.body)
        };
        let found = self.arrived.iter().rev().find(same);
        found.map(|arrived| arrived.name.clone())
    }

    async fn send(&mut self, arriving: &Frame) -> Result<(), Failure> {
        let answered = match &arriving.answer_to {
            Some(name) => {
                let request = &self.requests[self.number_of(name)?];
                let sent = request
                    .frame
                    .ok_or_else(|| format!("{name} has not been sent"))?;
                Some(sent.answer())
            }
            None => None,
        };
        let missing = "a frame that answers nothing has kind, code and id";
        let kind = arriving.kind.map(|kind| match kind {
            Kind::Command => Toy::COMMAND,
            Kind::Report => Toy::REPORT,
            Kind::Stream => Toy::STREAM,
        });
        let frame = FrameId {
            response: answered.is_some(),
            kind: kind.or(answered.map(|frame| frame.kind)).ok_or(missing)?,
            code: (arriving.code.map(toy).or(answered.map(|frame| frame.code))).ok_or(missing)?,
            id: (arriving.id.or(answered.map(|frame| frame.id))).ok_or(missing)?,
        };
        let mut body = if frame.response {
            let result = result_code(arriving.result.unwrap_or(Outcome::Success));
            json!({ "result": result, "text": "" })
        } else {
            match frame.code {
                Echo::CODE => json!({ "text": "" }),
                _ => json!({ "metres": 1 }),
            }
        };
        if arriving.broken {
            body = json!({ "text": 1, "metres": "" });
        }
        if let Some(data) = &arriving.data {
            body["data"] = json!(data);
        }
        if let Some(name) = &arriving.name {
            self.arrived.push(Arrived {
                name: name.clone(),
                frame,
                body: body.clone(),
            });
        }
        let raw = self.raw.as_mut().ok_or("there is no connection")?;
        raw.send_frame(frame, &body.to_string()).await;
        Ok(())
    }

    /// Frames sent by the peer under test.
    fn drain(&mut self, got: &mut Got) -> Result<(), Failure> {
        while let Some(raw) = &mut self.raw
            && let Some(received) = raw.recv().now_or_never()
        {
            let Some((frame, body)) = received else {
                self.raw = None;
                got.push(Event::Closes);
                break;
            };
            let body: Value =
                serde_json::from_str(&body).map_err(|error| format!("{frame}: {error}"))?;
            got.push(self.event(frame, &body)?);
        }
        Ok(())
    }

    fn event(&mut self, frame: FrameId, body: &Value) -> Result<Event, Failure> {
        if frame.response {
            let to = self.arrived(frame.code, frame.id, None);
            return Ok(Event::Answers(Answers {
                to: to.ok_or_else(|| format!("the {frame} answers nothing"))?,
                result: outcome(&body["result"])?,
            }));
        }
        let number = body["metres"]
            .as_u64()
            .or(body["text"].as_str().and_then(|text| text.parse().ok()));
        let number = number.and_then(|number| usize::try_from(number).ok());
        let request = number.and_then(|number| self.requests.get_mut(number));
        let request = request.ok_or_else(|| format!("the {frame} is nobody's: {body}"))?;
        let sent = Sent {
            name: request.name.clone(),
            id: Some(frame.id),
        };
        let kind = if request.code == Moved::CODE {
            Toy::REPORT
        } else {
            Toy::COMMAND
        };
        match request.frame {
            Some(before) if before == frame => Ok(Event::Again(sent)),
            None if (frame.kind, frame.code) == (kind, request.code) => {
                request.frame = Some(frame);
                Ok(Event::Sends(sent))
            }
            _ => Err(format!("{} is sent as {frame}", request.name)),
        }
    }
}

/// The operations of the scripts' protocol, by its codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// A command that only reads.
    Read,
    /// A command that moves something.
    Motion,
    Report,
}

impl Operation {
    pub fn of(code: u16) -> Result<Self, Failure> {
        match code {
            100 => Ok(Self::Read),
            200 => Ok(Self::Motion),
            300 => Ok(Self::Report),
            _ => Err(format!("there is no operation {code}")),
        }
    }
}

/// Returns the code of a frame in this protocol. A code without an operation stays unchanged.
fn toy(code: u16) -> u16 {
    match Operation::of(code) {
        Ok(Operation::Read) => Echo::CODE,
        Ok(Operation::Motion) => Go::CODE,
        Ok(Operation::Report) => Moved::CODE,
        Err(_) => code,
    }
}

const OUTCOMES: [Outcome; 5] = [
    Outcome::Success,
    Outcome::Protocol,
    Outcome::Timeout,
    Outcome::Invalid,
    Outcome::Expired,
];

/// The result code of this protocol.
pub fn result_code(outcome: Outcome) -> i64 {
    let results = &Toy::RESULTS;
    match outcome {
        Outcome::Success => results.success.code,
        Outcome::Protocol => results.protocol.code,
        Outcome::Timeout => results.timeout.code,
        Outcome::Invalid => results.invalid.code,
        Outcome::Expired => results.expired.code,
    }
}

fn outcome(code: &Value) -> Result<Outcome, Failure> {
    let found = OUTCOMES
        .into_iter()
        .find(|outcome| *code == result_code(*outcome));
    found.ok_or_else(|| format!("unknown result code {code}"))
}
