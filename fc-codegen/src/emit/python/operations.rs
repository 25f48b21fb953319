//! Commands, reports and streams as values, with their facts from the spec.

use super::literal::{boolean, constant as constant_of, literal};
use super::modules::{GroupPart, NamedGroup};
use super::protocol;
use super::source::{Code, Python, tuple};
use crate::package::context::{Context, page_of};
use crate::package::docs::Docs;
use crate::package::joined::Joined;
use crate::package::language::Case;
use crate::package::name::free;
use crate::package::process::{set_off, state};
use crate::package::source::Source;
use fc_spec::model::{
    Accepted, AcceptedIn, Ack, Cadence, Direction, Exchange, Kind, Operation, Side, StateSet,
    StructRef, Type, Value,
};

/// Writes the operations of these groups as values. Reports come first, because commands refer to them.
pub fn values(out: &mut Source, context: &Context<'_>, groups: &[&NamedGroup<'_, '_>]) {
    out.gap();
    for kind in KINDS {
        let operations = groups.iter().flat_map(|group| &group.operations);
        for operation in operations.filter(|it| it.kind() == kind) {
            let before = format!("{}: Final = ", constant(context, operation));
            out.blank();
            value(context, operation).write(out, &before, "");
            out.docstring(&Docs::titled(&operation.title));
        }
    }
    for group in groups {
        for kind in KINDS {
            let Some(name) = group.part(GroupPart::All(kind)) else {
                continue;
            };
            let operations = group.operations.iter().filter(|it| it.kind() == kind);
            let operations: Vec<String> = operations.map(|it| constant(context, it)).collect();
            out.blank();
            tuple(out, &format!("{name}: Final = "), &operations, "");
        }
    }
}

/// The kinds of operations, in the order of a file.
const KINDS: [Kind; 3] = [Kind::Report, Kind::Command, Kind::Stream];

/// Returns the name of an operation's value.
///
/// The name gets the kind as a suffix if a type, the protocol or an import of the file has the same name.
pub fn constant(context: &Context<'_>, operation: &Operation) -> String {
    let screaming = |operation: &Operation| Case::Screaming.apply(&operation.name).into_owned();
    let name = screaming(operation);
    let longer = format!("{name}_{}", Case::Screaming.apply(operation.kind().name()));
    let protocol = protocol::name(context);
    free(&[&name, &longer], |wish| {
        let mut others = context.model().operations.iter();
        context.package.has_type(wish)
            || wish == protocol
            || wish == "ABC"
            || (wish != name && others.any(|it| screaming(it) == wish))
    })
}

/// Converts to seconds.
pub fn seconds(ms: u32) -> String {
    format!("{:?}", f64::from(ms) / 1000.0)
}

/// Returns the timeout and the retries of an acknowledgement.
pub fn ack(ack: Ack) -> Code {
    let timeout = format!("timeout={}", seconds(ack.timeout_ms));
    let retries = format!("retries={}", ack.retries);
    Code::call("rt.AckPolicy", [timeout, retries])
}

fn value(context: &Context<'_>, operation: &Operation) -> Code {
    let code = match operation.code.value {
        Some(_) => operation.code.spelling.clone(),
        None => "None".to_owned(),
    };
    let mut items = Vec::new();
    let mut set = |name: &str, value: Code| items.push(Code::named(name, value));
    set("name", literal(&operation.name).into());
    set("code", code.into());
    set("zh", literal(&operation.title.zh).into());
    set("en", literal(&operation.title.en).into());
    if let Some(messages) = operation.messages() {
        set("request", context.name_of(&messages.request.ty).into());
        set("response", context.name_of(&messages.response.ty).into());
    }
    let word = match &operation.exchange {
        Exchange::Command {
            effect, accepted, ..
        } => {
            let effect = Case::Screaming.apply(effect.name());
            set("effect", format!("rt.Effect.{effect}").into());
            if let Some(accepted) = accepted {
                set("preconditions", preconditions(context, accepted));
            }
            if let Some(error) = context.package.error_type(operation) {
                set("errors", error.into());
            }
            let reports = sets_off(context, operation);
            if !reports.is_empty() {
                set("sets_off", Code::tuple(reports));
            }
            "rt.Command"
        }
        Exchange::Report {
            ack: policy,
            cadence,
            failures,
            messages,
            ..
        } => {
            if *policy != context.model().calls.ack {
                set("ack", ack(*policy));
            }
            if let Some(cadence) = cadence {
                set("cadence", self::cadence(cadence));
            }
            let body = &messages.request.ty;
            if let Some((keys, ..)) = state(context, operation) {
                set("state", way(context, body, keys));
            }
            if !failures.is_empty() {
                let failures = failures.iter().map(|keys| way(context, body, keys));
                set("failures", Code::tuple(failures.collect()));
            }
            "rt.Report"
        }
        Exchange::Stream(stream) => {
            let body = context.content(operation).unwrap_or("bytes");
            set("body", body.into());
            set(
                "from_robot",
                boolean(operation.sender == Side::Robot).into(),
            );
            for (name, said) in [
                ("content", stream.content.media_type()),
                ("started_by", stream.started_by.as_deref()),
                ("stopped_by", stream.stopped_by.as_deref()),
            ] {
                if let Some(said) = said {
                    set(name, literal(said).into());
                }
            }
            "rt.Stream"
        }
    };
    if let Some(since) = &operation.since {
        set("since", literal(since).into());
    }
    if operation.deprecated.is_some() {
        set("deprecated", "True".into());
    }
    set("docs", literal(&page_of(operation)).into());
    set("spec", literal(&operation.location.file).into());
    if let Some(call) = context.package.call(operation)
        && call.method != operation.name
    {
        set("method", literal(call.method).into());
    }
    Code::call(word, items)
}

fn preconditions(context: &Context<'_>, accepted: &Accepted) -> Code {
    let mut items = Vec::new();
    match &accepted.states {
        None => {}
        Some(AcceptedIn::Any) => items.push(Code::named("any_state", "True")),
        Some(AcceptedIn::States(sets)) => {
            let sets = sets.iter().map(|set| states(context, set));
            items.push(Code::named("states", Code::tuple(sets.collect())));
        }
    }
    if !accepted.after.is_empty() {
        let names = accepted.after.iter().map(|name| literal(name).into());
        items.push(Code::named("after", Code::tuple(names.collect())));
    }
    Code::call("rt.Preconditions", items)
}

fn states(context: &Context<'_>, set: &StateSet) -> Code {
    let ty = Type::Named(set.ty.clone());
    let values = set.values.iter().map(|wire| {
        let value = context.package.value(&ty, &Value::from(wire));
        constant_of(&value)
    });
    let values = Code::List("{", values.collect(), "}");
    let values = Code::call("frozenset", [values]);
    let of = context.name_of(&set.ty).into();
    Code::call("rt.States", [of, values])
}

fn sets_off(context: &Context<'_>, command: &Operation) -> Vec<Code> {
    let Some(messages) = command.messages() else {
        return Vec::new();
    };
    let reports = set_off(context, command).map(|(set_off, report, theirs)| {
        let ties = set_off.tied.iter().map(|tie| {
            let of_response = boolean(tie.side == Direction::Response);
            let ours = way(context, &messages.body(tie.side).ty, &tie.command);
            let items = vec![
                Code::named("of_response", of_response),
                Code::named("command", ours),
                Code::named("report", way(context, &theirs.request.ty, &tie.report)),
            ];
            Code::call("rt.Tie", items)
        });
        let ties: Vec<Code> = ties.collect();
        let mut items = vec![Code::named("report", constant(context, report))];
        if !ties.is_empty() {
            items.push(Code::named("ties", Code::tuple(ties)));
        }
        Code::call("rt.SetsOff", items)
    });
    reports.collect()
}

/// Returns the path to a field, as the names of its fields.
fn way(context: &Context<'_>, body: &StructRef, keys: &[String]) -> Code {
    let steps = context.steps(body, keys).into_iter();
    literal(&steps.map(|step| step.name).joined(".")).into()
}

fn cadence(cadence: &Cadence) -> Code {
    let said = match cadence {
        Cadence::OnChange(field) => Code::named("on_change", literal(field)),
        Cadence::Step(step) => {
            let step = format!("({}, {:?})", literal(&step.field), step.by.to_f64());
            Code::named("step", step)
        }
        Cadence::EveryMs(ms) => Code::named("every", seconds(*ms)),
        Cadence::WithinMs(ms) => Code::named("within", seconds(*ms)),
    };
    Code::call("rt.Cadence", [said])
}
