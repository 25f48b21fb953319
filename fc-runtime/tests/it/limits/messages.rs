//! Limits of one message: length, inflation, number of values, depth.

use crate::common::net::{Robot, loopback, service};
use crate::common::{Echo, LIMITS, Toy, ToyHeader, ToyRequest, answer_to, command, frame};
use crate::limits::around;
use fc_derive::Message;
use fc_runtime::json::from_str;
use fc_runtime::{
    Command, Decoder, Encoder, Extra, FrameId, Gzip, Header, Limits, Protocol, read_enveloped,
};

#[fc_test::test]
async fn frame_bytes() {
    let limits = Limits {
        frame_bytes: 1000,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    for (length, within) in around(1000) {
        let body = format!(r#"{{"text":"{:1$}"}}"#, "", length - ToyHeader::LEN - 11);
        let bytes = frame(command(Echo::CODE, 1), body.as_bytes());
        assert_eq!(bytes.len(), length);
        // Received and read.
        let mut decoder = Decoder::<Toy>::new().limits(&limits);
        decoder.push(&bytes);
        let name = decoder.next().map_err(|error| error.name());
        assert_eq!(name.is_ok(), within);
        assert!(within || name.err() == Some("frame_too_long"));
        // Written.
        let mut encoder = Encoder::<Toy>::new().frame_bytes(1000);
        let written = encoder.bytes(&mut Vec::new(), command(1, 1), body.as_bytes());
        assert_eq!(written.is_ok(), within);
        // Received by a robot: a length beyond the limit is not believed, and ends the connection.
        let mut app = robot.raw();
        app.send(&bytes).await;
        let heard = app.recv().await.map(|(_, body)| body);
        // The answer is longer than the request and does not fit; it is replaced by a result.
        let is_result = heard.map(|body| body.contains(r#""result":71"#));
        assert_eq!(is_result, within.then_some(true));
    }
    assert_eq!(robot.handle.counters().bad_frames, 1);
}

#[fc_test::test]
fn inflated_bytes() {
    let limits = Limits {
        inflated_bytes: 5000,
        ..LIMITS
    };
    for (length, within) in around(5000) {
        let mut bytes = Vec::new();
        let gzip = Gzip {
            from_bytes: 0,
            level: 9,
        };
        let mut encoder = Encoder::<Toy>::new().gzip(gzip);
        encoder
            .bytes(&mut bytes, command(1, 1), &vec![b' '; length])
            .unwrap();
        let mut decoder = Decoder::<Toy>::new().limits(&limits);
        decoder.push(&bytes);
        match decoder.next() {
            Ok(frame) => assert!(within && frame.unwrap().body().len() == length),
            Err(error) => assert!(!within && error.name() == "inflated_too_long"),
        }
    }
}

#[fc_test::test]
fn inflate_ratio() {
    let free = Limits::INFLATE_FREE as usize;
    let ratio = |inflate_ratio| Limits {
        inflate_ratio,
        ..LIMITS
    };
    let frame = |id, length: usize| {
        let mut bytes = Vec::new();
        let gzip = Gzip {
            from_bytes: 0,
            level: 9,
        };
        let mut encoder = Encoder::<Toy>::new().gzip(gzip);
        encoder.bytes(&mut bytes, id, &vec![b' '; length]).unwrap();
        bytes
    };
    let outcome = |bytes: &[u8], limits: &Limits| {
        let mut decoder = Decoder::<Toy>::new().limits(limits);
        decoder.push(bytes);
        decoder.next().map(|_| ()).map_err(|error| error.name())
    };
    let long = frame(command(1, 1), 2 * free);
    let packed = long.len() - ToyHeader::LEN;
    let least = (2 * free).div_ceil(packed);
    for (limit, within) in around(least) {
        // Here the sent text stays and the limit varies.
        let expected = if limit < least {
            Err("inflates_too_much")
        } else {
            Ok(())
        };
        assert_eq!(
            outcome(&long, &ratio(limit as u32)),
            expected,
            "{limit} {within}"
        );
    }
    // Short data and data that is not text may be blank.
    for (length, within) in around(free) {
        let expected = if within {
            Ok(())
        } else {
            Err("inflates_too_much")
        };
        assert_eq!(
            outcome(&frame(command(1, 1), length), &ratio(256)),
            expected
        );
    }
    let picture = FrameId {
        kind: Toy::STREAM,
        ..command(1, 1)
    };
    assert_eq!(outcome(&frame(picture, 2 * free), &ratio(256)), Ok(()));
}

/// The same text with a place for unknown keys, which count no less where they are kept.
#[derive(Clone, Debug, PartialEq, Message)]
struct Kept {
    text: String,
    #[fc(extra)]
    extra: Extra,
}

#[fc_test::test]
async fn json_values() {
    let limits = Limits {
        json_values: 10,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    let mut app = robot.raw();
    // The key of the text is one of them.
    let bodies: [fn(usize) -> String; 5] = [
        |n| format!(r#"{{"text":"x"{}}}"#, r#","a":[]"#.repeat(n - 1)),
        |n| format!(r#"{{{}"text":"x"}}"#, r#""a":0,"#.repeat(n - 1)),
        |n| format!(r#"{{"text":"x","a":[{}]}}"#, vec!["[]"; n - 2].join(",")),
        |n| {
            format!(
                r#"{{"text":"x","a":{{{}}}}}"#,
                vec![r#""":0"#; n - 2].join(",")
            )
        },
        |n| format!(r#"{{{}"text":"x"}}"#, r#""a\u0078":"y","#.repeat(n - 1)),
    ];
    for (values, within) in around(10) {
        for body in bodies {
            let text = body(values);
            let read = read_enveloped::<ToyRequest, Echo>(text.as_bytes(), limits.json());
            let name = read.map_err(|error| error.name()).map(|_| ());
            let kept = read_enveloped::<ToyRequest, Kept>(text.as_bytes(), limits.json());
            let expected = if within {
                Ok(())
            } else {
                Err("too_many_values")
            };
            assert_eq!(name, expected, "{text}");
            let body = kept.and_then(|read| read.body);
            assert_eq!(body.map_err(|error| error.name()).map(|_| ()), expected);
            let id = command(Echo::CODE, values as u32);
            app.send_frame(id, &text).await;
            let expected = if within { 7 } else { 73 };
            assert_eq!(app.result().await, (answer_to(id), expected), "{text}");
        }
        let lists = format!("[{}]", vec!["0"; values].join(","));
        let lists = from_str::<Vec<u8>>(&lists, limits.json());
        assert_eq!(lists.is_ok(), within);
    }
}

#[fc_test::test]
fn json_list_bytes() {
    // Four items at first, then as many again: 4, 8, 16.
    for (limit, within) in around(16 * size_of::<u64>()) {
        let limits = Limits {
            json_list_bytes: limit,
            ..LIMITS
        };
        let text = format!("[{}]", ["10000000"; 16].join(","));
        let read = from_str::<Vec<u64>>(&text, limits.json());
        let expected = if limit < 16 * size_of::<u64>() {
            Err("lists_too_large")
        } else {
            Ok(16)
        };
        assert_eq!(
            read.map(|read| read.len()).map_err(|error| error.name()),
            expected
        );
        assert!(within || limit > 128);
    }
    // Those in each other are counted together.
    let text = format!("[{}]", ["[10000000]"; 4].join(","));
    let limits = |json_list_bytes| Limits {
        json_list_bytes,
        ..LIMITS
    };
    // The last makes room for two alone: no more can come.
    let needed = 4 * size_of::<Vec<u64>>() + (4 + 4 + 4 + 2) * size_of::<u64>();
    let read = |limit| from_str::<Vec<Vec<u64>>>(&text, limits(limit).json());
    assert!(read(needed).is_ok());
    assert_eq!(read(needed - 1).unwrap_err().name(), "lists_too_large");
}

#[fc_test::test]
async fn json_depth() {
    let limits = Limits {
        json_depth: 10,
        ..LIMITS
    };
    let robot = Robot::start(loopback().limits(limits), service).await;
    let mut app = robot.raw();
    for (depth, within) in around(10) {
        let (open, close) = ("[".repeat(depth - 1), "]".repeat(depth - 1));
        let text = format!(r#"{{"text":"x","deep":{open}{close}}}"#);
        match read_enveloped::<ToyRequest, Echo>(text.as_bytes(), limits.json()) {
            Ok(_) => assert!(within),
            Err(error) => assert!(!within && error.name() == "too_deep"),
        }
        let id = command(Echo::CODE, depth as u32);
        app.send_frame(id, &text).await;
        let expected = if within { 7 } else { 73 };
        assert_eq!(app.result().await, (answer_to(id), expected));
    }
}
