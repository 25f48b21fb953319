//! Tests protocols that share nothing with the real one: `meter/spec` (little-endian, CRC-32, ids of 16 bits, no
//! compression) and `beacon/spec` (no envelope, no digest). Their Rust crates compile, talk over TCP and pass the
//! vectors. Tests of `fc-reflect`, the TypeScript package and `fc-codegen` check the vectors there, and the output of
//! the dump.

use crate::support;
use crate::support::nested;
use fc_codegen::emit::generate;
use fc_codegen::output::plan;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_spec::model::{Dump, Model};
use std::fs;
use std::path::Path;

fn model(name: &str) -> Model {
    support::model(&support::root().join("fc-generated/tests").join(name))
}

/// Generates a crate of the protocol with its vectors, and runs its tests.
fn compiles_and_talks(name: &str) {
    made_for(name, name, &Targets::of([Product::Rust]), "own.rs");
}

/// Generates a crate called `project` of the protocol for these targets, with its vectors. Runs its tests, including
/// the file `own`.
fn made_for(name: &str, project: &str, targets: &Targets, own: &str) {
    let tests = support::root().join("fc-generated/tests");
    let model = model(name);
    let project = Path::new(env!("CARGO_TARGET_TMPDIR")).join(project);
    let own = tests.join(name).join(own);
    let own = [&*tests.join("it/support/talk.rs"), &own];
    nested::write_crate_for(&project, &model, targets, &own);
    let vectors = project.join("fc-generated/vectors");
    fs::create_dir_all(&vectors).unwrap();
    for file in fs::read_dir(tests.join(name).join("vectors")).unwrap() {
        let file = file.unwrap();
        fs::copy(file.path(), vectors.join(file.file_name())).unwrap();
    }
    nested::cargo(&project, &["test", "--tests"]);
    nested::cargo(&project, &["check", "--no-default-features"]);
    nested::cargo(&project, &["doc", "--no-deps"]);
}

#[test]
#[ignore = "compiles a crate of its own"]
fn little_endian_protocol_with_crc_32_works() {
    compiles_and_talks("meter");
}

/// With id types, the crate sends the same bytes as in the vectors, and the samples of the docs compile.
#[test]
#[ignore = "compiles a crate of its own"]
fn protocol_with_id_types_works() {
    let targets = Targets::of([Product::Rust]).with_newtypes();
    made_for("meter", "meter-ids", &targets, "ids.rs");
}

#[test]
#[ignore = "compiles a crate of its own"]
fn protocol_without_envelope_and_digest_works() {
    compiles_and_talks("beacon");
}

/// The tests of the TypeScript package read the committed files, so these must be up to date.
#[test]
fn committed_packages_match_their_specs() {
    for name in ["meter", "beacon"] {
        let root = support::root().join("fc-generated/tests").join(name);
        let targets = Targets::read(&fs::read_to_string(root.join("fc.yaml")).unwrap()).unwrap();
        let plan = plan(generate(&model(name), &targets).unwrap(), &root, &[]).unwrap();
        let fix = "run `cargo run -p fc-cli -- generate --root fc-generated/tests/";
        assert!(plan.is_fresh(), "{fix}{name}`");
    }
}

/// Each audience of the meter has a complete protocol. Its crate compiles and has nothing of the other audience.
#[test]
#[ignore = "compiles a crate of its own"]
fn package_of_an_audience_has_only_its_part() {
    let whole = model("meter");
    for (audience, names) in [("resident_app", [false; 3]), ("installer_app", [true; 3])] {
        let part = whole.for_audience(audience).unwrap();
        let read = Dump::read(&fc_codegen::inspect::json(&part)).unwrap();
        let targets = Targets::default();
        let artifacts = generate(&part, &targets).unwrap();
        assert!(
            artifacts == generate(&read, &targets).unwrap(),
            "{audience}"
        );
        let made = |name: &str| {
            let protocol = ["rust", "typescript", "vectors"];
            let mut files = artifacts.iter();
            files.any(|it| protocol.contains(&&*it.target) && it.contents.contains(name))
        };
        // An operation, a key and a value of an enum.
        assert_eq!(
            ["close_switch", "pub keep:", "stuck"].map(made),
            names,
            "{audience}"
        );
        assert!(made("set_tariff") && made("switch_moved"), "{audience}");

        let project = Path::new(env!("CARGO_TARGET_TMPDIR")).join(audience);
        nested::write_crate(&project, &part, &[]);
        nested::cargo(&project, &["check", "--tests"]);
    }
}

/// Words of the real protocol must not appear in the output of another.
#[test]
fn other_protocols_have_no_part_of_the_real_one() {
    let words = ["MD5", "md5", "gzip", "cmdTime", "\"resultCode\"", "0xFC"];
    for name in ["meter", "beacon"] {
        for artifact in generate(&model(name), &Targets::default()).unwrap() {
            // These files describe the language, not the spec. A dissector contains its runtime, which is for all
            // protocols.
            let of_all_protocols = ["errors.md", "language.md", "schema.json", ".lua"];
            if (of_all_protocols.iter()).any(|name| artifact.path.ends_with(name)) {
                continue;
            }
            for word in words {
                let found = artifact.contents.lines().find(|line| line.contains(word));
                assert_eq!(found, None, "{name}: {}", artifact.path);
            }
        }
    }
}
