//! The READMEs as a user outside the workspace takes them: what they print of `Cargo.toml` and of Rust
//! compiles as it stands, with no other crate than those printed, and every guide is linked.

use crate::support::nested;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Each README, and where the guides in its language lie.
const READMES: [(&str, &str); 2] = [
    ("README.md", "docs-site/en/guides"),
    ("README.zh-CN.md", "docs-site/guides"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// What a README's fences of one language hold.
fn fences<'t>(text: &'t str, language: &str) -> Vec<&'t str> {
    let open = format!("\n```{language}\n");
    let parts = text.split(&open).skip(1);
    parts
        .map(|rest| rest.split("\n```\n").next().expect("a fence that closes"))
        .collect()
}

#[test]
#[ignore = "compiles projects of its own"]
fn what_the_readmes_print_compiles_for_a_user_outside() {
    for (name, _) in READMES {
        let text = fs::read_to_string(root().join(name)).unwrap();
        let manifests = fences(&text, "toml");
        let [manifest] = manifests.as_slice() else {
            unreachable!("{name} has one manifest");
        };
        let programs = fences(&text, "rust");
        assert!(programs.len() >= 2, "{name}: an app and a robot");
        assert!(
            !text.contains("```rust,"),
            "{name}: Rust that is not compiled"
        );

        compile(name, manifest, &programs);
    }
}

/// What the package says of itself on a registry, with the manifest that the whole prints.
#[test]
#[ignore = "compiles projects of its own"]
fn what_this_package_prints_compiles_for_a_user_outside() {
    let whole = fs::read_to_string(root().join("README.md")).unwrap();
    let name = "fc-generated/README.md";
    let text = fs::read_to_string(root().join(name)).unwrap();
    let programs = fences(&text, "rust");
    assert_eq!(programs.len(), 1, "{name}: an app");
    let manifests = fences(&whole, "toml");
    compile(name, manifests.first().expect("a manifest"), &programs);
}

/// Compiles programs as a package of their own, with that manifest.
fn compile(name: &str, manifest: &str, programs: &[&str]) {
    let project = tempfile::tempdir().unwrap();
    let here = root().join("fc-generated").canonicalize().unwrap();
    let path = "path = \"fc-generated\"";
    assert!(manifest.contains(path), "{name}: {manifest}");
    let manifest = manifest.replace(path, &format!("path = {:?}", here.to_string_lossy()));
    let package = "[package]\nname = \"user\"\nedition = \"2024\"\n\n[workspace]\n\n[lints.rust]\nwarnings = \"deny\"\n";
    fs::write(
        project.path().join("Cargo.toml"),
        [package, "\n", &manifest, "\n"].concat(),
    )
    .unwrap();
    // The versions that are there, so that nothing has to be fetched.
    fs::copy(root().join("Cargo.lock"), project.path().join("Cargo.lock")).unwrap();
    let sources = project.path().join("src/bin");
    fs::create_dir_all(&sources).unwrap();
    for (number, program) in programs.iter().enumerate() {
        fs::write(sources.join(format!("program_{number}.rs")), program).unwrap();
    }

    let output = Command::new(env!("CARGO"))
        .args(["check", "--offline"])
        .current_dir(project.path())
        .env("CARGO_TARGET_DIR", nested::target())
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{name}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn every_guide_is_linked() {
    for (name, guides) in READMES {
        let text = fs::read_to_string(root().join(name)).unwrap();
        for guide in fs::read_dir(root().join(guides)).unwrap() {
            let guide = guide.unwrap().file_name().into_string().unwrap();
            if Path::new(&guide).extension().is_some_and(|end| end == "md") {
                let link = format!("]({guides}/{guide})");
                assert!(text.contains(&link), "{name}: {link}");
            }
        }
    }
}
