//! The apps' process: connects all of them, says so, takes and acknowledges reports until its input
//! ends, and prints CPU seconds.

use super::robot::{ACKNOWLEDGEMENT, REPORT};
use crate::calls::{fc, runtime};
use crate::cost::Meter;
use std::io::{Read as _, stdin};
use std::net::SocketAddr;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;

/// `reports-drive ROBOT ADDRESS APPS SLOW`.
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

/// Answers every report with as many bytes as an acknowledgement has.
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
