//! `fcproto package`. `.ci/use` installs the packages of this repository.

use serde_json::{Value, json};

use crate::support::{Project, Run, command};

/// Creates a project with a crate whose generated files are up to date.
fn with_crate() -> Project {
    let project = Project::new();
    project.write("fc.yaml", "targets: { rust: { out: lamp } }\n");
    project.write(
        "lamp/Cargo.toml",
        "[package]\nname = \"lamp\"\nversion = \"1.2.3\"\nedition = \"2024\"\ninclude = [\"/src\"]\n\n[workspace]\n",
    );
    project.fc(&["generate"]).expect(0);
    project
}

fn pack(project: &Project) -> Run {
    project.fc(&["package", "--out", "dist"])
}

/// Returns the listed files except the sources of the crate.
fn listed(project: &Project) -> Vec<String> {
    let sums = project.read("dist/SHA256SUMS");
    let paths = sums.lines().filter_map(|line| line.split_once("  "));
    let paths = paths.map(|(sum, path)| {
        assert_eq!(sum.len(), 64, "{sum}");
        assert!(project.path("dist").join(path).is_file(), "{path}");
        path.to_owned()
    });
    paths.filter(|path| !path.contains("/src/")).collect()
}

#[test]
fn version_follows_the_release_of_the_spec() {
    let project = with_crate();
    let run = pack(&project).expect(0);
    let draft = run
        .stdout
        .lines()
        .find_map(|line| line.strip_prefix("packed rust "));
    let draft = draft.expect("the version");
    let digits = draft.strip_prefix("1.2.3-dev.x").expect("a pre-release");
    assert!(
        digits.len() == 12 && digits.bytes().all(|it| it.is_ascii_hexdigit()),
        "{draft}"
    );
    let files = |version: &str| {
        let vendored = |file: &str| format!("rust/vendor/lamp-{version}/{file}");
        vec![
            format!("rust/lamp-{version}.crate"),
            "rust/sbom.cdx.json".to_owned(),
            vendored(".cargo-checksum.json"),
            vendored("Cargo.toml"),
            vendored("Cargo.toml.orig"),
        ]
    };
    let mut expected = files(draft);
    assert_eq!(listed(&project), expected);

    project.write("dist/rust/vendor/note.txt", "");
    project
        .fc(&["release", "7.01", "--today", "2026-09-01"])
        .expect(0);
    project.fc(&["generate"]).expect(0);
    pack(&project).expect(0);
    expected = files("1.2.3+7.1");
    assert_eq!(listed(&project), expected);
    let old = project.path(&format!("dist/rust/vendor/lamp-{draft}"));
    assert!(!old.exists(), "the files of the last run are replaced");
    assert!(project.path("dist/rust/vendor/note.txt").is_file());

    // A changed comment keeps the release number, and a changed text does not.
    let path = "spec/protocol.yaml";
    let text = project.read(path);
    project.write(path, &format!("# A comment.\n{text}"));
    project.fc(&["generate"]).expect(0);
    let run = pack(&project).expect(0);
    assert!(run.stdout.contains("packed rust 1.2.3+7.1\n"), "{run:#?}");
    assert!(text.contains("  en: "), "{text}");
    project.write(path, &text.replacen("  en: ", "  en: Other ", 1));
    project.fc(&["generate"]).expect(0);
    let run = pack(&project).expect(0);
    assert!(run.stdout.contains("packed rust 1.2.3-dev.x"), "{run:#?}");
}

#[test]
fn created_project_is_packed_with_its_runtime() {
    let project = Project::empty();
    project.fc(&["init", "lamp"]).expect(0);
    let run = project
        .fc_in("lamp", &["package", "--out", "dist", "rust"])
        .expect(0);
    for name in ["fc-derive", "fc-runtime", "lamp-protocol"] {
        assert!(
            run.stdout.contains(&format!("  rust/{name}-0.")),
            "{run:#?}"
        );
    }
}

#[test]
fn sbom_lists_all_direct_dependencies() {
    let project = with_crate();
    let manifest = project.read("lamp/Cargo.toml");
    let manifest = manifest.replace(
        "[workspace]",
        "license = \"MIT\"\n\n[dependencies]\ntick = { path = \"../tick\", version = \"0.3\" }\nserde = { version = \"1\", optional = true }\n\n\
         [dev-dependencies]\nproptest = \"1\"\n\n[workspace]",
    );
    project.write("lamp/Cargo.toml", &manifest);
    project.write(
        "tick/Cargo.toml",
        "[package]\nname = \"tick\"\nversion = \"0.3.1\"\nedition = \"2024\"\n\n[dependencies]\n\
         serde = \"1\"\ntokio = { version = \"1.5\", optional = true }\n\n[workspace]\n",
    );
    project.write("tick/src/lib.rs", "");
    project
        .fc(&["release", "7.01", "--today", "2026-09-01"])
        .expect(0);
    project.fc(&["generate"]).expect(0);
    pack(&project).expect(0);
    let bill: Value = serde_json::from_str(&project.read("dist/rust/sbom.cdx.json")).expect("JSON");
    let lamp = "pkg:cargo/lamp@1.2.3%2B7.1";
    let main = json!({
        "type": "library",
        "bom-ref": lamp,
        "name": "lamp",
        "version": "1.2.3+7.1",
        "licenses": [{ "expression": "MIT" }],
        "purl": lamp,
    });
    assert_eq!(bill["metadata"]["component"], main);
    let requirement = |value: &str| json!([{ "name": "fcproto:requirement", "value": value }]);
    // `serde` is not optional, because one of the two crates requires it.
    let others = json!([
        {
            "type": "library",
            "bom-ref": "pkg:cargo/serde",
            "name": "serde",
            "purl": "pkg:cargo/serde",
            "properties": requirement("^1"),
        },
        {
            "type": "library",
            "bom-ref": "pkg:cargo/tick@0.3.1",
            "name": "tick",
            "version": "0.3.1",
            "purl": "pkg:cargo/tick@0.3.1",
        },
        {
            "type": "library",
            "bom-ref": "pkg:cargo/tokio",
            "name": "tokio",
            "scope": "optional",
            "purl": "pkg:cargo/tokio",
            "properties": requirement("^1.5"),
        },
    ]);
    assert_eq!(bill["components"], others);
    let edges = json!([
        { "ref": lamp, "dependsOn": ["pkg:cargo/serde", "pkg:cargo/tick@0.3.1"] },
        { "ref": "pkg:cargo/tick@0.3.1", "dependsOn": ["pkg:cargo/serde", "pkg:cargo/tokio"] },
    ]);
    assert_eq!(bill["dependencies"], edges);
}

#[test]
fn stale_files_are_not_packed() {
    let project = with_crate();
    project.append("lamp/src/lib.rs", "// Mine.\n");
    let run = pack(&project).expect(1);
    assert!(run.stderr.contains("run `fcproto generate"), "{run:#?}");
    assert!(!project.path("dist").exists());
}

#[test]
fn failed_language_does_not_stop_the_others() {
    let project = with_crate();
    project.write(
        "fc.yaml",
        "targets:\n  rust: { out: lamp }\n  typescript: { out: web/lamp }\n  cpp: { out: native }\n",
    );
    project.write("native/CMakeLists.txt", "");
    project.fc(&["generate"]).expect(0);
    let run = pack(&project).expect(1);
    assert!(run.stdout.contains("packed rust 1.2.3-dev.x"), "{run:#?}");
    let bare = "error: typescript: `web/lamp` has only generated sources, because no `package.json` is there";
    assert!(run.stderr.contains(bare), "{run:#?}");

    let run = project
        .fc(&["package", "--out", "dist", "typescript"])
        .expect(1);
    assert!(!run.stdout.contains("packed rust"), "{run:#?}");
    let run = project
        .fc(&["package", "--out", "dist", "kotlin"])
        .expect(2);
    assert!(run.stderr.contains("no target `kotlin`"), "{run:#?}");

    // Without any tool, each language reports the tool that it needs.
    let mut bare = command(&["package", "--out", "dist", "rust", "cpp"]);
    let bare = bare.current_dir(project.path("")).env("PATH", "/nowhere");
    let run = Run::new(&bare.output().expect("the command can be run")).expect(1);
    for missing in [
        "error: rust: `cargo` is not installed; get it with https://rustup.rs\n",
        "error: cpp: `cmake` is not installed; get it with apt install cmake g++\n",
    ] {
        assert!(run.stderr.contains(missing), "{run:#?}");
    }
}

#[test]
fn number_of_a_package_is_numbers_with_dots() {
    let project = with_crate();
    let manifest = project.read("lamp/Cargo.toml");
    project.write("lamp/Cargo.toml", &manifest.replace("1.2.3", "1.2.3-rc.1"));
    let run = pack(&project).expect(1);
    assert!(run.stderr.contains("but it is `1.2.3-rc.1`"), "{run:#?}");
}
