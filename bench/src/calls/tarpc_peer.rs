//! Peers `tarpc-bincode` and `tarpc-json`.

use super::peer::{Question, Serving, listen, map_text};
use fc_bench_cases::messages::{RESULT_CODE, RESULT_TEXT, STATION, STATION_NAME, TIME};
use futures_util::StreamExt as _;
use serde::{Deserialize, Serialize};
use std::net::SocketAddr;
use std::sync::Arc;
use tarpc::server::{BaseChannel, Channel as _};
use tarpc::{client, context};
use tokio::net::{TcpListener, TcpStream};
use tokio_serde::formats::{Bincode, Json};

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Station {
    cmd_time: i64,
    result_code: i32,
    result_msg: String,
    station_name: String,
    station_id: i64,
    station_type: i32,
    x: f64,
    y: f64,
    yaw: f64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Map {
    cmd_time: i64,
    result_code: i32,
    result_msg: String,
    image: String,
    resolution: f64,
    png: String,
}

#[tarpc::service]
pub trait Robot {
    async fn get_station(cmd_time: i64, station_id: i64) -> Station;
    async fn get_map(cmd_time: i64, map_id: i64) -> Map;
}

#[derive(Clone)]
struct Answers(Arc<String>);

impl Robot for Answers {
    async fn get_station(self, _: context::Context, _: i64, station_id: i64) -> Station {
        Station {
            cmd_time: TIME,
            result_code: RESULT_CODE,
            result_msg: RESULT_TEXT.to_owned(),
            station_name: STATION_NAME.to_owned(),
            station_id,
            station_type: 0,
            x: 0.5,
            y: 0.6,
            yaw: 0.2,
        }
    }

    async fn get_map(self, _: context::Context, _: i64, _: i64) -> Map {
        Map {
            cmd_time: TIME,
            result_code: RESULT_CODE,
            result_msg: RESULT_TEXT.to_owned(),
            image: String::new(),
            resolution: 0.05,
            png: String::clone(&self.0),
        }
    }
}

/// Format of the messages.
#[derive(Clone, Copy)]
pub enum Format {
    Bincode,
    Json,
}

macro_rules! transport {
    ($stream:expr, $codec:expr) => {{
        let mut frames = tarpc::tokio_util::codec::LengthDelimitedCodec::new();
        frames.set_max_frame_length(8 << 20);
        let framed = tarpc::tokio_util::codec::Framed::new($stream, frames);
        tarpc::serde_transport::new(framed, $codec)
    }};
}

pub async fn serve(format: Format) -> Serving {
    let (address, listener) = listen().await;
    (address, Box::pin(answer(listener, format)))
}

async fn answer(listener: TcpListener, format: Format) {
    let answers = Answers(Arc::new(map_text()));
    loop {
        let Ok((stream, _)) = listener.accept().await else { return };
        let _ = stream.set_nodelay(true);
        let answers = answers.clone();
        macro_rules! run {
            ($codec:expr) => {
                tokio::spawn(BaseChannel::with_defaults(transport!(stream, $codec)).execute(answers.serve()).for_each(
                    |answer| async {
                        tokio::spawn(answer);
                    },
                ))
            };
        }
        match format {
            Format::Bincode => run!(Bincode::default()),
            Format::Json => run!(Json::default()),
        };
    }
}

pub async fn connect(address: SocketAddr, format: Format) -> RobotClient {
    let stream = TcpStream::connect(address).await.expect("connect");
    stream.set_nodelay(true).expect("nodelay");
    let mut config = client::Config::default();
    config.max_in_flight_requests = 1024;
    config.pending_request_buffer = 1024;
    match format {
        Format::Bincode => RobotClient::new(config, transport!(stream, Bincode::default())).spawn(),
        Format::Json => RobotClient::new(config, transport!(stream, Json::default())).spawn(),
    }
}

pub async fn call(client: RobotClient, question: Question) -> usize {
    match question {
        Question::Small => {
            client.get_station(context::current(), TIME, STATION).await.expect("answer").station_name.len()
        }
        Question::Large => client.get_map(context::current(), TIME, STATION).await.expect("answer").png.len(),
    }
}
