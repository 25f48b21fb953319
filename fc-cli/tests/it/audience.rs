//! Output for one audience.

use crate::support::Project;

/// Returns `true` if a generated file in this directory contains `word`.
fn says(project: &Project, directory: &str, word: &str) -> bool {
    let mut files = project.files(directory).into_iter();
    files.any(|(path, _)| {
        let text = std::fs::read_to_string(path).expect("a file of text");
        text.contains(word)
    })
}

#[test]
fn audience_is_generated_into_its_own_directory() {
    let project = Project::new();
    project.fc(&["generate"]).expect(0);
    let before = project.files("");
    let args = ["generate", "--for", "user_app", "--out", "user"];
    let run = project.fc(&args).expect(0);
    assert!(run.stdout.contains("\ncreated "), "{run:#?}");
    assert!(project.path("user/fc-manifest.json").is_file());
    // Only `tester_app` has `probe`.
    assert!(!says(&project, "user/fc-generated", "probe"));
    assert!(says(&project, "fc-generated", "probe"));
    assert!(says(&project, "user/fc-generated", "get_level"));

    // The output is up to date for that audience only, and the project's own files are unchanged.
    let check = |audience: &str| {
        let check = ["generate", "--check", "--for", audience, "--out", "user"];
        project.fc(&check)
    };
    check("user_app").expect(0);
    let run = check("tester_app").expect(1);
    let fix = "run `fcproto generate --for tester_app --out user`";
    assert!(run.stderr.contains(fix), "{run:#?}");
    project.fc(&["generate", "--check"]).expect(0);
    let after = project.files("");
    assert!(before.iter().all(|file| after.contains(file)));
}

#[test]
fn a_project_is_no_place_for_a_part() {
    let project = Project::new();
    project.fc(&["generate"]).expect(0);
    let before = project.files("");
    let run = project.fc(&["generate", "--for", "user_app"]).expect(2);
    assert!(run.stderr.contains("--out <DIR>"), "{run:#?}");
    project.write("other/fc.yaml", "targets: {}\n");
    for out in [".", "spec/..", "other"] {
        let run = project
            .fc(&["generate", "--for", "user_app", "--out", out])
            .expect(2);
        let message = format!("`{out}` is a project; name another directory with --out");
        assert!(run.stderr.contains(&message), "{run:#?}");
    }
    std::fs::remove_dir_all(project.path("other")).expect("removed");
    assert_eq!(project.files(""), before);
}

#[test]
fn unknown_audience_is_refused_with_the_known_ones() {
    let project = Project::new();
    let message =
        "there is no audience `usr`; the spec declares `user_app`, `service_app`, `tester_app`";
    let all: [&[&str]; 2] = [
        &["generate", "--for", "usr", "--out", "x"],
        &["inspect", "--for", "usr"],
    ];
    for args in all {
        let run = project.fc(args).expect(2);
        assert!(run.stderr.contains(message), "{run:#?}");
    }
    assert!(!project.path("x").exists());
    project.write("fc.yaml", "targets: { rust: { audience: usr } }\n");
    for args in [["check"], ["generate"]] {
        let run = project.fc(&args).expect(2);
        assert!(run.stderr.contains(message), "{run:#?}");
    }
}

#[test]
fn target_has_only_the_part_of_its_audience() {
    let project = Project::new();
    let targets = "  rust: { out: app, audience: user_app }\n  typescript: { out: all }\n";
    project.write("fc.yaml", &format!("targets:\n{targets}"));
    project.fc(&["generate"]).expect(0);
    assert!(!says(&project, "app", "probe"));
    assert!(says(&project, "all", "probe"));
    project.fc(&["generate", "--check"]).expect(0);
    let run = project.fc(&["inspect", "--for", "user_app"]).expect(0);
    assert!(!run.stdout.contains("\"probe\"") && run.stdout.contains("\"get_level\""));
}
