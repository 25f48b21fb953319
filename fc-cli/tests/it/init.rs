//! `fcproto init`.

use std::path::Path;
use std::process::Command;

use crate::support::Project;
use crate::support::git::git;

#[test]
fn a_project_checks_and_is_generated_at_once() {
    let place = Project::empty();
    let run = place.fc(&["init", "lamp"]).expect(0);
    assert!(run.stdout.contains("\ncreated lamp\n"), "{run:#?}");
    for path in ["README.md", "fc.yaml", "src/lib.rs", "vectors/frames.json"] {
        assert!(place.path("lamp").join(path).is_file(), "{path}");
    }
    for language in ["docs/reference", "docs/en/reference"] {
        assert!(place.path("lamp").join(language).join("index.md").is_file());
    }
    for command in ["check", "lint"] {
        let run = place.fc_in("lamp", &[command]).expect(0);
        assert_eq!(run.stderr, "", "{command}");
    }
    place
        .fc_in("lamp/spec/commands", &["generate", "--check"])
        .expect(0);
    let new = ["new", "get_battery", "--group", "light"];
    place.fc_in("lamp", &new).expect(0);
    place.fc_in("lamp", &["generate"]).expect(0);
    let group = place.read("lamp/src/messages/light.rs");
    assert!(group.contains("pub fn get_battery<"), "{group}");
}

/// Files that people edit, and the start of a comment in them.
const WRITTEN: [(&str, &str); 7] = [
    ("fc.yaml", "# "),
    (".gitattributes", "# "),
    ("spec/protocol.yaml", "# "),
    ("spec/commands/light.yaml", "# "),
    ("examples/robot.rs", "//"),
    ("examples/app.rs", "//"),
    ("tests/talk.rs", "//"),
];

fn is_chinese(text: &str) -> bool {
    text.chars().any(|c| ('\u{4e00}'..'\u{a000}').contains(&c))
}

/// Removes comments and quoted words.
fn code(text: &str, comment: &str) -> String {
    let lines = text
        .lines()
        .filter(|line| !line.trim_start().starts_with(comment));
    let lines = lines.map(|line| {
        let is_import = line.starts_with("#[path") || line.starts_with("//! ");
        let parts = line.split('"').enumerate();
        let parts = parts.filter(|(at, _)| at % 2 == 0 || is_import);
        parts.map(|(_, part)| part).collect::<Vec<_>>().join("\"")
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn chinese_project_differs_in_texts_only() {
    let place = Project::empty();
    place.fc(&["init", "zh", "--lang", "zh"]).expect(0);
    place.fc(&["init", "en", "--lang", "en"]).expect(0);
    for (path, comment) in WRITTEN {
        let [zh, en] = ["zh", "en"].map(|lang| place.read(&format!("{lang}/{path}")));
        let comments = |text: &str| {
            let lines = text.lines().map(str::trim_start);
            let lines = lines.filter(|line| line.starts_with(comment));
            let is_command = |line: &&str| {
                !line.contains("cargo run")
                    && !line.contains("$schema")
                    && line.len() > 3
                    && !line.contains("```")
            };
            lines
                .filter(is_command)
                .map(str::to_owned)
                .collect::<Vec<_>>()
        };
        for line in comments(&zh) {
            assert!(is_chinese(&line), "{path}: {line}");
        }
        for line in comments(&en) {
            assert!(!is_chinese(&line), "{path}: {line}");
        }
        assert_eq!(comments(&zh).is_empty(), comments(&en).is_empty(), "{path}");
        assert_eq!(code(&zh, comment), code(&en, comment), "{path}");
        // The program prints these strings.
        let printed = zh
            .lines()
            .filter(|line| line.contains("{}") || line.contains("{:?}"));
        for line in printed.filter(|line| line.contains('"')) {
            assert!(is_chinese(line), "{path}: {line}");
        }
    }
    let readme = place.read("zh/README.md");
    for paragraph in readme.split("\n\n").filter(|it| !it.starts_with("```")) {
        assert!(is_chinese(paragraph), "{paragraph}");
    }
    // Both READMEs list the same commands to type.
    let typed = |lang: &str| {
        let readme = place.read(&format!("{lang}/README.md"));
        let block = readme.split("```").nth(1).expect("a block").to_owned();
        let lines = block.lines().map(|line| {
            line.split(" # ")
                .next()
                .unwrap_or_default()
                .trim()
                .to_owned()
        });
        lines.filter(|line| !line.is_empty()).collect::<Vec<_>>()
    };
    assert_eq!(typed("zh"), typed("en"));
    for command in [
        &["check"][..],
        &["lint"],
        &["fmt", "--check"],
        &["generate", "--check"],
    ] {
        let run = place.fc_in("zh", command).expect(0);
        assert_eq!(run.stderr, "", "{command:?}");
    }
}

#[test]
fn setup_keeps_settings_of_others() {
    let place = Project::empty();
    place.write("mine/notes.txt", "mine\n");
    let run = place.fc(&["init", "mine"]).expect(2);
    assert!(
        run.stderr
            .contains("`mine` is not empty: it has `notes.txt`; name another directory"),
        "{run:#?}"
    );
    assert_eq!(place.files("mine").len(), 1);

    // A directory with only a new repository counts as empty.
    place.write("fresh/.git/HEAD", "ref: refs/heads/main\n");
    place.fc(&["init", "fresh"]).expect(0);
}

#[test]
fn new_project_needs_no_git_attributes() {
    let place = Project::empty();
    place.fc(&["init", "lamp"]).expect(0);
    git(&place, &["init", "--quiet", "lamp"]);
    let said = place.fc_in("lamp", &["git", "setup"]).expect(0).stdout;
    assert!(!said.contains(".gitattributes"), "{said}");
}

#[test]
fn wrong_usage_writes_nothing() {
    let place = Project::empty();
    for (arguments, message) in [
        (
            ["init", "lamp", "--runtime", "nowhere"].as_slice(),
            "there is no `nowhere/fc-derive`",
        ),
        (
            &["init", "lamp", "--root", "."],
            "leave out --root and --spec",
        ),
        (&["init"], "<DIR>"),
    ] {
        let run = place.fc(arguments).expect(2);
        assert!(run.stderr.contains(message), "{run:#?}");
        assert!(!place.path("lamp").exists());
    }
}

/// Runs the tests of a new project: it compiles, the samples of its docs run, and its robot and app talk.
#[test]
#[ignore = "compiles a project of its own"]
fn the_robot_and_the_app_of_a_project_talk() {
    for lang in ["en", "zh"] {
        talks(lang);
    }
}

fn talks(lang: &str) {
    let place = Project::empty();
    place.fc(&["init", "lamp", "--lang", lang]).expect(0);
    // Uses the locked versions of this repository, so that cargo fetches nothing.
    let lock = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.lock");
    std::fs::copy(lock, place.path("lamp/Cargo.lock")).expect("the versions");
    let output = Command::new(env!("CARGO"))
        .args(["test", "--offline", "--all-targets"])
        .current_dir(place.path("lamp"))
        .env(
            "CARGO_TARGET_DIR",
            Path::new(env!("CARGO_TARGET_TMPDIR")).join("nested"),
        )
        .output()
        .expect("cargo");
    let said = String::from_utf8_lossy(&output.stdout);
    let complaints = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && !complaints.contains("warning"),
        "{said}\n{complaints}"
    );
    for test in [
        "test every_sample_runs ... ok",
        "test set_light_changes_the_light_and_is_reported ... ok",
    ] {
        assert!(said.contains(test), "{said}");
    }
}

/// In the programs of both languages, only comments and strings differ.
#[test]
fn programs_of_both_languages_are_the_same() {
    let templates = Path::new(env!("CARGO_MANIFEST_DIR")).join("templates/init");
    for file in ["examples/app.rs", "examples/robot.rs", "tests/talk.rs"] {
        let read = |path| std::fs::read_to_string(templates.join(path)).expect("a template");
        let [en, zh] = [read(file.to_owned()), read(format!("zh/{file}"))];
        assert_eq!(en.lines().count(), zh.lines().count(), "{file}");
        for (en, zh) in en.lines().zip(zh.lines()) {
            // Removes the comment and the strings.
            let code = |line: &str| {
                let line = line.split("//").next().unwrap_or_default();
                line.split('"').step_by(2).collect::<String>()
            };
            assert_eq!(code(en), code(zh), "{file}");
        }
    }
}
