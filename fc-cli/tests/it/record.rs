//! `fcproto record`, the proxy with `--record`, and their recordings as input.

use crate::support::Project;
use crate::support::robot::Robot;

/// The first and the last bytes of a recording.
const MAGIC: &[u8] = b"\x89MCAP0\r\n";

fn is_whole(project: &Project, path: &str) -> bool {
    let bytes = std::fs::read(project.path(path)).expect("a recording");
    let has = |topic: &[u8]| bytes.windows(topic.len()).any(|window| window == topic);
    bytes.starts_with(MAGIC) && bytes.ends_with(MAGIC) && has(b"/get_level/response")
}

#[test]
fn traffic_is_recorded() {
    let project = Project::new();
    let mock = Robot::mock(&project, &[]);
    let proxy = mock.proxy(&project, &["--record", "live.mcap"]);
    proxy.call(&project, &["get_level"]).expect(0);
    proxy.stop("-INT").expect(0);
    assert!(is_whole(&project, "live.mcap"));
    let decode = ["decode", "live.mcap", "--format", "json"];
    let run = project.fc(&decode).expect(0);
    let lines: Vec<&str> = run.stdout.lines().collect();
    let [request, response] = lines[..] else {
        panic!("{run:?}");
    };
    assert!(request.contains(r#""connection":"127.0.0.1:"#), "{request}");
    assert!(response.contains(r#""request":"#), "{response}");
    project.fc(&["drift", "live.mcap"]).expect(0);
    let replay = Robot::mock(&project, &["--replay", "live.mcap"]);
    replay.call(&project, &["get_level"]).expect(0);
}

#[test]
fn the_frames_before_a_cut_are_read() {
    let project = Project::new();
    let frame = project.fc(&["encode", "get_level"]).expect(0);
    project.write("frame.hex", &frame.stdout);
    project
        .fc(&["record", "frame.hex", "--out", "run.mcap"])
        .expect(0);
    let path = project.path("run.mcap");
    let mut bytes = std::fs::read(&path).expect("a recording");
    bytes.truncate(bytes.len() - 10);
    std::fs::write(&path, bytes).expect("the folder is writable");
    let run = project
        .fc(&["decode", "run.mcap", "--lang", "en"])
        .expect(2);
    assert!(run.stdout.contains("get_level request"), "{run:?}");
    assert!(run.stderr.contains("the recording ends early"), "{run:?}");
}

#[test]
fn recorded_bytes_become_a_recording() {
    let project = Project::new();
    let response = project
        .fc(&["encode", "get_level", "--side", "response"])
        .expect(0);
    project.write("frame.hex", &response.stdout);
    let record = ["record", "frame.hex", "--out", "run.mcap", "--lang", "en"];
    let run = project.fc(&record).expect(0);
    assert!(run.stdout.contains("1 frame in `run.mcap`"), "{run:?}");
    assert!(is_whole(&project, "run.mcap"));
}

#[test]
fn a_folder_that_does_not_exist_is_named() {
    let project = Project::new();
    project.write("none.hex", "");
    let run = project
        .fc(&["record", "none.hex", "--out", "no/run.mcap", "--lang", "en"])
        .expect(2);
    assert!(run.stderr.contains("cannot write `no/run.mcap`"), "{run:?}");
}
