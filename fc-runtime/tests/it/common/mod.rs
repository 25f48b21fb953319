//! A small protocol, unlike any real one, to test the runtime with.

pub mod log;
pub mod net;
pub mod short;

use fc_derive::{Command, Envelope, Header, Message, OpenEnum, Report};
use fc_runtime::{
    AckPolicy, BodyInfo, Cadence, Defaults, Effect, Empty, Encoder, FrameId, Limits, OperationInfo,
    OperationKind, Protocol, Report as _, ResultText, Results,
};
use std::panic::Location;
use std::time::{Duration, Instant};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Header)]
#[fc(byte_order = "little")]
pub struct ToyHeader {
    #[fc(role = "head")]
    pub head: [u8; 3],
    #[fc(role = "total_length")]
    pub total: u32,
    #[fc(role = "kind")]
    pub kind: u8,
    #[fc(role = "encoding")]
    pub encoding: u8,
    #[fc(value = 0x77)]
    pub spare: u16,
    #[fc(role = "code")]
    pub code: u16,
    #[fc(role = "id")]
    pub id: u32,
    #[fc(role = "plain_length")]
    pub plain: u32,
    #[fc(role = "digest")]
    pub digest: [u8; 16],
}

#[derive(Clone, Debug, PartialEq, Message, Envelope)]
#[fc(envelope = "request")]
pub struct ToyRequest {
    #[fc(key = "at", role = "time")]
    pub at: Option<i64>,
}

#[derive(Clone, Debug, PartialEq, Message, Envelope)]
#[fc(envelope = "response")]
pub struct ToyResponse {
    #[fc(key = "at", role = "time")]
    pub at: Option<i64>,
    #[fc(key = "result", role = "result_code")]
    pub result: i32,
    #[fc(key = "why", role = "result_text")]
    pub why: Option<String>,
}

/// Answers with the same text.
#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(example = r#"{"text":"hello"}"#)]
#[fc(code = 0x0101, name = "echo", effect = "read", response = EchoReply)]
pub struct Echo {
    #[fc(length = 0..=4_000_000)]
    pub text: String,
}

#[derive(Clone, Debug, PartialEq, Message)]
pub struct EchoReply {
    pub text: String,
}

/// Sets something in motion.
#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(
    code = 0x0102,
    name = "go",
    effect = "motion",
    response = Done,
    sets_off(Moved, UnderWay(request.metres = metres?))
)]
pub struct Go {
    #[fc(min = 0, max = 100)]
    pub metres: i32,
}

#[derive(Clone, Debug, PartialEq, Message)]
pub struct Done {}

#[derive(Clone, Debug, PartialEq, Message, Report)]
#[fc(code = 0x0B01, name = "moved")]
pub struct Moved {
    pub metres: i32,
}

/// Progress of a [`Go`].
#[derive(Clone, Debug, PartialEq, Message, Report)]
#[fc(code = 0x0BF0, name = "under_way", state(step: Step), failure(trouble?))]
pub struct UnderWay {
    pub step: Step,
    /// Which [`Go`] it is.
    pub metres: Option<i32>,
    pub trouble: Option<Trouble>,
}

#[derive(Clone, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = str, order = "complete")]
pub enum Step {
    #[fc(value = "ready", then(Rolling))]
    Ready,
    #[fc(value = "rolling", then(There, Stuck))]
    Rolling,
    #[fc(value = "there", final)]
    There,
    #[fc(value = "stuck", final, error)]
    Stuck,
    #[fc(other)]
    Unknown(String),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = u8)]
pub enum Trouble {
    #[fc(value = 0)]
    None,
    #[fc(value = 1, error)]
    Wheel,
}

pub const LIMITS: Limits = Limits {
    frame_bytes: 8 << 20,
    inflated_bytes: 16 << 20,
    // Deflate does not reach it: bombs are of use in tests.
    inflate_ratio: 2000,
    json_depth: 32,
    json_values: Limits::JSON_VALUES,
    json_list_bytes: Limits::JSON_LIST_BYTES,
    in_flight: 64,
    queued_reports: 16,
    connections: 8,
};

/// The protocol under test.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Toy;

impl Protocol for Toy {
    type Header = ToyHeader;
    type Request = ToyRequest;
    type Response = ToyResponse;

    const NAME: &'static str = "toy";
    const HOST: &'static str = "127.0.0.1";
    const COMMAND_PORT: u16 = 0;
    const DATA_PORT: u16 = 0;
    const REQUEST_HEAD: &'static [u8] = b"<?>";
    const RESPONSE_HEAD: &'static [u8] = b"<!>";
    const STREAM: u8 = 40;
    const COMMAND: u8 = 41;
    const REPORT: u8 = 42;
    const RESERVED_KINDS: &'static [u8] = &[43, 44];
    const PLAIN: u8 = 5;
    const GZIP: Option<u8> = Some(6);
    const ZERO_PLAIN_LENGTH: bool = true;
    const RESULTS: Results = Results {
        success: ResultText {
            code: 7,
            text: "fine",
        },
        protocol: ResultText {
            code: 71,
            text: "protocol",
        },
        timeout: ResultText {
            code: 72,
            text: "timeout",
        },
        invalid: ResultText {
            code: 73,
            text: "invalid",
        },
        expired: ResultText {
            code: 74,
            text: "expired",
        },
    };
    const DEFAULTS: Defaults = Defaults {
        call_timeout: Duration::from_secs(3),
        handler_timeout: Duration::from_secs(2),
        max_age: None,
        ack: AckPolicy {
            timeout: Duration::from_secs(2),
            retries: 3,
        },
        limits: LIMITS,
    };

    fn operations() -> &'static [OperationInfo] {
        const {
            &[
                operation("echo", 0x0101, Effect::Read),
                operation("go", 0x0102, Effect::Motion),
                MOVED,
                BEAT,
                UNDER_WAY,
            ]
        }
    }
}

const MOVED: OperationInfo = OperationInfo {
    kind: OperationKind::Report,
    effect: None,
    request: BodyInfo::of::<Moved>(),
    ..operation(Moved::NAME, Moved::CODE, Effect::Read)
};

/// A report that comes every second.
pub const BEAT: OperationInfo = OperationInfo {
    cadence: Some(Cadence::Every(Duration::from_secs(1))),
    name: "beat",
    code: Some(0x0202),
    ..MOVED
};

const UNDER_WAY: OperationInfo = OperationInfo {
    name: UnderWay::NAME,
    code: Some(UnderWay::CODE),
    request: BodyInfo::of::<UnderWay>(),
    ..MOVED
};

/// The properties of a command besides its types.
const fn operation(name: &'static str, code: u16, effect: Effect) -> OperationInfo {
    OperationInfo {
        name,
        code: Some(code),
        kind: OperationKind::Command,
        effect: Some(effect),
        preconditions: None,
        cadence: None,
        zh: name,
        en: name,
        since: None,
        deprecated: false,
        docs: "",
        spec: "",
        request: BodyInfo::of::<Empty>(),
        response: BodyInfo::of::<Empty>(),
    }
}

pub fn command(code: u16, id: u32) -> FrameId {
    FrameId {
        response: false,
        kind: Toy::COMMAND,
        code,
        id,
    }
}

pub fn report(code: u16, id: u32) -> FrameId {
    FrameId {
        response: false,
        kind: Toy::REPORT,
        code,
        id,
    }
}

/// The body of an answer with this result.
pub fn result(code: i32) -> String {
    format!(r#"{{"result":{code}}}"#)
}

pub fn answer_to(request: FrameId) -> FrameId {
    FrameId {
        response: true,
        ..request
    }
}

/// Yields to other tasks until a condition holds that they bring about.
///
/// # Panics
/// If it does not come to that. Only a test that fails waits for so long.
#[track_caller]
pub fn until(mut done: impl FnMut() -> bool) -> impl Future<Output = ()> {
    const PATIENCE: Duration = Duration::from_secs(10);

    let (place, begun) = (Location::caller(), Instant::now());
    async move {
        while !done() {
            assert!(
                begun.elapsed() < PATIENCE,
                "it does not come to that: {place}"
            );
            tokio::task::yield_now().await;
        }
    }
}

/// One frame with these bytes as its body.
pub fn frame(id: FrameId, body: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    Encoder::<Toy>::new().bytes(&mut out, id, body).unwrap();
    out
}
