//! A peer that goes without a word is noticed by the kernel: it asks whether the peer is still there.

#![cfg(target_os = "linux")]

use crate::common::net::{Robot, loopback, service};
use crate::common::{Toy, until};
use fc_runtime::{ClientConfig, Connection};
use std::fs;
use std::net::SocketAddr;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};

/// Returns the silence of `to` after which the kernel of `from` probes, or `None` if it does not.
fn asks_within(from: SocketAddr, to: SocketAddr) -> Option<Duration> {
    const KEEPALIVE: &str = "02";
    const HUNDREDTHS: u64 = 10;

    let port = |address: SocketAddr| format!(":{:04X}", address.port());
    let table = fs::read_to_string("/proc/net/tcp").unwrap();
    let lines = table.lines().map(|line| line.split_whitespace());
    let mut sockets = lines.map(Iterator::collect::<Vec<_>>);
    let socket = sockets.find(|it| it[1].ends_with(&port(from)) && it[2].ends_with(&port(to)));
    let socket = socket.expect("a socket");
    let (timer, rest) = socket[5].split_once(':').unwrap();
    let rest = u64::from_str_radix(rest, 16).unwrap();
    (timer == KEEPALIVE).then(|| Duration::from_millis(rest * HUNDREDTHS))
}

const THIRTY: Duration = Duration::from_secs(30);
const HOUR: Duration = Duration::from_secs(60 * 60);

/// Keepalive by default, with an hour, and off.
const WANTED: [Option<Duration>; 3] = [Some(THIRTY), Some(HOUR), None];

fn check(asks: Option<Duration>, wanted: Option<Duration>) {
    match (asks, wanted) {
        // It runs already.
        (Some(asks), Some(wanted)) => assert!(asks <= wanted && asks > wanted / 2, "{asks:?}"),
        _ => assert_eq!(asks, wanted),
    }
}

#[fc_test::test]
async fn an_app_asks() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let robot = listener.local_addr().unwrap();
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(robot.port());
    let configs = [
        config.clone(),
        config.clone().keepalive(Some(HOUR)),
        config.keepalive(None),
    ];
    for (config, wanted) in configs.into_iter().zip(WANTED) {
        let (_app, accepted) = tokio::join!(Connection::<Toy>::connect(config), listener.accept());
        check(asks_within(accepted.unwrap().1, robot), wanted);
    }
}

#[fc_test::test]
async fn a_robot_asks_at_both_ports() {
    let configs = [
        loopback(),
        loopback().keepalive(Some(HOUR)),
        loopback().keepalive(None),
    ];
    for (config, wanted) in configs.into_iter().zip(WANTED) {
        let robot = Robot::start(config, service).await;
        let command = TcpStream::connect(robot.command).await.unwrap();
        let data = TcpStream::connect(robot.data).await.unwrap();
        let counters = || robot.handle.counters();
        until(|| counters().connections == 1 && counters().data_connections == 1).await;
        for (port, app) in [(robot.command, command), (robot.data, data)] {
            check(asks_within(port, app.local_addr().unwrap()), wanted);
        }
    }
}
