//! Helpers for processes: the states of an enum, the reports of a command, and the state in a report.

use super::fields::enumerators;
use super::types::namespace;
use crate::package::context::{Context, Step};
use crate::package::items::{Call, Item, Spelled};
use crate::package::joined::Joined;
use crate::package::process::{has_states, next_values, set_off, state};
use crate::package::source::Source;
use fc_spec::model::{
    EnumRepr, EnumType, EnumValue, Exchange, Kind, Operation, StateOrder, StructRef,
};

/// Declares the functions over the states of an enum.
pub fn declare(out: &mut Source, by_value: &str, shape: &EnumType) {
    out.template("states", &[("by_value", by_value)]);
    let parameters = [format!("{by_value} value"), format!("{by_value} previous")];
    if shape.order.is_some() {
        out.template(follows(shape), &[]);
        let open = format!("[[nodiscard]] bool {}(", follows(shape));
        out.parameters(&open, &parameters, ") noexcept;");
    }
    out.template("is_in_order", &[]);
    out.parameters(
        "[[nodiscard]] bool is_in_order(",
        &parameters,
        ") noexcept;",
    );
}

/// Returns the name of the function that checks the order.
fn follows(shape: &EnumType) -> &'static str {
    if is_complete(shape) {
        "may_follow"
    } else {
        "normally_follows"
    }
}

/// Returns `true` if the list of changes is complete.
fn is_complete(shape: &EnumType) -> bool {
    shape.order == Some(StateOrder::Complete)
}

/// Defines the functions of [`declare`].
pub fn define(
    out: &mut Source,
    item: &Item<'_>,
    by_value: &str,
    shape: &EnumType,
    values: &[Spelled<'_, EnumValue>],
) {
    out.template("state", &[("by_value", by_value)]);
    let places = enumerators(item);
    let is_text = shape.repr == EnumRepr::String;
    let is = |what: &str, value: &Spelled<'_, EnumValue>| {
        let held = if is_text {
            format!("{what}.value()")
        } else {
            what.to_owned()
        };
        format!("{held} == {places}::{}", value.name)
    };
    let is_complete = is_complete(shape);
    let open =
        |name: &str| format!("bool {name}({by_value} value, {by_value} previous) noexcept {{");
    if shape.order.is_some() {
        out.enclose(&open(follows(shape)), "}", |out| {
            if is_complete && !shape.closed {
                out.line("if (!is_known(value) || !is_known(previous)) return true;");
            }
            for value in values.iter().filter(|value| !value.then.is_empty()) {
                let then = next_values(value, values);
                let then = then.map(|known| is("value", known)).joined(" || ");
                out.line(format!("if ({}) return {then};", is("previous", value)));
            }
            out.line("return false;");
        });
    }
    let (value, previous) = match shape.order {
        Some(_) => ("value", "previous"),
        None => ("/*value*/", "/*previous*/"),
    };
    let head = format!("bool is_in_order({by_value} {value}, {by_value} {previous}) noexcept {{");
    out.enclose(&head, "}", |out| {
        if shape.order.is_none() {
            return out.line("return true;");
        }
        out.line("if (value == previous || is_error(value)) return true;");
        if !is_complete {
            // The spec lists no successors of these values, so any successor is allowed.
            let silent = values
                .iter()
                .filter(|value| value.then.is_empty() && !value.is_final);
            let mut free: Vec<String> = silent.map(|value| is("previous", value)).collect();
            if !shape.closed {
                free.extend([
                    "!is_known(previous)".to_owned(),
                    "!is_known(value)".to_owned(),
                ]);
            }
            if !free.is_empty() {
                out.line(format!("if ({}) return true;", free.join(" || ")));
            }
        }
        out.line(format!("return {}(value, previous);", follows(shape)));
    });
}

/// Declares the functions that check the states in which a command is accepted.
pub fn declare_accepted(out: &mut Source, context: &Context<'_>, command: &Operation) {
    let space = &namespace(context);
    for states in context.accepted_states(command) {
        let ty = &states.item.ty.name;
        out.line(format!(
            "static bool is_accepted_in(const {space}::{ty}& state) noexcept;"
        ));
    }
}

/// Defines the functions of [`declare_accepted`].
fn define_accepted(out: &mut Source, context: &Context<'_>, call: &Call<'_>) {
    let space = &namespace(context);
    for states in context.accepted_states(call.operation) {
        let item = states.item;
        let held = if states.shape.repr == EnumRepr::String {
            "state.value()"
        } else {
            "state"
        };
        let known = states.values.iter();
        let known =
            known.map(|it| format!("{held} == {space}::{}::{}", enumerators(item), it.name));
        let known = any_of(known);
        let [request, ty] = [call.request, item].map(|it| [space, "::", &*it.ty.name].concat());
        let values = [("request", &*request), ("ty", &ty), ("known", &known)];
        out.template("accepted", &values);
        out.blank();
    }
}

/// Returns the conditions with `operator` between them, or `none` without conditions.
pub fn combined(conditions: impl Iterator<Item = String>, operator: &str, none: &str) -> String {
    match conditions.joined(operator) {
        all if all.is_empty() => none.to_owned(),
        all => all,
    }
}

fn any_of(conditions: impl Iterator<Item = String>) -> String {
    combined(conditions, " || ", "false")
}

/// Declares the functions that tie a command to the reports that it sets off.
pub fn declare_set_off(out: &mut Source, context: &Context<'_>, call: &Call<'_>) {
    let space = &namespace(context);
    for (_, _, report) in set_off(context, call.operation) {
        let (request, response) = (&call.request.ty.name, &call.response.ty.name);
        let report = context.name_of(&report.request.ty);
        out.line("template <>");
        let types = [format!("{space}::{request}"), format!("{space}::{report}")];
        out.parameters("struct SetsOff<", &types, "> {");
        let parameters = [
            format!("const {space}::{request}& request"),
            format!("const {space}::{response}& response"),
            format!("const {space}::{report}& report"),
        ];
        out.enclose("", "};", |out| {
            out.parameters("static bool is_of(", &parameters, ");");
        });
        out.blank();
    }
}

/// Defines the functions of a command and of a report.
pub fn define_call(out: &mut Source, context: &Context<'_>, call: &Call<'_>) {
    let space = &namespace(context);
    define_accepted(out, context, call);
    for (set_off, _, report) in set_off(context, call.operation) {
        let (request, response) = (&call.request.ty.name, &call.response.ty.name);
        let name = context.name_of(&report.request.ty);
        let ties = set_off.tied.iter().map(|tie| {
            let side = tie.side.name();
            let messages = call.operation.messages();
            let ours = messages.map(|it| at(context, side, &it.body(tie.side).ty, &tie.command));
            let ours = ours.unwrap_or_default();
            let theirs = at(context, "report", &report.request.ty, &tie.report);
            format!("detail::may_be_same({ours}, {theirs})")
        });
        let all = combined(ties, " && ", "true");
        let [request, response, name] =
            [request, response, name].map(|it| [space, "::", it].concat());
        let values = [
            ("request", &*request),
            ("response", &response),
            ("report", &name),
            ("all", &all),
        ];
        out.template("is_of", &values);
        out.blank();
    }
    if call.operation.kind() == Kind::Report {
        stage(out, context, call);
    }
}

/// Defines the functions over the state in a report.
fn stage(out: &mut Source, context: &Context<'_>, call: &Call<'_>) {
    let space = &namespace(context);
    let name = &call.request.ty.name;
    let body = call.operation.messages().map(|it| &it.request.ty);
    let way = body.and_then(|body| {
        let (keys, _, shape) = state(context, call.operation)?;
        Some((at(context, "report", body, keys), has_states(shape)))
    });
    let mut failures = Vec::new();
    if let (Exchange::Report { failures: keys, .. }, Some(body)) = (&call.operation.exchange, body)
    {
        failures.extend(keys.iter().map(|keys| at(context, "report", body, keys)));
    }
    if let Some((way, true)) = &way {
        failures.insert(0, way.clone());
    }
    let name = format!("{space}::{name}");
    let function = |out: &mut Source, what: &str, result: &str| {
        let values = [("name", &*name), ("what", what), ("result", result)];
        out.template("of_report", &values);
        out.blank();
    };
    let has_state = way.iter().map(|(way, _)| format!("{way} != nullptr"));
    function(out, "has_state", &any_of(has_state));
    let said = way.filter(|(_, says)| *says).map(|(way, _)| way);
    let holds = |what: &'static str| {
        move |way: &String| {
            format!("detail::holds({way}, [](const auto& it) {{ return {what}(it); }})")
        }
    };
    let is_end = said.iter().map(holds("is_final"));
    function(out, "is_end", &any_of(is_end));
    let is_failure = failures.iter().map(holds("is_error"));
    function(out, "is_failure", &any_of(is_failure));
    let [now, before, result] = match &said {
        Some(way) => [
            format!("const auto* now = {way};"),
            format!(
                "const auto* before = {};",
                way.replace("&report", "&previous")
            ),
            format!("now == nullptr || before == nullptr || {space}::is_in_order(*now, *before)"),
        ],
        None => ["", "", "true"].map(str::to_owned),
    };
    let values = [
        ("name", &*name),
        ("now", &now),
        ("before", &before),
        ("result", &result),
    ];
    out.template("order_of_report", &values);
    out.blank();
}

/// Returns a pointer to a field inside a message. It is null if a field on the path is absent.
fn at(context: &Context<'_>, message: &str, body: &StructRef, keys: &[String]) -> String {
    let space = &namespace(context);
    let mut out = format!("&{message}");
    for Step { holder, name, .. } in context.steps(body, keys) {
        out = format!("detail::at({out}, &{space}::{holder}::{name})");
    }
    out
}
