//! Certificates of a mock, and of the mock behind a link that breaks it.

use crate::support::small_with;
use fc_reflect::{Direction, Frame, FrameFault, FrameId, Packing, Reflector};
use fc_spec::model::{Effect, Exchange, HeaderRole, Model, ResultRole, Value};
use fc_workshop::arguments::json;
use fc_workshop::certify::{self, Certificate, Outcome, Settings, Trial};
use fc_workshop::client::Client;
use fc_workshop::listen::Listeners;
use fc_workshop::mock::{self, Mock};
use fc_workshop::permission::Permission;
use fc_workshop::run::block_on;
use fc_workshop::stream::{FrameStream, Piece};
use futures_util::stream::{FuturesUnordered, StreamExt};
use std::future::pending;
use std::time::{Duration, SystemTime};
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;

/// The small protocol with short times, and a command that sets off a report.
fn model() -> Model {
    small_with(|text| {
        let text = text.replace("timeout_ms: 3000", "timeout_ms: 1500");
        let text = text.replace(
            "timeout_ms: 2000, retries: 3",
            "timeout_ms: 400, retries: 2",
        );
        let text = text.replace("connections: 2", "connections: 8");
        text.replace(
            "    request:\n      lvl:",
            "    sets_off: [dimmed]\n    request:\n      lvl:",
        )
    })
}

/// A way in which a robot is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Break {
    Nothing,
    ResponseHasOtherId,
    ResponseHasOtherKind,
    ResponseHasWrongDigest,
    ResponseLacksKey,
    ResponseHasOtherType,
    ResponseHasUnknownResult,
    ResponseComesTwice,
    UnknownCodeGetsNoResponse,
    InvalidRequestsAreAccepted,
    OnlyFirstOfTogetherIsRead,
    BadHeadIsIgnored,
    BadDigestEndsConnection,
    OnlyOneAppIsServed,
    ReportHasOtherType,
    ReportsAreNotRepeated,
    RepetitionHasOtherId,
    AcknowledgementsAreLost,
}

/// Each way, and the first trial that it must fail.
const BREAKS: [(Break, &str); 17] = [
    (Break::ResponseHasOtherId, "call.set_light"),
    (Break::ResponseHasOtherKind, "call.set_light"),
    (Break::ResponseHasWrongDigest, "call.set_light"),
    (Break::ResponseLacksKey, "call.set_light"),
    (Break::ResponseHasOtherType, "call.set_light"),
    (Break::ResponseHasUnknownResult, "call.set_light"),
    (Break::ResponseComesTwice, "request.ids"),
    (Break::UnknownCodeGetsNoResponse, "request.unknown_code"),
    (Break::InvalidRequestsAreAccepted, "request.missing_key"),
    (Break::OnlyFirstOfTogetherIsRead, "request.pipelined"),
    (Break::BadHeadIsIgnored, "frame.bad_head"),
    (Break::BadDigestEndsConnection, "frame.bad_digest"),
    (Break::OnlyOneAppIsServed, "connection.two_apps"),
    (Break::ReportHasOtherType, "report.valid"),
    (Break::ReportsAreNotRepeated, "report.repeated"),
    (Break::RepetitionHasOtherId, "report.repeated"),
    (Break::AcknowledgementsAreLost, "report.acknowledged"),
];

/// A relay that makes a good robot a broken one.
struct Breaker<'m> {
    reflector: &'m Reflector<'m>,
    way: Break,
    robot: String,
    /// The turn of one app.
    turn: Semaphore,
}

/// The end of a connection.
struct Broken;

impl<'m> Breaker<'m> {
    async fn run(&self, listener: TcpListener) {
        let mut links = FuturesUnordered::new();
        loop {
            tokio::select! {
                accepted = listener.accept() => links.push(self.link(accepted.unwrap().0)),
                Some(()) = links.next(), if !links.is_empty() => {}
            }
        }
    }

    async fn link(&self, mut app: TcpStream) {
        let _permit = match self.way {
            Break::OnlyOneAppIsServed => Some(self.turn.acquire().await.unwrap()),
            _ => None,
        };
        let mut robot = TcpStream::connect(&self.robot).await.unwrap();
        let (from_app, to_app) = app.split();
        let (from_robot, to_robot) = robot.split();
        let requests = self.forward(from_app, to_robot, false);
        let responses = self.forward(from_robot, to_app, true);
        let _ = tokio::try_join!(requests, responses);
    }

    async fn forward(
        &self,
        mut reader: impl AsyncRead + Unpin,
        mut writer: impl AsyncWrite + Unpin,
        is_from_robot: bool,
    ) -> Result<(), Broken> {
        let mut frames = FrameStream::default();
        let mut reports = Vec::new();
        loop {
            let read = reader.read_buf(frames.room()).await;
            let is_end = !matches!(read, Ok(1..));
            let mut is_first = true;
            loop {
                let piece = match frames.next(self.reflector) {
                    Ok(Some(piece)) => piece,
                    Err(_) if self.way == Break::BadHeadIsIgnored => pending().await,
                    Ok(None) if !is_end => break,
                    // The end, or bytes that are no frame.
                    Ok(None) | Err(_) => {
                        let rest = std::mem::take(&mut frames);
                        writer.write_all(rest.rest()).await.map_err(|_| Broken)?;
                        break;
                    }
                };
                let bytes = if is_from_robot {
                    self.response(&mut reports, piece)
                } else {
                    self.request(piece, is_first)?
                };
                is_first = false;
                writer.write_all(&bytes).await.map_err(|_| Broken)?;
            }
            if is_end {
                return writer.shutdown().await.map_err(|_| Broken);
            }
        }
    }

    /// Returns the bytes of a frame of the app as they arrive.
    fn request(&self, piece: Piece<'m>, is_first: bool) -> Result<Vec<u8>, Broken> {
        let is_lost = match &piece.frame {
            Err(error)
                if self.way == Break::BadDigestEndsConnection
                    && error.fault == FrameFault::BadDigest =>
            {
                return Err(Broken);
            }
            Ok(frame) if frame.id.direction == Direction::Response => {
                self.way == Break::AcknowledgementsAreLost
            }
            _ => self.way == Break::OnlyFirstOfTogetherIsRead && !is_first,
        };
        Ok(if is_lost { Vec::new() } else { piece.bytes })
    }

    /// Returns the bytes of a frame of the robot as they arrive.
    fn response(&self, reports: &mut Vec<FrameId>, piece: Piece<'m>) -> Vec<u8> {
        let Ok(frame) = piece.frame else {
            return piece.bytes;
        };
        if frame.id.direction == Direction::Request {
            let is_repeated = reports.contains(&frame.id);
            reports.push(frame.id);
            return match self.way {
                Break::ReportsAreNotRepeated if is_repeated => Vec::new(),
                Break::RepetitionHasOtherId if is_repeated => self.seal(
                    FrameId {
                        id: frame.id.id + 1000,
                        ..frame.id
                    },
                    &frame.data,
                ),
                Break::ReportHasOtherType => self.changed(&frame, |body| {
                    body.set("lux", Value::String("bright".to_owned()));
                }),
                _ => piece.bytes,
            };
        }
        match self.way {
            Break::ResponseHasOtherId => self.seal(
                FrameId {
                    id: frame.id.id + 1,
                    ..frame.id
                },
                &frame.data,
            ),
            Break::ResponseHasOtherKind => {
                let kind = self.reflector.model().frame.kinds.report.value;
                self.seal(FrameId { kind, ..frame.id }, &frame.data)
            }
            Break::ResponseHasWrongDigest => {
                let mut bytes = piece.bytes;
                self.reflector.overwrite(&mut bytes, HeaderRole::Digest, 7);
                bytes
            }
            Break::ResponseLacksKey => self.changed(&frame, |body| {
                if let Value::Object(entries) = body {
                    entries.retain(|(key, _)| key != "left");
                }
            }),
            Break::ResponseHasOtherType => self.changed(&frame, |body| {
                body.set("left", Value::Bool(true));
            }),
            Break::ResponseHasUnknownResult => self.changed(&frame, |body| {
                body.set("rc", json("99").unwrap());
            }),
            Break::ResponseComesTwice => piece.bytes.repeat(2),
            Break::UnknownCodeGetsNoResponse if frame.operation.is_none() => Vec::new(),
            Break::InvalidRequestsAreAccepted => self.accepted(&frame).unwrap_or(piece.bytes),
            _ => piece.bytes,
        }
    }

    fn seal(&self, id: FrameId, data: &[u8]) -> Vec<u8> {
        self.reflector.seal(id, data, Packing::Plain).unwrap()
    }

    fn changed(&self, frame: &Frame<'m>, change: impl FnOnce(&mut Value)) -> Vec<u8> {
        let mut body = json(std::str::from_utf8(&frame.data).unwrap()).unwrap();
        change(&mut body);
        self.seal(frame.id, body.to_string().as_bytes())
    }

    /// Returns a success instead of a refusal as invalid.
    fn accepted(&self, frame: &Frame<'m>) -> Option<Vec<u8>> {
        let model = self.reflector.model();
        let text = std::str::from_utf8(&frame.data).unwrap();
        let result = json(text)?.get("rc")?.to_string();
        let invalid = fc_workshop::facts::result(model, ResultRole::Invalid)?;
        let success = fc_workshop::facts::result(model, ResultRole::Success)?;
        let message = self.reflector.samples().response(frame.operation, success);
        let is_invalid = result == invalid.code.to_string();
        is_invalid.then(|| self.seal(frame.id, message.to_string().as_bytes()))
    }
}

/// Runs all trials against a mock that is broken in this way.
fn certify_broken(model: &Model, way: Break) -> Vec<Trial> {
    let mock = Mock::start(model.clone(), mock::Settings::default()).unwrap();
    let reflector = Reflector::new(model);
    let trials = block_on(async {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let settings = Settings {
            address: listener.local_addr().unwrap().to_string(),
            permission: Permission::Config,
            only: Vec::new(),
        };
        let breaker = Breaker {
            reflector: &reflector,
            way,
            robot: mock.commands().to_string(),
            turn: Semaphore::new(1),
        };
        let mut told = |_: &Trial| {};
        tokio::select! {
            trials = certify::robot(&reflector, &settings, &mut told, pending()) => trials.unwrap(),
            () = breaker.run(listener) => unreachable!("the breaker goes on"),
        }
    });
    trials.unwrap()
}

#[test]
fn broken_robots_fail_the_expected_trial() {
    let model = &model();
    std::thread::scope(|scope| {
        for (way, expected) in [(Break::Nothing, "")].into_iter().chain(BREAKS) {
            scope.spawn(move || {
                let trials = certify_broken(model, way);
                let mut failed = trials.iter().filter_map(|trial| match &trial.outcome {
                    Outcome::Failed(failure) => Some((trial.name.as_str(), &failure.reason.en)),
                    Outcome::Passed | Outcome::Skipped(_) => None,
                });
                let (name, reason) = failed
                    .next()
                    .map_or(("", ""), |(name, reason)| (name, reason));
                assert_eq!(name, expected, "{way:?}: {reason}");
            });
        }
    });
}

#[test]
fn each_trial_runs_against_a_good_robot() {
    let trials = certify_broken(&model(), Break::Nothing);
    for trial in &trials {
        // The effect of this one is unknown.
        let is_allowed = trial.name != "call.unknown_body";
        let is_passed = trial.outcome == Outcome::Passed;
        assert_eq!(is_passed, is_allowed, "{trial:?}");
    }
    assert!(trials.len() > 20);
}

#[test]
fn certificate_with_a_failed_trial() {
    let trials = certify_broken(&model(), Break::ResponseHasUnknownResult);
    let certificate = Certificate {
        address: "192.0.2.1:5000".to_owned(),
        protocol: "lamp".to_owned(),
        version: "1 <draft>".to_owned(),
        fingerprint: "abc".to_owned(),
        program: "0.2.0".to_owned(),
        start: SystemTime::UNIX_EPOCH,
        duration: Duration::from_millis(1234),
        only: vec!["call".to_owned()],
        trials,
    };
    assert!(!certificate.is_passed());
    let text = certify::json(&certificate);
    let value = json(&text).unwrap();
    assert_eq!(value.get("passed").unwrap().to_string(), "false");
    let page = certify::html(&certificate).unwrap();
    for part in [
        "1 &lt;draft&gt;",
        "the spec has no result code 99",
        "规范没有结果码 99",
        "未通过",
        "仅试验",
        "&gt; 4C 41 3F",
        "&lt; 4C 41 21",
    ] {
        assert!(page.contains(part), "{part}: {page}");
    }
}

#[test]
fn a_trial_without_commands_is_skipped() {
    let mut model = model();
    for operation in &mut model.operations {
        if let Exchange::Command { effect, .. } = &mut operation.exchange {
            *effect = Effect::Motion;
        }
    }
    let mock = Mock::start(model.clone(), mock::Settings::default()).unwrap();
    let reflector = Reflector::new(&model);
    let settings = Settings {
        address: mock.commands().to_string(),
        permission: Permission::Read,
        only: vec!["frame".to_owned()],
    };
    let mut told = |_: &Trial| {};
    let run = certify::robot(&reflector, &settings, &mut told, pending());
    let trials = block_on(run).unwrap().unwrap();
    assert!(!trials.is_empty());
    for trial in trials {
        assert!(trial.name.starts_with("frame."));
        assert!(matches!(trial.outcome, Outcome::Skipped(_)), "{trial:?}");
    }
}

/// The ways in which an app is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AppBreak {
    Nothing,
    /// It acknowledges no report.
    IsSilent,
    /// Its request has a value of another type.
    SendsOtherType,
    /// It sends bytes that are no frame, and reads nothing.
    SendsGarbage,
    /// It does not connect again.
    LeavesForGood,
}

/// Bytes that are no frame.
const GARBAGE: &[u8] = b"GET / HTTP/1.1\r\nHost: robot.example\r\nConnection: close\r\n\r\n";

/// Runs the trials of an app, which calls once and receives reports.
fn certify_app(model: &Model, way: AppBreak) -> Vec<Trial> {
    let reflector = Reflector::new(model);
    let trials = block_on(async {
        let listeners = Listeners::bind("127.0.0.1", 0, 0).await.unwrap();
        let address = listeners.addresses().unwrap().0.to_string();
        let wait = match way {
            AppBreak::LeavesForGood | AppBreak::IsSilent | AppBreak::SendsGarbage => {
                Duration::from_millis(500)
            }
            _ => Duration::from_secs(60),
        };
        let mut told = |_: &Trial| {};
        tokio::select! {
            trials = certify::app(&reflector, listeners, wait, &mut told, pending()) => trials.unwrap(),
            () = app(&reflector, &address, way) => unreachable!("the app goes on"),
        }
    });
    trials.unwrap()
}

async fn app(reflector: &Reflector<'_>, address: &str, way: AppBreak) {
    let wait = Duration::from_secs(60);
    loop {
        if way == AppBreak::IsSilent {
            let _stream = TcpStream::connect(address).await.unwrap();
            pending::<()>().await;
        }
        if way == AppBreak::SendsGarbage {
            let mut stream = TcpStream::connect(address).await.unwrap();
            stream.write_all(GARBAGE).await.unwrap();
            pending::<()>().await;
        }
        let mut client = Client::connect(reflector, address, wait).await.unwrap();
        let command = reflector.model().operation("set_light").unwrap();
        let id = reflector.id(command, Direction::Request, 0).unwrap();
        let body: &[u8] = match way {
            AppBreak::SendsOtherType => br#"{"lvl":"high"}"#,
            _ => br#"{"lvl":7}"#,
        };
        let _ = client.call(id.kind, id.code, body.into(), wait).await;
        while client.report(wait).await.is_ok() {}
        if way == AppBreak::LeavesForGood {
            pending::<()>().await;
        }
    }
}

#[test]
fn garbage_of_an_app_is_evidence() {
    let trials = certify_app(&model(), AppBreak::SendsGarbage);
    let Outcome::Failed(failure) = &trials[0].outcome else {
        panic!("{trials:?}");
    };
    assert_eq!(failure.received, [GARBAGE]);
}

#[test]
fn good_and_broken_apps() {
    let model = &model();
    for (way, failed, skipped) in [
        (AppBreak::Nothing, None, None),
        (AppBreak::IsSilent, Some("report.dimmed"), None),
        (AppBreak::SendsOtherType, Some("request.valid"), None),
        (AppBreak::LeavesForGood, None, Some("connection.lost")),
    ] {
        let trials = certify_app(model, way);
        let first = |is_it: &dyn Fn(&Outcome) -> bool| {
            let mut found = trials.iter().filter(|trial| is_it(&trial.outcome));
            found.next().map(|trial| trial.name.as_str())
        };
        let has_failed = |outcome: &Outcome| matches!(outcome, Outcome::Failed(_));
        let is_skipped = |outcome: &Outcome| matches!(outcome, Outcome::Skipped(_));
        assert_eq!(first(&has_failed), failed, "{way:?}: {trials:?}");
        // A silent app also sends no request.
        let skipped = skipped.or((way == AppBreak::IsSilent).then_some("connection.lost"));
        assert_eq!(first(&is_skipped), skipped, "{way:?}");
    }
}
