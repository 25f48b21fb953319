//! The projects of the guide "Use it in your project", built outside the workspace as users build them. They need only
//! the lines of their `Cargo.toml`, and do what the guide describes.

use crate::support::nested;
use crate::support::programs::Running;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The serial number that the robot of the guide returns.
const NUMBER: &str = "100132007654321";

/// Each project, the name of its program, and `true` if it depends on tokio.
const PROJECTS: [(&str, &str, bool); 4] = [
    ("app", "my-app", true),
    ("robot", "my-robot", true),
    ("codec", "my-codec", false),
    ("blocking", "my-tool", true),
];

/// Builds a project in a separate folder. Returns the path of its program.
fn build(folder: &Path, name: &str, program: &str, has_tokio: bool) -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let from = here.join("tests/projects").join(name);
    let project = folder.join(name);
    fs::create_dir_all(project.join("src")).unwrap();
    fs::copy(from.join("main.rs"), project.join("src/main.rs")).unwrap();
    let manifest = fs::read_to_string(from.join("Cargo.toml")).unwrap();
    let path = "path = \"../protocol/fc-generated\"";
    assert!(manifest.contains(path), "{name}: {manifest}");
    let manifest = manifest.replace(path, &format!("path = {:?}", here.to_string_lossy()));
    let rest = "\n[workspace]\n\n[lints.rust]\nwarnings = \"deny\"\n";
    fs::write(project.join("Cargo.toml"), manifest + rest).unwrap();
    // The versions of the workspace, so that cargo downloads nothing.
    fs::copy(here.join("../Cargo.lock"), project.join("Cargo.lock")).unwrap();

    let target = nested::target();
    let cargo = |arguments: &[&str]| {
        let output = nested::command()
            .args(arguments)
            .arg("--offline")
            .current_dir(&project)
            .env("CARGO_TARGET_DIR", &target)
            .output()
            .unwrap();
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{name}: {errors}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    cargo(&["build"]);
    let tree = cargo(&["tree", "--edges", "normal", "--prefix", "none"]);
    let holds_tokio = tree.lines().any(|line| line.starts_with("tokio v"));
    assert_eq!(holds_tokio, has_tokio, "{name}: {tree}");
    target
        .join("debug")
        .join(format!("{program}{}", std::env::consts::EXE_SUFFIX))
}

fn output(program: &Path, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {errors}", program.display());
    String::from_utf8(output.stdout).unwrap()
}

#[test]
#[ignore = "compiles projects of its own"]
fn the_projects_of_the_guide_build_and_work() {
    let folder = tempfile::tempdir().unwrap();
    let [app, robot, codec, blocking] =
        PROJECTS.map(|(name, program, has_tokio)| build(folder.path(), name, program, has_tokio));

    let shown = output(&codec, &[]);
    assert!(shown.contains("GetRobotSnRequest"), "{shown}");

    let mut robot = Running::start(&robot, &["0"]);
    let address = robot.line();
    let (_, port) = address.rsplit_once(':').expect("an address");
    for program in [app, blocking] {
        assert_eq!(output(&program, &[port]).trim(), NUMBER);
    }
}
