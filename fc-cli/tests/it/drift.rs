//! `fcproto drift`.

use crate::support::{Project, copy};
use serde_json::Value;
use std::path::Path;

/// The request and the response of `get_lift`. The response has the key `age`, which the spec lacks.
const UNKNOWN_KEY: &str = "
4C413F4C0000000102000000000000EEEFAE807FC6F07A5408E00EA81B44430000081F000000200101070000007B226174223A313730303030303030303030302C226C6966744964223A337D
4C4121C10000000102000000000000C1EAD372B6EB03A88C9B5D90A7A23DF800000894000000200101070000007B22616765223A342C226174223A313730303030303030303030302C22646F6F72223A302C2266616E223A747275652C22666C6F6F72223A322C226C69676874223A312C226C6F6164223A38302E352C226E616D65223A226E6F727468222C2270686F746F223A2241414141222C227263223A302C22736179223A22E5A5BD222C2273746F7073223A5B7B226174223A317D5D7D
";

/// Creates a project with the spec of the lift, and a recording.
fn recorded(text: &str) -> Project {
    let project = Project::empty();
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fc-workshop/tests/drift/spec");
    copy(&spec, &project.path("spec"));
    project.write("recording.hex", text);
    project
}

#[test]
fn a_deviation_is_listed_with_its_place_in_the_spec() {
    let project = recorded(UNKNOWN_KEY);
    let run = project
        .fc(&["drift", "recording.hex", "--lang", "en"])
        .expect(1);
    assert!(run.stdout.contains("unknown_key"), "{run:?}");
    assert!(run.stdout.contains("spec/commands/lift.yaml:"), "{run:?}");
    assert!(run.stdout.contains("2 frames, 1 deviation\n"), "{run:?}");

    let run = project
        .fc(&["drift", "--format", "json", "recording.hex"])
        .expect(1);
    let line: Value = serde_json::from_str(&run.stdout).expect("a line of JSON");
    assert_eq!(line["deviation"], "unknown_key");
    assert_eq!(line["name"], "get_lift");
    assert_eq!(line["path"], "age");
    assert_eq!(line["count"], 1);
    assert_eq!(line["example"], "4");
}

#[test]
fn the_suggested_edit_settles_the_deviation() {
    let project = recorded(UNKNOWN_KEY);
    let run = project
        .fc(&["drift", "--suggest", "recording.hex"])
        .expect(1);
    let added = run.stdout.lines().find_map(|line| line.strip_prefix('+'));
    let added = added.expect("an added line");
    let (file, last) = ("spec/commands/lift.yaml", "      photo:");
    let old = project.read(file);
    let photo = old
        .lines()
        .find(|line| line.starts_with(last))
        .expect("the last field");
    project.write(file, &old.replace(photo, &format!("{photo}\n{added}")));
    let run = project.fc(&["drift", "recording.hex"]).expect(0);
    assert!(run.stdout.contains('0'), "{run:?}");
}
