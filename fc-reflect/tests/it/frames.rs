//! Frames of the small protocol of these tests, which is little-endian and has a different header.

#[allow(dead_code, reason = "other tests need more")]
use crate::support::specs;
use fc_reflect::{
    Decoded, Direction, Error, FrameFault, HeaderContent, Limits, Packing, Reflector, Value,
};
use fc_spec::model::{HeaderRole, Model};

const ID: u32 = 0x0102_0304;

fn encode(reflector: &Reflector<'_>, model: &Model, name: &str, text: &str) -> Vec<u8> {
    let operation = model.operation(name).expect(name);
    let id = reflector
        .id(operation, Direction::Request, ID)
        .expect("a code");
    let frame = reflector.encode(id, text.as_bytes(), Packing::Plain);
    frame.unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_header_is_laid_out_as_the_model_says() {
    let model = specs::small();
    let reflector = Reflector::new(&model);
    let frame = encode(&reflector, &model, "unknown_body", "{}");
    let mut wanted = b"LA?".to_vec();
    wanted.extend([47, 0, 0, 0]);
    wanted.extend([1, 2, 0, 0, 0, 0, 0, 0]);
    // MD5 of `{}`.
    wanted.extend([
        0x99, 0x91, 0x4b, 0x93, 0x2b, 0xd3, 0x7a, 0x50, 0xb9, 0x83, 0xc5, 0xe7, 0xc9, 0x0a, 0xe9,
        0x3b,
    ]);
    wanted.extend([0, 0, 8]);
    wanted.extend([2, 0, 0, 0]);
    wanted.extend([0x20, 0x03, 0x01]);
    wanted.extend([4, 3, 2, 1]);
    wanted.extend(b"{}");
    assert_eq!(frame, wanted);

    // Bytes after the frame belong to the next one.
    let mut longer = frame.clone();
    longer.extend(b"LA");
    let Decoded {
        frame: taken,
        message,
    } = reflector.decode(&longer).expect("a frame");
    assert_eq!(taken.length, frame.len());
    assert_eq!(taken.packed, 45..47);
    assert_eq!(taken.data, b"{}");
    assert_eq!(taken.operation.expect("known").name, "unknown_body");
    assert_eq!(taken.kind.name, "command");
    assert_eq!(taken.encoding.expect("known").name, "plain");
    assert!(message.expect("a command").envelope.is_empty());
    let names: Vec<_> = taken
        .header
        .iter()
        .map(|value| value.field.wire.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "head", "total", "spare", "sum", "pad", "packing", "plain", "what", "op", "seq"
        ]
    );
    let code = taken.field(HeaderRole::Code).expect("a field");
    assert_eq!(code.span, 39..41);
    assert_eq!(code.field.name, "code");
    assert_eq!(code.field.text.en, "Code");
    assert_eq!(code.content, HeaderContent::Int(0x0103));
    assert_eq!(taken.header[4].content, HeaderContent::Bytes(vec![0, 0]));
}

#[test]
fn a_plain_length_of_zero_is_a_quirk_that_is_marked() {
    let model = specs::small();
    let reflector = Reflector::new(&model);
    let mut frame = encode(&reflector, &model, "unknown_body", "{}");
    let lenient = |frame: &[u8]| {
        let taken = reflector.frame(frame).expect("a frame");
        taken
            .field(HeaderRole::PlainLength)
            .expect("a field")
            .lenient
    };
    assert!(!lenient(&frame));
    frame[34] = 0;
    assert!(lenient(&frame));
    frame[34] = 1;
    let error = reflector.frame(&frame).expect_err("another length");
    assert_eq!(error.fault, FrameFault::PlainLengthMismatch);
}

#[test]
fn streams_carry_bytes_and_codes_belong_to_their_kind() {
    let model = specs::small();
    let reflector = Reflector::new(&model);
    let film = model.operation("film").expect("known");
    let id = reflector.id(film, Direction::Request, ID).expect("a code");
    let frame = reflector
        .encode(id, b"\xFF\x00{", Packing::Plain)
        .expect("bytes");
    let decoded = reflector.decode(&frame).expect("bytes");
    assert!(decoded.message.is_none() && decoded.frame.is_stream());
    assert_eq!(decoded.frame.data, b"\xFF\x00{");
    assert_eq!(decoded.frame.operation.expect("known").name, "film");

    // No command has this code.
    let other = fc_reflect::FrameId { kind: 0x20, ..id };
    let frame = reflector
        .encode(other, br#"{"at":1,"b":[ 2]}"#, Packing::Plain)
        .expect("JSON");
    let decoded = reflector.decode(&frame).expect("JSON");
    assert!(decoded.frame.operation.is_none());
    let message = decoded.message.expect("a command");
    let body = message.body.as_ref().expect("unknown keys");
    assert!(matches!(&body[0].value, Value::Json(text) if text == "[ 2]"));
    assert_eq!(message.canonical().expect("right"), r#"{"at":1,"b":[ 2]}"#);
    assert_eq!(other.answer().direction, Direction::Response);
}

#[test]
fn every_limit_is_held() {
    let model = specs::small();
    let spec = Limits::of(&model);
    let zeros = vec![b'0'; 7000];
    let film = model.operation("film").expect("known");
    let reflector = Reflector::new(&model);
    let id = reflector.id(film, Direction::Request, ID).expect("a code");
    let refused = |limits: Limits, bytes: &[u8]| {
        let error = Reflector::new(&model).limits(limits).decode(bytes);
        error.expect_err("past a limit").name()
    };

    let packed = reflector
        .encode(id, &zeros, Packing::Gzip { level: 9 })
        .expect("short");
    assert!(packed.len() < 200);
    assert_eq!(
        reflector.decode(&packed).expect("a frame").frame.data,
        zeros
    );
    let too_long = reflector
        .encode(id, &zeros, Packing::Plain)
        .expect_err("long");
    assert!(matches!(&too_long, Error::Frame(error) if error.fault == FrameFault::FrameTooLong));
    let frame_bytes = u32::try_from(packed.len() - 1).unwrap();
    assert_eq!(
        refused(
            Limits {
                frame_bytes,
                ..spec
            },
            &packed
        ),
        "frame_too_long"
    );
    assert_eq!(
        refused(
            Limits {
                inflated_bytes: 6999,
                ..spec
            },
            &packed
        ),
        "inflated_too_long"
    );

    let text = br#"{"lvl":1,"grid":[[1],[2]]}"#;
    let light = encode(
        &reflector,
        &model,
        "set_light",
        std::str::from_utf8(text).unwrap(),
    );
    assert!(reflector.decode(&light).is_ok());
    assert_eq!(
        refused(
            Limits {
                json_values: 5,
                ..spec
            },
            &light
        ),
        "too_many_values"
    );
    assert_eq!(
        refused(
            Limits {
                json_depth: 2,
                ..spec
            },
            &light
        ),
        "too_deep"
    );

    // Any data may inflate to 1 MiB. Larger data must respect the ratio limit, which blank text exceeds.
    let wide = Limits {
        frame_bytes: 1 << 22,
        inflated_bytes: 1 << 22,
        ..spec
    };
    let blank = format!("{{\"x\":\"{}\"}}", " ".repeat(1 << 20));
    let reflector = Reflector::new(&model).limits(wide);
    let command = fc_reflect::FrameId { kind: 0x20, ..id };
    let bomb = reflector.seal(command, blank.as_bytes(), Packing::Gzip { level: 9 });
    let bomb = bomb.expect("short");
    assert_eq!(refused(wide, &bomb), "inflates_too_much");
    // The ratio limit does not apply to streams: a picture may be blank.
    let picture = reflector.seal(id, blank.as_bytes(), Packing::Gzip { level: 9 });
    assert!(reflector.decode(&picture.expect("short")).is_ok());
    let generous = Limits {
        inflate_ratio: 2000,
        ..wide
    };
    assert!(
        Reflector::new(&model)
            .limits(generous)
            .decode(&bomb)
            .is_ok()
    );
}

#[test]
fn header_and_length_of_an_invalid_frame_can_be_read() {
    let model = specs::small();
    let reflector = Reflector::new(&model);
    let mut frame = encode(&reflector, &model, "unknown_body", "{}");
    // Sets an unknown kind.
    frame[38] = 0x77;
    let error = reflector.frame(&frame).expect_err("invalid");
    assert_eq!(error.fault, FrameFault::UnknownKind);
    assert_eq!(reflector.length(&frame), Ok(Some(frame.len())));
    let header = reflector.header(&frame);
    assert_eq!(header.len(), 10);
    assert_eq!(header[7].content, HeaderContent::Int(0x77));
    assert_eq!(header[7].span, 38..39);
    // The header ends before the first incomplete field.
    assert_eq!(reflector.header(&frame[..38]).len(), 7);
}
