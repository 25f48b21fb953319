//! The process of the apps.
//!
//! It connects all apps, prints `ready`, and acknowledges reports until its input ends. Then it prints CPU seconds.

use super::robot::{ACKNOWLEDGEMENT, REPORT};
use crate::calls::{fc, runtime};
use crate::cost::Meter;
use fc_bench_cases::messages;
use fc_generated::{Fc, GetMapImageRequest, RequestEnvelope};
use fc_runtime::{Command as _, Encoder, FrameId, Header as _, Protocol, RequestEnvelope as _};
use std::io::{Read as _, stdin};
use std::net::SocketAddr;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;

/// The header of a frame.
type Head = <Fc as Protocol>::Header;

/// Runs `reports-drive ROBOT ADDRESS APPS SLOW`. The slow apps connect but never read.
pub fn drive(robot: &str, address: SocketAddr, apps: usize, slow: usize) {
    let runtime = runtime(false);
    runtime.block_on(async {
        let mut unread = Vec::new();
        for _ in 0..slow {
            unread.push(TcpStream::connect(address).await.expect("connect"));
        }
        for _ in 0..apps {
            if robot == "raw" {
                let stream = TcpStream::connect(address).await.expect("connect");
                stream.set_nodelay(true).expect("nodelay");
                tokio::spawn(acknowledge(stream));
            } else {
                let client = fc::connect(address).await;
                let mut reports = client.reports();
                tokio::spawn(async move {
                    while let Some(report) = reports.recv().await {
                        report.expect("a sound report");
                    }
                });
            }
        }
        let meter = Meter::start();
        println!("ready");
        let end = tokio::task::spawn_blocking(|| stdin().lock().read_to_string(&mut String::new()));
        let _ = end.await;
        println!("{}", meter.cpu());
        std::process::exit(0);
    });
}

/// Runs `reports-fetch ADDRESS`. Requests large responses, one after another, until the robot exits.
///
/// It discards the responses without parsing them, because an app on another machine would not use the robot's cores.
pub fn fetch(address: SocketAddr) {
    runtime(false).block_on(async {
        let mut request = Vec::new();
        let id = FrameId { response: false, kind: Fc::COMMAND, code: GetMapImageRequest::CODE, id: 1 };
        let mut encoder = Encoder::<Fc>::new();
        let envelope = RequestEnvelope::at(messages::TIME);
        encoder.message(&mut request, id, &envelope, &messages::map_request()).expect("it fits");
        let mut stream = TcpStream::connect(address).await.expect("connect");
        let mut answer = vec![0; 64 * 1024];
        // The loop ends when the robot exits.
        while stream.write_all(&request).await.is_ok() && stream.read_exact(&mut answer[..Head::LEN]).await.is_ok() {
            let length = Head::peek_total_length(&answer).expect("a whole header");
            let mut rest = (&mut stream).take(u64::from(length) - Head::LEN as u64);
            while let Ok(1..) = rest.read(&mut answer).await {}
        }
    });
}

/// Answers each report of the floor with the number of bytes of an acknowledgement.
async fn acknowledge(mut stream: TcpStream) {
    let mut input = vec![0; 64 * 1024];
    let mut have = 0;
    while let Ok(read @ 1..) = stream.read(&mut input).await {
        have += read;
        let answers = vec![7; have / REPORT * ACKNOWLEDGEMENT];
        have %= REPORT;
        if stream.write_all(&answers).await.is_err() {
            return;
        }
    }
}
