//! The stubs of the odd protocol; `tests/odd_spec.rs` runs this in a crate made from it.

#![allow(deprecated, missing_docs, reason = "tests")]

use fc_generated::*;
use fc_runtime::{
    Audience, ClientConfig, Command, Message, Protocol, Report, Server, ServerConfig, transcode,
};
use std::net::Ipv4Addr;
use std::time::Duration;

macro_rules! messages {
    ($($message:ident;)*) => {
        #[test]
        fn examples_are_written_as_they_are_read() {
            $(
                let written = transcode::<$message>($message::EXAMPLE.as_bytes()).unwrap();
                assert_eq!(String::from_utf8(written).unwrap(), $message::EXAMPLE);
                assert_eq!($message::example().check(), Ok(()));
            )*
        }
    };
}
for_each_message!(messages);

#[test]
fn rows_of_tables_hold_their_constraints() {
    let rows = tables::r#loop();
    assert_eq!(rows.len(), 2);
    for row in rows {
        assert_eq!(row.check(), Ok(()));
    }
}

#[test]
fn sensitive_fields_are_not_shown() {
    let shown = format!("{:?}", ConnectRequest::example());
    assert!(
        shown.contains("ConnectRequest") && !shown.contains("abc"),
        "{shown}"
    );
}

#[test]
fn names_give_way_to_each_other() {
    assert_eq!(Mood::from("sad"), Mood::Unlisted("sad".to_owned()));
    assert_eq!(ResultCode::from(5), ResultCode::Unlisted(5));
    assert_eq!(StreamCode::from(0x0A10), StreamCode::Picture);
    assert_eq!(OddLine::REQUEST_HEAD, [0, 1, 2]);
}

#[tokio::test]
async fn every_command_and_report_makes_its_round() {
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let server = Server::bind(config, RobotService::new(ExampleRobot))
        .await
        .unwrap();
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(server.command_addr().port())
        .call_timeout(Duration::from_secs(30));
    let reporter = Reporter::new(server.handle());
    let handle = server.handle();
    let serving = tokio::spawn(server.run());
    let client = Client::connect(config).await.unwrap();

    macro_rules! call {
        ($($method:ident $request:ident $response:ident;)*) => {
            $(
                let response = client.$method(&$request::example()).await.unwrap();
                assert_eq!(response, $response::example(), "{}", $request::NAME);
            )*
        };
    }
    for_each_command!(call);

    let mut reports = client.reports();
    macro_rules! push {
        ($($method:ident $report:ident $acknowledgement:ident;)*) => {
            $(
                let report = $report::example();
                reporter.$method(Audience::All, &report).await.unwrap();
                let received = reports.recv().await.unwrap().unwrap();
                assert_eq!(received, AnyReport::$report(report), "{}", $report::NAME);
            )*
        };
    }
    for_each_report!(push);

    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}
