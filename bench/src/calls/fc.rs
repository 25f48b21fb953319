//! Peer `fc`: the generated client, and a service with two commands.

use super::peer::{Question, Serving};
use fc_bench_cases::messages;
use fc_generated::{Client, Fc, GetMapImageRequest, GetMapImageResponse, GetStationRequest};
use fc_runtime::{
    ClientConfig, Command as _, Handling, Limits, PreparedResponse, Protocol as _, Request, Server, ServerConfig,
    Service,
};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;

/// Encoding of large responses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answers {
    /// For each request.
    Made,
    /// Once for all requests.
    Prepared,
}

/// A service that responds with stations and maps.
pub struct Robot {
    map: Arc<GetMapImageResponse>,
    prepared: Option<PreparedResponse<GetMapImageResponse>>,
}

impl Robot {
    /// Creates a service whose map has 1 MiB of base64 text.
    pub fn new(answers: Answers) -> Self {
        let map = messages::large();
        let prepared =
            (answers == Answers::Prepared).then(|| PreparedResponse::new(&map).expect("a response of the spec"));
        Self { map: Arc::new(map), prepared }
    }
}

impl Service<Fc> for Robot {
    fn call(&self, request: Request<'_, Fc>) -> Handling {
        match request.code() {
            GetStationRequest::CODE => request
                .handle(|_, request: GetStationRequest| async move { Ok(messages::small(request.data.station_id)) }),
            GetMapImageRequest::CODE => {
                if let Some(map) = self.prepared.clone() {
                    return request.handle_prepared(|_, _: GetMapImageRequest| async move { Ok(map) });
                }
                let map = Arc::clone(&self.map);
                request.handle(|_, _: GetMapImageRequest| async move { Ok(GetMapImageResponse::clone(&map)) })
            }
            _ => request.unknown(),
        }
    }
}

/// Binds a server to free ports, with room for many apps.
pub async fn bind(service: impl Service<Fc>) -> Server<Fc> {
    let limits = Limits { connections: 4096, ..Fc::DEFAULTS.limits };
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0)
        .limits(limits)
        .connections_per_address(4096);
    Server::bind(config, service).await.expect("bind")
}

/// Returns the settings of an app for the server at `address`.
pub fn config(address: SocketAddr) -> ClientConfig {
    ClientConfig::new().host(address.ip().to_string()).command_port(address.port())
}

pub async fn serve(answers: Answers) -> Serving {
    let server = bind(Robot::new(answers)).await;
    (server.command_addr(), Box::pin(server.run()))
}

pub async fn connect(address: SocketAddr) -> Client {
    Client::connect(config(address)).await.expect("connect")
}

pub async fn call(client: Client, question: Question) -> usize {
    match question {
        Question::Small => {
            let request = messages::station_request();
            client.get_station(&request).await.expect("answer").data.station_name.len()
        }
        Question::Large => {
            let request = messages::map_request();
            client.get_map_image(&request).await.expect("answer").png_map_bytes.0.len()
        }
    }
}
