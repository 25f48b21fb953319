//! `fcproto decode` and `fcproto encode`.

use crate::support::{Project, Run, command};
use serde_json::Value;

/// Runs the command in a project with `input` on standard input.
fn piped(project: &Project, args: &[&str], input: &[u8]) -> Run {
    Run::with_input(command(args).current_dir(project.path("")), input)
}

fn encoded(project: &Project, args: &[&str]) -> String {
    let args: Vec<&str> = ["encode"].iter().chain(args).copied().collect();
    project.fc(&args).expect(0).stdout
}

#[test]
fn decode_reads_the_output_of_encode() {
    let project = Project::new();
    let frame = encoded(&project, &["set_level", "--id", "7"]);
    let tree = piped(&project, &["decode"], frame.as_bytes()).expect(0);
    let first = tree.stdout.lines().next().expect("a title");
    assert!(first.starts_with("0x0101 set_level request · "), "{first}");
    let level = tree
        .stdout
        .lines()
        .find(|line| line.contains("data.level "));
    assert!(level.expect("the key").contains(" 40  % "), "{tree:#?}");
    let chinese = piped(&project, &["decode", "--lang", "zh"], frame.as_bytes()).expect(0);
    assert!(
        chinese.stdout.starts_with("0x0101 set_level 请求 · "),
        "{chinese:#?}"
    );

    let packed = encoded(&project, &["set_level", "--id", "7", "--gzip"]);
    let args = ["decode", "--format", "json"];
    let [plain, packed] = [frame, packed].map(|frame| {
        let run = piped(&project, &args, frame.as_bytes()).expect(0);
        let mut line: Value = serde_json::from_str(&run.stdout).expect("JSON");
        line["length"].take();
        line
    });
    assert_eq!(plain, packed);
    assert_eq!(plain["msg_id"], 7);
    assert_eq!(plain["body"]["data"]["level"], 40);
}

#[test]
fn encode_names_wrong_keys_and_values() {
    let project = Project::new();
    for (args, expected) in [
        (&["encode", "nothing"][..], "`fcproto codes`"),
        (&["encode", "dim"], "no code yet"),
        (
            &["encode", "set_level", "data.levle=3"],
            "did you mean `level`?",
        ),
        (&["encode", "set_level", "data.level=much"], "expected"),
        (
            &["encode", "set_level", "data.level=3"],
            "missing_field at `data.ratio`",
        ),
        (&["encode", "set_level", "--json", "[]"], "a JSON object"),
    ] {
        let run = project.fc(args).expect(2);
        assert!(run.stderr.contains(expected), "{run:#?}");
        assert_eq!(run.stdout, "");
    }
}

#[test]
fn filters_choose_frames_and_errors_set_the_status() {
    let project = Project::new();
    let level = encoded(&project, &["set_level", "--id", "7"]);
    let get = encoded(&project, &["get_level", "--id", "8"]);
    // Changes the last digit, which belongs to the body.
    let mut broken = level.trim_end().to_owned();
    let last = if broken.ends_with('D') { "E" } else { "D" };
    broken.replace_range(broken.len() - 1.., last);
    let input = format!("{level}{get}{broken}");
    for (filter, ids, status) in [
        (&[][..], &[7, 8, 7][..], 1),
        (&["--id", "8"], &[8], 0),
        (&["--code", "0x0101"], &[7, 7], 1),
        (&["--name", "get_level"], &[8], 0),
        (
            &["--name", "get_level", "--name", "set_level", "--id", "8"],
            &[8],
            0,
        ),
        (&["--only", "errors"], &[7], 1),
        (&["--result", "0"], &[], 0),
    ] {
        let args: Vec<&str> = ["decode", "--format", "json"]
            .iter()
            .chain(filter)
            .copied()
            .collect();
        let run = piped(&project, &args, input.as_bytes()).expect(status);
        let lines = run.stdout.lines();
        let id = |line: &str| {
            let line: Value = serde_json::from_str(line).expect("JSON");
            line["msg_id"].as_i64().expect("an id")
        };
        assert_eq!(lines.map(id).collect::<Vec<_>>(), ids, "{filter:?}");
    }
}

#[test]
fn unreadable_input_is_named() {
    let project = Project::new();
    project.write("words.txt", "no frames here");
    for (args, expected) in [
        (&["decode", "missing.bin"][..], "cannot read `missing.bin`"),
        (
            &["decode", "--input", "hex", "words.txt"],
            "`words.txt`: `n` in line 1",
        ),
        (&["decode", "--name", "nothing"], "`fcproto codes`"),
        (&["decode", "--result", "nothing"], "no result `nothing`"),
    ] {
        let run = project.fc(args).expect(2);
        assert!(run.stderr.contains(expected), "{run:#?}");
    }
}

#[cfg(not(feature = "record"))]
#[test]
fn a_recording_needs_the_feature() {
    let project = Project::new();
    let bytes = b"\x89MCAP0\r\n\x01";
    std::fs::write(project.path("run.mcap"), bytes).expect("the folder is writable");
    let run = project
        .fc(&["decode", "run.mcap", "--lang", "en"])
        .expect(2);
    assert!(run.stderr.contains("--features record"), "{run:?}");
}
