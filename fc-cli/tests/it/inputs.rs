//! A file that cannot be read is an error, and the command changes nothing.

use crate::support::{Project, Run};
use std::path::Path;

/// Runs `init` in `lamp`.
fn lamp() -> Project {
    let place = Project::empty();
    place.fc(&["init", "lamp"]).expect(0);
    place
}

/// Kinds of unreadable files, each with a part of the message about it.
const KINDS: [(&str, &str); 6] = [
    ("link", "is a link to a file that cannot be read"),
    ("directory", "is a directory, not a file"),
    ("device", "is not a regular file"),
    ("pipe", "is not a regular file"),
    ("bytes", "is not UTF-8"),
    ("large", "is larger than "),
];

/// Replaces a file with an unreadable one.
fn spoil(path: &Path, kind: &str) {
    let _ = std::fs::remove_file(path);
    match kind {
        "link" => std::os::unix::fs::symlink("nowhere", path).expect("a link"),
        "directory" => std::fs::create_dir_all(path).expect("a directory"),
        "device" => std::os::unix::fs::symlink("/dev/zero", path).expect("a link"),
        "pipe" => {
            let made = std::process::Command::new("mkfifo").arg(path).status();
            assert!(made.is_ok_and(|made| made.success()));
        }
        "bytes" => std::fs::write(path, b"a: \xFF\n").expect("a file"),
        "large" => {
            let file = std::fs::File::create(path).expect("a file");
            file.set_len(300 << 20).expect("its length");
        }
        _ => panic!("{kind}"),
    }
}

/// Returns the paths of all files in the project except `fc.yaml`.
fn files(place: &Project) -> Vec<std::path::PathBuf> {
    let all = place.files("lamp").into_iter().map(|(path, _)| path);
    all.filter(|path| !path.ends_with("fc.yaml")).collect()
}

#[test]
fn unreadable_settings_are_an_error() {
    for (kind, message) in KINDS {
        let place = lamp();
        spoil(&place.path("lamp/fc.yaml"), kind);
        let before = files(&place);
        for command in ["generate", "check", "lint", "fmt", "inspect", "codes"] {
            let run = place.fc_in("lamp/spec", &[command]).expect(2);
            assert!(run.stderr.contains("fc.yaml` "), "{kind}: {run:#?}");
            assert!(run.stderr.contains(message), "{kind}: {run:#?}");
        }
        let run = place.fc_in("lamp", &["check", "--lang", "zh"]).expect(2);
        let letters = run.stderr.replace("fc.yaml", "").replace("UTF-8", "");
        let letters = letters.replace("MiB", "").replace("lamp", "");
        assert!(
            !letters.contains(|c: char| c.is_ascii_alphabetic()) || letters.contains('/'),
            "{run:#?}"
        );
        assert_eq!(files(&place), before, "{kind}");
    }
}

#[test]
fn unreadable_spec_parts_are_an_error() {
    for path in ["spec", "spec/commands"] {
        for kind in ["link", "device", "pipe", "bytes"] {
            let place = lamp();
            let disk = place.path("lamp").join(path);
            std::fs::rename(&disk, place.path("away")).expect("moved");
            spoil(&disk, kind);
            let run = place.fc_in("lamp", &["generate"]).expect(2);
            assert!(run.stderr.contains(path), "{path} {kind}: {run:#?}");
            assert!(place.path("lamp/src/lib.rs").is_file());
        }
    }
    for kind in KINDS
        .map(|(kind, _)| kind)
        .iter()
        .filter(|it| **it != "directory")
    {
        let place = lamp();
        spoil(&place.path("lamp/spec/commands/light.yaml"), kind);
        let run = place.fc_in("lamp", &["generate"]);
        assert_ne!(run.status, 0, "{kind}: {run:#?}");
        assert!(place.path("lamp/src/lib.rs").is_file());
    }
}

#[test]
fn unreadable_manifest_is_an_error() {
    for (kind, _) in KINDS.iter().filter(|(kind, _)| *kind != "large") {
        let place = lamp();
        spoil(&place.path("lamp/fc-manifest.json"), kind);
        for command in [
            &["generate"][..],
            &["generate", "--check"],
            &["git", "stage"],
        ] {
            let run = place.fc_in("lamp", command).expect(2);
            assert!(run.stderr.contains("fc-manifest.json"), "{kind}: {run:#?}");
        }
    }
}

#[test]
fn unreadable_releases_are_an_error() {
    let release = |place: &Project, number| place.fc_in("lamp", &["release", number]);
    for (kind, _) in KINDS {
        let place = lamp();
        release(&place, "1").expect(0);
        spoil(&place.path("lamp/spec/releases/1.json"), kind);
        for run in [release(&place, "2"), place.fc_in("lamp", &["diff"])] {
            let run = run.expect(2);
            assert!(run.stderr.contains('1'), "{kind}: {run:#?}");
        }
        let run = place.fc_in("lamp", &["generate", "--as-of", "1", "--out", "../out"]);
        run.expect(2);
    }
    for kind in ["link", "device", "pipe", "bytes"] {
        let place = lamp();
        release(&place, "1").expect(0);
        std::fs::remove_dir_all(place.path("lamp/spec/releases")).expect("removed");
        spoil(&place.path("lamp/spec/releases"), kind);
        release(&place, "2").expect(2);
    }
}

/// Sheets, bodies and dumps must be readable. Pipes are allowed here, because `<(…)` of a shell is one.
#[test]
fn unreadable_inputs_are_an_error() {
    for (kind, _) in KINDS.iter().filter(|(kind, _)| *kind != "pipe") {
        let place = lamp();
        spoil(&place.path("lamp/input"), kind);
        let run = |args: &[&str]| -> Run { place.fc_in("lamp", args).expect(2) };
        for run in [
            run(&["settle", "--from", "input"]),
            run(&["settle", "x.request", "--request", "input", "--by", "me"]),
            run(&["generate", "--from", "input", "--out", "../out"]),
            run(&["diff", "input"]),
        ] {
            assert!(run.stderr.contains("input"), "{kind}: {run:#?}");
        }
    }
}
