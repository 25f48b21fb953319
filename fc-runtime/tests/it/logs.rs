//! Log contents, and data that must never be logged.

use crate::common::net::{Robot, app_of_raw, loopback, service};
use crate::common::{Echo, Go, Moved, answer_to, report};
use fc_runtime::{Audience, CallError, ClientConfig, Command};
use std::fmt::{Debug, Write};
use std::sync::{Arc, Mutex};
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};

/// Writes down every field of every span and event.
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
        self.line("event", |line| event.record(line));
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}

#[fc_test::test]
async fn spans_have_code_name_and_id_but_no_bodies() {
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
    let mut reports = app.reports();
    let moved = Moved { metres: 7_654_321 };
    let (pushed, _) = tokio::join!(robot.handle.push(Audience::All, &moved), reports.recv());
    pushed.unwrap();

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
