//! Robots and apps on loopback.

use super::{Done, Echo, EchoReply, Go, LIMITS, Toy, ToyResponse};
use fc_runtime::{
    ClientConfig, Command, Connection, DataConnection, Decoder, Empty, FrameId, Handling, Protocol,
    Refusal, Request, Server, ServerConfig, ServerHandle, Service,
};
use std::io::ErrorKind;
use std::net::{Ipv4Addr, SocketAddr};
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt, DuplexStream};
use tokio::sync::mpsc;

/// Answers [`Echo`], and refuses [`Go`] beyond 50 metres.
pub fn service(request: Request<'_, Toy>) -> Handling {
    match request.code() {
        Echo::CODE => request.handle(|_, Echo { text }| async { Ok(EchoReply { text }) }),
        Go::CODE => request.handle(|_, Go { metres }| async move {
            if metres > 50 {
                Err(Refusal::new(500, "too far"))
            } else {
                Ok(Done {})
            }
        }),
        _ => request.unknown(),
    }
}

pub fn loopback() -> ServerConfig {
    // All apps of a test come from the same address.
    ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .connections_per_address(usize::MAX)
}

/// Any address, for connections that have none.
pub fn nowhere() -> SocketAddr {
    SocketAddr::from((Ipv4Addr::LOCALHOST, 9))
}

/// A robot, and how an app finds it.
pub struct Robot {
    pub handle: ServerHandle<Toy>,
    pub config: ClientConfig,
    pub command: SocketAddr,
    pub data: SocketAddr,
}

impl Robot {
    pub async fn start(config: ServerConfig, service: impl Service<Toy>) -> Self {
        let server = Server::bind(config, service).await.unwrap();
        let (command, data) = (server.command_addr(), server.data_addr());
        let config = ClientConfig::new()
            .host("127.0.0.1")
            .command_port(command.port())
            .data_port(data.port());
        let handle = server.handle();
        tokio::spawn(server.run());
        Self {
            handle,
            config,
            command,
            data,
        }
    }

    pub async fn connect(&self) -> Connection<Toy> {
        Connection::connect(self.config.clone()).await.unwrap()
    }
}

impl Robot {
    /// An app over a pipe, for tests that hold the clock.
    pub fn pipe(&self, config: ClientConfig) -> Connection<Toy> {
        let (app, robot) = tokio::io::duplex(PIPE);
        self.handle.serve(robot, nowhere()).unwrap();
        Connection::over(app, config)
    }

    /// A peer that sends whatever a test wants, over a pipe.
    pub fn raw(&self) -> Raw<DuplexStream> {
        let (app, robot) = tokio::io::duplex(PIPE);
        self.handle.serve(robot, nowhere()).unwrap();
        Raw::new(app)
    }

    pub fn raw_data(&self) -> Raw<DuplexStream> {
        let (app, robot) = tokio::io::duplex(PIPE);
        self.handle.serve_data(robot, nowhere()).unwrap();
        Raw::new(app)
    }
}

/// An app whose robot is a test.
pub fn app_of_raw(config: ClientConfig) -> (Connection<Toy>, Raw<DuplexStream>) {
    let (app, robot) = tokio::io::duplex(PIPE);
    (Connection::over(app, config), Raw::new(robot))
}

const PIPE: usize = 64 * 1024;

/// A data connection over pipes of so many bytes: the robot's end of each that is made comes out of the
/// receiver.
pub fn data_over(
    app: &Connection<Toy>,
    bytes: usize,
) -> (DataConnection<Toy>, mpsc::UnboundedReceiver<DuplexStream>) {
    let (pipes, dialled) = mpsc::unbounded_channel();
    let dial = move || {
        let (app, robot) = tokio::io::duplex(bytes);
        let taken = pipes.send(robot);
        async move {
            taken
                .map(|()| app)
                .map_err(|_| ErrorKind::ConnectionRefused.into())
        }
    };
    (app.data_by(dial), dialled)
}

/// A data connection whose robot is a test, and the command connection that keeps it up.
pub async fn data_of_raw(bytes: usize) -> (DataConnection<Toy>, DuplexStream, impl Sized) {
    let (app, commands) = app_of_raw(ClientConfig::new());
    let (data, mut dialled) = data_over(&app, bytes);
    data.connected().await.unwrap();
    let end = dialled.recv().await.unwrap();
    (data, end, (commands, dialled))
}

/// A peer that does what a test wants, frame by frame.
pub struct Raw<S> {
    pub stream: S,
    decoder: Decoder<Toy>,
}

impl<S: AsyncRead + AsyncWrite + Unpin> Raw<S> {
    pub fn new(stream: S) -> Self {
        Self {
            stream,
            decoder: Decoder::new(),
        }
    }

    pub async fn send(&mut self, bytes: &[u8]) {
        self.stream.write_all(bytes).await.unwrap();
    }

    pub async fn send_frame(&mut self, id: FrameId, body: &str) {
        self.send(&super::frame(id, body.as_bytes())).await;
    }

    /// Returns the next frame or the name of its error, or `None` if the other side has closed.
    pub async fn recv(&mut self) -> Option<(FrameId, String)> {
        loop {
            match self.decoder.next() {
                Ok(Some(frame)) => {
                    return Some((
                        frame.id(),
                        String::from_utf8_lossy(frame.body()).into_owned(),
                    ));
                }
                Ok(None) => {}
                Err(error) => return Some((error.frame().unwrap(), error.name().to_owned())),
            }
            let mut bytes = [0; 4096];
            match self.stream.read(&mut bytes).await {
                Ok(0) | Err(_) => return None,
                Ok(n) => self.decoder.push(&bytes[..n]),
            }
        }
    }

    /// Sends something that a robot has heard of when this returns, at its data port or its command
    /// port.
    pub async fn speak(&mut self, data: bool) {
        let id = super::command(Echo::CODE, 1);
        if data {
            let stream = FrameId {
                kind: Toy::STREAM,
                ..id
            };
            self.send(&super::frame(stream, b"x")).await;
        }
        // Both ports answer it, after everything sent before.
        self.send_frame(id, "{}").await;
        self.result().await;
    }

    /// The result code of the next frame, and what it answers to.
    pub async fn result(&mut self) -> (FrameId, i64) {
        let (id, body) = self.recv().await.expect("an answer");
        let read = fc_runtime::read_enveloped::<ToyResponse, Empty>(body.as_bytes(), LIMITS.json())
            .unwrap();
        (id, read.envelope.result.into())
    }
}
