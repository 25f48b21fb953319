//! The output of calls and apps.

use crate::support::small;
use fc_reflect::{Direction, FrameId, Packing, Reflector};
use fc_spec::model::Lang;
use fc_workshop::transcript::Transcript;
use std::time::Duration;

#[test]
fn unknown_frames_are_lines_in_both_formats() {
    let model = small();
    let reflector = Reflector::new(&model);
    let id = FrameId {
        direction: Direction::Request,
        kind: model.frame.kinds.report.value,
        code: 0x7FFE,
        id: 1,
    };
    let bytes = reflector.seal(id, b"{}", Packing::Plain).unwrap();
    let frame = reflector.frame(&bytes).unwrap();
    for (transcript, line) in [
        (Transcript::Json, "{\"name\":\"0x7FFE\",\"bytes\":2}\n"),
        (Transcript::Text(Lang::Zh), "0x7FFE  2 字节\n"),
        (Transcript::Text(Lang::En), "0x7FFE  2 bytes\n"),
    ] {
        assert_eq!(transcript.arrival(&frame), line);
    }
}

#[test]
fn times_are_shown_for_several_calls() {
    let times = |count: u64| (1..=count).rev().map(Duration::from_millis).collect();
    let text = Transcript::Text(Lang::En);
    assert_eq!(
        text.times(times(4)),
        "4 responses: shortest 1 ms, median 2 ms, longest 4 ms\n"
    );
    assert_eq!(text.times(times(1)), "");
    assert_eq!(Transcript::Json.times(times(4)), "");
}
