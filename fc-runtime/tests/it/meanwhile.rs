//! While one caller encodes a large body, no other waits for the connection.

use crate::common::net::{Robot, app_of_raw, loopback};
use crate::common::{Done, Moved, Toy};
use fc_derive::{Command, Message};
use fc_runtime::json::{Reader, Writer};
use fc_runtime::{
    Audience, BodyError, ClientConfig, Command, FromJson, Report, Request, ServerHandle, ToJson,
};
use std::cell::RefCell;
use std::pin::pin;
use std::sync::{Arc, OnceLock, mpsc};
use std::task::{Context, Waker};
use std::time::Duration;

thread_local! {
    /// The attempt made while a text of this thread is being encoded.
    static MEANWHILE: RefCell<Option<Box<dyn FnOnce() + Send>>> = RefCell::default();
}

/// A value whose encoding continues after another caller has run.
#[derive(Clone, Debug, PartialEq)]
struct Slow;

impl ToJson for Slow {
    fn write(&self, writer: &mut Writer<'_>) {
        if let Some(meanwhile) = MEANWHILE.take() {
            let (done, wait) = mpsc::channel();
            std::thread::spawn(move || {
                meanwhile();
                done.send(()).unwrap();
            });
            // Only a test that fails waits for so long.
            let had = wait.recv_timeout(Duration::from_secs(10));
            assert!(had.is_ok(), "others wait while this is encoded");
        }
        1_i64.write(writer);
    }
}

impl FromJson for Slow {
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        i64::read(reader).map(|_| Self)
    }
}

#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0104, name = "slow", effect = "read", response = SlowReply)]
struct SlowCall {
    value: Slow,
}

#[derive(Clone, Debug, PartialEq, Message)]
struct SlowReply {
    value: Slow,
}

#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0105, name = "fast", effect = "read", response = Done)]
struct Fast {
    number: i64,
}

#[fc_test::test]
async fn callers_do_not_wait_for_a_callers_encoding() {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let other = app.clone();
    MEANWHILE.set(Some(Box::new(move || {
        let call = other.call(&Fast { number: 1 });
        let mut call = pin!(call);
        let mut cx = Context::from_waker(Waker::noop());
        assert!(call.as_mut().poll(&mut cx).is_pending());
        assert_eq!(other.in_flight(), 1);
        // It has been sent; no caller waits for its response.
    })));
    let call = app.call(&SlowCall { value: Slow });
    let calling = async {
        let (first, _) = robot.recv().await.unwrap();
        let (second, _) = robot.recv().await.unwrap();
        [first.code, second.code]
    };
    let codes = tokio::select! {
        codes = calling => codes,
        ended = call => panic!("{ended:?}"),
    };
    assert_eq!(codes, [Fast::CODE, SlowCall::CODE]);
}

#[fc_test::test]
async fn reports_do_not_wait_for_an_answers_encoding() {
    let pusher = Arc::new(OnceLock::<ServerHandle<Toy>>::new());
    let robot = Robot::start(loopback(), {
        let pusher = Arc::clone(&pusher);
        move |request: Request<'_, Toy>| {
            let pusher = Arc::clone(&pusher);
            request.handle(move |_, SlowCall { value }| async move {
                MEANWHILE.set(Some(Box::new(move || {
                    let push = pusher
                        .get()
                        .unwrap()
                        .push(Audience::All, &Moved { metres: 1 });
                    let mut push = pin!(push);
                    let mut cx = Context::from_waker(Waker::noop());
                    assert!(push.as_mut().poll(&mut cx).is_pending());
                })));
                Ok(SlowReply { value })
            })
        }
    })
    .await;
    assert!(pusher.set(robot.handle.clone()).is_ok());
    let app = robot.connect().await;
    let mut reports = app.reports();
    assert!(app.call(&SlowCall { value: Slow }).await.is_ok());
    assert_eq!(reports.recv().await.unwrap().code, Moved::CODE);
}
