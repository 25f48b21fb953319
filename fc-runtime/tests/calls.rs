//! Calls between app and robot over loopback.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::indexing_slicing, reason = "a test may")]

mod common;

use common::net::{Robot, loopback, service};
use common::{Done, Echo, EchoReply, Go};
use fc_runtime::CallError;

#[tokio::test]
async fn a_call_is_answered() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let reply = app.call(&Echo { text: "hello".into() }).await;
    assert_eq!(reply, Ok(EchoReply { text: "hello".into() }));
    assert_eq!(app.call(&Go { metres: 5 }).await, Ok(Done {}));
}

#[tokio::test]
async fn a_refusal_carries_code_and_text() {
    let robot = Robot::start(loopback(), service).await;
    let app = robot.connect().await;
    let Err(CallError::Refused(refusal)) = app.call(&Go { metres: 51 }).await else {
        panic!("not refused");
    };
    assert_eq!((refusal.code, refusal.text.as_str()), (500, "too far"));
}
