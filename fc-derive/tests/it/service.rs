//! A hand-written protocol: envelopes, commands, reports and a service, from call to answer.

use fc_derive::{Command, Dispatch, Envelope, Header, Message, Report, dispatch};
use fc_runtime::{
    AcceptedIn, AckPolicy, Allowance, CallError, ClientConfig, Command as _, Connection, Context,
    Defaults, Effect, Empty, Extra, Json, JsonRef, Limits, OperationInfo, Protocol, RawAnswer,
    RawReport, RawRequest, Refusal, Report as _, RequestEnvelope as _, ResponseEnvelope as _,
    ResultText, Results, Server, ServerConfig, ServerHandle, Service, read_enveloped,
    write_enveloped,
};
use std::net::Ipv4Addr;
use std::sync::Arc;
use std::time::Duration;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Header)]
#[fc(byte_order = "big")]
struct FrameHeader {
    #[fc(role = "head")]
    head: [u8; 1],
    #[fc(role = "kind")]
    kind: u8,
    #[fc(role = "code")]
    code: u16,
    #[fc(role = "id")]
    id: u32,
    #[fc(role = "encoding")]
    encoding: u8,
    #[fc(role = "total_length")]
    total_length: u32,
    #[fc(role = "plain_length")]
    plain_length: u32,
    #[fc(role = "digest")]
    digest: [u8; 16],
}

#[derive(Clone, Debug, PartialEq, Message, Envelope)]
#[fc(envelope = "request")]
struct Asked {
    #[fc(key = "cmdTime", role = "time")]
    time: i64,
    /// Stays at its default.
    note: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Message, Envelope)]
#[fc(envelope = "response")]
struct Answered {
    #[fc(key = "resultCode", role = "result_code")]
    code: i32,
    #[fc(key = "resultMsg", role = "result_text")]
    text: Option<String>,
}

/// An envelope that has only what it must have.
#[derive(Clone, Debug, PartialEq, Message, Envelope)]
#[fc(envelope = "response")]
struct Bare {
    #[fc(role = "result_code")]
    code: u8,
}

/// An envelope whose result may be absent.
#[derive(Clone, Debug, PartialEq, Message, Envelope)]
#[fc(envelope = "response")]
struct Silent {
    #[fc(role = "result_code")]
    code: Option<i32>,
}

/// An envelope without keys.
#[derive(Clone, Debug, PartialEq, Message, Envelope)]
#[fc(envelope = "response")]
struct Nothing {}

#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0A03, name = "get_station", effect = "read", response = Station)]
struct GetStation {
    id: i32,
}

#[derive(Clone, Debug, PartialEq, Message)]
struct Station {
    id: i32,
    #[fc(extra)]
    extra: Extra,
}

#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0A04, name = "drive", effect = "motion", response = Empty)]
#[fc(accepted_in(Brake(Off), Mode(Manual, Automatic)))]
struct Drive {}

#[derive(Clone, Debug, PartialEq)]
enum Brake {
    Off,
    On(String),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Manual,
    Automatic,
    Stopped,
}

#[test]
fn command_has_its_accepted_states() {
    assert!(Drive::accepted_in(&Brake::Off) && !Drive::accepted_in(&Brake::On("left".to_owned())));
    let modes = [Mode::Manual, Mode::Stopped, Mode::Automatic];
    assert_eq!(
        modes.map(|mode| Drive::accepted_in(&mode)),
        [true, false, true]
    );
    assert_eq!(
        <Drive as AcceptedIn<Mode>>::STATES,
        [Mode::Manual, Mode::Automatic]
    );
}

#[derive(Clone, Debug, PartialEq, Message, Report)]
#[fc(code = 0x0B01, name = "arrived", ack(timeout_ms = 1500, retries = 2))]
struct Arrived {
    station: Option<Station>,
}

#[derive(Clone, Debug, PartialEq, Message, Report)]
#[fc(code = 0x0B02, name = "left")]
struct Left {}

/// Any report.
#[derive(Clone, Debug, PartialEq, Dispatch)]
#[fc(protocol = Fc)]
enum AnyReport {
    Arrived(Arrived),
    Left(Left),
    #[fc(unknown)]
    Unknown(RawReport),
}

#[derive(Clone, Copy, Debug, Default)]
struct Fc;

const fn result(code: i64, text: &'static str) -> ResultText {
    ResultText { code, text }
}

impl Protocol for Fc {
    type Header = FrameHeader;
    type Request = Asked;
    type Response = Answered;

    const NAME: &'static str = "test";
    const HOST: &'static str = "127.0.0.1";
    const COMMAND_PORT: u16 = 0;
    const DATA_PORT: u16 = 0;
    const REQUEST_HEAD: &'static [u8] = b"?";
    const RESPONSE_HEAD: &'static [u8] = b"!";
    const STREAM: u8 = 0;
    const COMMAND: u8 = 1;
    const REPORT: u8 = 3;
    const RESERVED_KINDS: &'static [u8] = &[2];
    const PLAIN: u8 = 0;
    const GZIP: Option<u8> = Some(1);
    const ZERO_PLAIN_LENGTH: bool = false;
    const RESULTS: Results = Results {
        success: result(1001, "ok"),
        protocol: result(2001, "protocol"),
        timeout: result(2002, "timeout"),
        invalid: result(2003, "invalid"),
        expired: result(2004, "expired"),
    };
    const DEFAULTS: Defaults = Defaults {
        call_timeout: Duration::from_secs(20),
        handler_timeout: Duration::from_secs(20),
        max_age: None,
        ack: AckPolicy {
            timeout: Duration::from_secs(20),
            retries: 0,
        },
        limits: Limits {
            frame_bytes: 1 << 16,
            inflated_bytes: 1 << 16,
            json_depth: 32,
            inflate_ratio: Limits::INFLATE_RATIO,
            json_values: Limits::JSON_VALUES,
            json_list_bytes: Limits::JSON_LIST_BYTES,
            in_flight: 8,
            queued_reports: 8,
            connections: 8,
        },
    };

    fn operations() -> &'static [OperationInfo] {
        &[]
    }
}

/// The responses of the robot in this test.
#[dispatch(protocol = Fc, service = RobotService)]
trait Robot: Send + Sync + 'static {
    /// A command.
    async fn get_station(&self, _: Context<Fc>, request: GetStation) -> Result<Station, Refusal>;

    /// A command that need not be written.
    async fn drive(&self, context: Context<Fc>, request: Drive) -> Result<Empty, Refusal> {
        let Drive {} = request;
        Err(Refusal::new(i64::from(context.code), "no wheels"))
    }

    /// Codes of a range, except those above.
    #[fc(range = 0x0A00..=0x0AFF)]
    async fn pass_through(&self, _: Context<Fc>, request: RawRequest)
    -> Result<RawAnswer, Refusal>;

    /// Every other code.
    #[fc(unknown)]
    async fn unknown(&self, _: Context<Fc>, request: RawRequest) -> Result<RawAnswer, Refusal> {
        Err(Refusal::new(9, format!("{:#06x}", request.code)))
    }
}

/// The same with optional methods.
#[dispatch(protocol = Fc, service = CartService, partial = PartialCart)]
trait Cart: Send + Sync + 'static {
    /// A command.
    async fn get_station(&self, _: Context<Fc>, request: GetStation) -> Result<Station, Refusal>;

    /// Another.
    async fn drive(&self, context: Context<Fc>, request: Drive) -> Result<Empty, Refusal>;

    /// Codes of a range, except those above.
    #[fc(range = 0x0A00..=0x0AFF)]
    async fn pass_through(&self, _: Context<Fc>, request: RawRequest)
    -> Result<RawAnswer, Refusal>;

    /// Every other code.
    #[fc(unknown)]
    async fn unknown(&self, _: Context<Fc>, request: RawRequest) -> Result<RawAnswer, Refusal> {
        Err(Refusal::new(9, format!("{:#06x}", request.code)))
    }
}

/// Has one command so far.
struct Begun;

impl PartialCart for Begun {
    async fn get_station(&self, _: Context<Fc>, request: GetStation) -> Result<Station, Refusal> {
        Ok(Station {
            id: request.id,
            extra: Extra::new(),
        })
    }
}

/// Has them all.
struct Finished;

impl Cart for Finished {
    async fn get_station(&self, _: Context<Fc>, request: GetStation) -> Result<Station, Refusal> {
        Ok(Station {
            id: request.id,
            extra: Extra::new(),
        })
    }

    async fn drive(&self, _: Context<Fc>, _: Drive) -> Result<Empty, Refusal> {
        Ok(Empty {})
    }

    async fn pass_through(&self, _: Context<Fc>, _: RawRequest) -> Result<RawAnswer, Refusal> {
        Ok(RawAnswer(Json::new(r#"{"passed":true}"#).unwrap()))
    }
}

#[tokio::test]
async fn omitted_command_is_refused_as_not_implemented() {
    let (app, handle) = connected(CartService::new(Begun)).await;
    assert_eq!(app.call(&GetStation { id: 7 }).await.unwrap().id, 7);
    // Known to the protocol but not implemented: the text says this, and the robot counts it.
    assert_eq!(
        refused(app.call(&Drive {}).await),
        (2001, "protocol: not implemented".into())
    );
    assert_eq!(handle.counters().calls_not_implemented, 1);
    // Not known to the protocol.
    let passed = app.call_raw(0x0A05, TIME_ALONE).await.unwrap();
    assert_eq!(passed.envelope.result_text(), "protocol");
    let unknown = app.call_raw(0x0B01, TIME_ALONE).await.unwrap();
    assert_eq!(unknown.envelope.result_text(), "0x0b01");
    let counters = handle.counters();
    assert_eq!(
        (counters.calls_not_implemented, counters.calls_protocol),
        (1, 2)
    );
}

#[tokio::test]
async fn a_complete_robot_is_served_by_the_same_service() {
    let (app, handle) = connected(CartService::new(Finished)).await;
    assert_eq!(app.call(&GetStation { id: 7 }).await.unwrap().id, 7);
    app.call(&Drive {}).await.unwrap();
    let passed = app.call_raw(0x0A05, TIME_ALONE).await.unwrap();
    assert!(String::from_utf8_lossy(&passed.text).contains(r#""passed":true"#));
    let unknown = app.call_raw(0x0B01, TIME_ALONE).await.unwrap();
    assert_eq!(unknown.envelope.result_text(), "0x0b01");
    assert_eq!(handle.counters().calls_not_implemented, 0);
}

/// The text of a request with the envelope alone.
const TIME_ALONE: &[u8] = br#"{"cmdTime":1}"#;

/// An app at a robot that has this service.
async fn connected(service: impl Service<Fc>) -> (Connection<Fc>, ServerHandle<Fc>) {
    let config = ServerConfig::new().address(Ipv4Addr::LOCALHOST);
    let server = Server::bind(config, service).await.unwrap();
    let port = server.command_addr().port();
    let handle = server.handle();
    tokio::spawn(server.run());
    let config = ClientConfig::new().host("127.0.0.1").command_port(port);
    (Connection::connect(config).await.unwrap(), handle)
}

struct Shelf;

impl Robot for Shelf {
    async fn get_station(&self, _: Context<Fc>, request: GetStation) -> Result<Station, Refusal> {
        // Not ready at once.
        tokio::task::yield_now().await;
        Ok(Station {
            id: request.id + 1,
            extra: Extra::new(),
        })
    }

    async fn pass_through(&self, _: Context<Fc>, _: RawRequest) -> Result<RawAnswer, Refusal> {
        Ok(RawAnswer(Json::new(r#"{"passed":true}"#).unwrap()))
    }
}

fn refused<T: std::fmt::Debug>(answer: Result<T, CallError>) -> (i64, String) {
    match answer {
        Err(CallError::Refused(refusal)) => (refusal.code, refusal.text),
        other => panic!("not refused: {other:?}"),
    }
}

#[tokio::test]
async fn each_code_reaches_its_method() {
    let (app, _handle) = connected(RobotService::new(Shelf)).await;

    let station = app.call(&GetStation { id: 7 }).await.unwrap();
    assert_eq!(station.id, 8);
    assert_eq!(
        refused(app.call(&Drive {}).await),
        (0x0A04, "no wheels".into())
    );
    let passed = app.call_raw(0x0A05, br#"{"cmdTime":1}"#).await.unwrap();
    assert!(String::from_utf8_lossy(&passed.text).contains(r#""passed":true"#));
    let unknown = app.call_raw(0x0B01, br#"{"cmdTime":1}"#).await.unwrap();
    assert_eq!(
        (unknown.envelope.code, unknown.envelope.result_text()),
        (9, "0x0b01")
    );
}

#[test]
fn a_service_is_cheap_to_clone() {
    let service = RobotService::shared(Arc::new(Shelf));
    assert_eq!(format!("{:?}", service.clone()), "RobotService");
}

#[test]
fn operations_know_their_numbers() {
    assert_eq!(
        (GetStation::CODE, GetStation::NAME),
        (0x0A03, "get_station")
    );
    assert_eq!(
        (GetStation::EFFECT, Drive::EFFECT),
        (Effect::Read, Effect::Motion)
    );
    let ack = AckPolicy {
        timeout: Duration::from_millis(1500),
        retries: 2,
    };
    assert_eq!(
        (Arrived::CODE, Arrived::NAME, Arrived::ACK),
        (0x0B01, "arrived", Some(ack))
    );
    assert_eq!(Left::ACK, None);
}

#[test]
fn a_report_is_read_as_its_code_says() {
    let raw = |code, text: &str| RawReport {
        code,
        id: 1,
        text: text.into(),
    };
    let read = AnyReport::from_raw(raw(0x0B01, r#"{"station":{"id":1},"cmdTime":5}"#)).unwrap();
    assert!(matches!(
        read,
        AnyReport::Arrived(Arrived { station: Some(_) })
    ));
    let read = AnyReport::from_raw(raw(0x0B02, r#"{"cmdTime":5}"#));
    assert_eq!(read, Ok(AnyReport::Left(Left {})));
    let unknown = raw(0x0B03, "not JSON");
    assert_eq!(
        AnyReport::from_raw(unknown.clone()),
        Ok(AnyReport::Unknown(unknown))
    );
    let error = AnyReport::from_raw(raw(0x0B01, r#"{"station":1,"cmdTime":5}"#)).unwrap_err();
    assert_eq!((error.name(), error.path()), ("wrong_type", "station"));
}

#[test]
fn envelopes_are_made_and_read() {
    let asked = Asked::at(5);
    assert_eq!(
        asked,
        Asked {
            time: 5,
            note: None
        }
    );
    assert_eq!(asked.time_ms(), Some(5));
    let answered = Answered::at(5, i64::MAX, "why");
    assert_eq!(
        answered,
        Answered {
            code: i32::MAX,
            text: Some("why".into())
        }
    );
    assert_eq!(
        (answered.time_ms(), answered.result_code()),
        (None, Some(i64::from(i32::MAX)))
    );
    let answered = Answered {
        code: -1,
        text: None,
    };
    assert_eq!(
        (answered.result_code(), answered.result_text()),
        (Some(-1), "")
    );
    let bare = Bare::at(1, -5, "unused");
    assert_eq!((bare.result_code(), bare.result_text()), (Some(0), ""));
    let sent = Silent::at(1, i64::MAX, "");
    assert_eq!(sent.result_code(), Some(i32::MAX.into()));
    assert_eq!(Silent { code: None }.result_code(), None);
    let have = [Answered::HAS_RESULT, Bare::HAS_RESULT, Nothing::HAS_RESULT];
    assert_eq!(have, [true, true, false]);
    let none = Nothing::at(1, -5, "unused");
    assert_eq!((none.time_ms(), none.result_code()), (None, None));
    assert_eq!(none.result_text(), "");
}

#[test]
fn envelope_and_body_share_an_object() {
    let mut out = b"before".to_vec();
    write_enveloped(
        &Answered::at(0, 1001, "ok"),
        &GetStation { id: 3 },
        &mut out,
    );
    assert_eq!(out, br#"before{"resultCode":1001,"resultMsg":"ok","id":3}"#);

    for text in [
        r#"{"resultCode":1001,"resultMsg":"ok","id":3,"new":[1]}"#,
        r#"{"id":3,"resultCode":1001,"resultMsg":"ok","new":[1]}"#,
        r#"{"new":[1],"resultMsg":"ok","id":3,"resultCode":1001}"#,
        "{ \"new\" :[1],\n\t\"id\" : 3 , \"resultMsg\":\"ok\", \"resultCode\" : 1001 }",
    ] {
        let read =
            read_enveloped::<Answered, Station>(text.as_bytes(), Allowance::depth(32)).unwrap();
        assert_eq!(read.envelope, Answered::at(0, 1001, "ok"), "{text}");
        let station = read.body.unwrap();
        assert_eq!(station.id, 3);
        assert_eq!(station.extra.get("new").map(JsonRef::as_str), Some("[1]"));
    }
}

#[test]
fn a_wrong_body_leaves_the_envelope() {
    for (text, name, path) in [
        (r#"{"resultCode":2003}"#, "missing_field", "id"),
        (r#"{"id":"x","resultCode":2003}"#, "wrong_type", "id"),
        (
            r#"{"resultCode":2003,"other":{},"id":5.5}"#,
            "wrong_type",
            "id",
        ),
    ] {
        let read =
            read_enveloped::<Answered, GetStation>(text.as_bytes(), Allowance::depth(32)).unwrap();
        assert_eq!(read.envelope.code, 2003);
        let error = read.body.unwrap_err();
        assert_eq!((error.name(), error.path()), (name, path), "{text}");
    }
    for (text, name) in [
        (r#"{"id":3}"#, "missing_field"),
        (r#"{"id":"x","resultCode":"2003"}"#, "wrong_type"),
        (r#"{"id":"x","resultCode":2003"#, "bad_json"),
        (r#"{"id":"x","resultCode":2003} x"#, "bad_json"),
        ("[]", "not_an_object"),
        ("", "missing_field"),
    ] {
        let error = read_enveloped::<Answered, GetStation>(text.as_bytes(), Allowance::depth(32))
            .unwrap_err();
        assert_eq!(error.name(), name, "{text}");
    }
}
