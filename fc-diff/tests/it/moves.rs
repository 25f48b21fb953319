//! Moves operations and types within the files without changing their meaning.

use crate::support::{base, model};
use fc_diff::diff;
use fc_spec::source::Sources;
use std::collections::BTreeSet;

const GROUP: &str = "spec/commands/lamp.yaml";
const TYPES: &str = "spec/types.yaml";

/// Returns the sources with a change in the file of the group.
fn with(sources: &Sources, change: impl Fn(&str) -> String) -> Sources {
    Sources::from_texts(sources.iter().map(|(_, file)| {
        let is_it = file.path == GROUP;
        let text = if is_it {
            change(&file.text)
        } else {
            file.text.clone()
        };
        (file.path.clone(), text)
    }))
}

#[test]
fn operations_in_another_order_say_the_same() {
    let base = base();
    let swapped = with(&base, |text| {
        let (head, rest) = text.split_once("  dim:\n").expect("a command");
        let (one, rest) = rest.split_once("  probe:\n").expect("another behind it");
        let (other, rest) = rest.split_once("reports:\n").expect("what comes then");
        let other = other.trim_end();
        format!("{head}  probe:\n{other}\n\n  dim:\n{one}reports:\n{rest}")
    });
    let [old, new] = [&base, &swapped].map(|it| model(it).expect("a spec"));
    let names = |it: &fc_spec::model::Model| {
        let names = it.operations.iter().map(|it| it.name.clone());
        names.collect::<Vec<_>>()
    };
    assert_ne!(names(&old), names(&new));
    let found = diff(&old, &new);
    let found: Vec<_> = found.iter().map(|it| it.message.en.as_str()).collect();
    assert_eq!(found, [""; 0]);
}

#[test]
fn moved_types_are_the_only_finding() {
    let base = base();
    let types = base.iter().find(|(_, file)| file.path == TYPES);
    let types = types.expect("types of no group").1.text.clone();
    let moved = with(&base, |text| format!("{text}\n{types}"));
    let files = moved.iter().filter(|(_, file)| file.path != TYPES);
    let moved = Sources::from_texts(files.map(|(_, file)| (file.path.clone(), file.text.clone())));
    let [old, new] = [&base, &moved].map(|it| model(it).expect("a spec"));
    for (old, new) in [(&old, &new), (&new, &old)] {
        let found = diff(old, new);
        let rules: BTreeSet<_> = found.iter().map(|it| it.rule.name).collect();
        assert_eq!(Vec::from_iter(rules), ["group-moved"]);
        let subjects: BTreeSet<_> = found.iter().map(|it| it.subject.as_str()).collect();
        let declared = old.types.iter().filter(|it| it.body_of.is_none());
        let declared: BTreeSet<_> = declared.map(|it| it.name.as_str()).collect();
        assert_eq!(subjects, declared);
    }
}
