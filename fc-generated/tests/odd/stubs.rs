//! Tests the stubs of the odd protocol. `tests/it/odd_spec.rs` runs this in a crate that is generated from its spec.

#![allow(deprecated, missing_docs, reason = "tests")]

// The spec uses many common names, so everything else is written with its full path.
use fc_generated::*;

macro_rules! messages {
    ($($message:ident;)*) => {
        #[test]
        fn examples_survive_reading_and_writing() {
            $(
                let example = <$message as fc_runtime::Message>::EXAMPLE;
                let written = fc_runtime::transcode::<$message>(example.as_bytes()).unwrap();
                assert_eq!(String::from_utf8(written).unwrap(), example);
                let example = <$message as fc_runtime::Message>::example();
                assert_eq!(fc_runtime::Message::check(&example), Ok(()));
            )*
        }
    };
}
for_each_message!(messages);

#[test]
fn rows_of_tables_hold_their_constraints() {
    let rows = tables::r#loop();
    assert_eq!(rows.len(), 2);
    let as_numbers: Vec<bool> = rows.iter().map(|row| row.nb).collect();
    assert_eq!(as_numbers, [true, false]);
    for row in rows {
        assert_eq!(fc_runtime::Message::check(&row), Ok(()));
    }
}

#[test]
fn sensitive_fields_are_not_shown() {
    let shown = <ConnectRequest as fc_runtime::Message>::example();
    let shown = format!("{shown:?}");
    assert!(
        shown.contains("ConnectRequest") && !shown.contains("abc"),
        "{shown}"
    );
}

#[test]
fn names_give_way_to_each_other() {
    assert_eq!(Mood::from("sad"), Mood::Unlisted("sad".to_owned()));
    assert_eq!(ResultCode::from(55), ResultCode::Unlisted(55));
    assert_eq!(StreamCode::from(0x0A10), StreamCode::Picture);
    assert_eq!(StreamCode::from(0x0AF0), StreamCode::RawReport);
    assert_eq!(ResultCode::from(5), ResultCode::Self_);
    assert_eq!(OpenEnum::from(7), OpenEnum::Other(7));
    assert_eq!(Command::try_from("b"), Ok(Command::Self_));
    assert!(Command::try_from("z").is_err());
    assert_eq!(<OddLine as fc_runtime::Protocol>::REQUEST_HEAD, [0, 1, 2]);
}

/// Groups are modules of `messages` only, so `std` at the top is still the standard library.
#[test]
fn groups_may_be_called_like_crates() {
    let error = messages::std::Error::new();
    let example = <messages::core::OutCoreRequest as fc_runtime::Message>::example();
    assert_eq!(example.error, error);
}

#[tokio::test]
async fn every_command_and_report_makes_its_round() {
    let config = fc_runtime::ServerConfig::new()
        .address(std::net::Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let robot = ExampleRobot {
        pretend_motion: true,
    };
    let server = fc_runtime::Server::bind(config, RobotService::new(robot))
        .await
        .unwrap();
    let config = fc_runtime::ClientConfig::new()
        .host("127.0.0.1")
        .command_port(server.command_addr().port())
        .call_timeout(std::time::Duration::from_secs(30));
    let reporter = Reporter::new(server.handle());
    let handle = server.handle();
    let serving = tokio::spawn(server.run());
    let client = Client::connect(config).await.unwrap();

    macro_rules! call {
        ($($method:ident $request:ident $response:ident;)*) => {
            $(
                let request = <$request as fc_runtime::Message>::example();
                let response = client.$method(&request).await.unwrap();
                let example = <$response as fc_runtime::Message>::example();
                assert_eq!(response, example, "{}", <$request as fc_runtime::Command>::NAME);
            )*
        };
    }
    for_each_command!(call);

    let mut reports = client.reports();
    macro_rules! push {
        ($($method:ident $report:ident $acknowledgement:ident;)*) => {
            $(
                let report = <$report as fc_runtime::Message>::example();
                reporter.$method(fc_runtime::Audience::All, &report).await.unwrap();
                let received = reports.recv().await.unwrap().unwrap();
                let name = <$report as fc_runtime::Report>::NAME;
                assert_eq!(received, AnyReport::$report(report), "{name}");
            )*
        };
    }
    for_each_report!(push);

    handle.shutdown(std::time::Duration::ZERO).await;
    serving.await.unwrap();
}
