//! Frames that differ from a spec, and the deviations that must be found in them.

use crate::support::loaded;
use fc_reflect::{Packing, Reflector};
use fc_spec::diagnostic::Faults;
use fc_spec::model::{Direction, HeaderRole, Kind, Model};
use fc_spec::source::Sources;
use fc_spec::syntax::read_dir;
use fc_workshop::capture::Flow;
use fc_workshop::decode::Decoder;
use fc_workshop::drift::{Deviation, Drift, Report, suggest};
use serde::Deserialize;
use std::convert::Infallible;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The most suggestions that a case may need.
const ROUNDS: usize = 4;

#[derive(Deserialize)]
struct Case {
    name: String,
    frames: Vec<Sent>,
    /// The kind, path, value and number of each deviation.
    finds: Vec<String>,
    /// `true` if the suggested edits, applied, make the report empty.
    settles: bool,
}

/// A frame.
#[derive(Deserialize)]
struct Sent {
    name: String,
    #[serde(default)]
    is: Side,
    #[serde(default)]
    id: u32,
    /// The time in milliseconds.
    #[serde(default)]
    at: Option<u64>,
    #[serde(default)]
    body: Option<serde_json::Value>,
    /// The data instead of a body.
    #[serde(default)]
    text: Option<String>,
    /// A field of the header, and its wrong value.
    #[serde(default)]
    wrong: Option<(String, u64)>,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Side {
    #[default]
    Request,
    Response,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/drift")
}

fn spec() -> Sources {
    read_dir(&folder(), Path::new("spec"), &mut Faults::new())
}

fn model(sources: &Sources) -> Model {
    loaded(sources, Faults::new())
}

fn cases() -> Vec<Case> {
    let text = fs::read_to_string(folder().join("deviations.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Returns the bytes of a frame, without any check.
fn bytes(reflector: &Reflector<'_>, sent: &Sent) -> Vec<u8> {
    let operation = reflector.model().operation(&sent.name).unwrap();
    let direction = match sent.is {
        Side::Request => Direction::Request,
        Side::Response => Direction::Response,
    };
    let id = reflector.id(operation, direction, sent.id).unwrap();
    let data = match (&sent.body, &sent.text) {
        (Some(body), _) => body.to_string().into_bytes(),
        (None, Some(text)) => text.clone().into_bytes(),
        (None, None) => reflector.samples().data(operation, direction),
    };
    let mut bytes = reflector.seal(id, &data, Packing::Plain).unwrap();
    if let Some((field, value)) = &sent.wrong {
        let role = HeaderRole::ALL.iter().find(|role| role.name() == field);
        match role.unwrap() {
            HeaderRole::Digest => *bytes.last_mut().unwrap() ^= 1,
            role => reflector.overwrite(&mut bytes, *role, *value),
        }
    }
    bytes
}

fn flow(reflector: &Reflector<'_>, sent: &Sent) -> Flow {
    let to_robot = Flow {
        from: "127.0.0.1:40000".parse().unwrap(),
        to: "127.0.0.1:7001".parse().unwrap(),
    };
    let operation = reflector.model().operation(&sent.name).unwrap();
    let is_command = operation.kind() == Kind::Command;
    if is_command == matches!(sent.is, Side::Request) {
        to_robot
    } else {
        to_robot.reversed()
    }
}

/// Returns the report over the frames of a case, as the original peers send them.
fn observe<'m>(written: &Reflector<'_>, model: &'m Model, case: &Case) -> Report<'m> {
    let reflector = Reflector::new(model);
    let mut decoder = Decoder::new(&reflector);
    let mut drift = Drift::new(model);
    for sent in &case.frames {
        let time = sent.at.map(Duration::from_millis);
        let mut sink = |record: &_| -> Result<(), Infallible> {
            drift.observe(record);
            Ok(())
        };
        let bytes = bytes(written, sent);
        decoder
            .push(Some(flow(written, sent)), time, &bytes, &mut sink)
            .unwrap();
    }
    let mut sink = |record: &_| -> Result<(), Infallible> {
        drift.observe(record);
        Ok(())
    };
    decoder.finish(&mut sink).unwrap();
    drift.finish()
}

fn line(deviation: &Deviation<'_>) -> String {
    let place = &deviation.place;
    let parts = [place.kind.name(), &place.path, &place.value];
    let parts = parts.into_iter().filter(|part| !part.is_empty());
    let line = parts.collect::<Vec<_>>().join(" ");
    match deviation.count {
        1 => line,
        count => format!("{line} ×{count}"),
    }
}

#[test]
fn each_deviation_is_found_once() {
    let (sources, cases) = (spec(), cases());
    let model = model(&sources);
    let written = Reflector::new(&model);
    assert!(cases.len() >= 40, "{}", cases.len());
    let mut wrong = Vec::new();
    for case in &cases {
        let report = observe(&written, &model, case);
        let found: Vec<_> = report.deviations.iter().map(line).collect();
        if found != case.finds {
            wrong.push(format!("{}: {found:?}, not {:?}", case.name, case.finds));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn applied_suggestions_make_the_report_empty() {
    let sources = spec();
    let original = model(&sources);
    let written = Reflector::new(&original);
    let mut wrong = Vec::new();
    for case in cases() {
        let mut amended = sources.clone();
        let mut rounds = 0;
        let settled = loop {
            let model = model(&amended);
            let report = observe(&written, &model, &case);
            if report.deviations.is_empty() {
                break rounds > 0;
            }
            let mut deviations = report.deviations.iter();
            let edit = deviations.find_map(|deviation| suggest(&amended, &model, deviation));
            rounds += 1;
            match edit {
                Some(edit) if rounds <= ROUNDS => amended = edit.sources,
                _ => break false,
            }
        };
        if settled != case.settles {
            wrong.push(format!("{}: settled {settled}", case.name));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
