//! Tests the search for a project, and the changes of its files.

use fc_codegen::input::{FileChange, Input};
use fc_codegen::project::{Project, ProjectDirs, ProjectError};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Creates a directory with these files.
fn directory(files: &[(&str, &str)]) -> TempDir {
    let directory = tempfile::tempdir().expect("a directory");
    for (path, text) in files {
        write(directory.path(), path, text);
    }
    directory
}

fn write(root: &Path, path: &str, text: &str) {
    let path = root.join(path);
    fs::create_dir_all(path.parent().expect("a directory")).expect("created");
    fs::write(path, text).expect("written");
}

#[test]
fn project_above_a_directory_is_found() {
    let root = directory(&[("fc.yaml", "spec: protocol\n"), ("protocol/a/b.txt", "")]);
    let inside = root.path().join("protocol/a");
    let project = Project::find_from(&ProjectDirs::default(), &inside).expect("a project");
    assert_eq!(project.root, root.path());
    assert_eq!(project.spec, Path::new("protocol"));
}

#[test]
fn directory_without_a_project_is_an_error() {
    let root = directory(&[]);
    let found = Project::find_from(&ProjectDirs::default(), root.path());
    assert!(matches!(found, Err(ProjectError::NotFound { .. })));
    let named = ProjectDirs {
        root: Some(root.path().join("none")),
        spec: None,
    };
    let found = Project::find_from(&named, root.path());
    assert!(matches!(found, Err(ProjectError::NotADirectory(_))));
}

#[test]
fn invalid_settings_are_an_error() {
    let root = directory(&[("fc.yaml", "spec: [\n")]);
    let found = Project::find_from(&ProjectDirs::default(), root.path());
    assert!(matches!(found, Err(ProjectError::Targets(_))));
}

#[test]
fn spec_file_is_one_of_the_spec_directories() {
    let root = directory(&[("spec/protocol.yaml", "")]);
    let project = Project::find_from(&ProjectDirs::default(), root.path()).expect("a project");
    let path = |below: &str| root.path().join(below);
    for below in ["spec/types.yaml", "spec/commands/lamp.yaml"] {
        assert_eq!(project.spec_file(&path(below)), Some(below));
    }
    for below in ["spec/a/b.yaml", "spec/notes.md", "types.yaml"] {
        assert_eq!(project.spec_file(&path(below)), None, "{below}");
    }
}

#[test]
fn changed_files_are_listed_once() {
    let root = directory(&[
        ("spec/gone.yaml", "a: 1\n"),
        ("spec/kept.yaml", "a: 1\n"),
        ("spec/protocol.yaml", "a: 1\n"),
    ]);
    let read = || Input::read(root.path(), Path::new("spec"));
    let before = read();
    assert_eq!(before, read());
    fs::remove_file(root.path().join("spec/gone.yaml")).expect("removed");
    write(root.path(), "spec/protocol.yaml", "a: 2\n");
    write(root.path(), "fc.yaml", "spec: spec\n");
    let expected = [
        (FileChange::Added, "fc.yaml"),
        (FileChange::Modified, "spec/protocol.yaml"),
        (FileChange::Removed, "spec/gone.yaml"),
    ];
    assert_eq!(read().changes_since(&before), expected);
}
