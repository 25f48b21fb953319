//! The stubs of an operation without a code work as soon as it has one. The test assigns a code to every such operation
//! in a copy of the spec. It generates a crate from the copy and runs the round trips there.

use crate::support;
use crate::support::nested;
use fc_spec::model::{Kind, Model, RangeUse};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

#[test]
#[ignore = "compiles a crate of its own"]
fn operations_work_as_soon_as_they_have_a_code() {
    let project = Path::new(env!("CARGO_TARGET_TMPDIR")).join("assigned");
    let before = support::model(&support::root());
    let spec = project.join("spec");
    if spec.exists() {
        fs::remove_dir_all(&spec).unwrap();
    }
    support::copy(&support::root().join("spec"), &spec);
    let assigned = assign_codes(&before, &project);

    let model = support::model(&project);
    assert!(
        model
            .operations
            .iter()
            .all(|operation| operation.code.value.is_some())
    );
    let tests = support::root().join("fc-generated/tests/it/round_trip.rs");
    nested::write_crate(&project, &model, &[&tests]);
    let output = nested::cargo(&project, &["test", "--test", "round_trip"]);
    for (kind, name) in assigned {
        let module = if kind == Kind::Command {
            "command"
        } else {
            "report"
        };
        let line = format!("test {module}::{name} ... ok");
        assert!(output.contains(&line), "no `{line}` in\n{output}");
    }
}

/// Replaces each `unassigned` with a free code. Returns the commands and reports that got one.
fn assign_codes(model: &Model, project: &Path) -> Vec<(Kind, String)> {
    let mut taken: BTreeSet<u16> = model
        .operations
        .iter()
        .filter_map(|operation| operation.code.value)
        .chain(model.retired.iter().map(|retired| retired.code))
        .collect();
    let mut assigned = Vec::new();
    for operation in model
        .operations
        .iter()
        .filter(|operation| operation.code.value.is_none())
    {
        let usage = match operation.kind() {
            Kind::Report => RangeUse::Reports,
            Kind::Command | Kind::Stream => RangeUse::Commands,
        };
        let range = model
            .ranges
            .iter()
            .find(|range| range.usage == usage)
            .expect("a range");
        let code = (range.first..=range.last)
            .find(|code| !taken.contains(code))
            .expect("a code");
        taken.insert(code);

        let file = project.join(&operation.location.file);
        let text = fs::read_to_string(&file).unwrap();
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let own = lines.iter_mut().skip(operation.location.line - 1);
        let mut own = own.filter(|line| line.contains("code: unassigned"));
        let line = own.next().expect("the operation says that it has no code");
        let with_code = format!("code: {{ value: 0x{code:04X}, state: inferred }}");
        *line = line.replace("code: unassigned", &with_code);
        // A question about the code repeats its state, so both change together.
        for line in own_lines(&mut lines, operation.location.line) {
            *line = line.replace("code: open", "code: inferred");
        }
        fs::write(&file, lines.join("\n") + "\n").unwrap();
        if operation.kind() != Kind::Stream {
            assigned.push((operation.kind(), operation.name.clone()));
        }
    }
    assigned
}

/// Returns the lines of the operation that begins on this line, up to the next line with the same or less indentation.
fn own_lines(lines: &mut [String], first: usize) -> impl Iterator<Item = &mut String> {
    let depth = |line: &str| line.len() - line.trim_start().len();
    let own = lines.get(first - 1).map_or(0, |line| depth(line));
    let rest = lines.iter_mut().skip(first);
    rest.take_while(move |line| line.trim().is_empty() || depth(line) > own)
}
