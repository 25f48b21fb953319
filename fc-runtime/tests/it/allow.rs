//! Access rules by network and effect.

use crate::common::log::{Log, alone};
use crate::common::net::{Raw, Robot, loopback, service};
use crate::common::{Echo, Go, Toy, command, frame};
use fc_runtime::{
    Command, Effect, Handling, Network, NetworkError, Request, ServerConfig, ServerCounters,
};
use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tokio::io::{AsyncReadExt, AsyncWriteExt, DuplexStream};
use tokio::net::TcpStream;
use tracing::Level;

fn network(text: &str) -> Network {
    text.parse().unwrap_or_else(|error| panic!("{error}"))
}

/// Written networks, and their displayed form.
const NETWORKS: [(&str, &str); 8] = [
    ("10.0.0.0/8", "10.0.0.0/8"),
    ("192.0.2.7", "192.0.2.7/32"),
    ("0.0.0.0/0", "0.0.0.0/0"),
    ("FD00::/8", "fd00::/8"),
    ("::/0", "::/0"),
    ("2001:db8::1", "2001:db8::1/128"),
    ("::ffff:10.0.0.0/104", "10.0.0.0/8"),
    ("::ffff:192.0.2.7", "192.0.2.7/32"),
];

#[fc_test::test]
fn networks_are_read_and_shown() {
    for (text, shown) in NETWORKS {
        assert_eq!(network(text).to_string(), shown, "{text}");
        assert_eq!(network(shown), network(text), "{text}");
    }
}

#[fc_test::test]
fn invalid_network_is_refused_with_a_reason() {
    type Expected = fn(&NetworkError) -> bool;
    let cases: [(&str, Expected, &str); 10] = [
        ("", |e| matches!(e, NetworkError::Address { .. }), "``"),
        (
            "10.0.0/8",
            |e| matches!(e, NetworkError::Address { .. }),
            "`10.0.0`",
        ),
        (
            "robot.local",
            |e| matches!(e, NetworkError::Address { .. }),
            "`robot.local`",
        ),
        (
            "10.0.0.0/33",
            |e| matches!(e, NetworkError::Prefix { longest: 32, .. }),
            "0 to 32",
        ),
        (
            "fd00::/129",
            |e| matches!(e, NetworkError::Prefix { longest: 128, .. }),
            "0 to 128",
        ),
        (
            "10.0.0.0/",
            |e| matches!(e, NetworkError::Prefix { .. }),
            "``",
        ),
        (
            "10.0.0.0/+8",
            |e| matches!(e, NetworkError::Prefix { .. }),
            "`+8`",
        ),
        (
            "10.0.0.0/255.0.0.0",
            |e| matches!(e, NetworkError::Prefix { .. }),
            "`255.0.0.0`",
        ),
        (
            "10.1.2.3/8",
            |e| matches!(e, NetworkError::HostBits { .. }),
            "10.0.0.0/8",
        ),
        (
            "fd00::1/64",
            |e| matches!(e, NetworkError::HostBits { .. }),
            "fd00::/64",
        ),
    ];
    for (text, expected, says) in cases {
        let error = text.parse::<Network>().expect_err(text);
        assert!(expected(&error), "{text}: {error:?}");
        assert!(error.to_string().contains(says), "{text}: {error}");
    }
}

#[fc_test::test]
fn network_contains_mapped_addresses() {
    let cases = [
        ("10.0.0.0/8", "10.255.255.255", true),
        ("10.0.0.0/8", "11.0.0.0", false),
        ("10.0.0.0/8", "::ffff:10.1.2.3", true),
        ("10.0.0.0/8", "::ffff:11.0.0.0", false),
        ("10.0.0.0/8", "a00::", false),
        ("::ffff:10.0.0.0/104", "10.1.2.3", true),
        ("192.0.2.128/25", "192.0.2.127", false),
        ("192.0.2.128/25", "192.0.2.128", true),
        ("192.0.2.7", "192.0.2.7", true),
        ("192.0.2.7", "192.0.2.6", false),
        ("0.0.0.0/0", "255.255.255.255", true),
        ("0.0.0.0/0", "::1", false),
        ("::/0", "2001:db8::1", true),
        ("::/0", "192.0.2.1", false),
        ("fd00::/8", "fdff::1", true),
        ("fd00::/8", "fc00::1", false),
    ];
    for (text, address, holds) in cases {
        let address: IpAddr = address.parse().unwrap();
        assert_eq!(network(text).contains(address), holds, "{text} {address}");
    }
}

/// A robot that counts started handlers.
async fn robot(config: ServerConfig) -> (Robot, Arc<AtomicUsize>) {
    let begun = Arc::<AtomicUsize>::default();
    let count = Arc::clone(&begun);
    let counting = move |request: Request<'_, Toy>| -> Handling {
        count.fetch_add(1, Ordering::Relaxed);
        service(request)
    };
    (Robot::start(config, counting).await, begun)
}

/// An app from this address; `None` if it is closed at once.
fn connect(robot: &Robot, from: &str, data: bool) -> Option<Raw<DuplexStream>> {
    let (app, end) = tokio::io::duplex(10_000);
    let address = SocketAddr::new(from.parse().unwrap(), 1000);
    let id = if data {
        robot.handle.serve_data(end, address)
    } else {
        robot.handle.serve(end, address)
    };
    id.map(|_| Raw::new(app))
}

#[fc_test::test]
async fn everybody_may_connect_unless_somebody_is_named() {
    let _alone = alone();
    let (robot, _) = robot(loopback()).await;
    for data in [false, true] {
        assert!(connect(&robot, "203.0.113.9", data).is_some());
        assert!(connect(&robot, "2001:db8::1", data).is_some());
    }
    assert_eq!(robot.handle.counters().connections_forbidden, 0);
}

#[fc_test::test]
async fn address_outside_the_networks_cannot_connect() {
    let log = Log::listen(Level::WARN);
    let config = loopback().allow(network("10.0.0.0/8"), Effect::ALL);
    let (robot, _) = robot(config.allow(network("fd00::/8"), Effect::ALL)).await;
    for data in [false, true] {
        for from in ["10.1.2.3", "::ffff:10.1.2.3", "fd00::1"] {
            assert!(connect(&robot, from, data).is_some(), "{from}");
        }
        for from in ["192.0.2.1", "::ffff:192.0.2.1", "2001:db8::1"] {
            assert!(connect(&robot, from, data).is_none(), "{from}");
        }
    }
    let counters = robot.handle.counters();
    assert_eq!(counters.connections_forbidden, 6);
    assert_eq!((counters.connections, counters.data_connections), (3, 3));
    assert_eq!(counters.connections_refused, 0);
    let lines = log.take();
    assert_eq!(lines.len(), 5, "{lines:#?}");
    assert_eq!(
        lines.first().map(String::as_str),
        Some(r#"WARN refused: the address is not allowed protocol="toy" peer=192.0.2.1"#)
    );
}

#[fc_test::test]
async fn a_socket_from_elsewhere_is_closed_at_once() {
    let _alone = alone();
    let config = loopback().allow(network("192.0.2.0/24"), Effect::ALL);
    let (robot, _) = robot(config).await;
    for address in [robot.command, robot.data] {
        let mut stream = TcpStream::connect(address).await.unwrap();
        // Either port would answer it.
        let request = frame(command(Echo::CODE, 1), b"{}");
        let _ = stream.write_all(&request).await;
        let read = stream.read(&mut [0; 16]).await;
        assert!(matches!(read, Ok(0) | Err(_)), "{read:?}");
    }
    assert_eq!(robot.handle.counters().connections_forbidden, 2);
}

/// Sends a command and gives the result.
async fn call(app: &mut Raw<DuplexStream>, code: u16, id: u32, body: &str) -> i64 {
    app.send_frame(command(code, id), body).await;
    app.result().await.1
}

const ECHO: &str = r#"{"text":"x"}"#;
const GO: &str = r#"{"metres":1}"#;

#[fc_test::test]
async fn address_with_read_only_cannot_move() {
    let log = Log::listen(Level::WARN);
    let config = loopback()
        .allow(network("10.0.0.0/8"), Effect::ALL)
        .allow(network("10.0.7.0/24"), [Effect::Read]);
    let (robot, begun) = robot(config).await;

    let mut display = connect(&robot, "10.0.7.1", false).unwrap();
    assert_eq!(call(&mut display, Echo::CODE, 1, ECHO).await, 7);
    assert_eq!(begun.load(Ordering::Relaxed), 1);
    assert_eq!(call(&mut display, Go::CODE, 2, GO).await, 71);
    // The effect of a code that the spec does not have is unknown.
    assert_eq!(call(&mut display, 0x0999, 3, "{}").await, 71);
    assert_eq!(begun.load(Ordering::Relaxed), 1, "its handler has run");
    assert_eq!(call(&mut display, Echo::CODE, 4, ECHO).await, 7);

    let mut app = connect(&robot, "10.0.8.1", false).unwrap();
    assert_eq!(call(&mut app, Go::CODE, 1, GO).await, 7);
    let ServerCounters {
        calls_forbidden,
        calls_protocol,
        calls_succeeded,
        ..
    } = robot.handle.counters();
    assert_eq!(
        (calls_forbidden, calls_protocol, calls_succeeded),
        (2, 2, 3)
    );
    let lines = log.take();
    assert_eq!(lines.len(), 2, "{lines:#?}");
    assert_eq!(
        lines.first().map(String::as_str),
        Some(
            r#"WARN refused: not allowed from this address protocol="toy" connection=1 peer=10.0.7.1:1000 name="go" code=258 effect=Motion"#
        )
    );
}

#[fc_test::test]
async fn the_smallest_network_counts_in_any_order() {
    let _alone = alone();
    let wide = (network("0.0.0.0/0"), vec![Effect::Read]);
    let narrow = (network("10.0.0.0/8"), Effect::ALL.to_vec());
    let one = (network("10.0.0.1"), vec![]);
    for order in [[&wide, &narrow, &one], [&one, &narrow, &wide]] {
        let config = order.iter().fold(loopback(), |config, (network, effects)| {
            config.allow(*network, effects.iter().copied())
        });
        let (robot, _) = robot(config).await;
        for (from, echo, go) in [
            ("192.0.2.1", 7, 71),
            ("10.0.0.2", 7, 7),
            ("10.0.0.1", 71, 71),
        ] {
            let mut app = connect(&robot, from, false).expect(from);
            assert_eq!(call(&mut app, Echo::CODE, 1, ECHO).await, echo, "{from}");
            assert_eq!(call(&mut app, Go::CODE, 2, GO).await, go, "{from}");
        }
    }
}
