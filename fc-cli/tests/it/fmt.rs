//! `fcproto fmt`.

use std::path::Path;

use crate::support::{Project, Run, command};

/// A formatted file. `OTHER` is the same file in another layout.
const LAID_OUT: &str = "\
group: { id: lamp, zh: 灯, en: Lamp }

# What a lamp is.
types:
  Lamp:
    zh: 灯
    en: A lamp
    fields:
      hue: { type: u8, example: 0x0A, zh: 色相, en: Hue } # of the light
";
const OTHER: &str = "\
group: {id: lamp,  en: Lamp, zh: 灯}
# What a lamp is.
types:
    Lamp:
        en: A lamp
        zh: 灯
        fields:

            hue: {type: u8, zh: 色相, en: Hue, example: 0x0A}   # of the light
";
const BROKEN: &str = "types: { Lamp: [ }\n";
const UNKNOWN: &str = "types:\n  Lamp:\n    en: Lamp\n    colour: red\n    zh: 灯\n";

fn project() -> Project {
    let project = Project::empty();
    project.write("spec/protocol.yaml", LAID_OUT);
    project.write("spec/commands/lamp.yaml", OTHER);
    project
}

fn piped(args: &[&str], text: &str) -> Run {
    Run::with_input(&mut command(args), text)
}

#[test]
fn fmt_writes_only_files_that_change() {
    let project = project();
    let before = project.files("spec");
    let run = project.fc(&["fmt"]).expect(0);
    assert_eq!(run.stdout, "formatted spec/commands/lamp.yaml\n");
    assert_eq!(run.stderr, "");
    assert_eq!(project.read("spec/commands/lamp.yaml"), LAID_OUT);
    let after = project.files("spec");
    let same = |name: &str| {
        let time = |files: &[(std::path::PathBuf, _)]| {
            let found = files.iter().find(|(path, _)| path.ends_with(name));
            found.expect("the file").1
        };
        time(&before) == time(&after)
    };
    assert!(same("protocol.yaml"));

    // A second run writes nothing.
    let run = project.fc(&["fmt"]).expect(0);
    assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("", ""));
    assert_eq!(project.files("spec"), after);
}

#[test]
fn a_check_names_the_files_and_writes_nothing() {
    let project = project();
    let before = project.files("spec");
    let run = project.fc(&["fmt", "--check"]).expect(1);
    assert_eq!(run.stdout, "spec/commands/lamp.yaml\n");
    assert_eq!(run.stderr, "1 file not formatted: run `fcproto fmt`\n");
    let named = project.fc(&["fmt", "--check", "spec/protocol.yaml"]);
    assert_eq!(named.expect(0).stdout, "");
    assert_eq!(project.files("spec"), before);
}

#[test]
fn diff_shows_the_changes_and_writes_nothing() {
    let project = project();
    let before = project.files("spec");
    let run = project.fc(&["fmt", "--diff"]).expect(0);
    let head = "\
--- a/spec/commands/lamp.yaml
+++ b/spec/commands/lamp.yaml
@@ -1,9 +1,9 @@
-group: {id: lamp,  en: Lamp, zh: 灯}
+group: { id: lamp, zh: 灯, en: Lamp }
+
 # What a lamp is.
 types:
";
    assert!(run.stdout.starts_with(head), "{run:#?}");
    let again = project.fc(&["fmt", "--diff", "--check"]).expect(1);
    assert_eq!(again.stdout, run.stdout);
    assert_eq!(project.files("spec"), before);
}

#[test]
fn files_are_named_one_by_one_from_anywhere() {
    let project = project();
    project.write("elsewhere/types.yaml", OTHER);
    let run = project.fc_in("elsewhere", &["fmt", "types.yaml"]).expect(0);
    assert_eq!(run.stdout, "formatted types.yaml\n");
    assert_eq!(project.read("elsewhere/types.yaml"), LAID_OUT);
    assert_eq!(project.read("spec/commands/lamp.yaml"), OTHER);

    let run = project.fc(&["fmt", "elsewhere/none.yaml"]).expect(2);
    assert!(
        run.stderr.contains("cannot read `elsewhere/none.yaml`"),
        "{run:#?}"
    );
    project.fc(&["fmt", "-", "elsewhere/types.yaml"]).expect(2);
}

#[test]
fn standard_input_comes_back_laid_out() {
    let run = piped(&["fmt", "-"], OTHER).expect(0);
    assert_eq!((run.stdout.as_str(), run.stderr.as_str()), (LAID_OUT, ""));
    let run = piped(&["fmt", "-"], LAID_OUT).expect(0);
    assert_eq!(run.stdout, LAID_OUT);
    let run = piped(&["fmt", "--check", "-"], OTHER).expect(1);
    assert_eq!(run.stdout, "<stdin>\n");
    assert_eq!(
        piped(&["fmt", "--check", "-"], LAID_OUT).expect(0).stdout,
        ""
    );
    // A file with errors comes back unchanged, so an editor loses nothing.
    for text in [BROKEN, UNKNOWN] {
        assert_eq!(piped(&["fmt", "-"], text).expect(1).stdout, text);
    }
}

#[test]
fn unreadable_file_stays_and_others_are_formatted() {
    for (text, fault) in [(BROKEN, "error[FC00"), (UNKNOWN, "error[FC0101]")] {
        let project = project();
        project.write("spec/broken.yaml", text);
        let run = project.fc(&["fmt"]).expect(1);
        assert!(run.stderr.contains(fault), "{run:#?}");
        assert_eq!(project.read("spec/broken.yaml"), text);
        assert_eq!(project.read("spec/commands/lamp.yaml"), LAID_OUT);
    }
}

#[test]
fn line_ends_stay_those_of_the_file() {
    let project = project();
    project.write("spec/commands/lamp.yaml", &OTHER.replace('\n', "\r\n"));
    project.fc(&["fmt"]).expect(0);
    let expected = LAID_OUT.replace('\n', "\r\n");
    assert_eq!(project.read("spec/commands/lamp.yaml"), expected);
    project.fc(&["fmt", "--check"]).expect(0);
}

#[test]
fn new_operation_is_formatted() {
    let place = Project::empty();
    place.fc(&["init", "lamp"]).expect(0);
    place.fc_in("lamp", &["fmt", "--check"]).expect(0);
    let begun = [
        ["new", "get_battery", "--group", "light"].as_slice(),
        &["new", "battery_low", "--group", "light", "--report"],
        &["new", "curve", "--group", "light", "--stream"],
        &[
            "new",
            "graph",
            "--group",
            "light",
            "--stream",
            "--started-by",
            "get_battery",
        ],
    ];
    for arguments in begun {
        place.fc_in("lamp", arguments).expect(0);
        let run = place.fc_in("lamp", &["fmt", "--check", "--diff"]);
        assert_eq!(run.stdout, "", "{arguments:?}");
        run.expect(0);
    }
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fc-generated/tests");
    for protocol in ["meter", "beacon"] {
        let root = tests.join(protocol);
        let root = root.to_str().expect("UTF-8");
        let run = place.fc(&["fmt", "--check", "--diff", "--root", root]);
        assert_eq!(run.stdout, "", "{protocol}");
        run.expect(0);
    }
}
