//! The scripts of `conformance/sessions` against this runtime.
//!
//! They describe the required behaviour over time as data, for any implementation. A failure names the file, the
//! script, the step, and the expected and the actual result.

mod app;
mod errors;
mod patterns;
mod peer;
mod robot;
mod schemas;
mod script;
mod session;

use crate::tally::Tally;
use script::{Level, Script, folder, json_files};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// The scripts of a level, each with its file.
fn scripts(level: Level) -> Vec<(PathBuf, Script)> {
    let mut scripts = Vec::new();
    for (path, text) in json_files(&folder().join("sessions")) {
        let file: script::File = serde_json::from_str(&text)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert_eq!(file.format, 1, "{}", path.display());
        if file.level == level {
            scripts.extend(
                file.scripts
                    .into_iter()
                    .map(|script| (path.clone(), script)),
            );
        }
    }
    scripts
}

/// Returns the reason for each script that does not hold.
fn hold(level: Level, run: impl Fn(&Script) -> Result<(), script::Failure>) {
    let mut failures = Vec::new();
    let mut tally = Tally::of(match level {
        Level::Session => "session",
        Level::Peer => "peer",
    });
    let scripts = scripts(level);
    assert!(!scripts.is_empty());
    for (path, script) in &scripts {
        match script.check(level).and_then(|()| run(script)) {
            Ok(()) => tally.held(1),
            Err(why) => {
                let file = path.file_name().unwrap().to_string_lossy();
                let (name, demands) = (&script.name, &script.demands);
                failures.push(format!("{file}: {name}: {why}\n  {demands}"));
            }
        }
    }
    let (failed, all) = (failures.len(), scripts.len());
    assert!(
        failures.is_empty(),
        "{failed} of {all} scripts do not hold\n{}",
        failures.join("\n")
    );
}

#[fc_test::test]
fn every_session_script_holds() {
    hold(Level::Session, session::run);
}

#[fc_test::test]
fn every_peer_script_holds() {
    hold(Level::Peer, peer::run);
}

#[fc_test::test]
fn scripts_have_distinct_names_and_a_summary() {
    let all = [Level::Session, Level::Peer].map(scripts);
    let mut names = BTreeSet::new();
    for (path, script) in all.iter().flatten() {
        assert!(
            names.insert(&script.name),
            "{}: {} is there twice",
            path.display(),
            script.name
        );
        let one = script.demands.ends_with('.') && !script.demands.contains(['\n', '\t']);
        assert!(one, "{}: {}", path.display(), script.demands);
    }
    assert!(names.len() >= 60, "there are {} scripts", names.len());
}
