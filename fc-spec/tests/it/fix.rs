//! Applies the certain fixes to every slip in `slips` and every fixture in `bad`. They reduce the errors and change
//! only their own lines.

use fc_spec::diagnostic::Faults;
use fc_spec::fix::{Fixed, certain, fix_all};
use fc_spec::load::load;
use fc_spec::source::Sources;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn tests() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")
}

fn good(path: &str) -> String {
    std::fs::read_to_string(tests().join("good").join(path)).expect("a file of the good spec")
}

fn check(sources: &Sources) -> Faults {
    let mut faults = Faults::new();
    let _ = load(sources, &mut faults);
    faults
}

fn sources(protocol: &str, commands: &str) -> Sources {
    Sources::from_texts([
        ("spec/protocol.yaml", protocol),
        ("spec/commands/demo.yaml", commands),
    ])
}

/// Returns every slip with its title.
fn slips() -> Vec<(String, Sources)> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(tests().join("slips")).expect("slips") {
        let path = entry.expect("an entry").path();
        let text = std::fs::read_to_string(&path).expect("slips");
        for slip in text.split("\n# ") {
            let lines = |sign: char| -> String {
                let lines = slip
                    .lines()
                    .skip(1)
                    .filter_map(|line| line.strip_prefix(sign));
                lines.flat_map(|line| [line, "\n"]).collect()
            };
            let (old, new) = (lines('-'), lines('+'));
            let in_protocol = slip.lines().any(|line| line == "@ protocol.yaml");
            let made = |text: String| match old.as_str() {
                "" => text + &new,
                old => text.replacen(old, &new, 1),
            };
            let (mut protocol, mut commands) = (good("protocol.yaml"), good("commands/demo.yaml"));
            if in_protocol {
                protocol = made(protocol);
            } else {
                commands = made(commands);
            }
            let title = slip.lines().next().unwrap_or_default().to_owned();
            all.push((title, sources(&protocol, &commands)));
        }
    }
    all
}

/// Returns every fixture next to the complete good spec. Duplicates cause more errors, which no fix removes.
fn fixtures() -> Vec<(String, Sources)> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(tests().join("bad")).expect("fixtures") {
        let path = entry.expect("an entry").path();
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let text = std::fs::read_to_string(&path).expect("a fixture");
        let files = [
            ("spec/protocol.yaml".to_owned(), good("protocol.yaml")),
            (
                "spec/commands/demo.yaml".to_owned(),
                good("commands/demo.yaml"),
            ),
            (format!("spec/commands/z_{name}"), text),
        ];
        all.push((name, Sources::from_texts(files)));
    }
    all
}

fn lines_that_changed(old: &Sources, new: &Sources) -> BTreeSet<(String, usize)> {
    let mut changed = BTreeSet::new();
    for ((_, old), (_, new)) in old.iter().zip(new.iter()) {
        assert_eq!(
            old.text.lines().count(),
            new.text.lines().count(),
            "{}",
            old.path
        );
        let lines = old.text.lines().zip(new.text.lines()).enumerate();
        let lines = lines.filter(|(_, (old, new))| old != new);
        changed.extend(lines.map(|(index, _)| (old.path.clone(), index + 1)));
    }
    changed
}

#[test]
fn certain_fixes_change_only_their_lines() {
    let (mut fixed, mut with_certain) = (0, 0);
    for (title, sources) in slips().into_iter().chain(fixtures()) {
        let before = check(&sources);
        with_certain += usize::from(before.iter().any(|it| certain(it, &sources).is_some()));
        let Some(Fixed {
            sources: after,
            done,
        }) = fix_all(&sources, check)
        else {
            continue;
        };
        fixed += 1;
        let left = check(&after);
        let count = |faults: &Faults| faults.errors() + faults.warnings();
        assert!(count(&left) < count(&before), "{title}");
        let named: BTreeSet<_> = done.into_iter().map(|it| (it.path, it.line)).collect();
        assert_eq!(lines_that_changed(&sources, &after), named, "{title}");
    }
    println!("{fixed} of {with_certain} with a certain fix have fewer faults");
    // In the rest, the certain fix uncovers errors without one.
    assert!(fixed > 60, "{fixed} of {with_certain}");
    assert!(fixed * 10 >= with_certain * 9, "{fixed} of {with_certain}");
}

#[test]
fn errors_behind_a_yaml_error_are_fixed_too() {
    let commands = good("commands/demo.yaml")
        .replace("    effect: read\n", "    effect：raed\n    \t\n")
        .replace("since: 2023-05", "since: 2023/5");
    let broken = sources(&good("protocol.yaml"), &commands);
    let fixed = fix_all(&broken, check).expect("something is fixed");
    assert!(check(&fixed.sources).is_empty(), "{:?}", fixed.done);
    let codes: Vec<_> = fixed.done.iter().map(|it| it.code.as_str()).collect();
    assert!(
        codes.contains(&"FC0024") && codes.contains(&"FC0109"),
        "{codes:?}"
    );
}

/// A value with two possible meanings is left to a person.
#[test]
fn guesses_are_left_alone() {
    for (old, new) in [
        ("code: 0x0101", "code: 257"),
        ("since: 2023-05", "since: 05-2023"),
        (
            "x: { type: f64, wire: string, unit: m,",
            "x: { type: f64, wire: string, unit: metre,",
        ),
        ("color: Color\n", "color: Colour\n"),
        (
            "example: 7, zh: 物品 ID, en: Id of the thing }\n    response",
            "example: 010, zh: 物品 ID, en: Id of the thing }\n    response",
        ),
    ] {
        let good_commands = good("commands/demo.yaml");
        assert!(good_commands.contains(old), "{old}");
        let broken = sources(&good("protocol.yaml"), &good_commands.replacen(old, new, 1));
        assert!(!check(&broken).is_empty(), "{new}");
        assert!(fix_all(&broken, check).is_none(), "{new}");
    }
}
