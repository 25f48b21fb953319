//! `fcproto generate`.

use crate::support::Project;

fn generated() -> Project {
    let project = Project::new();
    project.fc(&["generate"]).expect(0);
    project
}

#[test]
fn a_second_run_changes_nothing() {
    let project = Project::new();
    let run = project.fc(&["generate"]).expect(0);
    assert!(run.stdout.starts_with("read "), "{run:#?}");
    assert!(run.stdout.contains("\ncreated "), "{run:#?}");
    assert!(project.path("fc-manifest.json").is_file());

    let before = project.files("");
    let run = project.fc(&["generate"]).expect(0);
    assert_eq!(run.stdout.lines().count(), 2, "{run:#?}");
    assert_eq!(project.files(""), before);
    project.fc(&["generate", "--check"]).expect(0);
}

#[test]
fn check_shows_stale_files_and_writes_nothing() {
    let project = generated();
    let path = "fc-generated/src/lib.rs";
    project.append(path, "// by hand\n");
    let before = project.files("");
    let run = project.fc(&["generate", "--check"]).expect(1);
    assert!(
        run.stdout
            .contains(&format!("--- a/{path}\n+++ b/{path}\n@@ ")),
        "{run:#?}"
    );
    assert!(run.stdout.contains("\n-// by hand\n"), "{run:#?}");
    assert_eq!(
        run.stderr,
        "error: 1 file is stale; run `fcproto generate`\n"
    );
    assert_eq!(project.files(""), before);

    let run = project
        .fc(&["generate", "--check", "--out", "a b"])
        .expect(1);
    let end = "run `fcproto generate --out 'a b'`\n";
    assert!(run.stderr.ends_with(end), "{run:#?}");

    let run = project.fc(&["generate"]).expect(0);
    assert!(
        run.stdout
            .contains(&format!("updated    1 file\n             {path}\n")),
        "{run:#?}"
    );
    project.fc(&["generate", "--check"]).expect(0);
}

#[test]
fn a_deleted_output_is_stale_and_comes_back_as_it_was() {
    let project = generated();
    let path = "fc-generated/src/client.rs";
    let before = project.read(path);
    std::fs::remove_file(project.path(path)).expect("the file is there");
    let run = project.fc(&["generate", "--check"]).expect(1);
    assert!(run.stdout.contains(&format!("+++ b/{path}\n")), "{run:#?}");
    assert!(!project.path(path).exists());
    let run = project.fc(&["generate"]).expect(0);
    assert!(run.stdout.contains(path), "{run:#?}");
    assert_eq!(project.read(path), before);
}

#[test]
fn the_command_to_run_is_the_one_that_was_run() {
    let project = generated();
    project.write("fc-generated/src/lib.rs", "");
    let run = project
        .fc(&[
            "generate",
            "--check",
            "--only",
            "rust,vectors",
            "--root",
            ".",
        ])
        .expect(1);
    assert!(
        run.stderr
            .contains("run `fcproto generate --only rust,vectors --root .`"),
        "{run:#?}"
    );
}

/// A directory without a spec gets the same files from a dump as the project gets from its YAML.
#[test]
fn from_a_dump_all_products_are_the_same() {
    let project = generated();
    let dump = project.fc(&["inspect"]).expect(0).stdout;
    project.write("model.json", &dump);
    let run = (project.fc(&["generate", "--check", "--from", "model.json"])).expect(0);
    assert!(
        run.stdout.starts_with("read       model.json\nup to date "),
        "{run:#?}"
    );

    project.write(
        "elsewhere/model.json",
        &dump.replace("\"digest\"", "\"hash\""),
    );
    let run = (project.fc(&[
        "generate",
        "--from",
        "elsewhere/model.json",
        "--root",
        "elsewhere",
    ]))
    .expect(2);
    assert!(
        run.stderr.contains(
            "`elsewhere/model.json`: not a dump of `fcproto inspect`: unknown variant `hash`"
        ),
        "{run:#?}"
    );
    assert!(!project.path("elsewhere/fc-manifest.json").exists());
    project.write("elsewhere/model.json", &dump);
    (project.fc(&[
        "generate",
        "--from",
        "elsewhere/model.json",
        "--root",
        "elsewhere",
    ]))
    .expect(0);
    for (path, _) in project.files("fc-generated") {
        let made = std::fs::read(&path).expect("a generated file");
        let below = path.strip_prefix(project.path("")).expect("in the project");
        let again = std::fs::read(project.path("elsewhere").join(below)).expect("the same file");
        assert_eq!(made, again, "{}", below.display());
    }

    let run = (project.fc(&["generate", "--from", "nowhere.json"])).expect(2);
    assert!(
        run.stderr.contains("cannot read `nowhere.json`: "),
        "{run:#?}"
    );

    project.write("fc-generated/src/lib.rs", "");
    let run = (project.fc(&["generate", "--check", "--from", "model.json"])).expect(1);
    assert!(
        run.stderr
            .contains("run `fcproto generate --from model.json`"),
        "{run:#?}"
    );
}

#[test]
fn only_some_products() {
    let project = Project::new();
    project.fc(&["generate", "--only", "rust"]).expect(0);
    assert!(project.path("fc-generated/src/lib.rs").is_file());
    assert!(!project.path("fc-generated/vectors").exists());
    let run = project.fc(&["generate", "--only", "rust,cobol"]).expect(2);
    assert!(run.stderr.contains("cobol"), "{run:#?}");
}

#[test]
fn files_of_others_stay() {
    let project = Project::new();
    project.write("fc-generated/src/lib.rs", "// mine\n");
    let run = project.fc(&["generate", "--check"]).expect(1);
    assert!(
        run.stdout.contains("fc-generated/src/lib.rs: exists"),
        "{run:#?}"
    );
    let run = project.fc(&["generate"]).expect(2);
    assert!(
        run.stderr
            .starts_with("error: `fc-generated/src/lib.rs` would"),
        "{run:#?}"
    );
    assert_eq!(project.read("fc-generated/src/lib.rs"), "// mine\n");
    assert!(!project.path("fc-manifest.json").exists());
}

#[test]
fn a_faulty_spec_generates_nothing() {
    let project = generated();
    project.append("spec/types.yaml", "x: [\n");
    let before = project.files("");
    let run = project.fc(&["generate"]).expect(1);
    assert!(run.stderr.contains("error[FC0008]"), "{run:#?}");
    assert_eq!(run.stdout, "");
    assert_eq!(project.files(""), before);
}

/// Renaming a command group removes the files with the old name.
#[test]
fn orphans_are_removed() {
    let project = generated();
    let has = |name: &str| {
        project
            .files("fc-generated")
            .iter()
            .any(|(path, _)| path.ends_with(name))
    };
    assert!(has("lamp.rs"));
    let group = "spec/commands/lamp.yaml";
    let text = project.read(group);
    assert!(text.contains("id: lamp"));
    project.write(group, &text.replacen("id: lamp", "id: torch", 1));

    let run = project.fc(&["generate", "--check"]).expect(1);
    assert!(run.stdout.contains("lamp.rs\n+++ /dev/null\n"), "{run:#?}");
    let run = project.fc(&["generate"]).expect(0);
    assert!(run.stdout.contains("\nremoved "), "{run:#?}");
    assert!(has("torch.rs") && !has("lamp.rs"));
}
