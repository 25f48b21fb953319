//! The crate depends on the model, the JSON and gzip of the runtime and a few libraries. It uses no generated code and
//! does no I/O.

use std::fs;
use std::path::Path;

const HERE: &str = env!("CARGO_MANIFEST_DIR");

#[test]
fn crate_depends_on_no_network_feature() {
    let manifest = fs::read_to_string(Path::new(HERE).join("Cargo.toml")).unwrap();
    let (_, behind) = manifest.split_once("\n[dependencies]\n").unwrap();
    let (dependencies, _) = behind.split_once("\n[").unwrap();
    let ours: Vec<&str> = dependencies
        .lines()
        .filter(|line| line.starts_with("fc-"))
        .collect();
    let runtime = r#"fc-runtime = { path = "../fc-runtime", version = "0.2.0", default-features = false, features = ["frames"] }"#;
    assert_eq!(ours, [runtime, "fc-spec.workspace = true"]);
}

#[test]
fn it_does_no_io() {
    let mut folders = vec![Path::new(HERE).join("src")];
    let mut files = 0;
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let source = fs::read_to_string(&path).unwrap();
            for module in ["std::fs", "std::io", "std::net", "std::process", "std::env"] {
                assert!(!source.contains(module), "{}: {module}", path.display());
            }
            files += 1;
        }
    }
    assert!(files > 10, "{files}");
}
