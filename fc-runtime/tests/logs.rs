//! What is logged, and what never is.

#![allow(clippy::unwrap_used, reason = "a test may")]

mod common;

use common::net::{Robot, app_of_raw, loopback, nowhere, service};
use common::{Echo, Go, Moved, Toy, answer_to, command, frame, report};
use fc_runtime::{Audience, CallError, ClientConfig, Command, Limits, Protocol};
use std::fmt::{Debug, Write};
use std::sync::{Arc, Mutex};
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};

/// One test at a time: what is first met while another test begins or ends to listen may stay off for both.
static ALONE: tokio::sync::Mutex<()> = tokio::sync::Mutex::const_new(());

/// Writes down every field of every span and event, and the level of events.
#[derive(Clone, Default)]
struct Log(Arc<Mutex<String>>);

struct Line<'a>(&'a mut String);

impl Visit for Line<'_> {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        write!(self.0, " {}={value:?}", field.name()).unwrap();
    }
}

impl Log {
    fn line(&self, name: &str, record: impl FnOnce(&mut Line<'_>)) {
        let mut text = self.0.lock().unwrap();
        text.push_str(name);
        record(&mut Line(&mut text));
        text.push('\n');
    }
}

impl Subscriber for Log {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.target().starts_with("fc_runtime")
    }

    fn new_span(&self, span: &Attributes<'_>) -> Id {
        self.line(span.metadata().name(), |line| span.record(line));
        Id::from_u64(1)
    }

    fn event(&self, event: &Event<'_>) {
        self.line(event.metadata().level().as_str(), |line| event.record(line));
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}

#[tokio::test]
async fn spans_tell_code_name_and_id_and_nothing_tells_bodies() {
    let _alone = ALONE.lock().await;
    let log = Log::default();
    let _guard = tracing::subscriber::set_default(log.clone());

    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    app.call(&Echo {
        text: "hush".into(),
    })
    .await
    .unwrap();
    app.call(&Go { metres: 51 }).await.unwrap_err();
    app.call_raw(Echo::CODE, br#"{"text":{"hush":"hush"}}"#)
        .await
        .unwrap();
    app.call_raw(Go::CODE, br#"{"metres":7654321}"#)
        .await
        .unwrap();
    app.call_raw(0x0999, br#"{"hush":1}"#).await.unwrap();
    robot
        .handle
        .push(Audience::All, &Moved { metres: 7_654_321 })
        .await
        .unwrap();

    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let mut reports = app.reports();
    let request = Echo {
        text: "hush".into(),
    };
    let (response, ()) = tokio::join!(app.call(&request), async {
        let (id, _) = robot.recv().await.unwrap();
        robot
            .send_frame(answer_to(id), r#"{"result":7,"text":{"hush":7654321}}"#)
            .await;
        robot.send_frame(report(1, 2), "{\"hush\":1}").await;
        robot.send_frame(report(1, 3), "hush").await;
        robot.send(b"hush").await;
    });
    assert!(matches!(response, Err(CallError::Response(_))));
    assert_eq!(reports.recv().await.map(|report| report.id), Some(2));

    let text = log.0.lock().unwrap().clone();
    assert!(
        text.contains("call protocol=\"toy\" name=\"echo\" code=257 msg_id="),
        "{text}"
    );
    assert!(
        text.contains("handle protocol=\"toy\" name=\"echo\" code=257 msg_id="),
        "{text}"
    );
    assert!(text.contains("result=71"), "{text}");
    assert!(text.contains("result=73"), "{text}");
    for secret in ["hush", "7654321", "too far"] {
        assert!(!text.contains(secret), "{text}");
    }
}

/// Of a flood the 1st, 2nd, 4th, 8th … is a warning: the log grows with its logarithm.
#[tokio::test]
async fn a_flood_at_the_robot_does_not_flood_the_log() {
    const FLOOD: usize = 64;
    const WARNINGS: usize = 7;
    let _alone = ALONE.lock().await;
    let log = Log::default();
    let _guard = tracing::subscriber::set_default(log.clone());
    let limits = Limits {
        connections: 1,
        ..Toy::DEFAULTS.limits
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    let warnings = |of: &str| {
        let text = log.0.lock().unwrap();
        let lines = text.lines().filter(|line| line.starts_with("WARN"));
        lines.filter(|line| line.contains(of)).count()
    };

    let mut app = robot.raw();
    let mut damaged = frame(command(Echo::CODE, 1), b"{}");
    *damaged.last_mut().unwrap() ^= 1;
    for _ in 0..FLOOD {
        app.send(&damaged).await;
        assert_eq!(app.result().await.1, Toy::RESULTS.protocol.code);
    }
    assert_eq!(warnings("bad_digest"), WARNINGS);

    for _ in 0..FLOOD {
        let (stream, _) = tokio::io::duplex(1);
        assert!(robot.handle.serve(stream, nowhere()).is_none());
    }
    assert_eq!(warnings(""), 2 * WARNINGS);
}
