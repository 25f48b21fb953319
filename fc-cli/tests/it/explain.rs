//! `fcproto explain`, `fcproto inspect`, `fcproto schema`.

use crate::support::Project;
use serde_json::Value;

#[test]
fn every_listed_code_can_be_explained() {
    let project = Project::empty();
    let list = project.fc(&["explain"]).expect(0).stdout;
    assert!(list.lines().count() > 20);
    for line in list.lines() {
        let (code, title) = line.split_once("  ").expect("a code and its title");
        let text = project.fc(&["explain", code]).expect(0).stdout;
        assert!(text.starts_with(&format!("{code}: {title}\n\n")), "{text}");
        // An error has examples. A rule of `fcproto diff` has its effect on the wire, a rule of `fcproto lint` its
        // default level.
        let has_examples = text.contains(" bad\n") && text.contains(" good\n");
        let is_of_diff = text.contains("\n- Wire: ");
        assert!(
            has_examples || is_of_diff || text.contains("by default `"),
            "{text}"
        );
    }
}

#[test]
fn codes_may_be_abbreviated() {
    let project = Project::empty();
    let full = project.fc(&["explain", "FC0012"]).expect(0).stdout;
    assert_eq!(project.fc(&["explain", "fc12"]).expect(0).stdout, full);
    assert_eq!(project.fc(&["explain", "12"]).expect(0).stdout, full);
}

#[test]
fn an_unknown_code_has_a_neighbor() {
    let project = Project::empty();
    let run = project.fc(&["explain", "FC0O12"]).expect(2);
    assert!(run.stderr.contains("did you mean `FC0012`?"), "{run:#?}");
    let run = project.fc(&["explain", "hello"]).expect(2);
    assert!(
        run.stderr.contains("`fcproto explain` lists them all"),
        "{run:#?}"
    );
}

#[test]
fn the_model_is_json() {
    let run = Project::new()
        .fc(&["inspect", "--format", "json"])
        .expect(0);
    let model: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert!(
        model["operations"]
            .as_array()
            .is_some_and(|list| list.len() > 2)
    );

    let project = Project::new();
    project.append("spec/types.yaml", "x: [\n");
    let run = project.fc(&["inspect"]).expect(1);
    assert_eq!(run.stdout, "");
}

#[test]
fn the_schema_is_json() {
    for of in ["spec", "project", "dump"] {
        let run = Project::empty().fc(&["schema", of]).expect(0);
        let schema: Value = serde_json::from_str(&run.stdout).expect("JSON");
        assert!(schema["$schema"].is_string());
    }
}
