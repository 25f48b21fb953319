//! Connections in captures.

use super::{error, lines, sampled};
use crate::support::{small, unhex};
use etherparse::PacketBuilder;
use fc_spec::model::Model;
use fc_workshop::decode::Format;
use serde_json::Value;
use std::fmt::Write as _;
use std::io::{self, Read};

const PORT: u16 = 7001;
const FIRST: u32 = 0xFFFF_FFF0;

/// A step of a connection. Positions count the bytes of one direction from 0.
#[derive(Clone, Copy)]
enum Step {
    Syn,
    /// Bytes of the app from one position to another.
    Send(usize, usize),
    /// The robot acknowledges the bytes before this position.
    Ack(usize),
    Fin(usize),
}

use Step::{Ack, Fin, Send, Syn};

/// Returns a packet of the app or the robot.
fn packet(port: u16, step: Step, sent: &[u8]) -> Vec<u8> {
    let at = |position: usize| FIRST.wrapping_add(1 + u32::try_from(position).unwrap());
    let (app, robot) = ([10, 0, 0, 2], [10, 0, 0, 1]);
    let ether = PacketBuilder::ethernet2([1; 6], [2; 6]);
    let (packet, payload) = match step {
        Ack(end) => {
            let packet = ether.ipv4(robot, app, 64).tcp(port, 50_000, 9, 9);
            return written(packet.ack(at(end)), &[]);
        }
        Syn => (
            ether.ipv4(app, robot, 64).tcp(50_000, port, FIRST, 9).syn(),
            &[][..],
        ),
        Send(from, to) => (
            ether.ipv4(app, robot, 64).tcp(50_000, port, at(from), 9),
            &sent[from..to],
        ),
        Fin(end) => (
            ether
                .ipv4(app, robot, 64)
                .tcp(50_000, port, at(end), 9)
                .fin(),
            &[][..],
        ),
    };
    written(packet, payload)
}

fn written(
    packet: etherparse::PacketBuilderStep<etherparse::TcpHeader>,
    payload: &[u8],
) -> Vec<u8> {
    let mut bytes = Vec::new();
    packet.write(&mut bytes, payload).unwrap();
    bytes
}

/// Returns a pcap file with a packet per millisecond.
fn pcap(packets: &[Vec<u8>]) -> Vec<u8> {
    let mut file = unhex("d4c3b2a1020004000000000000000000ffff000001000000");
    for (number, packet) in packets.iter().enumerate() {
        let micros = u32::try_from(number * 1000).unwrap();
        let length = u32::try_from(packet.len()).unwrap();
        for word in [1_700_000_000, micros, length, length] {
            file.extend(word.to_le_bytes());
        }
        file.extend(packet);
    }
    file
}

/// Returns the lines of a capture with these steps, after the bytes that the app sends.
fn captured(model: &Model, sent: &[u8], steps: &[Step]) -> Vec<Value> {
    let packets: Vec<_> = steps.iter().map(|step| packet(PORT, *step, sent)).collect();
    lines(model, &pcap(&packets), None)
}

#[test]
fn segments_in_any_order_give_the_same_frames() {
    let model = small();
    let frame = sampled(&model, "unknown_body", 7);
    let sent = [frame.clone(), sampled(&model, "unknown_body", 8)].concat();
    let (first, all) = (frame.len(), sent.len());
    for (name, steps) in [
        (
            "in order",
            vec![Syn, Send(0, first), Send(first, all), Fin(all)],
        ),
        (
            "without the beginning",
            vec![Send(0, first), Send(first, all)],
        ),
        ("cut inside a frame", vec![Syn, Send(0, 10), Send(10, all)]),
        (
            "out of order",
            vec![Syn, Send(10, all), Send(0, 10), Fin(all)],
        ),
        (
            "sent again",
            vec![Syn, Send(0, 10), Send(0, 10), Send(10, all), Send(10, all)],
        ),
        (
            "overlapping",
            vec![Syn, Send(0, 20), Send(5, 30), Send(25, all)],
        ),
        (
            "out of order and again",
            vec![Syn, Send(30, all), Send(10, 40), Send(0, 12), Syn],
        ),
        (
            "after the end",
            vec![Syn, Send(0, all), Fin(all), Fin(all), Send(3, all)],
        ),
    ] {
        let found = captured(&model, &sent, &steps);
        let offsets: Vec<_> = found
            .iter()
            .map(|line| line["offset"].as_u64().unwrap())
            .collect();
        assert_eq!(offsets, [0, first as u64], "{name}: {found:?}");
        let ids: Vec<_> = found
            .iter()
            .map(|line| line["msg_id"].as_u64().unwrap())
            .collect();
        assert_eq!(ids, [7, 8], "{name}");
        assert!(
            found.iter().all(|line| error(line).is_empty()),
            "{name}: {found:?}"
        );
    }
}

/// The capture lacks bytes of the first frame. The second one keeps its position.
#[test]
fn missing_bytes_end_at_the_next_frame() {
    let model = small();
    let frame = sampled(&model, "unknown_body", 7);
    let sent = [frame.clone(), sampled(&model, "unknown_body", 8)].concat();
    let (first, all) = (frame.len(), sent.len());
    for steps in [
        vec![Syn, Send(0, 10), Send(20, all), Ack(all)],
        vec![Syn, Send(0, 10), Send(20, all)],
    ] {
        let found = captured(&model, &sent, &steps);
        let shown: Vec<_> = found
            .iter()
            .map(|line| (line["offset"].as_u64().unwrap(), error(line)))
            .collect();
        let expected = [(0, "truncated"), (20, "bad_head"), (first as u64, "")];
        assert_eq!(shown, expected, "{found:?}");
    }
}

#[test]
fn acknowledged_bytes_are_not_waited_for() {
    let model = small();
    let sent = sampled(&model, "unknown_body", 7).repeat(2);
    let half = sent.len() / 2;
    // After the acknowledgement, the second frame is shown before the third one.
    let steps = [Syn, Send(5, half), Send(half, sent.len()), Ack(sent.len())];
    let found = captured(&model, &sent, &steps);
    let times: Vec<_> = found
        .iter()
        .map(|line| line["time"].as_f64().unwrap())
        .collect();
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(times[1] > 1_700_000_000.001, "{times:?}");
}

#[test]
fn responses_name_their_request_and_the_time_between() {
    let model = small();
    let reflector = fc_reflect::Reflector::new(&model);
    let request = sampled(&model, "unknown_body", 7);
    let frame = reflector.frame(&request).unwrap();
    let response = reflector
        .answer(&frame, None, fc_reflect::Packing::Plain)
        .unwrap()
        .unwrap();
    let ether = || PacketBuilder::ethernet2([1; 6], [2; 6]);
    let (app, robot) = ([10, 0, 0, 2], [10, 0, 0, 1]);
    let asked = written(
        ether().ipv4(app, robot, 64).tcp(50_000, PORT, 1, 9),
        &request,
    );
    let answered = written(
        ether().ipv4(robot, app, 64).tcp(PORT, 50_000, 1, 9),
        &response,
    );
    let found = lines(&model, &pcap(&[asked, answered]), Some(Format::Capture));
    assert_eq!(found[1]["direction"], "response");
    assert_eq!(found[1]["request"]["offset"], 0);
    let elapsed = found[1]["request"]["elapsed_ms"].as_f64().unwrap();
    assert!((elapsed - 1.0).abs() < 0.001, "{elapsed}");
    assert_eq!(found[0]["connection"], "10.0.0.2:50000 > 10.0.0.1:7001");
}

/// An input that cannot be read.
struct Broken;

impl Read for Broken {
    fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
        Err(io::ErrorKind::BrokenPipe.into())
    }
}

#[test]
fn packets_before_a_read_error_are_decoded() {
    let model = small();
    let sent = sampled(&model, "unknown_body", 7);
    let packet = packet(PORT, Send(0, sent.len()), &sent);
    let mut text = "12:00:01.5 IP 10.0.0.2.50000 > 10.0.0.1.7001: Flags [P.]\n".to_owned();
    for (number, bytes) in packet.chunks(16).enumerate() {
        let _ = write!(text, "\t0x{:04x}: ", number * 16);
        for byte in bytes {
            let _ = write!(text, " {byte:02x}");
        }
        text.push('\n');
    }
    let input = text.as_bytes().chain(Broken);
    let (found, result) = super::read(&model, input, None, &[]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(error(&found[0]), "");
    assert!(result.is_err());
}

#[test]
fn other_ports_are_named_in_the_error() {
    let model = small();
    let sent = sampled(&model, "unknown_body", 7);
    let file = pcap(&[packet(9999, Send(0, sent.len()), &sent)]);
    let error = super::read(&model, &*file, None, &[]).1.unwrap_err();
    assert!(error.to_string().contains("7001"), "{error}");
    let (found, result) = super::read(&model, &*file, None, &[9999]);
    assert_eq!((found.len(), result.is_ok()), (1, true));
}
