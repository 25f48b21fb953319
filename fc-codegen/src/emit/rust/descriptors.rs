//! `descriptors.rs`: every operation as data, for tools that work without its types.
//!
//! The file also contains macros that expand once for each operation.

use super::context::{Context, message, page_of};
use super::literal::literal;
use super::operation_macros;
use super::source::Source;
use crate::package::docs::Docs;
use crate::package::language::Case;
use fc_spec::model::{AcceptedIn, Cadence, Direction, Kind, Model, Operation, StateSet, Value};
use std::fmt::Display;

/// The four tables: name, kind, and the comment in Chinese and in English.
const TABLES: [(&str, Option<Kind>, &str, &str); 4] = [
    ("OPERATIONS", None, "全部操作。", "Every operation."),
    (
        "COMMANDS",
        Some(Kind::Command),
        "全部指令。",
        "Every command.",
    ),
    (
        "REPORTS",
        Some(Kind::Report),
        "全部主动上报。",
        "Every report.",
    ),
    (
        "STREAMS",
        Some(Kind::Stream),
        "全部数据流。",
        "Every stream.",
    ),
];

/// Generates `descriptors.rs`.
pub fn descriptors_file(context: &Context<'_>) -> String {
    let model = context.model();
    let mut out = context.source();
    out.template("descriptors", &[]);
    for (name, kind, zh, en) in TABLES {
        let rows = model.operations.iter();
        let rows = rows.filter(|operation| kind.is_none_or(|kind| kind == operation.kind()));
        out.documented(&Docs::said([zh, en]));
        let constants: Vec<String> = rows
            .map(|operation| format!("operation::{}", constant(operation)))
            .collect();
        out.list(
            &format!("pub const {name}: &[OperationInfo] = &["),
            &constants,
            "];",
        );
    }
    if !model.operations.is_empty() {
        out.blank();
        out.line("/// One constant per operation. The module keeps their names apart from those of the tables.");
        out.block("mod operation", |out| {
            let mut operations = model.operations.iter();
            if operations.any(|it| it.bodies().next().is_some()) {
                out.import("crate", &["messages"]);
            }
            out.import("fc_runtime", &runtime_names(model));
            for operation in &model.operations {
                out.blank();
                descriptor(out, context, operation);
            }
        });
    }
    operation_macros::macros(&mut out, context);
    out.finish()
}

fn runtime_names(model: &Model) -> Vec<&'static str> {
    let mut names = vec!["BodyInfo", "OperationInfo", "OperationKind"];
    let any = |has: fn(&Operation) -> bool| model.operations.iter().any(has);
    names.extend(any(|it| it.effect().is_some()).then_some("Effect"));
    if any(|it| it.accepted().is_some()) {
        names.extend(["AcceptedStates", "Preconditions"]);
    }
    let mut accepted = model.operations.iter().filter_map(Operation::accepted);
    if accepted.any(|accepted| !accepted.state_sets().is_empty()) {
        names.push("States");
    }
    names.extend(any(|it| it.cadence().is_some()).then_some("Cadence"));
    if any(|it| Direction::ALL.iter().any(|side| it.body(*side).is_none())) {
        names.push("Empty");
    }
    names
}

fn constant(operation: &Operation) -> String {
    operation.name.to_uppercase()
}

fn descriptor(out: &mut Source, context: &Context<'_>, operation: &Operation) {
    let kind = Case::Pascal.apply(operation.kind().name());
    let code = operation.code.value.map(|_| &operation.code.spelling);
    let effect = operation.effect();
    let effect = effect.map(|it| format!("Effect::{}", Case::Pascal.apply(it.name())));
    out.enclose(
        &format!(
            "pub(super) const {}: OperationInfo = OperationInfo {{",
            constant(operation)
        ),
        "};",
        |out| {
            for (field, value) in [
                ("name", literal(&operation.name)),
                ("code", option(code)),
                ("kind", format!("OperationKind::{kind}")),
                ("effect", option(effect)),
            ] {
                out.line([field, ": ", &value, ","].concat());
            }
            preconditions(out, operation);
            for (field, value) in [
                ("cadence", option(operation.cadence().map(cadence))),
                ("zh", literal(&operation.title.zh)),
                ("en", literal(&operation.title.en)),
                ("since", option(operation.since.as_deref().map(literal))),
                ("deprecated", operation.deprecated.is_some().to_string()),
                ("docs", literal(&page_of(operation))),
                ("spec", literal(&operation.location.file)),
                ("request", body(context, operation, Direction::Request)),
                ("response", body(context, operation, Direction::Response)),
            ] {
                out.line([field, ": ", &value, ","].concat());
            }
        },
    );
}

fn preconditions(out: &mut Source, operation: &Operation) {
    let Some(accepted) = operation.accepted() else {
        out.line("preconditions: None,");
        return;
    };
    out.enclose("preconditions: Some(Preconditions {", "}),", |out| {
        match &accepted.states {
            None => out.line("states: AcceptedStates::Unsaid,"),
            Some(AcceptedIn::Any) => out.line("states: AcceptedStates::Any,"),
            Some(AcceptedIn::States(sets)) => match sets.as_slice() {
                [set] => {
                    let open = "states: AcceptedStates::Only(&[States {";
                    out.enclose(open, "}]),", |out| states(out, set));
                }
                sets => out.enclose("states: AcceptedStates::Only(&[", "]),", |out| {
                    for set in sets {
                        out.enclose("States {", "},", |out| states(out, set));
                    }
                }),
            },
        }
        let after: Vec<String> = accepted.after.iter().map(|name| literal(name)).collect();
        out.array("after: &[", &after, "],");
    });
}

fn states(out: &mut Source, set: &StateSet) {
    out.line(format!("of: {},", literal(set.ty.name())));
    let values = set.values.iter().map(Value::from);
    let values: Vec<String> = values.map(|it| literal(&it.to_string())).collect();
    out.array("values: &[", &values, "],");
}

/// Returns an `Option`.
fn option(value: Option<impl Display>) -> String {
    value.map_or_else(|| "None".to_owned(), |value| format!("Some({value})"))
}

fn cadence(cadence: &Cadence) -> String {
    match cadence {
        Cadence::OnChange(field) => format!("Cadence::OnChange({})", literal(field)),
        Cadence::Step(step) => {
            let (field, by) = (literal(&step.field), step.by.to_f64());
            format!("Cadence::step({field}, {by:?})")
        }
        Cadence::EveryMs(ms) => format!("Cadence::every_ms({ms})"),
        Cadence::WithinMs(ms) => format!("Cadence::within_ms({ms})"),
    }
}

fn body(context: &Context<'_>, operation: &Operation, direction: Direction) -> String {
    let ty = operation.body(direction).map_or_else(
        || "Empty".to_owned(),
        |body| message(context.package.item(&body.ty)),
    );
    format!("BodyInfo::of::<{ty}>()")
}
