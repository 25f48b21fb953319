//! Reads and writes the golden frames and bodies with the model alone.

use crate::support::{self, cases, hex, unhex};
use fc_codegen::emit::generate;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_reflect::{Decoded, Direction, Error, HeaderContent, Message, Packing, Reflector};
use fc_spec::model::{HeaderRole, Model};
use serde_json::Value;
use std::fmt::Write as _;
use std::path::Path;

#[test]
fn every_frame_is_read_and_written_as_its_vector_says() {
    let model = support::specs::model();
    let count = all_hold(&model, support::vectors());
    // An empty folder would prove nothing.
    assert!(count > 1000, "{count}");
}

/// The repository has no vectors of these protocols, so the test generates them.
#[test]
fn vectors_of_other_protocols_hold_as_well() {
    for model in support::specs::others() {
        let vectors = generate(&model, &Targets::of([Product::Vectors])).unwrap();
        let files = vectors.into_iter().map(|artifact| {
            let name = Path::new(&artifact.path).file_stem().unwrap();
            let file = serde_json::from_str(&artifact.contents).unwrap();
            (name.to_string_lossy().into_owned(), file)
        });
        let count = all_hold(&model, files.collect());
        assert!(count > 50, "{}: {count}", model.protocol.id);
    }
}

/// Checks all files except the one about JSON itself, and counts their vectors.
fn all_hold(model: &Model, files: Vec<(String, Value)>) -> usize {
    let reflector = Reflector::new(model);
    let mut count = 0;
    for (name, file) in files {
        if name == "bodies" {
            continue;
        }
        assert_eq!(file["format"], 1);
        for vector in cases(&file, "accepted") {
            accepted(model, &reflector, &name, vector);
            count += 1;
        }
        for vector in cases(&file, "rejected") {
            let found = read(model, &reflector, &name, vector);
            let error = found.expect_err(&vector.to_string());
            assert_eq!(error.name(), vector["error"], "{name}: {vector}");
            count += 1;
        }
    }
    count
}

/// Reads a vector, which is a frame or the text of a message without a code.
fn read<'m>(
    model: &'m Model,
    reflector: &Reflector<'m>,
    name: &str,
    vector: &Value,
) -> Result<(Option<Decoded<'m>>, Option<Message<'m>>), Error> {
    if let Some(frame) = vector["frame"].as_str() {
        let bytes = unhex(frame);
        let decoded = if name == "frames" {
            // These vectors are about frames only. Some have a body that the envelope does not allow.
            Decoded {
                frame: reflector.frame(&bytes)?,
                message: None,
            }
        } else {
            reflector.decode(&bytes)?
        };
        let message = decoded.message.clone();
        return Ok((Some(decoded), message));
    }
    let operation = model.operation(name).expect("the file of an operation");
    let text = vector["text"].as_str().expect("a frame or a text");
    let direction = direction(vector);
    let frame = fc_reflect::FrameId {
        direction,
        kind: 0,
        code: 0,
        id: 0,
    };
    let fault = |error| Error::Body { frame, error };
    let message = reflector.message(Some(operation), direction, text.as_bytes());
    let message = message.map_err(fault)?;
    match message.body {
        Ok(_) => Ok((None, Some(message))),
        Err(error) => Err(fault(error)),
    }
}

fn direction(vector: &Value) -> Direction {
    let both = [Direction::Request, Direction::Response];
    let is_named = |direction: &Direction| vector["direction"] == direction.name();
    both.into_iter().find(is_named).expect("a direction")
}

fn accepted(model: &Model, reflector: &Reflector<'_>, name: &str, vector: &Value) {
    let place = format!("{name}: {}", vector["name"]);
    let found = read(model, reflector, name, vector);
    let (decoded, message) = found.unwrap_or_else(|error| panic!("{place}: {error}"));
    if let Some(decoded) = &decoded {
        let frame = &decoded.frame;
        assert_eq!(frame.id.direction, direction(vector), "{place}");
        if vector["header"].is_object() {
            let bytes = unhex(vector["frame"].as_str().unwrap());
            compare_header(decoded, &bytes, &vector["header"], &place);
        }
        if let Some(data) = vector["data"].as_str() {
            assert_eq!(hex(&frame.data), data, "{place}");
        }
        if let Some(operation) = model.operation(name) {
            let found = frame.operation.map(|operation| operation.name.as_str());
            assert_eq!(found, Some(operation.name.as_str()), "{place}");
        }
        if vector["case"] == "plain" {
            let again = reflector.encode(frame.id, &frame.data, Packing::Plain);
            let again = again.unwrap_or_else(|error| panic!("{place}: {error}"));
            assert_eq!(vector["frame"], hex(&again), "{place}: the same frame");
        }
    }
    let (Some(message), false) = (message, vector["body"].is_null()) else {
        return;
    };
    let expected = match &vector["canonical"] {
        Value::Null => &vector["body"],
        canonical => canonical,
    };
    let again: Value = serde_json::from_str(&message.canonical().unwrap()).unwrap();
    assert_eq!(again, *expected, "{place}");
}

fn compare_header(decoded: &Decoded<'_>, bytes: &[u8], expected: &Value, place: &str) {
    for (name, role) in [
        ("kind", HeaderRole::Kind),
        ("code", HeaderRole::Code),
        ("id", HeaderRole::Id),
        ("encoding", HeaderRole::Encoding),
        ("total_length", HeaderRole::TotalLength),
        ("plain_length", HeaderRole::PlainLength),
        ("digest", HeaderRole::Digest),
    ] {
        let found = decoded.frame.field(role).map_or(Value::Null, |field| {
            match field.content {
                // The vectors have digests in hex, as sent.
                HeaderContent::Int(value) if role != HeaderRole::Digest => value.into(),
                _ => hex(&bytes[field.span.clone()]).into(),
            }
        });
        assert_eq!(found, expected[name], "{place}: {name}");
    }
}

/// `bodies.json` belongs to no spec. The test builds one with a command for each type, whose body has one key.
#[test]
fn every_body_is_read_and_written_as_the_rules_say() {
    let files = support::vectors();
    let (_, file) = files.iter().find(|(name, _)| name == "bodies").unwrap();
    let mut types: Vec<&str> = ["accepted", "rejected"]
        .into_iter()
        .flat_map(|list| cases(file, list))
        .map(|vector| vector["type"].as_str().unwrap())
        .collect();
    types.sort_unstable();
    types.dedup();
    let mut commands = "group: { id: bodies, zh: 正文, en: Bodies }\n\ncommands:\n".to_owned();
    for (number, ty) in types.iter().enumerate() {
        let spelled = if *ty == "object" { "One" } else { *ty };
        let example = match *ty {
            "string" => ", example: a",
            "object" | "base64" | "json" | "timestamp_ms" | "timestamp_s" => "",
            _ => ", example: 1",
        };
        let code = 0x100 + number;
        write!(
            commands,
            "  of_{ty}:\n    code: 0x{code:04X}\n    zh: 一\n    en: One\n    effect: read\n    source: {{ sections: [] }}\n    \
             request:\n      value: {{ type: \"{spelled}?\"{example}, zh: 一, en: One }}\n"
        )
        .unwrap();
    }
    commands.push_str("\ntypes:\n  One:\n    zh: 一\n    en: One\n    fields:\n      value: { type: \"i32?\", example: 1, zh: 一, en: One }\n");
    // Uses the greatest depth that a reader supports.
    let protocol = support::specs::SMALL.replace("json_depth: 12", "json_depth: 127");
    let model = support::specs::model_of(&protocol, &commands);
    let reflector = Reflector::new(&model);
    let mut count = 0;
    for (list, key) in [("accepted", "written"), ("rejected", "error")] {
        for vector in cases(file, list) {
            let ty = vector["type"].as_str().unwrap();
            let operation = model.operation(&format!("of_{ty}")).unwrap();
            let bytes = unhex(vector["bytes"].as_str().unwrap());
            let message = reflector.message(Some(operation), Direction::Request, &bytes);
            let found = match message.and_then(|message| message.canonical()) {
                Ok(written) => ("accepted", written),
                Err(error) => ("rejected", error.name().to_owned()),
            };
            let wanted = vector[key].as_str().unwrap().to_owned();
            assert_eq!(found, (list, wanted), "{vector}");
            count += 1;
        }
    }
    assert!(count > 200, "{count}");
}
