//! Peer `tonic`, with prost.

use super::peer::{Question, Serving, listen, map_text};
use fc_bench_cases::messages::{RESULT_CODE, RESULT_TEXT, STATION, STATION_NAME, TIME};
use std::net::SocketAddr;
use tonic::transport::{Channel, Endpoint, Server, server::TcpIncoming};
use tonic::{Request, Response, Status};

#[allow(clippy::all, clippy::pedantic)]
pub mod pb {
    tonic::include_proto!("bench");
}

use pb::robot_client::RobotClient;
use pb::robot_server::{Robot, RobotServer};

struct Answers {
    map: String,
}

#[tonic::async_trait]
impl Robot for Answers {
    async fn get_station(&self, request: Request<pb::StationRequest>) -> Result<Response<pb::StationResponse>, Status> {
        Ok(Response::new(pb::StationResponse {
            cmd_time: TIME,
            result_code: RESULT_CODE,
            result_msg: RESULT_TEXT.to_owned(),
            station_name: STATION_NAME.to_owned(),
            station_id: request.get_ref().station_id,
            station_type: 0,
            x: 0.5,
            y: 0.6,
            yaw: 0.2,
        }))
    }

    async fn get_map(&self, _: Request<pb::MapRequest>) -> Result<Response<pb::MapResponse>, Status> {
        Ok(Response::new(pb::MapResponse {
            cmd_time: TIME,
            result_code: RESULT_CODE,
            result_msg: RESULT_TEXT.to_owned(),
            image: String::new(),
            resolution: 0.05,
            png: self.map.clone(),
        }))
    }
}

pub async fn serve() -> Serving {
    let (address, listener) = listen().await;
    let incoming = TcpIncoming::from(listener).with_nodelay(Some(true));
    let robot = RobotServer::new(Answers { map: map_text() }).max_encoding_message_size(8 << 20);
    let serving = Server::builder().add_service(robot).serve_with_incoming(incoming);
    (address, Box::pin(async { serving.await.expect("serve") }))
}

pub async fn connect(address: SocketAddr) -> RobotClient<Channel> {
    let endpoint = Endpoint::from_shared(format!("http://{address}")).expect("address").tcp_nodelay(true);
    RobotClient::new(endpoint.connect().await.expect("connect")).max_decoding_message_size(8 << 20)
}

pub async fn call(mut client: RobotClient<Channel>, question: Question) -> usize {
    match question {
        Question::Small => {
            let request = pb::StationRequest { cmd_time: TIME, station_id: STATION };
            client.get_station(request).await.expect("answer").into_inner().station_name.len()
        }
        Question::Large => {
            let request = pb::MapRequest { cmd_time: TIME, map_id: STATION };
            client.get_map(request).await.expect("answer").into_inner().png.len()
        }
    }
}
