//! Responses that are encoded once and sent to many.

use crate::common::net::{Robot, loopback};
use crate::common::{self, Done, Echo, EchoReply, Go, LIMITS, Toy, command};
use fc_runtime::digest::Md5;
use fc_runtime::{
    CallError, Command, Gzip, Handling, Header, Limits, PreparedResponse, Protocol, Refusal,
    Request, ServerConfig, read_enveloped,
};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;

/// A robot that answers each [`Echo`] with `text`, and refuses the empty one.
async fn robot(config: ServerConfig, text: String) -> Robot {
    let kept = PreparedResponse::new(&EchoReply { text }).unwrap();
    let done = PreparedResponse::new(&Done {}).unwrap();
    Robot::start(config, move |request: Request<'_, Toy>| -> Handling {
        let kept = kept.clone();
        let done = done.clone();
        match request.code() {
            Echo::CODE => request.handle_prepared(|_, Echo { text }| async move {
                if text.is_empty() {
                    return Err(Refusal::new(500, "nothing to say"));
                }
                Ok(kept)
            }),
            _ => request.handle_prepared(|_, Go { .. }| async move { Ok(done) }),
        }
    })
    .await
}

fn asking() -> Echo {
    Echo {
        text: "?".to_owned(),
    }
}

#[fc_test::test]
async fn many_get_it_as_if_it_had_been_made_for_each() {
    let text = "a\"b\u{7}".repeat(100_000);
    let robot = robot(loopback(), text.clone()).await;
    for _ in 0..3 {
        let app = robot.connect().await;
        let asking = asking();
        let (first, second) = tokio::join!(app.call(&asking), app.call(&asking));
        assert!(first.unwrap().text == text);
        assert!(second.unwrap().text == text);
    }
    let counters = robot.handle.counters();
    assert_eq!(counters.calls_succeeded, 6);
}

#[fc_test::test]
async fn prepared_response_gets_a_current_envelope() {
    let robot = robot(loopback(), "x".to_owned()).await;
    let mut app = robot.raw();
    for (code, body, before) in [
        (Echo::CODE, r#"{"text":"?"}"#, r#"{"text":"x","at":"#),
        (Go::CODE, r#"{"metres":1}"#, r#"{"at":"#),
    ] {
        app.send_frame(command(code, 5), body).await;
        let (id, answer) = app.recv().await.unwrap();
        assert!(id.response && id.code == code && id.id == 5);
        assert!(answer.starts_with(before), "{answer}");
        let read = read_enveloped::<<Toy as Protocol>::Response, EchoReply>(
            answer.as_bytes(),
            LIMITS.json(),
        )
        .unwrap();
        assert_eq!(
            (read.envelope.result, read.envelope.why.as_deref()),
            (7, Some("fine"))
        );
        assert!(read.envelope.at.is_some());
    }
}

#[fc_test::test]
async fn a_refusal_is_a_refusal() {
    let robot = robot(loopback(), "x".to_owned()).await;
    let app = robot.connect().await;
    let text = String::new();
    let error = app.call(&Echo { text }).await.unwrap_err();
    assert!(matches!(error, CallError::Refused(refusal) if refusal.code == 500));
}

#[fc_test::test]
async fn prepared_response_is_sent_plain() {
    let gzip = Gzip {
        from_bytes: 1,
        level: 1,
    };
    let robot = robot(loopback().gzip(gzip), "x".repeat(10_000)).await;
    let mut app = TcpStream::connect(robot.command).await.unwrap();
    let request = common::frame(command(Echo::CODE, 1), br#"{"text":"?"}"#);
    app.write_all(&request).await.unwrap();
    let mut header = vec![0; <Toy as Protocol>::Header::LEN];
    app.read_exact(&mut header).await.unwrap();
    let header = <Toy as Protocol>::Header::read(&header).unwrap();
    assert_eq!(header.encoding(), Toy::PLAIN);
    assert!(header.plain_length() > 10_000);
}

#[fc_test::test]
async fn one_that_fits_into_no_frame_is_refused() {
    let limits = Limits {
        frame_bytes: 1000,
        ..LIMITS
    };
    let robot = robot(loopback().limits(limits), "x".repeat(1000)).await;
    let app = robot.connect().await;
    let error = app.call(&asking()).await.unwrap_err();
    assert!(matches!(error, CallError::Refused(refusal) if refusal.code == 71));
    // No byte of it was sent.
    let done = app.call(&Go { metres: 1 }).await.unwrap();
    assert_eq!(done, Done {});
}

#[fc_test::test]
fn invalid_response_is_not_prepared() {
    let error = PreparedResponse::<_, Md5>::new(&Go { metres: 101 }).unwrap_err();
    assert_eq!(error.name(), "out_of_range");
}

#[fc_test::test]
fn its_debug_form_shows_no_text() {
    let kept = PreparedResponse::<_, Md5>::new(&Echo {
        text: "secret".to_owned(),
    });
    assert_eq!(format!("{:?}", kept.unwrap()), "PreparedResponse(16 bytes)");
}
