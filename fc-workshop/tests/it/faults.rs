//! Faults in frames.

use crate::support::small;
use fc_reflect::sample::Profile;
use fc_reflect::{Direction, FrameFault, Packing, Reflector};
use fc_spec::model::Model;
use fc_workshop::fault::{Delivery, Fault, Faults};
use fc_workshop::stream::{FrameStream, Piece};
use std::time::Duration;

/// The example of an operation, as a piece of a stream.
fn piece<'m>(reflector: &Reflector<'m>, name: &str, direction: Direction, id: u32) -> Piece<'m> {
    let operation = reflector.model().operation(name).unwrap();
    let id = reflector.id(operation, direction, id).unwrap();
    let message = (reflector.samples()).message(operation, direction, Profile::Example);
    let data = message.to_string();
    let bytes = reflector.seal(id, data.as_bytes(), Packing::Plain).unwrap();
    let mut stream = FrameStream::default();
    stream.room().extend_from_slice(&bytes);
    stream.next(reflector).unwrap().unwrap()
}

/// Delivers the frame of a piece with a fault.
fn deliver<'m>(reflector: &Reflector<'m>, fault: &str, piece: &Piece<'m>) -> Delivery {
    let fault = Fault::read(reflector.model(), fault).unwrap();
    Faults::new(reflector, &[fault], 1, 0).deliver(piece)
}

/// Returns which of 12 equal frames a fault strikes.
fn struck(model: &Model, fault: &str, seed: u64, stream: u64) -> Vec<usize> {
    let reflector = Reflector::new(model);
    let piece = piece(&reflector, "set_light", Direction::Request, 7);
    let fault = Fault::read(model, fault).unwrap();
    let mut faults = Faults::new(&reflector, &[fault], seed, stream);
    (1..=12)
        .filter(|_| !faults.deliver(&piece).faults.is_empty())
        .collect()
}

#[test]
fn each_fault_has_its_effect() {
    let model = small();
    let reflector = Reflector::new(&model);
    let request = piece(&reflector, "set_light", Direction::Request, 7);
    let response = piece(&reflector, "set_light", Direction::Response, 7);
    let acknowledgement = piece(&reflector, "dimmed", Direction::Response, 8);
    let faulty = |fault: &str, piece: &Piece<'_>| deliver(&reflector, fault, piece);

    assert_eq!(
        faulty("delay=250", &request).delay,
        Duration::from_millis(250)
    );
    assert_eq!(faulty("slow=40", &request).rate.unwrap().get(), 40);
    assert_eq!(faulty("drop-acknowledgement", &acknowledgement).bytes, b"");
    assert_eq!(
        faulty("drop-acknowledgement", &response).bytes,
        response.bytes
    );
    assert_eq!(
        faulty("duplicate-response", &response).bytes,
        response.bytes.repeat(2)
    );
    assert_eq!(faulty("duplicate-response", &request).bytes, request.bytes);

    let wrong = faulty("wrong-id", &response).bytes;
    assert_eq!(reflector.frame(&wrong).unwrap().id.id, !7);

    let cut = faulty("cut", &request);
    assert!(cut.ends && cut.bytes.len() == request.bytes.len() / 2);

    let damaged = faulty("bad-digest", &request).bytes;
    let fault = reflector.frame(&damaged).unwrap_err().fault;
    assert_eq!(fault, FrameFault::BadDigest);

    let text = |delivery: Delivery| {
        let frame = reflector.frame(&delivery.bytes).unwrap();
        String::from_utf8(frame.data).unwrap()
    };
    assert!(text(faulty("unknown-key", &request)).ends_with(r#""unknownKey":true}"#));
    let changed = text(faulty("unknown-value", &request));
    let is_changed = changed.contains("unknown value") || changed.contains(r#""mode":127"#);
    assert!(is_changed, "{changed}");

    let packed = faulty("compress", &request);
    let frame = reflector.frame(&packed.bytes).unwrap();
    assert_eq!(frame.data, request.frame.unwrap().data);
}

#[test]
fn selectors_choose_frames() {
    let model = small();
    assert_eq!(struck(&model, "delay=1", 1, 0).len(), 12);
    assert_eq!(struck(&model, "delay=1:every=5", 1, 0), [5, 10]);
    assert_eq!(struck(&model, "delay=1:only=3", 1, 0), [3]);
    assert_eq!(struck(&model, "delay=1:set_light:after=10", 1, 0), [11, 12]);
    assert_eq!(struck(&model, "delay=1:0x0102:only=1", 1, 0), [1]);
    assert_eq!(struck(&model, "delay=1:dimmed", 1, 0), [] as [usize; 0]);
    assert_eq!(struck(&model, "delay=1:0%", 1, 0), [] as [usize; 0]);
}

#[test]
fn the_same_seed_strikes_the_same_frames() {
    let model = small();
    let first = struck(&model, "delay=1:50%", 7, 3);
    assert_eq!(struck(&model, "delay=1:50%", 7, 3), first);
    assert_ne!(struck(&model, "delay=1:50%", 8, 3), first);
    assert_ne!(struck(&model, "delay=1:50%", 7, 4), first);
}

#[test]
fn wrong_faults_are_explained() {
    let model = small();
    for (text, part) in [
        ("", "there is no fault ``"),
        ("explode", "the faults are delay=MS, drop-acknowledgement"),
        ("delay", "there is no fault `delay`"),
        ("delay=soon", "there is no fault `delay=soon`"),
        ("slow=0", "there is no fault `slow=0`"),
        ("cut:101%", "`101%` selects no frames"),
        ("cut:every=0", "`every=0` selects no frames"),
        ("cut:nowhere", "no operation `nowhere` with a code"),
    ] {
        let error = Fault::read(&model, text).unwrap_err().to_string();
        assert!(error.contains(part), "{text}: {error}");
    }
}
