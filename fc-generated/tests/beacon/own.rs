//! Tests the beacon's protocol, which has no result code: any response means success, and a failure gets no response.
//! `tests/it/other_protocols.rs` runs this in a crate that is generated from its spec.

#![allow(missing_docs, reason = "tests")]

use fc_generated::{
    AnyReport, Beacon, BlinkError, BlinkRequest, BlinkResponse, Client, PartialRobot, RobotService,
    Seen, SoundRequest,
};
use fc_runtime::{
    AckOutcome, Audience, CallError, ClientConfig, Context, Decoder, Encoder, FrameId,
    Protocol as _, Refusal, Server, ServerConfig, ServerHandle,
};
use std::net::{Ipv4Addr, SocketAddr};
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::task::JoinHandle;

struct Robot;

impl PartialRobot for Robot {
    async fn blink(
        &self,
        _: Context<Beacon>,
        request: BlinkRequest,
    ) -> Result<BlinkResponse, Refusal> {
        if request.times > 5 {
            return Err(BlinkError::TooOften.into());
        }
        Ok(BlinkResponse::new())
    }
}

async fn serve() -> (SocketAddr, ServerHandle<Beacon>, JoinHandle<()>) {
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let server = Server::bind(config, RobotService::new(Robot))
        .await
        .unwrap();
    let (address, handle) = (server.command_addr(), server.handle());
    (address, handle, tokio::spawn(server.run()))
}

/// One side of a connection, which sends and receives frames.
struct Raw {
    socket: TcpStream,
    decoder: Decoder<Beacon>,
}

impl Raw {
    fn new(socket: TcpStream) -> Self {
        Self {
            socket,
            decoder: Decoder::new(),
        }
    }

    async fn send(&mut self, id: FrameId, data: &str) {
        let mut frame = Vec::new();
        let made = Encoder::<Beacon>::new().bytes(&mut frame, id, data.as_bytes());
        made.unwrap();
        self.socket.write_all(&frame).await.unwrap();
    }

    /// Returns the next frame, or `None` at the end.
    async fn next(&mut self) -> Option<(FrameId, String)> {
        loop {
            if let Some(frame) = self.decoder.next().unwrap() {
                let text = String::from_utf8(frame.body().to_vec()).unwrap();
                return Some((frame.id(), text));
            }
            let mut bytes = [0; 1024];
            let read = self.socket.read(&mut bytes).await.unwrap();
            if read == 0 {
                return None;
            }
            self.decoder.push(&bytes[..read]);
        }
    }
}

fn asks(kind: u8, code: u16, id: u32) -> FrameId {
    FrameId {
        response: false,
        kind,
        code,
        id,
    }
}

#[tokio::test]
async fn refused_request_gets_no_response() {
    let (address, handle, serving) = serve().await;
    let mut app = Raw::new(TcpStream::connect(address).await.unwrap());
    let command = |code, id| asks(Beacon::COMMAND, code, id);
    app.send(command(2, 1), r#"{"times":6}"#).await; // Refused by the handler.
    app.send(command(2, 2), r#"{"times":0}"#).await; // Out of range.
    app.send(command(2, 3), r#"{"times":"#).await; // Not JSON.
    app.send(command(1, 4), "{}").await; // Not implemented.
    app.send(command(99, 5), "{}").await; // Unknown code.
    app.send(asks(9, 2, 6), r#"{"times":1}"#).await; // Unknown kind.
    app.send(command(2, 7), r#"{"times":1}"#).await;
    app.socket.shutdown().await.unwrap();
    let answer = app.next().await;
    assert_eq!(answer, Some((command(2, 7).answer(), "{}".to_owned())));
    assert_eq!(app.next().await, None);

    let counters = handle.counters();
    assert_eq!(counters.calls_refused, 1, "the robot itself knows");
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}

/// An app must not take silence for success.
#[tokio::test]
async fn a_refused_call_ends_with_a_timeout() {
    let (address, handle, serving) = serve().await;
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(address.port())
        .call_timeout(Duration::from_millis(100));
    let client = Client::connect(config).await.unwrap();
    let refused = client.blink(&BlinkRequest::new(6)).await;
    assert!(matches!(refused, Err(CallError::Timeout)), "{refused:?}");
    let refused = client.sound(&SoundRequest::new()).await;
    assert!(matches!(refused, Err(CallError::Timeout)), "{refused:?}");
    drop(client);
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}

#[tokio::test]
async fn any_answer_to_a_report_acknowledges_it() {
    let (address, handle, serving) = serve().await;
    let mut app = Raw::new(TcpStream::connect(address).await.unwrap());
    while handle.connections().is_empty() {
        tokio::task::yield_now().await;
    }
    let report = Seen::new("anna".to_owned());
    let (outcome, ()) = tokio::join!(handle.push(Audience::All, &report), async {
        let (id, text) = app.next().await.unwrap();
        assert_eq!((id.code, &*text), (0x0100, r#"{"who":"anna"}"#));
        app.send(id.answer(), "{}").await;
    });
    let outcome = outcome.unwrap();
    assert_eq!(outcome.len(), 1);
    assert_eq!(outcome[0].outcome, AckOutcome::Acknowledged);
    drop(app);
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}

/// Without a digest, the app distinguishes reports with the same id by their data.
#[tokio::test]
async fn app_acknowledges_and_distinguishes_reports() {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).await.unwrap();
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(listener.local_addr().unwrap().port());
    let (client, accepted) = tokio::join!(Client::connect(config), listener.accept());
    let client = client.unwrap();
    let mut reports = client.reports();
    let seen = |id| asks(Beacon::REPORT, 0x0100, id);

    let mut robot = Raw::new(accepted.unwrap().0);
    robot.send(seen(4), r#"{"who":"much too long"}"#).await;
    robot.send(seen(5), r#"{"who":"anna"}"#).await;
    let acknowledged = robot.next().await;
    assert_eq!(acknowledged, Some((seen(5).answer(), "{}".to_owned())));

    // A restarted robot begins its ids again.
    drop(robot);
    let mut robot = Raw::new(listener.accept().await.unwrap().0);
    for (id, who) in [(5, "bob"), (5, "bob"), (6, "eve")] {
        let text = format!(r#"{{"who":"{who}"}}"#);
        robot.send(seen(id), &text).await;
        let acknowledged = robot.next().await;
        assert_eq!(acknowledged, Some((seen(id).answer(), "{}".to_owned())));
    }
    for who in ["anna", "bob", "eve"] {
        let report = reports.recv().await.unwrap().unwrap();
        assert_eq!(report, AnyReport::Seen(Seen::new(who.to_owned())));
    }
}
