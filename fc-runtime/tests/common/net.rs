//! Robots and apps on loopback.

use super::{Done, Echo, EchoReply, Go, Toy};
use fc_runtime::{
    ClientConfig, Command, Connection, Handling, Refusal, Request, Server, ServerConfig,
    ServerHandle, Service,
};
use std::net::{Ipv4Addr, SocketAddr};

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
    ServerConfig::new().address(Ipv4Addr::LOCALHOST)
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
        Self { handle, config, command, data }
    }

    pub async fn connect(&self) -> Connection<Toy> {
        Connection::connect(self.config.clone()).await.unwrap()
    }
}
