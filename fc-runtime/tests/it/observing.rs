//! Contents of a user's subscriber and of the counters, and data that they must never contain.

use crate::common::net::{Robot, loopback, service};
use crate::common::{Echo, EchoReply, Go, Moved, Toy, command, frame, report, until};
use fc_derive::{Command, Message, OpenEnum, RedactedDebug};
use fc_runtime::{Audience, Bytes64, CallError, Command, Connection, Gzip, Refusal, Request};
use std::fmt::{Debug, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};

const SECRET: &str = "hunter2";

/// One test at a time: a span that is first created without a subscriber, while another test starts to listen, may stay
/// disabled for both.
static ALONE: tokio::sync::Mutex<()> = tokio::sync::Mutex::const_new(());

/// Writes down all it is told.
#[derive(Clone, Default)]
struct Notes(Arc<Mutex<String>>, Arc<AtomicU64>);

struct Line<'a>(&'a mut String);

impl Visit for Line<'_> {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        write!(self.0, " {field}={value:?}").unwrap();
    }
}

impl Notes {
    fn note(&self, what: &str, metadata: &Metadata<'_>, fields: impl FnOnce(&mut Line<'_>)) {
        let mut text = self.0.lock().unwrap();
        write!(text, "{what} {} {}", metadata.level(), metadata.name()).unwrap();
        fields(&mut Line(&mut text));
        text.push('\n');
    }
}

impl Subscriber for Notes {
    fn enabled(&self, _: &Metadata<'_>) -> bool {
        true
    }

    fn new_span(&self, span: &Attributes<'_>) -> Id {
        self.note("span", span.metadata(), |line| span.record(line));
        Id::from_u64(self.1.fetch_add(1, Ordering::Relaxed) + 1)
    }

    fn record(&self, _: &Id, values: &Record<'_>) {
        values.record(&mut Line(&mut self.0.lock().unwrap()));
    }

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn event(&self, event: &Event<'_>) {
        self.note("event", event.metadata(), |line| event.record(line));
    }

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, OpenEnum)]
#[fc(repr = str)]
enum Closed {
    #[fc(value = "open")]
    Open,
}

/// Collects data that must not be logged.
#[derive(Clone, PartialEq, Message, Command, RedactedDebug)]
#[fc(code = 0x0301, name = "log_in", effect = "config", response = EchoReply)]
struct LogIn {
    #[fc(sensitive, pattern = "[a-z0-9]{1,7}")]
    word: String,
    #[fc(sensitive)]
    bytes: Option<Bytes64>,
    #[fc(sensitive)]
    closed: Option<Closed>,
}

fn log_in(word: &str) -> LogIn {
    LogIn {
        word: word.to_owned(),
        bytes: None,
        closed: None,
    }
}

#[fc_test::test]
async fn bodies_are_never_logged() {
    let _alone = ALONE.lock().await;
    let notes = Notes::default();
    let _guard = tracing::subscriber::set_default(notes.clone());
    let gossip = |request: Request<'_, Toy>| match request.code() {
        LogIn::CODE => request.handle(|_, LogIn { word, .. }| async move {
            match word.len() {
                7 => Ok(EchoReply { text: word }),
                _ => Err(Refusal::new(
                    500,
                    format!("{word} is not the word, {SECRET} is"),
                )),
            }
        }),
        _ => service(request),
    };
    let config = loopback().gzip(Gzip::default());
    let robot = Robot::start(config, gossip).await;
    let app = robot.connect().await;

    assert!(app.call(&log_in(SECRET)).await.is_ok());
    let refused = app.call(&log_in("x")).await.unwrap_err();
    let invalid = app.call(&log_in("Hunter2 hunter2")).await.unwrap_err();
    assert_eq!(
        (refused.name(), invalid.name()),
        ("refused", "invalid_request")
    );
    assert!(!invalid.to_string().contains(SECRET), "{invalid}");
    let echo = Echo {
        text: SECRET.repeat(500),
    };
    assert!(app.call(&echo).await.is_ok());
    // Bodies that break each rule there is.
    for body in [
        r#"{"word":"hunter2 hunter2"}"#,
        r#"{"word":["hunter2"]}"#,
        r#"{"word":"x","bytes":"hunter2"}"#,
        r#"{"word":"x","closed":"hunter2"}"#,
        r#"{"hunter2":"hunter2"}"#,
        r#"{"word":"x"}"#,
    ] {
        let response = app.call_raw(LogIn::CODE, body.as_bytes()).await.unwrap();
        assert!(!format!("{response:?}").contains(SECRET));
    }
    let mut raw = robot.raw();
    for body in [
        r#"{"word":hunter2"#,
        r"hunter2",
        r#"{"word":"hunter2","at":"hunter2"}"#,
    ] {
        raw.send_frame(command(LogIn::CODE, 1), body).await;
        raw.recv().await.unwrap();
    }
    // Frames that are damaged, of no known code, or of no use here.
    let mut damaged = frame(command(LogIn::CODE, 1), SECRET.as_bytes());
    *damaged.last_mut().unwrap() ^= 1;
    raw.send(&damaged).await;
    raw.recv().await.unwrap();
    raw.send_frame(command(0x7777, 1), SECRET).await;
    raw.send_frame(report(0x7777, 1), SECRET).await;
    raw.recv().await.unwrap();
    raw.recv().await.unwrap();
    raw.send(SECRET.as_bytes()).await;
    assert_eq!(raw.recv().await, None);

    // Reports and streams.
    let mut reports = app.reports();
    robot
        .handle
        .push(Audience::All, &Moved { metres: 424_242 })
        .await
        .unwrap();
    let moved = reports.recv().await.unwrap();
    assert!(!format!("{moved:?}").contains("424242"));
    let data = app.data();
    data.send(1, 2, SECRET.as_bytes()).await.unwrap();
    data.send(1, 2, SECRET.as_bytes()).await.unwrap();
    until(|| robot.handle.counters().stream_frames_dropped >= 2).await;
    robot.handle.shutdown(Duration::from_secs(1)).await;

    let text = notes.0.lock().unwrap().clone();
    for wanted in [
        "span DEBUG call",
        "span DEBUG handle",
        "answered",
        "bad_digest",
        "bad_head",
    ] {
        assert!(text.contains(wanted), "no {wanted} in {text}");
    }
    for hidden in [SECRET, "Hunter2", "424242", "is not the word"] {
        let line = text.lines().find(|line| line.contains(hidden));
        assert_eq!(line, None, "{hidden} was logged");
    }
    assert!(
        !format!(
            "{:?} {app:?} {robot:?}",
            log_in(SECRET),
            robot = robot.handle
        )
        .contains(SECRET)
    );
}

#[fc_test::test]
async fn spans_describe_a_call() {
    let _alone = ALONE.lock().await;
    let notes = Notes::default();
    let _guard = tracing::subscriber::set_default(notes.clone());
    let robot = Robot::start(loopback(), service).await;
    let app = Connection::<Toy>::connect(robot.config.clone().first_id(41))
        .await
        .unwrap();
    app.call(&Go { metres: 1 }).await.unwrap();
    let text = notes.0.lock().unwrap().clone();
    for span in ["call", "handle"] {
        let line = text
            .lines()
            .find(|line| line.starts_with(&format!("span DEBUG {span}")))
            .unwrap();
        for field in ["protocol=\"toy\"", "name=\"go\"", "code=258", "msg_id=41"] {
            assert!(line.contains(field), "no {field} in {line}");
        }
    }
}

#[fc_test::test]
async fn counters_agree_on_both_sides() {
    let _alone = ALONE.lock().await;
    let robot = Robot::start(loopback(), service).await;
    let app = Connection::<Toy>::connect(robot.config.clone().reconnect(None))
        .await
        .unwrap();
    let mut reports = app.reports();
    for metres in 0..60 {
        match app.call(&Go { metres }).await {
            Ok(_) => assert!(metres <= 50),
            Err(error) => assert!(metres > 50 && matches!(error, CallError::Refused(_))),
        }
    }
    app.call_raw(0x7777, b"{}").await.unwrap();
    app.call_raw(Echo::CODE, b"{}").await.unwrap();
    for metres in 0..7 {
        robot
            .handle
            .push(Audience::All, &Moved { metres })
            .await
            .unwrap();
        reports.recv().await.unwrap();
    }
    let (server, client) = (robot.handle.counters(), app.counters());
    assert_eq!(
        (
            server.calls_succeeded,
            server.calls_refused,
            server.calls_protocol,
            server.calls_invalid
        ),
        (51, 9, 1, 1)
    );
    assert_eq!(client.answers, 62);
    assert_eq!(
        (
            server.reports_sent,
            server.reports_acknowledged,
            client.reports
        ),
        (7, 7, 7)
    );
    assert_eq!(
        (server.bytes_out, server.bytes_in),
        (client.bytes_in, client.bytes_out)
    );
    assert_eq!((app.state().connects(), server.connections), (1, 1));
    let none = app.call_raw(0x7777, b"[]").await.unwrap_err();
    assert_eq!((none.name(), app.counters()), ("invalid_request", client));
}

/// The promise about `{:?}`: a message shows its values except sensitive ones.
#[fc_test::test]
fn debug_output_hides_sensitive_fields() {
    let shown = format!("{:?}", log_in(SECRET));
    assert!(
        shown.contains("LogIn") && !shown.contains(SECRET),
        "{shown}"
    );
    let shown = format!("{:?}", Moved { metres: 424_242 });
    assert!(shown.contains("424242"), "{shown}");
}
