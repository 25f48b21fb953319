//! Tests a client and a server of any protocol. `tests/it/other_protocols.rs` runs this in crates that are generated
//! from their specs.

use fc_generated::*;
use fc_runtime::{
    Audience, ClientConfig, Command as _, Connection, Decoder, Empty, Encoder, FrameId,
    Message as _, Protocol, Report as _, Server, ServerConfig, read_enveloped,
};
use serde_json::Value;
use std::fs;
use std::net::Ipv4Addr;
use std::path::Path;
use std::time::Duration;

#[tokio::test]
async fn every_command_and_report_makes_its_round() {
    let config = ServerConfig::new()
        .address(Ipv4Addr::LOCALHOST)
        .command_port(0)
        .data_port(0);
    let robot = ExampleRobot {
        pretend_motion: true,
    };
    let server = Server::bind(config, RobotService::new(robot))
        .await
        .unwrap();
    let handle = server.handle();
    let reporter = Reporter::new(server.handle());
    let config = ClientConfig::new()
        .host("127.0.0.1")
        .command_port(server.command_addr().port())
        .data_port(server.data_addr().port())
        .first_id(u32::MAX - 1)
        .call_timeout(Duration::from_secs(30));
    let serving = tokio::spawn(server.run());
    let client = Client::connect(config).await.unwrap();

    // Several rounds, so that ids begin again.
    for _ in 0..3 {
        macro_rules! call {
            ($($method:ident $request:ident $response:ident;)*) => {
                $(
                    let response = client.$method(&$request::example()).await.unwrap();
                    assert_eq!(response, $response::example(), "{}", $request::NAME);
                )*
            };
        }
        for_each_command!(call);
    }

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

    let data = client.connection().data();
    data.connected().await.unwrap();
    while handle.counters().data_connections == 0 {
        tokio::task::yield_now().await;
    }
    let sent = handle.send_stream(Audience::All, 7, 0x1234, b"raw\0bytes");
    assert_eq!(sent.await, Ok(1));
    let frame = data.recv().await.unwrap();
    assert_eq!(
        (frame.code, frame.id, &frame.data[..]),
        (7, 0x1234, &b"raw\0bytes"[..])
    );

    let count = hold_vectors(client.connection());
    assert!(count > 40, "{count}");
    drop(client);
    handle.shutdown(Duration::ZERO).await;
    serving.await.unwrap();
}

/// Decodes the frames of the vectors and returns their number. Each is accepted, or refused with the expected error.
/// Plain frames are encoded again to the same bytes.
fn hold_vectors<P: Protocol>(_: &Connection<P>) -> usize {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("vectors");
    let mut count = 0;
    for file in fs::read_dir(folder).unwrap() {
        let file: Value = serde_json::from_slice(&fs::read(file.unwrap().path()).unwrap()).unwrap();
        for vector in file["accepted"].as_array().unwrap() {
            let Some(hex) = vector["frame"].as_str() else {
                continue;
            };
            let bytes = unhex(hex);
            let mut decoder = Decoder::<P>::new();
            decoder.push(&bytes);
            let frame = decoder.next().unwrap().expect("a whole frame");
            if vector["case"] == "plain" {
                let mut again = Vec::new();
                let encoded = Encoder::<P>::new().bytes(&mut again, frame.id(), frame.body());
                encoded.unwrap();
                assert_eq!(again, bytes, "{vector}");
            }
            count += 1;
        }
        for vector in file["rejected"].as_array().unwrap() {
            let Some(hex) = vector["frame"].as_str() else {
                continue;
            };
            let mut decoder = Decoder::<P>::new();
            decoder.push(&unhex(hex));
            let found = match decoder.next() {
                Err(error) => error.name(),
                Ok(Some(frame)) => body_error::<P>(&file, frame.id(), frame.body()),
                Ok(None) => decoder.finish().unwrap_err().name(),
            };
            assert_eq!(found, vector["error"], "{vector}");
            count += 1;
        }
    }
    count
}

/// Returns the name of the error that the types of the operation find in a body, or `none`.
fn body_error<P: Protocol>(file: &Value, id: FrameId, body: &[u8]) -> &'static str {
    let operation = P::operations()
        .iter()
        .find(|operation| operation.name == file["operation"]);
    let operation = operation.expect("frames without an operation are refused as frames");
    let allowance = P::DEFAULTS.limits.json();
    let (own, envelope) = if id.response {
        let read = read_enveloped::<P::Response, Empty>(body, allowance);
        (operation.response, read.err())
    } else {
        let read = read_enveloped::<P::Request, Empty>(body, allowance);
        (operation.request, read.err())
    };
    let error = envelope.or_else(|| (own.check)(body, allowance).err());
    error.map_or("none", |error| error.name())
}

fn unhex(hex: &str) -> Vec<u8> {
    let digits = hex.as_bytes().chunks(2);
    let byte = |pair| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    digits.map(byte).collect()
}
