//! Golden frames: each one is an input, and its error must be that of the vector.

use super::{error, lines};
use crate::support::{model_in, root, small, unhex};
use fc_codegen::emit::generate;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_spec::model::Model;
use fc_workshop::decode::Format;
use serde_json::Value;
use std::path::Path;

#[test]
fn golden_frames_have_the_error_of_their_vector() {
    let specs = [
        root(),
        root().join("fc-generated/tests/meter"),
        root().join("fc-generated/tests/beacon"),
    ];
    for root in specs {
        all_agree(&model_in(&root));
    }
    all_agree(&small());
}

fn all_agree(model: &Model) {
    let files = generate(model, &Targets::of([Product::Vectors])).unwrap();
    let mut count = 0;
    for file in &files {
        let name = Path::new(&file.path).file_stem().unwrap();
        let vectors: Value = serde_json::from_str(&file.contents).unwrap();
        let cases = |list: &str| vectors[list].as_array().cloned().unwrap_or_default();
        for vector in cases("accepted").iter().chain(&cases("rejected")) {
            // Without a code, a message has no frame.
            let Some(frame) = vector["frame"].as_str() else {
                continue;
            };
            agrees(model, name == "frames", frame, vector);
            count += 1;
        }
    }
    assert!(count > 50, "{}: {count}", model.protocol.id);
}

/// `frames.json` is about frames alone. Some have no body that their envelope would allow.
fn agrees(model: &Model, is_frame_only: bool, frame: &str, vector: &Value) {
    let expected = vector["error"].as_str().unwrap_or_default();
    for (format, input) in [
        (Format::Binary, unhex(frame)),
        (Format::Hex, frame.as_bytes().to_vec()),
    ] {
        let lines = lines(model, &input, Some(format));
        let (line, rest) = lines.split_first().expect("a line");
        if is_frame_only && expected.is_empty() {
            assert!(line["code"].is_string(), "{vector}: {line}");
        } else {
            assert_eq!(error(line), expected, "{vector}: {line}");
        }
        assert_eq!(line["offset"], 0);
        // Only bytes after a rejected frame can follow.
        assert!(rest.is_empty() || !expected.is_empty(), "{rest:?}");
    }
}
