//! Robots that announce more than they send, or do not read, and the errors of the app.

use crate::common::net::{Raw, app_of_raw, data_of_raw};
use crate::common::{self, Echo, Moved, Toy, ToyHeader, answer_to, command, frame, report, until};
use fc_runtime::{
    Backoff, CallError, CallOptions, ClientConfig, Connection, DataError, FrameError, FrameId,
    Header, Loss, Protocol, Report,
};
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt, DuplexStream, duplex};
use tokio::sync::mpsc;
use tokio::time::{Instant, sleep, timeout};

const STALL: Duration = Duration::from_secs(10);
const LONG: Duration = Duration::from_secs(600);

fn echo() -> Echo {
    Echo { text: "x".into() }
}

fn patient() -> CallOptions {
    CallOptions {
        timeout: Some(LONG),
        repeat: Some(false),
    }
}

/// An app over pipes: each connection it makes comes out of the receiver.
async fn dialling(config: ClientConfig) -> (Connection<Toy>, mpsc::Receiver<DuplexStream>) {
    let (pipes, dialled) = mpsc::channel(1);
    let dial = move || {
        let pipes = pipes.clone();
        async move {
            let (app, robot) = duplex(64 * 1024);
            pipes.send(robot).await.unwrap();
            Ok(app)
        }
    };
    let app = Connection::connect_by(dial, config).await.unwrap();
    (app, dialled)
}

#[fc_test::test(start_paused = true)]
async fn a_frame_that_stops_loses_its_connection_alone() {
    let (app, mut dialled) = dialling(ClientConfig::new()).await;
    let mut robot = Raw::new(dialled.recv().await.unwrap());
    let whole = frame(report(Moved::CODE, 1), &[b'x'; 4000]);
    for received in [1, ToyHeader::LEN, 1000] {
        let request = echo();
        let call = app.call(&request).with_options(patient());
        let (end, ()) = tokio::join!(call, async {
            robot.recv().await.unwrap();
            let start = Instant::now();
            robot.send(&whole[..received]).await;
            assert_eq!(robot.recv().await, None);
            assert_eq!(start.elapsed(), STALL);
        });
        let total = if received == 1 {
            ToyHeader::LEN
        } else {
            whole.len()
        };
        let stalled = Loss::Stalled { received, total };
        assert_eq!(end, Err(CallError::Lost(stalled)));
        // The next connection is a good one, until it stalls as well.
        robot = Raw::new(dialled.recv().await.unwrap());
        let answered = async {
            let (id, _) = robot.recv().await.unwrap();
            let text = r#"{"result":7,"text":"x"}"#;
            robot.send_frame(answer_to(id), text).await;
        };
        assert!(tokio::join!(app.call(&request), answered).0.is_ok());
    }
}

#[fc_test::test(start_paused = true)]
async fn a_frame_that_goes_on_is_waited_for() {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let request = Echo {
        text: "x".repeat(1000),
    };
    let (end, ()) = tokio::join!(app.call(&request).with_options(patient()), async {
        let (id, _) = robot.recv().await.unwrap();
        let text = format!(r#"{{"result":7,"text":"{}"}}"#, "y".repeat(400_000));
        let answer = frame(answer_to(id), text.as_bytes());
        for piece in answer.chunks(40_000) {
            robot.send(piece).await;
            sleep(STALL / 3).await;
        }
    });
    assert_eq!(end.unwrap().text.len(), 400_000);
}

/// A wrong length swallows the following responses, which must not count as progress.
#[fc_test::test(start_paused = true)]
async fn swallowed_responses_are_no_progress() {
    let config = ClientConfig::new().call_timeout(Duration::from_secs(1));
    let (app, mut robot) = app_of_raw(config);
    let claim = frame(command(1, 1), &vec![b'x'; 4_000_000]);
    robot.send(&claim[..ToyHeader::LEN]).await;
    let mut ends = Vec::new();
    for _ in 0..15 {
        let request = echo();
        let (end, _) = tokio::join!(app.call(&request), async {
            robot.stream.write_all(&[b'y'; 100]).await
        });
        ends.push(end.unwrap_err());
    }
    let total = claim.len();
    assert_eq!(ends[0], CallError::Timeout);
    assert!(
        matches!(ends.last(), Some(CallError::Closed(Loss::Stalled { received, total: claimed }))
            if *claimed == total && *received < 2000),
        "{ends:?}"
    );
}

#[fc_test::test(start_paused = true)]
async fn a_robot_that_does_not_read_is_left() {
    let (app, robot) = app_of_raw(ClientConfig::new());
    let request = Echo {
        text: "x".repeat(1_000_000),
    };
    let start = Instant::now();
    let end = app.call(&request).with_options(patient()).await;
    assert_eq!(end, Err(CallError::Lost(Loss::Unread)));
    assert_eq!(start.elapsed(), STALL);
    drop(robot);
}

#[fc_test::test(start_paused = true)]
async fn a_robot_that_reads_slowly_is_waited_for() {
    let (app, robot) = app_of_raw(ClientConfig::new());
    let request = Echo {
        text: "x".repeat(1_000_000),
    };
    let mut stream = robot.stream;
    let reading = async {
        let (mut read, mut piece) = (0, vec![0; 50_000]);
        while read < 1_000_000 {
            sleep(STALL / 2).await;
            read += stream.read(&mut piece).await.unwrap();
        }
    };
    let call = app.call(&request).with_options(patient());
    tokio::select! {
        end = call => panic!("{end:?}"),
        () = reading => {}
    }
}

/// The end of a connection, and the error of the waiting call.
#[fc_test::test(start_paused = true)]
async fn the_cause_is_in_the_error() {
    let long = frame(command(1, 1), &[b'x'; 100]);
    let mut huge = long.clone();
    huge[3..7].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut short = long.clone();
    short[3..7].copy_from_slice(&1_u32.to_le_bytes());
    let limit = common::LIMITS.frame_bytes;
    let header = ToyHeader::LEN;
    let causes: [(&[u8], FrameError); 4] = [
        (b"HTTP/1.1 400", FrameError::BadHead),
        (
            &huge,
            FrameError::FrameTooLong {
                total: u64::from(u32::MAX),
                limit,
            },
        ),
        (&short, FrameError::ShortFrame { total: 1, header }),
        (&long[..50], FrameError::Truncated { bytes: 50 }),
    ];
    for (bytes, error) in causes {
        let end = lost(bytes).await;
        assert_eq!(end, CallError::Lost(Loss::Frame(error)));
        assert_eq!(
            (end.name(), end.loss().unwrap().name()),
            ("lost", error.name())
        );
        assert!(end.to_string().contains(&error.to_string()), "{end}");
    }
    assert_eq!(lost(b"").await, CallError::Lost(Loss::Unheard));
    let heard = frame(report(Moved::CODE, 1), b"{}");
    assert_eq!(lost(&heard).await, CallError::Lost(Loss::Closed));
}

/// The result of a call when the robot responds with these bytes and closes.
async fn lost(bytes: &[u8]) -> CallError {
    let (app, mut robot) = app_of_raw(ClientConfig::new());
    let request = echo();
    let (end, ()) = tokio::join!(app.call(&request), async {
        robot.recv().await.unwrap();
        robot.send(bytes).await;
        drop(robot);
    });
    end.unwrap_err()
}

/// A read that was lost and found no other connection is lost, and one that never left is not sent.
#[fc_test::test(start_paused = true)]
async fn error_without_a_connection_has_the_reason() {
    let mut robots = 1;
    let (pipes, mut dialled) = mpsc::channel(1);
    let dial = move || {
        let pipe = (robots > 0).then(|| duplex(1000));
        robots -= 1;
        let pipes = pipes.clone();
        async move {
            let (app, robot) = pipe.ok_or(std::io::ErrorKind::HostUnreachable)?;
            pipes.send(robot).await.unwrap();
            Ok(app)
        }
    };
    let config = ClientConfig::new().reconnect(Backoff::default());
    let app = Connection::<Toy>::connect_by(dial, config).await.unwrap();
    let mut robot = Raw::new(dialled.recv().await.unwrap());
    let request = echo();
    let (sent, unsent) = tokio::join!(app.call(&request), async {
        robot.recv().await.unwrap();
        drop(robot);
        until(|| !app.state().is_connected()).await;
        app.call(&request).await
    });
    let why = Loss::Unreachable(std::io::ErrorKind::HostUnreachable);
    assert_eq!(sent, Err(CallError::Lost(why)));
    assert_eq!(unsent, Err(CallError::NotConnected(why)));
    app.close();
    assert_eq!(app.call(&request).await, Err(CallError::Closed(Loss::Here)));
}

#[fc_test::test(start_paused = true)]
async fn a_data_connection_stalls_too() {
    let id = FrameId {
        kind: Toy::STREAM,
        ..command(1, 1)
    };
    let bytes = frame(id, &[b'x'; 4000]);
    for impatient in [false, true] {
        let (app, end, _kept) = data_of_raw(10_000).await;
        let mut robot = Raw::new(end);
        robot.send(&bytes[..1000]).await;
        let start = Instant::now();
        // A caller that waits again and again does not wait longer.
        let patience = if impatient { STALL / 7 } else { LONG };
        let error = loop {
            if let Ok(received) = timeout(patience, app.recv()).await {
                break received.unwrap_err();
            }
        };
        let (received, total) = (1000, bytes.len());
        let stalled = Loss::Stalled { received, total };
        assert_eq!(error, DataError::Lost(stalled));
        assert_eq!(start.elapsed(), STALL);
    }
}

#[fc_test::test(start_paused = true)]
async fn interrupted_read_keeps_the_partial_frame() {
    let id = FrameId {
        kind: Toy::STREAM,
        ..command(1, 1)
    };
    let bytes = frame(id, &[b'x'; 4000]);
    let (app, end, _kept) = data_of_raw(10_000).await;
    let mut robot = Raw::new(end);
    robot.send(&bytes[..1000]).await;
    assert!(timeout(STALL / 2, app.recv()).await.is_err());
    sleep(STALL / 3).await;
    robot.send(&bytes[1000..]).await;
    sleep(2 * STALL).await;
    assert_eq!(app.recv().await.unwrap().data.len(), 4000);
}

#[fc_test::test(start_paused = true)]
async fn a_robot_that_does_not_read_streams_is_left() {
    let (app, end, _kept) = data_of_raw(10_000).await;
    let start = Instant::now();
    let error = app.send(1, 1, &vec![0; 100_000]).await.unwrap_err();
    assert_eq!(error, DataError::Lost(Loss::Unread));
    assert_eq!(start.elapsed(), STALL);
    drop(end);
}
