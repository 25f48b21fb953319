//! Too many connections: silent ones are replaced first, and one address cannot lock others out.

use crate::common::log::{Log, alone};
use crate::common::net::{Raw, Robot, loopback, service};
use crate::common::{Echo, LIMITS};
use fc_runtime::{ConnectionId, Limits, ServerConfig};
use std::net::{Ipv4Addr, SocketAddr};
use tokio::io::DuplexStream;
use tokio::net::TcpStream;
use tracing::Level;

/// A connection to one of a robot's ports, from any address.
struct App {
    raw: Raw<DuplexStream>,
    id: Option<ConnectionId>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Port {
    Command,
    Data,
}

const PORTS: [Port; 2] = [Port::Command, Port::Data];

impl App {
    /// From the `host`th address of a network.
    fn connect(robot: &Robot, port: Port, host: u8) -> Self {
        let (app, end) = tokio::io::duplex(10_000);
        let address = SocketAddr::from((Ipv4Addr::new(192, 0, 2, host), 1000));
        let id = match port {
            Port::Command => robot.handle.serve(end, address),
            Port::Data => robot.handle.serve_data(end, address),
        };
        Self {
            raw: Raw::new(app),
            id,
        }
    }

    /// Sends something that is answered, so that the robot has heard of it.
    async fn speak(mut self, port: Port) -> Self {
        self.raw.speak(port == Port::Data).await;
        self
    }

    async fn is_closed(&mut self) -> bool {
        self.raw.recv().await.is_none()
    }
}

async fn robot(connections: usize, per_address: usize) -> Robot {
    let limits = Limits {
        connections,
        ..LIMITS
    };
    let config = loopback().limits(limits);
    Robot::start(config.connections_per_address(per_address), service).await
}

#[fc_test::test]
async fn one_address_alone_cannot_take_all() {
    let _alone = alone();
    for port in PORTS {
        let limits = Limits {
            connections: 64,
            ..LIMITS
        };
        let robot = Robot::start(ServerConfig::new().limits(limits).command_port(0), service).await;
        let mut kept = Vec::new();
        for _ in 0..8 {
            kept.push(App::connect(&robot, port, 1).speak(port).await);
        }
        for _ in 0..56 {
            assert!(App::connect(&robot, port, 1).id.is_none(), "{port:?}");
        }
        assert!(App::connect(&robot, port, 2).id.is_some(), "{port:?}");
        let counters = robot.handle.counters();
        assert_eq!(
            (counters.connections_refused, counters.connections_displaced),
            (56, 0)
        );
    }
}

/// From an app's view: silent connections from the same address do not lock it out.
#[fc_test::test]
async fn silent_connections_give_way() {
    let _alone = alone();
    let config = ServerConfig::new().address(Ipv4Addr::LOCALHOST);
    let robot = Robot::start(config, service).await;
    let mut silent = Vec::new();
    for _ in 0..64 {
        silent.push(TcpStream::connect(robot.command).await.unwrap());
        silent.push(TcpStream::connect(robot.data).await.unwrap());
    }
    let app = robot.connect().await;
    let request = Echo { text: "x".into() };
    assert!(app.call(&request).await.is_ok());
    let counters = robot.handle.counters();
    assert_eq!(counters.connections_refused, 0);
    assert!(counters.connections_displaced > 0);
}

#[fc_test::test(start_paused = true)]
async fn oldest_silent_connection_is_displaced() {
    let _alone = alone();
    for port in PORTS {
        let robot = robot(4, 4).await;
        let _speaks = App::connect(&robot, port, 1).speak(port).await;
        let mut first = App::connect(&robot, port, 2);
        let mut second = App::connect(&robot, port, 3);
        let _speaks = App::connect(&robot, port, 4).speak(port).await;
        for (host, silent) in [(5, &mut first), (6, &mut second)] {
            let new = App::connect(&robot, port, host);
            assert!(new.id.is_some());
            assert!(silent.is_closed().await, "{port:?} {host}");
            // It has taken the place, and keeps it.
            std::mem::forget(new.speak(port).await);
        }
        assert!(App::connect(&robot, port, 7).id.is_none());
        let counters = robot.handle.counters();
        assert_eq!(
            (counters.connections_refused, counters.connections_displaced),
            (1, 2)
        );
    }
}

#[fc_test::test(start_paused = true)]
async fn largest_silent_address_gives_way_first() {
    let _alone = alone();
    for port in PORTS {
        let robot = robot(5, 4).await;
        let mut alone = App::connect(&robot, port, 1);
        let crowd: Vec<_> = (0..4).map(|_| App::connect(&robot, port, 2)).collect();
        let mut kept = Vec::new();
        for (host, mut silent) in (3..).zip(crowd).take(3) {
            kept.push(App::connect(&robot, port, host).speak(port).await);
            assert!(silent.is_closed().await);
        }
        alone = alone.speak(port).await;
        assert!(alone.id.is_some());
    }
}

#[fc_test::test(start_paused = true)]
async fn an_address_that_is_full_displaces_its_own() {
    let _alone = alone();
    for port in PORTS {
        let robot = robot(8, 2).await;
        let mut other = App::connect(&robot, port, 1);
        let mut first = App::connect(&robot, port, 2);
        let _second = App::connect(&robot, port, 2).speak(port).await;
        let third = App::connect(&robot, port, 2);
        assert!(third.id.is_some() && first.is_closed().await, "{port:?}");
        let _third = third.speak(port).await;
        assert!(App::connect(&robot, port, 2).id.is_none());
        other = other.speak(port).await;
        assert!(other.id.is_some());
    }
}

/// An app that takes streams and sends none is known by its commands.
#[fc_test::test]
async fn data_listener_is_known_by_its_command_connection() {
    let _alone = alone();
    let robot = robot(2, 2).await;
    let _app = App::connect(&robot, Port::Command, 1)
        .speak(Port::Command)
        .await;
    let _data = App::connect(&robot, Port::Data, 1);
    let mut silent = App::connect(&robot, Port::Data, 2);
    assert!(App::connect(&robot, Port::Data, 3).id.is_some());
    assert!(silent.is_closed().await);
}

#[fc_test::test]
async fn warnings_name_the_address() {
    let log = Log::listen(Level::WARN);
    for port in PORTS {
        let robot = robot(1, 1).await;
        let _silent = App::connect(&robot, port, 77);
        let _new = App::connect(&robot, port, 78).speak(port).await;
        assert!(App::connect(&robot, port, 79).id.is_none());
        let lines = log.take();
        let [displaced, refused] = &lines[..] else {
            // The data port warns of the frames that `speak` sends as well.
            let lines: Vec<_> = lines
                .iter()
                .filter(|line| line.contains("limit="))
                .collect();
            assert!(lines[0].contains("192.0.2.77") && lines[0].contains("192.0.2.78"));
            assert!(lines[1].contains("192.0.2.79"), "{lines:?}");
            continue;
        };
        assert!(displaced.contains("192.0.2.77") && displaced.contains("192.0.2.78"));
        assert!(refused.contains("192.0.2.79"), "{refused}");
    }
}
