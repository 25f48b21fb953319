//! Tests the app's stub without `async` with every command and every report.

#![allow(
    clippy::panic,
    clippy::unwrap_used,
    clippy::wildcard_imports,
    deprecated,
    missing_docs,
    reason = "tests; what is withdrawn has to work all the same"
)]

use fc_generated::blocking;
use fc_generated::prelude::*;
use fc_generated::{ExampleRobot, for_each_command, for_each_report};
use std::net::Ipv4Addr;
use std::time::Duration;

/// A timeout that only a hanging test reaches.
const LONG: Duration = Duration::from_secs(60);

macro_rules! call_all {
    ($($method:ident $request:ident $response:ident;)*) => {
        fn call_all(client: &blocking::Client) {
            $(
                let answer = client.$method(&fc_generated::$request::example()).unwrap();
                assert_eq!(answer, fc_generated::$response::example());
            )*
        }
    };
}
for_each_command!(call_all);

macro_rules! push_all {
    ($($method:ident $report:ident $acknowledgement:ident;)*) => {
        fn push_all(runtime: &tokio::runtime::Runtime, robot: &Reporter, app: &mut blocking::Reports) {
            $(
                let report = fc_generated::$report::example();
                let pushed = runtime.block_on(robot.$method(Audience::All, &report)).unwrap();
                assert!(pushed.iter().all(|ack| ack.outcome == AckOutcome::Acknowledged));
                assert_eq!(app.recv_timeout(LONG), Ok(AnyReport::$report(report)));
            )*
        }
    };
}
for_each_report!(push_all);

#[test]
fn every_command_and_report_without_async() {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build()
        .unwrap();
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let robot = ExampleRobot {
        pretend_motion: true,
    };
    let server = runtime
        .block_on(Server::bind(config, RobotService::new(robot)))
        .unwrap();
    let port = server.command_addr().port();
    let reporter = Reporter::new(server.handle());
    runtime.spawn(server.run());

    let config = ClientConfig::new().host("127.0.0.1").command_port(port);
    let client = blocking::Client::connect(config).unwrap();
    let mut reports = client.reports();
    call_all(&client);
    push_all(&runtime, &reporter, &mut reports);
}
